# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports and reasons of the core in an artist's words."""

import math
from typing import Any

#: The steps of a run, by the core's names of them.
STEPS = {
    "starting": "starting",
    "clean": "checking the mesh",
    "solid": "making it solid",
    "close": "closing holes",
    "decimate": "unfolding",
    "embed": "unfolding",
    "sphere": "mapping",
    "flow": "laying the loops",
    "pair": "pairing triangles into quads",
    "deform": "fitting to the surface",
    "transfer": "carrying over your data",
    "score": "measuring",
}
# What cleaning drops, of one and of many.
_CLEANED = (
    ("n_isolated", ("loose vertex", "loose vertices")),
    ("n_degenerate", ("face of fewer than 3 corners", "faces of fewer than 3 corners")),
    ("n_duplicates", ("face that is there twice", "faces that are there twice")),
    ("n_doubled", ("triangle back to back with another", "triangles back to back with others")),
)
# The only ones that leave a part for borders or handles are those that are the same for all shapes.
_CLOSED_ALONE = ", which this primitive cannot have: choose Automatic"
_FILL = ", or fill all borders"
#: What parts are that were left, by the kind of reason.
OF_MANY = {
    "border": f"with holes (open edges){_CLOSED_ALONE}{_FILL}",
    "handles": f"with a hole through it like a ring or cup handle{_CLOSED_ALONE}",
    "one-sided": "whose inside and outside cannot be told apart (like a Moebius strip)",
    "flat": "flat",
    "small": "too small for this face count",
    "inside": "inside others",
    "failed": "that could not be done",
}
# Why one part is left, where that has no numbers.
_OF_ONE = {
    "one-sided": "inside and outside cannot be told apart (like a Moebius strip)",
    "flat": "is flat",
    "small": "is too small for this face count",
    "inside": "lies inside another",
}
_OUTCOMES = {"kept": "left as they were", "dropped": "left out"}
# What whole bodies, heads and props have that artists modelled: at least, at most.
_OF_ARTISTS = {"loop_edges_pct": (33.0, math.inf), "spiral_pct": (0.0, 1.6)}
# What becomes of the artist's lines.
_HEEDED = ("laid", "followed", "lost")
# Of more texts than these the rest is counted.
_MOST_TEXTS = 3


def beside_artists(name: str, figures: dict[str, Any]) -> str:
    """How a figure of a closed mesh is beside what is made by hand; empty where that is unknown."""
    if name not in _OF_ARTISTS or not figures["closed"]:
        return ""
    least, most = _OF_ARTISTS[name]
    if figures[name] < least:
        return ", by hand more"
    return ", by hand less" if figures[name] > most else ", as by hand"


def status(step: str, share: float, left_s: float | None) -> str:
    """How far a run is."""
    left = "" if left_s is None else f", {_about(left_s)} left"
    return f"{STEPS[step]}, {100 * share:.0f} %{left}"


def _about(left_s: float) -> str:
    if left_s < 20:
        return f"about {max(left_s, 1):.0f} s"
    if left_s < 90:
        return f"about {5 * round(left_s / 5)} s"
    return f"about {left_s / 60:.0f} min"


def count(n: int, one: str, many: str = "") -> str:
    """So many of something."""
    return f"{n:,} {one if n == 1 else many or one + 's'}"


def first_of(texts: list[str]) -> str:
    """The first texts, and how many more there are."""
    more = len(texts) - _MOST_TEXTS
    return "; ".join(texts[:_MOST_TEXTS] + ([f"and {more:,} more"] if more > 0 else []))


def reason(reason: dict[str, Any]) -> str:
    """Why a part was left, as what it "has" or "is"."""
    kind = reason["kind"]
    if kind in _OF_ONE:
        return _OF_ONE[kind]
    if kind == "border":
        return f"has {count(reason['n_loops'], 'hole')} (open edges){_CLOSED_ALONE}{_FILL}"
    if kind == "handles":
        through = "a hole" if reason["genus"] == 1 else f"{reason['genus']:,} holes"
        return f"has {through} through it like a ring or cup handle{_CLOSED_ALONE}"
    return f"could not be done: {reason['text']}"


def sentence(report: dict[str, Any]) -> str:
    """What became of an object in one line; Blender joins lines without a space."""
    before, after = (report[side]["n_faces"] for side in ("input", "output"))
    told = [*warnings(report), *_kept(report, small=True), *exceptions(report)]
    return "; ".join([f"{before:,} faces became {after:,}", *told])


def line(report: dict[str, Any]) -> str:
    """What became of one of several objects."""
    before, after = (report[side]["n_faces"] for side in ("input", "output"))
    return "; ".join([f"{before:,} → {after:,}", *warnings(report)])


def summary(states: list[str]) -> str:
    """What became of several objects in one line."""
    told = (("done", "done"), ("warned", "with warnings"), ("refused", "refused"))
    counts = [f"{states.count(state):,} {each}" for state, each in told if state in states]
    return ", ".join(counts)


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
    return f"{n:,} of {n_parts:,} parts {_OUTCOMES[outcome]}"


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
        reason(alike[0]) if len(parts) == 1 else f"{len(alike):,} {OF_MANY[kind]}"
        for kind, alike in kinds.items()
    ]


