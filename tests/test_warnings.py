"""What is not as it was to be: in the report, and in the error of a strict run."""

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball


def horned() -> Arrays:
    """A lumpy ball with a horn on one side."""
    points, starts, corners = ball(20, 30)
    points[:, 0] += 4 * np.maximum(points[:, 0] - 0.4, 0)
    return points, starts, corners


def test_a_side_that_was_replaced_is_a_warning_and_grave_where_the_shape_is_another() -> None:
    made = orbflow_native.remesh(*horned(), faces=400, mirror="x", score_samples=0)
    far, replaced = made.report["warnings"]
    assert (far["kind"], far["grave"]) == ("far", True)
    assert far["in_edges"] > 2
    assert (replaced["kind"], replaced["axis"]) == ("mirror-replaced", "x")
    assert f"{replaced['off_pct']:.1f} %" in replaced["text"]


def test_a_strict_run_refuses_what_is_grave() -> None:
    with pytest.raises(orbflow_native.InputError, match="not sound") as refused:
        orbflow_native.remesh(*horned(), faces=400, mirror="x", strict=True)
    kinds = [warning["kind"] for warning in refused.value.warnings]
    assert kinds == ["far", "mirror-replaced"]
    assert refused.value.kept == []


def test_a_sound_result_has_no_warnings() -> None:
    made = orbflow_native.remesh(*ball(20, 30), faces=200, strict=True)
    assert made.report["warnings"] == []
    assert orbflow_native.InputError("why").warnings == []
