"""Meshes made of numbers, chosen by property."""

from typing import Any

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


def on_the_ring(mesh: Any) -> tuple[NDArray[np.bool_], float]:  # noqa: ANN401
    """Which edges of a Blender mesh lie in the plane z = 0, and their length in all."""
    points = np.array([vertex.co for vertex in mesh.vertices])
    ends = points[np.array([edge.vertices for edge in mesh.edges])]
    is_on = (np.abs(ends[..., 2]) < 1e-4).all(axis=1)
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    return is_on, float(lengths[is_on].sum())


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


def split_along(mesh: Any, name: str) -> None:  # noqa: ANN401
    """Splits the vertices of a Blender mesh where values of its corners differ, as importers do."""
    corners = np.array([corner.vertex_index for corner in mesh.loops])
    values = np.array([tuple(each.vector) for each in mesh.attributes[name].data])
    keys = np.column_stack([corners, np.round(values * 1e5)])
    _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    old = corners[first]
    starts = [face.loop_start for face in mesh.polygons]
    smooth = [face.use_smooth for face in mesh.polygons]
    points = np.array([vertex.co for vertex in mesh.vertices])[old]
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.polygons.foreach_set("loop_start", starts)
    mesh.polygons.foreach_set("use_smooth", smooth)
    mesh.loops.foreach_set("vertex_index", which.ravel().astype(np.int32))
    mesh.update(calc_edges=True)
    layer = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT2", "CORNER")
    layer.data.foreach_set("vector", values.astype(np.float32).ravel())
