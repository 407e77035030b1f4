"""A building model as the rows of an inventory, with a plan of each storey beside it.

Breadth is the distance between the outer supports where that is less than the body's, as pieces rock about their
supports; where the supports stand closest along the longer side, Breadth lies along that. Of a base with oblique edges,
three legs or a cross, it is twice the distance from the middle of the body to the nearest edge. Supports off the
middle, such as a plinth set back at the front only, are warned of, with the Breadth as which the piece tips there.
"""

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from assess.bim.building_model import Area, BuildingModel, Door, Piece, Space, Stair, Storey
from assess.bim.cobie_floors import LOWEST_ROOF, note_datum
from assess.bim.door_sides import REACH, find_kinds, find_sides
from assess.bim.draft_corridors import find_width
from assess.bim.draft_floor import find_room_points
from assess.bim.floor_drawing import Drawn, draw_storey, name_plans
from assess.bim.import_workbook import LONGEST_NAME, ImportedBuilding, Skipped, name_apart
from assess.bim.model_names import Names, name_floors, name_items, name_places, sort_pieces
from assess.bim.plan_shapes import find_rectangle, to_polygon
from assess.bim.space_search import SpaceSearch
from assess.i18n import Text, fill, gettext, nfill
from assess.workbook.outlines import MOST, OutlineError, parse_outline
from assess.workbook.schema import BUILDING, FLOORS, ITEMS

Drafts = Literal["none", "draft"]
"""Whether evacuation routes are drafted."""
CENTIMETRES = 100.0
SAME = 0.005
"""Difference up to which two sizes are the same [m]."""
ALONG = 1.0
"""Angle between an edge and a side of a piece up to which the edge is along it [deg]."""
STAIRS = (
    "stair", "stairs", "staircase", "stairway", "stairwell", "treppe", "treppen", "treppenhaus", "treppenraum", "scala",
    "scale",
)  # fmt: skip
CORRIDORS = (
    "corridor", "corridors", "hallway", "passage", "passageway", "lobby", "foyer", "flur", "hausflur", "korridor",
    "gang", "diele", "corridoio", "disimpegno", "atrio", "ingresso",
)  # fmt: skip
"""Words in names of stairs and of corridors. A hall may be any large room."""
SLENDER, MANY_DOORS = 2.5, 3
"""A corridor is so many times as long as wide, or has so many doors [-]."""
LOW, HIGH = ITEMS.column("breadth").low or 0.0, ITEMS.column("breadth").high or math.inf
"""Sizes that a workbook takes [cm]."""
LOWEST, HIGHEST = FLOORS.column("elevation").low or 0.0, FLOORS.column("elevation").high or math.inf
"""Elevations that a workbook takes [m]."""
TALLEST = BUILDING.column("height").high or math.inf
"""Height of a building that a workbook takes [m]."""
BESIDE_BASE = fill("the middle of its body is not above its base in the model")
FITTED = fill("fitted furniture, usually fixed: look at it, and fill in Anchored")


def list_building(model: BuildingModel, routes: Drafts = "none") -> ImportedBuilding:
    """Return what a model tells of a building as rows, plans, and what was left out.

    `model`: from `assess.bim.ifc_model` and its like.
    `routes`: whether evacuation routes are drafted from the rooms to the exits.
    """
    holders: Sequence[Piece | Space | Door | Stair] = (*model.pieces, *model.spaces, *model.doors, *model.stairs)
    used = {one.storey for one in holders}
    storeys = [one for one in model.storeys if one.key in used] or list(model.storeys)
    floors = name_floors(storeys)
    places = name_places(model, floors)
    pieces, outside = _sort_by_size(sort_pieces(model.pieces, storeys, places))
    drawn = {one.key: plan for one in storeys if (plan := draw_storey(model, one)) is not None}
    files = dict(zip(drawn, name_plans(model.source, (floors[key] for key in drawn)), strict=True))
    found = dict.fromkeys(_type_key(one) for one in pieces)
    types = dict(zip(found, name_apart(one[0] for one in found), strict=True))
    draft = _draft(model, {**places, **floors}, routes)
    values = {
        "building": model.name, "address": model.address, "latitude": model.latitude, "longitude": model.longitude,
        "azimuth_deg": model.azimuth_deg, "height": _find_height(model, storeys),
    }  # fmt: skip
    source = gettext("shapes in {name}", name=model.source)
    return ImportedBuilding(
        source=model.source,
        building={name: value for name, value in values.items() if value not in (None, "")},
        floors=[_list_floor(one, floors, drawn.get(one.key), files) for one in storeys],
        items=list(_list_items(model, pieces, types, floors, places)),
        places=[*_list_spaces(model, floors, places), *_list_points(model, floors, places), *draft.places],
        routes=draft.routes,
        types=[
            {"type": name, "breadth": breadth, "width": width, "height": height, "source": source}
            for (_, breadth, width, height), name in types.items()
        ],
        skipped=(*_list_skipped(model), *outside),
        warnings=(*model.warnings, *_note_elevations(storeys, floors), *_warn_of_supports(pieces), *draft.warnings),
        remarks=(*model.remarks, *_note(model, storeys, pieces)),
        files={files[key]: plan.svg for key, plan in drawn.items()},
    )


