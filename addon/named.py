# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that name something of the file, chosen from a list of what there is."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
from bpy.props import StringProperty

from . import density as densities
from . import guides as guidance
from . import regions

_Names = list[tuple[str, str]]

# While an operator sets the panel's settings there is no undo step but its own.
_unnoticed: list[bool] = []


def density(**more: object) -> Any:  # noqa: ANN401 - a property that is made later
    """The vertex group or color that says where quads are small."""
    return StringProperty(
        name="Density",
        description=(
            "Flowing quads: vertex group or color attribute that says where they are small: most "
            "where it is 1 or white, largest where it is 0 or black; the count stays"
        ),
        search=_densities,
        **more,
    )


def guides(**more: object) -> Any:  # noqa: ANN401
    """What holds the lines that edges follow."""
    return StringProperty(
        name="Guides",
        description=(
            "Flowing quads: collection or object whose curves, Grease Pencil strokes or loose "
            "edges the edges of the result follow, or the annotation; what is hidden guides nothing"
        ),
        search=_holders,
        **more,
    )


def keep(**more: object) -> Any:  # noqa: ANN401
    """The faces that are left as they are."""
    return StringProperty(
        name="Keep Faces",
        description=(
            "Vertex group, face set or face attribute whose faces are left as they are; the new "
            "faces join them without a gap"
        ),
        search=_regions,
        **more,
    )


def push_undo(_settings: object, _context: bpy.types.Context) -> None:
    """Makes an undo step, as Blender does for all fields but those that search."""
    if not (bpy.app.background or _unnoticed) and bpy.ops.ed.undo_push.poll():
        bpy.ops.ed.undo_push(message="Orbflow Setting")


@contextmanager
def unnoticed() -> Iterator[None]:
    """In the block settings make no undo step."""
    _unnoticed.append(True)
    try:
        yield
    finally:
        _unnoticed.clear()


def _densities(_settings: object, context: bpy.types.Context, _typed: str) -> _Names:
    return densities.names(context.object)


def _holders(_settings: object, context: bpy.types.Context, _typed: str) -> _Names:
    return guidance.names(context)


def _regions(_settings: object, context: bpy.types.Context, _typed: str) -> _Names:
    return regions.names(context.object)
