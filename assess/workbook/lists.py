"""The sheet Lists: what the drop-downs and the live columns of the other sheets refer to.

It holds the choices, the factor that each header's bracket stands for, for every row of Floors the PFA and PFV that
serve each axis, and for every row of the Catalogue the sizes of the type. Names stand there without stray spaces, so
that a name in Items is found however both were typed. What is no number, or lies outside the range that the program
takes, is shown as `WRONG` and never computed with: Excel takes the text 40,5 for 405 where the comma groups thousands.

It serves a floor of which PFA is typed, of which PFV may be, and, as long as no floor has a motion of its own, floors
that follow from the ground: from Ground PGA and Ground PGV, SDS, or an assumed intensity. PFA and PFV are those of
`assess.motion.floor_medians`, the table of which stands in the sheet. Next to a floor with a record, or with a typed
motion, the others are the program's task, as is a ShakeMap.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext
from assess.intensity import RATIO, SHAKINGS
from assess.model import ANCHORED, SCANNED, SIZES_FROM
from assess.motion import floor_medians as medians
from assess.motion.assumed import CODE_FACTOR, CODE_POWER, LONGER, RATIO_SCATTER, STIFFNESS, STOREY
from assess.motion.scenario import PGA_OF_SDS
from assess.rocking.block import MIDDLE
from assess.rocking.draws import MOTION
from assess.units import ALIASES, GRAVITY, QUANTITIES
from assess.workbook.formulas import between, find_row, is_among, list_words, quote, trim, worse_axis
from assess.workbook.schema import (
    BUILDING,
    CATALOGUE,
    CLASS,
    FLOORS,
    ITEMS,
    LISTS,
    LIVE,
    NO,
    SHEETS,
    WORKINGS,
    YES,
    Sheet,
)

FROZEN = {ITEMS.name: 2}
"""Columns that stay in view while a table is scrolled; one where a sheet is not named."""


def list_columns(sheet: Sheet) -> list[str]:
    """Return the columns of a sheet from the left, fields or labels of computed ones; the class is next to the item."""
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
ROWS = {"Floors": 100, "Items": 200, "Places": 200, "Routes": 200, "Catalogue": 200, "Costs": 50, "Text": 50}
"""Rows of each table that are prepared; a longer table is read all the same."""
RUN_ASSESS = "run assess"
"""What the live columns show of a floor whose motion only the program computes: from a record, by interpolation, by a
code's profile."""
NO_SHAKING = "needs shaking"
"""What they show of a floor that nothing serves: `assess run` would name it in an error."""
NO_UNIT = "unit?"
"""What they show where the bracket of a header holds no unit that is known."""
WRONG = "check"
"""What they show where a cell holds no number, or one that the program refuses."""
EMPTY = '""'
"""A blank text in a formula."""
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
    "Catalogue": ("type", *_TYPE_SIZES, CENTRE, "mobile"),
}
"""Fields of which a helper column is computed; their columns are named after them."""
_FLOOR_HELPERS = (
    "key", "own_pfa_x", "own_pfa_y", "own_pfv_x", "own_pfv_y", "z", "at_grade", "place", "place_at", "place_part",
    "pfv_own_x", "pfv_own_y", "beam_pfa", "beam_pfv", "spread", "hint", "pfa_x", "pfa_y", "pfv_x", "pfv_y", "best",
)  # fmt: skip
"""Columns of the sheet for a row of Floors, in this order: its name, its own motion by axis; Elevation [m], whether it
has a motion of its own at grade, z/h, and where that lies in the table; PFV of a typed PFA, what follows from the
ground, and the variance of ln of what is drawn; what it shows if it has no motion, and what serves each axis."""
_TYPE_HELPERS = ("key", *_TYPE_SIZES, CENTRE, "mobile")
"""Columns of the sheet for a row of the Catalogue: name, sizes [cm], centre of gravity [-], whether on castors."""
_SPEED = 100 * GRAVITY
"""From s to cm/s per g."""
_COLUMNS = len(medians.PLACES) + 1
_BLOCK = len(medians.RATIOS) * (len(medians.PERIODS) + 1)
_NUMBERS = ("ground_pga", "ground_pgv", "sds", "height", "storeys", "period", "motion_uncertainty")
"""Numbers of Building that are read."""
_OWNING = '(floor_key<>0)*(1-(floor_own_pfa_x="")*(floor_own_pfa_y=""))'
"""Which floors have a motion of their own."""


