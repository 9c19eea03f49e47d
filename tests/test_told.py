"""What is told of a run: in one line, in the panel, with a line for every object."""

from types import SimpleNamespace
from typing import Any

import bpy
import pytest
from sidebar import panel_of
from test_operator import Open, addon, press, select

Report = dict[str, Any]
HOLES = "(open edges), which this primitive cannot have: choose Automatic, or fill all borders"


def texts(thing: Any) -> list[str]:  # noqa: ANN401
    """What a wide panel says of an object."""
    return [text for text, _ in panel_of(thing, width=1000).drawn]


def after(texts: list[str], text: str) -> list[str]:
    return texts[texts.index(text) :]


@pytest.fixture
def more_told(monkeypatch: pytest.MonkeyPatch) -> Any:  # noqa: ANN401
    """A function that makes the core tell more of an object."""
    told: dict[str, Report] = {}
    real = addon("job")._remesh_one

    def remesh_one(task: Any, *others: Any) -> Any:  # noqa: ANN401
        result = real(task, *others)
        names = ("positions", "loop_start", "corner_vert", "material_index", "carried_edges")
        names += ("carried_from", "origins", "crosses", "report")
        made = SimpleNamespace(
            **{name: getattr(result, name) for name in names}, kept_faces=0, filled_faces=[]
        )
        made.report = made.report | told.get(task.name, {})
        return made

    monkeypatch.setattr(addon("job"), "_remesh_one", remesh_one)
    return told.__setitem__


def warning(text: str, *, grave: bool) -> Report:
    return {"warnings": [{"kind": "far", "text": text, "grave": grave}]}


def part(kind: str, outcome: str = "kept", **more: int) -> Report:
    reason = {"kind": kind, "text": "exactly so", "place": [0, 0, 0], "edges": [], "faces": []}
    return {"part": 0, "n_faces": 120, "outcome": outcome, "reasons": [reason | more]}


def test_several_objects_are_counted_and_each_has_a_line(
    open_fixture: Open,
    more_told: Any,  # noqa: ANN401
    capfd: pytest.CaptureFixture[str],
) -> None:
    open_fixture("02")
    left = bpy.data.objects["Left"]
    bad = left.copy()
    bad.name, bad.data = "Bad", bpy.data.meshes.new("Bad")
    bpy.context.scene.collection.objects.link(bad)
    right = bpy.data.objects["Right"]
    more_told("Right", warning("it is off by 3 %", grave=True))
    select(left, right, bad)
    assert press.orbflow_remesh(faces=200) == {"FINISHED"}
    out = capfd.readouterr().out
    assert "Warning: 1 done, 1 with warnings, 1 refused; see the panel" in out
    assert "Info: Bad: the mesh has no faces" in out
    assert "Info: Right: " in out
    assert "Info: Left: " not in out
    shown = after(texts(left), "NONE 1 done, 1 with warnings, 1 refused")
    n_left, n_right = len(left.data.polygons), len(right.data.polygons)
    assert shown[1].startswith("CANCEL Bad: the mesh has no faces")
    assert shown[2] == f"ERROR Right: 320 → {n_right}; it is off by 3 %"
    assert shown[3] == f"CHECKMARK Left: 320 → {n_left}"


