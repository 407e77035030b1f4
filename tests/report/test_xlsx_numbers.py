"""Every number of the Excel report is that of results.json of the same run."""

import json
from pathlib import Path

import openpyxl
import pytest

import assess
from assess import fields
from assess.natural import natural_key
from assess.report import write_reports
from assess.report.xlsx.items_sheet import item_columns
from assess.risk import RiskClass
from assess.settings import Settings
from tests.workbooks import UNVERIFIED, assessed

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

STREET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"
FLOORS = [{"floor": "1", "pfa_x": 0.45, "pfv_x": 45.0, "pfa_y": 0.4}, {"floor": "2", "pfa_x": 0.8, "pfv_x": 90.0}]
ITEMS = [
    {"item": f"{floor}-{at}", "floor": floor, "breadth": breadth, "width": 120, "height": 180, "quantity": 1 + at % 3}
    | ({"anchored": "yes"} if at == 4 else {})
    | ({"axis": "Y"} if at == 2 else {})
    for floor in "12"
    for at, breadth in enumerate((25, 36, 50, 62, 75, 110))
]


@pytest.fixture(scope="module", params=["formula", "unconfirmed", "simulated"])
def made(request, tmp_path_factory):
    """Return results of each kind."""
    if request.param == "formula":
        return assess.run(assess.read_inventory(STREET), UNVERIFIED)
    period = {"period": 0.9} if request.param == "simulated" else {}
    path = tmp_path_factory.mktemp("made") / "w.xlsx"
    return assessed(path, ITEMS, FLOORS, settings=Settings(verify="all", runs=20), **period)


@pytest.fixture(scope="module")
def run(made, tmp_path_factory):
    """Return the stored Items by key, the other sheets, and results.json."""
    folder, results = tmp_path_factory.mktemp("run"), made
    written = write_reports(results, folder / "out", ["xlsx", "json"])
    book = openpyxl.load_workbook(written["xlsx"], data_only=True)
    keys = [column.key for column in item_columns(results)]
    rows = [dict(zip(keys, row, strict=True)) for row in book["Items"].iter_rows(min_row=2, values_only=True)]
    return rows, book, json.loads(written["json"].read_text(encoding="utf-8"))


def _is(value):
    return None if value is None else pytest.approx(value, abs=1e-9)


def _label(word):
    return next(risk.label for risk in RiskClass if risk.word == word)


def test_sizes_and_motions_are_those_of_the_results(run):
    rows, _, results = run
    assert len(rows) == len(results["items"])
    for row, one in zip(rows, results["items"], strict=True):
        assert row["item"] == one["item"]
        assert row["floor"] == one["floor"]
        assert row["quantity"] == one["quantity"]
        assert row["anchored"] == one["anchored"]
        for side in ("breadth_cm", "width_cm", "height_cm"):
            assert row[side] == _is(one[side])
        assert row["breadth_to_height"] == _is(one["breadth_to_height"])
        assert (row["pfa_g"], row["pfv_cm_s"] or None) == (_is(one["pfa_g"]), _is(one["pfv_cm_s"]))
        assert row["axis"] == row["axis_run"] == one["axis"]
        assert row["pfa_source"] == one["pfa_source"]


def test_chances_of_the_formulas_are_those_of_the_results(run):
    rows, _, results = run
    for row, one in zip(rows, results["items"], strict=True):
        assert row["proposed_or_raw"] == _is(one["methods"]["proposed_or"]["raw"])
        assert row["proposed_or"] == _is(one["methods"]["proposed_or"]["value"])
        assert row["kaneko_hayashi"] == _is(one["methods"]["kaneko_hayashi"]["value"])
        for key in ("fema_p58", "housner_monte_carlo"):
            value = one["methods"][key]["value"]
            assert row[key] == ("not evaluated" if value is None else _is(value))


def _find_range(one):
    """Return the range that the sheet shows: of all floors on assumed motion from the slower to the faster third."""
    adopted, found = one["adopted"], one["verification"]
    if adopted["basis"] != "simulated":
        return None, None
    ends = found["if_slower"], found["if_faster"], adopted["probability"]
    assert None not in ends
    return min(ends), max(ends)


