# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges along which data on corners is cut, as texture coordinates are along seams.

They are found on the mesh as the core welds it: where a seam is split, as importers split it, the
two borders that lie on each other are one edge.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import bpy
import mathutils
import numpy as np
from numpy.typing import NDArray

from .. import attributes
from . import normals
from .layers import Layer

Int = NDArray[np.int32]
Index = NDArray[np.intp]

# Texture coordinates of one place that differ by more are on two sides of a seam.
_APART = 1e-5
# Other numbers are cut where they jump by more than this share of their range: below, the grain of
# paint and of baked light would cut everywhere; above, a border that is seen would be smeared.
_VISIBLE = 1 / 32
# Normals of one place that differ by more make a crease: below, those of files that keep a byte for
# a number do; above, creases of 2 degrees are missed.
_CREASE = 1 / 32
# Borders no farther from each other than this share of the diagonal are welded by the core.
_WELD = 1e-5


@dataclass(frozen=True)
class Seams:
    """The sides of faces, those of one welded edge together."""

    #: The corner at which every side begins, (S,).
    sides: Index
    #: Its two corners, (S, 2), in the same order of places for all sides of an edge.
    ends: Index
    #: Where in `ends` the sides of every edge begin, (E,).
    starts: Index
    #: The vertex of every corner.
    corner_vert: Int
    #: For every vertex those that the core may take for it, itself among them.
    twins: dict[int, list[int]]

    def jumps(self, values: NDArray, least: float = 0.0) -> NDArray[np.bool_]:
        """At which edges a value of corners differs by more than `least` between faces, (E,)."""
        first = self.starts[self._edge_of_sides()]
        found = np.zeros(len(self.ends), bool)
        for end in self.ends.T:
            one, other = values[end], values[end[first]]
            if values.dtype == np.float32:
                with np.errstate(invalid="ignore"):
                    differs = np.abs(one - other) > least
            else:
                differs = one != other
            found |= differs.any(axis=1)
        return np.logical_or.reduceat(found, self.starts) if len(found) else found

    def on_corners(self, which: NDArray[np.bool_]) -> Index:
        """The corners at which the sides of some edges begin."""
        return self.sides[which[self._edge_of_sides()]]

    def pairs(self, which: NDArray[np.bool_]) -> Int:
        """The ends of some edges, (N, 2), by all vertices that the core may take for them."""
        pairs = self.corner_vert[self.ends[self.starts[which]]]
        more = [
            (a, b)
            for low, high in pairs[np.isin(pairs, list(self.twins)).any(axis=1)].tolist()
            for a in self.twins.get(low, [low])
            for b in self.twins.get(high, [high])
        ]
        pairs = np.concatenate([pairs, np.array(more, np.int32).reshape(-1, 2)])
        return np.ascontiguousarray(pairs, np.int32)

    def _edge_of_sides(self) -> Index:
        counts = np.diff(np.append(self.starts, len(self.sides)))
        return np.repeat(np.arange(len(self.starts)), counts)


def read(mesh: bpy.types.Mesh) -> Seams:
    """Finds out which sides of faces are on one edge."""
    corner_vert = attributes.corner_verts(mesh)
    loops = np.arange(len(corner_vert))
    ahead = attributes.corners_ahead(attributes.loop_starts(mesh), len(loops))
    ends = np.stack([loops, ahead], axis=1)
    names, twins = _named(attributes.positions(mesh), corner_vert[ends])
    # Sides of one edge may run either way.
    ends = np.where(names[:, :1] > names[:, 1:], ends[:, ::-1], ends)
    order, firsts = _grouped(names)
    return Seams(order, ends[order], firsts, corner_vert, twins)


def of_layers(mesh: bpy.types.Mesh, layers: list[Layer]) -> tuple[list[Int], list[int]]:
    """The sets of edges along which values of corners are cut, and which one is each layer's.

    There is always a set.
    """
    if not layers:
        return [np.empty((0, 2), np.int32)], []
    seams = read(mesh)
    sets: dict[bytes, tuple[int, Int]] = {}
    which = []
    for layer in layers:
        is_cut = seams.jumps(layer.values, _least_jump(layer))
        number, _ = sets.setdefault(is_cut.tobytes(), (len(sets), seams.pairs(is_cut)))
        which.append(number)
    return [edges for _, edges in sets.values()], which


def of_borders(mesh: bpy.types.Mesh, names: Iterable[str]) -> Int:
    """The borders of some names of `BORDERS`, each edge once, (N, 2)."""
    values = [each for name in names if (each := BORDERS[name](mesh)) is not None]
    if not values or not len(mesh.loops):
        return np.empty((0, 2), np.int32)
    seams = read(mesh)
    return seams.pairs(np.logical_or.reduce([seams.jumps(each, _APART) for each in values]))


