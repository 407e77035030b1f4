"""The sheet Lists: what the drop-downs and the live columns of the other sheets refer to.

It holds the choices, the factor that each header's bracket stands for, and for every row of Floors the PFA and PFV
that serve each axis.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.motion.scenario import HIGHEST_FLOOR_FREQUENCY, cap_pfv
from assess.rocking.draws import CUT, Uncertainty
from assess.units import ALIASES, GRAVITY, QUANTITIES
from assess.workbook import formulas as live
from assess.workbook import live_shaking
from assess.workbook.schema import BUILDING, LISTS, SHEETS

Units = Literal["si", "imperial"]

LISTS_NOTE = "Lists, units and helper columns for the drop-downs and live columns. Please leave this sheet as it is."

ROWS = {"Floors": 100, "Items": 500, "Places": 200, "Routes": 200, "Catalogue": 200}
"""Rows of each table that are prepared; a longer table is read all the same."""

LETTERS = {(sheet.name, column.name): xl_col_to_name(at) for sheet in SHEETS for at, column in enumerate(sheet.columns)}
"""Column of the sheet in which the empty workbook has a field."""

RUN_ASSESS = "run assess"
"""What the live columns say of a floor with a record, which no spreadsheet formula can read, of one of which nothing is
known, and of every floor where a code's profile is chosen."""

NO_UNIT = "unit?"
"""What they say where the bracket of a header holds no unit that is known."""

LISTED = ("length", "acceleration", "velocity", "time", "share")
"""Quantities of which the sheet holds the units."""

_NEEDED_FACTORS = (
    ("Items", "breadth"), ("Items", "height"), ("Catalogue", "breadth"), ("Catalogue", "height"),
    ("Floors", "pfa_x"), ("Floors", "pfa_y"), ("Floors", "pfv_x"), ("Floors", "pfv_y"), ("Building", "period"),
    ("Building", "ground_pgv"), ("Building", "height"), ("Floors", "elevation"),
    ("Items", "centre_of_gravity"), ("Catalogue", "centre_of_gravity"),
)  # fmt: skip

_OWN_SCENARIOS = {"asfilled": "as filled", "recorded": "recorded", "given": "given"}
"""Scenarios that floors' own values serve, by how choices are compared."""

_SCENARIO_NAMES = ("scenario_typed", "scenario_kind", "scenario_is_own")

