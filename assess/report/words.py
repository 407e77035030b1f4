"""Numbers and sentences as reports show them."""

from assess.results import ItemResult
from assess.risk import RiskClass
from assess.units import ACCELERATION, LENGTH, VELOCITY

LONGEST = 160
"""Characters of a text from the workbook that a table shows; the Excel report and results.json hold all of it."""

DASH = "–"


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


def risk_words(one: ItemResult) -> str:
    """Return the class in words, with what must be said beside it."""
    adopted = one.adopted
    words = adopted.risk.word
    if adopted.upper != adopted.risk:
        words += f", may be {adopted.upper.word}"
    if adopted.lowered_from is not None:
        words += f", lowered by verification (formula: {adopted.lowered_from.word})"
    if one.is_anchored:
        words = f"depends on its anchor (free-standing: {words})"
    return words


def class_name(risk: RiskClass) -> str:
    """Return the name of the style of a class."""
    return risk.word.replace(" ", "-")
