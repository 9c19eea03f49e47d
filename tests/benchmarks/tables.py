"""Makes Markdown tables of what was measured, and shorter ones of these."""

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import columns
from bars import Results
from bench import Row, median
from columns import Columns

KIND_PEERS = {"instant_meshes": "Instant Meshes", "quadriflow": "QuadriFlow"}
KIND_COUNTS = (("inverted", 0), ("is_used", True))
KIND_BORDERS = ("border_mean_edges", "border_largest_edges", ".2f")
ARTISTS = (
    ("loop_edges_pct", "edges on closed loops", "{:.0f} %"),
    ("alignment_deg", "deviation from principal directions", "{:.1f}°"),
    ("spiral_pct", "quads in spirals", "{:.1f} %"),
)
MEDIAN = "**median**"


def line(cells: Sequence[str]) -> str:
    """One line of a table."""
    return f"| {' | '.join(cells)} |"


def framed(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table with its head."""
    return "\n".join([line(head), "|" + "---|" * len(head), *map(line, rows)])


def table(rows: Sequence[Row], of: Columns, with_median: bool = True) -> str:
    """One line a mesh, failures in words, medians at the end."""
    lines = []
    for row in rows:
        if row.get("ok", True):
            lines.append([row["mesh"], *(_cell(row.get(k), f) for k, _, f in of)])
        else:
            lines.append([row["mesh"], f"failed ({row['code']}): {row['error']}"])
    if with_median:
        lines.append([MEDIAN, *(_median_cell(rows, key, form) for key, _, form in of)])
    return framed(["mesh", *(title for _, title, _ in of)], lines)


def _median_cell(rows: Sequence[Row], key: str, form: str) -> str:
    return "" if form == "s" else _cell(median(rows, key), form.replace("d", ".0f"))


def _cell(value: object, form: str) -> str:
    return "–" if value is None or value != value else format(value, form)


def few_table(rows: Sequence[Row]) -> str:
    """One line a number of quads: shares of the meshes and medians over them."""
    lines = []
    for n_asked in dict.fromkeys(row["n_asked"] for row in rows if row["ok"]):
        group = [row for row in rows if row["ok"] and row["n_asked"] == n_asked]
        figures: Row = {key: median(group, key) for key, _, _ in columns.FEW[3:]}
        figures |= {
            "n_asked": n_asked,
            "flow_share": sum(row["is_used"] for row in group) / len(group),
            "upright_share": sum(row["jacobian_min"] > 0 for row in group) / len(group),
        }
        lines.append([_cell(figures[key], form) for key, _, form in columns.FEW])
    return framed([title for _, title, _ in columns.FEW], lines)


def artists_table(rows: Sequence[Row]) -> str:
    """Medians of our figures and of the artists' own models', where these are of quads."""
    n = sum(row.get("loop_edges_pct") is not None for row in rows)
    lines = []
    for key, words, form in ARTISTS:
        found = [median(rows, name) for name in (key, f"artists_{key}")]
        lines.append([words, *(form.format(value) for value in found)])
    return framed([f"medians of {n} models", "Orbflow", "the artists' own"], lines)


def kinds_table(rows: Sequence[Row], peers: Sequence[Row]) -> str:
    """One line a kind of model: how many come out with the input's topology, ours and theirs."""
    of_peers = {row["mesh"]: row for row in peers}
    head = ["kind", "models", "done", "not one inverted quad", "flow in all of it"]
    head += ["loops; spirals %", "border off by, edges: mean; largest", *KIND_PEERS.values()]
    lines = []
    for kind in (*dict.fromkeys(row["kind"] for row in rows), None):
        group = [row for row in rows if kind in (row["kind"], None)]
        done = [row for row in group if row.get("is_alike") and not row["n_kept"]]
        theirs = [of_peers.get(row["mesh"], {}) for row in group]
        cells = [kind or "**all**", str(len(group)), str(len(done))]
        cells += [str(sum(row[key] == value for row in done)) for key, value in KIND_COUNTS]
        for pair in (("loop_edges_pct", "spiral_pct", ".0f"), KIND_BORDERS):
            cells.append("; ".join(_cell(median(done, key), pair[2]) for key in pair[:2]))
        n_alike = [sum(bool(row.get(f"{p}_is_alike")) for row in theirs) for p in KIND_PEERS]
        lines.append([*cells, *(str(n) if peers else "–" for n in n_alike)])
    return framed(head, lines)


def steps_table(rows: Sequence[Row]) -> str:
    """Median CPU seconds of every step."""
    done = [row["steps_s"] for row in rows if row.get("ok") and "steps_s" in row]
    names = list(dict.fromkeys(name for steps in done for name in steps))
    seconds = [f"{median(done, name):.3f}" for name in names]
    return framed(["step", *names], [["median CPU s", *seconds]])


def machine_table(rows: Sequence[Row]) -> str:
    """The machine in a sentence."""
    row = rows[0]
    return (
        f"{row['n_cores']} cores of {row['cpu']}, {row['memory_gb']} GB of memory, "
        f"{row['system']}; load {row['load'][0]:.1f} when it was looked at."
    )


def cells_of(text: str) -> list[list[str]]:
    """The cells of a table, without the line below its head."""
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in text.splitlines()]
    return [rows[0], *rows[2:]]


