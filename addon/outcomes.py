# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told of what became of each object, and kept for the panel."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import bpy
import numpy as np

from . import attributes, modifiers, runs, spots, words
from .job import Done, Failed
from .mesh_arrays import MeshArrays
from .runs import Left, Line, Print
from .spots import Complaint, Numbers
from .translations import n_, rpt_


@dataclass(frozen=True)
class Told:
    """What became of the objects of one task."""

    lines: list[Line]
    text: str
    is_grave: bool

    @property
    def state(self) -> str:
        """What has become of them: `done`, `warned` or `refused`."""
        return self.lines[0].state


@dataclass(frozen=True)
class Before:
    """What only the mesh tells that a result replaces."""

    print: Print | None
    n_hidden: int


def before(outcome: Done) -> Before:
    """Reads what is told of an object's mesh before it is replaced."""
    thing = runs.local(outcome.task.name)
    if thing is None:
        return Before(None, 0)
    hidden = attributes.values(thing.data, ".hide_poly", "FACE", "BOOLEAN")
    return Before(runs.print_of(thing.data), 0 if hidden is None else int(np.sum(hidden)))


def done(outcome: Done, report: dict[str, Any], old: Before) -> Told:
    """Tells of a task that was done; `report` is what the panel keeps of it."""
    task = outcome.task
    thing = bpy.data.objects[task.name, None]
    report["n_hidden"] = old.n_hidden
    report["nodes"] = [each.name for each in thing.modifiers if modifiers.has_nodes(each)]
    if old.print:
        runs.forget_left(old.print)
    complaints = _complaints(outcome, report)
    complaints += spots.lost(thing.data, task.guides or (), report["guides"])
    if complaints:
        title = "; ".join(words.counts(report)) if report["kept"] else ""
        runs.remember_left(thing, Left(title, False, complaints))
    state = "warned" if words.warnings(report) else "done"
    lines = [_line(name, state, words.line(report)) for name in (task.name, *task.others)]
    return Told(lines, words.sentence(report), words.is_grave(report))


def _complaints(outcome: Done, report: dict[str, Any]) -> list[Complaint]:
    """What was left of an object that was done, and what was made anew."""
    task, n_parts = outcome.task, len(report["parts"]) + len(report["kept"])
    # Half of a result has other numbers.
    numbers = spots.gone if report["half"] else partial(spots.in_result, result=outcome.result)
    found = spots.complaints(report["kept"], numbers(task.arrays), n_parts)
    made = [] if report["half"] else spots.made(outcome.result, words.filled(report))
    return found + made


def refused(failed: Failed) -> Told:
    """Tells of objects that were left as they are."""
    thing, task = runs.local(failed.name), failed.task
    complaints: list[Complaint] = []
    if task:
        numbers = _numbers(thing, task.arrays)
        complaints = spots.complaints(failed.kept, numbers, len(failed.kept))
    said = "; ".join(each.words for each in complaints)
    if thing and _is_only_one(failed.name):
        told = complaints or [Complaint(failed.error, failed.error, None)]
        runs.remember_left(thing, Left(n_("{} was left as it was"), True, told))
    text = rpt_("{} \nIn exact words: {}").format(said, failed.error) if said else failed.error
    names = (failed.name, *(task.others if task else ()))
    return Told([_line(name, "refused", said or failed.error) for name in names], text, True)


def _line(name: str, state: str, text: str) -> Line:
    thing = runs.local(name)
    return Line(name, state, text, thing and runs.print_of(thing.data))


def _numbers(thing: bpy.types.Object | None, arrays: MeshArrays) -> Numbers:
    """What the core calls by number is of the object's mesh, unless modifiers made another."""
    counts = len(arrays.positions), len(arrays.loop_start)
    if thing and counts == (len(thing.data.vertices), len(thing.data.polygons)):
        return spots.same(arrays)
    return spots.gone(arrays)


def _is_only_one(name: str) -> bool:
    """Whether no linked object has the same name."""
    return sum(each.name == name for each in bpy.data.objects) == 1
