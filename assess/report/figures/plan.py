"""The plan of a floor, in metres: its pieces to scale, what they would cover if they fell, places and routes.

The template plan.svg.j2 draws it in pixels, Y downwards, by `Plan.x`, `Plan.y` and `Plan.outline`: in metres its
letters would be smaller than some programs can draw.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.model import Place
from assess.report import words
from assess.report.content import FloorPage
from assess.report.figures.labels import LINE, Bounds, Corners, Label, Point, bounds, overlap, place_labels, text_width
from assess.report.figures.ways import Stretch, Style, name_ways, place_signs, sign_box
from assess.results import ItemResult, ItemRow, Results
from assess.risk import RiskClass

ANCHORED, INK = "#d0d0d0", "#1c1c1c"
"""Fill of an anchored piece, which stands outside the classes, and the colour of its symbol."""
WIDE, HIGH = 660.0, 780.0
"""Most of a drawing [px]: the width of a page in upright format, and what of its height leaves room for the text."""
BESIDE, BELOW = 26.0, 44.0
"""Room for the ticks, and for the scale bar below them [px]."""
LARGEST = 90.0
"""Scale [px/m] that is not gone beyond for a few pieces close together."""
BORDER = 0.4
"""Free space round everything that is drawn [m]."""
NAMED = 24
"""Characters of a place's name that are drawn."""
SHORT = 12
"""Characters of a piece's name that are drawn."""
KINDS = ("exit", "stair", "door", "room")
"""Kinds of places, each with a sign of its own."""
LARGE = ("exit", "stair")
"""Those whose sign is a large one."""
_STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
_TICKS = 12


@dataclass(frozen=True, slots=True)
class Piece:
    """One piece; `number` is that of its row among all pieces, from 1, and `side` its shorter side [m]."""

    number: int
    name: str
    title: str
    upper: RiskClass | None
    """The class that it may reach; None where it stands outside the classes."""
    class_name: str
    fill: str
    ink: str
    symbol: str
    marks: str
    side: float
    at: Point
    corners: Corners
    fallen: tuple[Corners, ...]
    """What it would cover if it fell, one rectangle a way: only for a free-standing one of at least medium class."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place with its name, which begins or, `is_before`, ends at `label`; `box` is the room that it takes."""

    name: str
    kind: str
    at: Point
    label: Point
    is_before: bool
    box: Bounds


