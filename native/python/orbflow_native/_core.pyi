"""The compiled half of the package `orbflow_native`."""

import os
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

_Floats: TypeAlias = NDArray[np.float32]
_Ints: TypeAlias = NDArray[np.int32]
_Flags: TypeAlias = NDArray[np.bool_]
_Listener: TypeAlias = Callable[[str, float], Any]

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

__version__: Final[str]
MIN_FACES: Final[int]
MAX_FACES: Final[int]
DEFAULTS: Final[dict[str, Any]]

class OrbflowError(Exception):
    """What every error of Orbflow derives from."""

class InputError(OrbflowError):
    """This input or this setting cannot be done; the text says why, with numbers.

    `kept` lists the parts that cannot be done and `warnings` what is wrong with a result that a
    strict run refuses, as a report does.
    """

    kept: list[dict[str, Any]]
    warnings: list[dict[str, Any]]

class Cancelled(OrbflowError):
    """The job was stopped by its cancel token; nothing was changed."""

@final
class CancelToken:
    """A flag that another thread raises to stop a running job."""

    def __new__(cls) -> CancelToken: ...
    def cancel(self) -> None:
        """Raises the flag; the job stops within a fraction of a second and raises `Cancelled`."""

    @property
    def is_cancelled(self) -> bool:
        """Whether the flag is up."""

@final
class Guide:
    """A line near the surface that edges of flowing quads follow.

    With `is_exact` a line of edges lies on it, else edges turn along it. A closed one goes on from
    its last point to its first. `points` is an `(N, 3) float64` array in the mesh's coordinates, of
    2 points or more, closed of 3.
    """

    def __new__(
        cls, points: NDArray[np.float64], *, is_closed: bool = False, is_exact: bool = False
    ) -> Guide: ...
    @property
    def points(self) -> NDArray[np.float64]:
        """`(N, 3) float64`."""

    @property
    def is_closed(self) -> bool:
        """Whether the last point is joined to the first."""

    @property
    def is_exact(self) -> bool:
        """Whether a line of edges is to lie on it."""

@final
class Origins:
    """What of the input every element of the result comes from: mix values by the weights."""

    @property
    def vertex_corners(self) -> _Ints:
        """`(V, 3) int32`: of every vertex three corners of one face of the input."""

    @property
    def vertex_weights(self) -> _Floats:
        """`(V, 3) float32`: their weights, which sum to 1."""

    @property
    def corner_corners(self) -> list[_Ints]:
        """For each set of cuts `(L, 3) int32`: of every corner three corners of an input face."""

    @property
    def corner_weights(self) -> list[_Floats]:
        """For each set of cuts `(L, 3) float32`: their weights, which sum to 1."""

    @property
    def faces(self) -> _Ints:
        """`(F,) int32`: the face of the input under every face."""

@final
class Remeshed:
    """A new mesh and how it came about."""

    @property
    def positions(self) -> _Floats:
        """`(V, 3) float32`: the positions of the vertices."""

    @property
    def loop_start(self) -> _Ints:
        """`(F,) int32`: where the corners of each face start."""

    @property
    def corner_vert(self) -> _Ints:
        """`(L,) int32`: the vertex of each corner."""

    @property
    def material_index(self) -> _Ints | None:
        """`(F,) int32`: the material of each face; `None` when the input had none."""

    @property
    def sphere(self) -> _Floats:
        """`(V, 3) float32`: where each vertex lies on the unit sphere of its part."""

    @property
    def carried_edges(self) -> _Ints:
        """`(M, 2) int32`: the edges, by their ends, that lie on edges to be carried."""

    @property
    def carried_from(self) -> _Ints:
        """`(M,) int32`: on which of the edges to be carried each of them lies."""

    @property
    def origins(self) -> Origins | None:
        """What of the input every element comes from; `None` without `cut_edges`."""

    @property
    def filled_faces(self) -> _Ints:
        """`(N,) int32`: the faces that lie on what filled borders and sealed handles."""

    @property
    def crosses(self) -> _Floats:
        """`(N, 3, 3) float32`: place and two arms of crosses, arms half as long as edges."""

    @property
    def report(self) -> dict[str, Any]:
        """What is told of the run."""

    @property
    def kept_faces(self) -> int:
        """How many faces at the end are the input's own, of parts that were kept as they were."""

