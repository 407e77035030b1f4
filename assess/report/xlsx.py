"""The Excel report: live formulas, so that an edited PFA, size or class limit recomputes classes and counts.

Sheets are written row by row and in little memory. Every text of the workbook goes in as text.
"""

import datetime
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import xlsxwriter
from xlsxwriter.utility import xl_col_to_name

from assess.demand import Demand
from assess.errors import OutputError
from assess.inventory.model import Axis
from assess.methods import kaneko_hayashi as kh
from assess.motion.estimate import HIGHEST_FLOOR_FREQUENCY
from assess.report import words
from assess.report.content import Content, build_content, describe_source, describe_treatment
from assess.report.data import edge
from assess.report.xlsx_items import INPUTS, item_columns, item_formula
from assess.results import Assessment
from assess.risk import LIMITS, RiskClass

HEAD = 1
"""Rows above the data of Items and Floors: the headings alone."""


def write_xlsx(assessment: Assessment, path: Path) -> None:
    """Write report.xlsx.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    content = build_content(assessment)
    options = {
        "constant_memory": True,
        "strings_to_formulas": False,
        "strings_to_urls": False,
        "strings_to_numbers": False,
    }
    try:
        with xlsxwriter.Workbook(path, options) as book:
            created = datetime.datetime.fromisoformat(content.date)
            book.set_properties({"title": "Furniture in earthquakes: report", "created": created})
            _Book(book, content).write()
    except xlsxwriter.exceptions.XlsxWriterException as error:
        cause = error.__cause__ or error.__context__
        raise (
            cause if isinstance(cause, OSError) else OutputError(f"report.xlsx could not be written: {error}")
        ) from None


class _Book:
    """Writes the sheets of one report; holds formats and where things stand."""

    def __init__(self, book: Any, content: Content) -> None:
        self.book, self.content = book, content
        self.formats: dict[str, Any] = {}
        self.head = book.add_format({"bold": True, "bg_color": "#1f3a4d", "font_color": "#ffffff", "text_wrap": True,
                                     "valign": "top", "border": 1})  # fmt: skip
        self.title = book.add_format({"bold": True, "font_size": 15, "font_color": "#1f3a4d"})
        self.bold = book.add_format({"bold": True})
        self.wrap = book.add_format({"text_wrap": True, "valign": "top"})
        self.input = book.add_format({"font_color": "#0000c0", "bg_color": "#fffbe6"})
        self.columns = item_columns(content)
        self.letters = {column.label: xl_col_to_name(at) for at, column in enumerate(self.columns)}
        self.last = HEAD + max(1, len(content.results))

    def write(self) -> None:
        names = ("Summary", "Fix first", "Floors", "Items", "Motions", "Routes", "Methods", "Assumptions", "Notes")
        pages = {name: self.book.add_worksheet(name) for name in names}
        for page in pages.values():
            page.set_landscape()
            page.set_paper(9)
            page.fit_to_pages(1, 0)
            page.set_footer("&L&8" + "Chance of overturning in this scenario, not per year" + "&C&8&A&R&8Page &P of &N")
        self._define_names()
        self._write_summary(pages["Summary"])
        self._write_fix_first(pages["Fix first"])
        self._write_floors(pages["Floors"])
        self._write_items(pages["Items"])
        self._write_motions(pages["Motions"])
        self._write_routes(pages["Routes"])
        self._write_methods(pages["Methods"])
        self._write_assumptions(pages["Assumptions"])
        self._write_notes(pages["Notes"])

    # ------------------------------------------------------------------ pieces

    def _format(self, number_format: str, **more: Any) -> Any:
        name = number_format + repr(sorted(more.items()))
        if name not in self.formats:
            self.formats[name] = self.book.add_format({"num_format": number_format or "General", **more})
        return self.formats[name]

    def _put(self, page: Any, row: int, column: int, value: Any, form: Any = None) -> None:
        """Write a value as what it is: a text is never a formula, a link or a number."""
        if value is None or value == "":
            page.write_blank(row, column, None, form) if form else None
        elif isinstance(value, bool | int | float):
            page.write_number(row, column, value, form)
        elif page.write_string(row, column, str(value), form) == -2:
            page.write_string(row, column, str(value)[:32_000] + "… (cut)", form)

    def _table(
        self, page: Any, top: int, heads: Sequence[str], widths: Sequence[int], rows: Sequence[Sequence[Any]]
    ) -> int:
        """Write a table and return the row below it."""
        for at, width in enumerate(widths):
            page.set_column(at, at, width)
        for at, label in enumerate(heads):
            page.write_string(top, at, label, self.head)
        for number, row in enumerate(rows, top + 1):
            for at, value in enumerate(row):
                self._put(page, number, at, value, self.wrap if isinstance(value, str) and len(value) > 40 else None)
        return top + 1 + len(rows)

    def _listing(self, page: Any, heads: Sequence[str], widths: Sequence[int], rows: Sequence[Sequence[Any]]) -> None:
        """Write a sheet that is one table: frozen head, filter, head repeated on each printed page."""
        self._table(page, 0, heads, widths, rows)
        page.freeze_panes(1, 0)
        page.repeat_rows(0)
        if rows:
            page.autofilter(0, 0, len(rows), len(heads) - 1)

    def _colour(self, page: Any, area: str) -> None:
        for risk in reversed(RiskClass):
            form = self.book.add_format({"bg_color": risk.fill, "font_color": risk.ink})
            page.conditional_format(
                area,
                {"type": "text", "criteria": "begins with", "value": risk.symbol, "format": form, "stop_if_true": True},
            )

    def _define_names(self) -> None:
        for row, name in enumerate(_NAMES, 2):
            self.book.define_name(name, f"=Assumptions!$B${row}")

    # ----------------------------------------------------------------- summary

    def _write_summary(self, page: Any) -> None:
        content = self.content
        page.set_column(0, 0, 34)
        page.set_column(1, 6, 15)
        page.write_string(0, 0, f"Furniture in earthquakes: {words.clip(content.title, 100)}", self.title)
        scenario = content.assessment.inventory.building.scenario
        lines = [
            f"Scenario: {words.clip(scenario, 300)}" if scenario else "",
            "Chance of overturning in this scenario, not per year; the interval covers the number of records only.",
            "Not verified: classes are those of a published formula; no direct integration has been run.",
            "Counts are pieces and follow the sheets Floors, Items and Assumptions when those are edited.",
        ]
        for row, line in enumerate(lines, 1):
            self._put(page, row, 0, line)
        top = len(lines) + 2
        bottom = self._write_counts(page, top)
        self._chart(page, top, bottom)
        row = bottom + 18
        page.write_string(row, 0, "The pieces most likely to fall (as run)", self.bold)
        heads = ("Item", "Floor", "Room", "Chance", "Class", "Pieces")
        for at, label in enumerate(heads):
            page.write_string(row + 1, at, label, self.head)
        for number, one in enumerate(content.worst, row + 2):
            described = words.clip(f"{one.item.item}: {one.item.description or one.item.type}", 80)
            for at, value in enumerate((described, one.item.floor, one.item.room)):
                self._put(page, number, at, value)
            page.write_number(number, 3, one.adopted.probability, self._format("0.0%"))
            self._put(page, number, 4, one.adopted.risk.label)
            page.write_number(number, 5, one.item.quantity)
        self._colour(page, f"E{row + 3}:E{row + 3 + len(content.worst)}")

    def _write_counts(self, page: Any, top: int) -> int:
        """Write the counts by floor and class as formulas over Items, and return the row of the totals."""
        for at, label in enumerate(("Floor", *(risk.label for risk in RiskClass), "anchored", "all")):
            page.write_string(top, at, label, self.head)
        item = {name: f"Items!${letter}${HEAD + 1}:${letter}${self.last}" for name, letter in self.letters.items()}
        total = top + 1 + len(self.content.floors)
        for row, floor_page in enumerate(self.content.floors, top + 1):
            self._put(page, row, 0, floor_page.title)
            named = f"Floors!$A${HEAD + 1 + row - top - 1}"
            on_floor = f"{item['Quantity']},{item['Floor']},{named}"
            counts = floor_page.counts
            for at, risk in enumerate(RiskClass, 1):
                formula = f'=SUMIFS({on_floor},{item["Class (formula)"]},"{risk.label}*",{item["Anchored"]},"<>yes")'
                page.write_formula(row, at, formula, None, counts.by_class[risk])
            page.write_formula(row, 5, f'=SUMIFS({on_floor},{item["Anchored"]},"yes")', None, counts.anchored)
            page.write_formula(row, 6, f"=SUM(B{row + 1}:F{row + 1})", None, counts.total)
        page.write_string(total, 0, "All floors", self.bold)
        totals = (*self.content.total.by_class.values(), self.content.total.anchored, self.content.total.total)
        for at, value in enumerate(totals, 1):
            letter = xl_col_to_name(at)
            page.write_formula(total, at, f"=SUM({letter}{top + 2}:{letter}{total})", self.bold, value)
        return total

    def _chart(self, page: Any, top: int, bottom: int) -> None:
        chart = self.book.add_chart({"type": "bar", "subtype": "stacked"})
        for at, risk in enumerate(RiskClass, 1):
            chart.add_series({
                "name": ["Summary", top, at],
                "categories": ["Summary", top + 1, 0, bottom - 1, 0],
                "values": ["Summary", top + 1, at, bottom - 1, at],
                "fill": {"color": risk.fill},
                "border": {"color": "#444444", "width": 0.5},
            })  # fmt: skip
        chart.set_title({"name": "Pieces by class and floor", "name_font": {"size": 11}})
        chart.set_y_axis({"reverse": True})
        chart.set_legend({"position": "bottom"})
        chart.set_size({"width": 760, "height": 320})
        page.insert_chart(
            bottom + 1, 0, chart, {"description": "Pieces of each class on every floor, as in the table above"}
        )

    def _write_fix_first(self, page: Any) -> None:
        rows = [
            (at, one.item.item, one.item.floor, one.item.room, one.item.description or one.item.type,
             one.item.importance, one.item.route, one.adopted.risk.label, one.adopted.probability, one.item.quantity,
             one.adopted.probability * one.item.quantity)
            for at, one in enumerate(self.content.fix_first, 1)
        ]  # fmt: skip
        heads = ("No.", "Item", "Floor", "Room", "Description", "Importance", "Route", "Class (as run)", "Chance",
                 "Pieces", "Expected falls saved if the anchor holds")  # fmt: skip
        self._listing(page, heads, (6, 12, 9, 16, 36, 13, 12, 16, 10, 8, 16), rows)
        self._colour(page, f"H2:H{len(rows) + 2}")

    # ------------------------------------------------------------------ floors

    def _write_floors(self, page: Any) -> None:
        heads = (
            "Floor",
            "Name",
            "PFA X [g]",
            "PFV X [cm/s]",
            "Source X",
            "PFA Y [g]",
            "PFV Y [cm/s]",
            "Source Y",
            "Elevation [m]",
        )
        for at, (label, width) in enumerate(zip(heads, (12, 22, 12, 14, 44, 12, 14, 44, 12), strict=True)):
            page.set_column(at, at, width)
            page.write_string(0, at, label, self.head)
        for row, floor_page in enumerate(self.content.floors, HEAD):
            self._put(page, row, 0, floor_page.floor.floor)
            self._put(page, row, 1, floor_page.floor.name)
            self._write_demand(page, row, 2, self._governing(floor_page.floor.floor, "X"))
            self._write_demand(page, row, 5, self._governing(floor_page.floor.floor, "Y"))
            self._put(page, row, 8, floor_page.floor.elevation)
        page.freeze_panes(1, 1)
        page.repeat_rows(0)
        page.write_comment("C1", _EDIT_HERE, {"x_scale": 2})

    def _governing(self, floor: str, axis: Axis) -> Demand:
        return max(self.content.assessment.demands[floor, axis], key=lambda demand: demand.pfa)

    def _write_demand(self, page: Any, row: int, at: int, demand: Demand) -> None:
        form = self._format("0.000", font_color="#0000c0", bg_color="#fffbe6")
        page.write_number(row, at, edge(demand.pfa, "g"), form)
        pfv, period = edge(demand.pfv, "cm/s"), self.content.assessment.inventory.building.period
        if "pfv_estimated" in demand.flags and period is not None:
            cell = f"{xl_col_to_name(at)}{row + 1}"
            formula = f"={cell}*{kh.G!r}/(2*PI()*{min(1 / period, HIGHEST_FLOOR_FREQUENCY)!r})"
            page.write_formula(row, at + 1, formula, self._format("0.0"), pfv)
        else:
            self._put(page, row, at + 1, pfv, self._format("0.0", font_color="#0000c0", bg_color="#fffbe6"))
        self._put(page, row, at + 2, f"{describe_source(demand)}{': ' + demand.name if demand.name else ''}")

    # ------------------------------------------------------------------- items

    def _write_items(self, page: Any) -> None:
        for at, column in enumerate(self.columns):
            page.set_column(at, at, column.width)
            page.write_string(0, at, column.label, self.head)
        for row, one in enumerate(self.content.results, HEAD):
            cells = {label: f"${letter}{row + 1}" for label, letter in self.letters.items()}
            for at, column in enumerate(self.columns):
                form = self._format(column.number_format) if column.number_format else None
                value = column.read(one)
                if column.formula:
                    formula = item_formula(column.formula, cells, HEAD + len(self.content.floors))
                    page.write_formula(row, at, formula, form, "" if value is None else value)
                else:
                    self._put(page, row, at, value, self.input if column.label in INPUTS else form)
        page.freeze_panes(1, 1)
        page.repeat_rows(0)
        page.autofilter(0, 0, self.last - 1, len(self.columns) - 1)
        letter = self.letters["Class (formula)"]
        self._colour(page, f"{letter}2:{letter}{self.last}")
        letter = self.letters["OR"]
        bar = {"type": "data_bar", "bar_color": "#9db7c9", "bar_solid": True}
        ends = {"min_type": "num", "max_type": "num", "min_value": 0, "max_value": 1}
        page.conditional_format(f"{letter}2:{letter}{self.last}", bar | ends)

    # -------------------------------------------------------------- other sheets

    def _write_motions(self, page: Any) -> None:
        rows = [
            (floor_page.floor.floor, demand.axis, describe_source(demand), demand.name, edge(demand.pfa, "g"),
             edge(demand.pfv, "cm/s"), edge(demand.record.file_pfa, "g") if demand.record else None,
             demand.record.station if demand.record else "", demand.record.event if demand.record else "",
             demand.record.azimuth_deg if demand.record else None, describe_treatment(demand))
            for floor_page in self.content.floors
            for demand in floor_page.demands
        ]  # fmt: skip
        heads = ("Floor", "Axis", "Source", "Record", "PFA [g]", "PFV [cm/s]", "PFA in the file [g]", "Station",
                 "Event", "Azimuth [deg]", "Treatment")  # fmt: skip
        self._listing(page, heads, (9, 6, 34, 40, 10, 11, 12, 34, 34, 10, 80), rows)

    def _write_routes(self, page: Any) -> None:
        segments = self.content.assessment.inventory.routes
        rows = [
            (one.route, one.segment, one.floor, one.start, one.end, one.clear_width, one.required_width, one.occupants,
             ", ".join(piece.item.item for piece in self.content.results
                       if piece.item.route == one.route and piece.item.segment in ("", one.segment)), one.notes)
            for one in segments
        ]  # fmt: skip
        heads = ("Route", "Segment", "Floor", "From", "To", "Clear width [m]", "Required width [m]", "Occupants",
                 "Pieces beside it (blockage is not evaluated by this version)", "Notes")  # fmt: skip
        self._listing(page, heads, (14, 12, 9, 20, 20, 10, 10, 10, 60, 40), rows)

    def _write_methods(self, page: Any) -> None:
        rows = []
        for method in self.content.methods:
            parts = (
                ("Predicts", (method.predicts,)),
                ("Equation", method.equations),
                ("Assumption", method.assumptions),
                ("Departure from the source", method.departures),
                ("Source", (str(method.reference),)),
            )
            rows += [(method.title, what, text) for what, texts in parts for text in texts]
        rows += [("Marks", flag.replace("_", " "), meaning) for flag, meaning in self.content.flags.items()]
        rows += [("Limits", "", text) for text in self.content.limits]
        self._listing(page, ("Method", "What", "Text"), (28, 26, 130), rows)

    def _write_assumptions(self, page: Any) -> None:
        settings = self.content.assessment.settings
        values = (*LIMITS, settings.zeta_acceleration, settings.zeta_velocity, settings.slide_coefficient)
        self._table(page, 0, ("Assumption", "Value"), (70, 60), ())
        for row, ((_, label), value) in enumerate(zip(_NAMES.items(), values, strict=True), 1):
            page.write_string(row, 0, f"{label} (edit the value: classes and counts follow)")
            page.write_number(row, 1, value, self.input)
        for row, (where, what) in enumerate(self.content.assumptions, len(_NAMES) + 2):
            self._put(page, row, 0, where)
            self._put(page, row, 1, what, self.wrap)

    def _write_notes(self, page: Any) -> None:
        rows: list[tuple[str, str, str]] = [
            (one.severity, one.place, f"{one.message} {one.mend}".strip()) for one in self.content.problems
        ]
        inventory, platform = self.content.assessment.inventory, self.content.platform
        rows.append(("input", inventory.source.name, f"SHA-256 {inventory.sha256}"))
        rows += [("input", name, f"SHA-256 {digest}") for name, digest in inventory.files.items()]
        rows.append(
            (
                "made with",
                f"assess {self.content.version}",
                ", ".join(f"{name} {value}" for name, value in platform.items()),
            )
        )
        self._listing(page, ("Kind", "Place", "What"), (12, 40, 120), rows)


_EDIT_HERE = (
    "Edit the PFA and PFV here: Items and Summary follow. Where several records serve an axis, the one with the largest "
    "PFA stands here; the sheet Motions lists all."
)

_NAMES = {
    "limit_medium": "Lower limit of medium",
    "limit_high": "Lower limit of high",
    "limit_very_high": "Lower limit of very high",
    "zeta_a": "Kaneko-Hayashi ζ_A",
    "zeta_v": "Kaneko-Hayashi ζ_V",
    "slide_alpha": "Kaneko-Hayashi slide coefficient α",
}
"""Cells that formulas refer to by name, in the order of the sheet Assumptions."""