@dataclass(frozen=True, slots=True)
class Plan:
    """One floor's plan; `low` and `high` are the corners of what is drawn, `unit` [m] one pixel of the drawing."""

    key: str
    """What the ids of the drawing begin with: no other plan of the report has the same."""
    title: str
    pieces: tuple[Piece, ...]
    places: tuple[Spot, ...]
    labels: tuple[Label, ...]
    ways: tuple[Stretch, ...]
    """Segments, those with most to warn of first."""
    names: tuple[Label, ...]
    """Names of segments."""
    low: Point
    high: Point
    unit: float
    north: float | None
    """Direction of north [deg], anticlockwise from X, where it is known."""

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
        """What is taken by the names, of places, pieces and segments."""
        return (*(spot.box for spot in self.places), *(label.box for label in (*self.labels, *self.names)))

    @property
    def styles(self) -> Sequence[Style]:
        """How the states that occur are drawn, the worst first."""
        return list(dict.fromkeys(one.style for one in self.ways))

    @property
    def kinds(self) -> Sequence[str]:
        """Kinds of the places that have a sign of their own."""
        return [kind for kind in KINDS if any(spot.kind == kind for spot in self.places)]

    @property
    def ticks(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Values along X and Y, at the same round distance."""
        step = _step(max(self.high[0] - self.low[0], self.high[1] - self.low[1]) / _TICKS)
        return _multiples(step, self.low[0], self.high[0]), _multiples(step, self.low[1], self.high[1])

    @property
    def bar(self) -> float:
        """Length of the scale bar [m]: round, and about a sixth of the width."""
        return _step((self.high[0] - self.low[0]) / 8)

    def symbol_size(self, piece: Piece) -> float:
        """Return the size of a piece's symbol [px]: that of the piece, yet legible and no giant."""
        return round(min(max(0.95 * piece.side / self.unit, 6), 16), 1)

    def mask(self, box: Bounds) -> str:
        """Return the attributes of the white ground under a name, which keeps it legible on hatching and lines."""
        left, high = self.x(box[0]) - 1, self.y(box[3])
        wide, tall = (box[2] - box[0]) / self.unit + 2, (box[3] - box[1]) / self.unit
        return f'x="{left:.1f}" y="{high:.1f}" width="{wide:.1f}" height="{tall:.1f}"'

    def right(self, piece: Piece) -> float:
        """Return where the right end of a piece lies in the drawing."""
        return self.x(max(x for x, _y in piece.corners))


def build_plan(page: FloorPage, results: Results, ways: Sequence[Stretch] = ()) -> Plan | None:
    """Return the plan of a floor with its segments, or None where neither a piece nor a segment has a position."""
    pieces = tuple(
        _piece(one, (one.item.x_m, one.item.y_m))
        for one in page.results
        if one.item.x_m is not None and one.item.y_m is not None
    )
    if not pieces and not ways:
        return None
    places = [(place, at) for place in results.places if (at := _position(place, page.floor.floor))]
    low, high = _frame(pieces, ways, [at for _place, at in places])
    unit, frame = _unit(low, high), (*low, *high)
    signed = tuple(place_signs(ways, [bounds(one.corners) for one in pieces], unit))
    signs = [sign_box(one.sign, unit) for one in signed if one.sign is not None]
    spots = tuple(_spots(places, pieces, signs, high, unit))
    labels = tuple(_labels(pieces, [*(spot.box for spot in spots), *signs], frame, unit))
    taken = [*(bounds(one.corners) for one in pieces), *(spot.box for spot in spots), *(one.box for one in labels)]
    return Plan(
        key=f"plan-{[floor.floor for floor in results.floor_rows].index(page.floor.floor) + 1}",
        title=page.title,
        pieces=pieces,
        places=spots,
        labels=labels,
        ways=signed,
        names=tuple(name_ways(signed, taken, frame, unit)),
        low=low,
        high=high,
        unit=unit,
        north=results.building.azimuth_deg,  # X lies as far clockwise from north as north anticlockwise from X
    )


def _position(place: Place, floor: str) -> Point | None:
    return None if place.floor != floor or place.x is None or place.y is None else (place.x, place.y)


def _piece(one: ItemResult, at: Point) -> Piece:
    item, risk, is_outside = one.item, one.adopted.risk, one.is_anchored or bool(one.apart)
    breadth = item.breadth_cm / 100
    across, angle = (item.width_cm or item.breadth_cm) / 100, turn(item)
    falls = not one.is_anchored and max(risk, one.adopted.upper) >= RiskClass.MEDIUM
    return Piece(
        number=item.index + 1,
        name=words.cut(item.item, SHORT),
        upper=None if is_outside else max(risk, one.adopted.upper),
        title=_title(one),
        class_name=words.style_name(one),
        fill=ANCHORED if one.is_anchored else words.APART_FILL if one.apart else risk.fill,
        ink=INK if is_outside else risk.ink,
        symbol=words.class_symbol(one),
        marks="" if is_outside else words.class_marks(one),
        side=min(breadth, across),
        at=at,
        corners=rectangle(at, angle, (-breadth / 2, breadth / 2), across),
        fallen=_ways_to_fall(item, at) if falls else (),
    )


def turn(item: ItemRow) -> float:
    """Return the direction of Breadth [deg], anticlockwise from X: that of the axis where no angle is given."""
    if item.angle_deg is not None:
        return item.angle_deg
    return 90.0 if item.axis_given == "Y" else 0.0


def rectangle(at: Point, angle: float, along: tuple[float, float], across: float) -> Corners:
    """Return the corners of a rectangle [m], anticlockwise.

    `at` is the centre of the piece, `angle` [deg] the direction of Breadth, `along` where the rectangle begins and ends
    along it from the centre, `across` its width across it.
    """
    cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    (x, y), (near, far), half = at, along, across / 2
    local = ((near, -half), (far, -half), (far, half), (near, half))
    one, two, three, four = ((x + u * cos - v * sin, y + u * sin + v * cos) for u, v in local)
    return one, two, three, four


def _ways_to_fall(item: ItemRow, at: Point) -> tuple[Corners, ...]:
    """Return what a piece covers beyond its footprint, each way that it may fall: away from a wall alone."""
    across, angle = (item.width_cm or item.breadth_cm) / 100, turn(item)
    ahead, behind = fallen(at, angle, item.breadth_cm / 100, across, item.height_cm / 100)
    if item.falls_toward_deg is None:
        return ahead, behind
    return (ahead,) if math.cos(math.radians(item.falls_toward_deg - angle)) > 0 else (behind,)


def fallen(at: Point, angle: float, breadth: float, width: float, height: float) -> tuple[Corners, Corners]:
    """Return what a piece covers beyond its footprint if it falls over either of its edges across Breadth [m]."""
    edge = breadth / 2
    return rectangle(at, angle, (edge, edge + height), width), rectangle(at, angle, (-edge - height, -edge), width)


def _title(one: ItemResult) -> str:
    named, kind = words.cut(one.item.item, 40), one.item.description or one.item.type
    described = f"{named}, {words.cut(kind, 80)}" if kind else named
    return _("{item}: {risk}; chance {chance}", item=described, risk=words.risk_words(one), chance=words.chance(one))


def _frame(pieces: Sequence[Piece], ways: Sequence[Stretch], places: Iterable[Point]) -> tuple[Point, Point]:
    """Return the lower left and the upper right corner of what is drawn."""
    drawn = [corners for one in pieces for corners in (one.corners, *one.fallen)] + [one.corners for one in ways]
    xs, ys = zip(*(point for corners in drawn for point in corners), *places, strict=True)
    return (min(xs) - BORDER, min(ys) - BORDER), (max(xs) + BORDER, max(ys) + BORDER)


def _unit(low: Point, high: Point) -> float:
    return max((high[0] - low[0]) / (WIDE - BESIDE), (high[1] - low[1]) / (HIGH - BELOW), 1 / LARGEST)


def _spots(
    places: Sequence[tuple[Place, Point]], pieces: Sequence[Piece], signs: Sequence[Bounds], high: Point, unit: float
) -> Iterator[Spot]:
    """Place the name of each place above or below it, right or left, where it covers least of what is drawn already."""
    taken = [*(bounds(corners) for one in pieces for corners in (one.corners, *one.fallen)), *signs]
    for place, (x, y) in places:
        shown = words.cut(place.place, NAMED)
        wide, tall, off = text_width(shown) * unit, LINE * unit, (8 if place.kind in LARGE else 4) * unit
        tried = [(x0, y0, x0 + wide, y0 + tall) for y0 in (y + off, y - off - tall) for x0 in (x + off, x - off - wide)]
        box = min(tried, key=lambda one: _cost(one, taken, high))
        taken.append(box)
        is_before = box[0] < x
        yield Spot(shown, place.kind, (x, y), (box[2 if is_before else 0], box[1] + 0.2 * tall), is_before, box)


def _labels(pieces: Sequence[Piece], others: Sequence[Bounds], frame: Bounds, unit: float) -> Iterator[Label]:
    """Name the pieces that are or may be of high or very high class; without one, those of medium class."""
    risky = [(one.upper, one) for one in pieces if one.upper is not None and one.upper >= RiskClass.MEDIUM]
    least = RiskClass.HIGH if any(upper >= RiskClass.HIGH for upper, _one in risky) else RiskClass.MEDIUM
    named = sorted((pair for pair in risky if pair[0] >= least), key=lambda pair: -pair[0])
    taken = [*(bounds(one.corners) for one in pieces), *others]
    return place_labels([(one.name, bounds(one.corners)) for _upper, one in named], taken, frame, unit)


def _cost(box: Bounds, taken: Sequence[Bounds], high: Point) -> float:
    """Return how much [m2] of a name lies over other things; outside the drawing is worse than over anything."""
    over = sum(overlap(box, other) for other in taken)
    return over + (1e6 if box[2] > high[0] or box[3] > high[1] else 0)


def _step(least: float) -> float:
    return next((step for step in _STEPS if step >= least), _STEPS[-1])


def _multiples(step: float, low: float, high: float) -> tuple[float, ...]:
    return tuple(round(step * at, 1) for at in range(math.ceil(low / step), math.floor(high / step) + 1))
