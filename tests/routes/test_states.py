"""The four states: what makes a segment, route or room open, doubtful, blocked or not known, and what is missing."""

import pytest

from assess.pipeline.schedule import list_rooms_at_risk
from assess.report.say.route import count_rooms, say_uncounted
from assess.route_results import RouteState
from tests.routes.buildings import CORRIDOR, corridor, evaluated, make_falls, one_segment, piece, place, stretch

OPEN, DOUBTFUL, BLOCKED, NOT_KNOWN = RouteState.OPEN, RouteState.DOUBTFUL, RouteState.BLOCKED, RouteState.NOT_KNOWN
WHOLE, LOOSE = piece(1.5, 0.0), {"x": None, "y": None}
"""1.5 m high at the edge it blocks the 1.8 m of a segment; a loose piece has neither a position nor a Route."""


def falls_in(count: int, runs: int):
    """Return how one piece falls in `count` of `runs` draws."""
    return make_falls([count / runs], fell={0: [at < count for at in range(runs)]})


def test_by_the_chance_and_the_upper_end_of_its_interval():
    """Wilson, 95 %: 0 of 100 is at most 3.7 %, 0 of 200 1.9 %, 1 of 300 1.9 %, 3 of 200 4.3 %; 60 of 200 is 0.3."""
    for count, runs, state in (
        (0, 100, DOUBTFUL), (0, 200, OPEN), (1, 300, OPEN), (3, 200, DOUBTFUL), (59, 200, DOUBTFUL), (60, 200, BLOCKED),
        (200, 200, BLOCKED),
    ):  # fmt: skip
        found = evaluated(falls_in(count, runs), [WHOLE])
        assert found.segments[0].state is found.routes[0].state is state, (count, runs)
        assert found.segments[0].missing == found.routes[0].missing == ()


def test_of_formulas_the_chance_itself_is_the_upper_end_and_the_chosen_risk_moves_open_and_not_blocked():
    states = [one_segment(make_falls([chance]), [WHOLE]).state for chance in (0.0299, 0.03, 0.2999, 0.3)]
    assert states == [OPEN, DOUBTFUL, DOUBTFUL, BLOCKED]
    states = [one_segment(make_falls([0.1]), [WHOLE], risk=risk).state for risk in (0.05, 0.1, 0.2)]
    assert states == [DOUBTFUL, DOUBTFUL, OPEN]
    assert one_segment(make_falls([0.35]), [WHOLE], risk=0.5).state is BLOCKED


# ---------------------------------------------------------------- pieces that are not counted


def lone(chance: float, *, high: float | None = None, **more):
    """Evaluate a corridor of which everything is known but one piece of its floor, without a position or Route."""
    given = {key: more.pop(key) for key in ("anchored", "in_record", "unconfirmed") if key in more}
    falls = make_falls([chance], high=[chance if high is None else high], **given)
    return one_segment(falls, [piece(2.0, **{**LOOSE, **more})], corridor(room="Corridor"))


def test_a_piece_that_may_stand_anywhere_leaves_it_not_known():
    found = lone(0.2)
    assert (found.state, found.blocked.probability) == (NOT_KNOWN, 0)
    (row,) = found.missing
    assert (row.what, row.names, row.cells) == ("positions", ("P0",), ("Items!A2",))


def test_one_that_cannot_matter_does_not_and_one_that_could_does():
    for given in (
        {"chance": 0.029}, {"chance": 0.2, "anchored": [True]}, {"chance": 0.2, "room": "Office"},
        {"chance": 0.2, "floor": "2"}, {"chance": 0.2, "route": "Elsewhere"},
    ):  # fmt: skip
        assert (lone(**given).state, lone(**given).missing) == (OPEN, ()), given
    for given in (
        {"chance": 0.01, "high": 0.03}, {"chance": 0.0, "in_record": [1]}, {"chance": 0.2, "room": "corridor"},
        {"chance": 0.4, "unconfirmed": [0]},
    ):  # fmt: skip
        assert (lone(**given).state, [row.what for row in lone(**given).missing]) == (NOT_KNOWN, ["positions"]), given


