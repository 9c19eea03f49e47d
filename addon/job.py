# SPDX-License-Identifier: GPL-3.0-or-later
"""The work itself, off the main thread: no bpy in here, Blender must not be touched from there."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import orbflow_native

from .artist import Artist
from .mesh_arrays import Float, MeshArrays
from .modifiers import Applied

Listener = Callable[[str, float], None]


@dataclass(frozen=True)
class Task:
    """One object to remesh."""

    name: str
    arrays: MeshArrays
    scale: tuple[float, float, float]
    artist: Artist | None = None
    density: Float | None = None
    #: More objects that get its result: they share its mesh and have its scale.
    others: tuple[str, ...] = ()
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
    for i, task in enumerate(tasks):
        if isinstance(task, Failed):
            outcomes.append(task)
            continue

        def listen(step: str, share: float, i: int = i) -> None:
            listener(step, (i + share) / len(tasks))

        try:
            result = _remesh_one(task, settings, listen, cancel)
        except orbflow_native.Cancelled:
            raise
        except Exception as error:
            outcomes.append(Failed(task.name, str(error) or type(error).__name__))
        else:
            outcomes.append(Done(task, result))
    return outcomes


def _remesh_one(
    task: Task,
    settings: dict[str, Any],
    listener: Listener,
    cancel: orbflow_native.CancelToken,
) -> orbflow_native.Remeshed:
    arrays, artist = task.arrays, task.artist
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
        scale=task.scale,
        progress=listener,
        cancel=cancel,
        **settings,
    )


@dataclass
class Job:
    """A run on a thread of its own, watched from a modal operator."""

    tasks: list[Todo]
    settings: dict[str, Any]
    step: str = "starting"
    share: float = 0.0
    is_cancelled: bool = False
    outcomes: list[Outcome] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Starts the thread."""
        self._cancel = orbflow_native.CancelToken()
        self._thread = threading.Thread(target=self._run, name="orbflow", daemon=True)
        self._thread.start()

    def cancel(self) -> None:
        """Asks the thread to stop; what it still finishes is not wanted any more."""
        self._cancel.cancel()
        self.is_cancelled = True

    def has_ended(self) -> bool:
        """Whether `outcomes` or `is_cancelled` is final."""
        return not self._thread.is_alive()

    def wait(self) -> None:
        """Waits until the thread has ended."""
        self._thread.join()

    def _run(self) -> None:
        try:
            self.outcomes = remesh(self.tasks, self.settings, self._hear, self._cancel)
        except orbflow_native.Cancelled:
            self.is_cancelled = True

    def _hear(self, step: str, share: float) -> None:
        self.step, self.share = step, share
