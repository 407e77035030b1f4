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