@pytest.mark.parametrize(("quantity", "state"), [(1, OPEN), (2, NOT_KNOWN), (20, NOT_KNOWN)])
def test_left_out_pieces_count_together(quantity, state):
    """Each falls at 2 %: two of them, independently, at 3.96 %, in one row or in several."""
    row = evaluated(make_falls([0.02], quantity=[quantity]), [piece(2.0, **LOOSE, quantity=quantity)],
                    [corridor()], CORRIDOR)  # fmt: skip
    rows = evaluated(make_falls([0.02] * quantity), [piece(2.0, **LOOSE)] * quantity, [corridor()], CORRIDOR)
    assert [one.routes[0].state for one in (row, rows)] == [state, state]
    assert [one.rooms[0].state for one in (row, rows)] == [state, state]
    assert len(rows.routes[0].missing) == (state is NOT_KNOWN)
    assert [len(one.names) for one in rows.segments[0].missing] == [quantity] * (state is NOT_KNOWN)


def test_left_out_pieces_count_with_those_that_reach_it():
    """2 % by a piece at the edge and 2 % by one that is left out are 3.96 %; 10 % and 2 % stay doubtful."""
    items = [piece(2.0, x=5.0, y=1.1, width=0.8, axis="Y"), piece(2.0, **LOOSE)]
    found = [one_segment(make_falls([own, 0.02]), items, corridor()) for own in (0.0, 0.02, 0.1, 0.29)]
    assert [one.state for one in found] == [OPEN, NOT_KNOWN, DOUBTFUL, NOT_KNOWN]


def test_left_out_pieces_of_all_segments_of_a_route_count_together():
    """Each of two segments is open at 2 %; the route and the room, which need both, are not known."""
    segments = [stretch("a", "West", "Mid", room="One"), stretch("b", "Mid", "East", room="Two")]
    places = [*CORRIDOR, place("Mid", "", (5, 0))]
    items = [piece(2.0, **LOOSE, room="One"), piece(2.0, **LOOSE, room="Two")]
    found = evaluated(make_falls([0.02, 0.02]), items, segments, places)
    assert [one.state for one in found.segments] == [OPEN, OPEN]
    assert (found.routes[0].state, found.rooms[0].state) == (NOT_KNOWN, NOT_KNOWN)
    assert [(row.what, row.names) for row in found.routes[0].missing] == [("positions", ("P0", "P1"))]
    assert found.routes[0].decisive_segment == 0


def test_left_out_pieces_that_fall_in_the_same_draws_count_once():
    """2 of 200 draws: 3.6 % at most, and 1 of 300 1.9 %, however many pieces fall in that same draw."""
    for count, runs, state in ((2, 200, NOT_KNOWN), (1, 300, OPEN)):
        fell = [at < count for at in range(runs)]
        falls = make_falls([count / runs] * 9, high=[0.02] * 9, fell=dict.fromkeys(range(9), fell))
        assert one_segment(falls, [piece(2.0, **LOOSE)] * 9, corridor()).state is state


def test_blocked_wins_over_what_is_missing():
    items = [piece(2.0, x=5.0, y=1.1, width=0.8, axis="Y"), piece(2.0, **LOOSE)]
    found = [one_segment(make_falls([chance, 0.9]), items, corridor()) for chance in (0.29, 0.3)]
    assert [one.state for one in found] == [NOT_KNOWN, BLOCKED]
    assert [len(one.missing) for one in found] == [1, 0]


def test_a_segment_without_a_plan_needs_its_places():
    """The piece has a position, which tells nothing as long as the segment has none."""
    items, ends = [piece(2.0, x=5.0, y=1.1)], [place("West", "room"), place("East", "exit")]
    (found,) = evaluated(make_falls([0.2]), items, [corridor()], ends).segments
    (row,) = found.missing
    assert (found.state, found.blocked, row.what, row.names) == (NOT_KNOWN, None, "places", ("West", "East"))
    (unjoined,) = evaluated(make_falls([0.2]), items, [stretch()]).segments[0].missing
    assert (unjoined.what, unjoined.names) == ("ends", ("Way: a",))
    low = evaluated(make_falls([0.02]), items, [corridor()], ends).segments[0]
    assert (low.state, low.evaluated, low.blocked.probability) == (OPEN, True, 0)


