"""Modules of our own that run in a process of their own, and the limits that such a process sets itself."""

import os
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

OUT_OF_MEMORY = 3  # status with which a process ends when memory runs out
_OWN_GROUP: int = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
"""Out of the reach of a Ctrl-C in the terminal on Windows; elsewhere the process gets a session of its own."""


def start_module(
    module: str, folder: Path, *, output: int = subprocess.PIPE, errors: object = None, is_apart: bool = True,
    variables: Mapping[str, str] | None = None,
) -> subprocess.Popen[bytes]:  # fmt: skip
    """Start ``python -m MODULE FOLDER`` in a folder that we named; its input is a pipe, closed when this process ends.

    No file of that folder takes the place of a module. `is_apart`: a Ctrl-C in the terminal does not reach it.
    """
    paths = os.pathsep.join(filter(None, (str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH"))))
    return subprocess.Popen(  # type: ignore[call-overload,no-any-return]  # noqa: S603
        [sys.executable, "-m", module, str(folder)], cwd=folder, stdin=subprocess.PIPE, stdout=output, stderr=errors,
        env={**os.environ, **(variables or {}), "PYTHONPATH": paths, "PYTHONSAFEPATH": "1"},
        creationflags=_OWN_GROUP if is_apart else 0, start_new_session=is_apart,
    )  # fmt: skip


def limit_process(memory: float, seconds: float = float("inf")) -> None:
    """Limit the memory [bytes] and the processor time [s] of this process, as far as the system does; no core dumps.

    Windows has no such limits: who started the process looks at the clock.
    """
    try:
        import resource
    except ImportError:
        return
    for kind, most in ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_AS, memory), (resource.RLIMIT_CORE, 0)):
        _, hard = resource.getrlimit(kind)
        if most < float("inf"):
            allowed = int(most) if hard == resource.RLIM_INFINITY else min(int(most), hard)
            with suppress(OSError, ValueError):  # macOS does not limit addresses
                resource.setrlimit(kind, (allowed, hard))
