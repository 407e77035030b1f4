"""Build `market-street.xlsx`: 575 Market Street, San Francisco, in the Loma Prieta earthquake.

The floor motions are those recorded in the building (`records/575-market/README.md`). The floor plan and the furniture
are an example: no inventory of the building exists. Run it with ``python inventories/market_street.py``.

The records serve every floor; the workbook also holds what a code's profile needs, so that it runs with
``--scenario "ASCE 7-22"`` as well. Height is 175 m (573 ft), the value commonly given for the tower, which is described
at https://buildingsdb.com/CA/san-francisco/575-market-street-tower. The elevations of the floors are an example
assumption: floors evenly spread by their number, the ground floor as the first and the roof as the 43rd. Storeys (40
are commonly given, the records number levels up to 42) and the period stay blank.

The plan is a plate of 32 x 24 m with a core in the middle, a corridor around it and rooms along the windows. X runs
along the longer side. Every piece stands with its back to a wall, or in a row parallel to one.

Routes lead from every room through the corridor to a stair, and down it to the street or the yard. On the 42nd floor
they form a ring with a stair on either side of the core, so that its offices have two ways out; the two floors below
have one. The west stair leads from there to the ground without a door between.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Any, Literal

from assess.pipeline.live_values import with_live
from assess.workbook.catalogue import read_catalogue
from assess.workbook.template import Content, Rows, write_workbook

Wall = Literal["S", "N", "W", "E"]
Box = tuple[float, float, float, float]
"""West, south, east and north edge [m]."""

PATH = Path(__file__).with_name("market-street.xlsx")

PLATE: Box = (0, 0, 32, 24)
CORE: Box = (9, 8, 23, 16)
FROM_WALL, BETWEEN = 0.1, 0.03
"""Space behind a piece and between two of a row [m]."""


def _records(channels: str) -> str:
    """Return the records of one level and direction, as the workbook names them."""
    return "; ".join(f"records/575-market/891018_1.cra-1.0210{channel}.smc" for channel in channels)


HEIGHT, ROOF = 175, 43
"""Height of the roof above the ground [m], and the number that it would have as a floor."""


def _elevation(number: int) -> float:
    """Height of a floor above the ground [m], floors evenly spread."""
    return round(HEIGHT * (number - 1) / (ROOF - 1), 1)


FLOORS: tuple[dict[str, str | float], ...] = (  # X: channels that point to 45 or 225 deg; Y: to 135 or 315 deg
    {"floor": "42", "name": "42nd floor", "elevation": _elevation(42),
     "record_x": _records("ab"), "record_y": _records("c")},
    {"floor": "34", "name": "34th floor", "elevation": _elevation(34), "record_x": _records("de")},
    {"floor": "25", "name": "25th floor", "elevation": _elevation(25),
     "record_x": _records("gh"), "record_y": _records("i")},
    {"floor": "G", "name": "Ground floor", "elevation": _elevation(1), "record_y": _records("k")},
)  # fmt: skip

BUILDING = {
    "height": HEIGHT, "ground_pga": 0.139,  # the ground floor channel's printed peak, 136.6 cm/s2
    "building": "575 Market Street", "address": "575 Market Street, San Francisco, California", "use": "Office",
    "client": "Example client", "prepared_by": "Example consultant", "checked_by": "Second engineer",
    "approved_by": "Head of department", "revision": "1",
    "scenario": "Loma Prieta earthquake, 17 October 1989, as recorded in the building. "
    "The furniture is an example; the records are real. Floors are assumed to be evenly spread.", "azimuth_deg": 45,
    "project_number": "Example 575", "survey_date": "2026-10-01", "surveyed_by": "Example consultant",
    "extent": "Floors 42, 34, 25 and G; the furniture is an example", "rooms_not_entered": "None",
    "documents": "Strong-motion records of the building; no drawings",
    "purpose": "To show what a report looks like. Nobody may rely on it.",
}  # fmt: skip
TEXTS = (
    {"section": "What to fix", "text": "The library of floor 42 comes first: its four bookcases are the only pieces "
     "that overturn under the recorded motion itself."},
)  # fmt: skip

_OFFICE: Mapping[str, Box] = {
    "South office": (0, 0, 25.4, 5.6),
    "Meeting room": (25.4, 0, 32, 5.6),
    "Archive": (25.4, 5.6, 32, 12),
    "Server room": (25.4, 12, 32, 18.4),
    "North office": (6.6, 18.4, 32, 24),
    "Kitchen": (0, 18.4, 6.6, 24),
    "Library": (0, 12, 6.6, 18.4),
    "Copy room": (0, 5.6, 6.6, 12),
    "Corridor": (6.6, 5.6, 25.4, 18.4),
}
_GROUND: Mapping[str, Box] = {
    "Lobby": (6.6, 0, 25.4, 8),
    "Mail room": (0, 0, 6.6, 8),
    "Cafe": (25.4, 0, 32, 11),
    "Security office": (25.4, 11, 32, 18.4),
    "Storage": (0, 8, 6.6, 18.4),
    "Workshop": (0, 18.4, 16, 24),
    "Building archive": (16, 18.4, 32, 24),
    "Corridor": (6.6, 8, 25.4, 18.4),
}
ROOMS = {"42": _OFFICE, "34": _OFFICE, "25": _OFFICE, "G": _GROUND}


@dataclass(frozen=True, slots=True)
class Run:
    """Equal pieces side by side along a wall of a room, or `off` [m] in front of it and parallel to it.

    `start` is measured along the wall from its west or south end [m]; `more` holds further cells of the rows.
    """

    room: str
    wall: Wall
    start: float
    description: str
    type: str
    count: int = 1
    off: float = 0.0
    more: Mapping[str, Any] = field(default_factory=dict)


SIDEWAYS = {"Vertical file 3 drawers", "Vertical file 5 drawers", "Server rack 42U", "Server rack 42U wide"}
"""Types that stand in a row with their Breadth along the wall: deeper than wide."""

_BOLTED = {"anchored": "yes"}
_FREE = {"anchored": "no"}
_FILE = {"width": 91.4, "anchored": "no"}
_SHELVES = {"width": 90, "anchored": "no"}
_COPIER = {"breadth": 60, "width": 65, "height": 115, "anchored": "no", "notes": "On castors"}
_STONE = {"friction": 0.4, "notes": "On a stone floor"}

FURNITURE: Mapping[str, tuple[Run, ...]] = {
    "42": (
        Run("South office", "S", 1, "Low cabinet under the windows", "Stationery cabinet counter height", 3, 0, _FREE),
        Run("South office", "S", 11, "Bookcase at the aisle", "Bookcase tall", 3, 1.6, _FREE),
        Run("South office", "N", 15, "Cabinet at the aisle", "Storage cabinet steel", 3, 1.4, _FREE),
        Run("South office", "N", 2, "Lateral file", "Lateral file 5 drawers", 2, 0, _FILE),
        Run("Meeting room", "E", 3.4, "Cabinet with crockery", "Storage cabinet sliding doors", 1, 0, _BOLTED),
        Run("Meeting room", "N", 2.5, "Glass cabinet with models", "Display cabinet glass", 2),
        Run("Archive", "E", 0.8, "Shelving with box files", "Steel shelving", 4, 0, _BOLTED),
        Run("Server room", "S", 2, "Server rack", "Server rack 42U", 2, 0.9, _BOLTED | {"importance": "function"}),
        Run("North office", "N", 4, "Bookcase", "Bookcase 5 shelves", 1, 0, _SHELVES),
        Run("North office", "S", 4, "Bookcase across the way", "Bookcase 5 shelves", 1, 0.3, _SHELVES),
        Run("North office", "N", 12, "Wardrobe", "Wardrobe 2 doors", 2, 0, {"anchored": "partly"}),
        Run("Library", "W", 1, "Bookcase", "Bookcase tall", 4, 0, {"anchored": "partly", "notes": "One bracket each"}),
        Run("Copy room", "W", 1, "Photocopier", "", 1, 0, _COPIER),
        Run("Kitchen", "W", 1, "Refrigerator", "Refrigerator top freezer"),
        Run("Corridor", "W", 3.4, "Lateral file in the corridor", "Lateral file 5 drawers", 2, 0, _FILE),
    ),
    "34": (
        Run("South office", "S", 4, "Low lateral file", "Lateral file 2 drawers", 3, 0, _FREE),
        Run("South office", "N", 12, "Wardrobe", "Wardrobe cabinet steel", 2, 0, _BOLTED),
        Run("Meeting room", "E", 3.8, "Cupboard with projector", "Cupboard"),
        Run("Archive", "E", 0.8, "Shelving with box files", "Steel shelving", 5, 0, _FREE | {"notes": "Full"}),
        Run("Archive", "E", 1.6, "File cabinet", "Vertical file 5 drawers", 3, 2.4, _FREE),
        Run("Server room", "N", 2, "Server rack", "Server rack 42U wide", 3, 0.9, _BOLTED | {"importance": "function"}),
        Run("North office", "N", 4, "Bookcase at the aisle", "Bookcase tall", 3, 1.6, _FREE),
        Run("North office", "S", 9, "Cabinet at the aisle", "Stationery cabinet", 3, 1.45, _FREE),
        Run("Library", "W", 1, "Narrow bookcase", "Bookcase tall narrow", 3, 0, _BOLTED),
        Run("Copy room", "W", 1, "Photocopier", "", 1, 0, _COPIER),
        Run("Copy room", "W", 2.5, "Paper cupboard", "Storage cabinet narrow", 2, 0, {"anchored": "partly"}),
        Run("Kitchen", "W", 2, "Vending machine", "Vending machine snacks"),
        Run("Corridor", "E", 8, "Steel cabinet in the corridor", "Storage cabinet steel", 2, 0, _FREE),
    ),
    "25": (
        Run("South office", "S", 9, "Cabinet at the aisle", "Stationery cabinet", 3, 1.5, _FREE),
        Run("South office", "N", 18, "File cabinet", "Vertical file 5 drawers", 3, 1.15, _FREE),
        Run("South office", "N", 5, "Narrow bookcase", "Bookcase tall narrow", 3),
        Run("Archive", "E", 0.8, "Shelving with box files", "Steel shelving", 5, 0, {"anchored": "partly"}),
        Run("Archive", "E", 0.8, "Shelving with box files", "Steel shelving", 4, 2, _FREE),
        Run("Server room", "N", 2, "Server rack", "Server rack 42U", 2, 0.9, _FREE | {"importance": "function"}),
        Run("North office", "N", 3, "Lateral file", "Lateral file 4 drawers", 3, 0, _FILE),
        Run("North office", "N", 13, "Wardrobe", "Wardrobe", 2, 0, _BOLTED),
        Run("Library", "W", 1.5, "Chest of drawers for plans", "Chest of drawers 6 drawers", 2, 0, _FREE),
        Run("Kitchen", "N", 2, "Cupboard with dishes", "Cupboard", 2, 0, _BOLTED),
        Run("Kitchen", "W", 1, "Refrigerator", "Refrigerator top freezer", 1, 0, _FREE),
        Run("Corridor", "E", 3, "Photocopier in the corridor", "", 1, 0.4,
            _COPIER | {"notes": "On castors; stands in the way, to be moved"}),
    ),
    "G": (
        Run("Lobby", "W", 2, "Reception counter", "", 1, 3, {"breadth": 80, "width": 280, "height": 110} | _BOLTED),
        Run("Lobby", "W", 3, "Glass cabinet at the way out", "Display cabinet glass", 2, 7.4, _FREE | _STONE),
        Run("Lobby", "E", 4, "Brochure shelf", "Bookcase 4 shelves", 1, 7.5, _SHELVES | _STONE),
        Run("Mail room", "W", 1, "Mail sorting shelf", "Steel shelving", 3, 0, _FREE),
        Run("Cafe", "E", 2, "Drinks machine", "Vending machine drinks", 2, 0, _BOLTED),
        Run("Cafe", "E", 6, "Refrigerator", "Refrigerator top freezer"),
        Run("Security office", "N", 3, "File cabinet", "Vertical file 3 drawers", 2, 0, _FREE),
        Run("Storage", "W", 1, "Storage shelving", "Steel shelving", 4, 0, {"anchored": "partly"}),
        Run("Workshop", "N", 3, "Tool cabinet", "Storage cabinet steel", 2, 0, _FREE),
        Run("Building archive", "N", 4, "Plan chest", "Chest of drawers 6 drawers", 2),
    ),
}  # fmt: skip

LOOSE: tuple[dict[str, Any], ...] = (
    {"floor": "42", "room": "South office", "description": "Desks", "type": "Desk", "quantity": 16},
    {"floor": "42", "room": "Meeting room", "description": "Tables", "type": "Conference table", "quantity": 4},
    {"floor": "34", "room": "North office", "description": "Desks", "type": "Desk", "quantity": 20},
    {"floor": "25", "room": "South office", "description": "Desks", "type": "Desk", "quantity": 18},
    {"floor": "25", "room": "South office", "description": "Pedestals under the desks", "quantity": 18,
     "breadth": 42, "width": 55, "height": 58, "anchored": "no"},
    {"floor": "G", "room": "Storage", "description": "Lockers of the cleaners", "quantity": 8, "axis": "Y",
     "breadth": 50, "width": 50, "height": 180, "anchored": "no", "route": "G storage",
     "notes": "Backs to the wall; measured. Beside the way to the door; how far from it was not noted"},
)  # fmt: skip


CORRIDOR, DOOR = 1.118, 0.813
"""Required widths [m]: 44 in and 32 in, as the International Building Code asks of a corridor and a door."""

Point = tuple[float, float, str]
"""Of a place: x, y [m] and kind."""

_ALONG = {"W": 8.25, "E": 23.75}
_ACROSS = {"aisle S": 2.8, "door S": 5.6, "corridor S": 6.8, "corridor N": 17.2, "door N": 18.4, "aisle N": 21.2}
_OFFICE_POINTS: Mapping[str, Point] = {
    **{f"{what}{side}": (x, y, "door" if "door" in what else "corridor")
       for what, y in _ACROSS.items() for side, x in _ALONG.items()},
    "corridor W": (8.25, 12, "corridor"), "corridor E": (23.75, 12, "corridor"),
    "west stair": (11.5, 12, "stair"), "east stair": (20.5, 12, "stair"),
    "Copy room": (3.3, 6.8, "room"), "Library": (3.3, 17.2, "room"), "Kitchen": (3.3, 21.2, "room"),
    "Archive": (27, 6.8, "room"), "Server room": (26.6, 17.2, "room"), "Meeting room": (28.7, 2.8, "room"),
    "meeting door": (25.4, 2.8, "door"), "kitchen door": (6.6, 21.2, "door"),
}  # fmt: skip
POINTS: Mapping[str, Mapping[str, Point]] = {
    "42": {**_OFFICE_POINTS, "South office": (22, 2.8, "room"), "North office": (22, 21.2, "room")},
    "34": {**_OFFICE_POINTS, "South office": (12.7, 2.8, "room"), "North office": (9, 21.2, "room")},
    "25": {**_OFFICE_POINTS, "South office": (3, 2.8, "room"), "North office": (9, 21.2, "room")},
    "G": {
        "east stair": (16, 9.5, "stair"), "Lobby": (16, 6.8, "room"), "street doors": (16, 1.2, "door"),
        "street": (16, 0, "exit"), "west stair": (11.5, 12, "stair"), "corridor W": (8.25, 12, "corridor"),
        "workshop door": (8.25, 18.4, "door"), "Workshop": (8.25, 21.2, "room"), "yard": (8.25, 24, "exit"),
        "Mail room": (3.3, 6.8, "room"), "Cafe": (28.7, 6.8, "room"), "lobby E": (24.2, 6.8, "corridor"),
        "Security office": (28.7, 14.7, "room"), "corridor E": (24.2, 14.7, "corridor"),
        "Building archive": (24.2, 21.2, "room"), "Storage": (3.3, 12, "room"),
    },
}  # fmt: skip
"""Places by floor."""

Course = tuple[str, int, str, tuple[tuple[str, str], ...]]
"""Name of a route, occupants, the place where it begins, and its segments, each with the place where it ends."""

PATHS: Mapping[str, tuple[Course, ...]] = {
    "42": (
        ("west", 30, "South office", (("aisle", "aisle SW"), ("door", "door SW"), ("corner", "corridor SW"),
                                      ("corridor", "corridor W"), ("stair door", "west stair"))),
        ("east", 30, "South office", (("aisle", "aisle SE"), ("door", "door SE"), ("corner", "corridor SE"),
                                      ("corridor", "corridor E"), ("stair door", "east stair"))),
        ("north", 30, "North office", (("office", "aisle NW"), ("door", "door NW"), ("corner", "corridor NW"),
                                       ("corridor", "corridor W"))),
        ("ring", 30, "corridor NW", (("corridor north", "corridor NE"), ("corridor east", "corridor E"))),
    ),
    "34": (
        ("east", 60, "North office", (("aisle", "aisle NE"), ("door", "door NE"), ("corner", "corridor NE"),
                                      ("corridor", "corridor E"), ("stair door", "east stair"))),
        ("south", 30, "South office", (("aisle", "aisle SE"), ("door", "door SE"), ("corner", "corridor SE"),
                                       ("corridor", "corridor E"))),
        ("west", 10, "corridor NW", (("corridor", "corridor NE"),)),
        ("west", 10, "corridor SW", (("corridor south", "corridor SE"),)),
    ),
    "25": (
        ("east", 60, "South office", (("aisle", "aisle SE"), ("door", "door SE"), ("corner", "corridor SE"),
                                      ("corridor", "corridor E"), ("stair door", "east stair"))),
        ("north", 30, "North office", (("aisle", "aisle NE"), ("door", "door NE"), ("corner", "corridor NE"),
                                       ("corridor", "corridor E"))),
        ("west", 10, "corridor NW", (("corridor", "corridor NE"),)),
        ("west", 10, "corridor SW", (("corridor south", "corridor SE"),)),
    ),
    "G": (
        ("street", 150, "east stair", (("stair door", "Lobby"),)),
        ("street", 200, "Lobby", (("lobby", "street doors"), ("street doors", "street"))),
        ("yard", 50, "west stair", (("stair door", "corridor W"), ("corridor", "workshop door"), ("door", "Workshop"),
                                    ("passage", "yard"))),
        ("east", 40, "corridor E", (("corridor", "lobby E"), ("lobby side", "Lobby"))),
        ("storage", 10, "Storage", (("aisle", "corridor W"),)),
    ),
}  # fmt: skip
_OFFICE_DOORS: Mapping[str, tuple[str, ...]] = {
    "Copy room": ("corridor SW",), "Library": ("corridor NW",), "Archive": ("corridor SE",),
    "Server room": ("corridor NE",), "Meeting room": ("meeting door", "aisle SE"),
}  # fmt: skip
DOORS: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "42": {**_OFFICE_DOORS, "Kitchen": ("kitchen door", "aisle NW")},
    "34": {**_OFFICE_DOORS, "Kitchen": ("kitchen door", "North office")},
    "25": {**_OFFICE_DOORS, "Kitchen": ("kitchen door", "North office")},
    "G": {"Mail room": ("Lobby",), "Cafe": ("lobby E",), "Security office": ("corridor E",),
          "Building archive": ("corridor E",)},
}  # fmt: skip
"""The other rooms of each floor, and the places to which a way leads from each, through its door if that is a place.

