"""The ways to fix: each with a drawing that has no text, and fixings by the kind of wall in both systems of units."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from assess.details import ALTERNATIVES, DETAILS, FIX_BY, WALLS, WHO, count_fixings, find_detail, says_castors
from assess.units import FORCE

DRAWINGS = Path(__file__).resolve().parents[1] / "templates" / "details"


def test_every_detail_has_a_drawing_of_one_size_without_text_and_no_drawing_is_left_over():
    wanted = {one.drawing for one in DETAILS.values() if one.drawing}
    assert wanted == {path.name for path in DRAWINGS.iterdir()}
    assert len(wanted) >= 8
    for name in wanted:
        root = ElementTree.parse(DRAWINGS / name).getroot()
        tags = {one.tag.rpartition("}")[2] for one in root.iter()}
        assert root.get("viewBox") == "0 0 60 45", name
        assert tags <= {"svg", "g", "path", "circle", "ellipse"}, name
        colours = set(re.findall(r"#\w+", (DRAWINGS / name).read_text(encoding="utf-8")))
        assert colours <= {"#1c1c1c", "#9a9a9a", "#fff"}, name


def test_only_capacities_that_a_source_prints_count_and_nothing_is_counted_where_nothing_is_drilled():
    assert {wall for wall, one in WALLS.items() if one.capacity is not None} == {"studs"}
    assert WALLS["studs"].capacity == pytest.approx(192 * FORCE["lbf"])
    assert count_fixings(DETAILS["bracket"], 2000) == 3
    assert count_fixings(DETAILS["base_angle"], 2000) == 2
    assert {key for key, one in DETAILS.items() if not one.least} == {"castors", "maker", "clear", "check"}
    assert {one.who for one in DETAILS.values()} <= WHO.keys()
    for one in DETAILS.values():
        texts = {str(one.say_fixing(wall, us=us)) for wall in WALLS for us in (False, True)}
        assert len(texts) == (6 if one.is_at_wall else 1), one.key
        assert one.hours > 0
        assert one.capacity is None or "kN" in str(one.say_fixing())


def test_the_catalogue_offers_every_way_but_alternatives_and_what_is_done_to_anchors():
    assert {*FIX_BY.values()} == DETAILS.keys() - {*ALTERNATIVES, "check", "complete"}
    assert find_detail("Chains round the cylinder") is DETAILS["chain"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("On castors; stands in the way", True), ("Linen trolley", True), ("su ruote", True), ("CARRELLO", True),
        ("Roller-shutter cabinet", False), ("cartons of paper", False), ("Steering wheel rack", False),
    ],
)  # fmt: skip
def test_words_for_castors_are_whole_words(text, says):
    assert says_castors(text) is says
