"""What every method keeps to, run over all of them: a new method is tested here without a line added."""

import dataclasses
import pickle
import re

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from assess.i18n import placeholders
from assess.methods import FACTS, Cases, Method, Outcome, adopted_formula, all_methods, paper_formula, simulation
from assess.rocking.draws import MOTION, PEAK
from assess.settings import Settings
from assess.units import GRAVITY
from tests.methods.ensembles import MadeUp

SETTINGS = Settings()
EXAMPLES = 60
NOT_ARRAYS = ("ensembles", "uncertainty", "earthquakes")
FIELDS = tuple(field.name for field in dataclasses.fields(Cases) if field.name not in NOT_ARRAYS)
METHODS = pytest.mark.parametrize("method", all_methods(), ids=lambda method: method.key)
SCREENING = pytest.mark.parametrize(
    "method", [method for method in all_methods() if method.tier == "screening"], ids=lambda method: method.key
)
"""Under one motion a harsher one may spare a piece: no integration is monotone."""
SETTINGS_OF = {"screening": SETTINGS, "verification": dataclasses.replace(SETTINGS, runs=6)}
ENSEMBLES = (MadeUp(0), MadeUp(1, is_assumed=True), MadeUp(2, has_record=True))

sizes = st.floats(0.05, 6.0)
pfas = st.floats(0.0, 3.0 * GRAVITY)
pfvs = st.one_of(st.just(float("nan")), st.floats(0.0, 6.0))
frictions = st.one_of(st.just(float("nan")), st.floats(0.05, 1.5))
case = st.tuples(sizes, sizes, pfas, pfvs, frictions)
DRAWN = ("breadth", "height", "pfa", "pfv", "friction")


def batch(rows) -> Cases:
    columns = zip(*rows, strict=True)
    return Cases.of(**dict(zip(DRAWN, map(np.array, columns), strict=True)))


def random_batch(n=400) -> Cases:
    random = np.random.default_rng(7)
    height = random.uniform(0.2, 3.0, n)
    return Cases.of(
        height=height,
        breadth=height * random.uniform(0.02, 2.0, n),
        pfa=random.uniform(0.0, 3.0 * GRAVITY, n),
        pfv=np.where(random.random(n) < 0.2, np.nan, random.uniform(0.0, 4.0, n)),
        friction=np.where(random.random(n) < 0.5, np.nan, random.uniform(0.1, 1.0, n)),
        restitution=np.where(random.random(n) < 0.7, np.nan, random.uniform(0.3, 1.0, n)),
        centre=np.where(random.random(n) < 0.5, 0.5, random.uniform(0.3, 0.7, n)),
        name=random.integers(0, 1000, n),
        ensemble=random.integers(-1, len(ENSEMBLES), n),
        ensembles=ENSEMBLES,
    )


def take(cases: Cases, index) -> Cases:
    return dataclasses.replace(cases, **{name: getattr(cases, name)[index] for name in FIELDS})


def evaluate(method: Method, cases: Cases) -> Outcome:
    return method.evaluate(cases, SETTINGS_OF[method.tier])


def change(cases: Cases, **changes) -> Cases:
    return dataclasses.replace(cases, **changes)


def arrays_of(outcome: Outcome) -> dict[str, np.ndarray]:
    return {"value": outcome.value, **outcome.detail, **outcome.flags}


def assert_same(found: Outcome, expected: Outcome, index=...) -> None:
    found_arrays, expected_arrays = arrays_of(found), arrays_of(expected)
    assert found_arrays.keys() == expected_arrays.keys()
    for name, values in found_arrays.items():
        np.testing.assert_array_equal(values, expected_arrays[name][index], err_msg=name)


def assert_no_less(method: Method, milder: Cases, harsher: Cases) -> None:
    """`harsher` comes out no safer, except where a formula jumps between its branches, as published."""
    before, after = evaluate(method, milder), evaluate(method, harsher)
    assert np.all(np.isnan(after.value) | ((after.value >= 0) & (after.value <= 1)))
    pairs = ~np.isnan(before.value) & ~np.isnan(after.value)
    if "branch" in before.detail:
        pairs &= before.detail["branch"] == after.detail["branch"]
    assert np.all(after.value[pairs] >= before.value[pairs] - 1e-12)


def test_order_of_reports():
    orders = [method.order for method in all_methods()]
    assert orders == sorted(set(orders))
    assert all_methods()[0] is adopted_formula()