def spread(text: str) -> str:
    """Of a table with a line a mesh: the medians, and from where to where each column goes."""
    head, *rows = cells_of(text)
    meshes = [row for row in rows if row[0] != MEDIAN and len(row) == len(head)]
    ranges = [_range([row[i] for row in meshes]) for i in range(1, len(head))]
    medians = [row for row in rows if row[0] == MEDIAN]
    return framed([f"{len(meshes)} meshes", *head[1:]], [*medians, ["range", *ranges]])


def _range(cells: Sequence[str]) -> str:
    numbers = sorted((cell for cell in cells if _is_number(cell)), key=float)
    return f"{numbers[0]} – {numbers[-1]}" if numbers else "–"


def _is_number(cell: str) -> bool:
    return cell.lstrip("-").replace(".", "", 1).isdigit()


def by_vertices(text: str) -> str:
    """Of a table with a line a mesh and size: the medians of each size."""
    head, *rows = cells_of(text)
    lines = []
    for size in dict.fromkeys(row[1] for row in rows):
        group = [row for row in rows if row[1] == size]
        found = [_median_of([row[i] for row in group]) for i in range(2, len(head))]
        lines.append([size, *found])
    return framed([head[1], *head[2:]], lines)


def _median_of(cells: Sequence[str]) -> str:
    """The middle one as it is written; of an even number the lower of the two."""
    numbers = sorted((cell for cell in cells if _is_number(cell)), key=float)
    return str(statistics.median_low(numbers)) if numbers else "–"


def as_it_is(text: str) -> str:
    """A table that is short already."""
    return text


def left_out(_: str) -> str:
    """Nothing: a table for the lab alone."""
    return ""


def joined(one: str, other: str) -> str:
    """Two tables with the same columns as one."""
    return "\n".join([one, *other.splitlines()[2:]])


def labelled(text: str, label: str) -> str:
    """The same with what its lines are of."""
    head, *rows = cells_of(text)
    return framed(head, [[f"{label}, {row[0].strip('*')}", *row[1:]] for row in rows])


@dataclass(frozen=True)
class Table:
    """A table: of which part, under which heading, with which words, and how it is made."""

    part: str
    name: str
    topic: str
    words: str
    make: Callable[[Results], str]
    shorten: Callable[[str], str] = spread
    # What its lines are of, where a table with the same columns stands before it.
    label: str = ""


def by_mesh(part: str, of: Columns, with_median: bool = True) -> Callable[[Results], str]:
    """Makes one line a mesh of a part's rows."""
    return lambda results: table(results[part], of, with_median)
