"""The lists of the sheet Summary: the pieces most likely to fall, each basis of a class in a list of its own."""

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from assess.i18n import gettext as _
from assess.report.xlsx.item_formulas import AT_RUN, literal
from assess.report.xlsx.item_values import (
    class_in_force,
    list_simulated,
    listed_chance,
    order_number,
    say_listed_class,
)
from assess.report.xlsx.items_sheet import HEAD, name_found
from assess.report.xlsx.pen import CHANCE, Pen, row_height
from assess.results import ItemResult, Results
from assess.risk import RiskClass

WIDTHS = (34, 14, 14, 14, 14, 14, 14, 14, 44)
"""Of the columns of the summary that are printed: of names, of numbers, and of classes."""
LAST = len(WIDTHS) - 1
LISTED = 10
"""Pieces in a list."""
PLACE, CHANCES = LAST + 1, LAST + 2
"""Hidden columns: the row of the piece in Items, and its chance in the column of its class."""
_LONGEST = 80

Found = Sequence[tuple[int, ItemResult]]
"""Pieces with their places in Items, 1 for the first."""


def find_worst(results: Sequence[ItemResult], basis: str) -> Found:
    """Return the pieces of a basis of highest class and chance."""
    own = ((row, one) for row, one in enumerate(results, HEAD) if one.adopted.basis == basis)
    numbers = ((order_number(one, row), row, one) for row, one in own)
    known = ((number, row, one) for number, row, one in numbers if number is not None)
    return [(row, one) for _number, row, one in heapq.nlargest(LISTED, known, key=lambda entry: entry[0])]


@dataclass(frozen=True, slots=True)
class WorstList:
    """Where the list of a basis stands (`row`), and what it shows: `areas` are the columns of Items."""

    pen: Pen
    page: Any
    run: Results
    areas: Mapping[str, str]
    basis: str
    row: int

    def write(self, found: Found) -> None:
        """Write the pieces of highest class and chance."""
        pen, page, row = self.pen, self.page, self.row
        title = _("The pieces most likely to fall: {basis}", basis=pen.terms.bases[self.basis])
        page.write_string(row, 0, title, pen.style("heading"))
        pen.heads(page, self._heads(), WIDTHS, row + 1)
        for number, (place, one) in enumerate(found, 1):
            self._write_piece(row + 1 + number, number, place, one)
        if found:
            pen.colour(page, f"I{row + 3}:I{row + 2 + len(found)}")
            pen.bar(page, f"E{row + 3}:E{row + 2 + len(found)}")
        page.set_column(PLACE, CHANCES + len(RiskClass) - 1, 10, None, {"hidden": True})

    @property
    def _is_simulated(self) -> bool:
        return self.basis == "simulated"

    def _heads(self) -> tuple[str, ...]:
        found = (_("Chance by formula"), "", "", "")
        if self._is_simulated:
            found = name_found(is_ideal=self.run.settings.ideal)
        return _("Item"), _("Floor"), _("Room"), _("Pieces"), *found, _("Class")

    def _write_piece(self, row: int, number: int, place: int, one: ItemResult) -> None:
        """Write one piece of the list, the `number`-th; it is in the row `place` of Items."""
        pen, page, values = self.pen, self.page, self._values(one)
        page.set_row(row, row_height(values, WIDTHS))
        order, cell = self.areas[f"order_{self.basis}"], f"${xl_col_to_name(PLACE)}{row + 1}"
        page.write_formula(row, PLACE, f'=IFERROR(MATCH(LARGE({order},{number}),{order},0),"")', None, place)
        text, live, chance = pen.style("text"), pen.style("live"), pen.style("plain", CHANCE)
        looks = (text, text, text, live, *(chance,) * len(AT_RUN), text)
        for column, (formula, value, look) in enumerate(zip(self._formulas(cell), values, looks, strict=True)):
            page.write_formula(row, column, f'=IF({cell}="","",{formula})', look, "" if value is None else value)
        for risk, label in zip(RiskClass, pen.terms.labels, strict=True):
            is_it = f"LEFT(INDEX({self.areas['class']},{cell}),{len(label)})={literal(label)}"
            formula = f'=IF({cell}="","",IF({is_it},$E{row + 1},""))'
            is_own = class_in_force(one).startswith(label)
            page.write_formula(row, CHANCES + risk, formula, None, listed_chance(one) if is_own else "")

    def _values(self, one: ItemResult) -> tuple[Any, ...]:
        text = one.item.description or one.item.type
        name = (one.item.item + (f": {text}" if text else ""))[:_LONGEST]
        found: tuple[float | None, ...] = (listed_chance(one), None, None, None)
        if self._is_simulated:
            found = list_simulated(one, is_ideal=self.run.settings.ideal)
        return name, one.item.floor, one.item.room, one.item.quantity, *found, say_listed_class(one)

    def _formulas(self, cell: str) -> list[str]:
        """Return the formulas of a row of the list by the cell that holds the place of its piece."""

        def of(key: str) -> str:
            return f"INDEX({self.areas[key]},{cell})"

        text = f'IF({of("description")}<>"",": "&{of("description")},IF({of("type")}<>"",": "&{of("type")},""))'
        chance = of("chance_run" if self.basis == "unconfirmed" else self.run.formula.key)
        found = [of(key) for key in AT_RUN] if self._is_simulated else [chance, *['""'] * 3]
        notes = of("class_notes")
        return [
            f"LEFT({of('item')}&{text},{_LONGEST})",
            of("floor"),
            f'{of("room")}&""',
            of("quantity"),
            *found,
            f'{of("class")}&IF({notes}="","",", "&{notes})',
        ]
