"""results.json of unknown origin: what is read, and the error that each fault gives."""

from pathlib import Path

import pytest

from assess.compare.past_run import read_run
from assess.errors import InputError
from assess.report.data import VERSION
from tests.compare.past import change, item, write_run
from tests.workbooks import UNVERIFIED

MAJOR = int(VERSION.partition(".")[0])


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return write_run(tmp_path_factory.mktemp("read") / "a", UNVERIFIED)


def test_a_later_minor_version_is_read_whatever_is_new_in_it(source, tmp_path):
    def edit(record):
        record.update(schema=f"{MAJOR}.99", schedule=[{"new": 1}])
        record["routes"]["routes"] = [{"route": "West", "state": "doubtful", "blocked": {"probability": 0.1}}]
        record["assess"]["settings"]["later"] = {"a": 1}

    run = read_run(change(source, tmp_path, edit))
    assert [(one.name, one.state, one.chance.probability, one.chance.low) for one in run.routes] == [
        ("West", "doubtful", 0.1, None)
    ]


def test_texts_are_made_safe(source, tmp_path):
    def edit(record):
        item(record, "A1").update(description="a\u202e\x1b[31mb\nc", room="\ud800")

    piece = read_run(change(source, tmp_path, edit)).pieces[0]
    assert (piece.description, piece.room) == ("a\ufffd[31mb c", "\ufffd")


BAD = {
    "no_file": (None, r"does not exist: name a results\.json, or the folder"),
    "empty": ("", r"is empty"),
    "workbook": ("PK\x03\x04", r"is not a JSON file"),
    "binary": (b"\xff\xfe\x00", r"is not a JSON file"),
    "list": ("[1, 2]", r"was not written by assess"),
    "foreign": ('{"name": "x", "version": 3}', r"was not written by assess"),
    "half_foreign": ('{"schema": "draft", "assess": {}}', r"was not written by assess"),
    "nan": ('{"schema": NaN}', r"is damaged"),
    "deep": ("[" * 200_000 + "]" * 200_000, r"is damaged"),
    "long_number": ('{"schema": ' + "9" * 5000 + "}", r"is damaged"),
    "broken_line": ('{"schema": "4.2",\n"assess" {}}', r"is damaged: line 2"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_no_results_is_named(tmp_path, name):
    content, message = BAD[name]
    path = tmp_path / "results.json"
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError, match=message) as found:
        read_run(path)
    assert str(path) in str(found.value)


def test_a_folder_without_results_is_named(tmp_path):
    with pytest.raises(InputError, match=rf"{tmp_path.name} contains no results\.json"):
        read_run(tmp_path)


def test_a_file_that_is_cut_off_is_named(source, tmp_path):
    whole = (source / "results.json").read_bytes().rstrip()
    for share in (0.1, 0.999):
        (tmp_path / "results.json").write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(InputError, match="is truncated"):
            read_run(tmp_path)


def _set(*path):
    *inside, name, value = path

    def edit(record):
        for one in inside:
            record = record[one]
        record[name] = value

    return edit


EDITS = {
    "earlier": (_set("schema", f"{MAJOR - 1}.7"), rf"earlier version of assess: its schema is {MAJOR - 1}\.7"),
    "later": (_set("schema", f"{MAJOR + 1}.0"), r"later version of assess.*Update assess"),
    "comparison": (_set("comparison", {}), r"is a comparison, not a run"),
    "no_items": (lambda record: record.pop("items"), r"is incomplete: items is missing"),
    "items": (_set("items", {"a": 1}), r"items is \{'a': 1\}, expected a list of objects"),
    "class": (_set("items", 0, "adopted", "class", "grim"), r"items\[0\]\.adopted\.class is 'grim', expected one of"),
    "basis": (_set("items", 1, "adopted", "basis", ["x"]), r"items\[1\]\.adopted\.basis is \['x'\]"),
    "chance": (_set("items", 0, "adopted", "probability", 1.5), r"probability is 1\.5, expected a number from 0 to 1"),
    "endless": (_set("items", 0, "adopted", "probability", 10**400), r"probability is 1000"),
    "null": (_set("items", 0, "adopted", "probability", None), r"probability is None"),
    "flag": (_set("items", 0, "quantity", True), r"items\[0\]\.quantity is True, expected a whole number"),
    "part": (_set("items", 0, "quantity", 1.5), r"quantity is 1\.5"),
    "name": (lambda record: record["items"][2].pop("item"), r"items\[2\]\.item is missing, expected a text"),
    "twice": (_set("items", 1, "item", " a1"), r"items\[1\]: duplicate name"),
    "settings": (_set("assess", "settings", None), r"assess\.settings is None, expected an object"),
    "hash": (_set("assess", "inputs", "sha256", 7), r"assess\.inputs\.sha256 is 7, expected a text"),
    "route": (_set("routes", "routes", [{"route": "W"}]), r"routes\.routes\[0\]\.state is missing"),
    "risk": (_set("routes", "risk", -1), r"routes\.risk is -1"),
}


@pytest.mark.parametrize("name", EDITS)
def test_a_value_that_cannot_be_is_named_by_its_place(source, tmp_path, name):
    edit, message = EDITS[name]
    with pytest.raises(InputError, match=message):
        read_run(change(source, tmp_path, edit))


def test_a_file_too_large_is_not_read(source, monkeypatch):
    monkeypatch.setattr("assess.compare.past_run.MOST_BYTES", 1000)
    with pytest.raises(InputError, match=r"too large: 0 MB, at most 0 MB"):
        read_run(Path(source))


def test_a_shakemap_is_read_with_its_value_and_hash_and_may_be_absent(source, tmp_path):
    """Absent as in files of version 5.0 of the schema."""
    site = {"file": "grid.xml", "pga_g": 0.1525, "sha256": "0123456789abcdef" * 4}
    with_map = change(source, tmp_path / "a", lambda record: record["assess"].update(site_ground=site))
    assert read_run(with_map).site_ground == "grid.xml, 0.152 g, SHA-256 0123456789abcdef"
    without = change(source, tmp_path / "b", lambda record: record["assess"].pop("site_ground"))
    assert read_run(without).site_ground == read_run(source).site_ground == ""
    damaged = change(source, tmp_path / "c", lambda record: record["assess"].update(site_ground=site | {"pga_g": "x"}))
    with pytest.raises(InputError, match=r"assess\.site_ground"):
        read_run(damaged)


def test_where_sizes_come_from_is_an_input_and_measured_where_a_file_does_not_tell(source, tmp_path):
    def edit(record):
        record["items"][0]["sizes_from"] = "scan"
        del record["items"][1]["sizes_from"]

    first, second, *_ = read_run(change(source, tmp_path, edit)).pieces
    assert (first.inputs["sizes_from"], second.inputs["sizes_from"]) == ("scan", "measured")
