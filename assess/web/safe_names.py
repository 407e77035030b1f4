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
    shown = _take_last(name)
    stem, ending = (shown[:-5], shown[-5:]) if shown.lower().endswith(ENDINGS) else (shown, ENDINGS[0])
    stem = stem.strip(". ")[: LONGEST - len(ending)]
    return f"{stem}{ending}" if stem and not _RESERVED.match(stem) else f"workbook{ending}"


def clean_name(name: str) -> str:
    """Return the name of a file without folders, and without signs that file systems refuse, cut to `LONGEST`."""
    shown = _take_last(name)
    stem, dot, ending = shown.rpartition(".")
    return f"{stem[: LONGEST - len(ending) - 1]}{dot}{ending}" if stem and len(ending) < LONGEST else shown[:LONGEST]


def _take_last(name: str) -> str:
    last = PureWindowsPath(PurePosixPath(name).name).name
    return "".join(one for one in last if one not in _FORBIDDEN and unicodedata.category(one)[0] != "C").rstrip(". ")


def check_name(name: object) -> str:
    """Return the name of a new workbook.

    Raises RequestError if it is no name of an .xlsx file alone, such as one with a folder.
    """
    text = name.strip() if isinstance(name, str) else ""
    if text and not text.lower().endswith(ENDINGS[0]):
        text = f"{text}{ENDINGS[0]}"
    if fix := _find_fault(text):
        raise RequestError(fill("{name} cannot be the name of a workbook.", name=repr(text[:LONGEST])), UNUSABLE, fix)
    return text


def _find_fault(text: str) -> str:
    stem = text[: -len(ENDINGS[0])]
    if not stem.strip(". "):
        return fill("Choose a name, such as office.xlsx.")
    if signs := " ".join(dict.fromkeys(one for one in text if one in _FORBIDDEN)):
        return fill("A name cannot have {signs}: leave it out.", signs=signs)
    if any(unicodedata.category(one)[0] == "C" for one in text):
        return fill("It has signs that cannot be seen: type it again.")
    if len(text) > LONGEST:
        return fill("A name has at most {most} signs: shorten it.", most=LONGEST)
    if stem.endswith((".", " ")) or text.startswith((".", "-", "~")):
        return fill("A name cannot begin with . - or ~, and cannot end with a point or a space.")
    if make_safe(text) != text:
        return fill("Windows keeps that name for itself: choose another, such as office.xlsx.")
    return ""
