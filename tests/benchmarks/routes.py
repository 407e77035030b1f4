"""Benchmark of evacuation routes: how much of a whole verified run their evaluation takes, on 60 floors."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from assess.workbook.template import Content, write_workbook

FLOORS, ITEMS, AIM = 60, 2000, 5
"""Floors, pieces, and the share of the run that routes may take [%]."""

TIMED = """
import json, sys, time
import assess
from assess.pipeline import adopt
from assess.routes import evaluate, obstructions
spent = []
def timed(module, name):
    real = getattr(module, name)
    def work(*given, **named):
        start = time.perf_counter()
        found = real(*given, **named)
        spent.append(time.perf_counter() - start)
        return found
    setattr(module, name, work)
timed(obstructions, "find_obstructions")
timed(adopt, "build_falls")
timed(evaluate, "evaluate_routes")
timed(obstructions, "find_route_problems")
start = time.perf_counter()
found = assess.run(assess.read_inventory(sys.argv[1]))
times = [time.perf_counter() - start]
for formats in ("json,csv", "pdf,html,xlsx"):
    start = time.perf_counter()
    assess.write_reports(found, sys.argv[2], formats=formats.split(","))
    times.append(time.perf_counter() - start)
beside = sum(len(one.pieces) for one in found.route_tables.segments)
print(json.dumps([sum(spent), beside, *times]))
"""


def rows(folder: Path) -> Iterator[str]:
    """Yield a table in Markdown; workbook and reports are written into `folder`."""
    book = write_tower(folder / "tower.xlsx")
    command = [sys.executable, "-c", TIMED, str(book), str(folder / "out")]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    routes, beside, assessed, data, reports = json.loads(done.stdout.splitlines()[-1])
    yield f"| {ITEMS:,} items, {FLOORS} floors, {5 * FLOORS} segments | whole run [s] | routes [s] | share | aim |"
    yield "|---|---|---|---|---|"
    for name, whole in (("json,csv", assessed + data), ("all formats", assessed + data + reports)):
        yield f"| verified, {name} | {whole:.1f} | {routes:.2f} | {100 * routes / whole:.1f} % | at most {AIM} % |"
    yield f"\nPieces beside a segment: {beside / (5 * FLOORS):.1f} on average."


def write_tower(path: Path) -> Path:
    """Write the workbook of a tower that shakes with 0.1 g at its foot and 0.34 g at its top.

    On every floor there is an office with two stairs, which lead down to two exits.
    """
    rng = np.random.default_rng(1)
    floors = [str(at) for at in range(1, FLOORS + 1)]
    rows = {
        "Building": [{"building": "Tower"}],
        "Floors": [
            {"floor": floor, "elevation": 3.5 * at, "pfa_x": 0.1 + 0.004 * at, "pfv_x": 12.0 + at / 2,
             "pfa_y": 0.08 + 0.004 * at, "pfv_y": 10.0 + at / 2}
            for at, floor in enumerate(floors)
        ],
        "Items": [_piece(rng, at, floors[at % FLOORS], at // FLOORS) for at in range(ITEMS)],
        "Places": [place for floor in floors for place in _places(floor)],
        "Routes": [segment for at in range(FLOORS) for segment in _segments(floors, at)],
    }  # fmt: skip
    write_workbook(path, Content(rows=rows))
    return path


def _places(floor: str) -> list[dict[str, Any]]:
    """Return the places of a floor: corridors along X from the hall to either stair, the office north of it."""
    found = [("Office", "room", 0, 4), ("Hall", "", 0, 0), ("West", "stair", -15, 0), ("East", "stair", 15, 0)]
    if floor == "1":
        found += [("West exit", "exit", -17, 0), ("East exit", "exit", 17, 0)]
    return [
        {"place": f"{floor} {name}", "floor": floor, "kind": kind or None, "x": x, "y": y} for name, kind, x, y in found
    ]


def _segments(floors: list[str], at: int) -> list[dict[str, Any]]:
    floor = floors[at]
    own = [("door", "Office", "Hall", 1.2), ("west", "Hall", "West", 1.8), ("east", "Hall", "East", 1.8)]
    found = [
        {"route": f"Floor {floor}", "segment": name, "floor": floor, "start": f"{floor} {start}",
         "end": f"{floor} {end}", "clear_width": clear, "required_width": 0.9, "occupants": 40}
        for name, start, end, clear in own
    ]  # fmt: skip
    for side in ("West", "East"):
        down = f"{floors[at - 1]} {side}" if at else f"{floor} {side} exit"
        found.append(
            {"route": f"{side} stair", "segment": f"from {floor}", "floor": None if at else floor,
             "start": f"{floor} {side}", "end": down, "clear_width": 1.4, "required_width": 0.9}
        )  # fmt: skip
    return found


def _piece(rng: np.random.Generator, number: int, floor: str, on_floor: int) -> dict[str, Any]:
    """Return a piece of a floor's 33: 18 along the corridors, 5 at the door, 3 that name a segment, others far off."""
    height = rng.uniform(90, 220)
    found = {"item": f"P{number:04d}", "floor": floor, "description": "Bookcase",
             "breadth": round(height * rng.uniform(0.12, 0.4), 1), "width": 90, "height": round(height, 1),
             "anchored": "yes" if number % 11 == 0 else "no"}  # fmt: skip
    side = 1 if on_floor % 2 else -1
    if on_floor < 18:
        along = (-1 if on_floor < 9 else 1) * rng.uniform(1.5, 14)
        return found | {"x": round(along, 2), "y": round(side * rng.uniform(1.1, 1.9), 2), "angle_deg": 90}
    if on_floor < 23:
        x, y = side * rng.uniform(0.9, 1.4), rng.uniform(1.2, 3.8)
        return found | {"x": round(x, 2), "y": round(y, 2), "angle_deg": 0}
    if on_floor < 26:
        segment, edge = ("door", "west", "east")[on_floor % 3], round(rng.uniform(0, 1), 2)
        return found | {"axis": "Y", "route": f"Floor {floor}", "segment": segment, "edge_distance": edge}
    return found | {"x": round(rng.uniform(-12, 12), 2), "y": round(rng.uniform(6, 12), 2), "angle_deg": 0}
