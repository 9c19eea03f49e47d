"""Lines that the artist has drawn: read from whatever holds them, and told of after a run."""

from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from sidebar import panel_of
from test_operator import Open, addon, press, select

RING = [(np.cos(a), np.sin(a), 0.0) for a in np.linspace(0, 2 * np.pi, 24, endpoint=False)]
LINE = [(0.0, 0.0, 0.1 * i) for i in range(5)]
# Grease Pencil is of another type before Blender 4.3.
IS_OLD = not hasattr(bpy.types, "GreasePencilDrawing")


def hold(name: str, data: Any, into: str = "") -> Any:  # noqa: ANN401
    """An object of some data in the scene, or in a collection of it."""
    thing = bpy.data.objects.new(name, data)
    collection = bpy.context.scene.collection
    if into:
        collection = collection.children.get(into)
        if collection is None:
            collection = bpy.data.collections.new(into)
            bpy.context.scene.collection.children.link(collection)
    collection.objects.link(thing)
    return thing


def curve(name: str, *lines: Any, is_closed: bool = False, into: str = "") -> Any:  # noqa: ANN401
    """A curve object of straight splines through points."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    for points in lines:
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        for each, place in zip(spline.points, points, strict=True):
            each.co = (*place, 1)
        spline.use_cyclic_u = is_closed
    return hold(name, data, into)


def edges(name: str, points: Any, pairs: Any) -> Any:  # noqa: ANN401
    """A mesh object of edges alone."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, pairs, [])
    return hold(name, data)


def pencil(name: str, *lines: Any) -> Any:  # noqa: ANN401
    """A Grease Pencil object with a layer of strokes, the last of them closed."""
    data = getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils).new(name)
    if IS_OLD:
        frame = data.layers.new("Lines").frames.new(1)
        strokes = [frame.strokes.new() for _ in lines]
        for stroke, points in zip(strokes, lines, strict=True):
            stroke.points.add(len(points))
            stroke.points.foreach_set("co", np.ravel(points))
        strokes[-1].use_cyclic = True
    else:
        drawing = data.layers.new("Lines").frames.new(1).drawing
        drawing.add_strokes([len(points) for points in lines])
        for stroke, points in zip(drawing.strokes, lines, strict=True):
            for each, place in zip(stroke.points, points, strict=True):
                each.position = place
        drawing.strokes[len(lines) - 1].cyclic = True
    return hold(name, data)


def annotate(*lines: Any) -> None:  # noqa: ANN401
    """Gives the scene an annotation of strokes in space."""
    scene = bpy.context.scene
    is_new = hasattr(bpy.data, "annotations")
    notes = (bpy.data.annotations if is_new else bpy.data.grease_pencils).new("Annotations")
    frame = notes.layers.new("Note").frames.new(1)
    if not hasattr(frame.strokes, "new"):
        pytest.skip("here annotations are drawn by hand alone")
    for points in lines:
        stroke = frame.strokes.new()
        stroke.points.add(len(points))
        if hasattr(stroke, "display_mode"):
            stroke.display_mode = "3DSPACE"
        stroke.points.foreach_set("co", np.ravel(points).astype(np.float32))
    setattr(scene, "annotation" if is_new else "grease_pencil", notes)


def read(name: str, is_exact: bool = False) -> Any:  # noqa: ANN401
    bpy.context.view_layer.update()
    return addon("guides").read(bpy.context, name, is_exact)


def test_edges_make_lines_that_end_where_more_than_two_meet(open_fixture: Open) -> None:
    open_fixture("03")
    chains = addon("guides.strokes").chains
    ring = np.array([(2, 0), (0, 1), (2, 1)])
    assert [(sorted(line), closed) for line, closed in chains(ring)] == [([0, 1, 2], True)]
    fork = np.array([(0, 1), (1, 2), (3, 1), (3, 4)])
    found = {tuple(sorted((line[0], line[-1]))): line for line, _ in chains(fork)}
    assert found[1, 4] in ([1, 3, 4], [4, 3, 1])
    assert sorted(found) == [(0, 1), (1, 2), (1, 4)]
    # A lasso: the loop begins and ends where its rope does.
    lasso = np.array([(0, 1), (1, 2), (2, 3), (3, 1)])
    assert sorted(closed for _, closed in chains(lasso)) == [False, True]