# ---------------------------------------------------------------- sizes


@dataclass(frozen=True, slots=True)
class Sized:
    """A piece with the sizes of its row [cm], the direction of Breadth [deg], and whether its supports stand inside.

    `supports` is the least distance between its outer supports along its sides [cm]. Where an edge of its base is
    nearer to the middle than half of that, `safe` is twice the distance to that edge, else `supports`; `is_oblique`
    tells that this edge is along neither of its sides.
    """

    piece: Piece
    breadth: float
    width: float
    height: float
    angle_deg: float
    is_inset: bool
    supports: float
    safe: float
    is_oblique: bool = False

    @property
    def is_off_middle(self) -> bool:
        """Whether it tips over one edge sooner than its Breadth says: its supports do not stand about its middle."""
        return self.safe < self.breadth

    @property
    def sizes(self) -> dict[str, float]:
        """Return the sizes by field [cm]."""
        return {"breadth": self.breadth, "width": self.width, "height": self.height}


def find_sizes(piece: Piece) -> Sized:
    """Return the sizes with which a piece rocks.

    Breadth is the distance between the outer supports, as people measure it; of a base with edges oblique to its sides,
    such as a cross or three legs, twice the distance from the middle to the nearest edge.
    """
    along = piece.support_breadth if piece.support_breadth < piece.breadth - SAME else piece.breadth
    across = piece.support_width if piece.support_width < piece.width - SAME else piece.width
    breadth, width, angle = along, piece.width, piece.angle_deg
    if across < along - SAME:
        breadth, width, angle = across, piece.breadth, piece.angle_deg + 90
    supports = breadth
    reach = piece.support_reach
    safe = breadth if reach is None or 2 * reach >= breadth - SAME else 2 * reach
    is_oblique = safe < breadth and (ALONG <= (piece.support_angle_deg - piece.angle_deg) % 90 <= 90 - ALONG)
    if is_oblique or safe == 0:
        breadth, width, angle = safe, piece.support_across, piece.support_angle_deg
    sizes = (breadth, width, piece.height, supports, safe)
    breadth_cm, width_cm, height_cm, supports_cm, safe_cm = (round(CENTIMETRES * one, 1) for one in sizes)
    return Sized(
        piece,
        breadth_cm,
        width_cm,
        height_cm,
        angle_deg=round((angle + 90) % 180 - 90, 1),
        is_inset=breadth < piece.breadth - SAME,
        supports=supports_cm,
        safe=safe_cm,
        is_oblique=is_oblique,
    )


def _sort_by_size(pieces: Sequence[Piece]) -> tuple[list[Sized], list[Skipped]]:
    sized = [find_sizes(one) for one in pieces]
    fits = [all(LOW <= size <= HIGH for size in one.sizes.values()) for one in sized]
    outside = fill("a size outside {low:g} to {high:g} cm", low=LOW, high=HIGH)
    counts = Counter(
        (one.piece.type[:LONGEST_NAME], BESIDE_BASE if one.piece.support_reach == 0 else outside)
        for one, is_inside in zip(sized, fits, strict=True)
        if not is_inside
    )
    kept = [one for one, is_inside in zip(sized, fits, strict=True) if is_inside]
    return kept, [Skipped(kind, number, reason) for (kind, reason), number in counts.items()]


def _type_key(one: Sized) -> tuple[str, float, float, float]:
    return one.piece.type, one.breadth, one.width, one.height


# ---------------------------------------------------------------- rows


def _find_height(model: BuildingModel, storeys: Sequence[Storey]) -> float | None:
    """Return the height of the roof: the highest storey or ceiling; None if not above all floors or above `TALLEST`."""
    datum = {one.key: one.elevation - one.level for one in model.storeys}
    tops = [one.elevation for one in model.storeys]
    tops += [one.top + datum[one.storey] for one in model.spaces if one.storey in datum]
    highest = max((one.elevation for one in storeys), default=0.0)
    top = max(tops, default=0.0)
    return round(top, 2) if max(highest, LOWEST_ROOF) < top <= TALLEST else None


