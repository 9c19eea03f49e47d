# SPDX-License-Identifier: GPL-3.0-or-later
"""The tool Draw Guides in the toolbar of object mode, and the button that takes it."""

import bpy

from .operators import draw_guide
from .translations import n_, rpt_

_DRAW, _ERASE = "object.orbflow_draw_guide", "object.orbflow_erase_guide"
_PRESS = {"type": "LEFTMOUSE", "value": "PRESS"}


class DrawGuides(bpy.types.WorkSpaceTool):
    """Draws and erases lines on the surface of the active object."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = "orbflow.draw_guides"
    bl_label = "Draw Guides"
    bl_description = (
        "Draw lines and loops on the surface that edges of the result follow.\n"
        "Ctrl or Shift erases; a line that ends at its start is a loop"
    )
    bl_icon = "ops.gpencil.draw"
    bl_keymap = (
        (_DRAW, _PRESS, {"properties": []}),
        (_ERASE, _PRESS | {"ctrl": True}, {"properties": []}),
        (_ERASE, _PRESS | {"shift": True}, {"properties": []}),
    )

    @staticmethod
    def draw_settings(
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        tool: bpy.types.WorkSpaceTool,
    ) -> None:
        """The row of the tool's settings, above the view."""
        layout.prop(tool.operator_properties(_DRAW), "is_exact")
        thing = draw_guide.target(context)
        if thing is not None:
            row = layout.row(align=True)
            row.label(text=n_("Mirror"))
            for axis in "xyz":
                row.prop(thing.data, f"use_mirror_{axis}", text=axis.upper(), toggle=True)
        layout.prop(context.scene.orbflow, "guides")


class OBJECT_OT_orbflow_draw_guides(bpy.types.Operator):
    """Take the tool that draws lines on the surface for edges to follow; Ctrl erases"""  # noqa: D400

    bl_idname = "object.orbflow_draw_guides"
    bl_label = "Draw Guides"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to draw on."""
        return draw_guide.OBJECT_OT_orbflow_draw_guide.poll.__func__(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Makes the tool the active one of the 3D view."""
        if context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, rpt_("guides are drawn in a 3D view"))
            return {"CANCELLED"}
        return bpy.ops.wm.tool_set_by_id(name=DrawGuides.bl_idname)


def register() -> None:
    """Adds the tool to the toolbar."""
    bpy.utils.register_tool(DrawGuides, after={"builtin.annotate"}, separator=True)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_tool(DrawGuides)