def exceptions(report: dict[str, Any]) -> list[str]:
    """In words what else is otherwise than was asked for."""
    lost = ", ".join(sorted(set(report["lost"])))
    told = [_without_marks(report), f"not carried over: {lost}" if lost else ""]
    told += [_cleaned(report), _welded(report), _parted(report), _shown(report)]
    told += [_solid(report["solid"])] if report.get("solid") else []
    told += filled(report) + _modifiers(report)
    told += [each for each in lost_guides(report) if each not in faults(report)]
    told += ["nothing that is shown of the guides lies where it is"] * report["is_unguided"]
    return [each for each in told if each]


def _cleaned(report: dict[str, Any]) -> str:
    """What cleaning has dropped before the run."""
    n = ((report["clean"][name], *each) for name, each in _CLEANED)
    dropped = ", ".join(count(*each) for each in n if each[0])
    return f"left out: {dropped}" if dropped else ""


def _shown(report: dict[str, Any]) -> str:
    """How many faces were hidden: those of the result are not."""
    n = report["n_hidden"]
    return f"{count(n, 'hidden face')} {'is' if n == 1 else 'are'} shown again" if n else ""


def _welded(report: dict[str, Any]) -> str:
    """How many vertices of seams were welded."""
    n = report["clean"]["n_seam_welded"]
    return f"{count(n, 'vertex', 'vertices')} of seams welded" if n else ""


def _parted(report: dict[str, Any]) -> str:
    """Where surfaces that share edges came apart."""
    n, sheets = (report["clean"][name] for name in ("n_shared_edges", "n_sheets"))
    edges = f"{count(n, 'edge')} at which 3 or more faces meet"
    return f"taken apart at {edges} into {count(sheets, 'sheet')}" if n else ""


def filled(report: dict[str, Any]) -> list[str]:
    """How many borders were filled, and how many handles sealed."""
    opened = [part["opened"] for part in report["parts"] if part["opened"]]
    n_filled, n_sealed = (sum(each[name] for each in opened) for name in ("n_filled", "n_sealed"))
    told = [f"{count(n_filled, 'border')} filled"] if n_filled else []
    return told + ([f"{count(n_sealed, 'handle')} sealed"] if n_sealed else [])


def lost_guides(report: dict[str, Any]) -> list[str]:
    """Along which of the artist's lines no edges lie."""
    lost = [each["name"] for each in report["guides"] if each["outcome"] == "lost"]
    if not lost:
        return []
    n, n_all = len(lost), count(len(report["guides"]), "guide")
    return [f"{n:,} of {n_all} {'is' if n == 1 else 'are'} lost: {first_of(lost)}"]


def guides(report: dict[str, Any]) -> list[tuple[str, str]]:
    """How the artist's lines were heeded, and how far edges are off them at most."""
    given = report["guides"]
    counts = [(sum(each["outcome"] == name for each in given), name) for name in _HEEDED]
    if not given:
        return []
    rows = [("Guides", ", ".join(f"{n:,} {name}" for n, name in counts if n))]
    off = off_guides([each for each in given if each["outcome"] != "lost"])
    return rows + ([("Off guides by", off)] if off else [])


def off_guides(given: list[dict[str, Any]]) -> str:
    """How far edges are off some of the artist's lines, of the worst; empty where nobody knows."""
    off = [
        form.format(max(figures))
        for name, form in (("distance", "{:.2f} edges"), ("angle", "{:.0f}°"))
        if (figures := [each[name] for each in given if each[name] is not None])
    ]
    return ", ".join(off)


def _solid(solid: dict[str, Any]) -> str:
    """What became of the shells that were made one surface."""
    counts = (
        ("n_walls", "with open edges closed"),
        ("n_turned", "turned inside out"),
        ("n_sheets", "made thick"),
        ("n_scraps", "left out: too small to be made thick"),
    )
    told = [f"{solid[name]:,} {what}" for name, what in counts if solid[name]]
    told += [f"{count(solid['n_dropped'], 'speck')} left out"] if solid["n_dropped"] else []
    shells, pieces = count(solid["n_shells"], "shell"), count(solid["n_pieces"], "closed surface")
    return f"{shells} made {pieces}" + (f" ({', '.join(told)})" if told else "")


def _modifiers(report: dict[str, Any]) -> list[str]:
    """Which modifiers went into the result, which makes it whole, and which may not fit it."""
    names, half = ", ".join(report["modifiers"]), report["half"]
    told = [f"modifiers applied: {names}" if names else ""]
    told += [f"half is kept: modifier {half} makes it whole" if half else ""]
    told += [f"modifier {name} stays: see whether it fits the new mesh" for name in report["nodes"]]
    return [each for each in told if each]


def _without_marks(report: dict[str, Any]) -> str:
    """Which share of what was left on edges is on no edge of the result, unless a warning says."""
    if any(each["kind"] == "lines" for each in report["warnings"]):
        return ""
    gone = 100 - report["carried"]["length_pct"] if report["carried"] else 0
    marks = "marks of edges"
    if report["has_normals"]:
        marks += " and breaks of custom normals"
    # Chords are shorter than what they stand for.
    return f"{gone:.0f} % of the {marks} are gone: no edge lies there" if gone > 5 else ""
