"""What takes long, kept in a file of its own as soon as it is done, and taken up by the next run."""

import hashlib
import os
import uuid
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from assess.errors import OutputError
from assess.version import __version__

Arrays = Mapping[str, NDArray[np.generic]]
PARTS = "parts"
"""Folder of what is kept, within that of a study's files."""
SOURCES = ("motion", "rocking", "compiled.py", "units.py", "studies/_trials.py")
"""Code on which what is kept depends: of another state of it nothing is taken up."""
MARK = "made_of"
"""Array within a file that says what its numbers are of."""


def take_up(folder: Path, told: object, make: Callable[[], Arrays]) -> Arrays:
    """Return what was kept in `folder` under what is `told` of it, or make it and keep it there.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    told : object
        Everything that the numbers depend on, beside the code; its `repr` tells it.
    make : callable
        Makes them.

    Raises
    ------
    OutputError
        If it cannot be kept.
    """
    name = _name(told)
    file = folder / f"{name}.npz"
    kept = _read(file, name)
    if kept is not None:
        return kept
    found = make()
    try:
        _keep(file, {**found, MARK: np.array(name)})
    except OSError as error:
        raise OutputError(
            f"{folder} could not be written: {error.strerror or error}. Make room, or name another folder with --out."
        ) from None
    return found


def _read(file: Path, name: str) -> Arrays | None:
    """Return what is kept in a file; None if it is not there, cut off, no such file at all, or of something else."""
    try:
        with file.open("rb") as stream, np.load(stream) as kept:
            found = {key: kept[key] for key in kept.files}
        return found if str(found.pop(MARK)) == name else None
    except Exception:  # whatever is wrong with it, it is made again
        return None


def _keep(file: Path, arrays: Arrays) -> None:
    """Write arrays; the file appears whole or not at all, whoever else writes it."""
    part = file.with_name(f"{file.stem}-{uuid.uuid4().hex}.part")
    try:
        write_through(part, lambda stream: np.savez(stream, **dict(arrays)))  # type: ignore[arg-type]
        part.replace(file)
    finally:
        part.unlink(missing_ok=True)


def write_through(file: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file, whose folder is made, down to the disk, where a full disk shows."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("wb") as stream:
        write(stream)
        stream.flush()
        os.fsync(stream.fileno())


def _name(told: object) -> str:
    """Return a name that nothing else has: by what is told, the version, the code and the libraries that count."""
    return hashlib.sha256(repr((told, _state())).encode()).hexdigest()[:24]


@cache
def _state() -> tuple[str, ...]:
    import numba
    import scipy

    root, code = Path(__file__).parents[1], hashlib.sha256()
    for source in SOURCES:
        own = root / source
        for file in sorted(own.rglob("*.py")) if own.is_dir() else [own]:
            code.update(file.read_bytes())
    return __version__, np.__version__, scipy.__version__, numba.__version__, code.hexdigest()