def _list_floor(storey: Storey, floors: Names, plan: Drawn | None, files: Names) -> dict[str, Any]:
    row: dict[str, Any] = {"floor": floors[storey.key]}
    if _is_known(storey):
        row["elevation"] = round(storey.elevation, 3) + 0.0
    if plan is not None:
        row |= {"plan": files[storey.key], "plan_left": plan.left, "plan_bottom": plan.bottom, "plan_width": plan.width}
    return row


def _is_known(storey: Storey) -> bool:
    return LOWEST <= storey.elevation <= HIGHEST


def _note_elevations(storeys: Sequence[Storey], floors: Names) -> list[Text]:
    odd = [floors[one.key] for one in storeys if not _is_known(one)]
    notes = note_datum([(floors[one.key], one.elevation) for one in storeys if _is_known(one)])
    if odd:
        notes.append(
            fill("Elevation is blank for {floors}: in the model it is outside {low:g} to {high:g} m. Fill in the "
                 "height above the ground.", floors=", ".join(odd[:20]), low=LOWEST, high=HIGHEST)
        )  # fmt: skip
    return notes


def _list_items(
    model: BuildingModel, pieces: Sequence[Sized], types: Mapping[Any, str], floors: Names, places: Names
) -> Iterator[dict[str, Any]]:
    spaces = {one.key: one for one in model.spaces}
    names = name_items([one.piece for one in pieces], spaces, floors)
    for name, one in zip(names, pieces, strict=True):
        piece = one.piece
        row = {
            "item": name, "floor": floors[piece.storey], "room": places.get(piece.space, ""), "description": piece.type,
            "type": types[_type_key(one)], **one.sizes, "x": round(piece.x, 3), "y": round(piece.y, 3),
            "angle_deg": one.angle_deg, "anchored": "unknown" if piece.is_fitted else "", "source_id": piece.key,
            "sizes_from": model.sizes_from, "notes": "; ".join(_list_notes(one)),
        }  # fmt: skip
        yield {field: value for field, value in row.items() if value != ""}


def _list_notes(one: Sized) -> Iterator[str]:
    piece = one.piece
    if one.is_inset:
        yield _note_supports(one)
    if piece.is_fitted:
        yield gettext(FITTED)
    if piece.name and piece.name != piece.type:
        yield gettext("in the model: {name}", name=piece.name)


def _note_supports(one: Sized) -> str:
    sizes = (one.piece.breadth, one.piece.width, one.piece.height)
    breadth, width, height = (CENTIMETRES * size for size in sizes)
    body = gettext("body {breadth:.1f} x {width:.1f} x {height:.1f} cm, {support:g} cm between the outer supports",
                   breadth=breadth, width=width, height=height, support=one.supports)  # fmt: skip
    if one.is_oblique:
        return gettext("{body}: Breadth is twice the distance from the middle to the nearest edge between them",
                       body=body)  # fmt: skip
    if one.is_off_middle:
        return gettext("{body}, which are off the middle: to one side it tips as with a Breadth of {safe:g} cm",
                       body=body, safe=one.safe)  # fmt: skip
    return body


def _list_spaces(model: BuildingModel, floors: Names, places: Names) -> Iterator[dict[str, Any]]:
    points, stairs = find_room_points(model), _find_stair_rooms(model)
    doors = Counter(key for sides in find_sides(model).values() for key in set(sides))
    for one in model.spaces:
        if one.storey in floors:
            x, y = points[one.key]
            kind = find_kind(one, doors[one.key], holds_stair=one.key in stairs)
            row = {"place": places[one.key], "floor": floors[one.storey], "x": x, "y": y, "kind": kind}
            outline = _write_outline(one.area)
            yield row | ({"outline": outline} if outline else {})


def _find_stair_rooms(model: BuildingModel) -> set[str]:
    found = set()
    for storey in {one.storey for one in model.stairs}:
        search = SpaceSearch([one for one in model.spaces if one.storey == storey])
        held = search.find_all([(one.x, one.y) for one in model.stairs if one.storey == storey], REACH)
        found |= {own[0].key for own in held if own}
    return found


def find_kind(space: Space, doors: int = 0, *, holds_stair: bool = False) -> Literal["room", "corridor", "stair"]:
    """Return what a room is by the words of its name, and what bears them out.

    Rooms are checked for losing all their ways out, corridors and stairs are not: so a name alone makes none.

    `doors`: how many doors it has.
    `holds_stair`: whether a stair begins or ends in it.
    """
    words = set(re.findall(r"[^\W\d_]+", f"{space.name} {space.title}".casefold()))
    if holds_stair and words & set(STAIRS):
        return "stair"
    is_corridor = words & set(CORRIDORS) and (doors >= MANY_DOORS or _is_slender(space.area))
    return "corridor" if is_corridor else "room"


