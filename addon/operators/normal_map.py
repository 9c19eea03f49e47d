# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that bakes the original's relief to a normal map."""

import bpy
from bpy.props import BoolProperty, IntProperty

from .. import bake, modifiers, originals, words
from ..translations import n_, rpt_
from . import detail


class OBJECT_OT_orbflow_bake_normal_map(bpy.types.Operator):
    """Bake the original's relief to an image for the UV map, with Cycles, and pack it"""  # noqa: D400

    bl_idname = "object.orbflow_bake_normal_map"
    bl_label = "Bake Normal Map"
    bl_options = {"REGISTER", "UNDO"}

    image_size: IntProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Image Size",
        description="How many pixels the image has across and down",
        default=2048,
        min=16,
        max=16_384,
        subtype="PIXEL",
    )
    into_materials: BoolProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Into Materials",
        description="Have the materials read it; those that others use too become the object's own",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an original, and in words why not."""
        reason = detail.why_not(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bakes for the active object; one that is refused stays as it was."""
        thing = context.object
        try:
            image = bake.bake(context, thing, self.image_size)
        except (bake.Refused, originals.Gone, modifiers.Refused) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        told = rpt_("{0}, {1:,} × {1:,} pixels, is packed").format(image.name, self.image_size)
        if self.into_materials:
            n = bake.put_into_materials(thing, image)
            told += " " + words.count(n, n_("and in {:,} material"), n_("and in {:,} materials"))
        self.report({"INFO"}, told)
        return {"FINISHED"}
