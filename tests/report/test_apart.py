"""What was not simulated, or not to be relied on, stands apart: in counts, lists, sums, pages, files and at the end."""

import csv
import json
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

import assess
from assess.cli.command_run import describe_result
from assess.report.content import build_content
from assess.report.counts import build_bars, count
from assess.report.figures.plan import build_plan
from assess.report.findings.apart import list_parts, list_ways_to_settle
from assess.report.words import risk_notes
from assess.results import BASES
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.report.reading import read_text, render
from tests.report.test_verified import _pulses
from tests.shaking import RECORDS as SHAKING
from tests.shaking import write_record
from tests.workbooks import RECORDS, write

FLOORS = [
    {"floor": "1", "record_x": "made-up-sweep.csv#north"},
    {"floor": "2", "pfa_x": 0.2, "pfv_x": 45},
    {"floor": "3", "record_x": "weak.csv"},
]
SIZE = {"width": 110, "axis": "X"}
ITEMS = [
    SIZE | {"item": "wide", "floor": "2", "room": "Office", "breadth": 22, "height": 200, "quantity": 3},
    SIZE | {"item": "felled", "floor": "1", "room": "Hall", "breadth": 30, "height": 200, "x": 2, "y": 2},
    SIZE | {"item": "still", "floor": "3", "breadth": 45, "height": 200},
    SIZE | {"item": "broad", "floor": "2", "breadth": 25, "height": 180, "x": 4, "y": 2},
    SIZE | {"item": "calm", "floor": "2", "breadth": 78, "height": 200},
    SIZE | {"item": "fixed", "floor": "2", "breadth": 50, "height": 180, "anchored": "yes"},
]
EXPECTED = {"wide": "unconfirmed", "felled": "simulated", "still": "cannot rock", "broad": "unconfirmed",
            "calm": "formula", "fixed": "unconfirmed"}  # fmt: skip
"""Where nothing is known of the building, the class of a floor without a record is unconfirmed; the calm piece is not
chosen, and the still one cannot rock."""


def _assess(folder, items=ITEMS, building=(), **settings):
    shutil.copy(RECORDS / "made-up-sweep.csv", folder)
    write_record(folder / "weak.csv", 0.6 * SHAKING["still"])
    inventory = assess.read_inventory(write(folder / "w.xlsx", items, FLOORS, **dict(building)))
    return assess.run(inventory, Settings(**{"runs": 20, "verify": "high", **settings}), jobs=1)


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("mixed"))


@pytest.fixture(scope="module")
def page(mixed):
    return render(mixed)


@pytest.fixture(scope="module")
def formulas(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("formulas"), verify="none")


# ---------------------------------------------------------------- counts and lists


def test_the_workbook_has_pieces_of_every_basis(mixed):
    assert {one.item.item: one.adopted.basis for one in mixed} == EXPECTED
    assert set(EXPECTED.values()) == set(BASES)
    assert {one.item.item: one.apart for one in mixed} == {
        name: "" if basis in ("simulated", "cannot rock") else basis for name, basis in EXPECTED.items()
    }


def test_classes_count_simulated_pieces_alone(mixed):
    rows = list(mixed)
    counts = count("all", rows)
    assert (counts.free, counts.unconfirmed, counts.by_formula, counts.anchored, counts.total) == (2, 4, 1, 1, 8)
    assert counts.expected == mixed["felled"].adopted.probability
    assert counts.falls == f"{counts.expected:.1f} ({counts.falls_low:.0f} to 1) and up to 4"
    assert mixed["wide"].adopted.risk >= RiskClass.HIGH, "which the counts leave out"
    assert counts.risky == 1
    assert count("simulated", [mixed["felled"]]).falls == counts.falls.partition(" and")[0]


def test_a_piece_that_cannot_rock_counts_as_low(mixed):
    still = mixed["still"]
    assert classify(still.governing.methods[mixed.paper_formula.key].value) > RiskClass.LOW
    assert (still.formula_class, still.paper_class) == (RiskClass.LOW, RiskClass.LOW)
    assert (still.adopted.risk, still.adopted.upper, still.apart) == (RiskClass.LOW, RiskClass.LOW, "")
    assert not still.adopted.can_rock


