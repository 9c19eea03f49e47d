"""Rebuilds a mesh with good edge flow by deforming a sphere into it: arrays in, arrays out.

A mesh is three arrays: `positions (V, 3) float32`, `loop_start (F,) int32` (where the corners of
each face start), `corner_vert (L,) int32` (the vertex of each corner).
"""

from ._core import (
    DEFAULTS,
    MAX_FACES,
    MIN_FACES,
    Cancelled,
    CancelToken,
    Decimated,
    Embedded,
    Guide,
    InputError,
    OrbflowError,
    Origins,
    Remeshed,
    __version__,
    decimate,
    embed,
    score,
)
from .bulk import remesh

__all__ = [
    "DEFAULTS",
    "MAX_FACES",
    "MIN_FACES",
    "CancelToken",
    "Cancelled",
    "Decimated",
    "Embedded",
    "Guide",
    "InputError",
    "OrbflowError",
    "Origins",
    "Remeshed",
    "__version__",
    "decimate",
    "embed",
    "remesh",
    "score",
]
