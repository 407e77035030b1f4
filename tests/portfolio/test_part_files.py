"""Parts: written whole, known by their key, and computed again where they are damaged or their files have changed."""

import hashlib

import pytest

from assess.portfolio.building_rows import build_skipped
from assess.portfolio.part_files import FOLDER, Part, find_key, find_place, is_done, read_part, sweep_parts, write_part
from assess.portfolio.table_schemas import TABLES

KEY = find_key("a.xlsx", None, 1.5)
PART = Part(path="a\n=b\u2028.xlsx", key=KEY, status="assessed", tables=build_skipped("a\n=b\u2028.xlsx", []),
            draws={"falls": [0, 2], "people_blocked": [0, 0], "routes_blocked": [0, 1]})  # fmt: skip


def test_a_part_comes_back_as_it_was_and_has_the_same_bytes(tmp_path):
    write_part(tmp_path, PART)
    data = find_place(tmp_path, KEY).read_bytes()
    assert read_part(tmp_path, KEY) == PART
    write_part(tmp_path, PART)
    assert find_place(tmp_path, KEY).read_bytes() == data
    assert len(PART.rows("buildings")[0]) == len(TABLES["buildings"])
    assert PART.rows("draws") == [[PART.path, 0, 0, 0, 0], [PART.path, 1, 2, 0, 1]]


def test_what_it_depends_on_changes_its_key():
    keys = {find_key(*one) for one in (("a", 1), ("a", "1"), ("a", 1.0), ("a", None), ("a", {"b": 1}), ("a1",))}
    assert len(keys) == 6
    assert find_key({"a": 1, "b": 2}) == find_key({"b": 2, "a": 1})


def test_a_part_that_is_cut_off_or_damaged_is_none(tmp_path):
    write_part(tmp_path, PART)
    place = find_place(tmp_path, KEY)
    data = place.read_bytes()
    for size in (0, 1, len(data) // 2, len(data) - 1):
        place.write_bytes(data[:size])
        assert read_part(tmp_path, KEY) is None
    for at in range(10, len(data)):
        place.write_bytes(data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :])
        assert read_part(tmp_path, KEY) in (None, PART)  # a bit that only fills up a byte changes nothing
    assert read_part(tmp_path, "f" * 64) is None


def test_a_part_of_other_columns_or_of_another_key_is_none(tmp_path):
    short = {name: [row[:-1] for row in rows] for name, rows in PART.tables.items()}
    write_part(tmp_path, Part(path="a", key=KEY, status="assessed", tables=short))
    assert read_part(tmp_path, KEY) is None
    write_part(tmp_path, PART)
    other = find_place(tmp_path, "0" * 64)
    other.parent.mkdir(parents=True)
    other.write_bytes(find_place(tmp_path, KEY).read_bytes())
    assert read_part(tmp_path, "0" * 64) is None


def test_a_part_is_done_while_the_files_that_its_workbook_names_are_what_they_were(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "motion.txt").write_bytes(b"1")
    part = Part(path="a", key=KEY, status="assessed", tables=PART.tables,
                files={"sub/motion.txt": hashlib.sha256(b"1").hexdigest()})  # fmt: skip
    assert is_done(part, tmp_path)
    (tmp_path / "sub" / "motion.txt").write_bytes(b"2")
    assert not is_done(part, tmp_path)
    (tmp_path / "sub" / "motion.txt").unlink()
    assert not is_done(part, tmp_path)
    assert not is_done(Part(path="a", key=KEY, status="skipped", tables=PART.tables), tmp_path)
    assert not is_done(None, tmp_path)


def test_what_a_killed_process_left_is_removed(tmp_path):
    write_part(tmp_path, PART)
    left = find_place(tmp_path, KEY).with_name(".writing-123-abcd")
    left.write_bytes(b"half")
    sweep_parts(tmp_path)
    assert sorted(path.name for path in (tmp_path / FOLDER).glob("*/*")) == [f"{KEY}.part"]


def test_a_disk_that_is_full_leaves_nothing(tmp_path):
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
        with pytest.raises(OSError, match="too large"):
            write_part(tmp_path, PART)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list((tmp_path / FOLDER).glob("*/*")) == []
