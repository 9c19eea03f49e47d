"""Borders between materials and between face sets are lines that edges of the result lie on."""

from typing import Any

import bpy
import numpy as np
import pytest
from shapes import on_the_ring, split_along
from test_operator import Open, addon, press, select

FACE_SETS = ".sculpt_face_set"


def two_sided(kind: str) -> Any:  # noqa: ANN401
    """An even ball of two materials or two face sets that meet at z = 0."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    thing = bpy.context.object
    is_top = np.array([face.center.z > 0 for face in thing.data.polygons])
    name = "material_index" if kind == "MATERIAL" else FACE_SETS
    mesh = thing.data
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "INT", "FACE")
    attribute.data.foreach_set("value", np.where(is_top, 1, 2).astype(np.int32))
    for name in ("Zero", "One", "Two"):
        mesh.materials.append(bpy.data.materials.new(name))
    return thing


@pytest.mark.parametrize("kind", ["MATERIAL", "FACE_SETS"])
def test_edges_lie_on_borders_where_they_are_asked_for(open_fixture: Open, kind: str) -> None:
    open_fixture("01")
    thing = two_sided(kind)
    plain = thing.copy()
    plain.data = thing.data.copy()
    press.orbflow_remesh(faces=400, marked_edges={kind})
    assert on_the_ring(thing.data)[1] > 0.95 * 2 * np.pi
    bpy.context.scene.collection.objects.link(plain)
    select(plain)
    press.orbflow_remesh(faces=400)
    assert on_the_ring(plain.data)[1] < 0.5 * 2 * np.pi


def test_face_sets_come_over(open_fixture: Open) -> None:
    open_fixture("01")
    thing = two_sided("FACE_SETS")
    press.orbflow_remesh(faces=400, marked_edges={"FACE_SETS"})
    sets = addon("attributes").values(thing.data, FACE_SETS, "FACE", "INT")
    tops = [face.center.z > 0 for face in thing.data.polygons]
    assert sets.tolist() == [1 if top else 2 for top in tops]


def test_a_border_on_split_vertices_is_found_by_either_side(open_fixture: Open) -> None:
    open_fixture("01")
    thing = two_sided("MATERIAL")
    read = addon("mesh_arrays").read
    assert len(read(thing.data, {"MATERIAL"}).marked_edges) == 40
    assert read(thing.data, {"FACE_SETS"}).marked_edges is None
    sides = thing.data.attributes.new("Side", "FLOAT2", "CORNER")
    for face in thing.data.polygons:
        for i in face.loop_indices:
            sides.data[i].vector = (face.center.z > 0, 0)
    numbers = [face.material_index for face in thing.data.polygons]
    split_along(thing.data, "Side")
    for face, number in zip(thing.data.polygons, numbers, strict=True):
        face.material_index = number
    ends = read(thing.data, {"MATERIAL"}).marked_edges
    points = np.array([vertex.co for vertex in thing.data.vertices])
    assert np.abs(points[ends][..., 2]).max() < 1e-6
    middles = {tuple(place) for place in np.round(points[ends].mean(axis=1), 4) + 0.0}
    assert len(middles) == 40


def test_several_marks_are_sent_together_and_each_edge_once(open_fixture: Open) -> None:
    open_fixture("01")
    thing = two_sided("MATERIAL")
    numbers = thing.data.attributes.new(FACE_SETS, "INT", "FACE")
    for face in thing.data.polygons:
        numbers.data[face.index].value = 1 + (face.center.x > 0)
    read = addon("mesh_arrays").read
    ends = read(thing.data, {"MATERIAL", "FACE_SETS"}).marked_edges
    keys = addon("attributes").edge_keys(ends)
    assert len(np.unique(keys)) == len(keys) == 40 + 40