def test_lists_never_rank_what_stands_apart_among_simulated_pieces(mixed):
    content = build_content(mixed)
    assert [one.item.item for one in content.summary.worst] == ["felled", "still"]
    assert [one.item.item for one in content.risky] == ["felled"]
    assert [one.item.item for one in content.unconfirmed] == ["wide", "broad"]
    fixes = content.summary.fixes
    assert [fix.result.apart for fix in fixes] == sorted((fix.result.apart for fix in fixes), key=bool)
    assert [fix.result.item.item for fix in fixes if fix.together is None] == ["wide", "broad", "calm"]
    assert [fix.together for fix in fixes if not fix.result.apart][-1] == pytest.approx(1.0)
    parts = list_parts(content.results)
    assert [[one.item.item for one in own] for _heading, own in parts] == [
        ["felled", "still"], ["wide", "broad", "fixed"], ["calm"],
    ]  # fmt: skip


def test_bars_and_plans_give_them_no_class(mixed):
    content = build_content(mixed)
    counts = next(one for one in content.by_floor if one.label == "Floor 2")
    (bar,) = build_bars([counts]).bars
    assert [(part.symbol, part.pieces) for part in bar.parts] == [("◌", 4), ("ƒ", 1), ("⚓", 1)]
    floor = next(one for one in content.floors if one.floor.floor == "2")
    (piece,) = build_plan(floor, mixed).pieces
    assert (piece.symbol, piece.class_name, piece.upper, piece.marks) == ("◌", "apart-unconfirmed", None, "")
    assert piece.fill not in {risk.fill for risk in RiskClass}


def test_by_the_formulas_alone_nothing_stands_apart(formulas):
    content = build_content(formulas)
    assert {one.apart for one in formulas} == {""}
    assert (content.total.free, content.total.unconfirmed, content.total.by_formula) == (7, 0, 0)
    assert content.summary.apart == []
    text = read_text(render(formulas))
    for apart in ("unconfirmed and counted apart", "is unconfirmed", "are unconfirmed", "◌"):
        assert apart not in text.partition("What the marks mean")[0]
    assert "by formula only" not in text
    assert "like this one" not in text.partition("Methods")[0]


# ---------------------------------------------------------------- pages


def test_the_summary_names_them_and_what_settles_them(mixed, page):
    text = read_text(page)
    assert "simulated free-standing pieces, " in text
    assert "and up to 4 unconfirmed pieces; " in text
    assert text.count("4 pieces are unconfirmed and counted apart") == 1
    assert "(wide, broad). 4 of them would be high or very high." in text
    assert "To settle this, fill in Storeys or Period T1 in the sheet Building, or records of the floors." in text
    assert "1 piece was not simulated and is counted apart, by formula only." in text
    assert re.search(r"◌ unconfirmed</span><span class=\"tile-number\">4<", page)
    assert re.search(r"ƒ by formula only</span><span class=\"tile-number\">1<", page)


def test_a_class_of_the_table_of_all_pieces_never_mixes_bases(mixed, page):
    """Rows that filters take for a class are simulated; all others stand in parts of their own, which say why."""
    table = page[page.index('id="pieces"') :].partition("</table>")[0]
    bodies = re.findall(r"<tbody>(.*?)</tbody>", table, re.DOTALL)
    found = [re.findall(r'id="row-(\d+)".*?data-class="([^"]+)"', body) for body in bodies]
    rows = list(mixed)
    for at, (body, listed) in enumerate(zip(bodies, found, strict=True)):
        bases = {rows[int(number) - 1].adopted.basis for number, _style in listed}
        assert bases == ({"simulated", "cannot rock"}, {"unconfirmed"}, {"formula"})[at]
        assert ('<tr class="part">' in body) == (at > 0)
    styles = dict(pair for body in found for pair in body)
    assert {style for number, style in styles.items() if rows[int(number) - 1].apart} == {
        "apart-unconfirmed", "apart-formula", "anchored",
    }  # fmt: skip


def test_floors_have_columns_of_their_own_for_them(page):
    table = page[page.index('<table class="counts">') :].partition("</table>")[0]
    head, *rows = re.findall(r"<tr.*?</tr>", table, re.DOTALL)
    assert "unconfirmed" in head
    assert "by formula only" in head
    cells = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row) for row in rows]
    second = next(row for row in cells if row[0] == "Floor 2")
    assert second[2:] == ["0", "0", "0", "0", "4", "1", "1", "6", "0.0 and up to 4"]


