# SPDX-License-Identifier: GPL-3.0-or-later
"""The eraser of the tool Draw Guides."""

import bpy
import numpy as np
from bpy.props import FloatProperty, FloatVectorProperty
from bpy_extras import view3d_utils
from mathutils import Vector

from .. import words
from ..guides import paths, store
from ..guides.strokes import Points
from ..guides.surface import Surface
from ..translations import n_
from . import draw_guide

_REACH_PX = 12.0
# A stroke that lies no deeper than this share of the object's size below what is seen is seen.
_DEPTH = 0.02


class OBJECT_OT_orbflow_erase_guide(bpy.types.Operator):
    """Erase the guides that are touched"""  # noqa: D400

    bl_idname = "object.orbflow_erase_guide"
    bl_label = "Erase Guides"
    bl_options = {"REGISTER", "UNDO"}

    location: FloatVectorProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Location",
        description="A point in the space of the scene",
        subtype="XYZ",
        size=3,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    reach: FloatProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Reach",
        description="Strokes are erased that come so near the point",
        default=0.1,
        min=0.0,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh that may have guides."""
        return draw_guide.target(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Erases what comes near the point."""
        place = np.array(self.location, np.float64)
        n = _erase(context, lambda line: paths.distance(place, line) <= self.reach)
        return self._told(n)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Starts to erase."""
        if context.region_data is None:
            return self.execute(context)
        self._n = 0
        context.window_manager.modal_handler_add(self)
        self._touch(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Erases what the mouse touches until its button is let go."""
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._touch(context, event)
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            return self._told(self._n)
        return {"RUNNING_MODAL"}

    def _touch(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        mouse = np.array((event.mouse_region_x, event.mouse_region_y), np.float64)
        self._n += _erase(context, lambda line: self._is_under(context, mouse, line))
        context.area.tag_redraw()

    def _is_under(self, context: bpy.types.Context, mouse: Points, line: Points) -> bool:
        """Whether a stroke is seen at a place of the view."""
        region, view = context.region, context.region_data
        at = [view3d_utils.location_3d_to_region_2d(region, view, Vector(each)) for each in line]
        for i in range(len(line) - 1):
            if at[i] is None or at[i + 1] is None:
                continue
            way = np.array((at[i], at[i + 1]), np.float64)
            is_near = paths.distance(mouse, way) <= _REACH_PX
            if is_near and self._is_seen(context, at[i], Vector(line[i])):
                return True
        return False

    def _is_seen(self, context: bpy.types.Context, at: Vector, place: Vector) -> bool:
        """Whether nothing of the surface is before a place that is at a point of the view."""
        surface = Surface(context, draw_guide.target(context))
        origin, ahead = draw_guide.ray(context, at)
        hit = surface.hit(origin, ahead)
        if hit is None:
            return True
        matrix = surface.thing.matrix_world
        size = surface.size * max(map(abs, matrix.to_scale()))
        return (place - matrix @ hit).dot(ahead) <= _DEPTH * size

    def _told(self, n: int) -> set[str]:
        self.report({"INFO"}, words.count(n, n_("{:,} guide erased"), n_("{:,} guides erased")))
        return {"FINISHED"} if n else {"CANCELLED"}


def _erase(context: bpy.types.Context, is_touched: store.Touched) -> int:
    curves = store.curves_of(context, draw_guide.target(context))
    return sum(store.erase(each, is_touched) for each in curves if each.visible_get())
