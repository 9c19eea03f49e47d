"""The modal run behind the button, driven by the events that a window would send."""

import itertools
import re
import time
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from conftest import ROOT
from sidebar import drawn
from test_operator import Open, addon, arrays


def place(kind: str, x: int, width: int, *regions: SimpleNamespace) -> SimpleNamespace:
    """An area or a region over the whole height of a window."""
    return SimpleNamespace(type=kind, x=x, y=0, width=width, height=100, regions=regions)


# A 3D view with a sidebar that lies over it and the panel of the last operator, and an outliner.
AREAS = [
    place("VIEW_3D", 0, 80, *(place("WINDOW", 0, 80), place("HUD", 0, 10), place("UI", 60, 20))),
    place("OUTLINER", 80, 20, place("WINDOW", 80, 20)),
]
X = {"HUD": 5, "WINDOW": 40, "UI": 70, "OUTLINER": 90, "top bar": 120}


class Window:
    """What the operator asks of Blender's window, and what it has set there."""

    def __init__(self) -> None:
        self.status: Any = None
        self.timers: list[object] = []
        self.handlers: list[object] = []
        self.reports: list[str] = []
        self.redraws: list[str] = []
        self.drawn: list[str] = []
        self.were_at_work: list[bool] = []
        self.warps: list[tuple[int, int]] = []

    def context(self) -> SimpleNamespace:
        sidebar = SimpleNamespace(type="UI", tag_redraw=lambda: self.drawn.append("sidebar"))
        view = SimpleNamespace(type="VIEW_3D", tag_redraw=self._draw_sidebar, regions=[sidebar])
        other = SimpleNamespace(type="OUTLINER")
        screen = SimpleNamespace(areas=[other, view])
        shown = SimpleNamespace(
            screen=SimpleNamespace(areas=AREAS),
            cursor_warp=lambda x, y: self.warps.append((x, y)),
        )
        manager = SimpleNamespace(
            windows=[SimpleNamespace(screen=screen)],
            event_timer_add=self._add_timer,
            event_timer_remove=self.timers.remove,
            modal_handler_add=self.handlers.append,
        )
        real = bpy.context
        return SimpleNamespace(
            window_manager=manager,
            workspace=SimpleNamespace(
                status_text_set=lambda status: setattr(self, "status", status),
                status_text_set_internal=self.redraws.append,
            ),
            window=shown,
            scene=real.scene,
            view_layer=real.view_layer,
            selected_objects=list(real.selected_objects),
            mode="OBJECT",
        )

    def _add_timer(self, _step: float, **_window: object) -> object:
        self.timers.append(object())
        return self.timers[-1]

    def _draw_sidebar(self) -> None:
        self.were_at_work.append(bool(addon("job").running))


@pytest.fixture
def window(open_fixture: Open, monkeypatch: pytest.MonkeyPatch) -> Window:
    open_fixture("01")
    module = addon("operators.remesh")
    app = SimpleNamespace(background=False)
    monkeypatch.setattr(module, "bpy", SimpleNamespace(app=app, data=bpy.data, types=bpy.types))
    return Window()


def operator(window: Window, faces: int) -> SimpleNamespace:
    """The operator's own functions on a stand-in for the instance that Blender would make."""
    kind = addon("operators.remesh").OBJECT_OT_orbflow_remesh
    settings = {name: getattr(bpy.context.scene.orbflow, name) for name in addon("settings").NAMES}
    self = SimpleNamespace(**settings | {"faces": faces})
    self.report = lambda _level, text: window.reports.append(text)
    for name in ("invoke", "modal", "cancel", "_end", "_tidy", "_finish"):
        setattr(self, name, getattr(kind, name).__get__(self))
    return self


def send(
    self: SimpleNamespace,
    context: SimpleNamespace,
    kind: str,
    held: str | None = None,
    over: str = "WINDOW",
) -> set[str]:
    keys = {key: key == held for key in ("ctrl", "alt", "shift")}
    mouse = {"mouse_x": X[over], "mouse_y": 50}
    return self.modal(context, SimpleNamespace(type=kind, value="PRESS", **mouse, **keys))


def until(ended: Callable[[], set[str]]) -> set[str]:
    for _ in range(2000):
        answer = ended()
        if not answer & {"RUNNING_MODAL", "PASS_THROUGH"}:
            return answer
        time.sleep(0.01)
    raise TimeoutError


def is_tidy(window: Window) -> bool:
    at_work = bool(addon("job").running)
    shown = window.were_at_work[-1:] == [False]
    return window.status is None and not window.timers and not at_work and shown


def test_a_run_ends_with_one_result_and_leaves_nothing_behind(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=500)
    assert self.invoke(context, None) == {"RUNNING_MODAL"}
    assert window.status is not None
    assert window.handlers == [self]
    assert "press ESC" in addon("operators.remesh").why_not(context)
    assert send(self, context, "MIDDLEMOUSE") == {"PASS_THROUGH"}
    assert send(self, context, "LEFTMOUSE") == {"RUNNING_MODAL"}
    assert until(lambda: send(self, context, "TIMER")) == {"FINISHED"}
    assert window.redraws
    assert len(bpy.data.objects["Spot"].data.polygons) < 520
    assert is_tidy(window)
    assert addon("panel").rows(addon("runs").last_report("Spot"))


