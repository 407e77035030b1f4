"""The plan of a floor, in metres: its pieces to scale, what they would cover if they fell, places and routes.

The template plan.svg.j2 draws it in pixels, Y downwards, by `Plan.x`, `Plan.y` and `Plan.outline`: in metres its
letters would be smaller than some programs can draw.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from assess.i18n import gettext as _
from assess.plans.linework import clip
from assess.report import measures, words
from assess.report.content import FloorPage
from assess.report.figures.labels import MOST, NAMED, Bounds, Corners, Key, Label, Names, Point, Spot, bounds
from assess.report.figures.underlay import Ring, Room, Underlay, build_underlay, cut_falls, find_edge, list_rooms, widen
from assess.report.figures.ways import Stretch, place_signs, sign_box
from assess.results import ItemResult, ItemRow, Results
from assess.risk import RiskClass
from assess.routes.geometry import fallen, rectangle

ANCHORED = "#d0d0d0"
"""Fill of an anchored piece, which stands outside the classes."""
WIDE, HIGH = 660.0, 520.0
"""Most of a drawing [px]: what a page has room for at its own size, so that letters of 10.8 px print as 8 points."""
BESIDE, BELOW = 30.0, 48.0
"""Room for the ticks, and for the scale bar below them [px]."""
LARGEST = 90.0
"""Scale [px/m] that is not gone beyond for a few pieces close together."""
BORDER = 0.4
"""Free space round everything that is drawn [m]."""
AROUND, SMALLEST, CROPPED = 0.8, 6.0, 190.0
"""Free space round a room, and its least width and depth [m]; the height of its drawing [px] at most."""
SHORT = 12
"""Characters of a piece's name that are drawn."""
_STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
_TICKS, _FEW_TICKS = 12, 5


@dataclass(frozen=True, slots=True)
class Piece:
    """One piece; `number` is that of its row among all pieces, from 1, and `side` its shorter side [m].

    `mark` is a text that stands in place of the sign of its class.
    `upper` is the class that it may reach; None where it stands outside the classes. `fallen` is what it would cover if
    it fell, one rectangle a way: only for a free-standing one of at least medium class, and inside the building's edge
    where that is known.
    """

    number: int
    name: str
    title: str
    upper: RiskClass | None
    class_name: str
    fill: str
    ink: str
    symbol: str
    side: float
    at: Point
    corners: Corners
    fallen: tuple[Ring, ...]
    mark: str = ""


@dataclass(frozen=True, slots=True)
class Plan:
    """One floor's plan; `low` and `high` are the corners of what is drawn, `unit` [m] one pixel of the drawing.

    The ids of the drawing begin with `key`, as those of no other plan. `ways` are segments, those with most to warn of
    first, and `names` their names; `keys` are names that are not drawn, with the numbers in their place. Falls are
    drawn as far as `cut_at`: the outlines of the floor, the frame of the user's drawing, or "". `north` is its
    direction [deg], anticlockwise from X, where it is known. `is_crop`: it is that of a room (`crop_plan`).
    """

    key: str
    title: str
    pieces: tuple[Piece, ...]
    places: tuple[Spot, ...]
    labels: tuple[Label, ...]
    ways: tuple[Stretch, ...]
    names: tuple[Label, ...]
    rooms: tuple[Room, ...]
    room_names: tuple[Label, ...]
    keys: tuple[Key, ...]
    underlay: Underlay | None
    cut_at: str
    low: Point
    high: Point
    unit: float
    north: float | None
    is_crop: bool = False

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the drawing [px], with room for the ticks on the left and below."""
        return math.ceil(self.x(self.high[0])), math.ceil(self.y(self.low[1]) + BELOW)

    def x(self, value: float) -> float:
        """Return where an X [m] lies in the drawing."""
        return round(BESIDE + (value - self.low[0]) / self.unit, 2)

    def y(self, value: float) -> float:
        """Return where a Y [m] lies in the drawing."""
        return round((self.high[1] - value) / self.unit, 2)

    def outline(self, corners: Iterable[Point]) -> str:
        """Return a closed path."""
        return "M" + "L".join(f"{self.x(x):g} {self.y(y):g}" for x, y in corners) + "Z"

    @property
    def falls(self) -> str:
        """All that would be covered, as one path: where two overlap it is hatched once."""
        return "".join(self.outline(corners) for piece in self.pieces for corners in piece.fallen)

    @property
    def boxes(self) -> tuple[Bounds, ...]:
        """What is taken by the names, of places, rooms, pieces and segments."""
        spots = (spot.box for spot in self.places if spot.name)
        return (*spots, *(label.box for label in (*self.room_names, *self.labels, *self.names)))

    @property
    def linework(self) -> str:
        """The lines of the user's drawing as one path."""
        if self.underlay is None:
            return ""
        found = [part for line in self.underlay.lines for part in clip(line, (*self.low, *self.high))]
        return "".join("M" + "L".join(f"{self.x(x):.1f} {self.y(y):.1f}" for x, y in line.tolist()) for line in found)

    @property
    def ticks(self) -> tuple[tuple[float, ...], ...]:
        """Values along X and Y [m], at the same distance, round in the reader's unit."""
        step = _round(
            max(self.high[0] - self.low[0], self.high[1] - self.low[1]) / (_FEW_TICKS if self.is_crop else _TICKS)
        )
        return tuple(
            tuple(round(step * at, 4) for at in range(math.ceil(low / step), math.floor(high / step) + 1))
            for low, high in zip(self.low, self.high, strict=True)
        )

    @property
    def bar(self) -> float:
        """Length of the scale bar [m]: round in the reader's unit, and about a sixth of the width."""
        return _round((self.high[0] - self.low[0]) / 8)

    def symbol_size(self, piece: Piece) -> float:
        """Return the size of a piece's symbol [px]: that of the piece, yet legible and no giant."""
        return round(min(max(0.95 * piece.side / self.unit, 6), 16), 1)

    def mask(self, box: Bounds) -> str:
        """Return the attributes of the white ground under a name, which keeps it legible on hatching and lines."""
        left, high = self.x(box[0]) - 1, self.y(box[3])
        wide, tall = (box[2] - box[0]) / self.unit + 2, (box[3] - box[1]) / self.unit
        return f'x="{left:.1f}" y="{high:.1f}" width="{wide:.1f}" height="{tall:.1f}"'


