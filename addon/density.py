# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the artist wants smaller quads: a vertex group or a colour attribute."""

import bpy
import numpy as np
from numpy.typing import NDArray

from . import attributes
from .artist.groups import Group
from .translations import rpt_

#: The vertex group that is painted where none is named.
DEFAULT = "Density"
# How bright a colour is, as Blender itself turns colours into numbers.
_BRIGHTNESS = np.array((0.2126, 0.7152, 0.0722), np.float32)


class NoSuchName(Exception):
    """An object has neither a vertex group nor a colour attribute of a name."""


def names(thing: bpy.types.Object | None) -> list[tuple[str, str]]:
    """The names that an object offers, each with what it is."""
    if thing is None or thing.type != "MESH":
        return []
    groups = [(group.name, "Vertex Group") for group in thing.vertex_groups]
    return groups + [(each.name, "Color Attribute") for each in thing.data.color_attributes]


def read(thing: bpy.types.Object, name: str, groups: list[Group]) -> NDArray[np.float32] | None:
    """The density at every vertex of an object, from 0 to 1; none where no name is given.

    A vertex group, of those given, gives its weights, a colour its brightness. Raises `NoSuchName`.
    """
    if not name:
        return None
    for group in groups:
        if group.name == name:
            return group.weights
    if (attribute := thing.data.color_attributes.get(name)) is not None:
        return _brightness(thing.data, attribute)
    offered = ", ".join(each for each, _ in names(thing)) or rpt_("none")
    told = rpt_("no vertex group or color attribute is named '{}'; there are: {}")
    raise NoSuchName(told.format(name, offered))


def _brightness(mesh: bpy.types.Mesh, attribute: bpy.types.Attribute) -> NDArray[np.float32]:
    colours = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color", colours)
    # Colours may be brighter than white; that asks for no more than white does.
    bright = (colours.reshape(-1, 4)[:, :3] @ _BRIGHTNESS).clip(0, 1)
    if attribute.domain == "POINT":
        return bright
    corners = attributes.corner_verts(mesh)
    n_vertices = len(mesh.vertices)
    sums = np.bincount(corners, bright, n_vertices)
    counts = np.bincount(corners, minlength=n_vertices)
    return (sums / np.maximum(counts, 1)).astype(np.float32)
