"""Names of files that came from elsewhere, as they can stand in any folder."""

import re
import unicodedata
from pathlib import PurePosixPath, PureWindowsPath

from assess.i18n import fill
from assess.web.request_errors import UNUSABLE, RequestError

LONGEST = 120
ENDINGS = (".xlsx", ".xlsm")
_RESERVED = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)", re.IGNORECASE)
_FORBIDDEN = frozenset('<>:"/\\|?*')


def make_safe(name: str) -> str:
    """Return the name of a workbook without folders, and without signs that file systems refuse."""
    last = PureWindowsPath(PurePosixPath(name).name).name
    shown = "".join(one for one in last if one not in _FORBIDDEN and unicodedata.category(one)[0] != "C").rstrip(". ")
    stem, ending = (shown[:-5], shown[-5:]) if shown.lower().endswith(ENDINGS) else (shown, ENDINGS[0])
    stem = stem.strip(". ")[: LONGEST - len(ending)]
    return f"{stem}{ending}" if stem and not _RESERVED.match(stem) else f"workbook{ending}"


def check_name(name: object) -> str:
    """Return the name of a new workbook.

    Raises
    ------
    RequestError
        If it is no name of an .xlsx file alone, such as one with a folder.
    """
    text = name.strip() if isinstance(name, str) else ""
    if text and not text.lower().endswith(ENDINGS[0]):
        text = f"{text}{ENDINGS[0]}"
    if not text or make_safe(text) != text or len(text) > LONGEST or text.startswith((".", "-", "~")):
        fix = fill("Choose a name of letters and digits, such as office.xlsx.")
        raise RequestError(fill("{name} cannot be the name of a workbook.", name=repr(text[:LONGEST])), UNUSABLE, fix)
    return text
