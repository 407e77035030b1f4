"""The worked example: every step that computes is worked again from the numbers that it prints."""

import dataclasses
import itertools
import math
import re

import pytest

import assess
from assess.language import load_catalogue, speaking
from assess.methods import all_methods, static
from assess.methods._fitted_texts import build_method
from assess.methods._method import normal_cdf
from assess.methods.proposed_or import COEFFICIENTS
from assess.report.example.worked import WORKING, choose_example, work_example
from assess.settings import Settings
from tests.methods.test_fitted import SURFACE
from tests.workbooks import RECORDS, UNVERIFIED, assessed

MARKET_STREET = RECORDS.parents[1] / "inventories" / "market-street.xlsx"
UNIT = r"( (cm/s²|cm/s|m/s²|rad/s|rad|Hz|m|\(cm\)))?"
COMPUTES = re.compile(rf"^(?P<sides>.+) = (?P<result>-?\d+(\.\d+)?){UNIT}$")
SYMBOLS = {"²": "**2", "^": "**", "·": "*", "√": "sqrt", "Φ": "phi", "π": "pi", "ln": "log"}
FUNCTIONS = {
    **{name: getattr(math, name) for name in ("sqrt", "log", "sin", "cos", "atan", "exp", "pi")},
    "phi": lambda z: float(normal_cdf(z)),
}


def work(expression):
    """Return the number of an expression as printed."""
    for symbol, python in SYMBOLS.items():
        expression = expression.replace(symbol, python)
    return eval(expression, {"__builtins__": {}}, FUNCTIONS)


def check(step):
    """Work a step again; tell whether it was one that computes."""
    found = COMPUTES.match(step)
    if not found or " = " not in found["sides"]:
        return False
    result, digits = float(found["result"]), len(found["result"].partition(".")[2])
    rounding = 0.5 * 10.0**-digits
    assert work(found["sides"].rsplit(" = ", 1)[1]) == pytest.approx(result, abs=3 * rounding, rel=1e-4), step
    return True


def check_all(worked, case):
    for method in worked:
        assert sum(check(step) for step in method.steps) >= 1, method
        value = case.methods[method.key].value
        meaning = next(one for one in all_methods() if one.key == method.key)
        if meaning.kind == "criterion":
            assert method.result == meaning.words[0 if value else 1]
        else:
            assert f"= {value:.4f}, that is" in method.result


def by_key(one, settings=UNVERIFIED, **named):
    return {method.key: method for method in work_example(one, settings, **named)}


def piece(tmp_path, breadth, height, pfa, pfv=None, **building):
    return piece_found(tmp_path, breadth, height, pfa, pfv, **building).result(0)


def piece_found(tmp_path, breadth, height, pfa, pfv=None, **building):
    floors = [{"floor": "1", "pfa_x": pfa, "pfv_x": pfv}]
    items = [{"item": "A", "floor": "1", "breadth": breadth, "width": breadth, "height": height, "axis": "X"}]
    return assessed(tmp_path / "w.xlsx", items, floors, **building)


def last(method, start):
    """Return the number at the end of the one step that begins so."""
    (step,) = [one for one in method.steps if one.startswith(start) and COMPUTES.match(one)]
    return float(re.sub(COMPUTES, r"\g<result>", step))


SWEEP = list(itertools.product((8, 30, 45, 90, 200), (60, 200), (0.05, 0.3, 0.9, 2.0), (None, 2, 40, 300)))


def test_sweep_of_sizes_and_motions(tmp_path):
    motions = sorted({(pfa, pfv) for _, _, pfa, pfv in SWEEP}, key=str)
    floors = [{"floor": f"F{at}", "pfa_x": pfa, "pfv_x": pfv} for at, (pfa, pfv) in enumerate(motions)]
    items = [
        {"item": f"I{at}", "floor": f"F{motions.index((pfa, pfv))}", "breadth": b, "width": max(b, 60), "height": h,
         "axis": "X"}
        for at, (b, h, pfa, pfv) in enumerate(SWEEP)
    ]  # fmt: skip
    results = list(assessed(tmp_path / "w.xlsx", items, floors))
    assert len(results) == len(SWEEP)
    for one in results:
        worked = work_example(one, UNVERIFIED)
        assert {method.key for method in worked} == {
            key for key, method in one.governing.methods.items() if method.value is not None
        }
        check_all(worked, one.governing)


