"""Which characters of the workbook the report's own fonts do not hold, and how the PDF shows them."""

import unicodedata
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from assess.errors import Problem
from assess.i18n import fill, nfill
from assess.report.fonts import find_missing
from assess.results import ItemRow, Results
from assess.route_results import SegmentRow
from assess.workbook.schema import BUILDING, FLOORS, ITEMS, PLACES_SHEET, ROUTES, Sheet

MOST_LISTED = 10
"""Fields that are named, one line each."""
MOST_NAMED = 5
"""Characters of a field that are named; the others are counted."""


@dataclass(frozen=True, slots=True)
class Missing:
    """A field of the workbook with characters that the fonts lack: the cell of the first, and how many have some."""

    sheet: str
    cell: str
    label: str
    count: int
    characters: str


def list_missing(results: Results) -> list[Missing]:
    """Return the fields of a workbook of which a report cannot show every character in its own fonts."""
    found = []
    for sheet, name, label, rows in _list_fields(results):
        lacking = [(row, lack) for row in rows if (lack := find_missing(_text(results, row, name)))]
        if lacking:
            characters = "".join(dict.fromkeys("".join(lack for _, lack in lacking)))
            cell = _cell(results, sheet, lacking[0][0], name)
            found.append(Missing(sheet.name, cell, label, len(lacking), characters))
    return found


def describe(missing: Sequence[Missing], nowhere: Collection[str]) -> list[Problem]:
    """Return problems about missing characters, of which `nowhere` are in no font of this machine either."""
    listed = [problem for one in missing if (problem := _describe(one, nowhere))]
    left = len(listed) - MOST_LISTED
    if left <= 0:
        return listed
    message = nfill("the same is true of {n} more field.", "the same is true of {n} more fields.", left)
    return [*listed[:MOST_LISTED], Problem("warning" if nowhere else "note", "", "", message)]


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
        fix = fill("Install a font that does, such as Noto (Debian: apt install fonts-noto-core fonts-noto-cjk).")
        return Problem("warning", one.sheet, one.cell, message, fix)
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


def _list_fields(results: Results) -> Iterator[tuple[Sheet, str, str, Sequence[Any]]]:
    """Yield every field that holds text of the user's own and that reports show, with the rows that have it."""
    rows: dict[Sheet, Sequence[Any]] = {
        BUILDING: [results.building],
        FLOORS: results.floor_rows,
        ITEMS: results.item_rows,
        PLACES_SHEET: results.places,
        ROUTES: results.route_tables.segments,
    }
    for sheet, own in rows.items():
        for column in sheet.columns:
            if column.kind in ("text", "records") and column.source != FLOORS.name:  # those are checked in Floors
                yield sheet, column.name, column.label, own


_OF_SEGMENTS = {"start": "from_place", "end": "to_place"}
"""Fields of the sheet Routes that `SegmentRow` calls otherwise."""


def _text(results: Results, row: Any, name: str) -> str:
    """Return a field of a row as reports show it: of a record its name and what its file calls the event."""
    if name.startswith("record_"):
        axis = name.removeprefix("record_").upper()
        return " ".join(f"{one.record} {one.event}" for one in results.motions_of(row.floor, axis))
    if isinstance(row, SegmentRow):
        name = _OF_SEGMENTS.get(name, name)
    return str((row.field(name) if isinstance(row, ItemRow) else getattr(row, name)) or "")


def _cell(results: Results, sheet: Sheet, row: Any, name: str) -> str:
    """Return the cell of a field; the first column where the sheet lacks it."""
    if hasattr(row, "cell"):
        return str(row.cell(name))
    number = row.workbook_row if isinstance(row, SegmentRow) else row.row
    return f"{results.provenance.letters.get(sheet.name, {}).get(name, 'A')}{number}"


def _is_invisible(sign: str) -> bool:
    """Tell whether nobody would miss a character: a space, a mark of direction, a choice of variant."""
    kind, number = unicodedata.category(sign), ord(sign)
    return kind in ("Cc", "Cf", "Zs", "Zl", "Zp") or 0xFE00 <= number <= 0xFE0F or 0xE0100 <= number <= 0xE01EF
