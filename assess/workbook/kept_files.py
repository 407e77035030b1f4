"""Files that a workbook names, kept between readings of it, so that an edit does not read them all again.

Each file is known by where it lies, when it was changed and its size. What reading it takes of the `Allowance` is kept
with it, and taken again in every reading, so that the limits of a workbook hold as if it were read anew.
"""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import RLock
from typing import Any, Self

from assess.workbook.allowance import Allowance

Key = tuple[Hashable, ...]


@dataclass(slots=True)
class KeptFiles:
    """What was made of files, by what they were read for and as what they were found.

    Used in a ``with`` statement round each reading of the workbook: what that reading did not ask for is forgotten
    after it, and readings of other threads wait.
    """

    _made: dict[Key, tuple[Any, Allowance]] = field(default_factory=dict)
    _asked: set[Key] = field(default_factory=set)
    _lock: RLock = field(default_factory=RLock)

    def __enter__(self) -> Self:
        self._lock.acquire()
        self._asked.clear()
        return self

    def __exit__(self, *_: object) -> None:
        for key in self._made.keys() - self._asked:
            del self._made[key]
        self._lock.release()

    @contextmanager
    def more(self) -> Iterator[None]:
        """Have readings of other threads wait while one file more is asked for; nothing is forgotten after it."""
        with self._lock:
            yield

    def take(self, key: Key | None, allowance: Allowance, make: Callable[[], Any]) -> Any:
        """Return what `make` makes of a file, or made of it before; its errors are results, not raised.

        `key` is what `find_key` returned, with what the result depends on besides; None for a file that is not kept.

        Raises CellError if a workbook may not name so much.
        """
        if key is None:
            return make()
        self._asked.add(key)
        if key in self._made:
            found, taken = self._made[key]
            allowance.add(taken)
            return found
        before = allowance.copy()
        found = make()
        self._made[key] = found, allowance.less(before)
        return found


def find_key(path: object, *purpose: Hashable) -> Key | None:
    """Return by what a file is known, together with what it is read for; None for one that cannot be seen."""
    if not isinstance(path, Path):
        return None
    try:
        found = path.stat()
    except OSError:
        return None
    return (str(path), found.st_mtime_ns, found.st_size, found.st_ino, *purpose)
