"""The sheet Costs: in the empty workbook, in any language, and every fault named by its cell."""

from typing import Any

import openpyxl
import pytest

from assess.cli.command_new import write_new_workbook
from assess.details import DETAILS
from assess.errors import WorkbookError
from assess.i18n import LANGUAGES, gettext, load_catalogue, speaking
from assess.workbook.read import read_inventory
from assess.workbook.schema import COSTS, LISTS
from tests.workbook.books import write_book

FLOORS = [["Floor", "PFA X [g]"], ["1", 0.5]]
ITEMS = [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", 40, 180]]

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")


def read(folder, *rows):
    sheets: dict[str, Any] = {"Floors": FLOORS, "Items": ITEMS}
    sheets["Costs"] = [["Detail", "Unit cost", "Source"], *rows]
    return read_inventory(write_book(folder / "w.xlsx", sheets))


def test_costs_are_read(tmp_path):
    inventory = read(
        tmp_path, ["base angle", 40.5, "offer of May"], ["L-bracket to studs", 0, ""], ["ceiling pole", None]
    )
    found = [(one.row, one.detail, one.unit_cost, one.source) for one in inventory.costs]
    assert found == [(2, "base angle", 40.5, "offer of May"), (3, "L-bracket to studs", 0, "")]
    assert not [one for one in inventory.problems if one.sheet == "Costs"]


@pytest.mark.parametrize(
    ("rows", "cell", "words"),
    [
        ([["base angle", -4]], "B2", "Unit cost is -4, expected 0 to 900000."),
        ([["base angle", 1e7]], "B2", "Unit cost is 1e+07, expected 0 to 900000."),
        ([["base angle", "40 €"]], "B2", "Unit cost is the text '40 €', expected a number."),
        ([[None, 4]], "A2", "Detail is blank."),
        ([["base angle", 4], ["Base angle", 5]], "A3", "duplicate Detail 'Base angle', also in A2."),
        ([["bracket", 4], ["L-bracket to studs", 5]], "A3", "Detail 'L-bracket to studs' is the same as that in A2."),
    ],
)
def test_what_is_wrong_is_an_error_at_its_cell(tmp_path, rows, cell, words):
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, *rows)
    (one,) = caught.value.problems
    assert (one.severity, one.sheet, one.cell, one.message) == ("error", "Costs", cell, words)
    assert one.fix


def test_an_unknown_detail_is_a_warning(tmp_path):
    inventory = read(tmp_path, ["glue", 1], ["base angle", 2])
    (one,) = (one for one in inventory.problems if one.sheet == "Costs")
    assert (one.severity, one.cell) == ("warning", "A2")
    assert all(str(detail.title) in one.fix for detail in DETAILS.values())


def test_a_cost_of_what_the_schedule_never_prices_is_a_warning_at_its_cell(tmp_path):
    inventory = read(tmp_path, *([str(one.title), 7] for one in DETAILS.values()))
    found = {one.cell: one for one in inventory.problems if one.sheet == "Costs"}
    assert {DETAILS[key].title: f"A{at}" for at, key in enumerate(DETAILS, 2) if f"A{at}" in found} == {
        "straps to two studs": "A3", "gang the row together": "A5", "ceiling pole": "A6",
    }  # fmt: skip
    assert {one.severity for one in found.values()} == {"warning"}
    pole = found["A6"]
    assert pole.message == (
        "Detail 'ceiling pole' is an alternative, which the schedule does not price: its cost is left out."
    )
    assert pole.fix == "The schedule prices these: L-bracket to studs, base angle."


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_empty_workbook_offers_every_detail(tmp_path, language):
    path = tmp_path / "new.xlsx"
    write_new_workbook(path, "si", language=language)
    book = openpyxl.load_workbook(path)
    with speaking(load_catalogue(language)):
        page, lists = book[gettext(COSTS.name)], book[gettext(LISTS)]
        heads = [gettext(column.label) for column in COSTS.columns]
        titles = [gettext(str(one.title)) for one in DETAILS.values()]
    assert [cell.value.rstrip(" *") for cell in page[1]][: len(heads)] == heads
    (choice,) = (one for one in page.data_validations.dataValidation if one.formula1 == "list_detail")
    assert "A2" in choice.sqref
    area = book.defined_names["list_detail"].attr_text.split("!")[1]
    assert [row[0].value for row in lists[area.replace("$", "")]] == titles


@pytest.mark.parametrize("language", LANGUAGES)
def test_details_are_known_in_every_language(tmp_path, language):
    catalogue = load_catalogue(language)
    inventory = read(tmp_path, *([catalogue.find(str(one.title)), 7] for one in DETAILS.values()))
    assert len(inventory.costs) == len(DETAILS)
    assert not [one for one in inventory.problems if one.sheet == "Costs" and "is none that" in one.message]
