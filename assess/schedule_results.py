"""The schedule in the results: what to fix, with what, in which order, and what it changes."""

from dataclasses import dataclass

from assess.details import DETAILS
from assess.risk import RiskClass


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkRow:
    """Alike pieces of one room that are fixed in the same way (`WORK_FIELDS`); `item_indices` are of `item_rows`."""

    floor: str
    room: str
    items: tuple[str, ...]
    item_indices: tuple[int, ...]
    pieces: int
    detail: str
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
    cost_source: str

    @property
    def is_least(self) -> bool:
        """Whether the number of fixings is the least that any piece has, as no capacity of one is printed."""
        return DETAILS[self.detail].capacity is None


@dataclass(frozen=True, slots=True, kw_only=True)
class ScheduleRow:
    """One entry of the schedule: a piece, pieces that are alike, or that only help together (`ENTRY_FIELDS`).

    `item_indices` are its pieces in `Results.item_rows`, the most urgent first. `falls_avoided` is 0 of pieces that
    stand apart.
    """

    place: int
    floor: str
    room: str
    item_indices: tuple[int, ...]
    pieces: int
    is_together: bool
    works: tuple[WorkRow, ...]
    falls_avoided: float
    falls_left: float

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """What to fix, the most urgent first, and what is to be expected before and after."""

    rows: tuple[ScheduleRow, ...]
    before: State
    after: State

    @property
    def cost(self) -> float | None:
        """The sum of the costs that are known; None where none is."""
        known = [work.cost for one in self.rows for work in one.works if work.cost is not None]
        return sum(known) if known else None

    @property
    def uncosted(self) -> int:
        """How many entries have a part whose cost is not known."""
        return sum(one.cost is None for one in self.rows)


_NONE = State(
    falls=0.0, apart=0, classes=(0,) * len(RiskClass), anchored=0, routes=(), blocked_routes=0.0, cut_off_rooms=0.0,
    rooms_at_risk=(),
)  # fmt: skip
NOTHING = Schedule(rows=(), before=_NONE, after=_NONE)
"""The schedule of a building without furniture."""
