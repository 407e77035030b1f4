"""The evacuation routes in the results: flat rows with units in their names, small, equal after a round trip.

Rows name what they refer to. Where another table is joined they also hold a 0-based index: `item_index` into the items,
`segment_indices` into the segments. Nothing refers to an inventory.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from enum import StrEnum
from typing import Any

from assess.annual_results import AnnualRow
from assess.risk import LIMITS, RiskClass, classify

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
    "stair_width_missing": "no Clear width is given: whether this stair is open is not known, unless pieces that name "
    "it block the required width",
    "required_assumed": "no Required width is given: 0.9 m is used",
    "walls_unknown": "no Room is given: placed pieces behind a wall count as well",
    "own_rooms": "placed pieces of other rooms do not count unless they name it",
    "no_plan": "its places have no positions: only pieces that name it count",
    "between_floors": "its places lie on different floors: only pieces that name it count",
    "unconfirmed_building": "its class is not confirmed, as nothing is known of the building: it counts as standing "
    "and as fallen",
    "unconfirmed_motions": "its lower simulated class is not confirmed, as the motions are weaker than the floor's: it "
    "counts as standing and as fallen",
    "rolls": "it stands on castors and may roll into the way: it counts as standing and as in the way",
}
"""What each flag of a piece beside a segment, or of a segment, means."""

ROLLING = "rolls"
DOUBTS: Mapping[str, str] = {
    "unknown_building": "unconfirmed_building", "weak_motions": "unconfirmed_motions", ROLLING: ROLLING
}  # fmt: skip
"""Flags of unconfirmed pieces, by the flag of the simulation that keeps a lower class from being adopted; of pieces
that roll their own."""


class RouteState(StrEnum):
    """The state of a segment, of a route, or of a room's way to the street.

    Blocked: the chance of a blockage is at least `BLOCKED_FROM`, or it is blocked under the recorded motion itself, or
    with nothing fallen; this wins over not known. Not known: something is missing that could change the state. Open:
    the upper end of the interval of the chance is below the chosen risk. Doubtful: all others.
    """

    OPEN = "open"
    DOUBTFUL = "doubtful"
    BLOCKED = "blocked"
    NOT_KNOWN = "not known"

    @property
    def severity(self) -> int:
        """Its place in rising order of urgency: 0 open, 1 doubtful, 2 not known, 3 blocked."""
        return {RouteState.DOUBTFUL: 1, RouteState.NOT_KNOWN: 2, RouteState.BLOCKED: 3}.get(self, 0)

    @property
    def symbol(self) -> str:
        """A sign that shows the state without colour."""
        return ("✓", "≈", "?", "✕")[self.severity]

    @property
    def fill(self) -> str:
        """Colour on the plan: green, amber, grey and dark red, from light to dark so that they differ in grey."""
        return ("#d3efdf", "#f7c95c", "#8a8f94", "#8c1d3f")[self.severity]


BLOCKED_FROM = LIMITS[1]
"""Chance of a blockage from which something counts as blocked [-]: that of the class high."""

MISSING: Mapping[str, str] = {
    "clear_width": "Clear width of a stair (Routes)",
    "stair_pieces": "pieces that name a stair without a Clear width (Items)",
    "stair_floor": "a segment between floors that names a Floor: blank for a stair (Routes)",
    "ends": "From and To of a segment, or its Floor (Routes)",
    "places": "X and Y of places (Places)",
    "positions": "X and Y, or Route, of pieces that may reach it (Items)",
    "furniture": "the furniture of the building (Items)",
    "beyond_stairs": "segments from stairs to an exit (Routes)",
    "unconfirmed_building": "Period T1 or Height (Building)",
    "unconfirmed_motions": "motions of your own that reach the PFA and PFV of the floor",
    "rolls": "a parking place out of the way, or a tether and then Anchored (Items), of pieces that roll",
}
"""What may be missing, by the keys of `MissingRow.what`, and the sheet to fill it in."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissingRow:
    """What is missing and could change a state.

    * `what`: Key of `MISSING`.
    * `names`: Of what: segments, places or pieces; empty for what concerns the building.
    * `cells`: Where it is to be filled in, as Sheet!Cell; empty where that is no cell.
    """

    what: str
    names: tuple[str, ...] = ()
    cells: tuple[str, ...] = ()


