"""The workbooks of the nets that no user made: every flag, state and basis, routes, imports, a city."""

import shutil
from pathlib import Path
from typing import Any

from assess.i18n import load_catalogue, speaking
from assess.portfolio.example_city import write_example_city
from assess.workbook.template import Content, write_workbook
from tests.cli.calling import run
from tests.hazards import write_hazard
from tests.pictures import picture
from tests.report import routed
from tests.shaking import write_records

ROOT = Path(__file__).parents[2]
CITY = 3
"""Buildings of the city."""
Rows = list[dict[str, Any]]

EVERYTHING: dict[str, Rows] = {
    "Building": [{
        "building": "Everything <hall> & annex", "address": "1 Long Street", "latitude": 40.0, "longitude": 10.0,
        "use": "School", "client": "=client", "storeys": 4, "height": 14.0, "period": 0.8, "structure": "frame",
        "azimuth_deg": 30.0, "prepared_by": "A. Engineer", "checked_by": "B. Engineer", "approved_by": "C. Engineer",
        "revision": "2", "report_date": "2026-03-04", "organisation": "Engineers", "logo": "logo.png",
        "scenario": "An earthquake like the record", "ground_pga": 0.25, "ground_pgv": 24.0, "sds": 0.9,
        "hazard": "hazard.csv", "friction": 0.5, "restitution": 0.95, "motion_uncertainty": 0.4,
        "piece_uncertainty": "yes",
    }],
    "Floors": [
        {"floor": "G", "name": "Ground", "elevation": 0.0, "record_x": "still.csv", "record_y": "fast.csv"},
        {"floor": "1", "name": "First", "elevation": 4.0, "record_x": "pulse.csv", "pfa_y": 0.2, "pfv_y": 45.0},
        {"floor": "2", "elevation": 7.5, "pfa_x": 0.5},
        {"floor": "3", "name": "Interpolated", "elevation": 9.0},
        {"floor": "4", "elevation": 11.0, "record_x": "slow.csv", "record_y": "pulse.csv", "pfa_x": 0.6},
    ],
    "Places": [
        {"place": "Office", "floor": "1", "x": 0.0, "y": 0.0, "kind": "room", "outline": "-2 -2; 4 -2; 4 3; -2 3"},
        {"place": "Archive", "floor": "1", "x": 0.0, "y": 8.0, "kind": "room"},
        {"place": "Cupboard", "floor": "1", "kind": "room"},
        {"place": "Landing", "floor": "1", "x": 10.0, "y": 0.0, "kind": "stair"},
        {"place": "Foot", "floor": "G", "x": 10.0, "y": 0.0, "kind": "stair"},
        {"place": "Street", "floor": "G", "x": 20.0, "y": 0.0, "kind": "exit"},
    ],
    "Routes": [*routed.ROUTES, {"route": "Loft", "segment": "ladder", "floor": "3", "notes": "not surveyed"}],
    "Items": [
        {"item": "tall", "floor": "1", "room": "Office", "description": "Bookcase", "breadth": 30, "width": 80,
         "height": 200, "x": 5.0, "y": 0.9, "axis": "Y", "angle_deg": 90, "anchored": "no", "importance": "life safety",
         "photo": "photo.jpg", "notes": "Full of files"},
        {"item": "slender", "floor": "4", "description": "Locker", "breadth": 20, "width": 90, "height": 210,
         "quantity": 12, "anchored": "no", "against_wall": "yes"},
        {"item": "alike-1", "floor": "1", "room": "Archive", "breadth": 40, "width": 90, "height": 180, "axis": "X"},
        {"item": "alike-2", "floor": "1", "room": "Archive", "breadth": 40, "width": 90, "height": 180, "axis": "X"},
        {"item": "square", "floor": "2", "breadth": 60, "width": 60, "height": 200, "importance": "function"},
        {"item": "stocky", "floor": "2", "breadth": 120, "width": 150, "height": 100},
        {"item": "calm", "floor": "G", "breadth": 50, "width": 80, "height": 110, "route": "Yard",
         "edge_distance": 0.1},
        {"item": "held", "floor": "G", "breadth": 30, "width": 80, "height": 200, "anchored": "yes", "weight": 90,
         "bracket_height": 180, "bracket_capacity": 5.0, "route": "Yard", "segment": "lane", "edge_distance": 0.0},
        {"item": "weak", "floor": "4", "breadth": 30, "width": 80, "height": 220, "anchored": "yes", "weight": 300,
         "bracket_height": 200, "bracket_capacity": 0.05},
        {"item": "partly", "floor": "1", "breadth": 35, "width": 100, "height": 190, "anchored": "partly"},
        {"item": "unknown", "floor": "2", "breadth": 35, "width": 100, "height": 190, "anchored": "unknown"},
        {"item": "of a type", "floor": "3", "type": "Bookcase 5 shelves", "x": 2.0, "y": 3.0, "angle_deg": 30,
         "sizes_from": "scan"},
        {"item": "own type", "floor": "3", "type": "Own cabinet", "centre_of_gravity": 60, "friction": 0.2},
        {"item": "no width", "floor": "1", "room": "Office", "breadth": 28, "height": 210, "anchored": "no", "x": 1.0,
         "y": 1.0, "against_wall": "yes", "source_id": "3fK2"},
        {"item": "=apart", "floor": "1", "breadth": 28, "height": 210, "anchored": "no", "description": "=cmd()",
         "notes": "<b>bold</b>"},
    ],
    "Catalogue": [{"type": "Own cabinet", "breadth": 45, "width": 90, "height": 190, "weight": 80, "source": "Own"},
                  {"type": "Bookcase 5 shelves", "breadth": 30, "width": 90, "height": 180, "source": "Own"}],
    "Costs": [{"detail": "L-bracket to studs", "unit_cost": 85.0, "source": "Quote"},
              {"detail": "base angle", "unit_cost": 120.0, "source": "Quote"}],
}  # fmt: skip
"""Every flag, state and basis."""

