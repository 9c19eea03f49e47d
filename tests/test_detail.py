"""What a result has lost of its original's relief can be put on it again."""

import re
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from sidebar import drawn
from test_operator import Open, addon, arrays, press


def bumps(directions: np.ndarray) -> np.ndarray:
    """The radius of a ball with small bumps."""
    return 1 + 0.03 * np.sin(16 * directions).prod(axis=1)


def bumpy(open_fixture: Open, **settings: Any) -> Any:  # noqa: ANN401
    """A ball with small bumps and a UV map, remeshed without them."""
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    thing = bpy.context.object
    places = addon("attributes").positions(thing.data)
    places *= bumps(places)[:, None]
    thing.data.attributes["position"].data.foreach_set("vector", places.ravel())
    thing.data.shade_smooth()
    wanted = {"faces": 300, "primitive": "QUAD_SPHERE", "keep_original": True}
    press.orbflow_remesh(**(wanted | settings))
    return thing


def counts() -> dict[str, int]:
    """How much there is of what a bake must not leave behind."""
    kinds = ("objects", "meshes", "scenes", "materials", "images", "collections")
    return {kind: len(getattr(bpy.data, kind)) for kind in kinds}


def seen(thing: Any) -> np.ndarray:  # noqa: ANN401
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return addon("attributes").positions(mesh)


def heights(places: np.ndarray) -> np.ndarray:
    """How far places are above the ball with its bumps."""
    length = np.linalg.norm(places, axis=1)
    return length - bumps(places / length[:, None])


