# SPDX-License-Identifier: GPL-3.0-or-later
"""*Online Manual* in the menu of the right button: the page that comes with the add-on.

It is `docs/blender.md` of the same version, made HTML by `scripts/manual.py`, so that it is there
without a network.
"""

from pathlib import Path

import bpy

PAGE = Path(__file__).parent / "manual.html"
#: The anchors of headings, and which settings each is about.
OF_SETTINGS = {
    "size": ("size", "faces", "ratio", "edge_length", "kind"),
    "shape": ("follow_shape", "adaptivity", "sharp_angle", "own_quads"),
    "symmetry": ("mirror",),
    "density": ("density",),
    "guides": ("guides", "guide_strength", "marked_edges"),
    "keeping-faces": ("keep_faces",),
    "borders-and-handles": ("borders", "fill_size", "handles", "seal_size"),
    "making-solid": ("solid", "solid_detail", "inner"),
    "small-parts-and-seams": ("small_parts", "small_size", "use_weld", "weld"),
    "modifiers": ("use_modifiers", "mirror_modifier"),
    "detail-and-normal-maps": ("keep_original",),
    "what-of-the-artists-data-comes-over": ("weights_limit",),
    "advanced": ("primitive", "predictor", "threads", "seed"),
    "before-and-after-size-of-faces": ("show_size",),
    "what-the-panel-says-of-a-result": ("show_irregular", "show_crosses"),
}
#: The same of operators.
OF_OPERATORS = {
    "remeshing": ("remesh", "cancel"),
    "guides": ("draw_guide", "draw_guides", "erase_guide"),
    "density": ("paint_density",),
    "detail-and-normal-maps": ("bake_detail", "bake_normal_map"),
    "before-and-after-size-of-faces": ("before",),
    "what-the-panel-says-of-a-result": ("show",),
}
_OTHERS = (
    ("bpy.types.object.orbflow_original", "detail-and-normal-maps"),
    ("bpy.types.windowmanager.orbflow_before", "before-and-after-size-of-faces"),
    ("bpy.types.orbflowpreferences.weights", "advanced"),
)


def links() -> tuple[str, tuple[tuple[str, str], ...]]:
    """The address of the page, and what leads where on it, as Blender asks for them."""
    settings = [
        (f"bpy.types.orbflowsettings.{name}", anchor)
        for anchor, names in OF_SETTINGS.items()
        for name in names
    ]
    operators = [
        (f"bpy.ops.object.orbflow_{name}", anchor)
        for anchor, names in OF_OPERATORS.items()
        for name in names
    ]
    return f"{PAGE.as_uri()}#", (*settings, *operators, *_OTHERS)


def register() -> None:
    """Gives Blender the links."""
    bpy.utils.register_manual_map(links)


def unregister() -> None:
    """Takes them away."""
    bpy.utils.unregister_manual_map(links)
