# SPDX-License-Identifier: GPL-3.0-or-later
"""What modifiers make of a mesh: what is seen is what is remeshed.

Modifiers that make geometry go into the result and leave the stack, and so do all before the last
of them that is shown, in the stack's order. What follows a pose, a simulation or the time stays,
and is off meanwhile; so is what follows the last one.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import bpy
import numpy as np
import orbflow_native
from mathutils import kdtree

from . import attributes, half, mesh_arrays
from .artist import keys, layers
from .artist.keys import Key
from .half import Half
from .mesh_arrays import MeshArrays
from .stand_in import StandIns
from .translations import n_, rpt_

# Modifiers that make or remove vertices, edges or faces.
_GENERATIVE = {
    "ARRAY",
    "BEVEL",
    "BOOLEAN",
    "BUILD",
    "DECIMATE",
    "MASK",
    "MIRROR",
    "MULTIRES",
    "PARTICLE_INSTANCE",
    "REMESH",
    "SCREW",
    "SKIN",
    "SOLIDIFY",
    "SUBSURF",
    "TRIANGULATE",
    "WELD",
    "WIREFRAME",
}
# Modifiers that stay wherever they are in the stack, because what they do is no shape of the mesh.
_KEPT = {
    # They follow a pose: bones, a cage, a path, a handle; or they mend what comes of it.
    "ARMATURE",
    "CORRECTIVE_SMOOTH",
    "CURVE",
    "HOOK",
    "LAPLACIANDEFORM",
    "LATTICE",
    "MESH_DEFORM",
    "SURFACE_DEFORM",
    "WARP",
    # They follow time.
    "CLOTH",
    "COLLISION",
    "DYNAMIC_PAINT",
    "EXPLODE",
    "FLUID",
    "MESH_CACHE",
    "MESH_SEQUENCE_CACHE",
    "OCEAN",
    "PARTICLE_SYSTEM",
    "SOFT_BODY",
    "SURFACE",
    "WAVE",
    # They make no faces: normals alone, lines, a volume.
    "LINEART",
    "MESH_TO_VOLUME",
    "NORMAL_EDIT",
    "WEIGHTED_NORMAL",
}
# Properties of a modifier that change nothing of what is seen.
_UNSEEN = {
    "execution_time",
    "is_active",
    "is_override_data",
    "persistent_uid",
    "render_levels",
    "rna_type",
    "show_expanded",
    "show_in_editmode",
    "show_on_cage",
    "show_render",
    "use_pin_to_last",
}

# Attributes that are as seen when they are gone.
_SHADING = {"sharp_face", "sharp_edge"}

# Borders no farther from each other than this share of the diagonal are welded by the core.
_WELD = 1e-5

# A material's name and the file it is linked from.
Named = tuple[str, str | None]


class Wanted(Protocol):
    """The settings that say what is done with modifiers."""

    use_modifiers: bool
    mirror_modifier: str


@dataclass(frozen=True)
class Stack:
    """The modifiers of an object that go into the result."""

    names: tuple[str, ...]
    #: What they are set to: objects of one mesh for which it is equal are seen alike.
    settings: tuple[Any, ...]
    #: Which half of the result stays, where one of them makes it whole.
    half: Half | None

    def leaving(self) -> list[str]:
        """Those that leave the object's stack."""
        return [each for each in self.names if not self.half or each != self.half.modifier]


@dataclass(frozen=True)
class Applied:
    """How the mesh that is remeshed was made of the object's own."""

    stack: Stack
    #: The object's own mesh.
    base: MeshArrays
    #: Of the mesh that is seen: some modifiers bring more.
    materials: tuple[Named | None, ...]


@dataclass(frozen=True)
class Seen:
    """What is seen of an object, as long as there is the copy that was evaluated."""

    #: The object, or one that stands for it and has as its mesh what is seen.
    thing: bpy.types.Object
    keys: list[Key]
    #: What is lost by evaluating, in words.
    lost: list[str]
    applied: Applied | None = None


_SCULPT = n_("apply or remove modifier {} first: it holds a sculpt")


class Refused(Exception):
    """Modifiers of an object hinder a run."""


def stack(copies: StandIns, thing: bpy.types.Object, wanted: Wanted) -> Stack:
    """What of an object's modifiers goes into the result; raises `Refused`."""
    names = _applied(copies, thing) if wanted.use_modifiers else ()
    for each in thing.modifiers:
        if each.type == "MULTIRES" and each.total_levels and each.name not in names:
            raise Refused(rpt_(_SCULPT).format(each.name))
        if each.name in names and thing.override_library and each.is_override_data:
            told = rpt_("modifier {} is linked from another file and cannot be applied")
            raise Refused(told.format(each.name))
        if each.type == "MIRROR" and each.show_viewport and not names and _is_open(thing.data):
            told = rpt_("it is open where modifier {} closes it: switch on Apply Modifiers")
            raise Refused(told.format(each.name))
    try:
        kept = half.of(thing, names) if wanted.mirror_modifier == "HALF" else None
    except half.NoHalf as error:
        raise Refused(str(error)) from error
    return Stack(names, _settings_of(thing, names), kept)


