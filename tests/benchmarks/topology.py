"""Measures what becomes of borders, handles and shared edges, ours and the peers'."""

import csv
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from bench import Bench, Row, failure
from inputs import listed
from remeshing import N_QUADS, flows, say

# Every 24th model of `basemesh`, from the 12th on: nothing was chosen on these.
STEP, FIRST = 24, 11
LEAST_QUADS = 60
# Of `dev`: models with borders, handles or several parts.
ROLES = {"open", "genus", "parts"}
FIGURES = ("faces", "inverted", "loop_edges_pct", "spiral_pct", "irregular_pct")
PEERS = ("instant_meshes", "quadriflow")


@dataclass(frozen=True)
class Sample:
    """A model and the number of quads to make of it."""

    path: Path
    n_quads: int

    @cached_property
    def name(self) -> str:
        """The name of its row."""
        return self.path.stem


def samples(bench: Bench) -> Iterator[Sample]:
    """Models of every kind: of `basemesh` at their own count, clothes, and those of `dev`."""
    data = bench.shared / "data"
    folder = bench.out / "basemesh"
    with (data / "basemesh" / "manifest.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))[FIRST::STEP]
    with zipfile.ZipFile(data / "basemesh" / "basemesh.zip") as archive:
        for row in rows:
            path = Path(archive.extract(row["file"], folder))
            yield Sample(path, max(int(row["n_faces"]), LEAST_QUADS))
    for path in sorted((data / "makehuman" / "clothes").glob("*.obj")):
        yield Sample(path, N_QUADS)
    for mesh in listed(bench.dev):
        if mesh.role in ROLES:
            yield Sample(mesh.path, N_QUADS)


def topology(bench: Bench) -> list[Row]:
    """The flow of every sample, and whether it has the input's pieces, borders and handles."""
    rows = []
    for sample in samples(bench):
        output = bench.out / "topology" / f"{sample.name}.obj"
        output.parent.mkdir(parents=True, exist_ok=True)
        arguments = ("--faces", sample.n_quads, "--threads", 1)
        done, report = bench.program("remesh", sample.path, output, *arguments)
        found: Row = {"mesh": sample.name, "kind": kind(bench, sample.path)}
        if done.ok:
            row = (
                found
                | _of(bench, sample, output)
                | {
                    "ok": True,
                    "is_used": flows(report),
                    "n_kept": len(report["kept"]),
                    "cpu_s": done.cpu_s,
                }
            )
        else:
            row = failure(sample.name, done, f"orbflow remesh {sample.path}") | found
        rows.append(row)
        say(row, "kind", "is_alike", "inverted", "border_mean_edges", "cpu_s")
    return rows


def topology_peers(bench: Bench) -> list[Row]:
    """The same of the peers."""
    rows = []
    for sample in samples(bench):
        row: Row = {"mesh": sample.name, "kind": kind(bench, sample.path), "ok": True}
        for peer in PEERS if bench.blender else PEERS[:1]:
            found = bench.peer(sample.path, peer, sample.n_quads)
            figures = _of(bench, sample, found["output"]) if found["status"] == "ok" else {}
            row |= {f"{peer}_{name}": value for name, value in figures.items()}
        rows.append(row)
        say(row, "kind", "instant_meshes_is_alike", "quadriflow_is_alike")
    return rows


def kind(bench: Bench, path: Path) -> str:
    """What a model has that a ball has not; the first of several."""
    _, own = bench.program("score", path, path)
    if not own.get("manifold", False):
        return "shared edges"
    if own["genus"]:
        return "handles"
    if not own["closed"]:
        return "borders"
    return "closed parts" if own["components"] > 1 else "closed"


def _of(bench: Bench, sample: Sample, output: Path) -> Row:
    """The figures of one output, borders in mean edges of the output."""
    done, found = bench.program("score", sample.path, output)
    if not done.ok:
        return {"is_alike": False}
    row: Row = {"is_alike": found["same_topology"]} | {name: found[name] for name in FIGURES}
    if found["border_mean_pct"] is not None:
        points, _ = bench.triangles_of(sample.path)
        edge_pct = 100 * found["edge_mean"] / np.linalg.norm(np.ptp(points, axis=0))
        row["border_mean_edges"] = found["border_mean_pct"] / edge_pct
        row["border_largest_edges"] = found["border_hausdorff_pct"] / edge_pct
    return row
