"""What a report says of the verification: how much was verified, what it changed, what is still open."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from assess.language import fill, ngettext
from assess.language import gettext as _
from assess.methods._method import Reference
from assess.methods.housner_monte_carlo import LOOKS
from assess.report import words
from assess.results import Assessment, ItemResult
from assess.risk import RiskClass
from assess.settings import AUTO

NAMED = 12
"""Pieces that a sentence names; the rest are counted."""
SCENARIO = fill("Chance of overturning in this scenario, not per year.")
INTERVAL = fill("the interval covers the number of records only")
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
            meaning = _("classes are those of a published formula; no direct integration has been run")
            return _("Not verified"), meaning
        done, kept, motions = len(self.done), len(self.kept), self.motions
        texts = [
            ngettext(
                "{done:,} of {n:,} row by direct integration, {motions}",
                "{done:,} of {n:,} rows by direct integration, {motions}",
                self.rows,
                done=done,
                motions=motions,
            )
        ]
        if kept:
            texts.append(
                ngettext(
                    "of {n:,} row the formula's higher class is kept",
                    "of {n:,} rows the formula's higher class is kept",
                    kept,
                )
            )
        if self.is_all:
            return _("Verified"), "; ".join(texts)
        texts.append(_("the classes of the other rows are those of a published formula"))
        return _("Partly verified"), "; ".join(texts)

    @property
    def footer(self) -> str:
        """What stands at the foot of every page."""
        if not self.done:
            status = _("Not verified.")
            return f"{_(SCENARIO)} {status}"
        told = ngettext(
            "Verified: {done:,} of {n:,} row; {interval}.",
            "Verified: {done:,} of {n:,} rows; {interval}.",
            self.rows,
            done=len(self.done),
            interval=INTERVAL,
        )
        return f"{_(SCENARIO)} {told}"

    @property
    def interval(self) -> str:
        """What the interval covers, and which pieces have none."""
        if not self.done:
            return _(
                "{interval}, and there is none yet: nothing has been verified by direct integration in this run",
                interval=INTERVAL,
            )
        covers = _("{interval}, not the formula, the motion of the floor or the earthquake", interval=INTERVAL)
        if self.is_all and not self.kept:
            return covers
        without = _("A chance without an interval is the formula's: it is not verified")
        if self.kept:
            without = _(
                "A chance without an interval is the formula's: it is not verified, or verification gave a lower "
                "class, which is not adopted"
            )
        return f"{covers}. {without}"

    @property
    def adopted(self) -> str:
        """Which method the chances of the report are those of."""
        if not self.done:
            return _("The adopted risk is that of the proposed OR formula; the others stand beside it for comparison.")
        text = _(
            "The adopted risk is that of Housner Monte Carlo (direct integration) where a piece was verified, and that "
            "of the proposed OR formula where it was not; the others stand beside it for comparison."
        )
        if self.is_all:
            text = _(
                "The adopted risk is that of Housner Monte Carlo (direct integration) where a piece was verified; the "
                "others stand beside it for comparison."
            )
        kept = _(
            "Where verification gave a lower class that may not be adopted, it is that of the proposed OR formula (not "
            "lowered)."
        )
        return f"{text} {kept}" if self.kept else text


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
        return ngettext("{n:,} motion of the user's own", "{n:,} motions of the user's own", len(assessment.suite))
    return _("{motions} on each floor and axis", motions=count_motions(assessment))


def count_motions(assessment: Assessment) -> str:
    """Return how many motions each piece was integrated under."""
    runs = assessment.settings.runs
    if runs == AUTO:
        return _("{least:,} to {most:,} motions", least=LOOKS[0], most=LOOKS[-1])
    return words.plural(int(runs), "motion")


def describe_verification(assessment: Assessment) -> str:
    """Say in one or two sentences how much has been verified, and what that changed."""
    verified = build_verified(assessment, tuple(assessment))
    if not verified.done:
        return _("Not verified.")
    extent = ngettext(
        "Verified by direct integration: {done:,} of {n:,} row, {motions} each",
        "Verified by direct integration: {done:,} of {n:,} rows, {motions} each",
        verified.rows,
        done=len(verified.done),
        motions=count_motions(assessment),
    )
    return "; ".join([extent, *_list_changes(verified)]) + "."


def _list_changes(verified: Verified) -> Iterator[str]:
    """Say what the verification changed, and what is open."""
    if verified.lowered:
        yield _("class lowered by it: {pieces}", pieces=count_pieces(verified.lowered))
    if verified.raised:
        yield _("class raised by it: {pieces}", pieces=count_pieces(verified.raised))
    if verified.may_be:
        yield _("may be of a higher class: {pieces}", pieces=count_pieces(verified.may_be))
    if n := len(verified.kept):
        yield ngettext(
            "{n:,} row keeps the formula's class, which verification may not lower",
            "{n:,} rows keep the formula's class, which verification may not lower",
            n,
        )
    if n := len(verified.fell):
        yield ngettext("{n:,} row overturns under the record itself", "{n:,} rows overturn under the record itself", n)
    if n := len(verified.undecided):
        yield ngettext("{n:,} row still undecided", "{n:,} rows still undecided", n)


def list_summary(verified: Verified) -> list[str]:
    """Say for the summary what verification changed, and what is open."""
    if not verified.done:
        return []
    lines = [
        (_("Class lowered by verification"), verified.lowered, _lowered_from(verified.lowered)),
        (_("Class raised by verification"), verified.raised, _raised_to(verified.raised)),
        (_("Class of the formula kept although verification gave a lower one (see the comparison of the methods), as "
           "the motions follow a generic spectrum or are weaker than the floor's, or its PFV is an estimate"),
         verified.kept, ""),
        (_("May be of a higher class, as the interval reaches into it"), verified.may_be, ""),
        (_("Undecided, as the interval still reaches over more than one class after {most:,} motions", most=LOOKS[-1]),
         verified.undecided, name_some(verified.undecided)),
        (_("Overturn under the recorded motion itself, and so are at least high"), verified.fell,
         name_some(verified.fell)),
        (_("Not verified, chance and class are the formula's"), verified.left, ""),
    ]  # fmt: skip
    return [
        f"{label}: {count_pieces(results)}{': ' if told else ''}{told}." for label, results, told in lines if results
    ]


def _lowered_from(results: Sequence[ItemResult]) -> str:
    """Return how many pieces were lowered from each class."""
    counts = _by_class(results, lambda one: one.adopted.lowered_from or RiskClass.LOW)
    return ", ".join(_("{count:,} from {risk}", count=count, risk=words.risk_word(risk)) for risk, count in counts)


def _raised_to(results: Sequence[ItemResult]) -> str:
    """Return how many pieces were raised to each class."""
    counts = _by_class(results, lambda one: one.adopted.risk)
    return ", ".join(_("{count:,} to {risk}", count=count, risk=words.risk_word(risk)) for risk, count in counts)


def _by_class(results: Sequence[ItemResult], risk_of: Callable[[ItemResult], RiskClass]) -> list[tuple[RiskClass, int]]:
    """Return the classes that there are, the highest first, with the pieces of each."""
    counts = [(risk, _pieces(one for one in results if risk_of(one) == risk)) for risk in reversed(RiskClass)]
    return [(risk, count) for risk, count in counts if count]


def _pieces(results: Iterable[ItemResult]) -> int:
    return sum(one.item.quantity for one in results)


def count_pieces(results: Sequence[ItemResult]) -> str:
    """Return ``5 pieces in 3 rows``, with those that are anchored, which stand outside the classes."""
    anchored = _pieces(one for one in results if one.is_anchored)
    pieces, rows = words.plural(_pieces(results), "piece"), words.plural(len(results), "row")
    if not anchored:
        return _("{pieces} in {rows}", pieces=pieces, rows=rows)
    return _("{pieces} in {rows} ({anchored:,} of them anchored)", pieces=pieces, rows=rows, anchored=anchored)


def name_some(results: Sequence[ItemResult]) -> str:
    """Return the names of the first rows, and how many more there are."""
    return words.name_first([words.cut(one.item.item, 40) for one in results], NAMED)
