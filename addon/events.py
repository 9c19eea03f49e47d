# SPDX-License-Identifier: GPL-3.0-or-later
"""Which events Blender may have while a run is at work: all but those that edit what it works on.

The modal operator hears every event of its window first. Over a 3D view only what looks around
passes; other editors, the sidebar, headers and saving go on as ever.
"""

import bpy

# Keys over a 3D view that look around, or open what is not the mesh's.
_LOOKS = ("HOME", "N", "T", "ACCENT_GRAVE")
_LOOKS_BY_NAME = (
    *("INBETWEEN_MOUSEMOVE", "MIDDLEMOUSE", "MOUSEMOVE", "NDOF", "TIMER", "TRACKPAD", "WHEEL"),
    "WINDOW_DEACTIVATE",
)
# Regions of a 3D view in which nothing edits a mesh. Not among them: the view itself, and the
# panel of the last operator, which would undo it and run it again.
_SAFE_REGIONS = {"ASSET_SHELF", "ASSET_SHELF_HEADER", "HEADER", "TOOLS", "TOOL_HEADER", "UI"}


def passes(event: bpy.types.Event, window: bpy.types.Window) -> bool:
    """Whether Blender may have an event of a window while a run is at work."""
    if event.ctrl and event.type in {"Z", "Y"}:
        return False
    if _looks_around(event) or (event.ctrl and event.type == "S"):
        return True
    return not _is_over_view(event, window)


def wake_button(event: bpy.types.Event, window: bpy.types.Window) -> None:
    """Lets Blender find a new button under a mouse that rests: it looks where the mouse moves."""
    if any(
        region.type == "UI" and _holds(region, event)
        for area in window.screen.areas
        if area.type == "VIEW_3D"
        for region in area.regions
    ):
        window.cursor_warp(event.mouse_x, event.mouse_y)


def _looks_around(event: bpy.types.Event) -> bool:
    """Whether an event looks around, or is a timer: all operators at work hear each other's."""
    if event.type.startswith("NUMPAD"):
        # With these keys it hides objects or sets the camera.
        return not (event.ctrl or event.alt)
    if event.type == "LEFTMOUSE":
        return event.alt
    if event.type in _LOOKS:
        return not (event.ctrl or event.alt or event.shift)
    return event.type.startswith(_LOOKS_BY_NAME)


def _is_over_view(event: bpy.types.Event, window: bpy.types.Window) -> bool:
    """Whether the mouse is where an event may edit a mesh."""
    for area in window.screen.areas:
        if area.type == "VIEW_3D" and _holds(area, event):
            return not any(
                region.type in _SAFE_REGIONS and _holds(region, event) for region in area.regions
            )
    return False


def _holds(place: bpy.types.Area | bpy.types.Region, event: bpy.types.Event) -> bool:
    x, y = event.mouse_x - place.x, event.mouse_y - place.y
    return 0 <= x < place.width and 0 <= y < place.height
