"""The network's weights: in Python and in the add-on's preferences."""

import json
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
    sizes = {"width": 4, "levels": [32, 8], "blocks": [1, 1]}
    header = {"sizes": sizes, "n_features": 0, "provenance": "made by a test"} | change
    text = json.dumps(header).encode()
    front = struct.pack(
        "<8sIIQQ", b"ORBFLOWN", 1, len(text), len(parameters), fnv(text + parameters)
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


def test_missing_weights_and_missing_files_are_said(tmp_path: Path) -> None:
    with pytest.raises(orbflow_native.InputError, match="the network needs weights"):
        orbflow_native.remesh(*ball(), predictor="network")
    with pytest.raises(orbflow_native.InputError, match=r"cannot read .*gone"):
        orbflow_native.remesh(*ball(), predictor="network", weights=tmp_path / "gone")
    with pytest.raises(TypeError):
        orbflow_native.remesh(*ball(), predictor="network", weights=7)  # pyright: ignore


def test_the_file_in_the_preferences_is_used_and_wrong_ones_change_nothing(
    open_fixture: Open, weights: bytes, tmp_path: Path
) -> None:
    first = open_fixture("03")
    preferences = bpy.context.preferences.addons["bl_ext.user_default.orbflow"].preferences
    path = tmp_path / "noise.weights"
    path.write_bytes(weights[:-2])
    preferences.weights = ""
    bpy.context.scene.orbflow.predictor = "NETWORK"

    def error() -> str:
        before = len(first.data.polygons), first.data
        with pytest.raises(RuntimeError) as caught:
            press.orbflow_remesh(predictor="NETWORK", faces=200)
        assert (len(first.data.polygons), first.data) == before
        return str(caught.value)

    try:
        assert "the network needs weights" in error()
        assert "preferences" in error()
        preferences.weights = str(path)
        assert "bytes, but" in error()
        path.write_bytes(weights)
        assert press.orbflow_remesh(predictor="NETWORK", faces=200) == {"FINISHED"}
        report = addon("panel").last_report("First")
        assert report["embedding"]["predictor"] == "network"
    finally:
        preferences.weights = ""
