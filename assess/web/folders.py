"""What the folder of a server says of the workbooks that are open, for other servers of the same user."""

import json
import os
from contextlib import suppress
from pathlib import Path

from assess.delivery.private_folder import is_left, is_ours

PREFIX = "assess-open-"
NOTE = "opened.json"
"""In the folder of a session: which workbook it has open, and the process."""


def note_opened(session: Path, workbook: Path) -> None:
    """Write down, for other servers of this user, which workbook a session has open."""
    text = json.dumps({"path": str(workbook.resolve()), "pid": os.getpid()})
    with suppress(OSError):  # it only serves a warning
        (session / NOTE).write_text(text, encoding="utf-8")


def find_other(session: Path, workbook: Path) -> int | None:
    """Return the process of another running server of this user that has a workbook open, None where there is none."""
    for note in session.parent.parent.glob(f"{PREFIX}*/*/{NOTE}"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            folder = note.parent.parent
            if folder == session.parent or folder.is_symlink() or not is_ours(folder):
                continue
            found = json.loads(note.read_text(encoding="utf-8"))
            if Path(found["path"]).samefile(workbook) and not is_left(folder):
                return int(found["pid"])
    return None
