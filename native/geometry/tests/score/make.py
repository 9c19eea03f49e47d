"""Makes the meshes of this folder and the figures that the quality tool gives them.

    python native/geometry/tests/score/make.py ../shared/tools

The folder named holds the tool `quality`; what it needs is in its requirements.txt. Coordinates are
multiples of 1 / 8192, so that they are the same numbers in a file and in single precision.
"""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent
Points = NDArray[np.float64]
Mesh = tuple[Points, list[list[int]]]


def main() -> None:
    """Writes every pair as OBJ files, and figures.json."""
    figures = {}
    for name, (make_input, make_output, target) in PAIRS.items():
        paths = [HERE / f"{name}_{role}.obj" for role in ("input", "output")]
        for path, make in zip(paths, (make_input, make_output), strict=True):
            write(path, *make())
        figures[name] = {"target": target, **measured(*paths, target)}
    (HERE / "figures.json").write_text(json.dumps(figures, indent=1) + "\n")


def measured(source: Path, output: Path, target: int) -> dict[str, float | None]:
    """Returns what the quality tool prints."""
    command = [sys.executable, "-m", "quality", source, output, "--json", "--more"]
    command += ["--target", str(target)]
    done = subprocess.run(command, cwd=sys.argv[1], check=True, capture_output=True, text=True)
    result = json.loads(done.stdout)
    return {key: value for key, value in result.items() if key not in ("input", "output")}


def write(path: Path, points: Points, faces: list[list[int]]) -> None:
    """Writes an OBJ file."""
    points = np.round(points * 8192) / 8192
    lines = [f"v {x:.13g} {y:.13g} {z:.13g}" for x, y, z in points + 0.0]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def cube(n: int, shape: Callable[[Points], Points]) -> Mesh:
    """Returns the cube [-1, 1]³, n × n quads a side, mapped."""
    points, faces, index = [], [], {}

    def vertex(at: tuple[int, ...]) -> int:
        if at not in index:
            index[at] = len(points)
            points.append([2 * k / n - 1 for k in at])
        return index[at]

    for axis in range(3):
        for end in (0, n):
            for i, j in np.ndindex(n, n):
                ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                quad = [vertex(tuple(np.roll((end, u, v), axis))) for u, v in ring]
                faces.append(quad if end else quad[::-1])
    return shape(np.array(points)), faces


def tube(n_around: int, n_along: int) -> Mesh:
    """Returns an open tube whose radius swells."""
    along, around = np.mgrid[: n_along + 1, :n_around]
    z = 4 * along.ravel() / n_along
    angle = 2 * np.pi * around.ravel() / n_around
    radius = 1 + 0.2 * np.sin(2 * z)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1)

    def at(i: int, j: int) -> int:
        return i * n_around + j % n_around

    faces = [
        [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]
        for i, j in np.ndindex(n_along, n_around)
    ]
    return points, faces


def torus(n_around: int, n_tube: int, twist: int) -> Mesh:
    """Returns quads on a torus, shifted by `twist` once around the tube."""
    i, j = np.mgrid[:n_around, :n_tube].reshape(2, -1)
    a, b = 2 * np.pi * (i + twist * j / n_tube) / n_around, 2 * np.pi * j / n_tube
    radius = 1 + 0.4 * np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), 0.4 * np.sin(b)], 1)

    def at(i: int, j: int) -> int:
        return (i + twist * (j // n_tube)) % n_around * n_tube + j % n_tube

    faces = [
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
        for i, j in np.ndindex(n_around, n_tube)
    ]
    return points, faces


def triangulated(mesh: Mesh) -> Mesh:
    """Returns the mesh with every other polygon cut into triangles the other way round."""
    faces = []
    for number, face in enumerate(mesh[1]):
        face = face[number % 2 :] + face[: number % 2]
        faces += [[face[0], face[k], face[k + 1]] for k in range(1, len(face) - 1)]
    return mesh[0], faces


def unit(points: Points) -> Points:
    """Returns the points pulled to the unit sphere."""
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def lumpy(points: Points) -> Points:
    """Returns a ball with lumps and a bent limb."""
    ball = unit(points)
    x, y, z = ball.T
    radius = 1 + 0.15 * np.sin(3 * x + 1) + 0.1 * np.cos(4 * y - z) + 1.5 * np.exp(8 * (z - 1))
    out = ball * radius[:, None]
    out[:, 0] += 0.15 * out[:, 2] ** 2
    return out


def jittered(points: Points) -> Points:
    """Returns the points moved a little, the same way every time."""
    return points + np.random.default_rng(1).normal(size=points.shape) * 0.02


def mixed() -> Mesh:
    """Returns a tube of triangles, quads and pentagons, with points that no face uses."""
    points, faces = tube(10, 8)
    faces = [face for face in faces if face[0] not in (13, 14)]
    kept = faces[:40]
    for face in faces[40:]:
        kept += [face[:3], [face[2], face[3], face[0]]]
    middle = len(points)
    points = np.concatenate([jittered(points), [[0.0, 0.0, 9.0], [0.0, 0.0, 0.0]]])
    kept[3:5] = [kept[3][:3], [*kept[4], middle + 1]]
    return points, kept


def broken() -> Mesh:
    """Returns overlapping balls with a fin, a turned face and faces without area."""
    points, faces = cube(5, lumpy)
    more = points * 0.7 + [0.6, 0.1, 0.2]
    faces = faces + [[i + len(points) for i in face] for face in faces]
    faces[7] = faces[7][::-1]
    faces += [[faces[20][0], faces[20][1], 2 * len(points)], [3, 4, 4], [9, 9, 9, 9]]
    return np.concatenate([points, more, [[2.0, 2.0, 2.0]]]), faces


def letter(whole: bool) -> Mesh:
    """Returns a thick letter U whose front and back are one concave polygon each, or cut up."""
    outline = [(0, 0), (3, 0), (3, 3), (2, 3.5), (2, 1), (1, 1), (1, 3), (0, 3)]
    points = np.array([(x, y, z) for z in (0, 1) for x, y in outline])
    faces = [[i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8] for i in range(8)]
    pieces = [[*range(8)]] if whole else [[0, 5, 6, 7], [0, 1, 4, 5], [1, 2, 3, 4]]
    front = [[i + 8 for i in piece] for piece in pieces]
    return points, faces + front + [piece[::-1] for piece in pieces]


PAIRS = {
    "01_lumpy": (lambda: triangulated(cube(16, lumpy)), lambda: cube(7, lumpy), 300),
    "02_sharp": (lambda: cube(8, np.array), lambda: cube(4, jittered), 100),
    "03_spiral": (lambda: torus(40, 16, 0), lambda: torus(30, 12, 1), 400),
    "04_open": (lambda: triangulated(tube(24, 20)), mixed, 80),
    "05_broken": (lambda: cube(8, lumpy), broken, 250),
    "06_triangles": (lambda: cube(12, lumpy), lambda: triangulated(cube(6, lumpy)), 200),
    "07_letter": (lambda: letter(whole=False), lambda: letter(whole=True), 20),
}

if __name__ == "__main__":
    main()
