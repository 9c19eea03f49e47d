"""Measures Orbflow and writes docs/benchmarks.md and docs/lab/per_mesh.md.

    python tests/benchmarks/measure.py [--only [PART...]] [--write]

Needs the built program, the folder `shared` beside the checkout (data/dev, data/quaternius,
data/poses, tools/quality, tools/peers) and the packages of the dependency group `bench`; QuadriFlow
runs where a Python with the bpy wheel is given. The rows are kept in OUT/results.json part
by part, so that one part can be measured again alone; what the documents show of them is kept in
docs/lab/measured.json, so that they keep the parts that were measured elsewhere. `--only` without
a part measures nothing.

A new part needs a line in `PARTS`, one in `topics.TABLES` and, where it has bars, one in
`bars.MAKERS`.
"""

import argparse
import importlib.util
import json
import os
import platform
import sys
from collections.abc import Callable
from pathlib import Path

import embedding
import flowing
import pages
import record
import remeshing
import topology
from bench import Bench, Row

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
RECORD = DOCS / "lab" / "measured.json"


def machine(bench: Bench) -> list[Row]:
    """The machine and its load: what to hold the seconds against."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    pages = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return [
        {
            "cpu": names[0] if names else platform.processor(),
            "n_cores": os.cpu_count(),
            "memory_gb": round(pages / 2**30),
            "system": f"{platform.system()} {platform.machine()}",
            "load": os.getloadavg(),
            "quadriflow": bench.blender is not None,
        }
    ]


def sizes(_: Bench) -> list[Row]:
    """The zips and wheels that were built."""
    found = sorted([*(ROOT / "dist").glob("orbflow*.zip"), *(ROOT / "dist").glob("*.whl")])
    return [{"file": path.name, "mb": path.stat().st_size / 1e6} for path in found]


PARTS: dict[str, Callable[[Bench], list[Row]]] = {
    "machine": machine,
    "validity": embedding.validity,
    "cost": embedding.cost,
    "threads": embedding.threads,
    "triangles": remeshing.triangles,
    "quads": remeshing.quads,
    "flow": flowing.flow,
    "flow_many": flowing.flow_many,
    "flow_few": flowing.flow_few,
    "flow_even": flowing.flow_even,
    "flow_bodies": flowing.flow_bodies,
    "flow_artists": flowing.flow_artists,
    "topology": topology.topology,
    "topology_peers": topology.topology_peers,
    "large": remeshing.large,
    "identity": remeshing.identity,
    "sizes": sizes,
}


def options() -> argparse.Namespace:
    """The command line."""
    has_bpy = importlib.util.find_spec("bpy") is not None
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orbflow", type=Path, default=ROOT / "target/release/orbflow")
    parser.add_argument("--shared", type=Path, default=ROOT.parent / "shared")
    parser.add_argument("--out", type=Path, default=ROOT / "target/bench")
    parser.add_argument("--blender", type=Path, default=Path(sys.executable) if has_bpy else None)
    parser.add_argument("--only", nargs="*", choices=PARTS, default=list(PARTS))
    parser.add_argument("--write", action="store_true", help="write the record and the documents")
    return parser.parse_args()


def main() -> None:
    """Measures the parts asked for and prints the page of all that was measured."""
    given = options()
    # Peers run in folders of their own, so paths must not depend on the current one.
    blender = given.blender and given.blender.absolute()
    bench = Bench(given.orbflow.resolve(), given.shared.resolve(), given.out.resolve(), blender)
    bench.out.mkdir(parents=True, exist_ok=True)
    kept = bench.out / "results.json"
    log = json.loads(kept.read_text()) if kept.exists() else {}
    build = record.build_of(ROOT)
    for part in given.only:
        print(f"{part}:", flush=True)
        log[part] = {"build": build, "rows": PARTS[part](bench)}
        kept.write_text(json.dumps(log, indent=1, default=float))
    found = record.read(RECORD) | record.recorded(log)
    print(f"\n{pages.benchmarks(found)}")
    if given.write:
        record.write(RECORD, found)
        (DOCS / "benchmarks.md").write_text(pages.benchmarks(found))
        (DOCS / "lab" / "per_mesh.md").write_text(pages.per_mesh(found))


if __name__ == "__main__":
    main()
