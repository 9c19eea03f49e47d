# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that puts the original's detail on a result."""

import bpy
from bpy.props import EnumProperty, IntProperty

from .. import details, modifiers, originals, words
from ..details import Detail, Distance
from ..translations import n_, rpt_

_METHODS = (
    ("MULTIRES", "Multires", "Levels that can be sculpted on; the original may go then"),
    ("SHRINKWRAP", "Shrinkwrap", "A subdivision that follows the original, which has to stay"),
)


class OBJECT_OT_orbflow_bake_detail(bpy.types.Operator):
    """Put what the result has lost of its original's relief on it, as levels of a Multires"""  # noqa: D400

    bl_idname = "object.orbflow_bake_detail"
    bl_label = "Bake Detail"
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Method", description="What holds the detail", items=_METHODS
    )
    levels: IntProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Levels",
        description="How often faces are divided by four; 0: as often as it takes",
        default=0,
        min=0,
        max=8,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an original, and in words why not."""
        reason = why_not(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Puts the detail on the active object; an object that is refused stays as it was."""
        thing, is_live = context.object, self.method == "SHRINKWRAP"
        try:
            made = details.bake(context, thing, self.levels, live=is_live)
        except (details.Refused, originals.Gone, modifiers.Refused) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        is_other = not (made.is_multires or is_live)
        self.report({"WARNING" if is_other else "INFO"}, _sentence(made, is_other=is_other))
        return {"FINISHED"}


def why_not(context: bpy.types.Context) -> str:
    """Why the active object has no original to take detail from; empty where it has."""
    thing = context.object
    if thing is None or thing.type != "MESH":
        return rpt_("Make a mesh active")
    if context.mode != "OBJECT":
        return rpt_("Leave edit, sculpt or paint mode first")
    if not thing.is_editable or thing.data.library is not None:
        return rpt_("It is linked from another file and cannot be changed")
    try:
        originals.of(thing)
    except originals.Gone as error:
        return str(error)
    return ""


def _sentence(made: Detail, *, is_other: bool) -> str:
    multires = n_("{:,} level of Multires"), n_("{:,} levels of Multires")
    others = (
        n_("{:,} level of Subdivision and Shrinkwrap"),
        n_("{:,} levels of Subdivision and Shrinkwrap"),
    )
    levels = words.count(made.levels, *(multires if made.is_multires else others))
    faces = words.count(made.n_faces, n_("{:,} face"), n_("{:,} faces"))
    apart = rpt_("mean distance to the original {} before, {} now")
    told = [f"{levels}, {faces}", apart.format(_told(made.before), _told(made.after))]
    return "; ".join(told + ([rpt_("Blender makes no Multires here")] if is_other else []))


def _told(distance: Distance) -> str:
    told = rpt_("{:.3f} % of size (at most {:.2f} %)")
    return told.format(distance.mean_pct, distance.most_pct)
