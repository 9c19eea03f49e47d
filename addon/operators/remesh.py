# SPDX-License-Identifier: GPL-3.0-or-later
"""The button: Object > Orbflow Remesh."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np
import orbflow_native

from .. import (
    artist,
    density,
    earlier,
    editing,
    events,
    guides,
    mesh_arrays,
    modifiers,
    originals,
    outcomes,
    overlay,
    panel,
    regions,
    runs,
    settings,
    size,
    words,
)
from ..guides.strokes import Stroke
from ..job import Done, Failed, Job, Outcome, Task, Todo, remesh, running
from ..outcomes import Told
from ..stand_in import StandIns, stand_ins
from ..translations import iface_, rpt_

_TICK_S = 0.05


class OBJECT_OT_orbflow_remesh(bpy.types.Operator, settings.Settings):
    """Rebuild the selected meshes at the number of faces asked for"""  # noqa: D400

    bl_idname = "object.orbflow_remesh"
    bl_label = "Orbflow Remesh"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is something to do, and in words why not."""
        reason = why_not(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        """The blocking twin for scripts, background mode and the redo panel."""
        self._edited = editing.leave(context)
        tasks = _tasks(context, self, self._edited)
        window_manager = context.window_manager
        window_manager.progress_begin(0.0, 1.0)
        try:
            ended = remesh(
                tasks,
                settings.for_core(self),
                lambda stage: window_manager.progress_update(stage.share),
                orbflow_native.CancelToken(),
            )
        finally:
            window_manager.progress_end()
        if self.options.is_repeat:
            # The redo panel has undone the run, and with it what was set since.
            settings.copy(self, context.scene.orbflow)
            overlay.keep_ticks(context.scene)
        return self._finish(ended)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Starts the thread and stays modal until it has ended."""
        if bpy.app.background:
            return self.execute(context)
        self._edited = editing.leave(context)
        tasks = _tasks(context, self, self._edited)
        running.append(Job(tasks, settings.for_core(self)))
        self._timer = context.window_manager.event_timer_add(_TICK_S, window=context.window)
        context.window_manager.modal_handler_add(self)
        # Blender crashes when this is given a new function on every tick: one reads the job.
        context.workspace.status_text_set(_draw_status)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Watches the thread; lets the user look around meanwhile, but not edit."""
        job = running[-1]
        if event.type == "ESC" and event.value == "PRESS":
            job.cancel()
        if event.type == "TIMER":
            panel.redraw_status_bar(context)
            panel.redraw_progress(context)
            if job.has_ended():
                self._tidy(context)
                events.wake_button(event, context.window)
                return self._end(job)
        return {"PASS_THROUGH"} if events.passes(event, context.window) else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender takes the operator away, for example when another file is opened."""
        job = running[-1]
        job.cancel()
        job.wait()
        self._tidy(context)
        editing.enter(self._edited, [])

    def _end(self, job: Job) -> set[str]:
        if job.is_cancelled:
            editing.enter(self._edited, [])
            self.report({"INFO"}, rpt_("cancelled; nothing was changed"))
            return {"CANCELLED"}
        return self._finish(job.outcomes)

    def _tidy(self, context: bpy.types.Context) -> None:
        running.clear()
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        # One that was left during the run has the empty text that drew the bar.
        for each in bpy.data.workspaces:
            each.status_text_set_internal(None)
        panel.redraw_sidebars(context)

    def _finish(self, ended: list[Outcome]) -> set[str]:
        """Writes the results; the one place where errors become reports."""
        told = [_write(each, self.keep_original) for each in ended]
        editing.enter(self._edited, [each for each in ended if isinstance(each, Done)])
        lines = [line for each in told for line in each.lines]
        runs.remember_lines(lines if len(told) > 1 else [])
        is_done = any(each.state != "refused" for each in told)
        for level, text in _reports(told):
            self.report({level}, text)
        return {"FINISHED"} if is_done else {"CANCELLED"}


def _write(outcome: Outcome, keep_original: bool) -> Told:
    """Replaces an object's mesh, where there is a result, and tells what became of it."""
    if isinstance(outcome, Failed):
        return outcomes.refused(outcome)
    old = outcomes.before(outcome)
    told = _replace(outcome, keep_original)
    if isinstance(told, Failed):
        return outcomes.refused(told)
    return outcomes.done(outcome, told, old)


def _reports(told: list[Told]) -> list[tuple[str, str]]:
    """What Blender is told, and how grave it is: the last is what its status bar shows."""
    is_done = any(each.state != "refused" for each in told)
    noted = [f"{each.lines[0].name}: {each.text}" for each in told if each.state != "done"]
    if len(told) == 1 and is_done:
        return [("WARNING" if told[0].is_grave else "INFO", told[0].text)]
    if len(told) == 1:
        return [("ERROR", noted[0])]
    lines = [line for each in told for line in each.lines]
    text = words.summary([line.state for line in lines])
    if not noted:
        return [("INFO", text)]
    last = "WARNING" if is_done else "ERROR", rpt_("{}; see the panel").format(text)
    return [*(("INFO", each) for each in noted), last]


def why_not(context: bpy.types.Context) -> str:
    """Why the button is greyed out; empty when it is not."""
    if running:
        return rpt_("Orbflow is at work; press ESC to stop it")
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return rpt_("Leave sculpt or paint mode first: Orbflow works in object and edit mode")
    meshes = [each for each in context.selected_objects if each.type == "MESH"]
    if not meshes:
        return rpt_("Select at least one mesh object")
    if not any(_is_editable(each) for each in meshes):
        return rpt_("The selected meshes are linked from another file and cannot be changed")
    return ""


def _is_editable(thing: bpy.types.Object) -> bool:
    return thing.is_editable and thing.data.library is None


def _tasks(
    context: bpy.types.Context, wanted: settings.Settings, edited: Sequence[str] = ()
) -> list[Todo]:
    """What is to be done; of objects that were in edit mode the selected faces alone."""
    context.view_layer.update()
    things = [each for each in context.selected_objects if each.type == "MESH"]
    if edited:
        things = [context.view_layer.objects[name] for name in edited]
    named = wanted.guides if settings.is_of_use(wanted, "guides") else ""
    try:
        drawn = guides.read(context, named, wanted.guide_strength == "EXACT")
    except guides.NoGuides as error:
        return [Failed(each.name, str(error)) for each in things]
    with stand_ins(context) as copies:
        failed, alike = _sort(things, copies, drawn, wanted, is_editing=bool(edited))
        return failed + [_task(each, copies, wanted) for each in alike]


@dataclass(frozen=True)
class _Alike:
    """Objects that share a mesh, and all that one result does for."""

    things: list[bpy.types.Object]
    stack: modifiers.Stack
    guides: tuple[Stroke, ...] | None
    #: Whether of its mesh the faces alone are meant that are selected in edit mode.
    is_editing: bool


def _sort(
    things: list[bpy.types.Object],
    copies: StandIns,
    drawn: list[Stroke] | None,
    wanted: settings.Settings,
    *,
    is_editing: bool,
) -> tuple[list[Todo], list[_Alike]]:
    """Which objects cannot be done; which of the others share a mesh that one result does for."""
    failed: list[Todo] = []
    alike: dict[Any, _Alike] = {}
    for thing in things:
        if reason := _why_left(thing):
            failed.append(Failed(thing.name, reason))
            continue
        try:
            none = modifiers.none(thing) if is_editing else None
            stack = none or modifiers.stack(copies, thing, wanted)
        except modifiers.Refused as error:
            failed.append(Failed(thing.name, str(error)))
            continue
        scale = (f"{x:.5g}" for x in thing.matrix_world.to_scale())
        own = guides.of(thing, drawn, len(things) == 1)
        key = (thing.data, stack, *scale, *(each.key() for each in own or ()))
        alike.setdefault(key, _Alike([], stack, own, is_editing)).things.append(thing)
    return failed, list(alike.values())


def _why_left(thing: bpy.types.Object) -> str:
    """Why an object is left as it is; empty when it is not."""
    if not _is_editable(thing):
        return rpt_("it is linked from another file and cannot be changed")
    if _is_being_edited(thing):
        return rpt_("it is not in object mode, in which Orbflow works")
    return ""


def _task(alike: _Alike, copies: StandIns, wanted: settings.Settings) -> Todo:
    thing, *others = alike.things
    try:
        seen = modifiers.seen(copies, thing, alike.stack)
        all_of = [seen.thing] + [each for each in alike.things if each != seen.thing]
        given = artist.read(all_of, wanted.weights_limit)
        wish = density.read(seen.thing, wanted.density, given.groups)
        kept = regions.kept(seen.thing, wanted.keep_faces, given.groups)
        if alike.is_editing:
            others_of = regions.unselected(thing.data)
            kept = others_of if kept is None else kept | others_of
    except (modifiers.Refused, density.NoSuchName, regions.NoRegion) as error:
        return Failed(thing.name, str(error))
    given = replace(given, keys=seen.keys, lost=given.lost + seen.lost)
    arrays = mesh_arrays.read(seen.thing.data, wanted.marked_edges)
    scale = tuple(thing.matrix_world.to_scale())
    names = tuple(each.name for each in others)
    n_faces = size.n_faces(wanted, arrays, scale, kept, is_editing=alike.is_editing)
    return Task(
        thing.name, arrays, scale, given, wish, alike.guides, kept, names, n_faces, seen.applied
    )


def _replace(outcome: Done, keep_original: bool) -> dict[str, Any] | Failed:
    """Gives an object, and those that share its mesh, its new one; returns what is told of it."""
    task, given, applied = outcome.task, outcome.task.artist, outcome.task.applied
    # A linked object may have the same name.
    things = [bpy.data.objects.get((name, None)) for name in (task.name, *task.others)]
    if not _are_unchanged(things, task):
        return Failed(task.name, rpt_("it was changed meanwhile and is left as it is now"))
    try:
        result = modifiers.rest_of(outcome.result, applied)
    except modifiers.Refused as error:
        return Failed(task.name, str(error))
    for each in things if keep_original else ():
        originals.keep(each)
    thing, *others = things
    old, name = thing.data, thing.data.name
    thing.data = mesh_arrays.write(result, like=old)
    if given:
        artist.write(thing, given, result, old)
    for each in others:
        each.data = thing.data
    if applied:
        modifiers.leave(things, applied)
    if old.users == 0:
        bpy.data.meshes.remove(old)
        thing.data.name = name
    report = outcome.result.report | {"lost": given.lost if given else []}
    report["has_normals"] = bool(given and given.elements.normals)
    report |= modifiers.told(applied)
    report |= guides.told(task.guides, report)
    runs.remember(thing, report, outcome.result.crosses)
    earlier.remember(thing, task.arrays)
    return report


def _is_being_edited(thing: bpy.types.Object) -> bool:
    """Whether a mode holds a mesh of its own, which it would write over another."""
    return thing.mode != "OBJECT" or thing.data.is_editmode


def _are_unchanged(things: list[bpy.types.Object], task: Task) -> bool:
    """Whether another window has left objects of one mesh as they were read."""
    if None in things or any(each.type != "MESH" or _is_being_edited(each) for each in things):
        return False
    mesh, applied = things[0].data, task.applied
    if applied and not modifiers.are_unchanged(things[0], applied.stack):
        return False
    now, before = mesh_arrays.read(mesh), applied.base if applied else task.arrays
    return all(each.data == mesh for each in things) and all(
        np.array_equal(getattr(now, name), getattr(before, name))
        for name in ("positions", "loop_start", "corner_vert")
    )


def _draw_status(bar: bpy.types.Header, _context: bpy.types.Context) -> None:
    if not running:
        return
    job = running[-1]
    row = bar.layout.row()
    row.ui_units_x = 20  # Blender cuts the text at the width of a short word otherwise
    row.progress(factor=job.stage.share, text=f"Orbflow: {job.told()}")
    bar.layout.label(text=iface_("Stop"), icon="EVENT_ESC")
