"""Custom normals come over: the result is lit as the original is."""

from typing import Any

import bpy
import numpy as np
import pytest
from test_operator import Open, addon, press


def normals(mesh: Any) -> np.ndarray:  # noqa: ANN401
    """The normal of every corner as Blender draws it."""
    found = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", found.ravel())
    return found


def places(mesh: Any) -> np.ndarray:  # noqa: ANN401
    """The place of every corner."""
    attributes = addon("attributes")
    return attributes.positions(mesh)[attributes.corner_verts(mesh)]


def leaning(points: np.ndarray) -> np.ndarray:
    """Normals that no mesh of a ball has by itself: they lean as if it were much longer."""
    leant = points * (1, 1, 0.2) + (0.3, 0, 0)
    return leant / np.linalg.norm(leant, axis=1, keepdims=True)


def degrees_off(found: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    return np.degrees(np.arccos((found * wanted).sum(axis=1).clip(-1, 1)))


def ball(open_fixture: Open) -> Any:  # noqa: ANN401
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    thing = bpy.context.object
    thing.data.shade_smooth()
    return thing


def sharp(mesh: Any) -> np.ndarray:  # noqa: ANN401
    return np.array([edge.use_edge_sharp for edge in mesh.edges])


def test_normals_are_those_of_the_original_at_the_same_place(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    thing.data.normals_split_custom_set(leaning(places(thing.data)))
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    assert mesh.has_custom_normals
    wanted = leaning(places(mesh))
    assert degrees_off(normals(mesh), wanted).max() < 3
    assert degrees_off(places(mesh), wanted).max() > 20
    assert not sharp(mesh).any()
    assert addon("runs").last_report(thing.name)["lost"] == []
    assert not mesh.validate()


def test_normals_break_where_the_originals_do(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_cylinder_add(vertices=48)
    thing = bpy.context.object
    thing.data.shade_smooth()
    is_cap = np.repeat(
        [len(f.vertices) > 4 for f in thing.data.polygons],
        [len(f.vertices) for f in thing.data.polygons],
    )
    points = places(thing.data)
    # The wall is lit as a cone's would be.
    wall = points * (1, 1, 0) + (0, 0, 0.5)
    given = np.where(is_cap[:, None], np.sign(points) * (0, 0, 1), wall)
    thing.data.normals_split_custom_set(given / np.linalg.norm(given, axis=1, keepdims=True))
    press.orbflow_remesh(faces=600)
    mesh = thing.data
    sizes = [len(face.vertices) for face in mesh.polygons]
    up = np.repeat([face.normal.z for face in mesh.polygons], sizes)
    found, points = normals(mesh), places(mesh)
    is_top, is_wall = up > 0.99, np.abs(up) < 0.1
    assert degrees_off(found[is_top], np.array([[0, 0, 1.0]])).max() < 1
    wall = points * (1, 1, 0) + (0, 0, 0.5)
    wall = wall / np.linalg.norm(wall, axis=1, keepdims=True)
    assert degrees_off(found[is_wall], wall[is_wall]).max() < 4
    ends = np.array([[mesh.vertices[v].co for v in edge.vertices] for edge in mesh.edges])
    on_rim = (np.abs(np.abs(ends[..., 2]) - 1) < 1e-4).all(axis=1)
    on_rim &= (np.hypot(ends[..., 0], ends[..., 1]) > 0.99).all(axis=1)
    assert np.array_equal(sharp(mesh), on_rim)


def test_flat_faces_are_lit_as_they_lie(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    for face in thing.data.polygons:
        face.use_smooth = face.center.z > 0
    thing.data.normals_split_custom_set(leaning(places(thing.data)))
    press.orbflow_remesh(faces=400)
    mesh, found = thing.data, normals(thing.data)
    n_flat = 0
    for face in mesh.polygons:
        if not face.use_smooth:
            n_flat += 1
            assert found[face.loop_start] == pytest.approx(tuple(face.normal), abs=1e-3)
    assert 150 < n_flat < 250


def test_without_custom_normals_there_are_none(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
    assert not thing.data.has_custom_normals
    assert not addon("runs").last_report(thing.name)["has_normals"]


def test_where_modifiers_drop_the_normals_it_is_said(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    thing.data.normals_split_custom_set(leaning(places(thing.data)))
    thing.modifiers.new("Cubes", "REMESH").voxel_size = 0.2
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
    assert "custom normals" in addon("runs").last_report(thing.name)["lost"]
