"""The mark of drafted routes: known in every language, warned of once a workbook, and gone when it is taken off."""

from pathlib import Path

import pytest

from assess.i18n import LANGUAGES, load_catalogue, speaking
from assess.workbook.draft_names import DRAFT, LONGEST, is_draft, mark_draft
from assess.workbook.read import read_inventory
from tests.workbook.books import Sheet, write

ITEMS = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Route"], ["A1", "1", 40, 180, None]]
PLACES = [["Place", "Floor", "X [m]", "Y [m]", "Kind"], ["Door", "1", 0, 0, "exit"], ["Hall", "1", 9, 0, "room"]]


def told(folder: Path, *routes: str) -> list[str]:
    rows: Sheet = [["Route", "Segment", "Floor", "From", "To", "Clear width [m]"]]
    rows += [[route, str(at), "1", "Hall", "Door", 1.2] for at, route in enumerate(routes)]
    found = read_inventory(write(folder, ITEMS, Places=PLACES, Routes=rows))
    return [f"{one.severity} {one}" for one in found.problems if "drafted" in one.message]


def test_drafted_routes_are_warned_of_once_and_a_long_name_keeps_the_mark(tmp_path):
    mend = "was drafted from a building model. Walk it, correct it, and take '(draft)' off its name."
    assert told(tmp_path, "To Exit A (draft)") == [f"warning Routes!A2: Route 'To Exit A (draft)' {mend}"]
    assert told(tmp_path, "Old", "To A (draft)", "To A (draft)", "to a (DRAFT)", "To B (draft)") == [
        "warning Routes!A3: 2 routes were drafted from a building model, such as 'To A (draft)'. "
        "Walk them, correct them, and take '(draft)' off their names."
    ]
    names = ["To A", "(draft) To A", "(draft) To (A)", "To A (draft) seen", "To A draft", "Draft"]
    assert not any(is_draft(name) for name in names)
    assert told(tmp_path, *names) == []
    name = mark_draft("word " * 40)
    assert len(name) <= LONGEST
    assert name.endswith("word wo (draft)")


@pytest.mark.parametrize("code", LANGUAGES)
def test_the_mark_is_known_in_every_language(tmp_path, code):
    catalogue = load_catalogue(code)
    with speaking(catalogue):
        name = mark_draft("To the street")
    assert name == f"To the street {catalogue.find(DRAFT)}"
    assert is_draft(name)
    assert len(told(tmp_path, name)) == 1