def test_the_command_ends_with_a_count_of_each(mixed, formulas):
    lines = list(describe_result(mixed))
    text = "\n".join(lines)
    assert sum(int(re.findall(r"(\d+) piece", line)[0]) for line in lines[:4]) == 2
    assert "  cannot rock      1 of the low ones: too stocky, or no motion can start them" in lines
    assert re.search(r"^  unconfirmed +4, not counted above: .*fill in Storeys or Period T1", text, re.MULTILINE)
    assert re.search(r"^  by formula +1, not counted above: not simulated$", text, re.MULTILINE)
    assert "with a dispersion of 0.4 (standard deviation of ln amplitude; assumed)." in lines[-1]
    assert "unconfirmed" not in " ".join(describe_result(formulas))


def test_classes_are_said_to_stay_unconfirmed_only_where_pieces_were_simulated(mixed, formulas):
    drawn = "neither T1, Height, Storeys nor an Elevation is known, so that buildings of every period and floors of"
    for results, is_said in ((mixed, True), (formulas, False)):
        (text,) = (one.message for one in results.problem_rows if drawn in one.message)
        assert text.endswith("; classes stay unconfirmed.") == is_said


def test_of_an_unconfirmed_piece_no_report_says_that_its_class_was_lowered(mixed, page):
    assert any(one.adopted.risk < one.formula_class for one in mixed if one.apart == "unconfirmed")
    assert {one.adopted.lowered_from for one in mixed if one.apart} == {None}
    assert "lowered by simulation (" not in read_text(page)
    assert "class lowered" not in " ".join(describe_result(mixed))


