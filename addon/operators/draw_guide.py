# SPDX-License-Identifier: GPL-3.0-or-later
"""One stroke of the tool Draw Guides: drawn by the mouse on the surface of the active object."""

from typing import Any

import bpy
import gpu
import numpy as np
from bpy.props import BoolProperty, CollectionProperty, FloatVectorProperty
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from ..guides import paths, store
from ..guides.surface import Surface
from ..translations import n_, rpt_

_COLOUR = (1.0, 0.45, 0.05, 1.0)
_WIDTH_PX = 3.0

# The stroke that is being drawn, in the space of the scene.
_drawn: list[tuple[float, float, float]] = []


class OrbflowPlace(bpy.types.PropertyGroup):
    """A point of a stroke."""

    location: FloatVectorProperty(name="Location", subtype="XYZ", size=3)  # pyright: ignore[reportInvalidTypeForm]


class OBJECT_OT_orbflow_draw_guide(bpy.types.Operator):
    """Draw a line on the surface that edges of the result follow; a loop where it ends at its start"""  # noqa: D400, E501

    bl_idname = "object.orbflow_draw_guide"
    bl_label = "Draw Guide"
    bl_options = {"REGISTER", "UNDO"}

    is_exact: BoolProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Exact",
        description="Edges lie on it exactly, whatever the guide strength is",
        default=False,
    )
    is_closed: BoolProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Closed",
        description="It is a loop",
        default=False,
        options={"SKIP_SAVE"},
    )
    stroke: CollectionProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Stroke",
        description="Its points in the space of the scene, from which it goes onto the surface",
        type=OrbflowPlace,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to draw on."""
        if target(context) is None:
            cls.poll_message_set(rpt_("Make a mesh active in object mode: guides are drawn on it"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Keeps the stroke."""
        thing = target(context)
        surface = Surface(context, thing)
        inverse = thing.matrix_world.inverted_safe()
        given = [Vector(each.location) for each in self.stroke]
        # A gap is where the mouse was beside the object.
        places = [surface.nearest(inverse @ p) if np.isfinite(p).all() else None for p in given]
        lines = surface.with_images(surface.lines(places, self.is_closed))
        if not lines:
            self.report({"WARNING"}, rpt_("nothing was drawn on {}").format(thing.name))
            return {"CANCELLED"}
        before = context.scene.orbflow.guides
        store.add(store.holder(context, thing), thing, lines, self.is_exact)
        one, many = n_("{:,} guide drawn on {name}"), n_("{:,} guides drawn on {name}")
        told = rpt_(many if len(lines) > 1 else one).format(len(lines), name=thing.name)
        now = context.scene.orbflow.guides
        if before not in {"", now}:
            told += "; " + rpt_("Guides is now {} instead of {}").format(now, before)
        self.report({"INFO"}, told)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Starts to draw."""
        if context.region_data is None:
            return self.execute(context)
        self._path = [(event.mouse_region_x, event.mouse_region_y)]
        _drawn.clear()
        space = bpy.types.SpaceView3D
        self._handle = space.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")
        context.window_manager.modal_handler_add(self)
        self._go_on(context, self._path)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follows the mouse until its button is let go."""
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._path.append((event.mouse_region_x, event.mouse_region_y))
            self._go_on(context, self._path[-2:])
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self.cancel(context)
            return self._end(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Takes the preview away."""
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        _drawn.clear()
        # Another file may be opened meanwhile.
        if context.area is not None:
            context.area.tag_redraw()

    def _end(self, context: bpy.types.Context) -> set[str]:
        """Makes a stroke of the path of the mouse."""
        line, self.is_closed = paths.drawn(np.array(self._path, np.float64))
        self.stroke.clear()
        for place in self._hits(context, line):
            added = self.stroke.add()
            added.location = place or (np.nan,) * 3
        return self.execute(context)

    def _go_on(self, context: bpy.types.Context, path: list[tuple[float, float]]) -> None:
        """Shows the stroke as far as it is drawn."""
        ends = np.array(path, np.float64)
        _drawn.extend(tuple(each) for each in self._hits(context, paths.even(ends)) if each)
        context.area.tag_redraw()

    def _hits(self, context: bpy.types.Context, line: Any) -> list[Vector | None]:  # noqa: ANN401
        """Where points of the view lie on the surface, in the space of the scene."""
        # What is evaluated holds until the next event: a frame that plays makes it anew.
        surface = Surface(context, target(context))
        matrix = surface.thing.matrix_world
        hits = (surface.hit(*ray(context, point)) for point in line)
        return [None if each is None else matrix @ each for each in hits]


def ray(context: bpy.types.Context, point: Any) -> tuple[Vector, Vector]:  # noqa: ANN401
    """Where a ray from the eye through a point of the view begins, and its direction."""
    region, view = context.region, context.region_data
    return (
        view3d_utils.region_2d_to_origin_3d(region, view, point),
        view3d_utils.region_2d_to_vector_3d(region, view, point),
    )


def target(context: bpy.types.Context) -> Any:  # noqa: ANN401 - an object, or none
    """The mesh object that is drawn on: the active one, or that of active guides."""
    thing = context.object
    if thing is not None and thing.type == "CURVE" and thing.parent is not None:
        thing = thing.parent
    if context.mode != "OBJECT" or thing is None or thing.type != "MESH":
        return None
    return thing if thing.visible_get() and len(thing.data.polygons) else None


def _draw() -> None:
    if len(_drawn) < 2:
        return
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINE_STRIP", {"pos": _drawn})
    gpu.state.line_width_set(_WIDTH_PX)
    shader.uniform_float("color", _COLOUR)
    batch.draw(shader)
    gpu.state.line_width_set(1.0)
