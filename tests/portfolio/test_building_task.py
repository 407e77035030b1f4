"""One building: its rows are those of its results, and whatever goes wrong is a reason to skip it."""

import shutil
from dataclasses import replace

import pytest

import assess
from assess.portfolio import building_inventory, building_task
from assess.portfolio.building_rows import build_skipped
from assess.portfolio.building_task import Part, Task, find_key, find_place, read_part, run_task, write_part
from assess.portfolio.sources import IndexRow, Source, find_sources
from assess.portfolio.table_schemas import TABLES
from assess.settings import Settings
from tests.portfolio.staged import StagedGround, write_building, write_city
from tests.workbook.books import write_book
from tests.workbooks import write, write_sheets

SETTINGS = Settings(verify="none", city=True)


@pytest.fixture
def task(tmp_path):
    """Return the task of a building whose shaking is that of the run."""
    (source,) = find_sources(write_city(tmp_path / "city", [40.0]))
    return Task(source=source, settings=SETTINGS, ground=StagedGround(tmp_path), out=tmp_path / "out")


def _rows(task, name, summary=None):
    part = (summary or run_task(task)).part or read_part(task.out, run_task(task).key)
    return [dict(zip([one.key for one in TABLES[name]], row, strict=True)) for row in part.rows(name)]


def test_rows_are_those_of_the_results(task):
    (building,), pieces = _rows(task, "buildings"), _rows(task, "pieces")
    inventory = assess.read_inventory(task.source.file, ground=task.ground)
    results = assess.run(inventory, SETTINGS)
    assert [one["probability"] for one in pieces] == [one.adopted.probability for one in results]
    assert [one["risk_class"] for one in pieces] == [one.adopted.risk.word for one in results]
    free = [one["probability"] * one["quantity"] for one in pieces if not one["is_held"]]
    assert building["expected_falls"] == sum(free)
    assert (building["pieces"], building["anchored"]) == (5, 1)
    assert building["low"] + building["medium"] + building["high"] + building["very_high"] == 4
    assert (building["ground_source"], building["latitude"], building["is_placed"]) == ("shakemap", 40.0, True)
    assert building["ground_pga_g"] == pytest.approx(3 / 9.80665)
    assert (building["inventory"], building["basis"], building["draws"]) == ("surveyed", "formula", 0)
    assert building["works"] == sum(one["quantity"] for one in pieces if one["work_place"])


def test_a_building_is_assessed_again_where_anything_that_it_depends_on_has_changed(task, tmp_path, monkeypatch):
    first = run_task(task)
    with monkeypatch.context() as patch:
        patch.setattr(building_inventory, "read_building", None)
        assert (first.is_kept, run_task(task).is_kept) == (False, True)
    keys, row = {first.key}, IndexRow(path=task.source.path, use="Office")
    indexed = replace(task, source=replace(task.source, index=row))
    for other in (
        indexed,
        replace(task, settings=replace(SETTINGS, scale=1.1)),
        replace(task, ground=StagedGround(tmp_path, sha256="1" * 64)),
        replace(task, source=replace(task.source, path="other.xlsx")),
    ):
        keys.add(run_task(other).key)
    moved = replace(task, source=replace(task.source, index=replace(row, line=7)))
    assert run_task(moved).key == run_task(indexed).key, "a row may stand elsewhere in the index"
    with monkeypatch.context() as patch:
        patch.setattr(building_task, "find_code", lambda: "ab" * 32)
        keys.add(run_task(task).key)
    write_building(task.source.file, latitude=41.0, longitude=10.0)
    keys.add(run_task(task).key)
    assert len(keys) == 7


def test_a_record_that_changes_has_its_building_assessed_again(tmp_path):
    folder = tmp_path / "city"
    folder.mkdir()
    record = assess.resources.record("1103.HN2.NP.RE_a.smc")
    shutil.copyfile(record, folder / "motion.smc")
    write(folder / "a.xlsx", floors=[{"floor": "1", "record_x": "motion.smc"}, {"floor": "2", "pfa_x": 0.3}])
    (source,) = find_sources(folder)
    task = Task(source=source, settings=SETTINGS, ground=None, out=tmp_path / "out")
    assert [run_task(task).is_kept for _ in range(2)] == [False, True]
    text = (folder / "motion.smc").read_bytes()
    (folder / "motion.smc").write_bytes(text + b"\n")
    assert [run_task(task).is_kept for _ in range(2)] == [False, True]


