"""The process that `assess.bim.model_process` starts: ``python -m assess.bim.model_worker FOLDER``.

It sets its own limits, does the work that FOLDER/order names, and leaves FOLDER/answer. Its input is closed when the
process that started it has ended; then it ends, too.
"""

import importlib
import os
import pickle
import sys
import threading
from pathlib import Path

from assess.bim.model_process import ANSWER, ORDER, OUT_OF_MEMORY
from assess.errors import AssessError


def main() -> None:
    """Do the work of the folder that is named."""
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
