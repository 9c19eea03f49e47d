# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of vertices, corners and faces: UV maps, colors and attributes of the artist's own."""

from dataclasses import dataclass

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from .. import attributes
from . import layers
from .layers import Layer, Mix

Int = NDArray[np.int32]

_DOMAINS = ("POINT", "CORNER", "FACE")
# Texture coordinates of one place that differ by more are on two sides of a seam.
_APART = 1e-5


@dataclass(frozen=True)
class Elements:
    """The attributes by their domains."""

    layers: dict[str, list[Layer]]
    #: The vertex of every corner.
    corner_vert: Int
    #: The ends of the edges along which UV maps are cut, (E, 2).
    cuts: Int
    #: Which UV maps and colors are active.
    active: dict[str, str]


def read(mesh: bpy.types.Mesh) -> Elements:
    """Reads the attributes of a mesh."""
    found = {domain: list(layers.read(mesh, domain)) for domain in _DOMAINS}
    maps = [layer.values for layer in found["CORNER"] if layer.kind == "FLOAT2"]
    corners = attributes.corner_verts(mesh)
    return Elements(found, corners, _cuts(mesh, corners, maps), _active(mesh))


def write(mesh: bpy.types.Mesh, given: Elements, result: orbflow_native.Remeshed) -> Mix | None:
    """Gives a new mesh the same attributes; returns how vertices are mixed of old ones."""
    origins = result.origins
    if origins is None:
        return None
    of_vertices = Mix(given.corner_vert[origins.vertex_corners], origins.vertex_weights)
    of_corners = Mix(origins.corner_corners, origins.corner_weights)
    for layer in given.layers["POINT"]:
        layer.mixed(of_vertices).write(mesh, "POINT")
    for layer in given.layers["CORNER"]:
        layer.mixed(of_corners).write(mesh, "CORNER")
    for layer in given.layers["FACE"]:
        layer.taken(origins.faces).write(mesh, "FACE")
    for place, name in given.active.items():
        _activate(mesh, place, name)
    return of_vertices


def _cuts(mesh: bpy.types.Mesh, corner_vert: Int, maps: list[NDArray[np.float32]]) -> Int:
    """The edges at which a place has other texture coordinates on one side than on the other."""
    if not maps or not len(corner_vert):
        return np.empty((0, 2), np.int32)
    ends, sides = attributes.edge_verts(mesh), attributes.corner_edges(mesh)
    loops = np.arange(len(sides), dtype=np.int32)
    starts = attributes.loop_starts(mesh)
    # The last corner of a face is followed by its first.
    ahead = loops + 1
    ahead[np.append(starts[1:], len(sides)) - 1] = starts
    # Of every edge the sides on two faces, each by the corner it begins at.
    first, last = np.zeros((2, len(ends)), np.int32)
    first[sides[::-1]] = loops[::-1]
    last[sides] = loops
    is_turned = (corner_vert[first] != corner_vert[last])[:, None]
    is_cut = np.zeros(len(ends), bool)
    for coordinates in maps:
        here, there = coordinates[last], coordinates[ahead[last]]
        others = np.where(is_turned, there, here), np.where(is_turned, here, there)
        for corner, other in zip((first, ahead[first]), others, strict=True):
            is_cut |= (np.abs(coordinates[corner] - other) > _APART).any(axis=1)
    return ends[is_cut]


def _active(mesh: bpy.types.Mesh) -> dict[str, str]:
    """Which layers are active, by where Blender keeps that."""
    names = {}
    if mesh.uv_layers.active:
        names["uv"] = mesh.uv_layers.active.name
    for layer in mesh.uv_layers:
        if layer.active_render:
            names["render"] = layer.name
    if mesh.color_attributes.active_color_name:
        names["color"] = mesh.color_attributes.active_color_name
    if mesh.color_attributes.default_color_name:
        names["default"] = mesh.color_attributes.default_color_name
    return names


def _activate(mesh: bpy.types.Mesh, place: str, name: str) -> None:
    if place == "uv" and name in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[name]
    elif place == "render" and name in mesh.uv_layers:
        mesh.uv_layers[name].active_render = True
    elif place == "color" and name in mesh.color_attributes:
        mesh.color_attributes.active_color_name = name
    elif place == "default" and name in mesh.color_attributes:
        mesh.color_attributes.default_color_name = name