def test_strokes_whose_ends_meet_are_closed(open_fixture: Open) -> None:
    open_fixture("03")
    tidied = addon("guides.strokes").tidied
    ring = np.array(RING)
    nearly = np.concatenate([ring, ring[:1] * 0.999])
    assert tidied(nearly, False)[1]
    points, is_closed = tidied(np.concatenate([ring, ring[:1]]), False)
    assert (len(points), is_closed) == (24, True)
    assert not tidied(ring, False)[1]
    assert tidied(ring, True)[1]
    points, is_closed = tidied(np.array([LINE[0], LINE[0], LINE[1]]), True)
    assert (len(points), is_closed) == (2, False)
    assert tidied(np.array([LINE[0], (np.nan, 0, 0)]), False) is None


def test_curves_are_read_as_they_are_seen_but_for_their_thickness(open_fixture: Open) -> None:
    open_fixture("03")
    data = bpy.data.curves.new("Loop", "CURVE")
    data.dimensions, data.resolution_u = "3D", 5
    data.bevel_depth, data.extrude = 0.1, 0.2
    bezier = data.splines.new("BEZIER")
    bezier.bezier_points.add(3)
    for point, place in zip(bezier.bezier_points, RING[::6], strict=True):
        point.co = place
        point.handle_left_type = point.handle_right_type = "AUTO"
    bezier.use_cyclic_u = True
    nurbs = data.splines.new("NURBS")
    nurbs.points.add(3)
    for i, point in enumerate(nurbs.points):
        point.co = (i, 3, i % 2, 1)
    nurbs.use_endpoint_u = True
    thing = hold("Loop", data)
    thing.matrix_world = Matrix.Translation((0, 0, 7)) @ Matrix.Scale(2, 4)
    loop, line = read("Loop")
    assert (loop.is_closed, line.is_closed) == (True, False)
    assert len(loop.points) == 20
    radii = np.linalg.norm(loop.points - (0, 0, 7), axis=1)
    assert radii == pytest.approx(np.full(20, 2), abs=0.06)
    assert line.points[0] == pytest.approx((0, 6, 7))
    assert line.points[-1] == pytest.approx((6, 6, 9))
    mirror = thing.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis, mirror.use_mirror_merge = (False, True, False), False
    assert len(read("Loop")) == 4
    assert [each.name for each in bpy.data.curves] == ["Loop"]
    assert len(bpy.data.objects) == 3


def test_grease_pencil_is_read_at_the_current_frame_without_hidden_layers(
    open_fixture: Open,
) -> None:
    open_fixture("03")
    thing = pencil("Ink", LINE, RING)
    thing.location.x = 5
    line, ring = read("Ink")
    assert (line.is_closed, ring.is_closed) == (False, True)
    assert line.points == pytest.approx(np.add(LINE, (5, 0, 0)))
    assert ring.points == pytest.approx(np.add(RING, (5, 0, 0)), abs=1e-6)
    assert (line.name, ring.name) == ("Ink, stroke 1", "Ink, stroke 2")
    follower, layer = bpy.data.objects["Second"], thing.data.layers[0]
    setattr(layer, "location" if IS_OLD else "translation", (0, 1, 0))
    assert read("Ink")[0].points == pytest.approx(np.add(LINE, (5, 1, 0)), abs=1e-6)
    layer.parent = follower
    follower.location.z += 3
    assert read("Ink")[0].points == pytest.approx(np.add(LINE, (0, 1, 3)), abs=1e-6)
    layer.hide = True
    assert read("Ink") == []


