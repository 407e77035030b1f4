"""FEMA P-58 contents: the closed form against the nine published medians."""

import csv
from pathlib import Path

import numpy as np
import pytest

from assess.methods import Cases
from assess.methods.fema_p58 import BETA, CHECKED_BREADTH_TO_HEIGHT, METHOD
from assess.settings import Settings

FACTS = Path(__file__).parents[2] / "assess" / "studies" / "facts" / "fema_p58_contents.csv"
with FACTS.open(encoding="utf-8") as file:
    ROWS = list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["fragility_id"])
def test_median_within_two_per_cent(row):
    breadth, height, published = (float(row[name]) for name in ("breadth_cm", "height_cm", "median_pfv_cm_s"))
    outcome = METHOD.evaluate(Cases.of(breadth=breadth / 100, height=height / 100, pfv=published / 100), Settings())
    assert outcome.detail["median_pfv_cm_s"][0] == pytest.approx(published, rel=0.02)
    assert outcome.value[0] == pytest.approx(0.5, abs=0.02)
    assert not outcome.flags["extrapolated"][0]


def test_dispersion_and_range_are_the_published_ones():
    assert len(ROWS) == 9
    assert {float(row["dispersion"]) for row in ROWS} == {BETA}
    ratios = np.array([float(row["breadth_cm"]) / float(row["height_cm"]) for row in ROWS])
    assert CHECKED_BREADTH_TO_HEIGHT.low == pytest.approx(ratios.min(), abs=0.001)
    assert CHECKED_BREADTH_TO_HEIGHT.high == pytest.approx(ratios.max(), abs=0.001)
