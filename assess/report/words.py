"""Numbers and sentences as reports show them."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from assess.i18n import Text, fill, gettext as _, ngettext, number
from assess.model import SCANNED
from assess.report import measures
from assess.results import CANNOT_ROCK, ROLLS, ItemResult
from assess.risk import LIMITS, RiskClass, classify
from assess.workbook.draft_names import is_draft

if TYPE_CHECKING:
    from assess.methods import MethodInfo

LONGEST = 160
"""Characters of a text from the workbook that a table shows; the Excel report and results.json hold all of it."""

MOST_DECIMALS = 6
"""Decimals of a percentage at most, however near a limit it lies."""
DASH = "–"
BASES: Mapping[str, Text] = {
    "simulated": fill("simulated"),
    "formula": fill("formula"),
    "unconfirmed": fill("unconfirmed"),
    CANNOT_ROCK: fill("cannot rock"),
    ROLLS: fill("rolls: not covered"),
}
"""What a chance rests on, by `assess.results.BASES`."""
NO_BREAK = "\N{NO-BREAK SPACE}"
LEAST_RUN = 3
"""Names in a row from which a run is written as the first and the last."""
_NUMBERED = re.compile(r"(.*?)([0-9]{1,9})", re.DOTALL)


def name_ranges(method: "MethodInfo") -> str:
    """Return the heading of the ranges of a method."""
    return _("Checked for") if method.fitted is None else _("Range of the data")


def clip(text: str, longest: int = LONGEST) -> str:
    """Return a text short enough for a table, with its full length where it was cut."""
    text = " ".join(text.split())
    if len(text) <= longest:
        return text
    length = _("{count:,} characters; whole in report.xlsx", count=len(text))
    return f"{text[:longest].rstrip()}… ({length})"


def cut(text: str, longest: int) -> str:
    """Return a text short enough for one line; an ellipsis stands for what was left out.

    The mark of a route that is a draft stays: ``To Stair Level 2… (draft)``.
    """
    text = " ".join(text.split())
    if len(text) <= longest:
        return text
    mark = f" {text[text.rindex('(') :]}" if is_draft(text) else ""
    return f"{text[: max(longest - 1 - len(mark), 1)].rstrip()}…{mark}"


def name_first(names: Sequence[str], most: int, mark: str = ", ") -> str:
    """Return the first names with a mark between them, and how many more there are."""
    named, more = mark.join(names[:most]), len(names) - most
    return _("{names} and {more:,} more", names=named, more=more) if more > 0 else named


def find_runs(names: Sequence[str], longest: int) -> list[list[int]]:
    """Return the places of names, those of three or more whose numbers follow each other as one run.

    A run whose ends are the same once they are cut at `longest` characters is none.
    """
    runs: list[list[int]] = []
    for at, name in enumerate(names):
        before = _NUMBERED.fullmatch(names[runs[-1][-1]]) if runs else None
        if before and name == f"{before[1]}{str(int(before[2]) + 1).zfill(len(before[2]))}":  # A10 after A09
            runs[-1].append(at)
        else:
            runs.append([at])
    found: list[list[int]] = []
    for run in runs:
        is_run = len(run) >= LEAST_RUN and cut(names[run[0]], longest) != cut(names[run[-1]], longest)
        found += [run] if is_run else [[at] for at in run]
    return found


def join_runs(names: Sequence[str], longest: int) -> list[str]:
    """Return names, each cut at `longest` characters, with each run of them as one text, ``25-07 to 25-09``."""
    return [_name_run(names, run, longest) for run in find_runs(names, longest)]


def _name_run(names: Sequence[str], run: Sequence[int], longest: int) -> str:
    first, last = (cut(names[run[end]], longest) for end in (0, -1))
    return _("{first} to {last}", first=first, last=last) if len(run) > 1 else first


def name_pieces(names: Sequence[str], most: int, longest: int = 20) -> str:
    """Return the first names of pieces, runs of them joined, and how many more pieces there are."""
    runs = find_runs(names, longest)
    named, more = ", ".join(_name_run(names, run, longest) for run in runs[:most]), sum(map(len, runs[most:]))
    return _("{names} and {more:,} more", names=named, more=more) if more else named


def fit_pieces(names: Sequence[str], room: int) -> str:
    """Return as many names of pieces as `room` characters hold, one at least, and how many more there are."""
    texts = (name_pieces(names, most, room) for most in range(min(len(names), room // 3 + 1), 1, -1))  # "A, " each
    return next((text for text in texts if len(text) <= room), name_pieces(names, 1, room))


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


def say_span(span: tuple[int, int]) -> str:
    """Return the least and the largest number of something: ``7 to 12``, or the number where they are the same."""
    low, high = (number(one, ",.0f") for one in span)
    return low if low == high else _("{low} to {high}", low=low, high=high)


WHOLE = 10
"""Expected falls from which they are rounded to whole ones in a sentence."""


def round_falls(expected: float) -> str:
    """Return expected falls as a sentence says them: ``12`` or ``3.1``."""
    return number(expected, ",.0f" if expected >= WHOLE else ".1f")


def say_falls(expected: float, low: float | None, high: float | None) -> str:
    """Return the expected falls, and what 5 and 95 % of the draws do not exceed: ``3.1 (1 to 6)``."""
    falls = fixed(expected, 1)
    return falls if low is None or high is None else f"{falls} ({say_span((round(low), round(high)))})"


def list_limits() -> list[tuple[RiskClass, str]]:
    """Return the classes with their limits in words."""
    medium, high, very_high = (f"{number(100 * limit, 'g')} %" for limit in LIMITS)
    texts = (
        _("below {limit}", limit=medium),
        _("{lower} to below {upper}", lower=medium, upper=high),
        _("{lower} to below {upper}", lower=high, upper=very_high),
        _("{limit} and above", limit=very_high),
    )
    return list(zip(RiskClass, texts, strict=True))


def yes_or_no(holds: bool) -> str:
    """Return "yes" or "no"."""
    return _("yes") if holds else _("no")


def deviation(value: float) -> str:
    """Return a share that is no probability as a percentage with one decimal."""
    return f"{number(100 * value, '.1f')} %"


def fixed(value: float | None, decimals: int) -> str:
    """Return a number with decimals, a dash for what is unknown."""
    return DASH if value is None or value != value else number(value, f".{decimals}f")


def in_g(value: float | None) -> str:
    """Return an acceleration [g]."""
    return fixed(value, 3)


def in_cm(value: float | None) -> str:
    """Return a length [cm] in the reader's unit, in or cm, with one decimal at most."""
    return DASH if value is None else measures.show(value, "cm")