def test_what_verification_found_is_that_of_the_results(run, made):
    rows, _, results = run
    for row, one, result in zip(rows, results["items"], made, strict=True):
        found, adopted = one["verification"], one["adopted"]
        assert row["runs"] == (found and found["runs"])
        is_adopted = adopted["basis"] == "simulated"
        assert row["basis"].split(" ")[0] == result.adopted.basis
        assert row["chance"] == (_is(adopted["probability"]) if is_adopted else None)
        assert (row["low"], row["high"]) == tuple(map(_is, _find_range(one)))
        assert result.governing.simulation is None or result.governing.simulation.ideal is None, "a drawn motion"
        assert not row["beside"]
        shown = row["class"].removeprefix("⚓ ").removesuffix("*")
        assert shown == _label(adopted["class"])
        if found:
            assert row["class_upper"].removeprefix("⚓ ") == _label(adopted["class_upper"])
        if is_adopted:
            assert ("could be " in (row["class_notes"] or "")) == (adopted["class_upper"] != adopted["class"])


BASES = {"formula": "formula (not simulated)", "simulated": "simulated", "unconfirmed": "unconfirmed"}


def _counts(results, basis):
    """Return the free-standing pieces of a basis by class, and their sum."""
    own = [one for one in results if one.adopted.basis == basis and not one.is_anchored]
    by_class = [sum(one.item.quantity for one in own if one.adopted.risk == risk) for risk in RiskClass]
    return [*by_class, sum(by_class)]


def test_a_new_field_shows_without_a_change_to_the_report(tmp_path, monkeypatch):
    load = fields.Field(key="load_kg", read=lambda one: 2.5 * one.item.row, label="Load", unit="kg", format="0.0",
                        kind="number")  # fmt: skip
    monkeypatch.setattr(fields, "PIECE_FIELDS", (*fields.PIECE_FIELDS, load))
    written = write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ["xlsx", "json", "csv"])
    sheet = openpyxl.load_workbook(written["xlsx"])["Items"]
    at = next(cell.column for cell in sheet[1] if cell.value == "Load [kg]")
    assert (sheet.cell(2, at).value, sheet.cell(2, at).number_format) == (5.0, "0.0")
    assert json.loads(written["json"].read_text(encoding="utf-8"))["items"][0]["load_kg"] == 5.0
    assert "load_kg" in written["csv"].read_text(encoding="utf-8-sig").splitlines()[0].split(",")


def test_counts_are_those_of_the_results(run, made):
    """Each basis has a table of its own, by floor; what has no class stands beside the first."""
    _, book, results = run
    rows = [list(row) for row in book["Summary"].iter_rows(max_col=9, values_only=True)]
    there = [basis for basis in ("simulated", "formula", "unconfirmed") if any(_counts(made, basis))]
    heads = [at for at, row in enumerate(rows) if row[0] == "Floor"]
    assert len(heads) == len(there)
    building = next(at for at, row in enumerate(rows) if row[0] == "Building")
    for number, (basis, head) in enumerate(zip(there, heads, strict=True)):
        assert rows[head - 1][0] == f"Pieces by class and floor: {BASES[basis]}"
        for at, floor in enumerate(results["floors"], head + 1):
            own = [one for one in made if one.item.floor == floor["floor"]]
            assert rows[at][1:6] == _counts(own, basis)
        assert rows[head + 1 + len(results["floors"])][1:6] == _counts(made, basis)
        assert rows[building + 1 + number][:6] == [BASES[basis], *_counts(made, basis)]
    anchored = sum(one.item.quantity for one in made if one.is_anchored)
    expected = [["run again", 0], ["anchored", anchored], ["all", sum(one.item.quantity for one in made)]]
    below = rows[building + 1 + len(there) :][: len(expected)]
    assert [[row[0], row[5]] for row in below] == expected
    assert [rows[heads[0]][6:], rows[heads[0] + 1 + len(results["floors"])][6:]] == [
        [one[at] for one in expected] for at in (0, 1)
    ]


def test_the_lists_on_the_summary_are_those_of_the_highest_classes_and_chances(run, made):
    """What was simulated, what was not, and what is unconfirmed are listed apart."""
    _, book, _ = run
    rows = [list(row) for row in book["Summary"].iter_rows(max_col=9, values_only=True)]
    for basis, name in BASES.items():
        free = [one for one in made if one.adopted.basis == basis and not one.is_anchored]
        tops = [at for at, row in enumerate(rows) if row[0] == f"The pieces most likely to fall: {name}"]
        assert len(tops) == (1 if any(one.adopted.basis == basis for one in made) else 0)
        ranked = [(int(one.adopted.upper), one.adopted.probability) for one in free]
        expected = [chance for _, chance in sorted(ranked, reverse=True)[:10]]
        for top in tops:
            shown = rows[top + 2 : top + 2 + len(expected)]
            assert [row[4] for row in shown] == pytest.approx(expected, abs=1e-9)
            assert {row[0] for row in shown} <= {_name(one) for one in free}
            assert all((row[5] is None) == (basis != "simulated") for row in shown)


