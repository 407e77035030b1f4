"""A COBie handover file as an inventory: moveable types with sizes become pieces, each component a row.

Reference: COBie 2.4 (National BIM Standard - United States, Version 3, section 4.2). Used are Facility (Name,
LinearUnits, Category, SiteName), Floor (Name, Category, Elevation, Height), Space (Name, FloorName), Type (Name,
AssetType, NominalLength, NominalWidth, NominalHeight) and Component (Name, TypeName, Space, ExtIdentifier).

Breadth is the shorter of NominalLength and NominalWidth. These are sizes of the product as its maker states them, not
measured between the supports. A size of 0 counts as not given. COBie tells neither positions, which stand in its sheet
Coordinate if anywhere, nor fixings: Anchored stays blank and counts as free-standing.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from assess.bim.cobie_floors import CobieFloor, list_rows, read_floors
from assess.bim.cobie_sheets import CobieSheet, is_cobie, read_sheets, say
from assess.bim.cobie_types import CobieType, check_unit, find_unit, read_types
from assess.bim.import_workbook import ImportedBuilding, Skipped, build_workbook, name_apart
from assess.i18n import Text, fill, nfill
from assess.progress import SILENT, Progress
from assess.workbook.names import key

__all__ = ["convert", "is_cobie", "read_cobie"]

THIN, SLENDER = 0.10, 0.10
"""A piece thinner than this [m], or with less breadth to height [-], probably hangs on a wall or a window."""
MOST_NAMED = 10
_CODE = re.compile(r"^[\w .-]*\d[\w .-]*\s*:\s*")
"""The number of a classification before the words of a category: ``11-16 27 00: Dormitory``."""


def convert(data: bytes, name: str = "COBie.xlsx") -> bytes:
    """Return the inventory workbook of a COBie file; raises WorkbookError as `read_cobie`."""
    return build_workbook(read_cobie(data, name))


def read_cobie(source: Path | bytes, name: str, progress: Progress = SILENT) -> ImportedBuilding:
    """Read the furniture of a COBie file.

    `name`: how messages and the Catalogue call it.
    Raises WorkbookError if it is no COBie file, is damaged or larger than the limits, lacks a sheet or a column, names
    no unit of length, or one in which no size of its furniture can be.

    Returns pieces, floors and types, with what was left out and why.
    """
    sheets = read_sheets(source, name, progress)
    unit = find_unit(sheets["Facility"])
    check_unit(sheets["Facility"], sheets["Type"], unit)
    floors, faults = read_floors(sheets["Floor"], unit)
    found = _Sorted(types=read_types(sheets["Type"], unit), floors=floors, spaces=_read_spaces(sheets["Space"], floors))
    for _, row in sheets["Component"].rows:
        found.take(row)
    used = {piece.floor.name for piece in found.pieces}
    rows, building, doubts = list_rows(floors, used)
    kinds = dict.fromkeys(piece.type for piece in found.pieces)
    origin = fill("COBie file {name}, sheet Type: nominal sizes", name=name)
    return ImportedBuilding(
        source=name,
        building=_describe_building(sheets["Facility"]) | building,
        floors=rows,
        items=list(_list_items(found.pieces)),
        types=[{"type": kind.name, **kind.sizes_cm(), "source": origin} for kind in kinds],
        skipped=tuple(found.list_skipped()),
        warnings=(*faults, *doubts),
        remarks=(*_note_facilities(sheets["Facility"]), *_note_pieces(found)),
    )


@dataclass(frozen=True, slots=True)
class _Piece:
    name: str
    type: CobieType
    floor: CobieFloor
    room: str
    source_id: str


@dataclass(slots=True)
class _Sorted:
    """Components sorted into pieces and what is left out."""

    types: Mapping[str, CobieType]
    floors: Mapping[str, CobieFloor]
    spaces: Mapping[str, tuple[str, CobieFloor | None]]
    pieces: list[_Piece] = field(default_factory=list)
    skipped: Counter[tuple[str, Text, bool]] = field(default_factory=Counter)
    with_several_spaces: int = 0

    def take(self, row: Mapping[str, Any]) -> None:
        """Sort one component in."""
        named = say(row.get("TypeName"))
        kind = self.types.get(key(named))
        if kind is None:
            self._skip(named or "-", fill("TypeName is blank") if not named else fill("not in the sheet Type"))
        elif kind.reason is not None:
            self._skip(kind.name, kind.reason, is_furniture=kind.is_furniture)
        else:
            self._place(row, kind)

    def _place(self, row: Mapping[str, Any], kind: CobieType) -> None:
        named = say(row.get("Space"))
        room, floor = self._find_space(named)
        if floor is None:
            reason = fill("Space is blank, so that the floor is not known")
            if named:
                reason = fill("its Space is not in the sheet Space, or that has no floor of the sheet Floor")
            self._skip(kind.name, reason)
            return
        own = say(row.get("ExtIdentifier")) or say(row.get("ExternalIdentifier"))
        name = say(row.get("Name")) or own or kind.name
        self.pieces.append(_Piece(name, kind, floor, room, own or name))

    def _find_space(self, named: str) -> tuple[str, CobieFloor | None]:
        if key(named) in self.spaces:
            return self.spaces[key(named)]
        for part in named.split(","):
            room, floor = self.spaces.get(key(part.strip()), ("", None))
            if floor is not None:
                self.with_several_spaces += 1
                return room, floor
        return "", None

    def _skip(self, kind: str, reason: Text, *, is_furniture: bool = True) -> None:
        self.skipped[kind, reason, is_furniture] += 1

    def list_skipped(self) -> Iterator[Skipped]:
        """Yield what was left out, by type and reason."""
        for (kind, reason, is_furniture), number in self.skipped.items():
            yield Skipped(kind, number, reason, is_furniture)


def _read_spaces(sheet: CobieSheet, floors: Mapping[str, CobieFloor]) -> dict[str, tuple[str, CobieFloor | None]]:
    """Return name and floor of each space, by its name as names are compared; of two alike the first."""
    found: dict[str, tuple[str, CobieFloor | None]] = {}
    for _, row in sheet.rows:
        name = say(row.get("Name"))
        if name:
            found.setdefault(key(name), (name, floors.get(key(say(row.get("FloorName"))))))
    return found


def _describe_building(sheet: CobieSheet) -> dict[str, Any]:
    row = sheet.rows[0][1] if sheet.rows else {}
    use = _CODE.sub("", say(row.get("Category")))
    texts = {"building": say(row.get("Name")), "address": say(row.get("SiteName")), "use": use}
    return {name: text for name, text in texts.items() if text}


def _list_items(pieces: Sequence[_Piece]) -> Iterator[dict[str, Any]]:
    for name, piece in zip(name_apart(one.name for one in pieces), pieces, strict=True):
        yield {
            "item": name,
            "floor": piece.floor.name,
            "room": piece.room,
            "description": piece.type.name,
            "type": piece.type.name,
            **piece.type.sizes_cm(),
            "source_id": piece.source_id,
        }


def _note_facilities(sheet: CobieSheet) -> Iterator[Text]:
    if len(sheet.rows) > 1:
        yield fill("The sheet Facility has {n} rows; the first was taken.", n=len(sheet.rows))


def _note_pieces(found: _Sorted) -> Iterator[Text]:
    if found.with_several_spaces:
        yield nfill(
            "{n} piece names several spaces; the first that is known was taken.",
            "{n:,} pieces name several spaces; the first that is known was taken.",
            found.with_several_spaces,
        )
    kinds = [one.type for one in found.pieces]
    thin = list(dict.fromkeys(one.name for one in kinds if one.breadth < THIN or one.breadth < SLENDER * one.height))
    if thin:
        more = fill(" and {n} more", n=len(thin) - MOST_NAMED) if len(thin) > MOST_NAMED else ""
        yield fill(
            "Thinner than 10 cm or than a tenth of their height: {types}{more}. Delete the rows of pieces that hang on "
            "a wall or a window: they do not stand on the floor.",
            types=", ".join(thin[:MOST_NAMED]), more=more,
        )  # fmt: skip
    if found.pieces:
        yield fill(
            "COBie files do not record fixings or positions: fill in Anchored where you have seen the fixing; blank "
            "counts as free-standing. Pieces without a position are not checked against evacuation routes."
        )
