"""Every number of a piece, and every count, is the same in results.json, items.csv, the Excel report, HTML and PDF."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import openpyxl
import pytest

import assess
from assess.report.words import find_range
from assess.results import Results
from assess.risk import RiskClass
from assess.settings import Settings
from tests.recalculate import stored_cells
from tests.report.parallel import BASES, assess_rich, read_html, read_items, read_json
from tests.report.reading import no_figures, read_text

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

LABELS = {risk.word: risk.label for risk in RiskClass}


@dataclass(frozen=True)
class Written:
    """A run and its reports."""

    results: Results
    paths: dict[str, Path]
    folder: Path


@pytest.fixture(scope="module", params=["high", "all by OR"])
def written(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("same")
    verify, _, by_paper = request.param.partition(" by ")
    class_by = "proposed OR" if by_paper else None
    results = assess_rich(folder, Settings(verify=verify, runs=40, class_by=class_by))
    with no_figures():
        paths = assess.write_reports(results, folder / "out", ("json", "xlsx", "html"))
    return Written(results, paths, folder)


def _is(value: float | None) -> Any:
    return None if value is None else pytest.approx(value, abs=1e-9)


def _number(shown: Any) -> Any:
    return None if shown == "" else shown


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
        assert _number(row["fema_p58"]) == _is(methods["fema_p58"]["value"])
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


def test_stored_items_are_those_of_results_json(written):
    cells = stored_cells(written.paths["xlsx"])
    _compare_items(read_items(cells, written.results), written)


def test_pieces_in_the_page_are_those_of_results_json(written):
    items = {one["item"]: one for one in read_json(written.paths["json"])["items"]}
    rows = read_html(written.paths["html"].read_text(encoding="utf-8"))
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
        _check_class(row, one, written.results.main_basis)


def _check_class(row: dict[str, Any], one: dict[str, Any], main: str) -> None:
    adopted, is_held = one["adopted"], one["anchor"]["counts_as_anchored"]
    assert ("depends on its anchor" in row["Class"][0]) == is_held
    is_main = adopted["basis"] in (main, "cannot rock")
    apart = adopted["class"].replace(" ", "-") if is_main else f"apart-{adopted['basis']}"
    assert row["style"][0] == ("anchored" if is_held else apart)
    if "ideal_higher" not in adopted["flags"] and adopted["class_upper"] != adopted["class"]:
        assert f"could be {adopted['class_upper']}" in row["Class"][0]


# ---------------------------------------------------------------- counts


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
    _check_excel(written, classes, anchored, _pieces(items))
    _check_page(written, classes, anchored, apart, falls)


def _pieces(items: Any) -> int:
    return sum(one["quantity"] for one in items)


def _check_excel(written: Written, classes: tuple[int, ...], anchored: int, every: int) -> None:
    sheet = openpyxl.load_workbook(written.paths["xlsx"], data_only=True)["Summary"]
    rows = {row[0]: row[1:6] for row in sheet.iter_rows(max_col=6, values_only=True) if row[0]}
    assert rows[BASES[written.results.main_basis]] == (*classes, sum(classes))
    assert (rows["run again"][4], rows["anchored"][4], rows["all"][4]) == (0, anchored, every)


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
