"""What the artist has left on a mesh is on the result too, or it is said that it is gone."""

from typing import Any

import bmesh
import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import ball, on_the_ring
from test_operator import Open, addon, press

SEAM = "use_seam"  # a property: the name of the attribute is not the same in all versions
EDGE_LAYERS = {
    "sharp_edge": ("BOOLEAN", True),
    SEAM: ("BOOLEAN", True),
    "crease_edge": ("FLOAT", 0.6),
    "bevel_weight_edge": ("FLOAT", 0.25),
    "freestyle_edge": ("BOOLEAN", True),
    "Mine": ("INT", 7),
}


def sphere_with_ring(layers: dict[str, tuple[str, Any]]) -> Any:  # noqa: ANN401
    """A sphere whose edges around the middle have these values."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    thing = bpy.context.object
    mesh = thing.data
    ring = [e for e in mesh.edges if all(abs(mesh.vertices[v].co.z) < 1e-6 for v in e.vertices)]
    for name, (kind, value) in layers.items():
        if name == SEAM:
            for edge in ring:
                edge.use_seam = value
            continue
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, "EDGE")
        for edge in ring:
            attribute.data[edge.index].value = value
    return thing


def values(mesh: Any, name: str) -> np.ndarray:  # noqa: ANN401
    if name == SEAM:
        return np.array([edge.use_seam for edge in mesh.edges])
    attribute = mesh.attributes[name]
    assert (attribute.domain, len(attribute.data)) == ("EDGE", len(mesh.edges))
    return np.array([each.value for each in attribute.data])


def test_what_is_on_edges_is_on_those_that_lie_along_them(open_fixture: Open) -> None:
    open_fixture("03")
    thing = sphere_with_ring(EDGE_LAYERS)
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    is_on, length = on_the_ring(mesh)
    assert length > 0.95 * 2 * np.pi
    for name, (kind, value) in EDGE_LAYERS.items():
        assert name == SEAM or mesh.attributes[name].data_type == kind
        wanted = np.where(is_on, value, 0)
        assert values(mesh, name) == pytest.approx(wanted), name
    assert not mesh.validate()


def test_a_mark_that_ends_halfway_round_does_so_in_the_result(open_fixture: Open) -> None:
    open_fixture("03")
    thing = sphere_with_ring({"crease_edge": ("FLOAT", 1.0)})
    mesh = thing.data
    for edge, crease in zip(mesh.edges, values(mesh, "crease_edge"), strict=True):
        is_right = sum(mesh.vertices[v].co.x for v in edge.vertices) > 0
        edge.use_seam = bool(crease > 0 and is_right)
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    ring, half = (values(mesh, name) > 0 for name in ("crease_edge", SEAM))
    assert half.sum() == pytest.approx(ring.sum() / 2, abs=2)
    assert not (half & ~ring).any()
    right = [edge.vertices for edge, on in zip(mesh.edges, half, strict=True) if on]
    assert min(sum(mesh.vertices[v].co.x for v in ends) for ends in right) > -0.3


def test_marks_that_no_edge_lies_on_are_said_to_be_gone(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    thing = sphere_with_ring({SEAM: ("BOOLEAN", True)})
    press.orbflow_remesh(faces=400, marked_edges=set())
    assert not values(thing.data, SEAM).any()
    told = "of the marks of edges are gone: no edge lies there"
    assert told in capfd.readouterr().out
    (text,) = addon("words").exceptions(addon("runs").last_report(thing.name))
    assert text == f"100 % {told}"


def dressed() -> Any:  # noqa: ANN401
    """A sphere with a field of every kind, each a plain function of the place."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    thing = bpy.context.object
    mesh = thing.data
    heights = np.array([vertex.co.z for vertex in mesh.vertices])
    corners = np.array([corner.vertex_index for corner in mesh.loops])
    high = np.array([face.center.z > 0 for face in mesh.polygons])
    fields = {
        "Height": ("FLOAT", "POINT", "value", heights),
        "Place": ("FLOAT_VECTOR", "POINT", "vector", [vertex.co[:] for vertex in mesh.vertices]),
        "Tint": ("FLOAT_COLOR", "POINT", "color", [(h, 0, 1, 1) for h in heights / 2 + 0.5]),
        "Paint": ("BYTE_COLOR", "CORNER", "color", [(h, h, h, 1) for h in heights[corners] ** 2]),
        "Side": ("INT", "FACE", "value", np.where(high, 3, -4)),
        "Region": ("INT", "POINT", "value", np.where(heights > 0, 1, 2)),
        "Chosen": ("BOOLEAN", "FACE", "value", high),
    }
    for name, (kind, domain, field, numbers) in fields.items():
        data = mesh.attributes.new(name, kind, domain).data
        number = {"INT": np.int32, "BOOLEAN": bool}.get(kind, np.float32)
        data.foreach_set(field, np.asarray(numbers, number).ravel())
    return thing


