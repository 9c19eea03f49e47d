"""Builds the Blender extension of one platform: build_zip.py WHEEL_FOLDER OUT_FOLDER.

The zip holds the add-on, its licence and one wheel; the same files give the same bytes.
"""

import sys
import tomllib
import zipfile
from pathlib import Path

import manual

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
# Part of a wheel's platform tag -> Blender's name of the platform.
PLATFORMS = {
    "linux_x86_64": "linux-x64",
    "manylinux": "linux-x64",
    "win_amd64": "windows-x64",
    "macosx_arm64": "macos-arm64",
    "macosx_x86_64": "macos-x64",
}
OLDEST_DATE = (1980, 1, 1, 0, 0, 0)


def platform(wheel: Path) -> str:
    """Blender's name of the platform that a wheel is for."""
    tag = wheel.stem.split("-")[-1]
    if tag.startswith("macosx"):
        tag = "macosx_" + ("arm64" if tag.endswith("arm64") else "x86_64")
    found = [name for part, name in PLATFORMS.items() if tag.startswith(part)]
    if not found:
        sys.exit(f"{wheel.name}: no Blender platform is known for {tag}")
    return found[0]


def manifest(wheel: Path) -> str:
    """The manifest of the zip: the add-on's, with platform and wheel."""
    text = (ADDON / "blender_manifest.toml").read_text()
    return f'{text}platforms = ["{platform(wheel)}"]\nwheels = ["./wheels/{wheel.name}"]\n'


def build(wheel: Path, out: Path) -> Path:
    """Writes the zip of one wheel."""
    version = tomllib.loads(manifest(wheel))["version"]
    path = out / f"orbflow-{version}-{platform(wheel).replace('-', '_')}.zip"
    members = {
        "blender_manifest.toml": manifest(wheel).encode(),
        "manual.html": manual.page((ROOT / "docs" / "blender.md").read_text()).encode(),
        "LICENSE": (ROOT / "LICENSE-GPL").read_bytes(),
        f"wheels/{wheel.name}": wheel.read_bytes(),
    }
    for source in sorted([*ADDON.rglob("*.py"), *ADDON.rglob("*.js")]):
        members[source.relative_to(ADDON).as_posix()] = source.read_bytes()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(members):
            archive.writestr(
                zipfile.ZipInfo(name, OLDEST_DATE), members[name], zipfile.ZIP_DEFLATED
            )
    return path


def main(wheels: Path, out: Path) -> None:
    """Builds the zip of the one wheel in a folder."""
    found = sorted(wheels.glob("*.whl"))
    if len(found) != 1:
        sys.exit(f"{wheels} must hold exactly one wheel, not {len(found)}")
    for old in out.glob("orbflow-*.zip"):
        old.unlink()
    print(build(found[0], out))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
