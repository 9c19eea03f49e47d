"""What the documents promise about themselves: links lead somewhere, named files are there."""

import json
import re
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted(DOCS.rglob("*.md"))]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
# From where the documents name files: the checkout, or a crate's sources.
BASES = [ROOT, DOCS, *ROOT.glob("native/*"), *ROOT.glob("native/*/src"), ROOT / "tests"]
# A name that is a path, with an ending or a last slash, and a file of a folder named before.
PATH = re.compile(r"[\w.-]+(?:/[\w.-]+)*(?:/[\w-]+\.(?:rs|py|md|toml|json|jpg|png)|/)")
FILE = re.compile(r"[\w-]+\.(?:rs|py)")
# Beside the checkout, made by a command, or in a folder that the reader names.
ELSEWHERE = (
    "shared/",
    "tools/",
    "data/",
    "dist/",
    "demo/",
    "target/",
    "makehuman/",
    "RUN/",
    "OUT/",
)


class Named(NamedTuple):
    """A file or place that a page names."""

    page: Path
    name: str


def named(page: Path, pattern: re.Pattern[str]) -> list[Named]:
    text = FENCE.sub("", page.read_text())
    return [Named(page, found) for found in pattern.findall(text)]


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub makes them."""
    words = (re.sub(r"[^\w\- ]", "", title.lower()) for title in HEADING.findall(page.read_text()))
    return {title.replace(" ", "-") for title in words}


def leads_somewhere(link: Named) -> bool:
    path, _, anchor = link.name.partition("#")
    target = (link.page.parent / path).resolve() if path else link.page
    if not target.exists():
        return False
    return not anchor or anchor in anchors(target)


def test_every_link_between_documents_leads_somewhere() -> None:
    links = [link for page in PAGES for link in named(page, LINK)]
    own = [link for link in links if not link.name.startswith(("http:", "https:"))]
    assert len(own) > 50
    assert [link for link in own if not leads_somewhere(link)] == []


def test_every_source_that_a_document_names_is_there() -> None:
    pages = [page for page in PAGES if page.name != "CHANGELOG.md"]
    names = [name for page in pages for name in named(page, CODE)]
    paths = [name for name in names if PATH.fullmatch(name.name)]
    paths = [path for path in paths if not path.name.startswith(ELSEWHERE)]
    assert len(paths) > 80
    assert [path for path in paths if not any((base / path.name).exists() for base in BASES)] == []
    folders = [ROOT / name for name in ("native", "addon", "scripts", "tests", "blend_fixtures")]
    known = {path.name for folder in folders for path in folder.rglob("*.*")}
    files = [name for name in names if FILE.fullmatch(name.name)]
    assert [file for file in files if file.name not in known] == []


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT / "tests" / "benchmarks"))
    return import_module("pages")


def test_the_benchmarks_are_what_the_record_says(pages: ModuleType) -> None:
    record = json.loads((DOCS / "lab" / "measured.json").read_text())
    assert (DOCS / "benchmarks.md").read_text() == pages.benchmarks(record)
    assert (DOCS / "lab" / "per_mesh.md").read_text() == pages.per_mesh(record)


def test_rows_that_were_measured_become_bars_and_tables(pages: ModuleType) -> None:
    rows = [
        {"mesh": name, "embed_1_s": 3.0, "embed_2_s": 2.0, "ratio": ratio, "whole_ratio": 1.4}
        for name, ratio in (("a", 1.4), ("b", 1.5), ("c", 1.7))
    ]
    old = sys.modules["record"].recorded({"threads": rows})
    new = sys.modules["record"].recorded({"threads": {"build": "1.0 (abc)", "rows": rows}})
    assert old["threads"]["build"] == "an earlier build"
    page = pages.benchmarks(new)
    assert "All figures are of one build: 1.0 (abc)." in page
    not_met = page[page.index("## Not met") : page.index("## Embedding")]
    assert "≥ 1.6× | 1.500× |" in not_met
    assert "| **median** | 3.00 | 2.00 | 1.50 | 1.40 |" in page
    assert "| range | 3.00 – 3.00 | 2.00 – 2.00 | 1.40 – 1.70 | 1.40 – 1.40 |" in page
    assert "| b | 3.00 | 2.00 | 1.50 | 1.40 |" in pages.per_mesh(new)
