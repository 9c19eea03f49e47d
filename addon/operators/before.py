# SPDX-License-Identifier: GPL-3.0-or-later
"""What a key can be given to: the original in the result's place, and back."""

import bpy

from .. import earlier
from ..translations import rpt_


class OBJECT_OT_orbflow_before(bpy.types.Operator):
    """Show the object as it was before the last run, or as it is again; nothing is changed"""  # noqa: D400

    bl_idname = "object.orbflow_before"
    bl_label = "Orbflow Before / After"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a before to show."""
        is_there = earlier.may_be(context.object)
        if not is_there:
            cls.poll_message_set(rpt_("It has no original, and no run of this session made it"))
        return is_there

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Moves the slider to the other end."""
        manager = context.window_manager
        manager.orbflow_before = 0.0 if manager.orbflow_before else 1.0
        return {"FINISHED"}