def test_detail_is_on_as_many_levels_as_it_takes(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    thing = bumpy(open_fixture)
    thing.location, thing.orbflow_original.rotation_euler = (5, 0, 0), (1, 2, 3)
    before, base = counts(), arrays(thing)
    assert press.orbflow_bake_detail() == {"FINISHED"}
    assert counts() == before
    assert arrays(thing) == base
    (modifier,) = thing.modifiers
    assert (modifier.type, modifier.levels) == ("MULTIRES", modifier.total_levels)
    assert modifier.total_levels >= 2
    made = seen(thing)
    assert len(made) > 3000
    assert np.abs(heights(made)).mean() < 0.003
    told = capfd.readouterr().out
    assert f"{modifier.total_levels} levels of Multires, {6 * 49 * 16:,} faces" in told
    first, last = re.findall(r"([\d.]+) % of size \(at most", told)
    assert float(last) < float(first) / 3
    assert press.orbflow_bake_detail(levels=1) == {"FINISHED"}
    assert [each.total_levels for each in thing.modifiers] == [1]


def test_sharp_edges_stay_sharp_under_detail(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_cube_add(size=2)
    thing = bpy.context.object
    press.orbflow_remesh(faces=54, keep_original=True)
    press.orbflow_bake_detail(levels=2)
    made = seen(thing)
    assert len(made) > 500
    assert np.abs(made).max(axis=1) == pytest.approx(1, abs=1e-4)


def test_detail_can_follow_the_original(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    press.orbflow_bake_detail(method="SHRINKWRAP", levels=2)
    assert [each.type for each in thing.modifiers] == ["SUBSURF", "SHRINKWRAP"]
    assert thing.modifiers[1].target == thing.orbflow_original
    assert np.abs(heights(seen(thing))).mean() < 0.004
    press.orbflow_bake_detail(levels=1)
    assert [each.type for each in thing.modifiers] == ["MULTIRES"]


def test_where_blender_makes_no_multires_it_is_said(
    open_fixture: Open, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    thing = bumpy(open_fixture)
    before = counts()

    def fails(*_given: object) -> None:
        raise RuntimeError("no Multires")

    monkeypatch.setattr(addon("details"), "_one_more_level", fails)
    assert press.orbflow_bake_detail(levels=1) == {"FINISHED"}
    assert [each.type for each in thing.modifiers] == ["SUBSURF", "SHRINKWRAP"]
    assert counts() == before
    assert "Warning" in (told := capfd.readouterr().out)
    assert "Blender makes no Multires here" in told


def test_detail_goes_below_what_poses_the_result(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    for each in (thing, thing.orbflow_original):
        each.modifiers.new("Bend", "SIMPLE_DEFORM").angle = 2
    press.orbflow_bake_detail(levels=1)
    assert [each.name for each in thing.modifiers] == ["Orbflow Detail", "Bend"]
    thing.modifiers["Bend"].show_viewport = False
    assert np.abs(heights(seen(thing))).mean() < 0.006


def test_detail_is_that_of_the_first_key_and_keys_move_it(open_fixture: Open) -> None:
    open_fixture("03")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    thing = bpy.context.object
    thing.shape_key_add(name="Basis")
    tall = thing.shape_key_add(name="Tall")
    for each in tall.data:
        each.co.z *= 2
    tall.value = 1
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE", keep_original=True)
    press.orbflow_bake_detail(levels=2)
    assert thing.data.shape_keys.key_blocks["Tall"].value == 1
    assert seen(thing)[:, 2].max() == pytest.approx(2, abs=0.05)
    thing.data.shape_keys.key_blocks["Tall"].value = 0
    bpy.context.view_layer.update()
    lengths = np.linalg.norm(seen(thing), axis=1)
    assert (lengths.min(), lengths.max()) == pytest.approx((1, 1), abs=0.01)


def test_half_of_a_mesh_has_its_detail_before_it_is_made_whole(open_fixture: Open) -> None:
    open_fixture("05")
    thing = bpy.context.object
    thing.modifiers.new("Mirror", "MIRROR").use_axis = (False, False, True)
    press.orbflow_remesh(faces=200, mirror_modifier="HALF", keep_original=True)
    assert [each.name for each in thing.modifiers] == ["Mirror"]
    press.orbflow_bake_detail(levels=1)
    assert [each.name for each in thing.modifiers] == ["Orbflow Detail", "Mirror"]
    whole = seen(thing)[:, 2]
    assert whole.min() == pytest.approx(-whole.max(), abs=1e-5)


def test_without_its_original_an_object_is_refused(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    original = thing.orbflow_original
    bpy.data.objects[original.name].hide_set(False)
    with bpy.context.temp_override(selected_objects=[original]):
        bpy.ops.object.delete()
    for operator in (press.orbflow_bake_detail, press.orbflow_bake_normal_map):
        with pytest.raises(RuntimeError, match="the original of Sphere is gone"):
            operator()
    thing.orbflow_original = None
    with pytest.raises(RuntimeError, match="tick Original before"):
        press.orbflow_bake_detail()


def test_another_shape_or_sculpt_is_refused(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    before = arrays(thing)
    sculpt = thing.modifiers.new("Mine", "MULTIRES")
    with pytest.raises(RuntimeError, match="apply or remove modifier Mine"):
        press.orbflow_bake_detail()
    thing.modifiers.remove(sculpt)
    thing.orbflow_original.data.transform(Matrix.Translation((4, 0, 0)))
    with pytest.raises(RuntimeError, match="are they still one shape"):
        press.orbflow_bake_detail()
    assert arrays(thing) == before
    assert not thing.modifiers


def test_a_normal_map_has_the_bumps(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    scene, before = bpy.context.scene, counts()
    engine = scene.render.engine
    assert press.orbflow_bake_normal_map(image_size=128) == {"FINISHED"}
    assert counts() == before | {"materials": before["materials"] + 1, "images": 1}
    assert scene.render.engine == engine
    (image,) = bpy.data.images
    assert tuple(image.size) == (128, 128)
    assert image.packed_file.size > 1000
    assert image.colorspace_settings.name == "Non-Color"
    normals = 2 * np.array(image.pixels[:]).reshape(-1, 4)[:, :3] - 1
    assert np.linalg.norm(normals, axis=1).mean() == pytest.approx(1, abs=0.02)
    tilt = np.degrees(np.arccos(normals[:, 2].clip(-1, 1)))
    # Bumps of 3 % and this width rise by 25 degrees at most; the faces bend by less than 10.
    assert 10 < np.percentile(tilt, 90) < 45
    assert image_of(thing.data.materials[0]) == image


def image_of(material: Any) -> Any:  # noqa: ANN401
    """The image behind the normals of a material's shader."""
    (shader,) = [each for each in material.node_tree.nodes if each.type == "BSDF_PRINCIPLED"]
    normal = shader.inputs["Normal"].links[0].from_node
    return normal.inputs["Color"].links[0].from_node.image


def test_a_second_bake_replaces_the_first_in_the_objects_own_materials(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    shared = addon("bake")._new_material("Skin")
    for each in (thing, thing.orbflow_original):
        each.data.materials.append(shared)
    for size in (32, 64):
        press.orbflow_bake_normal_map(image_size=size)
    (image,) = bpy.data.images
    assert (image.name, image.size[0]) == ("Sphere Normal", 64)
    own = thing.data.materials[0]
    assert own != shared
    assert image_of(own) == image
    assert not [each for each in shared.node_tree.nodes if each.type == "TEX_IMAGE"]


def test_without_a_uv_map_there_is_no_normal_map(open_fixture: Open) -> None:
    thing = bumpy(open_fixture)
    before = counts()
    thing.data.uv_layers[0].name = "Flat"
    thing.data.attributes["Flat"].data.foreach_set("vector", [0.5] * 2 * len(thing.data.loops))
    with pytest.raises(RuntimeError, match="UV map Flat of Sphere has no area"):
        press.orbflow_bake_normal_map(image_size=64)
    thing.data.uv_layers.remove(thing.data.uv_layers[0])
    with pytest.raises(RuntimeError, match="Sphere has no UV map to bake to"):
        press.orbflow_bake_normal_map(image_size=64)
    assert counts() == before


def test_the_panel_has_both_and_the_original(open_fixture: Open) -> None:
    names = [name for name, _ in drawn(bumpy(open_fixture))]
    at = names.index("orbflow_Detail")
    assert names[at + 1 : at + 5] == [
        "NONE Detail",
        "orbflow_original",
        "MOD_MULTIRES object.orbflow_bake_detail",
        "IMAGE_DATA object.orbflow_bake_normal_map",
    ]