def test_a_floor_without_furniture_is_not_known_without_a_plan_and_positions_are_asked_for_at_once():
    (found,) = evaluated(make_falls([]), [], [stretch()]).segments
    assert (found.state, found.evaluated) == (NOT_KNOWN, False)
    ends = [place("West", "room"), place("East", "exit")]
    found = evaluated(make_falls([0.2]), [piece(2.0, **LOOSE)], [corridor()], ends).segments[0]
    assert [row.what for row in found.missing] == ["places", "positions"]


def test_one_on_no_floor_that_joins_nothing_is_not_known_whatever_names_it():
    """A piece that names it tells nothing of the others: they have a floor, it has none; nor is it a stair."""
    items = [piece(2.0, 0.1, route="Way", segment="a"), piece(2.0, **LOOSE)]
    for chances, given, missing in (([0.001, 0.9], items, ["ends"]), ([], [], ["ends", "furniture"])):
        found = evaluated(make_falls(chances), given, [stretch(floor="", clear_width=1.2)]).segments[0]
        assert (found.state, [row.what for row in found.missing]) == (NOT_KNOWN, missing)


# ---------------------------------------------------------------- the recorded motion


def test_what_was_blocked_under_the_record_is_so_for_its_room_too():
    one = piece(2.0, x=5.0, y=1.2, width=1.0, axis="Y")
    found = evaluated(make_falls([0.1], in_record=[1]), [one], [corridor(required=1.2)], CORRIDOR)
    (room,) = found.rooms
    assert [found.segments[0].state, found.routes[0].state, room.state, room.ways[0].state] == [BLOCKED] * 4
    assert room.fixes


# ---------------------------------------------------------------- stairs

STAIR_ENDS = (place("Up", "stair", (0, 0), floor="2"), place("Down", "stair", (0, 0)))
FLIGHT = {"route": "Stair", "floor": ""}


def flight(clear_width, *items, chance=0.2):
    """Evaluate a flight of stairs with pieces."""
    one = stretch("flight", "Up", "Down", **FLIGHT, clear_width=clear_width)
    return evaluated(make_falls([chance] * len(items)), items, [one], STAIR_ENDS).routes[0]


def test_a_stair_is_open_where_its_clear_width_is_known():
    known, blank = flight(1.2, piece(2.0, **LOOSE)), flight(None)
    assert (known.state, known.blocked.probability, known.from_places, known.to_places) == (
        OPEN, 0, ("Up",), ("Down",),
    )  # fmt: skip
    assert (blank.state, [(row.what, row.names, row.cells) for row in blank.missing]) == (
        NOT_KNOWN, [("clear_width", ("Stair: flight",), ("Routes!A2",))],
    )  # fmt: skip


def test_pieces_that_name_a_stair_are_evaluated_by_their_edge_distance():
    """1.2 m clear: 1.5 m high at the edge it blocks the stair, in 0.2; a width is needed first."""
    own = piece(1.5, 0.0, route="Stair", segment="flight")
    found, blank = flight(1.2, own), flight(None, own)
    assert (found.state, found.blocked.probability) == (DOUBTFUL, 0.2)
    assert (blank.state, [row.what for row in blank.missing]) == (NOT_KNOWN, ["clear_width", "stair_pieces"])
    assert blank.missing[1].names == ("P0",)
    assert flight(None, own, chance=0.5).state is BLOCKED, "blocked wins"


OFFICE = place("Office", "room", (-5, 0), floor="2")
BESIDE_CORRIDOR = piece(2.0, 0.0, route="Way", segment="corridor", floor="2")


@pytest.mark.parametrize(
    ("width", "chance", "state"), [(None, 0.0, NOT_KNOWN), (1.2, 0.0, OPEN), (1.2, 0.2, DOUBTFUL), (None, 0.5, BLOCKED)]
)
def test_a_route_needs_the_flight_that_it_includes(width, chance, state):
    """Both ends of a flight are stairs: the way leads to the lower one, and one that is blocked above stays so."""
    ways = [
        stretch("corridor", "Office", "Up", floor="2"),
        stretch("flight", "Up", "Down", floor="", clear_width=width),
    ]
    found = evaluated(make_falls([chance]), [BESIDE_CORRIDOR], ways, [OFFICE, *STAIR_ENDS]).routes[0]
    assert (found.state, found.from_places, found.to_places) == (state, ("Office",), ("Down",))
    assert found.unevaluated_segments == (("flight",) if width is None else ())
    well, way = place("Stairwell", "stair", (1, 0), floor="2"), stretch("well", "Stairwell", "Up", floor="2")
    again = evaluated(make_falls([chance]), [BESIDE_CORRIDOR], [*ways, way], [OFFICE, *STAIR_ENDS, well])
    assert (again.routes[0].state, again.routes[0].to_places) == (state, ("Down",)), "nor does its space count"


