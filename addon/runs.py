# SPDX-License-Identifier: GPL-3.0-or-later
"""What is kept of the runs of this session, by the mesh that it is about; nothing is in the file.

A mesh is known by its print. So undo and redo, another name for an object and a copy of it keep
what belongs to them, and what is told of a mesh goes when the mesh changes.
"""

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .spots import Complaint

# What says which mesh a mesh is: how many vertices and faces it has, and where some vertices are.
# Places are bytes: what is not a number is like no number, itself included.
Print = tuple[int, int, bytes]
# As many runs are kept as Blender keeps undo steps by default; a run is a tenth of a megabyte.
_N_KEPT = 32
# Of what was left so many are kept: a scene may have hundreds of objects that cannot be done.
_N_LEFT = 1000
# At most so many vertices are looked at on every redraw, which takes less than a millisecond.
_N_LOOKED_AT = 200


@dataclass(frozen=True)
class Last:
    """What is kept of the run that made a mesh."""

    report: dict[str, Any]
    crosses: NDArray[np.float32]


@dataclass(frozen=True)
class Left:
    """What a run has left of a mesh as it was, and why."""

    #: What was left; `{}` stands for the object's name. Empty where nothing was.
    title: str
    #: Whether the whole object was.
    is_whole: bool
    complaints: list[Complaint]


@dataclass(frozen=True)
class Line:
    """What became of one object of a run over several."""

    name: str
    #: `done`, `warned` or `refused`.
    state: str
    text: str
    #: Of its mesh after the run; none where there is none.
    print: Print | None


_last: dict[Print, Last] = {}
_left: dict[Print, Left] = {}
_lines: list[Line] = []


def register() -> None:
    """Starts to forget what belongs to another file."""
    bpy.app.handlers.load_post.append(_forget)


def unregister() -> None:
    """Forgets everything."""
    bpy.app.handlers.load_post.remove(_forget)
    _forget()
    _last.clear()


@bpy.app.handlers.persistent
def _forget(*_file: object) -> None:
    _left.clear()
    _lines.clear()


def remember(thing: bpy.types.Object, report: dict[str, Any], crosses: NDArray[np.float32]) -> None:
    """Keeps what the panel and the overlay show of the run that made an object's mesh."""
    _keep(_last, print_of(thing.data), Last(report, crosses), _N_KEPT)


def remember_left(thing: bpy.types.Object, left: Left) -> None:
    """Keeps what was left of an object's mesh."""
    _keep(_left, print_of(thing.data), left, _N_LEFT)


def remember_lines(lines: list[Line]) -> None:
    """Keeps a line for every object of the last run."""
    _lines[:] = lines


def forget_left(mesh: Print) -> None:
    """What was said of a mesh holds no more: it was done."""
    _left.pop(mesh, None)


def last_report(name: str) -> dict[str, Any] | None:
    """The report of the run in this session that made an object what it is now."""
    last = last_of(bpy.data.objects.get(name))
    return last and last.report


def last_crosses(thing: bpy.types.Object) -> NDArray[np.float32] | None:
    """The crosses of the field of what an object is now, as places and arms (N, 3, 3)."""
    last = last_of(thing)
    return last and last.crosses


def last_of(thing: bpy.types.Object | None) -> Last | None:
    """What is kept of what an object is now: none where its mesh was edited since."""
    return _of(_last, thing)


def left_of(thing: bpy.types.Object | None) -> Left | None:
    """What was left of an object that is still what it was then."""
    return _of(_left, thing)


def lines() -> list[Line]:
    """The lines of the last run whose objects are what they were after it."""
    return [line for line in _lines if line.print is None or line.print == _print_now(line.name)]


def print_of(mesh: bpy.types.Mesh) -> Print:
    """The print of a mesh."""
    n = len(mesh.vertices)
    looked_at = [mesh.vertices[i].co for i in range(0, n, n // _N_LOOKED_AT + 1)]
    return n, len(mesh.polygons), np.array(looked_at, np.float32).tobytes()


def local(name: str) -> bpy.types.Object | None:
    """The mesh object of a name in this file; a linked object may have the same name."""
    thing = bpy.data.objects.get((name, None))
    return thing if thing and thing.type == "MESH" else None


def _print_now(name: str) -> Print | None:
    thing = local(name)
    return thing and print_of(thing.data)


def _of(kept: dict[Print, Any], thing: bpy.types.Object | None) -> Any:  # noqa: ANN401
    if not kept or thing is None or thing.type != "MESH":
        return None
    return kept.get(print_of(thing.data))


def _keep(kept: dict[Print, Any], key: Print, value: object, most: int) -> None:
    kept.pop(key, None)
    kept[key] = value
    while len(kept) > most:
        del kept[next(iter(kept))]
