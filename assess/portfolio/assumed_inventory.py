"""A building without a survey: bookcases and lateral files by its use and gross floor area, marked as assumed.

Reference: FEMA P-58-1, Seismic Performance Assessment of Buildings, second edition (2018), normative quantities of
components by occupancy: pieces a gross square foot, of which 10 %, 50 % and 90 % of buildings have no more
(``p58_quantities.csv``: bookcases of 6 to 7 shelves, 3 ft wide; lateral filing cabinets of 4 drawers). Sizes are those
of the fragility database of FEMA P-58 (E.20.22.106a: 12.625 x 81.25 in; E.20.22.124a: 18.6 x 52.5 in), as in the
Catalogue. P-58 gives quantities of such pieces for offices, healthcare and laboratories only: any other use is refused.

A building has other furniture as well, of which nothing is assumed: the number of falls is not that of the building.
The quantities of 10 % and 90 % are each assumed of all pieces at once.

Departures: whole pieces, rounded for the building as a whole, at least one of a kind of which the 90 % quantity is at
least one; spread evenly over the storeys, what is left over on the upper ones, which shake more. Storeys are of equal
height. A blank height counts as `STOREY_HEIGHT` a storey, which is assumed.
"""

from collections.abc import Iterator, Mapping, Sequence
from csv import DictReader
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from io import StringIO
from typing import Any, NamedTuple

from assess.errors import InputError, Problem
from assess.i18n import LANGUAGES, count, fill, load_catalogue
from assess.portfolio.index_file import IndexRow
from assess.units import LENGTH
from assess.workbook.catalogue import catalogue_rows
from assess.workbook.names import key
from assess.workbook.schema import BUILDING, ITEMS
from assess.workbook.template import Rows

SQUARE_FOOT = LENGTH["ft"] ** 2
"""[m2]."""
STOREY_HEIGHT = 4.0
"""Of a building whose height is not known [m]: assumed, on the high side for offices."""
BOOKCASE_WIDTH = 91.4
"""3 ft [cm], as the component of P-58 is named."""
USES: Mapping[str, tuple[str, ...]] = {
    "office": ("office", "offices", "commercial office", "ufficio"),
    "healthcare": ("healthcare", "health care", "hospital", "hospitals", "clinic", "medical"),
    "laboratory": ("laboratory", "laboratories", "research laboratory"),
}
"""How an index names the occupancies of P-58; names of the sheet Building in other languages count as well."""
_SOURCE = "FEMA P-58 normative quantities"


class Quantity(NamedTuple):
    """Whole pieces: 10 %, 50 % and 90 % quantity."""

    low: int
    median: int
    high: int


@dataclass(frozen=True, slots=True, kw_only=True)
class AssumedInventory:
    """What is assumed of a building.

    Attributes
    ----------
    rows : mapping
        Rows by sheet, for `assess.workbook.read.read_inventory`.
    low, high : mapping of str to int
        10 % and 90 % quantities by item; the 50 % quantity is the row's.
    problems : tuple of Problem
        That it is assumed, from what, and in which range.
    """

    rows: Mapping[str, Rows]
    low: Mapping[str, int]
    high: Mapping[str, int]
    problems: tuple[Problem, ...]


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of piece: its quantities a square foot (10 %, 50 %, 90 %), its Type, and sizes [cm] with their source."""

    piece: str
    type: str
    rates: tuple[float, float, float]
    sizes: Mapping[str, float | None]
    source: str

    def count(self, area: float) -> Quantity:
        """Return how many an area [m2] has: whole pieces, of two equally near the larger."""
        low, median, high = (int(rate * area / SQUARE_FOOT + 0.5) for rate in self.rates)
        return Quantity(low, max(median, min(high, 1)), high)


def build_assumed(row: IndexRow) -> AssumedInventory:
    """Return the furniture that is assumed of a building of an index.

    Parameters
    ----------
    row : IndexRow
        Its use, storeys and floor area are needed. A blank height is assumed by the storeys.

    Raises
    ------
    InputError
        If one of them is blank, the use is none that P-58 gives quantities for, or the area is too small or too large.
    """
    use = find_use(row.use)
    if row.storeys is None or row.floor_area_m2 is None:
        missing = [name for name in ("storeys", "floor_area_m2") if getattr(row, name) is None]
        text = "no inventory can be assumed without {columns}. Give it in the index, or survey the building."
        raise InputError(fill(text, columns=", ".join(missing)))
    area, storeys = row.floor_area_m2, row.storeys
    counts = [(kind, kind.count(area)) for kind in _read_kinds()[use]]
    if not any(one.median for _kind, one in counts):
        text = "no inventory can be assumed for a floor area of {area:g} m2: FEMA P-58 gives less than one piece."
        raise InputError(fill(text, area=area))
    most = int(ITEMS.column("quantity").high or 0)  # that a row of an inventory takes
    if max(one.high for _kind, one in counts) > most * storeys:
        text = "{area:,.0f} m2 on {storeys} storeys is more than {most:,} pieces of a kind a storey: check both."
        raise InputError(fill(text, area=area, storeys=storeys, most=most))
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
                    "notes": f"inventory assumed: {_SOURCE}; {one.low} to {one.high}",
                })  # fmt: skip
    return AssumedInventory(
        rows={
            "Building": [{"building": row.building or row.path, **row.as_building(), "height": height}],
            "Floors": [
                {"floor": str(level), "elevation": round((level - 1) * height / storeys, 4)}
                for level in range(1, storeys + 1)
            ],
            "Items": items,
            "Catalogue": [{"type": kind.type, **kind.sizes, "source": kind.source} for kind, _total in counts],
        },
        low=low,
        high=high,
        problems=tuple(_describe(row, use, counts, height)),
    )


def find_use(text: str) -> str:
    """Return the occupancy of P-58 that a use means: office, healthcare or laboratory.

    Raises
    ------
    InputError
        If it is blank, or P-58 gives no quantities of it.
    """
    if not text.strip():
        fault = "no inventory can be assumed without use. Give it in the index, or survey the building."
        raise InputError(fill(fault))
    if (use := _names().get(key(text))) is not None:
        return use
    fault = (
        "no inventory can be assumed for the use {use}: FEMA P-58 gives quantities of furniture for office, healthcare "
        "and laboratory only. Survey the building, and name its workbook in the column path."
    )
    raise InputError(fill(fault, use=repr(text[:60])))


@cache
def _names() -> dict[str, str]:
    """Return the occupancies by their names in every language, as names are compared."""
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
    """Return the kinds of pieces by occupancy."""
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
    """Yield that the inventory is assumed, and what else is."""
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