@dataclass(frozen=True, slots=True)
class ListsWriter:
    """Writes the sheet and defines its names; `last` tells the last row of each table."""

    book: Any
    page: Any
    title: Any
    units: Units
    last: Mapping[str, int]

    def write(self) -> None:
        """Write everything, one block next to the other."""
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
        # the table of floor medians by structure, period and PGV/PGA of the ground, and the scales that it is read by
        scales = {
            "structure_rows": [medians.STRUCTURES.index(medians.ALIKE.get(one, one)) * _BLOCK for one in STIFFNESS],
            "table_periods": medians.PERIODS,
            "table_ratios": [one * _SPEED for one in medians.RATIOS],
            "table_places": (0.0, *medians.PLACES),
        }
        at = self._write_columns(at + 1, [(name, name, values) for name, values in scales.items()])
        table = medians.read_table()
        rows = [row.T.ravel().tolist() for one in medians.STRUCTURES for by_ratio in table[one] for row in by_ratio]
        for number, row in enumerate(rows, 3):
            self.page.write_row(number, at, row)
        first, last = xl_col_to_name(at), xl_col_to_name(at + len(rows[0]) - 1)
        # some blank rows belong to it, of which the weight is 0
        self._name("floor_table", LISTS, first, 4, 5 + len(rows) + len(medians.RATIOS), last)
        at += len(rows[0]) + 1
        for quantity in LISTED:
            units = dict(QUANTITIES[quantity])
            units |= {other: units[unit] for other, unit in ALIASES.items() if unit in units}
            self.page.write_column(2, at, (gettext(quantity), *units))
            self.page.write_column(2, at + 1, ("SI", *units.values()))
            self._name(f"units_{quantity}", LISTS, xl_col_to_name(at), 4, 3 + len(units), xl_col_to_name(at + 1))
            at += 2
        at = self._write_definitions(at + 1)
        at = self._write_columns(at + 1, [(name, name, values) for name, values in _list_nodes()])
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

    def _write_definitions(self, at: int) -> int:
        """Write cells that have a name each: factors of headers, words, the scenario, the ground and the building."""
        self.page.write_row(2, at, (gettext("header"), gettext("factor")))
        letter, sheets = xl_col_to_name(at + 1), {sheet.name: sheet for sheet in SHEETS}
        rows: list[tuple[str, str, str, Any]] = []  # a name, its label, the formula, and the result that is stored
        for name, field in _NEEDED_FACTORS:
            column = sheets[name].column(field)
            at_head = f"$A${_line(field)}" if sheets[name] is BUILDING else f"{LETTERS[name, field]}$1"
            cell = f"{gettext(name)}!{at_head}"
            start = f'FIND("[",{cell})'
            unit = f'LOWER(SUBSTITUTE(MID({cell},{start}+1,FIND("]",{cell})-{start}-1)," ",""))'
            factor = QUANTITIES[column.quantity][column.header(self.units).partition("[")[2].rstrip("]")]
            formula = f"IFERROR(VLOOKUP({unit},units_{column.quantity},2,FALSE),{quote(NO_UNIT)})"
            label = f"{gettext(name)}: {gettext(column.label)}"
            rows.append((f"unit_{name.lower()}_{field}", label, formula, factor))
        sizes = (f"unit_{sheet}_{name}" for sheet in ("items", "catalogue") for name in ("breadth", "height"))
        formula = f'IF(OR({",".join(f"ISTEXT({size})" for size in sizes)}),{quote(NO_UNIT)},"")'
        rows.append(("sizes_unit", gettext("unknown unit of a size"), formula, ""))
        for name, label, words in (
            ("anchored_words", gettext("words for anchored"), list_words(ANCHORED, YES)),
            ("mobile_words", gettext("words for mobile"), list_words((YES, NO), YES)),
            ("scanned_words", gettext("words for sizes by a scan"), list_words(SIZES_FROM, SCANNED)),
        ):
            rows.append((name, label, f'"{words}"', words))
        # the kind of scenario as choices are compared, and whether floors' own values serve it
        typed, kind = (f"${letter}${4 + len(rows) + line}" for line in range(2))
        plain = f"LOWER({gettext(BUILDING.name)}!$B${_line('scenario_kind')})"
        for sign in (" ", "\u00a0", "-", "_"):
            plain = f'SUBSTITUTE({plain},"{sign}","")'
        english = typed  # by its English name, where it was typed by that of the language in use
        for known, name in _OWN_SCENARIOS.items():
            own = gettext(name).lower().replace(" ", "").replace("-", "")
            english = english if own == known else f'IF({typed}="{own}","{known}",{english})'
        served = ",".join(f'{kind}="{one}"' for one in ("", *_OWN_SCENARIOS))
        rows.append(("scenario_typed", "scenario_typed", plain, ""))
        rows.append(("scenario_kind", "scenario_kind", english, ""))
        rows.append(("scenario_is_own", "scenario_is_own", f"IF(OR({served}),1,0)", 1))
        building = {column.name: f"{gettext(BUILDING.name)}!$B${_line(column.name)}" for column in BUILDING.columns}
        rows += [(name, name, formula, "") for name, formula in _list_building(building)]
        for row, (name, label, formula, value) in enumerate(rows, 4):
            self.page.write_string(row - 1, at, label)
            self.page.write_formula(row - 1, at + 1, f"={formula}", None, value)
            self.book.define_name(name, f"={gettext(LISTS)}!${letter}${row}")
        return at + 2

    def _write_rows(
        self, at: int, sheet: str, prefix: str, names: Sequence[str],
        helpers: Callable[[Mapping[str, str]], Iterator[str]],
    ) -> int:  # fmt: skip
        """Write the helper columns of a table from column `at`; those of a row stand in the row of the same number.

        `helpers` yields the formulas of a row, by the cells that they are written to. The names that are defined begin
        in row 1, so that what is found is the number of the row. The header of the keys stays blank: it would be found
        as a name.
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


def _line(name: str) -> int:
    return BUILDING.columns.index(BUILDING.column(name)) + 1


# ---------------------------------------------------------------- the ground and the building


def _list_building(building: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield names and the formulas that they stand for, each from those before it; `building` are cells by field."""
    wrong, run_assess, periods, ratios = quote(WRONG), quote(RUN_ASSESS), len(medians.PERIODS), len(medians.RATIOS)
    for name in _NUMBERS:
        cell, column, unit = building[name], BUILDING.column(name), f"unit_building_{name}"
        number = f"{cell}*{unit}" if column.quantity else cell
        found = f"IF({between(number, column)},{number},{wrong})"
        read = f"IFERROR({found},{unit})" if column.quantity else found
        yield f"given_{name}", f'IF(TRIM({cell})="","",IF(ISNUMBER({cell}),{read},{wrong}))'
    yield from _list_ground(building)
    # The helper columns of the floors begin with their headers, which count as neither.
    yield "floors_owning", f"SUMPRODUCT({_OWNING})"
    yield "floors_recorded", f"COUNTIF(floor_own_pfa_x,{run_assess})+COUNTIF(floor_own_pfa_y,{run_assess})"
    yield "grade_row", "IFERROR(MATCH(1,floor_at_grade,0),0)"
    for axis, other in ("xy", "yx"):
        own = f'INDEX(floor_own_pfa_{axis},grade_row)=""'
        pfa, pfv = (
            f"IF({own},INDEX(floor_{name}_{other},grade_row),INDEX(floor_{name}_{axis},grade_row))"
            for name in ("own_pfa", "own_pfv")
        )
        paired = f'IF({pfv}="",{RATIO * _SPEED!r},IF(ISNUMBER({pfv}),{pfv}/({pfa}),{pfv}))'
        at_grade = f"IF(ISNUMBER({pfa}),{paired},{pfa})"
        yield f"ratio_{axis}", f"IF(shakemap_named,{run_assess},IF(grade_row=0,ground_ratio,{at_grade}))"
    by_storeys = f"IF(ISNUMBER(given_storeys),MAX(0,floor_z,{STOREY!r}*given_storeys),given_storeys)"
    by_floors = f'IF(given_storeys="",MAX(0,floor_z),{by_storeys})'
    yield "building_roof", f'IF(given_height="",{by_floors},given_height)'
    by_height = f'IF(building_roof>0,{LONGER * CODE_FACTOR!r}*building_roof^{CODE_POWER!r},"")'
    found = f"IF(ISNUMBER(building_roof),{by_height},building_roof)"
    yield "building_period", f'IF(given_period="",{found},given_period)'
    structure, formula = (find_row(trim(building[name]), f"list_{name}") for name in ("structure", "class_by"))
    found = f"IFERROR(INDEX(structure_rows,{structure}),{wrong})"
    yield "structure_row", f'IF({trim(building["structure"])}="",0,{found})'
    yield "class_by", f'IF({trim(building["class_by"])}="",1,IFERROR({formula},{wrong}))'
    is_wrong = 'AND(ISTEXT(building_period),building_period<>"")'
    yield "building_fault", f"IF({is_wrong},building_period,{wrong})"
    within = f"MIN(IFERROR(MATCH(building_period,table_periods,1),1),{periods - 1})-1"
    yield "period_at", f'IF(building_period="",{periods},{within})'
    yield "period_part", f'IF(building_period="",0,{_find_part("building_period", "table_periods", "period_at")})'
    for axis in "xy":
        ratio = f"ratio_{axis}"
        yield f"ratio_{axis}_at", f"MIN(IFERROR(MATCH({ratio},table_ratios,1),1),{ratios - 1})-1"
        yield f"ratio_{axis}_part", _find_part(ratio, "table_ratios", f"ratio_{axis}_at")
    named = ("ground_pga", "ground_pgv", "sds", "shakemap", "shaking")
    yield "ground_named", f"OR({','.join(f'TRIM({building[name]})<>{EMPTY}' for name in named)})"
    yield "storeys_serve", 'AND(given_storeys<>"",COUNTIF(floor_z,">0")=0)'


