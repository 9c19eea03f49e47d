# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbflow: rebuilds a mesh with good edge flow by deforming a sphere into it.

The extension reads arrays from Blender, asks `orbflow_native`, and writes arrays back; it computes
nothing itself. `operators/remesh.py` is the button, `job.py` the thread behind it, `words.py` what
is said of a run.
"""

import bpy

from . import (
    earlier,
    manual,
    originals,
    overlay,
    panel,
    preferences,
    runs,
    settings,
    tool,
    translations,
)
from .operators import (
    before,
    cancel,
    detail,
    draw_guide,
    erase_guide,
    normal_map,
    paint,
    remesh,
    show,
)

_CLASSES = (
    preferences.OrbflowPreferences,
    settings.OrbflowSettings,
    remesh.OBJECT_OT_orbflow_remesh,
    cancel.OBJECT_OT_orbflow_cancel,
    paint.OBJECT_OT_orbflow_paint_density,
    draw_guide.OrbflowPlace,
    draw_guide.OBJECT_OT_orbflow_draw_guide,
    erase_guide.OBJECT_OT_orbflow_erase_guide,
    tool.OBJECT_OT_orbflow_draw_guides,
    show.OBJECT_OT_orbflow_show,
    before.OBJECT_OT_orbflow_before,
    detail.OBJECT_OT_orbflow_bake_detail,
    normal_map.OBJECT_OT_orbflow_bake_normal_map,
    panel.VIEW3D_PT_orbflow,
    panel.VIEW3D_MT_orbflow,
)


def register() -> None:
    """Called by Blender when the extension is switched on."""
    translations.register()
    for each in _CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.orbflow = bpy.props.PointerProperty(type=settings.OrbflowSettings)
    bpy.types.VIEW3D_MT_object.append(panel.draw_menu)
    originals.register()
    runs.register()
    overlay.register()
    earlier.register()
    tool.register()
    manual.register()


def unregister() -> None:
    """Called by Blender when the extension is switched off."""
    manual.unregister()
    tool.unregister()
    earlier.unregister()
    overlay.unregister()
    runs.unregister()
    originals.unregister()
    bpy.types.VIEW3D_MT_object.remove(panel.draw_menu)
    del bpy.types.Scene.orbflow
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
    translations.unregister()
