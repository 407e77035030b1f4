"""The steps that bring each route below the chosen risk, in words."""

from collections.abc import Sequence
from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.report import words
from assess.route_results import RouteTables


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
    if before != after or step.steps == 1:
        return _("route {route}: {before} → {after} (step {place:,} of {steps:,})",
                 route=route, before=before, after=after, place=step.place, steps=step.steps)  # fmt: skip
    return _("route {route}: {before} → {after} (with all {steps:,} steps)",
             route=route, before=before, after=_say_left(step, step.at_last), steps=step.steps)  # fmt: skip


def _say_left(step: RouteStep, chance: float) -> str:
    said = words.percent(chance)
    return _("up to {chance}", chance=said) if step.is_bound and chance > 0 else said


def say_effect(steps: Sequence[RouteStep]) -> str:
    """Return the effect of steps of one route, in their order; of steps with others between, that of all."""
    first, last = steps[0], steps[-1]
    if len(steps) == 1:
        return say_step(first)
    route, before, after = words.cut(first.route, 30), _say_left(first, first.before), _say_left(last, last.after)
    if before != after and last.place - first.place + 1 == len(steps):
        return _("route {route}: {before} → {after} (steps {place:,} to {last:,} of {steps:,})",
                 route=route, before=before, after=after, place=first.place, last=last.place,
                 steps=first.steps)  # fmt: skip
    return _("route {route}: {before} → {after} (with all {steps:,} steps)",
             route=route, before=before, after=_say_left(first, first.at_last), steps=first.steps)  # fmt: skip
