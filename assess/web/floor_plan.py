"""One floor as the plan view draws it, in metres: by the geometry of the reports and of the evacuation routes.

The picture under it lies where reports draw it once it has been placed; nothing of the user's file reaches the page as
it is.
"""

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from assess.model import AXES, CatalogueType, FloorPlan, Inventory, Outline
from assess.plans.linework import unpack
from assess.report.figures.labels import Point
from assess.report.figures.plan import BORDER
from assess.report.figures.underlay import Ring, cut_falls, find_edge, list_rooms, widen
from assess.routes.geometry import Band, angle_apart, build_bands, fallen, rectangle
from assess.routes.walls import find_walls
from assess.web.evaluation import list_floors
from assess.workbook.names import key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import SIZES, build_catalogue, filled_sizes, places_by_name
from assess.workbook.schema import DEFAULT_WIDTH

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from assess.web.book import Snapshot

EMPTY = (12.0, 8.0)
"""Size of the frame of a floor on which there is nothing yet [m]."""
UNPLACED = 20.0
"""Width of the frame for a picture of unknown width that has not been placed yet [m]."""


DEFAULT_SIZE = 0.4
"""Side of a piece whose sizes are missing, so that it can be seen and moved [m]."""
DECIMALS = 4
"""Decimals of coordinates: a tenth of a millimetre."""
WIDE = 1000
"""Width of the drawing made of a picture's lines, in its own units."""
STROKE = "#757575"
"""Colour of its lines, as in reports."""
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{tall:.2f}" viewBox="0 0 {wide} {tall:.2f}">'


# ---------------------------------------------------------------- the picture


