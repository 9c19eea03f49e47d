"""Makes every picture of docs/pictures.

    python tests/pictures/make.py [--only NAME...]

Runs the built `orbflow` on meshes of `shared/data/dev` beside the checkout and renders what comes
out with Blender's bpy wheel (on a machine without screen this needs the library libegl1).
"""

import argparse
import json
import subprocess
from collections.abc import Callable
from pathlib import Path

from stage import Exhibit, picture

ROOT = Path(__file__).resolve().parents[2]
FINE = 0.0012


class Studio:
    """Runs the program and keeps what it writes in one folder."""

    def __init__(self, orbflow: Path, meshes: Path, folder: Path) -> None:
        """Takes the program, the folder of input meshes and a folder for its results."""
        self.orbflow, self.meshes, self.folder = orbflow, meshes, folder
        folder.mkdir(parents=True, exist_ok=True)

    def input(self, name: str) -> Path:
        """The file of an input mesh."""
        return self.meshes / f"{name}.obj"

    def remesh(self, name: str, n_faces: int, *arguments: str) -> tuple[Path, Path, dict]:
        """The new mesh, the sphere it came from, and the report."""
        stem = "_".join([name, str(n_faces), *(a.strip("-") for a in arguments)])
        mesh, sphere = self.folder / f"{stem}.obj", self.folder / f"{stem}_sphere.obj"
        report = self._run(
            "remesh", self.input(name), mesh, "--faces", n_faces, *arguments, "--sphere", sphere
        )
        return mesh, sphere, report

    def decimate(self, name: str, n_faces: int) -> Path:
        """The input with fewer triangles."""
        mesh = self.folder / f"{name}_decimated.obj"
        self._program("decimate", self.input(name), mesh, "--faces", n_faces)
        return mesh

    def embed(self, mesh: Path) -> Path:
        """The sphere that a mesh is mapped to, with the mesh's own connectivity."""
        sphere = self.folder / f"{mesh.stem}_embedded.obj"
        self._run("embed", mesh, "--sphere", sphere)
        return sphere

    def _run(self, verb: str, *arguments: str | Path | int) -> dict:
        report = self.folder / "report.json"
        self._program(verb, *arguments, "--report", report)
        return json.loads(report.read_text())

    def _program(self, *arguments: str | Path | int) -> None:
        subprocess.run([str(part) for part in (self.orbflow, *arguments)], check=True)


def overview(studio: Studio) -> list[list[Exhibit]]:
    """One model as it came, as triangles and as quads."""
    n_before = _n_faces(studio.input("spot"))
    triangles, _, first = studio.remesh("spot", 3000, "--kind", "triangles")
    quads, _, second = studio.remesh("spot", 2000, "--kind", "quads")
    return [
        [
            Exhibit(studio.input("spot"), f"input, {n_before:,} triangles", edges=FINE),
            Exhibit(triangles, f"{first['output']['n_faces']:,} triangles"),
            Exhibit(quads, f"{second['output']['n_faces']:,} quads"),
        ]
    ]


def method(studio: Studio) -> list[list[Exhibit]]:
    """The way of one model: decimated, embedded, a primitive on the sphere, deformed."""
    coarse = studio.decimate("spot", 3000)
    embedded = studio.embed(coarse)
    adaptive, adaptive_sphere, _ = studio.remesh("spot", 3000, "--kind", "triangles")
    quads, quad_sphere, _ = studio.remesh("spot", 2000, "--kind", "quads")
    return [
        [
            Exhibit(coarse, "decimated", embedded),
            Exhibit(embedded, "embedded in the sphere", embedded, is_y_up=False),
        ],
        [
            Exhibit(adaptive_sphere, "adaptive primitive", adaptive_sphere, is_y_up=False),
            Exhibit(adaptive, "deformed", adaptive_sphere),
        ],
        [
            Exhibit(quad_sphere, "quad sphere", quad_sphere, is_y_up=False),
            Exhibit(quads, "deformed", quad_sphere),
        ],
    ]


def gallery(studio: Studio) -> list[list[Exhibit]]:
    """Several models, triangles above quads."""
    names = ("cat", "koala", "fish", "wingnut", "cad_shaft")
    rows = []
    for kind, n_faces in (("triangles", 4000), ("quads", 2000)):
        made = [studio.remesh(name, n_faces, "--kind", kind) for name in names]
        rows.append(
            [Exhibit(mesh, f"{report['output']['n_faces']:,} {kind}") for mesh, _, report in made]
        )
    return rows


PICTURES: dict[str, Callable[[Studio], list[list[Exhibit]]]] = {
    "overview": overview,
    "method": method,
    "gallery": gallery,
}


def _n_faces(path: Path) -> int:
    return sum(line.startswith("f ") for line in path.read_text().splitlines())


def main() -> None:
    """Makes the pictures asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orbflow", type=Path, default=ROOT / "target/release/orbflow")
    parser.add_argument("--meshes", type=Path, default=ROOT.parent / "shared/data/dev")
    parser.add_argument("--work", type=Path, default=ROOT / "target/pictures")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/pictures")
    parser.add_argument("--only", nargs="+", choices=PICTURES, default=list(PICTURES))
    given = parser.parse_args()
    studio = Studio(given.orbflow, given.meshes, given.work)
    for name in given.only:
        picture(PICTURES[name](studio), given.out / f"{name}.png")


if __name__ == "__main__":
    main()
