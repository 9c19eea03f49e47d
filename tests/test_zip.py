"""The zip that users install."""

import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from conftest import ROOT, python

sys.path.insert(0, str(ROOT / "scripts"))
import build_zip

MAX_BYTES = 8_000_000


def test_blender_finds_nothing_wrong(extension_zip: Path, blender_ext: Path) -> None:
    assert "Success" in python(blender_ext, "validate", extension_zip)


def test_it_is_small(extension_zip: Path) -> None:
    assert extension_zip.stat().st_size <= MAX_BYTES


def test_it_holds_one_wheel_the_licence_and_nothing_else(extension_zip: Path) -> None:
    names = zipfile.ZipFile(extension_zip).namelist()
    others = [name for name in names if not name.endswith((".py", ".js"))]
    first = [name.split("/")[0] for name in others]
    assert first == ["LICENSE", "blender_manifest.toml", "manual.html", "wheels"]
    sources = {path.relative_to(ROOT / "addon").as_posix() for path in addon_sources()}
    assert sources == set(names) - set(others)


def addon_sources() -> list[Path]:
    return [*(ROOT / "addon").rglob("*.py"), *(ROOT / "addon").rglob("*.js")]


@pytest.mark.parametrize(
    ("tag", "platform"),
    [
        ("manylinux_2_28_x86_64", "linux-x64"),
        ("win_amd64", "windows-x64"),
        ("macosx_11_0_arm64", "macos-arm64"),
        ("macosx_10_12_x86_64", "macos-x64"),
    ],
)
def test_each_platform_gets_its_own_zip_with_one_wheel(
    tmp_path: Path, blender_ext: Path, tag: str, platform: str
) -> None:
    wheel = tmp_path / f"orbflow_native-0.1.0-cp311-abi3-{tag}.whl"
    wheel.write_bytes(b"a wheel")
    path = build_zip.build(wheel, tmp_path)
    with zipfile.ZipFile(path) as archive:
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
        assert [name for name in archive.namelist() if name.endswith(".whl")] == [
            manifest["wheels"][0].removeprefix("./")
        ]
    assert manifest["platforms"] == [platform]
    assert "Success" in python(blender_ext, "validate", path)


def test_the_same_files_give_the_same_bytes(tmp_path: Path) -> None:
    wheel = tmp_path / "orbflow_native-0.1.0-cp311-abi3-win_amd64.whl"
    wheel.write_bytes(b"a wheel")
    first = build_zip.build(wheel, tmp_path).read_bytes()
    assert build_zip.build(wheel, tmp_path).read_bytes() == first


@pytest.mark.parametrize("word", ["urllib", "requests", "socket", "pip", "bl_info", "exec("])
def test_the_add_on_stays_within_what_reviewers_allow(word: str) -> None:
    for source in addon_sources():
        assert word not in source.read_text(), source
