"""Smaller quads where a vertex group or a colour attribute asks for them."""

from typing import Any

import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball
from test_operator import Open, addon, press, select

FACES = 1000


def areas(points: Any, corners: Any) -> tuple[float, float]:  # noqa: ANN401 - arrays
    """The mean area of the quads well inside each half, x < 0 first."""
    quads = np.asarray(points)[np.asarray(corners).reshape(-1, 4)]
    across = quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]
    size = np.linalg.norm(np.cross(*across), axis=1) / 2
    middle = quads[..., 0].mean(1)
    return float(size[middle < -0.3].mean()), float(size[middle > 0.3].mean())


def of_object(thing: Any) -> tuple[float, float]:  # noqa: ANN401
    arrays = addon("mesh_arrays").read(thing.data)
    return areas(arrays.positions, arrays.corner_vert)


def paint(thing: Any, kind: str, domain: str = "POINT") -> None:  # noqa: ANN401
    """Asks for small quads at x > 0, by a group or a colour named Dense."""
    is_right = [vertex.co.x > 0 for vertex in thing.data.vertices]
    if kind == "GROUP":
        group = thing.vertex_groups.new(name="Dense")
        group.add([i for i, right in enumerate(is_right) if right], 1.0, "REPLACE")
        return
    attribute = thing.data.color_attributes.new("Dense", kind, domain)
    at = is_right
    if domain == "CORNER":
        at = [is_right[corner.vertex_index] for corner in thing.data.loops]
    for each, right in zip(attribute.data, at, strict=True):
        each.color = (right, right, right, 1)


def test_quads_are_smaller_where_density_asks_and_the_count_stays() -> None:
    mesh: Arrays = ball()
    density = (mesh[0][:, 0] > 0).astype(np.float32)
    result = orbflow_native.remesh(*mesh, faces=FACES, density=density, adaptivity=0.0)
    left, right = areas(result.positions, result.corner_vert)
    assert right / left < 0.65
    assert abs(len(result.loop_start) - FACES) <= 0.01 * FACES


def test_one_density_everywhere_gives_the_bytes_of_none() -> None:
    mesh = ball()
    even = np.full(len(mesh[0]), 0.5, np.float32)
    results = [
        orbflow_native.remesh(*mesh, faces=300, score_samples=0, density=density)
        for density in (None, even)
    ]
    assert results[0].positions.tobytes() == results[1].positions.tobytes()


@pytest.mark.parametrize(
    ("density", "error", "text"),
    [
        (np.zeros(5, np.float32), orbflow_native.InputError, "5 densities for 2342 vertices"),
        (np.full(2342, 1.5, np.float32), orbflow_native.InputError, "vertex 0 has the density 1.5"),
        (np.full(2342, np.nan, np.float32), orbflow_native.InputError, "density NaN; it goes from"),
        (np.zeros((5, 2), np.float32), ValueError, r"density must be a \(V,\) float32 array"),
        (np.zeros(2342), TypeError, r"density must be a \(V,\) float32 array"),
    ],
)
def test_wrong_densities_are_named(density: Any, error: type[Exception], text: str) -> None:  # noqa: ANN401
    with pytest.raises(error, match=text):
        orbflow_native.remesh(*ball(), density=density)


@pytest.mark.parametrize(
    ("kind", "domain"),
    [
        ("GROUP", ""),
        ("FLOAT_COLOR", "POINT"),
        ("BYTE_COLOR", "CORNER"),
    ],
)
def test_a_group_or_a_colour_says_where(open_fixture: Open, kind: str, domain: str) -> None:
    first = open_fixture("03")
    paint(first, kind, domain)
    assert press.orbflow_remesh(faces=FACES, density="Dense", adaptivity=0.0) == {"FINISHED"}
    left, right = of_object(first)
    assert right / left < 0.65
    assert abs(len(first.data.polygons) - FACES) <= 0.01 * FACES


def test_weights_between_and_bright_colours_are_read(open_fixture: Open) -> None:
    first = open_fixture("03")
    first.vertex_groups.new(name="Other").add([3], 1.0, "REPLACE")
    first.vertex_groups.new(name="Half").add([3, 5], 0.25, "REPLACE")
    groups = addon("artist.groups").read(first)
    half = addon("density").read(first, "Half", groups)
    assert (half[3], half[5], half.sum()) == (0.25, 0.25, 0.5)
    colour = first.data.color_attributes.new("Bright", "FLOAT_COLOR", "POINT")
    for each in colour.data:
        each.color = (9, 9, 9, 1)
    assert (addon("density").read(first, "Bright", groups) == 1).all()
    assert addon("density").read(first, "", groups) is None


def test_a_name_that_is_not_there_is_said_with_those_that_are(open_fixture: Open) -> None:
    first = open_fixture("03")

    def error() -> str:
        with pytest.raises(RuntimeError) as caught:
            press.orbflow_remesh(density="Dance")
        return str(caught.value)

    assert "named 'Dance'; there are: none" in error()
    paint(first, "GROUP")
    first.data.color_attributes.new("Tint", "FLOAT_COLOR", "POINT")
    assert "no vertex group or color attribute is named 'Dance'; there are: Dense, Tint" in error()
    assert [name for name, _ in addon("density").names(first)] == ["Dense", "Tint"]
    assert len(first.data.polygons) == 1280


def test_an_object_without_the_name_does_not_stop_the_others(open_fixture: Open) -> None:
    open_fixture("02")
    left, right = bpy.data.objects["Left"], bpy.data.objects["Right"]
    select(left, right)
    n_faces = len(right.data.polygons)
    paint(left, "GROUP")
    assert press.orbflow_remesh(faces=200, density="Dense") == {"FINISHED"}
    assert len(left.data.polygons) <= 204
    assert len(right.data.polygons) == n_faces


def test_the_button_has_an_artist_paint_the_density(open_fixture: Open) -> None:
    first = open_fixture("03")
    wanted = bpy.context.scene.orbflow
    assert bpy.ops.object.orbflow_paint_density() == {"FINISHED"}
    assert bpy.context.mode == "PAINT_WEIGHT"
    assert (wanted.density, first.vertex_groups.active.name) == ("Density", "Density")
    weights = {each.weight for vertex in first.data.vertices for each in vertex.groups}
    assert weights == {0.5}
    bpy.ops.object.mode_set(mode="OBJECT")
    first.vertex_groups["Density"].add([0], 1.0, "REPLACE")
    assert bpy.ops.object.orbflow_paint_density() == {"FINISHED"}
    assert first.data.vertices[0].groups[0].weight == 1.0
    bpy.ops.object.mode_set(mode="OBJECT")
    paint(first, "FLOAT_COLOR")
    wanted.density = "Dense"
    assert bpy.ops.object.orbflow_paint_density() == {"FINISHED"}
    assert bpy.context.mode == "PAINT_VERTEX"
    assert first.data.color_attributes.active_color.name == "Dense"
    bpy.ops.object.mode_set(mode="OBJECT")
