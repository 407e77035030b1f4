"""Japanese rule against the published table of the smallest breadth that needs no fixing."""

import csv
import math
from pathlib import Path

import pytest

from assess.methods import Cases
from assess.methods.japan_rule import LIMIT, METHOD
from assess.settings import Settings

FACTS = Path(__file__).parents[2] / "assess" / "studies" / "facts" / "japan_rule.csv"
with FACTS.open(encoding="utf-8") as file:
    ROWS = list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['height_cm']} cm")
def test_five_sizes_to_a_millimetre(row):
    height_cm, breadth_cm = float(row["height_cm"]), float(row["breadth_cm"])
    assert round(LIMIT * math.sqrt(height_cm), 1) == breadth_cm
    around = Cases.of(breadth=[(breadth_cm - 0.1) / 100, (breadth_cm + 0.1) / 100], height=height_cm / 100)
    assert METHOD.evaluate(around, Settings()).value.tolist() == [1, 0]
