# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar panel and the menu entry."""

import textwrap
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import settings


@dataclass(frozen=True)
class _Last:
    """What is kept of a run: in this session alone, not in the file."""

    report: dict[str, Any]
    crosses: NDArray[np.float32]


# What says which mesh a mesh is: how many vertices and faces it has, and where some vertices are.
_Print = tuple[int, int, tuple[float, ...]]
# Of the last runs, by the mesh that each has made: undo and redo, another name for an object and a
# copy of it keep what belongs to them.
_last: dict[_Print, _Last] = {}
# As many runs are kept as Blender keeps undo steps by default; a run is a tenth of a megabyte.
_N_KEPT = 32
# At most so many vertices are looked at on every redraw, which takes less than a millisecond.
_N_LOOKED_AT = 200
# How much of a panel's width there is for no letter of a sentence, and how wide a letter is.
_MARGIN_PX = 70.0
_LETTER_PX = 6.0
# What cleaning drops, of one and of many.
_CLEANED = (
    ("n_isolated", ("loose vertex", "loose vertices")),
    ("n_degenerate", ("face of fewer than 3 corners", "faces of fewer than 3 corners")),
    ("n_duplicates", ("face that is there twice", "faces that are there twice")),
    ("n_doubled", ("triangle back to back with another", "triangles back to back with others")),
)
# What stands in an empty field.
_PLACEHOLDERS = {"density": "Group or Color"}
_ROWS = (
    ("Faces", "n_faces", "{:,}"),
    ("Quads", "quads_pct", "{:.0f} %"),
    ("Irregular vertices", "irregular_pct", "{:.1f} %"),
    ("Flow deviation", "alignment_deg", "{:.1f}°"),
    ("On closed loops", "loop_edges_pct", "{:.0f} %"),
    ("In spirals", "spiral_pct", "{:.0f} %"),
    ("Edge variation", "edge_cv", "{:.2f}"),
    ("Mean distance", "chamfer_pct", "{:.3f} % of size"),
    ("Largest distance", "hausdorff_pct", "{:.2f} % of size"),
)


class VIEW3D_PT_orbflow(bpy.types.Panel):
    """Settings, the button, and the score of the last run."""

    bl_label = "Orbflow"
    bl_category = "Orbflow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        """Draws the panel."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in settings.NAMES:
            layout.prop(context.scene.orbflow, name, placeholder=_PLACEHOLDERS.get(name, ""))
        _button(layout, context)
        column = layout.column(heading="Show")
        column.prop(context.scene.orbflow, "show_irregular")
        last = _last_of(context.object)
        crosses = column.row()
        crosses.active = last is not None and len(last.crosses) > 0
        crosses.prop(context.scene.orbflow, "show_crosses")
        if last:
            _draw_score(layout.box().column(align=True), last.report, _n_letters(context))


def draw_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """The entry in the Object menu; operators in no menu are not found by searching."""
    menu.layout.separator()
    _button(menu.layout, context)


