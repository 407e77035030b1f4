"""The inventory of one building of a portfolio: surveyed (its workbook), handed over (COBie), or assumed.

What is assumed, was left out of a handover file, or is not as the index says, is among the problems of the inventory.

Assumed are bookcases and lateral files by use and gross floor area. Reference: FEMA P-58-1, Seismic Performance
Assessment of Buildings, second edition (2018), normative quantities of components by occupancy: pieces a gross square
foot, of which 10 %, 50 % and 90 % of buildings have no more (``p58_quantities.csv``: bookcases of 6 to 7 shelves, 3 ft
wide; lateral filing cabinets of 4 drawers). Sizes are those of its fragility database (E.20.22.106a: 12.625 x 81.25 in;
E.20.22.124a: 18.6 x 52.5 in), as in the Catalogue. P-58 gives quantities of such pieces for offices, healthcare and
laboratories only: any other use is refused.

A building has other furniture as well, of which nothing is assumed: the number of falls is not that of the building.
The quantities of 10 % and 90 % are each assumed of all pieces at once.

Departures: whole pieces, rounded for the building as a whole, at least one of a kind of which the 90 % quantity is at
least one; spread evenly over the storeys, what is left over on the upper ones, which shake more. Storeys are of equal
height. A blank height counts as `STOREY_HEIGHT` a storey, which is assumed.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from csv import DictReader
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from io import StringIO
from typing import Any, NamedTuple

from assess.errors import InputError, Problem, WorkbookError
from assess.i18n import LANGUAGES, count, fill, join, load_catalogue
from assess.model import Inventory
from assess.motion.site_ground import GroundField
from assess.portfolio.building_rows import Origin, spell_use
from assess.portfolio.sources import IndexRow, Source
from assess.units import LENGTH
from assess.workbook.catalogue import catalogue_rows
from assess.workbook.names import key
from assess.workbook.read import Rows, is_cobie, read_inventory
from assess.workbook.schema import BUILDING, ITEMS

APART = 0.01  # degrees, some 1 km, by which a place of the index may differ from that of the workbook


def read_building(source: Source, data: bytes | None, ground: GroundField | None) -> tuple[Origin, Inventory]:
    """Return where the pieces of a building come from, and its inventory; `data` is its file, where it can be read.

    Raises WorkbookError if its file cannot be used; InputError if no inventory can be assumed, or its place lies
    outside the ground motion of the run.
    """
    if source.kind == "assumed" and source.index is not None:
        origin, rows, problems = build_assumed(source.index)
        return origin, _read_rows(rows, problems, {}, ground)
    if source.file is None:
        raise WorkbookError([Problem("error", "", "", fill("it has no workbook."))])
    row = source.index or IndexRow()
    if data is None or not is_cobie(data):
        inventory = read_inventory(source.file, building=row.as_building(), ground=ground)
        return Origin(inventory="surveyed"), _compare(inventory, row, is_survey=True)
    from assess.bim.cobie import read_cobie
    from assess.bim.import_workbook import list_remarks, list_rows

    imported = read_cobie(data, source.file.name)
    left_out = sum(one.count for one in imported.skipped if one.is_furniture)
    if row.building:  # what a building model calls itself is no name that people gave it
        imported = replace(imported, building={**imported.building, "building": row.building})
    remarks = list_remarks(imported)
    if not imported.items:
        fault = fill("no furniture with sizes is found in the COBie file.")
        fix = fill("Fill in NominalLength, NominalWidth and NominalHeight of its Moveable types.")
        raise WorkbookError([Problem("error", "", "", fault, fix), *remarks])
    inventory = replace(_read_rows(list_rows(imported), remarks, row.as_building(), ground), source=source.file)
    return Origin(inventory="handover", left_out=left_out), _compare(inventory, row, is_survey=False)


def _read_rows(
    rows: Rows, problems: tuple[Problem, ...], filled: dict[str, Any], ground: GroundField | None
) -> Inventory:
    inventory = read_inventory(rows, building=filled, ground=ground)
    return replace(inventory, problems=(*problems, *inventory.problems))


def _compare(inventory: Inventory, row: IndexRow, *, is_survey: bool) -> Inventory:
    found = []
    for name, value in row.as_building().items():
        own = getattr(inventory.building, name)
        if own not in (None, "") and name in _ALIKE and not _ALIKE[name](value, own):
            found.append((BUILDING.column(name).label, _show(value), _show(own)))
    if not found:
        return inventory
    index = join(", ", [join(" ", (fill(label), value)) for label, value, _ in found])
    own = join(", ", [value for _, _, value in found])
    if is_survey:
        fault = fill("the index says {index}; the workbook says {own}: the workbook holds.", index=index, own=own)
        fix = fill("Check that the line of the index belongs to this workbook.")
    else:
        fault = fill("the index says {index}; the COBie file says {own}: the COBie file holds.", index=index, own=own)
        fix = fill("Check that the line of the index belongs to this COBie file.")
    warning = Problem("warning", inventory.sheets.get(BUILDING.name, BUILDING.name), "", fault, fix)
    return replace(inventory, problems=(warning, *inventory.problems))


def _show(value: str | float) -> str:
    return value if isinstance(value, str) else fill("{value:.7g}", value=value)


def _is_near(one: float, other: float) -> bool:
    """Tell whether two latitudes or longitudes are of one place, as far as registers give it."""
    return abs((one - other + 180) % 360 - 180) <= APART


_ALIKE: Mapping[str, Callable[[Any, Any], bool]] = {
    "building": lambda one, other: key(one) == key(other),
    "latitude": _is_near,
    "longitude": _is_near,
    "use": lambda one, other: key(spell_use(one)) == key(spell_use(other)),
    "storeys": lambda one, other: bool(one == other),
    "height": lambda one, other: math.isclose(one, other, rel_tol=0.01),
}
"""Whether the index and the workbook mean the same, by field of Building."""


# ---------------------------------------------------------------- assumed inventories


SQUARE_FOOT = LENGTH["ft"] ** 2  # [m2]
STOREY_HEIGHT = 4.0  # of a building whose height is not known [m]: assumed, on the high side for offices
BOOKCASE_WIDTH = 91.4  # 3 ft [cm], as the component of P-58 is named
USES: Mapping[str, tuple[str, ...]] = {
    "office": ("office", "offices", "commercial office", "ufficio"),
    "healthcare": ("healthcare", "health care", "hospital", "hospitals", "clinic", "medical"),
    "laboratory": ("laboratory", "laboratories", "research laboratory"),
}
"""How an index names the occupancies of P-58; names of the sheet Building in other languages count as well."""


class Quantity(NamedTuple):
    """Whole pieces: 10 %, 50 % and 90 % quantity."""

    low: int
    median: int
    high: int


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of piece: its quantities a square foot (10 %, 50 %, 90 %), its Type, and sizes [cm] with their source."""

    piece: str
    type: str
    rates: tuple[float, float, float]
    sizes: Mapping[str, float | None]
    source: str


