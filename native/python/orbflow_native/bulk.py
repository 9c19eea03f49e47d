"""The bulk reduction of large meshes by fast-simplification, where it is installed.

It holds the interpreter's lock while it works and cannot be stopped, so it runs in a process of its
own that is ended when the user cancels. The core takes its result only when it is closed, manifold
and of equal Euler number, says in the report what it did, and otherwise reduces the mesh itself.
"""

from __future__ import annotations

import importlib.util
import io
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

#: Below this many triangles the core's own reduction is over before a process has started.
LARGE = 200_000
#: How many triangles are left: enough for any detail that the embedding sees.
REDUCED = 60_000

_TICK_S = 0.05
_CHILD = """
import io, sys, numpy, fast_simplification
given, answer = io.BytesIO(sys.stdin.buffer.read()), io.BytesIO()
points, triangles = numpy.load(given), numpy.load(given)
reduced = fast_simplification.simplify(points, triangles, target_count=int(sys.argv[1]))
numpy.save(answer, numpy.ascontiguousarray(reduced[0], numpy.float32))
numpy.save(answer, numpy.ascontiguousarray(reduced[1], numpy.int32))
sys.stdout.buffer.write(answer.getvalue())
"""

if TYPE_CHECKING:
    from numpy.typing import NDArray

    _Floats = NDArray[np.float32]
    _Ints = NDArray[np.int32]
    _Flags = NDArray[np.bool_]


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
    guides: Sequence[_core.Guide] | None = None,
    keep_faces: _Flags | None = None,
    progress: Callable[[str, float], Any] | None = None,
    cancel: _core.CancelToken | None = None,
) -> _core.Remeshed:
    """Rebuilds a mesh by deforming a sphere into each of its parts.

    Keeps the topology, the direction of the faces and their materials. `kind` is "quads" or
    "triangles"; `primitive` is "flow", "quad-sphere", "adaptive", "icosphere" or `None` for what
    suits the kind. How quads flow: `follow_shape` from 0 (smooth loops) to 1 (edges along the
    curvature), `adaptivity` from 0 (quads of one size) to 1 (much smaller where the surface is
    bent). A part keeps its own quads, cut into finer ones or without some strips, where good ones
    come of it, unless `own_quads` is off. Edges at which the surface turns by more than
    `sharp_angle` degrees, and the `marked_edges`, pairs of vertices (E, 2), get edges of the result
    along them. `density` (V,) goes from 0 to 1: where it is 1, edges of flowing quads are about
    half as long as where it is 0; the number of faces stays what was asked for. `mirror` makes
    flowing quads their own image across "x", "y" or "z", in the plane through the origin or the
    middle of the mesh; with "auto"
    across the first in which every vertex, with its density and marks, is the image of another,
    with "off" across none.
    Parts that cannot be done stay as they were: their faces come last and are `kept_faces`, and
    the report's `kept` says why and where; a `strict` run raises instead. Parts too small for
    their share of the faces, or smaller than `small_size` percent of the mesh's diagonal, stay or
    go: `small_parts` is "keep" or "drop". Borders that lie on each other are welded up to a gap of
    `weld` times the diagonal; `None` welds equal points alone. The others stay, as lines of edges
    of the result, or are filled: `borders` is "keep" or "fill"; with `fill_size`, from 0 to 1000,
    those alone are filled that are no longer than so many percent of the diagonal. Handles stay,
    or are sealed: `handles` is "keep" or "seal", and those are closed for good round which a tight
    loop is no longer than `seal_size`, from 0 to 1000, percent of the diagonal.
    With `solid` everything becomes one closed surface first: shells that intersect, double walls,
    cavities, open scraps. A grid does it whose cells measure `solid_detail` percent of the
    diagonal, from 0.02 to 5; thinner walls and gaps are lost, sheets become thick. Closed parts
    that lie wholly inside another are parts like others, or go: `inner` is "keep" or "drop".
    Edges of the result that lie on `carried_edges` (E, 2) are told, so that what is marked on
    these can be carried over. `cut_edges` are edges (E, 2) along which data on corners is cut as
    texture coordinates are along seams, a list with a set of them for each way in which data is
    cut; with it, the result tells where each of its elements comes from.
    `predictor` is "auto", "network" or "solver": auto takes the network for maps of 20,000
    vertices or more, some 10,000 quads, else the solver. The network has the weights of the
    wheel, or `weights`: the bytes of a file that `orbflow train` wrote, or its path. `n_crosses`
    is how many crosses of the field that the quads follow to tell at most.
    `scale` is the scale of the object: faces are even in the scaled space, the
    result is in the space of the input. `reduced` is the same mesh with fewer triangles, as
    points (V, 3) and triangles (T, 3); without it, fast-simplification makes it for large
    meshes where installed.
    `guides` are lines near the surface, each a `Guide`, that edges of flowing quads follow; what
    became of each is in the report's `guides`, and a lost exact one is among its `warnings`.
    `keep_faces` (F,) are faces that are kept as they are: they come last, in order and bit for
    bit, the new ones join them without a gap, and `faces` counts them too.
    `score_samples` is how many points of each surface the score looks at; 0 makes no score.
    `progress` is called on the calling thread, at most 20 times a second, with the name of the
    step and the share of the work that is done. The same input and settings give the same bytes.

    Raises `InputError` when no part of the mesh can be done, `Cancelled` when the token was raised.
    """
    has_all = keep_faces is None and not solid
    if reduced is None and has_all and is_available():
        reduced = reduce(positions, loop_start, corner_vert, cancel)
    return _core.remesh(
        positions,
        loop_start,
        corner_vert,
        faces=faces,
        kind=kind,
        primitive=primitive,
        follow_shape=follow_shape,
        adaptivity=adaptivity,
        own_quads=own_quads,
        sharp_angle=sharp_angle,
        mirror=mirror,
        small_parts=small_parts,
        small_size=small_size,
        borders=borders,
        fill_size=fill_size,
        handles=handles,
        seal_size=seal_size,
        solid=solid,
        solid_detail=solid_detail,
        inner=inner,
        weld=weld,
        strict=strict,
        predictor=predictor,
        weights=weights,
        threads=threads,
        seed=seed,
        scale=scale,
        score_samples=score_samples,
        n_crosses=n_crosses,
        material_index=material_index,
        marked_edges=marked_edges,
        carried_edges=carried_edges,
        cut_edges=cut_edges,
        density=density,
        reduced=reduced,
        guides=guides,
        keep_faces=keep_faces,
        progress=progress,
        cancel=cancel,
    )


