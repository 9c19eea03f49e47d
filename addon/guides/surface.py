# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of an object as it is seen, on which guides are drawn; in its own space."""

from itertools import pairwise

import bpy
import numpy as np
from mathutils import Vector

from .paths import Line, mirrored
from .strokes import Points

# A way from point to point that is so many times as long as most, and longer than this share of the
# object, may go from an arm to what is seen behind it, or down a slope. It is a slope where all of
# it is nearer to the surface than this share of its length. Shorter ones cut across sharp edges,
# where they are a third of it off, or go over a ridge to what it hides, where the stroke goes on.
_LONG = 4.0
_LEAST_GAP = 0.04
_OFF = 0.15
_LOOKED_AT = (0.25, 0.5, 0.75)
# Lines that are shorter than this share of the object are left out beside longer ones: crumbs that
# a gap leaves.
_CRUMB = 0.01
# So near a plane of symmetry an end is on it, as a share of the object's size.
_ON_PLANE = 0.02


class Surface:
    """An object's surface, modifiers included."""

    def __init__(self, context: bpy.types.Context, thing: bpy.types.Object) -> None:
        """Evaluates the object."""
        self.thing = thing
        self._seen = thing.evaluated_get(context.evaluated_depsgraph_get())
        box = np.array(thing.bound_box)
        self.size = float(np.linalg.norm(np.ptp(box, axis=0)))

    def hit(self, origin: Vector, direction: Vector) -> Vector | None:
        """Where a ray of the scene meets the surface first; none where it does not."""
        inverse = self.thing.matrix_world.inverted_safe()
        start, ahead = inverse @ origin, inverse.to_3x3() @ direction
        is_hit, place, _, _ = self._seen.ray_cast(start, ahead)
        return place if is_hit else None

    def nearest(self, place: Vector) -> Vector:
        """The point of the surface that is nearest to a place."""
        is_found, found, _, _ = self._seen.closest_point_on_mesh(place)
        return found if is_found else place

    def lines(self, places: list[Vector | None], is_closed: bool) -> list[Line]:
        """The lines that lie on the surface of a row of places on it, with gaps where none is.

        A closed row is one closed line, or none of its lines is closed.
        """
        steps = [(b - a).length for a, b in pairwise(places) if a and b]
        long = max(_LONG * float(np.median(steps or [0.0])), _LEAST_GAP * self.size)
        runs: list[list[Vector]] = [[]]
        for place in places:
            if place is None or (runs[-1] and not self._holds(runs[-1][-1], place, long)):
                runs.append([])
            if place is not None:
                runs[-1].append(place)
        first = runs[0]
        is_whole = len(runs) == 1 and len(first) > 2 and self._holds(first[-1], first[0], long)
        lines = [np.array(run, np.float64) for run in runs if len(run) > 1]
        some = [line for line in lines if _length(line) > _CRUMB * self.size]
        return [(line, is_closed and is_whole) for line in some or lines]

    def snapped(self, points: Points) -> Points:
        """The same points on the surface."""
        return np.array([self.nearest(Vector(point)) for point in points], np.float64)

    def with_images(self, lines: list[Line]) -> list[Line]:
        """The same lines, with their images across the planes of the mesh's symmetry."""
        mesh = self.thing.data
        axes = (mesh.use_mirror_x, mesh.use_mirror_y, mesh.use_mirror_z)
        for axis in (i for i, is_on in enumerate(axes) if is_on):
            reach = _ON_PLANE * self.size
            lines = [image for line in lines for image in mirrored(line, axis, reach)]
        if not any(axes):
            return lines
        return [(self.snapped(points), is_closed) for points, is_closed in lines]

    def _holds(self, one: Vector, other: Vector, long: float) -> bool:
        """Whether the way between two points is on the surface."""
        length = (other - one).length
        if length <= long:
            return True
        looked_at = (one.lerp(other, share) for share in _LOOKED_AT)
        return all((self.nearest(at) - at).length <= _OFF * length for at in looked_at)


def _length(line: Points) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