def test_two_stairs_of_one_floor_that_a_corridor_joins_are_both_ways_out():
    """Either is enough, whatever blocks the corridor between them."""
    ends = (STAIR_ENDS[0], place("Other", "stair", (9, 0), floor="2"))
    ways = [stretch("office", "Office", "Up", floor="2"), stretch("corridor", "Up", "Other", floor="2")]
    found = evaluated(make_falls([0.5]), [BESIDE_CORRIDOR], ways, [OFFICE, *ends]).routes[0]
    assert (found.state, found.to_places) == (OPEN, ("Other", "Up"))


def test_one_between_floors_that_names_a_floor_says_so():
    one = stretch("flight", "Up", "Down", route="Stair", floor="1")
    found = evaluated(make_falls([0.2]), [piece(2.0, **LOOSE)], [one], STAIR_ENDS).segments[0]
    assert [row.what for row in found.missing] == ["stair_floor", "positions"]


# ---------------------------------------------------------------- rooms

UP = place("Office", "room", (-5, 0), floor="2")
HALL, STREET = place("Hall", "", (5, 0)), place("Street", "exit", (9, 0))
WAY = [stretch("corridor", "Office", "Up", floor="2", route="Upper"),
       stretch("flight", "Up", "Down", **FLIGHT, clear_width=1.2),
       stretch("hall", "Down", "Street", route="Lower")]  # fmt: skip
BESIDE_HALL = piece(1.5, 0.0, route="Lower", segment="hall")


def test_a_room_goes_by_its_way_to_the_street_stairs_included():
    """The routes are three; the room's way takes all of them, so that the hall below decides."""
    found = evaluated(make_falls([0.2]), [BESIDE_HALL], WAY, [UP, *STAIR_ENDS, STREET])
    (room,) = found.rooms
    assert [one.state for one in found.routes] == [OPEN, OPEN, DOUBTFUL]
    assert (room.state, room.decisive_segment, [fix.item for fix in room.fixes]) == (DOUBTFUL, 2, ["P0"])
    blank = stretch("flight", "Up", "Down", **FLIGHT, clear_width=None)
    narrow = evaluated(make_falls([0.0]), [BESIDE_HALL], [WAY[0], blank, WAY[2]], [UP, *STAIR_ENDS, STREET])
    assert (narrow.rooms[0].state, [row.what for row in narrow.rooms[0].missing]) == (NOT_KNOWN, ["clear_width"])
    assert (narrow.unknown_rooms, narrow.cut_off_rooms_expected) == (1, 0)


def test_beyond_a_stair_nothing_is_known():
    found = evaluated(make_falls([0.2]), [BESIDE_HALL], WAY[:1], [UP, *STAIR_ENDS]).rooms[0]
    assert (found.state, found.by_stairs) == (NOT_KNOWN, True)
    assert [(row.what, row.names) for row in found.missing] == [("beyond_stairs", ("Up",))]


def test_one_known_way_is_enough():
    """East is open for sure; of the way west nothing is known, which cannot cut the room off."""
    places = [place("Room", "room", (0, 0)), place("East", "exit", (5, 0)), place("West", "exit")]
    segments = [stretch("east", "Room", "East", room="Hall"), stretch("west", "Room", "West", room="Gallery")]
    items = [piece(2.0, **LOOSE, room="Gallery")]
    found = evaluated(make_falls([0.5]), items, segments, places)
    assert [one.state for one in found.segments] == [OPEN, NOT_KNOWN]
    assert (found.rooms[0].state, found.rooms[0].missing) == (OPEN, ())
    assert [way.end for way in found.rooms[0].ways] == ["East", "West"]


