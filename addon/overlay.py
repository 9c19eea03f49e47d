# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks the irregular vertices of the active mesh, and the field behind them, in the 3D view.

Where fewer edges meet than on a regular grid a vertex is blue if one is missing, red if there is
one too many, black otherwise. On a border as many faces are right as their angles have room there:
two along a straight one (three edges), one at its corners.

What is drawn is kept from one redraw to the next: to read a large mesh takes longer than a frame.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix
from numpy.typing import NDArray

from . import attributes, runs, size_preview

Colour = tuple[float, float, float, float]

_COLOURS: dict[str, Colour] = {
    "fewer": (0.10, 0.35, 1.00, 1.0),
    "more": (1.00, 0.10, 0.10, 1.0),
    "other": (0.00, 0.00, 0.00, 1.0),
}
# Neither that of a mark nor the orange of what is selected.
_CROSS_COLOUR: Colour = (0.05, 0.45, 0.15, 1.0)
# Length of an arm as a share of the space a cross has to itself. At the whole space neighbouring
# crosses run into one another, and nothing can be read.
_ARM = 0.6
_SIZE_PX = 9.0
_WIDTH_PX = 1.5
# What is drawn, in order, and the share of the way to the eye by which it is drawn nearer. Below
# that of marks, the surface around a vertex hides half of its mark; ten times as much shows marks
# through fingers. Crosses lie lower, so that none runs over a mark.
_NEARER = {"size": 0.003, "crosses": 0.003, "irregular": 0.004}

_handles: list[object] = []
_TICKS = ("show_irregular", "show_crosses", "show_size")
# What was ticked before the last undo, by the name of the scene.
_ticked: dict[str, list[bool]] = {}


@dataclass(frozen=True)
class Irregular:
    """Positions of the irregular vertices, (N, 3) float32 each."""

    fewer: NDArray[np.float32]
    more: NDArray[np.float32]
    other: NDArray[np.float32]


@dataclass(frozen=True)
class Figure:
    """Points or lines of one colour, in the space of the object."""

    kind: str
    colour: Colour
    positions: NDArray[np.float32]


class Kept:
    """What was made last of a mesh, as long as the mesh is the same."""

    def __init__(self) -> None:
        """Keeps nothing."""
        self._made: dict[str, tuple[tuple[Any, ...], list[Any]]] = {}

    def get(
        self,
        what: str,
        mesh: bpy.types.Mesh,
        make: Callable[[], list[Any]],
        settings: tuple[Any, ...] = (),
    ) -> list[Any]:
        """What is kept, or what `make` makes where that is of another mesh or other settings."""
        key = (mesh.as_pointer(), len(mesh.vertices), len(mesh.polygons), *settings)
        if what not in self._made or self._made[what][0] != key:
            self._made[what] = (key, make())
        return self._made[what][1]

    def forget(self) -> None:
        """Keeps nothing any more."""
        self._made.clear()


_kept = Kept()


def register() -> None:
    """Starts drawing; without a window there is nothing to draw on."""
    for handlers in _changes():
        handlers.append(_forget)
    bpy.app.handlers.undo_pre.append(_note_ticks)
    if not bpy.app.background:
        space = bpy.types.SpaceView3D
        _handles.append(space.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))


def unregister() -> None:
    """Stops drawing."""
    for handlers in _changes():
        handlers.remove(_forget)
    bpy.app.handlers.undo_pre.remove(_note_ticks)
    _kept.forget()
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _changes() -> Iterator[list[Any]]:
    """The lists of what Blender calls when a mesh may have changed."""
    handlers = bpy.app.handlers
    yield from (handlers.depsgraph_update_post, handlers.undo_post, handlers.redo_post)
    yield handlers.load_post


