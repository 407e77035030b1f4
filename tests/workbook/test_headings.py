"""What is written above the columns and beside the lines can be read whole, in every language."""

import math
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.i18n import LANGUAGES, gettext, load_catalogue, speaking
from assess.workbook.lists import list_columns
from assess.workbook.names import translate, translate_choices
from assess.workbook.schema import CLASS, LISTS, SHEETS
from assess.workbook.template import CHECKED, ROWS, describe, write_workbook
from tests.workbook.books import read_part

LETTER, LINE = 1.1, 15
"""Width of a bold letter [digits] and height of a line [points]: those of Calibri 11, somewhat on the safe side."""


@pytest.fixture(scope="module", params=LANGUAGES)
def code(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module", params=["si", "imperial"])
def path(request: pytest.FixtureRequest, code: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp(f"{code}-{request.param}") / "blank.xlsx"
    with speaking(load_catalogue(code)):
        write_workbook(path, units=request.param)
    return path


@pytest.fixture(scope="module")
def book(path: Path) -> Any:
    return openpyxl.load_workbook(path)


@pytest.fixture(scope="module")
def pages(book: Any) -> list[Any]:
    """Return Help, and the sheets of `SHEETS`."""
    return list(book.worksheets[: len(SHEETS) + 1])


def test_every_column_has_a_message_and_choices_drop_down(book: Any, code: str) -> None:
    with speaking(load_catalogue(code)):
        names = {sheet.name: translate(sheet, code).name for sheet in SHEETS}
        for sheet in SHEETS:
            found, columns = {}, list_columns(sheet)  # the check of each column, by field name
            for check in book[names[sheet.name]].data_validations.dataValidation:
                first = next(iter(check.sqref.ranges))
                found[columns[(first.min_row if sheet.layout == "form" else first.min_col) - 1]] = check
            assert [name for name in found if name != CLASS] == [column.name for column in sheet.columns]
            for column in sheet.columns:
                check = found[column.name]
                assert 0 < len(check.prompt) <= 255
                assert describe(column).startswith(check.prompt.removesuffix("…"))
                assert check.promptTitle == gettext(column.label)
                assert len(check.promptTitle) <= 32
                listed = [*translate_choices(column.choices, code)] or [gettext(one) for one in column.offered]
                assert (check.type == "list") == bool(listed or column.source)
                if check.type != "list":
                    continue
                name = check.formula1.lstrip("=")
                assert name == f"list_{column.name if listed else column.source.lower()}"
                target, _, area = book.defined_names[name].attr_text.partition("!")
                assert check.errorStyle == ("information" if column.offered else "warning" if column.source else None)
                if listed:
                    assert target == gettext(LISTS)
                    assert [cell.value for row in book[target][area.replace("$", "")] for cell in row] == listed
                else:
                    assert (target, area[:6]) == (names[column.source], "$A$2:$")


def test_no_header_label_or_help_is_cut(pages: list[Any]) -> None:
    for sheet, page in zip(SHEETS, pages[1:], strict=True):
        if sheet.layout == "form":
            continue
        for cell in page[1]:
            width, words = _width(page, cell.column), [LETTER * len(word) for word in str(cell.value).split()]
            assert max(words) <= width, cell.value
            assert (page.row_dimensions[1].height or LINE) >= LINE * math.ceil(sum(words) / width), cell.value
    # Of the lines of Building, and of Help.
    for page, labels, helps in ((pages[1], 1, 3), (pages[0], 2, 3)):
        for row in range(1, page.max_row + 1):
            label, text = (str(page.cell(row, at).value or "") for at in (labels, helps))
            assert LETTER * len(label) <= _width(page, labels), label
            needed = math.ceil(0.85 * len(text) / _width(page, helps))
            assert (page.row_dimensions[row].height or LINE) >= LINE * needed, text


def _width(page: Any, at: int) -> float:
    """Return the width of a column; openpyxl gives neighbours of the same width as one."""
    found = (one for one in page.column_dimensions.values() if one.min <= at <= one.max)
    return float(next(found).width)


def test_who_fills_in_more_rows_than_prepared_learns_what_to_do(path: Path, pages: list[Any]) -> None:
    last, page = ROWS["Items"] + 1, pages[3]
    assert len(read_part(path, "xl/worksheets/sheet4.xml")) < 1.32e6, "it opens the faster the less it holds"
    assert page["B1"].comment
    assert page["B1"].value in (CLASS, "Classe (formula)")
    assert (str(page[f"B{last}"].value)[0], page[f"B{last + 1}"].value) == ("=", None)
    area = f"B{last + 1}:B{CHECKED['Items'] + 1}"
    (note,) = [one for one in page.data_validations.dataValidation if str(one.sqref) == area]
    assert len(note.promptTitle) <= 32
    assert 0 < len(note.prompt) <= 255
    (rule,) = next(one for one in page.conditional_formatting if str(one.sqref) == area).rules
    assert rule.formula == [f'AND($A{last + 1}<>"",$B{last + 1}="")']
    assert any(f" {ROWS['Items']} " in str(row[0].value) for row in pages[0].iter_rows(max_row=15))
