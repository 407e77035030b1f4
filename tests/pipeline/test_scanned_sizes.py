"""Pieces whose sizes were measured by a scan: drawn wider than others, which stay as they were, and reported so."""

import csv
import io
import json

import numpy as np
import pytest

import assess
from assess.pipeline.piece_fragility import find_piece_fragilities
from assess.pipeline.run import compute
from assess.report.findings.uncertain import count_scanned, say_assumed
from assess.settings import Settings
from assess.units import GRAVITY
from assess.workbook.template import Content, write_workbook
from tests.report.reading import read_text, write_html

SETTINGS = Settings(verify="all", runs=200, seed=2)
FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 45, "pfa_y": 0.3, "pfv_y": 45}]
NAMES = ("one", "two", "three", "four")
"""Four pieces of about one size: no two are alike, so that each has a chance of its own."""
LEVELS = [one * GRAVITY for one in (0.2, 0.25, 0.3, 0.4, 0.6, 0.9)]


def pieces(*scanned, **more):
    return [
        {"item": name, "floor": "1", "breadth": 45 + at / 100, "width": 90, "height": 180, "axis": "X", **more}
        | ({"sizes_from": "scan"} if name in scanned else {})
        for at, name in enumerate(NAMES)
    ]


def read(folder, items, **building):
    rows = {"Building": [{"period": 0.8} | building], "Floors": FLOORS, "Items": items}
    write_workbook(folder / "w.xlsx", Content(rows=rows))
    return assess.read_inventory(folder / "w.xlsx")


def run(folder, items, settings=SETTINGS, **building):
    return assess.run(read(folder, items, **building), settings, figures=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scanned")


@pytest.fixture(scope="module")
def measured(folder):
    return run(folder, pieces())


@pytest.fixture(scope="module")
def mixed(folder):
    return run(folder, pieces("two"))


def simulated(results):
    return {one.item.item: one.governing.simulation for one in results}


def test_the_draws_of_others_do_not_change(measured, mixed):
    before, after = simulated(measured), simulated(mixed)
    assert [name for name in NAMES if before[name] != after[name]] == ["two"]
    assert before["two"].ideal == after["two"].ideal, "as given it is the same piece"


def test_a_model_counts_as_measured(measured, folder):
    assert simulated(run(folder, pieces(sizes_from="model"))) == simulated(measured)


def test_certain_pieces_do_not_vary_by_a_scan_either(folder):
    every = [run(folder, items, piece_uncertainty="no") for items in (pieces(), pieces(*NAMES))]
    assert simulated(every[0]) == simulated(every[1])


def curves(folder, items):
    found = find_piece_fragilities(
        compute(read(folder, items), Settings(verify="none", runs=400, seed=2)), levels=LEVELS
    )
    return np.sum([one.curve.fallen for one in found.curves], axis=0), found.curves


def test_the_curve_of_a_scanned_piece_is_wider(folder):
    """More fall where few do, fewer where most do: under motions that differ by their phases alone."""
    usual, (first, *_) = curves(folder, pieces())
    wide, (scanned, *_) = curves(folder, pieces(*NAMES))
    low, high = int(np.argmax(usual > 0)), -1
    assert wide[low] > usual[low] > 0
    assert wide[high] < usual[high]
    assert scanned.curve.dispersion > first.curve.dispersion


def test_its_curve_begins_lower(folder):
    """Its most slender draws start to rock at a lower level; the first level is found by that."""
    starts = []
    for items in (pieces(), pieces(*NAMES)):
        found = find_piece_fragilities(compute(read(folder, items), Settings(verify="none", runs=40, seed=2)))
        starts.append(found.curves[0].curve.levels[0])
    assert starts[1] < starts[0]


def test_a_weak_floor_may_rock_it(folder):
    """0.65 of B/H 0.25 is 0.1625 g; 0.0458 g times 3.48 is 0.159 g, times 3.60, as sizes are less certain, 0.165 g."""
    floors = [{"floor": "1", "pfa_x": 0.0458, "pfa_y": 0.0458}]
    building = [{"motion_uncertainty": 0.4}]
    write_workbook(folder / "weak.xlsx", Content(rows={"Building": building, "Floors": floors, "Items": pieces("two")}))
    found = assess.run(assess.read_inventory(folder / "weak.xlsx"), Settings(verify="none"), figures=False)
    assert [one.adopted.can_rock for one in found] == [False, True, False, False]


# --- what is reported ---


@pytest.fixture(scope="module")
def written(mixed, tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return {path.name: path for path in assess.write_reports(mixed, out, formats=("json", "csv")).values()}


def test_data_tell_where_sizes_come_from(written):
    found = json.loads(written["results.json"].read_text(encoding="utf-8"))
    assert [one["sizes_from"] for one in found["items"]] == ["measured", "scan", "measured", "measured"]
    rows = list(csv.DictReader(io.StringIO(written["items.csv"].read_text(encoding="utf-8-sig"))))
    assert [one["sizes_from"] for one in rows] == ["measured", "scan", "measured", "measured"]


def test_the_report_tells_it(mixed, measured, tmp_path):
    text = read_text(write_html(mixed, tmp_path))
    assert "Those of 1 piece were measured by a scan, which is less accurate: its sizes are varied more." in text
    assert text.count("sizes measured by scan") == 1, "in the row of the piece"
    assert "draws its base × N(0.97, 0.1) and its height × N(1, 0.05)" in text
    plain = read_text(write_html(measured, tmp_path))
    assert "which is less accurate: its sizes" not in plain
    assert "sizes measured by scan" not in plain


def test_pieces_are_counted_by_quantity(folder):
    items = [*pieces()[:2], *pieces("three", quantity=5)[2:3]]
    found = run(folder, items)
    assert count_scanned(found) == 5
    assert "Those of 5 pieces were measured by a scan" in say_assumed(found)
    certain = run(folder, items, piece_uncertainty="no")
    assert "exactly as given. Those of 5 pieces were measured by a scan, which is less accurate" in say_assumed(certain)


# --- the column ---


@pytest.mark.parametrize(
    ("typed", "message"), [("scam", "Did you mean scan"), ("laser", "expected one of: measured, model, scan")]
)
def test_another_word_is_an_error_of_its_cell(folder, typed, message):
    with pytest.raises(assess.WorkbookError, match=message) as raised:
        read(folder, pieces(sizes_from=typed)[:1])
    (error,) = [one for one in raised.value.problems if one.severity == "error"]
    assert error.message.startswith(f"Sizes from is '{typed}'")


def test_blank_is_measured(folder):
    inventory = read(folder, [*pieces()[:1], *pieces(sizes_from=" Scan ")[1:2]])
    assert [one.sizes_from for one in inventory.items] == ["measured", "scan"]
    assert inventory.frame()["sizes_from"].tolist() == ["measured", "scan"]
