# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes as numbers: chains of edges, ends that meet, and what names say of their strength."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

# The ends of a stroke that are no farther apart than this share of its length meet: below, rings
# that are drawn by hand stay open; above, hooks and horseshoes are closed.
_MEET = 0.02
_EXACT, _FOLLOW = "exact", "follow"


@dataclass(frozen=True)
class Stroke:
    """A line that the artist has drawn, in the space of the scene or of an object."""

    points: Points
    is_closed: bool
    is_exact: bool
    #: What it is called where it is told of.
    name: str
    #: The mesh object that it guides and no other, by its name; none where it guides any.
    owner: str | None = None

    def key(self) -> tuple[bytes, bool, bool]:
        """What is equal for strokes that guide alike."""
        return self.points.tobytes(), self.is_closed, self.is_exact


def is_exact(names: Iterable[str], otherwise: bool) -> bool:
    """Whether edges have to lie on a stroke exactly: the first name that says so decides."""
    for name in names:
        if name.lower().startswith(_EXACT):
            return True
        if name.lower().startswith(_FOLLOW):
            return False
    return otherwise


def moved(points: Points, matrix: Points) -> Points:
    """Points by a matrix of 4 × 4."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def tidied(points: Points, is_closed: bool) -> tuple[Points, bool] | None:
    """A stroke without points upon the one before, closed where its ends meet; none if it is none.

    A closed one does not repeat its first point.
    """
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) < 2:
        return None
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.append(True, steps > 0)]
    gap = float(np.linalg.norm(points[-1] - points[0]))
    if len(points) > 3 and gap <= _MEET * steps.sum():
        is_closed = True
        points = points[:-1] if gap == 0 else points
    if len(points) < 2:
        return None
    return points, is_closed and len(points) > 2


def chains(edges: NDArray[np.integer]) -> Iterator[tuple[list[int], bool]]:
    """The vertices of lines that edges (E, 2) make, in order, and whether each line is closed.

    Where more than two edges meet lines end.
    """
    near: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    left = {(min(a, b), max(a, b)) for a, b in edges.tolist() if a != b}
    ends = [vertex for vertex, others in near.items() if len(others) != 2]
    for start in [*ends, *near]:
        for ahead in near[start]:
            if (min(start, ahead), max(start, ahead)) in left:
                chain = _walk(start, ahead, near, left)
                is_closed = chain[0] == chain[-1]
                yield chain[:-1] if is_closed else chain, is_closed


def _walk(
    start: int, ahead: int, near: dict[int, list[int]], left: set[tuple[int, int]]
) -> list[int]:
    """Goes from a vertex over one beside it as long as the way is clear; takes the edges."""
    chain = [start]
    while True:
        left.discard((min(chain[-1], ahead), max(chain[-1], ahead)))
        chain.append(ahead)
        if ahead == start or len(near[ahead]) != 2:
            return chain
        one, other = near[ahead]
        ahead = other if one == chain[-2] else one
