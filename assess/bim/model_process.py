"""Work on a building model in a process of its own, with limits: its library is native code, and its file a stranger's.

Whatever such work does, it ends: the process is stopped at `SECONDS` of processor time (the clock counts where a
system does not count processor time), cannot use more than `MEMORY`, and takes nothing down with it if it crashes.

The process is this module, too: ``python -m assess.bim.model_process FOLDER``. It sets its own limits, does the work
that FOLDER/order names, and leaves FOLDER/answer. Its input is closed when the process that started it has ended; then
it ends, too.
"""

import importlib
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar, cast

from assess.delivery.folders import private_folder
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
OUT_OF_MEMORY = 3
"""Status with which the process ends when memory runs out."""

_Found = TypeVar("_Found")
_Given = ParamSpec("_Given")


def run_apart(
    name: str, progress: Progress, work: Callable[_Given, _Found], *args: _Given.args, **named: _Given.kwargs
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
    # in its own folder no file of the user's can take the place of a module
    root = str(Path(__file__).parents[2])
    paths = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    process = subprocess.Popen(  # noqa: S603 - our own module, in a folder that we named
        [sys.executable, "-m", "assess.bim.model_process", folder],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder,
        env={**os.environ, "PYTHONPATH": paths, "PYTHONSAFEPATH": "1"},
    )  # fmt: skip
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


def _too_long(name: str) -> ModelError:
    return ModelError(
        fill("{name} takes more than {n} s of processor time to be read. Export fewer storeys, or "
             "furniture, spaces, doors and walls only.", name=name, n=SECONDS)
    )  # fmt: skip


def main() -> None:
    """Do the work of the folder that is named, in the process of its own."""
    folder = Path(sys.argv[1])
    threading.Thread(target=_end_with_parent, daemon=True).start()
    module, function, args, named, seconds, memory = pickle.loads((folder / ORDER).read_bytes())  # noqa: S301
    limit(seconds, memory)
    try:
        work = getattr(importlib.import_module(module), function)
        answer = (False, work(*args, **named))
    except AssessError as error:
        answer = (True, error)
    except MemoryError:
        os._exit(OUT_OF_MEMORY)
    data = pickle.dumps(answer)
    part = folder / f"{ANSWER}.part"
    part.write_bytes(data)
    part.replace(folder / ANSWER)
    os._exit(0)  # without what libraries do at the end


def limit(seconds: int, memory: int) -> None:
    """Limit the processor time [s] and the memory [bytes] of this process, where the system can."""
    try:
        import resource
    except ImportError:  # Windows: the process that started this one looks at the clock
        return
    for kind, most in ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_AS, memory), (resource.RLIMIT_CORE, 0)):
        _, hard = resource.getrlimit(kind)
        allowed = most if hard == resource.RLIM_INFINITY else min(most, hard)
        try:
            resource.setrlimit(kind, (allowed, hard))
        except (OSError, ValueError):  # macOS does not limit addresses
            continue


def _end_with_parent() -> None:
    sys.stdin.buffer.read()
    os._exit(1)


if __name__ == "__main__":
    main()
