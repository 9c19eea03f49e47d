# Blender's modules are binary and made at run time: anything may be there.
from typing import Any

def __getattr__(name: str) -> Any: ...
