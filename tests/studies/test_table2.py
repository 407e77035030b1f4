"""What the study of buildings says, on chances that are known, and the paper's own table as printed."""

from pathlib import Path

import numpy as np
import pytest

from assess.methods import Cases, proposed_or
from assess.settings import Settings
from assess.studies.agreement import FORMULAS, INTEGRATION, PRINTED, by_building, find_agreement, pool
from assess.studies.buildings import FIRST_TOGETHER, LEVELS, RECORDED, TOGETHER
from assess.studies.study import Options, read_facts, render_block
from assess.studies.table2 import ALL, NOTHING, SUBSETS, collect, compare
from assess.units import GRAVITY
from tests.studies.made_up import make_compared

OPTIONS = Options(out=Path("unused"))
NAMES = ["575 Market Street", "Great Western Savings", "LACPW headquarters"]


def half(breadth, _height, pfa, _pfv):
    """Thinner than 45 cm falls for certain from 0.5 g on, nothing else does."""
    return (breadth < 0.45) & (pfa > 4.9)


@pytest.fixture(scope="module")
def judged():
    return make_compared(half, OPTIONS, runs=100)


@pytest.fixture(scope="module")
def compared(judged):
    return compare(judged)


def grid(one):
    """The cases of a channel at the common PFA, by hand."""
    pfa = np.repeat(np.array(LEVELS) * GRAVITY, 85)
    breadth, height = (np.tile(size, len(LEVELS)) for size in (one.trials.breadth, one.trials.height))
    return Cases.of(breadth=breadth, height=height, pfa=pfa, pfv=one.ratio * pfa)


def test_agreement_is_that_of_the_formula_itself(judged, compared):
    """OR evaluated here, as used and as printed, against what falls."""
    for name, own in by_building(judged).items():
        outcomes = [proposed_or.evaluate(grid(one), Settings()) for one in own]
        fallen = np.concatenate([one.trials.fallen[: len(LEVELS)].ravel() for one in own])
        used = np.concatenate([one.value for one in outcomes])
        printed = np.clip(np.concatenate([one.detail["raw"] for one in outcomes]), 0, 1)
        assert compared.agreements[name, ALL, "proposed_or"] == find_agreement(used, fallen, 100)
        assert compared.agreements[name, ALL, PRINTED] == find_agreement(printed, fallen, 100)
    assert {name for name, _, _ in compared.agreements} == set(NAMES)
    said, done = pool(judged, "proposed_or")
    assert said.size == done.size == 21 * 85 * len(LEVELS)


def test_parts_of_the_cases_are_those_that_their_names_say(judged):
    """By hand: PFA as recorded, up to three times that, and in the range of the tests of Table 3."""
    n = len(LEVELS)
    for one in judged:
        recorded = one.trials.channel.read().pfa
        pfa = np.array(LEVELS)[:, None] * GRAVITY
        ratio = (one.trials.breadth / one.trials.height)[None, :]
        own, little, inside = (chosen(one) for name, chosen in SUBSETS.items() if name != ALL)
        assert own.sum() == own[RECORDED].sum() == 85
        assert (little[:n] == (pfa / recorded <= 3) & (ratio > 0)).all()
        assert (inside[:n] == ((ratio >= 0.14) & (ratio <= 0.39) & (pfa > 0))).all()
        assert not little[n:].any()
        assert not inside[n:].any()


def test_criteria_are_counted_where_pieces_fall_and_where_they_do_not(judged, compared):
    """The static criterion knows PFA and B/H alone: it is held against what falls by hand."""
    for name, own in by_building(judged).items():
        found = compared.criteria[name, "static"]
        met, fallen = pool(own, "static")
        assert found.missed == np.sum((fallen == 100) & (met == 0)) / np.sum(fallen == 100)
        assert found.idle == np.sum((fallen == 0) & (met == 1)) / np.sum(fallen == 0)


def test_what_cannot_rock_is_found_and_pairs_are_those_of_one_floor(compared):
    """B/H of 0.1, 0.125, ... 0.5 and PFA of 0.1, 0.15, ... 0.9 g: how many are below g B/H is counted by hand."""
    ratios = [100 + 25 * at for at in range(17)]
    still = sum(50 * level < ratio for ratio in ratios for level in range(2, 19))
    assert compared.at_rest.share == pytest.approx(still / 17**2)
    assert 0 < compared.at_rest.above["kaneko_hayashi"] < compared.at_rest.above["proposed_or"] < 1
    assert compared.at_rest.above_by_integration == 0  # what falls is thin, and PFA is 0.5 g there
    along, across = ([one for one in compared.pairs if one.is_along == is_along] for is_along in (True, False))
    market, berkeley = 1 + 1 + 1, 1 + 1 + 1 + 3 + 1  # g h, d e, a b; basement X and Y, 4th, roof X and Y
    assert len(along) == (market + berkeley) * len(TOGETHER)
    assert len(across) == (2 + 2 + 4 + 6) * len(TOGETHER)


