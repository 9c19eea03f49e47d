"""Faces that are kept: by flags, by what an object offers, by selection in edit mode."""

from typing import Any

import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball
from sidebar import drawn
from test_operator import Open, addon, is_sound, press

N_KEPT = 120


def region(mesh: Any) -> np.ndarray:  # noqa: ANN401 - arrays of a mesh
    """The faces of a ball of triangles that lie highest."""
    points, corners = np.asarray(mesh[0]), np.asarray(mesh[2]).reshape(-1, 3)
    height = points[corners][..., 2].mean(1)
    flags = np.zeros(len(corners), bool)
    flags[np.argsort(-height, kind="stable")[:N_KEPT]] = True
    return flags


def corners_at(points: Any, starts: Any, corners: Any) -> list[bytes]:  # noqa: ANN401
    """The places of the corners of every face, bit for bit."""
    return [np.asarray(points)[each].tobytes() for each in np.split(corners, starts[1:])]


def n_open(starts: Any, corners: Any) -> int:  # noqa: ANN401
    """How many edges have not two faces."""
    count: dict[tuple[int, int], int] = {}
    for face in np.split(np.asarray(corners), np.asarray(starts)[1:]):
        for a, b in zip(face, np.roll(face, -1), strict=True):
            key = (int(min(a, b)), int(max(a, b)))
            count[key] = count.get(key, 0) + 1
    return sum(n != 2 for n in count.values())


def test_kept_faces_come_back_bit_for_bit_and_are_joined() -> None:
    mesh: Arrays = ball(20, 30)
    keep = region(mesh)
    made = orbflow_native.remesh(*mesh, faces=N_KEPT + 300, keep_faces=keep, score_samples=0)
    before, after = corners_at(*mesh), corners_at(made.positions, made.loop_start, made.corner_vert)
    assert made.kept_faces == N_KEPT
    assert after[-N_KEPT:] == [each for each, kept in zip(before, keep, strict=True) if kept]
    assert n_open(made.loop_start, made.corner_vert) == 0
    told = made.report["kept_faces"]
    assert (told["n_faces"], told["n_stayed"]) == (N_KEPT, 0)


def test_wrong_flags_are_named() -> None:
    mesh = ball(8, 12)
    n = len(mesh[1])
    with pytest.raises(orbflow_native.InputError, match=f"5 flags of faces to keep for {n} faces"):
        orbflow_native.remesh(*mesh, keep_faces=np.zeros(5, bool))
    with pytest.raises(orbflow_native.InputError, match=f"all {n} faces are kept"):
        orbflow_native.remesh(*mesh, keep_faces=np.ones(n, bool))
    numbers: Any = np.zeros(n, np.float32)
    with pytest.raises(TypeError, match=r"keep_faces must be a \(F,\) bool array"):
        orbflow_native.remesh(*mesh, keep_faces=numbers)


def places(mesh: Any) -> list[bytes]:  # noqa: ANN401
    read = addon("mesh_arrays").read(mesh)
    return corners_at(read.positions, read.loop_start, read.corner_vert)


def top(mesh: Any) -> list[int]:  # noqa: ANN401
    """The faces all of whose vertices lie in the upper third of a mesh."""
    heights = np.array([vertex.co.z for vertex in mesh.vertices])
    is_high = heights > heights.min() + 0.67 * np.ptp(heights)
    return [face.index for face in mesh.polygons if is_high[list(face.vertices)].all()]


def mark(thing: Any, kind: str) -> tuple[str, list[int]]:  # noqa: ANN401
    """Makes a region of an object; its name, and its faces."""
    faces = top(thing.data)
    if kind == "GROUP":
        group = thing.vertex_groups.new(name="Face")
        group.add([v for i in faces for v in thing.data.polygons[i].vertices], 1.0, "REPLACE")
        return "Face", faces
    name, data_type = (".sculpt_face_set", "INT") if kind == "SET" else ("Face", "BOOLEAN")
    attribute = thing.data.attributes.new(name, data_type, "FACE")
    for i, each in enumerate(attribute.data):
        is_in = i in set(faces)
        each.value = (7 if is_in else 1) if kind == "SET" else is_in
    return ("Face Set 7" if kind == "SET" else "Face"), faces


@pytest.mark.parametrize("kind", ["GROUP", "SET", "ATTRIBUTE"])
def test_what_an_object_offers_is_kept(open_fixture: Open, kind: str) -> None:
    first = open_fixture("03")
    name, faces = mark(first, kind)
    before = places(first.data)
    assert press.orbflow_remesh(faces=len(faces) + 300, keep_faces=name) == {"FINISHED"}
    after = places(first.data)
    assert after[-len(faces) :] == [before[i] for i in faces]
    assert abs(len(after) - len(faces) - 300) <= 60
    read = addon("mesh_arrays").read(first.data)
    assert n_open(read.loop_start, read.corner_vert) == 0
    assert is_sound(first)


def test_a_region_that_is_not_there_is_said_with_those_that_are(open_fixture: Open) -> None:
    first = open_fixture("03")
    mark(first, "ATTRIBUTE")
    with pytest.raises(RuntimeError) as caught:
        press.orbflow_remesh(keep_faces="Head")
    text = "no vertex group, face set or face attribute is named 'Head'; there are: Face"
    assert text in str(caught.value)
    assert len(first.data.polygons) == 1280


def choose(thing: Any, faces: set[int]) -> None:  # noqa: ANN401
    """Selects faces in edit mode."""
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="FACE")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for face in thing.data.polygons:
        face.select = face.index in faces
    bpy.ops.object.mode_set(mode="EDIT")


def test_in_edit_mode_the_selected_faces_alone_are_remeshed(open_fixture: Open) -> None:
    first = open_fixture("03")
    chosen = set(top(first.data))
    before = [each for i, each in enumerate(places(first.data)) if i not in chosen]
    choose(first, chosen)
    assert press.orbflow_remesh(faces=80) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = places(first.data)
    assert after[-len(before) :] == before
    assert abs(len(after) - len(before) - 80) <= 30
    selected = [face.index for face in first.data.polygons if face.select]
    assert selected == list(range(len(after) - len(before)))
    assert is_sound(first)


def test_in_edit_mode_something_has_to_be_selected(open_fixture: Open) -> None:
    first = open_fixture("03")
    bpy.context.view_layer.objects.active = first
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="no face is selected"):
        press.orbflow_remesh(faces=80)
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(first.data.polygons) == 1280


def test_in_edit_mode_the_panel_tells_how_many_faces_are_selected(open_fixture: Open) -> None:
    thing: Any = open_fixture("01")
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        bpy.ops.mesh.select_all(action="SELECT")
        told = [text for text, _ in drawn(thing) if text.startswith("MESH_DATA")]
        assert told == [f"MESH_DATA {thing.data.total_face_sel:,} faces selected"]
        assert thing.data.total_face_sel > 1000
        bpy.ops.mesh.select_all(action="DESELECT")
        assert [text for text, _ in drawn(thing) if "0 faces selected" in text]
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