def _coordinates(mesh: bpy.types.Mesh) -> NDArray[np.float32] | None:
    """The active UV map at every corner."""
    active = mesh.uv_layers.active
    if active is None:
        return None
    found = np.empty((len(mesh.loops), 2), np.float32)
    mesh.attributes[active.name].data.foreach_get("vector", found.ravel())
    return found


def _of_faces(mesh: bpy.types.Mesh, name: str) -> Int | None:
    """A whole number of every face at each of its corners."""
    values = attributes.values(mesh, name, "FACE", "INT")
    if values is None:
        return None
    sizes = np.diff(np.append(attributes.loop_starts(mesh), len(mesh.loops)))
    return np.repeat(values, sizes)[:, None]


#: What borders lie between: islands of the UV map, materials, face sets; by the names of marks.
BORDERS: dict[str, Callable[[bpy.types.Mesh], NDArray | None]] = {
    "UV": _coordinates,
    "MATERIAL": partial(_of_faces, name="material_index"),
    "FACE_SETS": partial(_of_faces, name=attributes.FACE_SETS),
}


def creases(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    """At which edges of smooth faces the artist's normals break, (E,)."""
    found = np.zeros(len(mesh.edges), bool)
    if not mesh.has_custom_normals:
        return found
    normals = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", normals.ravel())
    seams = read(mesh)
    corners = seams.on_corners(seams.jumps(normals, _CREASE))
    is_flat = attributes.values(mesh, "sharp_face", "FACE", "BOOLEAN")
    if is_flat is not None:
        # These have normals of their own without a crease.
        of_corners = np.searchsorted(attributes.loop_starts(mesh), corners, "right") - 1
        corners = corners[~is_flat[of_corners]]
    found[attributes.corner_edges(mesh)[corners]] = True
    return found


def _least_jump(layer: Layer) -> float:
    """By how much values on two sides of a cut differ at least."""
    if layer.kind == "FLOAT2":
        return _APART
    if layer.name == normals.NAME:
        return _CREASE
    if layer.values.dtype != np.float32:
        return 0.0
    known = layer.values[np.isfinite(layer.values)]
    return _VISIBLE * float(np.ptp(known)) if len(known) else 0.0


def _grouped(names: Index) -> tuple[Index, Index]:
    """An order in which the sides of one edge follow each other, and where the edges begin."""
    names = np.sort(names, axis=1)
    order = np.lexsort(names.T)
    is_first = np.ones(len(order), bool)
    is_first[1:] = (np.diff(names[order], axis=0) != 0).any(axis=1)
    return order, np.flatnonzero(is_first)


def _alone(names: Index) -> Index:
    """The sides that no other has the names of."""
    order, firsts = _grouped(names)
    counts = np.diff(np.append(firsts, len(order)))
    return order[firsts[counts == 1]]


def _named(points: NDArray[np.float32], ends: Int) -> tuple[Index, dict[int, list[int]]]:
    """Names for the ends of every side, the same for all sides of an edge.

    A side that has none beside it looks for others at its place, and if there is none, near it.
    """
    names = ends.astype(np.intp)
    single = _alone(names)
    places = _places(points, np.unique(names[single]))
    names[single] = len(points) + places[ends[single]]
    border = single[_alone(names[single])]
    twins = _twins(points, np.unique(places[ends[border]]))
    nearest = np.arange(len(points))
    for one, others in twins.items():
        nearest[one] = others[0]
    names[border] = 2 * len(points) + nearest[places[ends[border]]]
    return names, twins


def _places(points: NDArray[np.float32], which: Index) -> Index:
    """For every vertex the first of those, of some, at the same place."""
    # Both zeros are one place.
    at = points[which] + np.float32(0)
    order = np.lexsort(at.T)
    is_new = np.ones(len(order), bool)
    is_new[1:] = (np.diff(at[order], axis=0) != 0).any(axis=1)
    firsts = np.arange(len(points))
    firsts[which[order]] = which[order[is_new]][np.cumsum(is_new) - 1]
    return firsts


def _twins(points: NDArray[np.float32], which: Index) -> dict[int, list[int]]:
    """Of vertices at different places those that others are near, and all that are near them."""
    if len(which) == 0:
        return {}
    reach = _WELD * float(np.linalg.norm(np.ptp(points, axis=0)))
    tree = mathutils.kdtree.KDTree(len(which))
    for vertex in which.tolist():
        tree.insert(points[vertex], vertex)
    tree.balance()
    near = {v: sorted(i for _, i, _ in tree.find_range(points[v], reach)) for v in which.tolist()}
    return {vertex: others for vertex, others in near.items() if len(others) > 1}
