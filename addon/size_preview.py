# SPDX-License-Identifier: GPL-3.0-or-later
"""How large the faces will be: patches of a grid of them, spread over the mesh.

Each patch is three faces wide and lies on the surface, as large as the faces there will be by the
number that is asked for and by *Density*. *Adaptivity* and sharp edges are not foreseen.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector, bvhtree
from numpy.typing import NDArray

from . import density, mesh_arrays, size
from .artist import groups
from .mesh_arrays import MeshArrays

Floats = NDArray[np.float64]
# The nearest place of a surface, and the normal there.
Nearest = Callable[[Vector], tuple[Vector, Vector]]

#: The settings that say how large faces are.
SETTINGS = ("size", "faces", "ratio", "edge_length", "kind", "density", "use_modifiers")
#: The colours of patches, from the largest faces to the smallest, as weight paint has them.
COLOURS = (
    (0.05, 0.20, 1.00, 1.0),
    (0.00, 0.70, 0.75, 1.0),
    (0.10, 0.70, 0.10, 1.0),
    (0.85, 0.65, 0.00, 1.0),
    (1.00, 0.10, 0.05, 1.0),
)
# How many faces a patch has across: of one alone the eye makes no grid.
_ACROSS = 3
# More patches hide the mesh.
_MOST = 40
# So much room a patch has, by its width.
_ROOM = 1.8
# A patch that has to bend by more than this share of its width lies on no face: at the tip of an
# ear it would stand in the air.
_BENT = 0.3
# How far above the surface lines are drawn, by the length of an edge: they are straight, it is not.
_ABOVE = 0.06
# Of more vertices than these some are looked at, and weights are not read for a picture.
_LOOKED_AT, _MOST_WEIGHTS = 3000, 200_000


@dataclass(frozen=True)
class Sizes:
    """How long edges will be at some vertices, (N,), and how dense it is there, from 0 to 1."""

    vertices: NDArray[np.intp]
    edges: Floats
    density: Floats


def lines(thing: bpy.types.Object, wanted: bpy.types.PropertyGroup) -> list[NDArray[np.float32]]:
    """The ends of the lines of all patches, (2L, 3) in the object's space, for each colour."""
    seen = thing
    if wanted.use_modifiers:
        seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if not len(seen.data.polygons):
        return [np.zeros((0, 3), np.float32) for _ in COLOURS]
    arrays = mesh_arrays.read(seen.data)
    scale = np.array(thing.matrix_world.to_scale())
    nearest = _surface(seen, is_evaluated=seen != thing or not thing.modifiers)
    found: list[list[Floats]] = [[] for _ in COLOURS]
    for vertex, edge, dense in _spread(arrays, scale, _sizes(thing, arrays, scale, wanted)):
        patch = _patch(_Spot(seen, vertex, nearest), edge, wanted.kind)
        if not patch.is_bent or not any(found):
            found[min(int(dense * len(COLOURS)), len(COLOURS) - 1)].append(patch.lines)
    return [np.concatenate([np.zeros((0, 3)), *each]).astype(np.float32) for each in found]


