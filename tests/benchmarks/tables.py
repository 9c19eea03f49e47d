"""Writes what was measured as Markdown."""

import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from bars import Results, bars
from bench import Row, median

TRIANGLES = (
    ("triangles", "triangles", "d"),
    ("chamfer_pct", "mean distance %", ".4f"),
    ("isotropic_chamfer_pct", "isotropic's", ".4f"),
    ("chamfer_ratio", "ratio", ".2f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("f1_at_0.5_pct", "F1 at 0.5 %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("triangle_angle_mean_min", "mean min angle", ".1f"),
    ("self_intersecting_pct", "crossing %", ".3f"),
    ("run_s", "CPU s", ".2f"),
    ("isotropic_cpu_s", "isotropic's", ".2f"),
)
QUADS = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".4f"),
    ("instant_meshes_chamfer_pct", "Instant Meshes'", ".4f"),
    ("quadriflow_chamfer_pct", "QuadriFlow's", ".4f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("f1_at_1_pct", "F1 at 1 %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_mean", "scaled Jacobian", ".3f"),
    ("self_intersecting_pct", "crossing %", ".3f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("irregular_pct", "irregular %", ".2f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".0f"),
)
FLOW = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_min", "Jacobian min", ".2f"),
    ("jacobian_p01", "1 %", ".2f"),
    ("jacobian_mean", "mean", ".3f"),
    ("self_intersecting_pct", "crossing %", ".2f"),
    ("irregular_pct", "irregular %", ".1f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".0f"),
    ("feature_f1_pct", "feature F1 %", ".0f"),
    ("run_s", "CPU s", ".2f"),
    ("quadriflow_s", "QuadriFlow's", ".2f"),
)
BODIES = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("posed_chamfer_pct", "posed", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_min", "Jacobian min", ".2f"),
    ("irregular_pct", "irregular %", ".1f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".1f"),
    ("run_s", "CPU s", ".2f"),
)
FEW = (
    ("n_asked", "asked", "d"),
    ("flow_share", "flow used", ".0%"),
    ("upright_share", "no inverted quad", ".0%"),
    ("count_error_pct", "count error %", ".1f"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".1f"),
    ("jacobian_mean", "scaled Jacobian", ".3f"),
    ("irregular_pct", "irregular %", ".0f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("run_s", "CPU s", ".2f"),
)
WHOLE = (
    ("input_triangles", "input triangles", "d"),
    ("run_s", "Orbflow, CPU s", ".2f"),
    ("instant_meshes_s", "Instant Meshes, algorithm alone", ".2f"),
    ("quadriflow_s", "QuadriFlow, algorithm alone", ".2f"),
    ("peak_mb", "our peak MB", ".0f"),
)
COST = (
    ("n_vertices", "vertices", "d"),
    ("cpu_s", "CPU s", ".2f"),
    ("energy", "energy", ".3f"),
    ("n_relaxations", "relaxations", "d"),
    ("peak_mb", "peak MB", ".0f"),
    ("instant_meshes_s", "Instant Meshes' whole run, CPU s", ".2f"),
)
THREADS = (
    ("embed_1_s", "embedding, 1 thread, s", ".2f"),
    ("embed_2_s", "2 threads, s", ".2f"),
    ("ratio", "ratio", ".2f"),
    ("whole_ratio", "ratio of the whole process", ".2f"),
)
LARGE = (
    ("kind", "kind", "s"),
    ("faces", "faces", "d"),
    ("cpu_s", "CPU s", ".1f"),
    ("wall_s", "wall s", ".1f"),
    ("peak_mb", "peak MB", ".0f"),
)
KIND_PEERS = {"instant_meshes": "Instant Meshes", "quadriflow": "QuadriFlow"}
KIND_COUNTS = (("inverted", 0), ("is_used", True))
KIND_BORDERS = ("border_mean_edges", "border_largest_edges", ".2f")

Columns = Sequence[tuple[str, str, str]]


def table(rows: Sequence[Row], columns: Columns, with_median: bool = True) -> str:
    """One line a mesh, failures in words, medians at the end."""
    head = ["mesh", *(title for _, title, _ in columns)]
    lines = [_line(head), "|" + "---|" * len(head)]
    for row in rows:
        if row.get("ok", True):
            lines.append(_line([row["mesh"], *(_cell(row.get(k), f) for k, _, f in columns)]))
        else:
            lines.append(_line([row["mesh"], f"failed ({row['code']}): {row['error']}"]))
    if with_median:
        numbers = [
            _cell(median(rows, key), f.replace("d", ".0f")) if f != "s" else ""
            for key, _, f in columns
        ]
        lines.append(_line(["**median**", *numbers]))
    return "\n".join(lines)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cell(value: object, form: str) -> str:
    return "–" if value is None or value != value else format(value, form)


def few_table(rows: Sequence[Row]) -> str:
    """One line a number of quads: shares of the meshes and medians over them."""
    lines = [_line([title for _, title, _ in FEW]), "|" + "---|" * len(FEW)]
    for n_asked in dict.fromkeys(row["n_asked"] for row in rows if row["ok"]):
        group = [row for row in rows if row["ok"] and row["n_asked"] == n_asked]
        figures: Row = {key: median(group, key) for key, _, _ in FEW[3:]}
        figures |= {
            "n_asked": n_asked,
            "flow_share": sum(row["is_used"] for row in group) / len(group),
            "upright_share": sum(row["jacobian_min"] > 0 for row in group) / len(group),
        }
        lines.append(_line([_cell(figures[key], form) for key, _, form in FEW]))
    return "\n".join(lines)


def kinds_table(rows: Sequence[Row], peers: Sequence[Row]) -> str:
    """One line a kind of model: how many come out with the input's topology, ours and theirs."""
    of_peers = {row["mesh"]: row for row in peers}
    head = ["kind", "models", "done", "not one inverted quad", "flow in all of it"]
    head += ["loops; spirals %", "border off by, edges: mean; largest", *KIND_PEERS.values()]
    lines = [_line(head), "|" + "---|" * len(head)]
    for kind in (*dict.fromkeys(row["kind"] for row in rows), None):
        group = [row for row in rows if kind in (row["kind"], None)]
        done = [row for row in group if row.get("is_alike") and not row["n_kept"]]
        theirs = [of_peers.get(row["mesh"], {}) for row in group]
        cells = [kind or "**all**", str(len(group)), str(len(done))]
        cells += [str(sum(row[key] == value for row in done)) for key, value in KIND_COUNTS]
        for pair in (("loop_edges_pct", "spiral_pct", ".0f"), KIND_BORDERS):
            cells.append("; ".join(_cell(median(done, key), pair[2]) for key in pair[:2]))
        cells += [str(sum(bool(row.get(f"{p}_is_alike")) for row in theirs)) for p in KIND_PEERS]
        lines.append(_line(cells))
    return "\n".join(lines)


def steps_table(rows: Sequence[Row]) -> str:
    """Median CPU seconds of every step."""
    done = [row["steps_s"] for row in rows if row.get("ok") and "steps_s" in row]
    names = list(dict.fromkeys(name for steps in done for name in steps))
    cells = [(name, median(done, name)) for name in names]
    lines = [_line(["step", "median CPU s"]), "|---|---|"]
    return "\n".join([*lines, *(_line([name, f"{value:.3f}"]) for name, value in cells)])


def summary(results: Results) -> str:
    """Every bar with what was measured."""
    lines = [_line(["what", "bar", "measured", "met"]), "|---|---|---|---|"]
    for bar in bars(results):
        met = {True: "yes", False: "**no**", None: "–"}[bar.met]
        lines.append(_line([bar.what, bar.bar, bar.measured, met]))
    return "\n".join(lines)


def tables(results: Results) -> dict[str, str]:
    """The Markdown of every part that was measured, by the name of its marker."""
    made = {"summary": summary(results)}
    for marker, part, make in (
        ("cost", "cost", partial(table, columns=COST, with_median=False)),
        ("threads", "threads", partial(table, columns=THREADS)),
        ("triangles", "triangles", partial(table, columns=TRIANGLES)),
        ("quads", "quads", partial(table, columns=QUADS)),
        ("whole", "quads", partial(table, columns=WHOLE)),
        ("steps", "quads", steps_table),
        ("flow", "flow", partial(table, columns=FLOW)),
        ("flow_steps", "flow", steps_table),
        ("flow_many", "flow_many", partial(table, columns=FLOW)),
        ("flow_few", "flow_few", few_table),
        ("flow_bodies", "flow_bodies", partial(table, columns=BODIES)),
        ("large", "large", partial(table, columns=LARGE, with_median=False)),
    ):
        if rows := results.get(part):
            made[marker] = make(rows)
    if rows := results.get("topology"):
        made["topology"] = kinds_table(rows, results.get("topology_peers", []))
    return made


def write(path: Path, parts: dict[str, str]) -> None:
    """Puts each part between its markers `<!-- measured: NAME -->` and `<!-- end -->`."""
    text = path.read_text()
    for name, part in parts.items():
        pattern = re.compile(rf"(<!-- measured: {name} -->\n).*?(<!-- end -->)", re.DOTALL)
        text = pattern.sub(lambda found, part=part: f"{found[1]}\n{part}\n\n{found[2]}", text)
    path.write_text(text)
