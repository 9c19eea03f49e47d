# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for every file: other weights of the network."""

import bpy
from bpy.props import StringProperty


class OrbflowPreferences(bpy.types.AddonPreferences):
    """The preferences of the extension."""

    bl_idname = __package__

    weights: StringProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Network Weights",
        description=(
            "A file of weights for the network, as `orbflow train` writes it; empty for "
            "those that come with the add-on. It holds numbers; nothing in it is executed"
        ),
        subtype="FILE_PATH",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Draws the preferences."""
        self.layout.prop(self, "weights")


def weights() -> str | None:
    """The path of the file of weights; none for those that come with the add-on."""
    path = bpy.context.preferences.addons[__package__].preferences.weights
    return bpy.path.abspath(path) if path else None
