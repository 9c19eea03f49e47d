"""Guides that are drawn on the surface: kept with the object, erased, mirrored, used again."""

from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector
from test_operator import Open, addon, press, select

N = 40


def ball() -> Any:  # noqa: ANN401
    """The only mesh of the scene: an even ball of radius 1."""
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5)
    return bpy.context.object


def arc(first: Any, last: Any, n: int = N, radius: float = 1.1) -> list[dict[str, Any]]:  # noqa: ANN401
    """Points beside a ball along a great circle."""
    shares = np.linspace(0, 1, n)[:, None]
    points = (1 - shares) * first + shares * np.array(last, float)
    points *= radius / np.linalg.norm(points, axis=1, keepdims=True)
    return [{"name": "", "location": tuple(point)} for point in points]


def splines(thing: Any) -> list[tuple[np.ndarray, bool]]:  # noqa: ANN401
    """The strokes kept for an object, in the space of the scene."""
    (held,) = (each for each in bpy.data.objects if each.type == "CURVE" and each.parent == thing)
    bpy.context.view_layer.update()
    return [
        (np.array([held.matrix_world @ p.co.xyz for p in each.points]), each.use_cyclic_u)
        for each in held.data.splines
    ]


def test_a_stroke_is_kept_on_the_surface_as_a_child_of_the_object(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    thing.name = "Body"
    thing.matrix_world = Matrix.Translation((3, 0, 0)) @ Matrix.Scale(2, 4)
    stroke = [
        each | {"location": tuple(2 * Vector(each["location"]) + Vector((3, 0, 0)))}
        for each in arc((1, 0.5, 0), (0, 0.5, 1))
    ]
    assert press.orbflow_draw_guide(stroke=stroke) == {"FINISHED"}
    held = bpy.data.objects["Body Guides"]
    assert (held.parent, held.type, held.hide_render) == (thing, "CURVE", True)
    assert held in list(bpy.data.collections["Guides"].objects)
    assert bpy.context.scene.orbflow.guides == "Guides"
    ((points, is_closed),) = splines(thing)
    assert (len(points), is_closed) == (N, False)
    assert np.linalg.norm(points - (3, 0, 0), axis=1) == pytest.approx(np.full(N, 2), abs=0.01)
    assert bpy.context.object == thing
    # The second one goes to the same place, also when the guides are active.
    bpy.context.view_layer.objects.active = held
    assert press.orbflow_draw_guide(stroke=stroke, is_closed=False, is_exact=True) == {"FINISHED"}
    assert len(splines(thing)) == 2
    bpy.context.view_layer.update()
    first, second = addon("guides").of(
        thing, addon("guides").read(bpy.context, "Guides", False), False
    )
    assert (first.is_exact, second.is_exact) == (False, True)
    assert np.linalg.norm(first.points, axis=1) == pytest.approx(np.full(N, 1), abs=0.005)


def test_every_object_has_guides_of_its_own_in_one_run(open_fixture: Open) -> None:
    open_fixture("02")
    left, right = bpy.data.objects["Left"], bpy.data.objects["Right"]
    for thing in (left, right):
        bpy.context.view_layer.objects.active = thing
        places = [thing.matrix_world @ thing.data.vertices[i].co for i in range(3)]
        stroke = [{"name": "", "location": tuple(place)} for place in places]
        assert press.orbflow_draw_guide(stroke=stroke) == {"FINISHED"}
    select(left, right)
    wanted = bpy.context.scene.orbflow
    tasks = addon("operators.remesh")._tasks(bpy.context, wanted)
    owners = {task.name: {each.owner for each in task.guides} for task in tasks}
    assert owners == {"Left": {"Left"}, "Right": {"Right"}}


def test_strokes_go_where_the_artists_own_curve_is_named(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    own = bpy.data.objects.new("Lines", bpy.data.curves.new("Lines", "CURVE"))
    bpy.context.scene.collection.objects.link(own)
    bpy.context.scene.orbflow.guides = "Lines"
    press.orbflow_draw_guide(stroke=arc((1, 0, 0), (0, 0, 1)))
    assert len(own.data.splines) == 1
    assert bpy.context.scene.orbflow.guides == "Lines"
    assert [each for each in bpy.data.objects if each.parent == thing] == []


@pytest.mark.parametrize(
    ("first", "last", "wanted"),
    [
        ((0.5, 0.2, 1), (0.5, 1, 0.2), [False, False]),
        ((0.01, 0, 1), (1, 0, 0), [False]),
        ((-0.6, 0.3, 1), (0.6, 0.3, 1), [False]),
    ],
)
def test_strokes_are_mirrored_as_the_mesh_is(
    open_fixture: Open,
    first: Any,  # noqa: ANN401
    last: Any,  # noqa: ANN401
    wanted: list[bool],
) -> None:
    open_fixture("03")
    thing = ball()
    thing.data.use_mirror_x = True
    press.orbflow_draw_guide(stroke=arc(first, last))
    found = splines(thing)
    assert [is_closed for _, is_closed in found] == wanted
    points = np.concatenate([points for points, _ in found])
    images = points * (-1, 1, 1)
    nearest = np.linalg.norm(points[:, None] - images, axis=2).min(axis=1)
    assert nearest.max() < 0.03


def test_half_a_loop_becomes_one_by_its_image(open_fixture: Open) -> None:
    open_fixture("03")
    paths = addon("guides.paths")
    angles = np.linspace(-np.pi / 2 + 0.01, np.pi / 2 - 0.01, 20)
    half = np.stack([np.cos(angles), np.sin(angles), np.zeros(20)], axis=1)
    ((points, is_closed),) = paths.mirrored((half, False), 0, 0.05)
    assert (len(points), is_closed) == (38, True)
    assert (np.abs(points[:, 0]) < 1e-9).sum() == 2
    steps = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    assert steps.max() < 2 * steps.min()


def test_a_path_is_smoothed_and_closed_where_it_ends_at_its_start(open_fixture: Open) -> None:
    open_fixture("03")
    paths = addon("guides.paths")
    angles = np.linspace(0, 2 * np.pi, 90)
    ring = 100 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shaky = ring + np.random.default_rng(3).normal(0, 1.0, ring.shape)
    points, is_closed = paths.drawn(shaky)
    assert is_closed
    assert len(points) == pytest.approx(2 * np.pi * 100 / paths.STEP_PX, rel=0.25)
    off = np.abs(np.linalg.norm(points, axis=1) - 100)
    assert off.mean() < 0.6
    line, is_closed = paths.drawn(ring[:60])
    assert not is_closed
    assert line[[0, -1]].tolist() == ring[[0, 59]].tolist()
    dot, is_closed = paths.drawn(np.array([(5.0, 5.0), (5.0, 5.0)]))
    assert (len(dot), is_closed) == (1, False)


def test_the_eraser_takes_what_it_touches(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    press.orbflow_draw_guide(stroke=arc((1, 0, 0), (0, 0, 1)))
    press.orbflow_draw_guide(stroke=arc((-1, 0, 0), (0, 1, 0)))
    assert press.orbflow_erase_guide(location=(1, 0, 1), reach=0.2) == {"CANCELLED"}
    assert press.orbflow_erase_guide(location=(0.7, 0, 0.7), reach=0.1) == {"FINISHED"}
    ((points, _),) = splines(thing)
    assert points[0] == pytest.approx((-1, 0, 0), abs=0.01)


class View:
    """A 3D view from above, one unit as wide as 100 pixels, as the operators see it."""

    def __init__(self) -> None:
        turned = Matrix()
        self.region = SimpleNamespace(width=800, height=800)
        scale = Matrix.Diagonal((1 / 4, 1 / 4, -1 / 100, 1))
        self.region_data = SimpleNamespace(
            is_perspective=False,
            view_matrix=turned,
            perspective_matrix=scale @ turned,
            window_matrix=scale,
            view_perspective="ORTHO",
        )
        self.area = SimpleNamespace(tag_redraw=lambda: None, type="VIEW_3D")
        self.window_manager = SimpleNamespace(modal_handler_add=lambda _: None)
        self.scene, self.mode = bpy.context.scene, "OBJECT"
        self.view_layer, self.object = bpy.context.view_layer, bpy.context.object
        self.evaluated_depsgraph_get = bpy.context.evaluated_depsgraph_get


def event(what: str, value: str, x: float, y: float) -> Any:  # noqa: ANN401
    """An event at a place of the scene as it is seen from above."""
    at = {"mouse_region_x": 400 + 100 * x, "mouse_region_y": 400 + 100 * y}
    return SimpleNamespace(type=what, value=value, **at)


class Stroke:
    """What an operator keeps of a stroke."""

    def __init__(self) -> None:
        self.places: list[Any] = []
        self.clear = self.places.clear

    def add(self) -> Any:  # noqa: ANN401
        self.places.append(SimpleNamespace(location=None))
        return self.places[-1]

    def __iter__(self) -> Any:  # noqa: ANN401, D105
        return iter(self.places)


def instance(kind: Any) -> Any:  # noqa: ANN401
    """An operator that runs on the events of a test."""
    names = [name for name in dir(kind) if not name.startswith("__") and name != "bl_rna"]
    methods = {name: getattr(kind, name) for name in names if name in vars(kind)}
    made: Any = type("Made", (), {k: v for k, v in methods.items() if callable(v)})()
    made.stroke, made.is_exact, made.is_closed = Stroke(), False, False
    made.said = []
    made.report = lambda _level, text: made.said.append(text)
    return made


def drag(operator: Any, view: View, places: Any) -> set[str]:  # noqa: ANN401
    """Moves the mouse with its button down through places."""
    (x, y), *others = places
    assert operator.invoke(view, event("LEFTMOUSE", "PRESS", x, y)) == {"RUNNING_MODAL"}
    for x, y in others:
        assert operator.modal(view, event("MOUSEMOVE", "NOTHING", x, y)) == {"RUNNING_MODAL"}
    return operator.modal(view, event("LEFTMOUSE", "RELEASE", x, y))


@pytest.fixture
def handles(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What draws in the view: without a window nothing does."""
    held: list[object] = []

    def add(*given: object) -> object:
        held.append(given)
        return given

    space = SimpleNamespace(
        draw_handler_add=add, draw_handler_remove=lambda handle, _region: held.remove(handle)
    )
    module = addon("operators.draw_guide")
    monkeypatch.setattr(module, "bpy", SimpleNamespace(types=SimpleNamespace(SpaceView3D=space)))
    return held


def test_the_mouse_draws_on_what_it_sees_and_erases_it(
    open_fixture: Open, handles: list[object]
) -> None:
    open_fixture("03")
    thing = ball()
    draw = addon("operators.draw_guide").OBJECT_OT_orbflow_draw_guide
    operator, view = instance(draw), View()
    angles = np.linspace(0, 2 * np.pi, 30)
    ring = 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    assert drag(operator, view, ring) == {"FINISHED"}
    assert operator.said == [f"1 guide drawn on {thing.name}"]
    assert handles == []
    ((points, is_closed),) = splines(thing)
    assert is_closed
    assert (points[:, 2] > 0.8).all()
    assert np.linalg.norm(points, axis=1) == pytest.approx(np.ones(len(points)), abs=0.01)
    # Past the edge of what is seen there is nothing to draw on.
    assert drag(instance(draw), View(), [(0.0, 0.0), (0.5, 0.0), (2.0, 0.0)]) == {"FINISHED"}
    (_, (line, is_closed)) = splines(thing)
    assert not is_closed
    assert line[:, 0].max() == pytest.approx(1.0, abs=0.06)
    nothing = instance(draw)
    assert drag(nothing, View(), [(2.0, 0.0), (2.0, 1.0)]) == {"CANCELLED"}
    assert nothing.said == [f"nothing was drawn on {thing.name}"]
    # What lies behind the object is not erased.
    press.orbflow_draw_guide(stroke=arc((-0.3, -0.25, -1), (0.3, -0.25, -1)))
    erase = addon("operators.erase_guide").OBJECT_OT_orbflow_erase_guide
    assert drag(instance(erase), View(), [(-0.1, -0.25), (0.1, -0.25)]) == {"CANCELLED"}
    assert drag(instance(erase), View(), [(0.3, -0.1), (0.3, 0.1)]) == {"FINISHED"}
    assert [is_closed for _, is_closed in splines(thing)] == [True, False]


def test_a_stroke_breaks_between_what_is_near_and_what_is_behind(
    open_fixture: Open, handles: list[object]
) -> None:
    open_fixture("03")
    thing = ball()
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 3))
    select(thing, bpy.context.object)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.join()
    draw = addon("operators.draw_guide").OBJECT_OT_orbflow_draw_guide
    assert drag(instance(draw), View(), [(-0.8, 0.0), (0.8, 0.0)]) == {"FINISHED"}
    heights = [np.ptp(points[:, 2]) for points, _ in splines(thing)]
    assert len(heights) == 3
    assert max(heights) < 0.5
    stopped = instance(draw)
    stopped.invoke(View(), event("LEFTMOUSE", "PRESS", 0, 0))
    assert len(handles) == 1
    assert stopped.modal(View(), event("ESC", "PRESS", 0, 0)) == {"CANCELLED"}
    assert handles == []
    assert len(splines(thing)) == 3


def test_the_tool_is_in_the_toolbar_as_long_as_the_extension_is_on(open_fixture: Open) -> None:
    open_fixture("03")
    from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active as toolbar

    def tools() -> list[str]:
        found = []
        for each in toolbar._tools["OBJECT"]:
            found += [each] if not isinstance(each, tuple) else list(each)
        return [each.idname for each in found if hasattr(each, "idname")]

    assert tools().count("orbflow.draw_guides") == 1
    name = "bl_ext.user_default.orbflow"
    bpy.ops.preferences.addon_disable(module=name)
    assert "orbflow.draw_guides" not in tools()
    bpy.ops.preferences.addon_enable(module=name)
    assert tools().count("orbflow.draw_guides") == 1
    with pytest.raises(RuntimeError, match="guides are drawn in a 3D view"):
        press.orbflow_draw_guides()