def test_the_yardstick_says_that_nothing_falls(judged, compared):
    """Half as many fall of the uncertain motions and pieces that are made up."""
    for name, own in by_building(judged).items():
        fallen = np.concatenate([one.trials.fallen[: len(LEVELS)].ravel() for one in own])
        one = compared.agreements[name, ALL, NOTHING]
        assert one.bias == pytest.approx(-fallen.mean() / 100)
        assert one.rms == pytest.approx(np.mean((fallen / 100) ** 2) ** 0.5)
        assert one.class_too_low == np.mean(fallen > 0)
        said, halved = pool(own, "proposed_or", uncertain=True)
        assert (halved == fallen // 2).all()
        assert halved.any()
        assert compared.uncertain[name, "proposed_or"] == find_agreement(said, fallen // 2, 100)
        assert compared.uncertain[name, NOTHING].bias == pytest.approx(-np.mean(fallen // 2) / 100)


def test_channels_of_a_floor_are_scaled_by_one_factor(judged):
    for one in judged:
        factors = one.factors[FIRST_TOGETHER:]
        floor = [
            other for other in judged
            if (other.building, other.trials.channel.level) == (one.building, one.trials.channel.level)
        ]  # fmt: skip
        assert all(other.factors[FIRST_TOGETHER:] == pytest.approx(factors) for other in floor)
        strongest = max(other.trials.pfa[FIRST_TOGETHER] for other in floor)
        assert strongest == pytest.approx(TOGETHER[0] * GRAVITY)
        assert one.factors[RECORDED] == pytest.approx(1)


def test_channels_of_a_pair_are_as_far_apart_as_their_chances():
    """Where a chance is a tenth of PFA [m/s2], they are a tenth of the difference of their PFA apart."""
    judged = make_compared(lambda b, _h, pfa, _v: pfa / 10 + 0 * b, OPTIONS)
    own = {(one.building.name, one.trials.channel.name): one.trials.pfa[FIRST_TOGETHER:] for one in judged}
    for one in compare(judged).pairs:
        first, second = (own[one.building, name][TOGETHER.index(one.pfa)] for name in one.names)
        assert one.apart[INTEGRATION] == pytest.approx(abs(first - second) / 10)


def test_the_page_states_bias_rank_and_classes_for_every_building_and_formula(judged, compared):
    values = collect(judged, compared, OPTIONS)
    head, *others = (render_block("table2", block, **values) for block in ("overview", "page", "failures"))
    each = 1 + len(NAMES) * (len(FORMULAS) + 1)
    tables: list[list[list[str]]] = []  # the cells of each row of each table, its heading first
    for before, line in zip(["", *head], head, strict=False):
        if line.startswith("| "):
            tables += [] if before.startswith("|") else [[]]
            tables[-1].append(line.split(" | "))
    exact, uncertain = tables
    assert (len(exact), len(uncertain)) == (each, each)
    keys = {shown: key for key, shown in FORMULAS.items()}
    for cells in exact[1:]:
        name, title = cells[0].removeprefix("| "), cells[1].strip('"')
        one = compared.agreements[name, ALL, keys.get(title, title)]
        shown = [float(cells[at].split(" %")[0]) for at in (2, 3, 7, 8)]
        fields = (one.bias, one.rms, one.class_too_low, one.class_too_high)
        assert shown == pytest.approx([100 * value for value in fields], abs=0.0501)
        assert title not in keys or float(cells[4]) == pytest.approx(one.rank_correlation, abs=0.005)
    for cells in uncertain[1:]:
        title, name = cells[0].removeprefix("| ").strip('"'), cells[1]
        key = keys.get(title, title)
        pair = compared.agreements[name, ALL, key], compared.uncertain[name, key]
        shown = [float(cell.split(" ")[0]) for cell in cells[2:8]]
        expected = [getattr(one, field) for field in ("bias", "class_too_low", "class_too_high") for one in pair]
        assert shown == pytest.approx([100 * value for value in expected], abs=0.0501)
    for lines in (head, *others):
        assert all(name in "\n".join(lines) for name in NAMES)


def test_the_print_of_the_paper():
    """Counted from its table: integration above OR in 20 rows, equal in one."""
    rows = read_facts("table2_methods")
    assert len(rows) == 27
    apart = [float(row["housner_direct"]) - float(row["proposed_or"]) for row in rows]
    assert (sum(one > 0 for one in apart), sum(one == 0 for one in apart)) == (20, 1)


def test_the_conclusion_follows_from_the_correlation(judged, compared):
    values = collect(judged, compared, OPTIONS)
    for correlation, conclusion in (
        (-0.9, "-0.90 with PFV/PFA: the higher the frequency, the larger the bias."),
        (0.9, "0.90 with PFV/PFA: the lower the frequency, the larger the bias."),
        (-0.2, "-0.20 with PFV/PFA: no clear dependence."),
        (float("nan"), "its bias is constant."),
    ):
        lines = render_block("table2", "failures", **values | {"correlation": correlation})
        assert lines[0].endswith(conclusion)