def in_m(value: float | None) -> str:
    """Return a length [m] in the reader's unit, ft or m, with two decimals at most."""
    return DASH if value is None else measures.show(value, "m")


def size(one: ItemResult) -> str:
    """Return breadth, width and height in the reader's unit; two of them by name where the width is not known."""
    if one.item.width_cm is None:
        return _("B {breadth}, H {height}", breadth=in_cm(one.item.breadth_cm), height=in_cm(one.item.height_cm))
    return " × ".join(in_cm(side) for side in (one.item.breadth_cm, one.item.width_cm, one.item.height_cm))


_NOUNS: Mapping[str, Callable[[int], str]] = {
    "piece": lambda n: ngettext("{n:,} piece", "{n:,} pieces", n),
    "place": lambda n: ngettext("{n:,} place", "{n:,} places", n),
    "row": lambda n: ngettext("{n:,} row", "{n:,} rows", n),
    "floor": lambda n: ngettext("{n:,} floor", "{n:,} floors", n),
    "motion": lambda n: ngettext("{n:,} motion", "{n:,} motions", n),
    "impact": lambda n: ngettext("{n:,} impact", "{n:,} impacts", n),
}


def plural(count: int, noun: str) -> str:
    """Return ``1 piece``, ``2 pieces``; raises KeyError for a noun of which no plural is known."""
    return _NOUNS[noun](count)


def chance(one: ItemResult) -> str:
    """Return the adopted chance, with its range where it was simulated: ``3.0 % (1.0 to 8.5 %)``."""
    if not one.adopted.can_rock:
        return _("cannot rock")
    return say_chance(one.adopted.probability, *(find_range(one) or ()))


def find_range(one: ItemResult) -> tuple[float, float] | None:
    """Return the range of a simulated chance, as shown [-]; None by formula.

    It is the sampling interval; on assumed motion it is what is not known, see `find_thirds`.
    """
    low, high = one.adopted.low, one.adopted.high
    if one.adopted.has_simulated and (thirds := find_thirds(one)) is not None:
        return thirds
    return None if low is None or high is None else (low, high)


def find_thirds(one: ItemResult) -> tuple[float, float] | None:
    """Return its chances in the slower and the faster third of the draws, the lower first [-]; None with a record.

    They reach to the chance of all draws, which the middle third may take beyond them by the error of drawing.
    """
    found = one.simulation
    if found is None or found.if_slower is None or found.if_faster is None:
        return None
    ends = found.if_slower, found.if_faster, one.adopted.probability
    return min(ends), max(ends)


def find_highest(one: ItemResult) -> RiskClass:
    """Return the highest class that it could be of: by its sampling interval, and by the faster third of the draws."""
    thirds = None if one.apart or not one.adopted.can_rock else find_thirds(one)
    faster = None if thirds is None else classify(thirds[1])
    return one.adopted.upper if faster is None else max(one.adopted.upper, faster)


