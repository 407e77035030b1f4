"""Files that a workbook names, kept between readings of it, so that an edit does not read them all again.

Each file is known by where it lies, when it was changed and its size. What reading it takes of the `Allowance` is kept
with it, and taken again in every reading, so that the limits of a workbook hold as if it were read anew.
"""

from collections import Counter
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from pathlib import Path
from threading import RLock
from typing import Any, Self

from assess.i18n import Text, fill
from assess.workbook.habits import CellError

MOST_RECORD_BYTES = 256_000_000
"""Bytes of the files of recorded motion that a workbook names; a set of a large building has 30 million."""
MOST_RECORD_SAMPLES = 20_000_000
"""Samples of all their channels."""
MOST_ARCHIVES = 50
MOST_PICTURE_PIXELS = 500_000_000
"""Pixels of the logo and of all plans."""
MOST_DRAWINGS = 50
"""Plans that are drawings: one at all its limits takes about 10 s to read."""
MOST_DRAWING_BYTES = 50_000_000
MOST_PHOTOS = 400
"""Photos of pieces: each takes a tenth of a second to read, and about 40 kB in a report."""
MOST_PHOTO_BYTES = 30_000_000
"""Bytes of all photos as reports hold them."""


class Allowance:
    """What has been taken of it by the files read so far, each file once."""

    def __init__(self) -> None:
        self.taken: Counter[str] = Counter()

    def take(self, **amounts: int) -> None:
        """Count what is read of files, by the names of the limits below; CellError where it is too much."""
        self.taken.update(amounts)
        fewer = fill("Name fewer files, with the channels that are needed, cut to the shaking.")
        drawings = (
            fill("this workbook names more than {most} drawings as plans, or drawings of more than {size:.0f} MB.",
                 most=MOST_DRAWINGS, size=MOST_DRAWING_BYTES / 1e6),
            fill("Save the walls and doors alone, or name fewer."),
        )  # fmt: skip
        photos = (
            fill("this workbook names more than {most} photos, or photos of more than {size:.0f} MB when prepared.",
                 most=MOST_PHOTOS, size=MOST_PHOTO_BYTES / 1e6),
            fill("Name fewer: those of the pieces to fix."),
        )  # fmt: skip
        limits: dict[str, tuple[int, Text, Text]] = {
            "record_bytes": (MOST_RECORD_BYTES, fill("the record files of this workbook have more than {most:.0f} MB.",
                                                     most=MOST_RECORD_BYTES / 1e6), fewer),
            "archives": (MOST_ARCHIVES, fill("this workbook names more than {most} zip archives.", most=MOST_ARCHIVES),
                         fewer),
            "samples": (MOST_RECORD_SAMPLES, fill("the record files of this workbook have more than {most:,} samples.",
                                                  most=MOST_RECORD_SAMPLES), fewer),
            "pixels": (MOST_PICTURE_PIXELS,
                       fill("the pictures of this workbook have more than {most:.0f} million pixels.",
                            most=MOST_PICTURE_PIXELS / 1e6), fill("Save them smaller, or name fewer.")),
            "drawings": (MOST_DRAWINGS, *drawings), "drawing_bytes": (MOST_DRAWING_BYTES, *drawings),
            "photos": (MOST_PHOTOS, *photos), "photo_bytes": (MOST_PHOTO_BYTES, *photos),
        }  # fmt: skip
        for name in amounts:
            most, message, fix = limits[name]
            if self.taken[name] > most:
                raise CellError(message, fix)


Key = tuple[Hashable, ...]


@dataclass(slots=True)
class KeptFiles:
    """What was made of files, by what they were read for and as what they were found.

    Used in a ``with`` statement round each reading of the workbook: what that reading did not ask for is forgotten
    after it, and readings of other threads wait; `lock` alone has them wait while one file more is asked for.
    """

    _made: dict[Key, tuple[Any, Counter[str]]] = field(default_factory=dict)
    _asked: set[Key] = field(default_factory=set)
    lock: RLock = field(default_factory=RLock)

    def __enter__(self) -> Self:
        self.lock.acquire()
        self._asked.clear()
        return self

    def __exit__(self, *_: object) -> None:
        for key in self._made.keys() - self._asked:
            del self._made[key]
        self.lock.release()

    def take(self, key: Key | None, allowance: Allowance, make: Callable[[], Any]) -> Any:
        """Return what `make` makes of a file, known by `find_key`, or made before; CellError if that is too much."""
        if key is None:
            return make()
        self._asked.add(key)
        if key in self._made:
            found, taken = self._made[key]
            allowance.take(**taken)
            return found
        before = Counter(allowance.taken)
        found = make()
        self._made[key] = found, allowance.taken - before
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
