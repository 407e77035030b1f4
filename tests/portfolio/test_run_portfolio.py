"""A portfolio from end to end: the same bytes however it was run, whatever died on the way or is in the folder."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import openpyxl
import pytest

from assess.delivery.folders import FolderLock
from assess.errors import CancelledError, InputError, OutputError
from assess.portfolio import local_pool
from assess.portfolio.building_task import FOLDER, Task, run_task
from assess.portfolio.city_tables import read_table
from assess.portfolio.run_portfolio import run_portfolio
from assess.portfolio.sources import find_sources
from assess.settings import Settings
from tests.portfolio.staged import FILLS, HOLDS, KILLS, KILLS_ONCE, StagedGround, read_results, write_city
from tests.waiting import wait_until
from tests.workbook.books import write_book

ROOT = Path(__file__).parents[2]
FORMULAS = Settings(verify="none")
posix = pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")


def _run(tmp_path, out="out", *, settings=FORMULAS, formats=("parquet",), jobs=2, **options):
    ground = options.pop("ground", StagedGround(tmp_path))
    return run_portfolio(
        tmp_path / "city", tmp_path / out, settings, ground=ground, jobs=jobs, formats=formats, **options
    )


# ---------------------------------------------------------------- the same bytes


@pytest.mark.slow
def test_a_plain_loop_one_process_and_two_give_the_same_bytes(tmp_path):
    """What is written of the tables is written here however they came about: it is compared once."""
    write_city(tmp_path / "city", [40.0, 41.0])
    (tmp_path / "city" / "bad.xlsx").write_bytes(b"no workbook")
    settings, formats = Settings(verify="all", runs=10), ("parquet", "xlsx", "html", "pdf")
    one = _run(tmp_path, "one", settings=settings, formats=formats, jobs=1)
    _run(tmp_path, "two", settings=settings, jobs=2)
    loop = tmp_path / "loop"
    for source in reversed(find_sources(tmp_path / "city")):
        run_task(Task(source=source, settings=one.city.settings, ground=StagedGround(tmp_path), out=loop))
    looped = _run(tmp_path, "loop", settings=settings, formats=formats, jobs=1)
    assert looped.kept == 2  # computed by the loop alone, but for the one that is skipped
    first = read_results(tmp_path / "one")
    assert set(first) >= {"buildings.parquet", "city.html", "city.pdf", "portfolio.json", "ranking.xlsx"}
    assert first == read_results(loop)
    second = read_results(tmp_path / "two")
    assert {name: data for name, data in second.items() if name != "portfolio.json"} == {
        name: data for name, data in first.items() if name.endswith(".parquet")
    }
    falls = read_table(tmp_path / "one", "draws").groupby("path")["falls"].sum()
    assert (falls > 0).any()


@pytest.mark.slow
def test_a_second_run_assesses_nothing_but_damaged_parts_and_gives_the_same_bytes(tmp_path):
    write_city(tmp_path / "city", [40.0, 41.0])
    assert _run(tmp_path).kept == 0
    before = read_results(tmp_path / "out")
    assert _run(tmp_path, jobs=1).kept == 2
    assert read_results(tmp_path / "out") == before
    parts = tmp_path / "out" / FOLDER
    for path, size in zip(sorted(parts.glob("*/*.part")), (0, 300), strict=True):
        path.write_bytes(path.read_bytes()[:size])
    assert _run(tmp_path, jobs=1).kept == 0
    assert read_results(tmp_path / "out") == before
    (tmp_path / "city" / "b01.xlsx").rename(tmp_path / "city" / "b02.xlsx")
    assert _run(tmp_path, jobs=1).kept == 1
    assert list(read_table(tmp_path / "out", "buildings")["path"]) == ["b00.xlsx", "b02.xlsx"]
    assert len(list(parts.glob("*/*.part"))) == 2, "that of the building that is gone went with it"


# ---------------------------------------------------------------- what dies on the way


@posix
@pytest.mark.slow
def test_a_process_that_is_killed_changes_no_byte_and_a_workbook_that_kills_each_is_skipped(tmp_path, monkeypatch):
    write_city(tmp_path / "city", [40.0, KILLS_ONCE, KILLS, 40.0])
    result = _run(tmp_path)
    assert (tmp_path / "killed").exists()
    assert [path for path, _ in result.skipped] == ["b02.xlsx"]
    assert all("process that assessed it was ended by the system" in why for _, why in result.skipped)
    states = list(read_table(tmp_path / "out", "buildings")["status"])
    assert states == ["assessed", "assessed", "skipped", "assessed"]
    monkeypatch.setattr(local_pool, "MOST_DEATHS", 1)
    _run(tmp_path, "undisturbed", jobs=1)
    assert read_results(tmp_path / "out") == read_results(tmp_path / "undisturbed")


@posix
@pytest.mark.slow
def test_a_run_that_is_killed_goes_on_where_it_was(tmp_path):
    write_city(tmp_path / "city", [40.0, 40.0, 40.0, HOLDS])
    (tmp_path / "hold").touch()
    code = (
        "from pathlib import Path\nfrom tests.portfolio import test_run_portfolio as t\n"
        f"t._run(Path({str(tmp_path)!r}), jobs=2)"
    )
    parts = tmp_path / "out" / FOLDER
    with subprocess.Popen([sys.executable, "-c", code], cwd=ROOT) as command:
        wait_until(lambda: len(list(parts.glob("*/*.part"))) == 3 and list(tmp_path.glob("held-*")))
        command.send_signal(signal.SIGKILL)
    assert not (tmp_path / "out" / "buildings.parquet").exists()
    (tmp_path / "hold").unlink()
    assert _run(tmp_path, jobs=1).kept == 3
    _run(tmp_path, "undisturbed", jobs=1)
    assert read_results(tmp_path / "out") == read_results(tmp_path / "undisturbed")
    assert sorted(read_table(tmp_path / "out", "buildings")["path"]) == ["b00.xlsx", "b01.xlsx", "b02.xlsx", "b03.xlsx"]


@posix
@pytest.mark.slow
def test_a_process_that_cannot_write_is_reported_and_the_next_run_makes_up_for_it(tmp_path):
    write_city(tmp_path / "city", [40.0, 40.0, FILLS])
    (tmp_path / "full").touch()
    first = _run(tmp_path, jobs=1)
    assert [path for path, _ in first.skipped] == ["b02.xlsx"]
    assert "could not be written" in first.skipped[0][1]
    (tmp_path / "full").unlink()
    second = _run(tmp_path, jobs=1)
    assert (second.skipped, second.kept) == ((), 2)
    _run(tmp_path, "undisturbed", jobs=1)
    assert read_results(tmp_path / "out") == read_results(tmp_path / "undisturbed")


@posix
@pytest.mark.slow
def test_a_cancel_writes_nothing_and_keeps_what_is_done(tmp_path):
    write_city(tmp_path / "city", [40.0, HOLDS])
    (tmp_path / "hold").touch()
    cancel, parts = threading.Event(), tmp_path / "out" / FOLDER

    def stop():
        wait_until(lambda: list(parts.glob("*/*.part")))
        cancel.set()

    watch = threading.Thread(target=stop)
    watch.start()
    with pytest.raises(CancelledError):
        _run(tmp_path, cancel=cancel)
    watch.join()
    assert [path.name for path in (tmp_path / "out").iterdir()] == [FOLDER]
    (tmp_path / "hold").unlink()
    assert _run(tmp_path, jobs=1).kept == 1


# ---------------------------------------------------------------- what is in the folders


@posix
@pytest.mark.slow
def test_names_that_attack_are_data_in_every_result_and_reports_of_an_earlier_run_go(tmp_path):
    write_city(tmp_path / "city", [40.0])
    names = ["=cmd|'1'!A1.xlsx", "<script>alert(1)<%2fscript>.xlsx", "a\nb\x1b[31m.xlsx", "'; DROP TABLE x;--.xlsx"]
    for name in names:
        (tmp_path / "city" / name).write_bytes((tmp_path / "city" / "b00.xlsx").read_bytes())
    _run(tmp_path, jobs=1, formats=("parquet", "xlsx", "html"))
    assert set(read_table(tmp_path / "out", "buildings")["path"]) == {*names, "b00.xlsx"}
    assert "<script>alert(1)" not in (tmp_path / "out" / "city.html").read_text(encoding="utf-8")
    book = openpyxl.load_workbook(tmp_path / "out" / "ranking.xlsx")
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row if "cmd|" in str(cell.value)]
    assert cells
    assert {cell.data_type for cell in cells} == {"s"}
    (tmp_path / "out" / "mine.txt").write_text("mine", encoding="utf-8")
    _run(tmp_path, jobs=1, formats=("parquet",))
    assert not (tmp_path / "out" / "city.html").exists()
    assert (tmp_path / "out" / "mine.txt").read_text(encoding="utf-8") == "mine"
    listed = json.loads((tmp_path / "out" / "portfolio.json").read_text(encoding="utf-8"))
    assert set(listed["assess"]["files"]) == {f"{name}.parquet" for name in listed["tables"]}
    assert listed["assess"]["ground"]["file"] == "staged.csv"
    assert listed["buildings"] == {"assessed": 5, "skipped": 0}


def test_what_cannot_be_done_is_an_error_before_the_work(tmp_path, monkeypatch):
    city = write_city(tmp_path / "city", [40.0])
    with pytest.raises(InputError, match="holds the workbooks; name another folder"):
        run_portfolio(city, city, FORMULAS)
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="is a file; name a folder"):
        run_portfolio(city, tmp_path / "file", FORMULAS)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "ranking.xlsx").write_bytes(b"mine")
    with pytest.raises(InputError, match=r"would be replaced, but no portfolio.json beside them .*: ranking.xlsx\."):
        run_portfolio(city, tmp_path / "out", FORMULAS)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["ranking.xlsx"]
    (tmp_path / "out" / "ranking.xlsx").unlink()
    with pytest.raises(InputError, match="formats: 'csv' is unknown, expected some of: parquet"):
        run_portfolio(city, tmp_path / "out", FORMULAS, formats=("csv",))
    with pytest.raises(InputError, match="runs is auto: all buildings of a city need the same draws"):
        run_portfolio(city, tmp_path / "out", Settings(runs="auto"))
    with pytest.raises(InputError, match="runs is 20, expected a multiple of 50, the number of scenarios"):
        run_portfolio(city, tmp_path / "out", Settings(runs=20), ground=SimpleNamespace(event_count=50))
    with pytest.raises(InputError, match=r"scheduler is 'http://127\.0\.0\.1:1', expected tcp://HOST:PORT"):
        run_portfolio(city, tmp_path / "out", scheduler="http://127.0.0.1:1")
    monkeypatch.setitem(sys.modules, "duckdb", None)
    with pytest.raises(InputError, match=re.escape("pip install '.[parquet]'")):
        run_portfolio(city, tmp_path / "out", FORMULAS)
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=re.escape("pip install '.[cluster]'")):
        run_portfolio(city, tmp_path / "out", FORMULAS, formats=("html",), scheduler="tcp://127.0.0.1:1")


def test_two_runs_into_one_folder_do_not_mix(tmp_path):
    city = write_city(tmp_path / "city", [40.0])
    (tmp_path / "out" / FOLDER).mkdir(parents=True)
    lock = FolderLock(tmp_path / "out" / FOLDER)
    assert lock.take()
    with pytest.raises(OutputError, match="is in use: another run is writing to it"):
        run_portfolio(city, tmp_path / "out", FORMULAS, formats=("parquet",))
    lock.release()


@pytest.mark.slow
def test_why_a_building_was_skipped_begins_a_sentence_and_does_not_name_its_file_again(tmp_path):
    city = write_city(tmp_path / "city", [40.0])
    (city / "sub").mkdir()
    (city / "sub" / "text.xlsx").write_bytes(b"text")
    (city / "empty.xlsx").write_bytes(b"")
    (city / "old.xls").write_bytes(b"")
    write_book(city / "other.xlsx", {"Sheet": [["hi"]]})
    found = dict(_run(tmp_path, jobs=1).skipped)
    missing = "the sheet is missing. Add it, or start from a workbook made with `assess new`."
    assert found.pop("other.xlsx") in (f"Items: {missing}", f"Floors: {missing}")
    assert found == {
        "sub/text.xlsx": "It is not an Excel workbook (.xlsx). Save it from Excel as .xlsx.",
        "empty.xlsx": "It is empty (0 bytes). Download or copy it again.",
        "old.xls": "Workbooks ending in .xls are not read. Save it as .xlsx (Excel Workbook) and remove this file.",
    }
