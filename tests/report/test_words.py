"""Numbers and sentences of the reports: none contradicts the class, the counts, or another report."""

import re
from dataclasses import replace

import pytest

from assess.i18n import Catalogue, speaking
from assess.report import words
from assess.report.counts import count
from assess.report.figures.bars import draw_bars
from assess.report.say.route import name_few
from assess.report.sections.summary import say_plainly
from assess.report.statements import list_assumptions
from assess.risk import LIMITS, RiskClass, classify
from tests.report.reading import write_html
from tests.workbooks import ITEMS, assessed

FLOORS = [{"floor": "1", "pfa_x": 0.4, "pfv_x": 40, "pfa_y": 0.4, "pfv_y": 40}]
PIECE = {"item": "a", "floor": "1", "breadth": 30, "width": 80, "height": 200}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.6998, "69.98 %"), (0.69996, "69.996 %"), (0.7, "70.0 %"), (0.7001, "70.0 %"), (0.2997, "29.97 %"),
        (0.02996, "2.996 %"), (0.03, "3.0 %"), (0.0304, "3.0 %"), (0.699, "69.9 %"), (0.0, "0.0 %"), (1.0, "100.0 %"),
        (0.9999, "100.0 %"), (0.7 - 1e-12, "69.999999 %"), (None, "–"),
    ],
)  # fmt: skip
def test_a_percentage_never_contradicts_its_class(value, text):
    assert words.percent(value) == text


@pytest.mark.parametrize(
    ("chance", "text"),
    [
        ((0.03, 0.01, 0.085), "3.0 % (1.0\xa0to\xa08.5\xa0%)"),
        ((0.03, None, None), "3.0 %"),
        ((0.03,), "3.0 %"),
        ((1.0, 0.99999, 1.0), "100.0 %"),
        ((None, None, None), "–"),
    ],
)
def test_a_chance_has_its_interval_where_that_says_more(chance, text):
    assert words.say_chance(*chance) == text


@pytest.mark.parametrize(
    ("names", "runs"),
    [
        (["25-07", "25-08", "25-09"], ["25-07 to 25-09"]),
        (["A9", "A10", "A11", "B12", "B14"], ["A9 to A11", "B12", "B14"]),
        (["S08", "S9", "S10", "S11"], ["S08", "S9 to S11"]),
        (["A09", "A10", "A11"], ["A09 to A11"]),
        (["A1", "A2", "a very long name"], ["A1", "A2", "a very…"]),
        (["Bookcase 1", "Bookcase 2", "Bookcase 3"], ["Bookcas…"] * 3),
        (["Safe", "Safe 1"], ["Safe", "Safe 1"]),
        ([], []),
    ],
)
def test_names_in_a_row_are_joined(names, runs):
    assert words.join_runs(names, 8) == runs


def test_pieces_that_are_not_named_are_counted_one_by_one():
    names = ["A1", "A2", "A3", "B1", "C1", "C2", "C3", "C4", "D1"]
    assert words.name_pieces(names, 2) == "A1 to A3, B1 and 5 more"
    assert words.name_pieces(names, 4) == "A1 to A3, B1, C1 to C4, D1"


def test_as_many_pieces_are_named_as_there_is_room_for():
    names = ["25-01", "25-02", "25-03", "25-07", "25-08", "25-09", "25-31"]
    assert words.fit_pieces(names, 40) == "25-01 to 25-03, 25-07 to 25-09, 25-31"
    assert words.fit_pieces(names, 28) == "25-01 to 25-03 and 4 more"
    assert words.fit_pieces(names, 10) == "25-01 to 25-03 and 4 more"  # one at least
    assert words.fit_pieces(["Bookcase by the window"], 10) == "Bookcase…"
    assert words.fit_pieces([], 10) == ""


def test_that_holds_beside_every_limit():
    for limit in LIMITS:
        for power in range(1, 17):
            value = limit - 10.0**-power
            if value >= 0:
                assert classify(float(words.percent(value)[:-2]) / 100) == classify(value), value


@pytest.mark.parametrize(
    ("length", "shown", "in_m"),
    [
        (30.48, "30.5", "30.48"), (350.0, "350", "350"), (0.0, "0", "0"), (-0.001, "0", "0"),
        (1828.8, "1828.8", "1828.8"), (None, "–", "–"),
    ],
)  # fmt: skip
def test_lengths_have_no_needless_decimals(length, shown, in_m):
    assert (words.in_cm(length), words.in_m(length)) == (shown, in_m)


def test_numbers_are_those_of_the_language():
    with speaking(Catalogue("xx", {}, decimal=",", group=".")):
        assert (words.percent(0.0316), words.fixed(1.25, 2), words.in_g(1.0)) == ("3,2 %", "1,25", "1,000")
        assert (words.in_m(3.5), words.in_cm(30.5), words.in_cm_s(50.0)) == ("3,5", "30,5", "50,0")
        assert (words.plural(1200, "row"), words.percent(None)) == ("1.200 rows", "–")


@pytest.mark.parametrize(
    ("very_high", "high", "low", "could_be", "text"),
    [
        (0, 0, 1, 0, "The 1 free-standing piece has no high or very high chance of overturning in this scenario."),
        (0, 0, 5, 2, "Of 5 free-standing pieces, 0 to 2 have a high or very high chance of overturning, 0 a very "
                     "high one."),
        (1, 0, 0, 0, "The one free-standing piece has a very high chance of overturning in this scenario."),
        (1, 3, 4, 1, "Of 8 free-standing pieces, 4 to 5 have a high or very high chance of overturning, 1 a very "
                     "high one."),
    ],
)  # fmt: skip
def test_the_first_sentence_for_none_one_and_many(very_high, high, low, could_be, text):
    by_class = dict(zip(reversed(RiskClass), (very_high, high, 0, low), strict=True))
    risky = very_high + high
    counts = replace(count("all", []), by_class=by_class, spans={}, risky_span=(risky, risky + could_be))
    assert " ".join(say_plainly(counts, [], [])) == text


