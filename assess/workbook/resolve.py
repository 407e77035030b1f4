"""Typed rows to the inventory: every name as where it is defined, sizes from the catalogue, an axis from its angle.

`resolve` makes new rows and reports nothing; what does not fit together is for `check`. The rest builds the rows of
the model.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, TypeVar

from assess import model
from assess.details import FIX_BY
from assess.errors import Correction, Problem
from assess.i18n import fill, nfill
from assess.model import AXES, Axis, CatalogueType, FloorPlan, FloorRecord, Item, axis_of
from assess.workbook.catalogue import find_built_in
from assess.workbook.habits import note, shorten
from assess.workbook.names import key
from assess.workbook.parse import Row, Table, Tables, row_numbers
from assess.workbook.schema import PICTURE_FIELDS
from assess.workbook.values import find_currency

_ITEM_FIELDS = frozenset(field.name for field in fields(Item))
SIZES = ("breadth", "width", "height")
FROM_TYPE = (*SIZES, "weight", "centre_of_gravity")
"""Fields of an item that its type of the catalogue gives where they are blank."""
T = TypeVar("T", CatalogueType, model.Passage, model.Place, model.Segment)


def defined(table: Table, name: str = "") -> dict[str, str]:
    """Return the names of a column, the first by default, by how they are compared; the first spelling counts."""
    name = name or table.sheet.columns[0].name
    return {key(row.get(name)): row.get(name) for row in reversed(table.with_all(name))}


def places_by_name(table: Table) -> dict[str, Row]:
    """Return the rows of Places by their names, as they are compared."""
    return {key(row.get("place")): row for row in reversed(table.with_all("place"))}


def list_segments(routes: Table) -> dict[str, dict[str, Row]]:
    """Return the rows of Routes that have both names, by those of route and segment, as they are compared."""
    found: dict[str, dict[str, Row]] = {}
    for row in routes.with_all("route", "segment"):
        found.setdefault(key(row.get("route")), {}).setdefault(key(row.get("segment")), row)
    return found


def resolve(tables: Tables) -> Tables:
    """Return the tables with every name spelt as where it is defined, and blank floors of segments filled in."""
    sources = {"Routes", *(column.source for table in tables.values() for column in table.sheet.columns)} - {""}
    names = {sheet: defined(tables[sheet]) for sheet in sources}
    spelt = dict(tables)
    for sheet, table in tables.items():
        own = {column.name: column.source for column in table.sheet.columns if column.source}
        own |= {"route": sheet} if sheet == "Routes" else {}
        changes: dict[int, dict[str, str]] = {}
        for row in table.rows:
            for name, source in own.items():
                text = row.values.get(name)
                known = names[source].get(key(text)) if text else None
                if known is not None and known != text:
                    changes.setdefault(row.number, {})[name] = known
        spelt[sheet] = _change(table, changes)
    routes, places = spelt["Routes"], spelt["Places"]
    by_name = places_by_name(places)
    floors: dict[int, dict[str, str]] = {}
    for row in routes.rows:
        ends = [by_name.get(key(routes.sound(name, row) or "")) for name in ("start", "end")]
        on = {places.sound("floor", end) if end else None for end in ends}
        if len(on) == 1 and (floor := on.pop()) and key(floor) in names["Floors"] and routes.lacks(row, "floor"):
            floors[row.number] = {"floor": floor}
    spelt["Routes"] = _change(routes, floors)
    items, segments = spelt["Items"], list_segments(spelt["Routes"])
    parts: dict[int, dict[str, str]] = {}
    for row in items.with_all("segment"):
        route, segment = items.sound("route", row), items.sound("segment", row)
        if found := segments.get(key(route or ""), {}).get(key(segment or "")):
            parts[row.number] = {"segment": found.get("segment")}
    spelt["Items"] = _change(items, parts)
    return spelt


def _change(table: Table, changes: Mapping[int, Mapping[str, Any]]) -> Table:
    """Return a table with other values in some rows, by their numbers."""
    rows = (
        replace(row, values={**row.values, **changes[row.number]}) if row.number in changes else row
        for row in table.rows
    )
    return replace(table, rows=tuple(rows)) if changes else table


def build_building(tables: Tables, logo: Path | None) -> model.Building:
    """Return the building; `logo` is the picture that its line names. Blank units of reports are those of the sizes."""
    table, units = tables["Building"], {tables["Items"].units.get(name) for name in SIZES} - {None}
    values = table.rows[0].values if table.rows else {}
    cells = {name: table.cell(name, 0) for name in table.places}
    chosen = values.get("report_units")
    if chosen in (None, model.UNITS[0]):
        chosen = "US" if units and units <= {"in", "ft"} else "SI"
    return model.Building(**{**values, "logo": logo, "report_units": chosen}, cells=cells)


def build_rows(kind: type[T], table: Table, *needed: str) -> tuple[T, ...]:
    """Return the rows of a table that have the fields they need as rows of the model: places, segments or types."""
    return tuple(kind(row=row.number, **row.values) for row in table.with_all(*needed))


def build_costs(table: Table) -> tuple[model.Cost, ...]:
    """Return the costs of details, in the one currency that the sheet names."""
    rows = table.with_all("detail", "unit_cost")
    currency = next((code for row in rows for code in name_currencies(row)), "")
    return tuple(model.Cost(row=row.number, **{**row.values, "currency": currency}) for row in rows)


def name_currencies(row: Row) -> Iterator[str]:
    """Yield the ISO codes of the currencies that a row of Costs names: in its Unit cost, and in Currency."""
    if getattr(row.get("unit_cost"), "currency", ""):
        yield row.get("unit_cost").currency
    if row.get("currency"):
        yield find_currency(row.get("currency"))


def types_by_name(catalogue: Table) -> dict[str, CatalogueType]:
    """Return the types of furniture by their names, as they are compared."""
    return {key(one.type): one for one in build_rows(CatalogueType, catalogue, "type")}


def build_floors(
    table: Table, records: Mapping[tuple[int, Axis], tuple[FloorRecord, ...]], plans: Mapping[int, FloorPlan]
) -> tuple[model.Floor, ...]:
    """Return the floors; `records` and `plans` are found by the number of their row."""
    return tuple(
        model.Floor(
            row=row.number,
            floor=row.get("floor"),
            name=row.get("name") or "",
            elevation=row.get("elevation"),
            pfa={axis: pfa for axis in AXES if (pfa := row.get(f"pfa_{axis.lower()}")) is not None},
            pfv={axis: pfv for axis in AXES if (pfv := row.get(f"pfv_{axis.lower()}")) is not None},
            records={axis: found for axis in AXES if (found := records.get((row.number, axis)))},
            plan=plans.get(row.number),
            cells={name: table.cell(name, row.number) for name in table.places},
        )
        for row in table.with_all("floor")
    )


def build_items(table: Table, types: Mapping[str, CatalogueType]) -> tuple[Item, ...]:
    """Return the items that have all they need; why others have not has been reported."""
    items = []
    kept, faulty = table.kept("items")
    for row in table.rows:
        kind, before = types.get(key(row.get("type") or "")), kept.get(row.number)
        if before and before[0] is row and before[1] == kind and row.number not in faulty:
            items.append(before[2])
            continue
        typed = _find_in_type(table, row, types, FROM_TYPE)
        values, assumed = {**row.values, **typed, **find_fixing(table, row, kind)}, [*typed]
        if "axis" not in values and (axis := turned_axis(row)):
            values["axis"] = axis
            assumed.append("axis")
        assumed += [name for name in ("quantity", "anchored") if name not in values]
        if values.keys() >= {"item", "floor", "breadth", "height"}:
            more = {name: values.pop(name) for name in [*values] if name not in _ITEM_FIELDS}
            item = Item(row=row.number, **values, assumed=tuple(assumed), extra=row.extra, more=more)
            items.append(item)
            if row.number not in faulty:
                kept[row.number] = row, kind, item
    return tuple(items)


def find_fixing(table: Table, row: Row, kind: CatalogueType | None) -> dict[str, Any]:
    """Return how a piece is fixed, and whether it stands on castors where its row leaves that blank.

    As its type of the Catalogue says, and where that leaves it blank as the built-in type of its name.
    """
    built_in = find_built_in(row.get("type") or "") or {"fix_by": "", "mobile": ""}
    found: dict[str, Any] = {"fix_by": FIX_BY.get((kind and kind.fix_by) or built_in["fix_by"], "")}
    if row.values.get("mobile") is None and not table.spoilt("mobile", row):
        is_listed = kind is not None and kind.mobile is not None
        found["mobile"] = kind.mobile if kind and is_listed else bool(built_in["mobile"]) or None
    return found


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


def leave_out(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Return the tables without faulty rows and the rows that need one of those, with warnings of the latter."""
    left = {sheet: _without_faulty(table) for sheet, table in tables.items()}
    problems: list[Problem] = []
    for sheet, names in (
        ("Places", ("floor",)), ("Routes", ("floor", "start", "end")), ("Items", ("floor", "route", "segment")),
    ):  # fmt: skip
        columns = {column.name: column.source for column in left[sheet].sheet.columns}
        for name in names:
            table = left[sheet]
            if name == "segment":
                segments = list_segments(left["Routes"])
                named = ((row, segments.get(key(row.get("route") or ""), {})) for row in table.with_all(name))
                gone = [row for row, own in named if key(row.get(name)) not in own]
            else:
                known = defined(left[columns[name]])
                gone = [row for row in table.with_all(name) if key(row.get(name)) not in known]
            by_name: dict[str, list[Row]] = {}
            for row in gone:
                by_name.setdefault(row.get(name), []).append(row)
            for text, own_rows in by_name.items():
                message = nfill(
                    "{n:,} row that names {label} {name} is left out, as the row that defines {name} has errors.",
                    "{n:,} rows that name {label} {name} are left out, as the row that defines {name} has errors.",
                    len(own_rows), label=table.label(name), name=shorten(text),
                )  # fmt: skip
                problems.append(table.problem(name, own_rows[0], message, fill("Correct that row."), "warning"))
            numbers = {row.number for row in gone}
            left[sheet] = replace(table, rows=tuple(row for row in table.rows if row.number not in numbers))
    return left, problems


