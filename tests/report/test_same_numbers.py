"""Every number of a piece, and every count, is the same in results.json, items.csv, the Excel report, HTML and PDF."""

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest

import assess
from assess.report.words import find_range
from assess.results import Results
from assess.risk import RiskClass
from assess.settings import Settings
from tests.recalculate import stored_cells
from tests.report.parallel import BASES, assess_rich, read_csv, read_html, read_items, read_json, recalculate
from tests.report.reading import no_figures, read_text

LABELS = {risk.word: risk.label for risk in RiskClass}


@dataclass(frozen=True)
class Written:
    results: Results
    paths: dict[str, Path]


@pytest.fixture(
    scope="module",
    params=["none by OR", "high", "all by OR", pytest.param("example", marks=pytest.mark.slow)],
)
def written(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("same")
    if request.param == "example":
        results = request.getfixturevalue("verified_example")
    else:
        verify, _, by_paper = request.param.partition(" by ")
        class_by = "proposed OR" if by_paper else None
        results = assess_rich(folder, Settings(verify=verify, runs=40, class_by=class_by))
    with no_figures():
        paths = assess.write_reports(results, folder / "out", ("json", "csv", "xlsx", "html", "npz"))
    return Written(results, paths)


def _is(value: float | None) -> Any:
    return None if value is None else pytest.approx(value, abs=1e-9)


def _compare_items(rows: list[dict[str, Any]], written: Written) -> None:
    """Hold rows of the sheet Items against those of results.json."""
    items = read_json(written.paths["json"])["items"]
    assert len(rows) == len(items)
    for row, one, result in zip(rows, items, written.results, strict=True):
        methods, adopted, is_simulated = one["methods"], one["adopted"], one["adopted"]["basis"] == "simulated"
        mark = "⚓ " if one["anchor"]["counts_as_anchored"] else ""
        assert row["item"] == one["item"]
        assert (row["axis"], row["pfa_source"]) == (one["axis"], one["pfa_source"])
        assert row["axis_run"] == one["axis"]
        assert (row["pfa_g"], row["pfv_cm_s"] or None) == (_is(one["pfa_g"]), _is(one["pfv_cm_s"]))
        assert row["breadth_to_height"] == _is(one["breadth_to_height"])
        assert row["proposed_or"] == _is(methods["proposed_or"]["value"])
        assert row["proposed_or_raw"] == _is(methods["proposed_or"]["raw"])
        assert row["kaneko_hayashi"] == _is(methods["kaneko_hayashi"]["value"])
        assert (None if row["fema_p58"] == "" else row["fema_p58"]) == _is(methods["fema_p58"]["value"])
        assert row["basis"] == BASES[adopted["basis"]]
        assert row["class"].rstrip("*") == mark + LABELS[adopted["class"]]
        assert row["class_or"].rstrip("*") == mark + result.paper_class.label
        assert row["class_formula"].rstrip("*") == mark + result.formula_class.label
        assert (row["held"] == "yes") == one["anchor"]["counts_as_anchored"]
        if adopted["basis"] in ("simulated", "unconfirmed"):
            assert row["class_upper"] == mark + LABELS[adopted["class_upper"]]
        found = [row["chance"] or None, row["low"] or None, row["high"] or None]
        expected = [adopted["probability"], *(find_range(result) or ())] if is_simulated else [None] * 3
        assert found == [_is(value) if value else None for value in expected]


def test_stored_and_recalculated_items_are_those_of_results_json_and_every_parallel_record_stands_in_floors(written):
    for cells in (stored_cells(written.paths["xlsx"]), recalculate(written.paths["xlsx"], [])):
        _compare_items(read_items(cells, written.results), written)
    sheet = openpyxl.load_workbook(written.paths["xlsx"], data_only=True)["Floors"]
    lines = [row for row in sheet.iter_rows(min_row=2, max_col=8, values_only=True) if row[0]]
    for floor in read_json(written.paths["json"])["floors"]:
        own = [row for row in lines if row[0] == floor["floor"]]
        for axis, at in (("X", 2), ("Y", 5)):
            served = [one for one in floor["demands"] if one["axis"] == axis]
            shown = [row for row in own if row[at] is not None]
            assert len(shown) == len(served)
            for one in served:
                found = [row for row in shown if not one["record"] or row[at + 2].endswith(one["record"])]
                assert [(row[at], row[at + 1]) for row in found] == [(_is(one["pfa_g"]), _is(one["pfv_cm_s"]))]


def test_pieces_in_the_page_are_those_of_results_json(written):
    items = {one["item"]: one for one in read_json(written.paths["json"])["items"]}
    rows, main = read_html(written.paths["html"].read_text(encoding="utf-8")), written.results.main_basis
    assert sorted(row["Item"][0] for row in rows) == sorted(items)
    for row in rows:
        one = items[row["Item"][0]]
        methods, adopted = one["methods"], one["adopted"]
        assert row["Axis"][0] == one["axis"]
        assert row["PFA [g]"] == (f"{one['pfa_g']:.3f}", _is(one["pfa_g"]))
        assert row["OR (raw)"][1] == _is(methods["proposed_or"]["value"])
        assert row["OR (raw)"][0].endswith(f"({methods['proposed_or']['raw']:.3f})")
        assert row["Kaneko-Hayashi"][1] == _is(methods["kaneko_hayashi"]["value"])
        assert row["FEMA P-58"][1] == _is(methods["fema_p58"]["value"])
        assert row["Chance"][1] == _is(adopted["probability"])
        assert (row["Chance"][0] == "cannot rock") == (adopted["basis"] == "cannot rock")
        if adopted["basis"] == "simulated":
            shown = [float(text) / 100 for text in re.findall(r"[\d.]+", row["Chance"][0])[1:]]
            assert shown == pytest.approx([adopted["low"], adopted["high"]], abs=6e-4)
        assert adopted["class"] in row["Class"][0]
        is_held, is_main = one["anchor"]["counts_as_anchored"], adopted["basis"] in (main, "cannot rock")
        assert ("depends on its anchor" in row["Class"][0]) == is_held
        apart = adopted["class"].replace(" ", "-") if is_main else f"apart-{adopted['basis']}"
        assert row["style"][0] == ("anchored" if is_held else apart)
        if "ideal_higher" not in adopted["flags"] and adopted["class_upper"] != adopted["class"]:
            assert f"could be {adopted['class_upper']}" in row["Class"][0]


def test_items_csv_and_the_table_of_a_notebook_are_results_json(written):
    items = read_json(written.paths["json"])["items"]
    rows, frame = read_csv(written.paths["csv"]), written.results.items
    assert len(rows) == len(frame) == len(items)
    assert list(rows[0]) == list(frame.columns)
    places = {"axis": ("axis",), "pfa_g": ("pfa_g",), "pfv_cm_s": ("pfv_cm_s",), "pfa_source": ("pfa_source",),
              "proposed_or": ("methods", "proposed_or", "value"), "anchor_held": ("anchor", "counts_as_anchored"),
              "kaneko_hayashi": ("methods", "kaneko_hayashi", "value"), "adopted_class": ("adopted", "class"),
              "adopted_class_upper": ("adopted", "class_upper"), "adopted_basis": ("adopted", "basis"),
              "adopted_probability": ("adopted", "probability"), "adopted_low": ("adopted", "low"),
              "adopted_high": ("adopted", "high"), "quantity": ("quantity",)}  # fmt: skip
    places["counts_as_anchored"] = places.pop("anchor_held")
    for row, (_, series), one in zip(rows, frame.iterrows(), items, strict=True):
        for key, place in places.items():
            value: Any = one
            for step in place:
                value = value[step]
            assert row[key] == ("" if value is None else str(value)), key
            assert (None if isinstance(series[key], float) and math.isnan(series[key]) else series[key]) == value, key


def test_outcomes_npz_are_the_verification_of_results_json(written):
    items = {one["item"]: one for one in read_json(written.paths["json"])["items"]}
    with np.load(written.paths["npz"]) as arrays:
        found = {name: arrays[name] for name in arrays.files}
    falls = np.unpackbits(found["overturned"], axis=1) if len(found["item"]) else np.zeros((0, 0))
    governing = [at for at in range(len(found["item"])) if found["governs"][at]]
    assert len(governing) == sum(one["verification"] is not None for one in items.values())
    for at in governing:
        one = items[str(found["item"][at])]
        assert (found["axis"][at], found["source"][at]) == (one["axis"], one["pfa_source"])
        assert found["runs"][at] == one["verification"]["runs"]
        own, simulated = falls[at, : found["runs"][at]].sum(), one["verification"]
        assert own <= simulated["overturned"] <= simulated["draws"] - simulated["runs"] + own, "of it and those alike"


def test_counts_are_the_same_everywhere(written):
    """results.json counted by hand, the schedule's state before, the Excel summary, and the page.

    The PDF is made of the same page.
    """
    results = written.results
    items = read_json(written.paths["json"])["items"]
    free = [one for one in items if not one["anchor"]["counts_as_anchored"]]
    main = [one for one in free if one["adopted"]["basis"] in (results.main_basis, "cannot rock")]
    classes = tuple(_pieces(one for one in main if one["adopted"]["class"] == risk.word) for risk in RiskClass)
    anchored = _pieces(items) - _pieces(free)
    apart = _pieces(free) - _pieces(main)
    falls = sum(one["adopted"]["probability"] * one["quantity"] for one in main)
    before = results.schedule.before
    assert (before.classes, before.anchored, before.apart) == (classes, anchored, apart)
    assert before.falls == pytest.approx(falls, rel=1e-12)
    sheet = openpyxl.load_workbook(written.paths["xlsx"], data_only=True)["Summary"]
    rows = {row[0]: row[1:6] for row in sheet.iter_rows(max_col=6, values_only=True) if row[0]}
    assert rows[BASES[results.main_basis]] == (*classes, sum(classes))
    assert (rows["run again"][4], rows["anchored"][4], rows["all"][4]) == (0, anchored, _pieces(items))
    _check_page(written, classes, anchored, apart, falls)


def _pieces(items: Any) -> int:
    return sum(one["quantity"] for one in items)


def _check_page(written: Written, classes: tuple[int, ...], anchored: int, apart: int, falls: float) -> None:
    page = written.paths["html"].read_text(encoding="utf-8")
    heads, totals = next(
        (re.findall(r"<th(?: [^>]*)?>(.*?)</th>", table), re.findall(r"<td[^>]*>(.*?)</td>", total[1]))
        for table in re.findall(r"<table.*?</table>", page, re.DOTALL)
        if (total := re.search(r"<th[^>]*>All floors</th>(.*?)</tr>", table, re.DOTALL))
    )
    names = [read_text(head) for head in heads]
    shown = dict(zip(names[1:], map(read_text, totals), strict=False))
    for risk, pieces in zip(RiskClass, classes, strict=True):
        ends = [int(one) for one in re.findall(r"\d+", shown[risk.label].partition("(")[0].replace(",", ""))]
        assert ends[0] <= pieces <= ends[-1], "a range where intervals span a limit"
    assert int(shown["Anchored"]) == anchored
    assert shown["Expected falls"].split(" ")[0] == f"{falls:.1f}"
    assert sum(int(shown.get(name, "0")) for name in ("◌ unconfirmed", "ƒ by formula only")) == apart
