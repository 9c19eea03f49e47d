"""Measures whole runs: each primitive, a large input, the peers beside them, the same bytes."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from bench import Bench, Row, cpu_of, failure
from embedding import made
from inputs import resized, single_balls, write_obj
from runs import Run

N_TRIANGLES = 6000
N_QUADS = 2000
N_MANY_QUADS = 8000
LARGE_TRIANGLES = 1_000_000
LARGE_FACES = 5000
PEER_RANGE = (20_000, 40_000)
# How often more all run where seconds are compared.
N_REPEATS = 2

FIGURES = (
    "triangles",
    "faces",
    "quads_pct",
    "same_topology",
    "chamfer_pct",
    "hausdorff_pct",
    "f1_at_0.5_pct",
    "f1_at_1_pct",
    "normal_consistency",
    "self_intersecting_pct",
    "edge_cv",
    "triangle_angle_mean_min",
    "jacobian_min",
    "jacobian_p01",
    "jacobian_mean",
    "irregular_pct",
    "alignment_deg",
    "loop_edges_pct",
    "spiral_pct",
    "feature_f1_pct",
    "posed_chamfer_pct",
)
PEER_FIGURES = ("chamfer_pct", "faces", "same_topology")


def triangles(bench: Bench) -> list[Row]:
    """6,000 adaptive triangles on every mesh, isotropic remeshing beside it."""
    rows = []
    for mesh in single_balls(bench.dev):
        row = remeshed(bench, mesh.path, ("adaptive", N_TRIANGLES))
        peer = bench.peer(mesh.path, "isotropic", N_TRIANGLES // 2)
        if peer["status"] == "ok" and row["ok"]:
            found = bench.figures(mesh.path, peer["output"], N_TRIANGLES // 2)
            row["isotropic_chamfer_pct"] = found["chamfer_pct"]
            row["isotropic_triangles"] = found["triangles"]
            row["isotropic_cpu_s"] = peer["cpu_s"]
            row["chamfer_ratio"] = row["chamfer_pct"] / found["chamfer_pct"]
        rows.append(row)
        say(row, "chamfer_pct", "chamfer_ratio", "f1_at_0.5_pct", "edge_cv", "cpu_s")
    return rows


def quads(bench: Bench) -> list[Row]:
    """2,000 quads of the quad sphere on every mesh, the peers in turn with it."""
    return beside_peers(bench, "quad-sphere", N_QUADS)


def beside_peers(bench: Bench, primitive: str, n_quads: int) -> list[Row]:
    """A number of quads of a primitive on every mesh, the peers in turn with it.

    Where seconds are compared all run several times in turn, and the least of each counts.
    """
    rows = []
    peers = ("instant_meshes", *(("quadriflow",) if bench.blender else ()))
    for mesh in single_balls(bench.dev):
        row = remeshed(bench, mesh.path, (primitive, n_quads))
        for peer in peers:
            found = bench.peer(mesh.path, peer, n_quads)
            row[f"{peer}_s"] = found.get("cpu_s")
            row["input_triangles"] = found["input_triangles"]
            if found["status"] == "ok":
                figures = bench.figures(mesh.path, found["output"], n_quads)
                row |= {f"{peer}_{name}": figures[name] for name in PEER_FIGURES}
        for _ in range(N_REPEATS if row["ok"] and in_peer_range([row]) else 0):
            *_, done, report = _ran(bench, mesh.path, (primitive, n_quads))
            again = {"run_s": _cost(done, report)["run_s"]}
            again |= {
                f"{peer}_s": bench.peer(mesh.path, peer, n_quads).get("cpu_s") for peer in peers
            }
            row |= {name: min(row[name], s) for name, s in again.items() if s and row[name]}
        rows.append(row)
        say(row, "faces", "chamfer_pct", "f1_at_1_pct", "run_s", "instant_meshes_s", "quadriflow_s")
    return rows


def in_peer_range(rows: list[Row]) -> list[Row]:
    """The rows whose input has 20,000 to 40,000 triangles."""
    low, high = PEER_RANGE
    return [row for row in rows if low <= row.get("input_triangles", 0) <= high]


def remeshed(
    bench: Bench, path: Path, asked: tuple[str | int, ...], poses: Sequence[Path] = ()
) -> Row:
    """One run and its figures; `asked` is the primitive, the number of faces and other arguments.

    With poses, other positions of the input's vertices, also those of the result bent like it.
    """
    primitive, n_faces, *_ = asked
    assert isinstance(n_faces, int)
    name = path.stem
    output, command, done, report = _ran(bench, path, asked)
    if not done.ok:
        return failure(name, done, command)
    n_quads = n_faces // 2 if primitive == "adaptive" else n_faces
    found = bench.figures(path, output, n_quads, poses)
    return {
        "mesh": name,
        "ok": True,
        "command": command,
        "n_asked": n_faces,
        **_cost(done, report),
        **{name: found.get(name) for name in FIGURES},
        "count_error_pct": 100 * abs(found["faces"] / n_faces - 1),
        "n_folds": report["embedding"]["n_folds"],
        "is_used": flows(report),
    }


def _ran(bench: Bench, path: Path, asked: tuple[str | int, ...]) -> tuple[Path, str, Run, Row]:
    """One run: what it wrote, its command, its cost and its report."""
    primitive, n_faces, *others = asked
    output = bench.out / "_".join(str(each).strip("-") for each in asked) / f"{path.stem}.obj"
    output.parent.mkdir(parents=True, exist_ok=True)
    arguments = ("--faces", n_faces, "--primitive", primitive, "--threads", 1, *others)
    done, report = bench.program("remesh", path, output, *arguments)
    return output, f"orbflow remesh {path} out.obj {' '.join(map(str, arguments))}", done, report


def flows(report: Row) -> bool:
    """Whether the quads of every part flow."""
    return all((part.get("flow") or {}).get("status") == "used" for part in report["parts"])


def _cost(done: Run, report: Row) -> Row:
    """The cost of a run; `run_s` leaves out the scoring, which is no part of making a mesh."""
    return {
        "cpu_s": done.cpu_s,
        "run_s": done.cpu_s - cpu_of(report, "score"),
        "wall_s": done.wall_s,
        "peak_mb": report["peak_memory_mb"],
        "steps_s": {step["name"]: step["cpu_ms"] / 1000 for step in report["steps"]},
    }


def large(bench: Bench) -> list[Row]:
    """A million triangles to 5,000 faces of each kind."""
    rows = []
    for name in ("nefertiti", "spot"):
        path = _large_input(bench, name)
        for kind in ("triangles", "quads"):
            output = bench.out / f"large_{name}_{kind}.obj"
            arguments = ("--faces", LARGE_FACES, "--kind", kind, "--threads", 1)
            done, report = bench.program("remesh", path, output, *arguments)
            command = f"orbflow remesh {path} out.obj {' '.join(map(str, arguments))}"
            if not done.ok:
                rows.append(failure(name, done, command))
                continue
            found = bench.quality.read_mesh(output)
            rows.append(
                {"mesh": name, "kind": kind, "ok": True, "faces": found.n_faces}
                | _cost(done, report)
            )
            say(rows[-1], "kind", "faces", "cpu_s", "peak_mb")
    return rows


def _large_input(bench: Bench, name: str) -> Path:
    path = bench.out / "inputs" / f"{name}_large.obj"
    if not path.exists():
        source = bench.triangles_of(bench.dev / f"{name}.obj")
        write_obj(path, *resized(*source, LARGE_TRIANGLES))
    return path


def identity(bench: Bench) -> list[Row]:
    """Runs each command twice on one thread and once on two and compares every byte written."""
    meshes = [bench.dev / f"{name}.obj" for name in ("spot", "koala", "cad_shaft", "two_parts")]
    cases = [
        (path, kind, n) for path in meshes for kind, n in (("triangles", 6000), ("quads", 2000))
    ]
    cases.append((made(bench, "spot", 50_000), "quads", 5000))
    return [_compared(bench, *case) for case in cases]


def _compared(bench: Bench, path: Path, kind: str, n_faces: int) -> Row:
    written: list[tuple[bytes, bytes]] = []
    for n_threads in (1, 1, 2):
        mesh, sphere = bench.out / "same.obj", bench.out / "same_sphere.obj"
        arguments = ("--faces", n_faces, "--kind", kind, "--threads", n_threads, "--seed", 7)
        done, _ = bench.program("remesh", path, mesh, *arguments, "--sphere", sphere)
        if not done.ok:
            command = f"orbflow remesh {path} out.obj {' '.join(map(str, arguments))}"
            return failure(path.stem, done, command) | {"kind": kind}
        written.append((mesh.read_bytes(), sphere.read_bytes()))
    row = {
        "mesh": path.stem,
        "kind": kind,
        "n_asked": n_faces,
        "ok": True,
        "twice": written[0] == written[1],
        "two_threads": written[0] == written[2],
        "n_bytes": sum(map(len, written[0])),
    }
    say(row, "kind", "twice", "two_threads")
    return row


def say(row: Row, *names: str) -> None:
    """Prints some figures of a row."""
    shown = [f"{name} {_short(row[name])}" for name in names if row.get(name) is not None]
    print(f"  {row['mesh']}: {', '.join(shown)}", flush=True)


def _short(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)
