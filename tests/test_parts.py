"""Meshes of several parts: what can be done is done, the rest comes back as it was."""

from typing import Any

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball

# A triangle beside the ball.
SCRAP = np.array([[3.0, 0.1, 0.2], [3.0, 1.3, 0.2], [3.0, 0.1, 1.7]], np.float32)


def beside_a_scrap(mesh: Arrays) -> Arrays:
    """A mesh and a stray triangle, which comes first."""
    positions, loop_start, corner_vert = mesh
    corners = np.concatenate([np.arange(3, dtype=np.int32), corner_vert + np.int32(3)])
    starts = np.concatenate([np.zeros(1, np.int32), loop_start + np.int32(3)])
    return np.concatenate([SCRAP, positions]), starts, corners


@pytest.fixture(scope="module")
def mesh() -> Arrays:
    return beside_a_scrap(ball(12, 16))


def test_a_scrap_comes_back_bit_for_bit_and_is_named(mesh: Arrays) -> None:
    edges = np.array([[1, 2]], np.int32)
    result = orbflow_native.remesh(
        *mesh,
        faces=200,
        primitive="quad-sphere",
        scale=(1.7, 0.3, 1.1),
        material_index=np.arange(len(mesh[1]), dtype=np.int32),
        carried_edges=edges,
        cut_edges=[np.zeros((0, 2), np.int32)],
    )
    assert result.kept_faces == 1
    assert np.array_equal(result.positions[result.corner_vert[-3:]], SCRAP)
    assert len(result.loop_start) - 1 == result.report["parts"][0]["n_faces"]
    assert result.material_index is not None
    assert result.material_index[-1] == 0
    assert result.origins is not None
    assert result.origins.faces[-1] == 0
    (corners,), (weights,) = result.origins.corner_corners, result.origins.corner_weights
    assert corners[-3:, 0].tolist() == [0, 1, 2]
    assert weights[-3:].tolist() == [[1, 0, 0]] * 3
    assert (result.carried_from.tolist(), len(result.positions)) == ([0], len(result.sphere))
    assert result.carried_edges[0].tolist() == [len(result.positions) - n for n in (2, 1)]
    assert not result.sphere[-3:].any()
    (kept,) = result.report["kept"]
    assert (kept["part"], kept["n_faces"], kept["outcome"]) == (0, 1, "kept")
    assert [reason["kind"] for reason in kept["reasons"]] == ["border", "flat"]
    border = kept["reasons"][0]
    assert border["text"].startswith("1 border loop, 3 border edges: ")
    assert (border["n_loops"], border["n_edges"], border["faces"]) == (1, 3, [0])
    assert sorted(map(sorted, border["edges"])) == [[0, 1], [0, 2], [1, 2]]
    # In the coordinates of the caller, not in those that are scaled.
    assert np.allclose(border["place"], SCRAP[border["edges"][0]].mean(0), atol=1e-5)


def test_a_strict_run_raises_with_the_parts(mesh: Arrays) -> None:
    with pytest.raises(orbflow_native.InputError, match="1 of 2 parts cannot be done") as caught:
        orbflow_native.remesh(
            *mesh, faces=200, primitive="quad-sphere", strict=True, scale=(2.0, 1.0, 1.0)
        )
    (kept,) = caught.value.kept
    assert (kept["part"], kept["reasons"][0]["kind"]) == (0, "border")
    assert kept["reasons"][0]["place"][0] == pytest.approx(3.0)


def test_other_input_errors_have_no_parts(mesh: Arrays) -> None:
    with pytest.raises(orbflow_native.InputError) as caught:
        orbflow_native.remesh(*mesh, faces=3)
    assert caught.value.kept == []
    with pytest.raises(orbflow_native.InputError) as caught:
        orbflow_native.remesh(*mesh, small_size=101.0)
    assert caught.value.kept == []


def test_small_parts_stay_or_go(mesh: Arrays) -> None:
    kept = orbflow_native.remesh(*mesh, faces=200, small_size=50.0)
    gone = orbflow_native.remesh(*mesh, faces=200, small_size=50.0, small_parts="drop", strict=True)
    assert (kept.kept_faces, gone.kept_faces) == (1, 0)
    assert len(kept.loop_start) == len(gone.loop_start) + 1
    assert gone.report["kept"][0]["outcome"] == "dropped"
    with pytest.raises(ValueError, match="small_parts"):
        orbflow_native.remesh(*mesh, small_parts="eat")


def test_seams_are_welded_up_to_the_distance() -> None:
    positions, loop_start, corner_vert = ball(12, 16)
    # Every triangle for itself, each of its corners off by a little.
    away = np.random.default_rng(0).uniform(-1e-6, 1e-6, (len(corner_vert), 3))
    soup = (positions[corner_vert] + away).astype(np.float32)
    corners = np.arange(len(corner_vert), dtype=np.int32)
    result = orbflow_native.remesh(soup, loop_start, corners, faces=100)
    clean = result.report["clean"]
    assert result.kept_faces == 0
    assert clean["n_seam_welded"] > 0
    assert 0 < clean["weld_distance"] < 4e-6
    wanted: dict[str, Any] = {"faces": 100, "primitive": "quad-sphere"}
    for weld in (None, 1e-9):
        with pytest.raises(orbflow_native.InputError, match="welded"):
            orbflow_native.remesh(soup, loop_start, corners, weld=weld, **wanted)
