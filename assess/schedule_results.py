"""The schedule in the results: what to fix, with what, in which order, and what it changes."""

from dataclasses import dataclass

from assess.details import DETAILS
from assess.risk import RiskClass


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkRow:
    """Alike pieces of one room that are fixed in the same way: an entry of the schedule is one of these, or several.

    * `floor`, `room`: Where they stand.
    * `items`, `item_indices`: Their names, and their places in `Results.item_rows`, the most urgent first.
    * `pieces`: How many they are, quantities counted.
    * `detail`: How they may be fixed: key of `assess.details.DETAILS`.
    * `tension_kn`, `tension_high_kn`: What the fixings of each piece have to carry together at PFA and at its 84 %: at
      the bracket, or, where it is fixed at its base, at the far edge of the base, on the lever of its breadth [kN].
    * `tension_code_kn`: The same by the code; None where neither SDS nor Ground PGA is known [kN].
    * `shear_kn`: Horizontal force at the base of each piece at PFA [kN].
    * `fixings`: Of one piece, by the larger of the tensions at 84 % and by the code over the printed capacity of one
      fixing.
    * `weights_assumed`, `heights_assumed`: Pieces whose weight, and whose bracket height, is assumed.
    * `is_per_metre`: Whether forces and fixings are those of one metre of a piece, as its width is not known.
    * `unit_cost`, `cost`: Of one piece and of all, as the sheet Costs has it; None where it does not.
    * `cost_source`: Where that comes from, as the workbook says.
    """

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
    """One entry of the schedule: a piece, pieces that are alike, or pieces that only help together.

    * `place`: Its place in the order of urgency, from 1.
    * `floor`, `room`: Where it is to be done: of its most urgent piece.
    * `item_indices`: Its pieces, as places in `Results.item_rows`, the most urgent first.
    * `pieces`: How many they are, quantities counted.
    * `is_together`: Whether they only help together: fixing some of them opens no route.
    * `works`: What is to be done: alike pieces of a room are one.
    * `falls_avoided`: Expected number of falls that it avoids; 0 of pieces that stand apart.
    * `falls_left`: Expected number of falls that are left once it and those before it are fixed.
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
    """What is to be expected of the building: before anything of the schedule is done, or after all of it.

    * `falls`: Expected number of free-standing pieces that fall, of the run's basis.
    * `falls_low`, `falls_high`: What 5 and 95 % of the draws do not exceed; None where nothing was simulated.
    * `apart`: Free-standing pieces that stand apart: unconfirmed, or by formula only where others were simulated.
    * `classes`: Free-standing pieces of the run's basis by class, from low to very high.
    * `anchored`: Pieces that count as anchored.
    * `routes` (mapping as tuple of (str, int)): Routes by their state.
    * `blocked_routes`, `cut_off_rooms`: Expected number of routes that are blocked, and of rooms that lose every exit,
      among those that are known.
    * `unknown_routes`, `unknown_rooms`: Those that these two leave out, as they are not known.
    * `rooms_at_risk`: Rooms whose best way to the street is not open, or that no segment joins to one.
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
