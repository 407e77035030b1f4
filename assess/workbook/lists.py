"""The sheet Lists: what the drop-downs and the live columns of the other sheets refer to.

It holds the choices, the factor that each header's bracket stands for, for every row of Floors the PFA and PFV that
serve each axis, and for every row of the Catalogue the sizes of the type. Names stand there without stray spaces, so
that a name in Items is found however both were typed. What is no number, or lies outside the range that the program
takes, is shown as `WRONG` and never computed with: Excel takes the text 40,5 for 405 where the comma groups thousands.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.intensity import SHAKINGS
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
    """Return the columns of a sheet from the left: the field of each to fill in, the label of each that is computed.

    In Items the class stands next to the item, so that it stays in view while the row is filled in.
    """
    first, *others = (column.name for column in sheet.columns)
    if sheet is ITEMS:
        others = [CLASS, *others, *(label for label in LIVE if label != CLASS), *WORKINGS]
    return [first, *others]


PLACES = {(sheet.name, name): at for sheet in SHEETS for at, name in enumerate(list_columns(sheet))}
"""Column, from 0, in which the workbook has a field or a column that is computed; of a form, the line."""

LETTERS = {where: xl_col_to_name(at) for where, at in PLACES.items()}
"""The same as letters."""


Units = Literal["si", "imperial"]

ROW = "\x00"
"""Stands for the number of the row in formulas that are the same for every row."""

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

_TYPE_SIZES, CENTRE = ("breadth", "width", "height"), "centre_of_gravity"

_TYPED = {
    "Floors": ("floor", "elevation", "pfa_x", "pfa_y", "pfv_x", "pfv_y", "record_x", "record_y"),
    "Catalogue": ("type", *_TYPE_SIZES, CENTRE),
}
"""Fields of which a helper column is computed; their columns are named after them."""

Helpers = Callable[[Mapping[str, str]], Iterator[str]]
"""Gives the formulas of a row, by the cells that they are written to."""

Definition = tuple[str, str, str, Any]
"""A name, the label of its cell, the formula in that, and the result that is stored."""

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
        chosen = {one.name: one for sheet in SHEETS for one in sheet.columns if one.choices or one.offered}
        at = self._write_columns(0, [
            (f"list_{name}", gettext(column.label), [gettext(text) for text in column.choices or column.offered])
            for name, column in chosen.items()
        ])  # fmt: skip
        # of every choice of Shaking PGA [g], PGV [cm/s], its scatter, and whether PGA is derived
        shakings = [(one.pga / GRAVITY, 100 * one.pgv, one.scatter, int(one.is_derived)) for one in SHAKINGS.values()]
        at = self._write_columns(at + 1, [
            (f"shakings_{name}", f"shaking {name}", [row[place] for row in shakings])
            for place, name in enumerate(("pga", "pgv", "scatter", "derived"))
        ])  # fmt: skip
        at = self._write_floor_table(at + 1)
        at = self._write_units(at + 1)
        at = self._write_definitions(at + 1)
        # what a floor has of the ground's PFA and PFV at each z/h of the table, by axis
        nodes = {axis: [f"={one}" for one in live_ground.list_nodes(axis)] for axis in "xy"}
        at = self._write_columns(at + 1, [
            (f"nodes_{axis}_{peak}", f"nodes_{axis}_{peak}", own)
            for axis, every in nodes.items()
            for peak, own in (("a", every[: len(every) // 2]), ("v", every[len(every) // 2 :]))
        ])  # fmt: skip
        at = self._write_rows(at + 1, "Floors", "floor", _FLOOR_HELPERS, _of_floor)
        self._write_rows(at + 1, "Catalogue", "type", _TYPE_HELPERS, _of_type)
        for name in ("Floors", "Catalogue", "Places", "Routes"):
            self._name(f"list_{name.lower()}", name, "A", 2, self.last[name])

    def _name(self, name: str, sheet: str, column: str, first: int, last: int, end: str = "") -> None:
        self.book.define_name(name, f"={gettext(sheet)}!${column}${first}:${end or column}${last}")

    def _write_columns(self, at: int, columns: Iterable[tuple[str, str, Sequence[Any]]]) -> int:
        for name, header, values in columns:
            self.page.write_string(2, at, header)
            for row, value in enumerate(values, 3):
                if isinstance(value, str) and value.startswith("="):
                    self.page.write_formula(row, at, value, None, "")
                else:
                    self.page.write(row, at, value)
            self._name(name, LISTS, xl_col_to_name(at), 4, 3 + len(values))
            at += 1
        return at

    def _write_floor_table(self, at: int) -> int:
        at = self._write_columns(at, live_ground.list_scales())
        rows = live_ground.list_medians()
        for number, row in enumerate(rows, 3):
            for place, value in enumerate(row, at):
                self.page.write_number(number, place, value)
        first, last = xl_col_to_name(at), xl_col_to_name(at + len(rows[0]) - 1)
        # some blank rows belong to it, of which the weight is 0
        self._name("floor_table", LISTS, first, 4, 4 + len(rows) + live_ground.BLANK_ROWS, last)
        return at + len(rows[0])

    def _write_units(self, at: int) -> int:
        for quantity in LISTED:
            units = dict(QUANTITIES[quantity])
            units |= {other: units[unit] for other, unit in ALIASES.items() if unit in units}
            self.page.write_column(2, at, (gettext(quantity), *units))
            self.page.write_column(2, at + 1, ("SI", *units.values()))
            self._name(f"units_{quantity}", LISTS, xl_col_to_name(at), 4, 3 + len(units), xl_col_to_name(at + 1))
            at += 2
        return at

    def _write_definitions(self, at: int) -> int:
        self.page.write_row(2, at, (gettext("header"), gettext("factor")))
        letter, rows = xl_col_to_name(at + 1), [*self._list_factors()]
        for name, label, words in (
            ("anchored_words", gettext("words for anchored"), list_words(ANCHORED, YES)),
            ("scanned_words", gettext("words for sizes by a scan"), list_words(SIZES_FROM, SCANNED)),
        ):
            rows.append((name, label, f'"{words}"', words))
        rows += _list_scenario(*(f"${letter}${4 + len(rows) + line}" for line in range(2)))
        building = {column.name: f"{gettext(BUILDING.name)}!$B${_line(column.name)}" for column in BUILDING.columns}
        said = (f'"{gettext(one)}"' for one in (RUN_ASSESS, WRONG))
        rows += [(name, name, formula, "") for name, formula in live_ground.list_names(building, *said)]
        for row, (name, label, formula, value) in enumerate(rows, 4):
            self.page.write_string(row - 1, at, label)
            self.page.write_formula(row - 1, at + 1, f"={formula}", None, value)
            self.book.define_name(name, f"={gettext(LISTS)}!${letter}${row}")
        return at + 2

    def _list_factors(self) -> Iterator[Definition]:
        sheets = {sheet.name: sheet for sheet in SHEETS}
        for name, field in _NEEDED_FACTORS:
            column = sheets[name].column(field)
            at_head = f"$A${_line(field)}" if sheets[name] is BUILDING else f"{LETTERS[name, field]}$1"
            cell = f"{gettext(name)}!{at_head}"
            start = f'FIND("[",{cell})'
            unit = f'LOWER(SUBSTITUTE(MID({cell},{start}+1,FIND("]",{cell})-{start}-1)," ",""))'
            factor = QUANTITIES[column.quantity][column.header(self.units).partition("[")[2].rstrip("]")]
            formula = f'IFERROR(VLOOKUP({unit},units_{column.quantity},2,FALSE),"{gettext(NO_UNIT)}")'
            yield f"unit_{name.lower()}_{field}", f"{gettext(name)}: {gettext(column.label)}", formula, factor
        # What the live columns say where a header of a size has no known unit.
        sizes = (f"unit_{sheet}_{name}" for sheet in ("items", "catalogue") for name in ("breadth", "height"))
        formula = f'IF(OR({",".join(f"ISTEXT({size})" for size in sizes)}),"{gettext(NO_UNIT)}","")'
        yield "sizes_unit", gettext("unknown unit of a size"), formula, ""

    def _write_rows(self, at: int, sheet: str, prefix: str, names: Sequence[str], helpers: Helpers) -> int:
        """Write the helper columns of a table from column `at`; those of a row stand in the row of the same number.

        The names that are defined begin in row 1, so that what is found is the number of the row. The header of the
        keys stays blank: it would be found as a name.
        """
        letters = {name: xl_col_to_name(at + place) for place, name in enumerate(names)}
        last = self.last[sheet]
        self.page.write_row(0, at + 1, [f"{prefix}_{name}" for name in names[1:]])
        formulas = list(helpers({name: f"${letter}{ROW}" for name, letter in letters.items()}))
        for row in range(2, last + 1):
            for place, formula in enumerate(formulas, at):
                self.page.write_formula(row - 1, place, formula.replace(ROW, str(row)), None, "")
        for name, letter in letters.items():
            self._name(f"{prefix}_{name}", LISTS, letter, 1, last)
        for name in _TYPED[sheet]:
            self._name(f"typed_{name}", sheet, LETTERS[sheet, name], 1, last)
        return at + len(names)


def _list_scenario(typed: str, kind: str) -> Iterator[Definition]:
    """Yield the kind of scenario as choices are compared, and whether floors' own values serve it.

    `typed`, `kind`: the cells of the first two.
    """
    plain = f"LOWER({gettext(BUILDING.name)}!$B${_line('scenario_kind')})"
    for sign in (" ", "\u00a0", "-", "_"):
        plain = f'SUBSTITUTE({plain},"{sign}","")'
    english = typed  # by its English name, where it was typed by that of the language in use
    for known, name in _OWN_SCENARIOS.items():
        said = gettext(name).lower().replace(" ", "").replace("-", "")
        english = english if said == known else f'IF({typed}="{said}","{known}",{english})'
    own = ",".join(f'{kind}="{one}"' for one in ("", *_OWN_SCENARIOS))
    yield "scenario_typed", "scenario_typed", plain, ""
    yield "scenario_kind", "scenario_kind", english, ""
    yield "scenario_is_own", "scenario_is_own", f"IF(OR({own}),1,0)", 1


# ---------------------------------------------------------------- rows of Floors and of the Catalogue


def _of_floor(cells: Mapping[str, str]) -> Iterator[str]:
    yield _key(_typed("floor"))
    for axis in "xy":
        pfa, unit = _typed(f"pfa_{axis}"), f"unit_floors_pfa_{axis}"
        inside = live.between(f"{pfa}*{unit}", FLOORS.column(f"pfa_{axis}"))
        number = f'IFERROR(IF({inside},{pfa}*{unit}/{GRAVITY!r},"{gettext(WRONG)}"),{unit})'
        given = f'IF(scenario_kind="recorded","",{_if_number(pfa, number)})'
        aside = f'AND(TRIM({_typed(f"record_{axis}")})<>"",scenario_kind<>"given")'
        yield f'IF(OR({cells["key"]}=0,scenario_is_own=0),"",IF({aside},"{gettext(RUN_ASSESS)}",{given}))'
    for axis in "xy":
        pfv, unit = _typed(f"pfv_{axis}"), f"unit_floors_pfv_{axis}"
        inside = live.between(f"{pfv}*{unit}", FLOORS.column(f"pfv_{axis}"))
        given = _if_number(pfv, f'IFERROR(IF({inside},{pfv}*{unit}*100,"{gettext(WRONG)}"),{unit})')
        yield f'IF(ISNUMBER({cells[f"own_pfa_{axis}"]}),{given},"")'
    words = (f'"{gettext(one)}"' for one in (RUN_ASSESS, WRONG))
    yield from live_ground.list_places(_typed("elevation"), cells, *words)
    yield from live_ground.list_served(cells)
    yield f'IF({live_ground.could_serve(cells["z"])},"{gettext(RUN_ASSESS)}","{gettext(NO_SHAKING)}")'
    yield from _serving(cells)
    (x, y), speeds = ([cells[f"{peak}_{axis}"] for axis in "xy"] for peak in ("pfa", "pfv"))
    worse = f"IF(class_by=2,{live.worse_axis(x, y)},{live.worse_axis(*speeds)})"
    yield f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),{worse},"Y"),"X")'


def _of_type(cells: Mapping[str, str]) -> Iterator[str]:
    yield _key(_typed("type"))
    for name in _TYPE_SIZES:
        yield _if_number(_typed(name), f"IFERROR({_typed(name)}*unit_catalogue_{name}*100,sizes_unit)")
    centre, unit = _typed(CENTRE), f"unit_catalogue_{CENTRE}"
    share = f'IF({live.between(f"{centre}*{unit}", CATALOGUE.column(CENTRE))},{centre}*{unit},"{gettext(WRONG)}")'
    yield _if_number(centre, f"IFERROR({share},{unit})", repr(MIDDLE))


def _typed(name: str) -> str:
    """Refer to a cell of Floors or the Catalogue so that rows inserted or sorted there do not move the reference."""
    return f"INDEX(typed_{name},{ROW})"


def _key(cell: str) -> str:
    return f'IF({cell}="",0,{trim(cell)})'


def _if_number(cell: str, number: str, blank: str = '""') -> str:
    """Expression for what is shown of a cell: of a number, of a blank cell, and `WRONG` of anything else."""
    return f'IF(ISNUMBER({cell}),{number},IF(TRIM({cell})="",{blank},"{gettext(WRONG)}"))'


def _line(name: str) -> int:
    return BUILDING.columns.index(BUILDING.column(name)) + 1


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