def _list_ground(building: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    run_assess = quote(RUN_ASSESS)
    is_blank = 'AND(given_ground_pga="",given_sds="")'
    yield "shakemap_named", f'AND({is_blank},TRIM({building["shakemap"]})<>"")'
    typed = trim(building["shaking"])
    # A choice that is not found may be one that the program knows.
    chosen = f'IF({typed}="",0,IFERROR({find_row(typed, "list_shaking")},{run_assess}))'
    yield "shaking_at", f"IF(AND({is_blank},NOT(shakemap_named)),{chosen},0)"
    by_class = 'IF(shaking_at>0,INDEX(shakings_pgv,shaking_at),"")'
    in_cm = "IF(ISNUMBER(given_ground_pgv),given_ground_pgv*100,given_ground_pgv)"
    yield "ground_pgv", f'IF(given_ground_pgv="",IF(ISNUMBER(shaking_at),{by_class},shaking_at),{in_cm})'
    in_g = f"IF(ISNUMBER(given_ground_pga),given_ground_pga/{GRAVITY!r},given_ground_pga)"
    by_sds = f"IF(ISNUMBER(given_sds),{PGA_OF_SDS!r}*given_sds/{GRAVITY!r},given_sds)"
    by_class = 'IF(shaking_at>0,IF(INDEX(shakings_derived,shaking_at)=1,"",INDEX(shakings_pga,shaking_at)),"")'
    assumed = f"IF(ISNUMBER(shaking_at),{by_class},shaking_at)"
    yield "known_pga", f'IF({is_blank},{assumed},IF(given_ground_pga="",{by_sds},{in_g}))'
    usual = f"{RATIO * _SPEED!r}"
    by_ratio = f"IF(ISNUMBER(ground_pgv),ground_pgv/{usual},ground_pgv)"
    yield "ground_pga", f'IF(shakemap_named,{run_assess},IF(known_pga="",{by_ratio},known_pga))'
    paired = "IF(ISNUMBER(known_pga),IF(ISNUMBER(ground_pgv),ground_pgv/known_pga,ground_pgv),known_pga)"
    yield "ground_ratio", f'IF(OR(known_pga="",ground_pgv=""),{usual},{paired})'
    yield "own_spread", 'IF(given_motion_uncertainty="",0,given_motion_uncertainty)'
    by_class = "IF(shaking_at>0,INDEX(shakings_scatter,shaking_at),0)"
    known = f"IF(ISNUMBER(shaking_at),MAX(own_spread,{by_class}),shaking_at)"
    yield "ground_spread", f"IF(ISNUMBER(own_spread),{known},own_spread)"
    yield "ground_peak", f'IF(known_pga="",{RATIO_SCATTER!r},0)'


def _find_part(value: str, nodes: str, at: str) -> str:
    low, high = f"LN(INDEX({nodes},{at}+1))", f"LN(INDEX({nodes},{at}+2))"
    return f"MAX(0,MIN(1,(LN({value})-{low})/({high}-{low})))"


def _list_nodes() -> Iterator[tuple[str, list[str]]]:
    """Yield by axis formulas for PFA/PGA, and PFV/PGV, at grade, at each z/h of the table, and at an unknown one."""
    for axis, (quantity, peak) in product("xy", enumerate("av")):
        row = f"structure_row+period_at*{len(medians.RATIOS)}+ratio_{axis}_at+1"
        formulas = ["=1"]
        for column in range(quantity * _COLUMNS + 1, (quantity + 1) * _COLUMNS + 1):
            near, far = (
                f"((1-ratio_{axis}_part)*INDEX(floor_table,{row}+{low},{column})"
                f"+ratio_{axis}_part*INDEX(floor_table,{row}+{low + 1},{column}))"
                for low in (0, len(medians.RATIOS))
            )
            formulas.append(f"=(1-period_part)*{near}+period_part*{far}")
        yield f"nodes_{axis}_{peak}", formulas


# ---------------------------------------------------------------- rows of Floors and of the Catalogue


def _of_floor(cells: Mapping[str, str]) -> Iterator[str]:
    wrong, run_assess = quote(WRONG), quote(RUN_ASSESS)
    yield _key(_typed("floor"))
    for axis in "xy":
        pfa, unit = _typed(f"pfa_{axis}"), f"unit_floors_pfa_{axis}"
        inside = between(f"{pfa}*{unit}", FLOORS.column(f"pfa_{axis}"))
        number = f"IFERROR(IF({inside},{pfa}*{unit}/{GRAVITY!r},{wrong}),{unit})"
        given = f'IF(scenario_kind="recorded","",{_if_number(pfa, number)})'
        aside = f'AND(TRIM({_typed(f"record_{axis}")})<>"",scenario_kind<>"given")'
        yield f'IF(OR({cells["key"]}=0,scenario_is_own=0),"",IF({aside},{run_assess},{given}))'
    for axis in "xy":
        pfv, unit = _typed(f"pfv_{axis}"), f"unit_floors_pfv_{axis}"
        inside = between(f"{pfv}*{unit}", FLOORS.column(f"pfv_{axis}"))
        given = _if_number(pfv, f"IFERROR(IF({inside},{pfv}*{unit}*100,{wrong}),{unit})")
        yield f'IF(ISNUMBER({cells[f"own_pfa_{axis}"]}),{given},"")'
    elevation, unit = _typed("elevation"), "unit_floors_elevation"
    z, place, at, number = cells["z"], cells["place"], cells["place_at"], f"{elevation}*{unit}"
    found = f"IFERROR(IF({between(number, FLOORS.column('elevation'))},{number},{wrong}),{unit})"
    yield f'IF({cells["key"]}=0,"",{_if_number(elevation, found)})'
    own = f'OR({cells["own_pfa_x"]}<>"",{cells["own_pfa_y"]}<>"")'
    yield f"IF(AND(ISNUMBER({z}),{own}),IF({z}<=0,1,0),0)"
    above = f"IF(ISNUMBER(building_roof),MIN({z}/building_roof,1),building_roof)"
    blank = f'IF({z}="",IF(storeys_serve,{run_assess},""),{z})'
    yield f"IF(ISNUMBER({z}),IF({z}<=0,0,{above}),{blank})"
    yield f'IF(ISNUMBER({place}),MIN(MATCH({place},table_places,1),{len(medians.PLACES)}),"")'
    low, high = f"INDEX(table_places,{at})", f"INDEX(table_places,{at}+1)"
    yield f'IF(ISNUMBER({place}),({place}-{low})/({high}-{low}),"")'
    yield from _list_served(cells)
    yield f"IF({_could_serve(z)},{run_assess},{quote(NO_SHAKING)})"
    for what in (
        "pfa",
        "pfv",
    ):  # where one axis alone is known, it serves both; where PFV is not known, the floor is not
        for axis, other in ("xy", "yx"):
            own, others, pfv = (cells[name] for name in (f"own_pfa_{axis}", f"own_pfa_{other}", f"pfv_own_{axis}"))
            pfa = f'IF({own}="",{others},{own})'
            number = f"IF(ISNUMBER({pfv}),{pfa},{pfv})" if what == "pfa" else pfv
            beam, hint = cells[f"beam_{what}"], cells["hint"] if what == "pfa" else EMPTY
            nothing = f'IF({beam}="",{hint},{beam})'
            yield f'IF(AND({own}="",{others}=""),{nothing},IF(ISNUMBER({pfa}),{number},{pfa}))'
    (x, y), speeds = ([cells[f"{peak}_{axis}"] for axis in "xy"] for peak in ("pfa", "pfv"))
    worse = f"IF(class_by=2,{worse_axis(x, y)},{worse_axis(*speeds)})"
    yield f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),{worse},"Y"),"X")'


