"""Tables: each field is read, named and formatted once; columns, rows, records and their text say the same."""

import json
from collections import Counter
from dataclasses import replace

import pytest

import assess
from assess.fields import MOTION_FIELDS, method_fields
from assess.report.data import write_json
from assess.settings import Settings
from assess.table import unnest
from tests.report.routed import assess_routed
from tests.workbooks import ITEMS, assessed

TABLES = ("items", "cases", "floors", "segments", "routes", "rooms", "schedule", "problems")


@pytest.fixture(scope="module", params=["none", "all"])
def results(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("fields") / "w.xlsx"
    return assess_routed(path, Settings(verify=request.param, runs=10))


def test_keys_and_places_are_unique(results):
    for name in TABLES:
        fields = results.table(name).fields
        assert max(Counter(one.key for one in fields).values()) == 1
        assert max(Counter(one.place for one in fields).values()) == 1


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


def test_the_document_holds_the_records_of_the_tables(results, tmp_path):
    write_json(results, tmp_path / "r.json")
    found = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert found["items"] == list(results.table("items").records())
    assert found["schedule"]["entries"] == list(results.table("schedule").records())
    for floor in found["floors"]:
        motions = [one for axis in "XY" for one in results.motions_of(floor["floor"], axis)]
        for record, motion in zip(floor["demands"], motions, strict=True):
            assert unnest(record, MOTION_FIELDS) == {one.key: one.flatten(one.read(motion)) for one in MOTION_FIELDS}


def test_units_of_keys_and_headings_agree(results):
    """``breadth_cm`` is "Breadth [cm]": what a key ends in is the unit of its heading."""
    marks = {"cm": "cm", "m": "m", "g": "g", "cm/s": "cm_s", "deg": "deg", "Hz": "hz", "s": "s", "kg": "kg", "kN": "kn"}
    for one in (*results.table("items").fields, *MOTION_FIELDS):
        if one.unit:
            assert one.heading() == f"{one.label} [{one.unit}]"
        if one.unit and "^" not in one.unit:
            assert one.key.endswith(f"_{marks[one.unit]}"), one.key


def test_the_columns_of_a_method_follow_from_what_it_says_of_itself(results):
    for method in results.methods:
        own = {one.key: one for one in method_fields(method)}
        columns = () if method.role == "simulation" else method.columns
        names = [f"{method.key}_{column.name}" for column in columns]
        assert list(own) == [method.key, *names, f"{method.key}_flags"]
        for column, name in zip(columns, names, strict=True):
            decimals = column.format.rstrip("f").partition(".")[2]
            assert len(own[name].format.partition(".")[2]) == int(decimals or 0)
        assert own[method.key].format == ("0.0%" if method.kind == "probability" else "0")


def test_texts_with_signs_of_json_and_of_patterns_come_back(tmp_path):
    texts = ['100 %s "x"', "a, b", "line\nbreak", "書架"]
    items = [ITEMS[0] | {"item": str(at), "description": text} for at, text in enumerate(texts)]
    table = assessed(tmp_path / "w.xlsx", items).table("items")
    found = [json.loads(text)["description"] for part in table.json_parts() for text in part]
    assert found == table.columns["description"]
    assert found[:2] == texts[:2]
