# SPDX-License-Identifier: GPL-3.0-or-later
"""Custom normals: how smooth faces are lit where an artist, or a program, says it.

Each corner of the result has the normal that the original has at its place, on its side of a
break. Around a vertex the corners between two sharp edges have one normal, their mean: otherwise
Blender would mark more edges as sharp. Flat faces are lit as they lie.
"""

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import attributes
from .layers import Layer, Mix

#: What the layer of them is called among those of corners; no attribute can have this name.
NAME = ".orbflow_normals"
# The sum of normals that is no direction any more.
_LEAST = 1e-3

Floats = NDArray[np.float32]
Index = NDArray[np.intp]


def read(mesh: bpy.types.Mesh) -> Layer | None:
    """The normals of corners, 0 in flat faces; none where the artist has left none."""
    if not mesh.has_custom_normals or not len(mesh.loops):
        return None
    values = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", values.ravel())
    values[_is_flat(mesh)[_faces(mesh)]] = 0
    return Layer(NAME, "FLOAT_VECTOR", values) if values.any() else None


def write(mesh: bpy.types.Mesh, layer: Layer, mix: Mix) -> None:
    """Gives a mesh that has its sharp edges and flat faces the normals of corners."""
    mixed = mix.of(layer.values).astype(np.float64)
    mixed[_is_flat(mesh)[_faces(mesh)]] = 0
    fans = _fans(mesh)
    sums = np.stack([np.bincount(fans, axis, len(fans)) for axis in mixed.T], axis=1)[fans]
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    normals = np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > _LEAST)
    # Those that are 0 are what Blender makes them.
    mesh.normals_split_custom_set(normals.astype(np.float32))


def _is_flat(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    found = attributes.values(mesh, "sharp_face", "FACE", "BOOLEAN")
    return np.zeros(len(mesh.polygons), bool) if found is None else found


def _faces(mesh: bpy.types.Mesh) -> Index:
    """The face of every corner."""
    starts = attributes.loop_starts(mesh)
    return np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(mesh.loops))))


def _fans(mesh: bpy.types.Mesh) -> Index:
    """One number for all corners at a vertex that no sharp edge parts, that of one of them."""
    fans = np.arange(len(mesh.loops))
    one, other = _beside(mesh)
    while True:
        low = np.minimum(fans[one], fans[other])
        last = fans.copy()
        np.minimum.at(fans, one, low)
        np.minimum.at(fans, other, low)
        fans = fans[fans]
        if np.array_equal(fans, last):
            return fans


def _beside(mesh: bpy.types.Mesh) -> tuple[Index, Index]:
    """Pairs of corners at one vertex whose faces share an edge that is smooth."""
    edges, verts = attributes.corner_edges(mesh), attributes.corner_verts(mesh)
    ahead = attributes.corners_ahead(attributes.loop_starts(mesh), len(edges))
    is_hard = attributes.values(mesh, "sharp_edge", "EDGE", "BOOLEAN")
    is_hard = np.zeros(len(mesh.edges), bool) if is_hard is None else is_hard.copy()
    is_hard |= np.bincount(edges, minlength=len(is_hard)) != 2
    is_hard[edges[_is_flat(mesh)[_faces(mesh)]]] = True
    (sides,) = (~is_hard[edges]).nonzero()
    first, second = sides[np.argsort(edges[sides], kind="stable")].reshape(-1, 2).T
    # Two faces that look the same way run along their edge in opposite ones.
    turned = verts[first] == verts[ahead[second]]
    at_first = np.where(turned, ahead[second], second)
    at_second = np.where(turned, second, ahead[second])
    return np.concatenate([first, ahead[first]]), np.concatenate([at_first, at_second])
