"""Makes every picture of docs/pictures.

    python tests/pictures/make.py [--only NAME...]

Runs the built `orbflow`, and for the gallery the peers, on meshes of `shared/data/dev` beside the
checkout and renders what comes out with Blender's bpy wheel (on a machine without screen this needs
the library libegl1).
"""

import argparse
import json
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import field
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
        stem = "_".join([Path(name).name, str(n_faces), *(a.strip("-") for a in arguments)])
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

    def peer(self, name: str, peer: str, n_faces: int) -> Path | None:
        """The mesh that a peer makes by `tools/peers`; none when it makes none."""
        script = self.meshes.parents[1] / "tools" / "peers" / "run_peers.py"
        command = [sys.executable, script, self.input(name), "--targets", n_faces]
        command += ["--peers", peer, "--out", self.folder, "--blender", sys.executable]
        subprocess.run([str(part) for part in command], check=True, capture_output=True)
        mesh = self.folder / f"{Path(name).name}.{peer}.{n_faces}.obj"
        return mesh if mesh.exists() else None

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
    quads, flow_sphere, _ = studio.remesh("spot", 2000, "--kind", "quads")
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
            Exhibit(flow_sphere, "quads that flow", flow_sphere, is_y_up=False),
            Exhibit(quads, "deformed", flow_sphere),
        ],
    ]


def flow(studio: Studio) -> list[list[Exhibit]]:
    """The field that quads follow, the quads on the sphere, and those on the surface."""
    surface, colours = field.drawn(studio.input("spot"), N_QUADS, studio.folder)
    quads, sphere, _ = studio.remesh("spot", N_QUADS, "--kind", "quads")
    return [
        [
            Exhibit(surface, "the field of crosses", colours, edges=0.0),
            Exhibit(sphere, "quads that cover the sphere", sphere, is_y_up=False),
            Exhibit(quads, "irregular vertices", has_marks=True),
        ]
    ]


def gallery(studio: Studio, names: tuple[str, ...]) -> list[list[Exhibit]]:
    """Models as they came, as quads of ours and as those of two peers."""
    rows = []
    for name in names:
        ours, _, report = studio.remesh(name, N_QUADS)
        source = studio.input(name)
        row = [Exhibit(source, f"{source.stem}, {_n_faces(source):,}", edges=FINE)]
        row.append(Exhibit(ours, f"Orbflow, {report['output']['n_faces']:,}", has_marks=True))
        for peer, title in PEERS.items():
            mesh = studio.peer(name, peer, N_QUADS)
            if mesh is not None:
                row.append(Exhibit(mesh, f"{title}, {_n_faces(mesh):,}", has_marks=True))
        rows.append(row)
    return rows


N_QUADS = 2000
PEERS = {"instant_meshes": "Instant Meshes", "quadriflow": "QuadriFlow"}
GALLERIES = {
    "gallery_animals": ("spot", "cat", "koala", "fish", "penguin"),
    "gallery_thin": ("scorpion", "goathead", "nefertiti", "boat", "plane"),
    "gallery_hard": ("hammer", "sword", "wingnut", "cad_shaft", "cad_cube_bump"),
    "gallery_open": (
        *("open_demosthenes", "../makehuman/clothes/male_casualsuit03", "open_plane_holes"),
        *("cad_gear", "genus2_skull"),
    ),
}
PICTURES: dict[str, Callable[[Studio], list[list[Exhibit]]]] = {
    "overview": overview,
    "method": method,
    "flow": flow,
    **{name: partial(gallery, names=names) for name, names in GALLERIES.items()},
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
