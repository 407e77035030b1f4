"""What to fix first: pieces in the order in which they are to be fixed, with what each saves, and steps for routes."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.pipeline.schedule import fix_first
from assess.report import words
from assess.results import ItemResult, Results
from assess.route_results import RouteTables

NAMED = 2
"""Routes that a reason names; the rest are counted."""


@dataclass(frozen=True, slots=True)
class RouteStep:
    """One step of what to fix for a route: step `place` of `steps`, the first of which is 1.

    `item_index` is the index of the piece. The chance [-] that the route is blocked is `before` before this step,
    `after` once this step and those before it are taken, `at_last` once all are; at most, where `is_bound`, as
    unconfirmed pieces count as fallen.
    """

    route: str
    item_index: int
    place: int
    steps: int
    before: float
    after: float
    at_last: float
    is_bound: bool = False


def list_steps(routes: RouteTables) -> list[RouteStep]:
    """Return what to fix for every route, step by step."""
    return [
        RouteStep(
            one.route,
            fix.item_index,
            place,
            len(one.fixes),
            fix.left + fix.gain,
            fix.left,
            one.fixes[-1].left,
            is_bound=one.blocked_if_unconfirmed_fall is not None,
        )
        for one in routes.routes
        for place, fix in enumerate(one.fixes, 1)
    ]


def say_step(step: RouteStep) -> str:
    """Return for which route a step is, and its effect: ``route West: 15.5 % → 3.0 % (step 3 of 3)``.

    Where pieces that fall together must all be fixed before there is any effect, it is that of all steps.
    """
    route, before, after = words.cut(step.route, 30), _say_left(step, step.before), _say_left(step, step.after)
    if before != after:
        return _("route {route}: {before} → {after} (step {place:,} of {steps:,})",
                 route=route, before=before, after=after, place=step.place, steps=step.steps)  # fmt: skip
    return _("route {route}: {before} → {after} (with all {steps:,} steps)",
             route=route, before=before, after=_say_left(step, step.at_last), steps=step.steps)  # fmt: skip


def _say_left(step: RouteStep, chance: float) -> str:
    said = words.percent(chance)
    return _("up to {chance}", chance=said) if step.is_bound and chance > 0 else said


@dataclass(frozen=True, slots=True)
class Fix:
    """One line of what to fix first, with its place in the list.

    `saved` is the expected number of falls of this row, avoided if its anchors hold; `together` the share of all
    expected falls that this line and those above it avoid, None for a piece that stands apart. `steps` are the steps of
    routes that it is.
    """

    place: int
    result: ItemResult
    saved: float
    together: float | None
    steps: Sequence[RouteStep] = ()

    @property
    def reason(self) -> str:
        """Why it comes first, besides its chance: its importance, and its routes with the effect on them."""
        item, named = self.result.item, {one.route for one in self.steps}
        others = [words.cut(route, 30) for route in self.result.routes if route not in named]
        beside = ngettext("route {routes}", "routes {routes}", len(others), routes=words.name_first(others, NAMED))
        parts = [_(item.importance), *map(say_step, self.steps), beside if others and not named else ""]
        return ", ".join(part for part in parts if part) or words.DASH


def list_fixes(results: Results, rows: Sequence[ItemResult], expected: float) -> list[Fix]:
    """Return the pieces of at least medium class and those that a route needs fixed, the most urgent first.

    Pieces that stand apart (`ItemResult.apart`) come after all others, unconfirmed ones first. `expected` is the number
    of free-standing pieces that are expected to fall, but for those.
    """
    steps: dict[int, list[RouteStep]] = {}
    for step in list_steps(results.route_tables):
        steps.setdefault(step.item_index, []).append(step)
    fixes, sum_saved = [], 0.0
    for place, one in enumerate(fix_first(rows, steps), 1):
        saved = one.adopted.probability * one.item.quantity
        sum_saved += 0.0 if one.apart else saved
        together = sum_saved / expected if expected else 0.0
        fixes.append(Fix(place, one, saved, None if one.apart else together, tuple(steps.get(one.item.index, ()))))
    return fixes
