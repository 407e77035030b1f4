"""What an import found in a building, as an inventory workbook: that of `assess new`, filled in, without shaking."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from assess.bim.building_model import LONGEST_NAME, Skipped
from assess.delivery.folders import private_folder
from assess.errors import Problem
from assess.i18n import Text, count, fill
from assess.pipeline.live_values import store_live
from assess.workbook.catalogue import read_catalogue
from assess.workbook.habits import clean
from assess.workbook.names import key
from assess.workbook.schema import SHEETS
from assess.workbook.template import Content, Rows, write_workbook

LONGEST_CELL = 32_767  # characters that a spreadsheet takes in a cell
_LONG = frozenset(
    {"notes", "source", *(column.name for sheet in SHEETS for column in sheet.columns if column.kind == "outline")}
)
MOST_NAMED, FEW_NAMED = 500, 5  # types that a text names, of what may be furniture, and of what is none
MOST_LIVE = 5000
"""Rows up to which the results of the live columns are stored; a spreadsheet program works them out in any case."""
NEAR_GROUND = (-1.0, 3.0)  # elevations [m] of a lowest floor that lies at the ground, as far as can be known
LOWEST_ROOF = 2.0  # least height of a building that a workbook takes [m]
ENDING = "-import.txt"  # how the name of the file that records an import ends; it begins with that of the model


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedBuilding:
    """What a file tells of a building: rows by field of `assess.workbook.schema`, in the units of SI headers.

    `types` join the Catalogue, in place of those of their name there. `warnings` may distort the results until it is
    corrected, `remarks` are what else is worth checking. `files`, such as plans, are written next to the workbook.
    """

    source: str
    building: Mapping[str, Any] = field(default_factory=dict)
    floors: Rows = ()
    items: Rows = ()
    places: Rows = ()
    routes: Rows = ()
    types: Rows = ()
    skipped: tuple[Skipped, ...] = ()
    warnings: tuple[Text, ...] = ()
    remarks: tuple[Text, ...] = ()
    files: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """Whether there is furniture, and none was left out."""
        return bool(self.items) and not any(one.is_furniture for one in self.skipped)


def build_workbook(imported: ImportedBuilding) -> bytes:
    """Return the workbook of an import, in the language in use; OSError if there is no room for temporary files."""
    content = Content(list_rows(imported))
    if len(imported.items) <= MOST_LIVE:
        content = store_live(content, "si")
    with private_folder("assess-import-") as folder:
        path = folder / "imported.xlsx"
        write_workbook(path, content)
        return path.read_bytes()


def list_rows(imported: ImportedBuilding) -> dict[str, Rows]:
    """Return the rows of the workbook by sheet, as `assess.workbook.read.read_inventory` takes them, too."""
    own = {key(row["type"]) for row in imported.types}
    rows = {
        "Building": [imported.building],
        "Floors": imported.floors,
        "Items": imported.items,
        "Places": imported.places,
        "Routes": imported.routes,
        "Catalogue": [*imported.types, *(row for row in read_catalogue() if key(row["type"]) not in own)],
    }

    def cut(sheet: str, name: str, value: Any) -> Any:
        is_long = name in _LONG or (sheet, name) == ("Routes", "room")  # which lists the names of rooms
        return clean(value)[0][: LONGEST_CELL if is_long else LONGEST_NAME] if isinstance(value, str) else value

    return {
        sheet: [{name: cut(sheet, name, value) for name, value in row.items()} for row in some]
        for sheet, some in rows.items()
    }


def name_apart(names: Iterable[str], others: Sequence[str] = ()) -> list[str]:
    """Return names as cells hold them, cut to `LONGEST_NAME`, each its own: a second "Desk" becomes "Desk (2)".

    `others`: names that are taken.
    """
    taken: set[str] = set()
    next_number: Counter[str] = Counter()
    found = []
    for name in (*others, *names):
        bare = " ".join(clean(name)[0].split())[:LONGEST_NAME].rstrip()
        one = bare
        while key(one) in taken:
            next_number[key(bare)] += 1
            mark = f" ({next_number[key(bare)] + 1})"
            one = bare[: LONGEST_NAME - len(mark)] + mark
        taken.add(key(one))
        found.append(one)
    return found[len(others) :]


def note_datum(known: Sequence[tuple[str, float]]) -> list[Text]:
    """Return what has to be checked of the floors' names and elevations [m], from the lowest."""
    if not known or NEAR_GROUND[0] <= known[0][1] <= NEAR_GROUND[1]:
        return []
    below = [name for name, elevation in known if elevation < NEAR_GROUND[0]]
    if below:
        text = fill(
            "Below the ground by their elevation, so that they shake as the ground does: {floors}. Correct Elevation "
            "in Floors if the file does not count from the ground.", floors=", ".join(below),
        )  # fmt: skip
    else:
        text = fill(
            "The lowest floor, {floor}, is at {elevation:g} m in the file. If it lies at the ground, subtract that "
            "from every Elevation in Floors and from Height in Building: else it shakes as the top of a taller "
            "building.",
            floor=known[0][0], elevation=round(known[0][1], 3),
        )  # fmt: skip
    return [text]


def list_remarks(imported: ImportedBuilding) -> tuple[Problem, ...]:
    """Return what was left out and what has to be checked, as problems: for a table of many buildings."""
    groups = [group for _, group in group_skipped(imported.skipped)]
    return (
        *(Problem("warning", "", "", describe_skipped(one, MOST_NAMED)) for one in groups if one[0].is_furniture),
        *(Problem("warning", "", "", text) for text in imported.warnings),
        *(Problem("note", "", "", text) for text in imported.remarks),
        *(Problem("note", "", "", describe_skipped(one, FEW_NAMED)) for one in groups if not one[0].is_furniture),
    )


def group_skipped(skipped: Sequence[Skipped]) -> list[tuple[Text, list[Skipped]]]:
    """Return what was left out by reason: what may be furniture first, the most pieces first in each group."""
    groups: dict[Text, list[Skipped]] = {}
    for one in sorted(skipped, key=lambda one: (not one.is_furniture, -one.count, one.type)):
        groups.setdefault(one.reason, []).append(one)
    return list(groups.items())


def describe_skipped(group: Sequence[Skipped], most: int) -> Text:
    """Return what was left out for one reason: the first types with their numbers, and how many types more."""
    pieces = count(sum(one.count for one in group), "piece" if group[0].is_furniture else "component")
    types = ", ".join(f"{one.type} ({one.count:,})" for one in group[:most])
    values = {"pieces": pieces, "reason": group[0].reason, "types": types}
    if len(group) <= most:
        return fill("{pieces} left out ({reason}): {types}.", **values)
    return fill("{pieces} left out ({reason}): {types} and {n:,} more types.", n=len(group) - most, **values)


def describe(found: ImportedBuilding) -> Iterator[str]:
    """Yield what was taken, what was left out by reason and type, and what has to be checked, in English."""
    kinds, floors = ({row.get(name) for row in found.items} for name in ("type", "floor"))
    where = f"of {count(len(kinds), 'type')} on {count(len(floors or found.floors), 'floor')}"
    left = sum(one.count for one in found.skipped if one.is_furniture)
    pieces = count(len(found.items) + left, "piece")
    yield f"{found.source}: {f'{len(found.items):,} of ' if left else ''}{pieces} {where} taken."
    if not found.items:
        yield "No furniture was found: fill in Items by hand."
    yield from (describe_skipped(group, MOST_NAMED) for _, group in group_skipped(found.skipped))
    yield from (f"Check: {text}" for text in (*found.warnings, *found.remarks))