def test_looking_around_passes_and_edits_do_not(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=200_000)
    self.invoke(context, None)
    for kind, held, passes in [
        ("WHEELUPMOUSE", "ctrl", True),
        ("TIMER", None, True),
        ("TIMER_AUTOSAVE", None, True),
        ("NUMPAD_1", None, True),
        ("NUMPAD_0", "ctrl", False),
        ("NUMPAD_SLASH", "alt", False),
        ("LEFTMOUSE", "alt", True),
        ("LEFTMOUSE", None, False),
        ("RIGHTMOUSE", None, False),
        ("X", None, False),
        ("TAB", None, False),
        ("N", None, True),
        ("N", "ctrl", False),
        ("S", None, False),
        ("S", "ctrl", True),
    ]:
        wanted = {"PASS_THROUGH" if passes else "RUNNING_MODAL"}
        assert send(self, context, kind, held) == wanted, kind
    self.cancel(context)


def test_other_editors_the_sidebar_and_tabs_go_on_but_nothing_undoes(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=200_000)
    self.invoke(context, None)
    for over, passes in [("OUTLINER", True), ("UI", True), ("top bar", True), ("HUD", False)]:
        wanted = {"PASS_THROUGH" if passes else "RUNNING_MODAL"}
        assert send(self, context, "LEFTMOUSE", over=over) == wanted, over
        assert send(self, context, "F2", over=over) == wanted, over
        assert send(self, context, "Z", "ctrl", over) == {"RUNNING_MODAL"}, over
        assert send(self, context, "S", "ctrl", over) == {"PASS_THROUGH"}, over
    self.cancel(context)


def test_escape_stops_it_and_changes_nothing(window: Window) -> None:
    spot = bpy.data.objects["Spot"]
    before = arrays(spot)
    context = window.context()
    self = operator(window, faces=200_000)
    self.invoke(context, None)
    assert send(self, context, "ESC") == {"RUNNING_MODAL"}
    assert until(lambda: send(self, context, "TIMER")) == {"CANCELLED"}
    assert arrays(spot) == before
    assert window.reports == ["cancelled; nothing was changed"]
    assert is_tidy(window)


@pytest.mark.parametrize(("over", "warps"), [("UI", [(X["UI"], 50)]), ("WINDOW", []), ("HUD", [])])
def test_a_mouse_that_rests_on_the_button_is_moved_to_where_it_is(
    window: Window, over: str, warps: list[tuple[int, int]]
) -> None:
    context = window.context()
    self = operator(window, faces=200_000)
    self.invoke(context, None)
    addon("job").running[-1].cancel()
    assert until(lambda: send(self, context, "TIMER", over=over)) == {"CANCELLED"}
    assert window.warps == warps


def test_the_panel_shows_how_far_it_is_and_a_button_that_stops_it(window: Window) -> None:
    context, spot = window.context(), bpy.context.object
    self = operator(window, faces=200_000)
    before = arrays(spot)
    assert not bpy.ops.object.orbflow_cancel.poll()
    self.invoke(context, None)
    job = addon("job").running[-1]
    send(self, context, "TIMER")
    assert window.drawn
    shown = [text for text, _ in drawn(spot)]
    assert shown[0].startswith(job.told()[:4])
    assert shown[1] == "CANCEL object.orbflow_cancel"
    assert "MOD_REMESH Orbflow Remesh" not in shown
    assert bpy.ops.object.orbflow_cancel() == {"FINISHED"}
    job.wait()
    assert send(self, context, "TIMER") == {"CANCELLED"}
    assert arrays(spot) == before


def test_escape_counts_even_when_the_work_is_already_done(window: Window) -> None:
    spot = bpy.data.objects["Spot"]
    before = arrays(spot)
    context = window.context()
    self = operator(window, faces=500)
    self.invoke(context, None)
    addon("job").running[-1].wait()
    send(self, context, "ESC")
    assert send(self, context, "TIMER") == {"CANCELLED"}
    assert arrays(spot) == before
    assert is_tidy(window)


def test_blender_may_take_the_operator_away(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=200_000)
    self.invoke(context, None)
    self.cancel(context)
    assert is_tidy(window)


def remove(spot: Any) -> None:  # noqa: ANN401
    bpy.data.objects.remove(spot)


def move_a_vertex(spot: Any) -> None:  # noqa: ANN401
    spot.data.vertices[5].co.x += 0.1


def edit(spot: Any) -> None:  # noqa: ANN401
    bpy.context.view_layer.objects.active = spot
    bpy.ops.object.mode_set(mode="EDIT")


def edit_a_copy(spot: Any) -> None:  # noqa: ANN401
    copy = spot.copy()
    bpy.context.scene.collection.objects.link(copy)
    edit(copy)