def none(thing: bpy.types.Object) -> Stack:
    """That nothing goes in: the mesh is taken as it is stored; raises `Refused`."""
    for each in thing.modifiers:
        if each.type == "MULTIRES" and each.total_levels:
            raise Refused(rpt_(_SCULPT).format(each.name))
    return Stack((), (), None)


def _applied(copies: StandIns, thing: bpy.types.Object) -> tuple[str, ...]:
    """Those up to the last shown one that makes geometry."""
    counted = [each for each in thing.modifiers if each.show_viewport and each.type not in _KEPT]
    names = [each.name for each in counted]
    makes = [_is_generative(copies.context, each) for each in counted]
    n = max((i + 1 for i, is_generative in enumerate(makes) if is_generative), default=0)
    # Nodes may do anything: they count where they change the faces.
    nodes = [i for i in range(n, len(counted)) if has_nodes(counted[i])]
    changing = (i for i in reversed(nodes) if copies.of(thing).is_changed(names[:i], names[i]))
    return tuple(names[: next(changing, n - 1) + 1])


def are_unchanged(thing: bpy.types.Object, given: Stack) -> bool:
    """Whether an object has modifiers still, set as they were."""
    return _settings_of(thing, given.names) == given.settings


def _settings_of(thing: bpy.types.Object, names: tuple[str, ...]) -> tuple[Any, ...]:
    return tuple(_settings(thing, thing.modifiers.get(name)) for name in names)


def seen(copies: StandIns, thing: bpy.types.Object, given: Stack) -> Seen:
    """What is seen of an object with modifiers of its stack; raises `Refused` where no face is."""
    if not given.names:
        return Seen(thing, keys.read(thing.data), [])
    copy = copies.of(thing)
    mesh, moved, lost = copy.evaluated_with_keys(given.names)
    told = ", ".join(given.names)
    if not mesh.polygons and thing.data.polygons:
        why = rpt_("modifiers {} leave no faces; instances have to be realized first")
        raise Refused(why.format(told))
    if _is_torn(thing.data, mesh):
        why = rpt_(
            "modifiers {} tear it open where vertices only lie on each other: merge them by "
            "distance, or switch off Apply Modifiers"
        )
        raise Refused(why.format(told))
    copy.thing.data = mesh
    base = mesh_arrays.read(thing.data)
    materials = tuple(each and (each.name, _file_of(each)) for each in mesh.materials)
    hidden = [_unseen_levels(copies.context, each) for each in thing.modifiers]
    lost += [text for text in hidden if text] + _dropped(thing, mesh)
    return Seen(copy.thing, moved, lost, Applied(given, base, materials))


def leave(things: list[bpy.types.Object], gone: Applied) -> None:
    """Takes modifiers that went into the mesh of objects from their stacks; adds materials."""
    for thing in things:
        for name in gone.stack.leaving():
            _remove(thing, name)
    materials = things[0].data.materials
    for i, named in enumerate(gone.materials):
        material = named and bpy.data.materials.get(named)
        if i == len(materials):
            materials.append(material)
        elif materials[i] != material:
            materials[i] = material


def _remove(thing: bpy.types.Object, name: str) -> None:
    """Takes a modifier from a stack, with its drivers, which Blender 4.2 leaves."""
    if (modifier := thing.modifiers.get(name)) is not None:
        thing.modifiers.remove(modifier)
    if thing.animation_data:
        drivers, path = thing.animation_data.drivers, bpy.utils.escape_identifier(name)
        for driver in [each for each in drivers if f'modifiers["{path}"]' in each.data_path]:
            drivers.remove(driver)


def rest_of(result: orbflow_native.Remeshed, applied: Applied | None) -> orbflow_native.Remeshed:
    """What of a result the object gets: all, or the half that a modifier makes whole.

    Raises `Refused` where it has no halves.
    """
    if not applied or not applied.stack.half:
        return result
    try:
        return half.cut(result, applied.stack.half)
    except half.NoHalf as error:
        raise Refused(str(error)) from error


def told(applied: Applied | None) -> dict[str, Any]:
    """What a report says of modifiers: which went into the result, and which makes it whole."""
    if applied is None:
        return {"modifiers": [], "half": None}
    kept = applied.stack.half
    return {"modifiers": applied.stack.leaving(), "half": kept and kept.modifier}


