"""Holds what was measured against what was to be reached."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bench import Row, median
from embedding import COST_VERTICES
from remeshing import in_peer_range

Results = dict[str, list[Row]]


@dataclass(frozen=True)
class Bar:
    """What was to be reached and what was; `met` is None where nothing was to be reached."""

    what: str
    bar: str
    measured: str
    met: bool | None


def bars_of(part: str, rows: list[Row]) -> list[Bar]:
    """Every bar of a part; none where it has none or nothing was measured."""
    return MAKERS[part](rows) if rows and part in MAKERS else []


def _count(rows: Sequence[Row], key: str = "ok") -> str:
    return f"{sum(bool(row.get(key)) for row in rows)} of {len(rows)}"


def _all(rows: Sequence[Row], key: str = "ok") -> bool:
    return all(row.get(key) for row in rows)


def _validity(rows: list[Row]) -> list[Bar]:
    found = []
    for folder in ("dev", "quaternius"):
        part = [row for row in rows if row["folder"] == folder]
        what = f"`{folder}`, closed, genus 0: bijection, degree 1 per part, no fold"
        found.append(Bar(what, "every one", _count(part), _all(part)))
    return found


def _cost(rows: list[Row]) -> list[Bar]:
    parts = [[r for r in rows if r["n_vertices"] == n and r["ok"]] for n in COST_VERTICES]
    small, middle, big = (median(part, "cpu_s") for part in parts)
    peer = [median(part, "instant_meshes_s") for part in parts]
    what = "`orbflow embed`, one thread, whole process, median: {} vertices"
    return [
        Bar(what.format("10,000"), "≤ 1.0 s", _beside(small, peer[0]), small <= 1.0),
        Bar(what.format("50,000"), "≤ 6 s", _beside(middle, peer[1]), middle <= 6.0),
        Bar(
            "growth from 10,000 to 100,000 vertices",
            "≤ 12×",
            f"{big / small:.1f}×",
            big / small <= 12,
        ),
    ]


def _beside(cpu_s: float, peer_s: float) -> str:
    return f"{cpu_s:.2f} s ({cpu_s / peer_s:.1f}× Instant Meshes' whole run)"


def _threads(rows: list[Row]) -> list[Bar]:
    ratio = median(rows, "ratio")
    what = "two threads against one, wall time of the embedding, 50,000 vertices, median"
    return [Bar(what, "≥ 1.6×", f"{ratio:.3f}×", ratio >= 1.6)]


def _triangles(rows: list[Row]) -> list[Bar]:
    what = "`--primitive adaptive --faces 6000`, {}"
    ratio, f1 = median(rows, "chamfer_ratio"), median(rows, "f1_at_0.5_pct")
    cv, angle = median(rows, "edge_cv"), median(rows, "triangle_angle_mean_min")
    crossing = median(rows, "self_intersecting_pct")
    worst = max((r["self_intersecting_pct"] for r in rows if r["ok"]), default=float("nan"))
    n_better = sum(r.get("chamfer_ratio", 9) <= 0.9 for r in rows)
    return [
        Bar(what.format("done"), "every one", _count(rows), _all(rows)),
        Bar(what.format("F1 at 0.5 %, median"), "≥ 99", f"{f1:.2f}", f1 >= 99),
        Bar(
            what.format("mean distance against isotropic remeshing, median"),
            "≤ 0.9×",
            f"{ratio:.2f}× (≤ 0.9× on {n_better} of {len(rows)})",
            ratio <= 0.9,
        ),
        Bar(what.format("edge length CV, median"), "≤ 0.20", f"{cv:.3f}", cv <= 0.20),
        Bar(what.format("mean minimum angle, median"), "≥ 46°", f"{angle:.1f}°", angle >= 46),
        Bar(
            what.format("self-intersecting faces, median"),
            "≤ 0.1 %",
            f"{crossing:.3f} % (worst {worst:.2f} %)",
            crossing <= 0.1,
        ),
    ]


def _quads(rows: list[Row]) -> list[Bar]:
    what = "`--primitive quad-sphere --faces 2000`, {}"
    f1 = median(rows, "f1_at_1_pct")
    return [
        _sound(rows, what, 2),
        Bar(what.format("F1 at 1 %, median"), "≥ 97", f"{f1:.2f}", f1 >= 97),
        *_against(rows, what, "instant_meshes", 4),
        *_against(rows, what, "quadriflow", 0.6),
    ]


def _flow(rows: list[Row]) -> list[Bar]:
    what = "`--primitive flow --faces 2000`, {}"
    n_upright = sum(bool(row["ok"] and row["jacobian_min"] > 0) for row in rows)
    figures = [
        ("count error, median", "count_error_pct", "≤", 1, "{:.2f} %"),
        ("mean distance, median", "chamfer_pct", "≤", 0.045, "{:.3f} %"),
        ("Hausdorff distance, median", "hausdorff_pct", "≤", 0.9, "{:.2f} %"),
        ("scaled Jacobian, 1 % quantile, median", "jacobian_p01", "≥", 0.60, "{:.2f}"),
        ("scaled Jacobian, mean, median", "jacobian_mean", "≥", 0.955, "{:.3f}"),
        ("irregular vertices, median", "irregular_pct", "≤", 3.2, "{:.1f} %"),
        ("deviation from principal directions, median", "alignment_deg", "≤", 9.5, "{:.1f}°"),
        ("edges on closed loops, median", "loop_edges_pct", "≥", 28, "{:.0f} %"),
        ("quads in spirals, median", "spiral_pct", "≤", 7, "{:.1f} %"),
    ]
    cad = [row for row in rows if row["mesh"].startswith("cad_")]
    feature_f1 = median(cad, "feature_f1_pct")
    return [
        _sound(rows, what, 2),
        Bar(what.format("quads flow"), "", _count(rows, "is_used"), None),
        Bar(
            what.format("no inverted quad"),
            "on 90 %",
            f"on {n_upright} of {len(rows)}",
            n_upright >= 0.9 * len(rows),
        ),
        *(_figure(rows, what, figure) for figure in figures),
        Bar(
            what.format("feature F1 on the CAD parts, median"),
            "≥ 92",
            f"{feature_f1:.0f}",
            feature_f1 >= 92,
        ),
        *_against(rows, what, "quadriflow", 1.2),
    ]


def _flow_many(rows: list[Row]) -> list[Bar]:
    what = "`--primitive flow --faces 8000`, {}"
    return [_sound(rows, what, 1), *_against(rows, what, "quadriflow", 0.5)]


def _flow_few(rows: list[Row]) -> list[Bar]:
    what = "`--primitive flow --faces` 100, 200, 300 and 499, {}"
    upright = [{"ok": row["ok"] and row["jacobian_min"] > 0} for row in rows]
    return [
        _sound(rows, what, 3),
        Bar(what.format("quads flow"), "", _count(rows, "is_used"), None),
        Bar(what.format("no inverted quad"), "", _count(upright), None),
    ]


def _flow_even(rows: list[Row]) -> list[Bar]:
    what = "`--primitive flow --faces 2000 --adaptivity 0`, {}"
    return [_figure(rows, what, ("edge length CV, median", "edge_cv", "≤", 0.16, "{:.3f}"))]


def _flow_bodies(rows: list[Row]) -> list[Bar]:
    what = "five bodies, 2,000 quads, {}"
    worst = [
        ("largest Hausdorff distance", max, "hausdorff_pct", "≤", 1.0, "{:.2f} %"),
        ("largest mean distance when posed", max, "posed_chamfer_pct", "≤", 0.03, "{:.3f} %"),
        ("least scaled Jacobian", min, "jacobian_min", ">", 0.0, "{:.3f}"),
        ("fewest edges on closed loops", min, "loop_edges_pct", "≥", 35, "{:.0f} %"),
        ("most quads in spirals", max, "spiral_pct", "≤", 5, "{:.1f} %"),
    ]
    found = [_sound(rows, what, 1)]
    for words, most, key, sign, bar, form in worst:
        value = most(row[key] for row in rows if row["ok"])
        met = value <= bar if sign == "≤" else value > bar if sign == ">" else value >= bar
        found.append(Bar(what.format(words), f"{sign} {bar}", form.format(value), met))
    return found


def _flow_artists(rows: list[Row]) -> list[Bar]:
    what = "`quaternius`, the artist's number of quads, {}"
    upright = [{"ok": row["ok"] and row["n_inverted"] == 0} for row in rows]
    sound, all_sound = _count(rows, "is_sound"), _all(rows, "is_sound")
    return [
        Bar(what.format("closed and all quads"), "every one", sound, all_sound),
        Bar(what.format("quads flow"), "", _count(rows, "is_used"), None),
        Bar(what.format("no inverted quad"), "", _count(upright), None),
    ]


def _figure(rows: list[Row], what: str, figure: tuple[str, str, str, float, str]) -> Bar:
    words, key, sign, bar, form = figure
    value = median(rows, key)
    met = value <= bar if sign == "≤" else value >= bar
    return Bar(what.format(words), f"{sign} {bar}", form.format(value), met)


def _sound(rows: list[Row], what: str, most_pct: float) -> Bar:
    always = [{"ok": _is_sound(row, most_pct)} for row in rows]
    words = f"all quads, closed, genus 0, count within {most_pct} %"
    return Bar(what.format(words), "always", _count(always), _all(always))


def _against(rows: list[Row], what: str, peer: str, bar: float) -> list[Bar]:
    """CPU of inputs of 20,000 to 40,000 triangles against a peer's, if that was measured."""
    names = {"instant_meshes": "Instant Meshes", "quadriflow": "QuadriFlow"}
    ours = [row for row in in_peer_range(rows) if row.get(f"{peer}_s") and row["ok"]]
    if not ours:
        return []
    ratio = median([{"ratio": row["run_s"] / row[f"{peer}_s"]} for row in ours], "ratio")
    words = f"whole run, 20,000–40,000 triangles, CPU against {names[peer]}, median"
    return [Bar(what.format(words), f"≤ {bar}×", f"{ratio:.2f}×", ratio <= bar)]


