"""Runs one program in a process of its own and says what it cost."""

import os
import resource
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

CPU_LIMIT_S = 600


@dataclass(frozen=True)
class Run:
    """What one process did; CPU seconds are those of all its threads."""

    code: int
    cpu_s: float
    wall_s: float
    message: str

    @property
    def ok(self) -> bool:
        """Whether it ended well."""
        return self.code == 0


def run(command: Sequence[str | Path]) -> Run:
    """Runs a command to its end; start-up and files are part of what it costs.

    A shell stands in between: a process is charged with the memory of the one that it was forked
    from, and a shell is small, so that the peak memory in the program's report is its own.
    """

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S + 5))

    with tempfile.TemporaryFile("w+") as log:
        started = time.monotonic()
        process = subprocess.Popen(
            ["/bin/sh", "-c", '"$@"; exit $?', "sh", *map(str, command)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=log,
            preexec_fn=limit,
        )
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.monotonic() - started
        process.returncode = os.waitstatus_to_exitcode(status)
        log.seek(0)
        message = log.read().strip()[-400:]
    return Run(
        process.returncode,
        usage.ru_utime + usage.ru_stime,
        wall_s,
        message,
    )
