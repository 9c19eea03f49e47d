"""Every table of the documents, in their order: a new part needs a line here.

`docs/benchmarks.md` has the short form of each, `docs/lab/per_mesh.md` the whole of those that
were shortened. Tables of one topic stand under one heading.
"""

from collections.abc import Callable

import columns
import tables
from bars import Results
from bench import Row
from tables import Table, as_it_is, by_mesh, left_out


def _of(part: str, make: Callable[[list[Row]], str]) -> Callable[[Results], str]:
    return lambda results: make(results[part])


EMBEDDING = (
    "`orbflow embed IN --predictor solver --threads 1`, medians of five meshes brought to each"
    " number of vertices. *Energy* is the mean of log(1 + symmetric Dirichlet energy) by area."
    " No distortion at all would be 1.609."
)
THREADS = "Two threads against one at 50,000 vertices, the best wall time of nine runs each."
TRIANGLES = (
    "`orbflow remesh IN OUT --kind triangles --faces 6000 --threads 1`, beside isotropic"
    " remeshing (MeshLab) asked for the same number."
)
QUADS = (
    "`orbflow remesh IN OUT --primitive quad-sphere --faces 2000 --threads 1`,"
    " beside Instant Meshes and QuadriFlow asked for the same number."
)
FLOW = (
    "`orbflow remesh IN OUT --faces 2000 --threads 1` with default settings, with `--faces 8000`"
    " and, *even*, with `--adaptivity 0`, beside QuadriFlow asked for the same number."
)
BODIES = (
    "Five bodies of `poses` at rest, 2,000 quads. *Posed* is the mean distance after the result"
    " has followed the input into its other poses."
)
ARTISTS = (
    "The closed parts of genus 0 of `quaternius`, at half as many quads as they have triangles."
    " Figures are of those whose artist made mostly quads."
)
OPEN = (
    "Models of `basemesh` (every 24th, at their own count), clothes and the models of `dev` that"
    " are open, have handles or several parts (2,000 quads). *Done* has the pieces, borders and"
    " handles of the input and leaves no part as it was. The columns of the peers count the same."
)

TABLES = (
    Table(
        "cost",
        "cost",
        "Embedding",
        EMBEDDING,
        by_mesh("cost", columns.COST, False),
        tables.by_vertices,
    ),
    Table("threads", "threads", "Embedding", THREADS, by_mesh("threads", columns.THREADS)),
    Table(
        "triangles", "triangles", "Triangles", TRIANGLES, by_mesh("triangles", columns.TRIANGLES)
    ),
    Table("quads", "quads", "Quad sphere", QUADS, by_mesh("quads", columns.QUADS)),
    Table(
        "quads", "whole", "Quad sphere", "What these runs cost:", by_mesh("quads", columns.WHOLE)
    ),
    Table(
        "quads",
        "steps",
        "Quad sphere",
        "Where the time goes:",
        _of("quads", tables.steps_table),
        left_out,
    ),
    Table(
        "flow",
        "flow",
        "Flow",
        FLOW,
        by_mesh("flow", columns.FLOW),
        label="2,000",
    ),
    Table("flow_many", "flow_many", "Flow", "", by_mesh("flow_many", columns.FLOW), label="8,000"),
    Table(
        "flow_even", "flow_even", "Flow", "", by_mesh("flow_even", columns.FLOW), label="2,000 even"
    ),
    Table(
        "flow_few",
        "flow_few",
        "Flow",
        "Few quads: shares of the meshes, and medians over them.",
        _of("flow_few", tables.few_table),
        as_it_is,
    ),
    Table(
        "flow",
        "flow_steps",
        "Flow",
        "Where the time goes; *sphere* makes the even surface:",
        _of("flow", tables.steps_table),
        left_out,
    ),
    Table("flow_bodies", "flow_bodies", "Bodies", BODIES, by_mesh("flow_bodies", columns.BODIES)),
    Table(
        "flow_artists",
        "flow_artists",
        "Artists' parts",
        ARTISTS,
        _of("flow_artists", tables.artists_table),
        as_it_is,
    ),
    Table(
        "topology",
        "topology",
        "Open meshes, by kind",
        OPEN,
        lambda results: tables.kinds_table(results["topology"], results.get("topology_peers", [])),
        as_it_is,
    ),
    Table(
        "large",
        "large",
        "A million triangles",
        "`--faces 5000 --threads 1`.",
        by_mesh("large", columns.LARGE, False),
        as_it_is,
    ),
)
