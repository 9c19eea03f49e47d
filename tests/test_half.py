"""The half of a result can be kept, with the modifier that makes it whole."""

import bmesh
import bpy
import numpy as np
import pytest
from test_modifiers import (
    _nothing_is_left,  # noqa: F401 - holds for every test here too
    half_ball,
    is_closed,
    is_symmetric,
    places,
    seen,
    stack,
    told,
)
from test_operator import Open, arrays, is_sound, press


@pytest.mark.parametrize("turn", [1, -1])
def test_a_half_can_be_kept_with_the_modifier_that_makes_it_whole(
    open_fixture: Open, capfd: pytest.CaptureFixture[str], turn: int
) -> None:
    thing = half_ball(open_fixture)
    thing.modifiers.new("Grid", "SUBSURF").levels = 1
    thing.data.uv_layers.new(name="Map")
    for vertex in thing.data.vertices:
        vertex.co.x *= turn
        vertex.co.z *= 2
    for corner, place in zip(thing.data.loops, thing.data.uv_layers["Map"].data, strict=True):
        place.uv = thing.data.vertices[corner.vertex_index].co.yz
    for edge in thing.data.edges:
        edge.use_edge_sharp = all(abs(thing.data.vertices[v].co.z) < 1e-4 for v in edge.vertices)
    bottom = seen(thing)[:, 2].min()
    press.orbflow_remesh(faces=400, mirror_modifier="HALF", mirror="Y")
    assert stack(thing) == ["Mirror"]
    half = places(thing.data)
    assert (turn * half[:, 0]).min() == 0
    assert 190 <= len(thing.data.polygons) <= 210
    assert is_sound(thing)
    built = bmesh.new()
    built.from_mesh(thing.data)
    border = [vertex.co.x for edge in built.edges if edge.is_boundary for vertex in edge.verts]
    built.free()
    assert len(border) > 20
    assert set(border) == {0}
    assert half[:, 2].min() == pytest.approx(bottom, abs=0.03)
    for corner, place in zip(thing.data.loops, thing.data.uv_layers["Map"].data, strict=True):
        assert tuple(place.uv) == pytest.approx(half[corner.vertex_index, 1:], abs=0.1)
    sharp = [edge.vertices for edge in thing.data.edges if edge.use_edge_sharp]
    assert len(sharp) > 4
    assert np.abs(half[np.array(sharp)][:, :, 2]).max() < 0.01
    whole = thing.evaluated_get(bpy.context.view_layer.depsgraph).to_mesh()
    assert is_closed(whole)
    assert is_symmetric(whole)
    assert told(thing)["half"] == "Mirror"
    line = "modifiers applied: Grid; half is kept: modifier Mirror makes it whole"
    assert line in capfd.readouterr().out


def test_where_there_is_no_half_to_keep_it_is_said(open_fixture: Open) -> None:
    thing = half_ball(open_fixture)
    before = arrays(thing)
    with pytest.raises(RuntimeError, match=r"no half can be kept: [0-9]+ faces cross the plane"):
        press.orbflow_remesh(faces=100, kind="TRIANGLES", mirror_modifier="HALF")
    thing.modifiers["Mirror"].use_axis[1] = True
    with pytest.raises(RuntimeError, match="than across one axis of the object"):
        press.orbflow_remesh(faces=100, mirror_modifier="HALF")
    assert (arrays(thing), stack(thing)) == (before, ["Mirror"])
