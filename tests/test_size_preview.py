"""Patches on the mesh show how large the faces will be."""

from typing import Any

import bpy
import numpy as np
import pytest
from sidebar import drawn
from test_operator import Open, addon, press


def patches(thing: Any, **settings: Any) -> list[np.ndarray]:  # noqa: ANN401
    """The lines of all patches, (L, 2, 3), for each colour."""
    wanted = bpy.context.scene.orbflow
    for name, value in settings.items():
        setattr(wanted, name, value)
    found = addon("size_preview").lines(thing, wanted)
    return [each.reshape(-1, 2, 3) for each in found]


def lengths(lines: np.ndarray, scale: tuple[float, float, float] = (1, 1, 1)) -> np.ndarray:
    return np.linalg.norm((lines[:, 1] - lines[:, 0]) * scale, axis=1)


def ball(open_fixture: Open) -> Any:  # noqa: ANN401
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    return bpy.context.object


def test_patches_have_the_size_of_the_faces_of_the_run(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    (lines,) = [each for each in patches(thing, faces=600) if len(each)]
    edges = [each for each in lengths(lines) if each > 0]
    # Three by three faces have 24 sides.
    assert len(lines) % 24 == 0
    assert 5 < len(lines) / 24 <= 40
    places = lines.reshape(-1, 3)
    assert np.linalg.norm(places, axis=1) == pytest.approx(1, abs=0.02)
    press.orbflow_remesh(faces=600)
    mesh = thing.data
    ends = [[mesh.vertices[v].co for v in edge.vertices] for edge in mesh.edges]
    made = [(one - other).length for one, other in ends]
    assert np.mean(edges) == pytest.approx(np.mean(made), rel=0.1)


def test_edges_of_triangles_are_longer_for_as_many_faces(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    quads, triangles = (
        np.concatenate(patches(thing, faces=2000, kind=kind)) for kind in ("QUADS", "TRIANGLES")
    )
    assert len(triangles) % 33 == 0
    ratio = np.mean(lengths(triangles)) / np.mean(lengths(quads))
    assert ratio == pytest.approx(2 / 3**0.25, rel=0.05)


def test_an_edge_length_is_that_of_the_scene(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    thing.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    lines = np.concatenate(patches(thing, size="EDGE", edge_length=0.1))
    assert lengths(lines, (2, 2, 2)).mean() == pytest.approx(0.1, rel=0.06)


def test_dense_places_have_smaller_patches_in_other_colours(open_fixture: Open) -> None:
    thing = ball(open_fixture)
    group = thing.vertex_groups.new(name="Fine")
    group.add([each.index for each in thing.data.vertices if each.co.z > 0], 1.0, "REPLACE")
    plain = lengths(np.concatenate(patches(thing, faces=2000))).mean()
    large, *middle, small = patches(thing, faces=2000, density="Fine")
    assert sum(map(len, middle)) == 0
    assert large[..., 2].mean() < 0 < small[..., 2].mean()
    assert lengths(large).mean() == pytest.approx(2 * lengths(small).mean(), rel=0.05)
    # As many faces as without: half of them cover a fifth as much again.
    assert lengths(small).mean() < plain < lengths(large).mean()
    area = 2 * np.pi / lengths(large).mean() ** 2 + 2 * np.pi / lengths(small).mean() ** 2
    assert area == pytest.approx(2000, rel=0.1)


def test_modifiers_count_as_in_a_run(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_cube_add()
    thing = bpy.context.object
    thing.modifiers.new("Round", "SUBSURF").levels = 3
    places = np.concatenate(patches(thing, faces=500)).reshape(-1, 3)
    assert np.linalg.norm(places, axis=1).max() < 1.2
    places = np.concatenate(patches(thing, faces=500, use_modifiers=False)).reshape(-1, 3)
    assert np.linalg.norm(places, axis=1).max() > 1.5


def test_an_empty_mesh_has_none_and_the_panel_has_the_box(open_fixture: Open) -> None:
    open_fixture("07")
    empty = bpy.data.objects["Empty"]
    assert sum(map(len, patches(empty))) == 0
    assert "show_size" in dict(drawn(empty))
    assert not bpy.context.scene.orbflow.show_size
