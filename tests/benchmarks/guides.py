"""Draws rings round eyes, mouths, wrists and necks, and measures how edges lie to them.

    python tests/benchmarks/guides.py PROGRAM [--half tuning|report] [--strength exact|follow]

The rings are where a sphere round a landmark cuts the surface, as uneven as the triangles that they
cross. For each it prints how far the closed chain of edges along it is from it, in mean edges of
the result, at most and in the mean, and by how many degrees edges turn from it in the mean. Half of
the rings is for choosing settings, the other for figures.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
N_STRETCHES = 4
ON_IT = 0.25

# The meshes of the people share their vertices: landmarks are vertices, rings (vertex, radius).
PERSON = {
    "left eye": (None, (0.32, 7.35), 0.2),
    "right eye": (None, (-0.32, 7.35), 0.2),
    "mouth": (None, (0.0, 6.65), 0.55),
    "left wrist": (9694, None, 1.9),
    "right wrist": (3026, None, 1.9),
    "neck": (879, None, 2.5),
}
WRISTS = ["left wrist", "right wrist"]
RINGS = {
    "tuning": {
        "makehuman/body.obj": ["left eye", "mouth", *WRISTS, "neck"],
        "poses/human_f/pose_01.obj": ["right eye", "mouth", *WRISTS, "neck"],
    },
    "report": {
        "poses/human_m/pose_03.obj": ["left eye", "mouth", *WRISTS, "neck"],
        "poses/human_f/pose_05.obj": ["right eye", "neck"],
        "dev/spot.obj": ["left eye", "right eye", "neck"],
    },
}
SPOT = {
    "left eye": ((0.22, 0.62, -0.62), 0.11),
    "right eye": ((-0.22, 0.62, -0.62), 0.11),
    "neck": ((0.0, 0.55, -0.62), 0.72),
}


def read(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    """The vertices and faces of an OBJ file."""
    points, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return np.array(points), faces


def triangles(faces: list[list[int]]) -> np.ndarray:
    """Faces as fans."""
    return np.array([[f[0], f[i], f[i + 1]] for f in faces for i in range(1, len(f) - 1)])


def length(loop: np.ndarray) -> float:
    """How long a closed line is."""
    return float(np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1).sum())


def ring(
    points: np.ndarray, corners: np.ndarray, place: tuple[np.ndarray, float], is_face: bool
) -> np.ndarray:
    """The closed line at a distance from a place: round a limb the shortest, else the longest."""
    centre, radius = place
    value = np.linalg.norm(points - centre, axis=1) - radius
    value[value == 0] = 1e-12
    following = {}
    for face in corners[(np.sign(value[corners]) != np.sign(value[corners[:, :1]])).any(axis=1)]:
        ends = {}
        for i in range(3):
            a, b = int(face[i]), int(face[(i + 1) % 3])
            if value[a] * value[b] < 0:
                ends[value[a] < 0] = (min(a, b), max(a, b))
        following[ends[True]] = ends[False]
    loops = []
    while following:
        start, at = following.popitem()
        loop = [start]
        while at != start and at in following:
            loop.append(at)
            at = following.pop(at)
        a, b = np.array(loop).T
        share = (value[a] / (value[a] - value[b]))[:, None]
        loops.append(points[a] + share * (points[b] - points[a]))
    # A sphere round a hand may cut the head too.
    return max(loops, key=len) if is_face else min(loops, key=length)


def landmarks(name: str, points: np.ndarray) -> dict[str, tuple[np.ndarray, float]]:
    """The places and radii of a mesh's rings."""
    if name.startswith("dev/"):
        places = {part: (np.array(at), radius) for part, (at, radius) in SPOT.items()}
        return {k: (points[KDTree(points).query(p)[1]], r) for k, (p, r) in places.items()}
    body, _ = read(DATA / "makehuman" / "body.obj")
    found = {}
    for part, (vertex, place, radius) in PERSON.items():
        if vertex is None:
            off = np.linalg.norm(body[:, :2] - np.array(place), axis=1) - 0.5 * body[:, 2]
            vertex = int(np.argmin(off))
        found[part] = (points[vertex], radius)
    return found


