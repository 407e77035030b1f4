"""The four states, by the chance of a blockage: the same rules for segments, for routes and for the rooms' ways out."""

from dataclasses import dataclass

from assess.route_results import BLOCKED_FROM, Chance, RouteState


@dataclass(frozen=True, slots=True)
class Bounds:
    """Chances of a blockage: unconfirmed pieces stand or fall, and what is missing leaves it open or blocks it."""

    best: Chance
    if_missing: Chance
    if_fallen: Chance
    worst: Chance


@dataclass(frozen=True, slots=True)
class Verdict:
    """A state; where it is not known, whether unconfirmed pieces and what is missing could change it."""

    state: RouteState
    by_unconfirmed: bool = False
    by_missing: bool = False


def find_state(chance: Chance, risk: float, record: RouteState | None = None) -> RouteState:
    """Return the state by a chance alone: blocked, else open below the risk [-] at its upper end, else doubtful.

    What was blocked under the recorded motion itself is blocked.
    """
    if record == RouteState.BLOCKED or chance.probability >= BLOCKED_FROM:
        return RouteState.BLOCKED
    return RouteState.OPEN if chance.high < risk else RouteState.DOUBTFUL


def settle(bounds: Bounds, risk: float, record: RouteState | None = None) -> Verdict:
    """Return the state: not known where it could be another, unless it is blocked at best."""
    best, missing, fallen, worst = (
        find_state(one, risk, record) for one in (bounds.best, bounds.if_missing, bounds.if_fallen, bounds.worst)
    )
    if best in (worst, RouteState.BLOCKED):
        return Verdict(best)
    return Verdict(
        RouteState.NOT_KNOWN,
        by_unconfirmed=fallen != best or missing == best,
        by_missing=missing != best or fallen == best,
    )