def test_what_is_missing_matters_only_with_what_is_unconfirmed():
    """Each of the two ways may be blocked by something that is not known: only both cut the room off."""
    places = [place("Room", "room", (0, 0)), place("East", "exit", (5, 0)), place("West", "exit")]
    segments = [stretch("east", "Room", "East", room="Hall"), stretch("west", "Room", "West", room="Gallery")]
    items = [piece(1.5, 0.0, route="Way", segment="east"), piece(2.0, **LOOSE, room="Gallery")]
    (room,) = evaluated(make_falls([0.9, 0.5], unconfirmed=[0]), items, segments, places).rooms
    assert room.state is NOT_KNOWN
    assert {row.what for row in room.missing} <= {"unconfirmed_building", "places", "positions"}
    assert room.missing


# ---------------------------------------------------------------- what to fix


def test_fixes_bring_the_upper_end_below_the_risk():
    """3 of 200 draws are 1.5 %, below 3 %, but the interval goes to 4.3 %: doubtful, and there is something to fix."""
    found = evaluated(falls_in(3, 200), [WHOLE]).routes[0]
    assert (found.state, [fix.item for fix in found.fixes], found.is_fixed) == (DOUBTFUL, ["P0"], True)
    assert found.decisive_segment == 0
    open_one = evaluated(falls_in(1, 300), [WHOLE]).routes[0]
    assert (open_one.state, open_one.fixes) == (OPEN, ())


def test_with_its_fixes_held_a_route_is_open():
    """A second evaluation with those pieces anchored says so."""
    fell = {0: [at < 40 for at in range(400)], 1: [40 <= at < 70 for at in range(400)], 2: [False] * 400}
    items = [WHOLE, WHOLE, WHOLE]
    before = evaluated(make_falls([0.1, 0.075, 0.0], fell=fell), items).routes[0]
    held = [at in {fix.item_index for fix in before.fixes} for at in range(3)]
    after = evaluated(make_falls([0.1, 0.075, 0.0], fell=fell, anchored=held), items).routes[0]
    assert (before.state, held, after.state) == (DOUBTFUL, [True, True, False], OPEN)


def test_a_room_that_no_segment_joins_is_named():
    rooms = [*CORRIDOR, place("Cellar 10", "room"), place("Cellar 2", "room"), place("Side door", "door")]
    found = evaluated(make_falls([0.0]), [WHOLE], [corridor()], rooms)
    assert [one.room for one in found.rooms] == ["West"]
    assert found.unjoined_rooms == ("Cellar 2", "Cellar 10")
    assert (found.unknown_rooms, found.rooms[0].state, list(list_rooms_at_risk(found))) == (
        2, OPEN, ["Cellar 2", "Cellar 10"],
    )  # fmt: skip
    (sentence,) = count_rooms(found)[1:]
    assert "joins 2 more rooms to no exit or stair" in sentence
    assert "Cellar 2, Cellar 10" in sentence
    assert evaluated(make_falls([0.0]), [WHOLE], [corridor()], CORRIDOR).unjoined_rooms == ()


def test_what_is_missing_matters_once_the_fixes_are_done():
    """A blocked route and room say what would leave them not known; nothing where all is placed or held."""
    loose, wall = piece(2.0, **LOOSE), WHOLE
    for chances, missing in ((([0.5, 0.2]), ["positions"]), ([0.5, 0.02], []), ([0.5, 0.0], [])):
        found = evaluated(make_falls(chances), [wall, loose], [corridor()], CORRIDOR)
        for one in (found.routes[0], found.rooms[0]):
            assert (one.state, one.missing, [fix.item for fix in one.fixes]) == (BLOCKED, (), ["P0"])
            assert [row.what for row in one.missing_after] == missing
        later = "could change a result above once the pieces listed are fixed."
        assert say_uncounted(found).endswith(later if missing else "They could not change any result above.")


def test_a_stair_that_a_piece_blocks_needs_its_width_once_that_is_fixed():
    own = piece(1.5, 0.0, route="Stair", segment="flight")
    flights = [stretch("flight", "Up", "Down", **FLIGHT, clear_width=width) for width in (None, 1.2)]
    found = [evaluated(make_falls([0.5]), [own], [one], STAIR_ENDS).routes[0] for one in flights]
    assert [one.state for one in found] == [BLOCKED, BLOCKED]
    assert [[row.what for row in one.missing_after] for one in found] == [["clear_width", "stair_pieces"], []]
