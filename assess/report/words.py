"""Numbers and sentences as reports show them."""

from assess.results import ItemResult
from assess.risk import RiskClass, classify
from assess.units import ACCELERATION, LENGTH, VELOCITY

LONGEST = 160
"""Characters of a text from the workbook that a table shows; the Excel report and results.json hold all of it."""

DASH = "–"
NO_BREAK = "\N{NO-BREAK SPACE}"


def clip(text: str, longest: int = LONGEST) -> str:
    """Return a text short enough for a table, saying how much was left out."""
    text = " ".join(text.split())
    if len(text) <= longest:
        return text
    return f"{text[:longest].rstrip()}… ({len(text):,} characters; whole in report.xlsx)"


def percent(value: float | None) -> str:
    """Return a probability as a percentage with one decimal."""
    return DASH if value is None else f"{100 * value:.1f} %"


def fixed(value: float | None, decimals: int) -> str:
    """Return a number with decimals, a dash for what is unknown."""
    return DASH if value is None or value != value else f"{value:.{decimals}f}"


def in_g(value: float | None) -> str:
    """Return an acceleration [m/s2] in g."""
    return fixed(None if value is None else value / ACCELERATION["g"], 3)


def in_cm_s(value: float | None) -> str:
    """Return a velocity [m/s] in cm/s."""
    return fixed(None if value is None else value / VELOCITY["cm/s"], 1)


def in_cm(value: float | None) -> str:
    """Return a length [m] in cm, without needless decimals."""
    return DASH if value is None else f"{value / LENGTH['cm']:.4g}"


def in_m(value: float | None) -> str:
    """Return a length [m]."""
    return DASH if value is None else f"{value:.4g}"


def size(one: ItemResult) -> str:
    """Return breadth, width and height [cm]."""
    return " × ".join(in_cm(side) for side in (one.item.breadth, one.item.width, one.item.height))


def plural(count: int, one: str, many: str = "") -> str:
    """Return ``1 piece``, ``2 pieces``."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def chance(one: ItemResult) -> str:
    """Return the adopted chance, with its interval where it is verified: ``3.0 % (1.0 to 8.5 %)``."""
    adopted = one.adopted
    if adopted.low is None or adopted.high is None:
        return percent(adopted.probability)
    interval = f"({100 * adopted.low:.1f} to {percent(adopted.high)})"
    return f"{percent(adopted.probability)} {interval.replace(' ', NO_BREAK)}"


def fell_in_record(one: ItemResult) -> bool:
    """Tell whether it overturns under a recorded motion itself."""
    return any(case.verification is not None and bool(case.verification.record_overturned) for case in one.cases)


def under_record(one: ItemResult) -> str:
    """Return what it does under the recorded motion itself, the worst where there are several."""
    found = [case.verification for case in one.cases if case.verification is not None]
    turned = [verified.record_rotation for verified in found if verified.record_rotation is not None]
    if fell_in_record(one):
        return "overturns"
    if not turned:
        return DASH
    most = max(turned)
    if most == 0:
        return "stays at rest"
    return f"{most:.2f} of critical" if most >= 0.005 else "< 0.01 of critical"


def risk_words(one: ItemResult) -> str:
    """Return the class in words, with what must be said beside it."""
    words = ", ".join([one.adopted.risk.word, *risk_notes(one)])
    return f"depends on its anchor (free-standing: {words})" if one.is_anchored else words


def risk_notes(one: ItemResult) -> list[str]:
    """Return what must be said beside the class: that it may be higher, was lowered, or is not that of the chance."""
    adopted, notes = one.adopted, []
    if classify(adopted.probability) != adopted.risk:
        notes.append("as it overturns under the record itself")
    if adopted.upper != adopted.risk:
        notes.append(f"may be {adopted.upper.word}")
    if adopted.lowered_from is not None:
        notes.append(f"lowered by verification (formula: {adopted.lowered_from.word})")
    return notes


MAY_BE, LOWERED = "?", "↓"
"""Marks beside the symbol of a class where there is no room for words."""
MARKS = f"{MAY_BE}: may be of a higher class; {LOWERED}: lowered by verification"


def class_marks(one: ItemResult) -> str:
    """Return the marks that stand beside the symbol of a class."""
    may_be = MAY_BE if one.adopted.upper != one.adopted.risk else ""
    return may_be + (LOWERED if one.adopted.lowered_from is not None else "")


def class_name(risk: RiskClass) -> str:
    """Return the name of the style of a class."""
    return risk.word.replace(" ", "-")
