"""The schedule in the results: what to fix, with what, in which order, and what it changes."""

from dataclasses import dataclass

from assess.details import DETAILS
from assess.risk import RiskClass


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkRow:
    """Alike pieces of one room that are fixed in the same way (`WORK_FIELDS`); `item_indices` are of `item_rows`.

    `like` is the detail whose fixings, forces and capacity it has, where that is another: of an anchor that is to be
    completed or checked the one that its type would have. `hours` are those of work on all pieces, assumed.
    """

    floor: str
    room: str
    items: tuple[str, ...]
    item_indices: tuple[int, ...]
    pieces: int
    detail: str
    like: str
    tension_kn: float
    tension_high_kn: float
    tension_code_kn: float | None
    shear_kn: float
    fixings: int
    weights_assumed: int
    heights_assumed: int
    is_per_metre: bool
    unit_cost: float | None
    cost: float | None
    cost_per: str
    cost_source: str
    hours: float

    @property
    def is_least(self) -> bool:
        """Whether the number of fixings is the least that any piece has, as no capacity of one is printed."""
        return bool(self.fixings) and DETAILS[self.like].capacity is None

    @property
    def all_fixings(self) -> int:
        """The fixings of all its pieces."""
        return self.fixings * self.pieces

    @property
    def pull_kn(self) -> float | None:
        """What one fixing carries [kN], by the larger of the tensions at 84 % and by the code; None without fixings."""
        if not self.fixings:
            return None
        return max(self.tension_high_kn, self.tension_code_kn or 0.0) / self.fixings


@dataclass(frozen=True, slots=True, kw_only=True)
class ScheduleRow:
    """One entry of the schedule: a piece, pieces that are alike, or that only help together (`ENTRY_FIELDS`).

    `phase` is one of `PHASES`. `item_indices` are its pieces in `Results.item_rows`, the most urgent first.
    `falls_avoided` is 0 of pieces that stand apart; `falls_at_most` is what fixing these avoids at most, or of anchored
    ones what their anchors are trusted to avoid, else 0.
    """

    place: int
    phase: str
    floor: str
    room: str
    item_indices: tuple[int, ...]
    pieces: int
    is_together: bool
    works: tuple[WorkRow, ...]
    falls_avoided: float
    falls_left: float
    falls_at_most: float

    @property
    def hours(self) -> float:
        """Hours of work, assumed."""
        return sum(one.hours for one in self.works)

    @property
    def cost(self) -> float | None:
        """What it costs; None where that of any part is not known."""
        known = [one.cost for one in self.works if one.cost is not None]
        return sum(known) if len(known) == len(self.works) else None


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """What is to be expected of the building, before or after the schedule (`STATE_FIELDS`).

    `classes` are pieces from low to very high, `routes` counts by state, `rooms_at_risk` those whose best way to the
    street is not open, or that no segment joins to one.
    """

    falls: float
    apart: int
    classes: tuple[int, ...]
    anchored: int
    routes: tuple[tuple[str, int], ...]
    blocked_routes: float
    cut_off_rooms: float
    rooms_at_risk: tuple[str, ...]
    unknown_routes: int = 0
    unknown_rooms: int = 0
    falls_low: float | None = None
    falls_high: float | None = None

    def count(self, risk: RiskClass) -> int:
        """Return how many pieces are of a class."""
        return self.classes[risk]


PHASES = ("A", "B", "C")
"""Of the schedule: now; with the next works; not worth it on its own, which is listed only."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PhaseRow:
    """The entries of one phase of the schedule, and the building once they and those before are done (`PHASE_FIELDS`).

    `places` are rooms, `uncosted` entries a part of which has no known cost; `after` of phase C is that of phase B, as
    C is listed only.
    """

    phase: str
    entries: int
    pieces: int
    places: int
    falls_avoided: float
    falls_left: float
    cost: float | None
    uncosted: int
    hours: float
    after: State


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """What to fix, the most urgent first, and what is to be expected before and after phases A and B.

    `checks` are of pieces that are anchored, or that roll: to look at, or to park; `phases` are those of `rows`;
    `currency` is an ISO code, "" where the workbook names none.
    """

    rows: tuple[ScheduleRow, ...]
    before: State
    after: State
    checks: tuple[ScheduleRow, ...] = ()
    phases: tuple[PhaseRow, ...] = ()
    currency: str = ""

    @property
    def planned(self) -> tuple[ScheduleRow, ...]:
        """The entries of phases A and B, with which `after` reckons; those of C are listed only."""
        return tuple(one for one in self.rows if one.phase != PHASES[-1])

    @property
    def cost(self) -> float | None:
        """The sum of the costs of phases A and B that are known; None where none is."""
        known = [work.cost for one in self.planned for work in one.works if work.cost is not None]
        return sum(known) if known else None

    @property
    def uncosted(self) -> int:
        """How many entries of phases A and B have a part whose cost is not known."""
        return sum(one.cost is None for one in self.planned)


_NONE = State(
    falls=0.0, apart=0, classes=(0,) * len(RiskClass), anchored=0, routes=(), blocked_routes=0.0, cut_off_rooms=0.0,
    rooms_at_risk=(),
)  # fmt: skip
NOTHING = Schedule(rows=(), before=_NONE, after=_NONE)
"""The schedule of a building without furniture."""