def say_chance(probability: float | None, low: float | None = None, high: float | None = None) -> str:
    """Return a chance with its interval, ``3.0 % (1.0 to 8.5 %)``, alone if both ends are alike; a dash if unknown."""
    if probability is None or low is None or high is None or in_percent(low) == in_percent(high):
        return percent(probability)
    interval = _("({low} to {high} %)", low=in_percent(low), high=in_percent(high))
    return f"{percent(probability)} {interval.replace(' ', NO_BREAK)}"


def ideal_chance(one: ItemResult) -> str:
    """Return the chance if exactly its governing motion recurred and it were exactly as given, with its interval."""
    ideal = one.governing.simulation and one.governing.simulation.ideal
    return say_chance(ideal.probability, ideal.low, ideal.high) if ideal else DASH


def under_record(one: ItemResult) -> str:
    """Return what it does under the recorded motion itself, the worst where there are several."""
    if one.fell_in_record:
        return _("overturns")
    found = [case.simulation.record_max_rotation_ratio for case in one.cases if case.simulation is not None]
    most = max((ratio for ratio in found if ratio is not None), default=None)
    if not most:
        return DASH if most is None else _("stays at rest")
    return _("< {least:.2f} of critical", least=0.01) if most < 0.005 else _("{ratio:.2f} of critical", ratio=most)


LEAST_SLIP = 1.0
"""Slip [cm] exceeded in 16 % of the draws from which a piece's row states it."""


def list_remarks(one: ItemResult) -> list[str]:
    """Return the remarks next to the class of a piece: a scan, how it slides, its chance at a wall, its bracket."""
    sliding, one_sided = one.governing.sliding, one.governing.one_sided
    texts = [say_scanned(one)]
    if sliding is not None and sliding.slip_median_cm is not None and (sliding.slip_84_cm or 0.0) >= LEAST_SLIP:
        median, high = (measures.say(round(one or 0.0), "cm") for one in (sliding.slip_median_cm, sliding.slip_84_cm))
        texts.append(_("slides up to {median} (median), {high} (84 %)", median=median, high=high))
    if one_sided is not None:
        texts.append(_("with the wall at its back {chance}", chance=percent(one_sided)))
    return list(filter(None, (*texts, say_bracket(one))))


def say_scanned(one: ItemResult) -> str:
    """Return that the sizes of a piece were measured by a scan; "" of all others."""
    return _("sizes measured by scan") if one.item.sizes_from == SCANNED else ""


def say_bracket(one: ItemResult) -> str:
    """Return what follows from a bracket whose capacity is known: whether the piece counts as anchored; "" else.

    For one that holds by the criterion of its piece, PFA or its 84 %, it states where it fails by a stricter one.
    """
    anchored, anchor = one.item.anchored, one.item.anchor
    if anchored not in ("yes", "partly") or anchor.bracket_capacity_kn is None:
        return ""
    holds = anchor.holds if anchored == "yes" else anchor.holds_high
    fails = anchor.holds_high is False, anchor.holds_code is False
    if not one.is_anchored:
        if holds is None:
            return _("width not known, so whether its bracket holds is not known: counts as free-standing")
        return (_("bracket fails at PFA: counts as free-standing") if anchored == "yes"
                else _("bracket fails at 84 % of PFA: counts as free-standing"))  # fmt: skip
    if holds is None:
        text = _("width not known, so whether its bracket holds is not known: counts as anchored")
        further = {
            (True, False): _("bracket fails at 84 % of PFA"),
            (False, True): _("bracket fails by the code"),
            (True, True): _("bracket fails at 84 % of PFA and by the code"),
        }
        return "; ".join((text, further[fails])) if any(fails) else text
    if anchored == "partly":
        return (_("bracket holds at 84 % of PFA, fails by the code: counts as anchored") if fails[1]
                else _("bracket holds at 84 % of PFA: counts as anchored"))  # fmt: skip
    return {
        (False, False): "",
        (True, False): _("bracket holds at PFA, fails at 84 % of PFA: counts as anchored"),
        (False, True): _("bracket holds at PFA, fails by the code: counts as anchored"),
        (True, True): _("bracket holds at PFA, fails at 84 % of PFA and by the code: counts as anchored"),
    }[fails]


def has_doubtful_bracket(one: ItemResult) -> bool:
    """Tell whether a piece counts as anchored by a bracket that fails at 84 % of PFA or by the code."""
    return one.is_anchored and False in (one.item.anchor.holds_high, one.item.anchor.holds_code)


def list_risk_words(one: ItemResult) -> list[str]:
    """Return the class in words, of a piece that stands apart on what it rests, and the notes on it."""
    apart = say_apart(one.adopted.risk, one.apart, has_simulated=one.adopted.has_simulated)
    return [apart or risk_word(one.adopted.risk), *risk_notes(one)]


