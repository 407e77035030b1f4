"""Where methods disagree by more than one class: which rows, and whether the reasons are true of them."""

import dataclasses
import itertools
import math

import pytest

import assess
from assess.methods.fitted import Polynomial, build_method
from assess.report.say.methods import find_disagreements
from assess.risk import RiskClass, classify
from tests.methods.test_fitted import PROBIT, SURFACE
from tests.workbooks import UNVERIFIED, assessed

NEVER = dataclasses.replace(
    SURFACE, key="fitted_never", title="Never", formula=Polynomial("x", ((0, 0, 0.0),)),
    fitted=dataclasses.replace(SURFACE.fitted, error=0.5),
)  # fmt: skip
ALWAYS = dataclasses.replace(SURFACE, key="fitted_always", title="Always", formula=Polynomial("x", ((0, 0, 1.0),)))


def run(tmp_path, cases, settings=UNVERIFIED, **building):
    """Assess pieces given as breadth, height [cm], PFA [g], PFV [cm/s]."""
    motions = sorted({case[2:] for case in cases}, key=str)
    floors = [{"floor": f"F{at}", "pfa_x": pfa, "pfv_x": pfv} for at, (pfa, pfv) in enumerate(motions)]
    items = [
        {"item": f"I{at}", "floor": f"F{motions.index(motion)}", "breadth": b, "width": max(b, 80), "height": h,
         "axis": "X"}
        for at, (b, h, *peaks) in enumerate(cases) for motion in [tuple(peaks)]
    ]  # fmt: skip
    return assessed(tmp_path / "w.xlsx", items, floors, settings=settings, **building)


def found(results):
    return find_disagreements(results, tuple(results))


def rows_of(results):
    return [row for group in found(results)[1] for row in group.rows]


def one(tmp_path, *case, **named):
    (group,) = found(run(tmp_path, [case], **named))[1]
    (row,) = group.rows
    return row, " ".join(group.reasons)


def classes(results, row):
    methods = [one.key for one in results.methods if one.kind == "probability" and one.fitted is None]
    values = [row.governing.methods[key].value for key in methods]
    return [classify(value) for value in values if value is not None]


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Sizes and motions of all kinds, well beyond those of a building."""
    sizes = itertools.product((6, 20, 30, 45, 70, 120, 200), (40, 90, 200, 300))
    motions = list(itertools.product((0.02, 0.1, 0.25, 0.5, 0.9, 2.5), (None, 1, 10, 40, 120, 500)))
    return run(tmp_path_factory.mktemp("sweep"), [(*size, *motion) for size in sizes for motion in motions])


class TestSweep:
    def test_every_row_that_differs_by_more_than_one_class_is_in_one_group(self, swept):
        expected = [row.item.item for row in swept if max(classes(swept, row)) - min(classes(swept, row)) > 1]
        groups = found(swept)[1]
        assert sorted(row.result.item.item for group in groups for row in group.rows) == sorted(expected)
        assert len(groups) < len(expected) / 4
        assert len(expected) > 200

    def test_reasons_are_true(self, swept):
        for row in rows_of(swept):
            item, case = row.result.item, row.result.governing
            for method, reason in row.reasons:
                detail, motion = case.methods[method.key].detail, case.motion
                if reason.can_rock is False:
                    assert motion.pfa_g <= item.breadth_to_height * (1 + 1e-9)
                if reason.side:
                    assert row.highest.method is method if reason.side == "above" else row.lowest.method is method
                if reason.flag:
                    assert reason.flag in case.methods[method.key].flags
                if reason.equals == "pfv":
                    assert motion.pfa_g * 980.665 / (2 * math.pi * motion.pfv_cm_s) > detail["boundary_frequency_hz"]
                    assert (motion.pfv_cm_s < detail["median_pfv_cm_s"]) == (case.methods[method.key].value < 0.5)

    def test_the_widest_come_first_and_rows_of_a_group_are_alike(self, swept):
        groups = found(swept)[1]
        spreads = [one.highest.risk - one.lowest.risk for one in (group.rows[0] for group in groups)]
        assert spreads == sorted(spreads, reverse=True)
        for group in groups:
            alike = {(row.highest.risk, row.lowest.risk, *(reason for _, reason in row.reasons)) for row in group.rows}
            assert len(alike) == 1


class TestKnownRows:
    def test_the_formula_is_high_below_the_start_of_rocking(self, tmp_path):
        row, reasons = one(tmp_path, 45.7, 182.9, 0.165, 22.7)  # g·B/H = 0.25 g
        assert (row.highest.method.title, row.highest.risk) == ("Proposed OR formula", RiskClass.HIGH)
        assert (row.lowest.method.title, row.lowest.risk) == ("Kaneko-Hayashi formula", RiskClass.LOW)
        assert reasons.startswith("PFA 0.165 g is 0.66 times g·B/H, above which rocking can start;")
        assert f"it still gives {100 * row.highest.value:.1f} %." in reasons
        assert "(F_f 1.13 Hz, above F_b 0.83 Hz): PFV is 22.7 cm/s, its median for such pieces 59.0 cm/s." in reasons


MODELS = (NEVER, PROBIT, ALWAYS)


@pytest.fixture(scope="module")
def with_models(example_inventory):
    return assess.run(example_inventory, UNVERIFIED, methods=[build_method(one, "m.toml") for one in MODELS])


def model_of(row):
    return next((one.method.key for one in (row.highest, row.lowest) if one.method.fitted), "")


def shown(group):
    return group.named, group.highest, group.lowest, list(group.reasons)


class TestFitted:
    def test_what_is_said_of_the_published_methods_comes_first_unchanged(self, with_models, example):
        (summary, plain), (said, more) = found(example), found(with_models)
        assert list(map(shown, more[: len(plain)])) == list(map(shown, plain))
        assert said.startswith(f"{summary} Counted separately: ")
        assert all(model_of(row) for group in more[len(plain) :] for row in group.rows)

    def test_every_row_on_which_one_differs_from_a_published_method_is_found_once(self, with_models):
        for model in MODELS:
            expected = []
            for row in with_models:
                own, others = classify(row.governing.methods[model.key].value), classes(with_models, row)
                if own is not None and max(abs(own - other) for other in others) > 1:
                    expected.append(row.item.item)
            rows = [row for row in rows_of(with_models) if model_of(row) == model.key]
            assert sorted(row.result.item.item for row in rows) == sorted(expected)
            assert all(sum(one.method.fitted is not None for one in (row.highest, row.lowest)) == 1 for row in rows)
            n = f"method on {len(expected):,} of 121 rows; most often "
            assert (f" differs by more than one class from a published {n}" in found(with_models)[0]) == bool(expected)
        assert any(model_of(row) for row in rows_of(with_models))