def read(mesh: Any, name: str, field: str = "value", width: int = 1) -> np.ndarray:  # noqa: ANN401
    attribute = mesh.attributes[name]
    numbers = np.empty(width * len(attribute.data), np.float32)
    for i, each in enumerate(attribute.data):
        numbers[width * i : width * (i + 1)] = getattr(each, field)
    return numbers.reshape(-1, width)


def test_attributes_of_every_kind_come_over(open_fixture: Open) -> None:
    open_fixture("03")
    dressed()
    press.orbflow_remesh(faces=600)
    mesh = bpy.context.object.data
    places = np.array([vertex.co for vertex in mesh.vertices])
    corners = np.array([corner.vertex_index for corner in mesh.loops])
    heights = places[:, 2]
    assert read(mesh, "Height")[:, 0] == pytest.approx(heights, abs=0.01)
    assert read(mesh, "Place", "vector", 3) == pytest.approx(places, abs=0.02)
    assert read(mesh, "Tint", "color", 4)[:, 0] == pytest.approx(heights / 2 + 0.5, abs=0.01)
    paint = read(mesh, "Paint", "color", 4)[:, 0]
    assert paint == pytest.approx(heights[corners] ** 2, abs=0.05)
    middles = np.array([face.center.z for face in mesh.polygons])
    clear = np.abs(middles) > 0.1
    assert (read(mesh, "Side")[:, 0] == np.where(middles > 0, 3, -4))[clear].all()
    assert (read(mesh, "Chosen")[:, 0] == (middles > 0))[clear].all()
    clear = np.abs(heights) > 0.1
    assert (read(mesh, "Region")[:, 0] == np.where(heights > 0, 1, 2))[clear].all()
    assert mesh.color_attributes.active_color_name in {"Tint", "Paint"}
    assert not mesh.validate()


def test_texture_coordinates_come_over_island_by_island(open_fixture: Open) -> None:
    open_fixture("03")
    thing = dressed()
    mesh = thing.data
    mesh.uv_layers.new(name="Second")
    first = mesh.uv_layers[0].name
    # Two islands that lie apart: the upper half as seen from above, the lower one moved aside.
    for face in mesh.polygons:
        aside = 0.0 if face.center.z > 0 else 5.0
        for corner in face.loop_indices:
            x, y, _ = mesh.vertices[mesh.loops[corner].vertex_index].co
            mesh.attributes[first].data[corner].vector = (x + aside, y)
    mesh.uv_layers.active = mesh.uv_layers["Second"]
    press.orbflow_remesh(faces=600)
    mesh = thing.data
    assert [layer.name for layer in mesh.uv_layers] == [first, "Second"]
    assert mesh.uv_layers.active.name == "Second"
    coordinates = read(mesh, first, "vector", 2)
    for face in mesh.polygons:
        found = coordinates[list(face.loop_indices)]
        wanted = np.array([mesh.vertices[v].co[:2] for v in face.vertices])
        aside = found[:, 0].mean() > 2.5
        # No face is stretched from one island to the other, and all lie where they should.
        assert np.abs(found - wanted - (5.0 * aside, 0)).max() < 0.12
        if abs(face.center.z) > 0.15:
            assert aside == (face.center.z < 0)


