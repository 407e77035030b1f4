"""The sign of a building on the map and in lists: by the share of its pieces that fall, their worst class, its routes.

The signs are those of the reports: each has a shape of its own, so that it reads without colour.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from assess.i18n import gettext as _
from assess.i18n import number
from assess.portfolio.city import Row
from assess.portfolio.table_schemas import CLASS_COLUMNS, STATE_COLUMNS
from assess.report.say.route import name_state
from assess.report.words import ANCHORED, ANCHORED_FILL, APART_FILL, BY_FORMULA, INK, UNCONFIRMED, class_name, risk_word
from assess.risk import LIMITS, RiskClass, classify
from assess.route_results import RouteState

CIRCLE = "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0-5 0Z"
DIAMOND = "M0-6.5 6.5 0 0 6.5-6.5 0Z"
TRIANGLE = "M0-6.5 6.5 5.2-6.5 5.2Z"
SQUARE = "M-5.4-5.4H5.4V5.4H-5.4Z"
CROSS = "M-5-5 5 5M5-5-5 5"
TICK = "M-5 0-1.5 4 5-5"
_INK = "#3a4045"


@dataclass(frozen=True, slots=True)
class Sign:
    """How a building is marked: `key` in styles and filters, `symbol` in texts, that of the reports.

    `path` is its outline round its centre, as an SVG path [px]; the highest `severity` is drawn last and lies on top.
    One that `is_open` is strokes alone, the outline of one that `is_dashed` stands outside the classes.
    """

    key: str
    symbol: str
    fill: str
    path: str
    severity: int
    is_open: bool = False
    is_dashed: bool = False

    @property
    def ink(self) -> str:
        """Colour of its outline, or of its strokes."""
        return self.fill if self.is_open else INK


_SHAPES = {
    RiskClass.LOW: CIRCLE, RiskClass.MEDIUM: DIAMOND, RiskClass.HIGH: TRIANGLE, RiskClass.VERY_HIGH: SQUARE,
}  # fmt: skip
BY_CLASS: Mapping[str, Sign] = {
    "skipped": Sign("skipped", "×", _INK, CROSS, 0, is_open=True),
    "none": Sign("none", "–", "#ffffff", "M-5-1.5H5V1.5H-5Z", 1),
    "anchored": Sign("anchored", ANCHORED, ANCHORED_FILL, CIRCLE, 2),
    "by-formula": Sign("by-formula", BY_FORMULA, APART_FILL, DIAMOND, 3, is_dashed=True),
    "unconfirmed": Sign("unconfirmed", UNCONFIRMED, APART_FILL, CIRCLE, 4, is_dashed=True),
} | {
    class_name(risk): Sign(class_name(risk), risk.symbol, risk.fill, _SHAPES[risk], 5 + risk) for risk in RiskClass
}  # fmt: skip
"""Signs by the worst class of the pieces, in the order in which they are drawn."""
_BANDS = {risk: f"share-{class_name(risk)}" for risk in RiskClass}
BY_SHARE: Mapping[str, Sign] = {key: BY_CLASS[key] for key in BY_CLASS if key not in map(class_name, RiskClass)} | {
    key: replace(BY_CLASS[class_name(risk)], key=key) for risk, key in _BANDS.items()
}
"""Signs by the share of the pieces that is expected to fall, likewise: its bands have the limits of the classes."""
_ROUTE_SHAPES = {
    RouteState.OPEN: TICK, RouteState.DOUBTFUL: DIAMOND, RouteState.NOT_KNOWN: CIRCLE, RouteState.BLOCKED: SQUARE,
}  # fmt: skip
BY_ROUTES: Mapping[str, Sign] = {
    "skipped": BY_CLASS["skipped"],
    "no-routes": Sign("no-routes", "–", "#ffffff", "M-5-1.5H5V1.5H-5Z", 1),
} | {
    state.replace(" ", "-"): Sign(
        state.replace(" ", "-"), state.symbol, "#2e7d5b" if state is RouteState.OPEN else state.fill,
        _ROUTE_SHAPES[state], 2 + state.severity, is_open=state is RouteState.OPEN,
    )
    for state in sorted(RouteState, key=lambda one: one.severity)
}  # fmt: skip
"""Signs by the worst state of the routes, likewise."""


def find_share(row: Row) -> float | None:
    """Return the share of a building's pieces in the classes that is expected to fall [-]; None where it has none.

    It is rounded to 1e-9: three chances of 0.3 sum up to a hair below 0.9, and belong to the band from 0.3.
    """
    counted = sum(row[column] or 0 for column in CLASS_COLUMNS.values())
    return round(row["expected_falls"] / counted, 9) if counted and row["status"] == "assessed" else None


def sign_of_share(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the share of its pieces that is expected to fall."""
    share = find_share(row)
    risk = None if share is None else classify(share)
    return _sign_without_class(row) if risk is None else BY_SHARE[_BANDS[risk]]


def sign_of_class(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the highest class that any of its pieces has."""
    found = next((risk for risk, column in reversed([*CLASS_COLUMNS.items()]) if row[column]), None)
    return _sign_without_class(row) if found is None else BY_CLASS[class_name(found)]


def _sign_without_class(row: Row) -> Sign:
    """Return the sign of a building of which nothing is in the classes."""
    if row["status"] != "assessed":
        return BY_CLASS["skipped"]
    found = next((column for column in ("unconfirmed", "by_formula", "anchored") if row[column]), "none")
    return BY_CLASS[found.replace("_", "-")]


def sign_of_routes(row: Row) -> Sign:
    """Return the sign of a row of the table buildings by the worst state that any of its routes has."""
    if row["status"] != "assessed":
        return BY_ROUTES["skipped"]
    worst_first = sorted(RouteState, key=lambda one: -one.severity)
    found = next((state for state in worst_first if row[STATE_COLUMNS[state]]), "no-routes")
    return BY_ROUTES[found.replace(" ", "-")]


def say_sign(sign: Sign) -> str:
    """Return what a sign means, in the language in use."""
    for risk in RiskClass:
        if sign.key == class_name(risk):
            return risk_word(risk)
        if sign.key == _BANDS[risk]:  # the band of the share that has the limits of the class
            low, high = (number(100 * limit, "g") for limit in (0.0, *LIMITS, 1.0)[risk : risk + 2])
            if risk == min(RiskClass):
                return _("below {high} % of its pieces expected to fall", high=high)
            if risk == max(RiskClass):
                return _("{low} % or more of its pieces expected to fall", low=low)
            return _("{low} to {high} % of its pieces expected to fall", low=low, high=high)
    for state in RouteState:
        if sign.key == state.replace(" ", "-"):
            return name_state(state)
    return {
        "skipped": _("not assessed"),
        "none": _("no pieces"),
        "no-routes": _("no routes"),
        "anchored": _("all pieces anchored"),
        "by-formula": _("by formula only"),
        "unconfirmed": _("unconfirmed"),
    }[sign.key]
