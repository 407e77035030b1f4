"""What a building's row says: no number stands without what is missing from it."""

from assess.portfolio.piece_words import label_piece, mark_own_motions, name_skipped, say_blocked, say_falls, say_people


def test_what_is_not_known_stands_beside_the_number():
    for given, falls in (((1.6, 0, 0), "1.6"), ((1.6, 25, 0), "1.6 and up to 25 unconfirmed"),
                         ((0.0, 25, 3), "0.0 and up to 25 unconfirmed, 3 by formula only")):  # fmt: skip
        assert say_falls(*given) == falls
    for people, said in (((42.0, 100, 58), "42.0 of 42; 58 on routes not known"), ((3.0, 20, 0), "3.0 of 20"),
                         ((0.0, 30, 30), "not known: 30 on routes not known"),
                         ((None, 30, 30), "not known: 30 on routes not known"), ((None, None, None), "–")):  # fmt: skip
        assert say_people(*people) == said
    for routes, blocked in (((0, 0, 0), "–"), ((2, 0, 2), "not known"), ((3, 1, 1), "1; 1 not known"),
                            ((3, 0, 0), "0")):  # fmt: skip
        assert say_blocked(*routes) == blocked


def test_motions_of_its_own_are_marked_and_a_skipped_building_is_named():
    assert mark_own_motions("School", 2) == "School (floors with motions of their own)"
    assert mark_own_motions("School", 0) == "School"
    assert name_skipped("School", "s.xlsx") == "School (s.xlsx)"
    assert name_skipped(None, "s.xlsx") == name_skipped("s.xlsx", "s.xlsx") == "s.xlsx"


def test_an_unconfirmed_class_is_not_said_to_be_that_of_the_formula():
    row = {"risk_class": "high", "risk_class_upper": "very high", "is_held": False, "basis": "unconfirmed"}
    assert label_piece(row, "simulated") == ("◌ unconfirmed (high)", "apart-unconfirmed")
