"""The original is drawn over the result; the file and its undo steps know nothing of it."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix
from shapes import ball
from sidebar import drawn
from test_operator import Open, addon, arrays, press


def slider() -> float:
    return bpy.context.window_manager.orbflow_before


def slide(share: float) -> None:
    bpy.context.window_manager.orbflow_before = share


def given(thing: Any) -> tuple[bytes, ...] | None:  # noqa: ANN401
    """What is kept of an object as it was, as `arrays` tells it."""
    found = addon("earlier").of(thing)
    if found is None:
        return None
    return found.positions.tobytes(), found.loop_start.tobytes(), found.corner_vert.tobytes()


def test_what_a_run_was_given_is_kept_without_a_copy(open_fixture: Open) -> None:
    first = open_fixture("03")
    before = arrays(first)
    assert given(first) is None
    assert not dict(drawn(first))["orbflow_before"].active
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
    assert len(bpy.data.objects) == 2
    assert given(first) == before
    assert dict(drawn(first))["orbflow_before"].active
    first.data.vertices[0].co.x += 1
    assert given(first) is None


def test_the_slider_is_in_no_file(open_fixture: Open, tmp_path: Path) -> None:
    open_fixture("03")
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
    paths = [tmp_path / f"{share}.blend" for share in (0.0, 0.75)]
    n_data = len(bpy.data.meshes), len(bpy.data.objects), len(bpy.data.scenes)
    for path, share in zip(paths, (0.0, 0.75), strict=True):
        slide(share)
        assert slider() == share
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False, copy=True)
    assert (len(bpy.data.meshes), len(bpy.data.objects), len(bpy.data.scenes)) == n_data
    # Blender writes addresses, which differ, but not a byte more.
    assert paths[0].stat().st_size == paths[1].stat().st_size
    bpy.ops.wm.open_mainfile(filepath=str(paths[1]))
    assert slider() == 0
    assert addon("earlier")._kept == {}


def test_a_kept_original_is_shown_after_the_file_was_opened_again(
    open_fixture: Open, tmp_path: Path
) -> None:
    first = open_fixture("03")
    before = arrays(first)
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE", keep_original=True)
    path = str(tmp_path / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    first = bpy.data.objects["First"]
    n_data = len(bpy.data.meshes), len(bpy.data.objects)
    assert dict(drawn(first))["orbflow_before"].active
    slide(0.5)
    assert given(first) == before
    assert (len(bpy.data.meshes), len(bpy.data.objects)) == n_data


def test_a_key_can_be_given_to_it(open_fixture: Open) -> None:
    open_fixture("03")
    with pytest.raises(RuntimeError, match="no run of this session made it"):
        press.orbflow_before()
    press.orbflow_remesh(faces=200, primitive="QUAD_SPHERE")
    for share in (1.0, 0.0):
        assert press.orbflow_before() == {"FINISHED"}
        assert slider() == share
    assert "UNDO" not in addon("operators.before").OBJECT_OT_orbflow_before.bl_options


def test_as_much_is_kept_as_there_is_room_for(
    open_fixture: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = open_fixture("03")
    earlier, read = addon("earlier"), addon("mesh_arrays").read
    monkeypatch.setattr(earlier, "_MOST_BYTES", 3 * earlier._n_bytes(read(first.data)) + 1)
    for i in range(6):
        first.data.vertices[0].co.x = i
        earlier.remember(first, read(first.data))
    assert len(earlier._kept) == 3
    assert given(first) == arrays(first)


@pytest.mark.usefixtures("_extension")
def test_what_is_drawn_are_the_triangles_of_all_faces_in_light() -> None:
    mesh_arrays, earlier = addon("mesh_arrays"), addon("earlier")
    positions, starts, corners = ball()
    made = earlier.picture(mesh_arrays.MeshArrays(positions, starts, corners, None), Matrix())
    assert np.array_equal(made.positions, positions[corners])
    assert made.colours.shape == (len(corners), 4)
    assert (made.colours[:, 3] == 1).all()
    bright = made.colours[:, :3].sum(axis=1)
    towards = made.positions @ earlier._LIGHT
    assert np.corrcoef(bright, towards)[0, 1] > 0.8
    turned = Euler((0, 0, np.pi)).to_matrix().to_4x4()
    other = earlier.picture(mesh_arrays.MeshArrays(positions, starts, corners, None), turned)
    assert not np.allclose(other.colours, made.colours, atol=0.1)


@pytest.mark.usefixtures("_extension")
def test_faces_of_many_corners_are_drawn_whole_and_edges_hard() -> None:
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.mesh.primitive_cylinder_add(vertices=16)
    mesh = addon("mesh_arrays").read(bpy.context.object.data)
    made = addon("earlier").picture(mesh, Matrix())
    one, two, three = made.positions.reshape(-1, 3, 3).astype(float).transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(two - one, three - one), axis=1).sum() / 2
    assert area == pytest.approx(addon("size").area(mesh, (1, 1, 1)), rel=1e-5)
    is_top = (made.positions.reshape(-1, 3, 3)[:, :, 2] == 1).all(axis=1)
    top = made.colours.reshape(-1, 3, 4)[is_top]
    assert np.ptp(top[..., 0]) < 1e-6