class TestRoles:
    def test_the_adopted_formula_serves_the_workbook_and_the_choice_of_pieces(self):
        formula = adopted_formula()
        assert formula.is_live
        assert formula.selects
        assert "breadth_to_height" in formula.valid
        assert formula.kind == "probability"

    def test_the_simulation_gives_what_adoption_reads(self):
        outcome = evaluate(simulation(), random_batch(20))
        assert {"low", "high", "runs", "overturned", "record_overturned", "record_rotation"} <= outcome.detail.keys()
        assert {"assumed_motion", "weak_motions", "fell_in_record", "undecided", "does_not_rock"} <= set(outcome.flags)
        assert simulation().tier == "verification"

    def test_one_criterion_tells_whether_a_piece_can_rock(self):
        (method,) = (method for method in all_methods() if method.tells_rocking)
        assert evaluate(method, Cases.of(breadth=0.5, height=2.0, pfa=[2.4, 2.5])).value.tolist() == [0.0, 1.0]


@METHODS
class TestDescription:
    def test_every_text_is_filled(self, method):
        assert method.title
        assert method.short_title
        assert method.steps is not None
        assert method.predicts.endswith(".")
        assert method.assumptions
        assert str(method.reference).endswith(".")

    def test_texts_are_plain_lines(self, method):
        for text in (*method.equations, *method.assumptions, *method.departures, *method.flags.values()):
            assert text == text.strip()
            assert "\n" not in text

    def test_needs_are_fields_of_cases(self, method):
        assert method.needs
        assert method.needs <= set(FIELDS)

    def test_columns_are_the_details_in_their_order(self, method):
        detail = evaluate(method, random_batch(20)).detail
        assert [column.name for column in method.columns] == list(detail)
        for column in method.columns:
            values = detail[column.name]
            assert (values.dtype.kind == "U") == (column.kind == "text")
            if column.kind != "text":
                assert format(float(values[0]), column.format)
            assert column.label

    def test_reasons_name_what_there_is(self, method):
        known = {*FACTS, "value", *(column.name for column in method.columns)}
        sides = {"above", "below", ""}
        for reason in method.reasons:
            assert placeholders(reason.text) <= known
            assert reason.side in sides
            assert reason.flag in {"", *method.flags}
            assert reason.column in {"", *(column.name for column in method.columns if column.kind == "text")}

    def test_some_reason_applies_wherever_it_gives_a_probability(self, method):
        if method.kind == "criterion":
            return
        outcome = evaluate(method, random_batch())
        for at in np.flatnonzero(~np.isnan(outcome.value)):
            detail = {name: values[at].item() for name, values in outcome.detail.items()}
            flags = [flag for flag, raised in outcome.flags.items() if raised[at]]
            assert any(one.applies("above", detail, flags, can_rock=True) for one in method.reasons)

    def test_parameters_are_settings(self, method):
        for one in method.parameters:
            assert getattr(SETTINGS, one.setting) > 0
            assert re.fullmatch("[a-z_]+", one.cell)

    def test_info_is_the_method_without_functions(self, method):
        info = pickle.loads(pickle.dumps(method.info))
        assert info == method.info
        assert (info.key, info.columns, info.tier, info.is_live) == (
            method.key, method.columns, method.tier, method.live is not None,
        )  # fmt: skip
        assert len(pickle.dumps(method.info)) < 12_000

    def test_a_criterion_has_words_and_a_probability_none(self, method):
        assert all(method.words) is (method.kind == "criterion")
        assert any(method.words) is (method.kind == "criterion")


