"""Kaneko and Hayashi's medians against a second source, and against another computation of equations (6) and (7)."""

import csv
from pathlib import Path

import pytest

from assess.methods import Cases
from assess.methods.expression import G
from assess.methods.kaneko_hayashi import METHOD
from assess.settings import Settings

FACTS = Path(__file__).parents[2] / "assess" / "studies" / "facts" / "kaneko_hayashi_median_pfa.csv"
with FACTS.open(encoding="utf-8") as file:
    ROWS = list(csv.DictReader(line for line in file if not line.startswith("#")))


def detail_of(breadth_cm: float, height_cm: float):
    return METHOD.evaluate(Cases.of(breadth=breadth_cm / 100, height=height_cm / 100, pfa=1.0), Settings()).detail


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["item"])
def test_published_median_accelerations_within_one_gal(row):
    # the source gives g B/H in gal; the height is of no matter to the acceleration
    height_cm = 180.0
    detail = detail_of(float(row["static_gal"]) / G * height_cm, height_cm)
    assert detail["median_pfa_g"][0] * G == pytest.approx(float(row["median_gal"]), abs=1.0)


# equations (6) and (7) for the nine pieces of FEMA P-58, computed apart from this package; the sizes, rounded to a
# millimetre, are good for 0.3 %
@pytest.mark.parametrize(
    ("breadth_cm", "height_cm", "median_pfa_g", "median_pfv_cm_s", "boundary_frequency_hz"),
    [
        (32.1, 73.7, 0.625, 92.2, 1.06),
        (32.1, 104.1, 0.403, 61.5, 1.02),
        (32.1, 142.2, 0.276, 44.7, 0.96),
        (32.1, 180.3, 0.209, 36.0, 0.91),
        (32.1, 206.4, 0.180, 32.0, 0.87),
        (38.1, 61.0, 1.016, 164, 0.96),
        (38.1, 132.1, 0.372, 62.5, 0.93),
        (47.2, 133.3, 0.480, 87.3, 0.86),
        (47.2, 172.1, 0.350, 66.0, 0.83),
    ],
)
def test_medians_computed_apart(breadth_cm, height_cm, median_pfa_g, median_pfv_cm_s, boundary_frequency_hz):
    detail = detail_of(breadth_cm, height_cm)
    assert detail["median_pfa_g"][0] == pytest.approx(median_pfa_g, rel=0.003, abs=0.001)
    assert detail["median_pfv_cm_s"][0] == pytest.approx(median_pfv_cm_s, rel=0.003)
    assert detail["boundary_frequency_hz"][0] == pytest.approx(boundary_frequency_hz, abs=0.006)