def _button(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    button = layout.operator("object.orbflow_remesh", icon="MOD_REMESH")
    settings.copy(context.scene.orbflow, button)


def remember(thing: bpy.types.Object, report: dict[str, Any], crosses: NDArray[np.float32]) -> None:
    """Keeps what the panel and the overlay show of the run that made an object's mesh."""
    key = _print_of(thing.data)
    _last.pop(key, None)
    _last[key] = _Last(report, crosses)
    while len(_last) > _N_KEPT:
        del _last[next(iter(_last))]


def last_report(name: str) -> dict[str, Any] | None:
    """The report of the run in this session that made an object what it is now."""
    last = _last_of(bpy.data.objects.get(name))
    return last and last.report


def last_crosses(thing: bpy.types.Object) -> NDArray[np.float32] | None:
    """The crosses of the field of what an object is now, as places and arms (N, 3, 3)."""
    last = _last_of(thing)
    return last and last.crosses


def _last_of(thing: bpy.types.Object | None) -> _Last | None:
    """What is kept of what an object is now: none where its mesh was edited since."""
    if thing is None or thing.type != "MESH":
        return None
    return _last.get(_print_of(thing.data))


def _print_of(mesh: bpy.types.Mesh) -> _Print:
    n = len(mesh.vertices)
    looked_at = (mesh.vertices[i].co for i in range(0, n, n // _N_LOOKED_AT + 1))
    return n, len(mesh.polygons), tuple(x for place in looked_at for x in place)


def redraw_status_bar(context: bpy.types.Context) -> None:
    """Redraws the status bar, which is in no screen's list of areas: setting its text does it."""
    context.workspace.status_text_set_internal("")


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Draws the panel anew: without an undo step Blender does not, and a grey button stays grey."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def sentence(reports: list[dict[str, Any]]) -> str:
    """A run in one line; Blender joins lines without a space."""
    before, after = (
        sum(report[side]["n_faces"] for report in reports) for side in ("input", "output")
    )
    meshes = f"{len(reports)} meshes: " if len(reports) > 1 else ""
    told = "".join(f"; {each}" for each in [*_applied(reports), *exceptions(reports)])
    return f"{meshes}{before:,} faces became {after:,}{told}"


def _applied(reports: list[dict[str, Any]]) -> list[str]:
    """Which modifiers went into the result, and which make it whole."""
    names = list(dict.fromkeys(name for report in reports for name in report["modifiers"]))
    halves = sorted({report["half"] for report in reports if report["half"]})
    told = [f"modifiers applied: {', '.join(names)}"] if names else []
    return told + [f"half is kept: modifier {name} makes it whole" for name in halves]


def exceptions(reports: list[dict[str, Any]]) -> list[str]:
    """In words what is otherwise than was asked for."""
    lost = ", ".join(sorted({each for report in reports for each in report["lost"]}))
    told = [_without_flow(reports), _without_mirror(reports), _without_marks(reports)]
    told += [_without_network(reports), f"not carried over: {lost}" if lost else ""]
    told += [_cleaned(reports)]
    return [each for each in told if each]


def _cleaned(reports: list[dict[str, Any]]) -> str:
    """What cleaning has dropped before the run."""
    counts = [
        (sum(report["clean"][name] for report in reports), *words) for name, words in _CLEANED
    ]
    dropped = ", ".join(f"{n:,} {many if n > 1 else one}" for n, one, many in counts if n)
    return f"left out: {dropped}" if dropped else ""


def _without_marks(reports: list[dict[str, Any]]) -> str:
    """Which share of what was left on edges is on no edge of the result."""
    shares = [report["carried"]["length_pct"] for report in reports if report["carried"]]
    gone = 100 - min(shares, default=100)
    # Chords are shorter than what they stand for.
    return f"{gone:.0f} % of the marks of edges are gone: no edge lies there" if gone > 5 else ""


def _without_flow(reports: list[dict[str, Any]]) -> str:
    """Which parts got the quad sphere because their quads could not flow, and why the first."""
    return _refused(reports, "flow", "quad sphere instead of flow")


def _without_mirror(reports: list[dict[str, Any]]) -> str:
    """Which parts could not be made symmetric, and why the first."""
    return _refused(reports, "mirrored", "not symmetric")


def _without_network(reports: list[dict[str, Any]]) -> str:
    """Which parts got the solver's map because a proposal was of no use."""
    parts = _parts(reports)
    given_up = [part for part in parts if part["embedding"]["repair"]["fell_back_to_solver"]]
    if not given_up:
        return ""
    of = _of_parts(given_up, parts)
    return f"solver instead of network{of}: the proposal was beyond repair"


def _refused(reports: list[dict[str, Any]], what: str, words: str) -> str:
    """In how many parts something was refused, and why in the first; empty where in none."""
    parts = _parts(reports)
    refused = [part for part in parts if (part[what] or {}).get("status") == "refused"]
    if not refused:
        return ""
    return f"{words}{_of_parts(refused, parts)}: {refused[0][what]['reason']}"


def _parts(reports: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [part for report in reports for part in report["parts"]]


def _of_parts(some: list[dict[str, Any]], parts: list[dict[str, Any]]) -> str:
    return f" in {len(some)} of {len(parts)} parts" if len(parts) > 1 else ""


def rows(report: dict[str, Any]) -> list[tuple[str, str]]:
    """The score as words and values; what does not apply is left out."""
    figures = report["output"] | (report["score"] or {})
    score = [
        (words, form.format(figures[name]))
        for words, name, form in _ROWS
        if figures.get(name) is not None
    ]
    return _symmetry(report) + score + _proposal(report["embedding"])


def _symmetry(report: dict[str, Any]) -> list[tuple[str, str]]:
    """The axis across which the two sides are each other's image, if they are."""
    told = [(part["mirrored"] or {}).get("status") for part in report["parts"]]
    if not {"used", "image"} & set(told):
        return []
    return [("Symmetric across", "XYZ"[report["plane"]["axis"]])]


def _proposal(embedding: dict[str, Any]) -> list[tuple[str, str]]:
    """What the network proposed and what it took to mend it; nothing with the solver alone."""
    if embedding["weights"] is None:
        return []
    proposal = embedding["proposal"]
    relaxed = embedding["n_relaxations"] - proposal["n_relaxations"]
    moved, n_vertices = embedding["repair"]["n_moved"], proposal["n_vertices"]
    weights = embedding["weights"]
    return [
        ("Proposed by", embedding["predictor"]),
        ("Weights", "shipped" if weights["shipped"] else weights["sum"]),
        ("Folds proposed", f"{proposal['folds_pct']:.1f} %"),
        ("Distortion", f"{proposal['energy']:.2f} → {embedding['energy']:.2f}"),
        ("Vertices repaired", f"{moved:,} of {n_vertices:,}"),
        ("Relaxations", f"{relaxed:,}"),
    ]


def _n_letters(context: bpy.types.Context) -> int:
    """How many letters fit beside the icon in the panel as wide as it is."""
    scale = context.preferences.system.ui_scale
    return max(10, int((context.region.width / scale - _MARGIN_PX) / _LETTER_PX))


def _draw_score(column: bpy.types.UILayout, report: dict[str, Any], n_letters: int) -> None:
    for text in [*_applied([report]), *exceptions([report])]:
        for i, line in enumerate(textwrap.wrap(text, n_letters)):
            column.label(text=line, icon="BLANK1" if i else "INFO")
    for words, value in rows(report):
        row = column.row()
        row.label(text=words)
        row.label(text=value)
