"""`assess compare`: two runs of a small workbook through the real commands, and every bad input."""

import json
import shlex

import pytest

import assess.version
from tests.cli.calling import run
from tests.workbooks import write

QUICK = ("--runs", "60", "--formats", "json")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The workbook assessed as it is, at 1.5 times the motion, with two items anchored, and by the formulas alone."""
    folder = tmp_path_factory.mktemp("runs")
    book = write(folder / "hall.xlsx", building="Town hall", period=0.8)
    for name, options in {
        "base": QUICK,
        "strong": (*QUICK, "--scale", "1.5"),
        "held": (*QUICK, "--anchor", "A1,A3"),
        "formula": ("--verify", "none", "--formats", "json"),
    }.items():
        done = run("run", book, "--out", folder / name, *options)
        assert done.exit_code == 0, done.output
    return folder


def _compare(folder, before, after, *options):
    done = run("compare", folder / before, folder / after, *options)
    assert done.exit_code == 0, done.output
    return done


def test_anchored_pieces_get_better_and_before_and_after_are_what_each_run_says(folder, tmp_path):
    done = _compare(folder, "base", "held", "--out", tmp_path, "--formats", "html", "--json")
    record = json.loads(done.stdout)
    changes = {one["item"]: one["change"] for one in record["items"]}
    assert changes == {"A1": "better", "A3": "better", "A2": "same", "A4": "same", "A5": "same"}
    assert record["after"]["settings"]["anchor"] == "A1,A3"
    assert record["counts"]["pieces"]["anchored"] == {
        "before": 1, "after": 5, "comparable": True, "within_sampling_interval": None,
    }  # fmt: skip
    assert "AFTER: taken as anchored: A1, A3" in (tmp_path / "compare.html").read_text(encoding="utf-8")
    record = json.loads(_compare(folder, "base", "strong", "--out", tmp_path, "--formats", "json", "--json").stdout)
    for side, name in (("before", "base"), ("after", "strong")):
        own = json.loads((folder / name / "results.json").read_text(encoding="utf-8"))
        adopted = {one["item"]: one["adopted"] for one in own["items"]}
        for one in record["items"]:
            assert one[side]["probability"] == adopted[one["item"]]["probability"]
            assert one[side]["class"] == adopted[one["item"]]["class"]


@pytest.mark.slow
def test_files_go_to_the_current_folder_by_default(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    _compare(folder, "base", "strong")
    names = {path.name for path in (tmp_path / "compare").iterdir()}
    assert names == {"compare.html", "compare.pdf", "compare.xlsx", "compare.json"}


def test_the_files_speak_the_language_of_the_workbook_or_the_one_asked_for(folder, tmp_path):
    for options, code in (((), "en"), (("--language", "italiano"), "it")):
        _compare(folder, "base", "base", "--out", tmp_path, "--formats", "html", *options)
        assert f'<html lang="{code}">' in (tmp_path / "compare.html").read_text(encoding="utf-8")


@pytest.fixture
def older(folder, tmp_path):
    """Return the folder of a run that says it was computed by other code, or does not say by which."""

    def make(code, run="strong"):
        record = json.loads((folder / run / "results.json").read_text(encoding="utf-8"))
        record["assess"].pop("code")
        record["assess"] |= {"code": code} if code else {}
        (tmp_path / "older").mkdir(exist_ok=True)
        (tmp_path / "older" / "results.json").write_text(json.dumps(record), encoding="utf-8")
        return tmp_path / "older"

    return make


@pytest.mark.parametrize("code", ["ab" * 32, ""])
def test_a_run_by_other_code_is_assessed_again_by_the_command_that_the_error_prints(
    folder, older, tmp_path, monkeypatch, code
):
    before = older(code)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hall.xlsx").write_bytes((folder / "hall.xlsx").read_bytes())
    told = run("compare", before, folder / "strong")
    assert told.exit_code == 2
    lines = told.stderr.splitlines()
    assert "were computed by different code of assess" in lines[0]
    assert not (tmp_path / "compare").exists()
    (line,) = [line for line in lines if "Assess BEFORE again" in line]
    command = shlex.split(line.partition(": ")[2])
    assert command[:2] == ["assess", "run"]
    assert run(*command[1:], "--formats", "json").exit_code == 0
    done = _compare(folder, tmp_path / "older-again", "strong", "--out", tmp_path / "out", "--formats", "json")
    assert "\nNothing changed:" in done.stdout, done.stdout


@pytest.mark.parametrize("name", ["../../hall.xlsx", "/dev/zero", "."])
def test_a_workbook_is_looked_for_by_its_name_alone(older, folder, name):
    before = older("ab" * 32)
    record = json.loads((before / "results.json").read_text(encoding="utf-8"))
    record["assess"]["inputs"]["workbook"] = name
    (before / "results.json").write_text(json.dumps(record), encoding="utf-8")
    told = run("compare", before, folder / "strong")
    assert told.exit_code == 2
    assert "/dev" not in told.stderr
    assert "../.." not in told.stderr


def test_runs_by_different_code_are_compared_as_they_are_under_a_sentence_that_says_it(folder, older, tmp_path):
    done = _compare(folder, older("ab" * 32), "base", "--as-is", "--out", tmp_path / "out", "--formats", "html")
    first = "The two runs were computed by different code of assess"
    assert done.stdout.startswith(first)
    page = (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    assert page.index(first) < page.index("Counts before and after")
    document = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert document["comparison"]["same_code"] is False


def test_the_code_of_the_program_is_another_where_any_module_or_table_is(tmp_path, monkeypatch):
    (tmp_path / "deep").mkdir()
    module, table = tmp_path / "version.py", tmp_path / "deep" / "table.csv"
    found = set()
    for text, rows in (("a = 1", "1,2"), ("a = 2", "1,2"), ("a = 1", "1,3")):
        module.write_text(text, encoding="utf-8")
        table.write_text(rows, encoding="utf-8")
        monkeypatch.setattr(assess.version, "__file__", str(module))
        found.add(assess.version.find_code.__wrapped__())
    assert len(found) == 3