def test_where_nothing_can_be_done_all_reasons_are_told(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    first = open_fixture("03")
    second = bpy.data.objects["Second"]
    for thing in (first, second):
        thing.data = bpy.data.meshes.new("Empty")
    select(first, second)
    with pytest.raises(RuntimeError, match="2 refused; see the panel"):
        press.orbflow_remesh()
    out = capfd.readouterr().out
    assert all(f"Info: {name}: the mesh has no faces" in out for name in ("First", "Second"))


def test_a_line_selects_its_object_and_goes_with_its_mesh(open_fixture: Open) -> None:
    left = open_fixture("02")
    right = bpy.data.objects["Right"]
    before = right.data.copy()
    press.orbflow_remesh(faces=200)
    lines = [each for each in panel_of(left).buttons.values() if hasattr(each, "name")]
    assert {each.name for each in lines} == {thing.name for thing in bpy.data.objects}
    assert press.orbflow_show(name="Right") == {"FINISHED"}
    assert (bpy.context.object, bpy.context.selected_objects) == (right, [right])
    assert bpy.context.mode == "OBJECT"
    right.data = before
    assert f"NONE {len(lines) - 1} done" in texts(left)
    press.orbflow_remesh(faces=200)
    assert not any("done" in text for text in texts(left))


def test_many_objects_do_not_fill_the_panel(open_fixture: Open) -> None:
    first = open_fixture("03")
    runs = addon("runs")
    lines = [runs.Line(f"Thing {i}", "done", "12 → 20", None) for i in range(1200)]
    runs.remember_lines([*lines, runs.Line("Bad", "refused", "is flat", None)])
    shown = after(texts(first), "NONE 1,200 done, 1 refused")
    assert shown[1] == "CANCEL Bad: is flat"
    assert "BLANK1 and 1,161 more" in shown


def test_one_object_is_told_in_a_sentence_that_warns(
    open_fixture: Open,
    more_told: Any,  # noqa: ANN401
    capfd: pytest.CaptureFixture[str],
) -> None:
    first = open_fixture("03")
    more_told("First", warning("it is off by 3 %", grave=True))
    press.orbflow_remesh(faces=200)
    n = len(first.data.polygons)
    assert f"Warning: 1,280 faces became {n}; it is off by 3 %" in capfd.readouterr().out
    shown = after(texts(first), "show_crosses")
    assert shown[1] == "ERROR it is off by 3 %"
    more_told("First", warning("210 faces were made, 200 were asked for", grave=False))
    press.orbflow_remesh(faces=200)
    assert "Info: " in (out := capfd.readouterr().out)
    assert "; 210 faces were made, 200 were asked for" in out


def test_parts_that_were_left_are_told_of_with_their_reasons(
    open_fixture: Open,
    more_told: Any,  # noqa: ANN401
    capfd: pytest.CaptureFixture[str],
) -> None:
    first = open_fixture("03")
    kept = [part("border", n_loops=2), part("small", "dropped"), part("small", "dropped")]
    more_told("First", {"kept": kept})
    press.orbflow_remesh(faces=200)
    told = [
        f"1 of 4 parts left as they were: has 2 holes {HOLES}",
        "2 of 4 parts left out: 2 too small for this face count",
    ]
    out = capfd.readouterr().out
    assert out.startswith("Warning: ") or "\nWarning: " in out
    assert "; ".join(told) in out
    layout = panel_of(first, width=1200)
    shown = [text for text, _ in layout.drawn]
    assert after(shown, "ERROR 1 of 4 parts left as they were; 2 of 4 parts left out")[1:5] == [
        f"DOT part of 120 faces: has 2 holes {HOLES}",
        "NONE Show",
        "DOT part of 120 faces: is too small for this face count; left out",
        "DOT part of 120 faces: is too small for this face count; left out",
    ]


def test_parts_that_are_merely_small_are_no_warning(
    open_fixture: Open,
    more_told: Any,  # noqa: ANN401
    capfd: pytest.CaptureFixture[str],
) -> None:
    open_fixture("03")
    more_told("First", {"kept": [part("small")]})
    press.orbflow_remesh(faces=200)
    out = capfd.readouterr().out
    assert "Warning" not in out
    assert "1 of 2 parts left as they were: is too small for this face count" in out


def test_hidden_faces_and_nodes_that_stay_are_told_of(open_fixture: Open) -> None:
    first = open_fixture("03")
    for face in first.data.polygons[:12]:
        face.hide = True
    first.modifiers.new("Scatter", "NODES").node_group = bpy.data.node_groups.new(
        "Scatter", "GeometryNodeTree"
    )
    press.orbflow_remesh(faces=200, use_modifiers=False)
    shown = texts(first)
    assert "INFO 12 hidden faces are shown again" in shown
    assert "INFO modifier Scatter stays: see whether it fits the new mesh" in shown


def test_what_does_not_apply_to_triangles_has_no_row(open_fixture: Open) -> None:
    open_fixture("03")
    press.orbflow_remesh(faces=200, kind="TRIANGLES")
    report = addon("runs").last_report("First")
    report["score"] |= dict.fromkeys(("alignment_deg", "loop_edges_pct", "spiral_pct"))
    shown = dict(addon("panel").rows(report))
    assert "Faces" in shown
    assert not {"Quads", "Flow deviation", "On closed loops", "In spirals"} & shown.keys()


def test_settings_that_change_nothing_are_grey(open_fixture: Open) -> None:
    first = open_fixture("03")
    settings = bpy.context.scene.orbflow

    def grey() -> set[str]:
        drawn = panel_of(first).drawn
        return {name for name, row in drawn if not row.active} - {"show_crosses", "orbflow_before"}

    assert grey() == {"fill_size", "seal_size", "solid_detail", "guide_strength"}
    settings.guides = "Lines"
    settings.borders, settings.handles, settings.solid = "FILL", "SEAL", True
    assert grey() == {"inner"}
    settings.solid = False
    assert grey() == {"solid_detail"}
    settings.kind = "TRIANGLES"
    of_flow = {
        *("follow_shape", "adaptivity", "own_quads"),
        *("density", "mirror", "guides", "guide_strength"),
    }
    assert grey() == of_flow | {"solid_detail"}
    settings.kind = "QUADS"
    settings.use_weld = settings.use_modifiers = False
    assert grey() == {"weld", "mirror_modifier", "solid_detail"}


def test_every_setting_has_one_place_in_the_panel(open_fixture: Open) -> None:
    first = open_fixture("03")
    settings, wanted = addon("settings"), bpy.context.scene.orbflow
    places = [*settings.FIRST, *(name for names in settings.SECTIONS.values() for name in names)]
    assert sorted(places) == sorted(settings.NAMES)
    for size, shown in (("FACES", "faces"), ("RATIO", "ratio"), ("EDGE", "edge_length")):
        wanted.size = size
        names = {text for text, _ in panel_of(first).drawn}
        assert names & {"faces", "ratio", "edge_length"} == {shown}
        assert set(settings.NAMES) - names == {"faces", "ratio", "edge_length"} - {shown}


def test_figures_stand_beside_those_made_by_hand(open_fixture: Open) -> None:
    open_fixture("03")
    press.orbflow_remesh(faces=200)
    report = addon("runs").last_report("First")

    def shown(**figures: object) -> tuple[str, str]:
        report["score"] |= figures
        rows = dict(addon("panel").rows(report))
        return rows["On closed loops"], rows["In spirals"]

    assert shown(loop_edges_pct=38.0, spiral_pct=4.2) == (
        "38 %, as by hand",
        "4 %, by hand less",
    )
    assert shown(loop_edges_pct=12.0, spiral_pct=0.0) == (
        "12 %, by hand more",
        "0 %, as by hand",
    )
    assert shown(closed=False) == ("12 %", "0 %")


def test_the_redo_panel_gives_the_sidebar_its_settings_and_keeps_the_ticks(
    open_fixture: Open,
) -> None:
    open_fixture("03")
    scene, overlay = bpy.context.scene, addon("overlay")
    scene.orbflow.show_irregular = True
    overlay._note_ticks(scene)
    # What undo does.
    scene.orbflow.show_irregular = False
    names = addon("settings").NAMES
    kind = addon("operators.remesh").OBJECT_OT_orbflow_remesh
    wanted = {name: getattr(scene.orbflow, name) for name in names} | {"faces": 300}
    run = SimpleNamespace(**wanted, options=SimpleNamespace(is_repeat=True), report=lambda *_: None)
    run._finish = kind._finish.__get__(run)
    assert kind.execute(run, bpy.context) == {"FINISHED"}
    assert (scene.orbflow.faces, scene.orbflow.show_irregular) == (300, True)
    run.options.is_repeat, run.faces = False, 400
    kind.execute(run, bpy.context)
    assert scene.orbflow.faces == 300


def test_seams_are_welded_within_a_share_or_not_at_all(open_fixture: Open) -> None:
    open_fixture("03")
    settings = bpy.context.scene.orbflow
    of_core = addon("settings").for_core(settings)
    assert (of_core["weld"], of_core["small_parts"], of_core["small_size"]) == (1e-5, "keep", 0.0)
    settings.use_weld = False
    assert addon("settings").for_core(settings)["weld"] is None
