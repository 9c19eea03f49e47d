# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that stops a run, as ESC does."""

import bpy

from ..job import running


class OBJECT_OT_orbflow_cancel(bpy.types.Operator):
    """Stop; nothing is changed"""  # noqa: D400

    bl_idname = "object.orbflow_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether a run is at work."""
        return bool(running)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Asks the run to stop; the operator that watches it sees when it has."""
        running[-1].cancel()
        return {"FINISHED"}
