"""The workbook that `assess new` writes: drop-downs, units, help, and columns that compute as one types.

Everything is derived from `columns`. The sheet Lists holds what the drop-downs and formulas refer to: the choices, the
factor that each header's bracket stands for, and for every row of Floors the PFA and PFV that serve each axis.
"""

from collections.abc import Mapping, Sequence
from csv import DictReader
from dataclasses import dataclass, field
from importlib.resources import files
from io import StringIO
from pathlib import Path
from typing import Any, Literal

import xlsxwriter
from xlsxwriter.utility import xl_col_to_name

from assess.inventory import live
from assess.inventory.columns import CATALOGUE, LIVE, SHEETS, Column, Sheet
from assess.inventory.helptext import FIRST_LINES, LISTS_NOTE
from assess.motion.estimate import HIGHEST_FLOOR_FREQUENCY
from assess.risk import RiskClass
from assess.settings import Settings
from assess.units import GRAVITY, QUANTITIES

Units = Literal["si", "imperial"]
Rows = Sequence[Mapping[str, Any]]

ROWS = {"Floors": 100, "Items": 500, "Places": 200, "Routes": 200, "Catalogue": 200}
"""Rows of each table that are prepared; a longer table is read all the same."""

_NEEDED_FACTORS = (
    ("Items", "breadth"), ("Items", "height"), ("Catalogue", "breadth"), ("Catalogue", "height"),
    ("Floors", "pfa_x"), ("Floors", "pfa_y"), ("Floors", "pfv_x"), ("Floors", "pfv_y"), ("Building", "period"),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Content:
    """What to fill in: rows by sheet, each a value by field name in the units of the headers.

    `live` holds the results of the live columns, one sequence an item, stored so that a viewer that does not
    calculate shows them.
    """

    rows: Mapping[str, Rows] = field(default_factory=dict)
    live: Sequence[Sequence[float | str]] = ()


def read_catalogue(units: Units = "si") -> list[dict[str, Any]]:
    """Return the built-in types of furniture, sizes in the units of the headers (cm or in)."""
    text = (files("assess.inventory") / "catalogue.csv").read_text(encoding="utf-8")
    scale = 1 if units == "si" else 1 / 2.54
    rows = []
    for line in DictReader(StringIO(text)):
        row: dict[str, Any] = {"type": line["type"], "source": line["source"]}
        for name in ("breadth", "width", "height"):
            if line[f"{name}_cm"]:
                row[name] = round(float(line[f"{name}_cm"]) * scale, 2)
        rows.append(row)
    return rows


def write_workbook(path: Path, content: Content | None = None, units: Units = "si") -> None:
    """Write a workbook to fill in, or one that is filled in already.

    Parameters
    ----------
    path : Path
        Where to; overwritten.
    content : Content, optional
        What to fill in; an empty workbook still has the catalogue.
    units : "si" or "imperial"
        Of the headers.
    """
    content = content or Content()
    with xlsxwriter.Workbook(path, {"strings_to_formulas": False, "strings_to_urls": False}) as book:
        book.set_properties({"title": "Furniture inventory", "comments": "Made with assess new"})
        _Writer(book, content, units).write()


class _Writer:
    """Writes the sheets of one workbook; holds its formats and names."""

    def __init__(self, book: Any, content: Content, units: Units) -> None:
        self.book, self.content, self.units = book, content, units
        self.head = book.add_format({"bold": True, "bg_color": "#1f3a4d", "font_color": "#ffffff", "text_wrap": True,
                                     "valign": "top", "border": 1})  # fmt: skip
        self.live_head = book.add_format({"bold": True, "bg_color": "#5b6b76", "font_color": "#ffffff", "text_wrap": True,
                                          "valign": "top", "border": 1})  # fmt: skip
        self.text = book.add_format({"num_format": "@"})
        self.live_formats = [book.add_format({"num_format": code, "bg_color": "#f1f3f5"}) for code in
                             ("0.000", "0.000", "0.00", "0.00", "General")]  # fmt: skip
        self.title = book.add_format({"bold": True, "font_size": 14})
        self.wrap = book.add_format({"text_wrap": True, "valign": "top"})
        self.bold = book.add_format({"bold": True, "valign": "top"})
        self.letters = {
            (sheet.name, column.name): xl_col_to_name(at) for sheet in SHEETS for at, column in enumerate(sheet.columns)
        }

    def write(self) -> None:
        help_sheet = self.book.add_worksheet("Help")
        pages = {sheet.name: self.book.add_worksheet(sheet.name) for sheet in SHEETS}
        lists = self.book.add_worksheet("Lists")
        self._write_lists(lists)
        self._write_help(help_sheet)
        for sheet in SHEETS:
            write = self._write_form if sheet.layout == "form" else self._write_table
            write(pages[sheet.name], sheet)
        self._write_live(pages["Items"])
        pages["Items"].activate() if self.content.rows else help_sheet.activate()

    # ------------------------------------------------------------ sheets to fill

    def _write_form(self, page: Any, sheet: Sheet) -> None:
        values = (self._rows(sheet) or [{}])[0]
        page.set_column(0, 0, 22)
        page.set_column(1, 1, 44)
        page.set_column(2, 2, 80, self.wrap)
        for at, column in enumerate(sheet.columns):
            page.write_string(at, 0, column.header(self.units), self.head)
            self._write_cell(page, at, 1, column, values.get(column.name))
            page.write_string(at, 2, column.help)
            self._validate(page, column, at, 1, at)

    def _write_table(self, page: Any, sheet: Sheet) -> None:
        rows = self._rows(sheet)
        last = max(ROWS[sheet.name], len(rows))
        for at, column in enumerate(sheet.columns):
            page.set_column(at, at, column.width, self.text if column.kind == "text" else None)
            page.write_string(0, at, column.header(self.units), self.head)
            self._validate(page, column, 1, at, last)
        for number, row in enumerate(rows, 1):
            for at, column in enumerate(sheet.columns):
                self._write_cell(page, number, at, column, row.get(column.name))
        page.freeze_panes(1, 1)
        page.autofilter(0, 0, last, len(sheet.columns) - 1 + (len(LIVE) if sheet.name == "Items" else 0))
        page.set_landscape()
        page.fit_to_pages(1, 0)
        page.repeat_rows(0)
        page.set_footer("&C&A, page &P of &N")

    def _rows(self, sheet: Sheet) -> Rows:
        rows = self.content.rows.get(sheet.name, ())
        return read_catalogue(self.units) if sheet is CATALOGUE and not rows else rows

    def _write_cell(self, page: Any, row: int, at: int, column: Column, value: Any) -> None:
        if isinstance(value, str):
            page.write_string(row, at, value, self.text)
        elif value is not None:
            page.write_number(row, at, value)
        elif column.kind == "text":
            page.write_blank(row, at, None, self.text) if row <= ROWS.get(page.name, 1) else None

    def _validate(self, page: Any, column: Column, row: int, at: int, last: int) -> None:
        """Attach the drop-down or the check of a number, and the input message."""
        options: dict[str, Any] = {
            "input_title": column.label[:32],
            "input_message": _message(column),
            "ignore_blank": True,
        }
        if column.choices:
            options |= {"validate": "list", "source": f"=list_{_slug(column)}"}
        elif column.source:
            options |= {"validate": "list", "source": f"=list_{column.source.lower()}", "error_type": "warning"}
        elif column.kind == "count":
            options |= {"validate": "integer", "criteria": "between", "minimum": column.low, "maximum": column.high}
        elif column.kind == "number":
            options |= {"validate": "decimal", "criteria": ">", "value": -1e9, "error_message": "Type a number."}
        else:
            options |= {"validate": "any"}
        page.data_validation(row, at, last, at, options)

    # --------------------------------------------------------------- live columns

    def _write_live(self, page: Any) -> None:
        first = len(next(sheet for sheet in SHEETS if sheet.name == "Items").columns)
        for at, label in enumerate(LIVE):
            page.write_string(0, first + at, label, self.live_head)
            page.set_column(first + at, first + at, 16 if at == len(LIVE) - 1 else 10)
        page.write_comment(0, first + 4, f"Computed by Excel from this row. {live.OUTSIDE} behind a class: outside the "
                           "range in which the formula was checked by tests.", {"x_scale": 2})  # fmt: skip
        last = max(ROWS["Items"], len(self._rows(SHEETS[2])))
        for row in range(2, last + 2):
            stored = self.content.live[row - 2] if row - 2 < len(self.content.live) else [""] * len(LIVE)
            for at, formula in enumerate(self._live_row(row, first)):
                page.write_formula(row - 1, first + at, formula, self.live_formats[at], stored[at])
        column = xl_col_to_name(first + 4)
        for risk in reversed(RiskClass):
            form = self.book.add_format({"bg_color": risk.fill, "font_color": risk.ink, "bold": risk >= RiskClass.HIGH})
            page.conditional_format(
                f"{column}2:{column}{last + 1}",
                {"type": "text", "criteria": "begins with", "value": risk.symbol, "format": form, "stop_if_true": True},
            )
        wrong = self.book.add_format({"bg_color": "#ffc7ce"})
        page.conditional_format(f"A2:A{last + 1}", {"type": "duplicate", "format": wrong})
        page.conditional_format(
            f"B2:B{last + 1}", {"type": "formula", "criteria": '=AND($A2<>"",$B2="")', "format": wrong}
        )

    def _live_row(self, row: int, first: int) -> list[str]:
        """Return the five formulas of one row of Items."""
        ratio, pfa, risk = (f"${xl_col_to_name(first + at)}{row}" for at in (0, 1, 2))
        breadth, height = (self._size(name, row) for name in ("breadth", "height"))
        units = ",".join(
            f"ISTEXT(unit_{sheet}_{name})" for sheet in ("items", "catalogue") for name in ("breadth", "height")
        )
        sizes = f'IF(OR({units}),"unit?",IFERROR(IF(OR({breadth}<=0,{height}<=0),"",{breadth}/{height}),"check"))'
        settings = Settings()
        zetas = (repr(settings.zeta_acceleration), repr(settings.zeta_velocity), repr(settings.slide_coefficient))
        risks = live.kaneko_hayashi(ratio, f"({height}*100)", pfa, self._serving("pfv", row), *zetas)
        return [
            f'=IF($A{row}="","",{sizes})',
            f'=IF($A{row}="","",IFERROR({self._serving("pfa", row)},"floor?"))',
            _ready(ratio, pfa, live.proposed_or(ratio, pfa)),
            _ready(ratio, pfa, risks),
            f"=IF(ISNUMBER({risk}),{live.risk_class(risk, ratio, pfa)},{risk})",
        ]

    def _size(self, name: str, row: int) -> str:
        """Expression for a size in m: the row's own, else its type's, else 0."""
        own, last = f"${self.letters['Items', name]}{row}", ROWS["Catalogue"] + 1
        kind, column = f"${self.letters['Items', 'type']}{row}", self.letters["Catalogue", name]
        listed = f"INDEX(Catalogue!${column}$2:${column}${last},MATCH({kind},Catalogue!$A$2:$A${last},0))"
        return f'IF({own}="",IFERROR({listed}*unit_catalogue_{name},0),{own}*unit_items_{name})'

    def _serving(self, what: str, row: int) -> str:
        """Expression for the PFA [g] or PFV [cm/s] that governs a row, from the helper columns of Lists."""
        axis, angle, floor = (f"${self.letters['Items', name]}{row}" for name in ("axis", "angle_deg", "floor"))
        last = ROWS["Floors"] + 1
        match = f"MATCH({floor},Floors!$A$2:$A${last},0)"
        turned = f'IF(ABS(MOD({angle}+90,180)-90)<=15,"X",IF(ABS(MOD({angle},180)-90)<=15,"Y",""))'
        own = f'IF({axis}<>"",{axis},IF({angle}="","",{turned}))'
        chosen = f'IF({own}="",INDEX(floor_best,{match}),{own})'
        return f'IF({chosen}="X",INDEX(floor_{what}_x,{match}),INDEX(floor_{what}_y,{match}))'

    # ---------------------------------------------------------------------- lists

    def _write_lists(self, page: Any) -> None:
        page.write_string(0, 0, LISTS_NOTE, self.title)
        at = self._write_choices(page)
        at = self._write_units(page, at + 1)
        at = self._write_factors(page, at + 1)
        self._write_floor_helpers(page, at + 1)
        for name in ("Floors", "Catalogue", "Places", "Routes"):
            self._name(f"list_{name.lower()}", name, "A", 2, ROWS[name] + 1)
        for name in ("period", "scenario_kind"):
            row = [column.name for column in SHEETS[0].columns].index(name) + 1
            self.book.define_name(name, f"=Building!$B${row}")

    def _name(self, name: str, sheet: str, column: str, first: int, last: int) -> None:
        self.book.define_name(name, f"={sheet}!${column}${first}:${column}${last}")

    def _write_choices(self, page: Any) -> int:
        chosen = {_slug(column): column for sheet in SHEETS for column in sheet.columns if column.choices}
        for at, (slug, column) in enumerate(chosen.items()):
            page.write_column(2, at, (column.label, *column.choices))
            self._name(f"list_{slug}", "Lists", xl_col_to_name(at), 4, 3 + len(column.choices))
        return len(chosen)

    def _write_units(self, page: Any, at: int) -> int:
        for quantity in ("length", "acceleration", "velocity", "time"):
            units = dict(QUANTITIES[quantity]) | {
                unit.replace("s2", "s²"): factor for unit, factor in QUANTITIES[quantity].items()
            }
            page.write_column(2, at, (quantity, *units))
            page.write_column(2, at + 1, ("SI", *units.values()))
            first, second = xl_col_to_name(at), xl_col_to_name(at + 1)
            self.book.define_name(f"units_{quantity}", f"=Lists!${first}$4:${second}${3 + len(units)}")
            at += 2
        return at

    def _write_factors(self, page: Any, at: int) -> int:
        """Write the factor of every header that a live formula needs, read from the header's own bracket."""
        page.write_row(2, at, ("header", "factor"))
        for row, (sheet_name, name) in enumerate(_NEEDED_FACTORS, 4):
            sheet = next(sheet for sheet in SHEETS if sheet.name == sheet_name)
            column = sheet.column(name)
            line = sheet.columns.index(column) + 1
            header = (
                f"Building!$A${line}" if sheet.layout == "form" else f"{sheet_name}!{self.letters[sheet_name, name]}$1"
            )
            page.write_string(row - 1, at, f"{sheet_name}: {column.label}")
            unit = (
                f'LOWER(SUBSTITUTE(MID({header},FIND("[",{header})+1,FIND("]",{header})-FIND("[",{header})-1)," ",""))'
            )
            formula = f'=IFERROR(VLOOKUP({unit},units_{column.quantity},2,FALSE),"unit?")'
            factor = QUANTITIES[column.quantity][column.header(self.units).partition("[")[2].rstrip("]")]
            page.write_formula(row - 1, at + 1, formula, None, factor)
            self.book.define_name(f"unit_{sheet_name.lower()}_{name}", f"=Lists!${xl_col_to_name(at + 1)}${row}")
        return at + 2

    def _write_floor_helpers(self, page: Any, at: int) -> None:
        """Write, for every row of Floors, its own PFA and PFV on each axis and then those that serve each axis."""
        names = ("own_pfa_x", "own_pfa_y", "own_pfv_x", "own_pfv_y", "pfa_x", "pfa_y", "pfv_x", "pfv_y", "best")
        letters = {name: xl_col_to_name(at + place) for place, name in enumerate(names)}
        last = ROWS["Floors"] + 1
        page.write_row(0, at, names)
        for row in range(2, last + 1):
            cells = {name: f"${letter}{row}" for name, letter in letters.items()}
            for place, formula in enumerate(self._floor_row(row, cells)):
                page.write_formula(row - 1, at + place, f"={formula}", None, "")
        for name, letter in letters.items():
            self._name(f"floor_{name}", "Lists", letter, 2, last)

    def _floor_row(self, row: int, cells: Mapping[str, str]) -> list[str]:
        last = ROWS["Floors"] + 1

        def floor(name: str) -> str:
            letter = self.letters["Floors", name]
            return f"INDEX(Floors!${letter}$1:${letter}${last},{row})"

        own = []
        for axis in "xy":
            pfa = floor(f"pfa_{axis}")
            number = f'IF(ISTEXT(unit_floors_pfa_{axis}),"unit?",{pfa}*unit_floors_pfa_{axis}/{GRAVITY!r})'
            given = f'IF(OR({pfa}="",scenario_kind="recorded"),"",{number})'
            own.append(f'IF(AND({floor(f"record_{axis}")}<>"",scenario_kind<>"given"),"run assess",{given})')
        for axis in "xy":
            pfa, pfv = cells[f"own_pfa_{axis}"], floor(f"pfv_{axis}")
            frequency = f"MIN(1/(period*unit_building_period),{HIGHEST_FLOOR_FREQUENCY!r})"
            estimate = f'IF(ISNUMBER(period),{pfa}*{GRAVITY * 100!r}/(2*PI()*{frequency}),"")'
            given = f'IF(ISTEXT(unit_floors_pfv_{axis}),"unit?",{pfv}*unit_floors_pfv_{axis}*100)'
            own.append(f'IF(ISNUMBER({pfa}),IF({pfv}<>"",{given},{estimate}),"")')
        serving = [
            f'IF({cells[f"own_pfa_{axis}"]}="",{cells[f"own_{what}_{other}"]},{cells[f"own_{what}_{axis}"]})'
            for what in ("pfa", "pfv")
            for axis, other in ("xy", "yx")
        ]
        x, y = cells["pfa_x"], cells["pfa_y"]
        return [*own, *serving, f'IF(ISNUMBER({x}),IF(ISNUMBER({y}),IF({x}>={y},"X","Y"),"Y"),"X")']

    # ----------------------------------------------------------------------- help

    def _write_help(self, page: Any) -> None:
        page.set_column(0, 0, 14)
        page.set_column(1, 1, 22)
        page.set_column(2, 2, 90, self.wrap)
        page.hide_gridlines(2)
        page.write_string(0, 0, "Furniture in earthquakes: how to fill this in", self.title)
        row = 2
        for line in FIRST_LINES:
            page.merge_range(row, 0, row, 2, line, self.wrap)
            page.set_row(row, 15 * (1 + len(line) // 125))
            row += 1
        for at, head in enumerate(("Sheet", "Column", "What to fill in")):
            page.write_string(row + 1, at, head, self.head)
        row += 2
        for sheet in SHEETS:
            for column in sheet.columns:
                page.write_string(row, 0, sheet.name, self.bold)
                page.write_string(row, 1, column.header(self.units) + (" *" if column.required else ""), self.bold)
                page.write_string(row, 2, describe(column), self.wrap)
                row += 1


def describe(column: Column) -> str:
    """Return the help of a column with its choices and what a blank means, in one or two sentences."""
    parts = [column.help]
    if column.choices:
        parts.append(f"One of: {', '.join(column.choices)}.")
    if column.default:
        parts.append(f"Blank: {column.default}.")
    return " ".join(parts)


def _message(column: Column) -> str:
    text = describe(column)
    return text if len(text) <= 255 else text[:254] + "…"


def _slug(column: Column) -> str:
    return column.label.lower().replace(" ", "_")


def _ready(ratio: str, pfa: str, formula: str) -> str:
    """Show a result once B/H and PFA are numbers; until then what they say instead."""
    return f"=IF(ISNUMBER({ratio}),IF(ISNUMBER({pfa}),{formula},{pfa}),{ratio})"
