"""A hand on mouse and keyboard, and an eye: events sent to Blender's window, pictures of it.

Whatever takes time is a generator of seconds to wait: Blender works meanwhile.
"""

import re
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

Waits = Iterator[float]
Pixels = NDArray[np.uint8]

# What a frame of the window takes at most; drawn by software it takes some of them.
FRAME_S = 0.15
# So far apart places are looked at for a button; rows are 20 pixels high and more.
_STEP_PX = 8
# Beside each other a row has a button in the middle, and some have one at the right.
_ACROSS = (0.55, 0.76)
# What Blender takes to see which button the mouse is over.
_LOOK_S = 0.03
_HELD = {"ctrl": "LEFT_CTRL", "shift": "LEFT_SHIFT", "alt": "LEFT_ALT"}


@dataclass(frozen=True)
class Place:
    """A point of the window, in pixels from its lower left corner."""

    x: int
    y: int


@dataclass(frozen=True)
class Button:
    """What a button stands for, as Python would say it, and where it is."""

    name: str
    place: Place


def window() -> bpy.types.Window:
    """The only window; another file brings another one."""
    return bpy.context.window_manager.windows[0]


def view() -> bpy.types.Area:
    """The 3D view."""
    return next(area for area in window().screen.areas if area.type == "VIEW_3D")


def region(kind: str = "WINDOW") -> bpy.types.Region:
    """A region of the 3D view."""
    return next(each for each in view().regions if each.type == kind)


def middle(kind: str = "WINDOW", across: float = 0.5, up: float = 0.5) -> Place:
    """A place in a region of the 3D view, by shares of its width and height."""
    place = region(kind)
    return Place(int(place.x + across * place.width), int(place.y + up * place.height))


def send(kind: str, value: str, place: Place, **more: object) -> None:
    """Sends one event."""
    window().event_simulate(type=kind, value=value, x=place.x, y=place.y, **more)


def move(place: Place) -> Waits:
    """Moves the mouse."""
    send("MOUSEMOVE", "NOTHING", place)
    yield FRAME_S


def click(place: Place) -> Waits:
    """Moves the mouse somewhere and clicks."""
    yield from move(place)
    send("LEFTMOUSE", "PRESS", place)
    yield FRAME_S
    send("LEFTMOUSE", "RELEASE", place)
    yield 2 * FRAME_S


def drag(path: list[Place], *, held: str = "") -> Waits:
    """Moves along a path with the left button pressed."""
    keys = {held: True} if held else {}
    yield from move(path[0])
    send("LEFTMOUSE", "PRESS", path[0], **keys)
    yield FRAME_S
    for place in path:
        send("MOUSEMOVE", "NOTHING", place, **keys)
        yield 0.03
    send("LEFTMOUSE", "RELEASE", path[-1], **keys)
    yield 2 * FRAME_S


def press(key: str, place: Place | None = None, *held: str) -> Waits:
    """Presses a key over a place, by default the middle of the 3D view."""
    place = place or middle()
    yield from move(place)
    keys = dict.fromkeys(held, True)
    for each in held:
        send(_HELD[each], "PRESS", place, **keys)
    send(key, "PRESS", place, **keys)
    yield FRAME_S
    send(key, "RELEASE", place, **keys)
    for each in held:
        send(_HELD[each], "RELEASE", place)
    yield 2 * FRAME_S


def write(text: str, place: Place) -> Waits:
    """Types letters and spaces."""
    for letter in text:
        kind = "SPACE" if letter == " " else letter.upper()
        send(kind, "PRESS", place, unicode=letter)
        yield 0.05
        send(kind, "RELEASE", place)
        yield 0.05


def search(text: str) -> Waits:
    """Finds an entry of the menus by F3 and takes the first that is found."""
    place = middle()
    yield from press("F3", place)
    yield from write(text, place)
    yield 4 * FRAME_S
    yield from press("RET", place)


def undo() -> Waits:
    """Presses Ctrl-Z over the view."""
    yield from press("Z", None, "ctrl")


def redo() -> Waits:
    """Presses Ctrl-Shift-Z over the view."""
    yield from press("Z", None, "ctrl", "shift")


def until(holds: Callable[[], bool], limit_s: float, what: str) -> Waits:
    """Waits until something holds."""
    for _ in range(int(limit_s / FRAME_S)):
        if holds():
            return
        yield FRAME_S
    raise AssertionError(f"after {limit_s:g} s still not: {what}")


def button_under(place: bpy.types.Region) -> str:
    """What the button stands for over which the mouse is: a call, a path, or nothing."""
    manager, known = bpy.context.window_manager, bpy.ops.ui
    manager.clipboard = ""
    with bpy.context.temp_override(window=window(), area=view(), region=place):
        if known.copy_python_command_button.poll():
            known.copy_python_command_button()
        elif known.copy_data_path_button.poll():
            known.copy_data_path_button(full_path=True)
    return manager.clipboard


def buttons(found: list[Button], kind: str = "UI", wanted: str = "") -> Waits:
    """Looks for the buttons of a region by moving the mouse over it, and adds them to a list.

    It ends at the first whose name has a pattern, if one is given.
    """
    place = region(kind)
    seen: set[str] = set()
    for y in range(place.y + place.height - 6, place.y, -_STEP_PX):
        for across in _ACROSS:
            at = Place(int(place.x + across * place.width), y)
            send("MOUSEMOVE", "NOTHING", at)
            yield _LOOK_S
            name = button_under(place)
            if name and name not in seen:
                seen.add(name)
                found.append(Button(name, Place(at.x, at.y - _STEP_PX // 2)))
            if wanted and re.search(wanted, name):
                return


def push(wanted: str, kind: str = "UI") -> Waits:
    """Clicks on the first button of a region whose name has a pattern."""
    found: list[Button] = []
    yield from buttons(found, kind, wanted)
    fitting = [each for each in found if re.search(wanted, each.name)]
    assert fitting, f"no button for {wanted}; there are: {[each.name for each in found]}"
    yield from click(fitting[0].place)


def told() -> list[str]:
    """What Blender has told so far, as its Info editor lists it."""
    area = next(
        each for each in window().screen.areas if each.type not in {"VIEW_3D", "PREFERENCES"}
    )
    kind, area.type = area.type, "INFO"
    place = next(each for each in area.regions if each.type == "WINDOW")
    with bpy.context.temp_override(window=window(), area=area, region=place):
        bpy.ops.info.select_all(action="SELECT")
        bpy.ops.info.report_copy()
        bpy.ops.info.select_all(action="DESELECT")
    area.type = kind
    return bpy.context.window_manager.clipboard.splitlines()


def picture(path: Path | None = None) -> Pixels:
    """What is on the screen, (height, width, 3), from the upper left; kept in a file if asked."""
    command = ["import", "-window", "root", "-depth", "8", "ppm:-"]
    data = subprocess.run(command, check=True, capture_output=True).stdout
    if path:
        subprocess.run(["convert", "ppm:-", str(path)], input=data, check=True)
    _, size, _, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 3)


def of_view(pixels: Pixels) -> Pixels:
    """The pixels of the 3D view beside the sidebar and the toolbar, which lie over it."""
    whole, left, right = region("WINDOW"), region("TOOLS"), region("UI")
    top = len(pixels) - whole.y - whole.height
    return pixels[top : top + whole.height, left.x + left.width : right.x]
