# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups: their names, their order and their weights."""

from dataclasses import dataclass, replace

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
    #: Whether bones move vertices by it: of these, engines take a few for each vertex.
    is_deforming: bool = False


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
    bones = _bones(thing)
    return [
        Group(group.name, group.lock_weight, i == active, weights[i], group.name in bones)
        for i, group in enumerate(thing.vertex_groups)
    ]


def write(thing: bpy.types.Object, groups: list[Group], mix: Mix, limit: int) -> None:
    """Gives an object with a new mesh the same groups.

    A vertex has no more weights of bones than `limit`; with 0, than one of the old mesh has at
    most. Where no bones move the object, a limit is one for all groups.
    """
    if limit and not any(each.is_deforming for each in groups):
        groups = [replace(each, is_deforming=True) for each in groups]
    mixed = [replace(each, weights=mix.of(each.weights[:, None])[:, 0]) for each in groups]
    for given in limited(mixed, limit or most(groups)):
        group = thing.vertex_groups.new(name=given.name)
        group.lock_weight = given.is_locked
        weights = given.weights.clip(0, 1)
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


def most(groups: list[Group]) -> int:
    """How many weights of bones a vertex has at most."""
    counts = sum((each.weights > _LEAST).astype(np.int32) for each in groups if each.is_deforming)
    return int(np.max(counts, initial=0))


def limited(groups: list[Group], limit: int) -> list[Group]:
    """The same with no more weights of bones at a vertex than `limit`: the largest.

    The sum of a vertex's weights of bones stays what it was. Other groups are left as they are.
    """
    (deforming,) = np.nonzero([each.is_deforming for each in groups])
    if not len(deforming) or limit < 1:
        return groups
    weights = np.stack([groups[i].weights for i in deforming], axis=1)
    kept = np.where(weights > _LEAST, weights, 0)
    if limit < len(deforming):
        # Of several that are equal the first groups are taken.
        order = np.argsort(-kept, axis=1, kind="stable")
        np.put_along_axis(kept, order[:, limit:], 0, axis=1)
    left = kept.sum(axis=1)
    scale = np.divide(weights.sum(axis=1), left, out=np.ones_like(left), where=left > 0)
    kept *= scale[:, None]
    result = list(groups)
    for column, i in enumerate(deforming):
        result[i] = replace(groups[i], weights=kept[:, column])
    return result


def _bones(thing: bpy.types.Object) -> set[str]:
    """The names of the bones that move an object by its groups."""
    rigs = [
        each.object
        for each in thing.modifiers
        if each.type == "ARMATURE" and each.object and each.use_vertex_groups
    ]
    if thing.parent and thing.parent_type == "ARMATURE":
        rigs.append(thing.parent)
    return {bone.name for rig in rigs for bone in rig.data.bones if bone.use_deform}
