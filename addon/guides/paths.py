# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of a path of the mouse, and of a line beside a plane of symmetry: numbers alone."""

import numpy as np
from numpy.typing import NDArray

from .strokes import Points

# A line, and whether it is closed.
Line = tuple[Points, bool]

#: How far apart the points of a stroke are on the screen.
STEP_PX = 6.0
# A path that ends so near its start is closed, once it is some times as long.
_CLOSE_PX = 14.0
_LEAST_ROUND = 4.0
# How often a path is smoothed: a hand that shakes moves by a step or two.
_N_SMOOTH = 4


def even(path: NDArray[np.float64], step: float = STEP_PX) -> NDArray[np.float64]:
    """The same path with points at even distances, (N, 2)."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.append(0.0, np.cumsum(lengths))
    if along[-1] == 0:
        return path[:1]
    wanted = np.linspace(0.0, along[-1], max(2, round(along[-1] / step) + 1))
    return np.stack([np.interp(wanted, along, axis) for axis in path.T], axis=1)


def drawn(path: NDArray[np.float64]) -> Line:
    """A path of the mouse as a smooth line with even points; closed where it ends at its start.

    A closed one does not repeat its first point.
    """
    points = even(path)
    is_closed = len(points) * STEP_PX > _LEAST_ROUND * _CLOSE_PX and bool(
        np.linalg.norm(points[-1] - points[0]) <= _CLOSE_PX
    )
    if is_closed:
        points = even(np.concatenate([points, points[:1]]))[:-1]
    for _ in range(_N_SMOOTH):
        before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
        smooth = (before + 2 * points + after) / 4
        if not is_closed:
            smooth[[0, -1]] = points[[0, -1]]
        points = smooth
    return points, is_closed


def mirrored(line: Line, axis: int, reach: float) -> list[Line]:
    """A line with its image across a plane through the origin.

    Ends within `reach` of the plane go onto it and join the image. What runs across has no image.
    """
    points, is_closed = line
    sides = points[:, axis]
    if sides.min() < -reach and sides.max() > reach:
        return [line]
    points = points.copy()
    first, last = (not is_closed and abs(float(sides[end])) <= reach for end in (0, -1))
    for end, is_near in ((0, first), (-1, last)):
        if is_near:
            points[end, axis] = 0.0
    image = points.copy()
    image[:, axis] *= -1
    if first and last:
        return [(np.concatenate([points, image[-2:0:-1]]), True)]
    if first:
        return [(np.concatenate([image[:0:-1], points]), False)]
    if last:
        return [(np.concatenate([points, image[-2::-1]]), False)]
    return [(points, is_closed), (image, is_closed)]


def distance(point: NDArray[np.float64], line: NDArray[np.float64]) -> float:
    """How far a point is from a line through points, in any number of dimensions."""
    if len(line) == 1:
        return float(np.linalg.norm(line[0] - point))
    starts, along = line[:-1], np.diff(line, axis=0)
    squares = np.maximum((along**2).sum(axis=1), 1e-30)
    shares = (((point - starts) * along).sum(axis=1) / squares).clip(0, 1)
    return float(np.linalg.norm(starts + shares[:, None] * along - point, axis=1).min())
