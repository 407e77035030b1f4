"""Typed rows to the inventory: every name as where it is defined, sizes from the catalogue, an axis from its angle.

`resolve` makes new rows and reports nothing; what does not fit together is for `check`. The rest builds the rows of
the model.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, TypeVar

from assess.errors import Correction, Problem
from assess.i18n import fill, nfill
from assess.model import (
    AXES,
    Axis,
    Building,
    CatalogueType,
    Cost,
    Floor,
    FloorPlan,
    FloorRecord,
    Item,
    Place,
    Segment,
    axis_of,
)
from assess.workbook.habits import note, shorten
from assess.workbook.names import key
from assess.workbook.parse import Row, Table, Tables, row_numbers
from assess.workbook.schema import PICTURE_FIELDS, SHEETS, Column

_ITEM_FIELDS = frozenset(field.name for field in fields(Item))
_DEFINED_BY = {sheet.name: sheet.columns[0].name for sheet in SHEETS if sheet.layout == "table"}
"""The column of each table that defines its names: the first."""

SIZES = ("breadth", "width", "height")
FROM_TYPE = (*SIZES, "weight", "centre_of_gravity")
"""Fields of an item that its type of the catalogue gives where they are blank."""

T = TypeVar("T", CatalogueType, Cost, Place, Segment)

Segments = Mapping[str, Mapping[str, Row]]
"""Rows of Routes by the names of route and segment, as they are compared."""


def defined(table: Table) -> dict[str, str]:
    """Return the names that the first column of a table defines, as `defined_by` does."""
    return defined_by(table, table.sheet.columns[0].name)


def defined_by(table: Table, name: str) -> dict[str, str]:
    """Return the names of a column, by how they are compared; the first spelling counts."""
    return {key(row.get(name)): row.get(name) for row in reversed(table.with_all(name))}


def places_by_name(table: Table) -> dict[str, Row]:
    """Return the rows of Places by their names, as they are compared."""
    return {key(row.get("place")): row for row in reversed(table.with_all("place"))}


def list_segments(routes: Table) -> Segments:
    """Return the rows of Routes that have both names."""
    found: dict[str, dict[str, Row]] = {}
    for row in routes.with_all("route", "segment"):
        found.setdefault(key(row.get("route")), {}).setdefault(key(row.get("segment")), row)
    return found


def resolve(tables: Tables) -> Tables:
    """Return the tables with every name spelt as where it is defined, and blank floors of segments filled in."""
    sources = {"Routes", *(column.source for table in tables.values() for column in table.sheet.columns)} - {""}
    names = {sheet: defined(tables[sheet]) for sheet in sources}
    spelt = {sheet: _spell(table, sheet, names) for sheet, table in tables.items()}
    spelt["Routes"] = _map(spelt["Routes"], _floor_filler(spelt, names["Floors"]))
    spelt["Items"] = _map(spelt["Items"], _segment_speller(spelt["Items"], list_segments(spelt["Routes"])))
    return spelt


def _map(table: Table, change: Callable[[Row], Mapping[str, Any]]) -> Table:
    rows = ((row, change(row)) for row in table.rows)
    changed = (replace(row, values={**row.values, **new}) if new else row for row, new in rows)
    return replace(table, rows=tuple(changed))


def _spell(table: Table, sheet: str, names: Mapping[str, Mapping[str, str]]) -> Table:
    sources = {column.name: column.source for column in table.sheet.columns if column.source}
    sources |= {_DEFINED_BY[sheet]: sheet} if sheet == "Routes" else {}

    def change(row: Row) -> dict[str, str]:
        new = {}
        for name, source in sources.items():
            text = row.values.get(name)
            spelt = names[source].get(key(text)) if text else None
            if spelt is not None and spelt != text:
                new[name] = spelt
        return new

    return _map(table, change)


def _floor_filler(tables: Tables, floors: Mapping[str, str]) -> Callable[[Row], Mapping[str, str]]:
    routes, places = tables["Routes"], tables["Places"]
    known = places_by_name(places)

    def fill_in(row: Row) -> dict[str, str]:
        ends = [known.get(key(routes.sound(name, row) or "")) for name in ("start", "end")]
        on = {places.sound("floor", end) if end else None for end in ends}
        floor = next(iter(on))
        is_known = len(on) == 1 and floor is not None and key(floor) in floors
        return {"floor": floor} if is_known and floor and routes.lacks(row, "floor") else {}

    return fill_in


def _segment_speller(items: Table, segments: Segments) -> Callable[[Row], Mapping[str, str]]:
    def spell(row: Row) -> dict[str, str]:
        if row.get("segment") is None:
            return {}
        route, segment = items.sound("route", row), items.sound("segment", row)
        found = segments.get(key(route or ""), {}).get(key(segment or ""))
        return {"segment": found.get("segment")} if found else {}

    return spell


# ---------------------------------------------------------------- the model


def build_building(table: Table, logo: Path | None) -> Building:
    """Return the building; `logo` is the picture that its line names."""
    values = table.rows[0].values if table.rows else {}
    cells = {name: table.cell(name, 0) for name in table.places}
    return Building(**{**values, "logo": logo}, cells=cells)


def build_rows(kind: type[T], table: Table, *needed: str) -> tuple[T, ...]:
    """Return the rows of a table that have the fields they need as rows of the model: places, segments or types."""
    return tuple(kind(row=row.number, **row.values) for row in table.with_all(*needed))


def build_catalogue(table: Table) -> tuple[CatalogueType, ...]:
    """Return the types of furniture."""
    return build_rows(CatalogueType, table, "type")


def build_floors(
    table: Table, records: Mapping[tuple[int, Axis], tuple[FloorRecord, ...]], plans: Mapping[int, FloorPlan]
) -> tuple[Floor, ...]:
    """Return the floors; `records` and `plans` are found by the number of their row."""
    return tuple(
        Floor(
            row=row.number,
            floor=row.get("floor"),
            name=row.get("name") or "",
            elevation=row.get("elevation"),
            pfa=_by_axis(row, "pfa"),
            pfv=_by_axis(row, "pfv"),
            records={axis: found for axis in AXES if (found := records.get((row.number, axis)))},
            plan=plans.get(row.number),
            cells={name: table.cell(name, row.number) for name in table.places},
        )
        for row in table.with_all("floor")
    )


def _by_axis(row: Row, what: str) -> dict[Axis, float]:
    values = {axis: row.get(f"{what}_{axis.lower()}") for axis in AXES}
    return {axis: value for axis, value in values.items() if value is not None}


def build_items(table: Table, types: Mapping[str, CatalogueType]) -> tuple[Item, ...]:
    """Return the items that have all they need; why others have not has been reported."""
    built = (_build_item(table, row, types) for row in table.rows)
    return tuple(item for item in built if item is not None)


def _build_item(table: Table, row: Row, types: Mapping[str, CatalogueType]) -> Item | None:
    values, typed = dict(row.values), _find_in_type(table, row, types, FROM_TYPE)
    assumed = [*typed]
    values |= typed
    if "axis" not in values and (axis := turned_axis(row)):
        values["axis"] = axis
        assumed.append("axis")
    assumed += [name for name in ("quantity", "anchored") if name not in values]
    if any(name not in values for name in ("item", "floor", "breadth", "height")):
        return None
    more = {name: values.pop(name) for name in [*values] if name not in _ITEM_FIELDS}
    return Item(row=row.number, **values, assumed=tuple(assumed), extra=row.extra, more=more)


def filled_sizes(table: Table, row: Row, types: Mapping[str, CatalogueType]) -> dict[str, float]:
    """Return the sizes of an item [m]: its own, else those of its type."""
    own = {name: row.values[name] for name in SIZES if name in row.values}
    return own | _find_in_type(table, row, types, SIZES)


def _find_in_type(table: Table, row: Row, types: Mapping[str, CatalogueType], names: Iterable[str]) -> dict[str, float]:
    kind = types.get(key(row.get("type") or ""))
    blank = (name for name in names if kind is not None and name not in row.values and not table.spoilt(name, row))
    return {name: value for name in blank if (value := getattr(kind, name)) is not None}


def turned_axis(row: Row) -> Axis | None:
    """Return the axis that an item's angle lies along."""
    angle = row.get("angle_deg")
    return None if angle is None else axis_of(angle)


