# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines that the artist has drawn, along which edges of the result lie.

They are named by what holds them: a collection, an object, an annotation. What is hidden guides
nothing. Each kind of thing that holds strokes has a file of its own; `strokes.py` is numbers alone.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from .. import words
from ..translations import rpt_
from . import curves, pencil, strokes
from .strokes import Stroke

#: The collection into which guides are drawn where none is named.
DEFAULT = "Guides"
# Of a stroke that belongs to no object this share lies within the box of each that it guides in a
# run over several, and by this share of its size the box is grown for it.
_INSIDE = 0.5
_GROWN = 0.05


class NoGuides(Exception):
    """Nothing that holds strokes has a name."""


def names(context: bpy.types.Context) -> list[tuple[str, str]]:
    """The names that a scene offers, each with what it is."""
    held = {each.name for each in context.view_layer.objects if _holds(each)}
    collections = [
        each.name for each in _collections(context.scene) if held & {*each.all_objects.keys()}
    ]
    told = [(name, "Collection") for name in collections]
    told += [(each.name, "Object") for each in context.view_layer.objects if _holds(each)]
    noted = _annotation(context.scene)
    return told + ([(noted.name, "Annotation")] if noted else [])


def read(context: bpy.types.Context, name: str, is_exact: bool) -> list[Stroke] | None:
    """The strokes of a name in the space of the scene; none where no name is given.

    `is_exact` tells how strong those are that do not tell themselves. Raises `NoGuides`.
    """
    if not name:
        return None
    things = things_of(context, name)
    if things is not None:
        shown = [each for each in things if _holds(each) and each.visible_get()]
        return list(_of_objects(context, shown, is_exact))
    noted = _annotation(context.scene)
    if noted is None or noted.name != name:
        offered = ", ".join(each for each, _ in names(context)) or rpt_("none")
        told = rpt_("no collection, object or annotation with lines is named '{}'; there are: {}")
        raise NoGuides(told.format(name, offered))
    drawn = list(pencil.of_annotation(noted, context.scene.frame_current))
    return list(_tidied(drawn, noted.name, None, is_exact))


def of(
    thing: bpy.types.Object, given: list[Stroke] | None, is_alone: bool
) -> tuple[Stroke, ...] | None:
    """The strokes that guide an object, in its own space; `is_alone`: it is the only one."""
    if given is None:
        return None
    inverse = np.linalg.pinv(np.array(thing.matrix_world, np.float64))
    found = []
    for each in given:
        local = replace(each, points=strokes.moved(each.points, inverse))
        is_own = each.owner == thing.name
        if is_own or (each.owner is None and (is_alone or _is_near(thing, local))):
            found.append(local)
    return tuple(found)


def told(given: tuple[Stroke, ...] | None, report: dict[str, Any]) -> dict[str, Any]:
    """What a report says of strokes: the core's outcome of each, with its name.

    The core's warnings call them by number: one takes their place.
    """
    held = list(given or ())
    named = [each | {"name": held[each["guide"]].name} for each in report["guides"]]
    warnings = [each for each in report["warnings"] if each["kind"] != "guide"]
    if len(warnings) < len(report["warnings"]):
        text = words.lost_guides({"guides": named})
        warnings += [{"kind": "guide", "text": each, "grave": False} for each in text]
    return {"guides": named, "warnings": warnings, "is_unguided": given == ()}


def _holds(thing: bpy.types.Object) -> bool:
    """Whether an object may hold strokes."""
    return thing.type in {"CURVE", "CURVES", *pencil.TYPES} or curves.is_edges(thing)


def things_of(context: bpy.types.Context, name: str) -> list[bpy.types.Object] | None:
    """The objects of a collection or object of the scene; none where there is none."""
    for each in _collections(context.scene):
        if each.name == name:
            inside = set(each.all_objects)
            return [thing for thing in context.view_layer.objects if thing in inside]
    thing = context.view_layer.objects.get(name)
    return [thing] if thing is not None and _holds(thing) else None


def _collections(scene: bpy.types.Scene) -> list[bpy.types.Collection]:
    """All of a scene; linked ones, which may have the names of others, last."""
    return sorted(scene.collection.children_recursive, key=lambda each: each.library is not None)


def _annotation(scene: bpy.types.Scene) -> bpy.types.ID | None:
    """The annotation of a scene, which was called otherwise before Blender 5."""
    return scene.annotation if hasattr(scene, "annotation") else scene.grease_pencil


def _of_objects(
    context: bpy.types.Context, things: list[bpy.types.Object], is_exact: bool
) -> Iterator[Stroke]:
    bare = curves.Bare(context)
    try:
        copies = {
            thing: [(bare.copy(thing, kept), names) for names, kept in _sorted(thing).items()]
            for thing in things
            if thing.type == "CURVE"
        }
        context.view_layer.update()
        graph = context.view_layer.depsgraph
        for thing in things:
            drawn = [
                each
                for copy, names in copies.get(thing, [(thing, ())])
                for each in _drawn(thing, copy.evaluated_get(graph), names)
            ]
            yield from _tidied(drawn, thing.name, _owner(thing), is_exact)
    finally:
        bare.remove()


def _sorted(thing: bpy.types.Object) -> dict[tuple[str, ...], list[int]]:
    """Which splines of a curve have a material of which name."""
    slots = thing.material_slots
    found: dict[tuple[str, ...], list[int]] = {}
    for i, spline in enumerate(thing.data.splines):
        number = spline.material_index
        material = slots[number].material if number < len(slots) else None
        found.setdefault((material.name,) if material else (), []).append(i)
    return found


def _drawn(
    thing: bpy.types.Object, seen: bpy.types.Object, names: tuple[str, ...]
) -> Iterator[pencil.Drawn]:
    """The lines of an evaluated object, or of a copy that stands for it."""
    if seen.type in pencil.TYPES:
        yield from pencil.of_object(seen)
        return
    if seen.type == "CURVES":
        offsets = curves.offsets(seen.data.curve_offset_data)
        lines = list(curves.of_layout(offsets, seen.data.attributes))
    else:
        lines = curves.of_mesh(seen)
    matrix = np.array(thing.matrix_world, np.float64)
    for points, is_closed in lines:
        yield pencil.Drawn(strokes.moved(points, matrix), is_closed, names)


def _tidied(
    drawn: list[pencil.Drawn], name: str, owner: str | None, is_exact: bool
) -> Iterator[Stroke]:
    for i, each in enumerate(drawn):
        line = strokes.tidied(each.points, each.is_closed)
        if line is None:
            continue
        called = rpt_("{}, stroke {:,}").format(name, i + 1) if len(drawn) > 1 else name
        strength = strokes.is_exact((*each.names, name), is_exact)
        yield Stroke(*line, strength, called, owner)


def _owner(thing: bpy.types.Object) -> str | None:
    parent = thing.parent
    return parent.name if parent and parent.type == "MESH" else None


def _is_near(thing: bpy.types.Object, stroke: Stroke) -> bool:
    """Whether a stroke in the space of an object lies where the object is."""
    box = np.array(thing.bound_box, np.float64)
    low, high = box.min(axis=0), box.max(axis=0)
    slack = _GROWN * np.linalg.norm(high - low)
    is_inside = ((stroke.points >= low - slack) & (stroke.points <= high + slack)).all(axis=1)
    return bool(is_inside.mean() >= _INSIDE)
