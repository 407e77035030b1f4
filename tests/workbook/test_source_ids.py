"""A Source ID that two pieces share is warned of; GlobalIds that differ in capitals alone are two."""

from assess.workbook.read import read_inventory
from tests.workbooks import write


def test_a_copied_row_is_named_and_capitals_count(tmp_path):
    ids = ["2OBrcmyk58NupXoVOHUuXp", "", "2oBrcmyk58NupXoVOHUuXp", "2OBrcmyk58NupXoVOHUuXp", ""]
    sizes = {"floor": "1", "breadth": 40, "height": 180}
    rows = [{"item": f"A{at}", "source_id": one, **sizes} for at, one in enumerate(ids)]
    problems = read_inventory(write(tmp_path / "a.xlsx", rows)).problems
    assert [str(one) for one in problems if "Source ID" in str(one)] == [
        "Items!AA5: Source ID '2OBrcmyk58NupXoVOHUuXp' is that of row 2, too. Clear it where the row was copied: which "
        "of the two is in the model is not known."
    ]
