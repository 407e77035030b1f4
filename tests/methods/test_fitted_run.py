"""Fitted models in a run: reports show them, and no adopted risk goes by them."""

import csv
import dataclasses
import json

import jsonschema
import numpy as np
import openpyxl
import pytest

import assess
from assess.errors import InputError
from assess.methods import all_methods
from assess.methods.fitted import Polynomial
from assess.pipeline.run import compute
from assess.report.data import SCHEMA
from assess.settings import Settings
from tests.cli.calling import run
from tests.methods.test_fitted import NO_FILE, ON, PROBIT, SURFACE, k, of, saved, spoilt
from tests.workbooks import UNVERIFIED, write

pytestmark = pytest.mark.slow


class TestRun:
    @pytest.fixture
    def book(self, tmp_path):
        return write(tmp_path / "w.xlsx")

    @pytest.mark.parametrize("settings", [UNVERIFIED, Settings(runs=5)], ids=["none", "high"])
    def test_no_adopted_risk_or_choice_goes_by_it(self, book, settings):
        always = dataclasses.replace(SURFACE, formula=Polynomial("x", ((0, 0, 1.0),)))
        inventory = assess.read_inventory(book)
        without = compute(inventory, settings)
        with_it = compute(inventory, settings, methods=[of(always), of(PROBIT)])
        assert [one.key for one in with_it.methods] == [
            *(one.key for one in all_methods()), "fitted_surface", "fitted_probit",
        ]  # fmt: skip
        assert with_it.outcomes["fitted_surface"].value.tolist() == [1.0] * len(with_it.case_item)
        for name in ("probability", "risk", "upper", "basis"):
            np.testing.assert_array_equal(getattr(with_it.adoption, name), getattr(without.adoption, name))
        np.testing.assert_array_equal(with_it.governing, without.governing)

    @pytest.mark.parametrize(("key", "title", "name"), [("surface", "Other", "key"), ("other", "Surface (8)", "title")])
    def test_no_two_of_one_name(self, book, key, title, name):
        twin = dataclasses.replace(SURFACE, key=f"fitted_{key}", title=title)
        with pytest.raises(InputError, match=f"two methods have the {name} "):
            compute(assess.read_inventory(book), UNVERIFIED, methods=[of(SURFACE), of(twin)])

    def test_every_report_shows_it(self, book, tmp_path):
        odd = dataclasses.replace(SURFACE, title="Surface <b>8</b> & {x}")
        files = [saved(tmp_path, odd, "a.toml"), saved(tmp_path, PROBIT, "b.toml")]
        out = tmp_path / "out"
        told = [word for file in files for word in ("--method", str(file))]
        done = run_cli(book, "--out", str(out), "--formats", "json,xlsx,html,csv", *told)
        assert done.exit_code == 0, done.stderr
        results = json.loads((out / "results.json").read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(results)
        assert set(results["assess"]["fitted_models"]) == {"fitted_surface", "fitted_probit"}
        assert {item["adopted"]["method"] for item in results["items"]} == {"fema_p58"}
        heads = next(csv.reader((out / "items.csv").read_text(encoding="utf-8-sig").splitlines()))
        for model in (odd, PROBIT):
            assert all({"value", "raw", "flags"} == set(item["methods"][model.key]) for item in results["items"])
            assert {model.key, f"{model.key}_raw", f"{model.key}_flags"} <= set(heads)
        page = (out / "report.html").read_text(encoding="utf-8")
        assert "Surface <b>8" not in page
        names = ("Surface &lt;b&gt;8&lt;/b&gt; &amp; {x}", "Probit with size")
        escaped = [f"{one} (fitted on 3 buildings)" for one in names]
        for title in escaped:
            assert f"<h3>{title}</h3>" in page  # the methods
            assert f'class="num">{title}</th>' in page  # the comparison
        assert f"<strong>{escaped[0]}</strong>" in page  # the worked example
        assert page.count(f"Fitted to computed chances on {ON};") >= 2 * 2  # its source and the references
        assert "PFV 4 to 150 cm/s, PFV/PFA 0.03 to 0.25 s.</p>" in page
        check_workbook(out / "report.xlsx", [f"{one.title} (fitted on 3 buildings)" for one in (odd, PROBIT)])

    def test_without_one_nothing_is_said_of_them(self, book, tmp_path):
        assert run_cli(book, "--out", str(tmp_path / "out"), "--formats", "json").exit_code == 0
        assert "fitted" not in (tmp_path / "out" / "results.json").read_text(encoding="utf-8")

    def test_a_broken_file_writes_nothing(self, book, tmp_path):
        broken = spoilt(tmp_path, repr(k.b), "nan")
        done = run_cli(book, "--out", str(tmp_path / "out"), "--method", str(broken))
        assert done.exit_code == 2
        assert f"error  {broken}: polynomial.terms[1] is nan, expected a number of at most 1e+30." in done.stderr
        assert not (tmp_path / "out").exists()

    def test_a_folder_and_too_many_are_told(self, book, tmp_path):
        done = run_cli(book, "--out", str(tmp_path / "out"), "--method", str(tmp_path))
        assert (done.exit_code, f"error  {tmp_path}: {NO_FILE}" in done.stderr) == (2, True)
        assert not (tmp_path / "out").exists()
        path = str(saved(tmp_path))
        done = run_cli(book, "--out", str(tmp_path / "out"), *["--method", path] * 5)
        assert (done.exit_code, "5 files; a report has room for 4" in done.stderr) == (2, True)
        done = run_cli(book, "--out", str(tmp_path / "out"), *["--method", path] * 2)
        assert (done.exit_code, "two methods have the key 'fitted_surface'" in done.stderr) == (2, True)
        assert not (tmp_path / "out").exists()


def run_cli(book, *arguments):
    return run("run", "--verify", "none", str(book), *arguments)


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
def check_workbook(path, titles):
    book = openpyxl.load_workbook(path, read_only=True)
    heads = [cell.value for row in book["Items"].iter_rows(max_row=2) for cell in row]
    named = {row[0].value for row in book["Methods"].iter_rows()}
    for title in titles:
        assert f"{title} (as run)" in heads
        assert title in named