def test_weak_motions_are_settled_by_stronger_ones(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", ITEMS[3:4], FLOORS[1:2], period=1.0))
    results = assess.run(inventory, Settings(), suite=_pulses(*[0.01] * 20), jobs=1)
    (one,) = results
    assert one.apart == "unconfirmed"
    (way,) = list_ways_to_settle([one])
    assert way.startswith("To settle this, simulate under stronger motions: records of your own")
    assert "--motions" in " ".join(describe_result(results))


# ---------------------------------------------------------------- files


def test_files_hold_the_basis_and_the_chance_if_exactly_this_motion_recurred(mixed, tmp_path):
    written = assess.write_reports(mixed, tmp_path, ["json", "csv"])
    found = json.loads(written["json"].read_text(encoding="utf-8"))
    assert found["assess"]["uncertainty"] == {"motion": 0.4, "piece": True}
    assert (found["assess"]["settings"]["ideal"], found["assess"]["settings"]["scale"]) == (False, 1.0)
    with written["csv"].open(encoding="utf-8-sig", newline="") as file:
        rows = {row["item"]: row for row in csv.DictReader(file)}
    for record in found["items"]:
        name, one = record["item"], mixed[record["item"]]
        assert record["adopted"]["basis"] == rows[name]["adopted_basis"] == EXPECTED[name]
        assert record["centre_of_gravity"] == 0.5
        if EXPECTED[name] == "formula":
            assert record["verification"] is None
            continue
        ideal, simulation = record["verification"]["ideal"], one.governing.simulation
        if EXPECTED[name] == "unconfirmed":
            assert (ideal, rows[name]["verification_ideal_probability"]) == (None, ""), "no motion that could recur"
            thirds = [record["verification"][f"if_{one}"] for one in ("slower", "faster")]
            assert thirds == [simulation.if_slower, simulation.if_faster]
            continue
        assert ideal == {
            "runs": 20, "overturned": simulation.ideal.overturned, "probability": simulation.ideal.probability,
            "low": simulation.ideal.low, "high": simulation.ideal.high,
        }  # fmt: skip
        assert float(rows[name]["verification_ideal_probability"]) == ideal["overturned"] / 20
    motions = [one for floor in found["floors"] for one in floor["demands"] if one["ensemble"]]
    assert {one["source"]: one["ensemble"]["unknown_building"] for one in motions} == {"record": False, "given": True}


# ---------------------------------------------------------------- what was assumed


def _tried(results, **chances):
    """Return results whose simulated chances at other dispersions are these, of all pieces alike."""
    table = results.cases_table
    outcome = table.outcomes[results.simulation.key]
    known = ~np.isnan(outcome.value)
    detail = {f"dispersion_{one}": np.where(known, chance, np.nan) for one, chance in chances.items()}
    changed = replace(outcome, detail=outcome.detail | detail)
    return replace(results, cases_table=replace(table, outcomes=table.outcomes | {results.simulation.key: changed}))


def test_the_summary_says_what_was_varied_and_what_it_changes(mixed):
    text = read_text(render(_tried(mixed, **{"0.2": 0.0, "0.6": 1.0})))
    assert "; the sampling interval covers the number of draws only; on assumed motion the range is what is not" in text
    assert "with a dispersion of 0.4 (standard deviation of ln amplitude; assumed)." in text
    assert "Sizes, centre of gravity and restitution of each piece are varied." in text
    felled, still = mixed["felled"], mixed["still"]
    assert felled.fell_in_record, "so that it is high at least"
    assert not still.adopted.can_rock, "so that it is low at any of them"
    is_high = felled.adopted.risk == RiskClass.HIGH
    down = "no piece would change class" if is_high else "1 piece would be in a lower class"
    assert f"With a dispersion of 0.2, {down}." in text
    up = "1 piece would be in a higher class" if is_high else "no piece would change class"
    assert f"With a dispersion of 0.6, {up}." in text
    assert "base × N(0.97, 0.05), its height × N(1, 0.02), its centre of gravity N(as given, 0.05)" in text
    assert "have the same random phases on all floors along an axis; the signs of modes from floor to floor are" in text


def test_a_dispersion_of_the_workbook_is_not_called_assumed(tmp_path):
    results = _assess(tmp_path, ITEMS[1:2], {"motion_uncertainty": 0.6, "piece_uncertainty": "no"}, runs=10)
    text = read_text(render(results))
    assert "with a dispersion of 0.6 (standard deviation of ln amplitude; as filled in)." in text
    assert "Sizes, centre of gravity and restitution are exactly as given." in text
    assert "With a dispersion of 0.2, " in text
    assert "With a dispersion of 0.6, " not in text
    assert "Each piece draws its base" not in text


def test_a_row_says_that_exactly_this_motion_would_give_a_higher_class(mixed):
    table = mixed.cases_table
    outcome = table.outcomes[mixed.simulation.key]
    at = mixed["still"].governing.index
    table = replace(
        table, adopted=table.adopted | {"basis": np.where(np.arange(len(table)) == at, 1, table.adopted["basis"])}
    )
    basis = np.where(np.arange(len(table)) == at, BASES.index("simulated"), table.adopted["basis"])
    ideal = np.where(np.arange(len(table)) == at, 0.5, outcome.detail["ideal"])
    upper = np.where(np.arange(len(table)) == at, int(RiskClass.HIGH), table.adopted["upper"])
    higher = table.adopted["ideal_higher"] | (np.arange(len(table)) == at)
    formula = table.outcomes[mixed.formula.key]
    outcomes = {
        mixed.simulation.key: replace(outcome, detail=outcome.detail | {"ideal": ideal}),
        mixed.formula.key: replace(formula, value=np.where(np.arange(len(table)) == at, 0.1, formula.value)),
    }
    changed = replace(
        table,
        outcomes=table.outcomes | outcomes,
        adopted=table.adopted | {"basis": basis, "upper": upper, "ideal_higher": higher},
    )
    results = replace(mixed, cases_table=changed)
    text = read_text(render(results))
    assert "○ low, high if exactly this motion recurred, lowered by simulation (formula: medium)" in text
    assert risk_notes(results["still"]) == [
        "high if exactly this motion recurred",
        "lowered by simulation (formula: medium)",
    ]
    assert "Would be of a higher class if exactly this motion recurred and the piece were exactly as given" in text


CONDITIONS = (
    "Assumed: exactly this motion, and every piece exactly as given",
    "Every floor's motion times 1.2",
)


@pytest.fixture(scope="module")
def exactly(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("ideal"), ideal=True, scale=1.2)


def test_other_conditions_are_named_at_the_head_of_the_page(exactly, page):
    text = read_text(render(exactly))
    assert text.partition("Overturning of furniture in an earthquake: assessment")[0].endswith(
        f"{' · '.join(CONDITIONS)} "
    )
    assert "exactly this motion recurs and that every piece is exactly as given: nothing is varied." in text
    assert "In an earthquake like this one (dispersion 0.4), " in text
    assert [f"{one}." for one in CONDITIONS] == list(describe_result(exactly))[-3:-1]
    assert 'class="conditions"' not in page


@pytest.mark.slow
def test_other_conditions_are_named_on_every_page_of_the_pdf(exactly, mixed, tmp_path):
    import pypdfium2

    for results, expected in ((exactly, True), (mixed, False)):
        written = assess.write_reports(results, tmp_path / str(expected), ("pdf", "annex"))
        pages = []
        for name in ("pdf", "annex"):
            document = pypdfium2.PdfDocument(written[name])
            pages += [" ".join(document[at].get_textpage().get_text_range().split()) for at in range(len(document))]
            document.close()
        assert len(pages) > 5
        for condition in CONDITIONS:
            assert {condition in text for text in pages} == {expected}
