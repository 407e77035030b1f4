"""One floor as the plan view draws it, in metres: by the geometry of the reports and of the evacuation routes."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from assess.model import Inventory
from assess.report.figures.labels import Bounds, Point
from assess.report.figures.plan import BORDER
from assess.report.figures.underlay import find_edge, list_rooms, widen
from assess.routes.geometry import Band, build_bands
from assess.web.evaluation import list_floors
from assess.web.floor_picture import FloorPicture, find_floor_picture
from assess.web.floor_pieces import DECIMALS, cut_all, find_away, place_pieces, round_points
from assess.workbook.names import key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.resolve import build_catalogue, places_by_name
from assess.workbook.schema import DEFAULT_WIDTH

if TYPE_CHECKING:
    from assess.web.book import Snapshot

EMPTY = (12.0, 8.0)
"""Size of the frame of a floor on which there is nothing yet [m]."""
UNPLACED = 20.0
"""Width of the frame for a picture of unknown width that has not been placed yet [m]."""


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
    row = find_floor(floors, floor)
    answer = {
        "version": snapshot.version,
        "floor": row.get("floor") if row else "",
        "floor_row": row.number if row else None,
        "floors": [{"floor": one.get("floor"), "name": one.get("name") or "", "row": one.number} for one in floors],
    }
    picture = None if row is None else find_floor_picture(snapshot, row)
    return answer | _draw(snapshot.tables, snapshot.inventory, row.get("floor") if row else "", picture)


def find_floor(floors: Sequence[Row], name: str | None) -> Row | None:
    """Return the row of a floor by its name, else the first one; None where there are no floors."""
    named = (one for one in floors if name is not None and key(one.get("floor")) == key(name))
    return next(named, floors[0] if floors else None)


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
        "unplaced": [_describe_unplaced(row) for row in items if not _is_placed(row)],
        "places": [_describe_place(row) for row in places],
        "segments": segments,
        "walls": [[one, two] for ring in outlines for one, two in zip(ring, [*ring[1:], ring[0]], strict=True)],
    }


def list_on_floor(table: Table, floor: str) -> list[Row]:
    """Return the rows of a table that name a floor."""
    return [row for row in table.rows if floor and key(row.get("floor") or "") == key(floor)]


def _is_placed(row: Row) -> bool:
    return row.get("x") is not None and row.get("y") is not None


def _describe_unplaced(row: Row) -> dict[str, Any]:
    described = row.get("description") or row.get("type") or ""
    return {"row": row.number, "item": row.get("item") or "", "description": described}


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
    cos, sin = (band.end[0] - x) / long, (band.end[1] - y) / long
    before, behind = -band.extends_start, long + band.extends_end
    local = ((before, -half), (behind, -half), (behind, half), (before, half))
    return [(x + u * cos - v * sin, y + u * sin + v * cos) for u, v in local]


def _frame(points: Sequence[Point], picture: FloorPicture | None) -> list[float]:
    corners = picture.corners if picture else []
    box = _find_box(points) or _find_box(corners) or _empty_box(picture)
    if corners:
        box = widen(box, corners)
    grown = box[0] - BORDER, box[1] - BORDER, box[2] + BORDER, box[3] + BORDER
    return [round(value, DECIMALS) for value in grown]


def _find_box(points: Sequence[Point]) -> Bounds | None:
    if not points:
        return None
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _empty_box(picture: FloorPicture | None) -> Bounds:
    if picture is None:
        return 0.0, 0.0, *EMPTY
    width = picture.width or UNPLACED
    left, bottom = picture.left or 0.0, picture.bottom or 0.0
    return left, bottom, left + width, bottom + width * picture.aspect
