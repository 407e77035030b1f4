"""Small buildings with routes, built in code, and pieces whose falls are told outright."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from assess.arrays import BoolArray
from assess.model import Building, Floor, Inventory, Item, Place, Segment
from assess.route_results import Chance, RouteTables, SegmentRow
from assess.routes.chances import Falls
from assess.routes.evaluate import evaluate_routes
from assess.routes.obstructions import find_obstructions
from assess.settings import Settings

RISK = 0.03


def make_falls(
    probability: Sequence[float],
    *,
    high: Sequence[float] | None = None,
    fell: Mapping[int, Sequence[bool] | BoolArray] | None = None,
    unconfirmed: Sequence[int] = (),
    in_record: Sequence[float] | None = None,
    stands: Sequence[bool] | None = None,
    anchored: Sequence[bool] | None = None,
    quantity: Sequence[int] | None = None,
) -> Falls:
    """Return how pieces fall, from plain numbers; by default without outcomes, free-standing, one in each row.

    `unconfirmed` are the pieces whose chance is not confirmed, by their place.
    """
    n, known = len(probability), {at: np.array(one, dtype=np.bool_) for at, one in (fell or {}).items()}
    return Falls(
        probability=np.array(probability, dtype=np.float64),
        high=np.array(high or probability, dtype=np.float64),
        fell=known,
        unconfirmed=dict.fromkeys(unconfirmed, ("unconfirmed_building",)),
        in_record=np.array(in_record or [np.nan] * n, dtype=np.float64),
        stands=np.array(stands or [False] * n, dtype=np.bool_),
        anchored=np.array(anchored or [False] * n, dtype=np.bool_),
        quantity=np.array(quantity or [1] * n, dtype=np.intp),
    )


def told(*rows: str, **more: Any) -> Falls:
    """Return pieces that fall in the motions marked 1 of their rows, each with the chance that follows."""
    fell = {at: [mark == "1" for mark in row] for at, row in enumerate(rows)}
    return make_falls([row.count("1") / len(row) for row in rows], fell=fell, **more)


def piece(height: float, edge: float | None = None, *, route: str = "", segment: str = "", **more: Any) -> Item:
    """Return a piece 0.4 m deep: by its Edge distance where `edge` is given, beside Way a unless told otherwise."""
    if edge is not None or not more.keys() & {"x", "y"}:
        route, segment = route or "Way", segment if route else "a"
    given = {"row": 2, "item": "", "floor": "1", "breadth": 0.4} | more
    return Item(height=height, edge_distance=edge, route=route, segment=segment, **given)


def stretch(name: str = "a", start: str = "", end: str = "", *, route: str = "Way", **more: Any) -> Segment:
    """Return a segment of floor 1, 1.8 m clear and 0.9 m required unless told otherwise."""
    given = {"floor": "1", "clear_width": 1.8, "required_width": 0.9} | more
    return Segment(row=2, route=route, segment=name, start=start, end=end, **given)


def place(name: str, kind: str = "", at: tuple[float, float] | None = None, floor: str = "1") -> Place:
    """Return a place."""
    x, y = at or (None, None)
    return Place(row=2, place=name, floor=floor, x=x, y=y, kind=kind)


CORRIDOR = (place("West", "room", (0, 0)), place("East", "exit", (10, 0)))
"""Two places 10 m apart along X."""


def corridor(clear: float = 1.8, required: float = 0.9, **more: Any) -> Segment:
    """Return the segment between them."""
    return stretch("a", "West", "East", clear_width=clear, required_width=required, **more)


def building(items: Sequence[Item], segments: Sequence[Segment], places: Sequence[Place] = ()) -> Inventory:
    """Return an inventory with these rows, the items named by their place in it."""
    named = tuple(one if one.item else replace(one, item=f"P{at}") for at, one in enumerate(items))
    names = [*(one.floor for one in segments), *(one.floor for one in places), *(one.floor for one in items)]
    return Inventory(
        source=Path("building.xlsx"),
        sha256="",
        building=Building(),
        floors=tuple(Floor(row=2, floor=name) for name in dict.fromkeys(names) if name),
        items=named,
        places=tuple(places),
        routes=tuple(segments),
    )


def evaluated(
    falls: Falls,
    items: Sequence[Item],
    segments: Sequence[Segment] = (stretch(),),
    places: Sequence[Place] = (),
    *,
    risk: float = RISK,
    seed: int = 1,
) -> RouteTables:
    """Evaluate the routes of such a building; intervals are of 95 %."""
    inventory = building(items, segments, places)
    settings = Settings(runs=200, route_risk=risk, seed=seed)
    found = evaluate_routes(inventory, find_obstructions(inventory), falls, settings)
    assert found is not None
    return found


def one_segment(falls: Falls, items: Sequence[Item], segment: Segment | None = None, **more: Any) -> SegmentRow:
    """Evaluate a building of one segment and return it; with positions, the segment is that of `CORRIDOR`."""
    found = evaluated(falls, items, [segment or stretch()], CORRIDOR if segment and segment.start else (), **more)
    return found.segments[0]


def values(chance: Chance) -> tuple[float, float, float]:
    """Return the joint, independent and correlated value."""
    return chance.joint, chance.independent, chance.correlated
