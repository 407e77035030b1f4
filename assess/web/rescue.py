"""Changes that could be saved nowhere when the server ends: they are kept in a new file."""

from collections.abc import Iterator
from contextlib import suppress
from itertools import count, islice
from pathlib import Path

from assess.delivery.deliver import saving
from assess.errors import AssessError
from assess.web.sessions import Session

MOST_NAMES = 1000


def keep_changes(session: Session) -> Path | None:
    """Write the workbook of a session, with its changes, under a new name: next to its file, else where one may.

    Returns
    -------
    Path or None
        The new file; None where none can be written.
    """
    book = session.book
    if book is None:
        return None
    folders = [book.path.parent] if book.path else []
    folders += [session.home] if session.home else []
    with suppress(AssessError):
        data = book.write()
        for folder in (*folders, Path.home()):
            with suppress(OSError):
                return _write(data, folder, book.name)
    return None


def _write(data: bytes, folder: Path, name: str) -> Path:
    path = next(one for one in _list_names(folder, name) if not one.exists())
    with saving(path) as part:
        part.write_bytes(data)
    return path


def _list_names(folder: Path, name: str) -> Iterator[Path]:
    stem, suffix = Path(name).stem, Path(name).suffix
    yield folder / f"{stem}-changes{suffix}"
    yield from (folder / f"{stem}-changes-{number}{suffix}" for number in islice(count(2), MOST_NAMES))
