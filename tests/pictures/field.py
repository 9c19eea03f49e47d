"""Draws the field that quads follow onto the surface, as a mesh."""

from pathlib import Path

import numpy as np
import orbflow_native
from numpy.typing import NDArray

# How wide an arm is, and how far above the surface it lies, in shares of its length.
WIDTH, LIFT = 0.34, 0.1
LENGTH = 0.8
LIGHT, DARK = np.ones(3), -np.ones(3)


def drawn(source: Path, n_quads: int, folder: Path) -> tuple[Path, Path]:
    """The surface of an OBJ file of triangles with a cross for each quad, and its colours."""
    points, triangles = _read(source)
    starts = np.arange(0, triangles.size, 3, dtype=np.int32)
    made = orbflow_native.remesh(
        points.astype(np.float32),
        starts,
        triangles.ravel().astype(np.int32),
        faces=n_quads,
        kind="quads",
        n_crosses=n_quads,
    )
    arms = _arms(np.asarray(made.crosses, np.float64))
    corners = np.arange(4 * len(arms)).reshape(-1, 4) + len(points)
    faces = [*triangles.tolist(), *corners.tolist()]
    stem = f"{source.stem}_field"
    surface, colours = folder / f"{stem}.obj", folder / f"{stem}_colours.obj"
    _write(surface, np.concatenate([points, arms.reshape(-1, 3)]), faces)
    tints = [np.tile(LIGHT, (len(points), 1)), np.tile(DARK, (4 * len(arms), 1))]
    _write(colours, np.concatenate(tints), faces)
    return surface, colours


def _arms(crosses: NDArray[np.float64]) -> NDArray[np.float64]:
    """A strip along each of the two axes of every cross, above the surface."""
    place, along, across = (crosses[:, i] for i in range(3))
    normal = np.cross(along, across)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    middle = place + LIFT * length * normal
    strips = []
    for arm, side in ((along, across), (across, along)):
        end, edge = LENGTH * arm, WIDTH / 2 * side
        strips.append(
            np.stack(
                [
                    middle - end - edge,
                    middle + end - edge,
                    middle + end + edge,
                    middle - end + edge,
                ],
                axis=1,
            )
        )
    return np.concatenate(strips)


def _read(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    lines = [line.split() for line in path.read_text().splitlines()]
    points = [line[1:4] for line in lines if line[:1] == ["v"]]
    faces = [[int(c.split("/")[0]) - 1 for c in line[1:]] for line in lines if line[:1] == ["f"]]
    return np.array(points, np.float64), np.array(faces, np.int64)


def _write(path: Path, points: NDArray[np.float64], faces: list[list[int]]) -> None:
    with path.open("w") as file:
        file.writelines(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in points.tolist())
        file.writelines("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)