def join_missing(rows: Iterable[MissingRow]) -> tuple[MissingRow, ...]:
    """Return rows with those of the same kind as one, each name and cell once."""
    names: dict[str, dict[str, None]] = {}
    cells: dict[str, dict[str, None]] = {}
    for one in rows:
        names.setdefault(one.what, {}).update(dict.fromkeys(one.names))
        cells.setdefault(one.what, {}).update(dict.fromkeys(one.cells))
    return tuple(MissingRow(what=what, names=tuple(own), cells=tuple(cells[what])) for what, own in names.items())


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """The chance of something that fallen pieces cause.

    * `probability`: From the joint outcomes where all the pieces were simulated in the same draws; else the largest of
      `joint`, `independent` and `correlated` [-].
    * `low`, `high`: Joint: the sampling interval of the number of draws. Else: the range of the three values, widened
      by that [-].
    * `joint`: Simulated pieces fall as they did draw by draw, one earthquake for the whole building; all others
      independently [-].
    * `independent`: Every piece falls independently of the others [-].
    * `correlated`: Full correlation: the less likely piece falls only where the more likely one does [-].
    * `runs`: Draws of the joint outcomes; 0 where no piece was simulated.
    * `is_joint`: Whether every piece that takes part was simulated, and all of them in the same number of draws.
    * `pieces`, `unverified`: Pieces that take part, and those of them that enter by their adopted chance alone.
    * `unconfirmed`: Further pieces whose chance is not confirmed: all of them stand, or all of them fall, as the field
      says.
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


def find_state(chance: Chance, risk: float, record: RouteState | None = None) -> RouteState:
    """Return the state by a chance alone: blocked, else open below the risk [-] at its upper end, else doubtful.

    What was blocked under the recorded motion itself is blocked.
    """
    if record == RouteState.BLOCKED or chance.probability >= BLOCKED_FROM:
        return RouteState.BLOCKED
    return RouteState.OPEN if chance.high < risk else RouteState.DOUBTFUL


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceRef:
    """A row of furniture: its name, its row in the workbook, and its index in the items."""

    item: str
    row: int
    item_index: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BesideRow:
    """A piece beside a segment.

    * `item`, `row`, `item_index`: As in `PieceRef`.
    * `by_plan`: Whether what it covers follows from its position on the plan; else from its Edge distance.
    * `distance_m`, `reach_m`, `left_m`: From its nearest face to the edge of the route, 0 or below if inside; how far
      it lies in the route once fallen, measured across the route; the width left with this piece alone fallen [m].
    * `blocks_alone`: Whether `left_m` is under the required width.
    * `falls_while_blocked`: Chance that it falls while the segment is blocked [-]; for an anchored piece, if anchors
      fail. None where its chance is not confirmed.
    * `flags`: Keys of `FLAGS`.
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

    * `route`, `segment`, `floor`, `from_place`, `to_place`, `room`, `clear_width_m`, `required_width_m`, `occupants`,
      `notes`: As the workbook has them; None where it says nothing.
    * `workbook_row`: Its row in the sheet Routes.
    * `evaluated`: Whether it is known which pieces can reach it: by the plan, because a piece names it, because it is a
      stair of known width, or because the pieces of its floor that are left out hardly fall, all of them together.
    * `clear_width_used_m`, `required_width_used_m`: With what was assumed where the workbook says nothing [m].
    * `standing_width_m`, `least_width_m`: Width left with nothing fallen, and with every free-standing piece fallen,
      None if not evaluated [m].
    * `needed_width_m`: Width that its occupants need [m].
    * `length_m`: Between its places [m].
    * `start_x_m`, `start_y_m`, `end_x_m`, `end_y_m`: The ends of its centre line on the plan of its floor [m].
    * `extends_start_m`, `extends_end_m`: How far it goes on beyond them, round a bend [m].
    * `state`: Open, doubtful, blocked or not known.
    * `missing`: What is to be filled in where it is not known; empty where it is.
    * `blocked`, `blocked_or_reduced`: If all anchors hold, and with unconfirmed pieces standing; None if not evaluated.
    * `blocked_if_unconfirmed_fall`: The first with unconfirmed pieces fallen; None where there are none.
    * `blocked_if_anchors_fail`: With anchored pieces taken as free-standing and unconfirmed ones fallen; None where
      none is anchored.
    * `under_record`: Whether it is open or blocked under the recorded motion itself; None where no piece has one.
    * `most_likely_piece`: The free-standing piece most likely to fall while it is blocked.
    * `is_blocked_standing`: Whether it is under the required width with nothing fallen.
    * `insufficient_for_occupants`: Whether it is too narrow for its occupants with nothing fallen.
    * `insufficient_after_falls`: Of being too narrow for its occupants, with unconfirmed pieces standing; None where
      their number is unknown, if not evaluated, or where it depends on unconfirmed pieces whether the chance is at
      least the chosen risk.
    * `pieces`: The pieces that reach it, the one most likely to block it first.
    * `other_rooms`: Pieces that would reach it if they were not in another room than its own.
    * `flags`: Keys of `FLAGS`.
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
    missing: tuple[MissingRow, ...]
    blocked: Chance | None
    blocked_or_reduced: Chance | None
    blocked_if_unconfirmed_fall: Chance | None
    blocked_if_anchors_fail: Chance | None
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
    """One step of what to fix for a route or a room: the piece, its gain, 0 where others must follow, the chance left.

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

    * `route`: Its name.
    * `floors`: Floors of its segments.
    * `from_places`, `to_places`: The places that it serves, and those that it leads to; empty where its segments join
      no places.
    * `segment_indices`: Its segments.
    * `evaluated`: Whether any of them is evaluated.
    * `unevaluated_segments`: Names of those that are not.
    * `state`, `missing`, `blocked`, `blocked_or_reduced`, `blocked_if_unconfirmed_fall`, `blocked_if_anchors_fail`,
      `under_record`: As in `SegmentRow`.
    * `most_likely_piece`: As in `SegmentRow`.
    * `decisive_segment`: Index of the segment that decides its state: of a route that is not known one that is not,
      else the one that is most likely blocked; None where none is.
    * `fixes`: The smallest set found that opens the route, with unconfirmed pieces fallen.
    * `is_fixed`: Whether one exists: not where it is blocked with nothing fallen.
    * `missing_after`: What is to be filled in once all of `fixes` are done, as the route would be not known then; empty
      where it would be known, or where there is nothing to fix.
    * `annual`, `annual_if_anchors_fail`: How often a year it is blocked if all anchors hold, and with anchored pieces
      taken as free-standing; the second is None where there are none, both where no hazard file is given.
    """

    route: str
    floors: tuple[str, ...]
    from_places: tuple[str, ...]
    to_places: tuple[str, ...]
    segment_indices: tuple[int, ...]
    evaluated: bool
    unevaluated_segments: tuple[str, ...]
    state: RouteState
    missing: tuple[MissingRow, ...]
    blocked: Chance | None
    blocked_or_reduced: Chance | None
    blocked_if_unconfirmed_fall: Chance | None
    blocked_if_anchors_fail: Chance | None
    under_record: RouteState | None
    most_likely_piece: PieceRef | None
    decisive_segment: int | None
    fixes: tuple[RouteFixRow, ...]
    is_fixed: bool
    missing_after: tuple[MissingRow, ...] = ()
    annual: AnnualRow | None = None
    annual_if_anchors_fail: AnnualRow | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WayRow:
    """A way out: its segments in order, its end, the chance of a blockage, and the segments shared with the safest.

    `state`, `blocked` and `blocked_if_unconfirmed_fall` are as in `SegmentRow`.
    """

    segment_indices: tuple[int, ...]
    end: str
    state: RouteState
    blocked: Chance
    blocked_if_unconfirmed_fall: Chance | None
    shared: tuple[str, ...] = ()

    @property
    def is_known(self) -> bool:
        """Whether nothing is missing that could change its state."""
        return self.state != RouteState.NOT_KNOWN


