"""Places, routes and the furniture beside them: what does not fit together, each by its cell."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from assess.model import Inventory
from assess.workbook.read import read_inventory
from tests.workbook.books import FLOORS, Sheet, errors_of, problems_of, remarks, write

TWO_FLOORS: Sheet = [*FLOORS, ["2", 0.5]]
PLACES: Mapping[str, list[Any]] = {
    "Office": ["Office", "2", 10, 4, "room"], "Upper": ["Upper", "2", 1, 4, "stair"],
    "Lower": ["Lower", "1", 1, 4, "stair"], "Door": ["Door", "1", 12, 4, "exit"],
}  # fmt: skip
ROUTES: Mapping[str, list[Any]] = {
    "aisle": ["Way", "aisle", "2", "Office", "Upper", 1.2, 0.9],
    "flight": ["Way", "flight", None, "Upper", "Lower", 1.2, 0.9],
    "hall": ["Way", "hall", "1", "Lower", "Door", 1.5, 0.9],
}
ITEMS: Mapping[str, list[Any]] = {
    "B1": ["B1", "1", 40, 180, 5, 3, 90, "Way", "hall", 0.1, 80],
    "B2": ["B2", "2", 40, 180, 5, 3, 90, None, None, None, 80],
}
HEADS: Mapping[str, list[str]] = {
    "Places": ["Place", "Floor", "X [m]", "Y [m]", "Kind"],
    "Routes": ["Route", "Segment", "Floor", "From", "To", "Clear width [m]", "Required width [m]"],
    "Items": ["Item", "Floor", "Breadth [cm]", "Height [cm]", "X [m]", "Y [m]", "Angle [deg]", "Route", "Segment",
              "Edge distance [m]", "Width [cm]"],
}  # fmt: skip
SOUND = {"Places": PLACES, "Routes": ROUTES, "Items": ITEMS}


def changed(sheet: str, name: str, cells: Mapping[str, Any]) -> list[Any]:
    """Return a sound row but for cells changed by how their header begins."""
    row = list(SOUND[sheet][name])
    for header, value in cells.items():
        row[next(at for at, label in enumerate(HEADS[sheet]) if label.startswith(header))] = value
    return row


def book(folder: Path, *more: tuple[str, list[Any]], without: str = "", **changes: Mapping[str, Any]) -> Path:
    """Write a sound workbook but for cells changed by the name of the row and the header, and rows added to a sheet."""
    sheets: dict[str, list[Any]] = {}
    for sheet, head in HEADS.items():
        rows = [changed(sheet, name, changes.get(name, {})) for name in SOUND[sheet]]
        added = [row for name, row in more if name == sheet]
        if sheet == "Items":  # all are as wide
            added = [[*row, *[None] * (len(head) - 1 - len(row)), 80][: len(head)] for row in added]
        sheets[sheet] = [head, *rows, *added]
    sheets.pop(without, None)
    return write(folder, sheets.pop("Items"), TWO_FLOORS, **sheets)


def sound(folder: Path, *more: tuple[str, list[Any]], **changes: Mapping[str, Any]) -> Inventory:
    return read_inventory(book(folder, *more, **changes))


LANE = ("Routes", ["Lane", "flight", None, "Upper", "Lower", 1.5, 0.9])
NOWHERE = {"X": None, "Y": None, "Angle": None}
SILENT: list[tuple[list[tuple[str, list[Any]]], dict[str, dict[str, Any]]]] = [
    ([], {}),
    ([], {"aisle": {"Floor": None}, "hall": {"Floor": None}}),  # it is that of both places
    ([], {"flight": {"Floor": "1"}}),
    ([], {"flight": {"Floor": "2"}}),
    ([LANE], {"B1": {"Segment": "flight"}, "B2": {"Route": "Lane"}}),
    ([], {"hall": {"Clear": 0.9}}),
    ([], {"hall": {"Clear": 0.9, "Required": None}}),
    ([("Routes", ["Way", "corner", "2", None, None, 1.2, 0.9])], {}),  # one segment on the plan is enough
    ([("Routes", ["Other", "back", None, "Lower", "Upper", 1.0, 0.9])], {}),
    # A flight lies between floors, and a segment of which nothing tells the floor is on none that is known.
    *(([], {"aisle": change, "Office": {"Kind": "corridor"}, "B2": NOWHERE})
      for change in ({"From": None, "To": None, "Floor": None}, {"From": "Lower", "Floor": "2"})),
]  # fmt: skip


def test_sound_workbooks_say_nothing_and_warnings_come_by_cell_each_once(tmp_path: Path) -> None:
    for more, changes in SILENT:
        inventory = sound(tmp_path, *more, **changes)
        assert inventory.problems == (), (more, changes)
        if set(changes) <= {"aisle", "hall"}:
            assert [one.floor for one in inventory.routes[:3]] == ["2", "", "1"]
    for changes, expected in WARNINGS.values():
        inventory = sound(tmp_path, **changes)
        assert [f"{one.severity} {one}" for one in inventory.problems] == [f"warning {expected}"]
    for more, changes, told in MORE:
        assert {f"{one.severity} {one}" for one in sound(tmp_path, *more, **changes).problems} == told
    routes: Sheet = [["Route", "Segment"], ["R1", "a"], ["R1", "b"]]
    path = write(tmp_path, [HEADS["Items"], ITEMS["B2"]], TWO_FLOORS, Routes=routes)
    assert [str(problem) for problem in read_inventory(path).problems] == [f"Routes!A1: {CLEAR}"]


LISTED = "Choose one of the {0} sheet, or add it there."
ERRORS: Mapping[str, tuple[dict[str, dict[str, Any]], str]] = {
    "From is no place": (
        {"aisle": {"From": "Ofice"}},
        f"Routes!D2: From 'Ofice' is not in the Places sheet. {LISTED.format('Places')} Did you mean Office?",
    ),
    "To is no place": (
        {"hall": {"To": "Yard"}}, f"Routes!E4: To 'Yard' is not in the Places sheet. {LISTED.format('Places')}",
    ),
    "the same place": (
        {"hall": {"To": "lower"}},
        "Routes!E4: From and To are the same place: the segment has no length. "
        "Choose another place, or delete the row.",
    ),
    "the same point": (
        {"Door": {"X": 1.006, "Y": 4.006}},
        "Routes!E4: From and To are at the same point of the plan: the segment has no length. "
        "Correct their positions in Places, or choose another place.",
    ),
    "a route's floor": (
        {"hall": {"Floor": "9"}}, f"Routes!C4: Floor '9' is not in the Floors sheet. {LISTED.format('Floors')}",
    ),
    "a place's floor": (
        {"Door": {"Floor": "9"}}, f"Places!B5: Floor '9' is not in the Floors sheet. {LISTED.format('Floors')}",
    ),
    "a floor that is neither's": (
        {"hall": {"Floor": "2"}, "B1": {"Segment": None, "Route": None, "Edge": None}},
        "Routes!C4: Floor '2' is that of neither From nor To, which lie on '1'. Correct it, or clear the cell.",
    ),
    "the same segment twice": (
        {"hall": {"Segment": "AISLE"}, "B1": {"Segment": None}},
        "Routes!B4: duplicate Segment 'AISLE' of Route 'Way', also in B2. Give each its own name.",
    ),
    "an item's segment elsewhere": (
        {"B1": {"Segment": "aisle"}},
        "Items!I2: Segment 'aisle' is not on floor '1' but on '2'. Choose one of the item's floor, or correct the Floor.",
    ),
    "an item's segment that is not there": (
        {"B1": {"Segment": "lobby"}},
        "Items!I2: Route 'Way' has no segment 'lobby'. Add it to Routes, or clear the cell.",
    ),
    "an item's route that is not there": (
        {"B1": {"Route": "Wy"}},
        f"Items!H2: Route 'Wy' is not in the Routes sheet. {LISTED.format('Routes')} Did you mean Way?",
    ),
    "a segment without its route": (
        {"B1": {"Route": None}}, "Items!I2: a Segment is named without its Route. Fill in Route.",
    ),
}  # fmt: skip


def test_errors_by_cell_each_once_sheet_by_sheet_and_row_by_row(tmp_path: Path) -> None:
    for changes, expected in ERRORS.values():
        assert [str(problem) for problem in problems_of(book(tmp_path, **changes))] == [expected]
    # What cannot be read is found before what does not fit together, and Routes is checked before Items; a warning comes last.
    more = [("Routes", ["Way", "side", "9", None, None, 1.2, 0.9]), ("Items", ["B1", "1", "wide", 180, *[None] * 6])]
    problems = problems_of(book(tmp_path, *more, hall={"To": "Yard"}, B1={"Segment": "lobby"}, Door={"X": "far"}))
    assert [one.place for one in problems] == [
        "Items!I2", "Items!C4", "Items!A4", "Places!C5", "Routes!E4", "Routes!C5",
        "Items!E4",
    ]  # fmt: skip


def test_names_are_spelt_as_where_they_stand_first_and_routes_are_of_the_items_floor(
    tmp_path: Path,
) -> None:
    lane = ("Routes", ["Lane", "yard", None, "Lower", "Door", 1.5, 0.9])
    own = {"Route": "lane", "Segment": None}
    assert errors_of(book(tmp_path, lane, B1=own | {"Floor": "2"})) == {
        "Items!H2: Route 'Lane' is not on floor '2' but on '1'. Choose one of the item's floor, or correct the Floor."
    }
    assert sound(tmp_path, lane, B1=own).items[0].route == "Lane"
    inventory = sound(tmp_path, hall={"Route": "WAY ", "From": "lower"}, B1={"Route": "way", "Segment": "Hall"})
    assert {one.route for one in inventory.routes} == {"Way"}
    assert inventory.routes[2].start == "Lower"
    assert (inventory.items[0].route, inventory.items[0].segment) == ("Way", "hall")


def test_a_missing_sheet_column_or_cell_is_told_once_and_pieces_beside_routes_need_a_width(tmp_path: Path) -> None:
    more = "named in 3 rows, but there is no Places sheet. Add the sheet, or clear the column."
    assert errors_of(book(tmp_path, without="Places")) == {
        f"Routes!D2: From 'Office' and others are {more}", f"Routes!E2: To 'Upper' and others are {more}",
    }  # fmt: skip
    assert errors_of(book(tmp_path, without="Routes")) == {
        "Items!H2: Route 'Way' is named, but there is no Routes sheet. Add the sheet, or clear the column."
    }
    sheets = {"Places": [["Floor", "X [m]"], ["1", 2]], "Routes": [HEADS["Routes"], *ROUTES.values()]}
    path = write(tmp_path, [HEADS["Items"], *ITEMS.values()], TWO_FLOORS, **sheets)
    assert errors_of(path) == {"Places!A1: the column Place is missing. Add it to the header row."}
    unread: list[tuple[str, str, Any]] = [
        ("Office", "X", "far"), ("Office", "Floor", None), ("Office", "Kind", "roof"),
        ("Upper", "Kind", "roof"), ("aisle", "Route", None), ("aisle", "Segment", None), ("aisle", "Clear", "wide"),
        ("aisle", "Required", -1), ("aisle", "Floor", "=A1"), ("aisle", "From", "#REF!"), ("hall", "Segment", None),
        ("B1", "Floor", None), ("B1", "X", "left"), ("B1", "Route", "#REF!"), ("B1", "Segment", "=A1"),
        ("B1", "Edge", "near"), ("B2", "X", "left"), ("B2", "Route", "#REF!"),
    ]  # fmt: skip
    for row, header, value in unread:
        assert len(problems_of(book(tmp_path, **{row: {header: value}}))) == 1, (row, header)
    nameless = problems_of(book(tmp_path, Office={"Place": None}))  # a segment names a place that is not there
    assert [problem.place for problem in nameless] == ["Places!A2", "Routes!D2"]
    others = dict.fromkeys(("X", "Y", "Route", "Segment", "Edge", "Width"))
    message = "Items!K2: Width is blank and no Type gives it: the piece is taken as wide as its Breadth"
    for kept, told in ((("X", "Y"), [True]), (("Route", "Segment", "Edge"), [True]), ((), [])):
        blank = {name: None for name in others if name not in kept}
        found = [one for one in remarks(sound(tmp_path, B1=blank), "warning") if "Width" in one]
        assert [one.startswith(message) for one in found] == told


JOINS = "the segment is evaluated, but joins nothing in the network. Fill in the other, or clear both."
CLEAR = (
    "Clear width is blank: it is taken as the required width, so anything that reaches into it blocks it. "
    "Fill in Clear width."
)
STAIR = (
    "Clear width of a stair is blank: whether the stair is open is not known, unless pieces that name it block the "
    "required width. Fill in Clear width."
)
WARNINGS: Mapping[str, tuple[dict[str, dict[str, Any]], str]] = {
    "narrower than required": (
        {"hall": {"Clear": 0.8, "Required": 1.5}},
        "Routes!G4: Required width 1.5 m is wider than Clear width 0.8 m: the segment is blocked with nothing fallen. "
        "Are the two exchanged?",
    ),
    "narrower than the default": (
        {"hall": {"Clear": 0.85, "Required": None}},
        "Routes!G4: Required width is blank and taken as 0.9 m, which is wider than Clear width 0.85 m: the segment "
        "is blocked with nothing fallen. Fill in the width that must stay free.",
    ),
    "no clear width": ({"hall": {"Clear": None}}, f"Routes!F4: {CLEAR}"),
    "no clear width of a stair": ({"flight": {"Clear": None}}, f"Routes!F3: {STAIR}"),
    "From alone": ({"flight": {"To": None}}, f"Routes!E3: From is filled in without To: {JOINS}"),
    "To alone": ({"flight": {"From": None}}, f"Routes!D3: To is filled in without From: {JOINS}"),
    "a distance to nothing": (
        {"B2": {"Edge": 0.2}},
        "Items!J3: Edge distance is filled in without a Route: it is not used. Fill in the Route, or clear the cell.",
    ),
    "no position": (
        {"B2": {"X": None, "Y": None, "Angle": None}},
        "Items!E3: 1 of 1 pieces of floor '2' has neither a position nor a Route: whether it falls onto a route is not "
        "known, and it is not counted. Fill in X, Y and Angle, or name the Route.",
    ),
    "no way out": (
        {name: {"Kind": "corridor"} for name in ("Upper", "Lower", "Door")},
        "Routes!E2: no place of Kind exit or stair is joined by any segment, so no room is evaluated. "
        "Fill in the Kind of the places that lead out.",
    ),
    "a room on no route": (
        {"aisle": {"From": "Lower", "Floor": None}},
        "Places!A2: the room 'Office' is not on any route: whether it keeps an exit is not evaluated. "
        "Let a segment begin or end at every room, or leave it out of Places.",
    ),
}  # fmt: skip


MORE: list[tuple[list[tuple[str, list[Any]]], dict[str, dict[str, Any]], set[str]]] = [
    ([("Routes", ["Other", "back", None, "Lower", "Upper", None, 0.9])], {}, {
        f"warning Routes!F5: {STAIR}",
        "warning Routes!F5: F3 joins the same places and gives a Clear width; here it is blank. If both are the same "
        "way, fill in the same width.",
    }),
    ([*(("Items", [f"C{at}", "2", 40, 180, *[None] * 6]) for at in range(3)),
      ("Items", ["D1", "2", 40, 180, None, None, None, "Way", None, None])], {}, {
        "warning Items!E4: 3 of 5 pieces of floor '2' have neither a position nor a Route: whether they fall onto a "
        "route is not known, and they are not counted. Fill in X, Y and Angle, or name the Route.",
    }),
    ([("Places", [f"Room {at}", "1", at, 20, "room"]) for at in range(5)], {}, {
        "warning Places!A6: 5 rooms are not on any route, such as 'Room 0', 'Room 1', 'Room 2': whether they keep an "
        "exit is not evaluated. Let a segment begin or end at every room, or leave it out of Places.",
    }),
    *(([("Places", ["Yard", "2", 4, 9, "exit"]), ("Routes", ["Way", "yard", "2", "Office", "Yard", 1.2, 0.9])],
       {"Upper": blank},
       {"note Routes!E2: 'Upper' has no position in Places: pieces count beside this segment only where they name it. "
        "Fill in its X and Y."}) for blank in ({"X": None, "Y": None}, {"Y": None})),
]  # fmt: skip


NO_PLAN = "no segment of that floor has both its places placed, and"
UNPLACED_ROUTES: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({}, {"X": None, "Y": None}), ({}, {"Y": None}), ({"To": None}, {}), ({"From": None, "To": None}, {}),
    ({"Floor": None, "To": None}, {}),
]  # fmt: skip
"""Of the segment, and of the place at its end."""


def test_a_floor_that_cannot_be_drawn_counts_only_pieces_that_name_a_route(tmp_path: Path) -> None:
    head = [*HEADS["Items"], "Quantity"]
    rows = [
        [*ITEMS["B2"], None], ["C1", "2", 40, 180, None, None, None, None, None, None, 80, 12],
        ["C2", "2", 40, 180, 6, 3, 90, "Way", None, None, 80, None],
    ]  # fmt: skip
    for aisle, office in UNPLACED_ROUTES:
        routes = [HEADS["Routes"], changed("Routes", "aisle", aisle)]
        places = [HEADS["Places"], changed("Places", "Office", office), PLACES["Upper"]]
        found = read_inventory(write(tmp_path, [head, *rows], TWO_FLOORS, Routes=routes, Places=places))
        assert {str(one) for one in found.problems if one.sheet == "Items"} == {
            "Items!E3: 12 of 14 pieces of floor '2' have neither a position nor a Route: whether they fall onto a route "
            "is not known, and they are not counted. Fill in X, Y and Angle, or name the Route.",
            f"Items!E2: 1 piece of floor '2' has a position, but {NO_PLAN} it names no Route: it is not counted. "
            "Fill in X and Y of the places, or name the Route.",
        }
