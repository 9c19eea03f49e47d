"""Sets meshes side by side in Blender and renders them with their edges."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

CELL_PX = 480
# Rows of a tall picture are drawn smaller: it is scrolled, not looked at as a whole.
SMALL_CELL_PX, TALL = 330, 4
MARK = 0.0075
LABEL_SIZE = 0.075


@dataclass(frozen=True)
class Exhibit:
    """A mesh file, what is written under it, and how it stands.

    `colours` is another mesh file with the same vertices whose positions give the colours: so the
    same place has the same colour on the surface and on the sphere. With marks, irregular vertices
    of quads are shown: blue where one edge is missing, red where there is one too many, else black.
    """

    path: Path
    label: str
    colours: Path | None = None
    edges: float = 0.0022
    turn_deg: float = 35.0
    tilt_deg: float = 18.0
    is_y_up: bool = True
    has_marks: bool = False


def picture(rows: Sequence[Sequence[Exhibit]], out: Path, cell_px: int | None = None) -> None:
    """Renders rows of exhibits, each scaled into a cell of its own, to a PNG or a small JPEG."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    n_columns = max(map(len, rows))
    for i, row in enumerate(rows):
        for j, exhibit in enumerate(row):
            _place(exhibit, np.array([j - (n_columns - 1) / 2, 0.0, (len(rows) - 1) / 2 - i]))
    _camera(n_columns, len(rows))
    cell = cell_px or (SMALL_CELL_PX if len(rows) > TALL else CELL_PX)
    _render(n_columns * cell, len(rows) * cell, out)


def _place(exhibit: Exhibit, centre: NDArray[np.float64]) -> None:
    bpy.ops.wm.obj_import(filepath=str(exhibit.path), forward_axis="Y", up_axis="Z")
    solid = bpy.context.selected_objects[0]
    mesh = solid.data
    points = _positions(mesh)
    colours = _colours(exhibit, points)
    turned = points @ _rotation(exhibit).T
    low, high = turned.min(0), turned.max(0)
    scaled = (turned - (low + high) / 2) * (0.86 / max(high - low)) + centre + [0, 0, 0.04]
    mesh.attributes["position"].data.foreach_set("vector", scaled.astype(np.float32).ravel())
    attribute = mesh.color_attributes.new("colour", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", colours.astype(np.float32).ravel())
    mesh.update()
    if exhibit.has_marks:
        _marks(mesh)
    _wires(solid, exhibit.edges)
    _label(exhibit.label, centre)


def _positions(mesh: bpy.types.Mesh) -> NDArray[np.float64]:
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def _rotation(exhibit: Exhibit) -> NDArray[np.float64]:
    turn, tilt = np.radians([exhibit.turn_deg, exhibit.tilt_deg])
    up = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) if exhibit.is_y_up else np.eye(3)
    around = np.array(
        [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    )
    over = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    return over @ around @ up


def _colours(exhibit: Exhibit, points: NDArray[np.float64]) -> NDArray[np.float64]:
    grey = np.full((len(points), 4), [0.8, 0.8, 0.8, 1.0])
    if exhibit.colours is None:
        return grey
    lines = exhibit.colours.read_text().splitlines()
    sphere = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    grey[:, :3] = 0.55 + 0.4 * sphere / np.linalg.norm(sphere, axis=1, keepdims=True)
    return grey


def _wires(solid: bpy.types.Object, thickness: float) -> None:
    wire = solid.copy()
    wire.data = solid.data.copy()
    dark = np.tile(np.array([0.03, 0.03, 0.05, 1.0], np.float32), len(wire.data.vertices))
    wire.data.color_attributes["colour"].data.foreach_set("color", dark)
    modifier = wire.modifiers.new("wire", "WIREFRAME")
    modifier.thickness, modifier.use_even_offset = thickness, False
    bpy.context.scene.collection.objects.link(wire)


def _marks(mesh: bpy.types.Mesh) -> None:
    """An octahedron round every vertex that does not have four edges."""
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    valences = np.bincount(ends, minlength=len(mesh.vertices))
    where = np.flatnonzero(valences != 4)
    corners = np.concatenate([np.eye(3), -np.eye(3)]) * MARK
    faces = [(i, j, k) for i in (0, 3) for j in (1, 4) for k in (2, 5)]
    points = (_positions(mesh)[where][:, None] + corners).reshape(-1, 3)
    all_faces = (6 * np.arange(len(where))[:, None, None] + np.array(faces)).reshape(-1, 3)
    marks = bpy.data.meshes.new("marks")
    marks.from_pydata(points, [], all_faces)
    colours = np.array([_mark_colour(n) for n in valences[where]], np.float32)
    attribute = marks.color_attributes.new("colour", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.repeat(colours, len(corners), 0).ravel())
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("marks", marks))


def _mark_colour(valence: int) -> tuple[float, float, float, float]:
    return {3: (0.1, 0.35, 1.0, 1.0), 5: (1.0, 0.1, 0.1, 1.0)}.get(valence, (0.0, 0.0, 0.0, 1.0))


def _label(text: str, centre: NDArray[np.float64]) -> None:
    curve = bpy.data.curves.new("label", "FONT")
    curve.body, curve.size, curve.align_x, curve.align_y = text, LABEL_SIZE, "CENTER", "BOTTOM"
    curve.size = min(LABEL_SIZE, 1.7 / max(len(text), 1))
    label = bpy.data.objects.new("label", curve)
    label.rotation_euler = (np.pi / 2, 0, 0)
    label.location = (centre[0], -1.0, centre[2] - 0.49)
    bpy.context.scene.collection.objects.link(label)


def _camera(n_columns: int, n_rows: int) -> None:
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(n_columns, n_rows)
    camera.location, camera.rotation_euler = (0, -20, 0), (np.pi / 2, 0, 0)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def _render(width: int, height: int, out: Path) -> None:
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.film_transparent = False
    scene.render.filepath = str(out)
    scene.render.image_settings.file_format = "JPEG" if out.suffix == ".jpg" else "PNG"
    scene.render.image_settings.quality = 80
    scene.render.image_settings.color_mode = "RGB"
    scene.display.render_aa = "16"
    shading = scene.display.shading
    shading.light, shading.color_type = "STUDIO", "VERTEX"
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (1, 1, 1)
    scene.view_settings.view_transform = "Standard"
    out.parent.mkdir(parents=True, exist_ok=True)
    bpy.ops.render.render(write_still=True)
