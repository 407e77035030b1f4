"""The one way in for files that users name: a regular file, and no more of it than is read.

A pipe would be waited for without end, and a device may never end.
"""

import errno
import io
import stat
from pathlib import Path

from assess.i18n import fill


def open_input(path: Path) -> io.BufferedReader:
    """Open a file to read its bytes; OSError if it cannot be opened, or is a pipe, a device or a socket."""
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise OSError(errno.EINVAL, fill("it is a pipe or a device, not a file"), str(path))
    return path.open("rb")


def read_input(path: Path, most: int) -> bytes:
    """Return the bytes of a file; of one that is larger than `most`, just more, by which its reader knows.

    Raises OSError as `open_input`; ValueError if its name holds a zero character.
    """
    with open_input(path) as file:
        return file.read(most + 1)