def test_every_method_can_be_worked():
    assert set(WORKING) == {method.key for method in all_methods()}


def test_a_published_method_without_a_working_is_left_out(tmp_path):
    # by the key alone it would pass for a fitted model; it has no detail "raw"
    further = dataclasses.replace(static.METHOD, key="fitted_by_name", title="Further")
    book = piece_found(tmp_path, 50, 200, 0.4, 40)
    found = assess.run(book.inventory, UNVERIFIED, methods=[further])
    one = found.result(0)
    assert one.governing.methods["fitted_by_name"].value is not None
    worked = [method.key for method in work_example(one, UNVERIFIED, methods=found.methods)]
    assert worked == [method.key for method in work_example(one, UNVERIFIED)]


def test_a_fitted_model_is_worked_whatever_its_key(tmp_path):
    model = dataclasses.replace(build_method(SURFACE, "m.toml"), key="of_my_own")
    book = piece_found(tmp_path, 50, 200, 0.4, 40)
    found = assess.run(book.inventory, UNVERIFIED, methods=[model])
    worked = work_example(found.result(0), UNVERIFIED, methods=found.methods)[-1]
    assert worked.key == "of_my_own"
    assert worked.steps[-1].startswith("R = ")


def test_terms_of_equation_9_add_up(tmp_path):
    # B/H 0.25, PFA 0.4 g = 392.266 cm/s2, by hand from the printed coefficients
    one = piece(tmp_path, 50, 200, 0.4, 40)
    method = by_key(one)["proposed_or"]
    terms = {start: last(method, start) for start in ("b/(B/H)", "c·PFA", "d/(B/H)²", "e·PFA²", "f·PFA/(B/H)")}
    assert terms == {
        "b/(B/H)": 1.2343, "c·PFA": 1.2597, "d/(B/H)²": -0.2974, "e·PFA²": -0.2987, "f·PFA/(B/H)": -0.1593,
    }  # fmt: skip
    raw = last(method, "OR as printed")
    assert sum(terms.values()) + COEFFICIENTS.a == pytest.approx(raw, abs=3e-4)
    assert raw == pytest.approx(one.governing.methods["proposed_or"].detail["raw"], abs=5e-5)
    assert method.result == f"OR = {raw:.4f}, that is {100 * raw:.1f} %: very high"
    assert "it is used as it is" in " ".join(method.steps)


def test_departures_are_shown_with_their_numbers(tmp_path):
    thin, strong = piece(tmp_path, 16, 200, 0.2, 20), piece(tmp_path, 60, 200, 1.5, 20)
    steps = " ".join(by_key(thin)["proposed_or"].steps)
    assert "B/H lies below B/H*" in steps
    assert last(by_key(thin)["proposed_or"], "B/H*") == pytest.approx(0.1288, abs=2e-4)
    assert last(by_key(thin)["proposed_or"], "OR = ") == pytest.approx(thin.adopted.probability, abs=6e-5)
    method = by_key(strong)["proposed_or"]
    assert "PFA lies above PFA*" in " ".join(method.steps)
    assert "In B/H*, PFA counts up to 640 cm/s² only." in method.steps
    assert last(method, "PFA*") == pytest.approx(740.06, abs=0.5)
    assert last(method, "OR as printed") < last(method, "OR = ")


def test_clipping_is_said(tmp_path):
    low, high = piece(tmp_path, 200, 60, 0.05), piece(tmp_path, 28, 200, 0.7)
    assert (
        by_key(low)["proposed_or"].steps[-1] == "A probability lies between 0 and 1; this is below 0: it is set to 0."
    )
    assert by_key(low)["proposed_or"].result == "OR = 0.0000, that is 0.0 %: low"
    assert by_key(high)["proposed_or"].steps[-1].endswith("above 1: it is set to 1.")


