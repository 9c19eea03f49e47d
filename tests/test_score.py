"""The score is the one of `shared/tools/quality`.

`reference/score.json` holds what that tool says of a few meshes. With that folder beside the
checkout, `python tests/test_score.py` writes the file anew, and a test sees that it is the same.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball, ball_of_quads, box

ROOT = Path(__file__).resolve().parent.parent
REFERENCE = ROOT / "tests" / "reference" / "score.json"
TOOLS = ROOT.parent / "shared" / "tools"
CASES: dict[str, tuple[Arrays, Arrays]] = {
    "ball of quads": (ball(40, 60), ball_of_quads(20, 30)),
    "ball of triangles": (ball(40, 60), ball(21, 32)),
    "box": (box(16), box(9)),
}
TARGET = 600
# Means over 100,000 random samples differ by about a percent, their largest by more.
LOOSE = {"hausdorff_pct": 0.3, "p95_pct": 0.05, "chamfer_pct": 0.03, "chamfer_at_target_pct": 0.03}
TIGHT = 0.01


def by_the_tool(given: Arrays, made: Arrays) -> dict[str, Any]:
    sys.path.insert(0, str(TOOLS))
    import quality  # pyright: ignore[reportMissingImports]

    def mesh(arrays: Arrays) -> Any:  # noqa: ANN401 - the tool's own type
        positions, starts, corners = arrays
        faces = [face.tolist() for face in np.split(corners, starts[1:])]
        return quality.PolyMesh.from_faces(positions.astype(np.float64), faces)

    return quality.measure(quality.Reference(mesh(given)), mesh(made), TARGET)


def agrees(name: str, ours: Any, theirs: Any) -> bool:  # noqa: ANN401 - numbers, flags or None
    if theirs is None or isinstance(theirs, bool) or ours is None:
        return ours == theirs
    tolerance = LOOSE.get(name, TIGHT)
    return ours == pytest.approx(theirs, rel=tolerance, abs=1e-4)


@pytest.mark.parametrize("case", CASES)
def test_every_figure_agrees_with_the_tools(case: str) -> None:
    theirs = json.loads(REFERENCE.read_text())[case]
    ours = orbflow_native.score(*CASES[case], target=TARGET)
    names = ours.keys() & theirs.keys()
    assert len(names) >= 30
    wrong = {
        name: (ours[name], theirs[name])
        for name in names
        if not agrees(name, ours[name], theirs[name])
    }
    assert not wrong


@pytest.mark.skipif(not TOOLS.is_dir(), reason="shared/tools is not beside this checkout")
@pytest.mark.parametrize("case", CASES)
def test_the_recorded_figures_are_the_tools(case: str) -> None:
    recorded = json.loads(REFERENCE.read_text())[case]
    now = by_the_tool(*CASES[case])
    assert now.keys() == recorded.keys()
    assert all(agrees(name, now[name], recorded[name]) for name in now)


if __name__ == "__main__":
    figures = {case: by_the_tool(*meshes) for case, meshes in CASES.items()}
    REFERENCE.parent.mkdir(exist_ok=True)
    REFERENCE.write_text(json.dumps(figures, indent=1) + "\n")
