# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist has left on an object, carried from its old mesh to its new one.

Each kind of data has a file of its own. All is read before the core runs and written after, by the
core's word on where every element of the result comes from. What stays with the object itself needs
no carrying: modifiers, constraints, parents, materials, custom properties.
"""

from dataclasses import dataclass

import bpy
import orbflow_native

from ..translations import n_, rpt_
from . import edges, elements, groups, keys, layers
from .edges import Edges
from .elements import Elements
from .groups import Group
from .keys import Key


@dataclass(frozen=True)
class Artist:
    """Data of an object by what it lies on."""

    edges: Edges | None
    elements: Elements
    groups: list[Group]
    keys: list[Key]
    #: How many bones move a vertex of the result at most; 0: as many as one of the old mesh.
    weights_limit: int
    #: What cannot be carried, in words.
    lost: list[str]


def read(things: list[bpy.types.Object], weights_limit: int = 0) -> Artist:
    """Reads what is on objects of one mesh that is not in edit mode."""
    mesh = things[0].data
    return Artist(
        edges.read(mesh),
        elements.read(mesh),
        groups.read(things[0]),
        keys.read(mesh),
        weights_limit,
        _lost(mesh) + [text for each in things for text in _unbound(each)],
    )


def write(
    thing: bpy.types.Object,
    artist: Artist,
    result: orbflow_native.Remeshed,
    old: bpy.types.Mesh,
) -> None:
    """Leaves the same on an object that has its new mesh; `old` is the one it had."""
    if artist.edges:
        edges.write(thing.data, artist.edges, result)
    mix = elements.write(thing.data, artist.elements, result)
    if mix is None:
        return
    groups.write(thing, artist.groups, mix, artist.weights_limit)
    keys.write(thing, artist.keys, mix, old)


def _lost(mesh: bpy.types.Mesh) -> list[str]:
    n_loose = edges.n_loose(mesh)
    one, many = n_("{:,} loose edge"), n_("{:,} loose edges")
    lost = [rpt_(many if n_loose > 1 else one).format(n_loose)] if n_loose else []
    told = rpt_("attribute {}")
    return lost + [told.format(each.name) for each in mesh.attributes if layers.is_lost(each)]


def _unbound(thing: bpy.types.Object) -> list[str]:
    bound = [
        rpt_("binding of modifier {}").format(each.name)
        for each in thing.modifiers
        if _is_bound(each)
    ]
    baked = [
        rpt_("bake of modifier {}").format(each.name) for each in thing.modifiers if _is_baked(each)
    ]
    return bound + baked


def _is_bound(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier knows the vertices of a mesh by their numbers."""
    if modifier.type == "HOOK":
        return len(modifier.vertex_indices) > 0
    if modifier.type in ("MESH_CACHE", "MESH_SEQUENCE_CACHE"):
        return True
    return any(getattr(modifier, name, False) for name in ("is_bound", "is_bind"))


def _is_baked(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier keeps what was simulated or combed of a mesh that will be gone."""
    if modifier.type == "PARTICLE_SYSTEM":
        system = modifier.particle_system
        return system.is_edited or system.point_cache.is_baked
    return getattr(getattr(modifier, "point_cache", None), "is_baked", False)