_FLOOR_HELPERS = ("own_pfa_x", "own_pfa_y", "own_pfv_x", "own_pfv_y", *live_shaking.HELPERS,
                  "pfa_x", "pfa_y", "pfv_x", "pfv_y", "best")  # fmt: skip


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
        self._write_floors(at + 1)
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
        chosen = {column.name: column for sheet in SHEETS for column in sheet.columns if column.choices}
        for at, (name, column) in enumerate(chosen.items()):
            self.page.write_column(2, at, [gettext(text) for text in (column.label, *column.choices)])
            self._name(f"list_{name}", LISTS, xl_col_to_name(at), 4, 3 + len(column.choices))
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
            cell = f"$A${sheet.columns.index(column) + 1}" if sheet.layout == "form" else f"{LETTERS[name, field]}$1"
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
        self._write_scenario(row + 3, at)
        self._write_shaking(row + 3 + len(_SCENARIO_NAMES), at)
        return at + 2

    def _write_strongest(self, row: int, at: int) -> None:
        """Write the factor on a floor's motion that no drawn earthquake exceeds."""
        default = Uncertainty()
        uncertainty = f"{gettext(BUILDING.name)}!$B${_line('motion_uncertainty')}"
        own = f'IF({uncertainty}="",{default.motion!r},{uncertainty})'
        formula = f"=EXP({CUT!r}*MAX(shaking_scatter,1*{own}))"
        self._define("strongest", at, row, gettext("largest factor on the motion"), formula, default.largest)

    def _write_largest_estimate(self, row: int, at: int) -> None:
        """Write the PFV [cm/s] that no estimate exceeds; nothing where Ground PGV is no number with a known unit."""
        pgv = f"{gettext(BUILDING.name)}!$B${_line('ground_pgv')}"
        formula = f'=IF(ISNUMBER({pgv}),IFERROR({pgv}*unit_building_ground_pgv*{cap_pfv(100)!r},""),"")'
        self._define("largest_estimate", at, row, gettext("largest PFV that is estimated"), formula, "")

    def _write_scenario(self, row: int, at: int) -> None:
        """Write the kind of scenario as choices are compared, and whether floors' own values serve it."""
        plain = f"LOWER({gettext(BUILDING.name)}!$B${_line('scenario_kind')})"
        for sign in (" ", "-", "_"):
            plain = f'SUBSTITUTE({plain},"{sign}","")'
        typed, kind = (f"${xl_col_to_name(at + 1)}${row + line}" for line in range(2))
        own = ",".join(f'{kind}="{one}"' for one in ("", *_OWN_SCENARIOS))
        formulas = (plain, _in_english(typed), f"IF(OR({own}),1,0)")
        for line, (label, formula) in enumerate(zip(_SCENARIO_NAMES, formulas, strict=True), row):
            self._define(label, at, line, label, f"={formula}", 1 if formula is formulas[-1] else "")

    def _write_shaking(self, row: int, at: int) -> None:
        """Write what follows from an assumed intensity."""
        fields = ("ground_pga", "sds", "shaking", "height")
        building = {name: f"{gettext(BUILDING.name)}!$B${_line(name)}" for name in fields}
        letter, last = LETTERS["Floors", "elevation"], self.last["Floors"]
        elevations = f"{gettext('Floors')}!${letter}$2:${letter}${last}"
        for line, (name, formula) in enumerate(live_shaking.list_names(building, elevations), row):
            self._define(name, at, line, name, f"={formula}", "")

    # ------------------------------------------------------------------ floors

    def _write_floors(self, at: int) -> None:
        """Write, for every row of Floors, its own PFA and PFV on each axis and then those that serve each axis."""
        letters = {name: xl_col_to_name(at + place) for place, name in enumerate(_FLOOR_HELPERS)}
        last = self.last["Floors"]
        self.page.write_row(0, at, _FLOOR_HELPERS)
        for row in range(2, last + 1):
            cells = {name: f"${letter}{row}" for name, letter in letters.items()}
            assumed = live_shaking.list_formulas(self._floor("elevation", row), cells)
            formulas = (*self._own_pfa(row), *self._own_pfv(row, cells), *assumed, *_serving(cells), _best(cells))
            for place, formula in enumerate(formulas):
                self.page.write_formula(row - 1, at + place, f"={formula}", None, "")
        for name, letter in letters.items():
            self._name(f"floor_{name}", LISTS, letter, 2, last)

    def _floor(self, name: str, row: int) -> str:
        """Refer to a cell of Floors so that rows inserted or sorted there do not move the reference."""
        letter = LETTERS["Floors", name]
        floors = gettext("Floors")
        return f"INDEX({floors}!${letter}$1:${letter}${self.last['Floors']},{row})"

    def _own_pfa(self, row: int) -> Iterator[str]:
        for axis in "xy":
            pfa, record = self._floor(f"pfa_{axis}", row), self._floor(f"record_{axis}", row)
            number = f'IF(ISTEXT(unit_floors_pfa_{axis}),"{gettext(NO_UNIT)}",{pfa}*unit_floors_pfa_{axis}/{GRAVITY!r})'
            given = f'IF(OR({pfa}="",scenario_kind="recorded"),"",{number})'
            aside = f'AND(TRIM({record})<>"",scenario_kind<>"given")'
            yield f'IF(OR(scenario_is_own=0,{aside}),"{gettext(RUN_ASSESS)}",{given})'

    def _own_pfv(self, row: int, cells: Mapping[str, str]) -> Iterator[str]:
        for axis in "xy":
            pfa, pfv = cells[f"own_pfa_{axis}"], self._floor(f"pfv_{axis}", row)
            frequency = f"MIN(1/(period*unit_building_period),{HIGHEST_FLOOR_FREQUENCY!r})"
            by_period = f"{pfa}*{GRAVITY * 100!r}/(2*PI()*{frequency})"
            capped = f"IF(ISNUMBER(largest_estimate),MIN({by_period},largest_estimate),{by_period})"
            estimate = f'IF(ISNUMBER(period),{capped},"")'
            given = f'IF(ISTEXT(unit_floors_pfv_{axis}),"{gettext(NO_UNIT)}",{pfv}*unit_floors_pfv_{axis}*100)'
            yield f'IF(ISNUMBER({pfa}),IF({pfv}<>"",{given},{estimate}),"")'


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
        f'IF({nothing[what]},"{gettext(RUN_ASSESS)}",'
        f'IF({cells[f"own_pfa_{axis}"]}="",{cells[f"own_{what}_{other}"]},{cells[f"own_{what}_{axis}"]})))'
        for what in ("pfa", "pfv")
        for axis, other in ("xy", "yx")
    ]


def _best(cells: Mapping[str, str]) -> str:
    """Expression for the axis that governs a piece which may topple along both: one without a number comes first."""
    x, y = cells["pfa_x"], cells["pfa_y"]
    return f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),{live.worse_axis(x, y)},"Y"),"X")'
