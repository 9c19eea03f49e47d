# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes of curve objects, hair curves and meshes that are edges alone, as they are seen."""

from collections.abc import Iterator
from itertools import pairwise

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import attributes
from . import strokes
from .strokes import Points

# A line, and whether it is closed.
Line = tuple[Points, bool]


def is_edges(thing: bpy.types.Object) -> bool:
    """Whether an object is a mesh without faces."""
    return thing.type == "MESH" and not thing.data.polygons and len(thing.data.edges) > 0


def of_mesh(seen: bpy.types.Object) -> list[Line]:
    """The lines of the edges of an evaluated object that belong to no face."""
    mesh = seen.to_mesh()
    try:
        points = attributes.positions(mesh).astype(np.float64)
        edges = attributes.edge_verts(mesh)
        is_loose = np.ones(len(edges), bool)
        is_loose[attributes.corner_edges(mesh)] = False
        # Splines are in the order of their vertices.
        found = sorted(strokes.chains(edges[is_loose]), key=lambda each: min(each[0]))
    finally:
        seen.to_mesh_clear()
    return [(points[chain], is_closed) for chain, is_closed in found]


def of_layout(offsets: NDArray[np.int32], layers: bpy.types.bpy_prop_collection) -> Iterator[Line]:
    """The lines of hair curves or of a drawing, whose points begin at these."""
    if len(offsets) < 2:
        return
    points = np.empty((int(offsets[-1]), 3), np.float32)
    layers["position"].data.foreach_get("vector", points.ravel())
    closed = of_curves(layers, "cyclic", len(offsets) - 1)
    for i, (first, end) in enumerate(pairwise(offsets)):
        yield points[first:end].astype(np.float64), bool(closed[i])


def of_curves(
    layers: bpy.types.bpy_prop_collection, name: str, n: int
) -> NDArray[np.int32] | NDArray[np.bool_]:
    """An attribute of curves; 0 where there is none such."""
    attribute = layers.get(name)
    found = np.zeros(n, bool if name == "cyclic" else np.int32)
    if attribute is not None:
        attribute.data.foreach_get("value", found)
    return found


def offsets(starts: bpy.types.bpy_prop_collection) -> NDArray[np.int32]:
    """Where the points of curves begin, and where the last ones end."""
    found = np.empty(len(starts), np.int32)
    starts.foreach_get("value", found)
    return found


class Bare:
    """Copies of curve objects that are lines alone, whatever thickness they have been given."""

    def __init__(self, context: bpy.types.Context) -> None:
        """Copies none."""
        self._context = context
        self._made: list[bpy.types.Object] = []

    def copy(self, thing: bpy.types.Object, kept: list[int]) -> bpy.types.Object:
        """A copy with some of the splines, in the scene, so that it can be evaluated."""
        made = thing.copy()
        made.data = data = thing.data.copy()
        self._made.append(made)
        for each in (made, data):
            each.animation_data_clear()
        data.bevel_mode, data.bevel_object, data.taper_object = "ROUND", None, None
        data.bevel_depth = data.extrude = data.offset = 0.0
        # Flat ones are filled.
        data.dimensions = "3D"
        splines = list(data.splines)
        for i in set(range(len(splines))) - set(kept):
            data.splines.remove(splines[i])
        self._context.scene.collection.objects.link(made)
        return made

    def remove(self) -> None:
        """Removes the copies."""
        for each in self._made:
            data = each.data
            bpy.data.objects.remove(each)
            bpy.data.curves.remove(data)
        if self._made:
            self._context.view_layer.update()
