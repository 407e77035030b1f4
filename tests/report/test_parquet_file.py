"""items.parquet: what items.csv holds, with types that do not depend on the building."""

import csv
import sys
from importlib import util

import duckdb
import pytest

import assess
from assess.errors import InputError
from assess.report.data import write_csv, write_parquet
from tests.cli.calling import run as call

FLOORS = [{"floor": "1", "PFA X [g]": 0.3, "PFA Y [g]": 0.2}]
ITEM = {"item": "=A1", "floor": "1", "Breadth [cm]": 40, "Width [cm]": 90, "Height [cm]": 180}
FULL = [ITEM, {**ITEM, "item": 'b\'s "é" 書架', "Weight [kg]": 80, "axis": "X", "room": "hall"}]


def assess_rows(*rows):
    inventory = assess.read_inventory({"Floors": FLOORS, "Items": list(rows)})
    return assess.run(inventory, assess.Settings(verify="none"))


def read(path):
    with duckdb.connect() as connection:
        found = connection.execute("SELECT * FROM read_parquet(?)", [str(path)])
        columns = {one[0]: str(one[1]) for one in found.description}
        return columns, found.fetchall()


def test_it_holds_what_the_table_holds_with_the_types_of_the_fields_whatever_is_filled_in(tmp_path):
    results = assess_rows(*FULL)
    write_parquet(results, tmp_path / "it's.parquet")
    write_csv(results, tmp_path / "items.csv")
    columns, rows = read(tmp_path / "it's.parquet")
    with (tmp_path / "items.csv").open(encoding="utf-8-sig", newline="") as file:
        expected = list(csv.DictReader(file))
    assert list(columns) == list(expected[0]) == [one.key for one in results.table("items").fields]
    assert [row[0] for row in rows] == ["=A1", 'b\'s "é" 書架'], "texts are as they are: nothing is a formula here"
    for row, line in zip(rows, expected, strict=True):
        for value, (key, text) in zip(row, line.items(), strict=True):
            if isinstance(value, bool):
                assert text == str(value), key
            elif isinstance(value, int | float):
                assert float(text) == pytest.approx(value), key
            elif key != "item":
                assert text == (value or ""), key
    # Two buildings can be read as one table, also where a column of one is all empty.
    write_parquet(assess_rows(ITEM), tmp_path / "a.parquet")
    write_parquet(assess_rows(*FULL), tmp_path / "b.parquet")
    (sparse, _), (full, _) = (read(tmp_path / f"{name}.parquet") for name in "ab")
    assert sparse == full
    assert {full[key] for key in ("item", "room", "adopted_class")} == {"VARCHAR"}
    assert {full[key] for key in ("pfa_g", "weight_kg", "adopted_probability")} == {"DOUBLE"}
    assert full["quantity"] == "BIGINT"
    _, rows = read(tmp_path / "?.parquet")
    assert len(rows) == 3


def test_without_its_package_it_says_what_to_install(monkeypatch, tmp_path):
    find = util.find_spec
    monkeypatch.setattr(util, "find_spec", lambda name, *rest: None if name == "duckdb" else find(name, *rest))
    monkeypatch.setitem(sys.modules, "duckdb", None)
    message = r"the format parquet needs duckdb, which is not installed. Install it from .*pip install '\.\[parquet\]'"
    with pytest.raises(InputError, match=message):
        assess.write_reports(assess_rows(ITEM), tmp_path / "out", "parquet")
    done = call("run", "none.xlsx", "--formats", "csv,parquet", "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert not (tmp_path / "out").exists()
