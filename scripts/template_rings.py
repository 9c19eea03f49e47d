"""Finds the rings of the body template: template_rings.py DATA/makehuman OUT.json.

A ring is a closed loop of edges of the base mesh that goes straight on through vertices of four
edges. Of all such loops the one is taken that lies nearest to a joint and best across the limb.
`orbflow template DATA/makehuman/body.obj --rings OUT.json` makes the template from them.
"""

import argparse
import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Face = list[int]
# How many times lengths beyond a ring count on the common sphere: hands and heads get room.
ROOM = {"wrist": 2.2, "neck": 1.8}
# A loop along the limb counts as so many decimetres farther off than one across it.
ASLANT = 0.5
# Longer loops go round more than a limb.
MOST_EDGES = 400


def read(path: Path) -> tuple[Points, list[Face], dict[str, set[int]]]:
    """Vertices, faces, and the vertices of the faces of each group of an OBJ file."""
    vertices: list[list[float]] = []
    faces: list[Face] = []
    groups: dict[str, set[int]] = {}
    group = ""
    for line in path.read_text().splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            vertices.append([float(word) for word in words[:3]])
        elif kind == "g":
            group = words[0] if words else ""
        elif kind == "f":
            face = [int(word.split("/")[0]) - 1 for word in words]
            faces.append(face)
            groups.setdefault(group, set()).update(face)
    return np.array(vertices), faces, groups


def loops(faces: list[Face]) -> list[Face]:
    """All closed loops of edges that go straight on."""
    sides = {
        (face[i], face[(i + 1) % len(face)]): (f, i)
        for f, face in enumerate(faces)
        for i in range(len(face))
    }
    valence: dict[int, int] = {}
    for start, _ in sides:
        valence[start] = valence.get(start, 0) + 1

    def onward(start: int, end: int) -> tuple[int, int] | None:
        f, i = sides[start, end]
        if valence[end] != 4 or len(faces[f]) != 4:
            return None
        f, i = sides[faces[f][(i + 2) % 4], end]
        return (end, faces[f][(i + 2) % 4]) if len(faces[f]) == 4 else None

    found: dict[tuple[int, ...], Face] = {}
    seen: set[tuple[int, int]] = set()
    for first in sides:
        path: Face = []
        at: tuple[int, int] | None = first
        while at is not None and at not in seen and len(path) < MOST_EDGES:
            seen.add(at)
            path.append(at[0])
            at = onward(*at)
        if path and at == first and len(set(path)) == len(path):
            found.setdefault(tuple(sorted(path)), path)
    return list(found.values())


def joints(folder: Path) -> dict[str, Points]:
    """The middles of the cubes that mark joints."""
    vertices, _, groups = read(folder / "base.obj")
    cubes = {name: sorted(of) for name, of in groups.items() if name.startswith("joint-")}
    return {name.removeprefix("joint-"): vertices[of].mean(axis=0) for name, of in cubes.items()}


def wanted(at: dict[str, Points]) -> dict[str, tuple[Points, Points]]:
    """Where rings are to be, and along which way the limb runs there."""
    rings = {"neck": ((at["neck"] + at["head"]) / 2, at["head"] - at["neck"])}
    for letter, side in (("l", "left"), ("r", "right")):
        hand, elbow, shoulder, leg, knee, ankle = (
            at[f"{letter}-{name}"]
            for name in ("hand", "elbow", "shoulder", "upper-leg", "knee", "ankle")
        )
        rings |= {
            f"{side} wrist": (hand, hand - elbow),
            f"{side} elbow": (elbow, hand - shoulder),
            f"{side} shoulder": (0.75 * shoulder + 0.25 * elbow, elbow - shoulder),
            f"{side} hip": (0.85 * leg + 0.15 * knee, knee - leg),
            f"{side} knee": (knee, ankle - leg),
            f"{side} ankle": (0.9 * ankle + 0.1 * knee, knee - ankle),
        }
    return rings


def nearest(vertices: Points, all_loops: list[Face], place: Points, along: Points) -> Face:
    """The loop that lies best about a place."""
    along = along / np.linalg.norm(along)

    def off(loop: Face) -> float:
        points = vertices[loop]
        centre = points.mean(axis=0)
        across = np.cross(points - centre, np.roll(points, -1, axis=0) - centre).sum(axis=0)
        length = float(np.linalg.norm(across))
        if length < 1e-9:
            return float("inf")
        aslant = 1 - abs(float(across @ along)) / length
        return float(np.linalg.norm(centre - place)) + ASLANT * aslant

    return min(all_loops, key=off)


def main() -> None:
    """Writes the rings."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("makehuman", type=Path)
    parser.add_argument("out", type=Path)
    arguments = parser.parse_args()
    vertices, faces, _ = read(arguments.makehuman / "body.obj")
    all_loops = loops(faces)
    rings = [
        {
            "name": name,
            "vertices": nearest(vertices, all_loops, place, along),
            "room": ROOM.get(name.split()[-1], 1.0),
        }
        for name, (place, along) in wanted(joints(arguments.makehuman)).items()
    ]
    arguments.out.write_text(json.dumps(rings))


if __name__ == "__main__":
    main()
