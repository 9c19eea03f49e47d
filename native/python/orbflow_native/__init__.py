"""Rebuilds a mesh with good edge flow by deforming a sphere into it: arrays in, arrays out."""

from ._core import Cancelled, CancelToken, InputError, OrbflowError, __version__

__all__ = ["CancelToken", "Cancelled", "InputError", "OrbflowError", "__version__"]
