"""Worked examples: every step that computes is worked again from the numbers that it prints."""

import itertools
import math
import re
from collections.abc import Mapping

import numpy as np
import pytest

from assess.i18n import gettext, load_catalogue, speaking
from assess.methods import Cases, Example, Method, all_methods, simulation
from assess.methods.expression import normal_cdf
from assess.methods.simulate import interval_width
from assess.risk import wilson_interval
from assess.settings import Settings
from assess.units import GRAVITY
from tests.methods.ensembles import MadeUp

UNIT = r"( (cm/s²|cm/s|m/s²|rad/s|rad|Hz|m|\(cm\)))?"
COMPUTES = re.compile(rf"^(?P<sides>.+) = (?P<result>-?\d+(\.\d+)?){UNIT}$")
SYMBOLS = {"²": "**2", "^": "**", "·": "*", "√": "sqrt", "Φ": "phi", "ln": "log"}
FUNCTIONS = {
    **{name: getattr(math, name) for name in ("sqrt", "log", "sin", "cos", "atan", "exp")},
    "phi": lambda z: float(normal_cdf(z)), "min": min, "max": max,
}  # fmt: skip
SETTINGS = Settings(runs=20)


def work(expression: str) -> float:
    """Return the number of an expression as printed."""
    for symbol, python in SYMBOLS.items():
        expression = expression.replace(symbol, python)
    return float(eval(expression, {"__builtins__": {}}, dict(FUNCTIONS)))


def check(step: str) -> bool:
    """Work a step again; return whether it was one that computes."""
    found = COMPUTES.match(step)
    if not found or " = " not in found["sides"]:
        return False
    result, digits = float(found["result"]), len(found["result"].partition(".")[2])
    expected = pytest.approx(result, abs=3 * 0.5 * 10.0**-digits, rel=1e-4)
    assert work(found["sides"].rsplit(" = ", 1)[1]) == expected, step
    return True


def examples(settings: Settings = SETTINGS, **sizes: object) -> list[tuple[Method, Example]]:
    """Return what every method found of each case [cm, g, cm/s] that it evaluated."""
    b, h, pfa, pfv = np.broadcast_arrays(*(np.asarray(sizes[name], float) for name in ("B", "H", "PFA", "PFV")))
    cases = Cases.of(
        breadth=b / 100, height=h / 100, pfa=pfa * GRAVITY, pfv=pfv / 100, restitution=sizes.get("eta", math.nan),
        ensemble=0, ensembles=[MadeUp(0, has_record=not sizes.get("assumed"), is_assumed=bool(sizes.get("assumed")))],
    )  # fmt: skip
    found = []
    for method in all_methods():
        outcome = method.evaluate(cases, settings)
        for at in np.flatnonzero(~np.isnan(outcome.value)):
            detail = {name: values[at].item() for name, values in outcome.detail.items()}
            flags = [flag for flag, raised in outcome.flags.items() if raised[at]]
            found.append((method, Example(
                breadth=float(b.flat[at]), height=float(h.flat[at]), pfa=float(pfa.flat[at] * GRAVITY * 100),
                pfv=float(pfv.flat[at]), restitution=float(cases.restitution[at]), settings=settings,
                value=float(outcome.value[at]), detail=detail, flags=flags,
            )))  # fmt: skip
    return found


def steps_of(settings: Settings = SETTINGS, **sizes: object) -> Mapping[str, list[str]]:
    """Return the steps of one case by method."""
    return {m.key: [gettext(step) for step in m.steps(one)] for m, one in examples(settings, **sizes) if m.steps}


def last(steps: list[str], start: str) -> float:
    """Return the result of the one step that begins so and computes."""
    (step,) = [one for one in steps if one.startswith(start) and COMPUTES.match(one)]
    return float(re.sub(COMPUTES, r"\g<result>", step))


@pytest.mark.slow
def test_every_step_of_a_sweep_can_be_worked_again() -> None:
    sweep = itertools.product((8, 30, 45, 90, 200), (60, 200), (0.05, 0.3, 0.9, 2.0), (math.nan, 2, 40, 300))
    b, h, pfa, pfv = np.array(list(sweep)).T
    worked = set()
    for method, one in examples(B=b, H=h, PFA=pfa, PFV=pfv):
        assert method.steps is not None
        steps = [gettext(step) for step in method.steps(one)]
        assert sum(map(check, steps)) >= 1, steps
        results = [float(found["result"]) for step in steps if (found := COMPUTES.match(step))]
        if method.kind == "probability" and "clipped" not in one.flags:
            assert any(abs(result - one.value) < 6e-5 for result in results), (method.key, one, steps)
        worked.add(method.key)
    assert worked == {method.key for method in all_methods()}


