"""A building model as the rows of an inventory, with a plan of each storey.

Breadth is the distance between the outer supports where that is less than the body's, as pieces rock about their
supports; where the supports stand closest along the longer side, Breadth lies along that. Of a base with oblique edges,
three legs or a cross, it is twice the distance from the middle of the body to the nearest edge. Supports off the
middle, such as a plinth set back at the front only, are warned of, with the Breadth as which the piece tips there.
"""

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from assess.bim.building_model import LONGEST_NAME, BuildingModel, Door, Piece, Skipped, Space, Stair, half_turn
from assess.bim.draft_floor import REACH, find_kinds, find_room_points, find_sides
from assess.bim.floor_drawing import draw_storey, name_plans
from assess.bim.import_workbook import LOWEST_ROOF, ImportedBuilding, name_apart, note_datum
from assess.bim.plan_shapes import SpaceSearch, find_rectangle, find_width, to_polygon
from assess.i18n import Text, fill, gettext, nfill
from assess.text import natural_key
from assess.workbook.habits import CellError
from assess.workbook.names import key
from assess.workbook.schema import BUILDING, FLOORS, ITEMS
from assess.workbook.values import MOST_CORNERS, parse_outline

Row = dict[str, Any]
Drafts = Literal["none", "draft"]  # whether evacuation routes are drafted
CENTIMETRES = 100.0
SAME = 0.005  # difference up to which two sizes are the same [m]
ALONG = 1.0  # angle between an edge and a side of a piece up to which the edge is along it [deg]
STAIRS = (
    "stair", "stairs", "staircase", "stairway", "stairwell", "treppe", "treppen", "treppenhaus", "treppenraum", "scala",
    "scale",
)  # fmt: skip
CORRIDORS = (
    "corridor", "corridors", "hallway", "passage", "passageway", "lobby", "foyer", "flur", "hausflur", "korridor",
    "gang", "diele", "corridoio", "disimpegno", "atrio", "ingresso",
)  # fmt: skip
"""Words in names of stairs and of corridors. A hall may be any large room."""
SLENDER, MANY_DOORS = 2.5, 3  # a corridor is so many times as long as wide, or has so many doors [-]
LOW, HIGH = ITEMS.column("breadth").low or 0.0, ITEMS.column("breadth").high or math.inf
"""Sizes that a workbook takes [cm]."""
LOWEST, HIGHEST = FLOORS.column("elevation").low or 0.0, FLOORS.column("elevation").high or math.inf
"""Elevations that a workbook takes [m]."""
TALLEST = BUILDING.column("height").high or math.inf  # height of a building that a workbook takes [m]
BESIDE_BASE = fill("the middle of its body is not above its base in the model")
FITTED = fill("fitted furniture, usually fixed: look at it, and fill in Anchored")


def list_building(model: BuildingModel, routes: Drafts = "none") -> ImportedBuilding:
    """Return what a model tells of a building as rows, plans, and what was left out."""
    own = _Building(model)
    drawn = {one.key: plan for one in own.storeys if (plan := draw_storey(model, one)) is not None}
    files = dict(zip(drawn, name_plans(model.source, (own.floors[key] for key in drawn)), strict=True))
    plans = {key: {"plan": files[key], **place} for key, (_, place) in drawn.items()}
    found = dict.fromkeys(one.type_key for one in own.pieces)
    types = dict(zip(found, name_apart(one[0] for one in found), strict=True))
    source = gettext("shapes in {name}", name=model.source)
    # the height is that of the highest storey or ceiling
    datum = {one.key: one.elevation - one.level for one in model.storeys}
    tops = [one.elevation for one in model.storeys]
    top = max([*tops, *(one.top + datum[one.storey] for one in model.spaces if one.storey in datum)], default=0.0)
    highest = max((one.elevation for one in own.storeys), default=0.0)
    values = {
        "building": model.name, "address": model.address, "latitude": model.latitude, "longitude": model.longitude,
        "azimuth_deg": model.azimuth_deg,
        "height": round(top, 2) if max(highest, LOWEST_ROOF) < top <= TALLEST else None,
    }  # fmt: skip
    places, drafted, remarks = list[Mapping[str, Any]](), list[Mapping[str, Any]](), list[Text]()
    if routes != "none":
        from assess.bim.draft_routes import draft_routes

        draft = draft_routes(model, {**own.places, **own.floors}, own.sides, own.points)
        places, drafted, remarks = [*draft.places], [*draft.routes], [*draft.remarks]
    return ImportedBuilding(
        source=model.source,
        building={name: value for name, value in values.items() if value not in (None, "")},
        floors=[
            {"floor": own.floors[one.key]}
            | ({"elevation": round(one.elevation, 3) + 0.0} if LOWEST <= one.elevation <= HIGHEST else {})
            | plans.get(one.key, {})
            for one in own.storeys
        ],
        items=list(own.list_items(types)),
        places=[*own.list_places(), *places],
        routes=drafted,
        types=[
            {"type": name, "breadth": breadth, "width": width, "height": height, "source": source}
            for (_, breadth, width, height), name in types.items()
        ],
        skipped=(*model.skipped, *own.outside),
        warnings=(*model.warnings, *own.list_warnings(), *remarks),
        remarks=(*model.remarks, *own.list_remarks()),
        files={files[key]: svg for key, (svg, _) in drawn.items()},
    )