def build_plan(page: FloorPage, results: Results, ways: Sequence[Stretch] = ()) -> Plan | None:
    """Return the plan of a floor with its segments, or None where neither a piece nor a segment has a position."""
    pieces = tuple(
        _build_piece(one, (one.item.x_m, one.item.y_m))
        for one in page.results
        if one.item.x_m is not None and one.item.y_m is not None
    )
    if not pieces and not ways:
        return None
    own = [place for place in results.places if place.floor == page.floor.floor]
    rooms, underlay = list_rooms(own), build_underlay(results, page.floor.floor)
    edge = find_edge(rooms, underlay.corners if underlay else (), [one.at for one in pieces])
    if edge is not None:
        pieces = tuple(replace(one, fallen=cut_falls(one.fallen, edge[0])) for one in pieces)
    places = [(place, (place.x, place.y)) for place in own if place.x is not None and place.y is not None]
    drawn: list[Sequence[Point]] = [ring for one in pieces for ring in (one.corners, *one.fallen)]
    drawn += [*(one.corners for one in ways), *(room.outline for room in rooms), [at for _place, at in places]]
    box = bounds([point for points in drawn for point in points])
    if underlay is not None:
        box = widen(box, underlay.corners)
    frame = box[0] - BORDER, box[1] - BORDER, box[2] + BORDER, box[3] + BORDER
    unit = max((frame[2] - frame[0]) / (WIDE - BESIDE), (frame[3] - frame[1]) / (HIGH - BELOW), 1 / LARGEST)
    shapes = [bounds(one.corners) for one in pieces]
    signed = tuple(place_signs(ways, shapes, unit))
    signs = [(one.name, sign_box(one.sign, unit)) for one in signed if one.sign is not None]
    warned = [(one.name, sign_box(one.sign, unit)) for one in signed if one.sign is not None and not one.is_open]
    names, taken = Names(frame, unit, shapes), [*shapes, *(box for _name, box in signs)]
    falls = [bounds(ring) for one in pieces for ring in one.fallen]
    spots = names.place_spots(places, [*taken, *falls])
    inside = [(words.cut(one.name, NAMED), (*one.centre, *one.centre)) for one in rooms if one.name]
    room_names = [one for one in names.place(inside, taken) if one is not None]
    named = [(one.upper, one) for one in pieces if one.upper is not None and one.upper >= RiskClass.MEDIUM]
    least = RiskClass.HIGH if any(upper >= RiskClass.HIGH for upper, _one in named) else RiskClass.MEDIUM
    named = sorted((pair for pair in named if pair[0] >= least), key=lambda pair: -pair[0])
    risky = [(one.name, bounds(one.corners)) for _upper, one in named[:MOST]]
    labels = [one for one in names.place(risky, taken) if one is not None]
    return Plan(
        key=f"plan-{[floor.floor for floor in results.floor_rows].index(page.floor.floor) + 1}", title=page.title,
        pieces=pieces, places=tuple(spots), labels=tuple(labels), ways=signed, names=tuple(names.place_ways(warned)),
        rooms=rooms, room_names=tuple(room_names), keys=tuple(names.keys), underlay=underlay,
        cut_at=edge[1] if edge else "", low=frame[:2], high=frame[2:], unit=unit,
        north=results.building.azimuth_deg,  # X lies as far clockwise from north as north anticlockwise from X
    )  # fmt: skip


