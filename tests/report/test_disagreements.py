"""Where methods disagree by more than one class: which rows, and whether the reasons are true of them."""

import itertools
import math
from dataclasses import replace

import pytest

import assess
from assess.language import load_catalogue, speaking
from assess.methods import all_methods, fema_p58
from assess.report.findings.disagreements import (
    MOST_REASONS,
    find_disagreements,
    group_disagreements,
    summarise_disagreements,
)
from assess.report.findings.facts import Facts, span
from assess.report.findings.reasons import KINDS, find_kinds
from assess.risk import RiskClass, classify
from assess.settings import Settings
from assess.units import GRAVITY
from tests.workbooks import RECORDS, UNVERIFIED, assessed

MARKET_STREET = RECORDS.parents[1] / "inventories" / "market-street.xlsx"
PROBABILITIES = [method.key for method in all_methods() if method.kind == "probability"]


def rows(tmp_path, cases, settings=UNVERIFIED, **building):
    """Assess pieces given as breadth, height [cm], PFA [g], PFV [cm/s]."""
    motions = sorted({case[2:] for case in cases}, key=str)
    floors = [{"floor": f"F{at}", "pfa_x": pfa, "pfv_x": pfv} for at, (pfa, pfv) in enumerate(motions)]
    items = [
        {"item": f"I{at}", "floor": f"F{motions.index(motion)}", "breadth": b, "width": max(b, 80), "height": h,
         "axis": "X"}
        for at, (b, h, *peaks) in enumerate(cases) for motion in [tuple(peaks)]
    ]  # fmt: skip
    return assessed(tmp_path / "w.xlsx", items, floors, settings=settings, **building)


def one(tmp_path, *case, **named):
    (found,) = find_disagreements(rows(tmp_path, [case], **named))
    return found


def classes(result):
    values = [result.governing.methods[key].value for key in PROBABILITIES]
    return [classify(value) for value in values if value is not None]


