"""What is cut along seams comes over from one side of them, also where seams are split vertices."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from shapes import on_the_ring, split_along
from test_operator import Open, addon, press

# The lower half of the map lies so far aside.
ASIDE = 5.0
RANGE = np.array((ASIDE + 2, 2.0))


def halves() -> Any:  # noqa: ANN401
    """A sphere whose halves are two islands, each as seen from above."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    thing = bpy.context.object
    layer = thing.data.uv_layers[0]
    layer.name = "Map"
    for face in thing.data.polygons:
        for corner in face.loop_indices:
            x, y, _ = thing.data.vertices[thing.data.loops[corner].vertex_index].co
            layer.uv[corner].vector = (x + ASIDE * (face.center.z < 0), y)
    return thing


def split_halves() -> Any:  # noqa: ANN401
    """The same with split vertices along the seam."""
    thing = halves()
    split_along(thing.data, "Map")
    assert len(thing.data.vertices) == 48 * 23 + 2 + 48
    return thing


def numbers(mesh: Any, name: str, field: str, width: int) -> np.ndarray:  # noqa: ANN401
    attribute = mesh.attributes[name]
    values = np.empty(width * len(attribute.data), np.float32)
    attribute.data.foreach_get(field, values)
    return values.reshape(-1, width)


def quads(mesh: Any, name: str = "Map") -> tuple[np.ndarray, np.ndarray]:  # noqa: ANN401
    """Places and texture coordinates of the corners of every quad."""
    points = np.array([vertex.co for vertex in mesh.vertices])
    corners = np.array([corner.vertex_index for corner in mesh.loops])
    return points[corners].reshape(-1, 4, 3), numbers(mesh, name, "vector", 2).reshape(-1, 4, 2)


def area(corners: np.ndarray) -> np.ndarray:
    one, other = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    if corners.shape[2] == 2:
        return np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2
    return np.linalg.norm(np.cross(one, other), axis=1) / 2


def share_off(mesh: Any) -> float:  # noqa: ANN401
    """On which share of the surface the map is off by more than 5 % of its range."""
    steps = (np.arange(8) + 0.5) / 8
    u, v = (each.ravel() for each in np.meshgrid(steps, steps))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    places, coordinates = (np.einsum("sk,fkw->fsw", weights, each) for each in quads(mesh))
    wanted = places[..., :2] + np.stack([ASIDE * (places[..., 2] < 0), 0 * places[..., 0]], -1)
    is_off = (np.abs(coordinates - wanted) > 0.05 * RANGE).any(axis=2).mean(axis=1)
    sizes = area(quads(mesh)[0])
    return float((is_off * sizes).sum() / sizes.sum())


def test_islands_of_split_vertices_are_not_smeared(open_fixture: Open) -> None:
    open_fixture("03")
    mesh = split_halves().data
    press.orbflow_remesh(faces=1000)
    mesh = bpy.context.object.data
    coordinates = quads(mesh)[1]
    assert np.ptp(coordinates[..., 0], axis=1).max() < 1
    assert area(coordinates).sum() == pytest.approx(2 * np.pi, rel=0.03)
    # Quads on the seam have their map from one side of it: they are off at most half a quad deep.
    half = np.sqrt(area(quads(mesh)[0]).mean()) / 2
    assert share_off(mesh) < half * 2 * np.pi / (4 * np.pi)


def test_borders_of_islands_can_be_followed(open_fixture: Open) -> None:
    open_fixture("03")
    split_halves()
    press.orbflow_remesh(faces=600, marked_edges={"UV"})
    mesh = bpy.context.object.data
    assert on_the_ring(mesh)[1] > 0.9 * 2 * np.pi
    assert area(quads(mesh)[1]).sum() == pytest.approx(2 * np.pi, rel=0.03)
    assert share_off(mesh) < 0.002


