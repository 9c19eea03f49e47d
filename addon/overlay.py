# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks the irregular vertices of the active mesh in the 3D view.

Where fewer edges meet than on a regular grid a vertex is blue if one is missing, red if there is
one too many, black otherwise. Vertices on a border are left out: their valence says nothing.
"""

from dataclasses import dataclass

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix
from numpy.typing import NDArray

_COLOURS = {
    "fewer": (0.10, 0.35, 1.00, 1.0),
    "more": (1.00, 0.10, 0.10, 1.0),
    "other": (0.00, 0.00, 0.00, 1.0),
}
_SIZE_PX = 9.0
# Share of the way to the eye by which marks are drawn nearer. Below, the surface around a vertex
# hides half of its mark; ten times as much shows marks through fingers.
_NEARER = 0.004

_handles: list[object] = []


@dataclass(frozen=True)
class Irregular:
    """Positions of the irregular vertices, (N, 3) float32 each."""

    fewer: NDArray[np.float32]
    more: NDArray[np.float32]
    other: NDArray[np.float32]


def register() -> None:
    """Starts drawing; without a window there is nothing to draw on."""
    if not bpy.app.background:
        space = bpy.types.SpaceView3D
        _handles.append(space.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))


def unregister() -> None:
    """Stops drawing."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def irregular(mesh: bpy.types.Mesh) -> Irregular:
    """Finds the irregular vertices: not of valence 4 among quads, not of 6 among triangles."""
    n = len(mesh.vertices)
    edges = _read(mesh, ".edge_verts", "value", 2 * len(mesh.edges), np.int32).reshape(-1, 2)
    sides = _read(mesh, ".corner_edge", "value", len(mesh.loops), np.int32)
    is_border = np.zeros(n, bool)
    is_border[edges[np.bincount(sides, minlength=len(edges)) != 2]] = True
    valence = np.bincount(edges.ravel(), minlength=n)
    regular = 4 if 2 * len(mesh.loops) > 7 * len(mesh.polygons) else 6
    excess = np.where(is_border | (valence == 0), 0, valence - regular)
    positions = _read(mesh, "position", "vector", 3 * n, np.float32).reshape(-1, 3)
    return Irregular(positions[excess == -1], positions[excess == 1], positions[np.abs(excess) > 1])


def _read(mesh: bpy.types.Mesh, name: str, field: str, n: int, kind: type) -> NDArray:
    values = np.empty(n, kind)
    if n:
        mesh.attributes[name].data.foreach_get(field, values)
    return values


def _draw() -> None:
    context = bpy.context
    thing = context.active_object
    is_wanted = context.scene.orbflow.show_irregular and context.space_data.overlay.show_overlays
    if not is_wanted or context.mode != "OBJECT" or thing is None or thing.type != "MESH":
        return
    if not thing.visible_get():
        return
    marks = irregular(thing.data)
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.point_size_set(_SIZE_PX)
    with gpu.matrix.push_pop():
        view = gpu.matrix.get_model_view_matrix()
        gpu.matrix.load_matrix(_towards_the_eye(context.region_data) @ view @ thing.matrix_world)
        for name, colour in _COLOURS.items():
            _draw_points(getattr(marks, name), colour)
    gpu.state.point_size_set(1.0)
    gpu.state.depth_test_set("NONE")


def _towards_the_eye(view: bpy.types.RegionView3D) -> Matrix:
    if view.is_perspective:
        return Matrix.Scale(1 - _NEARER, 4)
    return Matrix.Translation((0, 0, _NEARER * view.view_distance))


def _draw_points(positions: NDArray[np.float32], colour: tuple[float, float, float, float]) -> None:
    if not len(positions):
        return
    shader = _shader()
    batch = batch_for_shader(shader, "POINTS", {"pos": positions})
    shader.uniform_float("color", colour)
    batch.draw(shader)


def _shader() -> gpu.types.GPUShader:
    try:
        return gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # before Blender 4.5 one shader drew points and lines alike
        return gpu.shader.from_builtin("UNIFORM_COLOR")
