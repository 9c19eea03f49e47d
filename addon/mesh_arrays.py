# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays out of a Blender mesh and into a new one.

Only the attribute interface is used: it copies memory, where the older collections walk over
Python objects and take 30 to 200 times as long.
"""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from . import attributes
from .artist import cuts

Int = NDArray[np.int32]
Float = NDArray[np.float32]


@dataclass(frozen=True)
class MeshArrays:
    """What the core needs of a mesh."""

    positions: Float
    loop_start: Int
    corner_vert: Int
    material_index: Int | None
    marked_edges: Int | None = None


# The attributes of edges that hold the marks, and their types; borders are found.
_MARKS = {
    **{name: [] for name in cuts.BORDERS},
    "SHARP": [("sharp_edge", "BOOLEAN")],
    "CREASE": [("crease_edge", "FLOAT")],
    "SEAM": [(name, "BOOLEAN") for name in attributes.SEAMS],
}


# Settings of a mesh that tools read.
_SETTINGS = (
    "remesh_mode",
    "remesh_voxel_adaptivity",
    "remesh_voxel_size",
    "use_auto_texspace",
    "use_mirror_topology",
    "use_mirror_vertex_groups",
    "use_mirror_x",
    "use_mirror_y",
    "use_mirror_z",
    "use_remesh_fix_poles",
    "use_remesh_preserve_attributes",
    "use_remesh_preserve_volume",
)
_TEXTURE_SPACE = ("texspace_location", "texspace_size")


def read(mesh: bpy.types.Mesh, marks: Iterable[str] = ()) -> MeshArrays:
    """Copies the arrays of a mesh that is not in edit mode, and the edges with any of the marks."""
    return MeshArrays(
        attributes.positions(mesh),
        attributes.loop_starts(mesh),
        attributes.corner_verts(mesh),
        attributes.values(mesh, "material_index", "FACE", "INT"),
        _marked(mesh, marks),
    )


def _marked(mesh: bpy.types.Mesh, marks: Iterable[str]) -> Int | None:
    marks = set(marks)
    found = np.zeros(len(mesh.edges), bool)
    for name, kind in (each for mark in marks for each in _MARKS[mark]):
        values = attributes.values(mesh, name, "EDGE", kind)
        if values is not None:
            found |= values > 0
    ends = attributes.edge_verts(mesh)[found]
    ends = np.concatenate([ends, cuts.of_borders(mesh, marks & cuts.BORDERS.keys())])
    return ends if len(ends) else None


def write(arrays: MeshArrays | orbflow_native.Remeshed, like: bpy.types.Mesh) -> bpy.types.Mesh:
    """Makes a new mesh of arrays, with the materials, properties and settings of `like`."""
    mesh = bpy.data.meshes.new(like.name)
    mesh.vertices.add(len(arrays.positions))
    mesh.loops.add(len(arrays.corner_vert))
    mesh.polygons.add(len(arrays.loop_start))
    mesh.polygons.foreach_set("loop_start", arrays.loop_start)
    mesh.attributes[".corner_vert"].data.foreach_set("value", arrays.corner_vert)
    mesh.attributes["position"].data.foreach_set("vector", arrays.positions.ravel())
    if arrays.material_index is not None:
        attribute = mesh.attributes.new("material_index", "INT", "FACE")
        attribute.data.foreach_set("value", arrays.material_index)
    mesh.update(calc_edges=True)
    for material in like.materials:
        mesh.materials.append(material)
    for key, value in like.items():
        mesh[key] = value
        # Some kinds of properties have neither range nor tooltip.
        with suppress(TypeError):
            mesh.id_properties_ui(key).update_from(like.id_properties_ui(key))
    for name in _SETTINGS + (() if like.use_auto_texspace else _TEXTURE_SPACE):
        setattr(mesh, name, getattr(like, name))
    return mesh
