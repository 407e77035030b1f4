"""Rows to problems: names, floors, the catalogue and the furniture. What concerns routes is in `check_routes`.

A check is a pure function: it takes the tables and yields what does not fit together. `run_checks` runs them in order
and notes the cells of errors, so that what has been reported once is not reported again as something else.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice

from assess.details import ALTERNATIVES, CHECK, DETAILS, find_detail, says_castors
from assess.errors import Gap, Problem
from assess.i18n import Text, fill, join, nfill
from assess.model import AXES, MEASURED, CatalogueType
from assess.motion.assumed import find_lowest_number, find_storey
from assess.units import ROUNDING
from assess.workbook.habits import shorten
from assess.workbook.names import find_near_name, key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import defined, filled_sizes, find_fixing, name_currencies, turned_axis, types_by_name
from assess.workbook.schema import SHAKEN

Check = Callable[[Tables], Iterable[Problem]]
_LIKE = 2.0
"""Ratio up to which a size is like that of its Type [-]."""


def run_checks(tables: Tables, checks: Sequence[Check]) -> tuple[Tables, list[Problem]]:
    """Run checks in order; return the tables with the cells of errors noted, and the problems."""
    problems: list[Problem] = []
    for check in checks:
        found = list(check(tables))
        problems += found
        tables = {sheet: table.with_failed(found) for sheet, table in tables.items()}
    return tables, problems


def duplicates(table: Table, *names: str) -> Iterator[tuple[Row, Row]]:
    """Yield every row whose fields another row above it has alike, and the first such row."""
    first: dict[tuple[str, ...], Row] = {}
    for row in table.with_all(*names):
        before = first.setdefault(tuple(key(row.get(name)) for name in names), row)
        if before is not row:
            yield row, before


def check_unique(table: Table, *, is_looked_up: bool = False) -> Iterator[Problem]:
    """Report every name that is defined twice, and warn of those that look-ups of spreadsheets take for patterns."""
    name = table.sheet.columns[0].name
    for row, before in duplicates(table, name):
        message = fill("duplicate {label} {name}, also in {cell}.", label=table.label(name), name=row.quote(name),
                       cell=table.cell(name, before.number))  # fmt: skip
        yield table.problem(name, row, message, fill("Give each its own name."))
    for row in table.with_all(name) if is_looked_up else ():
        if any(sign in row.get(name) for sign in "*?~"):
            values = {"column": fill(table.label(name)), "name": row.quote(name)}
            message = fill("{column} {name} holds *, ? or ~, which Excel's look-ups read as patterns.", **values)
            fix = fill("Rename it: the live columns may show another row's values.")
            yield table.problem(name, row, message, fix, "warning")


def check_references(table: Table, tables: Tables) -> Iterator[Problem]:
    """Report names that the first column of another sheet does not define.

    A missing column, or a missing sheet that is required, has been reported; a sheet that is not is reported here,
    once for the whole column. The Type of a piece whose row has its sizes is only warned of.
    """
    for column in table.sheet.columns:
        if not column.source:
            continue
        name, source, named = column.name, tables[column.source], table.with_all(column.name)
        if source.found and source.sheet.columns[0].name in source.places:
            known = defined(source)
            unknown = [row for row in named if key(row.get(name)) not in known]
            slips = {key(row.get(name)) for row in unknown}
            near = {slip: known.get(find_near_name(slip, known) or "") for slip in slips}
            for row in unknown:
                values = {"label": table.label(name), "name": row.quote(name), "sheet": source.sheet.name}
                fix = fill("Choose one of the {sheet} sheet, or add it there.", **values)
                if meant := near[key(row.get(name))]:
                    values["near"] = meant
                    fix = fill("Choose one of the {sheet} sheet, or add it there. Did you mean {near}?", **values)
                if not _has_own_sizes(table, name, row):
                    yield table.habit(name, row, fill("{label} {name} is not in the {sheet} sheet.", **values), fix)
                    continue
                values["label"] = fill(table.label(name))
                message = fill(
                    "{label} {name} is not in the {sheet} sheet; the sizes typed in its row are used.", **values
                )
                yield table.habit(name, row, message, fix, "warning")
        elif not source.found and not source.sheet.required:
            for is_spare in (False, True):
                if rows := [row for row in named if _has_own_sizes(table, name, row) is is_spare]:
                    yield _report_no_sheet(table, name, rows, source.sheet.name, is_spare=is_spare)


def _has_own_sizes(table: Table, name: str, row: Row) -> bool:
    """Tell whether a row does without what its type would give: the width counts where the piece may block a route."""
    if name != "type":
        return False
    may_block = table.says(row, "x", "y", "route", "edge_distance")
    return all(table.says(row, size) for size in ("breadth", "height", *(["width"] if may_block else ())))


def _report_no_sheet(table: Table, name: str, named: Sequence[Row], sheet: str, *, is_spare: bool) -> Problem:
    values = {"label": fill(table.label(name)) if is_spare else table.label(name)}
    values |= {"name": named[0].quote(name), "sheet": sheet}
    message = nfill("{label} {name} is named, but there is no {sheet} sheet.",
                    "{label} {name} and others are named in {n:,} rows, but there is no {sheet} sheet.", len(named),
                    **values)  # fmt: skip
    if is_spare:
        message = nfill(
            "{label} {name} is named, but there is no {sheet} sheet; the sizes typed in its row are used.",
            "{label} {name} and others are named in {n:,} rows, but there is no {sheet} sheet; the sizes typed in "
            "those rows are used.",
            len(named), **values,
        )  # fmt: skip
    fix = fill("Add the sheet, or clear the column.")
    return table.problem(name, named[0], message, fix, "warning" if is_spare else "error")


def check_catalogue(tables: Tables) -> Iterator[Problem]:
    """Check the types of furniture."""
    table = tables["Catalogue"]
    yield from check_unique(table, is_looked_up=True)
    for row in table.rows:
        yield from _check_plan_sides(table, row, row.get("breadth"), row.get("width"))


def check_costs(tables: Tables) -> Iterator[Problem]:
    """Check that each detail has one cost in one currency, and is one that the schedule prices."""
    table = tables["Costs"]
    yield from check_unique(table)
    yield from _check_currencies(table)
    found: dict[str, Row] = {}
    for row in table.with_all("detail"):
        detail = find_detail(row.get("detail"))
        before = found.setdefault(detail.key if detail else "", row)
        if detail is None:
            listed = join(", ", [one.title for one in DETAILS.values()])
            message = fill(
                "Detail {name} is not a known way of fixing: its cost is left out.", name=row.quote("detail")
            )
            yield table.problem("detail", row, message, fill("Choose one of: {listed}", listed=listed), "warning")
        elif before is not row and key(before.get("detail")) != key(row.get("detail")):  # which is a duplicate already
            cell = table.cell("detail", before.number)
            message = fill("Detail {name} is the same as that in {cell}.", name=row.quote("detail"), cell=cell)
            yield table.problem("detail", row, message, fill("Give each detail one cost."))
        elif row.get("per") == "fixing" and not (detail.least and detail.key != CHECK):
            message = fill("No fixing is counted for detail {name}, so that it cannot be priced by fixing.",
                           name=row.quote("detail"))  # fmt: skip
            yield table.problem("per", row, message, fill("Give the cost of one piece."))
        elif detail.key in ALTERNATIVES and row.get("unit_cost") is not None:
            message = fill("Detail {name} is an alternative, which the schedule does not price: its cost is left out.",
                           name=row.quote("detail"))  # fmt: skip
            priced = join(", ", [one.title for one in DETAILS.values() if one.key not in ALTERNATIVES])
            fix = fill("The schedule prices these: {priced}.", priced=priced)
            yield table.problem("detail", row, message, fix, "warning")


def _check_currencies(table: Table) -> Iterator[Problem]:
    """Report currencies that are unknown, named twice in a row, or different: their sum would mean nothing."""
    first: tuple[str, str] | None = None
    for row in table.rows:
        codes = list(name_currencies(row))
        in_cell = "currency" if row.get("currency") else "unit_cost"
        values = {"text": row.quote("currency"), "label": table.label("currency"), "cost": table.label("unit_cost")}
        if "" in codes:
            fix = fill("Write its ISO code, such as EUR.")
            yield table.problem("currency", row, fill("{label} {text} is not a known currency.", **values), fix)
        elif len({*codes}) > 1:
            message = fill("{cost} is in {one}, but {label} is {other}.", one=codes[0], other=codes[1], **values)
            yield table.problem("unit_cost", row, message, fill("Write the currency once."))
        elif codes and first and codes[0] != first[0]:
            message = fill("the currency is {one}, but {other} in {cell}: costs in two currencies have no sum.",
                           one=codes[0], other=first[0], cell=first[1])  # fmt: skip
            yield table.problem(in_cell, row, message, fill("Convert all costs to one currency."))
        elif codes:
            first = first or (codes[0], table.cell(in_cell, row.number))


def check_anchor_code(tables: Tables, *, is_shaken: bool = False) -> Iterator[Problem]:
    """Report a code of anchors without a ground motion; `is_shaken`: whether the run gives that of the ground."""
    table = tables["Building"]
    for row in table.with_all("anchor_code"):
        if not (is_shaken or any(table.says(row, name) for name in SHAKEN if name != "ground_pgv")):
            message = fill("{label} is {code}, but no ground motion is known to which the code applies.",
                           label=table.label("anchor_code"), code=row.get("anchor_code"))  # fmt: skip
            names = [table.label(name) for name in ("sds", "ground_pga", "anchor_code")]
            fix = fill("Fill in {sds} or {pga}, or clear {code}.", sds=names[0], pga=names[1], code=names[2])
            yield table.problem("anchor_code", row, message, fix)


def check_floors(tables: Tables, *, is_shaken: bool = False) -> Iterator[Problem]:
    """Check the names of the floors, and that something tells how each shakes, whatever the scenario.

    A motion at grade serves all floors, one above it only those of known height. `is_shaken`: whether the ground's
    motion is given for the run.
    """
    table, building = tables["Floors"], tables["Building"]
    yield from check_unique(table, is_looked_up=True)
    if is_shaken or any(building.says(row, *SHAKEN) for row in building.rows):  # be it usable or not
        return
    rows = table.with_all("floor")
    levels: dict[int, float | None] = {row.number: row.get("elevation") for row in rows}
    has_storeys = any(building.says(row, "storeys") for row in building.rows)
    if has_storeys and not any(table.spoilt("elevation", row) for row in rows):
        lowest = find_lowest_number((row.get("floor"), row.get("elevation")) for row in rows)
        numbers = {row.number: find_storey(row.get("floor")) for row in rows if levels[row.number] is None}
        if lowest is not None:
            levels |= {at: None if number is None else number - lowest for at, number in numbers.items()}
    known = [row for row in rows if table.says(row, "pfa_x", "pfa_y", "record_x", "record_y")]
    heights = [level for row in known if (level := levels[row.number]) is not None]
    if min(heights, default=1.0) <= 0 or any(table.spoilt("elevation", row) for row in known):
        return
    for row in rows:
        level = levels[row.number]
        if row in known or (level is None and table.spoilt("elevation", row)):
            continue
        if level is None or not heights:
            message, fix = describe_unserved(row.quote("floor"), has_elevation=level is not None)
            found = table.problem("pfa_x" if "pfa_x" in table.places else "floor", row, message, fix)
            yield Gap(found.severity, found.sheet, found.cell, found.message, found.fix)


def describe_unserved(floor: str, *, has_elevation: bool) -> tuple[Text, Text]:
    """Return that the motion of a floor, its name in quotes, is not known, and what would give it."""
    message = fill(
        "floor {floor} has neither a record nor a PFA, no Elevation by which its motion follows from other floors, "
        "and Building gives neither Ground PGA nor Ground PGV nor SDS nor a ShakeMap file nor Shaking.",
        floor=floor,
    )
    if has_elevation:
        message = fill(
            "floor {floor} has neither a record nor a PFA, no other floor has one and an Elevation, and Building gives "
            "neither Ground PGA nor Ground PGV nor SDS nor a ShakeMap file nor Shaking.",
            floor=floor,
        )
    fix = fill("Fill in PFA X or PFA Y, or name a record; or fill in Ground PGA, or choose Shaking, in Building.")
    return message, fix


def check_velocities(tables: Tables) -> Iterator[Problem]:
    """Report a PFV that would not be used: the floor may shake more than its PFA says."""
    table = tables["Floors"]
    for row in table.with_all("floor"):
        for axis in AXES:
            pfa, pfv, record = (f"{what}_{axis.lower()}" for what in ("pfa", "pfv", "record"))
            if row.get(pfv) is not None and not table.says(row, pfa, record):
                message = fill("PFV {axis} is filled in without PFA {axis} and would not be used.", axis=axis)
                yield table.habit(pfv, row, message, fill("Fill in PFA {axis}, or clear PFV {axis}.", axis=axis))


def check_item_names(tables: Tables) -> Iterator[Problem]:
    """Check that items have names of their own, a floor that is there, and a type and a route that are."""
    table = tables["Items"]
    yield from check_unique(table)
    yield from check_references(table, tables)


def check_items(tables: Tables) -> Iterator[Problem]:
    """Check each piece by itself: its sizes, its position, its axis."""
    table = tables["Items"]
    types = types_by_name(tables["Catalogue"])
    lacking: dict[str, list[Row]] = {}
    is_listed = tables["Catalogue"].found
    kept, faulty = table.kept("check")
    for row in table.rows:
        kind = types.get(key(row.get("type") or ""))
        before = kept.get(row.number)
        if before and before[0] is row and before[1] == (kind, is_listed) and row.number not in faulty:
            yield from before[2]
            continue
        sizes = filled_sizes(table, row, types)
        blank = [name for name in ("breadth", "height") if name not in sizes and not table.spoilt(name, row)]
        for name in (one for one in blank if one not in table.places):
            lacking.setdefault(name, []).append(row)  # reported once for the column, not in every row
        found = [*_check_blank(table, row, [one for one in blank if one in table.places], is_listed=is_listed)]
        found += [*_check_sizes(table, row, sizes, kind), *_check_item(table, row, sizes)]
        found += _ask_if_mobile(table, row, kind)
        if row.number not in faulty and not lacking:
            kept[row.number] = row, (kind, is_listed), found
        yield from found
    for name, rows in lacking.items():
        message = nfill(
            "the column {header} is missing, and row {row} has no Type that gives it.",
            "the column {header} is missing, and {n:,} rows, from row {row} on, have no Type that gives it.",
            len(rows), header=table.sheet.column(name).header(), row=str(rows[0].number),
        )  # fmt: skip
        yield table.problem_at_top(message, fill("Add the column, or give those rows such a Type."))


def _ask_if_mobile(table: Table, row: Row, kind: CatalogueType | None) -> Iterator[Problem]:
    """Ask whether a piece rolls that says so in words, where no Mobile tells."""
    if not table.spoilt("mobile", row) and find_fixing(table, row, kind).get("mobile", True) is None:
        named = (name for name in ("notes", "description", "type") if says_castors(row.get(name) or ""))
        for name in islice(named, 1):
            values = {"label": table.label(name), "mobile": table.sheet.column("mobile").label}
            message = fill(
                "{label} says that it stands on castors, and {mobile} does not say whether it rolls.", **values
            )
            yield table.habit(name, row, message, fill("Fill in {mobile}: yes or no.", **values), "note")


def _check_blank(table: Table, row: Row, names: Iterable[str], *, is_listed: bool) -> Iterator[Problem]:
    """Report sizes that are blank and that no type gives, unless the type has been reported."""
    if table.spoilt("type", row) or not (is_listed or row.get("type") is None):
        return
    for name in names:
        values = {"label": table.label(name), "type": table.label("type")}
        message = fill("{label} is blank and no {type} gives it.", **values)
        yield table.habit(name, row, message, fill("Fill it in, or choose a {type} that has one.", **values))


def _check_item(table: Table, row: Row, sizes: dict[str, float]) -> Iterator[Problem]:
    """Check the position of a piece, its axis, its bracket, and the width by which it may block a route."""
    x, y, quantity = (row.get(name) for name in ("x", "y", "quantity"))
    if (x is not None or y is not None) and (quantity or 1) > 1:
        message = fill(
            "{label} is {quantity} on a row with a position.", label=table.label("quantity"), quantity=quantity
        )
        yield table.habit("quantity", row, message, fill("Write one row a piece, or clear X and Y."))
    if (x is None) != (y is None) and not (table.spoilt("x", row) or table.spoilt("y", row)):
        fix = fill("Fill in the other, or clear both.")
        yield table.habit("y" if y is None else "x", row, fill("a position needs both X and Y."), fix, "warning")
    axis, turned = row.get("axis"), turned_axis(row)
    if axis is not None and turned is not None and axis != turned:
        values = {"axis": axis, "angle": row.get("angle_deg"), "turned": turned}
        message = fill("Axis is {axis}, but an Angle of {angle:g} deg lies along {turned}; {axis} is used.", **values)
        yield table.habit("axis", row, message, fill("Correct one of the two."), "warning")
    at, height = row.get("bracket_height"), sizes.get("height")
    if at is not None and height is not None and at > height * (1 + ROUNDING):
        message = fill("{label} {at:g} cm is greater than {other} {height:g} cm.", label=table.label("bracket_height"),
                       at=at * 100, other=table.label("height"), height=height * 100)  # fmt: skip
        yield table.habit("bracket_height", row, message, fill("A bracket holds a piece at its top or below."))
    given = next((name for name in ("bracket_height", "bracket_capacity") if row.get(name) is not None), None)
    if given is not None and row.get("anchored") == "no":
        values = {"label": table.label(given), "anchored": table.label("anchored")}
        message = fill("{label} is given, but {anchored} is no.", **values)
        fix = fill("Set {anchored} to yes or partly, or clear {label}.", **values)
        yield table.habit(given, row, message, fix, "warning")
    is_known = "width" in sizes or table.spoilt("width", row) or table.spoilt("type", row)
    if not is_known and table.says(row, "x", "y", "route"):
        label, kind, breadth = (fill(table.label(name)) for name in ("width", "type", "breadth"))
        message = fill(
            "{label} is blank and no {type} gives it: the piece is taken as wide as its {breadth}, so the area that it "
            "may cover can be too small.",
            label=label, type=kind, breadth=breadth,
        )  # fmt: skip
        fix = fill("Fill it in, or choose a {type} that has one.", type=kind)
        yield table.habit("width", row, message, fix, "warning")


def _check_plan_sides(table: Table, row: Row, breadth: float | None, width: float | None) -> Iterator[Problem]:
    if breadth is not None and width is not None and breadth > width * (1 + ROUNDING):
        label = table.label("breadth")
        message = fill("{label} {breadth:g} cm is greater than {other} {width:g} cm.", label=label,
                       breadth=breadth * 100, other=table.label("width"), width=width * 100)  # fmt: skip
        fix = fill("{label} is the shorter plan side: exchange the two.", label=label)
        yield table.habit("breadth", row, message, fix)


def _check_sizes(table: Table, row: Row, sizes: dict[str, float], kind: CatalogueType | None) -> Iterator[Problem]:
    breadth, height = sizes.get("breadth"), sizes.get("height")
    yield from _check_plan_sides(table, row, breadth, sizes.get("width"))
    is_typed = row.get("sizes_from") in (None, MEASURED)  # nobody exchanges the sizes of shapes
    if is_typed and breadth is not None and height is not None and breadth > height * (1 + ROUNDING):
        values = {"breadth": breadth * 100, "height": height * 100}
        message = fill("Breadth {breadth:g} cm is greater than Height {height:g} cm.", **values)
        if kind is None or kind.breadth is None or kind.height is None:
            yield table.habit("breadth", row, message, fill("Are the two exchanged?"), "warning")
            return
        exchanged = ((breadth, kind.height), (height, kind.breadth))
        is_like = all(usual / _LIKE <= size <= usual * _LIKE for size, usual in exchanged)
        if is_like and kind.breadth < kind.height:
            sides = {"breadth": kind.breadth * 100, "height": kind.height * 100}
            fix = fill("Its Type is {breadth:g} cm deep and {height:g} cm high: exchange the two.", **sides)
            yield table.habit("breadth", row, message, fix)


def check_source_ids(tables: Tables) -> Iterator[Problem]:
    """Warn of pieces that have the Source ID of another: of a row that was copied."""
    table = tables["Items"]
    first: dict[str, Row] = {}
    for row in table.with_all("source_id"):
        own = row.get("source_id").strip()
        other = first.setdefault(own, row)
        if other is not row:
            message = fill("{label} {id} is that of row {row}, too.", label=table.label("source_id"), id=shorten(own),
                           row=other.number)  # fmt: skip
            fix = fill("Clear it where the row was copied: which of the two is in the model is not known.")
            yield table.habit("source_id", row, message, fix, "warning")
