"""The sheet Lists: what the drop-downs and the live columns of the other sheets refer to.

It holds the choices, the factor that each header's bracket stands for, for every row of Floors the PFA and PFV that
serve each axis, and for every row of the Catalogue the sizes of the type. Names stand there without stray spaces, so
that a name in Items is found however both were typed. What is no number, or lies outside the range that the program
takes, is shown as `WRONG` and never computed with: Excel takes the text 40,5 for 405 where the comma groups thousands.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.model import ANCHORED, SCANNED, SIZES_FROM
from assess.rocking.block import MIDDLE
from assess.units import ALIASES, GRAVITY, QUANTITIES
from assess.workbook import formulas as live
from assess.workbook import live_ground
from assess.workbook.formulas import list_words, trim
from assess.workbook.schema import BUILDING, CATALOGUE, CLASS, FLOORS, ITEMS, LISTS, LIVE, SHEETS, WORKINGS, YES, Sheet

FROZEN = {ITEMS.name: 2}
"""Columns that stay in view while a table is scrolled; one where a sheet is not named."""


def list_columns(sheet: Sheet) -> list[str]:
    """Return the columns of a sheet from the left: the field of each to fill in, the label of each that is computed."""
    return list(_order(sheet))


def _order(sheet: Sheet) -> Iterator[str]:
    first, *others = (column.name for column in sheet.columns)
    yield first
    if sheet is ITEMS:
        others = [CLASS, *others, *(label for label in LIVE if label != CLASS), *WORKINGS]
    yield from others


PLACES = {(sheet.name, name): at for sheet in SHEETS for at, name in enumerate(list_columns(sheet))}
"""Column, from 0, in which the workbook has a field or a column that is computed; of a form, the line."""

LETTERS = {where: xl_col_to_name(at) for where, at in PLACES.items()}
"""The same as letters."""


Units = Literal["si", "imperial"]

LISTS_NOTE = "Lists, units and helper columns for the drop-downs and live columns. Please leave this sheet as it is."

ROWS = {"Floors": 100, "Items": 200, "Places": 200, "Routes": 200, "Catalogue": 200, "Costs": 50}
"""Rows of each table that are prepared; a longer table is read all the same."""

RUN_ASSESS = "run assess"
"""What the live columns say of a floor whose motion only the program computes: from a record, by interpolation, or by a
code's profile."""

NO_SHAKING = "shaking?"
"""What they say of a floor that nothing serves: `assess run` would name it in an error."""

NO_UNIT = "unit?"
"""What they say where the bracket of a header holds no unit that is known."""

WRONG = "check"
"""What they say where a cell holds no number, or one that the program refuses."""

LISTED = ("length", "acceleration", "velocity", "time", "share")
"""Quantities of which the sheet holds the units."""

_NEEDED_FACTORS = (
    ("Items", "breadth"), ("Items", "height"), ("Catalogue", "breadth"), ("Catalogue", "height"),
    ("Items", "width"), ("Catalogue", "width"),
    ("Floors", "pfa_x"), ("Floors", "pfa_y"), ("Floors", "pfv_x"), ("Floors", "pfv_y"), ("Building", "period"),
    ("Building", "ground_pga"), ("Building", "ground_pgv"), ("Building", "sds"), ("Building", "height"),
    ("Floors", "elevation"),
    ("Items", "centre_of_gravity"), ("Catalogue", "centre_of_gravity"),
)  # fmt: skip

_OWN_SCENARIOS = {"asfilled": "as filled", "recorded": "recorded", "given": "given"}
"""Scenarios that floors' own values serve, by how choices are compared."""

_SCENARIO_NAMES = ("scenario_typed", "scenario_kind", "scenario_is_own")

_TYPE_SIZES, CENTRE = ("breadth", "width", "height"), "centre_of_gravity"

_PREFIXES = {"Floors": "floor", "Catalogue": "type"}
"""First words of the names of helper columns."""

_TYPED = {
    "Floors": ("floor", "elevation", "pfa_x", "pfa_y", "pfv_x", "pfv_y", "record_x", "record_y"),
    "Catalogue": ("type", *_TYPE_SIZES, CENTRE),
}
"""Fields of which a helper column is computed; their columns are named after them."""

_WriteRow = Callable[[int, Mapping[str, str]], Iterator[str]]
"""Gives the formulas of one row by its number and the cells that they are written to."""

