# SPDX-License-Identifier: GPL-3.0-or-later
"""What a result has lost of its original's relief, put on top of it by modifiers.

The default is a *Multires*: its levels can be sculpted on. Each level has every vertex drawn to
the nearest place of the original, so that lower levels are worth having too. All is done in the
space of the two meshes, at rest: it does not matter where the objects stand or how they are posed.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
import orbflow_native

from . import mesh_arrays, originals
from .stand_in import stand_ins
from .translations import rpt_

#: The names of the modifiers that hold the detail.
MULTIRES, SUBDIVISION, SHRINKWRAP = "Orbflow Detail", "Orbflow Levels", "Orbflow Shrinkwrap"
NAMES = (MULTIRES, SUBDIVISION, SHRINKWRAP)
# Nearer than this, in percent of the size, no level more is seen: a pixel of a screen is as much.
_NEAR_PCT = 0.02
# A level that brings the surface nearer by less than this factor only repeats what is there.
_GAIN = 1.25
# More quads than this fill the memory of most machines.
_MOST_QUADS = 8_000_000
# Farther than this on the whole, in percent of the size, the two are no longer one shape.
_APART_PCT = 5.0
_N_SAMPLES = 10_000


class Refused(Exception):
    """An object cannot be given the detail of its original."""


@dataclass(frozen=True)
class Distance:
    """How far two surfaces are from each other, in percent of the size."""

    mean_pct: float
    most_pct: float


@dataclass(frozen=True)
class _Drawn:
    """A surface of so many levels that is drawn to the original."""

    levels: int
    n_faces: int
    distance: Distance


@dataclass(frozen=True)
class Detail:
    """What was put on an object."""

    levels: int
    n_faces: int
    is_multires: bool
    before: Distance
    after: Distance


def distance(thing: bpy.types.Object, original: bpy.types.Mesh, mesh: bpy.types.Mesh) -> Distance:
    """How far a mesh is from an original, both seen at the scale of an object."""
    scale = np.array(thing.matrix_world.to_scale(), np.float32)
    given, made = (_scaled(each, scale) for each in (original, mesh))
    score = orbflow_native.score(given, made, n_samples=_N_SAMPLES)
    return Distance(score["chamfer_pct"], score["hausdorff_pct"])


def bake(
    context: bpy.types.Context, thing: bpy.types.Object, levels: int = 0, *, live: bool = False
) -> Detail:
    """Puts the original's detail on an object: on as many levels as it takes, or as asked for.

    `live` leaves a *Shrinkwrap* that follows the original instead of a *Multires*; that is what
    an object gets, too, on which Blender makes no *Multires*. Raises `Refused`, `originals.Gone`
    and `modifiers.Refused`, with the object as it was.
    """
    _check(thing)
    for name in [each for each in NAMES if each in thing.modifiers]:
        thing.modifiers.remove(thing.modifiers[name])
    with originals.as_remeshed(context, thing) as original:
        before = distance(thing, original, thing.data)
        if before.mean_pct > _APART_PCT:
            told = rpt_("{} is {:.0f} % of its size from its original: are they still one shape?")
            raise Refused(told.format(thing.name, before.mean_pct))
        with _placed(context, original) as target:
            wanted = levels or _most_levels(thing.data, original)
            if live:
                made = None
            else:
                with _at_rest(thing):
                    made = _sculpted(context, thing, target, wanted, exactly=bool(levels))
            made = made or _wrapped(context, thing, target, wanted)
    return Detail(made.levels, made.n_faces, MULTIRES in thing.modifiers, before, made.distance)


def _check(thing: bpy.types.Object) -> None:
    if not thing.data.polygons:
        raise Refused(rpt_("{} has no faces").format(thing.name))
    others = [each.name for each in thing.modifiers if each.type == "MULTIRES"]
    if [each for each in others if each != MULTIRES]:
        told = rpt_("apply or remove modifier {} of {} first")
        raise Refused(told.format(others[0], thing.name))


def _scaled(mesh: bpy.types.Mesh, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    arrays = mesh_arrays.read(mesh)
    return arrays.positions * scale, arrays.loop_start, arrays.corner_vert


def _most_levels(mesh: bpy.types.Mesh, original: bpy.types.Mesh) -> int:
    """The first level that has a quad for every vertex of the original."""
    levels, n_quads = 1, len(mesh.loops)
    while n_quads < len(original.vertices) and 4 * n_quads <= _MOST_QUADS:
        levels, n_quads = levels + 1, 4 * n_quads
    return levels


def _sculpted(
    context: bpy.types.Context,
    thing: bpy.types.Object,
    target: bpy.types.Object,
    levels: int,
    *,
    exactly: bool,
) -> _Drawn | None:
    """Gives an object a *Multires* of so many levels, or of fewer where more bring nothing.

    None where Blender makes none; then there is none.
    """
    modifier = thing.modifiers.new(MULTIRES, "MULTIRES")
    # What moves or copies the surface works on its detail too. Blender itself puts it before what
    # makes faces.
    if (at := thing.modifiers.find(MULTIRES)) > 0:
        thing.modifiers.move(at, 0)
    made, last = None, math.inf
    for level in range(1, levels + 1):
        try:
            made = _one_more_level(context, thing, target, level)
        except RuntimeError:
            thing.modifiers.remove(thing.modifiers[MULTIRES])
            return None
        mean_pct = made.distance.mean_pct
        if not exactly and (mean_pct < _NEAR_PCT or last < _GAIN * mean_pct):
            break
        last = mean_pct
    if made:
        modifier.levels = modifier.sculpt_levels = modifier.render_levels = made.levels
    return made


def _one_more_level(
    context: bpy.types.Context, thing: bpy.types.Object, target: bpy.types.Object, level: int
) -> _Drawn:
    """Subdivides a *Multires* once and draws the level to a target; how far it is then."""
    operators = bpy.ops.object
    with context.temp_override(object=thing, active_object=thing, selected_objects=[thing]):
        # What Catmull and Clark make first is rounder: sharp edges would be cut off.
        _must(operators.multires_subdivide(modifier=MULTIRES, mode="LINEAR"))
    with _evaluated(context, thing) as mesh, _placed(context, mesh) as source:
        drawn = _shrunk(context, source, target)
        source.modifiers.clear()
        source.data = drawn
        context.view_layer.update()
        both = [thing, source]
        with context.temp_override(
            object=thing,
            active_object=thing,
            selected_objects=both,
            selected_editable_objects=both,
        ):
            _must(operators.multires_reshape(modifier=MULTIRES))
        made = _Drawn(level, len(drawn.polygons), distance(thing, target.data, drawn))
        source.data = mesh
        bpy.data.meshes.remove(drawn)
    return made


def _must(ended: set[str]) -> None:
    if ended != {"FINISHED"}:
        raise RuntimeError("Blender makes no Multires here")


def _wrapped(
    context: bpy.types.Context, thing: bpy.types.Object, target: bpy.types.Object, levels: int
) -> _Drawn:
    """Gives an object a subdivision that is drawn to its original as it is at any time."""
    for kind, name in (("SUBSURF", SUBDIVISION), ("SHRINKWRAP", SHRINKWRAP)):
        thing.modifiers.new(name, kind)
    levelled, shrunk = thing.modifiers[SUBDIVISION], thing.modifiers[SHRINKWRAP]
    levelled.levels = levelled.render_levels = levels
    levelled.subdivision_type = "SIMPLE"
    shrunk.target = originals.of(thing)
    with _placed(context, thing.data) as source:
        divided = source.modifiers.new(SUBDIVISION, "SUBSURF")
        divided.levels, divided.subdivision_type = levels, "SIMPLE"
        drawn = _shrunk(context, source, target)
        made = _Drawn(levels, len(drawn.polygons), distance(thing, target.data, drawn))
        bpy.data.meshes.remove(drawn)
    return made


def _shrunk(
    context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object
) -> bpy.types.Mesh:
    """The mesh of an object with every vertex at the nearest place of another."""
    source.modifiers.new(SHRINKWRAP, "SHRINKWRAP").target = target
    context.view_layer.update()
    seen = source.evaluated_get(context.evaluated_depsgraph_get())
    return bpy.data.meshes.new_from_object(seen)


@contextmanager
def _evaluated(context: bpy.types.Context, thing: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The last level of an object's *Multires*, without what other modifiers make of it."""
    modifier = thing.modifiers[MULTIRES]
    modifier.levels = modifier.total_levels
    with stand_ins(context) as copies:
        yield copies.of(thing).evaluated((MULTIRES,))


@contextmanager
def _placed(context: bpy.types.Context, mesh: bpy.types.Mesh) -> Iterator[bpy.types.Object]:
    """A mesh as an object of the scene, as long as the block takes."""
    thing = bpy.data.objects.new("Orbflow", mesh)
    # Keys of the mesh that are not at rest would move it.
    thing.show_only_shape_key, thing.active_shape_key_index = True, 0
    context.scene.collection.objects.link(thing)
    try:
        yield thing
    finally:
        bpy.data.objects.remove(thing)


@contextmanager
def _at_rest(thing: bpy.types.Object) -> Iterator[None]:
    """Has an object show its first key alone, as long as the block takes: detail belongs to it."""
    before = thing.show_only_shape_key, thing.active_shape_key_index
    thing.show_only_shape_key, thing.active_shape_key_index = True, 0
    try:
        yield
    finally:
        thing.show_only_shape_key, thing.active_shape_key_index = before