def build_assumed(row: IndexRow) -> tuple[Origin, Mapping[str, Sequence[Mapping[str, Any]]], tuple[Problem, ...]]:
    """Return the furniture that is assumed of a building of an index, by its use, storeys and floor area.

    Returns its 10 % and 90 % quantities by item, its rows by sheet with the 50 % quantity, and remarks on both. Raises
    InputError if one of the three is blank or cannot be used.
    """
    if not row.use.strip():
        fault = "no inventory can be assumed without use. Give it in the index, or survey the building."
        raise InputError.about(fault)
    if (use := _name_uses().get(key(row.use))) is None:
        fault = (
            "no inventory can be assumed for the use {use}: FEMA P-58 gives quantities of furniture for office, "
            "healthcare and laboratory only. Survey the building, and name its workbook in the column path."
        )
        raise InputError.about(fault, use=repr(row.use[:60]))
    if row.storeys is None or row.floor_area_m2 is None:
        missing = [name for name in ("storeys", "floor_area_m2") if getattr(row, name) is None]
        text = "no inventory can be assumed without {columns}. Give it in the index, or survey the building."
        raise InputError.about(text, columns=", ".join(missing))
    area, storeys = row.floor_area_m2, row.storeys
    counts = []
    for kind in _read_kinds()[use]:  # whole pieces, of two equally near the larger
        few, median, many = (int(rate * area / SQUARE_FOOT + 0.5) for rate in kind.rates)
        counts.append((kind, Quantity(few, max(median, min(many, 1)), many)))
    if not any(one.median for _kind, one in counts):
        text = "no inventory can be assumed for a floor area of {area:g} m2: FEMA P-58 gives less than one piece."
        raise InputError.about(text, area=area)
    most = int(ITEMS.column("quantity").high or 0)  # that a row of an inventory takes
    if max(one.high for _kind, one in counts) > most * storeys:
        text = "{area:,.0f} m2 on {storeys} storeys is more than {most:,} pieces of a kind a storey: check both."
        raise InputError.about(text, area=area, storeys=storeys, most=most)
    height = row.height_m or min(STOREY_HEIGHT * storeys, BUILDING.column("height").high or 0.0)
    items: list[dict[str, Any]] = []
    low, high = {}, {}
    for kind, total in counts:
        for level, one in enumerate(spread_pieces(total, storeys), 1):
            if one.median:
                name = f"{kind.piece} {level}"
                low[name], high[name] = one.low, one.high
                items.append({
                    "item": name, "floor": str(level), "description": f"{kind.piece} (inventory assumed)",
                    "type": kind.type, "quantity": one.median, **kind.sizes,
                    "notes": f"inventory assumed: FEMA P-58 normative quantities; {one.low} to {one.high}",
                })  # fmt: skip
    rows: dict[str, Sequence[Mapping[str, Any]]] = {
        "Building": [{"building": row.building or row.path, **row.as_building(), "height": height}],
        "Floors": [
            {"floor": str(level), "elevation": round((level - 1) * height / storeys, 4)}
            for level in range(1, storeys + 1)
        ],
        "Items": items,
        "Catalogue": [{"type": kind.type, **kind.sizes, "source": kind.source} for kind, _total in counts],
    }
    origin = Origin(inventory="assumed", low=low, high=high)
    return origin, rows, tuple(_describe(row, use, counts, height))


