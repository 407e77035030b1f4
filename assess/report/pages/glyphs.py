"""Which characters of the workbook the report's own fonts do not hold, and what becomes of them in the PDF."""

import unicodedata
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from assess import resources
from assess.errors import Problem
from assess.inventory.columns import BUILDING, FLOORS, ITEMS, PLACES_SHEET, ROUTES, Sheet
from assess.inventory.model import Inventory
from assess.language import fill, nfill

MOST_TOLD = 10
"""Fields that are named, one line each."""
MOST_NAMED = 5
"""Characters of a field that are named; the others are counted."""
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


@dataclass(frozen=True, slots=True)
class Missing:
    """A field of the workbook with characters that the fonts lack: the cell of the first, and how many have some."""

    sheet: str
    cell: str
    label: str
    count: int
    characters: str


def list_missing(inventory: Inventory) -> list[Missing]:
    """Return the fields of a workbook of which a report cannot show every character in its own fonts."""
    found = []
    for sheet, name, label, rows in _list_fields(inventory):
        lacking = [(row, lack) for row in rows if (lack := find_missing(_text(row, name)))]
        if lacking:
            characters = "".join(dict.fromkeys("".join(lack for _, lack in lacking)))
            cell = _cell(inventory, sheet, lacking[0][0], name)
            found.append(Missing(sheet.name, cell, label, len(lacking), characters))
    return found


def find_missing(text: str) -> str:
    """Return the characters of a text that the report's fonts do not hold, each once, in their order."""
    if text.isascii():
        return ""
    return "".join(sign for sign in dict.fromkeys(text) if not sign.isascii() and ord(sign) not in _held())


def replace(text: str, signs: Collection[str]) -> str:
    """Return a text with � for characters that no font holds: PDF/A allows no boxes in their place."""
    return text.translate(dict.fromkeys(map(ord, signs), REPLACEMENT)) if signs else text


def describe(missing: Sequence[Missing], nowhere: Collection[str]) -> list[Problem]:
    """Return what to tell of missing characters, of which `nowhere` are in no font of this machine either."""
    told = [problem for one in missing if (problem := _describe(one, nowhere))]
    left = len(told) - MOST_TOLD
    if left <= 0:
        return told
    message = nfill("the same is true of {n} more field.", "the same is true of {n} more fields.", left)
    return [*told[:MOST_TOLD], Problem("warning" if nowhere else "note", "", "", message)]


def _describe(one: Missing, nowhere: Collection[str]) -> Problem | None:
    lost = [sign for sign in one.characters if sign in nowhere]
    lent = [sign for sign in one.characters if not _is_invisible(sign)]
    if lost:
        message = nfill(
            "{label}: no font here holds {characters}; the PDF has � instead.",
            "{label} of {n} rows: no font here holds {characters}; the PDF has � instead.",
            one.count,
            label=fill(one.label),
            characters=_name(lost),
        )
        mend = fill("Install a font that does, such as Noto (Debian: apt install fonts-noto-core fonts-noto-cjk).")
        return Problem("warning", one.sheet, one.cell, message, mend)
    if lent:
        message = nfill(
            "{label}: a font of this machine lends the PDF {characters}; figures may have boxes instead.",
            "{label} of {n} rows: a font of this machine lends the PDF {characters}; figures may have boxes instead.",
            one.count,
            label=fill(one.label),
            characters=_name(lent),
        )
        return Problem("note", one.sheet, one.cell, message)
    return None


def _name(signs: Sequence[str]) -> str:
    """Return characters with their numbers in Unicode, as they may show as boxes here, too."""
    named = ", ".join(f"{sign} (U+{ord(sign):04X})" for sign in signs[:MOST_NAMED])
    left = len(signs) - MOST_NAMED
    return fill("{names} and {more:,} more", names=named, more=left) if left > 0 else named


def _list_fields(inventory: Inventory) -> Iterator[tuple[Sheet, str, str, Sequence[Any]]]:
    """Yield every field that holds text of the user's own and that reports show, with the rows that have it."""
    rows: dict[Sheet, Sequence[Any]] = {
        BUILDING: [inventory.building],
        FLOORS: inventory.floors,
        ITEMS: inventory.items,
        PLACES_SHEET: inventory.places,
        ROUTES: inventory.routes,
    }
    for sheet, own in rows.items():
        for column in sheet.columns:
            if (
                column.kind in ("text", "records") and column.source != FLOORS.name
            ):  # those of Floors are looked at there
                yield sheet, column.name, column.label, own


def _text(row: Any, name: str) -> str:
    """Return a field of a row as reports show it: of a record its name and what its file calls the event."""
    if name.startswith("record_"):
        records = row.records.get(name.removeprefix("record_").upper(), ())
        return " ".join(f"{one.name} {one.record.event}" for one in records)
    return str(getattr(row, name))


def _cell(inventory: Inventory, sheet: Sheet, row: Any, name: str) -> str:
    """Return the cell of a field; the first column where the sheet lacks it."""
    if hasattr(row, "cell"):
        return str(row.cell(name))
    return f"{inventory.letters.get(sheet.name, {}).get(name, 'A')}{row.row}"


@cache
def _held() -> frozenset[int]:
    """Return the code points of the regular font; what another style lacks is taken from it."""
    from matplotlib.ft2font import FT2Font

    path = resources.fonts().get(("Report", "regular"))
    return frozenset(FT2Font(str(path)).get_charmap()) if path else frozenset()


def _is_invisible(sign: str) -> bool:
    """Tell whether nobody would miss a character: a space, a mark of direction, a choice of variant."""
    kind, number = unicodedata.category(sign), ord(sign)
    return kind in ("Cc", "Cf", "Zs", "Zl", "Zp") or 0xFE00 <= number <= 0xFE0F or 0xE0100 <= number <= 0xE01EF
