"""A building with evacuation routes for tests of reports: one is blocked, one open, one is short of width, one held."""

from pathlib import Path
from typing import Any

import assess
from assess.results import Results
from tests.workbooks import UNVERIFIED, write_sheets

FLOORS: list[dict[str, Any]] = [
    {"floor": "1", "name": "First", "elevation": 4.0, "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "G", "name": "Ground", "elevation": 0.0, "pfa_x": 0.1, "pfa_y": 0.1},
]
PLACES: list[dict[str, Any]] = [
    {"place": "Office", "floor": "1", "x": 0.0, "y": 0.0, "kind": "room"},
    {"place": "Archive", "floor": "1", "x": 0.0, "y": 8.0, "kind": "room"},
    {"place": "Landing", "floor": "1", "x": 10.0, "y": 0.0, "kind": "stair"},
    {"place": "Foot", "floor": "G", "x": 10.0, "y": 0.0, "kind": "stair"},
    {"place": "Street", "floor": "G", "x": 20.0, "y": 0.0, "kind": "exit"},
]
ROUTES: list[dict[str, Any]] = [
    {"route": "West", "segment": "aisle", "floor": "1", "start": "Office", "end": "Landing", "clear_width": 1.2,
     "required_width": 0.9, "occupants": 30, "notes": "=1+1"},
    {"route": "West", "segment": "flight", "start": "Landing", "end": "Foot", "clear_width": 1.2,
     "required_width": 0.9, "occupants": 200},
    {"route": "West", "segment": "hall", "floor": "G", "start": "Foot", "end": "Street", "clear_width": 2.0,
     "required_width": 1.2},
    {"route": "Back", "segment": "corridor", "floor": "1", "start": "Archive", "end": "Landing"},
    {"route": "Yard", "segment": "lane", "floor": "G", "clear_width": 1.5},
]  # fmt: skip
ITEMS: list[dict[str, Any]] = [
    {"item": "tall", "floor": "1", "description": "Bookcase", "breadth": 30, "width": 80, "height": 200, "x": 5.0,
     "y": 0.9, "axis": "Y", "angle_deg": 90, "anchored": "no"},
    {"item": "calm", "floor": "1", "breadth": 50, "width": 80, "height": 110, "quantity": 2, "anchored": "no",
     "route": "Back", "edge_distance": 0.1},
    {"item": "held", "floor": "G", "breadth": 30, "width": 80, "height": 200, "anchored": "yes", "route": "Yard",
     "segment": "lane", "edge_distance": 0.0},
    {"item": "=apart", "floor": "1", "breadth": 28, "height": 210, "anchored": "no", "description": "=cmd()"},
]  # fmt: skip

BUILDING: dict[str, Any] = {"building": "Routed hall", "motion_uncertainty": 0.4}
KNOWN: dict[str, Any] = {"Building": [BUILDING | {"period": 1.0}]}
"""The same building with its period known."""
DOUBTED: dict[str, Any] = {
    "Floors": [{name: value for name, value in one.items() if name != "elevation"} for one in FLOORS]
}
"""The same with neither T1 nor any height: nothing is known of the building, and no class is confirmed."""
PARTLY: dict[str, list[dict[str, Any]]] = {
    "Floors": [FLOORS[0], FLOORS[1] | {"pfv_x": 22.0, "pfv_y": 22.0}],
    "Places": [
        {"place": "Lab", "floor": "G", "x": 0.0, "y": 0.0, "kind": "room"},
        {"place": "Fork", "floor": "G", "x": 6.0, "y": 0.0, "kind": "door"},
        {"place": "Street", "floor": "G", "x": 12.0, "y": 0.0, "kind": "exit"},
        {"place": "Yard", "floor": "G", "x": 6.0, "y": 9.0, "kind": "exit"},
        {"place": "Shaft", "floor": "G", "kind": "exit"},
    ],
    "Routes": [
        {"route": "Out", "segment": "aisle", "floor": "G", "start": "Lab", "end": "Fork", "room": "Hall",
         "clear_width": 1.2, "required_width": 0.9},
        {"route": "Out", "segment": "ahead", "floor": "G", "start": "Fork", "end": "Street", "clear_width": 1.2,
         "required_width": 0.9},
        {"route": "Out", "segment": "aside", "floor": "G", "start": "Fork", "end": "Yard", "clear_width": 1.2,
         "required_width": 0.9},
        {"route": "Out", "segment": "ladder", "floor": "G", "start": "Fork", "end": "Shaft", "clear_width": 1.2,
         "required_width": 0.9},
        {"route": "Cellar", "segment": "tunnel", "floor": "G", "clear_width": 1.2, "required_width": 0.9,
         "occupants": 10},
        {"route": "Cellar", "segment": "gap", "floor": "G", "clear_width": 1.2, "required_width": 0.9,
         "occupants": 300},
    ],
    "Items": [
        {"item": "tall", "floor": "G", "breadth": 30, "width": 80, "height": 200, "x": 9.0, "y": 0.9, "axis": "Y",
         "angle_deg": 90, "anchored": "no"},
        {"item": "behind", "floor": "G", "room": "Store", "breadth": 30, "width": 80, "height": 200, "x": 3.0,
         "y": 0.9, "axis": "Y", "angle_deg": 90, "anchored": "no"},
        {"item": "adrift", "floor": "G", "breadth": 30, "height": 200, "quantity": 3, "anchored": "no"},
    ],
}  # fmt: skip
"""A building that is evaluated in part: the ladder leads to no position, and nothing is told of the route Cellar."""


def write_routed(path: Path, **sheets: Any) -> Path:
    """Write the building; `sheets` take the place of its own by their names."""
    rows = {"Building": [BUILDING], "Floors": FLOORS, "Items": ITEMS, "Places": PLACES,
            "Routes": ROUTES}  # fmt: skip
    return write_sheets(path, rows | sheets)


def assess_routed(path: Path, settings: assess.Settings = UNVERIFIED, **sheets: Any) -> Results:
    """Write the building and assess it, by the formulas alone where no settings are given."""
    return assess.run(assess.read_inventory(write_routed(path, **sheets)), settings)
