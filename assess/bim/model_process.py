"""Work on a building model in a process of its own, with limits: its library is native code, and its file a stranger's.

Whatever such work does, it ends: the process is stopped at `SECONDS` of processor time (the clock counts where a
system does not count processor time), cannot use more than `MEMORY`, and takes nothing down with it if it crashes.
"""

import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar, cast

from assess.delivery.private_folder import private_folder
from assess.errors import AssessError, ModelError
from assess.i18n import fill
from assess.progress import Progress

SECONDS = 120
"""Processor time that the work may take [s]; the clock may show `PATIENCE` times as much."""
MEMORY = 4 * 2**30
"""Memory that it may use [bytes]."""
PATIENCE = 4
_ASKED_EVERY = 0.05
PREFIX = "assess-model-"
ORDER, ANSWER = "order", "answer"
"""Names of the files in which a process gets its work and leaves what came out."""

_Found = TypeVar("_Found")
_Given = ParamSpec("_Given")


def run_apart(
    name: str,
    progress: Progress,
    work: Callable[_Given, _Found],
    *args: _Given.args,
    **named: _Given.kwargs,
) -> _Found:
    """Return what `work` returns, called in a process of its own.

    `work`: a function of a module of this package; arguments and what it returns are plain data.

    Raises ModelError if the process crashed, or reached a limit; AssessError as `work` raises it.
    """
    with private_folder(PREFIX) as folder:
        order = (work.__module__, work.__qualname__, args, named, SECONDS, MEMORY)
        (folder / ORDER).write_bytes(pickle.dumps(order))
        status = _wait(str(folder), name, progress)
        answer = folder / ANSWER
        if not answer.exists():
            raise _explain(name, status)
        is_error, found = pickle.loads(answer.read_bytes())  # noqa: S301  written by our own process, just now
    if is_error:
        raise cast(AssessError, found)
    return cast(_Found, found)


def _wait(folder: str, name: str, progress: Progress) -> int:
    process = _start(folder)
    end = time.monotonic() + PATIENCE * SECONDS
    try:
        while True:
            progress.check()
            try:
                return process.wait(_ASKED_EVERY)
            except subprocess.TimeoutExpired:
                if time.monotonic() > end:
                    raise _too_long(name) from None
    finally:
        process.kill()
        process.communicate()


def _start(folder: str) -> "subprocess.Popen[bytes]":
    """Start the process in its own folder, where no file of the user's can take the place of a module."""
    root = str(Path(__file__).parents[2])
    paths = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    return subprocess.Popen(  # noqa: S603 - our own module, in a folder that we named
        [sys.executable, "-m", "assess.bim.model_worker", folder],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder,
        env={**os.environ, "PYTHONPATH": paths, "PYTHONSAFEPATH": "1"},
    )  # fmt: skip


def _explain(name: str, status: int) -> ModelError:
    xcpu = getattr(signal, "SIGXCPU", 0)
    if xcpu and status == -xcpu:
        return _too_long(name)
    if status == OUT_OF_MEMORY:
        return ModelError(
            fill("{name} needs more than {most} GB of memory to be read. Export fewer storeys, or furniture, "
                 "spaces, doors and walls only.", name=name, most=MEMORY // 2**30)
        )  # fmt: skip
    return ModelError(
        fill("{name} could not be read: the library that reads building models stopped. The file may be damaged, "
             "or need more than {most} GB of memory. Export it again from the program that made it.",
             name=name, most=MEMORY // 2**30)
    )  # fmt: skip


OUT_OF_MEMORY = 3
"""Status with which the process ends when memory runs out."""


def _too_long(name: str) -> ModelError:
    return ModelError(
        fill("{name} takes more than {n} s of processor time to be read. Export fewer storeys, or "
             "furniture, spaces, doors and walls only.", name=name, n=SECONDS)
    )  # fmt: skip