@bpy.app.handlers.persistent
def _forget(_scene: object, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    updates = getattr(depsgraph, "updates", None)
    if updates is None or any(each.is_updated_geometry for each in updates):
        _kept.forget()


@bpy.app.handlers.persistent
def _note_ticks(scene: bpy.types.Scene, _depsgraph: object = None) -> None:
    _ticked[scene.name] = [getattr(scene.orbflow, name) for name in _TICKS]


def keep_ticks(scene: bpy.types.Scene) -> None:
    """Ticks again what the redo panel has unticked: it undoes all that came after the run."""
    for name, is_ticked in zip(_TICKS, _ticked.get(scene.name, []), strict=False):
        setattr(scene.orbflow, name, is_ticked)


def irregular(mesh: bpy.types.Mesh) -> Irregular:
    """Finds the irregular vertices: not of valence 4 among quads, not of 6 among triangles.

    On a border one edge more than faces of 90° (quads) or 60° fill the angle there.
    """
    n = len(mesh.vertices)
    edges, sides = attributes.edge_verts(mesh), attributes.corner_edges(mesh)
    n_sides = np.bincount(sides, minlength=len(edges))
    is_border, is_tangled = np.zeros(n, bool), np.zeros(n, bool)
    is_border[edges[n_sides == 1]] = True
    is_tangled[edges[(n_sides != 1) & (n_sides != 2)]] = True
    valence = np.bincount(edges.ravel(), minlength=n)
    inside = 4 if 2 * len(mesh.loops) > 7 * len(mesh.polygons) else 6
    positions = attributes.positions(mesh)
    faces = np.rint(_angles(mesh, positions) / (2 * math.pi / inside))
    regular = np.where(is_border, np.maximum(faces, 1) + 1, inside).astype(int)
    excess = np.where(is_tangled | (valence == 0), 0, valence - regular)
    return Irregular(positions[excess == -1], positions[excess == 1], positions[np.abs(excess) > 1])


def _angles(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> NDArray[np.float64]:
    """The angles of all faces at every vertex, added, (V,), in radians."""
    corners = attributes.corner_verts(mesh)
    ahead = attributes.corners_ahead(attributes.loop_starts(mesh), len(corners))
    behind = np.empty_like(ahead)
    behind[ahead] = np.arange(len(ahead))
    first, second = (
        (positions[corners[to]] - positions[corners]).astype(np.float64) for to in (ahead, behind)
    )
    sine = np.linalg.norm(np.cross(first, second), axis=1)
    angles = np.arctan2(sine, (first * second).sum(1))
    return np.bincount(corners, angles, minlength=len(positions))


def figures(thing: bpy.types.Object, what: str) -> list[Figure]:
    """What to draw of an object: irregular vertices, crosses of its field, sizes of faces."""
    if what == "size":
        found = size_preview.lines(thing, bpy.context.scene.orbflow)
        colours = size_preview.COLOURS
        return [Figure("LINES", *each) for each in zip(colours, found, strict=True)]
    if what == "crosses":
        crosses = runs.last_crosses(thing)
        if crosses is None:
            return []
        lines = cross_lines(crosses, len(thing.data.polygons))
        return [Figure("LINES", _CROSS_COLOUR, lines)]
    marks = irregular(thing.data)
    return [Figure("POINTS", colour, getattr(marks, name)) for name, colour in _COLOURS.items()]


def cross_lines(crosses: NDArray[np.float32], n_faces: int) -> NDArray[np.float32]:
    """The ends of the two lines of every cross, (4N, 3), of places and arms (N, 3, 3).

    Of more crosses than faces some are left out; fewer are drawn larger.
    """
    shown = crosses[:: max(1, -(-len(crosses) // max(1, n_faces)))]
    arm = _ARM * math.sqrt(n_faces / max(1, len(shown)))
    shown = shown * np.array((1, arm, arm), np.float32)[:, None]
    place, first, second = (shown[:, i] for i in range(3))
    ends = (place - first, place + first, place - second, place + second)
    return np.stack(ends, axis=1, dtype=np.float32).reshape(-1, 3)


def _draw() -> None:
    context = bpy.context
    thing = context.active_object
    if context.mode != "OBJECT" or thing is None or thing.type != "MESH":
        return
    wanted = [what for what in _NEARER if _is_wanted(context, what)]
    if not wanted or not thing.visible_get():
        return
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.point_size_set(_SIZE_PX)
    gpu.state.line_width_set(_WIDTH_PX)
    view = gpu.matrix.get_model_view_matrix()
    for what in wanted:
        nearer = _towards_the_eye(context.region_data, _NEARER[what])
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(nearer @ view @ thing.matrix_world)
            draw(thing, what)
    gpu.state.point_size_set(1.0)
    gpu.state.line_width_set(1.0)
    gpu.state.depth_test_set("NONE")


def _is_wanted(context: bpy.types.Context, what: str) -> bool:
    shows = context.space_data.overlay.show_overlays
    return shows and getattr(context.scene.orbflow, f"show_{what}")


def _towards_the_eye(view: bpy.types.RegionView3D, share: float) -> Matrix:
    if view.is_perspective:
        return Matrix.Scale(1 - share, 4)
    return Matrix.Translation((0, 0, share * view.view_distance))


def draw(thing: bpy.types.Object, what: str) -> None:
    """Draws the figures of an object by the matrices that are set."""

    def batches() -> list[Any]:
        return [_batch(figure) for figure in figures(thing, what) if len(figure.positions)]

    wanted = bpy.context.scene.orbflow
    settings = tuple(getattr(wanted, name) for name in size_preview.SETTINGS * (what == "size"))
    for batch, shader, colour in _kept.get(what, thing.data, batches, settings):
        shader.uniform_float("color", colour)
        batch.draw(shader)


def _batch(figure: Figure) -> tuple[gpu.types.GPUBatch, gpu.types.GPUShader, Colour]:
    shader = _shader(figure.kind)
    batch = batch_for_shader(shader, figure.kind, {"pos": figure.positions})
    return batch, shader, figure.colour


def _shader(kind: str) -> gpu.types.GPUShader:
    if kind == "LINES":
        return gpu.shader.from_builtin("UNIFORM_COLOR")
    try:
        return gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # before Blender 4.5 one shader drew points and lines alike
        return gpu.shader.from_builtin("UNIFORM_COLOR")
