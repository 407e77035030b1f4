"""Fields: each is read, named and formatted once, and a record gives back its row."""

import json
from collections import Counter

import pytest

from assess.fields import (
    MOTION_FIELDS,
    Shape,
    case_fields,
    floor_fields,
    item_fields,
    method_fields,
    unnest,
)
from assess.report.data import write_json
from assess.settings import Settings
from tests.workbooks import assessed


@pytest.fixture(scope="module", params=["none", "all"])
def results(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("fields") / "w.xlsx"
    return assessed(path, settings=Settings(verify=request.param, runs=10))


def test_keys_and_places_are_unique(results):
    for chosen in (item_fields(results), case_fields(results), floor_fields(results)):
        assert max(Counter(one.key for one in chosen).values()) == 1
    places = [one.place for one in (*item_fields(results),)]
    assert max(Counter(places).values()) == 1


def test_a_record_of_the_document_gives_back_the_row(results, tmp_path):
    write_json(results, tmp_path / "r.json")
    found = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    shape = Shape(item_fields(results))
    for record, one in zip(found["items"], results, strict=True):
        assert unnest(record, shape.fields) == shape.flatten(one)
    motions = Shape(MOTION_FIELDS)
    records = [record for floor in found["floors"] for record in floor["demands"]]
    expected = [one for floor in results.floor_rows for axis in "XY" for one in results.motions_of(floor.floor, axis)]
    for record, motion in zip(records, expected, strict=True):
        assert unnest(record, MOTION_FIELDS) == motions.flatten(motion)


def test_units_of_keys_and_headings_agree(results):
    """``breadth_cm`` is "Breadth [cm]": what a key ends in is the unit of its heading."""
    marks = {"cm": "cm", "m": "m", "g": "g", "cm/s": "cm_s", "deg": "deg", "Hz": "hz", "s": "s", "kg": "kg", "kN": "kn"}
    for one in (*item_fields(results), *MOTION_FIELDS):
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