The first segment is named after the room, one from a door on after the door.
"""

STAIRS = (
    ("West stair", "42 to G", "42 west stair", "G west stair", 30),
    ("East stair", "42 to 34", "42 east stair", "34 east stair", 30),
    ("East stair", "34 to 25", "34 east stair", "25 east stair", 90),
    ("East stair", "25 to G", "25 east stair", "G east stair", 150),
)

WIDTHS: Mapping[str, tuple[float, float]] = {
    "aisle": (1.2, CORRIDOR), "office": (3.8, CORRIDOR), "door": (0.9, DOOR), "stair door": (0.9, DOOR),
    "stair": (1.2, CORRIDOR), "lobby": (2.4, CORRIDOR), "street doors": (1.8, CORRIDOR), "passage": (1.2, CORRIDOR),
}  # fmt: skip
"""Clear and required width of segments by their name."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A segment of a route: the room whose furniture can stand next to it, and its row without the floor."""

    room: str
    row: Mapping[str, Any]


def _stretch(
    room: str, names: tuple[str, str, str, str], widths: tuple[float, float], people: int, *through: str
) -> Stretch:
    row: dict[str, Any] = dict(zip(("route", "segment", "start", "end"), names, strict=True))
    row["room"] = "; ".join(dict.fromkeys(one for one in (room, *through) if one)) or None
    return Stretch(room, row | {"clear_width": widths[0], "required_width": widths[1], "occupants": people})


