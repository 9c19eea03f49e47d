# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of vertices, corners and faces: UV maps, colors and attributes of the artist's own."""

from dataclasses import dataclass

import bpy
import numpy as np
import orbflow_native
from numpy.typing import NDArray

from .. import attributes
from . import cuts, layers, normals
from .layers import Layer, Mix

Int = NDArray[np.int32]

_DOMAINS = ("POINT", "CORNER", "FACE")


@dataclass(frozen=True)
class Elements:
    """The attributes by their domains."""

    layers: dict[str, list[Layer]]
    #: The vertex of every corner.
    corner_vert: Int
    #: Sets of edges along which layers of corners are cut, each by the edges' ends, (E, 2).
    cuts: list[Int]
    #: By which of the sets each layer of corners is cut.
    cut_by: list[int]
    #: Which UV maps and colors are active.
    active: dict[str, str]
    #: The artist's normals of corners; they are cut by the last of `cut_by`.
    normals: Layer | None = None


def read(mesh: bpy.types.Mesh) -> Elements:
    """Reads the attributes of a mesh."""
    found = {domain: list(layers.read(mesh, domain)) for domain in _DOMAINS}
    corners = attributes.corner_verts(mesh)
    turned = normals.read(mesh)
    of_corners = found["CORNER"] + ([turned] if turned else [])
    return Elements(found, corners, *cuts.of_layers(mesh, of_corners), _active(mesh), turned)


def write(mesh: bpy.types.Mesh, given: Elements, result: orbflow_native.Remeshed) -> Mix | None:
    """Gives a new mesh the same attributes; returns how vertices are mixed of old ones."""
    origins = result.origins
    if origins is None:
        return None
    of_vertices = Mix(given.corner_vert[origins.vertex_corners], origins.vertex_weights)
    of_corners = [
        Mix(corners, weights)
        for corners, weights in zip(origins.corner_corners, origins.corner_weights, strict=True)
    ]
    for layer in given.layers["POINT"]:
        layer.mixed(of_vertices).write(mesh, "POINT")
    for layer, number in zip(given.layers["CORNER"], given.cut_by, strict=False):
        layer.mixed(of_corners[number]).write(mesh, "CORNER")
    for layer in given.layers["FACE"]:
        layer.taken(origins.faces).write(mesh, "FACE")
    for place, name in given.active.items():
        _activate(mesh, place, name)
    if given.normals:
        normals.write(mesh, given.normals, of_corners[given.cut_by[-1]])
    return of_vertices


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
