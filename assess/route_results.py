"""The evacuation routes in the results: flat rows with units in their names, small, equal after a round trip.

Rows name what they refer to. Where another table is joined they also hold a 0-based index: `item_index` into the items,
`segment_indices` into the segments. Nothing refers to an inventory.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from enum import StrEnum
from typing import Any

from assess.annual_results import AnnualRow
from assess.risk import RiskClass, classify

FLAGS: Mapping[str, str] = {
    "segment_assumed": "the workbook names no segment: it counts beside every segment of its route on its floor",
    "edge_assumed": "no Edge distance is given: it is taken to stand at the edge of the route",
    "side_unknown": "placed by its Edge distance alone: its side is unknown, so it may face any other piece",
    "direction_unknown": "neither Axis nor Angle is given: it may fall in any direction",
    "falls_from_wall": "it stands against a wall and falls away from it",
    "wall_side_unknown": "it stands against a wall, but its side is not known: it may fall either way",
    "width_assumed": "no Width is given: its Breadth is used",
    "nearer_than_plan": "its Edge distance is smaller than its position on the plan gives: the distance counts",
    "standing_inside": "it stands in the route with nothing fallen",
    "clear_assumed": "no Clear width is given: the required width is used, so any piece that reaches in blocks it",
    "required_assumed": "no Required width is given: 0.9 m is used",
    "walls_unknown": "no Room is given: placed pieces behind a wall count as well",
    "own_rooms": "placed pieces of other rooms do not count unless they name it",
    "no_plan": "its places have no positions: only pieces that name it count",
    "between_floors": "its places lie on different floors: only pieces that name it count",
    "unconfirmed_period": "its lower simulated class is not confirmed, as neither T1 nor the height of the building is "
    "known: it counts as standing and as fallen",
    "unconfirmed_motions": "its lower simulated class is not confirmed, as the motions are weaker than the floor's: it "
    "counts as standing and as fallen",
}
"""What each flag of a piece beside a segment, or of a segment, means."""

DOUBTS: Mapping[str, str] = {"unknown_period": "unconfirmed_period", "weak_motions": "unconfirmed_motions"}
"""Flags of unconfirmed pieces, by the flag of the simulation that keeps a lower class from being adopted."""


class RouteState(StrEnum):
    """The state of a segment or of a route.

    Not evaluated: nothing tells what can reach it. Not known: it depends on pieces whose class is not confirmed.
    """

    NOT_EVALUATED = "not evaluated"
    OPEN = "open"
    REDUCED = "reduced"
    NOT_KNOWN = "not known"
    BLOCKED = "blocked"

    @property
    def severity(self) -> int:
        """Its place in rising order: 0 for open and for what is not evaluated, 1 reduced, 2 not known, 3 blocked."""
        return {RouteState.REDUCED: 1, RouteState.NOT_KNOWN: 2, RouteState.BLOCKED: 3}.get(self, 0)

    @property
    def symbol(self) -> str:
        """A sign that shows the state without colour."""
        return ("✓", "≈", "?", "✕")[self.severity] if self != RouteState.NOT_EVALUATED else "–"

    @property
    def fill(self) -> str:
        """Colour on the plan: from light to dark, distinct without red and green."""
        return ("#bfe3f2", "#f2b84b", "#858585", "#8c1d3f")[self.severity]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """The chance of something that fallen pieces cause.

    Parameters
    ----------
    probability : float
        From the joint outcomes where all the pieces were simulated in the same draws; else the largest of `joint`,
        `independent` and `correlated` [-].
    low, high : float
        Joint: the sampling interval of the number of draws. Else: the range of the three values, widened by that [-].
    joint : float
        Simulated pieces fall as they did draw by draw, one earthquake for the whole building; all others independently
        [-].
    independent : float
        Every piece falls independently of the others [-].
    correlated : float
        Full correlation: the less likely piece falls only where the more likely one does [-].
    runs : int
        Draws of the joint outcomes; 0 where no piece was simulated.
    is_joint : bool
        Whether every piece that takes part was simulated, and all of them in the same number of draws.
    pieces, unverified : int
        Pieces that take part, and those of them that enter by their adopted chance alone.
    unconfirmed : int
        Further pieces whose chance is not confirmed: all of them stand, or all of them fall, as the field says.
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
    unconfirmed: int = 0

    @property
    def risk(self) -> RiskClass:
        """Its class, by the limits of a piece's chance of overturning."""
        return RiskClass(classify(self.probability) or 0)

    @property
    def upper(self) -> RiskClass:
        """The class by the upper end."""
        return RiskClass(classify(self.high) or 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceRef:
    """A row of furniture: its name, its row in the workbook, and its index in the items."""

    item: str
    row: int
    item_index: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BesideRow:
    """A piece beside a segment.

    Parameters
    ----------
    item, row, item_index
        As in `PieceRef`.
    by_plan : bool
        Whether what it covers follows from its position on the plan; else from its Edge distance.
    distance_m, reach_m, left_m : float
        From its nearest face to the edge of the route, 0 or below if inside; how far it lies in the route once fallen,
        measured across the route; the width left with this piece alone fallen [m].
    blocks_alone : bool
        Whether `left_m` is under the required width.
    falls_while_blocked : float, optional
        Chance that it falls while the segment is blocked [-]; for an anchored piece, if anchors fail. None where its
        chance is not confirmed.
    flags : tuple of str
        Keys of `FLAGS`.
    """

    item: str
    row: int
    item_index: int
    by_plan: bool
    distance_m: float
    reach_m: float
    left_m: float
    blocks_alone: bool
    falls_while_blocked: float | None = 0.0
    flags: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentRow:
    """One segment.

    Parameters
    ----------
    route, segment, floor, from_place, to_place, room, clear_width_m, required_width_m, occupants, notes
        As the workbook has them; None where it says nothing.
    workbook_row : int
        Its row in the sheet Routes.
    evaluated : bool
        Whether it is known which pieces can reach it: by the plan, or because a piece names it.
    clear_width_used_m, required_width_used_m : float
        With what was assumed where the workbook says nothing [m].
    standing_width_m, least_width_m : float
        Width left with nothing fallen, and with every free-standing piece fallen, None if not evaluated [m].
    needed_width_m : float, optional
        Width that its occupants need [m].
    length_m : float, optional
        Between its places [m].
    start_x_m, start_y_m, end_x_m, end_y_m : float, optional
        The ends of its centre line on the plan of its floor [m].
    extends_start_m, extends_end_m : float
        How far it goes on beyond them, round a bend [m].
    state, state_upper : RouteState
        Blocked or reduced where that chance is at least the chosen risk; not known where that differs between
        unconfirmed pieces standing and fallen, unless it is blocked either way. The second: the worst state that is not
        excluded, by the upper end of the interval and with unconfirmed pieces fallen.
    blocked, blocked_or_reduced : Chance, optional
        If all anchors hold, and with unconfirmed pieces standing; None if not evaluated.
    blocked_if_unconfirmed_fall : Chance, optional
        The first with unconfirmed pieces fallen; None where there are none.
    blocked_if_anchors_fail : Chance, optional
        With anchored pieces taken as free-standing and unconfirmed ones fallen; None where none is anchored.
    doubts : tuple of str
        Keys of `FLAGS`: why its state is not known; empty where it is.
    under_record : RouteState, optional
        Its state under the recorded motion itself; None where no piece has one.
    most_likely_piece : PieceRef, optional
        The free-standing piece most likely to fall while it is blocked.
    is_blocked_standing : bool
        Whether it is under the required width with nothing fallen.
    insufficient_for_occupants : bool
        Whether it is too narrow for its occupants with nothing fallen.
    insufficient_after_falls : Chance, optional
        Of being too narrow for its occupants, with unconfirmed pieces standing; None where their number is unknown, if
        not evaluated, or where it depends on unconfirmed pieces whether the chance is at least the chosen risk.
    pieces : tuple of BesideRow
        The pieces that reach it, the one most likely to block it first.
    other_rooms : tuple of PieceRef
        Pieces that would reach it if they were not in another room than its own.
    flags : tuple of str
        Keys of `FLAGS`.
    """

    route: str
    segment: str
    floor: str | None
    from_place: str | None
    to_place: str | None
    room: str | None
    clear_width_m: float | None
    required_width_m: float | None
    occupants: int | None
    notes: str
    workbook_row: int
    evaluated: bool
    clear_width_used_m: float
    required_width_used_m: float
    standing_width_m: float
    least_width_m: float | None
    needed_width_m: float | None
    length_m: float | None
    start_x_m: float | None
    start_y_m: float | None
    end_x_m: float | None
    end_y_m: float | None
    extends_start_m: float
    extends_end_m: float
    state: RouteState
    state_upper: RouteState
    blocked: Chance | None
    blocked_or_reduced: Chance | None
    blocked_if_unconfirmed_fall: Chance | None
    blocked_if_anchors_fail: Chance | None
    doubts: tuple[str, ...]
    under_record: RouteState | None
    most_likely_piece: PieceRef | None
    is_blocked_standing: bool
    insufficient_for_occupants: bool
    insufficient_after_falls: Chance | None
    pieces: tuple[BesideRow, ...]
    other_rooms: tuple[PieceRef, ...]
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteFixRow:
    """One step of what to fix for a route: the piece, its gain, 0 where others must follow, and the chance left [-].

    Unconfirmed pieces count as fallen in both until they are fixed.
    """

    item: str
    row: int
    item_index: int
    gain: float
    left: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteRow:
    """One route.

    `state` to `most_likely_piece` are as in `SegmentRow`. `unevaluated_segments` names those of its segments that are
    not evaluated; `evaluated` is whether any is. `fixes` is the smallest set found that brings the route under the
    chosen risk with unconfirmed pieces fallen, and `is_fixed` whether one exists: not where it is blocked with nothing
    fallen. `annual` is how often a year it is blocked if all anchors hold, `annual_if_anchors_fail` the same with
    anchored pieces taken as free-standing, None where there are none; both are None where no hazard file is given.
    """

    route: str
    floors: tuple[str, ...]
    segment_indices: tuple[int, ...]
    evaluated: bool
    unevaluated_segments: tuple[str, ...]
    state: RouteState
    state_upper: RouteState
    blocked: Chance | None
    blocked_or_reduced: Chance | None
    blocked_if_unconfirmed_fall: Chance | None
    blocked_if_anchors_fail: Chance | None
    doubts: tuple[str, ...]
    under_record: RouteState | None
    most_likely_piece: PieceRef | None
    fixes: tuple[RouteFixRow, ...]
    is_fixed: bool
    annual: AnnualRow | None = None
    annual_if_anchors_fail: AnnualRow | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WayRow:
    """A way out: its segments in order, its end, the chance of a blockage, and the segments shared with the safest.

    `blocked` and `blocked_if_unconfirmed_fall` are as in `SegmentRow`. It is known where both are on one side of the
    chosen risk.
    """

    segment_indices: tuple[int, ...]
    end: str
    blocked: Chance
    blocked_if_unconfirmed_fall: Chance | None
    is_known: bool
    shared: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomRow:
    """One room of the network.

    Parameters
    ----------
    room, floor : str
        Its name and its floor.
    exits : tuple of str
        The exits that can be reached; where there are none, `by_stairs`, the stairs, beyond which nothing is known.
    loses_every_exit : Chance
        Of losing all of them, if all anchors hold and with unconfirmed pieces standing.
    loses_if_unconfirmed_fall : Chance, optional
        The same with unconfirmed pieces fallen; None where there are none.
    loses_if_anchors_fail : Chance, optional
        With anchored pieces taken as free-standing and unconfirmed ones fallen; None where none is anchored.
    is_known : bool
        Whether the chance is on the same side of the chosen risk with unconfirmed pieces standing and fallen.
    doubts : tuple of str
        Keys of `FLAGS`: why it is not known; empty where it is.
    most_likely_piece : PieceRef, optional
        The free-standing piece most likely to fall while the room loses every exit.
    unevaluated_segments : tuple of str
        Segments on any of its ways out that are not evaluated.
    unevaluated_indices : tuple of int
        The same by their index.
    ways : tuple of WayRow
        Ways out, the safest first; further ones share as few segments as possible with those before them.
    annual : AnnualRow, optional
        How often a year it loses every exit, if all anchors hold; None where no hazard file is given.
    """

    room: str
    floor: str
    exits: tuple[str, ...]
    by_stairs: bool
    loses_every_exit: Chance
    loses_if_unconfirmed_fall: Chance | None
    loses_if_anchors_fail: Chance | None
    is_known: bool
    doubts: tuple[str, ...]
    most_likely_piece: PieceRef | None
    unevaluated_segments: tuple[str, ...]
    unevaluated_indices: tuple[int, ...]
    ways: tuple[WayRow, ...]
    annual: AnnualRow | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorRoutesRow:
    """One floor: its segments, its routes (by those segments alone), its rooms, and the expected losses among them.

    Expected losses are of those that are known; `unknown_segments`, `unknown_routes` and `unknown_rooms` count the
    others, which depend on unconfirmed pieces. `any_room_cut_off` is the chance that at least one of its rooms loses
    every exit; None without rooms, or where it depends on unconfirmed pieces. `uncounted_pieces` have neither a usable
    position nor a Route: whether they fall onto a segment is not known.
    """

    floor: str
    segments: int
    blocked_segments_expected: float
    unknown_segments: int
    routes: int
    blocked_routes_expected: float
    unknown_routes: int
    rooms: int
    cut_off_rooms_expected: float
    unknown_rooms: int
    any_room_cut_off: Chance | None
    uncounted_pieces: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteTables:
    """The evacuation routes of a building; without further arguments those of one that has none.

    Parameters
    ----------
    risk : float
        The chosen risk [-]: states go by it, and fixes are sought down to it.
    blocked_routes_expected, cut_off_rooms_expected : float
        Expected number of routes that are blocked, and of rooms that lose every exit, among those that are known.
    unknown_routes, unknown_rooms : int
        The others: what becomes of them depends on pieces whose chance is not confirmed.
    draws : int
        Draws that are made where all combinations of falling pieces are too many.
    uncounted_pieces : int
        Sum over the floors.
    """

    risk: float
    blocked_routes_expected: float = 0.0
    cut_off_rooms_expected: float = 0.0
    unknown_routes: int = 0
    unknown_rooms: int = 0
    draws: int = 0
    uncounted_pieces: int = 0
    segments: tuple[SegmentRow, ...] = ()
    routes: tuple[RouteRow, ...] = ()
    rooms: tuple[RoomRow, ...] = ()
    floors: tuple[FloorRoutesRow, ...] = ()

    def to_record(self) -> dict[str, Any]:
        """Return the content of `routes` in results.json."""
        record: dict[str, Any] = _plain(self)
        for segment in record["segments"]:
            segment["other_rooms"] = [one["item"] for one in segment["other_rooms"]]
        return record


JSON_NAMES = {"from_place": "from", "to_place": "to", "segment_indices": "segments"}
NOT_IN_JSON = frozenset(
    ("item_index", "unevaluated_indices", "workbook_row", "start_x_m", "start_y_m", "end_x_m", "end_y_m",
     "extends_start_m", "extends_end_m")
)  # fmt: skip


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        kept = (field.name for field in fields(value) if field.name not in NOT_IN_JSON)
        return {JSON_NAMES.get(name, name): _plain(getattr(value, name)) for name in kept}
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    return str(value) if isinstance(value, RouteState) else value
