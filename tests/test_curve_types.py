"""Guides are what is seen of curves, not their control points: against Blender's own."""

from typing import Any

import bpy
import numpy as np
import pytest
from test_operator import addon

pytestmark = pytest.mark.usefixtures("open_fixture")
PLACES = [(0, 0, 0), (1, 2, 0), (3, 2, 1), (4, -1, 0), (6, 0, 2)]


@pytest.fixture
def drawing() -> Any:  # noqa: ANN401
    """A drawing with one stroke of five points, in an object *Lines* that is the guide."""
    if not hasattr(bpy.types, "GreasePencilDrawing"):
        pytest.skip("Grease Pencil has no curves in this Blender")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    blocks: Any = getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils)
    held = blocks.new("Lines")
    bpy.context.collection.objects.link(bpy.data.objects.new("Lines", held))
    made = held.layers.new("Lines").frames.new(bpy.context.scene.frame_current).drawing
    made.add_strokes([len(PLACES)])
    for point, place in zip(made.strokes[0].points, PLACES, strict=True):
        point.position = place
    bpy.context.view_layer.update()
    return made


def read() -> Any:  # noqa: ANN401
    (stroke,) = addon("guides").read(bpy.context, "Lines", False)
    return stroke


def spline(kind: str, *, is_closed: bool, at_ends: bool = False) -> Any:  # noqa: ANN401
    """What a curve object of the same points is as Blender evaluates it, (N, 3)."""
    curve: Any = bpy.data.curves.new("Oracle", "CURVE")
    curve.dimensions = "3D"
    made = curve.splines.new(kind)
    made.use_cyclic_u, made.resolution_u = is_closed, 12
    points = made.bezier_points if kind == "BEZIER" else made.points
    points.add(len(PLACES) - 1)
    for point, place in zip(points, PLACES, strict=True):
        if kind == "BEZIER":
            point.co = place
            point.handle_left_type = point.handle_right_type = "FREE"
            point.handle_left = np.subtract(place, (0.5, 0.25, 0))
            point.handle_right = np.add(place, (0.75, 0, 0.25))
        else:
            point.co = (*place, 1.0 + 0.5 * place[2])
    if kind == "NURBS":
        made.order_u, made.use_endpoint_u = 4, at_ends
    thing = bpy.data.objects.new("Oracle", curve)
    bpy.context.collection.objects.link(thing)
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([each.co for each in mesh.vertices])


def farthest(some: Any, others: Any) -> float:  # noqa: ANN401
    """How far a point is from the nearest of others at most."""
    return float(np.linalg.norm(some[:, None] - others[None], axis=2).min(axis=1).max())


@pytest.mark.parametrize("is_closed", [False, True])
def test_a_bezier_stroke_runs_by_its_handles(drawing: Any, is_closed: bool) -> None:  # noqa: ANN401
    drawing.set_types(type="BEZIER")
    drawing.strokes[0].cyclic = is_closed
    for point, place in zip(drawing.strokes[0].points, PLACES, strict=True):
        point.handle_left.position = np.subtract(place, (0.5, 0.25, 0))
        point.handle_right.position = np.add(place, (0.75, 0, 0.25))
    stroke, wanted = read(), spline("BEZIER", is_closed=is_closed)
    assert stroke.is_closed == is_closed
    assert len(stroke.points) > 40
    assert max(farthest(stroke.points, wanted), farthest(wanted, stroke.points)) < 1e-4


# A curve object has no closed spline with knots at its ends.
@pytest.mark.parametrize(("is_closed", "at_ends"), [(False, False), (True, False), (False, True)])
def test_a_nurbs_stroke_runs_beside_its_points(
    drawing: Any,  # noqa: ANN401
    is_closed: bool,
    at_ends: bool,
) -> None:
    drawing.set_types(type="NURBS")
    drawing.strokes[0].cyclic = is_closed
    layers = drawing.attributes
    weight = layers.get("nurbs_weight") or layers.new("nurbs_weight", "FLOAT", "POINT")
    weight.data.foreach_set("value", np.array([1 + 0.5 * z for *_, z in PLACES], np.float32))
    for name, value in (("knots_mode", int(at_ends)), ("resolution", 400)):
        kind = "INT8" if name == "knots_mode" else "INT"
        (layers.get(name) or layers.new(name, kind, "CURVE")).data[0].value = value
    stroke = read()
    wanted = spline("NURBS", is_closed=is_closed, at_ends=at_ends)
    assert len(stroke.points) >= 1600
    # Blender cuts a curve object's spline less often.
    assert farthest(wanted, stroke.points) < 5e-3
    assert farthest(stroke.points, wanted) < 0.4
    if not is_closed:
        assert np.allclose(stroke.points[[0, -1]], wanted[[0, -1]], atol=1e-5)


@pytest.mark.parametrize("is_closed", [False, True])
def test_a_smooth_stroke_runs_through_its_points(drawing: Any, is_closed: bool) -> None:  # noqa: ANN401
    drawing.set_types(type="CATMULL_ROM")
    drawing.strokes[0].cyclic = is_closed
    stroke = read()
    assert len(stroke.points) > 40
    assert farthest(np.array(PLACES, float), stroke.points) < 1e-5
    # Half way between two points: nine sixteenths of each, less a sixteenth of those beyond.
    a, b, c, d = (np.array(each, float) for each in PLACES[:4])
    middle = (9 * (b + c) - a - d) / 16
    assert farthest(middle[None], stroke.points) < 1e-5


def test_a_stroke_of_straight_lines_is_its_points(drawing: Any) -> None:  # noqa: ANN401
    assert drawing.strokes[0].curve_type == 1
    assert np.allclose(read().points, PLACES)
