# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes of curve objects, hair curves and meshes that are edges alone, as they are seen."""

from collections.abc import Iterator
from itertools import pairwise

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import attributes
from . import evaluated, strokes
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
    """The lines of hair curves or of a drawing, whose points begin at these, as they are seen."""
    n = len(offsets) - 1
    if n < 1:
        return
    points = _vectors(layers, "position", int(offsets[-1]))
    sides = [_vectors(layers, f"handle_{side}", len(points)) for side in ("left", "right")]
    weights = _numbers(layers, "nurbs_weight", len(points))
    closed = of_curves(layers, "cyclic", n)
    kinds = of_curves(layers, "curve_type", n, evaluated.CATMULL_ROM)
    resolutions, orders = (
        of_curves(layers, name, n, usual)
        for name, usual in (("resolution", 12), ("nurbs_order", 4))
    )
    knots = of_curves(layers, "knots_mode", n)
    for i, (first, end) in enumerate(pairwise(offsets)):
        some = slice(first, end)
        curve = evaluated.Curve(
            points[some],
            bool(closed[i]),
            int(kinds[i]),
            int(resolutions[i]),
            (sides[0][some], sides[1][some]),
            int(orders[i]),
            int(knots[i]),
            weights[some],
        )
        yield evaluated.line(curve), curve.is_closed


def _vectors(layers: bpy.types.bpy_prop_collection, name: str, n: int) -> Points:
    """An attribute of points; their places where there is none such."""
    found = np.empty((n, 3), np.float32)
    (layers.get(name) or layers["position"]).data.foreach_get("vector", found.ravel())
    return found.astype(np.float64)


def _numbers(layers: bpy.types.bpy_prop_collection, name: str, n: int) -> Points:
    """A number of points; 1 where there is none such."""
    found = np.ones(n, np.float32)
    if (attribute := layers.get(name)) is not None:
        attribute.data.foreach_get("value", found)
    return found.astype(np.float64)


def of_curves(
    layers: bpy.types.bpy_prop_collection, name: str, n: int, usual: int = 0
) -> NDArray[np.int32] | NDArray[np.bool_]:
    """An attribute of curves; what is usual where there is none such."""
    attribute = layers.get(name)
    found = np.full(n, usual, bool if name == "cyclic" else np.int32)
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
