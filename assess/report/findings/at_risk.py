"""The routes at risk and what is to be fixed for them, as the summaries and the list of what to fix say it."""

from dataclasses import dataclass

from assess.language import gettext as _
from assess.language import ngettext
from assess.ranking import RouteStep
from assess.report import words
from assess.report.findings.route_rows import count_uncounted, say_unknown
from assess.report.findings.routes import is_blocked_standing, is_held, name_few, say_chance, say_risk, say_route_state
from assess.results import Assessment, ItemResult
from assess.routes.model import RoomResult, RouteResult, Routes, RouteState


@dataclass(frozen=True, slots=True)
class RouteAtRisk:
    """A route that may be blocked or reduced, the piece that most likely blocks it, and what to fix: "" where none.

    `risk` is the chosen one [-].
    """

    result: RouteResult
    risk: float
    blocker: str
    needed: str

    @property
    def route(self) -> str:
        """Its name."""
        return self.result.route

    @property
    def floors(self) -> str:
        """The floors that it has segments on."""
        return ", ".join(self.result.floors)

    @property
    def state(self) -> str:
        """Its state with its sign, in words."""
        return say_route_state(self.result, self.risk)

    @property
    def chance(self) -> str:
        """The chance that it is blocked, with its interval."""
        return say_chance(self.result.outlook.blocked)


def list_routes_at_risk(assessment: Assessment) -> list[RouteAtRisk]:
    """Return the routes that may be blocked or reduced, or of which that is not excluded, the worst first."""
    routes = assessment.routes
    if routes is None:
        return []
    found = [one for one in routes.routes if _worst(one) > RouteState.OPEN]
    found.sort(key=lambda one: (-one.outlook.state, -one.outlook.blocked.probability, one.route.casefold()))
    return [
        RouteAtRisk(
            one,
            routes.risk,
            _blocker(one, assessment),
            ", ".join(say_row(assessment.result(fix.item)) for fix in one.fixes),
        )
        for one in found
    ]


def _blocker(one: RouteResult, assessment: Assessment) -> str:
    """Return the piece that most likely blocks a route; of one that is blocked as it stands, none does."""
    at = one.outlook.blocker
    return "" if at is None or is_blocked_standing(one) else assessment.inventory.items[at].item


def say_row(one: ItemResult) -> str:
    """Return the name of a row, and how many pieces it is if it is several: ``e5 (5 pieces)``."""
    if one.item.quantity == 1:
        return one.item.item
    return f"{one.item.item} ({words.plural(one.item.quantity, 'piece')})"


def describe_at_risk(one: RouteAtRisk) -> str:
    """Return one of them as a sentence."""
    route = _("{route} (floor {floors})", route=one.route, floors=one.floors) if one.floors else one.route
    if not one.blocker:
        return _("{route}: {state}, blocked in {chance}.", route=route, state=one.state, chance=one.chance)
    return _("{route}: {state}, blocked in {chance}, most likely by {item}.",
             route=route, state=one.state, chance=one.chance, item=one.blocker)  # fmt: skip


def _worst(one: RouteResult) -> RouteState:
    return max(one.outlook.state, one.outlook.upper)


def list_rooms_at_risk(routes: Routes) -> list[RoomResult]:
    """Return the rooms that may lose every exit, or of which that is not excluded, the worst first."""
    found = [one for one in routes.rooms if one.loses.high >= routes.risk]
    return sorted(found, key=lambda one: (-one.loses.probability, -one.loses.high, one.place.place.casefold()))


def say_step(step: RouteStep) -> str:
    """Return for which route a step is, and what it gains: ``route West: 15.5 % → 3.0 % (step 3 of 3)``.

    Pieces that fall together must all be fixed before any of it shows: then it is what all steps gain.
    """
    route, before, after = words.cut(step.route, 30), words.percent(step.before), words.percent(step.after)
    if before != after:
        return _("route {route}: {before} → {after} (step {place:,} of {steps:,})",
                 route=route, before=before, after=after, place=step.place, steps=step.steps)  # fmt: skip
    at_last = words.percent(step.at_last)
    return _("route {route}: {before} → {after} (with all {steps:,} steps)",
             route=route, before=before, after=at_last, steps=step.steps)  # fmt: skip


# ---------------------------------------------------------------- sentences


def say_routes(assessment: Assessment) -> list[str]:
    """Return what a summary says of the routes; nothing where the workbook names none."""
    routes = assessment.routes
    if routes is None:
        return []
    at_risk = list_routes_at_risk(assessment)
    return [
        *_say_at_risk(routes, len(at_risk)),
        *say_unknown(routes),
        _say_expected(routes),
        *_say_rooms(routes),
        *_say_beside(routes),
    ]


def _say_at_risk(routes: Routes, at_risk: int) -> list[str]:
    risk, found = say_risk(routes.risk), [one for one in routes.routes if one.is_evaluated]
    if not found:
        return []
    if not at_risk:
        told = ngettext(
            "The {n:,} route is not at risk: its chance of being blocked or reduced is below the chosen {risk}, also "
            "at the upper end of its interval.",
            "None of the {n:,} routes is at risk: the chance of each of being blocked or reduced is below the chosen "
            "{risk}, also at the upper end of its interval.",
            len(found), risk=risk,
        )  # fmt: skip
        return [told]
    sure = sum(one.outlook.state > RouteState.OPEN for one in found)
    told = _("Routes that may be blocked or reduced: {n:,} of {all:,}, at the chosen risk of {risk}.",
             n=sure, all=len(found), risk=risk)  # fmt: skip
    if sure == at_risk:
        return [told]
    return [told, ngettext("For {n:,} more it is not excluded.", "For {n:,} more it is not excluded.", at_risk - sure)]


def _say_expected(routes: Routes) -> str:
    blocked, rooms = words.fixed(routes.blocked_routes, 2), words.fixed(routes.cut_off_rooms, 2)
    if not routes.rooms:
        return _("To be expected: {count} blocked routes.", count=blocked)
    return _("To be expected: {count} blocked routes, {rooms} rooms that lose every exit.", count=blocked, rooms=rooms)


def _say_rooms(routes: Routes) -> list[str]:
    if not routes.rooms:
        return [_("No room is joined to a way out, so none is evaluated.")]
    found = list_rooms_at_risk(routes)
    if not found:
        return [_("No room comes to that risk of losing every exit.")]
    worst, chance = found[0].place, found[0].loses
    return [_("Rooms that may lose every exit: {n:,} of {all:,}, the worst {room} with {chance}.",
              n=len(found), all=len(routes.rooms), room=words.cut(worst.place, 30),
              chance=say_chance(chance))]  # fmt: skip


def _say_beside(routes: Routes) -> list[str]:
    """Say which routes hang on anchors, how many segments are too narrow as they stand, and what is not counted."""
    texts = []
    held = [one.route for one in routes.routes if is_held(one.outlook, routes.risk)]
    if held:
        texts.append(ngettext("If anchors fail, {n:,} more may be blocked: {names}.",
                              "If anchors fail, {n:,} more may be blocked: {names}.",
                              len(held), names=name_few(held)))  # fmt: skip
    short = sum(one.is_short for one in routes.segments)
    if short:
        texts.append(ngettext("{n:,} segment is too narrow for its occupants as it stands.",
                              "{n:,} segments are too narrow for their occupants as they stand.", short))  # fmt: skip
    if uncounted := count_uncounted(routes):
        texts.append(ngettext("{n:,} piece is not counted: whether it falls onto a route is not known.",
                              "{n:,} pieces are not counted: whether they fall onto a route is not known.",
                              uncounted))  # fmt: skip
    return texts
