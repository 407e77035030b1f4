"""Results stand for themselves: small, equal after a round trip, with tables and reports that come from them alone."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from assess.errors import InputError
from assess.risk import classify
from assess.settings import Settings
from tests.workbooks import ITEMS, assessed

TABLES = ("items", "cases", "floors", "segments", "routes", "rooms", "problems")
KNOWN = {"string", "float64", "Int64", "boolean"}


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("results") / "w.xlsx", settings=Settings(verify="all", runs=10))


def test_the_worked_example_pickles_small_and_comes_back_equal(example):
    data = pickle.dumps(example)
    again = pickle.loads(data)
    assert len(data) < 300_000
    assert again == example
    assert list(again) == list(example)


def test_a_change_makes_results_unequal(simulated):
    assert replace(simulated, settings=Settings(verify="all", runs=11)) != simulated
    table = simulated.cases_table
    changed = table.adopted | {"probability": np.nextafter(table.adopted["probability"], 1)}
    assert replace(simulated, cases_table=replace(table, adopted=changed)) != simulated


def test_only_a_class_above_that_of_the_piece_is_called_higher(simulated):
    table = simulated.cases_table
    flagged = table.adopted | {"ideal_higher": np.ones_like(table.adopted["ideal_higher"])}  # of every motion
    results = replace(simulated, cases_table=replace(table, adopted=flagged))
    higher = [any(case.simulation and case.simulation.ideal and classify(case.simulation.ideal.probability)
                  > one.adopted.risk for case in one.cases) for one in results]  # fmt: skip
    assert ["ideal_higher" in one.adopted.flags for one in results] == higher
    assert not all(higher)


def test_series_that_are_gone_are_known_to_be(simulated, tmp_path):
    assert simulated.series.is_there
    name = f"motion/{next(one.index for one in simulated.motions if one.ensemble)}/runs"
    assert name in simulated.series
    gone = type(simulated.series)(tmp_path / "gone.npz")
    assert not gone.is_there
    assert name not in gone
    with pytest.raises(KeyError):
        gone[name]


# ---------------------------------------------------------------- rows by name


def test_an_unknown_name_is_an_input_error_with_a_hint(example, simulated):
    with pytest.raises(InputError, match=r"there is no item '42-011' among the 121 items. Did you mean '42-.1'\?"):
        example["42-011"]
    with pytest.raises(InputError, match=r"no item 'zebra' among the 5 items\.$"):
        simulated["zebra"]


# ---------------------------------------------------------------- tables


@pytest.mark.parametrize("name", TABLES)
def test_tables_have_one_type_a_column_whatever_the_rows(name, example, simulated, tmp_path):
    """What is not a text, a number, a count or a flag is a list, so that a table can be written as Parquet."""
    tables = [getattr(results, name) for results in (example, simulated)]
    for table in tables:
        assert {str(one) for one in table.dtypes} <= KNOWN | {"object"}
        for column in table.columns[table.dtypes == "object"]:
            assert all(isinstance(value, list) for value in table[column]), column
    assert dict(tables[0].dtypes) == dict(tables[1].dtypes)


# ---------------------------------------------------------------- in a notebook


def test_a_notebook_shows_results_in_short_and_escaped(tmp_path, example):
    items = [ITEMS[0] | {"item": "<b>x</b>", "description": "<script>alert(1)</script>"}, *ITEMS[1:]]
    results = assessed(tmp_path / "w.xlsx", items)
    for shown in (results._repr_html_(), results["<b>x</b>"]._repr_html_()):
        assert "&lt;b&gt;x&lt;/b&gt;" in shown
        assert "&lt;script&gt;" in shown
        assert "<script>" not in shown
    assert "Free-standing pieces by class: very high" in results._repr_html_()
    assert len(example._repr_html_()) < 4000
    assert len(repr(example)) < 120
