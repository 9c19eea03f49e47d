"""What the operator cannot do is said and left alone, and the others are done."""

import shutil
from pathlib import Path
from typing import Any

import bpy
import orbflow_native
import pytest
from conftest import FIXTURES
from test_operator import Open, addon, arrays, press, select


def refused(thing: Any, **settings: Any) -> str:  # noqa: ANN401
    """Presses the button, sees that nothing changed, and returns the text of the error."""
    before, data, users = arrays(thing), thing.data, thing.data.users
    with pytest.raises(RuntimeError) as caught:
        press.orbflow_remesh(**settings)
    assert (arrays(thing), thing.data, thing.data.users) == (before, data, users)
    return str(caught.value)


def test_one_bad_object_does_not_stop_the_others(open_fixture: Open) -> None:
    left = open_fixture("02")
    bad = left.copy()
    bad.name, bad.data = "Bad", bpy.data.meshes.new("Bad")
    bpy.context.scene.collection.objects.link(bad)
    before = arrays(left)
    select(left, bad)
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    assert arrays(left) != before
    assert len(bad.data.vertices) == 0


def test_no_error_stops_the_others(
    open_fixture: Open, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("02")
    remesh_one = addon("job")._remesh_one

    def fail(task: Any, *others: Any) -> Any:  # noqa: ANN401
        if task.name == "Left":
            raise MemoryError
        return remesh_one(task, *others)

    monkeypatch.setattr(addon("job"), "_remesh_one", fail)
    left, right = bpy.data.objects["Left"], bpy.data.objects["Right"]
    n_faces = len(left.data.polygons)
    select(left, right)
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    assert "Left: MemoryError" in capfd.readouterr().out
    assert (len(left.data.polygons), len(right.data.polygons) <= 204) == (n_faces, True)


@pytest.mark.parametrize(
    ("prefix", "primitive", "text"),
    [
        ("05", "QUAD_SPHERE", "the quad-sphere primitive has no borders; choose flow"),
        ("06", "QUAD_SPHERE", "genus 1: the quad-sphere primitive has no handles; choose flow"),
        ("07", "AUTO", "the mesh has no faces (0 vertices)"),
    ],
)
def test_what_cannot_be_done_is_said_and_left_alone(
    open_fixture: Open, prefix: str, primitive: str, text: str
) -> None:
    thing = open_fixture(prefix)
    given = addon("mesh_arrays").read(thing.data)
    name = None if primitive == "AUTO" else primitive.lower().replace("_", "-")
    with pytest.raises(orbflow_native.InputError) as caught:
        orbflow_native.remesh(given.positions, given.loop_start, given.corner_vert, primitive=name)
    told = refused(thing, primitive=primitive)
    assert text in told
    assert str(caught.value) in told


def test_a_fin_stays_on_the_vertices_of_what_it_stands_on(open_fixture: Open) -> None:
    thing = open_fixture("10")
    assert press.orbflow_remesh(faces=60) == {"FINISHED"}
    told = addon("words").exceptions(addon("runs").last_report(thing.name))
    assert told == ["taken apart at 1 edge at which 3 or more faces meet into 2 sheets"]
    *others, fin = thing.data.polygons
    assert {len(face.vertices) for face in others} == {4}
    # Its tip is its own; the corners between the ends of the edge it stands on are those of quads.
    assert len(fin.vertices) > 3
    used = {v for face in others for v in face.vertices}
    (tip,) = set(fin.vertices) - used
    assert tuple(thing.data.vertices[tip].co) == (1, 1, 1)


def test_coordinates_that_are_not_numbers_are_named(open_fixture: Open) -> None:
    first = open_fixture("03")
    first.data.vertices[17].co.y = float("nan")
    assert "vertex 17 has a coordinate that is not finite" in refused(first)


def test_a_flat_scale_is_said(open_fixture: Open) -> None:
    first = open_fixture("03")
    first.scale.x = 0
    assert "every axis needs a finite scale" in refused(first)


def test_the_wrong_mode_greys_the_button_out_and_says_why(open_fixture: Open) -> None:
    first = open_fixture("03")
    bpy.ops.object.mode_set(mode="SCULPT")
    try:
        with pytest.raises(RuntimeError, match="Orbflow works in object and edit mode"):
            press.orbflow_remesh()
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert len(first.data.polygons) == 1280


def test_an_object_in_another_mode_does_not_stop_the_others(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("02")
    left, right = bpy.data.objects["Left"], bpy.data.objects["Right"]
    select(right)
    bpy.context.view_layer.objects.active = right
    bpy.ops.object.mode_set(mode="EDIT")
    # As with Lock Object Modes off: the active object is in object mode, another one is not.
    bpy.context.view_layer.objects.active = left
    left.select_set(True)
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    assert "Right: it is not in object mode" in capfd.readouterr().out
    bpy.context.view_layer.objects.active = right
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(left.data.polygons) <= 204 < len(right.data.polygons)


def test_a_sculpt_on_many_levels_is_not_thrown_away(open_fixture: Open) -> None:
    first = open_fixture("03")
    first.modifiers.new("Detail", "MULTIRES")
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    bpy.ops.object.multires_subdivide(modifier="Detail")
    first.modifiers["Detail"].show_viewport = False
    assert "apply or remove modifier Detail first: it holds a sculpt" in refused(first)


def test_no_selected_mesh_greys_the_button_out_and_says_why(open_fixture: Open) -> None:
    open_fixture("04")
    select(bpy.data.objects["Parent"])
    with pytest.raises(RuntimeError, match="Select at least one mesh object"):
        press.orbflow_remesh()


def test_linked_objects_grey_the_button_out_and_say_why(open_fixture: Open) -> None:
    open_fixture("07")
    path = str(FIXTURES / "03_shared_data.blend")
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["First"]
    (linked,) = wanted.objects
    bpy.context.scene.collection.objects.link(linked)
    select(linked)
    with pytest.raises(RuntimeError, match="linked from another file"):
        press.orbflow_remesh()


def test_a_linked_object_does_not_stop_nor_stand_for_one_of_its_name(
    open_fixture: Open, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    first = open_fixture("03")
    path = shutil.copy(FIXTURES / "03_shared_data.blend", tmp_path)
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = ["First"]
    linked = bpy.data.objects["First", str(path)]
    # The scene finds the one that it was given first.
    scene = bpy.context.scene.collection
    for collection in first.users_collection:
        collection.objects.unlink(first)
    scene.objects.link(linked)
    scene.objects.link(first)
    select(first, linked)
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    assert "First: it is linked from another file" in capfd.readouterr().out
    assert len(first.data.polygons) <= 204 < len(linked.data.polygons)