def test_vertex_groups_keep_names_order_and_weights(open_fixture: Open) -> None:
    open_fixture("03")
    thing = dressed()
    names = ["Arm", "Leg", "Empty"]
    for name in names:
        thing.vertex_groups.new(name=name)
    for vertex in thing.data.vertices:
        thing.vertex_groups["Leg"].add([vertex.index], (1 - vertex.co.z) / 2, "REPLACE")
        if vertex.co.x > 0:
            thing.vertex_groups["Arm"].add([vertex.index], 1.0, "REPLACE")
    thing.vertex_groups["Arm"].lock_weight = True
    thing.vertex_groups.active_index = 1
    thing.modifiers.new("Bend", "SIMPLE_DEFORM").vertex_group = "Arm"
    press.orbflow_remesh(faces=600)
    assert [group.name for group in thing.vertex_groups] == names
    assert [group.lock_weight for group in thing.vertex_groups] == [True, False, False]
    assert thing.vertex_groups.active_index == 1
    assert thing.modifiers["Bend"].vertex_group == "Arm"
    for vertex in thing.data.vertices:
        weights = {thing.vertex_groups[each.group].name: each.weight for each in vertex.groups}
        assert weights.get("Leg", 0) == pytest.approx((1 - vertex.co.z) / 2, abs=0.01)
        if abs(vertex.co.x) > 0.2:
            assert weights.get("Arm", 0) == pytest.approx(float(vertex.co.x > 0), abs=1e-3)
        assert "Empty" not in weights


def test_weights_of_groups_that_do_not_exist_are_nothing(open_fixture: Open) -> None:
    thing = open_fixture("03")
    thing.data = thing.data.copy()
    thing.vertex_groups.new(name="Arm").add([3], 0.5, "REPLACE")
    built = bmesh.new()
    built.from_mesh(thing.data)
    built.verts.ensure_lookup_table()
    built.verts[3][built.verts.layers.deform.verify()][7] = 1.0
    built.to_mesh(thing.data)
    built.free()
    (arm,) = addon("artist.groups").read(thing)
    assert (arm.weights[3], arm.weights.sum()) == (0.5, 0.5)
    assert press.orbflow_remesh(faces=200, density="Arm") == {"FINISHED"}


def test_shape_keys_keep_their_moves_settings_and_drivers(open_fixture: Open) -> None:
    open_fixture("03")
    thing = dressed()
    thing.shape_key_add(name="Basis")
    smile, wink = thing.shape_key_add(name="Smile"), thing.shape_key_add(name="Wink")
    for vertex, moved in zip(thing.data.vertices, smile.data, strict=True):
        moved.co = vertex.co + vertex.co * vertex.co.z
    smile.value, smile.slider_max, wink.mute = 0.25, 2.0, True
    wink.relative_key = smile
    smile.driver_add("slider_min").driver.expression = "-0.5"
    follow = wink.driver_add("value").driver
    follow.expression = "other"
    other = follow.variables.new()
    other.name = "other"
    other.targets[0].id_type = "KEY"
    other.targets[0].id = thing.data.shape_keys
    other.targets[0].data_path = 'key_blocks["Smile"].value'
    thing.active_shape_key_index = 1
    press.orbflow_remesh(faces=600)
    keys = thing.data.shape_keys
    assert [key.name for key in keys.key_blocks] == ["Basis", "Smile", "Wink"]
    assert thing.active_shape_key_index == 1
    smile, wink = keys.key_blocks["Smile"], keys.key_blocks["Wink"]
    assert (smile.value, smile.slider_max, wink.mute) == (0.25, 2.0, True)
    assert wink.relative_key == smile
    for vertex, moved in zip(thing.data.vertices, smile.data, strict=True):
        wanted = tuple(vertex.co + vertex.co * vertex.co.z)
        assert tuple(moved.co) == pytest.approx(wanted, abs=0.02)
    driver, follow = keys.animation_data.drivers
    assert driver.driver.expression == "-0.5"
    assert driver.data_path == 'key_blocks["Smile"].slider_min'
    assert len(bpy.data.shape_keys) == 1
    assert follow.driver.variables[0].targets[0].id == keys
    smile.value = 0.75
    bpy.context.view_layer.update()
    assert wink.value == pytest.approx(0.75)


