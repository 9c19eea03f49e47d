# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar panel and the menu entry."""

import textwrap
from typing import Any

import bpy

from . import earlier, runs, settings, words
from .job import running
from .runs import Left, Line
from .translations import iface_, n_, rpt_

# How much of a panel's width there is for no letter of a sentence, and how wide a letter is.
_MARGIN_PX = 70.0
_LETTER_PX = 6.0
# The share of the width that a sentence has beside a button.
_BESIDE = 0.74
# The share that the name of a figure has beside its value.
_OF_ROW = 0.48
# So many objects have a line of their own; a list that is longer takes long to draw and to read.
_MOST_LINES = 40
_ICONS = {"refused": "CANCEL", "warned": "ERROR", "done": "CHECKMARK"}
# Shares of the input that have a button.
_RATIOS = (10, 25, 50)
# Settings of several boxes.
_BOXES = {"marked_edges"}
# What stands in an empty field.
_PLACEHOLDERS = {
    "density": n_("Group or Color"),
    "guides": n_("Collection or Object"),
    "keep_faces": n_("Group or Face Set"),
}
# What the menu has beside the run.
_ENTRIES = (
    ("object.orbflow_draw_guides", n_("Draw Guides"), "GREASEPENCIL"),
    ("object.orbflow_paint_density", n_("Paint Density"), "BRUSH_DATA"),
    ("object.orbflow_bake_detail", n_("Bake Detail"), "MOD_MULTIRES"),
    ("object.orbflow_bake_normal_map", n_("Bake Normal Map"), "IMAGE_DATA"),
    ("object.orbflow_before", n_("Before / After"), "ARROW_LEFTRIGHT"),
)
_ROWS = (
    (n_("Faces"), "n_faces", "{:,}"),
    (n_("Quads"), "quads_pct", "{:.0f} %"),
    (n_("Irregular vertices"), "irregular_pct", "{:.1f} %"),
    (n_("Irregular, border"), "border_irregular_pct", "{:.1f} %"),
    (n_("Flow deviation"), "alignment_deg", "{:.1f}°"),
    (n_("On closed loops"), "loop_edges_pct", "{:.0f} %"),
    (n_("In spirals"), "spiral_pct", "{:.0f} %"),
    (n_("Edge variation"), "edge_cv", "{:.2f}"),
    (n_("Mean distance"), "chamfer_pct", n_("{:.3f} % of size")),
    (n_("Largest distance"), "hausdorff_pct", n_("{:.2f} % of size")),
)


class VIEW3D_PT_orbflow(bpy.types.Panel):
    """Settings, the button, what was left and why, and the score of the last run."""

    bl_label = "Orbflow"
    bl_category = "Orbflow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        """Draws the panel."""
        layout = self.layout
        n_letters = _n_letters(context)
        if running:
            _draw_progress(layout)
        else:
            _button(layout, context)
        wanted = context.scene.orbflow
        _draw_size(layout, wanted, context)
        if lines := runs.lines():
            _draw_lines(layout.box().column(align=True), lines, n_letters)
        if left := runs.left_of(context.object):
            _draw_left(layout.box().column(align=True), context.object.name, left, context)
        for title in settings.SECTIONS:
            _draw_section(layout, wanted, title)
        _draw_detail(layout, context)
        row = layout.row()
        row.active = earlier.may_be(context.object)
        row.prop(context.window_manager, "orbflow_before", slider=True)
        column = layout.column(heading=n_("Show"))
        _draw_show(column, wanted, context.object)
        last = runs.last_of(context.object)
        crosses = column.row()
        crosses.active = last is not None and len(last.crosses) > 0
        crosses.prop(context.scene.orbflow, "show_crosses")
        if last:
            _draw_score(layout.box().column(align=True), last.report, n_letters)


def _draw_show(
    column: bpy.types.UILayout, wanted: settings.OrbflowSettings, thing: bpy.types.Object | None
) -> None:
    """What is drawn over the active mesh, and what its colors stand for."""
    if thing and thing.type == "MESH":
        column.prop(thing, "show_wire", text="Wireframe")
    column.prop(wanted, "show_size")
    if wanted.show_size:
        column.label(text=n_("Blue: large, red: small"))
    column.prop(wanted, "show_irregular")
    if wanted.show_irregular:
        column.label(text=n_("Blue: 3 edges, red: 5"))


def _draw_section(layout: bpy.types.UILayout, wanted: settings.Settings, title: str) -> None:
    """A section of settings that opens, with its buttons."""
    header, body = layout.panel(f"orbflow_{title}", default_closed=True)
    header.label(text=title)
    if body is None:
        return
    names = settings.SECTIONS[title]
    _draw_settings(body, wanted, names)
    if "guides" in names:
        body.operator("object.orbflow_draw_guides", icon="GREASEPENCIL")
    if "density" in names:
        body.operator("object.orbflow_paint_density", icon="BRUSH_DATA")


def _draw_detail(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """What takes relief from the original, once there is one."""
    header, body = layout.panel("orbflow_Detail", default_closed=True)
    header.label(text=n_("Detail"))
    if not body:
        return
    thing = context.object
    if thing and thing.type == "MESH":
        body.prop(thing, "orbflow_original")
    body.operator("object.orbflow_bake_detail", icon="MOD_MULTIRES")
    body.operator("object.orbflow_bake_normal_map", icon="IMAGE_DATA")


class VIEW3D_MT_orbflow(bpy.types.Menu):
    """What there is beside the run; F3 finds what is in menus alone."""

    # Without the word by which the run is searched for, which is to come first.
    bl_label = "Guides and Detail"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draws the entries."""
        for name, text, icon in _ENTRIES:
            self.layout.operator(name, text=text, icon=icon)


