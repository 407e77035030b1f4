"""A slip in the Room of a piece: told where it keeps the piece away from a segment, and nowhere else."""

from pathlib import Path
from typing import Any

from assess.workbook.read import read_inventory
from tests.workbook.books import write

FLOORS = [["Floor", "PFA X [g]"], ["1", 0.5], ["2", 0.5]]
ITEMS = ["Item", "Floor", "Room", "Quantity", "Breadth [cm]", "Height [cm]", "Route"]
PLACES = [["Place", "Floor", "X [m]", "Y [m]", "Kind"], ["Hall", "1", 0, 0, "exit"], ["Gate", "1", 9, 0, "room"]]
ROUTES = ["Route", "Segment", "Floor", "From", "To", "Room", "Clear width [m]"]


def told(folder: Path, *pieces: tuple[str, str, int | None], room: str = "Corridor; Room 11") -> list[str]:
    """Return what is told of the rooms of pieces, each by its floor, room and quantity; the first is in Corridor."""
    rows: list[list[Any]] = [["A0", "1", "Corridor", None, 40, 180, "Way"]]
    rows += [[f"B{at}", floor, name, count, 40, 180, "Way"] for at, (floor, name, count) in enumerate(pieces)]
    routes = [ROUTES, ["Way", "hall", "1", "Hall", "Gate", room, 1.2], ["Way", "top", "2", None, None, "Roof", 1.2]]
    found = read_inventory(write(folder, [ITEMS, *rows], FLOORS, Places=PLACES, Routes=routes))
    return [f"{one.severity} {one}" for one in found.problems if "Room" in one.message or "room" in one.message]


def test_a_slip_is_told_once_with_its_pieces_and_that_of_a_segment_there_alone(tmp_path: Path) -> None:
    assert told(tmp_path, ("1", "Coridor", None), ("1", "coridor ", 4), ("1", "Corridors", None)) == [
        "warning Items!C3: Room 'Coridor' is not that of any segment, so its 5 pieces do not count beside those of "
        "'Corridor' unless they name them. Did you mean Corridor?",
        "warning Items!C5: Room 'Corridors' is not that of any segment, so the piece does not count beside those of "
        "'Corridor' unless it names them. Did you mean Corridor?",
    ]
    pieces = [("1", name, None) for name in ("corridor", "Kitchen", "Room 12", "Hal", "Hall", "Roof", "")]
    assert told(tmp_path, *pieces) == []
    assert told(tmp_path, ("2", "Coridor", None)) == [], "on another floor it keeps nothing away"
    for room in ("South office; Corridor", "Corridor; South office"):
        assert told(tmp_path, ("1", "South office", None), ("1", "North office", None), room=room) == []
        (one,) = told(tmp_path, ("1", "South office", None), ("1", "Sout office", None), room=room)
        assert "Did you mean South office?" in one
    (one,) = told(tmp_path, ("1", "Open office", None), room="Open ofice; Hall")
    assert one.startswith("warning Routes!F2: no piece is in room 'Open ofice'")
    assert "Did you mean Open office?" in one
