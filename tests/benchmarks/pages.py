"""Writes docs/benchmarks.md and docs/lab/per_mesh.md, wholly, from the record."""

from collections.abc import Sequence
from pathlib import Path

from bars import Bar
from record import Record, bars_in
from tables import Table, framed, joined, labelled
from topics import TABLES

# Words and order of the page; what is in braces is filled in.
TEMPLATE = Path(__file__).with_name("page.md.in")
PER_MESH = """<!-- Written by `make bench` from docs/lab/measured.json. -->

# Mesh by mesh

The tables that [benchmarks.md](../benchmarks.md) shows in short. Distances are in % of the bounding
box's diagonal.
"""


def benchmarks(record: Record) -> str:
    """The page of medians, what was not reached first."""
    machine = record.get("machine", {}).get("tables", {}).get("machine", ["not told."])
    found = bars_in(record)
    bars = [
        _bars("Not met", [bar for bar in found if bar.met is False]),
        _bars("Met", [bar for bar in found if bar.met]),
        _bars("Told without a bar", [bar for bar in found if bar.met is None]),
    ]
    text = TEMPLATE.read_text()
    for name, part in (
        ("machine", "\n".join(machine)),
        ("build", _builds(record)),
        ("bars", "\n\n".join(filter(None, bars))),
        ("topics", "\n\n".join(_topics(record, is_short=True))),
    ):
        text = text.replace(f"{{{name}}}", part)
    return text


def per_mesh(record: Record) -> str:
    """The page of the tables that the other one shows in short."""
    return "\n\n".join([PER_MESH.rstrip(), *_topics(record, is_short=False)]) + "\n"


def _topics(record: Record, is_short: bool) -> list[str]:
    """Each table under the heading of its topic, with its words."""
    found: list[str] = []
    topic = ""
    for table in TABLES:
        text = _text(record, table)
        short = table.shorten(text) if text else ""
        if not (short if is_short else text != short):
            continue
        if table.topic != topic:
            topic = table.topic
            found.append(f"## {topic}")
        if is_short and table.label:
            short = labelled(short, table.label)
        if is_short and table.label and not table.words and found[-1].startswith("|"):
            found[-1] = joined(found[-1], short)
        else:
            found += [table.words or f"{table.label}:", short if is_short else text]
    return found


def _text(record: Record, table: Table) -> str:
    return "\n".join(record.get(table.part, {}).get("tables", {}).get(table.name, []))


def _builds(record: Record) -> str:
    """One build, or which parts are of which."""
    of: dict[str, list[str]] = {}
    for part, kept in record.items():
        of.setdefault(kept["build"], []).append(part)
    if len(of) == 1:
        return f"All figures are of one build: {next(iter(of))}."
    rows = [[build, ", ".join(parts)] for build, parts in of.items()]
    table = framed(["build", "parts of the measurement"], rows)
    return f"The parts were measured with more than one build:\n\n{table}"


def _bars(title: str, found: Sequence[Bar]) -> str:
    if not found:
        return ""
    is_told = found[0].met is None
    head = ["what", "measured"] if is_told else ["what", "bar", "measured"]
    rows = [[bar.what, *([] if is_told else [bar.bar]), bar.measured] for bar in found]
    return f"## {title}\n\n{framed(head, rows)}"
