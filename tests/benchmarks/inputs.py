"""Meshes to measure on: those of a data folder, and larger ones made from them."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]


@dataclass(frozen=True)
class Listed:
    """A mesh of a data folder as its manifest describes it."""

    path: Path
    role: str
    genus: int
    components: int
    is_closed: bool

    @property
    def name(self) -> str:
        """The file's name without suffix."""
        return self.path.stem


def listed(folder: Path) -> list[Listed]:
    """The meshes of a folder's manifest.csv."""
    with (folder / "manifest.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [
        Listed(
            folder / row["file"],
            row.get("role", row.get("pack", "")),
            int(float(row["genus"])),
            int(row["components"]),
            row["closed"] == "True",
        )
        for row in rows
    ]


def balls(folder: Path) -> list[Listed]:
    """The meshes whose every part is closed and of genus 0."""
    return [mesh for mesh in listed(folder) if mesh.is_closed and mesh.genus == 0]


def single_balls(folder: Path) -> list[Listed]:
    """The closed models and CAD parts of genus 0: what the figures are measured on."""
    return [m for m in balls(folder) if m.components == 1 and m.role in {"closed", "cad"}]


def subdivide(points: Points, triangles: Triangles) -> tuple[Points, Triangles]:
    """One Loop subdivision of a closed triangle mesh."""
    n = len(points)
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    edges, edge_of = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    edge_of = edge_of.reshape(-1)
    opposite = np.zeros((len(edges), 3))
    np.add.at(opposite, edge_of, points[np.roll(triangles, -2, axis=1).reshape(-1)])
    middles = 3 / 8 * points[edges].sum(1) + opposite / 8
    valence = np.bincount(edges.reshape(-1), minlength=n)
    ring = np.zeros((n, 3))
    np.add.at(ring, edges[:, 0], points[edges[:, 1]])
    np.add.at(ring, edges[:, 1], points[edges[:, 0]])
    weight = np.where(valence > 3, 3 / (8 * np.maximum(valence, 1)), 3 / 16)[:, None]
    moved = points * (1 - valence[:, None] * weight) + weight * ring
    ab, bc, ca = (edge_of.reshape(-1, 3) + n).T
    a, b, c = triangles.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    finer = np.concatenate([np.stack(part, axis=1) for part in parts])
    return np.concatenate([moved, middles]), finer


def resized(points: Points, triangles: Triangles, n_triangles: int) -> tuple[Points, Triangles]:
    """The same shape with exactly this many triangles: Loop subdivision, then quadric collapses."""
    import fast_simplification

    while len(triangles) < n_triangles:
        points, triangles = subdivide(points, triangles)
    if len(triangles) > n_triangles:
        out = fast_simplification.simplify(
            points.astype(np.float32).astype(np.float64),
            triangles.astype(np.int32),
            target_count=n_triangles,
        )
        points, triangles = out[0].astype(np.float64), out[1].astype(np.int64)
    return points, triangles


def is_ball(points: Points, triangles: Triangles) -> bool:
    """Whether triangles make one closed surface of genus 0, every edge run through both ways."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    forward = np.unique(ends, axis=0)
    both_ways = np.array_equal(forward, np.unique(ends[:, ::-1], axis=0))
    n_used = len(np.unique(triangles))
    is_manifold = len(forward) == len(ends) and both_ways and n_used == len(points)
    return is_manifold and n_used - len(ends) // 2 + len(triangles) == 2


def write_obj(path: Path, points: Points, triangles: Triangles) -> None:
    """Writes triangles with nine digits, as most programs do."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist())