def test_the_index_fills_in_blanks_alone_and_what_contradicts_is_a_warning(task):
    row = IndexRow(
        path=task.source.path, building="Hall", latitude=41.0, longitude=10.0, use="Office", floor_area_m2=90
    )
    other = replace(task, source=replace(task.source, index=row))
    (building,) = _rows(other, "buildings")
    assert (building["building"], building["use"], building["floor_area_m2"]) == ("Hall", "Office", 90.0)
    assert building["latitude"] == 40.0
    (warning,) = [one for one in _rows(other, "problems") if "the index says" in one["message"]]
    assert (warning["severity"], warning["sheet"]) == ("warning", "Building")
    assert warning["message"] == "the index says Latitude 41; the workbook says 40: the workbook holds."
    assert building["warnings"] == 1 + _rows(task, "buildings")[0]["warnings"]


def test_a_workbook_that_cannot_be_used_is_skipped_with_its_problems(task):
    write_building(task.source.file, latitude=40.0, longitude=10.0, storeys=-3)
    assert run_task(task).status == "skipped"
    (problem,) = [one for one in _rows(task, "problems") if one["severity"] == "error"]
    assert (problem["sheet"], "-3" in problem["message"]) == ("Building", True)
    (building,) = _rows(task, "buildings")
    assert (building["status"], building["pieces"], building["expected_falls"]) == ("skipped", None, None)
    write_book(task.source.file, {"Sheet": [["hi"]]})
    errors = [one for one in _rows(task, "problems") if one["severity"] == "error"]
    assert {(one["message"], one["sheet"]) for one in errors[:2]} == {
        ("the sheet is missing.", sheet) for sheet in ("Floors", "Items")
    }
    assert "Latitude, Longitude are blank" in errors[2]["message"], "after the sheets"
    for data in (b"junk", b"PK\x03\x04junk", b""):
        task.source.file.write_bytes(data)
        (problem,) = _rows(task, "problems")
        assert "b00.xlsx is" in problem["message"]
    assert (problem["message"], problem["fix"]) == ("b00.xlsx is empty (0 bytes).", "Download or copy it again.")
    source = Source(path="x.xlsx", refused="it is a link that leads out of the folder.", fix="Copy the workbook here.")
    (problem,) = _rows(replace(task, source=source), "problems")
    assert (problem["message"], problem["fix"]) == (source.refused, source.fix)


def test_a_use_is_spelled_as_the_workbook_offers_it(task):
    workbook = task.source.file.read_bytes()
    for data, row, use in (
        (workbook, "office", "Office"),
        (b"junk", "HOSPITAL", "Hospital"),
        (workbook, "ufficio", "ufficio"),
    ):
        task.source.file.write_bytes(data)
        index = replace(task, source=replace(task.source, index=IndexRow(path=task.source.path, use=row)))
        assert _rows(index, "buildings")[0]["use"] == use


@pytest.mark.parametrize(("error", "message"), [(MemoryError, "memory of this machine"), (KeyError("x"), "KeyError")])
def test_an_unforeseen_error_skips_the_building_and_keeps_its_traceback_in_the_parts(task, monkeypatch, error, message):
    def fail(*_):
        raise error

    monkeypatch.setattr(building_inventory, "read_building", fail)
    summary = run_task(task)
    (problem,) = _rows(task, "problems")
    assert message in problem["message"]
    assert "Traceback" not in problem["message"] + problem["fix"]
    trace = find_place(task.out, summary.key).with_suffix(".txt")
    assert trace.exists() is (error is not MemoryError)
    if trace.exists():
        assert trace.name in problem["fix"]
        assert "in fail" in trace.read_text(encoding="utf-8")


