"""The record of what was measured, part by part: what the documents are written from.

A part keeps its build, its bars and its tables as they are written, so that the documents can be
written anew without what the meshes' rows take, and parts of an earlier build stay.
"""

import json
import re
import subprocess
from dataclasses import asdict
from pathlib import Path
from typing import Any

from bars import Bar, Results, bars_of
from tables import machine_table
from topics import TABLES

EARLIER = "an earlier build"
Record = dict[str, dict[str, Any]]


def build_of(root: Path) -> str:
    """The version and the commit of a checkout."""
    version = re.search(r'^version = "(.+)"', (root / "Cargo.toml").read_text(), re.MULTILINE)
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    commit = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True)
    return f"{version[1] if version else ''} ({commit.stdout.strip()})".strip()


def rows_of(log: Record | dict[str, Any]) -> Results:
    """The rows of every part of a log; parts that were kept without their build are lists."""
    return {part: kept if isinstance(kept, list) else kept["rows"] for part, kept in log.items()}


def recorded(log: dict[str, Any]) -> Record:
    """What is to be kept of a log."""
    results = rows_of(log)
    found: Record = {}
    for part, rows in results.items():
        if not rows:
            continue
        own = [table for table in TABLES if table.part == part]
        made = {table.name: table.make(results).splitlines() for table in own}
        if part == "machine":
            made = {"machine": [machine_table(rows)]}
        if not made and not bars_of(part, rows):
            continue
        kept = log[part]
        found[part] = {
            "build": kept["build"] if isinstance(kept, dict) else EARLIER,
            "bars": [asdict(bar) for bar in bars_of(part, rows)],
            "tables": made,
        }
    return found


def read(path: Path) -> Record:
    """A record; none where there is no file yet."""
    return json.loads(path.read_text()) if path.exists() else {}


def write(path: Path, record: Record) -> None:
    """Writes a record, parts in the order of the documents."""
    order = ["machine", "validity", *dict.fromkeys(table.part for table in TABLES)]
    parts = [*(part for part in order if part in record)]
    parts += [part for part in record if part not in order]
    text = json.dumps({part: record[part] for part in parts}, indent=1, ensure_ascii=False)
    path.write_text(text + "\n")


def bars_in(record: Record) -> list[Bar]:
    """Every bar of a record."""
    return [Bar(**bar) for part in record.values() for bar in part["bars"]]