def _out_of(floor: str, room: str, *ends: str) -> Iterator[Stretch]:
    """Yield the segments from a room to where its door leads: in two rooms, or parted by the door."""
    beyond = {"aisle": "North office" if room == "Kitchen" else "South office", "lobby": "Lobby"}
    last = ends[-1] if ends[-1] in ROOMS[floor] else beyond.get(ends[-1].split()[0], "Corridor")
    rooms = ((room,), (last,)) if len(ends) > 1 else ((room, last),)
    for begin, end, (own, *through) in zip((room, *ends), ends, rooms, strict=False):
        names = (f"{floor} rooms", begin, f"{floor} {begin}", f"{floor} {end}")
        yield _stretch(own, names, WIDTHS["door"], 10, *through)


def _stretches() -> Iterator[Stretch]:
    """Yield the segments: floor by floor the routes and the doors of the other rooms, then the stairs."""
    for floor, paths in PATHS.items():
        for route, people, start, steps in paths:
            begin = start
            for segment, end in steps:
                room = {"aisle": start, "office": start, "door": "", "passage": "Workshop"}.get(segment, "Corridor")
                room = "Lobby" if {"Lobby", "street doors"} & {begin, end} else room
                names = (f"{floor} {route}", segment, f"{floor} {begin}", f"{floor} {end}")
                through = (start, "Corridor") if segment == "door" and start != "west stair" else ()
                yield _stretch(room, names, WIDTHS.get(segment, (1.5, CORRIDOR)), people, *through)
                begin = end
        for room, ends in DOORS[floor].items():
            yield from _out_of(floor, room, *ends)
    for *flight, people in STAIRS:
        route, segment, start, end = map(str, flight)
        yield _stretch("", (route, segment, start, end), WIDTHS["stair"], int(people))


