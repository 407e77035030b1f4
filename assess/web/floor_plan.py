"""One floor as the plan view draws it, in metres: by the geometry of the reports and of the evacuation routes.

The picture under it lies where reports draw it once it has been placed; nothing of the user's file reaches the page as
it is.
"""

import hashlib
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from assess.model import AXES, CatalogueType, Inventory, Outline
from assess.plans.linework import unpack
from assess.report.figures.labels import Point
from assess.report.figures.plan import BORDER
from assess.report.figures.underlay import Ring, cut_falls, find_edge, list_rooms, widen
from assess.routes.geometry import angle_apart, build_bands, fallen, rectangle
from assess.routes.walls import find_walls
from assess.web.evaluation import list_floors
from assess.workbook.names import key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import SIZES, filled_sizes, places_by_name, types_by_name
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


@dataclass(frozen=True, slots=True)
class FloorPicture:
    """The picture of a floor, of lines or grey, and where it lies, if known [m, deg]; `aspect`: height over width."""

    content: bytes
    is_lines: bool
    aspect: float
    left: float | None
    bottom: float | None
    width: float | None
    turn: float = 0.0

    @property
    def corners(self) -> Sequence[Point]:
        """Its frame [m], from its lower left corner anticlockwise; nothing where it is not known where it lies."""
        if self.left is None or self.bottom is None or self.width is None:
            return ()
        angle, tall = math.radians(self.turn), self.width * self.aspect
        side = (self.left - tall / 2 * math.sin(angle), self.bottom + tall / 2 * math.cos(angle))
        return rectangle(side, self.turn, (0.0, self.width), tall)

    def describe(self, floor: str) -> dict[str, Any]:
        """Return it as the page takes it."""
        digest = hashlib.sha256(self.content).hexdigest()[:16]
        return {
            "url": f"/api/picture?floor={quote(floor, safe='')}&v={digest}", "placed": bool(self.corners),
            "height": None if self.width is None else self.width * self.aspect, "aspect": self.aspect,
            **{name: getattr(self, name) for name in ("left", "bottom", "width", "turn")},
        }  # fmt: skip


def _find_picture(snapshot: "Snapshot", row: Row | None) -> FloorPicture | None:
    """Return the picture of a floor by its row; None where it names none, or one that cannot be used."""
    plan = next((one.plan for one in snapshot.inventory.floors if row and one.row == row.number), None)
    if plan is not None:
        aspect = plan.height / plan.width
        return FloorPicture(plan.content, plan.is_lines, aspect, plan.left, plan.bottom, plan.width, plan.turn_deg)
    drawing = row and row.get("plan") and snapshot.find_drawing(row.get("plan"), row.get("plan_width"))
    if not row or not drawing:
        return None
    left, bottom, width, turn = (row.get(f"plan_{name}") for name in ("left", "bottom", "width", "turn"))
    width = drawing.width if width is None else width
    return FloorPicture(drawing.content, drawing.is_lines, drawing.aspect, left, bottom, width, turn or 0.0)


def _name_piece(row: Row) -> dict[str, Any]:
    described = row.get("description") or row.get("type") or ""
    return {"row": row.number, "item": row.get("item") or "", "description": described}


def _place(
    table: Table, row: Row, types: Mapping[str, CatalogueType], away: float | None
) -> tuple[dict[str, Any], Ring, list[Ring]]:
    """Return a piece with a position as the page takes it, its footprint, and what it may cover beyond that [m].

    `away` is the direction in which one against a wall falls [deg].
    """
    sizes = filled_sizes(table, row, types)
    breadth, height = sizes.get("breadth"), sizes.get("height")
    width = sizes.get("width", breadth)
    angle = row.get("angle_deg")
    if angle is None:
        angle = 90.0 if row.get("axis") == AXES[1] else 0.0
    drawn, wide = min(DEFAULT_SIZE, width or DEFAULT_SIZE) if breadth is None else breadth, width or DEFAULT_SIZE
    at, falls = (row.get("x"), row.get("y")), list[Ring]()
    if breadth is not None and height is not None:
        ahead, behind = fallen(at, angle, breadth, wide, height)
        falls = [ahead, behind] if away is None else [ahead if abs(angle_apart(away, angle)) < 90 else behind]
    lengths = {"x": at[0], "y": at[1], "breadth": drawn, "width": wide, "height": height}
    described = {
        **_name_piece(row), "angle": angle, "anchored": row.get("anchored") or "unknown",
        **{name: _rounded(one) for name, one in lengths.items()},
        "missing": [name for name in SIZES if sizes.get(name) is None],
    }  # fmt: skip
    return described, rectangle(at, angle, (-drawn / 2, drawn / 2), wide), falls


def _cut_all(pieces: Sequence[list[Ring]], edge: "BaseGeometry") -> list[list[Ring]]:
    """Return what pieces may cover, cut at the building's edge."""
    import shapely

    shapely.prepare(edge)
    rings = np.array([ring for falls in pieces for ring in falls])
    is_inside = iter(np.asarray(shapely.covers(edge, shapely.polygons(rings)), dtype=np.bool_).tolist())
    return [
        [part for ring in falls for part in ([ring] if next(is_inside) else cut_falls([ring], edge))]
        for falls in pieces
    ]


def _rounded(length: float | None) -> float | None:
    return None if length is None else round(length, DECIMALS)


def _round_points(points: Iterable[Point] | Outline) -> list[list[float]]:
    return [[round(x, DECIMALS), round(y, DECIMALS)] for x, y in points]


