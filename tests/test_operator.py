"""The operator in the real Blender, on every fixture."""

import importlib
import time
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import on_the_ring

Open = Callable[[str], Any]
press = bpy.ops.object


def addon(name: str) -> Any:  # noqa: ANN401 - a module of the installed extension
    return importlib.import_module(f"bl_ext.user_default.orbflow.{name}")


def arrays(thing: Any) -> tuple[bytes, ...]:  # noqa: ANN401
    read = addon("mesh_arrays").read(thing.data)
    return read.positions.tobytes(), read.loop_start.tobytes(), read.corner_vert.tobytes()


def select(*things: Any) -> None:  # noqa: ANN401
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)


def is_sound(thing: Any) -> bool:  # noqa: ANN401
    """Whether Blender finds nothing to repair in an object's mesh."""
    return not thing.data.validate()


def test_a_real_mesh_becomes_quads(open_fixture: Open) -> None:
    spot = open_fixture("01")
    assert press.orbflow_remesh(faces=2000) == {"FINISHED"}
    assert abs(len(spot.data.polygons) - 2000) <= 40
    assert {len(face.vertices) for face in spot.data.polygons} == {4}
    assert is_sound(spot)


def test_scripts_and_background_get_the_bytes_of_the_core(open_fixture: Open) -> None:
    spot = open_fixture("01")
    given = addon("mesh_arrays").read(spot.data)
    wanted = orbflow_native.remesh(
        given.positions,
        given.loop_start,
        given.corner_vert,
        faces=500,
        material_index=given.material_index,
    )
    press.orbflow_remesh(faces=500)
    result = addon("mesh_arrays").read(spot.data)
    assert np.array_equal(result.positions, wanted.positions)
    assert np.array_equal(result.corner_vert, wanted.corner_vert)
    assert np.array_equal(result.material_index, wanted.material_index)


def test_triangles_come_when_asked_for(open_fixture: Open) -> None:
    first = open_fixture("03")
    press.orbflow_remesh(faces=300, kind="TRIANGLES")
    assert {len(face.vertices) for face in first.data.polygons} == {3}


def test_all_selected_objects_are_done_in_one_go(open_fixture: Open) -> None:
    open_fixture("02")
    before = {thing.name: arrays(thing) for thing in bpy.data.objects}
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    for thing in bpy.data.objects:
        assert arrays(thing) != before[thing.name]
        assert is_sound(thing)


def test_shared_data_becomes_single_user(open_fixture: Open) -> None:
    first = open_fixture("03")
    second = bpy.data.objects["Second"]
    before = arrays(second)
    press.orbflow_remesh(faces=200)
    assert arrays(second) == before
    assert (first.data.users, second.data.users) == (1, 1)
    assert first.data != second.data


def test_selected_objects_that_share_a_mesh_go_on_sharing(open_fixture: Open) -> None:
    first = open_fixture("03")
    second, third = bpy.data.objects["Second"], first.copy()
    bpy.context.scene.collection.objects.link(third)
    first.vertex_groups.new(name="Arm").add([3], 1.0, "REPLACE")
    first.shape_key_add(name="Basis")
    first.shape_key_add(name="Smile")
    third.rotation_euler = (1, 2, 3)
    second.scale = (1, 1, 3)
    select(first, second, third)
    press.orbflow_remesh(faces=200)
    assert (first.data, first.data.users) == (third.data, 2)
    assert second.data.users == 1
    assert len(bpy.data.meshes) == 2
    assert [group.name for group in third.vertex_groups] == ["Arm"]
    assert [key.name for key in third.data.shape_keys.key_blocks] == ["Basis", "Smile"]


