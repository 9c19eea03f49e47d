"""What is left as it was stays in the panel, with a button that selects why."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import bmesh
import bpy
import numpy as np
import orbflow_native
import pytest
from conftest import FIXTURES
from sidebar import panel_of
from test_open import new, tube
from test_operator import Open, addon, press, select

Reason = dict[str, Any]
ALONE = ", which this primitive cannot have: choose Automatic"
HOLES = f"(open edges){ALONE}, or fill all borders"


def reason(kind: str, text: str, thing: Any, **more: Any) -> Reason:  # noqa: ANN401
    """A reason as the core tells it, about all faces of an object unless told otherwise."""
    faces = list(range(len(thing.data.polygons)))
    return {"kind": kind, "text": text, "place": [0.0] * 3, "edges": [], "faces": faces} | more


def border(thing: Any) -> list[list[int]]:  # noqa: ANN401
    """The edges of one face, by their ends."""
    faces_of = np.bincount(addon("attributes").corner_edges(thing.data))
    return [list(edge.vertices) for edge in thing.data.edges if faces_of[edge.index] == 1]


@pytest.fixture
def refuse(monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """A function that runs the operator with a core that leaves a part, for some reasons."""

    def run(*reasons: Reason, n_parts: int = 1) -> str:
        error: Any = orbflow_native.InputError("; ".join(each["text"] for each in reasons))
        part = {"n_faces": 120, "outcome": "kept", "reasons": list(reasons)}
        error.kept = [part | {"part": i} for i in range(n_parts)]

        def fail(*_given: Any) -> None:  # noqa: ANN401
            raise error

        monkeypatch.setattr(addon("job"), "_remesh_one", fail)
        with pytest.raises(RuntimeError) as caught:
            press.orbflow_remesh()
        return str(caught.value)

    return run


def rows(thing: Any) -> list[str]:  # noqa: ANN401
    """What the panel says between the number of faces and the sections of settings."""
    texts = [text for text, _ in panel_of(thing, width=1200).drawn]
    said = texts[texts.index("faces") + 1 : texts.index("orbflow_Shape")]
    return [text for text in said if not text.startswith("MESH_DATA")]


def selected(thing: Any) -> tuple[set[tuple[int, ...]], set[int], set[int]]:  # noqa: ANN401
    """Edges by their ends and faces that are selected in edit mode, and hidden faces."""
    shape = bmesh.from_edit_mesh(thing.data)
    edges = {tuple(sorted(v.index for v in edge.verts)) for edge in shape.edges if edge.select}
    return (
        edges,
        {face.index for face in shape.faces if face.select},
        {face.index for face in shape.faces if face.hide},
    )


@pytest.fixture(autouse=True)
def object_mode() -> Any:  # noqa: ANN401
    yield
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def test_a_refusal_stays_until_the_mesh_changes(
    open_fixture: Open, refuse: Callable[..., str]
) -> None:
    half = open_fixture("05")
    exact = "1 border loop, the first through vertex 3"
    told = refuse(reason("border", exact, half, edges=border(half), n_loops=1))
    assert f"{half.name}: has 1 hole {HOLES} \nIn exact words: {exact}" in told
    said = [f"CANCEL {half.name} was left as it was", f"DOT has 1 hole {HOLES}", "NONE Show"]
    assert rows(half) == said
    half.name = "Renamed"
    assert rows(half)[1:] == said[1:]
    press.orbflow_show(name="Renamed", row=0)
    bpy.ops.mesh.edge_face_add()
    assert rows(half)[1:] == said[1:]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert rows(half) == []


def test_all_reasons_are_told_in_the_words_of_artists(
    open_fixture: Open, refuse: Callable[..., str]
) -> None:
    thing = open_fixture("03")
    refuse(
        reason("border", "2 border loops", thing, n_loops=2),
        reason("handles", "genus 1", thing, genus=1),
        reason("one-sided", "not orientable", thing),
        reason("flat", "no volume", thing),
        reason("failed", "no map was found", thing),
    )
    layout = panel_of(thing, width=1200)
    assert [text for text, _ in layout.drawn if text.startswith("DOT ")] == [
        f"DOT has 2 holes {HOLES}",
        f"DOT has a hole through it like a ring or cup handle{ALONE}",
        "DOT inside and outside cannot be told apart (like a Moebius strip)",
        "DOT is flat",
        "DOT could not be done: no map was found",
    ]
    shows = [each for each in layout.buttons.values() if each.bl_idname == "object.orbflow_show"]
    assert [(each.name, each.row) for each in shows] == [(thing.name, i) for i in range(5)]
    exact = addon("operators.show").OBJECT_OT_orbflow_show.description(None, shows[1])
    assert exact.endswith("genus 1")


def test_every_part_has_a_row_until_these_are_many(
    open_fixture: Open, refuse: Callable[..., str]
) -> None:
    thing = open_fixture("03")
    hole = reason("border", "1 border loop", thing, n_loops=1)
    refuse(hole, n_parts=2)
    shown = [text for text, _ in panel_of(thing, width=1200).drawn if "hole" in text]
    assert shown == [f"DOT part of 120 faces: has 1 hole {HOLES}"] * 2
    told = refuse(hole, reason("flat", "no volume", thing), n_parts=1200)
    assert f"{thing.name}: 1,200 parts with holes {HOLES}; 1,200 parts flat" in told
    shown = [text for text, _ in panel_of(thing, width=1200).drawn if " parts" in text]
    assert shown == [f"DOT 1,200 parts with holes {HOLES}", "DOT 1,200 parts flat"]


def test_show_selects_edges_and_reveals_them_and_their_faces_alone(
    open_fixture: Open, refuse: Callable[..., str]
) -> None:
    half = open_fixture("05")
    ends = border(half)
    for face in half.data.polygons:
        face.hide = True
    for each in (*half.data.edges, *half.data.vertices):
        each.hide = True
    other = bpy.data.objects.new("Other", half.data.copy())
    bpy.context.scene.collection.objects.link(other)
    refuse(reason("border", "1 border loop", half, edges=ends, n_loops=1))
    select(other)
    bpy.context.view_layer.objects.active = other
    assert press.orbflow_show(name=half.name, row=0) == {"FINISHED"}
    assert (bpy.context.mode, bpy.context.object) == ("EDIT_MESH", half)
    assert bpy.context.selected_objects == [half]
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, True, False)
    edges, faces, hidden = selected(half)
    assert edges == {tuple(sorted(pair)) for pair in ends}
    assert (faces, len(hidden)) == (set(), len(half.data.polygons) - len(ends))
    shape = bmesh.from_edit_mesh(half.data)
    shown = {edge for face in shape.faces if not face.hide for edge in face.edges}
    assert {edge for edge in shape.edges if not edge.hide} == shown


def test_show_selects_the_faces_of_a_part(open_fixture: Open, refuse: Callable[..., str]) -> None:
    parts = open_fixture("11")
    parts.data.polygons[5].hide = parts.data.polygons[9].hide = True
    refuse(reason("flat", "no volume", parts, faces=[3, 4, 5]))
    assert press.orbflow_show(name=parts.name, row=0) == {"FINISHED"}
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
    assert selected(parts)[1:] == ({3, 4, 5}, {9})


def test_show_finds_the_place_on_a_mesh_that_modifiers_change(
    open_fixture: Open, refuse: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = open_fixture("03")
    more = addon("mesh_arrays").read(bpy.data.objects["Second"].data)
    more = SimpleNamespace(
        positions=np.tile(more.positions, (2, 1)), loop_start=np.tile(more.loop_start, 2)
    )
    remesh = addon("operators.remesh")
    task = addon("job").Task(first.name, more, (1.0, 1.0, 1.0))
    monkeypatch.setattr(remesh, "_tasks", lambda *_: [task])
    place = first.data.vertices[77].co
    refuse(reason("border", "1 loop", first, edges=[[1200, 1201]], n_loops=1, place=[*place]))
    assert press.orbflow_show(name=first.name, row=0) == {"FINISHED"}
    around = {face.index for face in first.data.polygons if 77 in face.vertices}
    assert selected(first)[1] == around


def test_what_has_changed_or_is_hidden_is_not_shown(
    open_fixture: Open, refuse: Callable[..., str]
) -> None:
    first = open_fixture("03")
    refuse(reason("flat", "no volume", first))
    with pytest.raises(RuntimeError, match="Gone is not there or not visible"):
        press.orbflow_show(name="Gone", row=0)
    with pytest.raises(RuntimeError, match="First has changed since"):
        press.orbflow_show(name="First", row=7)
    first.hide_set(True)
    with pytest.raises(RuntimeError, match="First is not there or not visible"):
        press.orbflow_show(name="First", row=0)
    assert bpy.context.mode == "OBJECT"


def test_a_mesh_that_was_done_after_all_is_not_called_refused_after_undo(
    open_fixture: Open, refuse: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = open_fixture("03")
    before = first.data.copy()
    refuse(reason("flat", "too few faces", first))
    assert "DOT is flat" in rows(first)
    monkeypatch.undo()
    press.orbflow_remesh(faces=200)
    assert rows(first) == []
    first.data = before
    assert rows(first) == []


def numbers(thing: Any, stays: list[int]) -> Any:  # noqa: ANN401
    """Where vertices and faces of an object lie when some of its faces follow 10 new ones."""
    arrays = addon("mesh_arrays").read(thing.data)
    corners = [c for f in stays for c in thing.data.polygons[f].loop_indices]
    vertices = np.unique(arrays.corner_vert[corners])
    n_new = 40
    starts = np.arange(10) * 4
    of_kept = n_new + 3 * np.arange(len(stays))
    new_corners = np.searchsorted(vertices, arrays.corner_vert[corners]) + 12
    result = SimpleNamespace(
        kept_faces=len(stays),
        loop_start=np.concatenate([starts, of_kept]).astype(np.int32),
        corner_vert=np.concatenate([np.zeros(n_new), new_corners]).astype(np.int32),
        origins=SimpleNamespace(
            faces=np.array([0] * 10 + stays, np.int32),
            corner_corners=[np.repeat([0] * n_new + corners, 3).reshape(-1, 3).astype(np.int32)],
        ),
    )
    return addon("spots").in_result(arrays, result), vertices


def test_the_parts_that_stay_are_found_in_the_result(open_fixture: Open) -> None:
    parts = open_fixture("11")
    stays = [50, 51, 52, 7]
    found, vertices = numbers(parts, stays)
    edge = [int(vertices[2]), int(vertices[0])]
    spot = found.of(reason("border", "1 loop", parts, edges=[edge], faces=[52, 50, 3]))
    assert spot.faces.tolist() == [12, 10]
    assert spot.edges.tolist() == [[14, 12]]


@pytest.mark.parametrize(
    ("prefix", "told", "n_faces_at"),
    [
        ("05", f"has 1 hole {HOLES}", {1}),
        ("06", "has a hole through it like a ring or cup handle", {2}),
    ],
)
def test_the_core_names_the_spot_that_show_selects(
    open_fixture: Open, prefix: str, told: str, n_faces_at: set[int]
) -> None:
    thing = open_fixture(prefix)
    with pytest.raises(RuntimeError, match="In exact words: "):
        press.orbflow_remesh(primitive="QUAD_SPHERE")
    assert " ".join(text.split(" ", 1)[1] for text in rows(thing)).startswith(
        f"{thing.name} was left as it was {told}"
    )
    assert press.orbflow_show(name=thing.name, row=0) == {"FINISHED"}
    shape = bmesh.from_edit_mesh(thing.data)
    chosen = [edge for edge in shape.edges if edge.select]
    assert {len(edge.link_faces) for edge in chosen} == n_faces_at
    if n_faces_at != {2}:
        assert len(chosen) == sum(len(edge.link_faces) in n_faces_at for edge in shape.edges)


def test_a_part_that_stays_is_shown_where_it_lies_in_the_result(open_fixture: Open) -> None:
    half = open_fixture("05")
    with bpy.data.libraries.load(str(FIXTURES / "03_shared_data.blend")) as (_, wanted):
        wanted.objects = ["First"]
    # Names while the file is open, objects afterwards.
    ball: Any = wanted.objects[0]
    bpy.context.scene.collection.objects.link(ball)
    ball.location.x = 5
    select(half, ball)
    bpy.ops.object.join()
    n_stay = len(border(half))
    assert press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE") == {"FINISHED"}
    shown = [text for text, _ in panel_of(half, width=1200).drawn if "hole" in text]
    assert shown[0] == f"DOT part of 640 faces: has 1 hole {HOLES}"
    assert press.orbflow_show(name=half.name, row=0) == {"FINISHED"}
    edges, _, _ = selected(half)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert edges == {tuple(sorted(pair)) for pair in border(half)}
    assert len(edges) == n_stay


def test_what_was_filled_is_selected_in_the_result(open_fixture: Open) -> None:
    open_fixture("03")
    thing = new(*tube())
    press.orbflow_remesh(faces=100, borders="FILL")
    layout = panel_of(thing, width=1200)
    texts = [text for text, _ in layout.drawn]
    row = texts.index("DOT 2 borders filled")
    assert "INFO 2 borders filled" not in texts
    assert texts[row + 1] == "NONE Show"
    button = layout.buttons[row + 1]
    assert bpy.ops.object.orbflow_show(name=button.name, row=button.row) == {"FINISHED"}
    _, faces, _ = selected(thing)
    bpy.ops.object.mode_set(mode="OBJECT")
    lids = {face.index for face in thing.data.polygons if abs(face.normal.z) > 0.9}
    assert lids
    assert faces == lids
