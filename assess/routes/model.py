"""What the evaluation of the evacuation routes found, for the scenario; pieces go by their index in the inventory."""

from dataclasses import dataclass
from enum import IntEnum

from assess.inventory.model import Place, Segment
from assess.risk import RiskClass, classify
from assess.routes.widths import NARROWER


class RouteState(IntEnum):
    """What a segment or a route comes to, in rising order."""

    OPEN = 0
    REDUCED = 1
    BLOCKED = 2

    @property
    def word(self) -> str:
        """The state in words."""
        return ("open", "reduced", "blocked")[self]

    @property
    def symbol(self) -> str:
        """A sign that tells the state without colour."""
        return ("✓", "≈", "✕")[self]

    @property
    def fill(self) -> str:
        """Colour of the route on the plan: light to dark, told apart without red and green."""
        return ("#bfe3f2", "#f2b84b", "#8c1d3f")[self]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """The chance of something that fallen pieces cause.

    Parameters
    ----------
    probability : float
        From the joint outcomes where all the pieces were verified together; else the largest of the three values
        beside it [-].
    low, high : float
        Joint: the interval of the number of motions. Else: the range of the values beside, widened by that [-].
    joint : float
        Pieces that were verified together fall as they did motion by motion, all others independently [-].
    independent : float
        Every piece falls independently of the others [-].
    correlated : float
        The less likely piece falls only where the more likely one does: full correlation [-].
    runs : int
        Motions of the joint outcomes; 0 where no piece was verified.
    is_joint : bool
        Whether every piece that takes part was verified, and all of them under the motions of one source.
    pieces, unverified : int
        Pieces that take part, and those of them that enter by their adopted chance alone.
    """

    probability: float
    low: float
    high: float
    joint: float
    independent: float
    correlated: float
    runs: int
    is_joint: bool
    pieces: int
    unverified: int

    @property
    def risk(self) -> RiskClass:
        """Its class, by the limits of a piece's chance of overturning."""
        return RiskClass(classify(self.probability) or 0)

    @property
    def upper(self) -> RiskClass:
        """The class that it may be of, by the upper end."""
        return RiskClass(classify(self.high) or 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Beside:
    """A piece beside a segment.

    Parameters
    ----------
    item : int
        Its index in the inventory.
    by_plan : bool
        Whether its position on the plan tells what it covers; else its Edge distance.
    distance, reach, left : float
        From its nearest face to the edge of the route, 0 or below if inside; how far into the route it lies once
        fallen, across it; the width that is left beside it alone [m].
    blocks_alone : bool
        Whether `left` is under the required width.
    together : float
        Chance that it falls while the segment is blocked [-]; for an anchored one, if anchors fail.
    flags : tuple of str
        Keys of `FLAGS`.
    """

    item: int
    by_plan: bool
    distance: float
    reach: float
    left: float
    blocks_alone: bool
    together: float = 0.0
    flags: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Outlook:
    """What may become of a segment or of a route.

    Parameters
    ----------
    state, upper : RouteState
        Blocked or reduced where that chance, or the upper end of its interval, is at least the chosen risk.
    blocked, taken : Chance
        Of being blocked, and of being blocked or reduced, if all anchors hold.
    if_anchors_fail : Chance, optional
        Of being blocked, with anchored pieces taken as free-standing; None where there are none.
    in_record : RouteState, optional
        Under the recorded motion itself; None where no piece has one.
    blocker : int, optional
        The free-standing piece that most likely falls while it is blocked.
    """

    state: RouteState
    upper: RouteState
    blocked: Chance
    taken: Chance
    if_anchors_fail: Chance | None
    in_record: RouteState | None
    blocker: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentResult:
    """One segment.

    Parameters
    ----------
    segment : Segment
        As the workbook has it.
    clear, required : float
        The widths that were used [m].
    standing, least : float
        Width left with nothing fallen, and with every free-standing piece fallen [m].
    needed : float, optional
        Width that its occupants need [m].
    is_short : bool
        Whether it is too narrow for its occupants with nothing fallen.
    crowded : Chance, optional
        Of its being too narrow for its occupants; None where their number is unknown.
    length : float, optional
        Between its places [m].
    beside : tuple of Beside
        The pieces that reach it, the one most likely to block it first.
    flags : tuple of str
        Keys of `FLAGS`.
    is_evaluated : bool
        Whether anything tells which pieces can reach it: the plan, or a piece that names it.
    other_rooms : tuple of int
        Pieces that would reach it, were they not in another room than those that its Room names.
    """

    segment: Segment
    outlook: Outlook
    clear: float
    required: float
    standing: float
    least: float
    needed: float | None
    is_short: bool
    crowded: Chance | None
    length: float | None
    beside: tuple[Beside, ...]
    flags: tuple[str, ...]
    is_evaluated: bool
    other_rooms: tuple[int, ...]

    @property
    def is_blocked_standing(self) -> bool:
        """Whether it is under the required width with nothing fallen."""
        return self.standing < self.required - NARROWER


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteFix:
    """One step of what to fix for a route: the piece, its gain, 0 where others must follow, and the chance left [-]."""

    item: int
    gain: float
    left: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteResult:
    """One route.

    `segments` are places in `Routes.segments`, `unevaluated` those of which nothing tells what can reach them; `fixes`
    is the smallest set found that brings it under the chosen risk, and `is_mended` whether it does.
    """

    route: str
    outlook: Outlook
    segments: tuple[int, ...]
    floors: tuple[str, ...]
    fixes: tuple[RouteFix, ...]
    is_mended: bool
    unevaluated: tuple[int, ...]

    @property
    def is_evaluated(self) -> bool:
        """Whether any of its segments is."""
        return len(self.unevaluated) < len(self.segments)


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """A way out: its segments in order, its end, the chance of a blockage, and the segments that the safest has too."""

    segments: tuple[int, ...]
    end: str
    blocked: Chance
    shared: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomResult:
    """One room of the network.

    Parameters
    ----------
    place : Place
        The room.
    exits : tuple of str
        The exits that can be reached; where there are none, `by_stairs`, the stairs, beyond which nothing is known.
    loses : Chance
        Of losing every one of them.
    if_anchors_fail : Chance, optional
        The same with anchored pieces taken as free-standing.
    blocker : int, optional
        The free-standing piece that most likely falls while it loses every exit.
    ways : tuple of Way
        Ways out, the safest first: others share as few segments with those before them as may be.
    unevaluated : tuple of int
        Segments on any of its ways out of which nothing tells what can reach them.
    """

    place: Place
    exits: tuple[str, ...]
    by_stairs: bool
    loses: Chance
    if_anchors_fail: Chance | None
    blocker: int | None
    ways: tuple[Way, ...]
    unevaluated: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorRoutes:
    """One floor: its segments, routes (by those alone), rooms, and how many are expected to be blocked or cut off."""

    floor: str
    segments: int
    blocked_segments: float
    routes: int
    blocked_routes: float
    rooms: int
    cut_off_rooms: float
    any_room: Chance | None
    """Chance that at least one of its rooms loses every exit."""
    uncounted: int
    """Pieces of which neither the plan nor a Route tells whether they fall onto a segment."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Routes:
    """The evacuation routes of a building.

    `risk` is the chosen risk: states go by it, and fixes are sought down to it. `blocked_routes` is the number of
    routes that are expected to be blocked, `cut_off_rooms` that of rooms which lose every exit. `draws` is the number
    of draws where the pieces are too many to go through all that may fall together.
    """

    risk: float
    segments: tuple[SegmentResult, ...]
    routes: tuple[RouteResult, ...]
    rooms: tuple[RoomResult, ...]
    floors: tuple[FloorRoutes, ...]
    blocked_routes: float
    cut_off_rooms: float
    draws: int
