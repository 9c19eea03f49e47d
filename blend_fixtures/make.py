"""Builds every .blend of this folder anew: python blend_fixtures/make.py (or make fixtures).

A fixture is a function named after its file; its docstring is its row in README.md.
"""

import lzma
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

HERE = Path(__file__).resolve().parent
FIXTURES: list[Callable[[], None]] = []


def fixture(build: Callable[[], None]) -> Callable[[], None]:
    """Marks a function as a fixture."""
    FIXTURES.append(build)
    return build


def link(name: str, mesh: bpy.types.Mesh) -> bpy.types.Object:
    """Puts a mesh into the scene as the active, selected object."""
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    return thing


def ball(name: str, subdivisions: int = 4, lumps: float = 0.2) -> bpy.types.Object:
    """An icosphere with lumps: closed, of genus 0, not quite symmetric."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions)
    thing = bpy.context.object
    thing.name = thing.data.name = name
    points = np.empty(3 * len(thing.data.vertices), np.float32)
    position = thing.data.attributes["position"].data
    position.foreach_get("vector", points)
    x, y, z = points.reshape(-1, 3).T
    lump = 1 + lumps * np.sin(3 * x + 1) * np.cos(2 * y) + lumps * np.sin(2 * z + x)
    position.foreach_set("vector", (points.reshape(-1, 3) * lump[:, None]).ravel())
    thing.data.update()
    return thing


def paint(thing: bpy.types.Object, *colours: tuple[float, float, float]) -> None:
    """Gives an object one material per colour, in layers from its lowest face to its highest."""
    for i, colour in enumerate(colours):
        material = bpy.data.materials.new(f"{thing.name} {i}")
        material.diffuse_color = (*colour, 1)
        thing.data.materials.append(material)
    heights = np.array([face.center[2] for face in thing.data.polygons])
    share = (heights - heights.min()) / np.ptp(heights)
    layer = np.minimum(len(colours) * share, len(colours) - 1).astype(np.int32)
    thing.data.polygons.foreach_set("material_index", layer)


@fixture
def f01_spot() -> None:
    """A real mesh of 23,062 triangles (Spot, a cow) with two materials; the demo's."""
    packed = (HERE / "meshes" / "spot.obj.xz").read_bytes()
    lines = lzma.decompress(packed).decode().splitlines()
    points = [[float(x) for x in line.split()[1:4]] for line in lines if line.startswith("v ")]
    faces = [[int(x) - 1 for x in line.split()[1:]] for line in lines if line.startswith("f ")]
    mesh = bpy.data.meshes.new("Spot")
    mesh.from_pydata([(x, -z, y) for x, y, z in points], [], faces)
    paint(link("Spot", mesh), (0.85, 0.80, 0.72), (0.45, 0.33, 0.25))


@fixture
def f02_several_objects() -> None:
    """Three closed objects, all selected."""
    for i, name in enumerate(["Left", "Middle", "Right"]):
        ball(name, subdivisions=3 + i % 2).location.x = 3 * i
    bpy.ops.object.select_all(action="SELECT")


@fixture
def f03_shared_data() -> None:
    """Two objects with one mesh; the first one is selected."""
    first = ball("First")
    second = link("Second", first.data)
    second.location.x = 3
    second.select_set(False)
    bpy.context.view_layer.objects.active = first


@fixture
def f04_dressed() -> None:
    """An object with parent, turned and moved, modifiers, three materials, custom property."""
    thing = ball("Dressed")
    paint(thing, (0.8, 0.2, 0.2), (0.2, 0.8, 0.2), (0.2, 0.2, 0.8))
    thing.data["made_by"] = "make.py"
    thing.location, thing.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    thing.modifiers.new("Smoother", "SUBSURF").levels = 1
    thing.modifiers.new("Shell", "SOLIDIFY").thickness = 0.01
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location = (5, 0, 0)
    thing.parent = parent


@fixture
def f05_open_border() -> None:
    """A half sphere: one border loop."""
    thing = ball("Half", lumps=0)
    mesh = thing.data
    keep = [list(face.vertices) for face in mesh.polygons if face.center[2] > 0]
    points = [vertex.co[:] for vertex in mesh.vertices]
    mesh.clear_geometry()
    mesh.from_pydata(points, [], keep)


@fixture
def f06_handle() -> None:
    """A torus: closed, genus 1."""
    bpy.ops.mesh.primitive_torus_add()
    bpy.context.object.name = bpy.context.object.data.name = "Handle"


@fixture
def f07_empty_mesh() -> None:
    """A mesh object without a single vertex."""
    link("Empty", bpy.data.meshes.new("Empty"))


@fixture
def f08_stretched() -> None:
    """A ball whose object is scaled by 1, 1, 4: faces must be even as seen, not as stored."""
    ball("Stretched", lumps=0).scale = (1, 1, 4)


@fixture
def f09_artist_data() -> None:
    """A ball with a UV map, a vertex group, a shape key and flat shading."""
    thing = ball("Artist")
    thing.data.uv_layers.new(name="Map")
    thing.vertex_groups.new(name="Weight").add(range(100), 0.5, "REPLACE")
    thing.shape_key_add(name="Basis")
    thing.shape_key_add(name="Smile")
    thing.data.shade_flat()


@fixture
def f10_three_faces_at_an_edge() -> None:
    """A tetrahedron with a fin: an edge with three faces."""
    mesh = bpy.data.meshes.new("Fin")
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]
    mesh.from_pydata(points, [], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 1, 4)])
    link("Fin", mesh)


@fixture
def f11_parts() -> None:
    """One object of two closed parts, one large, one small."""
    ball("Parts")
    ball("Small", subdivisions=3).location.x = 4
    bpy.context.object.scale = (0.5, 0.5, 0.5)
    bpy.ops.object.transform_apply(location=True, scale=True)
    bpy.ops.object.select_all(action="SELECT")
    bpy.context.view_layer.objects.active = bpy.data.objects["Parts"]
    bpy.ops.object.join()


@fixture
def f12_quads_and_more() -> None:
    """A cube of quads with a roof of triangles and one face turned the wrong way."""
    bpy.ops.mesh.primitive_cube_add()
    thing = bpy.context.object
    thing.name = thing.data.name = "Cube"
    points = [*(vertex.co[:] for vertex in thing.data.vertices), (0, 0, 2)]
    faces = [list(face.vertices) for face in thing.data.polygons]
    top = next(face for face in faces if all(points[v][2] > 0 for v in face))
    faces.remove(top)
    faces += [[top[i], top[(i + 1) % 4], 8] for i in range(4)]
    faces[0].reverse()
    thing.data.clear_geometry()
    thing.data.from_pydata(points, [], faces)


def main() -> None:
    """Writes every fixture and the table of README.md."""
    rows = []
    for build in FIXTURES:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        build()
        name = f"{build.__name__[1:]}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(HERE / name), compress=True)
        rows.append(f"| `{name}` | {build.__doc__} |")
        (HERE / f"{name}1").unlink(missing_ok=True)
    head = (
        "# Fixtures\n\n`make.py` makes every file; a mesh that comes from elsewhere is in `meshes/`"
    )
    table = "\n".join(["| file | what |", "|---|---|", *rows])
    (HERE / "README.md").write_text(f"{head} with its licence.\n\n{table}\n")


if __name__ == "__main__":
    main()