def draw_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """The entries in the Object menu: what is searched for are the words of menus."""
    menu.layout.separator()
    _button(menu.layout, context, n_("Orbflow Remesh (Quad Retopology)"))
    menu.layout.menu("VIEW3D_MT_orbflow")


def _button(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str = n_("Orbflow Remesh")
) -> None:
    button = layout.operator("object.orbflow_remesh", text=text, icon="MOD_REMESH")
    settings.copy(context.scene.orbflow, button)


def _draw_progress(layout: bpy.types.UILayout) -> None:
    """How far the run is, where the button was, and below it what stops it."""
    layout.progress(factor=running[-1].stage.share, text=running[-1].told())
    layout.operator("object.orbflow_cancel", icon="CANCEL")


def _draw_size(
    layout: bpy.types.UILayout, wanted: settings.Settings, context: bpy.types.Context
) -> None:
    """How many faces there will be, and how many there are."""
    _draw_settings(layout, wanted, settings.FIRST)
    if wanted.size == "RATIO":
        row = layout.row(align=True)
        for ratio in _RATIOS:
            button = row.operator("wm.context_set_float", text=f"{ratio} %")
            button.data_path, button.value = "scene.orbflow.ratio", ratio
    thing = context.object
    if thing and thing.type == "MESH" and wanted.size != "EDGE":
        n, is_editing = _n_faces_now(wanted, context)
        told = words.count(n, n_("{:,} face now"), n_("{:,} faces now"))
        if is_editing:
            told = words.count(n, n_("{:,} face selected"), n_("{:,} faces selected"))
        if wanted.size == "RATIO":
            n_asked = round(n * wanted.ratio / 100)
            n_faces = words.count(n, n_("{:,} face"), n_("{:,} faces"))
            told = rpt_("{:,} of {}").format(n_asked, n_faces)
        layout.label(text=told, icon="MESH_DATA")


def _n_faces_now(wanted: settings.Settings, context: bpy.types.Context) -> tuple[int, bool]:
    """How many faces the active mesh has; in edit mode, of what is selected, and that it is so."""
    thing = context.object
    # What is evaluated then has no faces of its own.
    if thing.mode == "EDIT":
        return thing.data.total_face_sel, True
    seen = thing.evaluated_get(context.evaluated_depsgraph_get())
    return len((seen if wanted.use_modifiers else thing).data.polygons), False


def _draw_settings(
    layout: bpy.types.UILayout, wanted: settings.Settings, names: tuple[str, ...]
) -> None:
    layout.use_property_split = True
    layout.use_property_decorate = False
    for name in names:
        if not settings.is_shown(wanted, name):
            continue
        # Beside each other the names of several boxes would be cut.
        row = layout.column() if name in _BOXES else layout.row()
        row.active = settings.is_of_use(wanted, name)
        row.prop(wanted, name, placeholder=iface_(_PLACEHOLDERS.get(name, "")))


def redraw_status_bar(context: bpy.types.Context) -> None:
    """Redraws the status bar, which is in no screen's list of areas: setting its text does it."""
    context.workspace.status_text_set_internal("")


