"""The worked example: 575 Market Street with its own records, as committed and as its script builds it."""

import importlib.util
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import formualizer
import openpyxl
import pytest

from assess.pipeline.live_values import live_values
from assess.pipeline.run import run
from assess.results import MAY_BE_LOWER
from assess.settings import Settings
from assess.units import GRAVITY
from assess.workbook.lists import PLACES, RUN_ASSESS
from assess.workbook.live_row import IS_ANCHORED
from assess.workbook.read import read_inventory
from assess.workbook.schema import CLASS, CLASS_OR, LIVE
from tests.workbooks import UNVERIFIED, write_sheets

FOLDER = Path(__file__).parents[1] / "inventories"
WORKBOOK = FOLDER / "market-street.xlsx"
# Treated PFA [cm/s2] of each channel, as the README of the records has it.
PFA = {"a": 218.1, "b": 181.4, "c": 133.3, "d": 151.2, "e": 147.6, "g": 184.1, "h": 218.4, "i": 161.8, "k": 132.8}
CHANNELS = {
    ("42", "X"): "ab", ("42", "Y"): "c", ("34", "X"): "de", ("34", "Y"): "de",
    ("25", "X"): "gh", ("25", "Y"): "i", ("G", "X"): "k", ("G", "Y"): "k",
}  # fmt: skip
BORROWED = {("34", "Y"), ("G", "X")}


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("market_street", FOLDER / "market_street.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["market_street"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules["market_street"]


def in_cm_s2(value_in_g: float) -> float:
    return value_in_g * GRAVITY * 100


def _cells(path):
    """Return every cell and formula of a workbook; its bytes depend on the version of XlsxWriter."""
    book = openpyxl.load_workbook(path)
    return {(page.title, cell.coordinate): cell.value for page in book for row in page for cell in row if cell.value}


@pytest.mark.slow
def test_the_script_builds_the_workbook_and_nothing_else(tmp_path, script):
    shutil.copytree(FOLDER / "records", tmp_path / "records")
    script.build(tmp_path / "again.xlsx")
    assert _cells(tmp_path / "again.xlsx") == _cells(WORKBOOK), "run: make blank"
    assert {path.name for path in tmp_path.iterdir()} == {"records", "again.xlsx"}


def test_each_floor_and_axis_has_the_motion_of_its_channels(example):
    for (floor, axis), channels in CHANNELS.items():
        motions = example.motions_of(floor, axis)
        assert [motion.record[-5] for motion in motions] == list(channels), (floor, axis)
        for motion in motions:
            assert in_cm_s2(motion.pfa_g) == pytest.approx(PFA[motion.record[-5]], abs=0.051), motion.record
            assert ("one_axis_only" in motion.flags) == ((floor, axis) in BORROWED), (floor, axis)


def test_stored_live_values_are_those_of_the_program_and_of_a_spreadsheet_engine(example_inventory):
    page = openpyxl.load_workbook(WORKBOOK, data_only=True)["Items"]
    book = formualizer.load_workbook(str(WORKBOOK))
    book.evaluate_all()
    for row, (item, values) in enumerate(zip(example_inventory.items, live_values(example_inventory), strict=True), 2):
        stored = [page.cell(row, PLACES["Items", label] + 1).value for label in LIVE]
        computed = [book.get_value("Items", row, PLACES["Items", label] + 1) for label in LIVE]
        assert [stored[0], computed[0]] == pytest.approx([values[0]] * 2, abs=1e-9, rel=0)
        words = dict.fromkeys(LIVE[1:], RUN_ASSESS)
        words |= dict.fromkeys((CLASS, CLASS_OR), IS_ANCHORED if item.anchored == "yes" else RUN_ASSESS)
        assert stored[1:] == computed[1:] == values[1:] == list(words.values())


# ------------------------------------------------------------------ as a scenario without sensors

RATIOS = {"42": 170.8 / 175, "34": 137.5 / 175, "25": 100 / 175, "G": 0}


@pytest.mark.slow
def test_without_its_records_it_runs_by_beams_or_by_the_profile_of_a_code(tmp_path, script):
    content = script.content()
    floors = [{name: row[name] for name in ("floor", "name", "elevation")} for row in content.rows["Floors"]]
    write_sheets(tmp_path / "no-records.xlsx", {**content.rows, "Floors": floors})
    inventory, pga = read_inventory(tmp_path / "no-records.xlsx"), 0.139
    beams = run(inventory, UNVERIFIED).motions
    for one in beams:
        assert (one.source, one.profile) == ("beam", None)
        assert one.height_ratio == pytest.approx(RATIOS[one.floor])
        assert one.pfa_g == pytest.approx(pga * one.amplification)
        assert one.pfa_g > pga if one.floor == "42" else one.floor != "G" or one.pfa_g == pytest.approx(pga)
    for one in run(inventory, replace(UNVERIFIED, scenario="ASCE 7-22")).motions:
        amplification = 1 + 2.5 * RATIOS[one.floor]
        assert (one.source, one.profile.key) == ("profile", "ASCE 7-22")
        assert (one.height_ratio, one.amplification) == pytest.approx((RATIOS[one.floor], amplification))
        assert one.pfa_g == pytest.approx(pga * amplification)


@pytest.mark.slow
def test_as_a_scenario_of_a_code_it_sets_its_records_aside(example_inventory):
    found = run(example_inventory, Settings(scenario="ASCE 7-22", verify="none"))
    assert {one.source for one in found.motions} == {"profile"}
    aside = [str(one) for one in found.problem_rows if "Record" in one.message]
    assert len(aside) == 6
    warned = [one.sheet for one in found.problem_rows if one.severity == "warning"]
    assert set(warned) == {"Items", "Places"}, "every profile value is above the recorded one; a room has no furniture"


@pytest.mark.slow
def test_interpolation_left_out_as_a_test_gives_less_than_was_recorded(example_inventory):
    """On the 25th floor along X, from G and the 34th: 132.8 + 100/137.5 x (151.2 - 132.8) = 146.2 cm/s2 = 0.149 g."""
    floors = tuple(replace(floor, records={}) if floor.floor == "25" else floor for floor in example_inventory.floors)
    (one,) = run(replace(example_inventory, floors=floors), UNVERIFIED).motions_of("25", "X")
    recorded = max(motion.pfa_g for motion in run(example_inventory, UNVERIFIED).motions_of("25", "X"))
    assert one.between == ("G", "34")
    assert f"it gives {one.pfa_g:.3f} g where {recorded:.3f} g was recorded" in MAY_BE_LOWER


@pytest.mark.slow
def test_a_floor_that_lost_its_record_is_interpolated(tmp_path, script):
    """The 34th floor lies (137.5 - 100)/(170.8 - 100) = 0.52966 of the way from the 25th to the 42nd."""
    content = script.content()
    floors = [row if row["floor"] != "34" else {"floor": "34", "elevation": 137.5} for row in content.rows["Floors"]]
    shutil.copytree(FOLDER / "records", tmp_path / "records")
    write_sheets(tmp_path / "lost.xlsx", {**content.rows, "Floors": floors})
    for scenario in ("as filled", "recorded"):
        found = run(read_inventory(tmp_path / "lost.xlsx"), Settings(scenario=scenario, verify="none"))
        (one,) = found.motions_of("34", "X")
        assert one.between == ("25", "42")
        assert in_cm_s2(one.pfa_g) == pytest.approx(218.4 + 0.52966 * (218.1 - 218.4), abs=0.06)
        (one,) = found.motions_of("34", "Y")
        assert in_cm_s2(one.pfa_g) == pytest.approx(161.8 + 0.52966 * (133.3 - 161.8), abs=0.06)


# ------------------------------------------------------------------ verified
