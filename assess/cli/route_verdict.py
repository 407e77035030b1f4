"""The verdict of `assess routes`: up to which PFA all routes stay below the limit, which first does not, and why."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from assess.cli.console import count
from assess.pipeline.route_sweep import Fragility, RouteFragility
from assess.report import words
from assess.route_results import Chance

MOST_ROUTES, MOST_PIECES = 3, 4
"""Routes, and pieces of a route, that the text names; the data names all of them."""
LONGEST = 40
"""Characters of a name."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a sweep comes to, at the values of PFA that were evaluated.

    Parameters
    ----------
    limit : float
        The chosen risk, below which a route counts as open [-].
    lowest_g, highest_g : float
        The smallest and the largest value [g].
    evaluated : tuple of RouteFragility
        The routes that can be judged: all their segments are evaluated, or those that are reach the limit.
    not_evaluated : tuple of RouteFragility
        The others.
    below_up_to_g : float, optional
        The last value up to which the chances of all routes are below the limit [g]; None where it is none.
    reached_at_g : float, optional
        The next one, the first at which a chance is not [g]; None where all stay below.
    first : tuple of RouteFragility
        The routes whose chance is not below the limit there, the largest chance first.
    reaching : int
        Routes whose chance is not below the limit at any value.
    anchored_at_g : float, optional
        The first value at which a chance is not below the limit if anchors fail [g], where that is smaller than
        `reached_at_g`; else None.
    anchored : tuple of RouteFragility
        The routes of which that is so.
    unplaced : int
        Pieces that are left out, as the workbook does not place them.
    """

    limit: float
    lowest_g: float
    highest_g: float
    evaluated: tuple[RouteFragility, ...]
    not_evaluated: tuple[RouteFragility, ...]
    below_up_to_g: float | None
    reached_at_g: float | None
    first: tuple[RouteFragility, ...]
    reaching: int
    anchored_at_g: float | None
    anchored: tuple[RouteFragility, ...]
    unplaced: int

    @property
    def lower_bounds(self) -> tuple[str, ...]:
        """The routes whose chances are lower bounds: motions may be too weak, or a segment is not evaluated."""
        return tuple(one.route for one in self.evaluated if one.doubtful or one.unevaluated)

    def describe(self) -> dict[str, Any]:
        """Return it as data, with its text."""
        return {
            "text": self.say(),
            "limit": self.limit,
            "evaluated_routes": len(self.evaluated),
            "not_evaluated": [one.route for one in self.not_evaluated],
            "not_evaluated_segments": [
                {"route": one.route, "segments": list(one.unevaluated)}
                for one in (*self.not_evaluated, *self.evaluated)
                if one.unevaluated
            ],
            "below_up_to_g": self.below_up_to_g,
            "reached_at_g": self.reached_at_g,
            "first": [
                {"route": one.route, "pieces": [{"item": piece.item, "row": piece.row} for piece in one.causes]}
                for one in self.first
            ],
            "routes_reaching": self.reaching,
            "reached_at_g_if_anchors_fail": self.anchored_at_g or self.reached_at_g,
            "first_if_anchors_fail": [one.route for one in self.anchored],
            "lower_bounds": list(self.lower_bounds),
            "pieces_left_out": self.unplaced,
        }

    def say(self) -> str:
        """Return it in a sentence or two, with what decides how far it can be relied on."""
        return " ".join(self._sentences())

    def _sentences(self) -> Iterator[str]:
        if not self.evaluated:
            if not any(one.is_evaluated for one in self.not_evaluated):
                yield "No route can be evaluated: the workbook places no furniture next to any."
                return
            yield "No route can be evaluated as a whole."
        else:
            yield from self._say_reached()
        if self.anchored_at_g is not None:
            named, reach = _name([one.route for one in self.anchored], MOST_ROUTES), _reaches(len(self.anchored))
            yield f"If the anchors fail, {named} {reach} {100 * self.limit:g} % from {self.anchored_at_g:.4g} g."
        if self.lower_bounds:
            yield f"The chances of {_name(self.lower_bounds, MOST_ROUTES)} are lower bounds."
        if self.not_evaluated:
            yield f"Not evaluated: {words.name_first([_name_part(one) for one in self.not_evaluated], MOST_ROUTES)}."
        if parts := [_name_part(one) for one in self.evaluated if one.unevaluated]:
            yield f"Counted without what is not evaluated: {words.name_first(parts, MOST_ROUTES)}."
        if self.unplaced:
            yield f"Left out: {count(self.unplaced, 'piece')} without a usable position or route."

    def _say_reached(self) -> Iterator[str]:
        level, number = f"{100 * self.limit:g} %", len(self.evaluated)
        whole = count(number, "evaluated route" if self.not_evaluated else "route")
        if self.below_up_to_g is not None:
            every = f"All {whole} stay" if number > 1 else f"The only {whole.removeprefix('1 ')} stays"
            every = every.replace("All 2", "Both") if number == 2 else every
            last = "" if self.reached_at_g else ", the largest PFA evaluated"
            yield f"{every} below {level} up to {self.below_up_to_g:.4g} g{last}."
        if self.reached_at_g is None:
            return
        later = self.reaching > len(self.first)
        more = f"; up to {self.highest_g:.4g} g, {self.reaching} of {whole} do" if later else ""
        where = f"From {self.reached_at_g:.4g} g"
        if self.below_up_to_g is None:
            where = f"Already at {self.lowest_g:.4g} g, the smallest PFA evaluated,"
        named = [f"{_quote(one.route)} ({_blame(one)})" for one in self.first]
        yield f"{where} {words.name_first(named, MOST_ROUTES)} {_reaches(len(self.first))} {level}{more}."


def find_verdict(fragility: Fragility, pfa_g: Sequence[float]) -> Verdict:
    """Return what the chances at the values of PFA [g] come to."""
    evaluated = tuple(one for one in fragility.routes if _is_judged(one, fragility.limit))
    ways = [(one, _find_first(one.blocked, fragility.limit)) for one in evaluated]
    anchored = [(one, _find_first(one.if_anchors_fail, fragility.limit)) for one in evaluated if one.if_anchors_fail]
    at = min((at for _, at in ways if at is not None), default=None)
    early = min((at for _, at in anchored if at is not None), default=None)
    is_early = early is not None and (at is None or early < at)
    below = len(pfa_g) - 1 if at is None else at - 1
    first = [] if at is None else [one for one, own in ways if own == at]
    return Verdict(
        limit=fragility.limit,
        lowest_g=pfa_g[0],
        highest_g=pfa_g[-1],
        evaluated=evaluated,
        not_evaluated=tuple(one for one in fragility.routes if not _is_judged(one, fragility.limit)),
        below_up_to_g=pfa_g[below] if below >= 0 and evaluated else None,
        reached_at_g=None if at is None else pfa_g[at],
        first=tuple(sorted(first, key=lambda one: -one.blocked[at or 0].probability)),
        reaching=sum(own is not None for _, own in ways),
        anchored_at_g=pfa_g[early] if early is not None and is_early else None,
        anchored=tuple(one for one, own in anchored if is_early and own == early),
        unplaced=fragility.unplaced,
    )


def _is_judged(route: RouteFragility, limit: float) -> bool:
    """Tell whether a verdict can rely on a route: below the limit only with all segments evaluated."""
    is_reached = _find_first(route.blocked, limit) is not None
    return route.is_evaluated and (is_reached or not route.unevaluated)


def _find_first(chances: Sequence[Chance], limit: float) -> int | None:
    """Return the number of the first chance that is not below the limit."""
    return next((at for at, one in enumerate(chances) if one.probability >= limit), None)


def _blame(route: RouteFragility) -> str:
    """Return the pieces that cause it; fixing none would help a route that is blocked with nothing fallen."""
    if not route.causes:
        return "blocked with nothing fallen"
    return f"because of {_name([one.item for one in route.causes], MOST_PIECES)}"


def _quote(name: str) -> str:
    return repr(words.cut(name, LONGEST))


def _name_part(route: RouteFragility) -> str:
    """Return a route with its segments that are not evaluated, unless none is."""
    if not route.is_evaluated:
        return _quote(route.route)
    segments = f"segment{'' if len(route.unevaluated) == 1 else 's'} {_name(route.unevaluated, MOST_PIECES)}"
    return f"{_quote(route.route)} ({segments})"


def _name(names: Sequence[str], most: int) -> str:
    return words.name_first([_quote(name) for name in names], most)


def _reaches(number: int) -> str:
    return "reaches" if number == 1 else "reach"
