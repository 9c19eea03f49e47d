"""What every measurement shares: the program, the meshes, the peers, the figures."""

import importlib
import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from inputs import Points, Triangles
from runs import Run, run

Row = dict[str, Any]


@dataclass(frozen=True)
class Bench:
    """Where things are. `shared` holds the folders `data` and `tools`."""

    orbflow: Path
    shared: Path
    out: Path
    blender: Path | None = None

    @property
    def dev(self) -> Path:
        """The development meshes."""
        return self.shared / "data" / "dev"

    @property
    def quaternius(self) -> Path:
        """Parts of low-poly models."""
        return self.shared / "data" / "quaternius"

    @property
    def poses(self) -> Path:
        """Bodies, at rest and bent."""
        return self.shared / "data" / "poses"

    @cached_property
    def quality(self) -> Any:  # noqa: ANN401 (a package outside the repository, without types)
        """The package that defines the figures."""
        sys.path.insert(0, str(self.shared / "tools"))
        return importlib.import_module("quality")

    def program(self, verb: str, *arguments: str | Path | int) -> tuple[Run, Row]:
        """Runs `orbflow VERB ... --report`; gives its cost and its report (empty on failure)."""
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder) / "report.json"
            command = [self.orbflow, verb, *map(str, arguments), "--report", report]
            done = run(command)
            return done, json.loads(report.read_text()) if done.ok else {}

    def figures(self, source: Path, output: Path, n_quads: int, poses: Sequence[Path] = ()) -> Row:
        """Every figure of `tools/quality` of one output."""
        reference = self.quality.Reference.read(source, poses)
        return self.quality.measure(reference, self.quality.read_mesh(output), n_quads)

    def triangles_of(self, path: Path) -> tuple[Points, Triangles]:
        """A mesh file as triangles."""
        mesh = self.quality.read_mesh(path)
        return mesh.points, np.asarray(mesh.triangles, np.int64)

    def peer(self, source: Path, peer: str, n_quads: int) -> Row:
        """Runs one peer on one mesh by `tools/peers`; `output` is the path of what it made."""
        out = self.out / "peers"
        out.mkdir(parents=True, exist_ok=True)
        (out / "runs.jsonl").unlink(missing_ok=True)
        script = self.shared / "tools" / "peers" / "run_peers.py"
        command = [sys.executable, script, source, "--targets", n_quads, "--peers", peer]
        blender = ["--blender", self.blender] if self.blender else []
        subprocess.run(
            [str(part) for part in [*command, "--out", out, *blender]],
            check=True,
            capture_output=True,
        )
        row = json.loads((out / "runs.jsonl").read_text())
        return row | ({"output": out / row["output"]} if row["status"] == "ok" else {})


def median(rows: Sequence[Row], key: str) -> float:
    """The median of a figure over the rows that have it; NaN when none has."""
    values = [row[key] for row in rows if row.get(key) is not None]
    return statistics.median(values) if values else float("nan")


def cpu_of(report: Row, name: str) -> float:
    """CPU seconds of one step of a report."""
    return sum(step["cpu_ms"] for step in report["steps"] if step["name"] == name) / 1000


def failure(name: str, done: Run, command: str) -> Row:
    """A row for a run that did not end well."""
    print(f"  {name}: exit {done.code}: {done.message}", flush=True)
    return {"mesh": name, "ok": False, "code": done.code, "error": done.message, "command": command}
