"""What a report says of the verification: how much was verified, what it changed, what is still open."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from assess.methods._method import Reference
from assess.methods.housner_monte_carlo import LOOKS
from assess.report import words
from assess.results import Assessment, ItemResult
from assess.risk import RiskClass
from assess.settings import AUTO

NAMED = 12
"""Pieces that a sentence names; the rest are counted."""
SCENARIO = "Chance of overturning in this scenario, not per year."
INTERVAL = "the interval covers the number of records only"
WILSON = Reference(
    authors="Wilson EB",
    year="1927",
    title="Probable inference, the law of succession, and statistical inference",
    source="Journal of the American Statistical Association 22(158):209-212",
    doi="10.1080/01621459.1927.10502953",
)
"""The interval of a verified chance."""


@dataclass(frozen=True, slots=True)
class Verified:
    """The rows of a report by what verification did to them.

    `done` were verified, `lowered` and `raised` have another class than the formula's, of `kept` a lower class was
    found but not adopted, of `may_be` the interval reaches into a higher class, `undecided` have an open class after
    the last look of "auto", `fell` overturn under a recorded motion itself.
    """

    rows: int
    motions: str
    left: Sequence[ItemResult]
    done: Sequence[ItemResult]
    lowered: Sequence[ItemResult]
    raised: Sequence[ItemResult]
    kept: Sequence[ItemResult]
    may_be: Sequence[ItemResult]
    undecided: Sequence[ItemResult]
    fell: Sequence[ItemResult]

    @property
    def is_all(self) -> bool:
        """Whether every row was verified."""
        return bool(self.done) and not self.left

    @property
    def status(self) -> tuple[str, str]:
        """The state of the report in one or two words, and what it means."""
        if not self.done:
            return (
                "Not verified",
                "classes are those of a published formula; no direct integration has been run",
            )
        extent = f"{len(self.done):,} of {words.plural(self.rows, 'row')} by direct integration, {self.motions}"
        if self.kept:
            extent += f"; of {words.plural(len(self.kept), 'row')} the formula's higher class is kept"
        if self.is_all:
            return "Verified", extent
        return "Partly verified", f"{extent}; the classes of the other rows are those of a published formula"

    @property
    def footer(self) -> str:
        """What stands at the foot of every page."""
        if not self.done:
            return f"{SCENARIO} Not verified."
        return f"{SCENARIO} Verified: {len(self.done):,} of {words.plural(self.rows, 'row')}; {INTERVAL}."

    @property
    def interval(self) -> str:
        """What the interval covers, and which pieces have none."""
        if not self.done:
            return f"{INTERVAL}, and there is none yet: nothing has been verified by direct integration in this run"
        covers = f"{INTERVAL}, not the formula, the motion of the floor or the earthquake"
        if self.is_all and not self.kept:
            return covers
        kept = ", or verification gave a lower class, which is not adopted" if self.kept else ""
        return f"{covers}. A chance without an interval is the formula's: it is not verified{kept}"

    @property
    def adopted(self) -> str:
        """Which method the chances of the report are those of."""
        formula = "the proposed OR formula"
        if not self.done:
            return f"The adopted risk is that of {formula}; the others stand beside it for comparison."
        text = "The adopted risk is that of Housner Monte Carlo (direct integration) where a piece was verified"
        text += "" if self.is_all else f", and that of {formula} where it was not"
        kept = f" Where verification gave a lower class that may not be adopted, it is that of {formula} (not lowered)."
        return f"{text}; the others stand beside it for comparison.{kept if self.kept else ''}"


def build_verified(assessment: Assessment, results: Sequence[ItemResult]) -> Verified:
    """Sort the rows by what verification did to them."""

    def of(test: Callable[[ItemResult], bool]) -> tuple[ItemResult, ...]:
        return tuple(one for one in done if test(one))

    done = tuple(one for one in results if one.is_verified)
    return Verified(
        rows=len(results),
        motions=_motions(assessment),
        left=tuple(one for one in results if not one.is_verified),
        done=done,
        lowered=of(lambda one: one.adopted.lowered_from is not None),
        raised=of(lambda one: one.adopted.risk > one.formula_class),
        kept=of(lambda one: "not_lowered" in one.adopted.flags),
        may_be=of(lambda one: one.adopted.upper > one.adopted.risk),
        undecided=of(lambda one: "undecided" in one.adopted.flags),
        fell=of(words.fell_in_record),
    )


def _motions(assessment: Assessment) -> str:
    if assessment.suite is not None:
        return f"{words.plural(len(assessment.suite), 'motion')} of the user's own"
    return f"{count_motions(assessment)} on each floor and axis"


def count_motions(assessment: Assessment) -> str:
    """Return how many motions each piece was integrated under."""
    runs = assessment.settings.runs
    return f"{LOOKS[0]:,} to {LOOKS[-1]:,} motions" if runs == AUTO else words.plural(int(runs), "motion")


def describe_verification(assessment: Assessment) -> str:
    """Say in one or two sentences how much has been verified, and what that changed."""
    verified = build_verified(assessment, tuple(assessment))
    if not verified.done:
        return "Not verified."
    extent = f"{len(verified.done):,} of {words.plural(verified.rows, 'row')}, {count_motions(assessment)} each"
    changes = [
        (verified.lowered, "{} lowered by it", "class", "classes"),
        (verified.raised, "{} raised by it", "class", "classes"),
        (verified.may_be, "{} of a higher class", "row may be", "rows may be"),
        (verified.kept, "{} the formula's class, which verification may not lower", "row keeps", "rows keep"),
        (verified.fell, "{} under the record itself", "row overturns", "rows overturn"),
        (verified.undecided, "{} undecided", "row still", "rows still"),
    ]
    told = [text.format(words.plural(len(found), *nouns)) for found, text, *nouns in changes if found]
    return "; ".join([f"Verified by direct integration: {extent}", *told]) + "."


def list_summary(verified: Verified) -> list[str]:
    """Say for the summary what verification changed, and what is open."""
    if not verified.done:
        return []
    lines = [
        ("Class lowered by verification", verified.lowered,
         _by_class(verified.lowered, "from", lambda one: one.adopted.lowered_from or RiskClass.LOW)),
        ("Class raised by verification", verified.raised,
         _by_class(verified.raised, "to", lambda one: one.adopted.risk)),
        ("Class of the formula kept although verification gave a lower one (see the comparison of the methods), as "
         "the motions follow a generic spectrum or are weaker than the floor's, or its PFV is an estimate",
         verified.kept, ""),
        ("May be of a higher class, as the interval reaches into it", verified.may_be, ""),
        (f"Undecided, as the interval still reaches over more than one class after {LOOKS[-1]:,} motions",
         verified.undecided, name_some(verified.undecided)),
        ("Overturn under the recorded motion itself, and so are at least high", verified.fell,
         name_some(verified.fell)),
        ("Not verified, chance and class are the formula's", verified.left, ""),
    ]  # fmt: skip
    return [
        f"{label}: {count_pieces(results)}{': ' if told else ''}{told}." for label, results, told in lines if results
    ]


def _by_class(results: Sequence[ItemResult], preposition: str, risk_of: Callable[[ItemResult], RiskClass]) -> str:
    """Return how many pieces were lowered from, or raised to, each class."""
    by_class = [(risk, _pieces(one for one in results if risk_of(one) == risk)) for risk in reversed(RiskClass)]
    return ", ".join(f"{count:,} {preposition} {risk.word}" for risk, count in by_class if count)


def _pieces(results: Iterable[ItemResult]) -> int:
    return sum(one.item.quantity for one in results)


def count_pieces(results: Sequence[ItemResult]) -> str:
    """Return ``5 pieces in 3 rows``, with those that are anchored, which stand outside the classes."""
    anchored = _pieces(one for one in results if one.is_anchored)
    text = f"{words.plural(_pieces(results), 'piece')} in {words.plural(len(results), 'row')}"
    return f"{text} ({anchored:,} of them anchored)" if anchored else text


def name_some(results: Sequence[ItemResult]) -> str:
    """Return the names of the first rows, and how many more there are."""
    names = ", ".join(words.clip(one.item.item, 40) for one in results[:NAMED])
    return names if len(results) <= NAMED else f"{names} and {len(results) - NAMED:,} more"
