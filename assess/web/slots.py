"""How many of a kind may run at once, in the processes of all sessions: each has the lock on one of so many folders.

The system releases the lock of a process that ends, however it does.
"""

from pathlib import Path

from assess.delivery.folders import FolderLock
from assess.i18n import Text
from assess.web.request_errors import TOO_MANY, RequestError


def take(folder: Path, kind: str, most: int) -> FolderLock | None:
    """Return one of `most` places of a kind in the folder of a server, to be released; None where all are taken."""
    for n in range(most):
        place = folder / f"slot-{kind}-{n}"
        place.mkdir(mode=0o700, exist_ok=True)
        lock = FolderLock(place)
        if lock.take():
            return lock
    return None


class Slots:
    """The places of one kind; `refusal` says why there is none."""

    def __init__(self, folder: Path, kind: str, most: int, refusal: Text) -> None:
        self._place, self._refusal = (folder, kind, most), refusal

    def take(self) -> FolderLock:
        """Return a place, to be released; RequestError where all are taken."""
        found = take(*self._place)
        if found is None:
            raise RequestError(self._refusal, TOO_MANY)
        return found
