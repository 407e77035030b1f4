"""Tables: each field is read, named and formatted once; columns, rows, records and their text say the same."""

import json
from dataclasses import replace

import pytest

import assess
from assess.settings import Settings
from assess.table import unnest
from tests.report.routed import assess_routed
from tests.workbooks import ITEMS, assessed


@pytest.fixture(scope="module", params=["none", "all"])
def results(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("fields") / "w.xlsx"
    return assess_routed(path, Settings(verify=request.param, runs=10))


def test_columns_rows_records_and_their_text_agree(results):
    """Columns come from arrays, a row or a field of one result from objects."""
    for name in ("items", "cases", "floors", "schedule"):
        table = results.table(name)
        records, rows = list(table.records()), list(table.rows())
        assert len(records) == len(rows) == len(table) > 0
        assert [json.loads(text) for part in table.json_parts() for text in part] == records
        assert [unnest(record, table.fields) for record in records] == rows
        assert {key: [row[key] for row in rows] for key in table.columns} == table.columns
    for name, row in (("items", lambda one: one), ("cases", lambda one: one.governing)):
        table = results.table(name)
        rows = [one for one in table.rows() if name == "items" or one["governs"]]
        read = [{one.key: one.flatten(one.read(row(result))) for one in table.fields} for result in results]
        assert read == rows


def test_a_part_of_the_rows_is_read_like_the_whole(monkeypatch, results):
    whole, results = list(results.table("items").records()), replace(results)
    monkeypatch.setattr(assess.results, "PART", 2)
    monkeypatch.setattr(assess.results, "MOST_KEPT", 1)
    assert list(results.table("items").records()) == whole
    assert [one.item.item for one in results] == [one["item"] for one in whole]
    assert results.result(1) == list(results)[1]


def test_texts_with_signs_of_json_and_of_patterns_come_back(tmp_path):
    texts = ['100 %s "x"', "a, b", "line\nbreak", "書架"]
    items = [ITEMS[0] | {"item": str(at), "description": text} for at, text in enumerate(texts)]
    table = assessed(tmp_path / "w.xlsx", items).table("items")
    found = [json.loads(text)["description"] for part in table.json_parts() for text in part]
    assert found == table.columns["description"]
    assert found[:2] == texts[:2]
