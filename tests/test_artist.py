"""What the artist has left on a mesh is on the result too, or it is said that it is gone."""

from typing import Any

import bpy
import numpy as np
import pytest
from test_operator import Open, addon, press

EDGE_LAYERS = {
    "sharp_edge": ("BOOLEAN", True),
    "uv_seam": ("BOOLEAN", True),
    "crease_edge": ("FLOAT", 0.6),
    "bevel_weight_edge": ("FLOAT", 0.25),
    "freestyle_edge": ("BOOLEAN", True),
    "Mine": ("INT", 7),
}


def sphere_with_ring(layers: dict[str, tuple[str, Any]]) -> Any:  # noqa: ANN401
    """A sphere whose edges around the middle have these values."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    thing = bpy.context.object
    for name, (kind, value) in layers.items():
        mesh = thing.data
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, "EDGE")
        for edge, each in zip(mesh.edges, attribute.data, strict=True):
            if all(abs(mesh.vertices[v].co.z) < 1e-6 for v in edge.vertices):
                each.value = value
    return thing


def values(mesh: Any, name: str) -> np.ndarray:  # noqa: ANN401
    attribute = mesh.attributes[name]
    assert (attribute.domain, len(attribute.data)) == ("EDGE", len(mesh.edges))
    return np.array([each.value for each in attribute.data])


def test_what_is_on_edges_is_on_those_that_lie_along_them(open_fixture: Open) -> None:
    open_fixture("03")
    thing = sphere_with_ring(EDGE_LAYERS)
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    is_on = np.array(
        [all(abs(mesh.vertices[v].co.z) < 1e-4 for v in edge.vertices) for edge in mesh.edges]
    )
    assert is_on.sum() >= 24
    for name, (kind, value) in EDGE_LAYERS.items():
        assert mesh.attributes[name].data_type == kind
        wanted = np.where(is_on, value, 0)
        assert values(mesh, name) == pytest.approx(wanted), name
    assert not mesh.validate()


def test_a_mark_that_ends_halfway_round_does_so_in_the_result(open_fixture: Open) -> None:
    open_fixture("03")
    thing = sphere_with_ring({"crease_edge": ("FLOAT", 1.0)})
    seam = thing.data.attributes.get("uv_seam")
    seam = seam or thing.data.attributes.new("uv_seam", "BOOLEAN", "EDGE")
    creases = values(thing.data, "crease_edge")
    middles = [sum(thing.data.vertices[v].co.x for v in edge.vertices) for edge in thing.data.edges]
    seam.data.foreach_set("value", (creases > 0) & (np.array(middles) > 0))
    press.orbflow_remesh(faces=400)
    mesh = thing.data
    ring, half = (values(mesh, name) > 0 for name in ("crease_edge", "uv_seam"))
    assert half.sum() == pytest.approx(ring.sum() / 2, abs=2)
    assert not (half & ~ring).any()
    right = [edge.vertices for edge, on in zip(mesh.edges, half, strict=True) if on]
    assert min(sum(mesh.vertices[v].co.x for v in ends) for ends in right) > -0.3


def test_marks_that_no_edge_lies_on_are_said_to_be_gone(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    thing = sphere_with_ring({"uv_seam": ("BOOLEAN", True)})
    press.orbflow_remesh(faces=400, marked_edges=set())
    assert "uv_seam" not in thing.data.attributes
    told = "of the marks of edges are gone: no edge lies there"
    assert told in capfd.readouterr().out
    (text,) = addon("panel").exceptions([addon("panel").last_report(thing.name)])
    assert text == f"100 % {told}"
