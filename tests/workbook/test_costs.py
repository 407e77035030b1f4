"""The sheet Costs: in the empty workbook, in any language, and every fault named by its cell."""

import openpyxl
import pytest

from assess.cli.command_new import write_new_workbook
from assess.details import DETAILS
from assess.errors import WorkbookError
from assess.i18n import LANGUAGES, load_catalogue
from assess.workbook.schema import COSTS, LISTS
from tests.workbook.books import Sheet, read

HEADER = ["Detail", "Unit cost", "Source"]


def test_what_is_wrong_is_an_error_and_a_detail_unknown_or_never_priced_a_warning_at_its_cell(tmp_path):
    rows: Sheet = [["base angle", 4], ["Base angle", 5], [None, 4], ["bracket", 4], ["L-bracket to studs", 5]]
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, Costs=[HEADER, *rows])
    assert {(one.cell, one.message) for one in caught.value.problems} == {
        ("A3", "duplicate Detail 'Base angle', also in A2."),
        ("A4", "Detail is blank."),
        ("A6", "Detail 'L-bracket to studs' is the same as that in A5."),
    }
    inventory = read(tmp_path, Costs=[HEADER, ["glue", 1], *([str(one.title), 7] for one in DETAILS.values())])
    found = {one.cell: one for one in inventory.problems if one.sheet == "Costs"}
    assert {one.severity for one in found.values()} == {"warning"}
    fix = found.pop("A2").fix
    assert all(str(detail.title) in fix for detail in DETAILS.values())
    assert {cell: one.message for cell, one in found.items()} == {
        cell: f"Detail '{title}' is an alternative, which the schedule does not price: its cost is left out."
        for cell, title in {"A6": "gang the row together", "A7": "ceiling pole"}.items()
    }
    assert found["A7"].fix.startswith(
        "The schedule prices these: L-bracket to studs, straps to two studs, base angle, ch"
    )


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.slow
def test_the_empty_workbook_offers_every_detail_and_knows_it_again(tmp_path, language):
    catalogue = load_catalogue(language)
    write_new_workbook(tmp_path / "new.xlsx", "si", language=language)
    book = openpyxl.load_workbook(tmp_path / "new.xlsx")
    page, lists = book[catalogue.find(COSTS.name)], book[catalogue.find(LISTS)]
    titles = [catalogue.find(str(one.title)) for one in DETAILS.values()]
    assert "A2" in next(one for one in page.data_validations.dataValidation if one.formula1 == "list_detail").sqref
    area = book.defined_names["list_detail"].attr_text.split("!")[1]
    assert [row[0].value for row in lists[area.replace("$", "")]] == titles
    inventory = read(tmp_path, Costs=[HEADER, *([title, 7] for title in titles)])
    assert len(inventory.costs) == len(DETAILS)
    assert not [one for one in inventory.problems if one.sheet == "Costs" and "is none that" in one.message]


def test_a_currency_in_a_cell_is_understood_and_kept(tmp_path):
    for cell, amount, code in (
        ("€ 85,00", 85, "EUR"), ("85 EUR", 85, "EUR"), ("$ 1,200.00", 1200, "USD"), ("CHF 90.-", 90, "CHF"),
        ("£12.50", 12.5, "GBP"), ("1'200,5 nzd", 1200.5, "NZD"),
    ):  # fmt: skip
        inventory = read(tmp_path, Costs=[HEADER, ["L-bracket to studs", cell]])
        (cost,) = inventory.costs
        assert (cost.unit_cost, cost.currency, cost.per) == (amount, code, "piece"), cell
        (note,) = [one for one in inventory.problems if one.sheet == "Costs"]
        assert (note.cell, note.severity) == ("B2", "note")
        assert str(note.message).endswith(f"it is read as {amount:g} {code}.")
        assert not inventory.corrections, "a corrected cell would lose its currency"


def test_the_currency_of_one_row_is_that_of_the_sheet(tmp_path):
    header = ["Detail", "Unit cost", "Currency", "Per"]
    rows: Sheet = [["bracket", 4, None, "fixing"], ["base angle", 5, "€", None]]
    costs = read(tmp_path, Costs=[header, *rows]).costs
    assert [(one.currency, one.per) for one in costs] == [("EUR", "fixing"), ("EUR", "piece")]


@pytest.mark.parametrize(
    ("row", "cell", "message"),
    [
        (["bracket", "€ 85 EUR", None, None], "B2", "Unit cost is '€ 85 EUR': it names a currency twice."),
        (["bracket", "$ 85", "EUR", None], "B2", "Unit cost is in USD, but Currency is EUR."),
        (["bracket", 85, "Taler", None], "C2", "Currency 'Taler' is not a known currency."),
        (["bracket", 85, "EUR", "hour"], "D2", "Per is 'hour', expected one of: piece, fixing."),
        (["bracket", "85 apples", None, None], "B2", "Unit cost is the text '85 apples', expected a number."),
        (["bracket", "€ 1,200", None, None], "B2",
         "Unit cost is the text '1,200', which can be read as 1.2 or as 1200."),
    ],
)  # fmt: skip
def test_a_currency_that_cannot_be_used_is_an_error_at_its_cell(tmp_path, row, cell, message):
    header = ["Detail", "Unit cost", "Currency", "Per"]
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, Costs=[header, row])
    found = [one for one in caught.value.problems if one.severity == "error"]
    assert [(one.cell, str(one.message)) for one in found] == [(cell, message)]


def test_two_currencies_in_one_sheet_are_an_error(tmp_path):
    rows: Sheet = [["bracket", "€ 85", None], ["base angle", 90, "CHF"]]
    with pytest.raises(WorkbookError, match="the currency is CHF, but EUR in B2: costs in two currencies have no sum"):
        read(tmp_path, Costs=[["Detail", "Unit cost", "Currency"], *rows])