def redraw_progress(context: bpy.types.Context) -> None:
    """Draws the sidebars anew, and nothing of the views beside them."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions if area.type == "VIEW_3D" else ():
                if region.type == "UI":
                    region.tag_redraw()


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Draws the panel anew: without an undo step Blender does not, and a grey button stays grey."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def rows(report: dict[str, Any]) -> list[tuple[str, str]]:
    """The score as words and values; what does not apply is left out."""
    figures = report["output"] | (report["score"] or {})
    if not figures["quads_pct"]:
        del figures["quads_pct"]
    score = [
        (what, rpt_(form).format(figures[name]) + words.beside_artists(name, figures))
        for what, name, form in _ROWS
        if figures.get(name) is not None
    ]
    return _symmetry(report) + words.guides(report) + score + _proposal(report["embedding"])


def _symmetry(report: dict[str, Any]) -> list[tuple[str, str]]:
    """The axis across which the two sides are each other's image, if they are."""
    told = [(part["mirrored"] or {}).get("status") for part in report["parts"]]
    if not {"used", "image"} & set(told):
        return []
    return [(n_("Symmetric across"), "XYZ"[report["plane"]["axis"]])]


def _proposal(embedding: dict[str, Any]) -> list[tuple[str, str]]:
    """What the network proposed and what it took to mend it; nothing with the solver alone."""
    if embedding["weights"] is None:
        return []
    proposal = embedding["proposal"]
    relaxed = embedding["n_relaxations"] - proposal["n_relaxations"]
    moved, n_vertices = embedding["repair"]["n_moved"], proposal["n_vertices"]
    weights = embedding["weights"]
    return [
        (n_("Proposed by"), embedding["predictor"]),
        (n_("Weights"), rpt_("shipped") if weights["shipped"] else weights["sum"]),
        (n_("Folds proposed"), f"{proposal['folds_pct']:.1f} %"),
        (n_("Distortion"), f"{proposal['energy']:.2f} → {embedding['energy']:.2f}"),
        (n_("Vertices repaired"), rpt_("{:,} of {}").format(moved, f"{n_vertices:,}")),
        (n_("Relaxations"), f"{relaxed:,}"),
    ]


def _n_letters(context: bpy.types.Context, share: float = 1.0) -> int:
    """How many letters fit beside an icon in a share of the panel as wide as it is."""
    scale = context.preferences.system.ui_scale
    return max(10, int((share * context.region.width / scale - _MARGIN_PX) / _LETTER_PX))


def _draw_lines(column: bpy.types.UILayout, lines: list[Line], n_letters: int) -> None:
    """What became of every object of the last run, the worst first."""
    column.label(text=words.summary([line.state for line in lines]))
    ordered = sorted(lines, key=lambda line: list(_ICONS).index(line.state))
    for line in ordered[:_MOST_LINES]:
        row = column.row()
        row.alignment = "LEFT"
        text = f"{line.name}: {line.text}"
        button = row.operator(
            "object.orbflow_show",
            text=textwrap.shorten(text, n_letters, placeholder=" …"),
            icon=_ICONS[line.state],
            emboss=False,
        )
        button.name = line.name
    if len(lines) > _MOST_LINES:
        column.label(text=rpt_("and {:,} more").format(len(lines) - _MOST_LINES), icon="BLANK1")


def _draw_left(
    column: bpy.types.UILayout, name: str, left: Left, context: bpy.types.Context
) -> None:
    """Why an object, or parts of it, were left as they were, each with the button Show."""
    icon = "CANCEL" if left.is_whole else "ERROR"
    if left.title:
        _draw_text(column, rpt_(left.title).format(name), icon, _n_letters(context))
    for i, complaint in enumerate(left.complaints):
        share = _BESIDE if complaint.spot else 1.0
        row = column.split(factor=share)
        _draw_text(row.column(align=True), complaint.words, "DOT", _n_letters(context, share))
        if complaint.spot:
            button = row.operator("object.orbflow_show", text=n_("Show"))
            button.name, button.row = name, i


def _draw_text(column: bpy.types.UILayout, text: str, icon: str, n_letters: int) -> None:
    """A sentence in as many lines as it needs."""
    for i, line in enumerate(textwrap.wrap(text, n_letters)):
        column.label(text=line, icon="BLANK1" if i else icon)


def _draw_score(column: bpy.types.UILayout, report: dict[str, Any], n_letters: int) -> None:
    # These have rows of their own, with the button Show.
    shown = words.lost_guides(report) + ([] if report["half"] else words.filled(report))
    for text in words.faults(report):
        if text not in shown:
            _draw_text(column, text, "ERROR", n_letters)
    for text in words.exceptions(report):
        if text not in shown:
            _draw_text(column, text, "INFO", n_letters)
    for what, value in rows(report):
        row = column.split(factor=_OF_ROW)
        row.label(text=what)
        row.label(text=value)