def test_what_cannot_be_carried_is_named(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    thing = dressed()
    thing.data.attributes.new("Turn", "QUATERNION", "POINT")
    press.orbflow_remesh(faces=200)
    told = "not carried over: attribute Turn"
    assert told in capfd.readouterr().out
    assert told in addon("words").exceptions(addon("runs").last_report(thing.name))


def test_what_belongs_to_no_face_and_what_is_bound_to_vertices_is_named(
    open_fixture: Open,
) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_cube_add(size=4)
    cage = bpy.context.object
    thing = dressed()
    built = bmesh.new()
    built.from_mesh(thing.data)
    places = [built.verts.new((0, 0, 3 + i)) for i in range(4)]
    built.edges.new(places[:2])
    built.edges.new(places[1:3])
    built.to_mesh(thing.data)
    built.free()
    for name in ("Held", "Free"):
        thing.modifiers.new(name, "HOOK").object = cage
    thing.modifiers["Held"].vertex_indices_set([0, 1])
    thing.modifiers.new("Soft", "CORRECTIVE_SMOOTH")
    thing.modifiers.new("Follow", "SURFACE_DEFORM").target = cage
    bpy.ops.object.surfacedeform_bind(modifier="Follow")
    press.orbflow_remesh(faces=200)
    lost = "2 loose edges, binding of modifier Follow, binding of modifier Held"
    told = [f"not carried over: {lost}", "left out: 4 loose vertices"]
    words = addon("words")
    report = addon("runs").last_report(thing.name)
    assert words.exceptions(report) == told
    report["clean"] |= {"n_isolated": 0, "n_degenerate": 1, "n_duplicates": 2, "n_doubled": 1200}
    assert words.exceptions(report)[1] == (
        "left out: 1 face of fewer than 3 corners, 2 faces that are there twice, "
        "1,200 triangles back to back with others"
    )


def test_origins_name_corners_of_the_input_and_mix_to_the_place() -> None:
    mesh = ball()
    plain, told = (
        orbflow_native.remesh(*mesh, faces=300, score_samples=0, cut_edges=cuts)
        for cuts in (None, [np.zeros((0, 2), np.int32)])
    )
    assert plain.origins is None
    assert plain.positions.tobytes() == told.positions.tobytes()
    origins = told.origins
    assert origins is not None
    for corners, weights, places in (
        (origins.vertex_corners, origins.vertex_weights, told.positions),
        (origins.corner_corners[0], origins.corner_weights[0], told.positions[told.corner_vert]),
    ):
        assert weights.sum(axis=1) == pytest.approx(1)
        mixed = np.einsum("nkw,nk->nw", mesh[0][mesh[2][corners]], weights)
        assert np.linalg.norm(mixed - places, axis=1).max() < 0.03
    assert origins.faces.shape == told.loop_start.shape
    with pytest.raises(orbflow_native.InputError, match="cut edge 0 names vertex 9999"):
        orbflow_native.remesh(*mesh, cut_edges=[np.array([[9999, 0]], np.int32)])


def test_where_a_mesh_is_made_symmetric_its_positive_side_is_carried_to_both() -> None:
    points, starts, corners = ball()
    points = points * np.where(points[:, :1] < -0.3, 1.15, 1).astype(np.float32)
    ends = np.stack([corners.reshape(-1, 3), np.roll(corners.reshape(-1, 3), 1, 1)], -1)
    sides = np.unique(np.sort(ends.reshape(-1, 2)), axis=0)
    ring = np.ascontiguousarray(sides[(np.abs(points[sides][..., 2]) < 1e-6).all(1)])
    result = orbflow_native.remesh(
        points,
        starts,
        corners,
        faces=500,
        mirror="x",
        score_samples=0,
        marked_edges=ring,
        carried_edges=ring,
    )
    assert result.report["plane"]["was_symmetric"] is False
    middles = result.positions[result.carried_edges].mean(1)[:, 0]
    n_right, n_left = (middles > 1e-3).sum(), (middles < -1e-3).sum()
    assert n_left == n_right > 8
    assert (points[ring[result.carried_from]].mean(1)[:, 0] > -1e-3).all()