def test_annotations_are_read(open_fixture: Open) -> None:
    open_fixture("03")
    annotate(LINE, [*RING, RING[0]])
    line, ring = read("Annotations")
    assert line.points == pytest.approx(np.array(LINE))
    assert (line.is_closed, ring.is_closed) == (False, True)


def test_meshes_of_edges_are_read_through_their_modifiers(open_fixture: Open) -> None:
    open_fixture("03")
    thing = edges("Wire", [(1, 0, 0), (2, 0, 0), (3, 1, 0)], [(0, 1), (1, 2)])
    (line,) = read("Wire")
    assert line.points[[0, -1]].tolist() in ([[1, 0, 0], [3, 1, 0]], [[3, 1, 0], [1, 0, 0]])
    thing.modifiers.new("Mirror", "MIRROR")
    assert len(read("Wire")) == 2


def test_names_say_how_strong_a_stroke_is(open_fixture: Open) -> None:
    open_fixture("03")
    thing = curve("exact lips", LINE, RING)
    for name in ("Follow me", "Skin"):
        thing.data.materials.append(bpy.data.materials.new(name))
    assert [each.is_exact for each in read("exact lips")] == [False, False]
    thing.data.splines[1].material_index = 1
    assert [each.is_exact for each in read("exact lips")] == [False, True]
    thing.name = "lips"
    assert [each.is_exact for each in read("lips")] == [False, False]
    assert [each.is_exact for each in read("lips", True)] == [False, True]
    ink = pencil("Ink", LINE, RING)
    layer = ink.data.layers[0]
    setattr(layer, "info" if IS_OLD else "name", "Exactly")
    assert [each.is_exact for each in read("Ink")] == [True, True]


def test_a_collection_holds_what_is_shown_in_it(open_fixture: Open) -> None:
    first = open_fixture("03")
    curve("A", LINE, into="Guides")
    hidden = curve("B", LINE, into="Guides")
    curve("C", LINE)
    assert {each.name for each in read("Guides")} == {"A", "B"}
    hidden.hide_set(True)
    assert [each.name for each in read("Guides")] == ["A"]
    assert read("") is None
    offered = addon("guides").names(bpy.context)
    assert ("Guides", "Collection") in offered
    assert ("C", "Object") in offered
    assert first.name not in dict(offered)
    with pytest.raises(RuntimeError, match="is named 'Nowhere'; there are: Guides, "):
        press.orbflow_remesh(faces=200, guides="Nowhere")


def test_strokes_come_in_the_space_of_the_object_that_they_guide(open_fixture: Open) -> None:
    first = open_fixture("03")
    first.matrix_world = Matrix.Translation((3, 0, 0)) @ Matrix.Diagonal((1, 2, 4, 1))
    second = bpy.data.objects["Second"]
    near = curve("Near", [(3, 0, 1), (3, 1, 2)], into="Guides")
    own = curve("Own", [(9, 9, 9), (9, 9, 10)], into="Guides")
    own.parent = first
    own.matrix_parent_inverse = first.matrix_world.inverted()
    drawn = read("Guides")
    of = addon("guides").of
    found = {each.name: each.points for each in of(first, drawn, True)}
    assert found["Near"] == pytest.approx(np.array([(0, 0, 0.25), (0, 0.5, 0.5)]))
    assert set(found) == {"Near", "Own"}
    assert [each.name for each in of(second, drawn, True)] == ["Near"]
    # In a run over several a stroke guides what it lies on.
    second.location = (50, 0, 0)
    bpy.context.view_layer.update()
    assert of(second, drawn, False) == ()
    assert {each.name for each in of(first, drawn, False)} == {"Near", "Own"}
    near.location.x = 47
    assert [each.name for each in of(second, read("Guides"), False)] == ["Near"]


