"""Runs of the real core along lines that are drawn."""

import bpy
import numpy as np
from test_draw_guides import ball
from test_guides import curve
from test_operator import Open, addon, press, select

# A ring round a ball of radius 1 that no other thing asks for: tilted against all axes.
NORMAL = np.array((0.3, 0.4, 1.0)) / np.linalg.norm((0.3, 0.4, 1.0))


def ring(radius: float = 1.0, n: int = 64) -> list[tuple[float, ...]]:
    """Points on a great circle."""
    side = np.cross(NORMAL, (1.0, 0, 0))
    side /= np.linalg.norm(side)
    up = np.cross(NORMAL, side)
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)[:, None]
    return [tuple(p) for p in radius * (np.cos(angles) * side + np.sin(angles) * up)]


def length_on_ring(thing: bpy.types.Object) -> float:
    """How long the edges are that lie on the ring."""
    points = np.array([vertex.co for vertex in thing.data.vertices])
    ends = points[np.array([edge.vertices for edge in thing.data.edges])]
    is_on = (np.abs(ends @ NORMAL) < 0.02).all(axis=1)
    return float(np.linalg.norm(ends[is_on, 0] - ends[is_on, 1], axis=1).sum())


def test_edges_lie_on_an_exact_loop(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    curve("Exact Ring", ring(), is_closed=True)
    select(thing)
    bpy.context.view_layer.objects.active = thing
    plain = thing.data.copy()
    assert press.orbflow_remesh(faces=600, guides="Exact Ring") == {"FINISHED"}
    (told,) = addon("runs").last_report(thing.name)["guides"]
    assert (told["outcome"], told["strength"], told["name"]) == ("laid", "exact", "Exact Ring")
    assert length_on_ring(thing) > 0.9 * 2 * np.pi
    rows = dict(addon("panel").rows(addon("runs").last_report(thing.name)))
    assert rows["Guides"] == "1 laid"
    thing.data = plain
    press.orbflow_remesh(faces=600)
    assert length_on_ring(thing) < 0.4 * 2 * np.pi


def test_edges_follow_what_is_drawn_in_a_second_run_too(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    thing.matrix_world.translation.x = 4
    stroke = [
        {"name": "", "location": (place[0] + 4, place[1], place[2])} for place in ring(radius=1.05)
    ]
    assert press.orbflow_draw_guide(stroke=stroke, is_closed=True) == {"FINISHED"}
    for _ in range(2):
        guides = bpy.context.scene.orbflow.guides
        assert press.orbflow_remesh(faces=600, guides=guides, mirror="OFF") == {"FINISHED"}
        (told,) = addon("runs").last_report(thing.name)["guides"]
        assert told["outcome"] in {"laid", "followed"}, told
        assert told["angle"] < 10


def test_a_line_far_from_the_mesh_is_lost_and_named(open_fixture: Open) -> None:
    open_fixture("03")
    thing = ball()
    curve("Far", [(0, 0, 3), (1, 0, 3)])
    select(thing)
    assert press.orbflow_remesh(faces=200, guides="Far") == {"FINISHED"}
    report = addon("runs").last_report(thing.name)
    assert addon("words").warnings(report) == ["1 of 1 guide is lost: Far"]
    assert report["guides"][0]["angle"] is None
