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
from assess.motion.scenario import HIGHEST_FLOOR_FREQUENCY, cap_pfv
from assess.rocking.block import MIDDLE
from assess.rocking.draws import CUT, Uncertainty
from assess.units import ALIASES, GRAVITY, QUANTITIES, ROUNDING
from assess.workbook import formulas as live
from assess.workbook import live_shaking
from assess.workbook.cell_texts import list_words, trim
from assess.workbook.layout import LETTERS
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, LISTS, SHEETS, YES, Column

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
    ("Floors", "pfa_x"), ("Floors", "pfa_y"), ("Floors", "pfv_x"), ("Floors", "pfv_y"), ("Building", "period"),
    ("Building", "ground_pgv"), ("Building", "height"), ("Floors", "elevation"),
    ("Items", "centre_of_gravity"), ("Catalogue", "centre_of_gravity"),
)  # fmt: skip

_NO_CAP = 1_000_000
"""Largest PFV that is estimated [cm/s] where Ground PGV does not limit it."""

_OWN_SCENARIOS = {"asfilled": "as filled", "recorded": "recorded", "given": "given"}
"""Scenarios that floors' own values serve, by how choices are compared."""

_SCENARIO_NAMES = ("scenario_typed", "scenario_kind", "scenario_is_own")

_TYPE_SIZES, CENTRE = ("breadth", "height"), "centre_of_gravity"

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
    "key", "own_pfa_x", "own_pfa_y", "own_pfv_x", "own_pfv_y", *live_shaking.HELPERS, "hint",
    "pfa_x", "pfa_y", "pfv_x", "pfv_y", "best",
)  # fmt: skip
"""Columns of the sheet for a row of Floors: its name, its own motion by axis, that of an assumed shaking, what
it shows if it has neither, and what serves each axis."""

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
        at = live_shaking.write_shakings(self.book, self.page, self._write_choices() + 1)
        at = self._write_units(at + 1)
        at = self._write_factors(at + 1)
        at = self._write_rows(at + 1, "Floors", _FLOOR_HELPERS, self._of_floor)
        self._write_rows(at + 1, "Catalogue", _TYPE_HELPERS, self._of_type)
        for name in ("Floors", "Catalogue", "Places", "Routes"):
            self._name(f"list_{name.lower()}", name, "A", 2, self.last[name])
        self.book.define_name("period", f"={gettext(BUILDING.name)}!$B${_line('period')}")

    def _name(self, name: str, sheet: str, column: str, first: int, last: int) -> None:
        self.book.define_name(name, f"={gettext(sheet)}!${column}${first}:${column}${last}")

    def _define(self, name: str, at: int, row: int, label: str, formula: str, value: Any) -> None:
        """Write a label and next to it a formula with its value, and define a name for the latter."""
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
            cell = f"$A${_line(field)}" if sheet.layout == "form" else f"{LETTERS[name, field]}$1"
            unit = _bracket(f"{gettext(name)}!{cell}")
            factor = QUANTITIES[column.quantity][column.header(self.units).partition("[")[2].rstrip("]")]
            formula = f'=IFERROR(VLOOKUP({unit},units_{column.quantity},2,FALSE),"{gettext(NO_UNIT)}")'
            label = f"{gettext(name)}: {gettext(column.label)}"
            self._define(f"unit_{name.lower()}_{field}", at, row, label, formula, factor)
        row = len(_NEEDED_FACTORS) + 4
        # What the live columns say where a header of a size has no known unit.
        sizes = (f"unit_{sheet}_{name}" for sheet in ("items", "catalogue") for name in ("breadth", "height"))
        formula = f'=IF(OR({",".join(f"ISTEXT({size})" for size in sizes)}),"{gettext(NO_UNIT)}","")'
        self._define("sizes_unit", at, row, gettext("unknown unit of a size"), formula, "")
        self._write_strongest(row + 1, at)
        self._write_largest_estimate(row + 2, at)
        self._write_words(row + 3, at)
        self._write_scenario(row + 5, at)
        self._write_shaking(row + 5 + len(_SCENARIO_NAMES), at)
        return at + 2

    def _write_words(self, row: int, at: int) -> None:
        """Write how a piece can be said to be anchored, and its sizes to be by a scan."""
        lists = ("anchored_words", gettext("words for anchored"), ANCHORED, YES), (
            "scanned_words", gettext("words for sizes by a scan"), SIZES_FROM, SCANNED
        )  # fmt: skip
        for number, (name, label, choices, choice) in enumerate(lists):
            words = list_words(choices, choice)
            self._define(name, at, row + number, label, f'="{words}"', words)

    def _write_strongest(self, row: int, at: int) -> None:
        """Write the factor on a floor's motion that no drawn earthquake exceeds."""
        default = Uncertainty()
        uncertainty = f"{gettext(BUILDING.name)}!$B${_line('motion_uncertainty')}"
        factor = f"EXP({CUT!r}*MAX(shaking_scatter,{uncertainty}))"
        given = f'IF(AND(ISNUMBER({uncertainty}),{uncertainty}>=0),{factor},"{gettext(WRONG)}")'
        assumed = f"EXP({CUT!r}*MAX(shaking_scatter,{default.motion!r}))"
        formula = f'=IF(shakemap_serves,"{gettext(RUN_ASSESS)}",IF(TRIM({uncertainty})="",{assumed},{given}))'
        self._define("strongest", at, row, gettext("largest factor on the motion"), formula, default.largest)

    def _write_largest_estimate(self, row: int, at: int) -> None:
        """Write the PFV [cm/s] that no estimate exceeds, if Ground PGV is a number with a known unit."""
        pgv = f"{gettext(BUILDING.name)}!$B${_line('ground_pgv')}"
        formula = f"=IF(ISNUMBER({pgv}),IFERROR({pgv}*unit_building_ground_pgv*{cap_pfv(100)!r},{_NO_CAP}),{_NO_CAP})"
        self._define("largest_estimate", at, row, gettext("largest PFV that is estimated"), formula, _NO_CAP)

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

    def _write_shaking(self, row: int, at: int) -> None:
        """Write what follows from an assumed intensity."""
        fields = ("ground_pga", "ground_pgv", "sds", "shakemap", "shaking", "height", "storeys")
        building = {name: f"{gettext(BUILDING.name)}!$B${_line(name)}" for name in fields}
        letter, last = LETTERS["Floors", "elevation"], self.last["Floors"]
        floors = gettext("Floors")
        elevations = f"{floors}!${letter}$2:${letter}${last}"
        for line, (name, formula) in enumerate(live_shaking.list_names(building, elevations), row):
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
        yield from self._own_pfa(row)
        yield from self._own_pfv(row, cells)
        yield from live_shaking.list_formulas(_typed("elevation", row), cells)
        could_serve = live_shaking.could_serve(_typed("elevation", row))
        yield f'IF({could_serve},"{gettext(RUN_ASSESS)}","{gettext(NO_SHAKING)}")'
        yield from _serving(cells)
        yield _best(cells)

    def _own_pfa(self, row: int) -> Iterator[str]:
        for axis in "xy":
            pfa, record = (_typed(f"{what}_{axis}", row) for what in ("pfa", "record"))
            unit, wrong = f"unit_floors_pfa_{axis}", gettext(WRONG)
            in_g, least = f"{pfa}*{unit}/{GRAVITY!r}", (FLOORS.column(f"pfa_{axis}").low or 0) * (1 - ROUNDING)
            number = f'IFERROR(IF({in_g}<{least:.12g},"{wrong}",{in_g}),{unit})'
            given = f'IF(scenario_kind="recorded","",{_if_number(pfa, number)})'
            aside = f'AND(TRIM({record})<>"",scenario_kind<>"given")'
            yield f'IF(scenario_is_own=0,"",IF({aside},"{gettext(RUN_ASSESS)}",{given}))'

    def _own_pfv(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        frequency = f"MIN(1/(period*unit_building_period),{HIGHEST_FLOOR_FREQUENCY!r})"
        for axis in "xy":
            pfa, unit = cells[f"own_pfa_{axis}"], f"unit_floors_pfv_{axis}"
            by_period = f"{pfa}*{GRAVITY * 100!r}/(2*PI()*{frequency})"
            estimate = f'IF(ISNUMBER(period),MIN({by_period},largest_estimate),"")'
            pfv = _typed(f"pfv_{axis}", row)
            given = _if_number(pfv, f"IFERROR({pfv}*{unit}*100,{unit})", estimate)
            yield f'IF(ISNUMBER({pfa}),{given},"")'

    def _of_type(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        yield _key(_typed("type", row))
        for name in _TYPE_SIZES:
            yield _if_number(_typed(name, row), f"IFERROR({_typed(name, row)}*unit_catalogue_{name}*100,sizes_unit)")
        centre, unit = _typed(CENTRE, row), f"unit_catalogue_{CENTRE}"
        share = f'IF({between(f"{centre}*{unit}", CATALOGUE.column(CENTRE))},{centre}*{unit},"{gettext(WRONG)}")'
        yield _if_number(centre, f"IFERROR({share},{unit})", repr(MIDDLE))


def between(number: str, column: Column, scale: float = 1.0) -> str:
    """Return an expression for whether a number, in SI times `scale`, lies in the range of a column."""
    low, high = ((limit or 0) * column.factor * scale for limit in (column.low, column.high))
    return f"AND({number}>={low * (1 - ROUNDING):.12g},{number}<={high * (1 + ROUNDING):.12g})"


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


def _bracket(cell: str) -> str:
    """Expression for the unit in a header's brackets, spelt as in the lists of units."""
    start = f'FIND("[",{cell})'
    return f'LOWER(SUBSTITUTE(MID({cell},{start}+1,FIND("]",{cell})-{start}-1)," ",""))'


def _serving(cells: Mapping[str, str]) -> list[str]:
    """Expressions for PFA and PFV on X and Y: where one axis alone is known, it serves both."""
    x, y = cells["own_pfa_x"], cells["own_pfa_y"]
    nothing = {"pfa": f'AND({x}="",{y}="")', "pfv": "FALSE"}
    return [
        f"IF(ISNUMBER({cells['assumed_pfa']}),{cells[f'assumed_{what}']},"
        f"IF({nothing[what]},{cells['hint']},"
        f'IF({cells[f"own_pfa_{axis}"]}="",{cells[f"own_{what}_{other}"]},{cells[f"own_{what}_{axis}"]})))'
        for what in ("pfa", "pfv")
        for axis, other in ("xy", "yx")
    ]


def _best(cells: Mapping[str, str]) -> str:
    """Expression for the axis that governs a piece which may topple along both: one without a number comes first."""
    x, y = cells["pfa_x"], cells["pfa_y"]
    return f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),{live.worse_axis(x, y)},"Y"),"X")'
