# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of a mesh that are left as they are: those of a group or face set, or not selected."""

import bpy
import numpy as np
from numpy.typing import NDArray

from . import attributes
from .artist.groups import Group
from .translations import rpt_

Flags = NDArray[np.bool_]

# A vertex with at least this weight is in a group: paint fades out towards the border of one.
_INSIDE = 0.5
_FACE_SET = "Face Set "
_SELECTED = ".select_poly"


class NoRegion(Exception):
    """An object has nothing of a name that faces could be in, or no face is selected."""


def names(thing: bpy.types.Object | None) -> list[tuple[str, str]]:
    """The names that an object offers, each with what it is."""
    if thing is None or thing.type != "MESH":
        return []
    sets = attributes.values(thing.data, attributes.FACE_SETS, "FACE", "INT")
    numbers = [] if sets is None else np.unique(sets).tolist()
    return [
        *((group.name, "Vertex Group") for group in thing.vertex_groups),
        *((f"{_FACE_SET}{number}", "Face Set") for number in numbers),
        *((each.name, "Face Attribute") for each in thing.data.attributes if _is_region(each)),
    ]


def kept(thing: bpy.types.Object, name: str, groups: list[Group]) -> Flags | None:
    """Which faces of an object are left as they are; none where no name is given.

    Of a vertex group, of those given, faces all of whose vertices are in it. Raises `NoRegion`.
    """
    if not name:
        return None
    for group in groups:
        if group.name == name:
            is_in = group.weights >= _INSIDE
            corners = is_in[attributes.corner_verts(thing.data)]
            return np.logical_and.reduceat(corners, attributes.loop_starts(thing.data))
    if name in {each for each, _ in names(thing)}:
        return _of_faces(thing.data, name)
    offered = ", ".join(each for each, _ in names(thing)) or rpt_("none")
    told = rpt_("no vertex group, face set or face attribute is named '{}'; there are: {}")
    raise NoRegion(told.format(name, offered))


def unselected(mesh: bpy.types.Mesh) -> Flags:
    """Which faces are not selected; raises `NoRegion` where all are."""
    chosen = attributes.values(mesh, _SELECTED, "FACE", "BOOLEAN")
    if chosen is None or not chosen.any():
        raise NoRegion(rpt_("no face is selected: in edit mode the selected ones are remeshed"))
    return ~chosen


def select_others(mesh: bpy.types.Mesh, n_kept: int) -> None:
    """Selects all faces but the last ones, and their edges and vertices."""
    n = len(mesh.polygons) - n_kept
    faces = np.arange(len(mesh.polygons)) < n
    end = attributes.loop_starts(mesh)[n] if n_kept else len(mesh.loops)
    edges, vertices = np.zeros(len(mesh.edges), bool), np.zeros(len(mesh.vertices), bool)
    edges[attributes.corner_edges(mesh)[:end]] = True
    vertices[attributes.corner_verts(mesh)[:end]] = True
    for held, flags in ((mesh.polygons, faces), (mesh.edges, edges), (mesh.vertices, vertices)):
        held.foreach_set("select", flags)


def _is_region(attribute: bpy.types.Attribute) -> bool:
    is_own = attribute.name.startswith(".") or attribute.name in {"material_index", "sharp_face"}
    return attribute.domain == "FACE" and attribute.data_type in {"BOOLEAN", "INT"} and not is_own


def _of_faces(mesh: bpy.types.Mesh, name: str) -> Flags:
    number = name.removeprefix(_FACE_SET)
    if name not in mesh.attributes and name != number:
        sets = attributes.values(mesh, attributes.FACE_SETS, "FACE", "INT")
        return _nothing(mesh) if sets is None else sets == int(number)
    attribute = mesh.attributes[name]
    values = attributes.values(mesh, name, "FACE", attribute.data_type)
    return _nothing(mesh) if values is None else values > 0


def _nothing(mesh: bpy.types.Mesh) -> Flags:
    return np.zeros(len(mesh.polygons), bool)
