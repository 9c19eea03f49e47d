"""The manual links: each setting and operator leads to a heading of the page in the zip."""

import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import pytest
from conftest import ROOT
from test_docs import anchors
from test_operator import addon

pytestmark = pytest.mark.usefixtures("open_fixture")


def address(of: str) -> str:
    """What Blender's own *Online Manual* opens for something."""
    lookup: Callable[..., Any] = bpy.types.WM_OT_doc_view_manual._lookup_rna_url
    return lookup(of, verbose=False) or ""


def leads(of: str) -> str:
    page, _, anchor = address(of).partition("#")
    return anchor if page == addon("manual").PAGE.as_uri() else ""


def test_every_setting_leads_to_a_heading() -> None:
    names = [
        each.identifier
        for each in bpy.types.Scene.bl_rna.properties["orbflow"].fixed_type.properties
    ]
    names = [name for name in names if name not in {"rna_type", "name"}]
    assert len(names) > 30
    known = anchors(ROOT / "docs" / "blender.md")
    assert [name for name in names if leads(f"bpy.types.OrbflowSettings.{name}") not in known] == []


def test_every_operator_leads_to_a_heading() -> None:
    names = [name for name in dir(bpy.ops.object) if name.startswith("orbflow_")]
    assert len(names) >= 9
    known = anchors(ROOT / "docs" / "blender.md")
    assert [name for name in names if leads(f"bpy.ops.object.{name}") not in known] == []


def test_every_link_is_for_something_that_is_there() -> None:
    _, links = addon("manual").links()
    known = anchors(ROOT / "docs" / "blender.md")
    assert {anchor for _, anchor in links} <= known
    for name, _ in links:
        kind, owner, what = name.rsplit(".", 2)
        if kind == "bpy.ops":
            assert what in dir(bpy.ops.object), name
        elif owner == "orbflowsettings":
            assert hasattr(bpy.context.scene.orbflow, what), name


def test_the_page_in_the_zip_has_all_headings(extension_zip: Path) -> None:
    with zipfile.ZipFile(extension_zip) as archive:
        page = archive.read("manual.html").decode()
    assert set(re.findall(r'<h1 id="([^"]+)"', page)) == anchors(ROOT / "docs" / "blender.md")
    assert page.count("<table>") >= 4
    assert "**" not in page
    assert addon("manual").PAGE.read_text() == page