def describe_catalogue(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the answer of `GET /api/catalogue`: the types of the workbook, with their sizes [m]."""
    names = ("type", *SIZES)
    return {"types": [{name: getattr(one, name) for name in names} for one in snapshot.inventory.catalogue]}


def find_picture(snapshot: "Snapshot", floor: str) -> tuple[bytes, str] | None:
    """Return the picture of a floor as `GET /api/picture` answers it, and its media type; None where there is none."""
    named = (one for one in list_floors(snapshot.tables) if key(one.get("floor")) == key(floor))
    picture = _find_picture(snapshot, next(named, None))
    if picture is None:
        return None
    if not picture.is_lines:
        return picture.content, "image/jpeg"
    tall = WIDE * picture.aspect
    lines = (line * (WIDE, -WIDE) + (0, tall) for line in unpack(picture.content))
    path = "".join("M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in line.tolist()) for line in lines)
    drawn = f'<path d="{path}" fill="none" stroke="{STROKE}" stroke-width="1"/></svg>'
    return f"{HEAD.format(wide=WIDE, tall=tall)}{drawn}".encode(), "image/svg+xml"


def describe_plan(snapshot: "Snapshot", floor: str | None) -> dict[str, Any]:
    """Return the answer of `GET /api/plan`; the first floor where none is named, or one that is not there."""
    floors = list_floors(snapshot.tables)
    named = (one for one in floors if floor is not None and key(one.get("floor")) == key(floor))
    row = next(named, floors[0] if floors else None)
    name = row.get("floor") if row else ""
    return {
        "version": snapshot.version,
        "floor": name,
        "floor_row": row.number if row else None,
        "floors": [{"floor": one.get("floor"), "name": one.get("name") or "", "row": one.number} for one in floors],
        **_draw(snapshot.tables, snapshot.inventory, name, _find_picture(snapshot, row)),
    }


def _draw(tables: Tables, inventory: Inventory, floor: str, picture: FloorPicture | None) -> dict[str, Any]:
    def list_own(name: str) -> list[Row]:
        return [row for row in tables[name].rows if floor and key(row.get("floor") or "") == key(floor)]

    items, places = list_own("Items"), list_own("Places")
    types = types_by_name(tables["Catalogue"])
    leaning = tuple(one for one in inventory.items if one.floor == floor and one.against_wall)
    walls = find_walls(replace(inventory, items=leaning))
    away = {leaning[at].row: one.falls_toward for at, one in walls.items()}
    pieces = [_place(tables["Items"], row, types, away.get(row.number)) for row in items if _is_placed(row)]
    covered = [falls for _, _, falls in pieces]
    rooms = list_rooms([one for one in inventory.places if one.floor == floor])
    placed = [(one.x, one.y) for one in inventory.items if one.floor == floor]
    stand = [(x, y) for x, y in placed if x is not None and y is not None]
    edge = find_edge(rooms, picture.corners if picture else (), stand)
    if edge is not None and any(covered):
        covered = _cut_all(covered, edge[0])
    segments = list(_describe_segments(tables, inventory, floor))
    outlines = [_round_points(row.get("outline") or ()) for row in places]
    drawn: list[Iterable[Sequence[float]]] = [footprint for _, footprint, _ in pieces]
    drawn += [*(ring for falls in covered for ring in falls), *outlines]
    drawn += [one["outline"] or one["points"] for one in segments]
    drawn.append([(row.get("x"), row.get("y")) for row in places if _is_placed(row)])
    return {
        "frame": _frame([(x, y) for points in drawn for x, y in points], picture),
        "picture": None if picture is None else picture.describe(floor),
        "pieces": [
            {**described, "fallen": [_round_points(ring) for ring in falls]}
            for (described, *_), falls in zip(pieces, covered, strict=True)
        ],
        "unplaced": [_name_piece(row) for row in items if not _is_placed(row)],
        "places": [
            {
                "row": row.number, "place": row.get("place") or "", "kind": row.get("kind") or "",
                "outline": outline or None, "x": _rounded(row.get("x")), "y": _rounded(row.get("y")),
            }
            for row, outline in zip(places, outlines, strict=True)
        ],
        "segments": segments,
    }  # fmt: skip


def _is_placed(row: Row) -> bool:
    return row.get("x") is not None and row.get("y") is not None


def _describe_segments(tables: Tables, inventory: Inventory, floor: str) -> Iterator[dict[str, Any]]:
    places = places_by_name(tables["Places"])
    clear = [one.clear_width or one.required_width or DEFAULT_WIDTH for one in inventory.routes]
    bands = {inventory.routes[at].row: band for at, band in build_bands(inventory, clear).items() if band.length > 0}
    for row in tables["Routes"].rows:
        ends = [places.get(key(row.get(name) or "")) for name in ("start", "end")]
        own = {key(row.get("floor"))} if row.get("floor") else {key(end.get("floor") or "") for end in ends if end}
        if own != {key(floor)} or not floor:
            continue
        here = [end for end in ends if end is not None and _is_placed(end) and key(end.get("floor") or "") in own]
        band, outline = bands.get(row.number), None
        if band is not None:  # as far as it goes on round a bend
            angle = math.degrees(math.atan2(band.end[1] - band.start[1], band.end[0] - band.start[0]))
            along = (-band.extends_start, band.length + band.extends_end)
            outline = _round_points(rectangle(band.start, angle, along, band.width))
        names = {"route": "route", "segment": "segment", "from": "start", "to": "end"}
        yield {
            "row": row.number, **{name: row.get(field) or "" for name, field in names.items()}, "outline": outline,
            "points": _round_points((end.get("x"), end.get("y")) for end in here) if len(here) == len(ends) else [],
            "width": row.get("clear_width") or row.get("required_width") or DEFAULT_WIDTH,
        }  # fmt: skip


def _frame(points: Sequence[Point], picture: FloorPicture | None) -> list[float]:
    corners = picture.corners if picture else ()
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
