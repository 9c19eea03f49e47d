"""Meshes with borders stay open, with their borders where they were, or are filled."""

import bmesh
import bpy
import numpy as np
import orbflow_native
import pytest
from numpy.typing import NDArray
from shapes import Arrays
from test_modifiers import half_ball, is_closed, stack, told
from test_operator import Open, addon, is_sound, press

Points = NDArray[np.float64]


def rows(n: int, m: int, *, is_round: bool) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Where the vertices of rows of quads are in a square (V, 2), and the quads."""
    columns = m if is_round else m + 1
    i, j = (each.ravel() for each in np.indices((n + 1, columns)))
    a, b = (each.ravel() for each in np.indices((n, m)))
    quads = np.stack([(a, b), (a, b + 1), (a + 1, b + 1), (a + 1, b)])
    names = quads[:, 0] * columns + quads[:, 1] % columns
    return np.stack([i / n, j / m], axis=1), names.T.astype(np.int32)


def plate() -> tuple[Points, NDArray[np.int32]]:
    square, quads = rows(8, 12, is_round=False)
    return np.column_stack([1.5 * square[:, 1], square[:, 0], 0 * square[:, 0]]), quads


def tube() -> tuple[Points, NDArray[np.int32]]:
    square, quads = rows(10, 20, is_round=True)
    angle = 2 * np.pi * square[:, 1]
    return np.column_stack([np.cos(angle), np.sin(angle), 3 * square[:, 0]]), quads


def border(mesh: bpy.types.Mesh) -> Points:
    """The ends of the edges of one face, (E, 2, 3)."""
    n_faces = np.bincount(addon("attributes").corner_edges(mesh), minlength=len(mesh.edges))
    ends = np.array([edge.vertices for edge in mesh.edges]).reshape(-1, 2)[n_faces == 1]
    return np.array([vertex.co for vertex in mesh.vertices])[ends]


def off(points: Points, lines: Points) -> float:
    """How far the farthest of some points is from some lines."""
    a, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    share = ((points[:, None] - a) * along).sum(-1) / (along**2).sum(-1)
    nearest = a + np.clip(share, 0, 1)[..., None] * along
    return float(np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1).max())


def topology(thing: bpy.types.Object) -> tuple[int, int]:
    """How many borders and handles a mesh of one piece has."""
    output = told(thing)["output"]
    assert (output["n_components"], output["manifold"]) == (1, True)
    return output["n_borders"], output["genus"]


def new(points: Points, quads: NDArray[np.int32]) -> bpy.types.Object:
    """An object of quads with a UV map that shows where a vertex is in X and Y, selected."""
    mesh = bpy.data.meshes.new("Open")
    mesh.from_pydata(points.tolist(), [], quads.tolist())
    layer = mesh.uv_layers.new(name="Map")
    for corner, place in zip(mesh.loops, layer.data, strict=True):
        place.uv = mesh.vertices[corner.vertex_index].co.xy
    thing = bpy.data.objects.new("Open", mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    return thing


@pytest.mark.parametrize("fixture", ["hemisphere", "tube"])
def test_an_open_mesh_stays_open_with_its_borders_where_they_were(
    open_fixture: Open, fixture: str
) -> None:
    thing = open_fixture("05")
    if fixture == "tube":
        thing = new(*tube())
    lines = border(thing.data)
    n_borders = 2 if fixture == "tube" else 1
    assert press.orbflow_remesh(faces=120, mirror="OFF") == {"FINISHED"}
    assert is_sound(thing)
    assert {len(face.vertices) for face in thing.data.polygons} == {4}
    assert topology(thing) == (n_borders, 0)
    found = border(thing.data)
    assert len(found) >= 8 * n_borders
    size = np.linalg.norm(np.ptp(lines.reshape(-1, 3), axis=0))
    assert off(found.reshape(-1, 3), lines) < 1e-3 * size
    assert "filled" not in addon("words").sentence(told(thing))


def test_a_plate_keeps_its_corners_and_its_texture(open_fixture: Open) -> None:
    open_fixture("03")
    thing = new(*plate())
    lines = border(thing.data)
    assert press.orbflow_remesh(faces=96, mirror="OFF") == {"FINISHED"}
    assert topology(thing) == (1, 0)
    places = np.array([vertex.co for vertex in thing.data.vertices])
    for corner in ((0, 0), (1.5, 0), (0, 1), (1.5, 1)):
        assert np.linalg.norm(places - [*corner, 0], axis=1).min() < 1e-5
    assert off(border(thing.data).reshape(-1, 3), lines) < 1e-4
    corners = places[[corner.vertex_index for corner in thing.data.loops]]
    found = np.array([each.uv for each in thing.data.uv_layers["Map"].data])
    assert found == pytest.approx(corners[:, :2], abs=1e-4)
    # Both sides of the sheet would have twice as many.
    assert abs(len(thing.data.polygons) - 96) <= 5
    assert all(face.normal.z > 0.99 for face in thing.data.polygons)


def test_borders_are_filled_when_asked_and_it_is_said(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    thing = new(*tube())
    assert press.orbflow_remesh(faces=100, borders="FILL") == {"FINISHED"}
    assert is_closed(thing.data)
    assert told(thing)["warnings"] == []
    assert "; 2 borders filled" in capfd.readouterr().out


def arrays(points: Points, quads: NDArray[np.int32]) -> Arrays:
    starts = np.arange(0, quads.size, 4, dtype=np.int32)
    return points.astype(np.float32), starts, quads.ravel()


def test_a_size_says_which_borders_are_filled() -> None:
    # Round the tube it is 152 % of the diagonal.
    mesh = arrays(*tube())
    for size, n_filled in ((160.0, 2), (150.0, 0)):
        report = orbflow_native.remesh(*mesh, faces=60, borders="fill", fill_size=size).report
        opened = report["parts"][0]["opened"]
        assert (opened["n_borders"], opened["n_filled"]) == (2, n_filled)
        assert opened["way"] == (None if n_filled else "capped")
        assert report["output"]["n_borders"] == 2 - n_filled
        assert report["settings"]["borders"] == {"fill-up-to": size}
    # To keep is to keep, whatever the size.
    report = orbflow_native.remesh(*mesh, faces=60, borders="keep", fill_size=200.0).report
    assert (report["settings"]["borders"], report["output"]["n_borders"]) == ("keep", 2)


def torus() -> tuple[Points, NDArray[np.int32]]:
    square, quads = rows(12, 32, is_round=True)
    # The last row is the first.
    quads = np.where(quads >= 12 * 32, quads - 12 * 32, quads).astype(np.int32)
    tube, ring = 2 * np.pi * square[: 12 * 32].T
    radius = 1 + 0.3 * np.cos(tube)
    x, y, z = radius * np.cos(ring), radius * np.sin(ring), 0.3 * np.sin(tube)
    return np.column_stack([x, y, z]), quads


def test_a_size_says_which_handles_are_sealed() -> None:
    # Round the tube it is 50 % of the diagonal.
    mesh = arrays(*torus())
    for size, n_sealed in ((45.0, 0), (60.0, 1)):
        report = orbflow_native.remesh(*mesh, faces=200, handles="seal", seal_size=size).report
        opened = report["parts"][0]["opened"]
        assert (opened["n_sealed"] if opened else 0) == n_sealed
        assert report["output"]["genus"] == 1 - n_sealed
        assert report["settings"]["handles"] == {"seal-up-to": size}
        assert report["score"]["same_topology"]


def test_the_line_says_how_many_handles_were_sealed(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    thing = new(*torus())
    assert press.orbflow_remesh(faces=200, handles="SEAL", seal_size=60.0) == {"FINISHED"}
    assert topology(thing) == (0, 0)
    assert "; 1 handle sealed" in capfd.readouterr().out


def test_the_add_on_asks_for_handles_to_be_sealed_up_to_a_size(open_fixture: Open) -> None:
    open_fixture("03")
    settings, wanted = addon("settings"), bpy.context.scene.orbflow
    assert settings.for_core(wanted)["handles"] == "keep"
    assert not settings.is_of_use(wanted, "seal_size")
    wanted.handles, wanted.seal_size = "SEAL", 2.5
    of_core = settings.for_core(wanted)
    assert (of_core["handles"], of_core["seal_size"]) == ("seal", 2.5)
    assert settings.is_of_use(wanted, "seal_size")


def test_the_add_on_asks_for_all_or_for_a_size(open_fixture: Open) -> None:
    open_fixture("03")
    settings, wanted = addon("settings"), bpy.context.scene.orbflow
    of_core = settings.for_core(wanted)
    assert (of_core["borders"], of_core["fill_size"]) == ("keep", None)
    assert not settings.is_of_use(wanted, "fill_size")
    wanted.borders, wanted.fill_size = "FILL", 12.5
    of_core = settings.for_core(wanted)
    assert (of_core["borders"], of_core["fill_size"]) == ("fill", 12.5)
    assert settings.is_of_use(wanted, "fill_size")


def test_a_half_without_a_modifier_that_makes_it_whole_is_done_as_a_half(
    open_fixture: Open,
) -> None:
    thing = half_ball(open_fixture)
    thing.modifiers.clear()
    press.orbflow_remesh(faces=150, mirror="OFF")
    assert stack(thing) == []
    built = bmesh.new()
    built.from_mesh(thing.data)
    ends = [vertex.co for edge in built.edges if edge.is_boundary for vertex in edge.verts]
    built.free()
    assert topology(thing) == (1, 0)
    assert len(ends) >= 16
    assert max(abs(place.x) for place in ends) < 1e-3