def test_the_object_keeps_what_is_the_artists(open_fixture: Open) -> None:
    thing = open_fixture("04")
    kept = thing.name, thing.data.name, thing.parent, thing.matrix_world.copy()
    modifiers = [(each.name, each.type) for each in thing.modifiers]
    materials = list(thing.data.materials)
    thing.data["wear"], thing.data["more"] = 0.5, {"deep": 1}
    thing.data.id_properties_ui("wear").update(max=2.0, description="How worn it is")
    thing.data.use_mirror_x, thing.data.remesh_voxel_size = True, 0.25
    thing.data.use_auto_texspace, thing.data.texspace_size = False, (1, 2, 3)
    press.orbflow_remesh(faces=600, use_modifiers=False)
    assert (thing.name, thing.data.name, thing.parent, thing.matrix_world) == kept
    assert [(each.name, each.type) for each in thing.modifiers] == modifiers
    assert list(thing.data.materials) == materials
    assert {face.material_index for face in thing.data.polygons} == {0, 1, 2}
    assert thing.data["made_by"] == "make.py"
    assert (thing.data["wear"], thing.data["more"]["deep"]) == (0.5, 1)
    shown = thing.data.id_properties_ui("wear").as_dict()
    assert (shown["max"], shown["description"]) == (2.0, "How worn it is")
    assert (thing.data.use_mirror_x, thing.data.remesh_voxel_size) == (True, 0.25)
    assert (thing.data.use_auto_texspace, tuple(thing.data.texspace_size)) == (False, (1, 2, 3))
    low, high = (
        max(face.center[2] for face in thing.data.polygons if face.material_index == i)
        for i in (0, 2)
    )
    assert low < high
    assert len(bpy.data.meshes) == 1


def test_the_original_stays_hidden_beside_the_result(open_fixture: Open) -> None:
    first = open_fixture("03")
    follower = bpy.data.objects.new("Follower", None)
    bpy.context.collection.objects.link(follower)
    follower.parent = first
    mesh, before = first.data, arrays(first)
    press.orbflow_remesh(faces=200, keep_original=True)
    original = bpy.data.objects["First Original"]
    assert original.data == mesh
    assert arrays(original) == before
    assert original.hide_get()
    assert original.hide_render
    assert not original.select_get()
    assert first.data != mesh
    assert follower.parent == first
    assert first.visible_get()


def test_shading_is_kept_flat_or_smooth(open_fixture: Open) -> None:
    artist = open_fixture("09")
    press.orbflow_remesh(faces=200)
    assert not any(face.use_smooth for face in artist.data.polygons)
    assert artist.data.normals_domain == "FACE"
    artist.data.shade_smooth()
    press.orbflow_remesh(faces=200)
    assert all(face.use_smooth for face in artist.data.polygons)
    assert artist.data.normals_domain == "POINT"
    for face in artist.data.polygons:
        face.use_smooth = face.center.x > 0
    press.orbflow_remesh(faces=200)
    assert artist.data.normals_domain == "CORNER"
    right = [face for face in artist.data.polygons if face.use_smooth]
    assert 50 < len(right) < 150
    assert min(face.center.x for face in right) > -0.2


def test_faces_are_even_as_the_object_is_seen(open_fixture: Open) -> None:
    stretched = open_fixture("08")
    press.orbflow_remesh(faces=800, kind="TRIANGLES")
    points = np.array([v.co for v in stretched.data.vertices]) * (1, 1, 4)
    edges = np.array([edge.vertices for edge in stretched.data.edges])
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    assert lengths.std() / lengths.mean() < 0.25


@pytest.mark.parametrize("mark", ["SHARP", "CREASE", "SEAM"])
def test_edges_marked_by_the_artist_are_edges_of_the_result(open_fixture: Open, mark: str) -> None:
    open_fixture("01")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    thing = bpy.context.object
    flat = {v.index for v in thing.data.vertices if abs(v.co[2]) < 1e-6}
    marked = [edge for edge in thing.data.edges if set(edge.vertices) <= flat]
    creases = thing.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    for edge in marked:
        edge.use_edge_sharp = mark == "SHARP"
        edge.use_seam = mark == "SEAM"
        creases.data[edge.index].value = float(mark == "CREASE")
    plain = thing.copy()
    plain.data = thing.data.copy()
    press.orbflow_remesh(faces=400, marked_edges={mark})
    assert on_the_ring(thing.data)[1] > 0.95 * 2 * np.pi
    bpy.context.scene.collection.objects.link(plain)
    select(plain)
    press.orbflow_remesh(faces=400, marked_edges=set())
    assert on_the_ring(plain.data)[1] < 0.5 * 2 * np.pi


def test_closed_parts_of_one_object_are_done_one_by_one(open_fixture: Open) -> None:
    parts = open_fixture("11")
    press.orbflow_remesh(faces=500)
    assert abs(len(parts.data.polygons) - 500) <= 25
    assert is_sound(parts)


def test_quads_polygons_and_turned_faces_are_welcome(open_fixture: Open) -> None:
    cube = open_fixture("12")
    assert press.orbflow_remesh(faces=96) == {"FINISHED"}
    assert is_sound(cube)


