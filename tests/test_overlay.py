"""The marks on irregular vertices; drawing itself needs a window."""

import bpy
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


def test_borders_and_empty_meshes_are_left_alone(open_fixture: Open) -> None:
    open_fixture("07")
    assert counts(bpy.data.objects["Empty"].data) == (0, 0, 0)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    assert counts(bpy.context.object.data) == (0, 0, 0)


def test_marks_are_off_at_first_and_saved_with_the_scene(open_fixture: Open) -> None:
    open_fixture("03")
    assert not bpy.context.scene.orbflow.show_irregular
    bpy.context.scene.orbflow.show_irregular = True
    assert "show_irregular" not in addon("settings").NAMES


def test_without_a_window_nothing_is_drawn(open_fixture: Open) -> None:
    open_fixture("03")
    assert addon("overlay")._handles == []
