# SPDX-License-Identifier: GPL-3.0-or-later
"""A run in edit mode: the selected faces alone are remeshed, and edit mode is where it ends."""

import bpy

from . import regions
from .job import Done


def leave(context: bpy.types.Context) -> list[str]:
    """Leaves edit mode of meshes; the names of the objects that were in it."""
    if context.mode != "EDIT_MESH":
        return []
    names = [each.name for each in context.objects_in_mode_unique_data]
    bpy.ops.object.mode_set(mode="OBJECT")
    return names


def enter(names: list[str], done: list[Done]) -> None:
    """Goes back into it, with the new faces of objects that were done selected."""
    if not names:
        return
    for each in done:
        thing = bpy.data.objects.get((each.task.name, None))
        if thing is not None and len(thing.data.polygons) == len(each.result.loop_start):
            regions.select_others(thing.data, each.result.kept_faces)
    bpy.ops.object.mode_set(mode="EDIT")
