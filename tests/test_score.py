"""The score: the same figures as the independent tool's, recorded and live."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball

ROOT = Path(__file__).resolve().parent.parent
PAIRS = ROOT / "native" / "geometry" / "tests" / "score"
RECORDED = json.loads((PAIRS / "figures.json").read_text())
TOOLS = ROOT.parent / "shared" / "tools"
HAS_TOOL = (TOOLS / "quality").is_dir() and all(
    importlib.util.find_spec(name) for name in ("scipy", "igl", "fast_simplification")
)
# Figures from samples, which the tools take at different points: relative and absolute tolerance.
SAMPLED = {
    "chamfer_pct": (0.01, 1e-9),
    "chamfer_at_target_pct": (0.01, 1e-9),
    "p95_pct": (0.02, 1e-9),
    "hausdorff_pct": (0.1, 1e-9),
    "normal_consistency": (0, 0.005),
    "f1_at_0.5_pct": (0, 1),
    "f1_at_1_pct": (0, 1),
}
# Figures of quads, which the tool makes of any polygons: none where there are no quads.
OF_QUADS = {
    "alignment_deg",
    "chain_edge_median",
    "chain_mean",
    "chain_median",
    "high_valence",
    "irregular_pct",
    "loop_edges_pct",
}

# Figures that the tool does not have.
OWN = {"border_irregular_pct"}


def read_obj(path: Path) -> Arrays:
    words = [line.split() for line in path.read_text().splitlines()]
    points = np.array([w[1:] for w in words if w[0] == "v"], np.float32)
    faces = [w[1:] for w in words if w[0] == "f"]
    starts = np.cumsum([0, *map(len, faces[:-1])]).astype(np.int32)
    corners = np.array([int(i) - 1 for face in faces for i in face], np.int32)
    return points, starts, corners


def pair(name: str) -> tuple[Path, Path]:
    return PAIRS / f"{name}_input.obj", PAIRS / f"{name}_output.obj"


def score(name: str) -> dict[str, Any]:
    source, output = map(read_obj, pair(name))
    return orbflow_native.score(source, output, target=RECORDED[name]["target"])


def assert_agrees(found: dict[str, Any], wanted: dict[str, Any]) -> None:
    assert not wanted.keys() - found.keys()
    for figure in found.keys() - OWN:
        value = found[figure]
        relative, absolute = SAMPLED.get(figure, (1e-9, 1e-9))
        expected = wanted.get(figure)
        if wanted["quads_pct"] == 0 and figure in OF_QUADS:
            expected = None
        if isinstance(expected, int | float) and not isinstance(expected, bool):
            expected = pytest.approx(expected, rel=relative, abs=absolute)
        assert value == expected, figure


@pytest.mark.parametrize("name", RECORDED)
def test_every_figure_agrees_with_the_recorded_one(name: str) -> None:
    wanted = {key: value for key, value in RECORDED[name].items() if key != "target"}
    assert_agrees(score(name), wanted)


@pytest.mark.skipif(not HAS_TOOL, reason="the tool `quality` is not beside this checkout")
@pytest.mark.parametrize("name", ["01_lumpy", "05_broken"])
def test_every_figure_agrees_with_the_tool_itself(name: str) -> None:
    options = ["--json", "--more", "--target", str(RECORDED[name]["target"])]
    command = [sys.executable, "-m", "quality", *map(str, pair(name)), *options]
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, cwd=TOOLS, env=environment, check=True, capture_output=True)
    wanted = json.loads(done.stdout)
    assert_agrees(score(name), {k: v for k, v in wanted.items() if k not in ("input", "output")})


def test_a_mesh_is_as_good_as_itself() -> None:
    found = orbflow_native.score(ball(), ball(), n_samples=2000)
    assert found["same_topology"]
    assert found["chamfer_pct"] < 1e-5
    assert found["count_error_pct"] is None


def test_seams_and_faces_of_their_own_are_no_other_topology() -> None:
    points, starts, corners = ball()
    soup = (points[corners], starts, np.arange(len(corners), dtype=np.int32))
    assert orbflow_native.score(soup, ball(), n_samples=2000)["same_topology"]


def test_the_number_of_samples_and_the_seed_are_heard() -> None:
    source, output = map(read_obj, pair("01_lumpy"))
    chamfers = [
        orbflow_native.score(source, output, n_samples=n, seed=seed)["chamfer_pct"]
        for n, seed in ((500, 0), (500, 1), (501, 0), (500, 0))
    ]
    assert len(set(chamfers)) == 3
    assert chamfers == pytest.approx([chamfers[0]] * 4, rel=0.2)


def test_what_cannot_be_scored_is_said() -> None:
    flat = (np.zeros((3, 3), np.float32), np.zeros(1, np.int32), np.arange(3, dtype=np.int32))
    with pytest.raises(orbflow_native.InputError, match="the output has no face with an area"):
        orbflow_native.score(ball(), flat)
    with pytest.raises(orbflow_native.InputError, match="0 samples"):
        orbflow_native.score(ball(), ball(), n_samples=0)
