"""The files of studies, each written whole or not at all, and the results of long work, kept for the next run."""

import hashlib
import io
import tempfile
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assess.delivery.deliver import save
from assess.errors import OutputError
from assess.version import __version__

Arrays = Mapping[str, NDArray[np.generic]]
PARTS = "parts"
"""Folder of kept results, within that of a study's files."""
SOURCES = (
    "motion", "rocking", "compiled.py", "units.py", "methods/simulate.py", "studies/buildings.py",
    "studies/calibration.py",
)  # fmt: skip
"""The code that kept results depend on: if it changes, they are computed again."""
MARK = "made_of"
"""Array within a kept file that identifies what its numbers were computed from."""


def check_folder(folder: Path) -> None:
    """Raise OutputError unless a folder can be written to; it need not exist, and nothing is left behind."""
    try:
        there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
        with tempfile.TemporaryDirectory(prefix=".assess-writing-", dir=there):
            pass
    except OSError as error:
        raise _fault(folder, error) from None


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder, which is made if missing; a name may include a folder within.

    Each file appears whole, and if one cannot be written, none is: see `assess.delivery`.

    Raises OutputError if a file cannot be written.
    """
    taken = next((name for name in files if (folder / name).is_dir()), None)
    if taken is not None:
        raise OutputError(f"{folder / taken} could not be written: it is a folder. Move it away.")
    try:
        save({folder / name: data for name, data in files.items()})
    except OSError as error:
        raise _fault(folder, error) from None


def load_or_compute(folder: Path, inputs: object, compute: Callable[[], Arrays]) -> Arrays:
    """Return the result kept in `folder` for these inputs, or compute it and keep it there.

    The name of its file is a hash of `inputs`, the code in `SOURCES` and the versions of the numerical libraries. Only
    plain arrays are loaded, never pickles: a folder may come from someone else.

    * `folder`: made if missing.
    * `inputs`: everything that the numbers depend on, other than the code; identified by its `repr`.
    * `compute`: called where nothing is kept, or what is kept is damaged.

    Raises OutputError if the result cannot be kept.
    """
    name = hashlib.sha256(repr((inputs, _state())).encode()).hexdigest()[:24]
    file = folder / f"{name}.npz"
    kept = _load(file, name)
    if kept is not None:
        return kept
    found, stream = compute(), io.BytesIO()
    np.savez(stream, **found, **{MARK: np.array(name)})  # type: ignore[arg-type]
    write_files(folder, {file.name: stream.getvalue()})
    return found


def _load(file: Path, name: str) -> Arrays | None:
    """Return the arrays kept in a file; None if it is missing, damaged, or was computed from something else."""
    try:
        with file.open("rb") as stream, np.load(stream) as kept:
            found = {key: kept[key] for key in kept.files}
        return found if str(found.pop(MARK)) == name else None
    except Exception:  # whatever is wrong with it, it is computed again
        return None


def _fault(folder: Path, error: OSError) -> OutputError:
    return OutputError(f"{folder} could not be written: {error.strerror or error}. Make room, or name another folder.")


@cache
def _state() -> tuple[str, ...]:
    root, code = Path(__file__).parents[1], hashlib.sha256()
    for source in SOURCES:
        own = root / source
        for file in sorted(own.rglob("*.py")) if own.is_dir() else [own]:
            code.update(file.read_bytes())
    return __version__, np.__version__, version("scipy"), version("numba"), code.hexdigest()
