"""The network's weights: in Python and in the add-on's preferences."""

import json
import re
import struct
from pathlib import Path

import bpy
import numpy as np
import orbflow_native
import pytest
from shapes import ball
from test_operator import Open, addon, press


def fnv(data: bytes) -> int:
    """FNV-1a of 64 bits, the sum in a file of weights."""
    total = 0xCBF29CE484222325
    for byte in data:
        total = (total ^ byte) * 0x100000001B3 % 2**64
    return total


def file_of(parameters: bytes, **change: object) -> bytes:
    """A file of weights by its layout, with any header."""
    sizes = {"width": 4, "levels": [32, 8], "blocks": [1, 1], "relaxations": 2}
    header = {"sizes": sizes, "n_features": 0, "provenance": "made by a test"} | change
    text = json.dumps(header).encode()
    front = struct.pack(
        "<8sIIQQ", b"ORBFLOWN", 2, len(text), len(parameters), fnv(text + parameters)
    )
    return front + text + parameters


@pytest.fixture
def weights() -> bytes:
    """Weights of noise: the solver mends whatever they propose."""
    rng = np.random.default_rng(7)

    def n_wanted(made: bytes, **change: object) -> int:
        with pytest.raises(orbflow_native.InputError) as caught:
            orbflow_native.embed(*ball(), predictor="network", weights=made)
        return int(str(caught.value).split()[-1])

    n_features = n_wanted(file_of(b""))
    count = n_wanted(file_of(b"", n_features=n_features))
    values = (rng.standard_normal(count) * 0.05).astype(np.float16)
    return file_of(values.tobytes(), n_features=n_features)


def test_the_network_runs_on_bytes_and_on_a_path(weights: bytes, tmp_path: Path) -> None:
    path = tmp_path / "noise.weights"
    path.write_bytes(weights)
    results = [
        orbflow_native.remesh(
            *ball(), faces=300, predictor="network", weights=given, score_samples=0
        )
        for given in (weights, path, str(path))
    ]
    assert len({each.positions.tobytes() for each in results}) == 1
    embedding = results[0].report["embedding"]
    assert (embedding["predictor"], embedding["n_folds"]) == ("network", 0)
    told = embedding["weights"]
    assert (told["shipped"], told["provenance"]) == (False, "made by a test")
    assert re.fullmatch("[0-9a-f]{16}", told["sum"])


@pytest.mark.parametrize(
    ("harm", "text"),
    [
        (lambda w: b"", "they do not begin with ORBFLOWN"),
        (lambda w: b"\x80\x04cos\nsystem\n", "they do not begin with ORBFLOWN"),
        (lambda w: w[:-2], "bytes, but"),
        (lambda w: w[:-1] + bytes([w[-1] ^ 1]), "the weights are damaged"),
        (lambda w: w[:8] + b"\x09" + w[9:], "the weights have version 9"),
    ],
)
def test_wrong_and_damaged_weights_are_refused(weights: bytes, harm: object, text: str) -> None:
    with pytest.raises(orbflow_native.InputError, match=text):
        orbflow_native.remesh(*ball(), predictor="network", weights=harm(weights))  # pyright: ignore


def test_the_wheel_has_weights_of_its_own_and_tells_what_they_proposed() -> None:
    embedding = orbflow_native.embed(*ball(), predictor="network").report["embedding"]
    proposal, repair = embedding["proposal"], embedding["repair"]
    assert (embedding["predictor"], repair["fell_back_to_solver"]) == ("network", False)
    # The solver's map of this ball has 1.63.
    assert proposal["energy"] == pytest.approx(1.78, abs=0.05)
    assert (proposal["n_folds"], repair["n_moved"], proposal["n_relaxations"]) == (0, 0, 0)
    assert embedding["n_relaxations"] > 0
    assert embedding["weights"]["shipped"]
    assert min(embedding["times"][f"{stage}_ms"] for stage in ("propose", "relax")) > 0


def test_by_default_the_network_proposes_where_there_are_many_vertices() -> None:
    small, large = (
        orbflow_native.embed(*ball(rows, 200)).report["embedding"] for rows in (100, 101)
    )
    assert [small["n_vertices"], large["n_vertices"]] == [19_802, 20_002]
    assert (small["predictor"], small["weights"]) == ("solver", None)
    assert large["predictor"] == "network"
    assert large["weights"]["shipped"]
    assert large["energy"] == pytest.approx(small["energy"], rel=0.03)


def test_weights_that_nothing_reads_and_missing_files_are_said(tmp_path: Path) -> None:
    for function in (orbflow_native.remesh, orbflow_native.embed):
        with pytest.raises(ValueError, match="not for the predictor `solver`"):
            function(*ball(), predictor="solver", weights=b"")
    with pytest.raises(orbflow_native.InputError, match=r"cannot read .*gone"):
        orbflow_native.remesh(*ball(), predictor="network", weights=tmp_path / "gone")
    with pytest.raises(TypeError):
        orbflow_native.remesh(*ball(), predictor="network", weights=7)  # pyright: ignore


def test_the_add_on_needs_no_file_and_the_panel_tells_what_was_proposed(open_fixture: Open) -> None:
    open_fixture("03")
    assert press.orbflow_remesh(predictor="NETWORK", faces=200) == {"FINISHED"}
    panel, words = addon("panel"), addon("words")
    report = addon("runs").last_report("First")
    assert words.warnings(report) + words.exceptions(report) == []
    shown = dict(panel.rows(report))
    proposal = report["embedding"]["proposal"]
    assert shown["Proposed by"] == "network"
    assert shown["Weights"] == "shipped"
    assert shown["Folds proposed"] == f"{proposal['folds_pct']:.1f} %"
    assert shown["Vertices repaired"].endswith(f" of {proposal['n_vertices']:,}")
    assert shown["Distortion"].startswith(f"{proposal['energy']:.2f} → ")
    assert shown["Relaxations"] == f"{report['embedding']['n_relaxations']:,}"
    assert press.orbflow_remesh(predictor="SOLVER", faces=200) == {"FINISHED"}
    assert "Proposed by" not in dict(panel.rows(addon("runs").last_report("First")))


def test_the_file_in_the_preferences_is_used_and_wrong_ones_change_nothing(
    open_fixture: Open, weights: bytes, tmp_path: Path
) -> None:
    first = open_fixture("03")
    preferences = bpy.context.preferences.addons["bl_ext.user_default.orbflow"].preferences
    path = tmp_path / "noise.weights"
    path.write_bytes(weights[:-2])

    def error() -> str:
        before = len(first.data.polygons), first.data
        with pytest.raises(RuntimeError) as caught:
            press.orbflow_remesh(predictor="NETWORK", faces=200)
        assert (len(first.data.polygons), first.data) == before
        return str(caught.value)

    try:
        preferences.weights = str(path)
        assert "bytes, but" in error()
        path.write_bytes(weights)
        assert press.orbflow_remesh(predictor="NETWORK", faces=200) == {"FINISHED"}
        report = addon("runs").last_report("First")
        assert report["embedding"]["predictor"] == "network"
        assert dict(addon("panel").rows(report))["Weights"] == report["embedding"]["weights"]["sum"]
    finally:
        preferences.weights = ""
