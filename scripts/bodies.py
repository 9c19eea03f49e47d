"""Makes human bodies to train on: bodies.py DATA/makehuman OUT --most N.

Each is MakeHuman's closed base mesh with a random build, height and details, all CC0. Bodies of one
ancestry, sex and age share a name but for its number: `orbflow prepare` keeps such files on one
side, so that a held-back body is of a kind that training saw none of. Body i is the same whatever
else is made. With `--poses DATA/poses` two of three bodies of a kind are bent, one of them mildly.
"""

import argparse
import random
import tarfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from poses import Rig

# Folders of details that change the outline; faces are too small to matter.
PLACES = ("arms", "feet", "hands", "head", "hip", "legs", "neck", "pelvis", "stomach", "torso")
# How the names of details end that exclude each other.
ENDS = ("-incr", "-decr", "-up", "-down", "-in", "-out", "-forward", "-backward")
ANCESTRIES = ("african", "asian", "caucasian")
SEXES = ("female", "male")
AGES = ("baby", "child", "old", "young")
# How far limbs of the bodies of a kind turn, in turn.
BENT = (0.0, 1.0, 0.4)
Vertex = tuple[float, float, float]
Target = list[tuple[int, Vertex]]


def read_base(path: Path) -> tuple[list[Vertex], list[str]]:
    """Reads the vertices of an OBJ file and its lines of faces."""
    vertices: list[Vertex] = []
    faces: list[str] = []
    for line in path.read_text().splitlines():
        if line.startswith("v "):
            x, y, z = map(float, line.split()[1:4])
            vertices.append((x, y, z))
        elif line.startswith("f "):
            faces.append(line)
    return vertices, faces


def read_targets(path: Path, n_vertices: int) -> dict[str, Target]:
    """Reads all targets of the packed file by their names, for the first vertices alone."""
    targets: dict[str, Target] = {}
    with tarfile.open(path) as packed:
        for member in packed:
            stream = packed.extractfile(member) if member.name.endswith(".target") else None
            if stream is None:
                continue
            moves: Target = []
            for line in stream.read().decode().splitlines():
                if line.strip() and not line.startswith("#"):
                    index, x, y, z = line.split()
                    if int(index) < n_vertices:
                        moves.append((int(index), (float(x), float(y), float(z))))
            name = member.name.removeprefix("targets/").removesuffix(".target")
            targets[name] = moves
    return targets


def details(names: list[str]) -> list[list[tuple[str, str]]]:
    """The details of a body, each with what excludes it, left and right as one."""
    groups: dict[str, set[tuple[str, str]]] = {}
    for name in names:
        folder, _, rest = name.partition("/")
        if folder not in PLACES:
            continue
        both = rest.removeprefix("l-").removeprefix("r-")
        stem = both
        for end in ENDS:
            stem = stem.removesuffix(end)
        groups.setdefault(f"{folder}/{stem}", set()).add((folder, both))
    return [sorted(group) for _, group in sorted(groups.items())]


def weights(
    kind: str, names: list[str], groups: list[list[tuple[str, str]]], chance: random.Random
) -> dict[str, float]:
    """Chooses the targets of a body, of sorted names, and how much each counts."""
    _, sex, age = kind.split("-")
    build = [n for n in names if n.startswith(f"macrodetails/universal-{sex}-{age}-")]
    chosen = {f"macrodetails/{kind}": 1.0, chance.choice(build): chance.uniform(0.5, 1)}
    for folder in ("height", "proportions"):
        of = [n for n in names if n.startswith(f"macrodetails/{folder}/{sex}-{age}-")]
        if of:
            chosen[chance.choice(of)] = chance.uniform(0, 1)
    for group in groups:
        if chance.random() < 0.5:
            folder, detail = chance.choice(group)
            weight = chance.uniform(0, 1)
            for side in ("", "l-", "r-"):
                if f"{folder}/{side}{detail}" in names:
                    chosen[f"{folder}/{side}{detail}"] = weight
    return chosen


def bodies(folder: Path, most: int, rig: Rig | None = None) -> Iterator[tuple[str, str]]:
    """The names of OBJ files and their texts; bent by a rig, if there is one."""
    vertices, faces = read_base(folder / "body.obj")
    targets = read_targets(folder / "targets.tar.xz", len(vertices))
    names = sorted(targets)
    groups = details(names)
    kinds = [f"{a}-{s}-{age}" for a in ANCESTRIES for s in SEXES for age in AGES]
    for i in range(most):
        kind = kinds[i % len(kinds)]
        chance = random.Random(i)
        moved = [list(v) for v in vertices]
        for name, weight in weights(kind, names, groups, chance).items():
            for index, move in targets[name]:
                for axis in range(3):
                    moved[index][axis] += weight * move[axis]
        bent = BENT[i // len(kinds) % len(BENT)]
        if rig is not None and bent > 0:
            moved = rig.posed(np.array(moved), chance, bent).tolist()
        lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in moved]
        yield f"{kind}_{i // len(kinds):03}.obj", "\n".join([*lines, *faces, ""])


def main() -> None:
    """Writes the bodies and the table of their licence that `orbflow prepare` reads."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("makehuman", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--most", type=int, required=True)
    parser.add_argument("--poses", type=Path)
    arguments = parser.parse_args()
    rig = Rig(arguments.poses) if arguments.poses else None
    arguments.out.mkdir(parents=True, exist_ok=True)
    table = ["file,licence"]
    for name, text in bodies(arguments.makehuman, arguments.most, rig):
        (arguments.out / name).write_text(text)
        table.append(f"{name},CC0-1.0")
    (arguments.out / "licences.csv").write_text("\n".join([*table, ""]))


if __name__ == "__main__":
    main()
