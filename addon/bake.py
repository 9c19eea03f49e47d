# SPDX-License-Identifier: GPL-3.0-or-later
"""The relief of an original as a normal map of its result, baked by Cycles.

It is baked in a scene of its own, from and to copies: neither the settings of the artist's scene
nor what is selected or hidden there matters, and none of it is touched.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from . import attributes, details, originals
from .translations import rpt_

#: What the nodes are called that a baked map is read by.
NODE = "Orbflow Normal Map"
# The property of an image that was baked here: the next bake replaces it.
_MARK = "orbflow"
# How far rays start beyond the largest distance between the two surfaces, and at least, as a share
# of the size: nearer, rays would miss what lies on the surface itself.
_BEYOND, _LEAST = 1.2, 1e-3
# An island is continued over so many pixels per thousand of the image, for smaller mipmaps.
_MARGIN = 8 / 1024


class Refused(Exception):
    """An object cannot be given a normal map."""


def bake(context: bpy.types.Context, thing: bpy.types.Object, size: int) -> bpy.types.Image:
    """Bakes a normal map of `size` × `size` pixels for the active UV map of an object.

    The image is packed into the file. Raises `Refused`, `originals.Gone`, `modifiers.Refused`.
    """
    layer = thing.data.uv_layers.active
    if layer is None:
        raise Refused(rpt_("{} has no UV map to bake to").format(thing.name))
    if not _has_area(thing.data, layer.name):
        told = rpt_("UV map {} of {} has no area: unwrap it first")
        raise Refused(told.format(layer.name, thing.name))
    if "cycles" not in context.preferences.addons:
        raise Refused(rpt_("Cycles, which bakes, is switched off in the preferences"))
    with originals.as_remeshed(context, thing) as original:
        apart = details.distance(thing, original, thing.data)
        image = _new_image(thing, size)
        try:
            with _stage(context, thing, original, image) as stage:
                _bake(context, stage, _reach(thing, apart.most_pct), layer.name)
        except RuntimeError as error:
            bpy.data.images.remove(image)
            raise Refused(str(error).strip()) from error
    image.pack()
    return _in_place(image, thing)


def put_into_materials(thing: bpy.types.Object, image: bpy.types.Image) -> int:
    """Has the materials of an object read a normal map; in how many.

    Materials that others use too become the object's own: the original looks as before.
    """
    materials = thing.data.materials
    if not any(materials):
        materials.append(_new_material(thing.name))
    n_done = 0
    for i, material in enumerate(materials):
        if material is None:
            continue
        if material.users > 1 or material.library is not None:
            materials[i] = material = material.copy()
        n_done += _wire(material, image, thing.data.uv_layers.active.name)
    return n_done


def _has_area(mesh: bpy.types.Mesh, name: str) -> bool:
    places = np.empty((len(mesh.loops), 2), np.float32)
    mesh.attributes[name].data.foreach_get("vector", places.ravel())
    ahead = attributes.corners_ahead(attributes.loop_starts(mesh), len(places))
    (x, y), (x_ahead, y_ahead) = places.T, places[ahead].T
    crossed = np.add.reduceat(x * y_ahead - x_ahead * y, attributes.loop_starts(mesh))
    return bool(np.abs(crossed).sum() > 1e-9)


def _new_image(thing: bpy.types.Object, size: int) -> bpy.types.Image:
    image = bpy.data.images.new(
        f"{thing.name} Normal", size, size, alpha=False, float_buffer=False, is_data=True
    )
    image[_MARK] = thing.name
    return image


def _in_place(image: bpy.types.Image, thing: bpy.types.Object) -> bpy.types.Image:
    """Has an image take the place of the one that was baked for an object before."""
    for old in [each for each in bpy.data.images if each.get(_MARK) == thing.name]:
        if old != image and not old.library:
            name = old.name
            old.user_remap(image)
            bpy.data.images.remove(old)
            image.name = name
    return image


def _reach(thing: bpy.types.Object, most_pct: float) -> float:
    """How far from the result rays start: beyond all of the original, but not past a face.

    A limb that the result lacks would have them start inside others.
    """
    scale = np.array(thing.matrix_world.to_scale(), np.float32)
    places = attributes.positions(thing.data) * scale
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    ends = places[attributes.edge_verts(thing.data)]
    edge = float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean())
    return max(min(_BEYOND * most_pct / 100 * size, edge), _LEAST * size)


@dataclass(frozen=True)
class _Stage:
    """A scene with a copy of a result, which is baked to, and of its original."""

    scene: bpy.types.Scene
    low: bpy.types.Object
    high: bpy.types.Object


@contextmanager
def _stage(
    context: bpy.types.Context,
    thing: bpy.types.Object,
    original: bpy.types.Mesh,
    image: bpy.types.Image,
) -> Iterator[_Stage]:
    scene = bpy.data.scenes.new("Orbflow Bake")
    material = _new_material("Orbflow Bake")
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    meshes = [thing.data.copy(), original.copy()]
    stage = _Stage(scene, *(bpy.data.objects.new("Orbflow Bake", mesh) for mesh in meshes))
    for each in (stage.low, stage.high):
        each.data.transform(Matrix.Diagonal([*map(abs, thing.matrix_world.to_scale()), 1]))
        # Keys that are not at rest would move the copies.
        each.show_only_shape_key, each.active_shape_key_index = True, 0
        scene.collection.objects.link(each)
    meshes[0].materials.clear()
    meshes[0].materials.append(material)
    try:
        yield stage
    finally:
        for each in (stage.low, stage.high):
            bpy.data.objects.remove(each)
        for mesh in meshes:
            bpy.data.meshes.remove(mesh)
        bpy.data.scenes.remove(scene)
        bpy.data.materials.remove(material)
        context.view_layer.update()


def _bake(context: bpy.types.Context, stage: _Stage, reach: float, uv_map: str) -> None:
    scene, low, high = stage.scene, stage.low, stage.high
    view_layer = scene.view_layers[0]
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    image = low.data.materials[0].node_tree.nodes.active.image
    for each in (low, high):
        each.select_set(True, view_layer=view_layer)
    view_layer.objects.active = low
    view_layer.update()
    with context.temp_override(
        scene=scene,
        view_layer=view_layer,
        object=low,
        active_object=low,
        selected_objects=[low, high],
    ):
        ended = bpy.ops.object.bake(
            type="NORMAL",
            normal_space="TANGENT",
            use_selected_to_active=True,
            cage_extrusion=reach,
            max_ray_distance=2 * reach,
            margin=max(2, round(_MARGIN * image.size[0])),
            uv_layer=uv_map,
            use_clear=True,
            target="IMAGE_TEXTURES",
            save_mode="INTERNAL",
        )
    if ended != {"FINISHED"}:
        raise RuntimeError("Cycles has baked nothing")


def _new_material(name: str) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    # From Blender 5 on every material has nodes.
    if material.node_tree is None:
        material.use_nodes = True
    return material


def _wire(material: bpy.types.Material, image: bpy.types.Image, uv_map: str) -> bool:
    """Has the shaders of a material read a normal map; whether it has any that can."""
    if material.node_tree is None:
        return False
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shaders = [each for each in nodes if each.type == "BSDF_PRINCIPLED"]
    normal = nodes.get(NODE) or _normal_node(nodes, links)
    normal.uv_map = uv_map
    texture = normal.inputs["Color"].links[0].from_node
    texture.image = image
    texture.inputs["Vector"].links[0].from_node.uv_map = uv_map
    for shader in shaders:
        links.new(normal.outputs["Normal"], shader.inputs["Normal"])
    return bool(shaders)


def _normal_node(nodes: bpy.types.Nodes, links: bpy.types.NodeLinks) -> bpy.types.Node:
    normal, texture, place = (
        nodes.new(f"ShaderNode{kind}") for kind in ("NormalMap", "TexImage", "UVMap")
    )
    for i, node in enumerate((normal, texture, place)):
        node.location = (-250 - 300 * i, -400)
    normal.name = normal.label = NODE
    links.new(place.outputs["UV"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], normal.inputs["Color"])
    return normal