def is_available() -> bool:
    """Whether fast-simplification is installed and a process can be started for it."""
    found = importlib.util.find_spec("fast_simplification") is not None
    return found and bool(sys.executable) and "python" in os.path.basename(sys.executable).lower()


def reduce(
    positions: _Floats,
    loop_start: _Ints,
    corner_vert: _Ints,
    cancel: _core.CancelToken | None = None,
) -> tuple[_Floats, _Ints] | None:
    """A mesh of many triangles with fewer; `None` for anything else, or when it fails.

    Raises `Cancelled` when the token was raised.
    """
    if not _is_large_and_of_triangles(positions, loop_start, corner_vert):
        return None
    given = io.BytesIO()
    np.save(given, positions)
    np.save(given, corner_vert.reshape(-1, 3))
    answer = _ask(given.getvalue(), cancel or _core.CancelToken())
    if answer is None:
        return None
    return np.load(answer), np.load(answer)


def _is_large_and_of_triangles(positions: _Floats, loop_start: _Ints, corner_vert: _Ints) -> bool:
    arrays = (positions, loop_start, corner_vert)
    if not all(isinstance(each, np.ndarray) for each in arrays):
        return False
    n_faces = len(loop_start)
    if n_faces <= LARGE or len(corner_vert) != 3 * n_faces or positions.dtype != np.float32:
        return False
    regular = bool(np.array_equal(loop_start, np.arange(0, 3 * n_faces, 3, dtype=np.int32)))
    in_range = corner_vert.min() >= 0 and corner_vert.max() < len(positions)
    return bool(regular and in_range and np.isfinite(positions).all())


def _ask(given: bytes, cancel: _core.CancelToken) -> io.BytesIO | None:
    child = subprocess.Popen(
        [sys.executable, "-c", _CHILD, str(REDUCED)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    answers: list[bytes] = []
    asker = threading.Thread(target=lambda: answers.append(child.communicate(given)[0]))
    asker.start()
    while asker.is_alive():
        asker.join(_TICK_S)
        if cancel.is_cancelled:
            child.kill()
    asker.join()
    if cancel.is_cancelled:
        raise _core.Cancelled("cancelled")
    return io.BytesIO(answers[0]) if child.returncode == 0 and answers else None