def test_pieces_that_cannot_rock_are_counted_and_told(tmp_path):
    """On the formulas alone; 36 x 144 starts at 0.25 g, and 0.03 g times 4.3 is below 0.65 of that."""
    items = [PIECE | {"item": "stocky", "breadth": 145, "width": 145, "height": 100, "quantity": 2},
             PIECE | {"item": "still", "floor": "2", "breadth": 36, "height": 144},
             PIECE | {"item": "thin"},
             PIECE | {"item": "held", "breadth": 145, "width": 145, "height": 100, "anchored": "yes"}]  # fmt: skip
    floors = [{"floor": "1", "pfa_x": 0.24, "pfv_x": 35}, {"floor": "2", "pfa_x": 0.03}]
    counts = count("", list(assessed(tmp_path / "w.xlsx", items, floors)))
    assert (counts.cannot_rock, counts.by_class[RiskClass.LOW], counts.anchored) == (3, 3, 1)
    assert counts.say_cannot_rock() == [
        "3 pieces cannot rock: they are too stocky, or not even the strongest motion that may be drawn can start them. "
        "Their class is low, whatever a formula says."
    ]


def test_bars_show_every_piece_in_proportion(tmp_path):
    counts = count("1", list(assessed(tmp_path / "w.xlsx")))
    found = draw_bars([counts, count("empty", []), count("left out", [])], "Bars", most=2)
    assert found
    drawn, left_out = found
    widths = [float(width) for width in re.findall(' width="([^"]+)" height', drawn.source)]
    pieces = [int(text.split()[-1]) for text in re.findall(">([^<>]+)</text>", drawn.source)[1:-1]]
    assert (sum(pieces), left_out) == (counts.total, 0)
    assert [width / sum(widths) for width in widths] == pytest.approx([n / sum(pieces) for n in pieces], abs=1e-3)
    cut = draw_bars([counts] * 3, "Bars", most=2)
    assert cut
    assert cut[1] == 1
    assert draw_bars([], "Bars") is None


@pytest.mark.slow
def test_without_pieces_nothing_is_said_of_them(tmp_path):
    results = assessed(tmp_path / "w.xlsx", [])
    assert not [name for name, _ in list_assumptions(results) if name.startswith(("Axis unknown", "Friction"))]
    page = write_html(results, tmp_path)
    assert ("Raw: as printed" in page, "There are no free-standing pieces." in page) == (False, True)
    assert (results.worked_item, results.worked) == (None, ())


@pytest.mark.slow
def test_long_names_are_cut_without_a_remark_where_there_is_no_room(tmp_path):
    long = "N" * 300
    items = [PIECE | {"item": long, "room": long, "description": long}]
    html = write_html(assessed(tmp_path / "w.xlsx", items, [FLOORS[0] | {"name": long}]), tmp_path)
    assert "whole in report.xlsx" not in html


@pytest.mark.parametrize(
    ("text", "longest", "shown"),
    [
        ("To Stair Level 2, head (draft)", 40, "To Stair Level 2, head (draft)"),
        ("To Stair Level 2, head (draft)", 26, "To Stair Level 2,… (draft)"),
        ("To Stair Level 2, head (bozza)", 26, "To Stair Level 2,… (bozza)"),
        ("To Stair Level 2, head (east)", 26, "To Stair Level 2, head (e…"),
        ("a (draft)", 4, "a… (draft)"),
    ],
)
def test_the_mark_of_a_draft_is_never_cut(text, longest, shown):
    assert words.cut(text, longest) == shown


def test_nor_is_it_in_front_of_a_segment():
    named = name_few(["To Stair Level 2, head of the main staircase (draft): 17"])
    assert named == "To Stair Level 2, hea… (draft): 17"


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", [""]),
        ("Electrocardiograph on a trolley", ["Electrocardiograph on a trolley"]),
        ("Second-PHYS-14-12-Gastroenterology", ["Second-PHYS-14-12-Gastroenterology"]),
        ("Electroencephalograph", ["Electroence", "phalograph"]),
        ("a Supercalifragilisticexpialidocious-wing", ["a Supercalifragilis", "ticexpialidocious-wing"]),
    ],
)
def test_only_long_words_have_places_to_break_at(text, parts):
    assert words.list_breaks(text) == parts
    assert "".join(words.list_breaks(text)) == text


# ---------------------------------------------------------------- the worked example


def test_the_worst_free_standing_piece_is_worked_by_every_method(tmp_path):
    found = assessed(tmp_path / "w.xlsx")
    example = list(found)[found.worked_item or 0]
    assert example.adopted.upper == max(one.adopted.upper for one in found if not one.is_anchored)
    assert not example.is_anchored
    methods = example.governing.methods
    assert [one.key for one in found.worked] == [key for key, one in methods.items() if one.value is not None]


def test_an_anchored_piece_comes_last(tmp_path):
    held = [dict(ITEMS[0], item=name, anchored="yes") for name in ("one", "two")]
    assert assessed(tmp_path / "held.xlsx", held).worked_item == 0
    safer = dict(ITEMS[1], item="safer", breadth=70, width=70)
    assert assessed(tmp_path / "both.xlsx", [*held, safer]).worked_item == 2