def write_rings(path: Path, rings: dict[str, np.ndarray], strength: str) -> None:
    """The rings as closed OBJ lines."""
    lines, n = [], 0
    for name, loop in rings.items():
        lines.append(f"o {strength} {name}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in loop.tolist()]
        ids = [str(n + 1 + i) for i in range(len(loop))]
        lines.append("l " + " ".join([*ids, ids[0]]))
        n += len(loop)
    path.write_text("\n".join(lines) + "\n")


def spaced(loop: np.ndarray, step: float) -> np.ndarray:
    """Points of a closed line at even steps, the first again at the end."""
    closed = np.vstack([loop, loop[:1]])
    at = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    wanted = np.linspace(0, at[-1], max(int(at[-1] / step), 8) + 1)
    return np.column_stack([np.interp(wanted, at, closed[:, k]) for k in range(3)])


class Result:
    """The quads of a result, to be held against rings."""

    def __init__(self, points: np.ndarray, faces: list[list[int]]) -> None:
        self.points = points
        self.faces = np.array([f for f in faces if len(f) == 4])
        ends = np.array([[a, b] for f in faces for a, b in zip(f, f[1:] + f[:1], strict=True)])
        self.ends = np.unique(np.sort(ends, axis=1), axis=0)
        self.edge = np.linalg.norm(points[self.ends[:, 0]] - points[self.ends[:, 1]], axis=1).mean()

    def chain(self, loop: np.ndarray) -> tuple[float, float]:
        """How far the chain of edges along a ring is from it: at most, in the mean."""
        line = spaced(loop, 0.05 * self.edge)
        n = len(line) - 1
        stops = [k * n // N_STRETCHES for k in range(N_STRETCHES + 1)]
        tree = KDTree(self.points)
        at = [int(tree.query(line[i])[1]) for i in stops[:-1]]
        off = []
        for k in range(N_STRETCHES):
            stretch = KDTree(line[stops[k] : stops[k + 1] + 1])
            away = stretch.query(self.points)[0] / self.edge
            near = (away[self.ends] < 1.0).all(axis=1)
            a, b = self.ends[near].T
            length = np.linalg.norm(self.points[a] - self.points[b], axis=1)
            cost = length * (0.02 + ((away[a] + away[b]) / 2) ** 2)
            graph = coo_matrix((cost, (a, b)), shape=(len(self.points),) * 2).tocsr()
            to = at[(k + 1) % N_STRETCHES]
            _, before = dijkstra(graph, directed=False, indices=at[k], return_predecessors=True)
            way = [to]
            while way[-1] != at[k] and before[way[-1]] >= 0:
                way.append(int(before[way[-1]]))
            if way[-1] != at[k]:
                return np.inf, np.inf
            places = self.points[way]
            places = np.vstack([places, (places[1:] + places[:-1]) / 2])
            off.append(KDTree(line).query(places)[0] / self.edge)
        off = np.concatenate(off)
        return float(off.max()), float(off.mean())

    def angle(self, loop: np.ndarray) -> float:
        """By how many degrees edges turn from a ring, in the mean."""
        line = spaced(loop, 0.1 * self.edge)
        middles = self.points[self.faces].mean(axis=1)
        way = np.diff(line, axis=0)
        face = KDTree(middles).query((line[1:] + line[:-1]) / 2)[1]
        a, b, c, d = (self.points[self.faces[face, i]] for i in range(4))
        arms = [(b - a) + (c - d), (d - a) + (c - b)]
        normal = np.cross(arms[0], arms[1])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        way -= normal * (way * normal).sum(axis=1)[:, None]
        cosines = [
            np.abs((arm * way).sum(axis=1))
            / (np.linalg.norm(arm, axis=1) * np.linalg.norm(way, axis=1))
            for arm in arms
        ]
        angles = np.degrees(np.arccos(np.clip(np.maximum(*cosines), 0, 1)))
        return float(angles.mean())


def remesh(asked: argparse.Namespace, name: str, rings: dict[str, np.ndarray]) -> Result:
    """What the program makes of a mesh along some rings."""
    stem = f"{name.replace('/', '_')[:-4]}_{asked.strength}"
    lines, out = asked.out / f"{stem}_rings.obj", asked.out / f"{stem}.obj"
    write_rings(lines, rings, asked.strength)
    command = [asked.program, "remesh", str(DATA / name), str(out), "--faces", str(asked.faces)]
    if asked.strength != "none":
        command += ["--guides", str(lines)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    print(name, run.stderr.strip() or "no warnings", flush=True)
    return Result(*read(out))


def main() -> None:
    """Runs the program on every mesh and prints a line for each ring."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--half", choices=list(RINGS), default="tuning")
    parser.add_argument("--faces", type=int, default=3000)
    parser.add_argument("--strength", choices=["exact", "follow", "none"], default="exact")
    parser.add_argument("--out", type=Path, default=Path(tempfile.gettempdir()))
    parser.add_argument("--only", default="", help="meshes whose name has this in it")
    parser.add_argument("--apart", action="store_true", help="a run for each ring")
    asked = parser.parse_args()
    laid, angles = [], []
    for name, parts in RINGS[asked.half].items():
        if asked.only not in name:
            continue
        points, faces = read(DATA / name)
        places, corners = landmarks(name, points), triangles(faces)
        rings = {p: ring(points, corners, places[p], "wrist" not in p) for p in parts}
        runs = [{part: loop} for part, loop in rings.items()] if asked.apart else [rings]
        for some in runs:
            result = remesh(asked, name, some)
            for part, loop in some.items():
                most, mean = result.chain(loop)
                angles.append(result.angle(loop))
                laid.append(most <= ON_IT)
                told = f"at most {most:5.2f}, mean {mean:5.3f} edges, {angles[-1]:5.1f} degrees"
                print(f"  {part:12} {told}", flush=True)
    n_laid = sum(laid)
    print(f"{n_laid} of {len(laid)} within {ON_IT} edges, mean angle {np.mean(angles):.1f} degrees")


if __name__ == "__main__":
    main()
