"""Measures quads that flow: beside peers, of one size, on bodies that bend, on artists' models."""

from pathlib import Path

from bench import Bench, Row, failure
from inputs import balls, single_balls
from remeshing import N_MANY_QUADS, N_QUADS, beside_peers, flows, remeshed, say

BODIES = ("human_f", "human_m", "man_low_poly", "horse", "trex")
# Fewer quads than a cube's do not close a surface.
LEAST_QUADS = 6
FEW_QUADS = (100, 200, 300, 499)


def flow(bench: Bench) -> list[Row]:
    """2,000 quads on every mesh, the peers in turn with it."""
    return beside_peers(bench, "flow", N_QUADS)


def flow_many(bench: Bench) -> list[Row]:
    """8,000 quads on every mesh, the peers in turn with it."""
    return beside_peers(bench, "flow", N_MANY_QUADS)


def flow_few(bench: Bench) -> list[Row]:
    """A few hundred quads of every mesh, as for games and far away things."""
    rows = []
    for n_quads in FEW_QUADS:
        for mesh in single_balls(bench.dev):
            rows.append(remeshed(bench, mesh.path, ("flow", n_quads)))
            say(rows[-1], "n_asked", "faces", "is_used", "chamfer_pct", "jacobian_min")
    return rows


def flow_even(bench: Bench) -> list[Row]:
    """2,000 quads of one size on every mesh."""
    rows = []
    for mesh in single_balls(bench.dev):
        rows.append(remeshed(bench, mesh.path, ("flow", N_QUADS, "--adaptivity", 0)))
        say(rows[-1], "edge_cv", "jacobian_mean", "chamfer_pct")
    return rows


def flow_bodies(bench: Bench) -> list[Row]:
    """2,000 quads of bodies at rest, which then follow the input into its other poses."""
    rows = []
    for name in BODIES:
        rest, *bent = sorted((bench.poses / name).glob("pose_*.obj"))
        row = remeshed(bench, rest, ("flow", N_QUADS), bent)
        rows.append(row | {"mesh": name})
        say(rows[-1], "hausdorff_pct", "posed_chamfer_pct", "jacobian_min", "loop_edges_pct")
    return rows


def flow_artists(bench: Bench) -> list[Row]:
    """Every model of `quaternius` at its artist's number of faces, scored as the artist's is."""
    rows = []
    for mesh in balls(bench.quaternius):
        row = _beside_the_artist(bench, mesh.path)
        rows.append(row | {"n_parts": mesh.components})
        if not row["ok"] or not row["is_used"] or row["n_inverted"]:
            say(rows[-1], "faces", "n_asked", "is_used", "n_inverted")
    return rows


def _beside_the_artist(bench: Bench, path: Path) -> Row:
    corners = [len(line.split()) - 1 for line in path.read_text().splitlines() if line[:2] == "f "]
    # Two triangles are as good as a quad.
    n_quads = max(sum(n - 2 for n in corners) // 2, LEAST_QUADS)
    output = bench.out / "artists.obj"
    arguments = ("--faces", n_quads, "--primitive", "flow", "--threads", 1)
    done, report = bench.program("remesh", path, output, *arguments)
    if not done.ok:
        command = f"orbflow remesh {path} out.obj {' '.join(map(str, arguments))}"
        return failure(path.stem, done, command)
    faces, parts = report["output"], report["parts"]
    artists = _score(bench, path) if sum(n == 4 for n in corners) > len(corners) / 2 else {}
    return {
        "mesh": path.stem,
        "ok": True,
        "n_asked": n_quads,
        "faces": faces["n_faces"],
        "is_sound": faces["closed"] and faces["n_quads"] == faces["n_faces"],
        "is_used": flows(report),
        "n_inverted": sum(part["deform"]["n_inverted"] for part in parts),
        "cpu_s": done.cpu_s,
    } | _pairs(report["score"] or {}, artists)


def _pairs(ours: Row, artists: Row) -> Row:
    """Figures of both where the artist's model is of quads."""
    names = ("loop_edges_pct", "alignment_deg", "spiral_pct") if artists else ()
    return {name: ours.get(name) for name in names} | {
        f"artists_{name}": artists.get(name) for name in names
    }


def _score(bench: Bench, path: Path) -> Row:
    """The artist's own mesh as if it were a result."""
    done, report = bench.program("score", path, path)
    return report if done.ok else {}
