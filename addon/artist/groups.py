# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups: their names, their order and their weights."""

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from .layers import Mix

# A weight below this is none.
_LEAST = 1e-4


@dataclass(frozen=True)
class Group:
    """A vertex group and the weight of every vertex, 0 where it is not in the group."""

    name: str
    is_locked: bool
    is_active: bool
    weights: NDArray[np.float32]


def read(thing: bpy.types.Object) -> list[Group]:
    """Reads the groups of an object."""
    if not thing.vertex_groups:
        return []
    n = len(thing.data.vertices)
    weights = [np.zeros(n, np.float32) for _ in thing.vertex_groups]
    for i, vertex in enumerate(thing.data.vertices):
        for each in vertex.groups:
            # Blender tolerates weights of groups that do not exist.
            if each.group < len(weights):
                weights[each.group][i] = each.weight
    active = thing.vertex_groups.active_index
    return [
        Group(group.name, group.lock_weight, i == active, weights[i])
        for i, group in enumerate(thing.vertex_groups)
    ]


def write(thing: bpy.types.Object, groups: list[Group], mix: Mix) -> None:
    """Gives an object with a new mesh the same groups."""
    for given in groups:
        group = thing.vertex_groups.new(name=given.name)
        group.lock_weight = given.is_locked
        weights = mix.of(given.weights[:, None])[:, 0].clip(0, 1)
        (inside,) = (weights > _LEAST).nonzero()
        # One call for all vertices of one weight: most are 1.
        values, which = np.unique(weights[inside], return_inverse=True)
        order = np.argsort(which, kind="stable")
        bounds = np.searchsorted(which[order], np.arange(1, len(values)))
        for value, vertices in zip(values, np.split(inside[order], bounds), strict=False):
            group.add(vertices.tolist(), float(value), "REPLACE")
    for i, given in enumerate(groups):
        if given.is_active:
            thing.vertex_groups.active_index = i
