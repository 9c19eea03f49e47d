"""Strokes that edges follow, in the wheel."""

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball


@pytest.fixture(scope="module")
def mesh() -> Arrays:
    return ball()


def ring(radius: float) -> np.ndarray:
    turned = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    return radius * np.stack([np.cos(turned), np.sin(turned), 0.2 * np.cos(turned)], axis=1)


def test_an_exact_ring_is_laid(mesh: Arrays) -> None:
    # The ball is bumpy: the ring goes as far out as its nearest vertices.
    points = mesh[0].astype(np.float64)
    sizes = np.linalg.norm(points, axis=1)
    wanted = ring(1.0) / np.linalg.norm(ring(1.0), axis=1)[:, None]
    wanted *= sizes[np.argmax(wanted @ (points / sizes[:, None]).T, axis=1)][:, None]
    guide = orbflow_native.Guide(wanted, is_closed=True, is_exact=True)
    assert (guide.is_closed, guide.is_exact, guide.points.shape) == (True, True, (40, 3))
    result = orbflow_native.remesh(*mesh, faces=400, mirror="off", guides=[guide])
    (told,) = result.report["guides"]
    assert (told["guide"], told["strength"], told["outcome"]) == (0, "exact", "laid")
    assert told["distance"] < 0.25
    assert told["text"] is None


def test_a_stroke_far_off_is_a_warning(mesh: Arrays) -> None:
    guide = orbflow_native.Guide(ring(9.0), is_closed=True)
    result = orbflow_native.remesh(*mesh, faces=100, guides=[guide])
    (told,) = result.report["guides"]
    assert (told["strength"], told["outcome"], told["angle"]) == ("follow", "lost", None)
    assert told["text"] in result.report["warnings"][0]["text"]


def test_what_is_no_line_is_refused(mesh: Arrays) -> None:
    single = ring(1.0).astype(np.float32)
    with pytest.raises(TypeError, match=r"points must be a \(N, 3\) float64 array"):
        orbflow_native.Guide(single)  # pyright: ignore
    short = orbflow_native.Guide(ring(1.0)[:2], is_closed=True)
    with pytest.raises(orbflow_native.InputError, match="guide 0 has 2 points; it needs 3"):
        orbflow_native.remesh(*mesh, faces=100, guides=[short])
