"""What the reports say of floors without a motion of their own."""

import json

import jsonschema
import pytest

import assess
from assess.report.content import Content
from assess.report.data import SCHEMA
from assess.report.say.ground import describe_source
from tests.shaking import write_records
from tests.workbooks import UNVERIFIED as BY_FORMULA
from tests.workbooks import write

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

ITEMS = [{"item": f"i{floor}", "floor": floor, "breadth": 40, "height": 180} for floor in "1234"]
FLOORS = [
    {"floor": "1", "elevation": 3, "record_x": "slow.csv"},
    {"floor": "2", "elevation": 6},
    {"floor": "3", "elevation": 15, "record_x": "fast.csv", "record_y": "pulse.csv"},
    {"floor": "4", "elevation": 20, "pfa_x": 0.6, "pfv_x": 60, "pfa_y": 0.5},
    {"floor": "5", "elevation": 18},
]
PLACED = [{"floor": name, "elevation": z} for name, z in (("1", 0), ("2", 3), ("3", 12), ("4", 16))]
"""Floors of which only the elevation is known."""


def _reports(folder, scenario=None, formats=("json",), floors=FLOORS, **building):
    write_records(folder)
    path = write(folder / "w.xlsx", ITEMS, floors, **building)
    return assess.write_reports(assess.run(path, scenario=scenario, verify="none"), folder / "out", formats)


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    """Floors with records, with peaks, between two with records, and on a beam between a record and peaks."""
    return _reports(tmp_path_factory.mktemp("mixed"), ground_pga=0.25, height=20, period=1.0)


def _json(written):
    found = json.loads(written["json"].read_text(encoding="utf-8"))
    jsonschema.validate(found, json.loads(SCHEMA.read_text(encoding="utf-8")))
    return found


def test_json_holds_what_was_used_on_each_floor_and_axis(mixed):
    found = _json(mixed)
    demands = {(floor["floor"], one["axis"]): one for floor in found["floors"] for one in floor["demands"]}
    assert {place: one["source"] for place, one in demands.items()} == {
        ("1", "X"): "record", ("1", "Y"): "record", ("2", "X"): "interpolated", ("2", "Y"): "interpolated",
        ("3", "X"): "record", ("3", "Y"): "record", ("4", "X"): "given", ("4", "Y"): "given",
        ("5", "X"): "beam", ("5", "Y"): "beam",
    }  # fmt: skip
    lower, between, upper = (demands[floor, "X"] for floor in "123")  # 3 of 12 m from floor 1 to floor 3
    assert (between["between"], between["profile"], between["amplification"]) == (["1", "3"], None, None)
    for peak in ("pfa_g", "pfv_cm_s"):
        assert between[peak] == pytest.approx(0.75 * lower[peak] + 0.25 * upper[peak])
    assert {place: one["pfv_follows"] for place, one in demands.items()} == {
        place: place in {("4", "Y"), ("5", "X"), ("5", "Y")} for place in demands
    }
    assert {one["dispersion"] for one in demands.values()} == {0.4}, "as a floor has a record"
    sources = {item["item"]: item["pfa_source"] for item in found["items"]}
    assert sources == {"i1": "slow.csv", "i2": "interpolated between 1 and 3", "i3": "pulse.csv", "i4": "given"}
    assert "interpolated" in found["items"][1]["adopted"]["flags"]


@pytest.mark.slow
def test_json_of_floors_on_a_beam_by_hand(tmp_path):
    """Of the table of medians: T1 1 s, PGV/PGA 105 cm/s per g, z/h 0.6 PFA/PGA 1.505, PFV/PGV 1.814."""
    written = _reports(tmp_path, floors=PLACED, ground_pga=0.25, height=20, period=1.0)
    found = {floor["floor"]: floor["demands"][1] for floor in _json(written)["floors"]}
    ground, one = found["1"], found["3"]
    assert (ground["pfa_g"], ground["pfv_cm_s"], ground["amplification"]) == pytest.approx((0.25, 26.25, 1))
    assert (one["height_ratio"], one["amplification"]) == pytest.approx((0.6, 1.505))
    assert (one["pfa_g"], one["pfv_cm_s"]) == pytest.approx((0.25 * 1.505, 26.25 * 1.814), rel=1e-4)
    assert (one["pfv_follows"], one["dispersion"], one["flags"]) == (True, 0, ["drawn_building"])
    (label,) = {item["pfa_source"] for item in _json(written)["items"]}
    assert label == "Ground PGA, beam"


def test_above_1_g_a_drawn_building_is_said_to_stay_elastic(tmp_path):
    motions = _content(tmp_path, PLACED, ground_pga=0.65, height=20, period=1.0).run.motions
    said = {(one.floor, describe_source(one).partition(", ")[2]) for one in motions}
    assert said == {("1", ""), ("2", ""), ("3", ""), ("4", "if the building stays elastic")}


def _content(folder, floors, scenario=None, **building):
    write_records(folder)
    path = write(folder / "w.xlsx", ITEMS, floors, **building)
    return Content(assess.run(path, scenario=scenario, verify="none"))


def test_short_cautions_are_whole_however_many_floors_there_are(tmp_path):
    write_records(tmp_path, "slow")
    floors = [{"floor": f"F{at}", "elevation": 3 * at} | ({"record_x": "slow.csv"} if at in (0, 30) else {})
              for at in range(60)]  # fmt: skip
    items = [{"item": "i", "floor": "F0", "breadth": 30, "width": 40, "height": 100}]
    results = assess.run(write(tmp_path / "w.xlsx", items, floors), BY_FORMULA)
    short = [one.short for one in Content(results).cautions]
    text = "Floors F1, F2, F3, F4, F5, F6 and 23 more: interpolated between floors; it may be lower than the truth."
    assert text in short
    assert all(len(text) <= 130 and text.endswith(".") for text in short), short
    assert len(short) == len(set(short)) >= 2
