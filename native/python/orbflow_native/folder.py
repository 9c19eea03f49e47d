"""Remeshes every mesh of a folder with the program `orbflow`, on Dask.

    python -m orbflow_native.folder scans low --workers 2 -- --faces 2000 --mirror x

What stands after `--` is what `orbflow remesh` takes. Without `--scheduler` a cluster of processes
on this machine does it; with the address of one, whatever workers it has: these need the program,
this module and the same folders. Beside every result is what was told of it, `NAME.json`, with
the sum of the input and the options: another run leaves out what is done already, so that one that
was cut, or whose workers were lost, is gone on with. Results are written whole or not at all.

A mesh that cannot be done is told of and not tried again. A program that is killed or fails
otherwise is tried again; a worker that is lost has its meshes done by the others.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

#: The endings of files that are read; what cannot be written becomes OBJ.
READ = (".obj", ".ply", ".stl", ".off", ".glb", ".gltf")
_WRITTEN_AS = {".stl": ".obj"}
# Of the program: this input cannot be done; however often it is tried, nothing else comes of it.
_CANNOT = 3
# What a run that was stopped by Ctrl-C ends with.
_CANCELLED = 130
# Of what a program says when it fails the end tells why.
_MOST_TEXT = 2000


class FolderError(Exception):
    """A folder cannot be done as it is asked for; the text says why."""


@dataclass(frozen=True)
class Task:
    """One file to remesh."""

    source: str
    target: str
    options: tuple[str, ...]
    program: str = "orbflow"

    @property
    def told(self) -> str:
        """The file in which is told what became of it."""
        return self.target + ".json"


@dataclass(frozen=True)
class Outcome:
    """What became of a file."""

    source: str
    target: str
    #: `done`, `refused` (this input cannot be done) or `failed`.
    state: str
    #: Why it was refused or failed; warnings where it was done.
    text: str = ""
    seconds: float = 0.0
    #: Whether a run before this one has done it.
    is_old: bool = False
    #: The program's own report; empty where there is none.
    report: dict[str, Any] = field(default_factory=dict)

    def line(self) -> str:
        """The outcome in a line."""
        name, n = os.path.basename(self.source), self.report.get("output", {}).get("n_faces")
        faces = f" {n:,} faces" if n else ""
        when = "before" if self.is_old else f"{self.seconds:.1f} s"
        text = "" if self.state == "done" else ": " + self.text.strip().replace("\n", " ")
        return f"{name} {self.state}{faces} ({when}){text}"


class Failed(Exception):
    """The program has failed in a way that another try may mend."""


def tasks(
    source: Path, target: Path, options: Sequence[str] = (), program: str = "orbflow"
) -> list[Task]:
    """The files of a folder and those below it, with where each result goes.

    Raises `FolderError` where there is none, or two would have one result.
    """
    found = sorted(path for path in source.rglob("*") if path.suffix.lower() in READ)
    found = [path for path in found if not path.is_relative_to(target)]
    if not found:
        raise FolderError(f"no mesh ({', '.join(READ)}) in {source}")
    taken: dict[Path, Path] = {}
    for path in found:
        ending = _WRITTEN_AS.get(path.suffix.lower(), path.suffix)
        to = target / path.relative_to(source).with_suffix(ending)
        if to in taken:
            raise FolderError(f"{taken[to]} and {path} would both become {to}")
        taken[to] = path
    return [Task(str(path), str(to), tuple(options), program) for to, path in taken.items()]


def remesh_one(task: Task) -> Outcome:
    """Remeshes one file, unless that was done before; raises `Failed` where it may be tried again.

    This is what workers run.
    """
    key = _key(task)
    if (old := _told_before(task, key)) is not None:
        return old
    os.makedirs(os.path.dirname(task.target) or ".", exist_ok=True)
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="orbflow-") as scratch:
        report = Path(scratch, "report.json")
        command = [task.program, "remesh", task.source, task.target, "--report", str(report)]
        ended = subprocess.run(
            [*command, *task.options], stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
        told = json.loads(report.read_text()) if report.exists() else {}
    text, seconds = ended.stderr[-_MOST_TEXT:], round(time.monotonic() - start, 3)
    if ended.returncode not in (0, _CANNOT):
        raise Failed(f"{task.program} ended with {ended.returncode}: {text.strip()}")
    state = "refused" if ended.returncode == _CANNOT else "done"
    outcome = Outcome(task.source, task.target, state, text, seconds, report=told)
    _tell(task, key, outcome)
    return outcome


def remesh(
    todo: Sequence[Task],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retries: int = 2,
    listener: Callable[[Outcome], object] = lambda outcome: None,
) -> list[Outcome]:
    """Remeshes files on Dask and tells the listener of each as it ends; in the order given.

    `workers` is how many processes of this machine do it, all cores where that is not said;
    `scheduler` is the address of a cluster that does it instead. A program that fails is tried
    again so many times as `retries` says.
    """
    outcomes: dict[str, Outcome] = {}
    with _client(workers, scheduler) as client:
        for outcome in _ended(client, todo, retries):
            outcomes[outcome.target] = outcome
            listener(outcome)
    return [outcomes[task.target] for task in todo]


def _ended(client: Any, todo: Sequence[Task], retries: int) -> Iterator[Outcome]:  # noqa: ANN401
    """The outcomes of tasks as they end."""
    futures = {
        # Two runs of one process may not have one result: nothing is remembered by the arguments.
        client.submit(remesh_one, task, retries=retries, pure=False): task
        for task in todo
    }
    for future in _dask().as_completed(futures):
        task, error = futures[future], future.exception()
        if error is None:
            yield future.result()
        else:
            text = str(error) or type(error).__name__
            yield Outcome(task.source, task.target, "failed", text[-_MOST_TEXT:])
        future.release()


def _dask() -> Any:  # noqa: ANN401 - a module that need not be there
    try:
        return importlib.import_module("distributed")
    except ImportError as error:
        why = "Dask is not installed: pip install 'orbflow-native[dask]'"
        raise FolderError(why) from error


@contextmanager
def _client(workers: int | None, scheduler: str | None) -> Iterator[Any]:
    dask = _dask()
    if scheduler:
        with dask.Client(scheduler) as client:
            yield client
        return
    n_workers = workers or os.cpu_count() or 1
    # A process each: one that is lost takes no other with it.
    with (
        dask.LocalCluster(
            n_workers=n_workers, threads_per_worker=1, processes=True, dashboard_address=":0"
        ) as cluster,
        dask.Client(cluster) as client,
    ):
        yield client


def _key(task: Task) -> dict[str, Any]:
    """What a result depends on."""
    with open(task.source, "rb") as file:
        sum_of_input = hashlib.file_digest(file, "sha256").hexdigest()
    return {"sha256": sum_of_input, "options": list(task.options), "program": task.program}


def _told_before(task: Task, key: dict[str, Any]) -> Outcome | None:
    """What was told of a file that is done as it is asked for now."""
    try:
        told = json.loads(Path(task.told).read_text())
        outcome = Outcome(**(told["outcome"] | {"is_old": True}))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    is_there = outcome.state == "refused" or os.path.exists(task.target)
    return outcome if told.get("key") == key and is_there else None


def _tell(task: Task, key: dict[str, Any], outcome: Outcome) -> None:
    """Writes what became of a file, whole or not at all."""
    written = f"{task.told}.{os.getpid()}.part"
    Path(written).write_text(json.dumps({"key": key, "outcome": asdict(outcome)}, indent=1))
    os.replace(written, task.told)


def _counts(outcomes: Iterable[Outcome]) -> dict[str, int]:
    counts = {"done": 0, "refused": 0, "failed": 0, "before": 0}
    for each in outcomes:
        counts[each.state] += 1
        counts["before"] += each.is_old
    return counts


def _arguments(given: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m orbflow_native.folder",
        description="Remeshes every mesh of a folder with the program orbflow, on Dask.",
        epilog="What stands after -- is for `orbflow remesh`, such as --faces 2000.",
    )
    parser.add_argument("source", type=Path, help="the folder of meshes")
    parser.add_argument("target", type=Path, help="the folder of results")
    parser.add_argument("--workers", type=int, help="processes of this machine; all cores else")
    parser.add_argument("--scheduler", help="the address of a Dask cluster to use instead")
    parser.add_argument("--retries", type=int, default=2, help="tries of what fails (2)")
    parser.add_argument("--program", default="orbflow", help="the program, or its path")
    at = given.index("--") if "--" in given else len(given)
    arguments = parser.parse_args(given[:at])
    arguments.options = list(given[at + 1 :])
    return arguments


def main(given: Sequence[str]) -> int:
    """The command line; 0 where all was done, 3 where a mesh was not, 2 for wrong usage."""
    wanted = _arguments(given)
    # Workers are as many as there is room for: each program takes one core.
    options = wanted.options if "--threads" in wanted.options else [*wanted.options, "--threads=1"]
    try:
        todo = tasks(wanted.source, wanted.target, options, wanted.program)
    except FolderError as error:
        print(error, file=sys.stderr)
        return 2
    n_ended = 0

    def listen(outcome: Outcome) -> None:
        nonlocal n_ended
        n_ended += 1
        print(f"{n_ended:,} of {len(todo):,}: {outcome.line()}", file=sys.stderr, flush=True)

    try:
        outcomes = remesh(
            todo,
            workers=wanted.workers,
            scheduler=wanted.scheduler,
            retries=wanted.retries,
            listener=listen,
        )
    except FolderError as error:
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("cancelled; the same command goes on with it", file=sys.stderr)
        return _CANCELLED
    counts = _counts(outcomes)
    print(json.dumps(counts))
    return 0 if counts["done"] == len(todo) else _CANNOT


if __name__ == "__main__":
    # Workers are told of functions by their module: that of a program that runs has another name.
    from orbflow_native import folder

    sys.exit(folder.main(sys.argv[1:]))
