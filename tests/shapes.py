"""Meshes made of numbers, chosen by property."""

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int32]]


def ball(rows: int = 40, columns: int = 60) -> Arrays:
    """A closed lumpy ball of 2 × (rows - 1) × columns triangles."""
    lat = np.linspace(0, np.pi, rows + 1)[1:-1]
    lon = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    lat, lon = np.meshgrid(lat, lon, indexing="ij")
    radius = 1 + 0.2 * np.sin(3 * lat) * np.cos(2 * lon)
    ring = np.stack([np.sin(lat) * np.cos(lon), np.sin(lat) * np.sin(lon), np.cos(lat)], -1)
    points = np.concatenate([(radius[..., None] * ring).reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    return points.astype(np.float32), *faces_of(_ball_triangles(rows, columns))


def ball_of_quads(rows: int = 20, columns: int = 30) -> Arrays:
    """The same ball with quads between its poles, whose fans stay triangles."""
    positions, _, corners = ball(rows, columns)
    triangles = corners.reshape(-1, 3)
    strips = triangles[columns:-columns].reshape(rows - 2, 2, columns, 3)
    quads = np.concatenate([strips[:, 0], strips[:, 1, :, 2:]], -1).reshape(-1, 4)
    fans = np.concatenate([triangles[:columns], triangles[-columns:]])
    starts = np.concatenate(
        [4 * np.arange(len(quads)), 4 * len(quads) + 3 * np.arange(len(fans))]
    ).astype(np.int32)
    return positions, starts, np.concatenate([quads.ravel(), fans.ravel()]).astype(np.int32)


def box(n: int, sides: tuple[float, float, float] = (1, 2, 3)) -> Arrays:
    """A box of 6 n² quads: sharp edges, eight irregular vertices."""
    numbers: dict[tuple[int, ...], int] = {}
    corners = []
    for axis in range(3):
        for end in (0, n):
            for i, j in np.ndindex(n, n):
                ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                for u, v in ring if end else ring[::-1]:
                    place = tuple(np.roll((end, u, v), axis).tolist())
                    corners.append(numbers.setdefault(place, len(numbers)))
    positions = np.array(list(numbers), np.float32) * np.array(sides, np.float32) / n
    starts = np.arange(0, len(corners), 4, dtype=np.int32)
    return positions, starts, np.array(corners, np.int32)


def faces_of(triangles: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Triangles as starts and corners."""
    starts = np.arange(0, 3 * len(triangles), 3, dtype=np.int32)
    return starts, np.ascontiguousarray(triangles.ravel(), np.int32)


def _ball_triangles(rows: int, columns: int) -> NDArray[np.int32]:
    here = np.arange(columns)
    there = (here + 1) % columns
    top, bottom = (rows - 1) * columns, (rows - 1) * columns + 1
    last = (rows - 2) * columns
    triangles = [np.stack([np.full(columns, top), here, there], -1)]
    for row in range(rows - 2):
        a, b = row * columns, (row + 1) * columns
        triangles.append(np.stack([a + here, b + here, b + there], -1))
        triangles.append(np.stack([a + here, b + there, a + there], -1))
    triangles.append(np.stack([np.full(columns, bottom), last + there, last + here], -1))
    return np.concatenate(triangles).astype(np.int32)