@pytest.mark.parametrize("size", [1e30, 1e-30])
def test_any_size_is_done(open_fixture: Open, size: float) -> None:
    first = open_fixture("03")
    positions = np.array([vertex.co for vertex in first.data.vertices], np.float32) * size
    first.data.attributes["position"].data.foreach_set("vector", positions.ravel())
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    assert max(abs(x) for vertex in first.data.vertices for x in vertex.co) > 0.5 * size


def test_counts_out_of_range_are_clamped_by_blender(open_fixture: Open) -> None:
    open_fixture("12")
    assert press.orbflow_remesh(faces=1) == {"FINISHED"}


@pytest.mark.parametrize("after_s", [0.0, 0.05, 0.2])
def test_the_thread_behind_the_button_stops_within_a_fifth_of_a_second(
    open_fixture: Open, after_s: float
) -> None:
    spot = open_fixture("01")
    before = arrays(spot)
    settings = addon("settings").for_core(bpy.context.scene.orbflow) | {"faces": 200_000}
    task = addon("job").Task(spot.name, addon("mesh_arrays").read(spot.data), (1.0, 1.0, 1.0))

    def latency_s() -> float:
        job = addon("job").Job([task] * 3, settings)
        time.sleep(after_s)
        start = time.monotonic()
        job.cancel()
        job.wait()
        assert job.is_cancelled
        assert job.has_ended()
        return time.monotonic() - start

    # A busy machine may be late once, not three times.
    assert min(latency_s() for _ in range(3)) < 0.2
    assert arrays(spot) == before


def test_the_thread_behind_the_button_does_the_same_as_the_blocking_twin(
    open_fixture: Open,
) -> None:
    first = open_fixture("03")
    task = addon("job").Task(first.name, addon("mesh_arrays").read(first.data), (1.0, 1.0, 1.0))
    settings = addon("settings").for_core(bpy.context.scene.orbflow)
    job = addon("job").Job([task], settings)
    job.wait()
    (outcome,) = job.outcomes
    press.orbflow_remesh()
    result = addon("mesh_arrays").read(first.data)
    assert np.array_equal(outcome.result.positions, result.positions)
    assert job.stage.share == 1.0


def test_the_extension_can_be_switched_off_and_on(open_fixture: Open) -> None:
    open_fixture("03")
    name = "bl_ext.user_default.orbflow"
    bpy.ops.preferences.addon_disable(module=name)
    assert not hasattr(bpy.types, "OBJECT_OT_orbflow_remesh")
    bpy.ops.preferences.addon_enable(module=name)
    assert hasattr(bpy.types, "OBJECT_OT_orbflow_remesh")


def test_a_fallback_is_named_in_the_panel_and_the_info_line(open_fixture: Open) -> None:
    first = open_fixture("03")
    press.orbflow_remesh(faces=200)
    panel, words = addon("panel"), addon("words")
    report = addon("runs").last_report(first.name)
    assert words.warnings(report) == []
    told = "the edges of 1 part do not follow the shape (no whole periods)"
    report["warnings"] = [{"kind": "flow", "text": told, "grave": False}]
    assert words.sentence(report).endswith(f"; {told}")
    shown: list[str] = []

    class Column:
        def label(self, text: str, icon: str = "NONE") -> None:
            shown.append(f"{icon} {text}")

        def split(self, **_how: object) -> "Column":
            return self

    panel._draw_score(Column(), report, 36)
    assert shown[:2] == [
        "ERROR the edges of 1 part do not follow",
        "BLANK1 the shape (no whole periods)",
    ]


def test_a_symmetric_mesh_stays_so_unasked_and_the_panel_says_across_what(
    open_fixture: Open,
) -> None:
    open_fixture("03")
    shown = {}
    for mirror in ("AUTO", "OFF"):
        bpy.ops.mesh.primitive_uv_sphere_add()
        thing = bpy.context.object
        select(thing)
        assert press.orbflow_remesh(faces=300, mirror=mirror) == {"FINISHED"}
        report = addon("runs").last_report(thing.name)
        shown[mirror] = dict(addon("panel").rows(report))
        places = {tuple(np.round(vertex.co, 5)) for vertex in thing.data.vertices}
        images = {(-x + 0.0, y, z) for x, y, z in places}
        assert (places == images) is (mirror == "AUTO")
    assert shown["AUTO"]["Symmetric across"] == "X"
    assert "Symmetric across" not in shown["OFF"]