MADE: dict[str, dict[str, Rows]] = {
    "everything": EVERYTHING,
    "routed": {"Building": [routed.BUILDING], "Floors": routed.FLOORS, "Items": routed.ITEMS,
               "Places": routed.PLACES, "Routes": routed.ROUTES},
    "partly": {"Building": [routed.BUILDING], **routed.PARTLY},
    "doubted": {"Building": [routed.BUILDING], "Items": routed.ITEMS, "Places": routed.PLACES,
                "Routes": routed.ROUTES, **routed.DOUBTED},
    "one-piece": {"Building": [{}], "Floors": [{"floor": "1", "pfa_x": 0.3}],
                  "Items": [{"item": "A", "floor": "1", "breadth": 30, "height": 200}]},
    "nothing-known": {"Building": [{"shaking": "JMA 5+, upper"}], "Floors": [{"floor": "1"}, {"floor": "2"}],
                      "Items": [{"item": at, "floor": at, "breadth": 40, "width": 80, "height": 190} for at in "12"]},
    "by-profile": {"Building": [{"sds": 1.0, "height": 20, "storeys": 5, "scenario_kind": "ASCE 7-22"}],
                   "Floors": [{"floor": str(at), "elevation": 4.0 * at} for at in range(5)],
                   "Items": [{"item": f"B{at}", "floor": str(at), "breadth": 40, "width": 80, "height": 190}
                             for at in range(5)]},
}  # fmt: skip


def make_workbooks(folder: Path) -> None:
    """Write them, and what they name, into a folder."""
    write_records(folder)
    write_hazard(folder)
    (folder / "logo.png").write_bytes(picture("PNG"))
    (folder / "photo.jpg").write_bytes(picture("JPEG"))
    for name, rows in MADE.items():
        write_workbook(folder / f"{name}.xlsx", Content(rows=rows), spare=1)
    with speaking(load_catalogue("it")):
        write_workbook(folder / "everything-it.xlsx", Content(rows=EVERYTHING), spare=1)
    write_workbook(folder / "routed-imperial.xlsx", Content(rows=MADE["routed"]), "imperial", spare=1)
    for model in ("duplex", "LargeBuilding"):
        target = folder / f"{model}.xlsx"
        done = run("import", ROOT / "samples" / "models" / f"{model}.ifc", "--out", target, "--routes", "draft")
        assert target.is_file(), done.output
    write_example_city(folder / "city", CITY)
    for number, path in enumerate(sorted((folder / "city").rglob("*.xlsx")), 1):
        shutil.copy(path, folder / f"city-{number}.xlsx")