_FLOOR_HELPERS = (
    "key", "own_pfa_x", "own_pfa_y", "own_pfv_x", "own_pfv_y", *live_ground.HELPERS, *live_ground.SERVED, "hint",
    "pfa_x", "pfa_y", "pfv_x", "pfv_y", "best",
)  # fmt: skip
"""Columns of the sheet for a row of Floors: its name, its own motion by axis, what follows from the ground, what it
shows if it has neither, and what serves each axis."""

_TYPE_HELPERS = ("key", *_TYPE_SIZES, CENTRE)
"""Columns of the sheet for a row of the Catalogue: its name, its sizes [cm], and its centre of gravity [-]."""


@dataclass(frozen=True, slots=True)
class ListsWriter:
    """Writes the sheet and defines its names; `last` tells the last row of each table."""

    book: Any
    page: Any
    title: Any
    units: Units
    last: Mapping[str, int]

    def write(self) -> None:
        """Write everything, one block beside the other."""
        self.page.write_string(0, 0, gettext(LISTS_NOTE), self.title)
        at = live_ground.write_shakings(self.book, self.page, self._write_choices() + 1)
        at = live_ground.write_table(self.book, self.page, at + 1)
        at = self._write_units(at + 1)
        at = self._write_factors(at + 1)
        at = self._write_nodes(at + 1)
        at = self._write_rows(at + 1, "Floors", _FLOOR_HELPERS, self._of_floor)
        self._write_rows(at + 1, "Catalogue", _TYPE_HELPERS, self._of_type)
        for name in ("Floors", "Catalogue", "Places", "Routes"):
            self._name(f"list_{name.lower()}", name, "A", 2, self.last[name])

    def _name(self, name: str, sheet: str, column: str, first: int, last: int) -> None:
        self.book.define_name(name, f"={gettext(sheet)}!${column}${first}:${column}${last}")

    def _define(self, name: str, at: int, row: int, label: str, formula: str, value: Any) -> None:
        self.page.write_string(row - 1, at, label)
        self.page.write_formula(row - 1, at + 1, formula, None, value)
        self.book.define_name(name, f"={gettext(LISTS)}!${xl_col_to_name(at + 1)}${row}")

    def _write_choices(self) -> int:
        chosen = {one.name: one for sheet in SHEETS for one in sheet.columns if one.choices or one.offered}
        for at, (name, column) in enumerate(chosen.items()):
            listed = column.choices or column.offered
            self.page.write_column(2, at, [gettext(text) for text in (column.label, *listed)])
            self._name(f"list_{name}", LISTS, xl_col_to_name(at), 4, 3 + len(listed))
        return len(chosen)

    def _write_units(self, at: int) -> int:
        for quantity in LISTED:
            units = dict(QUANTITIES[quantity])
            units |= {other: units[unit] for other, unit in ALIASES.items() if unit in units}
            self.page.write_column(2, at, (gettext(quantity), *units))
            self.page.write_column(2, at + 1, ("SI", *units.values()))
            first, second = xl_col_to_name(at), xl_col_to_name(at + 1)
            self.book.define_name(f"units_{quantity}", f"={gettext(LISTS)}!${first}$4:${second}${3 + len(units)}")
            at += 2
        return at

    def _write_factors(self, at: int) -> int:
        """Write the factor of every header that a live formula needs, read from the header's own bracket."""
        self.page.write_row(2, at, (gettext("header"), gettext("factor")))
        for row, (name, field) in enumerate(_NEEDED_FACTORS, 4):
            sheet = next(sheet for sheet in SHEETS if sheet.name == name)
            column = sheet.column(field)
            at_head = f"$A${_line(field)}" if sheet.layout == "form" else f"{LETTERS[name, field]}$1"
            cell = f"{gettext(name)}!{at_head}"
            start = f'FIND("[",{cell})'
            unit = f'LOWER(SUBSTITUTE(MID({cell},{start}+1,FIND("]",{cell})-{start}-1)," ",""))'
            factor = QUANTITIES[column.quantity][column.header(self.units).partition("[")[2].rstrip("]")]
            formula = f'=IFERROR(VLOOKUP({unit},units_{column.quantity},2,FALSE),"{gettext(NO_UNIT)}")'
            label = f"{gettext(name)}: {gettext(column.label)}"
            self._define(f"unit_{name.lower()}_{field}", at, row, label, formula, factor)
        row = len(_NEEDED_FACTORS) + 4
        # What the live columns say where a header of a size has no known unit.
        sizes = (f"unit_{sheet}_{name}" for sheet in ("items", "catalogue") for name in ("breadth", "height"))
        formula = f'=IF(OR({",".join(f"ISTEXT({size})" for size in sizes)}),"{gettext(NO_UNIT)}","")'
        self._define("sizes_unit", at, row, gettext("unknown unit of a size"), formula, "")
        self._write_words(row + 1, at)
        self._write_scenario(row + 3, at)
        self._write_ground(row + 3 + len(_SCENARIO_NAMES), at)
        return at + 2

    def _write_nodes(self, at: int) -> int:
        """Write what a floor has of the ground's PFA and PFV at each z/h of the table, by axis."""
        for axis in "xy":
            every = list(live_ground.list_nodes(axis))
            half = len(every) // 2
            for peak, formulas in (("a", every[:half]), ("v", every[half:])):
                name, letter = f"nodes_{axis}_{peak}", xl_col_to_name(at)
                self.page.write_string(2, at, name)
                for row, formula in enumerate(formulas, 3):
                    self.page.write_formula(row, at, f"={formula}", None, "")
                self.book.define_name(name, f"={gettext(LISTS)}!${letter}$4:${letter}${3 + half}")
                at += 1
        return at

    def _write_words(self, row: int, at: int) -> None:
        lists = ("anchored_words", gettext("words for anchored"), ANCHORED, YES), (
            "scanned_words", gettext("words for sizes by a scan"), SIZES_FROM, SCANNED
        )  # fmt: skip
        for number, (name, label, choices, choice) in enumerate(lists):
            words = list_words(choices, choice)
            self._define(name, at, row + number, label, f'="{words}"', words)

    def _write_scenario(self, row: int, at: int) -> None:
        """Write the kind of scenario as choices are compared, and whether floors' own values serve it."""
        plain = f"LOWER({gettext(BUILDING.name)}!$B${_line('scenario_kind')})"
        for sign in (" ", "\u00a0", "-", "_"):
            plain = f'SUBSTITUTE({plain},"{sign}","")'
        typed, kind = (f"${xl_col_to_name(at + 1)}${row + line}" for line in range(2))
        own = ",".join(f'{kind}="{one}"' for one in ("", *_OWN_SCENARIOS))
        formulas = (plain, _in_english(typed), f"IF(OR({own}),1,0)")
        for line, (label, formula) in enumerate(zip(_SCENARIO_NAMES, formulas, strict=True), row):
            self._define(label, at, line, label, f"={formula}", 1 if formula is formulas[-1] else "")

    def _write_ground(self, row: int, at: int) -> None:
        fields = (
            "ground_pga", "ground_pgv", "sds", "shakemap", "shaking", "height", "storeys", "period", "structure",
            "motion_uncertainty", "class_by",
        )  # fmt: skip
        building = {name: f"{gettext(BUILDING.name)}!$B${_line(name)}" for name in fields}
        words = (f'"{gettext(one)}"' for one in (RUN_ASSESS, WRONG))
        for line, (name, formula) in enumerate(live_ground.list_names(building, *words), row):
            self._define(name, at, line, name, f"={formula}", "")

    # ------------------------------------------------------------------ rows of Floors and of the Catalogue

    def _write_rows(self, at: int, sheet: str, names: Sequence[str], write: _WriteRow) -> int:
        """Write the helper columns of a table from column `at`; those of a row stand in the row of the same number.

        The names that are defined begin in row 1, so that what is found is the number of the row. The header of the
        keys stays blank: it would be found as a name.
        """
        letters = {name: xl_col_to_name(at + place) for place, name in enumerate(names)}
        last = self.last[sheet]
        self.page.write_row(0, at + 1, [f"{_PREFIXES[sheet]}_{name}" for name in names[1:]])
        for row in range(2, last + 1):
            cells = {name: f"${letter}{row}" for name, letter in letters.items()}
            for place, formula in enumerate(write(row, cells)):
                self.page.write_formula(row - 1, at + place, f"={formula}", None, "")
        for name, letter in letters.items():
            self._name(f"{_PREFIXES[sheet]}_{name}", LISTS, letter, 1, last)
        for name in _TYPED[sheet]:
            self._name(f"typed_{name}", sheet, LETTERS[sheet, name], 1, last)
        return at + len(names)

    def _of_floor(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        yield _key(_typed("floor", row))
        yield from self._own_pfa(row, cells["key"])
        yield from self._own_pfv(row, cells)
        words = (f'"{gettext(one)}"' for one in (RUN_ASSESS, WRONG))
        yield from live_ground.list_places(_typed("elevation", row), cells, *words)
        yield from live_ground.list_served(cells)
        could_serve = live_ground.could_serve(cells["z"])
        yield f'IF({could_serve},"{gettext(RUN_ASSESS)}","{gettext(NO_SHAKING)}")'
        yield from _serving(cells)
        (x, y), speeds = ([cells[f"{peak}_{axis}"] for axis in "xy"] for peak in ("pfa", "pfv"))
        worse = f"IF(class_by=2,{live.worse_axis(x, y)},{live.worse_axis(*speeds)})"
        yield f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),{worse},"Y"),"X")'

    def _own_pfa(self, row: int, key: str) -> Iterator[str]:
        for axis in "xy":
            pfa, record = (_typed(f"{what}_{axis}", row) for what in ("pfa", "record"))
            unit = f"unit_floors_pfa_{axis}"
            inside = live.between(f"{pfa}*{unit}", FLOORS.column(f"pfa_{axis}"))
            number = f'IFERROR(IF({inside},{pfa}*{unit}/{GRAVITY!r},"{gettext(WRONG)}"),{unit})'
            given = f'IF(scenario_kind="recorded","",{_if_number(pfa, number)})'
            aside = f'AND(TRIM({record})<>"",scenario_kind<>"given")'
            yield f'IF(OR({key}=0,scenario_is_own=0),"",IF({aside},"{gettext(RUN_ASSESS)}",{given}))'

    def _own_pfv(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        for axis in "xy":
            pfa, unit = cells[f"own_pfa_{axis}"], f"unit_floors_pfv_{axis}"
            pfv = _typed(f"pfv_{axis}", row)
            inside = live.between(f"{pfv}*{unit}", FLOORS.column(f"pfv_{axis}"))
            given = _if_number(pfv, f'IFERROR(IF({inside},{pfv}*{unit}*100,"{gettext(WRONG)}"),{unit})')
            yield f'IF(ISNUMBER({pfa}),{given},"")'

    def _of_type(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        yield _key(_typed("type", row))
        for name in _TYPE_SIZES:
            yield _if_number(_typed(name, row), f"IFERROR({_typed(name, row)}*unit_catalogue_{name}*100,sizes_unit)")
        centre, unit = _typed(CENTRE, row), f"unit_catalogue_{CENTRE}"
        share = f'IF({live.between(f"{centre}*{unit}", CATALOGUE.column(CENTRE))},{centre}*{unit},"{gettext(WRONG)}")'
        yield _if_number(centre, f"IFERROR({share},{unit})", repr(MIDDLE))


def _typed(name: str, row: int) -> str:
    """Refer to a cell of Floors or the Catalogue so that rows inserted or sorted there do not move the reference."""
    return f"INDEX(typed_{name},{row})"


def _key(cell: str) -> str:
    """Expression for a name as it is looked up; 0 where there is none, which no name is."""
    return f'IF({cell}="",0,{trim(cell)})'


def _if_number(cell: str, number: str, blank: str = '""') -> str:
    """Expression for what is shown of a cell: of a number, of a blank cell, and `WRONG` of anything else."""
    return f'IF(ISNUMBER({cell}),{number},IF(TRIM({cell})="",{blank},"{gettext(WRONG)}"))'


def _line(name: str) -> int:
    """Row of the form Building in which the empty workbook has a field."""
    return BUILDING.columns.index(BUILDING.column(name)) + 1


def _in_english(typed: str) -> str:
    """Expression for a kind of scenario by its English name, where it was typed by that of the language in use."""
    expression = typed
    for kind, name in _OWN_SCENARIOS.items():
        said = gettext(name).lower().replace(" ", "").replace("-", "")
        expression = expression if said == kind else f'IF({typed}="{said}","{kind}",{expression})'
    return expression


def _serving(cells: Mapping[str, str]) -> list[str]:
    """Expressions for PFA and PFV on X and Y: where one axis alone is known, it serves both.

    Where PFV is not known, the floor is not.
    """
    found = []
    for what in ("pfa", "pfv"):
        for axis, other in ("xy", "yx"):
            own, others, pfv = (cells[name] for name in (f"own_pfa_{axis}", f"own_pfa_{other}", f"pfv_own_{axis}"))
            pfa = f'IF({own}="",{others},{own})'
            number = f"IF(ISNUMBER({pfv}),{pfa},{pfv})" if what == "pfa" else pfv
            beam, hint = cells[f"beam_{what}"], cells["hint"] if what == "pfa" else '""'
            nothing = f'IF({beam}="",{hint},{beam})'
            found.append(f'IF(AND({own}="",{others}=""),{nothing},IF(ISNUMBER({pfa}),{number},{pfa}))')
    return found
