# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of objects as they were, hidden beside their results, and what is asked of them later."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy

from . import modifiers
from .stand_in import stand_ins
from .translations import rpt_


class Gone(Exception):
    """An object has no original, or not any more."""


@dataclass
class _AsSeen:
    """The settings by which a run takes what is seen."""

    use_modifiers: bool = True
    mirror_modifier: str = "WHOLE"


def register() -> None:
    """Lets every object name its original."""
    bpy.types.Object.orbflow_original = bpy.props.PointerProperty(
        name="Original",
        description="The object as it was before Orbflow remeshed it",
        type=bpy.types.Object,
        poll=lambda _of, thing: thing.type == "MESH",
    )


def unregister() -> None:
    """Takes that away; what is stored stays in the file."""
    del bpy.types.Object.orbflow_original


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
    thing.orbflow_original = copy


def of(thing: bpy.types.Object) -> bpy.types.Object:
    """The original of an object; raises `Gone` where it has none."""
    found = thing.orbflow_original
    if found is None:
        told = rpt_("{} has no original: tick Original before Orbflow Remesh")
        raise Gone(told.format(thing.name))
    # What is deleted stays in the file as long as something names it.
    if not found.users_collection or found.type != "MESH" or not found.data.polygons:
        raise Gone(rpt_("the original of {} is gone").format(thing.name))
    return found


@contextmanager
def as_remeshed(context: bpy.types.Context, thing: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The mesh that a run made an object of: its original's, with the modifiers that went in.

    It is at rest and in the space of the object. Raises `Gone`, and `modifiers.Refused` where it
    cannot be evaluated.
    """
    original = of(thing)
    with stand_ins(context) as copies:
        stack = modifiers.stack(copies, original, _AsSeen())
        names = tuple(each for each in stack.names if each not in thing.modifiers)
        yield modifiers.seen(copies, original, modifiers.Stack(names, (), None)).thing.data
