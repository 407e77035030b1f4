"""The schedule in the results: what to fix, with what, in which order, and what it changes."""

from dataclasses import dataclass

from assess.risk import RiskClass


@dataclass(frozen=True, slots=True, kw_only=True)
class ScheduleRow:
    """One entry of the schedule: a piece, pieces that are alike, or pieces that only help together.

    Parameters
    ----------
    place : int
        Its place in the order of urgency, from 1.
    floor, room : str
        Where it is to be done: of its most urgent piece.
    item_indices : tuple of int
        Its pieces, as places in `Results.item_rows`, the most urgent first.
    pieces : int
        How many they are, quantities counted.
    is_together : bool
        Whether they only help together: fixing some of them opens no route.
    detail : str
        How it may be fixed: key of `assess.details.DETAILS`.
    tension_kn : float
        What each piece's fixings have to carry together: the largest of the pieces, and of the demands of the scenario
        at 84 % of PFA and of the code where that is known [kN].
    fixings : int
        Of one piece, at the printed capacity of one where there is one.
    unit_cost, cost : float, optional
        Of one piece and of all, as the sheet Costs has it; None where it does not.
    cost_source : str
        Where that comes from, as the workbook says.
    falls_avoided : float
        Expected number of falls that it avoids; 0 of pieces that stand apart.
    falls_left : float
        Expected number of falls that are left once it and those before it are fixed.
    """

    place: int
    floor: str
    room: str
    item_indices: tuple[int, ...]
    pieces: int
    is_together: bool
    detail: str
    tension_kn: float
    fixings: int
    unit_cost: float | None
    cost: float | None
    cost_source: str
    falls_avoided: float
    falls_left: float


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """What is to be expected of the building: before anything of the schedule is done, or after all of it.

    Parameters
    ----------
    falls : float
        Expected number of free-standing pieces that fall, of the run's basis.
    apart : int
        Free-standing pieces that stand apart: unconfirmed, or by formula only where others were simulated.
    classes : tuple of int
        Free-standing pieces of the run's basis by class, from low to very high.
    anchored : int
        Pieces that count as anchored.
    routes : mapping as tuple of (str, int)
        Routes by their state.
    blocked_routes, cut_off_rooms : float
        Expected number of routes that are blocked, and of rooms that lose every exit.
    rooms_at_risk : tuple of str
        Rooms whose best way to the street is not open.
    """

    falls: float
    apart: int
    classes: tuple[int, ...]
    anchored: int
    routes: tuple[tuple[str, int], ...]
    blocked_routes: float
    cut_off_rooms: float
    rooms_at_risk: tuple[str, ...]

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
        known = [one.cost for one in self.rows if one.cost is not None]
        return sum(known) if known else None


_NONE = State(
    falls=0.0, apart=0, classes=(0,) * len(RiskClass), anchored=0, routes=(), blocked_routes=0.0, cut_off_rooms=0.0,
    rooms_at_risk=(),
)  # fmt: skip
NOTHING = Schedule(rows=(), before=_NONE, after=_NONE)
"""The schedule of a building without furniture."""
