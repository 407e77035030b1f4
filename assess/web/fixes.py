"""Fixes that one click makes: what is likely meant in a cell, or the row that another sheet lacks.

A fix is what its button says and the edits that it makes, as `POST /api/edit` takes them, in the units of the headers.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from assess.errors import Problem
from assess.i18n import Text, fill, gettext
from assess.motion.assumed import find_number, guess_elevation, is_below_ground
from assess.units import QUANTITIES, ROUNDING
from assess.web.columns import PageColumn, PageSheet
from assess.workbook.habits import SHOWN
from assess.workbook.names import find_near_name, key
from assess.workbook.parse import Row
from assess.workbook.resolve import SIZES, defined
from assess.workbook.schema import Column
from assess.workbook.values import find_near_choice, is_within, list_readings

if TYPE_CHECKING:
    from assess.web.snapshot import Snapshot

DIGITS = 4
"""Significant digits of a number that a fix writes."""
Edit = tuple[str, int, int, Any]
"""Sheet, row, column and value."""
Fix = tuple[Text, tuple[Edit, ...]]


class Fixes:
    """Finds the fixes of the problems of one version of a workbook, in the language in use."""

    def __init__(self, snapshot: "Snapshot") -> None:
        self._sheets, self._tables, self._workbook = snapshot.sheets, snapshot.tables, snapshot.workbook
        self._building = snapshot.inventory.building
        self._names: dict[tuple[str, str], tuple[list[str], Fix | None]] = {}

    @cached_property
    def _corrections(self) -> Mapping[tuple[str, str], Any]:
        tables = self._tables.items()
        return {(sheet, one.cell): one.value for sheet, table in tables for one in table.corrections}

    @cached_property
    def _rows(self) -> Mapping[tuple[str, int], Row]:
        return {(sheet, row.number): row for sheet, table in self._tables.items() for row in table.rows}

    def find(self, sheet: str, alike: Sequence[tuple[tuple[int, int], Problem]]) -> list[dict[str, Any]]:
        """Return the fixes of problems that are shown as one, as the page takes them: each makes that of every cell."""
        found = [dict(self._list_fixes(sheet, place, one)) for place, one in alike]
        labels = list(dict.fromkeys(label for own in found for label in own))
        if any(len(own) != len(labels) for own in found):  # each has another one
            edits = list(dict.fromkeys(edit for own in found for fix in own.values() for edit in fix))
            is_one = all(len(own) == 1 for own in found)
            label = gettext("Fix all {n:,}", n=len(found))
            return [{"label": label, "edits": [list(edit) for edit in edits]}] if is_one else []
        fixes = []
        for label in labels:
            edits = list(dict.fromkeys(edit for own in found for edit in own[label]))
            text, n = gettext(label), len(found) if len(edits) > len(found[0][label]) else 1
            text = gettext("{fix} (all {n:,})", fix=text, n=n) if n > 1 else text
            fixes.append({"label": text, "edits": [list(edit) for edit in edits]})
        return fixes

    def _list_fixes(self, sheet: str, place: tuple[int, int], problem: Problem) -> Iterator[Fix]:
        page = self._sheets.get(sheet)
        found = page.find(*place) if page else None
        if page is None or found is None or found.column is None or found.is_blind:
            return
        (number, at), column = place, found.column
        row = self._rows.get((sheet, 0 if page.sheet.layout == "form" else number))
        value = self._workbook.sheets[sheet].value(place)
        if (sheet, problem.cell) in self._corrections:
            meant = self._corrections[sheet, problem.cell]
            shown = f"{meant:.10g}" if isinstance(meant, float) else str(meant or "")
            yield fill("Write {value}", value=shown[:SHOWN]), ((sheet, number, at, meant),)
        elif column.source:
            name, known = row and row.get(column.name), self._known.get(column.source)
            if row is not None and name and known is not None and key(name) not in known:
                yield from self._fix_name(sheet, number, at, column, row)
        elif column.kind in ("choice", "flag") and isinstance(value, str):
            if problem.severity == "error" and (near := find_near_choice(column, value)):
                yield _use(near, (sheet, number, at, near))
        elif isinstance(value, int | float) and not isinstance(value, bool):
            if not is_within(column, value, found.unit):
                for _, converted in list_readings(column, value, found.unit):
                    meant = float(f"{converted:.{DIGITS}g}")
                    yield _use(f"{meant:g} {found.unit}", (sheet, number, at, meant))
            elif column.name == "breadth" and row is not None:
                yield from self._exchange(page, number, row)

    @cached_property
    def _known(self) -> Mapping[str, Mapping[str, str]]:
        return {sheet: defined(table) for sheet, table in self._tables.items() if table.found}

    # ---- names that another sheet does not define

    def _fix_name(self, sheet: str, number: int, at: int, column: Column, row: Row) -> Iterator[Fix]:
        name, source = row.get(column.name), column.source
        if (source, key(name)) not in self._names:  # the same names stand in row after row
            self._names[source, key(name)] = self._find_name(source, name)
        meant, added = self._names[source, key(name)]
        for other in meant:
            yield _use(other, (sheet, number, at, other))
        if added:
            yield added
        elif source == "Catalogue" and row.get("breadth") and row.get("height"):
            sizes = {one: row.get(one) for one in SIZES}
            yield self._add_row(source, {"type": name, **sizes}, self._say_sizes(name, sizes))

    def _find_name(self, source: str, name: str) -> tuple[list[str], Fix | None]:
        """Return the names that an unknown one may mean, and the fix that adds the floor that it calls."""
        known = self._known[source]
        near = known.get(find_near_name(key(name), known) or "")
        if source != "Floors":
            return [near] if near else [], None
        level = self._find_level(name)
        return [*dict.fromkeys(filter(None, (level, near)))], None if level else self._add_floor(name)

    def _find_level(self, name: str) -> str | None:
        """Return the floor that another name calls: 2 for "2nd floor", "Piano terra" or its Name for "Ground floor"."""
        rows, number = self._tables["Floors"].with_all("floor"), None if is_below_ground(name) else find_number(name)
        called = [row for row in rows if key(row.get("name") or "") == key(name)]
        if number is not None:
            names = ((row, one) for row in rows for one in (row.get("floor"), row.get("name") or ""))
            called += [row for row, one in names if find_number(one) == number]
            called += [row for row in rows if number == row.get("elevation") == 0]
        return called[0].get("floor") if called else None

    def _add_floor(self, name: str) -> Fix:
        rows, building = self._tables["Floors"].with_all("floor"), self._building
        levels = [(row.get("floor"), row.get("elevation")) for row in rows]
        z = guess_elevation(name, levels, building.height, building.storeys)
        place = self._sheets["Floors"].field("elevation")
        if z is None or place is None:
            return self._add_row("Floors", {"floor": name}, fill("Add floor {floor}", floor=name[:SHOWN]))
        label = fill("Add floor {floor} at {z:g} {unit}", floor=name[:SHOWN], z=_convert(place, z), unit=place.unit)
        return self._add_row("Floors", {"floor": name, "elevation": z}, label)

    def _add_row(self, sheet: str, values: Mapping[str, Any], label: Text) -> Fix:
        """Return the fix that writes values [SI] below the last row of a sheet."""
        number = max(self._workbook.sheets[sheet].last_row, self._sheets[sheet].header) + 1
        edits: list[Edit] = []
        for name, value in values.items():
            column = self._sheets[sheet].field(name)
            if column is not None and value is not None:
                edits.append((sheet, number, column.at, _convert(column, value)))
        return label, tuple(edits)

    def _say_sizes(self, name: str, sizes: Mapping[str, float | None]) -> Text:
        page = self._sheets["Catalogue"]
        found = [(one, size) for name, size in sizes.items() if size and (one := page.field(name))]
        shown = " × ".join(f"{_convert(one, size):g}" for one, size in found)
        values = {"name": name[:SHOWN], "sizes": shown, "unit": found[0][0].unit, "sheet": page.title}
        return fill("Add {name} {sizes} {unit} to {sheet}", **values)

    def _exchange(self, page: PageSheet, number: int, row: Row) -> Iterator[Fix]:
        """Yield the fix of a breadth that is greater than a width, else than a height, in the same row."""
        breadth, size = page.field("breadth"), row.get("breadth")
        for name in ("width", "height"):
            other, more = page.field(name), row.get(name)
            if breadth and other and size and more and size > more * (1 + ROUNDING):
                sides = ((breadth, more), (other, size))
                edits = tuple((page.sheet.name, number, one.at, _convert(one, value)) for one, value in sides)
                yield fill("Exchange {one} and {other}", one=breadth.label, other=other.label), edits
                return


def _use(shown: str, edit: Edit) -> Fix:
    return fill("Use {name}", name=shown[:SHOWN]), (edit,)


def _convert(column: PageColumn, value: Any) -> Any:
    """Return a value [SI] in the unit of a header."""
    if column.column is None or not isinstance(value, float) or not column.column.quantity:
        return value
    return float(f"{value / QUANTITIES[column.column.quantity].get(column.unit, 1.0):.{DIGITS}g}")
