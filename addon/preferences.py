# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for every file: where the weights of the network are."""

import bpy
from bpy.props import StringProperty

NO_WEIGHTS = (
    "the network needs weights: name a file that `orbflow train` wrote in the preferences of the "
    "add-on"
)


class OrbflowPreferences(bpy.types.AddonPreferences):
    """The preferences of the extension."""

    bl_idname = __package__

    weights: StringProperty(  # pyright: ignore[reportInvalidTypeForm]
        name="Network Weights",
        description=(
            "The file of weights that the predictor Network uses, as `orbflow train` writes it. It "
            "holds numbers; nothing in it is executed"
        ),
        subtype="FILE_PATH",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Draws the preferences."""
        self.layout.prop(self, "weights")


def weights() -> str | None:
    """The path of the file of weights; none where none is chosen."""
    path = bpy.context.preferences.addons[__package__].preferences.weights
    return bpy.path.abspath(path) if path else None