@dataclass(frozen=True, slots=True, kw_only=True)
class RoomRow:
    """One room of the network.

    * `room`, `floor`: Its name and its floor.
    * `exits`: The exits that can be reached; where there are none, `by_stairs`, the stairs, beyond which nothing is
      known.
    * `loses_every_exit`: Of losing all of them, if all anchors hold and with unconfirmed pieces standing.
    * `loses_if_unconfirmed_fall`: The same with unconfirmed pieces fallen; None where there are none.
    * `loses_if_anchors_fail`: With anchored pieces taken as free-standing and unconfirmed ones fallen; None where none
      is anchored.
    * `state`: That of the best way from the room to the street: by the chance of losing every exit.
    * `missing`: What is to be filled in where it is not known; empty where it is.
    * `most_likely_piece`: The free-standing piece most likely to fall while the room loses every exit.
    * `decisive_segment`: Index of the segment on its safest way that decides the state, as in `RouteRow`.
    * `fixes`, `is_fixed`: As in `RouteRow`: what opens the best way; fixes are sought where it is doubtful or blocked.
    * `missing_after`: As in `RouteRow`.
    * `unevaluated_segments`: Segments on any of its ways out that are not evaluated.
    * `unevaluated_indices`: The same by their index.
    * `ways`: Ways out, the safest first; further ones share as few segments as possible with those before them.
    * `annual`: How often a year it loses every exit, if all anchors hold; None where no hazard file is given.
    """

    room: str
    floor: str
    exits: tuple[str, ...]
    by_stairs: bool
    loses_every_exit: Chance
    loses_if_unconfirmed_fall: Chance | None
    loses_if_anchors_fail: Chance | None
    state: RouteState
    missing: tuple[MissingRow, ...]
    most_likely_piece: PieceRef | None
    decisive_segment: int | None
    fixes: tuple[RouteFixRow, ...]
    is_fixed: bool
    unevaluated_segments: tuple[str, ...]
    unevaluated_indices: tuple[int, ...]
    ways: tuple[WayRow, ...]
    missing_after: tuple[MissingRow, ...] = ()
    annual: AnnualRow | None = None

    @property
    def is_known(self) -> bool:
        """Whether nothing is missing that could change its state."""
        return self.state != RouteState.NOT_KNOWN


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorRoutesRow:
    """One floor: its segments, its routes (by those segments alone), its rooms, and the expected losses among them.

    Expected losses are of those that are known; `unknown_segments`, `unknown_routes` and `unknown_rooms` count the
    others; rooms that no segment joins to a way out are not among its rooms. `any_room_cut_off` is the chance that at
    least one of its rooms loses every exit; None without rooms, or where something is missing that decides whether it
    is below the chosen risk. `uncounted_pieces` have neither a usable position nor a Route: whether they fall onto a
    segment is not known.
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

    * `risk`: The chosen risk [-]: open is what is below it, and fixes are sought down to it.
    * `blocked_routes_expected`, `cut_off_rooms_expected`: Expected number of routes that are blocked, and of rooms that
      lose every exit, among those that are known.
    * `unknown_routes`, `unknown_rooms`: The others: something is missing that could change their state; unjoined rooms
      count.
    * `draws`: Draws that are made where all combinations of falling pieces are too many.
    * `uncounted_pieces`: Sum over the floors.
    * `unjoined_rooms`: Rooms that no segment joins to an exit or a stair: nothing is known of their way to the street.
    * `furnished_rooms`, `counted_rooms`: Rooms and corridors of the workbook in which furniture is listed, and all of
      them: ways through the others count as free of furniture.
    """

    risk: float
    blocked_routes_expected: float = 0.0
    cut_off_rooms_expected: float = 0.0
    unknown_routes: int = 0
    unknown_rooms: int = 0
    draws: int = 0
    uncounted_pieces: int = 0
    unjoined_rooms: tuple[str, ...] = ()
    furnished_rooms: int = 0
    counted_rooms: int = 0
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
NOT_IN_JSON = frozenset(("item_index", "unevaluated_indices", "workbook_row", "extends_start_m", "extends_end_m"))


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        kept = (field.name for field in fields(value) if field.name not in NOT_IN_JSON)
        return {JSON_NAMES.get(name, name): _plain(getattr(value, name)) for name in kept}
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    return str(value) if isinstance(value, RouteState) else value
