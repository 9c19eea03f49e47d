# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes of Grease Pencil, as it is now and as it was up to Blender 4.2, and of annotations."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from . import curves, strokes
from .strokes import Points

#: The types of Grease Pencil objects: since Blender 4.3, and before.
TYPES = {"GREASEPENCIL", "GPENCIL"}


@dataclass(frozen=True)
class Drawn:
    """A line in the space of the scene, and the names that it has from within its object."""

    points: Points
    is_closed: bool
    #: The first that says how strong it is decides.
    names: tuple[str, ...]


def of_object(seen: bpy.types.Object) -> Iterator[Drawn]:
    """The strokes at the current frame of an evaluated object, without hidden layers."""
    materials = [slot.material.name if slot.material else "" for slot in seen.material_slots]
    for layer in seen.data.layers:
        if _is_hidden(layer):
            continue
        name = layer.name if seen.type == "GREASEPENCIL" else layer.info
        matrix = _placed(seen, layer)
        lines = _of_layer(layer) if seen.type == "GREASEPENCIL" else _of_old_layer(layer)
        for points, is_closed, number in lines:
            material = materials[number] if number < len(materials) else ""
            yield Drawn(strokes.moved(points, matrix), is_closed, (material, name))


def annotations() -> bpy.types.bpy_prop_collection:
    """All annotations of the file: before Blender 5 they are among those of Grease Pencil."""
    found = getattr(bpy.data, "annotations", None)
    return bpy.data.grease_pencils if found is None else found


def of_annotation(notes: bpy.types.ID, now: int) -> Iterator[Drawn]:
    """The strokes of an annotation at a frame that were drawn in space, without hidden layers."""
    for layer in notes.layers:
        frame = layer.active_frame if layer.lock_frame else _frame_at(layer, now)
        for stroke in frame.strokes if frame and not layer.annotation_hide else ():
            # Blender 4.5 does not tell.
            if getattr(stroke, "display_mode", "3DSPACE") == "3DSPACE":
                yield Drawn(_points(stroke), False, (layer.info,))


def _frame_at(layer: bpy.types.ID, now: int) -> bpy.types.ID | None:
    """The last frame of an annotation's layer that is not after now."""
    before = [each for each in layer.frames if each.frame_number <= now]
    return max(before, key=lambda each: each.frame_number, default=None)


def _is_hidden(layer: bpy.types.ID) -> bool:
    if layer.hide:
        return True
    group = getattr(layer, "parent_group", None)
    while group is not None:
        if group.hide:
            return True
        group = group.parent_group
    return False


def _placed(seen: bpy.types.Object, layer: bpy.types.ID) -> Points:
    """From the space of an evaluated layer to that of the scene."""
    if seen.type == "GPENCIL":
        # Evaluated points are in the space of the object, whatever the layer follows.
        return np.array(seen.matrix_world)
    own = np.array(layer.matrix_local)
    if layer.parent is None:
        return np.array(seen.matrix_world) @ own
    parent = np.array(layer.parent.matrix_world)
    pose = layer.parent.pose if layer.parent_bone else None
    if pose and (bone := pose.bones.get(layer.parent_bone)):
        parent = parent @ np.array(bone.matrix)
    return parent @ np.array(layer.matrix_parent_inverse) @ own


def _of_layer(layer: bpy.types.ID) -> Iterator[tuple[Points, bool, int]]:
    frame = layer.current_frame()
    if frame is None:
        return
    drawing = frame.drawing
    offsets = curves.offsets(drawing.curve_offsets)
    numbers = curves.of_curves(drawing.attributes, "material_index", max(len(offsets) - 1, 0))
    lines = curves.of_layout(offsets, drawing.attributes)
    for (points, is_closed), number in zip(lines, numbers, strict=False):
        yield points, is_closed, int(number)


def _of_old_layer(layer: bpy.types.ID) -> Iterator[tuple[Points, bool, int]]:
    for stroke in layer.active_frame.strokes if layer.active_frame else ():
        yield _points(stroke), stroke.use_cyclic, stroke.material_index


def _points(stroke: bpy.types.ID) -> Points:
    points = np.empty(3 * len(stroke.points), np.float32)
    stroke.points.foreach_get("co", points)
    return points.reshape(-1, 3).astype(np.float64)
