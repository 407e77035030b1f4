"""The tables of the pages show the fields of the results: their headings, order and values follow from them."""

import re
from dataclasses import replace

import openpyxl
import pytest

import assess
from assess import fields
from assess.fields import item_fields, route_fields
from assess.i18n import load_catalogue, speaking
from assess.report.page_columns import ROUTE_TABLES, list_columns, route_columns, say_value
from assess.report.sections.pieces import list_lines
from assess.settings import Settings
from assess.table import EVERYWHERE, Field
from tests.report.reading import render
from tests.workbooks import assessed


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("columns") / "w.xlsx", settings=Settings(verify="all", runs=10))


@pytest.mark.parametrize("where", ["pieces", "risky", "methods"])
def test_a_list_has_every_field_that_it_shows_in_their_order(results, where):
    expected = [one.short_heading() for one in item_fields(results.methods) if where in one.shows]
    found = [one.heading.removesuffix(" (raw)") for one in list_columns(results, where) if one.key != "marks"]
    if where == "methods":
        titles = {one.short_title: one.title for one in results.methods}
        expected = [titles.get(heading, heading) for heading in expected]
    assert found == expected
    assert {"B × W × H [cm]", "Chance", "Class"} <= set(found) or where == "methods"


@pytest.mark.slow
def test_a_further_field_shows_in_every_format_and_list(results, tmp_path, monkeypatch):
    colour = Field(key="colour", source="item.row", label="Colour", shows=EVERYWHERE)
    monkeypatch.setattr(fields, "PIECE_FIELDS", (*fields.PIECE_FIELDS, colour))
    page = render(results)
    assert re.search(r'<th scope="col">Colour</th>', page)
    row = next(iter(results)).item.row
    assert f">{row}</td>" in page
    blocks = list_lines(list(results), list_columns(results, "pieces"))
    assert "Colour" in blocks[0].head
    assert str(row) in blocks[0].lines[0]
    written = assess.write_reports(results, tmp_path, ("json", "csv", "xlsx"))
    assert f'"colour": {row}' in written["json"].read_text(encoding="utf-8")
    assert "colour" in written["csv"].read_text(encoding="utf-8").splitlines()[0]
    sheet = openpyxl.load_workbook(written["xlsx"])["Items"]
    heads = [cell.value for cell in sheet[1]]
    assert sheet.cell(2, heads.index("Colour") + 1).value == row


def test_tables_of_routes_name_fields_that_have_labels():
    for row, keys in ROUTE_TABLES.values():
        assert [key for key in keys if not route_fields(row)[key].label] == []
    assert len(route_columns(has_anchors=True)["routes"]) == len(route_columns(has_anchors=False)["routes"]) + 1
    with speaking(load_catalogue("it")):
        assert route_columns(has_anchors=True)["segments"][3].heading == "Libera"


@pytest.mark.parametrize(
    ("field", "value", "text"),
    [
        ({"kind": "number", "format": "0.000"}, 0.12345, "0.123"),
        ({"kind": "number", "unit": "m"}, 1.2, "1.2"),
        ({"kind": "share"}, 0.5, "50.0 %"),
        ({"kind": "count"}, 12345, "12,345"),
        ({"kind": "flag"}, True, "yes"),
        ({"kind": "list"}, ["one_axis", "two"], "one_axis, two"),
        ({"kind": "text"}, None, ""),
        ({"kind": "number"}, None, "–"),
        ({"kind": "text"}, "x" * 60, "x" * 39 + "…"),
    ],
)
def test_a_value_is_shown_by_the_kind_and_the_format_of_its_field(field, value, text):
    assert say_value(replace(Field(key="k"), **field), value) == text
