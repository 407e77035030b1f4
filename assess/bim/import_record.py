"""What an import took and left out, in lines: for the terminal, and as a file beside the workbook, which stays."""

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path, PurePath

from assess.bim.import_workbook import MOST_NAMED, ImportedBuilding, group_skipped, say_skipped
from assess.i18n import count
from assess.input_file import open_input
from assess.plain_text import plain_text
from assess.version import __version__

ENDING = "-import.txt"
"""How the name of the file ends; it begins with that of the model."""


def describe(found: ImportedBuilding) -> Iterator[str]:
    """Yield what was taken, what was left out by reason and type, and what has to be checked, in English."""
    kinds, floors = ({row.get(name) for row in found.items} for name in ("type", "floor"))
    where = f"of {count(len(kinds), 'type')} on {count(len(floors or found.floors), 'floor')}"
    left = sum(one.count for one in found.skipped if one.is_furniture)
    pieces = count(len(found.items) + left, "piece")
    yield f"{found.source}: {f'{len(found.items):,} of ' if left else ''}{pieces} {where} taken."
    if not found.items:
        yield "No furniture was found: fill in Items by hand."
    yield from (say_skipped(group, MOST_NAMED) for _, group in group_skipped(found.skipped))
    yield from (f"Check: {text}" for text in (*found.warnings, *found.remarks))


def keep_record(found: ImportedBuilding, path: Path) -> ImportedBuilding:
    """Return an import with its record among its files: those lines, the hash of the model and the version.

    Raises OSError if the file cannot be read again.
    """
    with open_input(path) as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    lines = (f"Imported by assess {__version__} from {found.source}, SHA-256 {digest}", "", *describe(found))
    text = "\n".join(map(plain_text, lines)) + "\n"
    return replace(found, files={**found.files, PurePath(found.source).stem + ENDING: text.encode()})
