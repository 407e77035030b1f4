"""A column that nothing is computed with: named in the schema and in the fields, and it is read and shown."""

from dataclasses import replace

import pytest

from assess import fields
from assess.fields import _of_item
from assess.pipeline.run import run
from assess.report.pages import glyphs
from assess.table import EVERYWHERE
from assess.workbook import parse, read, resolve, schema
from assess.workbook.schema import Column
from tests.report.reading import render
from tests.workbooks import UNVERIFIED

COLOUR = Column("colour", "Colour", "text", "Of the front.")
ROWS = {
    "Floors": [{"floor": "1", "pfa_x": 0.3}],
    "Items": [{"item": "A", "floor": "1", "breadth": 40, "width": 80, "height": 180, "colour": "red 紅"},
              {"item": "B", "floor": "1", "breadth": 40, "width": 80, "height": 180}],
}  # fmt: skip


@pytest.mark.slow
def test_a_new_column_of_items_reaches_the_results_and_the_reports(monkeypatch):
    items = replace(schema.ITEMS, columns=(*schema.ITEMS.columns, COLOUR))
    sheets = tuple(items if sheet.name == "Items" else sheet for sheet in schema.SHEETS)
    for module in (schema, parse, read, resolve):
        if hasattr(module, "SHEETS"):
            monkeypatch.setattr(module, "SHEETS", sheets)
    monkeypatch.setattr(glyphs, "ITEMS", items)
    colour = _of_item("colour", "Colour", is_optional=True, shows=EVERYWHERE)
    monkeypatch.setattr(fields, "PIECE_FIELDS", (*fields.PIECE_FIELDS, colour))
    results = run(read.read_inventory(ROWS), UNVERIFIED)
    table = results.table("items")
    assert results["A"].item.more == {"colour": "red 紅"}
    assert [one["colour"] for one in table.records()] == table.columns["colour"] == ["red 紅", None]
    assert ">red 紅</td>" in render(results)
    assert [one.label for one in glyphs.list_missing(results)] == ["Colour"]