SEGMENTS = tuple(_stretches())
_PLACES = {f"{floor} {name}": (floor, *point) for floor, points in POINTS.items() for name, point in points.items()}

_TYPES = {row["type"]: row for row in read_catalogue()}
_FACING: Mapping[Wall, int] = {"W": 0, "S": 90, "E": 180, "N": 270}
"""Direction that a piece with its back to a wall looks to, anticlockwise from X [deg]."""


def _size(row: Mapping[str, Any]) -> tuple[float, float]:
    """Breadth and width of a row [m], the catalogue's where it has none of its own."""
    sizes = {**_TYPES.get(row.get("type", ""), {}), **row}
    return sizes["breadth"] / 100, sizes["width"] / 100


def _box(row: Mapping[str, Any]) -> Box:
    """Return what a placed row covers on the plan."""
    breadth, width = _size(row)
    along_x, along_y = (breadth, width) if row["angle_deg"] % 180 == 0 else (width, breadth)
    x, y = row["x"], row["y"]
    return x - along_x / 2, y - along_y / 2, x + along_x / 2, y + along_y / 2


def _pieces(floor: str, run: Run) -> Iterator[dict[str, Any]]:
    """Return the rows of a run, one a piece, from the start of the wall on."""
    row = {"floor": floor, "room": run.room, "description": run.description, "type": run.type or None, **run.more}
    breadth, width = _size(row)
    sideways = run.type in SIDEWAYS
    length, depth = (breadth, width) if sideways else (width, breadth)
    west, south, east, north = ROOMS[floor][run.room]
    out = FROM_WALL + run.off + depth / 2
    for number in range(run.count):
        along = run.start + length / 2 + number * (length + BETWEEN)
        x, y = {"S": (west + along, south + out), "N": (west + along, north - out),
                "W": (west + out, south + along), "E": (east - out, south + along)}[run.wall]  # fmt: skip
        angle = (_FACING[run.wall] - (90 if sideways else 0)) % 360
        yield row | {"x": round(x, 2), "y": round(y, 2), "angle_deg": angle}


