# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can set; the operator and the panel share one list of properties."""

# pyright: reportInvalidTypeForm=false
import math
from typing import Any

import bpy
import orbflow_native
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from . import choices, named, preferences
from .translations import CONTEXT, n_

# How many crosses of the field a result brings: enough to read the field, a tenth of a megabyte.
N_CROSSES = 4000


def _share(name: str, description: str) -> Any:  # noqa: ANN401 - a property that is made later
    return FloatProperty(
        name=name, description=description, default=0.5, min=0.0, max=1.0, subtype="FACTOR"
    )


class Settings:
    """The properties themselves; names, defaults and ranges are those of the core."""

    size: EnumProperty(
        name="Size",
        description="How the number of faces is given",
        items=choices.SIZES,
        default="FACES",
    )
    faces: IntProperty(
        name="Faces",
        description="How many faces the result has, within a few percent",
        default=2000,
        min=orbflow_native.MIN_FACES,
        max=orbflow_native.MAX_FACES,
        soft_min=100,
        soft_max=100_000,
    )
    ratio: FloatProperty(
        name="Ratio",
        description="How many faces the result has, as a share of those of the object",
        default=25.0,
        min=0.001,
        max=10_000.0,
        soft_max=100.0,
        subtype="PERCENTAGE",
    )
    edge_length: FloatProperty(
        name="Edge Length",
        description="How long edges are in the scene, on the whole",
        default=0.1,
        min=1e-6,
        soft_max=10.0,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    kind: EnumProperty(name="Kind", description="What the faces are", items=choices.KINDS)
    primitive: EnumProperty(
        name="Primitive",
        description="The sphere that is deformed into the mesh",
        items=choices.PRIMITIVES,
    )
    follow_shape: _share(
        "Follow Shape", "Flowing quads: 0 makes smooth loops, 1 lays edges along the curvature"
    )
    adaptivity: _share(
        "Adaptivity", "Flowing quads: 0 makes all of one size, 1 much smaller ones where it bends"
    )
    own_quads: BoolProperty(
        name="Own Quads",
        description=(
            "Keep the mesh's own quads where they are good, cut into finer ones or without some "
            "strips: its loops stay. Off: new quads are found"
        ),
        default=True,
    )
    density: named.density()
    guides: named.guides()
    guide_strength: EnumProperty(
        name="Guide Strength",
        description=(
            "How edges heed a guide whose name, or that of its layer or material, does not begin "
            "with Follow or Exact"
        ),
        items=choices.STRENGTHS,
    )
    keep_faces: named.keep()
    sharp_angle: FloatProperty(
        name="Sharp Angle",
        description=(
            "Edges at which the surface turns by more than this get edges of the result along them"
        ),
        default=math.radians(40.0),
        min=0.0,
        max=math.pi,
        subtype="ANGLE",
    )
    marked_edges: EnumProperty(
        name="Marked Edges",
        description="Which marks of edges get edges of the result along them, however flat",
        items=choices.MARKS,
        options={"ENUM_FLAG"},
        default={"SHARP", "CREASE"},
    )
    mirror: EnumProperty(
        name="Mirror",
        description="Flowing quads: makes one side the exact image of the other",
        items=choices.MIRRORS,
        default="AUTO",
    )
    use_modifiers: BoolProperty(
        name="Apply Modifiers",
        translation_context=CONTEXT,
        description=(
            "Remesh what is seen: modifiers that make geometry, such as Mirror and Subdivision, go "
            "into the result and leave the stack; those that follow a pose or time stay"
        ),
        default=True,
    )
    mirror_modifier: EnumProperty(
        name="Mirror Modifier",
        description="What becomes of a half that a Mirror modifier makes whole",
        items=choices.MIRROR_MODIFIERS,
        default="WHOLE",
    )
    small_parts: EnumProperty(
        name="Small Parts",
        description="What becomes of parts that are too small for their share of the faces",
        items=choices.SMALL_PARTS,
    )
    small_size: FloatProperty(
        name="Small Below",
        description=(
            "Parts that are smaller than this share of the whole mesh are small too; 0: only those "
            "that are too small for the faces that they would get"
        ),
        default=0.0,
        min=0.0,
        max=100.0,
        subtype="PERCENTAGE",
    )
    borders: EnumProperty(
        name="Borders",
        description="What becomes of open edges: those around holes, and of sheets as of cloth",
        items=choices.BORDERS,
    )
    fill_size: FloatProperty(
        name="Fill Up To",
        description=(
            "Borders that are longer than this share of the whole mesh's size stay open; 0: all "
            "are filled"
        ),
        default=0.0,
        min=0.0,
        max=1000.0,
        soft_max=100.0,
        subtype="PERCENTAGE",
    )
    handles: EnumProperty(
        name="Handles",
        translation_context=CONTEXT,
        description="What becomes of handles, as of a cup, and of holes that go through",
        items=choices.HANDLES,
    )
    seal_size: FloatProperty(
        name="Seal Up To",
        description=(
            "Handles stay round which a tight loop is longer than this share of the whole mesh's "
            "size"
        ),
        default=1.0,
        min=0.0,
        max=1000.0,
        soft_max=100.0,
        subtype="PERCENTAGE",
    )
    solid: BoolProperty(
        name="Make Solid",
        description=(
            "Make everything one closed surface first: parts that pass through each other, double "
            "walls, cavities and open pieces"
        ),
        default=False,
    )
    solid_detail: FloatProperty(
        name="Detail",
        description=(
            "The size of the cells that make it solid: walls and gaps that are thinner than this "
            "share of the mesh's size are lost, smaller cells take more time and memory"
        ),
        default=0.4,
        min=0.02,
        max=5.0,
        precision=2,
        step=1,
        subtype="PERCENTAGE",
    )
    inner: EnumProperty(
        name="Inner Parts",
        description="What becomes of closed parts that lie wholly inside another",
        items=choices.INNER,
    )
    use_weld: BoolProperty(
        name="Weld Seams",
        description="Close gaps between open edges that lie on each other, as imported seams do",
        default=True,
    )
    weld: FloatProperty(
        name="Weld Within",
        description="Open edges that are no farther apart than this share of the mesh's size",
        default=0.001,
        min=0.0,
        max=1.0,
        precision=4,
        step=0.01,
        subtype="PERCENTAGE",
    )
    keep_original: BoolProperty(
        name="Original",
        description=(
            "Leave a hidden copy of the object as it was beside the result, which keeps the name "
            "and all that points at it"
        ),
        default=False,
    )
    weights_limit: IntProperty(
        name="Weights per Vertex",
        description=(
            "How many bones move a vertex at most; many engines take 4. 0: as many as before"
        ),
        default=0,
        min=0,
        soft_max=8,
    )
    predictor: EnumProperty(
        name="Predictor",
        description="Who proposes where each vertex lies on the sphere",
        items=choices.PREDICTORS,
        default="AUTO",
    )
    threads: IntProperty(
        name="Threads",
        description="How many threads to use; 0 uses all. The result is the same for any number",
        default=0,
        min=0,
        soft_max=64,
    )
    seed: IntProperty(
        name="Seed",
        description="Another seed places the points of the adaptive primitive differently",
        default=0,
        min=0,
    )


# Which settings only quads that flow heed.
_OF_FLOW = {
    *("follow_shape", "adaptivity", "own_quads"),
    *("density", "mirror", "guides", "guide_strength"),
}
NAMES = tuple(Settings.__annotations__)
# Settings that say how many faces an object gets.
_OF_SIZE = {"size", "ratio", "edge_length"}
# Settings that say what of an object is read.
_OF_MESH = {"density", "keep_faces", "marked_edges", "mirror_modifier", "use_modifiers"}
# Settings that say what is read beside an object.
_BESIDE = {"guides", "guide_strength"}
# Settings that say what is written.
_OF_RESULT = {"keep_original", "weights_limit"}
# Settings that are one with another in the core.
_IN_OTHERS = {"use_weld"}
_APART = _OF_SIZE | _OF_MESH | _BESIDE | _OF_RESULT | _IN_OTHERS
# What is set by each value of `size`.
_BY_SIZE = {"FACES": "faces", "RATIO": "ratio", "EDGE": "edge_length"}
#: The settings beside the button, and those in the sections of the panel below it.
FIRST = ("kind", "size", "faces", "ratio", "edge_length")
SECTIONS = {
    n_("Shape"): ("follow_shape", "adaptivity", "sharp_angle", "own_quads"),
    n_("Symmetry"): ("mirror", "mirror_modifier"),
    n_("Guides and Density"): ("guides", "guide_strength", "marked_edges", "density"),
    n_("Keep"): (
        "keep_faces",
        *("borders", "fill_size", "handles", "seal_size", "solid", "solid_detail", "inner"),
        *("small_parts", "small_size"),
        *("use_modifiers", "use_weld", "weld", "keep_original", "weights_limit"),
    ),
    n_("Advanced"): ("primitive", "predictor", "threads", "seed"),
}


class OrbflowSettings(bpy.types.PropertyGroup, Settings):
    """The settings that the panel shows, saved with the scene."""

    # Without a step of its own, undo of a run would empty it.
    density: named.density(update=named.push_undo)
    guides: named.guides(update=named.push_undo)
    keep_faces: named.keep(update=named.push_undo)
    show_irregular: BoolProperty(
        name="Irregular Vertices",
        description=(
            "Mark the vertices of the active mesh where the grid breaks: blue where one edge is "
            "missing, red where there is one too many, black otherwise"
        ),
        default=False,
    )
    show_size: BoolProperty(
        name="Size of Faces",
        description=(
            "Lay patches of faces on the active mesh, as large as they will be: by the number that "
            "is asked for and by Density, from blue (large) to red (small), not by Adaptivity"
        ),
        default=False,
    )
    show_crosses: BoolProperty(
        name="Field Crosses",
        description=(
            "Show the field that the quads of the active mesh follow, as found by the last run in "
            "this session"
        ),
        default=False,
    )


def for_core(source: Settings) -> dict[str, Any]:
    """The settings as keywords of `orbflow_native.remesh`; others say what is read or written."""
    names = [name for name in NAMES if name not in _APART]
    values = {name: _value(getattr(source, name)) for name in names}
    return values | {
        "sharp_angle": math.degrees(source.sharp_angle),
        # Blender keeps fewer digits; those beyond are not what was asked for.
        "weld": float(f"{source.weld / 100:.6g}") if source.use_weld else None,
        "fill_size": source.fill_size or None,
        "solid_detail": float(f"{source.solid_detail:.6g}"),
        "mirror": source.mirror.lower(),
        "predictor": source.predictor.lower(),
        "weights": preferences.weights() if source.predictor != "SOLVER" else None,
        "n_crosses": N_CROSSES,
    }


def is_of_use(source: Settings, name: str) -> bool:
    """Whether a setting changes anything with the others as they are."""
    if name in _OF_FLOW:
        flows = source.kind == "QUADS" and source.primitive in {"AUTO", "FLOW"}
        return flows and (name != "guide_strength" or bool(source.guides))
    if name == "mirror_modifier":
        return source.use_modifiers
    if name == "fill_size":
        return source.borders == "FILL"
    if name == "seal_size":
        return source.handles == "SEAL"
    if name == "solid_detail":
        return source.solid
    if name == "inner":
        return not source.solid
    return name != "weld" or source.use_weld


def is_shown(source: Settings, name: str) -> bool:
    """Whether a setting has a row: of those for the number of faces the one that is used."""
    return name not in _BY_SIZE.values() or name == _BY_SIZE[source.size]


def copy(source: Settings, target: object) -> None:
    """Gives `target`, the properties of an operator or a scene, the settings of `source`."""
    with named.unnoticed():
        for name in NAMES:
            setattr(target, name, getattr(source, name))


def _value(value: str | float) -> str | float | None:
    if value == "AUTO":
        return None
    return value.lower().replace("_", "-") if isinstance(value, str) else value
