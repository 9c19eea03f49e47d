"""Shells that intersect become one closed mesh; parts inside others go."""

from typing import Any

import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball
from test_modifiers import is_closed, told
from test_operator import Open, addon, press


def balls(*places: tuple[float, float]) -> Arrays:
    """Balls of some radii at some x."""
    points, _, corners = ball(16, 24)
    n = len(points)
    all_points = [points * radius + np.array([x, 0, 0], np.float32) for radius, x in places]
    all_corners = [corners + i * n for i in range(len(places))]
    corners = np.concatenate(all_corners).astype(np.int32)
    starts = np.arange(0, len(corners), 3, dtype=np.int32)
    return np.concatenate(all_points).astype(np.float32), starts, corners


def test_settings_reach_the_core() -> None:
    mesh = balls((1, 0), (0.8, 1.0), (0.3, 0.1))
    wanted: dict[str, Any] = {"faces": 200, "score_samples": 0, "mirror": "off"}
    report = orbflow_native.remesh(*mesh, solid=True, solid_detail=1.5, **wanted).report
    assert report["settings"]["solid"]
    assert report["solid"]["cell_pct"] == pytest.approx(1.5)
    assert (report["solid"]["n_shells"], report["solid"]["n_pieces"]) == (3, 1)
    assert (report["output"]["n_components"], report["output"]["closed"]) == (1, True)
    report = orbflow_native.remesh(*mesh, inner="drop", **wanted).report
    assert report["solid"] is None
    assert report["output"]["n_components"] == 2
    assert [part["outcome"] for part in report["kept"]] == ["dropped"]


def test_the_add_on_makes_solid_and_says_it(
    open_fixture: Open, capfd: pytest.CaptureFixture[str]
) -> None:
    open_fixture("03")
    points, _, corners = balls((1, 0), (0.8, 1.0))
    mesh = bpy.data.meshes.new("Two")
    mesh.from_pydata(points.tolist(), [], corners.reshape(-1, 3).tolist())
    thing = bpy.data.objects.new("Two", mesh)
    bpy.context.collection.objects.link(thing)
    for each in bpy.context.selected_objects:
        each.select_set(False)
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    assert press.orbflow_remesh(faces=150, solid=True, solid_detail=1.5) == {"FINISHED"}
    assert is_closed(thing.data)
    assert told(thing)["output"]["n_components"] == 1
    assert "2 shells made 1 closed surface" in capfd.readouterr().out


def test_detail_is_of_use_where_it_is_made_solid(open_fixture: Open) -> None:
    open_fixture("03")
    settings, wanted = addon("settings"), bpy.context.scene.orbflow
    assert not settings.is_of_use(wanted, "solid_detail")
    assert settings.is_of_use(wanted, "inner")
    wanted.solid = True
    assert settings.is_of_use(wanted, "solid_detail")
    assert not settings.is_of_use(wanted, "inner")
