import pytest

import assess
from tests.workbooks import write


@pytest.mark.parametrize("name", ["B*", "what?", "~1"])
def test_a_name_that_a_look_up_reads_as_a_pattern_is_warned_of(tmp_path, name):
    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": name, "breadth": 30, "height": 180}],
                 [{"floor": name, "pfa_x": 0.3}])  # fmt: skip
    (warning,) = [one for one in assess.read_inventory(path).problems if one.severity == "warning"]
    assert warning.place == "Floors!A2"
    assert f"Floor '{name}' holds *, ? or ~, which Excel's look-ups read as patterns." in warning.message
