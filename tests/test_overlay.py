"""The marks on irregular vertices; drawing itself needs a window."""

from pathlib import Path

import bpy
import numpy as np
import orbflow_native
import pytest
from mathutils import Matrix
from shapes import ball
from sidebar import drawn
from test_operator import Open, addon, press


def counts(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """How many vertices have one edge too few, one too many, and are otherwise irregular."""
    found = addon("overlay").irregular(mesh)
    return len(found.fewer), len(found.more), len(found.other)


def test_a_box_of_quads_is_irregular_at_its_corners(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object.data
    assert counts(cube) == (8, 0, 0)
    marked = addon("overlay").irregular(cube).fewer
    assert sorted(map(tuple, marked)) == sorted(tuple(each.co) for each in cube.vertices)


def test_a_quad_sphere_has_eight_irregular_vertices(open_fixture: Open) -> None:
    spot = open_fixture("01")
    press.orbflow_remesh(faces=500, primitive="QUAD_SPHERE")
    assert counts(spot.data) == (8, 0, 0)


def test_triangles_are_regular_where_six_edges_meet(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    assert counts(bpy.context.object.data) == (12, 0, 0)


def test_many_edges_at_a_vertex_are_marked_by_how_many(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    assert counts(bpy.context.object.data) == (0, 0, 2)


def test_grids_and_empty_meshes_have_no_marks(open_fixture: Open) -> None:
    open_fixture("07")
    assert counts(bpy.data.objects["Empty"].data) == (0, 0, 0)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    assert counts(bpy.context.object.data) == (0, 0, 0)


def test_a_border_has_three_edges_at_its_vertices_and_two_at_its_corners(
    open_fixture: Open,
) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    grid = bpy.context.object.data
    corner, beside, across = grid.vertices[0], grid.vertices[1], grid.vertices[5]
    # The corner is one no more: its two edges go straight on.
    corner.co = (beside.co + across.co) / 2
    marked = addon("overlay").irregular(grid)
    assert counts(grid)[0] == 1
    assert tuple(marked.fewer[0]) == tuple(corner.co)


def test_a_border_of_triangles_has_room_for_one_every_sixty_degrees(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_circle_add(vertices=6, fill_type="TRIFAN")
    assert counts(bpy.context.object.data) == (0, 0, 0)


def test_marks_are_off_at_first_and_saved_with_the_scene(open_fixture: Open) -> None:
    open_fixture("03")
    assert not bpy.context.scene.orbflow.show_irregular
    bpy.context.scene.orbflow.show_irregular = True
    assert "show_irregular" not in addon("settings").NAMES


def test_without_a_window_nothing_is_drawn(open_fixture: Open) -> None:
    open_fixture("03")
    assert addon("overlay")._handles == []


def lengths(crosses: np.ndarray) -> np.ndarray:
    """Of the two arms of crosses."""
    return np.linalg.norm(crosses[:, 1:], axis=2)


def test_the_field_is_kept_for_the_session_and_lies_on_the_mesh(open_fixture: Open) -> None:
    spot = open_fixture("01")
    assert addon("runs").last_crosses(spot) is None
    press.orbflow_remesh(faces=500)
    crosses = addon("runs").last_crosses(spot)
    assert 2000 < len(crosses) <= addon("settings").N_CROSSES
    low, high = (np.array(spot.bound_box).min(0) - 0.05, np.array(spot.bound_box).max(0) + 0.05)
    assert ((crosses[:, 0] > low) & (crosses[:, 0] < high)).all()
    first, second = crosses[:, 1], crosses[:, 2]
    assert np.abs((first * second).sum(1)).max() < 1e-6
    assert lengths(crosses)[:, 0] == pytest.approx(lengths(crosses)[:, 1], rel=1e-3)
    edges = [
        (spot.data.vertices[a].co - spot.data.vertices[b].co).length
        for a, b in (edge.vertices for edge in spot.data.edges)
    ]
    assert np.median(2 * lengths(crosses)) == pytest.approx(np.median(edges), rel=0.25)
    (figure,) = addon("overlay").figures(spot, "crosses")
    n_shown = len(figure.positions) / 4
    assert len(spot.data.polygons) / 2 < n_shown <= len(spot.data.polygons)
    arm = figure.positions[1] - figure.positions[0]
    assert np.cross(arm, first[0]) == pytest.approx(0, abs=1e-6)
    assert 0.6 <= np.linalg.norm(arm) / np.linalg.norm(2 * first[0]) < 0.9


@pytest.mark.usefixtures("_extension")
@pytest.mark.parametrize(("n_faces", "n_shown", "arm"), [(1000, 1000, 0.6), (16_000, 4000, 1.2)])
def test_crosses_fill_the_surface_and_do_not_meet(n_faces: int, n_shown: int, arm: float) -> None:
    crosses = np.tile(np.eye(3, dtype=np.float32), (4000, 1, 1))
    lines = addon("overlay").cross_lines(crosses, n_faces)
    assert lines.dtype == np.float32
    assert len(lines) == 4 * n_shown
    assert lines[:4] == pytest.approx(
        np.array([(1, -arm, 0), (1, arm, 0), (1, 0, -arm), (1, 0, arm)])
    )


def test_no_field_is_shown_of_a_mesh_that_has_changed_or_does_not_flow(open_fixture: Open) -> None:
    first = open_fixture("03")
    press.orbflow_remesh(faces=200, kind="TRIANGLES")
    assert len(addon("runs").last_crosses(first)) == 0
    press.orbflow_remesh(faces=200)
    assert len(addon("runs").last_crosses(first)) > 100
    first.data = bpy.data.meshes.new("Other")
    assert addon("overlay").figures(first, "crosses") == []


def test_what_is_kept_of_a_run_belongs_to_the_mesh_it_made(open_fixture: Open) -> None:
    first = open_fixture("03")
    runs, made = addon("runs"), []
    for _ in range(2):
        press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
        made.append(first.data.copy())
    # One count of faces, as after undo of the second run: the score is that of the mesh.
    assert len(made[0].polygons) == len(made[1].polygons)
    for mesh, n_faces in zip(made, (1280, len(made[0].polygons)), strict=True):
        first.data = mesh
        assert runs.last_report(first.name)["input"]["n_faces"] == n_faces
    press.orbflow_remesh(faces=200)
    first.name = "Renamed"
    assert len(runs.last_crosses(first)) > 100
    # Applying a scale moves the surface away from the crosses.
    first.data.transform(Matrix.Scale(2, 4))
    assert runs.last_crosses(first) is None


def test_only_the_newest_runs_are_kept(open_fixture: Open) -> None:
    first = open_fixture("03")
    runs = addon("runs")
    press.orbflow_remesh(faces=200)
    report = runs.last_report("First")
    for i in range(2 * runs._N_KEPT):
        first.data.vertices[0].co.x = i
        runs.remember(first, report, np.empty((0, 3, 3), np.float32))
    assert len(runs._last) == runs._N_KEPT
    assert len(runs.last_crosses(first)) == 0


def test_crosses_are_told_only_when_asked_for() -> None:
    mesh = ball()
    assert orbflow_native.remesh(*mesh, faces=200, score_samples=0).crosses.shape == (0, 3, 3)
    some = orbflow_native.remesh(*mesh, faces=200, score_samples=0, n_crosses=50)
    assert 25 <= len(some.crosses) <= 50


def test_the_file_does_not_grow_by_what_is_shown(open_fixture: Open, tmp_path: Path) -> None:
    open_fixture("03")
    sizes = []
    press.orbflow_remesh(faces=200)
    for shows in (False, True):
        bpy.context.scene.orbflow.show_crosses = shows
        bpy.ops.wm.save_as_mainfile(
            filepath=str(tmp_path / "shown.blend"), compress=False, copy=True
        )
        sizes.append((tmp_path / "shown.blend").stat().st_size)
    assert abs(sizes[1] - sizes[0]) < 2000


def test_what_is_drawn_is_kept_until_the_mesh_changes(open_fixture: Open) -> None:
    first = open_fixture("03")
    kept, made = addon("overlay")._kept, []

    def get() -> None:
        kept.get("irregular", first.data, lambda: made.append(1) or [])

    get()
    get()
    assert len(made) == 1
    first.location.x = 2
    bpy.context.view_layer.update()
    get()
    assert len(made) == 1
    first.data.vertices[0].co.x += 1
    first.data.update_tag()
    bpy.context.view_layer.update()
    get()
    assert len(made) == 2
    press.orbflow_remesh(faces=200)
    get()
    assert len(made) == 3


def test_the_box_for_crosses_is_grey_while_there_is_no_field(open_fixture: Open) -> None:
    first = open_fixture("03")
    assert not dict(drawn(first))["show_crosses"].active
    press.orbflow_remesh(faces=200, kind="TRIANGLES")
    assert not dict(drawn(first))["show_crosses"].active
    press.orbflow_remesh(faces=200)
    assert dict(drawn(first))["show_crosses"].active
    assert dict(drawn(first))["show_irregular"].active


def test_sentences_are_broken_at_the_width_of_the_sidebar(open_fixture: Open) -> None:
    first = open_fixture("03")
    for name in ("Turn", "Spin"):
        first.data.attributes.new(name, "QUATERNION", "POINT")
    press.orbflow_remesh(faces=200)

    def lines(width: int) -> list[str]:
        icons = ("INFO ", "BLANK1 ")
        return [text for text, _ in drawn(first, width) if text.startswith(icons)]

    whole = "not carried over: attribute Spin, attribute Turn"
    assert lines(600) == [f"INFO {whole}"]
    for width in (200, 292):
        first_line, *others = lines(width)
        assert first_line.startswith("INFO ")
        assert others
        assert all(each.startswith("BLANK1 ") for each in others)
        assert " ".join(each.split(" ", 1)[1] for each in lines(width)) == whole
        assert max(len(each.split(" ", 1)[1]) for each in lines(width)) < width / 6