@pytest.fixture(scope="module")
def market_street():
    return assess.run(assess.read_inventory(MARKET_STREET), UNVERIFIED)


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Sizes and motions of all kinds, well beyond what a building holds."""
    sizes = itertools.product((6, 20, 30, 45, 70, 120, 200), (40, 90, 200, 300))
    motions = list(itertools.product((0.02, 0.1, 0.25, 0.5, 0.9, 2.5), (None, 1, 10, 40, 120, 500)))
    cases = [(*size, *motion) for size in sizes for motion in motions]
    return rows(tmp_path_factory.mktemp("sweep"), cases)


class TestSweep:
    def test_every_row_that_differs_by_more_than_one_class_is_found(self, swept):
        found = {row.result.item.item for row in find_disagreements(swept)}
        assert found == {result.item.item for result in swept if max(classes(result)) - min(classes(result)) > 1}
        assert len(found) > 200

    def test_every_row_has_reasons_as_sentences(self, swept):
        for row in find_disagreements(swept):
            assert 1 <= len(row.reasons) <= MOST_REASONS
            for reason in row.reasons:
                assert reason.endswith(".")
                assert "nan" not in reason
                assert "{" not in reason

    def test_what_is_high_and_low_is_explained(self, swept):
        about = {
            "proposed_or": {"or_below_start", "or_at_start", "or_at_most", "size", "or_alone"},
            "kaneko_hayashi": {"kaneko_bound", "kaneko_velocity", "kaneko_acceleration"},
            "fema_p58": {"fema"},
        }
        for row in find_disagreements(swept):
            for verdict in (row.highest, row.lowest):
                assert about[verdict.key] & set(row.kinds), row

    def test_every_kind_that_needs_peaks_alone_occurs(self, swept):
        kinds = {kind for row in find_disagreements(swept) for kind in find_kinds(_facts(row))}
        rarer = {
            "peaks_above",
            "integration",
            "peak_is_not_enough",
            "quick",
            "slow",
            "generic",
            "weak",
            "estimated",
        }
        assert set(KINDS) - kinds <= rarer

    def test_reasons_are_true(self, swept):
        for row in find_disagreements(swept):
            for kind in row.kinds:
                TRUE.get(kind, lambda row: None)(row)

    def test_groups_hold_every_row_once(self, swept):
        found = find_disagreements(swept)
        groups = group_disagreements(found)
        assert sorted(item for group in groups for item in group.items) == sorted(row.result.item.item for row in found)
        assert len(groups) < len(found) / 4
        spreads = [group.rows[0].spread for group in groups]
        assert spreads == sorted(spreads, reverse=True)
        for group in groups:
            assert {row.kinds for row in group.rows} == {group.rows[0].kinds}
            assert len(group.reasons) == len(group.rows[0].reasons)

    def test_the_widest_come_first(self, swept):
        order = [(row.spread, row.result.adopted.upper) for row in find_disagreements(swept)]
        assert order == sorted(order, reverse=True)


def _facts(row):
    return Facts(row.result, row.highest.key, row.lowest.key)


def _below_start(row):
    case, item = row.result.governing, row.result.item
    assert case.demand.pfa <= GRAVITY * item.breadth / item.height * (1 + 1e-9)
    assert case.methods["static"].value == 0


def _kaneko_velocity(row):
    demand, formula = row.result.governing.demand, row.result.governing.methods["kaneko_hayashi"]
    assert demand.pfa / (2 * math.pi * demand.pfv) > formula.detail["boundary_frequency_hz"]
    assert (100 * demand.pfv < formula.detail["median_pfv_cm_s"]) == (formula.value < 0.5)


def _size(row):
    """A piece of the height that is named, of the same B/H, overturns by half."""
    facts, item = _facts(row), row.result.item
    height = facts.half_height / 100
    median = fema_p58.median_pfv(height * item.breadth / item.height, height)
    assert median == pytest.approx(row.result.governing.demand.pfv)
    assert (facts.half_height < facts.height) == (row.highest.key == "proposed_or")


def _at_most(row):
    assert classify(_facts(row).or_at_most) < row.highest.risk
    assert row.lowest.value <= _facts(row).or_at_most + 1e-12


TRUE = {
    "or_below_start": _below_start,
    "velocity_below_start": _below_start,
    "kaneko_velocity": _kaneko_velocity,
    "size": _size,
    "or_at_most": _at_most,
}


class TestKnownRows:
    def test_the_formula_is_high_below_the_start_of_rocking(self, tmp_path):
        # g·B/H = 0.25 g, PFA 0.165 g
        row = one(tmp_path, 45.7, 182.9, 0.165, 22.7)
        assert (row.highest.title, row.highest.risk) == ("Proposed OR formula", RiskClass.HIGH)
        assert (row.lowest.title, row.lowest.risk) == ("Kaneko-Hayashi formula", RiskClass.LOW)
        assert row.spread == 2
        assert row.reasons[0] == (
            "PFA 0.165 g is 0.66 times g·B/H = 0.250 g, above which rocking can start; the proposed formula is a "
            f"surface fitted to results and knows no such threshold: it still gives {100 * row.highest.value:.1f} %."
        )
        assert row.reasons[1] == (
            "The Kaneko-Hayashi formula goes by velocity here (F_f 1.13 Hz, above F_b 0.83 Hz): PFV 22.7 cm/s is 0.38 "
            "times its median for such pieces, 59.0 cm/s."
        )

    def test_size_and_velocity_count_for_others(self, tmp_path):
        tall, small = one(tmp_path, 60, 300, 0.4, 20), one(tmp_path, 20, 40, 0.02, 120)
        assert (tall.highest.key, small.lowest.key) == ("proposed_or", "proposed_or")
        assert "size" in tall.kinds
        assert "size" in small.kinds
        assert "here the height is 300 cm." in tall.reasons[tall.kinds.index("size")]
        assert "here the height is 40 cm." in small.reasons[small.kinds.index("size")]

    def test_an_unknown_velocity_is_an_upper_bound(self, tmp_path):
        row = one(tmp_path, 120, 90, 0.9, None)
        assert (row.highest.key, row.lowest.key) == ("proposed_or", "kaneko_hayashi")
        assert row.reasons[row.kinds.index("kaneko_bound")].startswith(
            "PFV is unknown: the Kaneko-Hayashi formula shows"
        )

    def test_an_estimated_velocity_is_said(self, tmp_path):
        found = find_disagreements(rows(tmp_path, [(45.7, 182.9, 0.165, None)], period=0.7))
        assert found
        assert all("estimated" in find_kinds(_facts(row)) for row in found)

    def test_methods_that_agree_are_left_out(self, tmp_path):
        assert find_disagreements(rows(tmp_path, [(30, 200, 0.8, 150)])) == ()

    def test_direct_integration_counts_once_it_ran(self, tmp_path):
        settings = Settings(verify="all", runs=20)
        row = one(tmp_path, 45, 180, 0.24, 35, settings=settings, period=1.0)
        verified = row.result.governing.verification
        assert (row.lowest.key, row.lowest.value) == ("housner_monte_carlo", verified.probability)
        text = " ".join(row.reasons)
        assert f"{100 * verified.probability:.1f} % of 20 motions overturn it." in text
        assert "or_below_start" in row.kinds
        assert "generic" in find_kinds(_facts(row))


class TestExampleBuilding:
    def test_by_the_formulas(self, market_street):
        found = find_disagreements(market_street)
        assert summarise_disagreements(found, len(market_street)) == (
            "On 9 of 121 rows, methods differ by more than one class: in every case Proposed OR formula lies above "
            "Kaneko-Hayashi formula."
        )
        groups = group_disagreements(found)
        assert [len(group.rows) for group in groups] == [8, 1]
        assert groups[0].items[:2] == ("42-07", "42-08")
        assert groups[0].highest_value == "34.5 to 36.3 %"
        assert groups[0].reasons[0].startswith("PFA 0.136 to 0.165 g is 0.59 to 0.66 times g·B/H = 0.231 to 0.254 g, ")
        assert groups[1].items == ("G-04",)
        assert "near_switch" in groups[1].rows[0].kinds
        for row in found:
            for kind in row.kinds:
                TRUE.get(kind, lambda row: None)(row)

    def test_in_another_language_the_numbers_follow(self, market_street):
        with speaking(load_catalogue("it")):
            (row, *_) = find_disagreements(market_street)
            assert "0,136" in row.reasons[0]


def test_integration_kinds_by_made_up_verdicts(tmp_path):
    """A sentence is made of every kind for a piece that was integrated, whichever the two methods are."""
    settings = Settings(verify="all", runs=20)
    found = rows(tmp_path, [(45, 180, 0.4, 35), (45, 180, 0.2, 35)], settings=settings)
    for result in found:
        for highest, lowest in itertools.permutations(PROBABILITIES, 2):
            facts = Facts(result, highest, lowest)
            kinds = find_kinds(facts)
            assert kinds
            for kind in kinds:
                assert KINDS[kind].say([facts, facts]) == KINDS[kind].say([facts])
    quick = Facts(found.result(0), "proposed_or", "housner_monte_carlo")
    assert {"integration", "peak_is_not_enough", "quick"} <= set(find_kinds(quick))
    slept = Facts(found.result(1), "housner_monte_carlo", "proposed_or")
    assert "peaks_above" in find_kinds(slept)
    assert "slow" not in find_kinds(slept)


def test_the_most_frequent_pair_is_counted_where_there_are_others(market_street):
    found = find_disagreements(market_street)
    other = replace(found[0], lowest=replace(found[0].lowest, title="Another"))
    said = summarise_disagreements([*found[1:], other], 121)
    assert said.endswith("; most often Proposed OR formula lies above Kaneko-Hayashi formula (on 8).")


def test_a_long_group_names_some_and_counts_the_others(market_street):
    (group, *_) = group_disagreements(find_disagreements(market_street))
    long = replace(group, rows=group.rows * 2)
    assert (len(group.named), group.left, len(long.named), long.left) == (8, 0, 12, 4)


def test_no_disagreement_is_said():
    assert summarise_disagreements((), 3) == "On all 3 rows, the methods lie within one class of each other."
    assert summarise_disagreements((), 1) == "On the 1 row, the methods lie within one class of each other."


@pytest.mark.parametrize(("values", "text"), [([0.25, 0.31], "0.25 to 0.31"), ([0.251, 0.249], "0.25")])
def test_ranges(values, text):
    assert span(values, ".2f") == text


def test_pieces_on_which_the_lowest_and_highest_are_the_same_class_apart_are_one_group(tmp_path):
    found = find_disagreements(rows(tmp_path, [(45.7, 182.9, 0.165, 22.7), (45.7, 182, 0.165, 22.7)]))
    (group,) = group_disagreements(found)
    assert len(group.rows) == 2
    moved = replace(found[0], kinds=("fema",))
    assert len(group_disagreements([moved, found[1]])) == 2