def crop_plan(plan: Plan, results: Results, room: str, numbers: Mapping[int, str], key: str) -> Plan | None:
    """Return the part of a plan that holds a room, for work orders; None where no piece of it has a position.

    `numbers` are those of the lines by the numbers of their pieces (`Piece.number`); all other pieces are grey. Falls,
    routes and names are left out, and so is a picture under the plan, which would be in the file once for each room.
    """
    rows = results.item_rows
    floor = {rows[number - 1].floor for number in numbers}
    own = {one.index + 1 for one in rows if one.room == room and one.floor in floor}
    outlines = [one.outline for one in plan.rooms if one.name == room]
    there = [one.corners for one in plan.pieces if one.number in (own if room else numbers)]
    if not any(one.number in numbers for one in plan.pieces):
        return None
    box = bounds([point for ring in (*there, *outlines) for point in ring])
    x, y = (max(AROUND, (SMALLEST - (box[at + 2] - box[at])) / 2) for at in (0, 1))
    low, high = (box[0] - x, box[1] - y), (box[2] + x, box[3] + y)

    def is_inside(corners: Sequence[Point]) -> bool:
        return all(low[0] <= x <= high[0] and low[1] <= y <= high[1] for x, y in corners)

    pieces = tuple(
        replace(one, symbol="", mark=numbers[one.number], fallen=()) if one.number in numbers
        else replace(one, symbol="", fallen=(), fill=ANCHORED, ink=words.INK)
        for one in plan.pieces if is_inside(one.corners)
    )  # fmt: skip
    unit = max((high[0] - low[0]) / (WIDE - BESIDE), (high[1] - low[1]) / CROPPED, 1 / LARGEST)
    under = plan.underlay if plan.underlay and not plan.underlay.image else None
    return replace(
        plan, key=key, title=f"{plan.title}: {words.cut(room, 60)}" if room else plan.title, pieces=pieces, places=(),
        labels=(), ways=(), names=(), room_names=(), keys=(), cut_at="", is_crop=True, north=None, low=low, high=high,
        rooms=tuple(one for one in plan.rooms if is_inside(one.outline)), underlay=under, unit=unit,
    )  # fmt: skip


def _build_piece(one: ItemResult, at: Point) -> Piece:
    item, risk, is_outside = one.item, one.adopted.risk, one.is_anchored or bool(one.apart)
    breadth = item.breadth_cm / 100
    across, angle = (item.width_cm or item.breadth_cm) / 100, turn(item)
    ways: tuple[Corners, ...] = ()
    if not one.is_anchored and max(risk, one.adopted.upper) >= RiskClass.MEDIUM:
        ways = fallen(at, angle, breadth, across, item.height_cm / 100)
        if item.falls_toward_deg is not None:  # away from a wall alone
            is_ahead = math.cos(math.radians(item.falls_toward_deg - angle)) > 0
            ways = ways[:1] if is_ahead else ways[1:]
    named, kind = words.cut(item.item, 40), item.description or item.type
    described = f"{named}, {words.cut(kind, 80)}" if kind else named
    return Piece(
        number=item.index + 1, name=words.cut(item.item, SHORT),
        upper=None if is_outside else max(risk, one.adopted.upper),
        title=_("{item}: {risk}; chance {chance}",
                item=described, risk=words.risk_words(one), chance=words.chance(one)),
        class_name=words.style_name(one), ink=words.INK if is_outside else risk.ink,
        fill=ANCHORED if one.is_anchored else words.APART_FILL if one.apart else risk.fill,
        symbol=words.style_name(one), side=min(breadth, across),
        at=at, corners=rectangle(at, angle, (-breadth / 2, breadth / 2), across), fallen=ways,
    )  # fmt: skip


def turn(item: ItemRow) -> float:
    """Return the direction of Breadth [deg], anticlockwise from X: that of the axis where no angle is given."""
    if item.angle_deg is not None:
        return item.angle_deg
    return 90.0 if item.axis_given == "Y" else 0.0


def _round(length: float) -> float:
    """Return the least length [m] that is round in the reader's unit and at least this."""
    scale = measures.convert(1.0, "m")
    return _step(length * scale) / scale


def _step(least: float) -> float:
    return next((step for step in _STEPS if step >= least), _STEPS[-1])
