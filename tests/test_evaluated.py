"""What modifiers make carries the artist's data, or it is said what is lost."""

import bpy
import numpy as np
import pytest
from test_modifiers import (
    _nothing_is_left,  # noqa: F401 - holds for every test here too
    cube,
    keyed,
    places,
    seen,
    stack,
    told,
)
from test_operator import Open, press, select


def test_shape_keys_go_through_a_subdivision(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    keyed(thing)
    thing.modifiers.new("Subdivision", "SUBSURF").levels = 2
    heights = {}
    for value in (0, 1):
        thing.data.shape_keys.key_blocks["Lift"].value = value
        heights[value] = seen(thing)[:, 2].max()
    press.orbflow_remesh(faces=400)
    assert stack(thing) == []
    keys = thing.data.shape_keys
    assert [key.name for key in keys.key_blocks] == ["Basis", "Lift", "More"]
    assert keys.key_blocks["More"].relative_key.name == "Lift"
    assert keys.key_blocks["Lift"].vertex_group == "Half"
    assert len(keys.animation_data.drivers) == 1
    assert told(thing)["lost"] == []
    for value in (0, 1):
        keys.key_blocks["Lift"].value = value
        assert seen(thing)[:, 2].max() == pytest.approx(heights[value], abs=0.03)
    assert heights[1] > heights[0] + 0.1


def test_where_no_key_keeps_its_faces_the_mix_that_is_seen_is_taken(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    keyed(thing)
    thing.modifiers.new("Remesh", "REMESH").voxel_size = 0.2
    high = seen(thing)[:, 2].max()
    press.orbflow_remesh(faces=200)
    assert thing.data.shape_keys is None
    lost = ["attribute UVMap", "shape key Lift", "shape key More", "vertex groups"]
    assert sorted(told(thing)["lost"]) == lost
    assert places(thing.data)[:, 2].max() == pytest.approx(high, abs=0.1)
    assert high > 1.1


def test_a_key_that_makes_other_faces_is_lost_and_named_alone(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    for name in ("Basis", "Flat", "Low", "Lift"):
        thing.shape_key_add(name=name)
    blocks = thing.data.shape_keys.key_blocks
    for flat, lift in zip(blocks["Flat"].data, blocks["Lift"].data, strict=True):
        flat.co.z = 0
        lift.co.z *= 2
    blocks["Low"].relative_key = blocks["Flat"]
    blocks["Flat"].driver_add("value").driver.expression = "0.5"
    thing.modifiers.new("Weld", "WELD")
    press.orbflow_remesh(faces=96)
    keys = thing.data.shape_keys
    assert [key.name for key in keys.key_blocks] == ["Basis", "Lift"]
    assert not keys.animation_data.drivers
    assert told(thing)["lost"] == ["shape key Flat", "shape key Low"]
    lifted = [point.co.z for point in keys.key_blocks["Lift"].data]
    assert lifted == pytest.approx(list(2 * places(thing.data)[:, 2]), abs=0.06)


def test_what_modifiers_bring_of_the_artists_comes_over(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    colours = thing.data.attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for vertex, colour in zip(thing.data.vertices, colours.data, strict=True):
        colour.color = (vertex.co.x > 0, 0, 0, 1)
    ring = [edge for edge in thing.data.edges if all(v < 4 for v in edge.vertices)]
    for edge in thing.data.edges:
        edge.use_seam = edge in ring
    for name in ("Arm.L", "Arm.R"):
        thing.vertex_groups.new(name=name)
    thing.vertex_groups["Arm.L"].add(range(8), 0.5, "REPLACE")
    thing.vertex_groups["Arm.R"].lock_weight = True
    thing.vertex_groups.active_index = 1
    materials = [bpy.data.materials.new(name) for name in ("Skin", "Rim")]
    for material in materials:
        thing.data.materials.append(material)
    thing.modifiers.new("Grid", "SUBSURF").subdivision_type = "SIMPLE"
    solid = thing.modifiers.new("Shell", "SOLIDIFY")
    solid.offset, solid.material_offset, solid.thickness = 1, 1, 0.25
    press.orbflow_remesh(faces=250, marked_edges={"SEAM"}, density="Arm.L")
    groups = [(group.name, group.lock_weight) for group in thing.vertex_groups]
    assert groups == [("Arm.L", False), ("Arm.R", True)]
    assert thing.vertex_groups.active_index == 1
    weights = [each.weight for vertex in thing.data.vertices for each in vertex.groups]
    assert weights == pytest.approx([0.5] * len(thing.data.vertices), abs=1e-3)
    assert list(thing.data.materials) == materials
    assert {face.material_index for face in thing.data.polygons} == {0, 1}
    assert thing.data.uv_layers[0].name == "UVMap"
    red = [each.color[0] for each in thing.data.attributes["Paint"].data]
    assert red == pytest.approx(list((places(thing.data)[:, 0].clip(-1, 1) + 1) / 2), abs=0.1)
    assert sum(edge.use_seam for edge in thing.data.edges) >= 8


def test_a_boolean_brings_its_material_and_leaves_the_stack(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    own, other = (bpy.data.materials.new(name) for name in ("Own", "Other"))
    thing.data.materials.append(own)
    bpy.ops.mesh.primitive_uv_sphere_add(location=(1, 0, 3), radius=0.8)
    ball = bpy.context.object
    ball.data.materials.append(other)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    thing.parent, parent.location, parent.scale = parent, (1, 0, 2), (1, 2, 1)
    bite = thing.modifiers.new("Bite", "BOOLEAN")
    bite.object, bite.material_mode = ball, "TRANSFER"
    bite.driver_add("show_viewport").driver.expression = "1"
    ball.hide_set(True)
    select(thing)
    press.orbflow_remesh(faces=300)
    assert stack(thing) == []
    assert not thing.animation_data.drivers
    assert list(thing.data.materials) == [own, other]
    carved = [face.center for face in thing.data.polygons if face.material_index == 1]
    assert len(carved) > 10
    middle = thing.matrix_world.inverted() @ ball.location
    assert max((place - middle).length for place in carved) < 1


def test_what_is_simulated_stays_and_what_was_baked_is_named(open_fixture: Open) -> None:
    thing = cube(open_fixture)
    cloth = thing.modifiers.new("Cloth", "CLOTH")
    thing.modifiers.new("Hair", "PARTICLE_SYSTEM")
    thing.modifiers.new("Subdivision", "SUBSURF").levels = 2
    thing.modifiers.new("Collision", "COLLISION")
    cloth.point_cache.frame_end = 2
    with bpy.context.temp_override(point_cache=cloth.point_cache):
        bpy.ops.ptcache.bake(bake=True)
    press.orbflow_remesh(faces=96)
    assert stack(thing) == ["Cloth", "Hair", "Collision"]
    assert len(thing.particle_systems) == len(bpy.data.particles) == 1
    assert told(thing)["lost"] == ["bake of modifier Cloth"]


def test_a_sculpt_that_is_shown_goes_in_and_what_is_not_shown_is_named(
    open_fixture: Open,
) -> None:
    thing = cube(open_fixture)
    detail = thing.modifiers.new("Detail", "MULTIRES")
    for _ in range(3):
        bpy.ops.object.multires_subdivide(modifier="Detail")
    detail.levels = 0
    with pytest.raises(RuntimeError, match="modifier Detail first: it holds a sculpt"):
        press.orbflow_remesh(faces=96)
    detail.levels = 2
    press.orbflow_remesh(faces=96)
    assert stack(thing) == []
    assert np.abs(places(thing.data)).max() < 0.9
    assert told(thing)["lost"] == ["level 3 of modifier Detail"]
