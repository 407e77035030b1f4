"""What a firm's report says of its survey, its units and its code: read from Building and Text, every fault at a cell."""

import pytest

from assess.errors import WorkbookError
from tests.workbook.books import ITEMS, Sheet, read

BUILDING: Sheet = [
    ["Building", "Town hall"], ["Survey date", "3 March 2026"], ["Surveyed by", "A. Rossi"],
    ["Extent", "Floors 1 and 2"], ["Rooms not entered", "Archive: locked"], ["Level of investigation", 0],
    ["Documents reviewed", "Plans of 1998"], ["Purpose and reliance", "For the owner alone"],
    ["Licence", "ABC 1"], ["Project number", 1027],
]  # fmt: skip


def test_the_survey_is_read(tmp_path):
    found = read(tmp_path, Building=BUILDING).building
    assert (found.survey_date, found.investigation_level, found.project_number) == ("2026-03-03", "0", "1027")
    assert (found.surveyed_by, found.rooms_not_entered) == ("A. Rossi", "Archive: locked")
    assert (found.documents, found.purpose) == ("Plans of 1998", "For the owner alone")


def test_texts_are_kept_in_their_order_as_they_are_typed(tmp_path):
    rows: Sheet = [
        ["What to fix", "Start in the archive."],
        [None, "+2 <b>shelves</b>\nare new."],
        ["ways out", "Two."],
    ]
    found = read(tmp_path, Text=[["Section", "Text"], *rows])
    assert [(one.section, one.text) for one in found.texts] == [
        ("What to fix", "Start in the archive."), ("Summary", "+2 <b>shelves</b>\nare new."), ("Ways out", "Two."),
    ]  # fmt: skip
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, Text=[["Section", "Text"], ["Annex", "Long."], ["Limits", None]])
    assert [(one.cell, str(one.message)) for one in caught.value.problems] == [
        ("A2", "Section is 'Annex', expected one of: Summary, What to believe, What to fix, Ways out, Floors, Limits."),
        ("B3", "Text is blank."),
    ]


@pytest.mark.parametrize(
    ("unit", "line", "expected"),
    [("cm", None, "SI"), ("in", None, "US"), ("in", "SI", "SI"), ("cm", "US", "US"), ("ft", "workbook's", "US")],
)
def test_units_of_reports_are_the_chosen_or_those_of_the_sizes(tmp_path, unit, line, expected):
    sizes = {"cm": (40, 180), "in": (16, 70), "ft": (1.3, 6)}[unit]
    items: Sheet = [["Item", "Floor", f"Breadth [{unit}]", f"Height [{unit}]"], ["A1", "1", *sizes]]
    found = read(tmp_path, items, Building=[["Building", "Hall"], *([["Report units", line]] if line else [])])
    assert found.building.report_units == expected


def test_a_code_of_anchors_needs_a_ground_motion(tmp_path):
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, Building=[["Building", "Hall"], ["Code of anchors", "EN 1998-1"]])
    (problem,) = caught.value.problems
    assert (problem.sheet, problem.cell) == ("Building", "B2")
    assert str(problem.message) == (
        "Code of anchors is EN 1998-1, but no ground motion is known to which the code applies."
    )
    assert str(problem.fix) == "Fill in SDS or Ground PGA, or clear Code of anchors."
    for line in (["SDS [g]", 1], ["Ground PGA [g]", 0.2], ["Shaking", "MMI VII, very strong"]):
        found = read(tmp_path, ITEMS, Building=[["Code of anchors", "en 1998-1"], line])
        assert found.building.anchor_code == "EN 1998-1"
