"""The demo: installs the extension into Blender and presses the button on a real mesh.

    python scripts/demo.py OUT_FOLDER

Leaves a .blend, an .obj and a picture in OUT_FOLDER and prints a table.
"""

import os
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
FACES = 2000
# Blender reads this when it is imported: nothing of the user's own settings is touched.
_HOME = tempfile.TemporaryDirectory(prefix="orbflow-demo-", ignore_cleanup_errors=True)
os.environ["BLENDER_USER_RESOURCES"] = _HOME.name
sys.path.insert(0, str(ROOT / "tests" / "pictures"))

import bpy  # noqa: E402
from stage import Exhibit, picture  # noqa: E402


def install() -> None:
    """Installs the zip that `make zip` built, as a user would."""
    (path,) = (ROOT / "dist").glob("orbflow-*.zip")
    bpy.ops.extensions.package_install_files(
        filepath=str(path), repo="user_default", enable_on_install=True
    )


def export(path: Path) -> None:
    """Writes the selected objects as an .obj file."""
    bpy.ops.wm.obj_export(
        filepath=str(path),
        export_selected_objects=True,
        export_materials=False,
        export_uv=False,
        forward_axis="Y",
        up_axis="Z",
    )


def table(report: dict[str, Any]) -> str:
    """What came of it, in a few lines."""
    before, after, score = report["input"], report["output"], report["score"]
    rows = [
        ("", "input", "output"),
        ("vertices", f"{before['n_vertices']:,}", f"{after['n_vertices']:,}"),
        ("faces", f"{before['n_faces']:,}", f"{after['n_faces']:,}"),
        ("quads", f"{before['n_quads']:,}", f"{after['n_quads']:,}"),
    ]
    figures = [
        ("mean distance to the input, % of the diagonal", f"{score['chamfer_pct']:.3f}"),
        ("largest distance, % of the diagonal", f"{score['hausdorff_pct']:.2f}"),
        ("irregular vertices, %", f"{score['irregular_pct']:.2f}"),
        ("edges off the principal directions, degrees", f"{score['alignment_deg']:.1f}"),
        ("edges on closed loops, %", f"{score['loop_edges_pct']:.0f}"),
        ("edge length variation (standard deviation / mean)", f"{score['edge_cv']:.3f}"),
    ]
    steps = [(step["name"], f"{step['time_ms']:.0f}") for step in report["steps"]]
    lines = [f"  {name:<10}{left:>10}{right:>10}" for name, left, right in rows]
    lines += ["", *(f"  {name:<52}{value:>8}" for name, value in figures)]
    lines += ["", *(f"  {name:<52}{ms:>8} ms" for name, ms in steps)]
    return "\n".join(lines)


def main(out: Path) -> None:
    """Runs the demo."""
    out.mkdir(parents=True, exist_ok=True)
    install()
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_fixtures" / "01_spot.blend"))
    before = out / "spot_input.obj"
    export(before)
    bpy.ops.object.orbflow_remesh(faces=FACES)
    runs = sys.modules["bl_ext.user_default.orbflow.runs"]
    report = runs.last_report("Spot")
    after = out / "spot_orbflow.obj"
    export(after)
    bpy.ops.wm.save_as_mainfile(filepath=str(out.resolve() / "spot_orbflow.blend"), compress=True)
    n_before, n_after = report["input"]["n_faces"], report["output"]["n_faces"]
    exhibits = [
        Exhibit(
            before, f"input: {n_before:,} triangles", edges=0.0009, turn_deg=145, is_y_up=False
        ),
        Exhibit(after, f"Orbflow: {n_after:,} quads", turn_deg=145, is_y_up=False),
    ]
    picture([exhibits], out.resolve() / "spot.png")
    print(f"\n{table(report)}\n")
    for path in sorted(out.iterdir()):
        print(f"  {path}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