def test_a_file_that_splits_seams_comes_back_with_its_map(
    open_fixture: Open, tmp_path: Path
) -> None:
    open_fixture("03")
    halves()
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.object.select_set(True)
    path = str(tmp_path / "halves.glb")
    bpy.ops.export_scene.gltf(filepath=path, use_selection=True)
    bpy.ops.import_scene.gltf(filepath=path)
    thing = bpy.context.object
    (layer,) = thing.data.uv_layers
    layer.name = "Map"
    assert len(thing.data.vertices) > 48 * 23 + 2
    press.orbflow_remesh(faces=600)
    coordinates = quads(thing.data)[1]
    assert np.ptp(coordinates[..., 0], axis=1).max() < 1
    # The file has triangles, whose map is that of the sphere all the same.
    assert area(coordinates).sum() == pytest.approx(2 * np.pi, rel=0.04)


def pairs_of(mesh: Any, ends: np.ndarray, like: Any) -> set[frozenset[int]]:  # noqa: ANN401
    """Pairs of vertices by the nearest vertices of another mesh."""
    points, others = (np.array([vertex.co for vertex in each.vertices]) for each in (mesh, like))
    away = np.linalg.norm(points[np.unique(ends)][:, None] - others, axis=2)
    nearest = dict(zip(np.unique(ends).tolist(), away.argmin(axis=1).tolist(), strict=True))
    return {frozenset(nearest[vertex] for vertex in pair) for pair in ends.tolist()}


def test_a_split_seam_is_cut_where_a_whole_one_is(open_fixture: Open) -> None:
    open_fixture("03")
    whole, split = halves().data, split_halves().data
    read = addon("artist.elements").read
    (ends,), (others,) = read(whole).cuts, read(split).cuts
    assert len(ends) == len(others) == 48
    wanted = pairs_of(whole, ends, whole)
    assert pairs_of(split, others, whole) == wanted
    # One of the two borders a little off, as after rounding: the core welds them all the same.
    for vertex in split.vertices:
        vertex.co *= 1 + 1e-6 * (vertex.index % 2)
    (others,) = read(split).cuts
    assert pairs_of(split, others, whole) == wanted


def test_what_is_painted_face_by_face_does_not_cut_the_map(open_fixture: Open) -> None:
    open_fixture("03")
    thing = halves()
    mesh = thing.data
    paint = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    tones = np.arange(len(mesh.polygons)) % 7 / 7
    for face in mesh.polygons:
        for corner in face.loop_indices:
            paint.data[corner].color = (tones[face.index], 0, 0, 1)
    press.orbflow_remesh(faces=600)
    mesh = thing.data
    # A face has one of the colors; faces are larger than those that were painted.
    found = numbers(mesh, "Paint", "color", 4).reshape(-1, 4, 4)[..., 0]
    assert np.ptp(found, axis=1).max() < 1e-6
    assert np.abs(found[:, :1] - tones[:7]).min(axis=1).max() < 1e-6
    assert area(quads(mesh)[1]).sum() == pytest.approx(2 * np.pi, rel=0.04)


def test_the_grain_of_paint_cuts_nothing(open_fixture: Open) -> None:
    open_fixture("03")
    mesh = halves().data
    paint = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    colors = np.random.default_rng(1).uniform(0.5, 0.52, (len(mesh.loops), 4))
    colors[:500, 0] = 0
    colors[-500:, 0] = 1
    paint.data.foreach_set("color", colors.astype(np.float32).ravel())
    elements = addon("artist.elements").read(mesh)
    # Blender versions keep their layers in other orders.
    n_cuts = {
        layer.name: len(elements.cuts[number])
        for layer, number in zip(elements.layers["CORNER"], elements.cut_by, strict=True)
    }
    assert n_cuts["Map"] == 48
    # Two borders of the white and the black paint, but not between all faces.
    assert 48 < n_cuts["Paint"] < 0.25 * len(mesh.edges)


def test_vertices_take_values_from_one_side_of_a_split_seam(open_fixture: Open) -> None:
    open_fixture("03")
    thing = split_halves()
    mesh = thing.data
    upper = np.zeros(len(mesh.vertices), np.float32)
    for face in mesh.polygons:
        upper[list(face.vertices)] = face.center.z > 0
    mesh.attributes.new("Upper", "FLOAT", "POINT").data.foreach_set("value", upper)
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    found = numbers(mesh, "Upper", "value", 1)[:, 0]
    heights = np.array([vertex.co.z for vertex in mesh.vertices])
    assert (np.minimum(np.abs(found), np.abs(found - 1)) < 1e-6).all()
    assert ((found > 0.5) == (heights > 0))[np.abs(heights) > 0.02].all()