def _distance(piece: Box, line: Box) -> float:
    """Clear distance of a piece and a line along X or Y; infinite where it does not stand next to it."""
    gaps = [max(0.0, piece[at] - line[at + 2], line[at] - piece[at + 2]) for at in (0, 1)]
    along, across = gaps if line[1] == line[3] else reversed(gaps)
    return across if along == 0 else inf


def _next_to_route(row: Mapping[str, Any]) -> dict[str, Any]:
    """Name the segment that a piece can reach when it falls: its edge in the same room is nearer than its height."""
    near = []
    for one in SEGMENTS:
        (floor, x0, y0, _), (_, x1, y1, _) = _PLACES[one.row["start"]], _PLACES[one.row["end"]]
        if (floor, one.room) == (row["floor"], row["room"]):
            line = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
            edge = round(_distance(_box(row), line) - one.row["clear_width"] / 2, 2)
            near.append((edge, one.row["route"], one.row["segment"]))
    edge, route, segment = min(near, default=(inf, "", ""))
    if edge * 100 >= {**_TYPES.get(row["type"], {}), **row}["height"]:
        return {}
    return {"route": route, "segment": segment, "edge_distance": edge, "importance": "life safety"}


def item_rows() -> list[dict[str, Any]]:
    """Return the rows of Items, floor by floor, each floor's rows without a position last."""
    rows = []
    for floor in ROOMS:
        placed = (piece for run in FURNITURE[floor] for piece in _pieces(floor, run))
        own = [{"importance": "property", **row, **_next_to_route(row)} for row in placed]
        own += [row for row in LOOSE if row["floor"] == floor]
        rows += [{"item": f"{floor}-{number:02d}", **row} for number, row in enumerate(own, 1)]
    return rows


