# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a mesh's own attributes, copied as arrays."""

import bpy
import numpy as np
from numpy.typing import NDArray

#: What Blender calls the attribute of seams: now, and in 4.2.
SEAMS = ("uv_seam", ".uv_seam")
#: What it calls the attribute of face sets.
FACE_SETS = ".sculpt_face_set"
_NUMBERS = {"BOOLEAN": np.bool_, "FLOAT": np.float32, "INT": np.int32}


def positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """The position of every vertex, (V, 3)."""
    return _read(mesh, "position", "vector", (len(mesh.vertices), 3), np.float32)


def edge_verts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """The vertices of every edge, (E, 2)."""
    return _read(mesh, ".edge_verts", "value", (len(mesh.edges), 2), np.int32)


def corner_verts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """The vertex of every corner, (L,)."""
    return _read(mesh, ".corner_vert", "value", (len(mesh.loops),), np.int32)


def corner_edges(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """The edge from every corner to the next one of its face, (L,)."""
    return _read(mesh, ".corner_edge", "value", (len(mesh.loops),), np.int32)


def loop_starts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """The first corner of every face, (F,)."""
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return starts


def values(mesh: bpy.types.Mesh, name: str, domain: str, kind: str) -> NDArray | None:
    """The values of an attribute of a domain and type; none where the mesh has none such."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.domain, attribute.data_type) != (domain, kind):
        return None
    found = np.empty(len(attribute.data), _NUMBERS[kind])
    attribute.data.foreach_get("value", found)
    return found if len(found) else None


def corners_ahead(starts: NDArray[np.integer], n_corners: int) -> NDArray[np.intp]:
    """The corner that follows each in its face, whose corners start at these, (L,)."""
    ahead = np.arange(1, n_corners + 1)
    # The last corner of a face is followed by its first.
    ahead[np.append(starts, n_corners)[1:] - 1] = starts
    return ahead


def edge_keys(ends: NDArray[np.integer]) -> NDArray[np.int64]:
    """One number for every pair of vertices, whichever comes first, (N,) of (N, 2)."""
    low, high = np.sort(ends, axis=1).astype(np.int64).T
    return (low << 32) + high


def _read(
    mesh: bpy.types.Mesh, name: str, field: str, shape: tuple[int, ...], kind: type
) -> NDArray:
    values = np.empty(shape, kind)
    # A mesh without elements may not have the attribute.
    if values.size:
        mesh.attributes[name].data.foreach_get(field, values.ravel())
    return values
