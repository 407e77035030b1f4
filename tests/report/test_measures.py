"""Units of the reader: every quantity of a US report in in, ft, lb and in/s; files for other programs stay SI."""

import json
import re
from dataclasses import replace

import pytest

from assess.report import words
from assess.report.measures import reading, say, show, unit
from assess.report.say.work import say_cost, say_force
from tests.report.reading import read_text, write_html


def test_si_and_us():
    assert [say(45.72, "cm"), say(3.6576, "m"), say(0.2, "kN"), say(12.7, "cm/s"), say(40.4, "kg")] == [
        "45.7 cm", "3.66 m", "0.20 kN", "12.7 cm/s", "40 kg",
    ]  # fmt: skip
    with reading("US"):
        assert [say(45.72, "cm"), say(3.6576, "m"), say(0.2, "kN"), say(12.7, "cm/s"), say(40.4, "kg")] == [
            "18 in", "12 ft", "45 lb", "5.0 in/s", "89 lb",
        ]  # fmt: skip
        assert (unit("g"), unit("cm"), show(0.001, "kN"), show(0.0, "kN")) == ("g", "in", "< 1", "0")
        assert (say_force(None), say_force(20.0)) == (words.DASH, "4,496")
    assert (unit("cm"), say_force(0.001), say_force(0.0)) == ("cm", "< 0.01", "0.00")


def test_costs_name_their_currency():
    assert [say_cost(1530.0, "EUR"), say_cost(12.5, "USD"), say_cost(7.0), say_cost(None, "EUR")] == [
        "1,530\N{NO-BREAK SPACE}EUR", "12.50\N{NO-BREAK SPACE}USD", "7", words.DASH,
    ]  # fmt: skip


@pytest.mark.parametrize("units", ["SI", "US"])
def test_a_report_is_in_the_units_of_its_reader_and_results_json_in_si(example, tmp_path, units):
    results = replace(example, building=replace(example.building, report_units=units))
    text = read_text(write_html(results, tmp_path))
    metric, customary = (
        re.findall(r"(\d (?:kN|cm|m)|\[(?:kN|cm|m)\])(?![\w/²³]| inside)", text),
        re.findall(r"\[(?:in|lb)\]", text),
    )
    assert (bool(metric), bool(customary)) == (units == "SI", units == "US"), metric
    found = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert found["items"][0]["breadth_cm"] == example.item_rows[0].breadth_cm
