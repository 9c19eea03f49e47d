"""Files that the program writes, held against Khronos's validator: check.py PROGRAM OUT.

A scene with what glTF can hold of a mesh (two materials, a texture, colors, a skin, a morph
target) is exported by Blender as GLB and as glTF with its files, remeshed by the program, and
validated by validate.mjs: what came in and what came out.
"""

import subprocess
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

HERE = Path(__file__).resolve().parent
FORMATS = {"GLB": "glb", "GLTF_SEPARATE": "gltf"}


def material(name: str, image: bpy.types.Image | None) -> bpy.types.Material:
    """A material of one color, or of an image."""
    made: Any = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.6, 0.2, 0.1, 1)
    if image:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        made.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    return made


def scene() -> None:
    """A ball with all that, bound to an armature of two bones."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball: Any = bpy.context.object
    image: Any = bpy.data.images.new("Grid", 64, 64)
    image.generated_type = "COLOR_GRID"
    for each in (material("Painted", image), material("Plain", None)):
        ball.data.materials.append(each)
    for face in ball.data.polygons:
        face.material_index = int(face.center.x > 0)
    colors = ball.data.color_attributes.new("Color", "FLOAT_COLOR", "POINT")
    shades = np.random.default_rng(1).random(4 * len(ball.data.vertices)).astype(np.float32)
    colors.data.foreach_set("color", shades)
    ball.shape_key_add(name="Basis")
    moved = ball.shape_key_add(name="Flat")
    for point in moved.data:
        point.co.z *= 0.5
    bpy.ops.object.armature_add(enter_editmode=True, location=(0, 0, -1))
    rig: Any = bpy.context.object
    second = rig.data.edit_bones.new("Top")
    second.head, second.tail = (0, 0, 1), (0, 0, 2)
    second.parent = rig.data.edit_bones[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    ball.parent = rig
    ball.modifiers.new("Armature", "ARMATURE").object = rig
    for name, sign in (("Bone", -1), ("Top", 1)):
        group = ball.vertex_groups.new(name=name)
        for vertex in ball.data.vertices:
            group.add([vertex.index], max(0.0, min(1.0, 0.5 + sign * vertex.co.z)), "REPLACE")


def main(program: str, out: Path) -> None:
    """Writes, remeshes and validates; ends with the validator's status."""
    scene()
    files = []
    for kind, ending in FORMATS.items():
        given, low = (out / kind.lower() / f"{name}.{ending}" for name in ("given", "low"))
        given.parent.mkdir(parents=True, exist_ok=True)
        more = {"export_morph": True, "export_skins": True, "export_vertex_color": "ACTIVE"}
        bpy.ops.export_scene.gltf(filepath=str(given), export_format=kind, **more)
        subprocess.run([program, "remesh", given, low, "--faces", "1000"], check=True)
        files += [given, low]
    sys.exit(subprocess.run(["node", HERE / "validate.mjs", *files], check=False).returncode)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
