"""The tables as Parquet: fixed types, the same bytes, several files for many rows."""

import sys

import pandas as pd
import pytest

from assess.errors import InputError
from assess.portfolio import city_tables
from assess.portfolio.building_task import Part
from assess.portfolio.city_tables import build_frame, check_tables, find_files, read_table, write_tables
from assess.portfolio.table_schemas import TABLES


def _rows(count):
    texts = ("=1+1", "<script>", 'a"b', "a\nb", "é'", None)
    rows = (
        {"path": texts[at % 6], "quantity": at % 7 or None, "pfa_g": at / 3, "is_held": bool(at % 2)}
        for at in range(count)
    )
    return [[row.get(field.key) for field in TABLES["pieces"]] for row in rows]


def _write(name, rows, folder):
    part = Part(path="a", key="", status="assessed", tables={name: rows})
    pd.testing.assert_frame_equal(write_tables([part], folder)[name], build_frame(name, rows))
    return find_files(folder, name)


def test_what_is_written_is_read_again_also_from_a_folder_whose_name_is_no_sql(tmp_path):
    rows, folder = _rows(20), tmp_path / "it's; DROP"
    (path,) = _write("pieces", rows, tmp_path)
    assert path.name == "pieces.parquet"
    pd.testing.assert_frame_equal(read_table(tmp_path, "pieces"), build_frame("pieces", rows))
    folder.mkdir()
    _write("routes", [], folder)
    assert read_table(folder, "routes").empty


@pytest.mark.slow
def test_columns_that_are_empty_keep_their_types(tmp_path):
    duckdb = pytest.importorskip("duckdb")
    for name, columns in TABLES.items():
        _write(name, [], tmp_path)
        found = duckdb.sql(f"DESCRIBE SELECT * FROM '{tmp_path / name}.parquet'").fetchall()
        assert [(one[0], one[1]) for one in found] == [(one.key, city_tables.SQL_TYPES[one.kind]) for one in columns]
        assert list(read_table(tmp_path, name).columns) == [one.key for one in columns]


def test_many_rows_take_several_files_and_come_back_in_order(tmp_path, monkeypatch):
    monkeypatch.setattr(city_tables, "ROWS", 7)
    rows = _rows(20)
    assert [path.name for path in _write("pieces", rows, tmp_path)] == [f"pieces-000{at}.parquet" for at in (1, 2, 3)]
    pd.testing.assert_frame_equal(read_table(tmp_path, "pieces"), build_frame("pieces", rows))


def test_the_same_rows_give_the_same_bytes(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (path,) = _write("pieces", _rows(3000), tmp_path / name)
    assert (tmp_path / "one" / path.name).read_bytes() == path.read_bytes()


def test_what_cannot_be_read_is_named_and_without_duckdb_one_line_says_what_to_install(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="'rooms' is an unknown table; expected one of: buildings, pieces"):
        read_table(tmp_path, "rooms")
    with pytest.raises(InputError, match=r"there is no pieces.parquet"):
        read_table(tmp_path, "pieces")
    (tmp_path / "pieces.parquet").write_bytes(b"PAR1 no more")
    with pytest.raises(InputError, match=r"pieces.parquet cannot be read"):
        read_table(tmp_path, "pieces")
    monkeypatch.setitem(sys.modules, "duckdb", None)
    message = r"needs duckdb, which is not installed. Install it from .*pip install '\.\[parquet\]'"
    with pytest.raises(InputError, match=message):
        check_tables()