def _sizes(
    thing: bpy.types.Object, arrays: MeshArrays, scale: Floats, wanted: bpy.types.PropertyGroup
) -> Sizes:
    """How long edges will be, so that all of them are as many faces as are asked for.

    Where density is 1 they are half as long as where it is 0.
    """
    n = len(arrays.positions)
    dense = _density(thing, n, wanted.density)
    share = np.bincount(arrays.corner_vert, minlength=n).astype(float)
    n_faces = size.n_faces(wanted, arrays, tuple(scale))
    # As if every face were as large: what is dense takes four times the faces.
    mean = float((share * 4**dense).sum() / max(share.sum(), 1))
    of_one = size.area(arrays, tuple(scale)) / n_faces * mean
    shape = 1.0 if wanted.kind == "QUADS" else 4 / math.sqrt(3)
    looked_at = np.flatnonzero(share)[:: max(1, n // _LOOKED_AT)]
    edges = math.sqrt(of_one * shape) / 2 ** dense[looked_at]
    is_one = not np.ptp(dense)
    return Sizes(looked_at, edges, np.full(len(looked_at), 0.3) if is_one else dense[looked_at])


def _density(thing: bpy.types.Object, n: int, name: str) -> Floats:
    """The density at every vertex that is seen; 0 where the seen mesh is another one."""
    mesh = thing.data
    if name and n == len(mesh.vertices) <= _MOST_WEIGHTS:
        try:
            found = density.read(thing, name, groups.read(thing))
        except density.NoSuchName:
            found = None
        if found is not None:
            return found.astype(float)
    return np.zeros(n)


def _spread(arrays: MeshArrays, scale: Floats, sizes: Sizes) -> list[tuple[int, float, float]]:
    """The vertex, length of edges and density of patches that are far from each other."""
    places = arrays.positions[sizes.vertices] * scale
    middle = (places.max(axis=0) + places.min(axis=0)) / 2
    # The first is where most look: in front, in the middle.
    at = int(np.argmin(np.linalg.norm((places - middle) * (1, 0, 1), axis=1) + places[:, 1]))
    free = np.full(len(places), math.inf)
    found = []
    while len(found) < _MOST:
        edge = float(sizes.edges[at])
        found.append((int(sizes.vertices[at]), edge, float(sizes.density[at])))
        free = np.minimum(free, np.linalg.norm(places - places[at], axis=1))
        at = int(np.argmax(free))
        if free[at] < _ROOM * _ACROSS * max(edge, float(sizes.edges[at])):
            break
    return found


def _surface(seen: bpy.types.Object, *, is_evaluated: bool) -> Nearest:
    """What finds the nearest place of a mesh, and the normal there."""
    if is_evaluated:
        return lambda place: seen.closest_point_on_mesh(place)[1:3]
    # Blender's own looks at what modifiers make of it.
    places = [vertex.co for vertex in seen.data.vertices]
    tree = bvhtree.BVHTree.FromPolygons(places, [face.vertices[:] for face in seen.data.polygons])
    return lambda place: tree.find_nearest(place)[:2]


@dataclass(frozen=True)
class _Spot:
    """A vertex of an object, and what finds the nearest place of its mesh."""

    seen: bpy.types.Object
    vertex: int
    nearest: Nearest


@dataclass(frozen=True)
class _Patch:
    """The ends of the lines of a patch, (2L, 3), and whether it lies badly on the surface."""

    lines: Floats
    is_bent: bool


def _patch(spot: _Spot, edge: float, kind: str) -> _Patch:
    """A patch of a grid around a vertex, on the surface."""
    vertex = spot.seen.data.vertices[spot.vertex]
    place, normal, scale = vertex.co, vertex.normal, spot.seen.matrix_world.to_scale()
    steps = np.arange(_ACROSS + 1) - _ACROSS / 2
    along, up = np.meshgrid(steps, steps, indexing="ij")
    if kind != "QUADS":
        along, up = along + up / 2, up * math.sqrt(3) / 2
    right = _across(normal)
    over = normal.cross(right)
    grid, bent = np.empty((_ACROSS + 1, _ACROSS + 1, 3)), 0.0
    for i, j in np.ndindex(grid.shape[:2]):
        arm = edge * (float(along[i, j]) * right + float(up[i, j]) * over)
        flat = place + Vector(a / s if s else 0 for a, s in zip(arm, scale, strict=True))
        lying, above = spot.nearest(flat)
        bent = max(bent, (lying - flat).length)
        grid[i, j] = lying + _ABOVE * (flat - place).length / _ACROSS * above
    sides = [(grid[:-1], grid[1:]), (grid[:, :-1], grid[:, 1:])]
    if kind != "QUADS":
        sides.append((grid[1:, :-1], grid[:-1, 1:]))
    ends = [np.stack([one, other], axis=2).reshape(-1, 3) for one, other in sides]
    width = _ACROSS * edge / max(*map(abs, scale), 1e-12)
    return _Patch(np.concatenate(ends), bent > _BENT * width)


def _across(normal: Vector) -> Vector:
    """A direction along the surface: level, where that can be said."""
    level = Vector((0, 0, 1)).cross(normal)
    if level.length < 0.1:
        level = Vector((0, 1, 0)).cross(normal)
    return level.normalized()
