"""What lies in the window during a check, and what is asked about it."""

import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import bmesh
import bpy
import hand
import numpy as np
from hand import Pixels, Waits, until

OUT = Path(__file__).resolve().parent / "out"
MODULE = "bl_ext.user_default.orbflow"
# As long as a run of a few hundred faces may take on a slow machine.
_RUN_S = 90.0
# How far the first title of a section lies below the number of faces, and each below the one above.
_TO_TITLES_PX, _TITLE_PX = 57, 25


@dataclass(frozen=True)
class State:
    """What a run changes of an object, and undo brings back."""

    n_faces: int
    mesh: str
    places: bytes


def addon(name: str) -> ModuleType:
    """A module of the add-on."""
    return sys.modules[f"{MODULE}.{name}"]


def prepare() -> Waits:
    """Starts with a file without objects, and with the sidebar open at our tab."""
    while hand.window().modal_operators:
        yield from hand.press("ESC")
    bpy.ops.wm.read_homefile(use_empty=False)
    yield 1.0
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    hand.view().spaces[0].show_region_ui = True
    yield 0.5
    if MODULE in sys.modules:
        hand.region("UI").active_panel_category = "Orbflow"
        yield 0.5


def start_with(make: Callable[[], None]) -> Waits:
    """Puts objects into an empty scene, all in view, as the state that undo goes back to."""
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    bpy.context.scene.orbflow.faces = 600
    with in_view():
        make()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    bpy.ops.ed.undo_push(message="start")
    yield 1.0


def in_view() -> AbstractContextManager[None]:
    """The context of the 3D view, which operators ask for."""
    return bpy.context.temp_override(
        window=hand.window(), area=hand.view(), region=hand.region("WINDOW")
    )


def ball() -> None:
    """A ball of many faces."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=64)
    bpy.context.object.name = bpy.context.object.data.name = "Ball"


def ball_and_strip() -> None:
    """A ball, and a strip with one twist, of which inside and outside cannot be told apart."""
    n = 40
    turns = np.linspace(0, 2 * np.pi, n, endpoint=False)
    places = [
        (
            (2 + s * np.cos(t / 2)) * np.cos(t) + 4,
            (2 + s * np.cos(t / 2)) * np.sin(t),
            s * np.sin(t / 2),
        )
        for t in turns
        for s in (-0.5, 0.5)
    ]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(n - 1)]
    faces.append((2 * n - 2, 2 * n - 1, 0, 1))
    mesh = bpy.data.meshes.new("Strip")
    mesh.from_pydata(places, [], faces)
    strip = bpy.data.objects.new("Strip", mesh)
    bpy.context.collection.objects.link(strip)
    ball()
    strip.select_set(True)


def cow() -> None:
    """Spot, the cow of the fixtures, seen from the side."""
    (path,) = OUT.parent.glob("01_*.blend")
    with bpy.data.libraries.load(str(path)) as (source, target):
        target.objects = source.objects
    for thing in target.objects:
        if thing.type == "MESH":
            bpy.context.collection.objects.link(thing)
            thing.select_set(True)
            bpy.context.view_layer.objects.active = thing


def is_open(editor: str) -> bool:
    """Whether an editor of a kind is in the window."""
    return any(area.type == editor for area in hand.window().screen.areas)


def is_at_work() -> bool:
    """Whether a run is at work, as the window knows it and as the add-on does."""
    known = any(
        each.bl_idname == "OBJECT_OT_orbflow_remesh" for each in hand.window().modal_operators
    )
    assert known == bool(addon("job").running)
    return known


def until_done() -> Waits:
    """Waits until a run has ended and is drawn."""
    yield from until(lambda: not is_at_work(), _RUN_S, "the run has ended")
    yield 1.0


def n_faces(name: str) -> int:
    """How many faces an object has."""
    return len(bpy.data.objects[name].data.polygons)


def state(name: str) -> State:
    """What an object is now."""
    mesh = bpy.data.objects[name].data
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", places)
    return State(len(mesh.polygons), mesh.name, places.tobytes())


def report(name: str) -> dict[str, Any]:
    """What the core has told of the run that made an object."""
    found = addon("runs").last_report(name)
    assert found, f"nothing is known of {name}"
    return found


def told_last() -> str:
    """The last that Blender has told."""
    return hand.told()[-1]


def n_selected() -> int:
    """How many edges and faces are selected in edit mode."""
    thing = bpy.context.object
    thing.update_from_editmode()
    return sum(each.select for each in thing.data.edges)


def strokes() -> list[bool]:
    """Of each stroke that is drawn whether it is a loop."""
    curves = [each for each in bpy.data.objects if each.type == "CURVE"]
    return [spline.use_cyclic_u for each in curves for spline in each.data.splines]


def select_above() -> None:
    """Selects the faces of the upper half of what is edited."""
    mesh = bpy.context.object.data
    shape = bmesh.from_edit_mesh(mesh)
    for face in shape.faces:
        face.select_set(False)
    for face in shape.faces:
        if face.calc_center_median().z > 0:
            face.select_set(True)
    bmesh.update_edit_mesh(mesh)


def n_faces_selected() -> tuple[int, int]:
    """How many faces of what is edited are selected, and how many there are."""
    faces = bmesh.from_edit_mesh(bpy.context.object.data).faces
    return sum(each.select for each in faces), len(faces)


def speak(language: str) -> None:
    """Sets Blender's language, for all that it says."""
    view = bpy.context.preferences.view
    view.language = language
    for each in ("interface", "tooltips", "reports"):
        setattr(view, f"use_translate_{each}", True)


def click_title(at: int) -> Waits:
    """Clicks on the title of a section, which opens or closes it."""
    found: list[hand.Button] = []
    yield from hand.buttons(found, wanted=r"orbflow\.faces$")
    below = found[-1].place.y - _TO_TITLES_PX - at * _TITLE_PX
    yield from hand.click(hand.Place(hand.region("UI").x + 80, below))


def open_section(at: int, setting: str) -> Waits:
    """Opens a section of the panel by a click on its title; one of its settings is looked for.

    Titles lie below each other, under the row that says how many faces there are.
    """
    yield from click_title(at)
    found: list[hand.Button] = []
    yield from hand.buttons(found, wanted=rf"orbflow\.{setting}$")
    assert found[-1].name.endswith(f"orbflow.{setting}"), f"section {at} has no {setting}"


def clay() -> tuple[float, float]:
    """How much of the left and of the right of the view has the color of clay."""
    pixels = hand.of_view(hand.picture()).astype(int)
    red, green, blue = (pixels[..., i] for i in range(3))
    is_clay = (red > 60) & (red - blue > 0.35 * red) & (red > green) & (green > blue)
    half = hand.region("WINDOW").width // 2 - hand.region("TOOLS").width
    return float(is_clay[:, :half].mean()), float(is_clay[:, half:].mean())


def n_changed(before: Pixels, after: Pixels) -> int:
    """How many pixels are another color."""
    return int((np.abs(before.astype(int) - after.astype(int)).sum(axis=2) > 60).sum())
