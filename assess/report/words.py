"""Numbers and sentences as reports show them."""

from collections.abc import Callable, Mapping, Sequence

from assess.language import fill, ngettext, number
from assess.language import gettext as _
from assess.methods import Method
from assess.results import ItemResult
from assess.risk import LIMITS, RiskClass, classify
from assess.units import ACCELERATION, LENGTH, VELOCITY

LONGEST = 160
"""Characters of a text from the workbook that a table shows; the Excel report and results.json hold all of it."""

MOST_DECIMALS = 6
"""Decimals of a percentage at most, however near a limit it lies."""
DASH = "–"
NO_BREAK = "\N{NO-BREAK SPACE}"


def name_ranges(method: Method) -> str:
    """Return what the ranges of a method are, as a heading."""
    return _("Checked for") if method.fitted is None else _("Range of the data")


def clip(text: str, longest: int = LONGEST) -> str:
    """Return a text short enough for a table, saying how much was left out."""
    text = " ".join(text.split())
    if len(text) <= longest:
        return text
    told = _("{count:,} characters; whole in report.xlsx", count=len(text))
    return f"{text[:longest].rstrip()}… ({told})"


def cut(text: str, longest: int) -> str:
    """Return a text short enough for one line; an ellipsis stands for what was left out."""
    text = " ".join(text.split())
    return text if len(text) <= longest else f"{text[: longest - 1].rstrip()}…"


def name_first(names: Sequence[str], most: int) -> str:
    """Return the first names, and how many more there are."""
    named, more = ", ".join(names[:most]), len(names) - most
    return _("{names} and {more:,} more", names=named, more=more) if more > 0 else named


def in_percent(probability: float) -> str:
    """Return a probability in percent with one decimal, or as many as it takes to stay below the limit of a class."""
    for decimals in range(1, MOST_DECIMALS + 1):
        text = f"{100 * probability:.{decimals}f}"
        reached = [limit for limit in LIMITS if probability < limit <= float(text) / 100]
        if not reached:
            return number(float(text), f".{decimals}f")
    return number(100 * reached[0] - 10**-MOST_DECIMALS, f".{MOST_DECIMALS}f")


def percent(value: float | None) -> str:
    """Return a probability as a percentage that stands on the same side of every class limit as the value."""
    return DASH if value is None else f"{in_percent(value)} %"


def percents(values: Sequence[float]) -> str:
    """Return the range of probabilities as percentages, ``34.5 to 48.7 %``."""
    low, high = in_percent(min(values)), in_percent(max(values))
    return _("{range} %", range=low if low == high else _("{low} to {high}", low=low, high=high))


def deviation(value: float) -> str:
    """Return a share that is no probability as a percentage with one decimal."""
    return f"{number(100 * value, '.1f')} %"


def fixed(value: float | None, decimals: int) -> str:
    """Return a number with decimals, a dash for what is unknown."""
    return DASH if value is None or value != value else number(value, f".{decimals}f")


def in_g(value: float | None) -> str:
    """Return an acceleration [m/s2] in g."""
    return fixed(None if value is None else value / ACCELERATION["g"], 3)


def in_cm_s(value: float | None) -> str:
    """Return a velocity [m/s] in cm/s."""
    return fixed(None if value is None else value / VELOCITY["cm/s"], 1)


def in_cm(value: float | None) -> str:
    """Return a length [m] in cm, with one decimal at most."""
    return DASH if value is None else _short(value / LENGTH["cm"], 1)


def in_m(value: float | None) -> str:
    """Return a length [m], with two decimals at most."""
    return DASH if value is None else _short(value, 2)


def _short(value: float, decimals: int) -> str:
    """Return a number with so many decimals at most, without zeros at its end, and never as -0."""
    return number(round(value, decimals) + 0.0, ".12g")


def size(one: ItemResult) -> str:
    """Return breadth, width and height [cm]."""
    return " × ".join(in_cm(side) for side in (one.item.breadth, one.item.width, one.item.height))


