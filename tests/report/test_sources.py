"""What a signed report rests on: every source can be cited, and what has none is marked assumed beside the value."""

import re

from assess.details import DETAILS
from assess.methods import all_methods
from assess.motion.scenario import PROFILES, UNVERIFIED
from assess.pipeline.anchors import DENSITIES
from assess.report.statements import list_assumptions
from assess.routes.widths import RULES
from tests.workbooks import assessed

VAGUE = re.compile(
    r"general knowledge|at hand|not to hand|second.hand|safety sites|to be (checked|verified)|\bshop", re.I
)


def list_sources() -> list[str]:
    """Every text that says where a number comes from."""
    return [
        *(str(method.reference) for method in all_methods()),
        *(f"{one.reference} {one.remark}" for one in PROFILES.values()),
        *(str(rule.reference) for rule in RULES),
        *(str(one.source) for one in DENSITIES.values()),
        *(str(text) for one in DETAILS.values() for text in (one.what, one.weakness, one.source, one.fixing)),
    ]


def test_no_source_is_vague():
    assert len(list_sources()) > 20
    assert not [one for one in list_sources() if VAGUE.search(one)]
    assert UNVERIFIED.startswith("assumed")


def test_what_was_not_compared_with_its_publication_is_marked_assumed():
    texts = [one for one in list_sources() if "not compared" in one]
    assert len(texts) >= 3
    assert all("Assumed: " in one for one in texts)


def test_a_detail_without_a_source_says_so():
    for one in DETAILS.values():
        assert re.search(r"\d{4}|Alliance|assumed", str(one.source)), one.key
        assert one.capacity is None or "kN" in str(one.fixing)


def test_assumed_sizes_weights_and_brackets_are_counted_in_the_assumptions(tmp_path):
    """A4 has a type whose size nobody prints, A5 one of FEMA P-58; A6 has its own size and weight."""
    size = {"breadth": 40, "width": 80, "height": 180}
    items = [
        {"item": "A4", "floor": "1", "type": "Desk"},
        {"item": "A5", "floor": "1", "type": "Bookcase 5 shelves"},
        {"item": "A6", "floor": "1", "type": "Desk", **size, "weight": 90, "bracket_height": 150},
        {"item": "A7", "floor": "1", **size},
    ]
    results = assessed(tmp_path / "w.xlsx", items)
    lines = dict(list_assumptions(results))
    assert lines["Sizes by Type in 1 row"] == "assumed: usual sizes, no citable source"
    assert lines["Weight unknown in 3 rows"].startswith("estimated for forces on brackets")
    assert lines["Bracket height unknown in 3 rows"] == "assumed: 90 % of the height of the piece"
    weights = {one.item: str(one.anchor.weight_words) for one in results.item_rows}
    assert weights["A4"] == "estimated: 80 kg/m³, open furniture (assumed)"
    assert weights["A5"] == "estimated: 430 kg/m³, books and files (Krakower 2000, library shelving full of books)"
    assert weights["A6"] == "as the workbook gives it"
    assert weights["A7"].startswith("estimated: 430 kg/m³, assumed to be full of books and files (")
