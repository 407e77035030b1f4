"""Numbers and sentences of the reports: none contradicts the class, the counts, or another report."""

from assess.report import words
from assess.risk import LIMITS, classify


def test_a_percentage_never_contradicts_its_class_and_has_its_interval_where_that_says_more():
    for value, text in (
        (0.6998, "69.98 %"), (0.69996, "69.996 %"), (0.7, "70.0 %"), (0.7001, "70.0 %"), (0.2997, "29.97 %"),
        (0.02996, "2.996 %"), (0.03, "3.0 %"), (0.0304, "3.0 %"), (0.699, "69.9 %"), (0.0, "0.0 %"), (1.0, "100.0 %"),
        (0.9999, "100.0 %"), (0.7 - 1e-12, "69.999999 %"), (None, "–"),
    ):  # fmt: skip
        assert words.percent(value) == text, (value, text)
    for chance, text in (
        ((0.03, 0.01, 0.085), "3.0 % (1.0\xa0to\xa08.5\xa0%)"), ((0.03, None, None), "3.0 %"), ((0.03,), "3.0 %"),
        ((1.0, 0.99999, 1.0), "100.0 %"), ((None, None, None), "–"),
    ):  # fmt: skip
        assert words.say_chance(*chance) == text, (chance, text)


def test_names_in_a_row_are_joined_as_many_as_there_is_room_for_and_the_mark_of_a_draft_is_never_cut():
    for names, runs in (
        (["25-07", "25-08", "25-09"], ["25-07 to 25-09"]),
        (["A9", "A10", "A11", "B12", "B14"], ["A9 to A11", "B12", "B14"]),
        (["S08", "S9", "S10", "S11"], ["S08", "S9 to S11"]),
        (["A09", "A10", "A11"], ["A09 to A11"]),
        (["A1", "A2", "a very long name"], ["A1", "A2", "a very…"]),
        (["Bookcase 1", "Bookcase 2", "Bookcase 3"], ["Bookcas…"] * 3),
        (["Safe", "Safe 1"], ["Safe", "Safe 1"]),
        ([], []),
    ):
        assert words.join_runs(names, 8) == runs, (names, runs)
    names = ["25-01", "25-02", "25-03", "25-07", "25-08", "25-09", "25-31"]
    assert words.fit_pieces(names, 40) == "25-01 to 25-03, 25-07 to 25-09, 25-31"
    assert words.fit_pieces(names, 28) == "25-01 to 25-03 and 4 more"
    assert words.fit_pieces(names, 10) == "25-01 to 25-03 and 4 more"  # one at least
    assert words.fit_pieces(["Bookcase by the window"], 10) == "Bookcase…"
    assert words.fit_pieces([], 10) == ""
    for limit in LIMITS:
        for power in range(1, 17):
            value = limit - 10.0**-power
            if value >= 0:
                assert classify(float(words.percent(value)[:-2]) / 100) == classify(value), value
    for text, longest, shown in (
        ("To Stair Level 2, head (draft)", 40, "To Stair Level 2, head (draft)"),
        ("To Stair Level 2, head (draft)", 26, "To Stair Level 2,… (draft)"),
        ("To Stair Level 2, head (bozza)", 26, "To Stair Level 2,… (bozza)"),
        ("To Stair Level 2, head (east)", 26, "To Stair Level 2, head (e…"),
        ("a (draft)", 4, "a… (draft)"),
    ):
        assert words.cut(text, longest) == shown, (text, longest)
