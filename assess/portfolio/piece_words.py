"""How the rows of the tables pieces, routes and problems read, on the page and in the ranking."""

from assess.i18n import gettext as _
from assess.i18n import number
from assess.portfolio.building_signs import BY_ROUTES, Row, Sign, say_sign
from assess.portfolio.city_words import say_number, say_whole
from assess.report import words
from assess.risk import RiskClass
from assess.route_results import RouteState

_CLASSES = {risk.word: risk for risk in RiskClass}


def find_class(word: str | None) -> RiskClass | None:
    """Return the class that a table names."""
    return _CLASSES.get(word or "")


def label_piece(row: Row, basis: str | None) -> tuple[str, str]:
    """Return the class of a piece as sign and words, and its style.

    `basis` is that of its building: where this is simulated, a piece that was not stands outside the classes.
    """
    risk = find_class(row["risk_class"])
    if row["is_held"]:
        said = _("anchored")
        return f"{words.ANCHORED} {said}", "anchored"
    if risk is None:
        return words.DASH, ""
    if row["basis"] == "unconfirmed":
        said = _("unconfirmed ({risk})", risk=words.risk_word(risk))
        return f"{words.UNCONFIRMED} {said}", "apart-unconfirmed"
    if row["basis"] == "formula" and basis != "formula":
        said = _("{risk} by formula only", risk=words.risk_word(risk))
        return f"{words.BY_FORMULA} {said}", "apart-formula"
    upper = find_class(row["risk_class_upper"])
    note = f", {words.could_be(words.risk_word(upper))}" if upper is not None and upper > risk else ""
    return f"{words.risk_label(risk)}{note}", words.class_name(risk)


def say_probability(row: Row) -> str:
    """Return a chance with its interval where it has one: ``12.3 % (10.1 to 15.0 %)``.

    Of an anchored piece it is said that it is the chance if it stood free; a route whose state is not known has none,
    as what is missing is left out of it.
    """
    if row.get("state") == RouteState.NOT_KNOWN:
        return words.DASH
    said = words.say_chance(row["probability"], row["probability_low"], row["probability_high"])
    return _("free-standing: {chance}", chance=said) if row.get("is_held") else said


def say_size(row: Row) -> str:
    """Return breadth, width and height [cm], a dash for what is not known."""
    return " × ".join(words.in_cm(row[name]) for name in ("breadth_cm", "width_cm", "height_cm"))


def say_kind(row: Row) -> str:
    """Return what a piece is: its description, else its type."""
    return str(row["description"] or row["type"] or "")


def find_state(state: str | None) -> Sign:
    """Return the sign of the state of a route."""
    return BY_ROUTES.get((state or "").replace(" ", "-"), BY_ROUTES["not-known"])


def label_state(state: str | None) -> str:
    """Return the state of a route as sign and words."""
    sign = find_state(state)
    return f"{sign.symbol} {say_sign(sign)}"


def say_severity(severity: str) -> str:
    """Return how grave a problem is."""
    return {"error": _("error"), "warning": _("warning"), "note": _("note")}.get(severity, severity)


def say_spot(row: Row) -> str:
    """Return where a problem is: sheet and cell."""
    return " ".join(str(row[name]) for name in ("sheet", "cell") if row[name])


def say_count(value: float | None) -> str:
    """Return a whole number of a row; a dash for what is not known."""
    return words.DASH if value is None else number(value, ",.0f")


def order_pieces(rows: list[Row]) -> list[Row]:
    """Return pieces as the building's work list has them, then the others, the likeliest to fall first."""
    return sorted(rows, key=_order)


def _order(row: Row) -> tuple[float, float, int]:
    place = float("inf") if row["work_place"] is None else row["work_place"]
    return place, -(row["probability"] or 0.0), row["row"] or 0


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
