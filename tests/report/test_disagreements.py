"""Where methods disagree by more than one class: which rows, and whether the reasons are true of them."""

import itertools
import math

import pytest

from assess.report.say.methods import find_disagreements
from assess.risk import classify
from tests.workbooks import UNVERIFIED, assessed


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