def _list_served(cells: Mapping[str, str]) -> Iterator[str]:
    """Yield PFV of a typed PFA by axis, what follows from the ground, and the variance of ln of what is drawn."""
    place = cells["place"]
    fault = f'IF(AND(ISTEXT({place}),{place}<>""),{place},building_fault)'
    for axis, other in ("xy", "yx"):
        own, others = cells[f"own_pfa_{axis}"], cells[f"own_pfa_{other}"]
        pfa = f'IF({own}="",{others},{own})'
        pfv = f'IF({own}="",{cells[f"own_pfv_{other}"]},{cells[f"own_pfv_{axis}"]})'
        speed = f"ratio_{axis}*({_read('v', axis, cells)})/({_read('a', axis, cells)})"
        found = f"IF(ISNUMBER(ratio_{axis}),IFERROR({pfa}*{speed},{fault}),ratio_{axis})"
        yield f'IF(ISNUMBER({pfa}),IF({pfv}="",{found},{pfv}),"")'
    for peak, ground in (("a", "ground_pga"), ("v", "ground_pga*ratio_x")):
        serves = 'AND(floors_owning=0,scenario_kind<>"recorded",scenario_kind<>"given",scenario_is_own=1)'
        found = f"IF(ISNUMBER(ratio_x),IFERROR({ground}*({_read(peak, 'x', cells)}),{fault}),ratio_x)"
        yield f'IF({serves},IF(ISNUMBER(ground_pga),{found},ground_pga),"")'
    typed = f'IF(given_motion_uncertainty="",IF(floors_recorded>0,{MOTION!r},0),own_spread)^2'
    beam = f"ground_spread^2+IF({place}=0,ground_peak,{medians.SCATTER!r})^2"
    yield f"IF(ISNUMBER({cells['beam_pfa']}),{beam},{typed})"


