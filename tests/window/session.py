"""What Blender runs in its window: the checks that were asked for, one after the other.

Each starts with an empty scene. What fails is told and does not stop the others.
"""

import os
import sys
import time
import traceback
from collections.abc import Callable, Generator
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import checks  # noqa: E402
import hand  # noqa: E402
import scene  # noqa: E402
import shots  # noqa: E402

OUT = HERE / "out"
Check = Callable[[], hand.Waits]


def all_of(names: list[str]) -> hand.Waits:
    """Runs checks by their names, all of them where none is named."""
    known: dict[str, Check] = checks.CHECKS | {"pictures": shots.pictures}
    names = names or list(checks.CHECKS)
    failed = []
    for name in names:
        start = time.monotonic()
        error = yield from _one(known[name])
        spent = time.monotonic() - start
        hand.picture(OUT / f"{name}.png")
        _tell(f"{'failed' if error else 'passed'} {name} ({spent:.0f} s)")
        if error:
            failed.append(name)
            _tell(error)
    _tell(f"{len(names) - len(failed)} passed, {len(failed)} failed")
    os._exit(1 if failed else 0)


def _one(check: Check) -> Generator[float, None, str]:
    """Runs one check; what it returns is its error, empty where there is none."""
    try:
        yield from scene.prepare()
        yield from check()
    except Exception:
        return traceback.format_exc()
    return ""


def _tell(text: str) -> None:
    with (OUT / "result.txt").open("a") as result:
        print(text, file=result)


def main() -> None:
    """Starts the checks as soon as the window is there."""
    bpy.context.preferences.view.show_splash = False
    steps = all_of(sys.argv[sys.argv.index("--") + 1 :])

    def tick() -> float:
        try:
            return next(steps)
        except BaseException:
            _tell(traceback.format_exc())
            os._exit(1)

    bpy.app.timers.register(tick, first_interval=2.0, persistent=True)


main()
