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
from contextlib import suppress
from pathlib import Path
from typing import ParamSpec, TypeVar, cast

from assess.delivery.folders import private_folder
from assess.errors import AssessError, ModelError
from assess.i18n import fill
from assess.processes import OUT_OF_MEMORY, limit_process, start_module
from assess.progress import Progress

SECONDS = 120  # processor time that the work may take [s]; the clock may show `PATIENCE` times as much
MEMORY = 4 * 2**30  # memory that it may use [bytes]
PATIENCE = 4
_ASKED_EVERY = 0.05
PREFIX = "assess-model-"
ORDER, ANSWER = "order", "answer"  # names of the files in which a process gets its work and leaves what came out

_Found = TypeVar("_Found")
_Given = ParamSpec("_Given")


def run_apart(
    name: str, progress: Progress, work: Callable[_Given, _Found], *args: _Given.args, **named: _Given.kwargs
) -> _Found:
    """Return what `work`, a function of a module, returns of plain data, called in a process of its own. Raises
    ModelError if the process crashed, or reached a limit; AssessError as `work` raises it.
    """
    with private_folder(PREFIX) as folder:
        order = (work.__module__, work.__qualname__, args, named, SECONDS, MEMORY)
        (folder / ORDER).write_bytes(pickle.dumps(order))
        process = start_module(
            "assess.bim.model_process", folder, output=subprocess.DEVNULL, errors=subprocess.DEVNULL, is_apart=False
        )
        status, end = None, time.monotonic() + PATIENCE * SECONDS
        try:
            while status is None and time.monotonic() <= end:
                progress.check()
                with suppress(subprocess.TimeoutExpired):
                    status = process.wait(_ASKED_EVERY)
        finally:
            process.kill()
            process.communicate()
        answer = folder / ANSWER
        if not answer.exists():
            most = MEMORY // 2**30
            if status in (None, -getattr(signal, "SIGXCPU", 99)):
                raise ModelError(
                    fill("{name} takes more than {n} s of processor time to be read. Export fewer storeys, or "
                         "furniture, spaces, doors and walls only.", name=name, n=SECONDS)
                )  # fmt: skip
            if status == OUT_OF_MEMORY:
                raise ModelError(
                    fill("{name} needs more than {most} GB of memory to be read. Export fewer storeys, or furniture, "
                         "spaces, doors and walls only.", name=name, most=most)
                )  # fmt: skip
            raise ModelError(
                fill("{name} could not be read: the library that reads building models stopped. The file may be "
                     "damaged, or need more than {most} GB of memory. Export it again from the program that made it.",
                     name=name, most=most)
            )  # fmt: skip
        is_error, found = pickle.loads(answer.read_bytes())  # noqa: S301  written by our own process, just now
    if is_error:
        raise cast(AssessError, found)
    return cast(_Found, found)


def main() -> None:
    """Do the work of the folder that is named, in the process of its own."""

    def end_with_parent() -> None:
        sys.stdin.buffer.read()
        os._exit(1)

    folder = Path(sys.argv[1])
    threading.Thread(target=end_with_parent, daemon=True).start()
    module, function, args, named, seconds, memory = pickle.loads((folder / ORDER).read_bytes())  # noqa: S301
    limit_process(memory, seconds)
    try:
        work = getattr(importlib.import_module(module), function)
        answer = (False, work(*args, **named))
    except AssessError as error:
        answer = (True, error)
    except MemoryError:
        os._exit(OUT_OF_MEMORY)
    part = folder / f"{ANSWER}.part"
    part.write_bytes(pickle.dumps(answer))
    part.replace(folder / ANSWER)
    os._exit(0)  # without what libraries do at the end


if __name__ == "__main__":
    main()
