"""Models read in the process of the tests, each once: for tests that are not about the process of its own."""

import hashlib
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from assess.bim import export_files, read_source
from assess.progress import Progress

_READ: dict[bytes, bytes] = {}


def _run_here(_name: str, progress: Progress, work: Callable[..., Any], *args: Any) -> Any:
    progress.check()
    contents = [one.read_bytes() for one in args if isinstance(one, Path)]
    key = hashlib.sha256(pickle.dumps((work, args, contents))).digest()
    if key not in _READ:
        _READ[key] = pickle.dumps(work(*args))
    return pickle.loads(_READ[key])


@contextmanager
def models_read_here() -> Iterator[None]:
    """Take the process of its own away from importing and exporting."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (read_source, export_files):
            patch.setattr(module, "run_apart", _run_here)
        yield
