# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports and reasons of the core in an artist's words."""

import math
from typing import Any

from .translations import n_, rpt_

#: The steps of a run, by the core's names of them.
STEPS = {
    "starting": n_("starting"),
    "clean": n_("checking the mesh"),
    "solid": n_("making it solid"),
    "close": n_("closing holes"),
    "decimate": n_("unfolding"),
    "embed": n_("unfolding"),
    "sphere": n_("mapping"),
    "flow": n_("laying the loops"),
    "pair": n_("pairing triangles into quads"),
    "deform": n_("fitting to the surface"),
    "transfer": n_("carrying over your data"),
    "score": n_("measuring"),
}
# What cleaning drops, of one and of many.
_CLEANED = (
    ("n_isolated", n_("{:,} loose vertex"), n_("{:,} loose vertices")),
    (
        "n_degenerate",
        n_("{:,} face of fewer than 3 corners"),
        n_("{:,} faces of fewer than 3 corners"),
    ),
    ("n_duplicates", n_("{:,} face that is there twice"), n_("{:,} faces that are there twice")),
    (
        "n_doubled",
        n_("{:,} triangle back to back with another"),
        n_("{:,} triangles back to back with others"),
    ),
)
# What parts are that were left, by the kind of reason. The only primitives that leave a part for
# borders or handles are those that are the same for all shapes.
_OF_MANY = {
    "border": n_(
        "with holes (open edges), which this primitive cannot have: choose Automatic, or fill all "
        "borders"
    ),
    "handles": n_(
        "with a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ),
    "one-sided": n_("whose inside and outside cannot be told apart (like a Moebius strip)"),
    "flat": n_("flat"),
    "small": n_("too small for this face count"),
    "inside": n_("inside others"),
    "failed": n_("that could not be done"),
}
# Why one part is left, where that has no numbers.
_OF_ONE = {
    "one-sided": n_("inside and outside cannot be told apart (like a Moebius strip)"),
    "flat": n_("is flat"),
    "small": n_("is too small for this face count"),
    "inside": n_("lies inside another"),
}
_HOLES = (
    n_(
        "has {:,} hole (open edges), which this primitive cannot have: choose Automatic, or fill "
        "all borders"
    ),
    n_(
        "has {:,} holes (open edges), which this primitive cannot have: choose Automatic, or fill "
        "all borders"
    ),
)
_HANDLES = (
    n_(
        "has a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ),
    n_(
        "has {:,} holes through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ),
)
_OUTCOMES = {
    "kept": n_("{:,} of {:,} parts left as they were"),
    "dropped": n_("{:,} of {:,} parts left out"),
}
# What became of several objects.
_STATES = {
    "done": n_("{:,} done"),
    "warned": n_("{:,} with warnings"),
    "refused": n_("{:,} refused"),
}
# What whole bodies, heads and props have that artists modelled: at least, at most.
_OF_ARTISTS = {"loop_edges_pct": (33.0, math.inf), "spiral_pct": (0.0, 1.6)}
# What becomes of the artist's lines.
_HEEDED = {"laid": n_("{:,} laid"), "followed": n_("{:,} followed"), "lost": n_("{:,} lost")}
# How far edges are off them.
_OFF = (("distance", n_("{:.2f} edges")), ("angle", n_("{:.0f}°")))
# Of more texts than these the rest is counted.
_MOST_TEXTS = 3


def beside_artists(name: str, figures: dict[str, Any]) -> str:
    """How a figure of a closed mesh is beside what is made by hand; empty where that is unknown."""
    if name not in _OF_ARTISTS or not figures["closed"]:
        return ""
    least, most = _OF_ARTISTS[name]
    if figures[name] < least:
        return rpt_(", by hand more")
    return rpt_(", by hand less") if figures[name] > most else rpt_(", as by hand")


def status(step: str, share: float, left_s: float | None) -> str:
    """How far a run is."""
    left = "" if left_s is None else ", " + rpt_("{} left").format(_about(left_s))
    return f"{rpt_(STEPS[step])}, {100 * share:.0f} %{left}"


def _about(left_s: float) -> str:
    if left_s < 20:
        return rpt_("about {:.0f} s").format(max(left_s, 1))
    if left_s < 90:
        return rpt_("about {:.0f} s").format(5 * round(left_s / 5))
    return rpt_("about {:.0f} min").format(left_s / 60)


def count(n: int, one: str, many: str) -> str:
    """So many of something; `one` and `many` have a place for the number."""
    return rpt_(one if n == 1 else many).format(n)


def first_of(texts: list[str]) -> str:
    """The first texts, and how many more there are."""
    more = len(texts) - _MOST_TEXTS
    return "; ".join(
        texts[:_MOST_TEXTS] + ([rpt_("and {:,} more").format(more)] if more > 0 else [])
    )


def reason(reason: dict[str, Any]) -> str:
    """Why a part was left, as what it "has" or "is"."""
    kind = reason["kind"]
    if kind in _OF_ONE:
        return rpt_(_OF_ONE[kind])
    if kind == "border":
        return count(reason["n_loops"], *_HOLES)
    if kind == "handles":
        return count(reason["genus"], *_HANDLES)
    return rpt_("could not be done: {}").format(reason["text"])


def of_many(kind: str) -> str:
    """What parts are that were left for a kind of reason."""
    return rpt_(_OF_MANY[kind])


def sentence(report: dict[str, Any]) -> str:
    """What became of an object in one line; Blender joins lines without a space."""
    before, after = (report[side]["n_faces"] for side in ("input", "output"))
    told = [*warnings(report), *_kept(report, small=True), *exceptions(report)]
    return "; ".join([rpt_("{:,} faces became {:,}").format(before, after), *told])


def line(report: dict[str, Any]) -> str:
    """What became of one of several objects."""
    before, after = (report[side]["n_faces"] for side in ("input", "output"))
    return "; ".join([f"{before:,} → {after:,}", *warnings(report)])


def summary(states: list[str]) -> str:
    """What became of several objects in one line."""
    told = _STATES.items()
    return ", ".join(rpt_(each).format(states.count(it)) for it, each in told if it in states)


def faults(report: dict[str, Any]) -> list[str]:
    """What may be wrong with a result."""
    return [each["text"] for each in report["warnings"]]


def warnings(report: dict[str, Any]) -> list[str]:
    """What may be wrong with a result, and which parts of the mesh could not be done."""
    return faults(report) + _kept(report, small=False)


def is_grave(report: dict[str, Any]) -> bool:
    """Whether a result may be wrong, or a part could not be done."""
    return any(each["grave"] for each in report["warnings"]) or bool(_kept(report, small=False))


def counts(report: dict[str, Any]) -> list[str]:
    """How many parts were left as they were, and how many left out."""
    outcomes = [part["outcome"] for part in report["kept"]]
    return [
        _count(report, outcome, outcomes.count(outcome))
        for outcome in _OUTCOMES
        if outcome in outcomes
    ]


def _count(report: dict[str, Any], outcome: str, n: int) -> str:
    n_parts = len(report["parts"]) + len(report["kept"])
    return rpt_(_OUTCOMES[outcome]).format(n, n_parts)


def _kept(report: dict[str, Any], *, small: bool) -> list[str]:
    """The same of the small parts, or of the others, and why."""
    told = []
    for outcome in _OUTCOMES:
        kept = [part for part in report["kept"] if part["outcome"] == outcome]
        some = [part for part in kept if _is_small(part) == small]
        if some:
            told.append(f"{_count(report, outcome, len(some))}: {', '.join(_reasons(some))}")
    return told


def _is_small(part: dict[str, Any]) -> bool:
    """Whether a part was left because it is small or inside another, whatever else it is."""
    return any(each["kind"] in {"small", "inside"} for each in part["reasons"])


def _reasons(parts: list[dict[str, Any]]) -> list[str]:
    """Why parts were left, each kind of reason once."""
    kinds: dict[str, list[dict[str, Any]]] = {}
    for each in (each for part in parts for each in part["reasons"]):
        kinds.setdefault(each["kind"], []).append(each)
    return [
        reason(alike[0]) if len(parts) == 1 else f"{len(alike):,} {of_many(kind)}"
        for kind, alike in kinds.items()
    ]


def exceptions(report: dict[str, Any]) -> list[str]:
    """In words what else is otherwise than was asked for."""
    lost = ", ".join(sorted(set(report["lost"])))
    told = [_without_marks(report), rpt_("not carried over: {}").format(lost) if lost else ""]
    told += [_cleaned(report), _welded(report), _parted(report), _shown(report)]
    told += [_solid(report["solid"])] if report.get("solid") else []
    told += filled(report) + _modifiers(report)
    told += [each for each in lost_guides(report) if each not in faults(report)]
    if report["is_unguided"]:
        told.append(rpt_("nothing that is shown of the guides lies where it is"))
    return [each for each in told if each]


def _cleaned(report: dict[str, Any]) -> str:
    """What cleaning has dropped before the run."""
    n = ((report["clean"][name], *each) for name, *each in _CLEANED)
    dropped = ", ".join(count(*each) for each in n if each[0])
    return rpt_("left out: {}").format(dropped) if dropped else ""


def _shown(report: dict[str, Any]) -> str:
    """How many faces were hidden: those of the result are not."""
    n = report["n_hidden"]
    one, many = n_("{:,} hidden face is shown again"), n_("{:,} hidden faces are shown again")
    return count(n, one, many) if n else ""


def _welded(report: dict[str, Any]) -> str:
    """How many vertices of seams were welded."""
    n = report["clean"]["n_seam_welded"]
    one, many = n_("{:,} vertex of seams welded"), n_("{:,} vertices of seams welded")
    return count(n, one, many) if n else ""


def _parted(report: dict[str, Any]) -> str:
    """Where surfaces that share edges came apart."""
    n, sheets = (report["clean"][name] for name in ("n_shared_edges", "n_sheets"))
    if not n:
        return ""
    one = n_("taken apart at {:,} edge at which 3 or more faces meet")
    many = n_("taken apart at {:,} edges at which 3 or more faces meet")
    return count(n, one, many) + " " + count(sheets, n_("into {:,} sheet"), n_("into {:,} sheets"))


def filled(report: dict[str, Any]) -> list[str]:
    """How many borders were filled, and how many handles sealed."""
    opened = [part["opened"] for part in report["parts"] if part["opened"]]
    n_filled, n_sealed = (sum(each[name] for each in opened) for name in ("n_filled", "n_sealed"))
    told = (
        (n_filled, n_("{:,} border filled"), n_("{:,} borders filled")),
        (n_sealed, n_("{:,} handle sealed"), n_("{:,} handles sealed")),
    )
    return [count(*each) for each in told if each[0]]


def lost_guides(report: dict[str, Any]) -> list[str]:
    """Along which of the artist's lines no edges lie."""
    lost = [each["name"] for each in report["guides"] if each["outcome"] == "lost"]
    if not lost:
        return []
    n, n_all = len(lost), count(len(report["guides"]), n_("{:,} guide"), n_("{:,} guides"))
    told = n_("{:,} of {} is lost: {}"), n_("{:,} of {} are lost: {}")
    return [rpt_(told[n > 1]).format(n, n_all, first_of(lost))]


def guides(report: dict[str, Any]) -> list[tuple[str, str]]:
    """How the artist's lines were heeded, and how far edges are off them at most."""
    given = report["guides"]
    counts = [
        (sum(each["outcome"] == name for each in given), what) for name, what in _HEEDED.items()
    ]
    if not given:
        return []
    rows = [(n_("Guides"), ", ".join(rpt_(what).format(n) for n, what in counts if n))]
    off = off_guides([each for each in given if each["outcome"] != "lost"])
    return rows + ([(n_("Off guides by"), off)] if off else [])


def off_guides(given: list[dict[str, Any]]) -> str:
    """How far edges are off some of the artist's lines, of the worst; empty where nobody knows."""
    off = [
        rpt_(form).format(max(figures))
        for name, form in _OFF
        if (figures := [each[name] for each in given if each[name] is not None])
    ]
    return ", ".join(off)


def _solid(solid: dict[str, Any]) -> str:
    """What became of the shells that were made one surface."""
    counts = (
        ("n_walls", n_("{:,} with open edges closed")),
        ("n_turned", n_("{:,} turned inside out")),
        ("n_sheets", n_("{:,} made thick")),
        ("n_scraps", n_("{:,} left out: too small to be made thick")),
    )
    told = [rpt_(what).format(solid[name]) for name, what in counts if solid[name]]
    if n := solid["n_dropped"]:
        told.append(count(n, n_("{:,} speck left out"), n_("{:,} specks left out")))
    shells = count(solid["n_shells"], n_("{:,} shell"), n_("{:,} shells"))
    pieces = count(solid["n_pieces"], n_("{:,} closed surface"), n_("{:,} closed surfaces"))
    made = rpt_("{} made {}").format(shells, pieces)
    return made + (f" ({', '.join(told)})" if told else "")


def _modifiers(report: dict[str, Any]) -> list[str]:
    """Which modifiers went into the result, which makes it whole, and which may not fit it."""
    names, half = ", ".join(report["modifiers"]), report["half"]
    told = [rpt_("modifiers applied: {}").format(names) if names else ""]
    told += [rpt_("half is kept: modifier {} makes it whole").format(half) if half else ""]
    stays = rpt_("modifier {} stays: see whether it fits the new mesh")
    told += [stays.format(name) for name in report["nodes"]]
    return [each for each in told if each]


def _without_marks(report: dict[str, Any]) -> str:
    """Which share of what was left on edges is on no edge of the result, unless a warning says."""
    if any(each["kind"] == "lines" for each in report["warnings"]):
        return ""
    gone = 100 - report["carried"]["length_pct"] if report["carried"] else 0
    told = (
        n_("{:.0f} % of the marks of edges are gone: no edge lies there"),
        n_(
            "{:.0f} % of the marks of edges and breaks of custom normals are gone: no edge lies "
            "there"
        ),
    )
    # Chords are shorter than what they stand for.
    return rpt_(told[report["has_normals"]]).format(gone) if gone > 5 else ""
