# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys: how far each moves every vertex, their settings, their drivers."""

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .layers import Mix

_SETTINGS = ("slider_min", "slider_max", "value", "mute", "vertex_group", "interpolation")


@dataclass(frozen=True)
class Key:
    """A shape key by how far it moves every vertex from the first one, (V, 3)."""

    name: str
    relative: str
    settings: dict[str, Any]
    moves: NDArray[np.float32]


def read(mesh: bpy.types.Mesh) -> list[Key]:
    """Reads the keys of a mesh."""
    if mesh.shape_keys is None:
        return []
    blocks = mesh.shape_keys.key_blocks
    rest = _places(blocks[0])
    return [
        Key(
            block.name,
            block.relative_key.name,
            {name: getattr(block, name) for name in _SETTINGS},
            _places(block) - rest,
        )
        for block in blocks
    ]


def write(thing: bpy.types.Object, keys: list[Key], mix: Mix, old: bpy.types.Mesh) -> None:
    """Gives an object with a new mesh the same keys."""
    if not keys:
        return
    active = thing.active_shape_key_index
    blocks = [thing.shape_key_add(name=key.name, from_mix=False) for key in keys]
    rest = _places(blocks[0])
    for block, key in zip(blocks, keys, strict=True):
        block.data.foreach_set("co", (rest + mix.of(key.moves)).ravel())
        block.relative_key = thing.data.shape_keys.key_blocks[key.relative]
        for name, value in key.settings.items():
            setattr(block, name, value)
    thing.data.shape_keys.use_relative = old.shape_keys.use_relative
    thing.active_shape_key_index = min(active, len(keys) - 1)
    _animate(thing.data.shape_keys, old.shape_keys)


def _animate(keys: bpy.types.Key, old: bpy.types.Key) -> None:
    given = old.animation_data
    if given is None:
        return
    animation = keys.animation_data_create()
    animation.action = given.action
    if getattr(given, "action_slot", None) is not None:
        animation.action_slot = given.action_slot
    for driver in given.drivers:
        # Of a key that could not be carried.
        if not _has(keys, driver.data_path):
            continue
        copied = animation.drivers.from_existing(src_driver=driver)
        for target in (each for read in copied.driver.variables for each in read.targets):
            if target.id == old:
                target.id = keys


def _has(keys: bpy.types.Key, path: str) -> bool:
    try:
        keys.path_resolve(path)
    except ValueError:
        return False
    return True


def _places(block: bpy.types.ShapeKey) -> NDArray[np.float32]:
    places = np.empty(3 * len(block.data), np.float32)
    block.data.foreach_get("co", places)
    return places.reshape(-1, 3)
