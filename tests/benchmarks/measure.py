"""Measures Orbflow and fills the tables of docs/benchmarks.md.

    python tests/benchmarks/measure.py [--only PART...] [--write docs/benchmarks.md]

Needs the built program, the folder `shared` beside the checkout (data/dev, data/quaternius,
data/poses, tools/quality, tools/peers) and the packages of the dependency group `bench`; QuadriFlow
runs where a Python with the bpy wheel is given. Results are kept in a file part by part, so that
one part can be measured again alone.
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
import remeshing
import topology
from bars import Results
from bench import Bench, Row
from tables import tables, write

ROOT = Path(__file__).resolve().parents[2]


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
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--write", type=Path, help="Markdown file whose marked parts are replaced")
    return parser.parse_args()


def main() -> None:
    """Measures the parts asked for and prints every table there is."""
    given = options()
    # Peers run in folders of their own, so paths must not depend on the current one.
    blender = given.blender and given.blender.absolute()
    bench = Bench(given.orbflow.resolve(), given.shared.resolve(), given.out.resolve(), blender)
    bench.out.mkdir(parents=True, exist_ok=True)
    log = bench.out / "results.json"
    results: Results = json.loads(log.read_text()) if log.exists() else {}
    for part in given.only:
        print(f"{part}:", flush=True)
        results[part] = PARTS[part](bench)
        log.write_text(json.dumps(results, indent=1, default=float))
    made = tables(results)
    for name, part in made.items():
        print(f"\n## {name}\n\n{part}")
    if given.write:
        write(given.write, made)


if __name__ == "__main__":
    main()
