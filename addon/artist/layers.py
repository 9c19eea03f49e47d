# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist has left on the elements of a mesh: attributes as arrays, by their names."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..attributes import FACE_SETS, SEAMS

# Of every type of attribute that can be carried: the property of its values, the type of an
# array of them, and how many numbers a value has.
_FIELDS: dict[str, tuple[str, type, int]] = {
    "BOOLEAN": ("value", np.bool_, 1),
    "BYTE_COLOR": ("color", np.float32, 4),
    "FLOAT": ("value", np.float32, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int8, 1),
}
# Attributes that are the mesh itself, or that are carried by other means.
_OWN = {"position", "material_index", "custom_normal"}


@dataclass(frozen=True)
class Mix:
    """Of which three old elements every new one is mixed, (N, 3), and by which weights."""

    rows: NDArray[np.int32]
    weights: NDArray[np.float32]

    def of(self, values: NDArray) -> NDArray:
        """Numbers are mixed; of anything else the value with the largest share wins."""
        three = values[self.rows]
        if values.dtype == np.float32:
            return np.einsum("nkw,nk->nw", three, self.weights)
        is_same = (three[:, :, None] == three[:, None]).all(axis=3)
        shares = (is_same * self.weights[:, None]).sum(axis=2)
        return three[np.arange(len(three)), shares.argmax(axis=1)]


@dataclass(frozen=True)
class Layer:
    """An attribute: its name, its type, and a row of numbers for every element."""

    name: str
    kind: str
    values: NDArray

    def taken(self, rows: NDArray[np.integer]) -> "Layer":
        """The same with some of the rows, in their order."""
        return Layer(self.name, self.kind, self.values[rows])

    def mixed(self, mix: Mix) -> "Layer":
        """The same for elements that are mixed of these."""
        return Layer(self.name, self.kind, mix.of(self.values))

    def write(self, mesh: bpy.types.Mesh, domain: str) -> None:
        """Gives a mesh the attribute; there must be a row for every element."""
        attribute = mesh.attributes.get(self.name)
        attribute = attribute or mesh.attributes.new(self.name, self.kind, domain)
        field, _, _ = _FIELDS[self.kind]
        attribute.data.foreach_set(field, np.ascontiguousarray(self.values).ravel())


def is_carried(attribute: bpy.types.Attribute) -> bool:
    """Whether an attribute is the artist's and of a type that can be carried."""
    return _is_artists(attribute) and attribute.data_type in _FIELDS


def is_lost(attribute: bpy.types.Attribute) -> bool:
    """Whether an attribute is the artist's, but of a type that cannot be carried."""
    return _is_artists(attribute) and attribute.data_type not in _FIELDS


def _is_artists(attribute: bpy.types.Attribute) -> bool:
    name = attribute.name
    return name in {*SEAMS, FACE_SETS} or not (name.startswith(".") or name in _OWN)


def read(mesh: bpy.types.Mesh, domain: str) -> Iterator[Layer]:
    """The artist's attributes of a domain."""
    for attribute in mesh.attributes:
        if attribute.domain != domain or not is_carried(attribute):
            continue
        field, number, width = _FIELDS[attribute.data_type]
        values = np.empty(width * len(attribute.data), number)
        attribute.data.foreach_get(field, values)
        yield Layer(attribute.name, attribute.data_type, values.reshape(-1, width))
