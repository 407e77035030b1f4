"""Where a fitted model disagrees with the published methods: told apart, and hiding nothing of theirs."""

import dataclasses

import pytest

import assess
from assess.methods import all_methods
from assess.methods._fitted_model import Polynomial
from assess.methods._fitted_texts import build_method
from assess.methods._method import FittedOn
from assess.report.data import describe_run
from assess.report.findings.disagreements import find_disagreements, group_disagreements, summarise_disagreements
from assess.report.words import name_ranges
from assess.risk import classify
from tests.methods.test_fitted import PROBIT, SURFACE
from tests.report.test_disagreements import MARKET_STREET
from tests.workbooks import UNVERIFIED, assessed

NEVER = dataclasses.replace(
    SURFACE, key="fitted_never", title="Never", formula=Polynomial("x", ((0, 0, 0.0),)), error=0.5
)
ALWAYS = dataclasses.replace(SURFACE, key="fitted_always", title="Always", formula=Polynomial("x", ((0, 0, 1.0),)))


def plain(row):
    return (row.result.item.item, row.highest, row.lowest, row.kinds, row.reasons, row.model)


def shown(group):
    return dataclasses.replace(group, rows=()), group.items


@pytest.fixture(scope="module")
def inventory():
    return assess.read_inventory(MARKET_STREET)


@pytest.fixture(scope="module")
def without(inventory):
    return assess.run(inventory, UNVERIFIED)


@pytest.fixture(scope="module", params=[[NEVER], [ALWAYS], [NEVER, PROBIT, ALWAYS]], ids=len)
def models(request):
    return request.param


@pytest.fixture(scope="module")
def with_them(inventory, models):
    return assess.run(inventory, UNVERIFIED, methods=[build_method(one, "m.toml") for one in models])


class TestPublished:
    def test_their_rows_are_those_without_a_fitted_model(self, with_them, without):
        published, found = find_disagreements(without), find_disagreements(with_them, with_them.methods)
        assert len(published) == 9
        assert list(map(plain, found[:9])) == list(map(plain, published))
        assert all(row.model is not None for row in found[9:])

    def test_their_groups_come_first_unchanged(self, with_them, without):
        published = group_disagreements(find_disagreements(without))
        groups = group_disagreements(find_disagreements(with_them, with_them.methods))
        assert list(map(shown, groups[: len(published)])) == list(map(shown, published))
        assert len(published) < len(groups)

    def test_their_sentence_stands_first_unchanged(self, with_them, without):
        said = summarise_disagreements(find_disagreements(with_them, with_them.methods), len(with_them))
        assert said.startswith(summarise_disagreements(find_disagreements(without), len(without)) + " Counted apart: ")

    def test_a_model_that_is_not_asked_for_is_left_out(self, with_them, without):
        assert list(map(plain, find_disagreements(with_them))) == list(map(plain, find_disagreements(without)))


class TestFitted:
    def test_it_is_compared_with_published_methods_alone(self, with_them, models):
        keys = {one.key for one in models}
        for row in find_disagreements(with_them, with_them.methods):
            pair = {row.highest.key, row.lowest.key}
            assert len(pair & keys) == (row.model is not None)
            assert row.model is None or row.model.key in pair

    def test_every_row_on_which_it_differs_from_one_of_them_is_found_once(self, with_them, models):
        found = find_disagreements(with_them, with_them.methods)
        for model in models:
            published = [one.key for one in all_methods() if one.kind == "probability"]
            differ = []
            for result in with_them:
                values = result.governing.methods
                own = classify(values[model.key].value)
                others = [classify(values[key].value) for key in published if values[key].value is not None]
                if own is not None and max(abs(own - one) for one in others) > 1:
                    differ.append(result.item.item)
            rows = [row.result.item.item for row in found if row.model and row.model.key == model.key]
            assert sorted(rows) == sorted(differ)
        assert rows

    def test_each_is_counted_in_a_sentence(self, with_them, models):
        found = find_disagreements(with_them, with_them.methods)
        said = summarise_disagreements(found, len(with_them))
        assert said.count("Counted apart: ") == len(models)
        for model in models:
            n = sum(row.model is not None and row.model.key == model.key for row in found)
            assert (
                f"Counted apart: {model.title} (fitted on 3 buildings) differs by more than one class from a published "
                f"method on {n:,} of 121 rows; most often "
            ) in said

    def test_only_a_fitted_model_says_what_it_was_fitted_on(self):
        assert build_method(PROBIT, "m.toml").fitted == FittedOn(
            data=PROBIT.fitted_on, error=0.1234, spread=0.02, constant=0.4321
        )
        assert all(method.fitted is None for method in all_methods())

    def test_a_published_method_of_such_a_key_is_none(self, inventory):
        method = dataclasses.replace(build_method(NEVER, "m.toml"), fitted=None)
        found = assess.run(inventory, UNVERIFIED, methods=[method])
        assert all(row.model is None for row in find_disagreements(found, found.methods))
        assert "fitted_models" not in describe_run(found)["assess"]
        assert name_ranges(method) == "Checked for"


class TestReasons:
    def of(self, tmp_path, model, pfv):
        floors = [{"floor": "F1", "pfa_x": 0.5, "pfv_x": pfv}]
        items = [{"item": "A", "floor": "F1", "breadth": 30, "width": 80, "height": 180, "axis": "X"}]
        found = assessed(tmp_path / "w.xlsx", items, floors, settings=UNVERIFIED)
        method = build_method(model, "m.toml")
        found = assess.run(found.inventory, UNVERIFIED, methods=[method])
        (row,) = [row for row in find_disagreements(found, found.methods) if row.model]
        return row

    def test_it_is_said_where_it_is_no_better_than_a_constant(self, tmp_path):
        row = self.of(tmp_path, NEVER, 40)
        assert row.reasons[:2] == (
            "The fitted model gives 0.0 % at B/H 0.167 and PFA 0.500 g: it approximates what was computed on the "
            "buildings that it was fitted to, with a root mean square error of 0.500 where a building is left out.",
            "For a building that it was not fitted to, it is no better than a constant, one chance for every piece and "
            "motion.",
        )
        assert "fitted_extrapolated" not in row.kinds

    @pytest.mark.parametrize(
        ("pfv", "told"),
        [
            (200, "The piece or its motion lies outside the data that the model was fitted to."),
            (None, "PFV is unknown: the piece and its motion cannot be shown to lie inside the data that the model was "
                   "fitted to."),
        ],
    )  # fmt: skip
    def test_it_is_said_where_it_is_extrapolated(self, tmp_path, pfv, told):
        row = self.of(tmp_path, dataclasses.replace(NEVER, error=0.1), pfv)
        assert row.reasons[1] == told
