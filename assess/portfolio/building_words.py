"""What one building's row says of falls, people and routes: what is not known stands beside each number."""

from assess.i18n import gettext as _
from assess.portfolio.city_words import say_number, say_whole
from assess.report import words


def say_falls(
    expected: float | None, unconfirmed: int | None, by_formula: int | None, left_out: int | None = None
) -> str:
    """Return expected falls, with the pieces that could fall as well and are not in them."""
    apart = [
        *([_("{pieces} unconfirmed", pieces=say_whole(unconfirmed))] if unconfirmed else []),
        *([_("{pieces} by formula only", pieces=say_whole(by_formula))] if by_formula else []),
        *([_("{pieces} left out of the COBie file", pieces=say_whole(left_out))] if left_out else []),
    ]
    if not apart:
        return say_number(expected)
    return _("{falls} and up to {apart}", falls=say_number(expected), apart=", ".join(apart))


def say_people(expected: float | None, occupants: int | None, not_known: int | None) -> str:
    """Return the expected people on blocked routes of those on routes that are known; the others beside them.

    A dash where no people are filled in.
    """
    if not occupants:
        return words.DASH
    missing = not_known or 0
    if missing >= occupants:
        return _("not known: {people} on routes not known", people=say_whole(missing))
    said = _("{people} of {occupants}", people=say_number(expected), occupants=say_whole(occupants - missing))
    return said + (_("; {people} on routes not known", people=say_whole(missing)) if missing else "")


def say_blocked(routes: int | None, blocked: int | None, not_known: int | None) -> str:
    """Return how many routes are blocked, those not known beside them; a dash where there are no routes."""
    if not routes:
        return words.DASH
    missing = not_known or 0
    if missing >= routes:
        return _("not known")
    return say_whole(blocked) + (_("; {routes} not known", routes=say_whole(missing)) if missing else "")


def mark_own_motions(text: str, floors: int | None) -> str:
    """Return a text with the mark of a building of which floors keep motions that may not be of this earthquake."""
    return _("{text} (floors with motions of their own)", text=text) if floors else text


def name_skipped(building: str | None, path: str) -> str:
    """Return the name of a building that was skipped, with its file where this differs; else its file alone."""
    return path if not building or building == path else f"{building} ({path})"