class _Building:
    """A model with the names of its floors, by the keys of storeys, and of its places, and its pieces in their order.

    Keys of places are those of rooms and doors, and of stairs with their end: ``KEY foot``. Pieces are sorted by
    storey, room and type, as people look for them; those in no room come last. Of `outside` a workbook takes no sizes.
    """

    def __init__(self, model: BuildingModel) -> None:
        self.model = model
        holders: Sequence[Piece | Space | Door | Stair] = (*model.pieces, *model.spaces, *model.doors, *model.stairs)
        used = {one.storey for one in holders}
        self.storeys = [one for one in model.storeys if one.key in used] or list(model.storeys)
        self.floors = dict(
            zip((one.key for one in self.storeys), name_apart(one.name for one in self.storeys), strict=True)
        )
        self.spaces = [one for one in model.spaces if one.storey in self.floors]
        self.doors = [one for one in model.doors if one.storey in self.floors]
        self.stairs = [one for one in model.stairs if one.storey in self.floors]
        self.sides = find_sides(model)
        self.kinds = find_kinds(model, self.sides)
        self.places = self._name_places()
        self.points = find_room_points(model)
        order = {one.key: at for at, one in enumerate(self.storeys)}

        def place(one: Piece) -> tuple[Any, ...]:
            room = not one.space, natural_key(self.places.get(one.space, ""))
            return order[one.storey], *room, natural_key(one.type), one.x, one.y

        outside = fill("a size outside {low:g} to {high:g} cm", low=LOW, high=HIGH)
        every = [find_sizes(one) for one in sorted(model.pieces, key=place)]
        self.pieces = [one for one in every if all(LOW <= size <= HIGH for size in one.sizes.values())]
        counts = Counter(
            (one.piece.type[:LONGEST_NAME], BESIDE_BASE if one.piece.support_reach == 0 else outside)
            for one in every
            if not all(LOW <= size <= HIGH for size in one.sizes.values())
        )
        self.outside = [Skipped(kind, number, reason) for (kind, reason), number in counts.items()]

    def _name_places(self) -> dict[str, str]:
        counts = Counter(key(one.name) for one in self.spaces)
        short = {
            one.key: one.name
            if one.name and counts[key(one.name)] == 1
            else f"{self.floors[one.storey]} {one.name}".strip()  # other floors have a room of that name
            for one in self.spaces
        }
        named = [(one.key, f"{short[one.key]} {one.title}".strip()) for one in self.spaces]
        for door in self.doors:
            rooms = " / ".join(sorted({short[side] for side in self.sides[door.key] if side in short}, key=natural_key))
            rooms = rooms or self.floors[door.storey]
            is_exit = self.kinds[door.key] == "exit"
            text = gettext("Exit {room}", room=rooms) if is_exit else gettext("Door {rooms}", rooms=rooms)
            named.append((door.key, text))
        ends = {"foot": fill("foot"), "head": fill("head")}
        for stair in self.stairs:
            text = gettext("Stair {floor}, {end}", floor=self.floors[stair.storey], end=gettext(ends[stair.end]))
            named.append((f"{stair.key} {stair.end}", text))
        return dict(zip((key for key, _ in named), name_apart(name for _, name in named), strict=True))

    def list_items(self, types: Mapping[Any, str]) -> Iterator[Row]:
        """Yield the rows of Items, named as ``A203-02``: the room, or else the floor, and a number in it."""
        numbers: Counter[str] = Counter()
        spaces = {one.key: one for one in self.model.spaces}
        rooms = Counter(key(one.name) for one in spaces.values())
        names = []
        for piece in (one.piece for one in self.pieces):
            room, at = spaces.get(piece.space), self.floors[piece.storey]
            if room is not None and room.name and rooms[key(room.name)] == 1:
                at = room.name
            numbers[key(at)] += 1
            names.append(f"{at}-{numbers[key(at)]:02}")
        for name, one in zip(name_apart(names), self.pieces, strict=True):
            piece = one.piece
            row = {
                "item": name, "floor": self.floors[piece.storey], "room": self.places.get(piece.space, ""),
                "description": piece.type, "type": types[one.type_key], **one.sizes, "x": round(piece.x, 3),
                "y": round(piece.y, 3), "angle_deg": one.angle_deg, "anchored": "unknown" if piece.is_fitted else "",
                "source_id": piece.key, "sizes_from": self.model.sizes_from, "notes": "; ".join(one.list_notes()),
            }  # fmt: skip
            yield {field: value for field, value in row.items() if value != ""}

    def list_places(self) -> Iterator[Row]:
        """Yield the rows of Places; an outline is as coarse as a cell asks for, and left out where none is taken."""
        search = SpaceSearch(self.model.spaces)
        held = (search.find(one.storey, (one.x, one.y), REACH) for one in self.model.stairs)
        with_stair = {own[0].key for own in held if own}
        doors = Counter(key for sides in self.sides.values() for key in set(sides))
        for one in self.spaces:
            x, y = self.points[one.key]
            kind = find_kind(one, doors[one.key], holds_stair=one.key in with_stair)
            row: Row = {"place": self.places[one.key], "floor": self.floors[one.storey], "x": x, "y": y, "kind": kind}
            outer, coarse = to_polygon(one.area).exterior, 0.0
            corners = outer.coords[:-1]
            while len(corners) > MOST_CORNERS:
                coarse = 2 * coarse or 0.01
                corners = outer.simplify(coarse).coords[:-1]
            outline = "; ".join(f"{round(x, 3):g} {round(y, 3):g}" for x, y in corners)
            with suppress(CellError):
                parse_outline(outline, 1.0)
                row["outline"] = outline
            yield row
        ends: list[tuple[Door | Stair, str, str]] = [
            *((one, one.key, "exit" if self.kinds[one.key] == "exit" else "door") for one in self.doors),
            *((one, f"{one.key} {one.end}", "stair") for one in self.stairs),
        ]
        for end, name, what in ends:
            row = {"place": self.places[name], "floor": self.floors[end.storey], "kind": what}
            yield row | {"x": round(end.x, 3), "y": round(end.y, 3)}

    def list_warnings(self) -> Iterator[Text]:
        known = [(self.floors[one.key], one.elevation) for one in self.storeys if LOWEST <= one.elevation <= HIGHEST]
        yield from note_datum(known)
        odd = [name for name in self.floors.values() if name not in dict(known)]
        if odd:
            yield fill("Elevation is blank for {floors}: in the model it is outside {low:g} to {high:g} m. Fill in the "
                       "height above the ground.", floors=", ".join(odd[:20]), low=LOWEST, high=HIGHEST)  # fmt: skip
        off = sum(one.is_off_middle for one in self.pieces)
        if off:
            yield nfill(
                "{n:,} piece stands off the middle of its supports, and tips to one side sooner than its Breadth says. "
                "Type the Breadth in its Notes to be on the safe side.",
                "{n:,} pieces stand off the middle of their supports, and tip to one side sooner than their Breadth "
                "says. Type the Breadth in their Notes to be on the safe side.", off,
            )  # fmt: skip

    def list_remarks(self) -> Iterator[Text]:
        model = self.model
        fitted = sum(one.piece.is_fitted for one in self.pieces)
        if fitted:
            yield nfill(
                "{n:,} piece is fitted furniture by its name: usually fixed, free-standing until Anchored says yes.",
                "{n:,} pieces are fitted furniture by their names: usually fixed, free-standing until Anchored says "
                "yes.", fitted,
            )  # fmt: skip
        inset = sum(one.is_inset for one in self.pieces)
        if inset:
            yield nfill(
                "{n:,} piece stands on supports inside its body: Breadth is between these, and Notes give the body.",
                "{n:,} pieces stand on supports inside their bodies: Breadth is between these, and Notes give the "
                "bodies.", inset,
            )  # fmt: skip
        if model.doors:
            out = sum(kind == "exit" for kind in self.kinds.values())
            yield fill("Doors that lead out of the ground storey (a room on one side only): {n:,} of {all:,}.", n=out,
                       all=len(model.doors))  # fmt: skip
        if model.latitude is not None:
            yield fill("Latitude and Longitude are those of the model, {latitude:g} and {longitude:g}: check them, as "
                       "programs fill in a default town.",
                       latitude=model.latitude, longitude=model.longitude)  # fmt: skip
        empty = [one.name for one in model.storeys if one not in self.storeys]
        if empty:
            names = ", ".join(empty[:20])
            yield fill("Storeys without furniture, rooms and doors were left out: {names}.", names=names)


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
    def type_key(self) -> tuple[str, float, float, float]:
        """What pieces of one type share."""
        return self.piece.type, self.breadth, self.width, self.height

    @property
    def sizes(self) -> dict[str, float]:
        """The sizes by field [cm]."""
        return {"breadth": self.breadth, "width": self.width, "height": self.height}

    def list_notes(self) -> Iterator[str]:
        """Yield what is to be noted of it."""
        piece = self.piece
        if self.is_inset:
            breadth, width, height = (CENTIMETRES * size for size in (piece.breadth, piece.width, piece.height))
            body = gettext("body {breadth:.1f} x {width:.1f} x {height:.1f} cm, {support:g} cm between the outer "
                           "supports", breadth=breadth, width=width, height=height, support=self.supports)  # fmt: skip
            if self.is_oblique:
                body = gettext("{body}: Breadth is twice the distance from the middle to the nearest edge between them",
                               body=body)  # fmt: skip
            elif self.is_off_middle:
                body = gettext("{body}, which are off the middle: to one side it tips as with a Breadth of {safe:g} cm",
                               body=body, safe=self.safe)  # fmt: skip
            yield body
        if piece.is_fitted:
            yield gettext(FITTED)
        if piece.name and piece.name != piece.type:
            yield gettext("in the model: {name}", name=piece.name)


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
    supports, reach = breadth, piece.support_reach
    safe = breadth if reach is None or 2 * reach >= breadth - SAME else 2 * reach
    is_oblique = safe < breadth and (ALONG <= (piece.support_angle_deg - piece.angle_deg) % 90 <= 90 - ALONG)
    if is_oblique or safe == 0:
        breadth, width, angle = safe, piece.support_across, piece.support_angle_deg
    sizes = (round(CENTIMETRES * one, 1) for one in (breadth, width, piece.height, supports, safe))
    breadth_cm, width_cm, height_cm, supports_cm, safe_cm = sizes
    return Sized(
        piece, breadth_cm, width_cm, height_cm, angle_deg=round(half_turn(angle), 1), supports=supports_cm,
        is_inset=breadth < piece.breadth - SAME, safe=safe_cm, is_oblique=is_oblique,
    )  # fmt: skip


def find_kind(space: Space, doors: int = 0, *, holds_stair: bool = False) -> Literal["room", "corridor", "stair"]:
    """Return what a room is by the words of its name, confirmed by its `doors`, its shape or an end of a stair in it.

    Rooms are checked for losing all their ways out, corridors and stairs are not: so a name alone makes none.
    """
    words = set(re.findall(r"[^\W\d_]+", f"{space.name} {space.title}".casefold()))
    if holds_stair and words & set(STAIRS):
        return "stair"
    if not words & set(CORRIDORS):
        return "room"
    polygon = to_polygon(space.area)
    box = find_rectangle(np.array(polygon.exterior.coords)) if polygon.area > 0 else None
    is_slender = box is not None and (box.long >= SLENDER * box.short or find_width(polygon) > 0)
    return "corridor" if doors >= MANY_DOORS or is_slender else "room"