@dataclass(frozen=True, slots=True)
class FloorPicture:
    """The picture of a floor; of one that has not been placed yet some of the numbers are None.

    Parameters
    ----------
    content : bytes
        As `assess.model.FloorPlan` has it: nothing of the user's file reaches the page as it is.
    is_lines : bool
        Whether it is a drawing of lines.
    aspect : float
        Height over width [-].
    left, bottom, width : float, optional
        Where it lies, and how wide it is [m].
    turn : float
        By how much it is turned [deg].
    """

    content: bytes
    is_lines: bool
    aspect: float
    left: float | None
    bottom: float | None
    width: float | None
    turn: float = 0.0

    @classmethod
    def of(cls, plan: FloorPlan) -> "FloorPicture":
        """Return that of a plan which is placed."""
        aspect = plan.height / plan.width
        return cls(plan.content, plan.is_lines, aspect, plan.left, plan.bottom, plan.width, plan.turn_deg)

    @property
    def is_placed(self) -> bool:
        """Whether it is known where it lies."""
        return None not in (self.left, self.bottom, self.width)

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Its frame [m], from its lower left corner anticlockwise; nothing where it is not placed."""
        if self.left is None or self.bottom is None or self.width is None:
            return []
        angle, tall = np.radians(self.turn), self.width * self.aspect
        local = ((0.0, 0.0), (self.width, 0.0), (self.width, tall), (0.0, tall))
        return _move(local, (self.left, self.bottom), float(np.cos(angle)), float(np.sin(angle)))

    def describe(self, floor: str) -> dict[str, Any]:
        """Return it as the page takes it."""
        digest = hashlib.sha256(self.content).hexdigest()[:16]
        return {
            "url": f"/api/picture?floor={quote(floor, safe='')}&v={digest}",
            "left": self.left,
            "bottom": self.bottom,
            "width": self.width,
            "height": None if self.width is None else self.width * self.aspect,
            "turn": self.turn,
            "placed": self.is_placed,
            "aspect": self.aspect,
        }

    def draw(self) -> tuple[bytes, str]:
        """Return what the browser shows of it, and its media type: of lines an SVG with one path."""
        if not self.is_lines:
            return self.content, "image/jpeg"
        tall = WIDE * self.aspect
        lines = (line * (WIDE, -WIDE) + (0, tall) for line in unpack(self.content))
        path = "".join("M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in line.tolist()) for line in lines)
        head = HEAD.format(wide=WIDE, tall=tall)
        return (
            f'{head}<path d="{path}" fill="none" stroke="{STROKE}" stroke-width="1"/></svg>'.encode(),
            "image/svg+xml",
        )


def find_floor_picture(snapshot: "Snapshot", row: Row) -> FloorPicture | None:
    """Return the picture of a floor by its row; None where it names none, or one that cannot be used."""
    plan = next((one.plan for one in snapshot.inventory.floors if one.row == row.number), None)
    if plan is not None:
        return FloorPicture.of(plan)
    text = row.get("plan")
    drawing = None if text is None else snapshot.find_drawing(text, row.get("plan_width"))
    if drawing is None:
        return None
    numbers = {name: row.get(f"plan_{name}") for name in ("left", "bottom", "width")}
    numbers["width"] = drawing.width if numbers["width"] is None else numbers["width"]
    return FloorPicture(drawing.content, drawing.is_lines, drawing.aspect, **numbers, turn=row.get("plan_turn") or 0.0)


# ---------------------------------------------------------------- the pieces


@dataclass(frozen=True, slots=True)
class PlacedPiece:
    """A piece with a position; `falls` is what it may cover beyond its footprint [m], `missing` its unknown sizes."""

    row: Row
    at: Point
    angle: float
    breadth: float
    width: float
    height: float | None
    missing: tuple[str, ...]
    falls: tuple[Ring, ...] = ()

    @property
    def corners(self) -> Ring:
        """Its footprint [m]."""
        return rectangle(self.at, self.angle, (-self.breadth / 2, self.breadth / 2), self.width)

    def describe(self) -> dict[str, Any]:
        """Return it as the page takes it."""
        row = self.row
        return {
            "row": row.number,
            "item": row.get("item") or "",
            "description": _describe(row),
            "x": round(self.at[0], DECIMALS),
            "y": round(self.at[1], DECIMALS),
            "angle": self.angle,
            "breadth": round(self.breadth, DECIMALS),
            "width": round(self.width, DECIMALS),
            "height": None if self.height is None else round(self.height, DECIMALS),
            "anchored": row.get("anchored") or "unknown",
            "quantity": row.get("quantity") or 1,
            "fallen": [round_points(ring) for ring in self.falls],
            "missing": [*self.missing],
        }


def place_pieces(
    table: Table, rows: Iterable[Row], types: Mapping[str, CatalogueType], away: Mapping[int, float]
) -> list[PlacedPiece]:
    """Return the pieces of some rows that have a position.

    `away` holds, of the pieces against a wall, the direction in which each falls [deg], by the number of their row.
    """
    return [_place(table, row, types, away.get(row.number)) for row in rows if _is_placed(row)]


def _place(table: Table, row: Row, types: Mapping[str, CatalogueType], away: float | None) -> PlacedPiece:
    sizes = filled_sizes(table, row, types)
    breadth, height = sizes.get("breadth"), sizes.get("height")
    width = sizes.get("width", breadth)
    angle = row.get("angle_deg")
    if angle is None:
        angle = 90.0 if row.get("axis") == AXES[1] else 0.0
    piece = PlacedPiece(
        row=row,
        at=(row.get("x"), row.get("y")),
        angle=angle,
        breadth=min(DEFAULT_SIZE, width or DEFAULT_SIZE) if breadth is None else breadth,
        width=width or DEFAULT_SIZE,
        height=height,
        missing=tuple(name for name in SIZES if sizes.get(name) is None),
    )
    return piece if breadth is None or height is None else replace(piece, falls=_list_falls(piece, height, away))


def _list_falls(piece: PlacedPiece, height: float, away: float | None) -> tuple[Ring, ...]:
    ahead, behind = fallen(piece.at, piece.angle, piece.breadth, piece.width, height)
    if away is None:
        return ahead, behind
    return (ahead,) if abs(angle_apart(away, piece.angle)) < 90 else (behind,)


def find_away(inventory: Inventory, floor: str) -> dict[int, float]:
    """Return the direction in which the pieces of a floor that stand against a wall fall [deg], by their rows."""
    own = tuple(one for one in inventory.items if one.floor == floor and one.against_wall)
    walls = find_walls(replace(inventory, items=own))
    return {own[at].row: one.falls_toward for at, one in walls.items() if one.falls_toward is not None}


def cut_all(pieces: Sequence[PlacedPiece], edge: "BaseGeometry | None") -> list[PlacedPiece]:
    """Return pieces with what they may cover cut at the building's edge; as they are where that is not known."""
    if edge is None or not any(one.falls for one in pieces):
        return list(pieces)
    import numpy as np
    import shapely

    shapely.prepare(edge)
    rings = np.array([ring for one in pieces for ring in one.falls])
    is_inside = iter(np.asarray(shapely.covers(edge, shapely.polygons(rings)), dtype=np.bool_).tolist())
    return [replace(one, falls=tuple(_cut(one.falls, edge, is_inside))) for one in pieces]


