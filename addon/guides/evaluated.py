# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of Grease Pencil and of hair as they are seen, from their control points.

Blender gives their points alone to Python. This is what it draws of them: Catmull and Rom's,
Bezier's and rational B-splines at their resolution, on the same places.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .strokes import Points

# Blender's numbers of types.
CATMULL_ROM, POLY, BEZIER, NURBS = range(4)
# Its modes of knots: at end points, and as pieces of Bezier's.
_ENDPOINT, _BEZIER = (1, 3), (2, 3)


@dataclass(frozen=True)
class Curve:
    """One curve: control points, and what Blender keeps beside them."""

    points: Points
    is_closed: bool
    kind: int
    #: Into how many pieces each segment is cut.
    resolution: int = 12
    #: Bezier: the handles on the left and on the right of each point.
    handles: tuple[Points, Points] | None = None
    #: NURBS: its order, how its knots lie, and the weights of points.
    order: int = 4
    knots: int = 0
    weights: Points | None = None


def line(curve: Curve) -> Points:
    """The points of a curve as it is drawn."""
    if len(curve.points) < 2 or curve.resolution < 1:
        return curve.points
    if curve.kind == BEZIER and curve.handles is not None:
        return _bezier(curve, *curve.handles)
    if curve.kind == CATMULL_ROM:
        return _catmull_rom(curve)
    if curve.kind == NURBS and len(curve.points) >= curve.order >= 2:
        return _nurbs(curve)
    return curve.points


def _shares(curve: Curve) -> NDArray[np.float64]:
    """Where a segment is cut, (R, 1), without its end."""
    return (np.arange(curve.resolution) / curve.resolution)[:, None]


def _joined(curve: Curve, segments: NDArray[np.float64]) -> Points:
    """The points of all segments, (S, R, 3), as a line; one that is open has its end, too."""
    points = segments.reshape(-1, 3)
    return points if curve.is_closed else np.concatenate([points, curve.points[-1:]])


def _bezier(curve: Curve, left: Points, right: Points) -> Points:
    n = len(curve.points) if curve.is_closed else len(curve.points) - 1
    t = _shares(curve)
    corners = (
        curve.points[:n],
        right[:n],
        np.roll(left, -1, axis=0)[:n],
        np.roll(curve.points, -1, axis=0)[:n],
    )
    shares = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3)
    return _joined(curve, _mixed(corners, shares))


def _catmull_rom(curve: Curve) -> Points:
    points = curve.points
    ends = (points[-1:], points[:2]) if curve.is_closed else (points[:1], points[-1:])
    given = np.concatenate([ends[0], points, ends[1]])
    n = len(given) - 3
    t = _shares(curve)
    s = 1 - t
    shares = (
        -0.5 * t * s**2,
        1 + 0.5 * t**2 * (3 * t - 5),
        1 + 0.5 * s**2 * (3 * s - 5),
        -0.5 * s * t**2,
    )
    return _joined(curve, _mixed([given[i : i + n] for i in range(4)], shares))


def _mixed(corners: "list[Points] | tuple[Points, ...]", shares: tuple) -> NDArray[np.float64]:
    """Points of segments (S, R, 3) from their corners, by the shares (R, 1) that these have."""
    pairs = zip(shares, corners, strict=True)
    return np.sum([share * each[:, None] for share, each in pairs], axis=0)


def _nurbs(curve: Curve) -> Points:
    n, order = len(curve.points), curve.order
    knots = knots_of(n, order, curve.knots, curve.is_closed)
    n_segments = n if curve.is_closed else n - 1
    n_made = n_segments * curve.resolution
    start, end = knots[order - 1], knots[n + order - 1 if curve.is_closed else n]
    cuts = n_made if curve.is_closed else n_made - 1
    shares = _basis(knots, order, start + (end - start) * np.arange(n_made) / cuts, end)
    weights = np.ones(n) if curve.weights is None else curve.weights
    around = np.arange(shares.shape[1]) % n
    mixed = shares * weights[around]
    return (mixed @ curve.points[around]) / mixed.sum(axis=1, keepdims=True)


def knots_of(n: int, order: int, mode: int, is_closed: bool) -> NDArray[np.float64]:
    """The knots of a B-spline as Blender lays them."""
    repeat = order - 1 if mode in _BEZIER else 1
    head = order - is_closed if mode in _ENDPOINT else min(2, repeat)
    tail = 2 * order - 1 if is_closed else order * (mode in _ENDPOINT)
    size = n + 2 * order - 1 if is_closed else n + order
    knots = np.zeros(size)
    first = int(mode in _ENDPOINT and is_closed)
    current, left = float(first), head
    for i in range(first, size - tail):
        knots[i] = current
        left -= 1
        if left == 0:
            current, left = current + 1, repeat
    # The widths of the first knots again: those may be some of the last ones themselves.
    for i in range(tail):
        knots[size - tail + i] = current + knots[i] - knots[0]
    return knots


def _basis(knots: Points, order: int, at: Points, end: float) -> NDArray[np.float64]:
    """The share of every control point at every place, (P, N), by Cox and de Boor."""
    at = at[:, None]
    spans = (knots[:-1] <= at) & (at < knots[1:])
    # The end belongs to the last span that is not empty.
    is_end = (at >= end)[:, 0]
    spans[is_end] = False
    spans[is_end, np.searchsorted(knots, end) - 1] = True
    shares = spans.astype(np.float64)
    for degree in range(1, order):
        n = len(knots) - 1 - degree
        first, last = knots[:n], knots[degree + 1 : degree + 1 + n]
        rise, fall = knots[degree : degree + n] - first, last - knots[1 : 1 + n]
        with np.errstate(divide="ignore", invalid="ignore"):
            up = np.where(rise > 0, (at - first) / rise, 0.0)
            down = np.where(fall > 0, (last - at) / fall, 0.0)
        shares = up * shares[:, :n] + down * shares[:, 1 : 1 + n]
    return shares
