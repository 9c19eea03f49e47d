"""Pictures of the window for the documents: panel, guides, before and after."""

import subprocess

import bpy
import hand
import scene
from hand import Place, Waits


def pictures() -> Waits:
    """Draws guides on the cow, remeshes it, and keeps what is seen."""
    yield from scene.start_with(scene.cow)
    with scene.in_view():
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
    hand.view().spaces[0].overlay.show_floor = False
    bpy.context.scene.orbflow.faces = 2500
    yield from hand.search("draw guides")
    middle = hand.middle(across=0.42)
    yield from hand.drag([Place(middle.x - 150 + 10 * i, middle.y + 40) for i in range(26)])
    yield from hand.drag([Place(middle.x - 60, middle.y + 90 - 8 * i) for i in range(22)])
    yield from hand.move(hand.middle(up=0.05))
    yield 1.0
    _keep("window_guides")
    yield from hand.push(r"orbflow_remesh\(")
    yield from scene.until_done()
    hand.view().spaces[0].overlay.show_wireframes = True
    hand.view().spaces[0].overlay.wireframe_threshold = 1.0
    bpy.context.scene.orbflow.show_irregular = True
    yield from hand.move(hand.middle(up=0.05))
    yield 1.0
    _keep("window_panel")
    bpy.context.scene.orbflow.show_irregular = False
    for each in [each for each in bpy.data.objects if each.type == "CURVE"]:
        each.hide_set(True)
    bpy.context.window_manager.orbflow_before = 0.42
    yield 1.5
    _keep("window_before_after")


def _keep(name: str) -> None:
    """Keeps what the 3D view shows, as a small JPEG."""
    place = hand.region("WINDOW")
    path = scene.OUT / f"{name}.png"
    top = len(hand.picture(path)) - place.y - place.height
    part = f"{place.width}x{place.height}+{place.x}+{top}"
    how = ["-crop", part, "+repage", "-resize", "960", "-quality", "82"]
    subprocess.run(["convert", str(path), *how, str(path.with_suffix(".jpg"))], check=True)
    path.unlink()
