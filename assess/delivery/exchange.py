"""Two folders of one file system exchanged by one call of the system.

Linux: renameat2 with RENAME_EXCHANGE (man 2 rename; since 3.15). macOS: renamex_np with RENAME_SWAP (man 2 renamex_np;
since 10.12, on APFS). Windows has no such call.
"""

import os
import sys
from pathlib import Path

_AT_FDCWD, _RENAME_EXCHANGE, _RENAME_SWAP = -100, 2, 2


def can_exchange() -> bool:
    """Whether this system has such a call; a file system may refuse it."""
    return sys.platform in ("linux", "darwin")


def exchange(one: Path, other: Path) -> bool:
    """Exchange two folders; False if the system or the file system cannot, and then nothing has changed."""
    if not can_exchange():
        return False
    import ctypes

    try:
        library = ctypes.CDLL(None, use_errno=True)
        first, second = os.fsencode(one), os.fsencode(other)
        if sys.platform == "darwin":
            return int(library.renamex_np(first, second, _RENAME_SWAP)) == 0
        return int(library.renameat2(_AT_FDCWD, first, _AT_FDCWD, second, _RENAME_EXCHANGE)) == 0
    except (AttributeError, OSError):  # a C library that is older than the call
        return False