# ---------------------------------------------------------------- what is left of a faulty workbook


def leave_out(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Return the tables without faulty rows and the rows that need one of those, with warnings of the latter."""
    left = {sheet: _without_faulty(table) for sheet, table in tables.items()}
    problems: list[Problem] = []
    for sheet, names in (("Places", ("floor",)), ("Routes", ("floor", "start", "end")), ("Items", ("floor", "route"))):
        columns = {column.name: column.source for column in left[sheet].sheet.columns}
        for name in names:
            known = defined(left[columns[name]])
            gone = [row for row in left[sheet].with_all(name) if key(row.get(name)) not in known]
            problems += _warn_left_out(left[sheet], name, gone)
            left[sheet] = _without(left[sheet], gone)
    items, segments = left["Items"], list_segments(left["Routes"])
    named = ((row, segments.get(key(row.get("route") or ""), {})) for row in items.with_all("segment"))
    gone = [row for row, known in named if key(row.get("segment")) not in known]
    problems += _warn_left_out(items, "segment", gone)
    return {**left, "Items": _without(items, gone)}, problems


def _without_faulty(table: Table) -> Table:
    """Return a table without the rows of errors; without any where its headers, or the sheet itself, are wrong.

    Of a form only the faulty values are left out, and of a row whose only errors are in `PICTURE_FIELDS` these.
    """
    if not table.failed:
        return table
    if table.sheet.layout == "form":
        faulty = {name for name in table.places if table.cell(name, 0) in table.failed}
        return replace(table, rows=tuple(_without_fields(row, faulty) for row in table.rows))
    names = PICTURE_FIELDS & table.places.keys()
    spare = {row.number: {name for name in names if table.cell(name, row.number) in table.failed} for row in table.rows}
    harmless = {table.cell(name, number) for number, fields in spare.items() for name in fields}
    named = [set(row_numbers(cell)) for cell in table.failed - harmless]
    if not all(one & spare.keys() for one in named):
        return replace(table, rows=())
    faulty_rows = set().union(*named)
    kept = (row for row in table.rows if row.number not in faulty_rows)
    return replace(table, rows=tuple(_without_fields(row, spare[row.number]) for row in kept))


def _without_fields(row: Row, names: Collection[str]) -> Row:
    values = {name: value for name, value in row.values.items() if name not in names}
    return replace(row, values=values) if names else row


def _without(table: Table, gone: Iterable[Row]) -> Table:
    numbers = {row.number for row in gone}
    return replace(table, rows=tuple(row for row in table.rows if row.number not in numbers))


def _warn_left_out(table: Table, name: str, rows: Iterable[Row]) -> Iterable[Problem]:
    by_name: dict[str, list[Row]] = {}
    for row in rows:
        by_name.setdefault(row.get(name), []).append(row)
    for text, own in by_name.items():
        message = nfill(
            "{n:,} row that names {label} {name} is left out, as the row that defines {name} has errors.",
            "{n:,} rows that name {label} {name} are left out, as the row that defines {name} has errors.",
            len(own), label=table.label(name), name=shorten(text),
        )  # fmt: skip
        yield table.problem(name, own[0], message, fill("Correct that row."), "warning")


def correct_names(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Return the tables with corrections of names of other sheets, and the notes on them.

    Letter case alone is no difference: a spreadsheet's look-ups ignore it, too.
    """
    found: dict[str, Table] = {}
    notes: list[Problem] = []
    for sheet, table in tables.items():
        corrections: list[Correction] = []
        for column in table.sheet.columns:
            if column.source and column.name in table.places:
                _correct_column(table, column, defined(tables[column.source]), notes, corrections)
        found[sheet] = replace(table, corrections=(*table.corrections, *corrections)) if corrections else table
    return found, notes


def _correct_column(
    table: Table, column: Column, known: dict[str, str], notes: list[Problem], corrections: list[Correction]
) -> None:
    spellings = {None, *known.values()}
    for row in (row for row in table.rows if row.get(column.name) not in spellings):
        typed = row.get(column.name)
        spelt = known.get(key(typed), typed)
        if spelt.casefold() == typed.casefold():
            continue
        remark = note("signs", fill(table.label(column.name)), shorten(typed), shorten(spelt), spelt)
        problem = table.problem(column.name, row, remark.message, severity=remark.severity)
        notes.append(replace(problem, group=f"{column.name}: {remark.habit}"))
        if table.source is not None and table.source.title:
            corrections.append(Correction(table.source.title, problem.cell, typed, spelt, remark.why))
