# SPDX-License-Identifier: GPL-3.0-or-later
"""How many faces an object gets, where the artist says it by a share or by the length of edges."""

import math
from typing import TYPE_CHECKING

import numpy as np
import orbflow_native

from . import attributes

if TYPE_CHECKING:
    from .mesh_arrays import MeshArrays
    from .regions import Flags
    from .settings import Settings


def n_faces(
    wanted: "Settings",
    arrays: "MeshArrays",
    scale: tuple[float, float, float],
    kept: "Flags | None" = None,
    *,
    is_editing: bool = False,
) -> int:
    """The number of faces for a mesh seen at a scale, within what the core takes.

    Those that are kept are counted: a share and a length are of the others, and so is a number in
    edit mode.
    """
    n_kept = 0 if kept is None else int(kept.sum())
    if wanted.size == "RATIO":
        n = (len(arrays.loop_start) - n_kept) * wanted.ratio / 100
    elif wanted.size == "EDGE":
        corners = 4 if wanted.kind == "QUADS" else 3
        n = area(arrays, scale, kept) / _area_of_one(corners, wanted.edge_length)
    elif is_editing:
        n = wanted.faces
    else:
        return wanted.faces
    n = max(round(n), orbflow_native.MIN_FACES) + n_kept
    return int(min(n, orbflow_native.MAX_FACES))


def area(
    arrays: "MeshArrays", scale: tuple[float, float, float], kept: "Flags | None" = None
) -> float:
    """The area of a mesh seen at a scale, but for faces that are kept, in square units."""
    corners = arrays.corner_vert
    if not len(corners):
        return 0.0
    positions = np.asarray(arrays.positions, np.float64) * scale
    ahead = attributes.corners_ahead(arrays.loop_start, len(corners))
    first = positions[corners[arrays.loop_start]]
    sizes = np.diff(np.append(arrays.loop_start, len(corners)))
    # Seen from a corner of its own a face is made of triangles.
    arms = positions[corners] - np.repeat(first, sizes, axis=0)
    doubled = np.add.reduceat(np.cross(arms, arms[ahead]), arrays.loop_start, axis=0)
    areas = np.linalg.norm(doubled, axis=1)
    return float((areas if kept is None else areas[~kept]).sum() / 2)


def _area_of_one(corners: int, edge: float) -> float:
    """The area of a regular polygon by its edge."""
    return corners * edge**2 / (4 * math.tan(math.pi / corners))
