"""Which floor and room is which: by the pieces that stand there, then by names and elevations."""

from assess.bim.update_names import Named, match_alike, match_floors, match_rooms

LEVELS = {"1": 0.0, "2": 3.0, "3": 6.0}


def _pairs(*counts: tuple[str, str, int]) -> list[tuple[str, str]]:
    return [(one, own) for one, own, number in counts for _ in range(number)]


def test_floors_of_the_same_names_are_the_same() -> None:
    assert match_floors(LEVELS, LEVELS, _pairs(("1", "1", 3), ("2", "2", 1))) == {"1": "1", "2": "2", "3": "3"}


def test_most_pieces_tell_that_a_floor_was_renamed() -> None:
    own = {"eg": None, "2": None}
    assert match_floors({"1": 0.0, "2": 3.0}, own, _pairs(("1", "eg", 4), ("1", "2", 1), ("2", "2", 2))) == {
        "1": "eg", "2": "2",
    }  # fmt: skip


def test_renumbered_floors_are_told_by_their_pieces() -> None:
    own = {"0": 0.0, "1": 3.0, "2": 6.0}
    pairs = _pairs(("1", "0", 5), ("1", "1", 1), ("2", "1", 4))
    assert match_floors(LEVELS, own, pairs) == {"1": "0", "2": "1", "3": "2"}


def test_pieces_that_the_model_moved_to_another_floor_rename_none() -> None:
    pairs = _pairs(("1", "1", 4), ("2", "1", 6), ("2", "2", 3))
    assert match_floors(LEVELS, LEVELS, pairs) == {"1": "1", "2": "2", "3": "3"}


def test_a_floor_that_was_cleared_into_another_at_its_own_elevation_is_no_new_name() -> None:
    assert match_floors({"2": 3.0}, LEVELS, _pairs(("2", "1", 6))) == {"2": "2"}


def test_floors_that_people_joined_are_one() -> None:
    assert match_floors({"1a": 0.0, "1b": 0.5}, {"eg": 0.0}, _pairs(("1a", "eg", 2), ("1b", "eg", 2))) == {
        "1a": "eg", "1b": "eg",
    }  # fmt: skip


def test_a_floor_without_pieces_is_told_by_its_elevation() -> None:
    own = {"1": 0.0, "dach": 6.02}
    assert match_floors({"1": 0.0, "roof": 6.0, "attic": 9.0}, own, _pairs(("1", "1", 2))) == {"1": "1", "roof": "dach"}


def test_half_of_the_pieces_are_not_enough() -> None:
    assert match_floors({"1": None}, {"a": None, "b": None}, _pairs(("1", "a", 2), ("1", "b", 2))) == {}


def test_a_room_was_renamed_where_the_model_does_not_know_its_name() -> None:
    trios = [("1", "101", "Archive"), ("1", "101", "archive"), ("1", "102", "101"), ("2", "101", "101")]
    assert match_rooms(trios, {"101", "102"}) == {("1", "101"): "Archive"}


def test_a_room_in_which_one_piece_has_the_name_of_the_model_was_not_renamed() -> None:
    assert match_rooms([("1", "101", "Archive")] * 3 + [("1", "101", "101")], {"101"}) == {}


def test_alike_are_those_of_one_name_but_for_a_number_and_of_one_content() -> None:
    model = [Named("Desk", (160,)), Named("Desk (2)", (120,)), Named("Desk (3)", (80,)), Named("Sofa", (200,))]
    own = [Named("desk", (120,)), Named("Desk (2)", (160,)), Named("Desk (3)", (90,)), Named("Couch", (200,))]
    same = {0: 1, 1: 0, 2: 2}
    assert match_alike(model, own, lambda one, other: one == other) == same
    assert match_alike(model, own, lambda one, other: one == other, by_content=True) == same | {3: 3}