def test_kaneko_hayashi_names_its_branch(tmp_path):
    velocity = by_key(piece(tmp_path, 40, 200, 0.4, 20))["kaneko_hayashi"]
    assert "F_f is above F_b: the second line of equation (5) applies, that of the velocity." in velocity.steps
    assert last(velocity, "F_f") > last(velocity, "F_b")
    acceleration = by_key(piece(tmp_path, 40, 200, 0.2, 60))["kaneko_hayashi"]
    assert "F_f is not above F_b: the first line of equation (5) applies, that of the acceleration." in (
        acceleration.steps
    )
    assert last(acceleration, "F_f") <= last(acceleration, "F_b")


def test_upper_bound_where_pfv_is_unknown(tmp_path):
    one = piece(tmp_path, 40, 200, 0.2)
    worked = by_key(one)
    assert "PFV is unknown: the largest risk that any PFV could give is taken." in worked["kaneko_hayashi"].steps
    bounds = [last(worked["kaneko_hayashi"], f"Φ(ln k/ζ_{which})") for which in "AV"]
    assert one.governing.methods["kaneko_hayashi"].value == pytest.approx(max(bounds), abs=5e-5)
    assert "fema_p58" not in worked
    assert "PFV is unknown, but need not be known." in by_key(piece(tmp_path, 40, 60, 0.2))["ishiyama"].steps


def test_an_estimated_velocity_is_said(tmp_path):
    worked = by_key(piece(tmp_path, 40, 200, 0.2, period=1.0))
    for key in ("kaneko_hayashi", "fema_p58"):
        assert any("is an estimate from PFA and the building's period T1" in step for step in worked[key].steps)


def test_settings_and_restitution_are_those_of_the_run(tmp_path):
    settings = Settings(verify="all", runs=20, slide_coefficient=0.5, zeta_acceleration=0.3)
    floors = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 60}]
    items = [{"item": "A", "floor": "1", "breadth": 40, "width": 80, "height": 200, "axis": "X"}]
    found = assessed(tmp_path / "w.xlsx", items, floors, settings=settings, restitution=0.9)
    one = found.result(0)
    worked = by_key(one, settings, restitution=found.inventory.building.restitution)
    check_all(worked.values(), one.governing)
    assert any("= 0.5·Φ(" in step for step in worked["kaneko_hayashi"].steps)
    steps, verified = worked["housner_monte_carlo"].steps, one.governing.verification
    assert "η = 0.9, as set for the building." in steps
    assert f"It overturned under {verified.overturned} of 20 motions." in steps
    assert last(worked["housner_monte_carlo"], "low (Wilson)") == pytest.approx(verified.low, abs=5e-5)
    assert last(worked["housner_monte_carlo"], "high (Wilson)") == pytest.approx(verified.high, abs=5e-5)


def test_numbers_are_written_as_the_language_does(tmp_path):
    one = piece(tmp_path, 50, 200, 0.4, 40)
    with speaking(load_catalogue("it")):
        worked = by_key(one)
    assert "B/H = 50/200 = 0,25000" in worked["proposed_or"].steps
    for method in worked.values():
        for step in method.steps:
            assert not re.search(r"\d\.\d", step), step


def test_words_beside_a_formula_are_translated(tmp_path):
    settings = Settings(verify="all", runs=20)
    one = assessed(tmp_path / "w.xlsx", settings=settings).result(0)
    with speaking(load_catalogue("it")):
        steps = [step for method in by_key(one, settings).values() for step in method.steps]
    assert any(step.startswith("OR come pubblicato (9) = ") for step in steps)
    for step in steps:
        assert not re.search(r"\b(as printed|low|high|above|below|is)\b", step), step


class TestExample:
    def test_is_the_worst_that_is_free_standing(self):
        found = assess.run(assess.read_inventory(MARKET_STREET), UNVERIFIED)
        one = choose_example(found)
        assert not one.is_anchored
        assert one.adopted.upper == max(other.adopted.upper for other in found if not other.is_anchored)
        check_all(work_example(one, UNVERIFIED), one.governing)

    def test_of_nothing_is_none(self):
        assert choose_example([]) is None

    def test_an_anchored_one_comes_last(self, tmp_path):
        found = assessed(tmp_path / "w.xlsx")
        anchored = [one for one in found if one.is_anchored]
        assert choose_example(anchored) is anchored[0]
        assert not choose_example(found).is_anchored