def _is_sound(row: Row, most_pct: float) -> bool:
    return bool(
        row["ok"]
        and row["quads_pct"] == 100
        and row["same_topology"]
        and row["count_error_pct"] <= most_pct
    )


def _large(rows: list[Row]) -> list[Bar]:
    done = [row for row in rows if row["ok"]]
    if not done:
        return [Bar("1,000,000 triangles to 5,000 faces", "done", _count(rows), False)]
    cpu_s, peak = max(r["cpu_s"] for r in done), max(r["peak_mb"] for r in done)
    what = "1,000,000 triangles to 5,000 faces, worst of both kinds"
    return [
        Bar(f"{what}, CPU", "≤ 15 s", f"{cpu_s:.1f} s", _all(rows) and cpu_s <= 15),
        Bar(
            f"{what}, peak memory",
            "≤ 1.5 GB",
            f"{peak / 1024:.2f} GiB",
            _all(rows) and peak * 1024**2 <= 1.5e9,
        ),
    ]


def _identity(rows: list[Row]) -> list[Bar]:
    return [
        Bar(
            "same command twice, one thread",
            "same bytes",
            _count(rows, "twice"),
            _all(rows, "twice"),
        ),
        Bar(
            "one and two threads",
            "same bytes",
            _count(rows, "two_threads"),
            _all(rows, "two_threads"),
        ),
    ]


def _sizes(rows: list[Row]) -> list[Bar]:
    return [
        Bar(f"size of `{r['file']}`", "≤ 8 MB", f"{r['mb']:.2f} MB", r["mb"] <= 8) for r in rows
    ]


# Who makes the bars of a part: a new part needs a line here.
MAKERS: dict[str, Callable[[list[Row]], list[Bar]]] = {
    "validity": _validity,
    "cost": _cost,
    "threads": _threads,
    "triangles": _triangles,
    "quads": _quads,
    "flow": _flow,
    "flow_many": _flow_many,
    "flow_few": _flow_few,
    "flow_even": _flow_even,
    "flow_bodies": _flow_bodies,
    "flow_artists": _flow_artists,
    "large": _large,
    "identity": _identity,
    "sizes": _sizes,
}
