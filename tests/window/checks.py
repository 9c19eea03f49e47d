"""What a user does in the window, and what has to come of it."""

import sys

import bpy
import hand
import numpy as np
import scene
from hand import Place, Waits, until


def install() -> Waits:
    """*Install from Disk* in the preferences, the zip chosen in the file browser."""
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    area = hand.view()
    area.type = "PREFERENCES"
    bpy.context.preferences.active_section = "EXTENSIONS"
    yield 1.0
    place = next(each for each in area.regions if each.type == "WINDOW")
    corner = Place(place.x + place.width - 18, place.y + place.height - 18)
    yield from hand.click(corner)
    # The menu's last entry.
    below = Place(corner.x, corner.y - 30)
    yield from hand.press("UP_ARROW", below)
    yield from hand.press("RET", below)
    yield from until(lambda: scene.is_open("FILE_BROWSER"), 5, "the file browser is open")
    yield 1.0
    files = next(each for each in hand.window().screen.areas if each.type == "FILE_BROWSER")
    rows = next(each for each in files.regions if each.type == "WINDOW")
    yield from hand.click(Place(rows.x + 60, rows.y + rows.height - 32))
    yield from hand.press("RET", Place(rows.x + 60, rows.y + 200))
    yield from until(lambda: scene.MODULE in sys.modules, 20, "the extension is on")
    yield 1.0
    assert hasattr(bpy.types, "OBJECT_OT_orbflow_remesh")


def searched() -> Waits:
    """F3 finds the run by its name and by what people call it, and it runs from there."""
    for words in ("orbflow", "retopology", "quad remesh"):
        yield from scene.start_with(scene.ball)
        yield from hand.search(words)
        yield from scene.until_done()
        assert scene.n_faces("Ball") < 700, f"'{words}' started nothing"
        assert scene.told_last().startswith("4,096 faces became "), scene.told_last()


def panel() -> Waits:
    """The button of the sidebar tab, all in one undo step, which redo does again."""
    yield from scene.start_with(scene.ball)
    before = scene.state("Ball")
    bpy.context.scene.orbflow.faces = 600
    bpy.ops.ed.undo_push(message="faces")
    yield from hand.push(r"orbflow_remesh\(")
    yield from until(scene.is_at_work, 5, "the run is at work")
    yield from scene.until_done()
    after = scene.state("Ball")
    assert 570 <= after.n_faces <= 630, after
    yield from hand.undo()
    assert scene.state("Ball") == before, "one undo step takes all back"
    yield from hand.redo()
    assert scene.state("Ball") == after, "redo brings the result"


def stopped() -> Waits:
    """ESC and the button *Cancel* stop a run, and change nothing."""
    yield from scene.start_with(scene.ball)
    before = scene.state("Ball")
    bpy.context.scene.orbflow.faces = 60_000
    for stop in (hand.press("ESC"), hand.push("orbflow_cancel")):
        yield from hand.push(r"orbflow_remesh\(")
        yield from until(scene.is_at_work, 5, "the run is at work")
        yield from stop
        yield from until(lambda: not scene.is_at_work(), 5, "the run has ended")
        yield 0.5
        assert scene.told_last() == "cancelled; nothing was changed", scene.told_last()
        assert scene.state("Ball") == before


def settings_of_the_redo_panel() -> Waits:
    """*Adjust Last Operation* runs again from the original, in the same undo step."""
    yield from scene.start_with(scene.ball)
    before = scene.state("Ball")
    yield from hand.search("orbflow")
    yield from scene.until_done()
    first = scene.n_faces("Ball")
    yield from hand.press("F9")
    yield 1.0
    with scene.in_view():
        operator = bpy.context.active_operator
        assert operator.bl_idname == "OBJECT_OT_orbflow_remesh"
    yield from hand.press("ESC")
    assert scene.n_faces("Ball") == first
    yield from hand.undo()
    assert scene.state("Ball") == before


def refused() -> Waits:
    """Of two objects one is refused: a line for each, *Show* selects where, undo takes all back."""
    yield from scene.start_with(scene.ball_and_strip)
    before = [scene.state(name) for name in ("Ball", "Strip")]
    yield from hand.push(r"orbflow_remesh\(")
    yield from scene.until_done()
    assert scene.told_last() == "1 done, 1 refused; see the panel", scene.told_last()
    assert scene.n_faces("Ball") < 700
    assert scene.state("Strip") == before[1]
    # The list names the refused one first; with it active the panel has the reason and Show.
    yield from hand.push(r"orbflow_show\(name=.Strip.\)")
    assert bpy.context.object.name == "Strip"
    yield from hand.push(r"orbflow_show\(name=.Strip., row=0\)")
    assert bpy.context.mode == "EDIT_MESH"
    assert scene.n_selected() > 0
    yield from hand.undo()
    yield from hand.undo()
    yield from hand.undo()
    assert [scene.state(name) for name in ("Ball", "Strip")] == before


