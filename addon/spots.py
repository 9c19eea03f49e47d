# SPDX-License-Identifier: GPL-3.0-or-later
"""Why parts of a mesh were left as they were, and the spots that Show selects for it.

The core speaks of the vertices and faces of what came in. What stayed of it lies at the end of the
result, so that its numbers there are found by where every corner comes from.
"""

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from . import attributes, words
from .guides.strokes import Stroke
from .mesh_arrays import MeshArrays
from .translations import n_, rpt_

Int = NDArray[np.int32]
_Reason = tuple[dict[str, Any], dict[str, Any]]
_ELEMENTS = ("edges", "faces")
# More rows than this would fill the sidebar: then one row stands for all of a kind.
_MOST_ROWS = 6
# Faces along a stroke are looked for at no more points than these: each takes a look at all faces.
_MOST_POINTS = 200


@dataclass(frozen=True)
class Spot:
    """Edges by their ends (E, 2), faces (F,), and a point among them, of a mesh as it is now."""

    edges: Int
    faces: Int
    place: tuple[float, float, float]


@dataclass(frozen=True)
class Complaint:
    """One reason why something was left, in an artist's words, in exact words, and where."""

    words: str
    exact: str
    spot: Spot | None


@dataclass(frozen=True)
class Numbers:
    """The numbers that vertices and faces of what came in have now; -1 where they are gone."""

    vertices: Int
    faces: Int

    def of(self, reason: dict[str, Any]) -> Spot:
        """The spot of a reason."""
        edges = self.vertices[np.array(reason["edges"], np.int32).reshape(-1, 2)]
        faces = self.faces[np.array(reason["faces"], np.int32)]
        place = tuple(reason["place"])
        return Spot(edges[(edges >= 0).all(axis=1)], faces[faces >= 0], place)


def same(arrays: MeshArrays) -> Numbers:
    """The numbers where nothing has changed."""
    counts = len(arrays.positions), len(arrays.loop_start)
    return Numbers(*(np.arange(n, dtype=np.int32) for n in counts))


def gone(arrays: MeshArrays) -> Numbers:
    """The numbers where the mesh at hand is not the one that came in: only places are of use."""
    counts = len(arrays.positions), len(arrays.loop_start)
    return Numbers(*(np.full(n, -1, np.int32) for n in counts))


def in_result(arrays: MeshArrays, result: orbflow_native.Remeshed) -> Numbers:
    """The numbers in a result: its last faces are those that stayed."""
    numbers = gone(arrays)
    origins, n_kept = result.origins, result.kept_faces
    if origins is None or not n_kept:
        return numbers
    n_faces = len(result.loop_start)
    kept = np.arange(n_faces - n_kept, n_faces, dtype=np.int32)
    numbers.faces[origins.faces[kept]] = kept
    corners = np.arange(int(result.loop_start[kept[0]]), len(result.corner_vert))
    old = arrays.corner_vert[origins.corner_corners[0][corners, 0]]
    numbers.vertices[old] = result.corner_vert[corners]
    return numbers


def complaints(kept: list[dict[str, Any]], numbers: Numbers, n_parts: int) -> list[Complaint]:
    """A row for every reason of every part, or for every kind of reason where these are many."""
    reasons = [(part, reason) for part in kept for reason in part["reasons"]]
    groups: dict[object, list[_Reason]] = {}
    for i, (part, reason) in enumerate(reasons):
        kind = reason["kind"], part["outcome"]
        groups.setdefault(i if len(reasons) <= _MOST_ROWS else kind, []).append((part, reason))
    return [_complaint(group, numbers, n_parts) for group in groups.values()]


def made(result: orbflow_native.Remeshed, told: list[str]) -> list[Complaint]:
    """A row for the faces that lie on what was filled and sealed, if there are any."""
    faces = result.filled_faces
    if not len(faces):
        return []
    corners = result.corner_vert[result.loop_start[faces[0]] :][:3]
    place = tuple(result.positions[corners].mean(0).tolist())
    one = n_("{:,} face on what was closed for good")
    many = n_("{:,} faces on what was closed for good")
    exact = words.count(len(faces), one, many)
    return [Complaint(", ".join(told), exact, Spot(np.zeros((0, 2), np.int32), faces, place))]


def lost(
    mesh: bpy.types.Mesh, strokes: tuple[Stroke, ...], outcomes: list[dict[str, Any]]
) -> list[Complaint]:
    """A row for every stroke that no edges of a mesh follow, or one for all where these are many.

    Its spot is the faces that lie along it.
    """
    gone = [each for each in outcomes if each["outcome"] == "lost"]
    rows = [gone] if len(gone) > _MOST_ROWS else [[each] for each in gone]
    return [_lost(mesh, [strokes[each["guide"]] for each in row], row) for row in rows]


def _lost(mesh: bpy.types.Mesh, strokes: list[Stroke], outcomes: list[dict[str, Any]]) -> Complaint:
    points = np.concatenate([each.points for each in strokes])
    some = points[:: -(-len(points) // _MOST_POINTS)]
    middles = _middles(mesh)
    squares = [((middles - point) ** 2).sum(axis=1) for point in some]
    faces = np.unique([each.argmin() for each in squares]).astype(np.int32)
    exact = words.first_of([each["text"] for each in outcomes])
    told = rpt_("guide {} is lost").format(strokes[0].name)
    if len(strokes) > 1:
        told = rpt_("{:,} guides are lost").format(len(strokes))
    elif off := words.off_guides(outcomes):
        told += ": " + rpt_("{} off").format(off)
    return Complaint(told, exact, Spot(np.zeros((0, 2), np.int32), faces, tuple(some[0])))


def _middles(mesh: bpy.types.Mesh) -> NDArray[np.floating]:
    """The middles of all faces, (F, 3)."""
    starts = attributes.loop_starts(mesh)
    corners = attributes.positions(mesh)[attributes.corner_verts(mesh)]
    sizes = np.diff(np.append(starts, len(corners)))
    return np.add.reduceat(corners, starts, axis=0) / sizes[:, None]


def _complaint(group: list[_Reason], numbers: Numbers, n_parts: int) -> Complaint:
    (part, reason), *others = group
    if others:
        told = rpt_("{:,} parts {}").format(len(group), words.of_many(reason["kind"]))
    elif n_parts > 1:
        n_faces = words.count(part["n_faces"], n_("{:,} face"), n_("{:,} faces"))
        told = rpt_("part of {}: {}").format(n_faces, words.reason(reason))
    else:
        told = words.reason(reason)
    exact = words.first_of([reason["text"] for _, reason in group])
    if part["outcome"] == "dropped":
        return Complaint(rpt_("{}; left out").format(told), exact, None)
    spots = [numbers.of(reason) for _, reason in group]
    edges, faces = (np.concatenate([getattr(spot, name) for spot in spots]) for name in _ELEMENTS)
    return Complaint(told, exact, Spot(edges, faces, spots[0].place))
