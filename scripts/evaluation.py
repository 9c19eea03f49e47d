"""Fills the tables of docs/evaluation.md: evaluation.py REPORT.json docs/evaluation.md.

The report is that of `orbflow evaluate`. Each table goes between its markers
`<!-- measured: NAME -->` and `<!-- end -->`.
"""

import json
import re
import sys
from pathlib import Path
from typing import Any

SIDES = {
    "train": "trained on",
    "test": "held back",
    "other": "other sets",
}
PROPOSERS = {
    "radial": "radial projection",
    "thesis": "thesis",
    "thesis_target": "thesis, its targets",
    "network": "network",
    "unswept": "solver, no sweep yet",
    "solver": "solver",
}
Figures = dict[str, Any]


def line(cells: list[str]) -> str:
    """One line of a table."""
    return f"| {' | '.join(cells)} |"


def table(header: list[str], rows: list[list[str]]) -> str:
    """A table of Markdown."""
    return "\n".join([line(header), "|---" * len(header) + "|", *map(line, rows)])


def proposals(sides: Figures) -> str:
    """What each predictor proposes for the level, by side."""
    rows = []
    for side, report in sides.items():
        overall = report["overall"]
        for name, title in PROPOSERS.items():
            if (p := overall["proposals"].get(name)) is None:
                continue
            rows.append(
                [
                    f"{SIDES[side]} ({overall['n_shapes']})" if name == "radial" else "",
                    title,
                    f"{p['energy']:.2f}",
                    f"{p['energy_ratio']:.2f} ({p['energy_ratio_p90']:.2f})",
                    f"{p['folds_pct']:.1f} %",
                    *(
                        " / ".join(f"{value:.0f}" for value in p[key])
                        for key in ("precision_pct", "recall_pct", "f1_pct")
                    ),
                ]
            )
    header = ["shapes", "proposal", "distortion", "of the solver's (90 %)", "folded"]
    return table([*header, "precision", "recall", "F1"], rows)


def gap(sides: Figures) -> str:
    """What shapes never seen cost each learner, against those trained on."""
    rows = []
    for name in ("thesis", "network"):
        seen, unseen = (sides[side]["overall"]["proposals"].get(name) for side in ("train", "test"))
        if seen is None or unseen is None:
            continue
        rows.append(
            [
                PROPOSERS[name],
                *(f"{p['energy_ratio']:.2f}" for p in (seen, unseen)),
                *(f"{p['folds_pct']:.1f} %" for p in (seen, unseen)),
                *(f"{p['f1_pct'][1]:.1f}" for p in (seen, unseen)),
            ]
        )
    header = ["", "distortion, seen", "never seen", "folded, seen", "never seen"]
    return table([*header, "F1 at 1 %, seen", "never seen"], rows)


def angles(sides: Figures) -> str:
    """How far the network is from the solver, and how often from anything good."""
    rows = []
    for side, report in sides.items():
        overall = report["overall"]
        median, most = overall["angles_deg"]
        worse = (overall[f"worse_than_{other}_pct"] for other in ("radial", "unswept"))
        rows.append(
            [SIDES[side], f"{median:.0f}°", f"{most:.0f}°", *(f"{pct:.1f} %" for pct in worse)]
        )
    worse = ["worse than the radial projection", "than the solver before any sweep"]
    return table(["shapes", "median", "90 %", *worse], rows)


def whole(sides: Figures) -> str:
    """The finished maps, network and hurried solver against the solver."""
    rows = []
    for side, report in sides.items():
        if (w := report["overall"]["whole"]) is None:
            continue
        for name, title in (("brisk", "solver in a hurry"), ("network", "network")):
            cost = w[name]
            cpu = "–" if cost["cpu_ratio"] is None else f"{cost['cpu_ratio']:.2f}"
            rows.append(
                [
                    f"{SIDES[side]} ({w['n_shapes']})" if name == "brisk" else "",
                    title,
                    f"{cost['energy_ratio']:.3f}",
                    f"{cost['relaxations_ratio']:.2f}",
                    cpu,
                    f"{w['gave_up_pct']:.1f} %" if name == "network" else "",
                ]
            )
    header = ["shapes", "from", "distortion", "relaxations", "CPU time", "given up"]
    return table(header, rows)


def categories(sides: Figures) -> str:
    """The network's proposals in each category that it was not trained on."""
    rows = []
    for side in ("test", "other"):
        for category, summary in sides.get(side, {"categories": {}})["categories"].items():
            radial, p = (summary["proposals"][name] for name in ("radial", "network"))
            rows.append(
                [
                    f"{category}, {SIDES[side]}",
                    str(summary["n_shapes"]),
                    f"{radial['energy_ratio']:.2f}",
                    f"{p['energy_ratio']:.2f}",
                    f"{p['folds_pct']:.1f} %",
                    f"{p['f1_pct'][1]:.0f}",
                ]
            )
    header = ["category", "shapes", "radial, of the solver's", "network, of the solver's"]
    return table([*header, "folded", "F1 at 1 %"], rows)


def main(report: Path, page: Path) -> None:
    """Writes every table of a report into the page."""
    sides = json.loads(report.read_text())["sides"]
    text = page.read_text()
    for make in (proposals, gap, angles, whole, categories):
        pattern = re.compile(rf"(<!-- measured: {make.__name__} -->\n).*?(<!-- end -->)", re.DOTALL)
        made = make(sides)
        text = pattern.sub(lambda found, made=made: f"{found[1]}\n{made}\n\n{found[2]}", text)
    page.write_text(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