def test_objects_of_one_mesh_share_a_result_where_they_share_their_guides(
    open_fixture: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = open_fixture("03")
    second = first.copy()
    bpy.context.scene.collection.objects.link(second)
    second.location = (20, 0, 0)
    select(first, second)
    guide = curve("Line", RING)
    wanted = bpy.context.scene.orbflow
    wanted.guides, wanted.guide_strength = "Line", "EXACT"
    tasks = addon("operators.remesh")._tasks
    alone, guided = sorted(tasks(bpy.context, wanted), key=lambda each: len(each.guides))
    assert (alone.name, alone.guides, guided.name) == (second.name, (), first.name)
    assert guided.guides[0].is_exact
    guide.hide_set(True)
    (both,) = tasks(bpy.context, wanted)
    assert both.others == (second.name,)


def outcome(number: int, what: str, distance: float | None, angle: float | None) -> dict[str, Any]:
    text = f"guide {number} is 40 mean edges off"
    figures = {"distance": distance, "angle": angle, "text": text, "strength": "follow"}
    return {"guide": number, "outcome": what} | figures


def test_guides_are_told_of_and_lost_ones_can_be_shown(
    open_fixture: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = open_fixture("03")
    curve("Lines", LINE, RING, [(0, 0, 1), (0.1, 0, 1)])
    job = addon("job")
    real = job._remesh_one

    def run(*given: Any) -> Any:  # noqa: ANN401
        result = real(*given)
        told = [outcome(0, "followed", 0.25, 11.4), outcome(1, "laid", 0.0, None)]
        told = [*told, outcome(2, "lost", 0.09, 12.1)]
        warned = [{"kind": "guide", "text": "guide 2 is lost: it is far off", "grave": False}]
        return Stood(result, result.report | {"guides": told, "warnings": warned})

    monkeypatch.setattr(job, "_remesh_one", run)
    press.orbflow_remesh(faces=200, guides="Lines")
    report = addon("runs").last_report(first.name)
    lost = "1 of 3 guides is lost: Lines, stroke 3"
    assert addon("words").sentence(report).count("lost") == 1
    assert addon("words").warnings(report) == [lost]
    rows = dict(addon("panel").rows(report))
    assert rows["Guides"] == "1 laid, 1 followed, 1 lost"
    assert rows["Off guides by"] == "0.25 edges, 11°"
    layout = panel_of(first, width=1200)
    texts = [text for text, _ in layout.drawn]
    row = texts.index("DOT guide Lines, stroke 3 is lost: 0.09 edges, 12° off")
    assert texts[row + 1] == "NONE Show"
    assert not {f"INFO {lost}", f"ERROR {lost}"} & set(texts)
    press.orbflow_show(name=first.name, row=layout.buttons[row + 1].row)
    bpy.ops.object.mode_set(mode="OBJECT")
    chosen = [face.center for face in first.data.polygons if face.select]
    assert 0 < len(chosen) < 8
    assert all((place - first.data.vertices[0].co).length > 0 for place in chosen)
    assert min(place.z for place in chosen) > 0.5


class Stood:
    """A result with another report."""

    def __init__(self, result: Any, report: dict[str, Any]) -> None:  # noqa: ANN401
        self._result, self.report = result, report

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401, D105
        return getattr(self._result, name)


def test_guides_that_guide_nothing_are_told_of(open_fixture: Open) -> None:
    first = open_fixture("03")
    curve("Lines", LINE).hide_set(True)
    press.orbflow_remesh(faces=200, guides="Lines")
    report = addon("runs").last_report(first.name)
    assert any("nothing that is shown of the guides" in each for each in told_of(report))
    press.orbflow_remesh(faces=200)
    assert not any("guides" in each for each in told_of(addon("runs").last_report(first.name)))


def test_only_quads_that_flow_are_guided(open_fixture: Open) -> None:
    open_fixture("03")
    curve("Lines", LINE)
    wanted = bpy.context.scene.orbflow
    wanted.guides = "Lines"
    tasks = addon("operators.remesh")._tasks
    assert len(tasks(bpy.context, wanted)[0].guides) == 1
    wanted.kind = "TRIANGLES"
    assert tasks(bpy.context, wanted)[0].guides is None


def told_of(report: dict[str, Any]) -> list[str]:
    return addon("words").exceptions(report)
