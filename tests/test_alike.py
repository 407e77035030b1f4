import pytest

from tests.alike import differences, flatten


@pytest.mark.parametrize(
    ("now", "then"),
    [
        ("it rises in 4, by at most 1.", "it rises in 3, by at most 1."),
        ("94.5 % (90.4 to 96.9 %)", "95.5 % (91.7 to 97.6 %)"),
        ("risk 0.945, 13,005 cases, -1.2e-06", "risk 0.955, 13,004 cases, -1.3e-06"),
    ],
)
def test_numbers_within_their_error_are_alike(now, then):
    assert differences([now], [then]) == []


@pytest.mark.parametrize(
    ("now", "then"),
    [
        ("it rises in 30", "it rises in 3"),
        ("it falls in 3", "it rises in 3"),
        ("4.0 %", "14.0 %"),
        ("risk 0.94", "risk 0.04"),
        ("13,005 cases", "1,305 cases"),
        ("HN2.NP.RS", "HN3.NP.RS"),
        ("1 of 2", "1 of"),
    ],
)
def test_other_words_and_numbers_are_reported(now, then):
    assert differences(["same", now], ["same", then]) == [f"{now!r}, expected {then!r}"]


def test_missing_lines_are_reported():
    assert differences(["one"], ["one", "two"]) == ["1 lines, expected 2"]


def test_values_are_found_with_their_places():
    assert dict(flatten({"a": [1, {"b": None}]})) == {"/a/0": 1, "/a/1/b": None}