def _place_rows() -> list[dict[str, Any]]:
    """Return the rows of Places: those that a segment begins or ends at, then rooms that only have an outline."""
    used = {one.row[end] for one in SEGMENTS for end in ("start", "end")}
    outlines = {f"{floor} {name}": _outline(box) for floor, rooms in ROOMS.items() for name, box in rooms.items()}
    rows: list[dict[str, Any]] = [
        {"place": name, "floor": floor, "x": x, "y": y, "kind": kind, "outline": outlines.pop(name, None)}
        for name, (floor, x, y, kind) in _PLACES.items()
        if name in used
    ]
    cores = {f"{floor} Core": _outline(CORE) for floor in ROOMS}
    return rows + [
        {"place": name, "floor": name.split()[0], "outline": outline} for name, outline in (outlines | cores).items()
    ]


def _outline(box: Box) -> str:
    west, south, east, north = box
    return "; ".join(f"{x:g} {y:g}" for x, y in ((west, south), (east, south), (east, north), (west, north)))


def _route_rows() -> list[dict[str, Any]]:
    """Return the rows of Routes; stairs are on no floor."""
    floors = [{_PLACES[one.row[end]][0] for end in ("start", "end")} for one in SEGMENTS]
    return [
        {**one.row, **({"floor": min(own)} if len(own) == 1 else {})} for one, own in zip(SEGMENTS, floors, strict=True)
    ]


def content() -> Content:
    """Return the whole workbook, without the results of its live columns."""
    rows: dict[str, Rows] = {"Building": [BUILDING], "Floors": FLOORS, "Items": item_rows(), "Places": _place_rows()}
    return Content(rows | {"Routes": _route_rows(), "Text": TEXTS})


def build(path: Path = PATH) -> None:
    """Write the workbook; the records must lie in its folder."""
    write_workbook(path, with_live(content(), folder=path.parent))


if __name__ == "__main__":
    build()
