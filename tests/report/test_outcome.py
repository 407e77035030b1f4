"""The outcome of a building in one sentence."""

from types import SimpleNamespace

import pytest

from assess.report.counts import Counts
from assess.report.say.outcome import say_outcome
from assess.risk import RiskClass
from assess.route_results import RouteState, RouteTables


def _count(free, expected, unconfirmed=0, ends=(None, None)):
    by_class = dict.fromkeys(RiskClass, 0) | {RiskClass.LOW: free}
    low, high = ends
    return Counts("", by_class, 0, unconfirmed, expected=expected, falls_low=low, falls_high=high)


def _routes(**counts):
    found = tuple(SimpleNamespace(state=RouteState[name]) for name, n in counts.items() for _ in range(n))
    return RouteTables(risk=0.05, routes=found)


@pytest.mark.parametrize(
    ("total", "routes", "said"),
    [
        (
            _count(177, 10.14, ends=(7.2, 13.9)), _routes(BLOCKED=3, DOUBTFUL=3, OPEN=14),
            "About 10 of 177 free-standing pieces fall (7 to 14); 3 of 20 ways out are likely blocked.",
        ),
        (
            _count(12, 3.14), _routes(DOUBTFUL=1, NOT_KNOWN=1),
            "About 3.1 of 12 free-standing pieces fall; 1 of 2 ways out is doubtful.",
        ),
        (
            _count(5, 0.01, 2), _routes(OPEN=2, NOT_KNOWN=1),
            "None of 5 free-standing pieces is expected to fall; "
            "2 unconfirmed pieces could fall; 1 of 3 ways out is not known.",
        ),
        (_count(0, 0.0, 31), _routes(), "31 unconfirmed pieces could fall."),
        (_count(0, 0.0), _routes(BLOCKED=1), "The only way out is likely blocked."),
        (_count(0, 0.0), _routes(OPEN=2), "All 2 ways out are open."),
        (_count(0, 0.0), _routes(), ""),
    ],
)  # fmt: skip
def test_the_outcome_is_one_sentence(total, routes, said):
    assert say_outcome(total, routes) == said


def test_the_sentence_names_the_earthquake():
    said = say_outcome(_count(12, 3.14), _routes(BLOCKED=1, OPEN=1), "Loma Prieta")
    assert said == (
        "In an earthquake like this one (Loma Prieta), about 3.1 of 12 free-standing pieces fall; "
        "1 of 2 ways out is likely blocked."
    )
