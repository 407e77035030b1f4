"""Buildings drawn by hand, as models: rooms along corridors, with walls, doors and furniture."""

from collections.abc import Sequence
from typing import Any

from assess.bim.building_model import Area, BuildingModel, Door, Piece, Space, Stair, Storey

DEEP, LONG, WIDE, WALL = 5.0, 4.0, 2.0, 0.1
"""Depth and length of a room, width of a corridor, thickness of walls [m]."""
LEAF = 0.9


def rectangle(x: float, y: float, u: float, v: float) -> Area:
    return (((x, y), (u, y), (u, v), (x, v)),)


def door(key: str, x: float, y: float, normal: float = 90.0, storey: str = "0", overall: float = LEAF) -> Door:
    """Return a door as wide as its opening."""
    return Door(key, storey, key, x, y, normal, LEAF, WALL, overall)


def room(key: str, *corners: float, storey: str = "0") -> Space:
    return Space(key, storey, key, "", rectangle(*corners), 0.0, 3.0)


def piece(key: str, x: float, y: float, space: str = "", storey: str = "0", **more: Any) -> Piece:
    values = {"breadth": 0.4, "width": 1.0, "height": 2.0, "angle_deg": 90.0, "support_breadth": 0.4,
              "support_width": 1.0, "bottom": 0.0} | more  # fmt: skip
    return Piece(key=key, storey=storey, space=space, ifc_class="IfcFurniture", name=key, type="Cabinet",
                 x=x, y=y, **values)  # fmt: skip


def cut(start: float, end: float, gaps: Sequence[float]) -> list[tuple[float, float]]:
    """Return the parts of a wall between doors at some places."""
    edges = [start, *(edge for gap in sorted(gaps) for edge in (gap - LEAF / 2, gap + LEAF / 2)), end]
    return list(zip(edges[::2], edges[1::2], strict=True))


def build_corridor(number: int, rooms: int, storey: str, *, exits: bool, furnished: bool) -> dict[str, list[Any]]:
    """Return a corridor with rooms on both sides, and a door at either end that leads out."""
    y, length = number * (2 * DEEP + WIDE + 4 * WALL), rooms * LONG + (rooms - 1) * WALL
    low, high = y + DEEP + WALL, y + DEEP + WALL + WIDE  # of the corridor
    own = f"{storey} c{number}"
    found: dict[str, list[Any]] = {"spaces": [], "doors": [], "walls": [], "pieces": []}
    found["spaces"].append(Space(own, storey, own, "", rectangle(0, low, length, high), 0.0, 3.0))
    middles = [at * (LONG + WALL) + LONG / 2 for at in range(rooms)]
    for side, (bottom, top, wall) in enumerate(((y, y + DEEP, low - WALL), (high + WALL, high + WALL + DEEP, high))):
        for at, x in enumerate(middles):
            key = f"{own} r{side}{at}"
            left = x - LONG / 2
            found["spaces"].append(Space(key, storey, key, "", rectangle(left, bottom, left + LONG, top), 0.0, 3.0))
            found["doors"].append(door(f"{key} door", x, wall + WALL / 2, storey=storey))
            found["walls"].append(rectangle(left + LONG, bottom, left + LONG + WALL, top))
            if furnished:
                back = bottom + 0.3 if side == 0 else top - 0.3
                found["pieces"] += [piece(f"{key} p{n}", left + 0.6 + n * 1.2, back, key, storey) for n in range(3)]
                found["pieces"].append(piece(f"{key} desk", x, (bottom + top) / 2, key, storey, breadth=0.8, width=1.6,
                                             height=0.75))  # fmt: skip
        found["walls"] += [rectangle(one, wall, other, wall + WALL) for one, other in cut(-WALL, length, middles)]
        outer = bottom - WALL if side == 0 else top
        found["walls"].append(rectangle(-WALL, outer, length + WALL, outer + WALL))
    for at, x in enumerate((-WALL, length)):
        gaps = [(low + high) / 2] if exits else []
        if exits:
            found["doors"].append(door(f"{own} exit{at}", x + WALL / 2, gaps[0], 0.0, storey))
        found["walls"] += [rectangle(x, one, x + WALL, other) for one, other in cut(y, high + WALL + DEEP, gaps)]
    return found


def build_office(
    corridors: int = 1, rooms: int = 3, *, storeys: int = 1, exits: bool = True, furnished: bool = True
) -> BuildingModel:
    """Return an office of `corridors` with twice `rooms` each; on upper storeys a stair stands in each corridor."""
    parts: dict[str, list[Any]] = {"spaces": [], "doors": [], "pieces": [], "stairs": []}
    walls: dict[str, tuple[Area, ...]] = {}
    for level in range(storeys):
        found = [
            build_corridor(number, rooms, str(level), exits=exits and level == 0, furnished=furnished)
            for number in range(corridors)
        ]
        for name in ("spaces", "doors", "pieces"):
            parts[name] += [one for corridor in found for one in corridor[name]]
        walls[str(level)] = tuple(wall for corridor in found for wall in corridor["walls"])
        for number in range(corridors if level else 0):
            y = number * (2 * DEEP + WIDE + 4 * WALL) + DEEP + WALL + WIDE / 2
            ends = (("foot", str(level - 1), 1.0), ("head", str(level), 4.0))
            parts["stairs"] += [Stair(f"{level} s{number}", storey, "Stair", end, x, y) for end, storey, x in ends]
    return BuildingModel(
        source="office.ifc",
        schema="IFC4",
        storeys=tuple(Storey(str(at), f"Level {at}", 3.5 * at, 3.5 * at) for at in range(storeys)),
        walls=walls,
        **{name: tuple(own) for name, own in parts.items()},
    )


def name_all(model: BuildingModel) -> dict[str, str]:
    """Return names of places as the writer of a workbook gives them, each its own."""
    found = {one.key: f"Room {one.key}" for one in model.spaces} | {one.key: f"Door {one.key}" for one in model.doors}
    return found | {f"{one.key} {one.end}": f"Stair {one.key}, {one.end}" for one in model.stairs}
