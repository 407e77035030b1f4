"""The page on generated motions is that of this version, and its figure can be drawn."""

import importlib.util
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from assess.motion.formats import read_records
from assess.motion.record import treat
from docs.ensemble_figures import draw_ensemble

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
LARGEST = (3, 4, 6, 8, 10)
"""Cells of a row of the page that differ from processor to processor."""
RECORD = "575 Market Street, 34th floor, 225°"


@pytest.fixture(scope="module")
def page():
    spec = importlib.util.spec_from_file_location("motions_page", ROOT / "docs" / "motions.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def generator(page):
    return page.build(treat(read_records(page.RECORDS[RECORD][0])[0]))


def test_the_page_is_up_to_date(page, generator):
    """One row is made again; on another kind of processor numbers differ a little, and the largest stands elsewhere."""
    text = (ROOT / "docs" / "motions.md").read_text(encoding="utf-8")
    kept = next(line for line in text.splitlines() if line.startswith(f"| {RECORD} "))
    across = page.build(treat(read_records(page.RECORDS[RECORD][0])[0]), axis="Y")
    made = page.row_of(RECORD, generator, across)
    assert _numbers(kept) == pytest.approx(_numbers(made), abs=0.35), "run: make docs"
    motions = {name: treat(read_records(path)[0]) for name, (path, _, _) in page.RECORDS.items()}
    assert "\n".join(page.lines_of_blind(motions)) in text, "run: make docs"


def _numbers(row):
    """Return the numbers of a row, but for the largest deviations and the period of the first."""
    cells = row.replace("%", "").replace(",", " ").split("|")[2:-1]
    cells = [cell for at, cell in enumerate(cells) if at not in LARGEST]
    return [float(number) for cell in cells for number in cell.split()]


def test_the_figure(generator):
    drawn = ET.fromstring(draw_ensemble(generator, "A $floor"))
    assert sum(1 for one in drawn.iter() if str(one.get("id", "")).startswith("axes_")) == 5
