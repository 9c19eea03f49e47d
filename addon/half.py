# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of a symmetric result, which a Mirror modifier that stays makes whole again."""

from dataclasses import dataclass
from typing import cast

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from . import attributes
from .translations import rpt_

Int = NDArray[np.int32]
Float = NDArray[np.float32]


@dataclass(frozen=True)
class Half:
    """Which half of a result stays."""

    #: The modifier that makes it whole.
    modifier: str
    axis: int
    #: The side of the plane, 1 or -1.
    side: int


class NoHalf(Exception):
    """There is no half that a Mirror modifier could make whole."""


@dataclass(frozen=True)
class _Origins:
    vertex_corners: Int
    vertex_weights: Float
    corner_corners: list[Int]
    corner_weights: list[Float]
    faces: Int


@dataclass(frozen=True)
class _Cut:
    positions: Float
    loop_start: Int
    corner_vert: Int
    material_index: Int | None
    carried_edges: Int
    carried_from: Int
    origins: _Origins | None
    crosses: Float


def of(thing: bpy.types.Object, names: tuple[str, ...]) -> Half | None:
    """The half that a Mirror modifier of these names makes whole; none where there is no such.

    Raises `NoHalf` where it mirrors otherwise than across one axis of the object.
    """
    mirrors = [thing.modifiers[each] for each in names if thing.modifiers[each].type == "MIRROR"]
    if not mirrors:
        return None
    axes = [(each, axis) for each in mirrors for axis in range(3) if each.use_axis[axis]]
    if len(axes) != 1 or axes[0][0].mirror_object:
        told = rpt_(
            "no half can be kept: modifier {} mirrors otherwise than across one axis of the object"
        )
        raise NoHalf(told.format(" + ".join(each.name for each in mirrors)))
    ((modifier, axis),) = axes
    if modifier.use_bisect_axis[axis]:
        return Half(modifier.name, axis, -1 if modifier.use_bisect_flip_axis[axis] else 1)
    middle = np.mean([vertex.co[axis] for vertex in thing.data.vertices] or [0])
    return Half(modifier.name, axis, 1 if middle >= 0 else -1)


def cut(result: orbflow_native.Remeshed, half: Half) -> orbflow_native.Remeshed:
    """One half of a result, with all but its report.

    Raises `NoHalf` where a face crosses the plane.
    """
    starts, corners = result.loop_start, result.corner_vert
    sides = half.side * result.positions[:, half.axis][corners]
    low, high = (each.reduceat(sides, starts) for each in (np.minimum, np.maximum))
    if (n_across := int(((low < 0) & (high > 0)).sum())) > 0:
        told = rpt_("no half can be kept: {:,} faces cross the plane, {}")
        raise NoHalf(told.format(n_across, _why(result)))
    is_kept = high > 0
    lengths = np.diff(np.append(starts, len(corners)))
    (loops,) = np.repeat(is_kept, lengths).nonzero()
    old, new = np.unique(corners[loops], return_inverse=True)
    number = np.full(len(result.positions), -1, np.int32)
    number[old] = np.arange(len(old))
    new = new.astype(np.int32)
    kept_lengths = lengths[is_kept]
    new_starts = (np.cumsum(kept_lengths) - kept_lengths).astype(np.int32)
    edges = number[result.carried_edges]
    is_there = _are_edges(edges, new, new_starts)
    material_index, origins = result.material_index, result.origins
    made = _Cut(
        result.positions[old],
        new_starts,
        new,
        None if material_index is None else material_index[is_kept],
        edges[is_there],
        result.carried_from[is_there],
        origins and _of_half(origins, old, loops, is_kept),
        result.crosses,
    )
    return cast("orbflow_native.Remeshed", made)


def _of_half(
    origins: orbflow_native.Origins,
    vertices: NDArray[np.integer],
    loops: NDArray[np.integer],
    is_kept: NDArray[np.bool_],
) -> _Origins:
    return _Origins(
        origins.vertex_corners[vertices],
        origins.vertex_weights[vertices],
        [each[loops] for each in origins.corner_corners],
        [each[loops] for each in origins.corner_weights],
        origins.faces[is_kept],
    )


def _are_edges(ends: Int, corners: Int, starts: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Which pairs of vertices are edges of faces."""
    ahead = attributes.corners_ahead(starts, len(corners))
    sides = np.stack([corners, corners[ahead]], axis=1)
    is_edge = np.isin(attributes.edge_keys(ends), attributes.edge_keys(sides))
    return is_edge & (ends >= 0).all(axis=1)


def _why(result: orbflow_native.Remeshed) -> str:
    """Why a result is not symmetric, where it says so."""
    told = [part["mirrored"] or {} for part in result.report["parts"]]
    return next(
        (each["reason"] for each in told if "reason" in each), rpt_("which is not its middle")
    )
