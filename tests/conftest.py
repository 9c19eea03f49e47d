"""What all tests share: Blender with the real extension installed, and the fixtures."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

# Blender reads this when it is imported: nothing of the user's own settings, nothing left behind.
_HOME = tempfile.TemporaryDirectory(prefix="orbflow-blender-", ignore_cleanup_errors=True)
os.environ["BLENDER_USER_RESOURCES"] = _HOME.name

import bpy  # noqa: E402
import pytest  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
FIXTURES = ROOT / "blend_fixtures"


@pytest.fixture(scope="session")
def extension_zip() -> Path:
    """The extension as `make zip` built it."""
    found = sorted((ROOT / "dist").glob("orbflow-*.zip"))
    assert len(found) == 1, "run `make zip` first"
    return found[0]


@pytest.fixture(scope="session")
def blender_ext() -> Path:
    """Blender's own tool that builds and validates extensions."""
    scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    return scripts / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"


@pytest.fixture(scope="session")
def _extension(extension_zip: Path) -> None:
    bpy.ops.extensions.package_install_files(
        filepath=str(extension_zip), repo="user_default", enable_on_install=True
    )


@pytest.fixture
def open_fixture(_extension: None) -> Callable[[str], bpy.types.Object]:
    """A function that opens a fixture by the first letters of its name."""

    def open_it(prefix: str) -> bpy.types.Object:
        (path,) = FIXTURES.glob(f"{prefix}*.blend")
        bpy.ops.wm.open_mainfile(filepath=str(path))
        return bpy.context.view_layer.objects.active

    return open_it


def python(*arguments: str | Path) -> str:
    """Runs this Python and returns what it printed."""
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
