"""Rooms, doors, stairs and walls of a building model."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from shapely import Polygon

from assess.bim.building_model import Area, Door, Point, Space, Stair, Storey
from assess.bim.ifc_elements import (
    Element,
    find_storey,
    join_parts,
    list_elements,
    list_outer,
    list_shapes,
    tell_apart,
)
from assess.bim.ifc_site import say
from assess.bim.plan_shapes import FloatArray, Rectangle, Shape, cut, find_base, find_rectangle, merge

CUT = 1.2
"""Height above the floor at which walls are cut for the plan [m]."""
WALLS = ("IfcWall", "IfcColumn", "IfcCurtainWall", "IfcPlate", "IfcMember")
STAIRS = ("IfcStair", "IfcStairFlight", "IfcRamp", "IfcRampFlight")
CLEARLY_LONGER = 2.0
"""Ratio of sides from which a plan tells the direction of a wall by itself [-]."""
RISER = 0.35
"""Height within which the first and the last step of a stair lie [m]."""
AT_FOOT, LEAST_RISE, ABOVE_HEAD = 0.7, 1.5, 0.3
"""A stair's foot lies within this of its storey's floor; its head is at the highest storey between these above its foot
and its top [m]."""


def list_spaces(model: Any, storeys: Mapping[str, Storey]) -> Iterator[Space]:
    """Yield the rooms that have a plan, on the storeys that are given."""
    spaces = {one.id(): one for one in model.by_type("IfcSpace")}
    keys = tell_apart(spaces.values())
    shapes = dict(list_shapes(model, list(spaces.values())))
    for number, one in spaces.items():
        storey = _find_known(one, storeys)
        shape = shapes.get(number)
        area = find_base(shape) if shape is not None and storey is not None else None
        if shape is None or storey is None or area is None:
            continue
        name, title = say(one.Name), say(one.LongName)
        yield Space(keys[number], storey, name or title, "" if title == name else title, area, shape.bottom, shape.top)


def _find_known(element: Element, storeys: Mapping[str, Storey]) -> str | None:
    storey = find_storey(element)
    if storey in storeys:
        return storey
    return "" if "" in storeys else None


def list_doors(model: Any, storeys: Mapping[str, Storey], unit: float) -> Iterator[Door]:
    """Yield the doors that have a plan: that of their opening, else their own."""
    doors = model.by_type("IfcDoor")
    keys = tell_apart(doors)
    fills = [(one.id(), fill.RelatingOpeningElement) for one in doors for fill in one.FillsVoids]
    openings = {number: opening for number, opening in fills if opening is not None}
    shapes = dict(list_shapes(model, [*doors, *openings.values()]))
    for one in doors:
        storey = _find_known(one, storeys)
        opening = openings.get(one.id())
        shape = (shapes.get(opening.id()) if opening is not None else None) or shapes.get(one.id())
        plan = find_rectangle(shape.points[:, :2]) if shape is not None else None
        if plan is not None:
            plan = _turn_to_leaf(plan, shapes.get(one.id()))
        if storey is None or plan is None:
            continue
        overall = float(one.OverallWidth or 0.0) * unit
        yield Door(
            keys[one.id()], storey, say(one.Name), plan.x, plan.y, plan.angle_deg, plan.long, plan.short,
            overall if math.isfinite(overall) and overall > 0 else 0.0,
        )  # fmt: skip


def _turn_to_leaf(plan: Rectangle, leaf: Shape | None) -> Rectangle:
    """Return the plan of an opening with the direction of the door's normal, which a leaf tells if it is squarish."""
    own = find_rectangle(leaf.points[:, :2]) if leaf is not None else None
    if own is None or plan.long >= CLEARLY_LONGER * plan.short or own.long < CLEARLY_LONGER * own.short:
        return plan
    # the short side of a rectangle is taken for the thickness of the wall; here the door itself tells it
    is_across = abs(math.sin(math.radians(own.angle_deg - plan.angle_deg))) > 0.9
    return replace(plan, short=plan.long, long=plan.short, angle_deg=own.angle_deg) if is_across else plan


def list_stairs(model: Any, storeys: Sequence[Storey]) -> Iterator[Stair]:
    """Yield foot and head of each stair and ramp, on the storeys that they join."""
    stairs = {one.id(): one for one in list_outer(list_elements(model, STAIRS))}
    keys = tell_apart(stairs.values())
    for number, shape in sorted(join_parts(model, list(stairs.values())), key=lambda one: one[0]):
        key, name, low, high = keys[number], say(stairs[number].Name), shape.bottom, shape.top
        feet = [one for one in storeys if abs(one.level - low) < AT_FOOT]
        heads = [one for one in storeys if low + LEAST_RISE < one.level < high + ABOVE_HEAD]
        if feet:
            foot = min(feet, key=lambda one: abs(one.level - low))
            yield Stair(key, foot.key, name, "foot", *_find_step(shape.points, low))
        if heads:
            head = max(heads, key=lambda one: one.level)
            yield Stair(key, head.key, name, "head", *_find_step(shape.points, min(head.level, high)))


def _find_step(points: FloatArray, level: float) -> Point:
    near = points[np.abs(points[:, 2] - level) < RISER]
    plan = (near if len(near) else points)[:, :2]
    x, y = (plan.max(axis=0) + plan.min(axis=0)) / 2
    return float(x), float(y)


Plans = dict[str, tuple[Area, ...]]
"""Areas by the key of their storey."""


def cut_walls(model: Any, storeys: Sequence[Storey]) -> tuple[Plans, Plans]:
    """Return what stands and what is glazed at 1.2 m above the floor of each storey."""
    elements = {one.id(): one for one in list_elements(model, (*WALLS, "IfcWindow"))}
    walls: dict[str, list[Polygon]] = {}
    windows: dict[str, list[Polygon]] = {}
    cuts = {
        number: [cut(shape, storey.level + CUT) for storey in storeys]
        for number, shape in list_shapes(model, list(elements.values()), with_openings=True)
    }
    for number in sorted(cuts):
        kept = windows if elements[number].is_a("IfcWindow") else walls
        for storey, polygons in zip(storeys, cuts[number], strict=True):
            kept.setdefault(storey.key, []).extend(polygons)
    return {key: merge(some) for key, some in walls.items()}, {key: merge(some) for key, some in windows.items()}