def _is_generative(context: bpy.types.Context, modifier: bpy.types.Modifier) -> bool:
    if modifier.type == "MULTIRES":
        return _levels(context, modifier) > 0
    return modifier.type in _GENERATIVE


def has_nodes(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier runs geometry nodes."""
    return modifier.type == "NODES" and modifier.node_group is not None


def _levels(context: bpy.types.Context, multires: bpy.types.Modifier) -> int:
    """How many levels of a sculpt are seen."""
    render = context.scene.render
    most = render.simplify_subdivision if render.use_simplify else multires.levels
    return min(multires.levels, most)


def _unseen_levels(context: bpy.types.Context, modifier: bpy.types.Modifier) -> str:
    if modifier.type != "MULTIRES" or not modifier.total_levels:
        return ""
    seen_levels, last = _levels(context, modifier), modifier.total_levels
    if seen_levels == last:
        return ""
    first = seen_levels + 1
    if first == last:
        return rpt_("level {} of modifier {}").format(last, modifier.name)
    return rpt_("levels {} to {} of modifier {}").format(first, last, modifier.name)


def _settings(thing: bpy.types.Object, modifier: bpy.types.Modifier | None) -> Any:  # noqa: ANN401
    if modifier is None:
        return None
    told: list[Any] = []
    for each in modifier.bl_rna.properties:
        is_unseen = each.identifier in _UNSEEN or each.type == "COLLECTION"
        if is_unseen or (each.identifier == "custom_profile" and _is_plain(modifier)):
            continue
        value = getattr(modifier, each.identifier)
        if each.type == "POINTER":
            value = _pointed_at(thing, value)
        elif getattr(each, "is_array", False):
            value = tuple(np.ravel(value).tolist())
        told.append((each.identifier, frozenset(value) if isinstance(value, set) else value))
    return tuple(told)


def _is_plain(modifier: bpy.types.Modifier) -> bool:
    return modifier.profile_type != "CUSTOM"


def _pointed_at(thing: bpy.types.Object, value: Any) -> Any:  # noqa: ANN401 - any property
    """What tells what a property names: of each object another where it is not told in full."""
    is_told = value is None or isinstance(value, bpy.types.Image | bpy.types.Texture)
    return (value and value.name_full) if is_told else (thing.name, getattr(value, "name_full", ""))


def _dropped(thing: bpy.types.Object, mesh: bpy.types.Mesh) -> list[str]:
    """What of the artist's is on an object's mesh, but not on what modifiers have made of it."""
    base = thing.data
    is_turned = base.has_custom_normals and not mesh.has_custom_normals
    told = [rpt_("custom normals")] * is_turned + [
        rpt_("attribute {}").format(layer.name)
        for domain in ("POINT", "EDGE", "CORNER", "FACE")
        for layer in layers.read(base, domain)
        if layer.name not in _SHADING and layer.name not in mesh.attributes and layer.values.any()
    ]
    if thing.vertex_groups and _is_weighted(base) and not _is_weighted(mesh):
        told.append(rpt_("vertex groups"))
    return told


def _is_weighted(mesh: bpy.types.Mesh) -> bool:
    return any(vertex.groups for vertex in mesh.vertices)


def _is_open(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh has borders."""
    return bool((np.bincount(attributes.corner_edges(mesh), minlength=1) == 1).any())


def _is_torn(base: bpy.types.Mesh, mesh: bpy.types.Mesh) -> bool:
    """Whether modifiers move vertices apart that lie on each other and close a mesh."""
    return _is_open(base) and _is_open(mesh) and not _is_gaping(base) and _is_gaping(mesh)


def _is_gaping(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh has borders even where those that lie on each other are one."""
    # Zero has two signs.
    places = attributes.positions(mesh) + np.float32(0)
    _, first, vertex = np.unique(places, axis=0, return_index=True, return_inverse=True)
    ends = vertex.ravel()[attributes.edge_verts(mesh)[attributes.corner_edges(mesh)]]
    sides, counts = np.unique(np.sort(ends, axis=1), axis=0, return_counts=True)
    border = sides[(counts == 1) & (sides[:, 0] != sides[:, 1])]
    if not len(border):
        return False
    middles = places[first][border].mean(axis=1)
    tree = kdtree.KDTree(len(middles))
    for i, middle in enumerate(middles.tolist()):
        tree.insert(middle, i)
    tree.balance()
    least = _WELD * float(np.linalg.norm(np.ptp(places, axis=0)))
    # The nearest is itself.
    return any(tree.find_n(middle, 2)[-1][2] > least for middle in middles.tolist())


def _file_of(material: bpy.types.Material) -> str | None:
    return material.library.filepath if material.library else None
