"""Draws the grid of docs/evaluation.md: evaluation_grid.py REPORT.json MESHES ORBFLOW OUT.jpg.

Report and meshes are those of `orbflow evaluate --meshes`. Of the shapes held back, and of those of
other sets, three get a row: the one that a tenth of the proposals are better than, the middle one
and the one that a tenth are worse than. A row has the level, what the proposal rebuilds of it, and
the mesh that `orbflow remesh` makes.
"""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "pictures"))

from stage import Exhibit, picture

SIDES = ("test", "other")
SHARES = (0.1, 0.5, 0.9)
N_FACES = 1000
FINE, MIDDLE = 0.0035, 0.0045
CELL_PX = 250
LONGEST = 20


def ratio(shape: dict[str, Any]) -> float:
    """The distortion of the network's proposal in shares of the solver's."""
    proposals = shape["proposals"]
    return proposals["network"]["energy"] / proposals["solver"]["energy"]


def chosen(report: dict[str, Any]) -> list[dict[str, Any]]:
    """A good, a middling and a bad proposal of each side."""
    sides = [sorted(report["sides"][side]["shapes"], key=ratio) for side in SIDES]
    return [side[round(share * (len(side) - 1))] for side in sides for share in SHARES]


def title(name: str) -> str:
    """The name of a shape's file, as much of its end as is easy to read in a cell."""
    title = re.sub(r"(\.\w+)? part \d+$", "", name.rsplit("/")[-1])
    return title if len(title) <= LONGEST else f"…{title[-LONGEST:]}"


def row(shape: dict[str, Any], meshes: Path, remesh: list[str]) -> list[Exhibit]:
    """The level, its rebuilt shape and the finished mesh; colours are places on the sphere."""
    stem = re.sub("[^A-Za-z0-9]", "_", shape["name"])
    mesh = {
        each: meshes / f"{stem}.{each}.obj"
        for each in ("level", "level_sphere", "rebuilt", "rebuilt_sphere", "whole")
    }
    final, sphere, told = (
        meshes / f"{stem}.{each}" for each in ("final.obj", "final_sphere.obj", "final.json")
    )
    command = [*remesh, str(mesh["whole"]), str(final), "--sphere", str(sphere)]
    subprocess.run([*command, "--report", str(told)], check=True)
    report = json.loads(told.read_text())
    n_quads, repair = report["output"]["n_faces"], report["embedding"]["repair"]
    by = "solver's map" if repair["fell_back_to_solver"] else f"{repair['n_moved']} repaired"
    folds = shape["proposals"]["network"]["folds_pct"]
    return [
        Exhibit(mesh["level"], title(shape["name"]), mesh["level_sphere"], MIDDLE),
        Exhibit(
            mesh["rebuilt"],
            f"{ratio(shape):.2f}; {folds:.1f} % folded",
            mesh["rebuilt_sphere"],
            FINE,
        ),
        Exhibit(final, f"{n_quads:,} quads, {by}", sphere, MIDDLE),
    ]


def main(report: Path, meshes: Path, orbflow: Path, out: Path) -> None:
    """Draws the grid."""
    remesh = [str(orbflow), "remesh", "--predictor", "network", "--faces", str(N_FACES)]
    shapes = chosen(json.loads(report.read_text()))
    picture([row(shape, meshes, remesh) for shape in shapes], out, CELL_PX)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:5]))
