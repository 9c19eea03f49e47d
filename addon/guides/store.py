# SPDX-License-Identifier: GPL-3.0-or-later
"""Where strokes that are drawn are kept: a curve object that is a child of what it guides.

So Blender's own tools edit them, they go with the object, and a second run has them again.
"""

from collections.abc import Callable

import bpy
import numpy as np

from .. import named
from . import DEFAULT, strokes, things_of
from .paths import Line
from .strokes import Points

# Tells of the points of a line in the space of the scene whether it is touched.
Touched = Callable[[Points], bool]

# How thick lines are shown, as a share of the object's size: that hides none of the surface.
_THICKNESS = 0.0025
# The materials of strokes that are as strong as the settings say, and of those that are exact.
_MATERIALS = {False: ("Guide", (1.0, 0.45, 0.05, 1.0)), True: ("Exact Guide", (0.9, 0.1, 0.3, 1.0))}


def holder(context: bpy.types.Context, thing: bpy.types.Object) -> bpy.types.Object:
    """The curve object into which guides of an object are drawn.

    Where there is none yet it is made and named in the settings.
    """
    wanted = context.scene.orbflow
    found = next(iter(curves_of(context, thing)), None)
    if found is None:
        collection = _collection(context.scene, wanted.guides)
        found = _new(thing)
        collection.objects.link(found)
        with named.unnoticed():
            wanted.guides = collection.name
    found.hide_set(False)
    return found


def curves_of(context: bpy.types.Context, thing: bpy.types.Object) -> list[bpy.types.Object]:
    """The curve objects that guide an object and may be drawn into, its own first."""
    name = context.scene.orbflow.guides
    found = [
        each
        for each in (things_of(context, name) if name else None) or []
        if each.type == "CURVE" and each.parent in {thing, None} and each.data.library is None
    ]
    return sorted(found, key=lambda each: each.parent is None)


def add(held: bpy.types.Object, thing: bpy.types.Object, lines: list[Line], is_exact: bool) -> None:
    """Adds lines in the space of the object that they guide to a curve object."""
    inverse = np.array(held.matrix_world.inverted_safe() @ thing.matrix_world, np.float64)
    number = _slot(held.data, is_exact)
    for points, is_closed in lines:
        spline = held.data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        places = np.ones((len(points), 4))
        places[:, :3] = strokes.moved(points, inverse)
        spline.points.foreach_set("co", places.ravel())
        spline.use_cyclic_u = is_closed
        spline.material_index = number


def erase(held: bpy.types.Object, is_touched: Touched) -> int:
    """Removes the strokes of a curve object that are touched, by points in the scene's space."""
    matrix = np.array(held.matrix_world, np.float64)
    touched = [each for each in held.data.splines if is_touched(_points(each, matrix))]
    for each in touched:
        held.data.splines.remove(each)
    return len(touched)


def _points(spline: bpy.types.Spline, matrix: Points) -> Points:
    held = spline.bezier_points if spline.type == "BEZIER" else spline.points
    points = np.array([tuple(each.co)[:3] for each in held], np.float64)
    if spline.use_cyclic_u:
        points = np.concatenate([points, points[:1]])
    return strokes.moved(points, matrix)


def _collection(scene: bpy.types.Scene, name: str) -> bpy.types.Collection:
    """The collection of a name in a scene; where there is none such, that for guides."""
    inside = {each.name: each for each in scene.collection.children_recursive if not each.library}
    found = inside.get(name) or inside.get(DEFAULT)
    if found is None:
        found = bpy.data.collections.new(DEFAULT)
        scene.collection.children.link(found)
    return found


def _new(thing: bpy.types.Object) -> bpy.types.Object:
    name = f"{thing.name} {DEFAULT}"
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    size = float(np.linalg.norm(np.ptp(np.array(thing.bound_box), axis=0)))
    data.bevel_depth, data.bevel_resolution = _THICKNESS * size, 1
    made = bpy.data.objects.new(name, data)
    made.parent = thing
    # Blender tells it only after the next update.
    made.matrix_world = thing.matrix_world
    made.hide_render = True
    return made


def _slot(data: bpy.types.Curve, is_exact: bool) -> int:
    """The number of the material that says how strong a stroke is."""
    name, colour = _MATERIALS[is_exact]
    material = bpy.data.materials.get((name, None))
    if material is None:
        material = bpy.data.materials.new(name)
        material.diffuse_color = colour
    held = list(data.materials)
    if material not in held:
        data.materials.append(material)
        return len(held)
    return held.index(material)
