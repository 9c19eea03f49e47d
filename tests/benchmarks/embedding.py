"""Measures the embedding: does it always hold, what does it cost, what do two threads bring."""

from pathlib import Path

from bench import Bench, Row, failure
from inputs import Listed, balls, is_ball, resized, write_obj
from sphere_check import folds_and_degree

COST_MESHES = ("spot", "koala", "cat", "fish", "nefertiti")
COST_VERTICES = (10_000, 50_000, 100_000)
THREAD_VERTICES = 50_000
THREAD_REPEATS = 9
# What costs and threads are measured of: by default a network proposes for the larger of these.
SOLVER = ("--predictor", "solver")


def validity(bench: Bench) -> list[Row]:
    """Embeds every closed mesh of genus 0 in `dev` and `quaternius` and checks the written map."""
    named = [("dev", m) for m in balls(bench.dev)]
    named += [("quaternius", m) for m in balls(bench.quaternius)]
    return [_embedded(bench, name, mesh) for name, mesh in named]


def _embedded(bench: Bench, folder: str, mesh: Listed) -> Row:
    sphere = bench.out / "sphere.obj"
    done, report = bench.program("embed", mesh.path, "--sphere", sphere, "--threads", 1)
    if not done.ok:
        command = f"orbflow embed {mesh.path} --report r.json"
        return failure(mesh.name, done, command) | {"folder": folder}
    embedding = report["embedding"]
    folds, degree = folds_and_degree(*bench.triangles_of(sphere))
    # Each part has a sphere of its own: the report has the degree of each, the file their sum.
    is_valid = embedding["n_folds"] == 0 and embedding["degree"] == 1
    is_confirmed = folds == 0 and abs(degree - mesh.components) < 1e-6
    if not (is_valid and is_confirmed):
        print(f"  {mesh.path}: {embedding}, in the file {folds} folds, degree {degree}", flush=True)
    return {
        "folder": folder,
        "mesh": mesh.name,
        "ok": is_valid and is_confirmed,
        "n_folds": embedding["n_folds"],
        "degree": embedding["degree"],
        "n_folds_in_file": folds,
        "degree_in_file": degree,
        "energy": embedding["energy"],
        "n_vertices": embedding["n_vertices"],
        "cpu_s": done.cpu_s,
    }


def made(bench: Bench, name: str, n_vertices: int) -> Path:
    """The mesh `name` of `dev` brought to a number of vertices; made once and kept."""
    path = bench.out / "inputs" / f"{name}_{n_vertices}.obj"
    if not path.exists():
        source = bench.triangles_of(bench.dev / f"{name}.obj")
        points, triangles = resized(*source, 2 * (n_vertices - 2))
        if not is_ball(points, triangles):
            raise RuntimeError(f"{path.name} did not come out closed and of genus 0")
        write_obj(path, points, triangles)
    return path


def cost(bench: Bench) -> list[Row]:
    """CPU time of `orbflow embed` on one thread at growing sizes, Instant Meshes beside it."""
    rows = []
    for name in COST_MESHES:
        for n_vertices in COST_VERTICES:
            path = made(bench, name, n_vertices)
            done, report = bench.program("embed", path, *SOLVER, "--threads", 1)
            if not done.ok:
                command = f"orbflow embed {path} {' '.join(SOLVER)} --threads 1"
                rows.append(failure(path.name, done, command))
                continue
            rows.append(
                {
                    "mesh": name,
                    "n_vertices": n_vertices,
                    "ok": report["embedding"]["n_folds"] == 0,
                    "cpu_s": done.cpu_s,
                    "steps_s": {s["name"]: s["cpu_ms"] / 1000 for s in report["steps"]},
                    "energy": report["embedding"]["energy"],
                    "n_relaxations": report["embedding"]["n_relaxations"],
                    "peak_mb": report["peak_memory_mb"],
                    "instant_meshes_s": bench.peer(path, "instant_meshes", 2000).get("cpu_s"),
                }
            )
            print(f"  {name} {n_vertices}: {done.cpu_s:.2f} s CPU", flush=True)
    return rows


def threads(bench: Bench) -> list[Row]:
    """Wall time of the embedding with 1 and 2 threads, alternating; the best of several each."""
    rows = []
    for name in COST_MESHES[:3]:
        path = made(bench, name, THREAD_VERTICES)
        best: dict[int, tuple[float, float]] = {}
        for _ in range(THREAD_REPEATS):
            for n_threads in (1, 2):
                done, report = bench.program("embed", path, *SOLVER, "--threads", n_threads)
                step_s = sum(s["time_ms"] for s in report["steps"] if s["name"] == "embed") / 1000
                found = (done.wall_s, step_s or done.wall_s)
                best[n_threads] = min(best.get(n_threads, found), found, key=lambda t: t[1])
        rows.append(
            {
                "mesh": name,
                "n_vertices": THREAD_VERTICES,
                "wall_1_s": best[1][0],
                "wall_2_s": best[2][0],
                "embed_1_s": best[1][1],
                "embed_2_s": best[2][1],
                "ratio": best[1][1] / best[2][1],
                "whole_ratio": best[1][0] / best[2][0],
            }
        )
        print(f"  {name}: {rows[-1]['ratio']:.2f}", flush=True)
    return rows