def _is_slender(area: Area) -> bool:
    polygon = to_polygon(area)
    rectangle = find_rectangle(np.array(polygon.exterior.coords)) if polygon.area > 0 else None
    return rectangle is not None and (rectangle.long >= SLENDER * rectangle.short or find_width(polygon) > 0)


def _write_outline(area: Area) -> str:
    polygon, coarse = to_polygon(area), 0.0
    corners = list(polygon.exterior.coords)[:-1]
    while len(corners) > MOST:
        coarse = 2 * coarse or 0.01
        corners = list(polygon.exterior.simplify(coarse).coords)[:-1]
    text = "; ".join(f"{x:g} {y:g}" for x, y in ((round(x, 3), round(y, 3)) for x, y in corners))
    try:
        parse_outline(text, 1.0)
    except OutlineError:
        return ""
    return text


def _list_points(model: BuildingModel, floors: Names, places: Names) -> Iterator[dict[str, Any]]:
    kinds = find_kinds(model)
    for door in model.doors:
        if door.storey in floors:
            kind = "exit" if kinds[door.key] == "exit" else "door"
            row = {"place": places[door.key], "floor": floors[door.storey], "kind": kind}
            yield row | {"x": round(door.x, 3), "y": round(door.y, 3)}
    for stair in model.stairs:
        if stair.storey in floors:
            row = {"place": places[f"{stair.key} {stair.end}"], "floor": floors[stair.storey], "kind": "stair"}
            yield row | {"x": round(stair.x, 3), "y": round(stair.y, 3)}


# ---------------------------------------------------------------- routes


@dataclass(frozen=True, slots=True)
class _Draft:
    places: Sequence[Mapping[str, Any]] = ()
    routes: Sequence[Mapping[str, Any]] = ()
    warnings: tuple[Text, ...] = ()


def _draft(model: BuildingModel, places: Names, routes: Drafts) -> _Draft:
    if routes == "none":
        return _Draft()
    from assess.bim.draft_routes import draft_routes

    drafted = draft_routes(model, places)
    return _Draft(drafted.places, drafted.routes, tuple(drafted.remarks))


# ---------------------------------------------------------------- what was left out, and what is to be checked


def _list_skipped(model: BuildingModel) -> Iterator[Skipped]:
    for one in model.left_out:
        kind = one.type if one.ifc_class in ("", one.type) else f"{one.ifc_class} {one.type}"
        yield Skipped(kind[:LONGEST_NAME], one.count, one.reason, one.is_furniture)


def _warn_of_supports(pieces: Sequence[Sized]) -> Iterator[Text]:
    off = sum(one.is_off_middle for one in pieces)
    if off:
        yield nfill(
            "{n:,} piece stands off the middle of its supports, and tips to one side sooner than its Breadth says. "
            "Type the Breadth in its Notes to be on the safe side.",
            "{n:,} pieces stand off the middle of their supports, and tip to one side sooner than their Breadth says. "
            "Type the Breadth in their Notes to be on the safe side.", off,
        )  # fmt: skip


def _note(model: BuildingModel, storeys: Sequence[Storey], pieces: Sequence[Sized]) -> Iterator[Text]:
    fitted = sum(one.piece.is_fitted for one in pieces)
    if fitted:
        yield nfill(
            "{n:,} piece is fitted furniture by its name: usually fixed, free-standing until Anchored says yes.",
            "{n:,} pieces are fitted furniture by their names: usually fixed, free-standing until Anchored says yes.",
            fitted,
        )  # fmt: skip
    inset = sum(one.is_inset for one in pieces)
    if inset:
        yield nfill(
            "{n:,} piece stands on supports inside its body: Breadth is between these, and Notes give the body.",
            "{n:,} pieces stand on supports inside their bodies: Breadth is between these, and Notes give the bodies.",
            inset,
        )  # fmt: skip
    if model.doors:
        kinds = find_kinds(model)
        out = sum(kind == "exit" for kind in kinds.values())
        yield fill("Doors that lead out of the ground storey (a room on one side only): {n:,} of {all:,}.", n=out,
                   all=len(model.doors))  # fmt: skip
    if model.latitude is not None:
        yield fill("Latitude and Longitude are those of the model, {latitude:g} and {longitude:g}: check them, as "
                   "programs fill in a default town.", latitude=model.latitude, longitude=model.longitude)  # fmt: skip
    empty = [one.name for one in model.storeys if one not in storeys]
    if empty:
        yield fill("Storeys without furniture, rooms and doors were left out: {names}.", names=", ".join(empty[:20]))