@pytest.mark.slow
def test_simulated_draws_are_summed_draw_by_draw(task):
    task = replace(task, settings=Settings(verify="all", runs=20, city=True))
    part = read_part(task.out, run_task(task).key)
    (building,), draws = _rows(task, "buildings"), _rows(task, "draws")
    assert [one["draw"] for one in draws] == list(range(20))
    falls = sorted(one["falls"] for one in draws)
    assert sum(falls) / 20 == pytest.approx(building["expected_falls"])
    assert (building["falls_p05"], building["falls_p95"]) == (falls[0], falls[18])
    assert part.draws["people_blocked"] == [0] * 20


@pytest.mark.slow
def test_a_route_that_is_not_known_has_no_chance_and_its_people_no_number(tmp_path):
    """A number there would look safer than what is known."""
    folder = tmp_path / "city"
    folder.mkdir()
    write_sheets(folder / "both.xlsx", {
        "Building": [{"ground_pga": 0.4, "height": 7}], "Floors": [{"floor": "1", "elevation": 3}],
        "Items": [{"item": "A1", "floor": "1", "breadth": 30, "width": 80, "height": 200, "route": "East",
                   "edge_distance": 0.2}],
        "Places": [{"place": "Hall", "floor": "1", "x": 0, "y": 0, "kind": "room"},
                   {"place": "Exit", "floor": "1", "x": 10, "y": 0, "kind": "exit"}],
        "Routes": [{"route": "East", "segment": "E1", "floor": "1", "start": "Hall", "end": "Exit", "clear_width": 1.2,
                    "occupants": 12}, {"route": "West", "segment": "W1", "occupants": 30}],
    })  # fmt: skip
    (source,) = find_sources(folder)
    drawn = Task(source=source, settings=Settings(city=True, runs=20), ground=None, out=tmp_path / "simulated")
    task = replace(drawn, settings=SETTINGS, out=tmp_path / "out")
    east, _west = _rows(drawn, "routes")
    assert 0 <= east["probability_low"] < east["probability_high"] <= 1
    (building,), (east, west) = _rows(task, "buildings"), _rows(task, "routes")
    assert (west["state"], west["probability"], west["blockers"]) == ("not known", None, None)
    assert west["to_fill_in"]
    assert (east["probability"] > 0, east["blockers"]) == (True, "A1")
    assert east["probability_low"] is east["probability_high"] is None, "nothing was simulated"
    assert building["people_blocked"] == pytest.approx(12 * east["probability"])
    assert (building["occupants"], building["people_not_known"]) == (42, 30)


# ---------------------------------------------------------------- parts

KEY = find_key("a.xlsx", None, 1.5)
NAMED = Source(path="a\n=b\u2028.xlsx")
PART = Part(path=NAMED.path, key=KEY, status="assessed", tables=build_skipped(NAMED, []),
            draws={"falls": [0, 2], "people_blocked": [0, 0], "routes_blocked": [0, 1]})  # fmt: skip


def test_a_part_comes_back_as_it_was_and_one_that_is_damaged_is_none(tmp_path):
    write_part(tmp_path, PART)
    assert read_part(tmp_path, KEY) == PART
    assert PART.rows("draws") == [[PART.path, 0, 0, 0, 0], [PART.path, 1, 2, 0, 1]]
    place = find_place(tmp_path, KEY)
    data = place.read_bytes()
    for size in (0, 1, len(data) // 2, len(data) - 1):
        place.write_bytes(data[:size])
        assert read_part(tmp_path, KEY) is None
    for at in range(10, len(data)):
        place.write_bytes(data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :])
        assert read_part(tmp_path, KEY) in (None, PART)  # a bit that only fills up a byte changes nothing


def test_a_part_of_other_columns_or_of_another_key_is_none(tmp_path):
    short = {name: [row[:-1] for row in rows] for name, rows in PART.tables.items()}
    write_part(tmp_path, Part(path="a", key=KEY, status="assessed", tables=short))
    assert read_part(tmp_path, KEY) is None
    write_part(tmp_path, PART)
    other = find_place(tmp_path, "0" * 64)
    other.parent.mkdir(parents=True)
    other.write_bytes(find_place(tmp_path, KEY).read_bytes())
    assert read_part(tmp_path, "0" * 64) is None
