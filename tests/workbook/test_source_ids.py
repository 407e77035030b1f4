"""A Source ID that two pieces share is warned of; GlobalIds that differ in capitals alone are two."""

from pathlib import Path

from assess.workbook.read import read_inventory
from tests.workbooks import write


def warnings(tmp_path: Path, *ids: str) -> list[str]:
    sizes = {"floor": "1", "breadth": 40, "height": 180}
    rows = [{"item": f"A{at}", "source_id": one, **sizes} for at, one in enumerate(ids, 1)]
    found = read_inventory(write(tmp_path / "a.xlsx", rows))
    return [str(one) for one in found.problems if "Source ID" in str(one)]


def test_a_copied_row_is_named(tmp_path):
    (told,) = warnings(tmp_path, "2OBrcmyk58NupXoVOHUuXp", "", "2OBrcmyk58NupXoVOHUuXp")
    assert told == (
        "Items!AA4: Source ID '2OBrcmyk58NupXoVOHUuXp' is that of row 2, too. Clear it where the row was copied: which "
        "of the two is in the model is not known."
    )


def test_capitals_count(tmp_path):
    assert warnings(tmp_path, "2OBrcmyk58NupXoVOHUuXp", "2oBrcmyk58NupXoVOHUuXp", "") == []
