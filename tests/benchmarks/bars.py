"""Holds what was measured against what was to be reached."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bench import Row, median
from embedding import COST_VERTICES
from remeshing import in_peer_range

Results = dict[str, list[Row]]


@dataclass(frozen=True)
class Bar:
    """One line of the summary; `met` is None where it was not measured."""

    what: str
    bar: str
    measured: str
    met: bool | None


def bars(results: Results) -> list[Bar]:
    """Every bar of which something was measured."""
    makers: list[tuple[str, Callable[[list[Row]], list[Bar]]]] = [
        ("validity", _validity),
        ("cost", _cost),
        ("threads", _threads),
        ("triangles", _triangles),
        ("quads", _quads),
        ("large", _large),
        ("identity", _identity),
        ("sizes", _sizes),
    ]
    return [bar for name, make in makers if results.get(name) for bar in make(results[name])]


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
    return [Bar(what, "≥ 1.6×", f"{ratio:.2f}×", ratio >= 1.6)]


def _triangles(rows: list[Row]) -> list[Bar]:
    what = "`--kind triangles --faces 6000`, {}"
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
    what = "`--kind quads --faces 2000`, {}"
    always = [{"ok": _is_sound(row)} for row in rows]
    f1 = median(rows, "f1_at_1_pct")
    ours = in_peer_range(rows)
    found = [
        Bar(
            what.format("all quads, closed, genus 0, count within 2 %"),
            "always",
            _count(always),
            _all(always),
        ),
        Bar(what.format("F1 at 1 %, median"), "≥ 97", f"{f1:.2f}", f1 >= 97),
    ]
    for peer, name, bar in (
        ("instant_meshes_s", "Instant Meshes", 4),
        ("quadriflow_s", "QuadriFlow", 0.6),
    ):
        ratios = [{"ratio": r["run_s"] / r[peer]} for r in ours if r.get(peer) and r["ok"]]
        if ratios:
            ratio = median(ratios, "ratio")
            line = (
                f"whole run of 20,000–40,000 triangles to 2,000 quads, CPU against {name}, median"
            )
            found.append(Bar(line, f"≤ {bar}×", f"{ratio:.2f}×", ratio <= bar))
    return found


def _is_sound(row: Row) -> bool:
    return bool(
        row["ok"]
        and row["quads_pct"] == 100
        and row["same_topology"]
        and abs(row["faces"] / row["n_asked"] - 1) <= 0.02
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