@pytest.mark.parametrize("change", [remove, move_a_vertex, edit, edit_a_copy])
def test_an_object_that_was_changed_meanwhile_is_let_go(
    window: Window, change: Callable[[Any], None]
) -> None:
    context = window.context()
    self = operator(window, faces=500)
    self.invoke(context, None)
    change(bpy.data.objects["Spot"])
    assert until(lambda: send(self, context, "TIMER")) == {"CANCELLED"}
    assert window.reports == ["Spot: it was changed meanwhile and is left as it is now"]
    assert is_tidy(window)
    if bpy.context.object and bpy.context.object.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    meshes = [thing.data for thing in bpy.data.objects if thing.type == "MESH"]
    assert all(len(mesh.polygons) > 2000 for mesh in meshes)


def shown_in_status_bar(window: Window) -> list[str]:
    shown: list[str] = []
    row = SimpleNamespace(progress=lambda factor, text: shown.append(f"{text} {factor:.2f}"))
    layout = SimpleNamespace(
        row=lambda: row,
        label=lambda text, icon: shown.append(f"{text} {icon}"),
    )
    window.status(SimpleNamespace(layout=layout), None)
    return shown


def test_the_status_bar_shows_the_step_the_share_and_how_to_stop(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=500)
    self.invoke(context, None)
    job = addon("job").running[-1]
    job.wait()
    job.left_s = lambda: None
    job.stage = addon("job").Stage(0.25, "flow", 0)
    assert shown_in_status_bar(window) == [
        "Orbflow: laying the loops, 25 % 0.25",
        "Stop EVENT_ESC",
    ]
    job.left_s = lambda: 11.6
    job.tasks = job.tasks * 12
    job.stage = addon("job").Stage(0.5, "score", 2)
    assert shown_in_status_bar(window)[0] == (
        "Orbflow: 3 of 12: measuring, 50 %, about 12 s left 0.50"
    )
    self.cancel(context)


@pytest.mark.usefixtures("_extension")
@pytest.mark.parametrize(
    ("left_s", "told"),
    [
        (None, "unfolding, 40 %"),
        (0.2, "unfolding, 40 %, about 1 s left"),
        (12.3, "unfolding, 40 %, about 12 s left"),
        (43.0, "unfolding, 40 %, about 45 s left"),
        (200.0, "unfolding, 40 %, about 3 min left"),
    ],
)
def test_the_time_left_is_told_as_precisely_as_it_is_known(left_s: float | None, told: str) -> None:
    assert addon("words").status("embed", 0.4, left_s) == told


@pytest.mark.usefixtures("_extension")
def test_every_step_of_the_core_has_words_for_artists() -> None:
    sources = (ROOT / "native" / "geometry" / "src" / "pipeline").rglob("*.rs")
    named = re.compile(r'progress\s*\.part\(\s*"([a-z-]+)"')
    steps = {step for source in sources for step in named.findall(source.read_text())}
    assert {"clean", "flow", "score"} < steps <= addon("words").STEPS.keys()


def test_what_belongs_to_no_step_goes_on_under_the_name_of_the_last(window: Window) -> None:
    context = window.context()
    self = operator(window, faces=500)
    self.invoke(context, None)
    job = addon("job").running[-1]
    job.wait()
    for step in ("flow", ""):
        job._hear(addon("job").Stage(0.25, step, 0))
    assert "laying the loops" in shown_in_status_bar(window)[0]
    self.cancel(context)


@pytest.mark.usefixtures("_extension")
def test_the_time_left_comes_from_what_was_done_and_does_not_jump() -> None:
    now = 0.0
    clock = addon("job").Clock(lambda: now)
    assert clock.left_s(0.0) is None
    now = 0.5
    assert clock.left_s(0.5) is None
    now = 2.0
    assert clock.left_s(0.2) == pytest.approx(8.0)
    # What was to take 10 s would take 20 now: it is believed step by step, not at once.
    now, told = 4.0, []
    for _ in range(100):
        now += 0.05
        told.append(clock.left_s(now / 20))
    steps = [later - sooner for sooner, later in itertools.pairwise(told)]
    assert max(map(abs, steps)) < 0.5
    assert told[-1] == pytest.approx(20 - now, rel=0.2)


def test_many_objects_share_the_bar_by_how_much_work_each_is(window: Window) -> None:
    job = addon("job")
    small, large = (addon("mesh_arrays").read(bpy.data.objects["Spot"].data) for _ in range(2))
    large = replace(large, loop_start=np.zeros(20_000, np.int32))
    tasks = [
        job.Task(name, arrays, (1.0, 1.0, 1.0)) for name, arrays in (("A", small), ("B", large))
    ]
    bounds = job._bounds([job.Failed("C", "no"), *tasks], 500)
    n = len(small.loop_start) + 500
    assert bounds == pytest.approx([0, 0, n / (n + len(large.loop_start) + 500), 1])