@METHODS
class TestBatch:
    def test_shapes_and_flags(self, method):
        cases = random_batch()
        outcome = evaluate(method, cases)
        for name, values in arrays_of(outcome).items():
            assert values.shape == cases.pfa.shape, name
        assert outcome.value.dtype == np.float64
        assert all(flag.dtype == np.bool_ for flag in outcome.flags.values())
        assert set(outcome.flags) == set(method.flags), "a flag without a meaning, or a meaning without a flag"

    def test_values_are_probabilities_or_answers(self, method):
        value = evaluate(method, random_batch()).value
        value = value[~np.isnan(value)]
        assert value.size
        assert np.all((value >= 0) & (value <= 1))
        if method.kind == "criterion":
            assert set(value) == {0.0, 1.0}

    def test_inputs_are_left_untouched(self, method):
        cases, again = random_batch(), random_batch()
        for name in FIELDS:
            getattr(cases, name).flags.writeable = False
        evaluate(method, cases)
        for name in FIELDS:
            np.testing.assert_array_equal(getattr(cases, name), getattr(again, name))

    def test_order_of_the_batch_is_irrelevant(self, method):
        cases = random_batch()
        order = np.random.default_rng(1).permutation(len(cases.pfa))
        assert_same(evaluate(method, take(cases, order)), evaluate(method, cases), order)

    def test_a_batch_equals_one_by_one(self, method):
        cases = random_batch(60)
        together = evaluate(method, cases)
        for index in range(60):
            one = slice(index, index + 1)
            assert_same(evaluate(method, take(cases, one)), together, one)

    def test_an_empty_batch(self, method):
        outcome = evaluate(method, take(random_batch(), slice(0)))
        assert all(values.shape == (0,) for values in arrays_of(outcome).values())


@METHODS
class TestUnknown:
    def test_an_unknown_need_gives_nan_or_what_any_value_of_it_would_give(self, method):
        cases = random_batch()
        for need in method.needs:
            unknown = evaluate(method, change(cases, **{need: np.full_like(cases.pfa, np.nan)})).value
            settled = ~np.isnan(unknown)
            if need != "pfv":
                assert not settled.any(), need
            for size in (0.01, 0.3, 100.0):
                known = evaluate(method, change(cases, **{need: np.full_like(cases.pfa, size)})).value
                np.testing.assert_array_equal(unknown[settled], known[settled], err_msg=need)

    def test_all_unknown_gives_nan_and_warns_of_nothing(self, method):
        nothing = Cases.of(breadth=np.nan, height=np.nan, friction=0.3)
        outcome = evaluate(method, nothing)
        assert np.isnan(outcome.value).all()
        assert not any(flag.any() for name, flag in outcome.flags.items() if name != "pfv_unknown")

    def test_no_shaking(self, method):
        still = Cases.of(breadth=[0.1, 0.3, 1.0, 3.0], height=1.0, pfa=0.0, pfv=[0.0, 0.0, np.nan, 0.0])
        value = evaluate(method, still).value
        if {"pfa", "pfv"} & method.needs and method is not paper_formula():  # it gives some risk, see its own test
            assert np.all((value == 0) | np.isnan(value))


@SCREENING
class TestMonotone:
    @settings(deadline=None, max_examples=EXAMPLES)
    @given(rows=st.lists(case, min_size=1, max_size=40), factor=st.floats(1.0, 5.0))
    def test_no_less_risk_for_a_motion_scaled_up(self, method, rows, factor):
        cases = batch(rows)
        assert_no_less(method, cases, change(cases, pfa=cases.pfa * factor, pfv=cases.pfv * factor))

    @settings(deadline=None, max_examples=EXAMPLES)
    @given(rows=st.lists(case, min_size=1, max_size=40), factor=st.floats(0.1, 1.0))
    def test_no_less_risk_for_a_thinner_piece(self, method, rows, factor):
        cases = batch(rows)
        assert_no_less(method, cases, change(cases, breadth=cases.breadth * factor))

    def test_on_a_fine_grid(self, method):
        breadth, pfa = (values.ravel() for values in np.meshgrid(np.linspace(0.02, 2.0, 300), np.linspace(0, 30, 120)))
        cases = Cases.of(breadth=breadth, height=1.0, pfa=pfa, pfv=pfa / (2 * np.pi * 0.9))
        assert_no_less(method, cases, change(cases, pfa=cases.pfa * 1.01, pfv=cases.pfv * 1.01))
        assert_no_less(method, cases, change(cases, breadth=cases.breadth * 0.995))


class TestCasesOf:
    def test_numbers_and_arrays_come_to_one_length(self):
        cases = Cases.of(breadth=0.4, height=[1.8, 2.0], pfa=3.0)
        assert cases.breadth.tolist() == [0.4, 0.4]
        assert np.isnan(cases.pfv).tolist() == [True, True]
        assert cases.dispersion.tolist() == [MOTION, MOTION]
        assert cases.peak.tolist() == [PEAK, PEAK]
        np.testing.assert_allclose(cases.breadth_to_height, [0.4 / 1.8, 0.2])

    def test_what_was_given_is_copied(self):
        height = np.array([1.8, 2.0])
        Cases.of(breadth=0.4, height=height).height[0] = 0.0
        assert height[0] == 1.8
