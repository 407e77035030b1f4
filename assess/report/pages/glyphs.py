"""Which characters of the workbook the report's own fonts do not hold, and how the PDF shows them."""

import unicodedata
from collections.abc import Collection, Sequence
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
_BLANKS = ("Cc", "Cf", "Zs", "Zl", "Zp")
_VARIANTS = frozenset(map(chr, (*range(0xFE00, 0xFE10), *range(0xE0100, 0xE01F0))))
"""Categories and characters that nobody would miss: spaces, marks of direction, choices of variant."""
_OF_SEGMENTS = {"start": "from_place", "end": "to_place"}
"""Fields of the sheet Routes that `SegmentRow` calls otherwise."""


@dataclass(frozen=True, slots=True)
class Missing:
    """A field of the workbook with characters that the fonts lack: the cell of the first, and how many have some."""

    sheet: str
    cell: str
    label: str
    count: int
    characters: str


def list_missing(results: Results) -> list[Missing]:
    """Return the fields with text of the user's own of which the report's own fonts lack characters."""
    rows: dict[Sheet, Sequence[Any]] = {
        BUILDING: [results.building],
        FLOORS: results.floor_rows,
        ITEMS: results.item_rows,
        PLACES_SHEET: results.places,
        ROUTES: results.route_tables.segments,
    }
    found = []
    for sheet, column in [(one, column) for one in rows for column in one.columns]:
        if column.kind not in ("text", "records") or column.source == FLOORS.name:  # those are checked in Floors
            continue
        name, lacking = column.name, []
        for row in rows[sheet]:
            if name.startswith("record_"):  # shown is what its file calls the event, too
                own = results.motions_of(row.floor, name.removeprefix("record_").upper())
                text = " ".join(f"{one.record} {one.event}" for one in own)
            else:
                key = _OF_SEGMENTS.get(name, name) if isinstance(row, SegmentRow) else name
                text = str((row.field(key) if isinstance(row, ItemRow) else getattr(row, key)) or "")
            if lack := find_missing(text):
                lacking.append((row, lack))
        if lacking:
            row = lacking[0][0]
            if hasattr(row, "cell"):
                cell = str(row.cell(name))
            else:  # of a sheet that lacks the field, the first column
                number = row.workbook_row if isinstance(row, SegmentRow) else row.row
                cell = f"{results.provenance.letters.get(sheet.name, {}).get(name, 'A')}{number}"
            characters = "".join(dict.fromkeys("".join(lack for _, lack in lacking)))
            found.append(Missing(sheet.name, cell, column.label, len(lacking), characters))
    return found


def describe(missing: Sequence[Missing], nowhere: Collection[str]) -> list[Problem]:
    """Return problems about missing characters, of which `nowhere` are in no font of this machine either."""
    listed = []
    for one in missing:
        lost = [sign for sign in one.characters if sign in nowhere]
        seen = [sign for sign in one.characters if unicodedata.category(sign) not in _BLANKS]
        borrowed = [sign for sign in seen if sign not in _VARIANTS]
        signs = lost or borrowed
        named = ", ".join(f"{sign} (U+{ord(sign):04X})" for sign in signs[:MOST_NAMED])  # they may show as boxes here
        more = len(signs) - MOST_NAMED
        values = {
            "label": fill(one.label),
            "characters": fill("{names} and {more:,} more", names=named, more=more) if more > 0 else named,
        }
        if lost:
            message = nfill(
                "{label}: no font here holds {characters}; the PDF has � instead.",
                "{label} of {n} rows: no font here holds {characters}; the PDF has � instead.",
                one.count, **values,
            )  # fmt: skip
            fix = fill("Install a font that does, such as Noto (Debian: apt install fonts-noto-core fonts-noto-cjk).")
            listed.append(Problem("warning", one.sheet, one.cell, message, fix))
        elif borrowed:
            message = nfill(
                "{label}: a font of this machine lends the PDF {characters}; figures may have boxes instead.",
                "{label} of {n} rows: a font of this machine lends the PDF {characters}; figures may have boxes "
                "instead.",
                one.count, **values,
            )  # fmt: skip
            listed.append(Problem("note", one.sheet, one.cell, message))
    left = len(listed) - MOST_LISTED
    if left <= 0:
        return listed
    message = nfill("the same is true of {n} more field.", "the same is true of {n} more fields.", left)
    return [*listed[:MOST_LISTED], Problem("warning" if nowhere else "note", "", "", message)]
