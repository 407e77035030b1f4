"""The ground motion of a building: by the ShakeMap that its workbook names, or by one that is given for the run."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from assess.errors import InputError, Problem
from assess.i18n import fill, join, nfill
from assess.motion.site_ground import GroundField, SiteGround
from assess.workbook.parse import CodeCells, Row, Table, Tables, parse_sheet
from assess.workbook.schema import BUILDING

STRONGER = ("ground_pga", "sds")
"""Fields of Building that come before its ShakeMap."""
REPLACED = ("ground_pga", "sds", "ground_pgv", "shakemap", "shaking")
"""Fields of Building whose place a ground motion of the run takes."""
SHAKEN = ("ground_pga", "ground_pgv", "sds", "shakemap", "shaking")
"""Fields of Building that tell how the ground shakes; any one will do."""


def fill_building(
    tables: Tables, problems: list[Problem], given: Mapping[str, Any] | None
) -> tuple[Tables, list[Problem]]:
    """Return the tables with the blanks of Building filled in, and all problems.

    `tables` and `problems`: as read from the workbook.
    `given`: values by field or header, as in rows in code. Those of lines that the workbook fills in are not used.
    """
    if not given:
        return tables, problems
    own = tables[BUILDING.name]
    new, found = parse_sheet(BUILDING, own.sheet, own.language, CodeCells(BUILDING, [given]))
    row = own.rows[0] if own.rows else Row(0, {})
    unused = {name for name in new.places if own.says(row, name)}
    cells = {new.cell(name, 0) for name in unused}
    new_ones = [one for one in found if one.cell not in cells]
    of_index = (replace(one, message=fill("of the index: {message}", message=one.message)) for one in new_ones)
    problems = [*problems, *of_index]
    values = {name: value for name, value in new.rows[0].values.items() if name not in unused}
    if not values:
        return tables, problems
    labels = join(", ", [own.label(name) for name in values])
    note = nfill(
        "{labels} is blank in the workbook: the value comes from the index.",
        "{labels} are blank in the workbook: the values come from the index.",
        len(values),
        labels=labels,
    )
    problems.append(Problem("note", own.sheet.name, "", note))
    base = own if own.rows else replace(new, places={}, rows=(row,))
    filled = replace(base, rows=(replace(row, values={**row.values, **values}),))
    return {**tables, BUILDING.name: filled}, problems


def replace_ground(tables: Tables, ground: GroundField) -> tuple[Tables, list[Problem]]:
    """Return the tables without the ground motion that the workbook fills in, and a note on what is not used."""
    table = tables[BUILDING.name]
    row = table.rows[0] if table.rows else Row(0, {})
    filled = [name for name in REPLACED if row.get(name) is not None]
    cleared = replace(row, values={name: value for name, value in row.values.items() if name not in REPLACED})
    notes = []
    if filled:
        message = nfill(
            "{labels} is not used: the ground motion of {file} takes its place.",
            "{labels} are not used: the ground motion of {file} takes their place.",
            len(filled),
            labels=join(", ", [table.label(name) for name in filled]),
            file=ground.file,
        )
        notes = [table.problem(filled[0], row, message, severity="note")]
    return {**tables, BUILDING.name: replace(table, rows=(cleared,))}, notes


class GroundReader:
    """Finds how the ground shakes at the building, and checks it as the functions of `check` do.

    `name`: the field of Building that asks for it; "" where the run does.
    """

    def __init__(self, ground: GroundField, name: str = "") -> None:
        self.ground, self.name = ground, name
        self.found: SiteGround | None = None

    def check(self, tables: Tables) -> Iterator[Problem]:
        """Find the motion at the building, or report why that is not known."""
        table = tables[BUILDING.name]
        row = table.rows[0] if table.rows else Row(0, {})
        if table.spoilt("latitude", row) or table.spoilt("longitude", row):
            return
        place = row.get("latitude"), row.get("longitude")
        if place[0] is None or place[1] is None:
            yield _report_no_place(table, row, self.name, self.ground.file)
            return
        try:
            self.found = self.ground.at(*place)
        except InputError as error:
            fix = fill("Correct Latitude and Longitude, or name a ground motion that covers the building.")
            message = fill("no ground motion at the building: {why}.", why=error.message)
            yield table.problem(self.name or "latitude", row, message, fix)


def report_unplaced(table: Table, row: Row) -> Iterator[Problem]:
    """Report that a ShakeMap is named without the place of the building, unless that was reported already."""
    lacking = [name for name in ("latitude", "longitude") if table.lacks(row, name)]
    if len(lacking) == 2:  # of one alone the other was reported
        yield _report_no_place(table, row, "shakemap", row.get("shakemap"))


def _report_no_place(table: Table, row: Row, name: str, file: str) -> Problem:
    lacking = [one for one in ("latitude", "longitude") if row.get(one) is None]
    cells = [cell for one in lacking if re.fullmatch(r"[A-Z]+\d+", cell := table.cell(one, row.number))]
    message = nfill(
        "{labels} is blank; the ground motion of {file} needs the building's place.",
        "{labels} are blank; the ground motion of {file} needs the building's place.",
        len(lacking),
        labels=join(", ", [table.label(one) for one in lacking]),
        file=file,
    )
    fix = fill("Fill in Latitude and Longitude.")
    if cells:
        fix = fill("Fill in Latitude and Longitude (cells {cells}).", cells=", ".join(cells))
    return table.problem(name if name in table.places else lacking[0], row, message, fix)
