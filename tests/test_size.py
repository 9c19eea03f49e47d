"""How many faces an object gets, by a share or by the length of edges."""

import bpy
import numpy as np
import pytest
from sidebar import drawn
from test_operator import Open, addon, press


def test_a_share_of_the_faces_is_one_of_what_is_seen(open_fixture: Open) -> None:
    first = open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball = bpy.context.object
    wanted = bpy.context.scene.orbflow
    wanted.size, wanted.ratio = "RATIO", 25.0
    n = len(ball.data.polygons)
    assert f"MESH_DATA {round(n / 4):,} of {n:,} faces" in [text for text, _ in drawn(ball)]
    press.orbflow_remesh(size="RATIO", ratio=25.0, faces=50)
    assert len(ball.data.polygons) == pytest.approx(n / 4, rel=0.02)
    assert f"MESH_DATA {n:,} faces now" not in [text for text, _ in drawn(ball)]
    assert first.name == "First"


@pytest.mark.parametrize("kind", ["QUADS", "TRIANGLES"])
def test_edges_get_the_length_asked_for_in_the_scene(open_fixture: Open, kind: str) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball = bpy.context.object
    ball.scale = (2.0, 2.0, 2.0)
    press.orbflow_remesh(size="EDGE", edge_length=0.3, kind=kind, adaptivity=0.0)
    attributes = addon("attributes")
    ends = attributes.positions(ball.data)[attributes.edge_verts(ball.data)]
    lengths = 2 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert lengths.mean() == pytest.approx(0.3, rel=0.1)


def test_the_area_of_a_mesh_is_that_of_its_faces_however_many_corners(open_fixture: Open) -> None:
    open_fixture("03")
    read, area = addon("mesh_arrays").read, addon("size").area
    bpy.ops.mesh.primitive_circle_add(vertices=6, fill_type="NGON")
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    hexagon, cube = bpy.data.objects["Circle"].data, bpy.data.objects["Cube"].data
    assert area(read(hexagon), (1.0, 1.0, 1.0)) == pytest.approx(1.5 * np.sqrt(3))
    assert area(read(cube), (1.0, 1.0, 3.0)) == pytest.approx(8 + 4 * 12)
    assert area(read(bpy.data.meshes.new("Empty")), (1.0, 1.0, 1.0)) == 0


def test_what_the_core_does_not_take_is_not_asked_for(open_fixture: Open) -> None:
    first = open_fixture("03")
    wanted = bpy.context.scene.orbflow
    mesh = addon("mesh_arrays").read(first.data)
    wanted.size, wanted.ratio = "RATIO", 0.001
    least = addon("size").n_faces(wanted, mesh, (1.0, 1.0, 1.0))
    wanted.size, wanted.edge_length = "EDGE", 1e-6
    most = addon("size").n_faces(wanted, mesh, (1.0, 1.0, 1.0))
    core = addon("size").orbflow_native
    assert (least, most) == (core.MIN_FACES, core.MAX_FACES)