def _cut(falls: Iterable[Ring], edge: "BaseGeometry", is_inside: Iterator[bool]) -> Iterator[Ring]:
    for ring in falls:
        yield from (ring,) if next(is_inside) else cut_falls([ring], edge)


def round_points(points: Iterable[Point] | Outline) -> list[list[float]]:
    """Return points for the page."""
    return [[round(x, DECIMALS), round(y, DECIMALS)] for x, y in points]


# ---------------------------------------------------------------- what the page asks for


def describe_catalogue(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the answer of `GET /api/catalogue`: the types of the workbook, with their sizes [m]."""
    return {
        "types": [
            {"type": one.type, "breadth": one.breadth, "width": one.width, "height": one.height}
            for one in snapshot.inventory.catalogue
        ]
    }


def find_picture(snapshot: "Snapshot", floor: str) -> tuple[bytes, str] | None:
    """Return the picture of a floor as `GET /api/picture` answers it, and its media type; None where there is none."""
    row = next((one for one in list_floors(snapshot.tables) if key(one.get("floor")) == key(floor)), None)
    picture = None if row is None else find_floor_picture(snapshot, row)
    return None if picture is None else picture.draw()


def describe_plan(snapshot: "Snapshot", floor: str | None) -> dict[str, Any]:
    """Return the answer of `GET /api/plan`; the first floor where none is named, or one that is not there."""
    floors = list_floors(snapshot.tables)
    named = (one for one in floors if floor is not None and key(one.get("floor")) == key(floor))
    row = next(named, floors[0] if floors else None)
    answer: dict[str, Any] = {
        "version": snapshot.version,
        "floor": row.get("floor") if row else "",
        "floor_row": row.number if row else None,
        "floors": [{"floor": one.get("floor"), "name": one.get("name") or "", "row": one.number} for one in floors],
    }
    picture = None if row is None else find_floor_picture(snapshot, row)
    return answer | _draw(snapshot.tables, snapshot.inventory, answer["floor"], picture)


def _draw(tables: Tables, inventory: Inventory, floor: str, picture: FloorPicture | None) -> dict[str, Any]:
    items, places = list_on_floor(tables["Items"], floor), list_on_floor(tables["Places"], floor)
    types = {key(one.type): one for one in build_catalogue(tables["Catalogue"])}
    rooms = list_rooms([one for one in inventory.places if one.floor == floor])
    placed = [(one.x, one.y) for one in inventory.items if one.floor == floor]
    stand = [(x, y) for x, y in placed if x is not None and y is not None]
    edge = find_edge(rooms, picture.corners if picture else (), stand)
    pieces = cut_all(
        place_pieces(tables["Items"], items, types, find_away(inventory, floor)), None if edge is None else edge[0]
    )
    segments = list(_describe_segments(tables, inventory, floor))
    outlines = [round_points(row.get("outline")) for row in places if row.get("outline")]
    drawn: list[Iterable[Sequence[float]]] = [ring for one in pieces for ring in (one.corners, *one.falls)]
    drawn += [*outlines, *(one["outline"] or one["points"] for one in segments)]
    drawn.append([(row.get("x"), row.get("y")) for row in places if _is_placed(row)])
    return {
        "frame": _frame([(x, y) for points in drawn for x, y in points], picture),
        "picture": None if picture is None else picture.describe(floor),
        "pieces": [one.describe() for one in pieces],
        "unplaced": [
            {"row": row.number, "item": row.get("item") or "", "description": _describe(row)}
            for row in items
            if not _is_placed(row)
        ],
        "places": [_describe_place(row) for row in places],
        "segments": segments,
        "walls": [[one, two] for ring in outlines for one, two in zip(ring, [*ring[1:], ring[0]], strict=True)],
    }


def list_on_floor(table: Table, floor: str) -> list[Row]:
    """Return the rows of a table that name a floor."""
    return [row for row in table.rows if floor and key(row.get("floor") or "") == key(floor)]


def _is_placed(row: Row) -> bool:
    return row.get("x") is not None and row.get("y") is not None


def _describe(row: Row) -> str:
    return row.get("description") or row.get("type") or ""


def _describe_place(row: Row) -> dict[str, Any]:
    outline = row.get("outline")
    return {
        "row": row.number,
        "place": row.get("place") or "",
        "kind": row.get("kind") or "",
        "outline": round_points(outline) if outline else None,
        "x": None if row.get("x") is None else round(row.get("x"), DECIMALS),
        "y": None if row.get("y") is None else round(row.get("y"), DECIMALS),
    }


def _describe_segments(tables: Tables, inventory: Inventory, floor: str) -> Iterator[dict[str, Any]]:
    places = places_by_name(tables["Places"])
    bands = _list_bands(inventory)
    for row in tables["Routes"].rows:
        ends = [places.get(key(row.get(name) or "")) for name in ("start", "end")]
        own = {key(row.get("floor"))} if row.get("floor") else {key(end.get("floor") or "") for end in ends if end}
        if own != {key(floor)} or not floor:
            continue
        here = [end for end in ends if end is not None and _is_placed(end) and key(end.get("floor") or "") in own]
        band = bands.get(row.number)
        yield {
            "row": row.number,
            "route": row.get("route") or "",
            "segment": row.get("segment") or "",
            "points": round_points((end.get("x"), end.get("y")) for end in here) if len(here) == len(ends) else [],
            "width": row.get("clear_width") or row.get("required_width") or DEFAULT_WIDTH,
            "from": row.get("start") or "",
            "to": row.get("end") or "",
            "outline": None if band is None else round_points(outline_band(band)),
        }


def _list_bands(inventory: Inventory) -> dict[int, Band]:
    clear = [one.clear_width or one.required_width or DEFAULT_WIDTH for one in inventory.routes]
    return {inventory.routes[at].row: band for at, band in build_bands(inventory, clear).items() if band.length > 0}


def outline_band(band: Band) -> list[Point]:
    """Return the corners of a band on the plan, as far as it goes on round a bend [m]."""
    (x, y), long, half = band.start, band.length, band.width / 2
    before, behind = -band.extends_start, long + band.extends_end
    local = ((before, -half), (behind, -half), (behind, half), (before, half))
    return _move(local, (x, y), (band.end[0] - x) / long, (band.end[1] - y) / long)


def _move(local: Iterable[Point], to: Point, cos: float, sin: float) -> list[Point]:
    """Return points turned by the angle of a cosine and a sine, and moved."""
    return [(to[0] + x * cos - y * sin, to[1] + x * sin + y * cos) for x, y in local]


def _frame(points: Sequence[Point], picture: FloorPicture | None) -> list[float]:
    corners = picture.corners if picture else []
    if framed := points or corners:
        xs, ys = zip(*framed, strict=True)
        box = min(xs), min(ys), max(xs), max(ys)
    elif picture is None:
        box = 0.0, 0.0, *EMPTY
    else:
        width, left, bottom = picture.width or UNPLACED, picture.left or 0.0, picture.bottom or 0.0
        box = left, bottom, left + width, bottom + width * picture.aspect
    if corners:
        box = widen(box, corners)
    grown = box[0] - BORDER, box[1] - BORDER, box[2] + BORDER, box[3] + BORDER
    return [round(value, DECIMALS) for value in grown]