def _read(peak: str, axis: str, cells: Mapping[str, str]) -> str:
    """Expression for PFA/PGA ("a") or PFV/PGV ("v") of a floor; an error where its z/h is a word."""
    nodes, at = f"nodes_{axis}_{peak}", cells["place_at"]
    along = f"INDEX({nodes},{at})+{cells['place_part']}*(INDEX({nodes},{at}+1)-INDEX({nodes},{at}))"
    return f'IF({cells["place"]}="",INDEX({nodes},{_COLUMNS + 1}),{along})'


def _could_serve(z: str) -> str:
    """Return an expression for whether the ground or other floors could serve a floor, by all that is filled in."""
    placed = f'{_OWNING}*(floor_z<>"")'
    # A floor at grade is the ground of those below it, too.
    limits = f"<=MAX(0,{z})", f">={z}"
    below, above = (f"SUMPRODUCT({placed}*(ISTEXT(floor_z)+(floor_z{limit})>0))" for limit in limits)
    by_code = f'AND(ground_named,OR({z}<>"",storeys_serve))'
    by_storeys = f'AND({z}="",storeys_serve,ground_named,floors_owning>0)'
    between_floors = f'OR({by_storeys},AND({z}<>"",{above}>0,OR(ground_named,{below}>0)))'
    by_number = "AND(storeys_serve,floors_owning>0)"
    beside_floors = f'OR(ground_named,grade_row>0,{by_number},AND({z}<>"",SUMPRODUCT({placed})>0))'
    is_own = 'OR(scenario_kind="recorded",scenario_kind="given")'
    return f"IF(scenario_is_own=0,{by_code},IF({is_own},{between_floors},{beside_floors}))"


def _of_type(cells: Mapping[str, str]) -> Iterator[str]:
    yield _key(_typed("type"))
    for name in _TYPE_SIZES:
        yield _if_number(_typed(name), f"IFERROR({_typed(name)}*unit_catalogue_{name}*100,sizes_unit)")
    centre, unit = _typed(CENTRE), f"unit_catalogue_{CENTRE}"
    share = f"IF({between(f'{centre}*{unit}', CATALOGUE.column(CENTRE))},{centre}*{unit},{quote(WRONG)})"
    yield _if_number(centre, f"IFERROR({share},{unit})", repr(MIDDLE))
    yield is_among(_typed("mobile"), "mobile_words")


def _typed(name: str) -> str:
    """Refer to a cell of Floors or the Catalogue so that rows inserted or sorted there do not move the reference."""
    return f"INDEX(typed_{name},{ROW})"


def _key(cell: str) -> str:
    return f'IF({cell}="",0,{trim(cell)})'


def _if_number(cell: str, number: str, blank: str = EMPTY) -> str:
    """Expression for what is shown of a cell: of a number, of a blank cell, and `WRONG` of anything else."""
    return f'IF(ISNUMBER({cell}),{number},IF(TRIM({cell})="",{blank},{quote(WRONG)}))'