_NOUNS: Mapping[str, Callable[[int], str]] = {
    "piece": lambda n: ngettext("{n:,} piece", "{n:,} pieces", n),
    "row": lambda n: ngettext("{n:,} row", "{n:,} rows", n),
    "floor": lambda n: ngettext("{n:,} floor", "{n:,} floors", n),
    "motion": lambda n: ngettext("{n:,} motion", "{n:,} motions", n),
    "impact": lambda n: ngettext("{n:,} impact", "{n:,} impacts", n),
}


def plural(count: int, noun: str) -> str:
    """Return ``1 piece``, ``2 pieces``; raises KeyError for a noun of which no plural is known."""
    return _NOUNS[noun](count)


def chance(one: ItemResult) -> str:
    """Return the adopted chance, with its interval where it is verified: ``3.0 % (1.0 to 8.5 %)``."""
    adopted = one.adopted
    if adopted.low is None or adopted.high is None:
        return percent(adopted.probability)
    interval = _("({low} to {high} %)", low=in_percent(adopted.low), high=in_percent(adopted.high))
    return f"{percent(adopted.probability)} {interval.replace(' ', NO_BREAK)}"


def fell_in_record(one: ItemResult) -> bool:
    """Tell whether it overturns under a recorded motion itself."""
    return any(case.verification is not None and bool(case.verification.record_overturned) for case in one.cases)


def under_record(one: ItemResult) -> str:
    """Return what it does under the recorded motion itself, the worst where there are several."""
    found = [case.verification for case in one.cases if case.verification is not None]
    turned = [verified.record_rotation for verified in found if verified.record_rotation is not None]
    if fell_in_record(one):
        return _("overturns")
    if not turned:
        return DASH
    most = max(turned)
    if most == 0:
        return _("stays at rest")
    if most < 0.005:
        return _("< {least:.2f} of critical", least=0.01)
    return _("{ratio:.2f} of critical", ratio=most)


def risk_words(one: ItemResult) -> str:
    """Return the class in words, with what must be said beside it."""
    words = free_words(one)
    return _("depends on its anchor (free-standing: {risk})", risk=words) if one.is_anchored else words


def free_words(one: ItemResult) -> str:
    """Return the class of a piece as if it were free-standing, with what must be said beside it."""
    return ", ".join([risk_word(one.adopted.risk), *risk_notes(one)])


def risk_notes(one: ItemResult) -> list[str]:
    """Return what must be said beside the class: that it may be higher, was lowered, or is not that of the chance."""
    adopted, notes = one.adopted, []
    if classify(adopted.probability) != adopted.risk:
        notes.append(_("as it overturns under the record itself"))
    if adopted.upper != adopted.risk:
        notes.append(_("may be {risk}", risk=risk_word(adopted.upper)))
    if adopted.lowered_from is not None:
        notes.append(_("lowered by verification (formula: {risk})", risk=risk_word(adopted.lowered_from)))
    return notes


MAY_BE, LOWERED = "?", "↓"
"""Marks beside the symbol of a class where there is no room for words."""
MARKS = fill("{may_be}: may be of a higher class; {lowered}: lowered by verification", may_be=MAY_BE, lowered=LOWERED)


def marks() -> str:
    """Say what the marks mean."""
    return _(MARKS)


def class_marks(one: ItemResult) -> str:
    """Return the marks that stand beside the symbol of a class."""
    may_be = MAY_BE if one.adopted.upper != one.adopted.risk else ""
    return may_be + (LOWERED if one.adopted.lowered_from is not None else "")


def risk_word(risk: RiskClass) -> str:
    """Return a class in words."""
    return _(risk.word)


def risk_label(risk: RiskClass) -> str:
    """Return a class as symbol and words, ``■ very high``."""
    return f"{risk.symbol} {risk_word(risk)}"


def class_name(risk: RiskClass) -> str:
    """Return the name of the style of a class."""
    return risk.word.replace(" ", "-")