def _name(one):
    text = one.item.description or one.item.type
    return (one.item.item + (f": {text}" if text else ""))[:80]


def test_floors_and_motions_are_those_of_the_results(run):
    _, book, results = run
    rows = [row for row in book["Floors"].iter_rows(min_row=2, values_only=True) if row[0]]
    floors = {row[0]: row for row in reversed(rows)}
    motions = list(book["Motions"].iter_rows(min_row=2, values_only=True))
    expected = [(floor["floor"], one) for floor in results["floors"] for one in floor["demands"]]
    assert len(motions) == len(expected)
    for row, (floor, one) in zip(motions, expected, strict=True):
        assert row[:2] == (floor, one["axis"])
        assert (row[7], row[8]) == (_is(one["pfa_g"]), _is(one["pfv_cm_s"]))
        assert row[9] == _is(one["pfa_file_g"])
    for floor in results["floors"]:
        for axis, at in (("X", 2), ("Y", 5)):
            largest = max(one["pfv_cm_s"] for one in floor["demands"] if one["axis"] == axis)
            assert floors[floor["floor"]][at + 1] == pytest.approx(largest, abs=1e-9)
            shown = [(row[at], row[at + 1]) for row in rows if row[0] == floor["floor"] and row[at] is not None]
            served = [(one["pfa_g"], one["pfv_cm_s"]) for one in floor["demands"] if one["axis"] == axis]
            assert sorted(shown) == [(_is(pfa), _is(pfv)) for pfa, pfv in sorted(served)], "every parallel record"


def test_the_work_list_is_the_schedule_of_the_results(run):
    """Every part of every entry has a row, with its forces and what is left."""
    _, book, results = run
    entries = results["schedule"]["entries"]
    rows = {(row[1], row[5]): row for row in book["Work list"].iter_rows(min_row=2, values_only=True)
            if isinstance(row[1], int)}  # fmt: skip
    heads = [cell.value for cell in book["Work list"][1]]
    works = [(entry, work) for entry in entries for work in entry["works"]]
    assert works
    assert len(rows) == len(works)
    names = ("Floor", "Room", "Pieces", "Tension at PFA", "Tension at 84 %", "Shear", "Fixings", "Falls left")
    at = {name: next(place for place, head in enumerate(heads) if head.startswith(name)) for name in names}
    for entry, work in works:
        row = rows[entry["place"], ", ".join(sorted(work["items"], key=natural_key))]
        found = [row[at[name]] for name in ("Floor", "Room", "Pieces", "Fixings")]
        fixings = f"{work['fixings']}+" if work["fixings_are_least"] else work["fixings"]
        assert found == [work["floor"], work["room"] or None, work["pieces"], fixings]
        forces = [row[at[name]] for name in ("Tension at PFA", "Tension at 84 %", "Shear")]
        assert forces == [_is(work[name]) for name in ("tension_kn", "tension_high_kn", "shear_kn")]
        is_first = work is entry["works"][0]
        assert row[at["Falls left"]] == (_is(entry["falls_left"]) if is_first else None)


def test_inputs_and_settings_are_those_of_the_results(run):
    _, book, results = run
    rows = [row[:3] for row in book["Quality log"].iter_rows(min_row=2, values_only=True)]
    made, inputs = results["assess"], results["assess"]["inputs"]
    files = {inputs["workbook"]: inputs["sha256"], **inputs["records"]}
    assert {("input", name, f"SHA-256 {digest}") for name, digest in files.items()} <= set(rows)
    assert {("platform", name, value) for name, value in made["platform"].items()} <= set(rows)
    assert {("setting", name, str(value) or None) for name, value in made["settings"].items()} <= set(rows)
    assert ("program", "assess", made["version"]) in rows
    problems = [(one["severity"], one["message"]) for one in results["problems"]] or [("note", "No warnings or notes.")]
    assert [(row[0], row[2]) for row in rows if row[0] in ("warning", "note")] == problems