@final
class Embedded:
    """A mesh of triangles and its map to the sphere."""

    @property
    def positions(self) -> _Floats:
        """`(V, 3) float32`: the positions of the vertices."""

    @property
    def loop_start(self) -> _Ints:
        """`(F,) int32`: where the corners of each face start."""

    @property
    def corner_vert(self) -> _Ints:
        """`(L,) int32`: the vertex of each corner."""

    @property
    def sphere(self) -> _Floats:
        """`(V, 3) float32`: where each vertex lies on the unit sphere of its part."""

    @property
    def report(self) -> dict[str, Any]:
        """What is told of the run."""

@final
class Decimated:
    """A mesh with fewer triangles."""

    @property
    def positions(self) -> _Floats:
        """`(V, 3) float32`: the positions of the vertices."""

    @property
    def loop_start(self) -> _Ints:
        """`(F,) int32`: where the corners of each face start."""

    @property
    def corner_vert(self) -> _Ints:
        """`(L,) int32`: the vertex of each corner."""

    @property
    def material_index(self) -> _Ints | None:
        """`(F,) int32`: the material of each face; `None` when the input had none."""

    @property
    def report(self) -> dict[str, Any]:
        """What is told of the run."""

def remesh(
    positions: _Floats,
    loop_start: _Ints,
    corner_vert: _Ints,
    *,
    faces: int = 2000,
    kind: str = "quads",
    primitive: str | None = None,
    follow_shape: float = 0.5,
    adaptivity: float = 0.5,
    own_quads: bool = True,
    sharp_angle: float = 40.0,
    mirror: str = "auto",
    small_parts: str = "keep",
    small_size: float = 0.0,
    borders: str = "keep",
    fill_size: float | None = None,
    handles: str = "keep",
    seal_size: float = 1.0,
    solid: bool = False,
    solid_detail: float = 0.4,
    inner: str = "keep",
    weld: float | None = 1e-5,
    strict: bool = False,
    predictor: str = "auto",
    weights: bytes | str | os.PathLike[str] | None = None,
    threads: int = 0,
    seed: int = 0,
    scale: tuple[float, float, float] | None = None,
    score_samples: int = 10_000,
    n_crosses: int = 0,
    material_index: _Ints | None = None,
    marked_edges: _Ints | None = None,
    carried_edges: _Ints | None = None,
    cut_edges: Sequence[_Ints] | None = None,
    density: _Floats | None = None,
    reduced: tuple[_Floats, _Ints] | None = None,
    guides: Sequence[Guide] | None = None,
    keep_faces: _Flags | None = None,
    progress: _Listener | None = None,
    cancel: CancelToken | None = None,
) -> Remeshed:
    """Rebuilds a mesh by deforming a sphere into each of its parts."""

def embed(
    positions: _Floats,
    loop_start: _Ints,
    corner_vert: _Ints,
    *,
    predictor: str = "auto",
    weights: bytes | str | os.PathLike[str] | None = None,
    threads: int = 0,
    progress: _Listener | None = None,
    cancel: CancelToken | None = None,
) -> Embedded:
    """Maps every vertex of a mesh to the unit sphere, at full resolution."""

def decimate(
    positions: _Floats,
    loop_start: _Ints,
    corner_vert: _Ints,
    *,
    faces: int = 2000,
    material_index: _Ints | None = None,
    progress: _Listener | None = None,
    cancel: CancelToken | None = None,
) -> Decimated:
    """Lowers the number of triangles of a mesh; borders and handles are kept."""

def score(
    input: tuple[_Floats, _Ints, _Ints],
    output: tuple[_Floats, _Ints, _Ints],
    *,
    target: int | None = None,
    n_samples: int = 100_000,
    seed: int = 0,
    progress: _Listener | None = None,
    cancel: CancelToken | None = None,
) -> dict[str, Any]:
    """Says in numbers how good `output` is as a new mesh of `input`.

    Whether the topology is the same is told of the input once it is cleaned as `remesh` does it.
    """
