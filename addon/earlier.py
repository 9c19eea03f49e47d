# SPDX-License-Identifier: GPL-3.0-or-later
"""Before and after: a slider that draws the original over the result, from the left.

What is drawn are the triangles that the run was given. They are kept for the session, beside the
file and its undo steps: no copy of the object is needed, nothing of it is saved, and neither
undo nor redo goes through it. In a file that was opened again they come from the original that
*Original* has kept. The slider itself is a number of this module, not of the file.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix
from numpy.typing import NDArray

from . import mesh_arrays, modifiers, originals, runs
from .mesh_arrays import MeshArrays
from .runs import Print

Floats = NDArray[np.float32]

# Of all that is kept at most so many bytes: what was kept first goes first.
_MOST_BYTES = 256 * 1024**2
# Clay, which neither the result nor what is selected looks like.
_CLAY = np.array((0.80, 0.53, 0.36))
_LIGHT = np.array((-0.45, -0.60, 0.66))
_DARKEST = 0.25
# Where a face turns by more than this cosine from what is around it, an edge is seen.
_SMOOTH = 0.95
_LINE: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 0.9)
_TEXT_PX = 13

_kept: dict[Print, MeshArrays] = {}
_handles: list[object] = []
# What is drawn of which mesh, so that a redraw makes nothing anew.
_drawn: dict[Print, Any] = {}


class _Slider:
    """How much of the view shows the original, from 0 to 1."""

    share = 0.0


_slider = _Slider()


def register() -> None:
    """Puts the slider where no file is: nothing of it is saved, nor is it a step of undo."""
    bpy.types.WindowManager.orbflow_before = bpy.props.FloatProperty(
        name="Before / After",
        description=(
            "Draw the object as it was before the last run over the result, up to this share of "
            "the view from the left"
        ),
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        get=lambda _manager: _slider.share,
        set=lambda _manager, share: show(bpy.context, share),
    )
    bpy.app.handlers.load_post.append(_forget)
    if not bpy.app.background:
        space = bpy.types.SpaceView3D
        _handles.append(space.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))
        _handles.append(space.draw_handler_add(_draw_line, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Takes the slider away."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    bpy.app.handlers.load_post.remove(_forget)
    _forget()
    del bpy.types.WindowManager.orbflow_before


@bpy.app.handlers.persistent
def _forget(*_file: object) -> None:
    _kept.clear()
    _drawn.clear()
    _slider.share = 0.0


def remember(thing: bpy.types.Object, arrays: MeshArrays) -> None:
    """Keeps what a run was given for the mesh that an object has now."""
    key = runs.print_of(thing.data)
    _kept.pop(key, None)
    _kept[key] = arrays
    while len(_kept) > 1 and sum(map(_n_bytes, _kept.values())) > _MOST_BYTES:
        del _kept[next(iter(_kept))]


def show(context: bpy.types.Context, share: float) -> None:
    """Draws the original over so much of the view, from 0 to 1."""
    _slider.share = min(max(share, 0.0), 1.0)
    if _slider.share > 0 and of(context.object) is None:
        _fetch(context)
    for area in _views(context):
        area.tag_redraw()


def of(thing: bpy.types.Object | None) -> MeshArrays | None:
    """What an object was before the run that made its mesh, at rest; none where that is gone."""
    if not _kept or thing is None or thing.type != "MESH":
        return None
    return _kept.get(runs.print_of(thing.data))


def may_be(thing: bpy.types.Object | None) -> bool:
    """Whether there is a before to show."""
    if of(thing) is not None:
        return True
    try:
        return thing is not None and thing.type == "MESH" and originals.of(thing) is not None
    except originals.Gone:
        return False


def _fetch(context: bpy.types.Context) -> None:
    """Takes the original that is in the file, where there is one."""
    if may_be(context.object) and context.mode == "OBJECT":
        try:
            with originals.as_remeshed(context, context.object) as mesh:
                remember(context.object, mesh_arrays.read(mesh))
        except modifiers.Refused:
            # The panel shows the slider as grey: there is nothing to draw.
            return


def _n_bytes(arrays: MeshArrays) -> int:
    return sum(each.nbytes for each in (arrays.positions, arrays.loop_start, arrays.corner_vert))


def _views(context: bpy.types.Context) -> Iterator[bpy.types.Area]:
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type == "VIEW_3D")


@dataclass(frozen=True)
class Picture:
    """Triangles by their corners, (3T, 3), and the colour of each corner, (3T, 4)."""

    positions: Floats
    colours: Floats


def picture(arrays: MeshArrays, turn: Matrix) -> Picture:
    """A mesh as lit clay; `turn` is how its object is turned in the world."""
    corners = arrays.corner_vert[_triangles(arrays)]
    points = arrays.positions[corners].astype(np.float64)
    across = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    n = len(arrays.positions)
    around = np.stack(
        [np.bincount(corners.ravel(), np.repeat(axis, 3), n) for axis in across.T], axis=1
    )
    faces, around = _unit(across)[:, None], _unit(around)[corners]
    is_smooth = (faces * around).sum(axis=2, keepdims=True) > _SMOOTH
    normals = np.where(is_smooth, around, faces) @ np.array(turn.to_3x3()).T
    bright = _DARKEST + (1 - _DARKEST) * (0.5 + 0.5 * _unit(normals) @ _LIGHT) ** 1.5
    colours = np.ones((len(corners), 3, 4), np.float32)
    colours[..., :3] = _CLAY * bright[..., None]
    return Picture(points.reshape(-1, 3).astype(np.float32), colours.reshape(-1, 4))


def _triangles(arrays: MeshArrays) -> NDArray[np.intp]:
    """The corners of triangles, (T, 3), that meet in the first corner of their face."""
    starts, n = arrays.loop_start, len(arrays.corner_vert)
    sizes = np.diff(np.append(starts, n))
    firsts = np.repeat(starts, np.maximum(sizes - 2, 0))
    middle = np.ones(n, bool)
    middle[starts] = False
    middle[np.append(starts, n)[1:] - 1] = False
    second = middle.nonzero()[0]
    return np.stack([firsts, second, second + 1], axis=1).astype(np.intp)


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)


def _shown() -> bpy.types.Object | None:
    """The object that is drawn as it was, if one is."""
    thing = bpy.context.active_object
    if _slider.share == 0 or thing is None or thing.type != "MESH":
        return None
    return thing if thing.visible_get() else None


def _draw() -> None:
    thing = _shown()
    if thing is None or (arrays := of(thing)) is None:
        return
    region, view = bpy.context.region, gpu.matrix.get_model_view_matrix()
    gpu.state.scissor_test_set(True)
    gpu.state.scissor_set(0, 0, max(1, round(_slider.share * region.width)), region.height)
    _push_back()
    gpu.state.depth_test_set("LESS_EQUAL")
    with gpu.matrix.push_pop():
        gpu.matrix.load_matrix(view @ thing.matrix_world)
        draw(thing, arrays)
    gpu.state.depth_test_set("NONE")
    gpu.state.depth_mask_set(False)
    gpu.state.scissor_test_set(False)


def _push_back() -> None:
    """Makes what is drawn already as far as can be: the result must not show through."""
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    corners = [(-1, -1, 1), (3, -1, 1), (-1, 3, 1)]
    gpu.state.depth_test_set("ALWAYS")
    gpu.state.depth_mask_set(True)
    gpu.state.color_mask_set(False, False, False, False)
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_matrix(Matrix.Identity(4))
        gpu.matrix.load_projection_matrix(Matrix.Identity(4))
        shader.uniform_float("color", (0, 0, 0, 1))
        batch_for_shader(shader, "TRIS", {"pos": corners}).draw(shader)
    gpu.state.color_mask_set(True, True, True, True)


def draw(thing: bpy.types.Object, arrays: MeshArrays) -> None:
    """Draws what an object was by the matrices that are set."""
    key = runs.print_of(thing.data)
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    if key not in _drawn:
        _drawn.clear()
        made = picture(arrays, thing.matrix_world)
        given = {"pos": made.positions, "color": made.colours}
        _drawn[key] = batch_for_shader(shader, "TRIS", given)
    _drawn[key].draw(shader)


def _draw_line() -> None:
    """Where the original ends, and which side is which."""
    thing = _shown()
    if thing is None or of(thing) is None:
        return
    region = bpy.context.region
    x, y = round(_slider.share * region.width), region.height
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    shader.uniform_float("color", _LINE)
    batch_for_shader(shader, "LINES", {"pos": [(x, 0, 0), (x, y, 0)]}).draw(shader)
    gpu.state.blend_set("NONE")
    blf.size(0, _TEXT_PX * bpy.context.preferences.system.ui_scale)
    for text, of_width, gap in (("Before", 1, -8), ("After", 0, 8)):
        width, height = blf.dimensions(0, text)
        blf.position(0, x - of_width * width + gap, 2 * height, 0)
        blf.color(0, *_LINE)
        blf.draw(0, text)
