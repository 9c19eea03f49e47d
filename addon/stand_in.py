# SPDX-License-Identifier: GPL-3.0-or-later
"""A copy of an object that is evaluated in its place: neither it nor its mesh is touched."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import bpy
import numpy as np

from . import attributes
from .artist import keys
from .artist.keys import Key
from .translations import rpt_

# What is simulated with other objects: a copy would collide with the object that it stands for.
_SIMULATED = {"CLOTH", "COLLISION", "PARTICLE_SYSTEM", "SOFT_BODY"}


class StandIn:
    """A copy of an object that is evaluated in its place, and the meshes made of it."""

    def __init__(self, context: bpy.types.Context, thing: bpy.types.Object) -> None:
        """Copies an object, its mesh not."""
        self._context = context
        self._own = thing.data
        self._made: list[bpy.types.Mesh] = []
        self.thing = thing.copy()

    def prepare(self) -> None:
        """Puts the copy into the scene, so that it can be evaluated."""
        # Drivers and actions would set anew what is switched here.
        self.thing.animation_data_clear()
        for each in [each for each in self.thing.modifiers if each.type in _SIMULATED]:
            self.thing.modifiers.remove(each)
        # No modifier can name this collection, so that none comes upon the copy.
        self._context.scene.collection.objects.link(self.thing)

    def remove(self) -> None:
        """Removes the copy and all meshes made of it."""
        bpy.data.objects.remove(self.thing)
        for mesh in self._made:
            bpy.data.meshes.remove(mesh)

    def evaluated(self, names: tuple[str, ...] | list[str]) -> bpy.types.Mesh:
        """The mesh that the modifiers of these names make."""
        for each in self.thing.modifiers:
            each.show_viewport = each.name in names
        view_layer = self._context.view_layer
        view_layer.update()
        mesh = bpy.data.meshes.new_from_object(
            self.thing.evaluated_get(view_layer.depsgraph),
            preserve_all_data_layers=True,
            depsgraph=view_layer.depsgraph,
        )
        self._made.append(mesh)
        return mesh

    def is_changed(self, before: list[str], by: str) -> bool:
        """Whether a modifier after some others changes which vertices the faces have."""
        without, with_it = self.evaluated(before), self.evaluated([*before, by])
        is_changed = not _are_alike(without, with_it)
        self._remove(without, with_it)
        return is_changed

    def evaluated_with_keys(
        self, names: tuple[str, ...]
    ) -> tuple[bpy.types.Mesh, list[Key], list[str]]:
        """The same with its shape keys, and which are lost: those that make other faces."""
        given = keys.read(self._own)
        if not given:
            return self.evaluated(names), [], []
        rest = np.empty((len(self._own.vertices), 3), np.float32)
        self._own.shape_keys.key_blocks[0].data.foreach_get("co", rest.ravel())
        self._shape_by_hand()
        mesh = self._moulded(rest, names)
        moved = [self._moved(key, rest, mesh, names) for key in given]
        kept = _whole([each for each in moved if each])
        lost = [rpt_("shape key {}").format(key.name) for key in given if key.name not in kept]
        if len(given) > 1 and len(kept) == 1:
            # None is left but the first: what is seen is their mix.
            self.thing.data = self._own
            return self.evaluated(names), [], lost
        return mesh, list(kept.values()), lost

    def _shape_by_hand(self) -> None:
        """Gives the copy a mesh of its own, without keys."""
        self.thing.data = self._own.copy()
        self._made.append(self.thing.data)
        name = self.thing.data.shape_keys.name
        self.thing.shape_key_clear()
        # Up to Blender 4.5 keys of a copied mesh have one user too many, and are not gone.
        if (left := bpy.data.shape_keys.get((name, None))) is not None:
            bpy.data.batch_remove([left])

    def _moved(
        self, key: Key, rest: np.ndarray, mesh: bpy.types.Mesh, names: tuple[str, ...]
    ) -> Key | None:
        """A key by how far it moves the vertices of the evaluated mesh; none where it cannot."""
        if not key.moves.any():
            return replace(key, moves=np.zeros((len(mesh.vertices), 3), np.float32))
        moulded = self._moulded(rest + key.moves, names)
        moves = None
        if _are_alike(mesh, moulded):
            moves = attributes.positions(moulded) - attributes.positions(mesh)
        self._remove(moulded)
        return None if moves is None else replace(key, moves=moves)

    def _moulded(self, places: np.ndarray, names: tuple[str, ...]) -> bpy.types.Mesh:
        """What the modifiers make of the mesh with its vertices at these places."""
        mesh = self.thing.data
        mesh.attributes["position"].data.foreach_set("vector", places.ravel())
        mesh.update()
        return self.evaluated(names)

    def _remove(self, *meshes: bpy.types.Mesh) -> None:
        """One by one, as many keys of a large mesh would fill the memory."""
        for mesh in meshes:
            self._made.remove(mesh)
            bpy.data.meshes.remove(mesh)


class StandIns:
    """Copies of objects, made when they are asked for."""

    def __init__(self, context: bpy.types.Context) -> None:
        """Makes none."""
        self.context = context
        self._made: dict[bpy.types.Object, StandIn] = {}

    def of(self, thing: bpy.types.Object) -> StandIn:
        """The copy of an object, always the same one: its modifiers are fast the second time."""
        if thing not in self._made:
            self._made[thing] = StandIn(self.context, thing)
            self._made[thing].prepare()
        return self._made[thing]

    def remove(self) -> None:
        """Removes all copies, and all meshes made of them."""
        for each in self._made.values():
            each.remove()
        if self._made:
            self.context.view_layer.update()


@contextmanager
def stand_ins(context: bpy.types.Context) -> Iterator[StandIns]:
    """Copies of objects that are gone where the block ends."""
    made = StandIns(context)
    try:
        yield made
    finally:
        made.remove()


def _whole(found: list[Key]) -> dict[str, Key]:
    """Keys by name, without those that build upon one that is not there."""
    kept = {key.name: key for key in found}
    while without := [key.name for key in kept.values() if key.relative not in kept]:
        for name in without:
            del kept[name]
    return kept


def _are_alike(one: bpy.types.Mesh, other: bpy.types.Mesh) -> bool:
    """Whether faces have the same vertices in both."""
    return len(one.vertices) == len(other.vertices) and all(
        np.array_equal(read(one), read(other))
        for read in (attributes.loop_starts, attributes.corner_verts)
    )
