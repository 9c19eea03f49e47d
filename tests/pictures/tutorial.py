"""Does what docs/tutorial.md says, step by step, and makes its pictures: tutorial.py DATA OUT.

The "scan" is MakeHuman's body (CC0), made as dense and as noisy as a scan is.
"""

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Blender reads this when it is imported: nothing of the user's own settings is touched.
_HOME = tempfile.TemporaryDirectory(prefix="orbflow-tutorial-", ignore_cleanup_errors=True)
os.environ["BLENDER_USER_RESOURCES"] = _HOME.name

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Euler, Vector  # noqa: E402
from stage import Exhibit, picture  # noqa: E402

N_FACES = 3000
# Bones of the left half: name, joint of head, joint of tail, parent.
BONES = (
    ("hips", "pelvis", "spine-3", ""),
    ("spine", "spine-3", "spine-1", "hips"),
    ("chest", "spine-1", "neck", "spine"),
    ("head", "neck", "head-2", "chest"),
    ("upper_arm.L", "l-shoulder", "l-elbow", "chest"),
    ("forearm.L", "l-elbow", "l-hand", "upper_arm.L"),
    ("hand.L", "l-hand", "l-finger-3-4", "forearm.L"),
    ("thigh.L", "l-upper-leg", "l-knee", "hips"),
    ("shin.L", "l-knee", "l-ankle", "thigh.L"),
    ("foot.L", "l-ankle", "l-foot-1", "shin.L"),
)
# A pose that bends elbows and knees: degrees about the axes of the scene.
POSE = {
    "upper_arm.L": (0, 35, 0),
    "forearm.L": (-75, 0, 0),
    "thigh.L": (-65, 0, 0),
    "shin.L": (80, 0, 0),
    "forearm.R": (-40, 0, 0),
}


def install() -> None:
    """Installs the zip that `make zip` built."""
    (path,) = (ROOT / "dist").glob("orbflow-*.zip")
    bpy.ops.extensions.package_install_files(
        filepath=str(path), repo="user_default", enable_on_install=True
    )


def scan(path: Path) -> bpy.types.Object:
    """The body as a scan has it: 107,024 triangles and a little noise."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="bl_ext.user_default.orbflow")
    bpy.ops.wm.obj_import(filepath=str(path), global_scale=0.1)
    body = bpy.context.object
    body.name = "Body"
    bpy.ops.object.transform_apply()
    body.modifiers.new("dense", "SUBSURF").levels = 1
    body.modifiers.new("triangles", "TRIANGULATE")
    for name in ("dense", "triangles"):
        bpy.ops.object.modifier_apply(modifier=name)
    places = np.empty(3 * len(body.data.vertices), np.float32)
    body.data.vertices.foreach_get("co", places)
    places += np.random.default_rng(1).normal(0, 3e-4, len(places)).astype(np.float32)
    body.data.vertices.foreach_set("co", places)
    body.data.update()
    return body


def joints(path: Path) -> dict[str, Vector]:
    """The joints of the body, as the corners of little cubes of its base mesh tell them."""
    points, corners, name = [], {}, ""
    for line in path.read_text().splitlines():
        kind, *rest = line.split() or [""]
        if kind == "v":
            x, y, z = map(float, rest[:3])
            points.append(Vector((0.1 * x, -0.1 * z, 0.1 * y)))
        elif kind == "g":
            name = rest[0].removeprefix("joint-")
        elif kind == "f":
            numbers = (int(each.split("/")[0]) - 1 for each in rest)
            corners.setdefault(name, set()).update(numbers)
    return {
        name: sum((points[i] for i in where), Vector()) / len(where)
        for name, where in corners.items()
    }


def rig(body: bpy.types.Object, at: dict[str, Vector]) -> bpy.types.Object:
    """Bones at the joints, bound with automatic weights."""
    bpy.ops.object.armature_add()
    armature = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    bones.remove(bones[0])
    for name, head, tail, parent in BONES:
        bone = bones.new(name)
        bone.head, bone.tail = at[head], at[tail]
        bone.parent = bones.get(parent)
    bpy.ops.armature.select_all(action="SELECT")
    bpy.ops.armature.symmetrize()
    bpy.ops.object.mode_set(mode="OBJECT")
    body.select_set(True)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    return armature


def pose(armature: bpy.types.Object) -> None:
    """Bends elbows and knees."""
    for name, degrees in POSE.items():
        bone = armature.pose.bones[name]
        rest = bone.bone.matrix_local.to_3x3()
        turn = Euler(np.radians(degrees)).to_matrix()
        bone.rotation_mode = "QUATERNION"
        bone.rotation_quaternion = (rest.inverted() @ turn @ rest).to_quaternion()
    bpy.context.view_layer.update()


def export(thing: bpy.types.Object, path: Path) -> Path:
    """Writes an object as it is seen."""
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.ops.wm.obj_export(
        filepath=str(path),
        export_selected_objects=True,
        export_materials=False,
        export_uv=False,
        forward_axis="Y",
        up_axis="Z",
    )
    return path


def main(data: Path, out: Path) -> None:
    """Does the steps, tells what came of each, and renders them."""
    work = Path(_HOME.name)
    install()
    body = scan(data / "makehuman" / "body.obj")
    n_before = len(body.data.polygons)
    before = export(body, work / "scan.obj")
    bpy.context.view_layer.objects.active = body
    bpy.ops.object.orbflow_remesh(faces=N_FACES, mirror="X", keep_original=True)
    n_after = len(body.data.polygons)
    after = export(body, work / "low.obj")
    bpy.context.view_layer.objects.active = body
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.orbflow_bake_normal_map(image_size=1024)
    armature = rig(body, joints(data / "makehuman" / "base.obj"))
    pose(armature)
    posed = export(body, work / "posed.obj")
    n_free = sum(not vertex.groups for vertex in body.data.vertices)
    print(f"{n_before:,} triangles, {n_after:,} quads, {n_free} vertices without a bone")
    print(f"images: {[image.name for image in bpy.data.images]}")
    view = {"turn_deg": 25.0, "is_y_up": False}
    steps = [
        Exhibit(before, f"the scan: {n_before:,} triangles", edges=0.0, **view),
        Exhibit(after, f"{n_after:,} quads", edges=0.0014, **view),
        Exhibit(posed, "rigged and posed", edges=0.0014, **view),
    ]
    picture([steps], out / "tutorial.jpg")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
