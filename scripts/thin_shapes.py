"""Makes thin closed shapes, remeshes them and prints how well that went.

    python scripts/thin_shapes.py PROGRAM FOLDER [--half choose|report|all] [--only NAME]

Settings are chosen by looking at one half of the shapes and checked on the other. Needs numpy, and
the quality tools beside the checkout for the figures.
"""

import argparse
import json
import math
import resource
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Faces = list[list[int]]
Way = Sequence[Sequence[float]]

TOOLS = Path(__file__).resolve().parents[2] / "shared" / "tools"


def tube(
    way: Way, radius: float, n_round: int, *, tips: float = 0.0, closed_tips: bool = False
) -> tuple[Points, Faces]:
    """Rings of corners round a way; ends are flat n-gons, or go to a point."""
    path = np.asarray(way, float)
    tangents = np.gradient(path, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    up = np.cross(tangents[0], [0.3, 0.5, 0.8])
    points, faces = [], []
    for i, (at, tangent) in enumerate(zip(path, tangents, strict=True)):
        up -= tangent * (up @ tangent)
        up /= np.linalg.norm(up)
        side = np.cross(tangent, up)
        end = min(i, len(path) - 1 - i) / (len(path) - 1)
        scale = radius * (1.0 if not tips else min(1.0, max(end / tips, 0.05)))
        for k in range(n_round):
            angle = 2 * math.pi * k / n_round
            points.append(at + scale * (math.cos(angle) * up + math.sin(angle) * side))
    for i in range(len(path) - 1):
        for k in range(n_round):
            a, b = i * n_round + k, i * n_round + (k + 1) % n_round
            faces.append([a, b, b + n_round, a + n_round])
    last = (len(path) - 1) * n_round
    if closed_tips:
        low, high = len(points), len(points) + 1
        points += [path[0] - tangents[0] * radius, path[-1] + tangents[-1] * radius]
        for k in range(n_round):
            nxt = (k + 1) % n_round
            faces += [[nxt, k, low], [last + k, last + nxt, high]]
    else:
        faces += [list(range(n_round))[::-1], [last + k for k in range(n_round)]]
    return np.array(points), faces


def line(n: int, length: float) -> Way:
    """A straight way."""
    return [[length * i / (n - 1), 0, 0] for i in range(n)]


def helix(turns: float, radius: float, pitch: float, n: int) -> Way:
    """The way of a spring."""
    angles = [2 * math.pi * turns * i / (n - 1) for i in range(n)]
    return [[radius * math.cos(a), radius * math.sin(a), pitch * a / 2 / math.pi] for a in angles]


def wave(n: int, length: float, height: float, waves: float) -> Way:
    """A way that swings to the sides and up and down."""
    steps = [i / (n - 1) for i in range(n)]
    return [
        [length * s, height * math.sin(2 * math.pi * waves * s), height * math.cos(5 * s)]
        for s in steps
    ]


def sheet(
    n: int,
    m: int,
    thickness: float,
    surface: Callable[[float, float], tuple[float, float, float]],
    *,
    is_round: bool = False,
) -> tuple[Points, Faces]:
    """Two sides and a rim between them; a disc where it is round."""
    grid = {}
    top, bottom = [], []
    for i in range(n + 1):
        for j in range(m + 1):
            u, v = i / n * 2 - 1, j / m * 2 - 1
            if is_round:
                big = max(abs(u), abs(v))
                long = math.hypot(u, v)
                u, v = (u * big / long, v * big / long) if long else (0.0, 0.0)
            at = np.array(surface(u, v), float)
            e = 1e-4
            du = np.array(surface(u + e, v)) - np.array(surface(u - e, v))
            dv = np.array(surface(u, v + e)) - np.array(surface(u, v - e))
            normal = np.cross(du, dv)
            normal /= np.linalg.norm(normal)
            grid[i, j] = len(top)
            top.append(at + normal * thickness / 2)
            bottom.append(at - normal * thickness / 2)
    k = len(top)
    faces = []
    for i in range(n):
        for j in range(m):
            quad = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
            faces += [quad, [v + k for v in reversed(quad)]]
    rim = [(i, 0) for i in range(n)] + [(n, j) for j in range(m)]
    rim += [(n - i, m) for i in range(n)] + [(0, m - j) for j in range(m)]
    for a, b in zip(rim, rim[1:] + rim[:1], strict=True):
        a, b = grid[a], grid[b]
        faces.append([b, a, a + k, b + k])
    return np.array(top + bottom), faces


SHAPES = {
    # name: (shape, faces, half)
    "pole_4_100": (lambda: tube(line(2, 100), 0.5, 4), 500, "choose"),
    "pole_6_60": (lambda: tube(line(4, 60), 0.5, 6), 300, "report"),
    "rod_16_200": (lambda: tube(line(3, 200), 0.5, 16), 1000, "choose"),
    "rod_12_30": (lambda: tube(line(2, 30), 0.5, 12), 400, "report"),
    "spoke_12_250": (lambda: tube(line(2, 250), 0.5, 12), 800, "report"),
    "needle_10_80": (lambda: tube(line(12, 80), 0.5, 10, tips=0.4), 600, "choose"),
    "pin_12_60": (lambda: tube(line(9, 60), 0.5, 12, closed_tips=True), 500, "report"),
    "spring_3": (lambda: tube(helix(3, 6, 4, 120), 0.7, 10), 1000, "choose"),
    "spring_8": (lambda: tube(helix(8, 5, 1.6, 500), 0.5, 8), 3000, "report"),
    "spring_3_few": (lambda: tube(helix(3, 6, 4, 120), 0.5, 10), 300, "report"),
    "cable_1": (lambda: tube(wave(150, 60, 6, 2), 0.25, 8), 1500, "choose"),
    "cable_2": (lambda: tube(wave(300, 120, 9, 4), 0.15, 6), 2000, "report"),
    "wire_500": (lambda: tube(wave(400, 500, 30, 3), 0.5, 8), 2000, "choose"),
    "elbow": (
        lambda: tube([[0, 0, 0], [30, 0, 0], [30, 30, 0], [30, 30, 30]], 0.6, 12),
        600,
        "report",
    ),
    "slab_01": (lambda: sheet(10, 8, 0.02, lambda u, v: (u, 0.8 * v, 0)), 800, "choose"),
    "slab_002": (lambda: sheet(12, 6, 0.004, lambda u, v: (u, 0.5 * v, 0)), 1000, "report"),
    "wavy_005": (
        lambda: sheet(20, 12, 0.01, lambda u, v: (u, 0.7 * v, 0.1 * math.sin(4 * u + v))),
        1500,
        "choose",
    ),
    "roof_004": (
        lambda: sheet(16, 10, 0.008, lambda u, v: (u, 0.6 * v, 0.15 * (1 - u * u))),
        700,
        "report",
    ),
    "disc_005": (
        lambda: sheet(16, 16, 0.01, lambda u, v: (u, v, 0.1 * u * v), is_round=True),
        900,
        "choose",
    ),
    "dish_003": (
        lambda: sheet(20, 20, 0.006, lambda u, v: (u, v, 0.3 * (u * u + v * v)), is_round=True),
        1200,
        "report",
    ),
    "blade_01": (
        lambda: sheet(24, 6, 0.02, lambda u, v: (4 * u, 0.4 * v * (1.05 - 0.5 * u), 0.2 * u * u)),
        600,
        "report",
    ),
}


def write(path: Path, points: Points, faces: Faces) -> None:
    """Writes a mesh as OBJ."""
    rows = [f"v {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in points]
    rows += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def remesh(
    program: Path, source: Path, n_faces: int, folder: Path
) -> tuple[dict[str, Any] | None, float, Path]:
    """Runs the program; returns its report and the seconds of processor time it took."""
    out, told = folder / f"{source.stem}_out.obj", folder / f"{source.stem}.json"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "remesh", source, out, "--faces", str(n_faces), "--report", told]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if done.returncode:
        return None, cpu, out
    return json.loads(told.read_text(encoding="utf-8")), cpu, out


def figures(source: Path, out: Path) -> dict[str, Any]:
    """What the quality tools say of a result."""
    command = [sys.executable, "-m", "quality", source, out, "--json", "--more"]
    done = subprocess.run(command, cwd=TOOLS, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def row(name: str, program: Path, folder: Path, job: tuple[Path, int]) -> str:
    """One line of the table."""
    source, n_faces = job
    report, cpu, out = remesh(program, source, n_faces, folder)
    if report is None:
        return f"{name:18} failed after {cpu:.1f} s"
    part, score = report["parts"][0], figures(source, out)
    flow = part["flow"] or {}
    how = flow.get("attempt") or f"refused: {flow.get('reason')}"
    mirrored = (part["mirrored"] or {}).get("status", "-")
    off = 100 * (part["n_faces"] / n_faces - 1)
    return (
        f"{name:18} {cpu:6.1f} {part['n_faces']:5} {off:+6.1f} {score['inverted']:5.0f} "
        f"{score['self_intersections']:6} {score['hausdorff_pct']:7.3f} "
        f"{score['jacobian_p01']:6.2f} {score['irregular_pct']:6.2f} {score['spiral_pct']:5.1f} "
        f"{score['loop_edges_pct']:5.1f}  {mirrored:8} {how[:60]}"
    )


def main() -> None:
    """Makes, remeshes and measures all shapes that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--half", choices=["choose", "report", "all"], default="all")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    folder = options.folder.resolve()
    print(
        "shape              CPU s faces  off %   inv  cross  haus % jac 1  irr % spir% loop%  how"
    )
    for name, (shape, n_faces, half) in SHAPES.items():
        if options.half in ("all", half) and options.only in name:
            source = folder / f"{name}.obj"
            write(source, *shape())
            print(row(name, options.program.resolve(), folder, (source, n_faces)), flush=True)
    reports = TOOLS.parent / "data" / "reports"
    named = [("pole_8gon", 500), ("pole_8gon", 2000), ("helix_5turns", 2000), ("cloth", 1000)]
    for name, n_faces in named:
        if options.half == "all" and options.only in name:
            source = reports / f"{name}.obj"
            label = f"{name}_{n_faces}"
            print(row(label, options.program.resolve(), folder, (source, n_faces)), flush=True)


if __name__ == "__main__":
    main()
