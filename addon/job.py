# SPDX-License-Identifier: GPL-3.0-or-later
"""The work itself, off the main thread: no bpy in here, Blender must not be touched from there."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import accumulate
from typing import Any

import orbflow_native

from . import words
from .artist import Artist
from .guides.strokes import Stroke
from .mesh_arrays import Float, MeshArrays
from .modifiers import Applied
from .regions import Flags
from .translations import rpt_

# Before this much has passed, and this share is done, nobody can say how long the rest takes.
_LEAST_S = 1.0
_LEAST_SHARE = 0.03
# How fast what was told of the time left follows what is known now: much slower and it stands when
# a step is slow, much faster and it jumps.
_FOLLOWS_S = 3.0


@dataclass(frozen=True)
class Stage:
    """How far a run is: the share of all, and the step of which of its objects."""

    share: float
    step: str
    #: Counted from 0.
    at: int


# Hears how far a run is, and how far the core is with one of its objects.
Listener = Callable[[Stage], None]
CoreListener = Callable[[str, float], None]


@dataclass(frozen=True)
class Task:
    """One object to remesh."""

    name: str
    arrays: MeshArrays
    scale: tuple[float, float, float]
    artist: Artist | None = None
    density: Float | None = None
    #: The strokes that guide it, in its space; none where no guides were named.
    guides: tuple[Stroke, ...] | None = None
    #: Which faces are left as they are; none: no face is.
    kept: Flags | None = None
    #: More objects that get its result: they share its mesh and have its scale.
    others: tuple[str, ...] = ()
    #: How many faces it gets; none: as many as the settings say.
    faces: int | None = None
    #: How modifiers have made the arrays of the object's own mesh.
    applied: Applied | None = None


@dataclass(frozen=True)
class Done:
    """A task that was done."""

    task: Task
    result: orbflow_native.Remeshed


@dataclass(frozen=True)
class Failed:
    """An object that cannot be done, and the text of why not."""

    name: str
    error: str
    #: Its parts as the core tells of them, each with its reasons; none where it tells of no part.
    kept: list[dict[str, Any]] = field(default_factory=list)
    #: None where it could not even be read.
    task: Task | None = None


Outcome = Done | Failed
# What could not even be read has failed already.
Todo = Task | Failed


def remesh(
    tasks: list[Todo],
    settings: dict[str, Any],
    listener: Listener,
    cancel: orbflow_native.CancelToken,
) -> list[Outcome]:
    """Remeshes one task after the other; a task that fails does not stop the others."""
    outcomes: list[Outcome] = []
    bounds = _bounds(tasks, settings["faces"])
    for i, task in enumerate(tasks):
        if isinstance(task, Failed):
            outcomes.append(task)
            continue

        def listen(step: str, share: float, i: int = i) -> None:
            listener(Stage(bounds[i] + share * (bounds[i + 1] - bounds[i]), step, i))

        try:
            result = _remesh_one(task, settings, listen, cancel)
        except orbflow_native.Cancelled:
            raise
        except orbflow_native.InputError as error:
            outcomes.append(Failed(task.name, str(error), error.kept, task))
        except Exception as error:
            text = str(error) or type(error).__name__
            outcomes.append(Failed(task.name, text, task=task))
        else:
            outcomes.append(Done(task, result))
    return outcomes


def _bounds(tasks: list[Todo], n_wanted: int) -> list[float]:
    """Which share of the work is done before each task, and after the last."""
    work = [
        0 if isinstance(each, Failed) else (each.faces or n_wanted) + len(each.arrays.loop_start)
        for each in tasks
    ]
    done = list(accumulate(work, initial=0))
    return [each / max(done[-1], 1) for each in done]


def _remesh_one(
    task: Task,
    settings: dict[str, Any],
    listener: CoreListener,
    cancel: orbflow_native.CancelToken,
) -> orbflow_native.Remeshed:
    arrays, artist = task.arrays, task.artist
    if task.faces:
        settings = settings | {"faces": task.faces}
    if task.applied and task.applied.stack.half:
        settings = settings | {"mirror": "xyz"[task.applied.stack.half.axis]}
    return orbflow_native.remesh(
        arrays.positions,
        arrays.loop_start,
        arrays.corner_vert,
        material_index=arrays.material_index,
        marked_edges=arrays.marked_edges,
        carried_edges=artist and artist.edges and artist.edges.ends,
        cut_edges=artist and artist.elements.cuts,
        density=task.density,
        keep_faces=task.kept,
        guides=[_guide(each) for each in task.guides or ()],
        scale=task.scale,
        progress=listener,
        cancel=cancel,
        **settings,
    )


def _guide(stroke: Stroke) -> orbflow_native.Guide:
    points, is_closed = stroke.points, stroke.is_closed
    return orbflow_native.Guide(points, is_closed=is_closed, is_exact=stroke.is_exact)


class Clock:
    """Tells how long a run still takes, from what it has done in the time that has passed."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        """Starts with the run; `now` tells the time in seconds."""
        self._now = now
        self._start = self._asked = now()
        self._end: float | None = None

    def left_s(self, share: float) -> float | None:
        """About how many seconds are left after a share; none where nobody can say yet."""
        now = self._now()
        passed = now - self._start
        if passed < _LEAST_S or share < _LEAST_SHARE:
            return None
        end = self._start + passed / share
        if self._end is not None:
            follow = min((now - self._asked) / _FOLLOWS_S, 1.0)
            end = self._end + follow * (end - self._end)
        self._end, self._asked = end, now
        return max(end - now, 0.0)


@dataclass
class Job:
    """A run on a thread of its own, watched from a modal operator."""

    tasks: list[Todo]
    settings: dict[str, Any]
    stage: Stage = Stage(0.0, "starting", 0)
    is_cancelled: bool = False
    outcomes: list[Outcome] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Starts the thread."""
        self._cancel = orbflow_native.CancelToken()
        self._clock = Clock()
        self._thread = threading.Thread(target=self._run, name="orbflow", daemon=True)
        self._thread.start()

    def cancel(self) -> None:
        """Asks the thread to stop; what it still finishes is not wanted any more."""
        self._cancel.cancel()
        self.is_cancelled = True

    def has_ended(self) -> bool:
        """Whether `outcomes` or `is_cancelled` is final."""
        return not self._thread.is_alive()

    def left_s(self) -> float | None:
        """About how many seconds are left; none where nobody can say yet."""
        return self._clock.left_s(self.stage.share)

    def told(self) -> str:
        """How far it is, in words."""
        n = len(self.tasks)
        which = rpt_("{:,} of {}").format(self.stage.at + 1, f"{n:,}") + ": " if n > 1 else ""
        return which + words.status(self.stage.step, self.stage.share, self.left_s())

    def wait(self) -> None:
        """Waits until the thread has ended."""
        self._thread.join()

    def _run(self) -> None:
        try:
            self.outcomes = remesh(self.tasks, self.settings, self._hear, self._cancel)
        except orbflow_native.Cancelled:
            self.is_cancelled = True

    def _hear(self, stage: Stage) -> None:
        # What belongs to no step has no name.
        self.stage = replace(stage, step=stage.step or self.stage.step)


# The job of the modal operator: the status bar and the panel draw it.
running: list[Job] = []
