# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist has left on edges: sharp, crease, seam, bevel weight, attributes."""

from dataclasses import dataclass

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from ..attributes import corner_edges, edge_keys, edge_verts
from . import cuts, layers
from .layers import Layer

Int = NDArray[np.int32]


@dataclass(frozen=True)
class Edges:
    """The edges on which something is left, and what."""

    ends: Int
    layers: list[Layer]


def read(mesh: bpy.types.Mesh) -> Edges | None:
    """Reads what is left on edges; none where nothing is."""
    found = _with_creases(mesh, list(layers.read(mesh, "EDGE")))
    is_left = np.zeros(len(mesh.edges), bool)
    for layer in found:
        is_left |= layer.values.any(axis=1)
    if not is_left.any():
        return None
    (rows,) = is_left.nonzero()
    return Edges(edge_verts(mesh)[rows], [layer.taken(rows) for layer in found])


def write(mesh: bpy.types.Mesh, edges: Edges, result: orbflow_native.Remeshed) -> None:
    """Leaves the same on the edges of a new mesh that lie on these."""
    rows = _find(mesh, result.carried_edges)
    for layer in edges.layers:
        values = np.zeros((len(mesh.edges), layer.values.shape[1]), layer.values.dtype)
        values[rows] = layer.values[result.carried_from]
        if values.any():
            Layer(layer.name, layer.kind, values).write(mesh, "EDGE")


def n_loose(mesh: bpy.types.Mesh) -> int:
    """How many edges of a mesh belong to no face."""
    return len(mesh.edges) - len(np.unique(corner_edges(mesh)))


def _with_creases(mesh: bpy.types.Mesh, found: list[Layer]) -> list[Layer]:
    """The layers of edges, with those sharp at which the artist's normals break."""
    sharp = cuts.creases(mesh)[:, None]
    if not sharp.any():
        return found
    for layer in found:
        if layer.name == "sharp_edge":
            sharp = sharp | layer.values
    others = [layer for layer in found if layer.name != "sharp_edge"]
    return [*others, Layer("sharp_edge", "BOOLEAN", sharp)]


def _find(mesh: bpy.types.Mesh, ends: Int) -> NDArray[np.intp]:
    """Which edges of a mesh have these ends."""
    own = edge_keys(edge_verts(mesh))
    order = np.argsort(own)
    return order[np.searchsorted(own, edge_keys(ends), sorter=order)]