def _without_faulty(table: Table) -> Table:
    """Return a table without the rows of errors; without any where its headers, or the sheet itself, are wrong.

    Of a form only the faulty values are left out, and of a row whose only errors are in `PICTURE_FIELDS` these.
    """
    if not table.failed:
        return table
    is_form = table.sheet.layout == "form"
    names = table.places.keys() if is_form else PICTURE_FIELDS & table.places.keys()
    spare = {row.number: {name for name in names if table.cell(name, row.number) in table.failed} for row in table.rows}
    faulty: set[int] = set()
    if not is_form:
        harmless = {table.cell(name, number) for number, fields in spare.items() for name in fields}
        cells = [set(row_numbers(cell)) for cell in table.failed - harmless]
        if not all(numbers & spare.keys() for numbers in cells):
            return replace(table, rows=())
        faulty = set().union(*cells)
    rows = []
    for row in table.rows:
        if row.number not in faulty:
            values = {name: value for name, value in row.values.items() if name not in spare[row.number]}
            rows.append(replace(row, values=values) if spare[row.number] else row)
    return replace(table, rows=tuple(rows))


def correct_names(tables: Tables) -> tuple[Tables, list[Problem]]:
    """Return the tables with corrections of names of other sheets, and notes; letter case alone is no difference."""
    found: dict[str, Table] = {}
    notes: list[Problem] = []
    for sheet, table in tables.items():
        corrections: list[Correction] = []
        for column in table.sheet.columns:
            if not column.source or column.name not in table.places:
                continue
            known = defined(tables[column.source])
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
        found[sheet] = replace(table, corrections=(*table.corrections, *corrections)) if corrections else table
    return found, notes
