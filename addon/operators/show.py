# SPDX-License-Identifier: GPL-3.0-or-later
"""The button Show: selects what keeps a mesh, or a part of it, from being done."""

from typing import Any

import bmesh
import bpy
from bpy.props import IntProperty, StringProperty
from mathutils import Vector

from .. import runs
from ..job import running
from ..spots import Complaint, Spot
from ..translations import rpt_, tip_

# Of the mode of selection: vertices, edges, faces.
_EDGES, _FACES = (False, True, False), (False, False, True)


class OBJECT_OT_orbflow_show(bpy.types.Operator):
    """Select this object"""  # noqa: D400

    bl_idname = "object.orbflow_show"
    bl_label = "Show"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Object", options={"HIDDEN", "SKIP_SAVE"})  # pyright: ignore[reportInvalidTypeForm]
    row: IntProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Row",
        description="Which of the rows that the panel has about the object; -1 is the object",
        default=-1,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether meshes may be put into edit mode."""
        if running:
            cls.poll_message_set(rpt_("Orbflow is at work; press ESC to stop it"))
        return not running

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:  # noqa: ANN401
        """The tooltip: the exact words of the reason."""
        complaint = _complaint(runs.local(properties.name), properties.row)
        if complaint is None:
            return tip_("Select {}").format(properties.name)
        told = tip_("Select the spot in edit mode. In exact words: {}")
        return told.format(complaint.exact)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Makes the object active, and selects the spot of the row in edit mode."""
        thing = runs.local(self.name)
        if thing is None or not thing.visible_get():
            self.report({"ERROR"}, rpt_("{} is not there or not visible").format(self.name))
            return {"CANCELLED"}
        complaint = _complaint(thing, self.row)
        if self.row >= 0 and (complaint is None or complaint.spot is None):
            self.report({"ERROR"}, rpt_("{} has changed since").format(self.name))
            return {"CANCELLED"}
        _activate(context, thing)
        if complaint and complaint.spot:
            bpy.ops.object.mode_set(mode="EDIT")
            select(context, thing.data, complaint.spot)
            _frame(context)
            self.report({"INFO"}, complaint.words)
        return {"FINISHED"}


def _complaint(thing: bpy.types.Object | None, row: int) -> Complaint | None:
    left = runs.left_of(thing)
    return left.complaints[row] if left and 0 <= row < len(left.complaints) else None


def _activate(context: bpy.types.Context, thing: bpy.types.Object) -> None:
    """Makes an object the only selected one, in object mode."""
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for each in context.selected_objects:
        each.select_set(False)
    thing.select_set(True)
    context.view_layer.objects.active = thing


def select(context: bpy.types.Context, mesh: bpy.types.Mesh, spot: Spot) -> None:
    """Selects a spot of a mesh in edit mode and nothing else; reveals it and its faces alone."""
    context.tool_settings.mesh_select_mode = _EDGES if len(spot.edges) else _FACES
    bpy.ops.mesh.select_all(action="DESELECT")
    shape = bmesh.from_edit_mesh(mesh)
    for element in _elements(shape, spot):
        # An edge that is revealed reveals its faces, but not their other edges.
        for face in getattr(element, "link_faces", ()):
            face.hide_set(False)
        element.hide_set(False)
        element.select_set(True)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _elements(shape: bmesh.types.BMesh, spot: Spot) -> list[Any]:
    shape.verts.ensure_lookup_table()
    shape.faces.ensure_lookup_table()
    if len(spot.edges):
        ends = [[shape.verts[i] for i in pair] for pair in spot.edges.tolist()]
        return [edge for edge in map(shape.edges.get, ends) if edge]
    if len(spot.faces):
        return [shape.faces[i] for i in spot.faces.tolist()]
    # What came in is another mesh, such as what modifiers make of this one.
    place = Vector(spot.place)
    nearest = min(shape.verts, key=lambda each: (each.co - place).length_squared)
    return list(nearest.link_faces)


def _frame(context: bpy.types.Context) -> None:
    """Moves the view to what is selected."""
    area = context.area
    if bpy.app.background or area is None or area.type != "VIEW_3D":
        return
    region = next(each for each in area.regions if each.type == "WINDOW")
    with context.temp_override(area=area, region=region):
        bpy.ops.view3d.view_selected()
