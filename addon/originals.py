# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of objects as they were, hidden beside their results."""

import bpy


def keep(thing: bpy.types.Object) -> None:
    """Leaves a hidden copy of an object with the mesh and the modifiers that it has now.

    The object itself gets the result: what points at it, a constraint or a child, goes on doing so.
    """
    copy = thing.copy()
    copy.name = f"{thing.name} Original"
    for collection in thing.users_collection:
        collection.objects.link(copy)
    copy.select_set(False)
    copy.hide_set(True)
    copy.hide_render = True