def test_terms_of_equation_9_add_up() -> None:
    # B/H 0.25, PFA 0.4 g = 392.266 cm/s2, by hand from the printed coefficients
    steps = steps_of(B=50, H=200, PFA=0.4, PFV=40)["proposed_or"]
    terms = [last(steps, f"{start} =") for start in ("b/(B/H)", "c·PFA", "d/(B/H)²", "e·PFA²", "f·PFA/(B/H)")]
    assert terms == [1.2343, 1.2597, -0.2974, -0.2987, -0.1593]
    assert "a = -0.97758451" in steps
    assert last(steps, "OR_9") == pytest.approx(sum(terms) - 0.97758451, abs=3e-4)


def test_departures_are_shown_with_their_numbers() -> None:
    thin = steps_of(B=16, H=200, PFA=0.2, PFV=20)["proposed_or"]
    assert any(step.startswith("B/H lies below B/H*") for step in thin)
    assert last(thin, "B/H*") == pytest.approx(0.1288, abs=2e-4)
    strong = steps_of(B=60, H=200, PFA=1.5, PFV=20)["proposed_or"]
    assert any(step.startswith("PFA lies above PFA*") for step in strong)
    assert last(strong, "PFA*") == pytest.approx(740.06, abs=0.5)
    assert last(strong, "OR_9") < last(strong, "OR = ")
    assert steps_of(B=200, H=60, PFA=0.05, PFV=5)["proposed_or"][-1].endswith("the result is below 0 and is set to 0.")
    assert steps_of(B=28, H=200, PFA=0.7, PFV=5)["proposed_or"][-1].endswith("the result is above 1 and is set to 1.")


def test_kaneko_hayashi_names_its_branch() -> None:
    velocity = steps_of(B=40, H=200, PFA=0.4, PFV=20)["kaneko_hayashi"]
    assert "F_f is above F_b: the second line of equation (5) applies, that of the velocity." in velocity
    assert last(velocity, "F_f") > last(velocity, "F_b")
    acceleration = steps_of(B=40, H=200, PFA=0.2, PFV=60)["kaneko_hayashi"]
    assert "F_f is not above F_b: the first line of equation (5) applies, that of the acceleration." in acceleration
    bound = steps_of(B=40, H=200, PFA=0.2, PFV=math.nan)
    assert "PFV is unknown: the largest risk that any PFV could give is taken." in bound["kaneko_hayashi"]
    assert "PFV is unknown, but need not be known." in steps_of(B=40, H=60, PFA=0.2, PFV=math.nan)["ishiyama"]
    assert "fema_p58" not in bound


def test_settings_and_restitution_are_those_of_the_run() -> None:
    settings = Settings(runs=20, slide_coefficient=0.5, zeta_acceleration=0.3)
    steps = steps_of(settings, B=40, H=200, PFA=0.3, PFV=60, eta=0.9)
    assert any("= 0.5·Φ(" in step for step in steps["kaneko_hayashi"])
    simulated = steps[simulation().key]
    assert "η = 0.9, as set for the building." in simulated
    (counted,) = [step for step in simulated if step.startswith("It overturned in")]
    count = int(counted.split()[3])
    low, high = wilson_interval(count, 20, interval_width(settings))
    assert last(simulated, "R_low") == pytest.approx(float(low), abs=6e-5)
    assert last(simulated, "R_high") == pytest.approx(float(high), abs=6e-5)
    assert simulated[-1].startswith("Under the recorded motion itself it ")


def test_of_drawn_motions_nothing_is_said_of_one_that_recurs() -> None:
    ideal = "If exactly this motion recurred"
    drawn, recorded = (steps_of(B=40, H=200, PFA=0.3, PFV=60, assumed=one)[simulation().key] for one in (True, False))
    assert any(step.startswith(ideal) for step in recorded)
    assert not any(step.startswith(ideal) for step in drawn)
    assert len(drawn) < len(recorded)


def test_without_a_record_nothing_is_said_of_one() -> None:
    method, one = next(pair for pair in examples(B=40, H=200, PFA=0.3, PFV=60) if pair[0].role == "simulation")
    assert method.steps is not None
    for unknown in (math.nan, None):
        detail = {**one.detail, "record_overturned": unknown}
        steps = method.steps(Example(**{name: getattr(one, name) for name in one.__slots__} | {"detail": detail}))
        assert not any("recorded motion" in step for step in steps)


def test_numbers_are_written_as_the_language_does() -> None:
    sized = examples(B=50, H=200, PFA=0.4, PFV=40)
    with speaking(load_catalogue("it")):
        steps = [gettext(step) for method, one in sized if method.steps for step in method.steps(one)]
    assert "B/H = 50/200 = 0,25000" in steps
    for step in steps:
        assert not re.search(r"\d\.\d", step), step
        assert not re.search(r"\b(low|high|above|below|is)\b", step), step
