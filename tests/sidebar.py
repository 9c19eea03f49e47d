"""What the panel in the sidebar draws, kept for tests."""

from types import SimpleNamespace
from typing import Any

import bpy
from test_operator import addon


class Layout:
    """A part of a panel that keeps what is drawn in it, and the buttons."""

    def __init__(self, of: "Layout | None" = None) -> None:
        self.drawn: list[tuple[str, Layout]] = of.drawn if of else []
        self.buttons: dict[int, SimpleNamespace] = of.buttons if of else {}
        self.active = True

    def part(self, **_how: object) -> "Layout":
        return Layout(self)

    column = row = box = split = part

    def panel(self, name: str, **_how: object) -> "tuple[Layout, Layout]":
        self.drawn.append((name, self))
        return self.part(), self.part()

    def progress(self, factor: float, text: str) -> None:
        self.drawn.append((f"{text} {factor:.2f}", self))

    def prop(self, _of: object, name: str, **_how: object) -> None:
        self.drawn.append((name, self))

    def label(self, text: str, icon: str = "NONE") -> None:
        self.drawn.append((f"{icon} {text}", self))

    def operator(
        self, name: str, text: str = "", icon: str = "NONE", **_how: object
    ) -> SimpleNamespace:
        button = self.buttons[len(self.drawn)] = SimpleNamespace(bl_idname=name)
        self.drawn.append((f"{icon} {text or name}", self))
        return button


def drawn(thing: bpy.types.Object, width: int = 292) -> list[tuple[str, Layout]]:
    """What the panel draws of an object in a sidebar of a width."""
    return panel_of(thing, width).drawn


def panel_of(thing: bpy.types.Object, width: int = 292) -> Layout:
    """The panel as it is drawn of an object in a sidebar of a width."""
    preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    context: Any = SimpleNamespace(
        scene=bpy.context.scene,
        window_manager=bpy.context.window_manager,
        object=thing,
        evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get,
        region=SimpleNamespace(width=width),
        preferences=preferences,
    )
    layout = Layout()
    panel: Any = SimpleNamespace(layout=layout)
    addon("panel").VIEW3D_PT_orbflow.draw(panel, context)
    return layout