def test_where_custom_normals_break_edges_are_sharp(open_fixture: Open) -> None:
    open_fixture("03")
    thing = split_halves()
    mesh = thing.data
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    normals = np.empty((len(mesh.loops), 3))
    for face in mesh.polygons:
        for corner in face.loop_indices:
            place = mesh.vertices[mesh.loops[corner].vertex_index].co
            normals[corner] = place + type(place)((0, 0, np.copysign(0.5, face.center.z)))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mesh.normals_split_custom_set(normals.tolist())
    assert not any(edge.use_edge_sharp for edge in mesh.edges)
    press.orbflow_remesh(faces=400, marked_edges={"UV"})
    mesh = thing.data
    is_sharp = np.array([edge.use_edge_sharp for edge in mesh.edges])
    is_on_ring = on_the_ring(mesh)[0]
    assert (is_sharp != is_on_ring).sum() < 0.1 * is_on_ring.sum()
    report = addon("runs").last_report(thing.name)
    # The seam has two edges at every place, of which one is carried: none is lost.
    assert report["carried"]["length_pct"] == pytest.approx(100, abs=2)


def bound(n_bones: int) -> Any:  # noqa: ANN401
    """A sphere of which every vertex is moved by two bones, and a mask."""
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    for i in range(n_bones):
        bone = rig.data.edit_bones.new(f"Bone{i}")
        bone.head, bone.tail = (0, 0, i), (0, 0, i + 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    thing = bpy.context.object
    thing.modifiers.new("Rig", "ARMATURE").object = rig
    for name in [*(f"Bone{i}" for i in range(n_bones)), "Mask"]:
        thing.vertex_groups.new(name=name)
    for vertex in thing.data.vertices:
        first = vertex.index % n_bones
        second = (first + 1 + vertex.index // n_bones % (n_bones - 1)) % n_bones
        thing.vertex_groups[first].add([vertex.index], 0.7, "REPLACE")
        thing.vertex_groups[second].add([vertex.index], 0.3, "REPLACE")
        thing.vertex_groups["Mask"].add([vertex.index], 0.5, "REPLACE")
    return thing


def test_a_vertex_has_no_more_weights_of_bones_than_one_had(open_fixture: Open) -> None:
    open_fixture("03")
    thing = bound(9)
    press.orbflow_remesh(faces=300)
    for vertex in thing.data.vertices:
        weights = {thing.vertex_groups[each.group].name: each.weight for each in vertex.groups}
        assert weights.pop("Mask") == pytest.approx(0.5, abs=1e-4)
        assert len(weights) <= 2
        assert sum(weights.values()) == pytest.approx(1, abs=1e-4)


def test_as_few_weights_of_bones_stay_as_an_engine_takes(open_fixture: Open) -> None:
    open_fixture("03")
    thing = bound(9)
    press.orbflow_remesh(faces=300, weights_limit=1)
    for vertex in thing.data.vertices:
        weights = {thing.vertex_groups[each.group].name: each.weight for each in vertex.groups}
        assert weights.pop("Mask") == pytest.approx(0.5, abs=1e-4)
        assert list(weights.values()) == pytest.approx([1], abs=1e-4)


def test_the_largest_weights_of_bones_stay_and_keep_their_sum(open_fixture: Open) -> None:
    open_fixture("03")
    thing = bound(4)
    groups = addon("artist.groups")
    read = groups.read(thing)
    assert [each.is_deforming for each in read] == [True] * 4 + [False]
    assert groups.most(read) == 2
    columns = [[0.4, 0.0], [0.2, 5e-5], [0.1, 0.5], [0.3, 0.25], [0.9, 0.0]]
    given = [
        groups.replace(each, weights=np.array(values, np.float32))
        for each, values in zip(read, columns, strict=True)
    ]
    found = np.array([each.weights for each in groups.limited(given, 2)])
    assert found[:, 0] == pytest.approx([0.4 / 0.7, 0, 0, 0.3 / 0.7, 0.9])
    assert found[:, 1] == pytest.approx([0, 0, 0.5, 0.25, 0], abs=1e-4)
    assert found[1, 1] == 0
    thing.modifiers.clear()
    assert not any(each.is_deforming for each in groups.read(thing))
