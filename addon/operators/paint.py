# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that has an artist paint where quads are small."""

import bpy

from .. import density, named, settings

# Half as dense as it can be: there is room for more and for less.
_AT_FIRST = 0.5


class OBJECT_OT_orbflow_paint_density(bpy.types.Operator):
    """Paint where quads are small: red where they are smallest, blue where they are largest"""  # noqa: D400

    bl_idname = "object.orbflow_paint_density"
    bl_label = "Paint Density"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to paint on."""
        thing = context.object
        if thing is None or thing.type != "MESH" or context.mode != "OBJECT":
            return False
        return thing.is_editable and thing.data.library is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Makes the vertex group of the field *Density*, unless it is there, and paints on it."""
        thing, wanted = context.object, context.scene.orbflow
        name = wanted.density or density.DEFAULT
        if thing.data.color_attributes.get(name) and name not in thing.vertex_groups:
            thing.data.attributes.active_color_name = name
            _name(wanted, name)
            return bpy.ops.object.mode_set(mode="VERTEX_PAINT")
        group = thing.vertex_groups.get(name)
        if group is None:
            group = thing.vertex_groups.new(name=name)
            group.add(range(len(thing.data.vertices)), _AT_FIRST, "REPLACE")
        thing.vertex_groups.active = group
        _name(wanted, name)
        return bpy.ops.object.mode_set(mode="WEIGHT_PAINT")


def _name(wanted: settings.OrbflowSettings, name: str) -> None:
    """Names the density within the undo step of the operator."""
    with named.unnoticed():
        wanted.density = name