def risk_words(one: ItemResult) -> str:
    """Return the class with its notes as one text."""
    return join_notes(list_risk_words(one), is_anchored=one.is_anchored)


def join_notes(notes: Sequence[str], *, is_anchored: bool) -> str:
    """Return a class in words and its notes as one text; of an anchored piece it is that of a free-standing one."""
    words = ", ".join(notes)
    return _("depends on its anchor (free-standing: {risk})", risk=words) if is_anchored else words


def say_apart(risk: RiskClass, apart: str, *, has_simulated: bool) -> str:
    """Return a class in words of a piece that stands apart, by what sets it apart; "" where nothing does."""
    if apart == "unconfirmed":
        word = risk_word(risk)
        return _("unconfirmed ({risk})", risk=word) if has_simulated else _("unconfirmed (formula: {risk})", risk=word)
    if apart == ROLLS:
        return _("rolls: not covered (free-standing: {risk})", risk=risk_word(risk))
    return _("{risk} by formula only", risk=risk_word(risk)) if apart else ""


def apart_note(one: ItemResult) -> str:
    """Return what stands next to the sign of a piece that is counted apart."""
    if one.apart == "unconfirmed":
        risk = risk_word(one.adopted.risk)
        return risk if one.adopted.has_simulated else _("formula: {risk}", risk=risk)
    if one.apart == ROLLS:
        return _("free-standing: {risk}", risk=risk_word(one.adopted.risk))
    return _("by formula only")


def risk_notes(one: ItemResult) -> list[str]:
    """Return the notes on a class: that it could be higher, was lowered, or is not that of the chance."""
    adopted, notes = one.adopted, []
    if classify(adopted.probability) != adopted.risk and one.fell_in_record:
        notes.append(_("as it overturns under the record itself"))
    ideal = one.ideal_class if "ideal_higher" in one.adopted.flags else None
    if ideal is not None:
        notes.append(_("{risk} if exactly this motion recurred", risk=risk_word(ideal)))
    highest = find_highest(one)
    if highest != adopted.risk and highest != ideal:
        notes.append(could_be(risk_word(highest)))
    if adopted.lowered_from is not None and not one.apart:
        notes.append(was_lowered(risk_word(adopted.lowered_from)))
    return notes


def could_be(risk: str) -> str:
    """Return the note that a class could be a higher one, `risk`."""
    return _("could be {risk}", risk=risk)


def was_lowered(risk: str) -> str:
    """Return the note that simulation lowered the class of the formula, `risk`."""
    return _("lowered by simulation (formula: {risk})", risk=risk)


UNCONFIRMED, BY_FORMULA, ANCHORED, ROLLING = "◌", "ƒ", "⚓", "◎"
"""Signs in place of the symbol of a class, of what stands outside the classes."""
APART_FILL, ANCHORED_FILL, INK = "#ffffff", "#e3e3e3", "#1c1c1c"
"""Their colours in bars and on plans."""


def class_span(one: ItemResult) -> str:
    """Return the class of a piece, ``◇ medium to high`` where it could be a higher one."""
    highest, label = find_highest(one), class_label(one)
    is_one = one.apart or highest == one.adopted.risk
    return label if is_one else _("{low} to {high}", low=label, high=risk_word(highest))


def class_label(one: ItemResult) -> str:
    """Return the class as symbol and words, ``■ very high``; of what stands apart ``◌ unconfirmed``, ``ƒ high``."""
    if one.apart in ("unconfirmed", ROLLS):
        return apart_label(one.apart)
    return f"{BY_FORMULA} {risk_word(one.adopted.risk)}" if one.apart else risk_label(one.adopted.risk)


def apart_label(name: str) -> str:
    """Return sign and words of what stands outside the classes: "unconfirmed", "formula", "rolls" or "anchored"."""
    return {
        "unconfirmed": f"{UNCONFIRMED} " + _("unconfirmed"),
        "formula": f"{BY_FORMULA} " + _("by formula only"),
        ROLLS: f"{ROLLING} " + _("rolls"),
        "anchored": f"{ANCHORED} " + _("anchored"),
    }[name]


def style_name(one: ItemResult) -> str:
    """Return the name of the style of a piece: that of its class, or of why it stands outside the classes."""
    return "anchored" if one.is_anchored else f"apart-{one.apart}" if one.apart else class_name(one.adopted.risk)


def risk_word(risk: RiskClass) -> str:
    """Return a class in words."""
    return _(risk.word)


def risk_label(risk: RiskClass) -> str:
    """Return a class as symbol and words, ``■ very high``."""
    return f"{risk.symbol} {risk_word(risk)}"


def class_name(risk: RiskClass) -> str:
    """Return the name of the style of a class."""
    return risk.word.replace(" ", "-")