@cache
def _name_uses() -> dict[str, str]:
    languages = [load_catalogue(code) for code in LANGUAGES]
    return {
        key(said): use
        for use, words in USES.items()
        for word in words
        for said in (word, *(one.find(word.capitalize()) for one in languages))
    }


def spread_pieces(total: Quantity, storeys: int) -> list[Quantity]:
    """Return the quantities of each storey, from the lowest: even, what is left over on the upper ones.

    Where there are fewer pieces than storeys, those of 10 % and 90 % stand on the storeys of the median.
    """
    levels = min(storeys, total.median)
    shares = [
        Quantity(*(number // levels + (level >= levels - number % levels) for number in total))
        for level in range(levels)
    ]
    return [Quantity(0, 0, 0)] * (storeys - levels) + shares


@cache
def _read_kinds() -> dict[str, tuple[_Kind, ...]]:
    text = (files("assess.portfolio") / "p58_quantities.csv").read_text(encoding="utf-8")
    catalogue = {line["type"]: line for line in catalogue_rows()}
    found: dict[str, tuple[_Kind, ...]] = {}
    for line in DictReader(StringIO(text)):
        known, rates = catalogue[line["type"]], (float(line["p10"]), float(line["p50"]), float(line["p90"]))
        sizes = {
            "breadth": float(known["breadth_cm"]),
            "width": BOOKCASE_WIDTH if line["piece"] == "bookcase" else None,
            "height": float(known["height_cm"]),
        }
        kind = _Kind(line["piece"], line["type"], rates, sizes, known["source"])
        found[line["use"]] = (*found.get(line["use"], ()), kind)
    return found


def _describe(row: IndexRow, use: str, counts: Sequence[tuple[_Kind, Quantity]], height: float) -> Iterator[Problem]:
    pieces = ", ".join(f"{count(one.median, kind.piece)} ({one.low:,} to {one.high:,})" for kind, one in counts)
    text = fill(
        "inventory assumed: no piece of this building has been seen. {pieces}, by its use ({use}) and its gross floor "
        "area ({area:,.0f} m2) after the normative quantities of FEMA P-58 (50 %; in brackets 10 % to 90 %). Other "
        "furniture is not counted.",
        pieces=pieces, use=use, area=row.floor_area_m2,
    )  # fmt: skip
    fix = fill("Survey the building, and name its workbook in the column path of the index.")
    yield Problem("warning", "", "", text, fix)
    if row.height_m is None:
        note = fill("height_m is blank: {each:g} m a storey assumed, {height:g} m.", each=STOREY_HEIGHT, height=height)
        yield Problem("note", "", "", note, fill("Give it in the index."))