def guides() -> Waits:
    """*Draw Guides*: a ring and a stroke are drawn, erased, brought back, and heeded by a run."""
    yield from scene.start_with(scene.ball)
    bpy.context.scene.orbflow.faces = 1500
    bpy.context.scene.orbflow.guide_strength = "EXACT"
    bpy.ops.ed.undo_push(message="settings")
    yield from scene.open_section(2, "guides")
    yield from hand.push("orbflow_draw_guides")
    tool = bpy.context.workspace.tools.from_space_view3d_mode("OBJECT")
    assert tool.idname == "orbflow.draw_guides"
    middle = hand.middle(across=0.45)
    angles = np.linspace(0.0, 2 * np.pi, 30)
    ring = [Place(int(middle.x + 120 * np.cos(a)), int(middle.y + 90 * np.sin(a))) for a in angles]
    yield from hand.drag(ring)
    assert scene.strokes() == [True], "a ring is a loop"
    yield from hand.drag([Place(middle.x - 150 + 10 * i, middle.y + 160) for i in range(31)])
    assert scene.strokes() == [True, False]
    hand.picture(scene.OUT / "guides_drawn.png")
    yield from hand.drag([Place(middle.x, middle.y + 150 + 2 * i) for i in range(12)], held="ctrl")
    assert scene.strokes() == [True], "Ctrl erases what is touched"
    yield from hand.undo()
    assert scene.strokes() == [True, False]
    yield from hand.push(r"orbflow_remesh\(")
    yield from scene.until_done()
    given = scene.report("Ball")["guides"]
    assert len(given) == 2
    assert all(each["distance"] < 0.5 for each in given), given


def before_and_after() -> Waits:
    """The slider draws the original in clay over the left of the view, and the key all of it."""
    yield from scene.start_with(scene.ball)
    yield from hand.search("orbflow")
    yield from scene.until_done()
    without = scene.clay()
    assert max(without) < 0.01, without
    bpy.context.window_manager.orbflow_before = 0.5
    yield 1.0
    left, right = scene.clay()
    assert left > 0.1, left
    assert right < 0.01, right
    hand.picture(scene.OUT / "before_half.png")
    yield from hand.search("before after")
    yield 1.0
    assert bpy.context.window_manager.orbflow_before == 0.0
    assert max(scene.clay()) < 0.01


def marks() -> Waits:
    """*Irregular Vertices*, *Field Crosses* and *Size of Faces* are drawn, and go again."""
    yield from scene.start_with(scene.ball)
    yield from hand.search("orbflow")
    yield from scene.until_done()
    for name in ("show_irregular", "show_crosses", "show_size"):
        before = hand.of_view(hand.picture()).astype(int)
        yield from hand.push(f"orbflow.{name}")
        yield from hand.move(hand.middle(up=0.1))
        yield 0.5
        assert getattr(bpy.context.scene.orbflow, name), name
        shown = hand.of_view(hand.picture()).astype(int)
        assert scene.n_changed(before, shown) > 100, f"{name} draws nothing"
        yield from hand.push(f"orbflow.{name}")
        yield from hand.move(hand.middle(up=0.1))
        yield 0.5
        assert scene.n_changed(before, hand.of_view(hand.picture())) < 100, name


def selected_faces() -> Waits:
    """In edit mode the selected half alone is done; the other stays, and undo takes all back."""
    yield from scene.start_with(scene.ball)
    before = scene.state("Ball")
    with scene.in_view():
        bpy.ops.object.mode_set(mode="EDIT")
        scene.select_above()
    bpy.ops.ed.undo_push(message="selection")
    yield 0.5
    yield from hand.push(r"orbflow_remesh\(")
    yield from scene.until_done()
    assert bpy.context.mode == "EDIT_MESH"
    hand.picture(scene.OUT / "selected_half.png")
    n_selected, n_all = scene.n_faces_selected()
    assert 540 <= n_selected <= 660, n_selected
    assert n_all - n_selected == before.n_faces // 2, (n_selected, n_all)
    yield from hand.undo()
    assert scene.n_faces_selected() == (before.n_faces // 2, before.n_faces)


def languages() -> Waits:
    """The panel, its tooltips and what is told of a run are in Blender's language."""
    told = {"de_DE": "4,096 Flächen wurden ", "fr_FR": "4,096 faces sont devenues "}
    shown = []
    for language, text in told.items():
        yield from scene.start_with(scene.ball)
        scene.speak(language)
        yield 1.0
        yield from hand.push(r"orbflow_remesh\(")
        yield from scene.until_done()
        said = scene.told_last()
        yield from scene.open_section(3, "keep_faces")
        yield from hand.move(hand.middle(up=0.1))
        yield 0.5
        shown.append(hand.picture(scene.OUT / f"panel_{language}.png"))
        scene.speak("en_US")
        yield 0.5
        yield from scene.click_title(3)
        assert said.startswith(text), said
    assert scene.n_changed(*shown) > 1000


CHECKS = {
    each.__name__: each
    for each in (
        install,
        searched,
        panel,
        stopped,
        settings_of_the_redo_panel,
        refused,
        guides,
        before_and_after,
        marks,
        selected_faces,
        languages,
    )
}
