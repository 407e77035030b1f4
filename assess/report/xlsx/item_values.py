"""What a row of the sheet Items holds: chance, class and notes as run, and the number by which pieces stand in order.

The formulas of `item_formulas` compute the same from the cells.
"""

from assess.i18n import gettext as _
from assess.report import words
from assess.report.xlsx.item_formulas import ANCHORED, CLASS_WEIGHT
from assess.results import CaseRow, ItemResult, MethodResult, Results
from assess.risk import RiskClass, classify
from assess.workbook.formulas import OUTSIDE, say_class
from assess.workbook.schema import BUILDING


def is_as_run(one: ItemResult) -> bool:
    """Tell whether its class holds for the inputs as run alone: it rests on what a simulation found.

    So does, in a run that simulated others, one that cannot rock; else that follows its inputs as the formula does.
    """
    return (one.main_basis if not one.adopted.can_rock else one.adopted.basis) != "formula"


def say_inputs_that_settle(one: ItemResult) -> str:
    """Return what is to be filled in or changed so that the class of an unconfirmed piece rests on simulation."""
    building = {name: _(BUILDING.column(name).label) for name in ("storeys", "period")}
    texts = {
        "unknown_building": _("fill in {storeys} or {period} in {sheet}", sheet=_(BUILDING.name), **building),
        "weak_motions": _("use stronger motions"),
    }
    return ", ".join(text for flag, text in texts.items() if flag in one.adopted.flags)


def say_unsettled(one: ItemResult) -> str:
    """Return how to settle the class of an unconfirmed piece; "" of any other."""
    return _("to settle it, {how}", how=say_inputs_that_settle(one)) if one.adopted.is_unconfirmed else ""


def list_simulated(one: ItemResult, *, is_ideal: bool) -> tuple[float | None, ...]:
    """Return the adopted chance of a simulated piece, its range, and the chance to compare it with.

    That is the chance if exactly this motion recurred; with `is_ideal`, where this one is adopted, the chance in an
    earthquake like it.
    """
    adopted, found = one.adopted, one.governing.simulation
    if not adopted.is_simulated or found is None:
        return (None,) * 4
    exact = None if found.ideal is None else found.ideal.probability
    beside = found.probability if is_ideal else exact
    return adopted.probability, *(words.find_range(one) or (None, None)), beside


def listed_chance(one: ItemResult) -> float | None:
    """Return the chance by which it stands in the list of its basis."""
    return one.adopted.probability if is_as_run(one) else one.formula.value


def chance_behind(one: ItemResult, *, is_ideal: bool) -> float | None:
    """Return the chance by which it is classed, whatever the limits: None where nothing was simulated.

    It is the largest under any of its motions. Where simulation may not lower a class, a larger chance of the formula
    counts, so that other limits do not lower it either; where nothing is known of the building, that of the faster
    third of the draws.
    """

    def chance(case: CaseRow) -> float:
        formula, found, adopted = case.methods[one.formula_key].value or 0.0, case.simulation, case.adopted
        if adopted.is_unconfirmed and adopted.has_simulated:
            return max(adopted.probability, (found and found.if_faster) or 0.0)
        if found is None or adopted.is_simulated:  # the adopted one may be that of a fall along either axis
            return max(formula, adopted.probability) if adopted.is_doubtful else adopted.probability
        return max(formula, found.ideal.probability if is_ideal and found.ideal else found.probability)

    if not one.adopted.can_rock:
        return 0.0 if is_as_run(one) else None
    return max(map(chance, one.cases)) if is_as_run(one) else None


def upper_end(one: ItemResult, *, is_ideal: bool) -> float | None:
    """Return the chance behind the upper class: the highest upper end of its ranges, or a higher ideal chance."""
    if not one.adopted.can_rock:
        return None
    ends = [case.adopted.high for case in one.cases if case.adopted.high is not None]
    ends += [thirds[1]] if not one.apart and (thirds := words.find_thirds(one)) else []
    for found in (case.simulation for case in one.cases if case.simulation):
        exact = found.ideal
        ends += [found.high] if exact is None else [exact.high] if is_ideal else [found.high, exact.probability]
    return max(ends, default=None)


def under_record(one: ItemResult) -> str:
    """Return its response to the recorded motion itself, the worst of several; "" where no record is known."""
    ratios = {
        case.motion.axis: (found.record_overturned, found.record_max_rotation_ratio or 0.0)
        for case in one.cases
        if (found := case.simulation) is not None and found.record_overturned is not None
    }
    if not ratios:
        return ""
    worst, text = max(ratios, key=lambda axis: ratios[axis]), words.under_record(one)
    return text if worst == one.governing.motion.axis else _("{what} (along {axis})", what=text, axis=worst)


def _mark(one: ItemResult) -> str:
    return ANCHORED if one.is_anchored else ""


def class_by_formula(one: ItemResult) -> str:
    """Return its class by the formula, marked where the formula was not checked."""
    return _mark(one) + say_class(one.formula_class) + _outside(one, one.formula)


def class_by_paper(one: ItemResult) -> str:
    """Return its class by the paper's formula under the governing motion, marked where that was not checked."""
    return _mark(one) + say_class(one.paper_class) + _outside(one, one.governing.methods[one.paper_key])


def _outside(one: ItemResult, found: MethodResult) -> str:
    return OUTSIDE * (one.adopted.can_rock and "extrapolated" in found.flags)


def class_in_force(one: ItemResult) -> str:
    """Return the class that counts, as the sheet shows it."""
    is_adopted = is_as_run(one) or not one.adopted.can_rock
    return _mark(one) + say_class(one.adopted.risk) if is_adopted else class_by_formula(one)


def upper_class(one: ItemResult) -> str:
    """Return the class by the upper end of the range; "" where nothing was simulated."""
    return _mark(one) + say_class(words.find_highest(one)) if is_as_run(one) else ""


def class_notes(one: ItemResult) -> str:
    """Return what is to be said of the class."""
    adopted, highest = one.adopted, words.find_highest(one)
    texts = [
        say_unsettled(one),
        words.could_be(say_class(highest)) if highest > adopted.risk else "",
        "" if adopted.lowered_from is None else words.was_lowered(say_class(adopted.lowered_from)),
        _("as it overturns under the record itself") if is_as_run(one) and one.fell_in_record else "",
        say_bracket_held(one),
    ]
    return ", ".join(filter(None, texts))


def say_bracket_held(one: ItemResult) -> str:
    """Return what is to be known of the bracket by which a piece counts as anchored; "" of any other."""
    return words.say_bracket(one) if one.is_anchored and is_as_run(one) else ""


def say_listed_class(one: ItemResult) -> str:
    """Return the class with its notes, as the lists of the summary have it."""
    return ", ".join(filter(None, (class_in_force(one), class_notes(one))))


def list_bases(results: Results) -> list[str]:
    """Return what the classes of a run rest on: `assess.results.BASES` that there are, the simulated first."""
    there = {one.apart or one.main_basis for one in results}
    return [basis for basis in ("simulated", "formula", "unconfirmed") if basis in there]


def order_number(one: ItemResult, row: int) -> float | None:
    """Return the number by which pieces stand in order, as the formula of its row has it; None for anchored ones."""
    chance = listed_chance(one)
    if one.is_anchored or chance is None or not one.adopted.can_rock:
        return None
    upper = words.find_highest(one) if is_as_run(one) else classify(chance)
    return CLASS_WEIGHT * int(upper or RiskClass.LOW) + chance - (row + 1) * 1e-9
