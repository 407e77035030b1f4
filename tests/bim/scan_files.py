"""Scans as RoomPlan writes them, made by hand for tests: no phone took them, and no such file is in the repository.

Keys and shapes of values follow the Swift types of RoomPlan (iOS 17) as `JSONEncoder` writes them: cases of enums as
objects of one key, vectors as 3 numbers, matrices as 16, column after column, metres, Y upwards, identifiers as UUIDs
in capitals. Floors lie in the plane of their own X and Y, as scans do. That other apps write categories as texts, and
matrices as lists of 4, was seen in public programs.
"""

import json
import math
from typing import Any
from uuid import NAMESPACE_URL, uuid5

Element = dict[str, Any]


def identify(name: str) -> str:
    """Return the identifier of an element by a name: the same each time."""
    return str(uuid5(NAMESPACE_URL, name)).upper()


def place(x: float, y: float, z: float, turn_deg: float = 0.0) -> list[float]:
    """Return a matrix: a turn about the vertical axis, anticlockwise from above, and a position in the file's axes."""
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    return [c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, x, y, z, 1]


def lie(x: float, y: float, z: float) -> list[float]:
    """Return the matrix of a floor: its own X and Y are x and -z of the file."""
    return [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, x, y, z, 1]


def element(kind: str, name: str, sizes: tuple[float, float, float], at: list[float], **more: Any) -> Element:
    """Return an element of a category with its sizes and its matrix."""
    return {
        "identifier": identify(name), "parentIdentifier": None, "category": {kind: {}}, "confidence": {"high": {}},
        "dimensions": list(sizes), "transform": at, "story": 0, **more,
    }  # fmt: skip


def wall(name: str, x: float, z: float, length: float, turn_deg: float = 0.0, y: float = 0.0, **more: Any) -> Element:
    """Return a wall of 2.5 m on a floor at height y, by its middle."""
    return element("wall", name, (length, 2.5, 0.0), place(x, y + 1.25, z, turn_deg), **more)


def office(**more: Any) -> Element:
    """Return a room of 5 x 4 m about the origin: four walls, a door, a window, and four pieces of furniture.

    Plan X is x and plan Y -z. A bookcase of 0.9 x 2 x 0.3 m stands at the wall at Y = 2, a cabinet turned by 90 degrees
    at the wall at X = 2.5, a chair at a table in the middle; a shelf hangs 1.4 m above the floor.
    """
    table = element("table", "table", (1.6, 0.75, 0.8), place(0, 0.375, 0))
    return {
        "version": 2, "identifier": identify("office"), "story": 0,
        "walls": [
            wall("north", 0, -2, 5), wall("south", 0, 2, 5), wall("east", 2.5, 0, 4, 90), wall("west", -2.5, 0, 4, 90),
        ],
        "doors": [
            element("door", "door", (0.9, 2.05, 0.0), place(-1.5, 1.025, 2), category={"door": {"isOpen": True}}),
        ],
        "windows": [element("window", "window", (1.2, 1.2, 0.0), place(1, 1.5, -2))],
        "openings": [],
        "floors": [
            element("floor", "floor", (5, 4, 0.0), lie(0, 0, 0),
                    polygonCorners=[[-2.5, -2, 0], [2.5, -2, 0], [2.5, 2, 0], [-2.5, 2, 0]]),
        ],
        "objects": [
            element("storage", "bookcase", (0.9, 2.0, 0.3), place(0.5, 1.0, -1.85), attributes={}),
            element("storage", "cabinet", (0.8, 1.9, 0.45), place(2.275, 0.95, 0.6, 90)),
            table,
            element("chair", "chair", (0.5, 0.9, 0.5), place(0.2, 0.45, 0.7, 30), parentIdentifier=table["identifier"]),
            element("storage", "hanging shelf", (0.8, 0.4, 0.25), place(-1, 1.6, -1.85)),
        ],
        "sections": [{"label": "livingRoom", "center": [0, 0, 0], "story": 0}],
        **more,
    }  # fmt: skip


def write(document: object) -> bytes:
    return json.dumps(document).encode()
