"""How many pieces were simulated, what that changed, and what is still open, in the words of reports."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.findings.cautions import list_narrowing
from assess.report.findings.uncertain import list_conditions
from assess.results import ItemResult, Results
from assess.risk import RiskClass
from assess.settings import AUTO

NAMED = 12
"""Pieces that a sentence names; the rest are counted."""
SCENARIO = fill("Chance of overturning in this scenario, not per year.")
WITH_ANNUAL = fill("Chance of overturning in this scenario, unless it is called a chance a year.")
INTERVAL = fill("the sampling interval covers the number of draws only")
ASSUMED = fill("the range is what is not known of the ground and of the building")
WILSON = (
    "Wilson EB (1927). Probable inference, the law of succession, and statistical inference. Journal of the American "
    "Statistical Association 22(158):209-212. doi:10.1080/01621459.1927.10502953"
)
"""The interval of a simulated chance."""


def say_range(results: Results) -> str:
    """Return what the range behind a simulated chance is, without a full stop."""
    assumed = {one.ensemble.assumed_motion for one in results.motions if one.ensemble is not None}
    if assumed == {True}:
        return _(ASSUMED)
    if True in assumed:
        return _("{interval}; on assumed motion {range}", interval=_(INTERVAL), range=_(ASSUMED))
    return _(INTERVAL)


def say_scenario(results: Results) -> str:
    """Return what the chances of a report are, for the foot of every page."""
    has_annual = results.annual is not None and results.annual.is_evaluated
    return _(WITH_ANNUAL if has_annual else SCENARIO)


@dataclass(frozen=True, slots=True)
class Verified:
    """The rows of a report by what simulation found.

    `done` were simulated, `left` were not and can rock. Of those done, `unconfirmed` have a class that cannot be relied
    on: nothing is known of their building, or they keep the formula's, as the motions are weak. Of the others,
    `lowered` and `raised` have another class than the formula's; `may_be` have a range that reaches into a higher
    class; `undecided` are not resolved after the last check of "auto"; `fell` overturn under a recorded motion itself;
    `ideal_higher` would have a higher class if exactly this motion recurred.
    """

    run: Results
    left: Sequence[ItemResult]
    done: Sequence[ItemResult]
    lowered: Sequence[ItemResult]
    raised: Sequence[ItemResult]
    unconfirmed: Sequence[ItemResult]
    may_be: Sequence[ItemResult]
    undecided: Sequence[ItemResult]
    fell: Sequence[ItemResult]
    ideal_higher: Sequence[ItemResult]

    @property
    def is_all(self) -> bool:
        """Whether every row was simulated."""
        return bool(self.done) and not self.left

    @property
    def motions(self) -> str:
        """Number and kind of the motions."""
        if suite := self.run.provenance.suite:
            return ngettext("{n:,} motion of the user's own", "{n:,} motions of the user's own", len(suite))
        return _("{motions} on each floor and axis", motions=count_motions(self.run))

    @property
    def status(self) -> tuple[str, str]:
        """The state of the report in one or two words, and what it means."""
        if not self.done:
            return _("Not simulated"), _("classes come from a published formula; no rocking has been simulated")
        texts = [
            ngettext(
                "rocking of {done:,} of {n:,} row simulated, {motions}",
                "rocking of {done:,} of {n:,} rows simulated, {motions}",
                len(self.run), done=len(self.done), motions=self.motions,
            )
        ]  # fmt: skip
        if self.unconfirmed:
            texts.append(
                ngettext(
                    "{n:,} row is unconfirmed and counted apart",
                    "{n:,} rows are unconfirmed and counted apart",
                    len(self.unconfirmed),
                )
            )
        if self.left:
            texts.append(_("the other rows have a class by a published formula, and are counted apart"))
        return _("Simulated") if self.is_all else _("Partly simulated"), "; ".join(texts)

    @property
    def footer(self) -> str:
        """The foot of every page, but for what `list_conditions` adds."""
        if not self.done:
            return f"{say_scenario(self.run)} {self.sentence}"
        extent = ngettext(
            "Simulated: {done:,} of {n:,} row; {interval}.", "Simulated: {done:,} of {n:,} rows; {interval}.",
            len(self.run), done=len(self.done), interval=say_range(self.run),
        )  # fmt: skip
        return f"{say_scenario(self.run)} {extent}"

    @property
    def conditions(self) -> str:
        """What the head of every page says of the run: "" of a run with both uncertainties and the motions as given."""
        return " · ".join(list_conditions(self.run))

    @property
    def interval(self) -> str:
        """What the range covers, what would narrow it, and which percentages have none; without a full stop."""
        if not self.done:
            return _("there are no intervals, as no rocking has been simulated in this run")
        texts = [say_range(self.run)]
        if ways := list_narrowing(self.run):
            most = ways[0] if len(ways) == 1 else _("{first}, else {second}", first=ways[0], second=ways[1])
            texts.append(_("what would narrow it most: {ways}", ways=most))
        if self.left or not all(one.adopted.has_simulated for one in self.unconfirmed):
            texts.append(_("percentages without a range come from the formula only"))
        return "; ".join(texts)

    @property
    def adopted(self) -> str:
        """Which method the adopted chances come from."""
        titles = {"formula": _(self.run.formula.title), "simulation": _(self.run.simulation.title)}
        if not self.done:
            text = _("Adopted risk: {formula}. The other methods are shown for comparison.", **titles)
        else:
            text = _(
                "Adopted risk: {simulation} (direct integration) where a piece was simulated, otherwise {formula}, "
                "counted apart. The other methods are shown for comparison.", **titles,
            )  # fmt: skip
        if any(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _(
                "Where nothing is known of the building, the class is at least that of the faster third of the draws, "
                "unconfirmed."
            )
        if not all(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _(
                "Where simulation gave a lower class under motions weaker than the floor's, the class is that of "
                "{formula}, unconfirmed.", **titles,
            )  # fmt: skip
        return text

    @property
    def sentence(self) -> str:
        """How much was simulated, and what that changed, in one sentence."""
        if not self.done:
            return _("Not simulated.")
        extent = ngettext(
            "Simulated by direct integration: {done:,} of {n:,} row, {motions} each",
            "Simulated by direct integration: {done:,} of {n:,} rows, {motions} each",
            len(self.run), done=len(self.done), motions=count_motions(self.run),
        )  # fmt: skip
        return "; ".join([extent, *self._list_changes()]) + "."

    def _list_changes(self) -> Iterator[str]:
        if self.lowered:
            yield _("class lowered: {pieces}", pieces=count_rows(self.lowered))
        if self.raised:
            yield _("class raised: {pieces}", pieces=count_rows(self.raised))
        if self.may_be:
            yield _("could be of a higher class: {pieces}", pieces=count_rows(self.may_be))
        if self.unconfirmed:
            yield _("unconfirmed: {pieces}", pieces=count_rows(self.unconfirmed))
        if n := len(self.fell):
            yield ngettext(
                "{n:,} row overturns under the record itself", "{n:,} rows overturn under the record itself", n
            )
        if n := len(self.undecided):
            yield ngettext("{n:,} row still undecided", "{n:,} rows still undecided", n)

    @property
    def summary(self) -> list[str]:
        """What simulation changed, and what is open, line by line."""
        if not self.done:
            return []
        most = self.run.provenance.looks[-1]
        lines = [
            (_("Class lowered by simulation"), self.lowered,
             ", ".join(_("{n:,} from {risk}", n=n, risk=risk)
                       for n, risk in _by_class(self.lowered, lambda one: one.adopted.lowered_from))),
            (_("Class raised by simulation"), self.raised,
             ", ".join(_("{n:,} to {risk}", n=n, risk=risk)
                       for n, risk in _by_class(self.raised, lambda one: one.adopted.risk))),
            (_("Unconfirmed, as nothing is known of the building, or the formula's class although simulation gave a "
               "lower one, as the motions are weaker than the floor's"),
             self.unconfirmed, name_some(self.unconfirmed)),
            (_("Could be of a higher class: the range reaches into it"), self.may_be, ""),
            (_("Would be of a higher class if exactly this motion recurred and the piece were exactly as given"),
             self.ideal_higher, name_some(self.ideal_higher)),
            (_("Undecided: the interval still covers more than one class after {most:,} motions", most=most),
             self.undecided, name_some(self.undecided)),
            (_("Overturn under the recorded motion itself, and so are at least high"), self.fell, name_some(self.fell)),
            (_("Not simulated: chance and class come from the formula"), self.left, ""),
        ]  # fmt: skip
        return [
            f"{label}: {count_rows(results)}{': ' if more else ''}{more}." for label, results, more in lines if results
        ]


def build_verified(run: Results, results: Sequence[ItemResult]) -> Verified:
    """Sort the rows by what simulation found."""

    def of(test: Callable[[ItemResult], bool]) -> tuple[ItemResult, ...]:
        return tuple(one for one in done if not one.apart and test(one))

    done = tuple(one for one in results if one.is_simulated)
    return Verified(
        run=run,
        left=tuple(one for one in results if not one.is_simulated and one.adopted.can_rock),
        done=done,
        unconfirmed=tuple(one for one in done if one.adopted.is_unconfirmed),
        lowered=of(lambda one: one.adopted.lowered_from is not None),
        raised=of(lambda one: one.adopted.risk > one.formula_class),
        may_be=of(lambda one: words.find_highest(one) > one.adopted.risk),
        undecided=of(lambda one: "undecided" in one.adopted.flags),
        fell=of(lambda one: one.fell_in_record),
        ideal_higher=of(lambda one: "ideal_higher" in one.adopted.flags),
    )


def describe_verification(results: Results) -> str:
    """Return how much was simulated, and what that changed, in one sentence."""
    return build_verified(results, tuple(results)).sentence


def count_motions(results: Results) -> str:
    """Return how many motions each piece was simulated under."""
    runs, looks = results.settings.runs, results.provenance.looks
    if runs == AUTO:
        return _("{least:,} to {most:,} motions", least=looks[0], most=looks[-1])
    return words.plural(int(runs), "motion")


def _by_class(
    results: Sequence[ItemResult], risk_of: Callable[[ItemResult], RiskClass | None]
) -> Iterator[tuple[int, str]]:
    """Yield the number of pieces and the class, the highest first."""
    for risk in reversed(RiskClass):
        if count := _pieces(one for one in results if risk_of(one) == risk):
            yield count, words.risk_word(risk)


def _pieces(results: Iterable[ItemResult]) -> int:
    return sum(one.item.quantity for one in results)


def count_rows(results: Sequence[ItemResult]) -> str:
    """Return ``5 pieces in 3 rows``, with the number of anchored pieces, which have no class."""
    anchored = _pieces(one for one in results if one.is_anchored)
    pieces, rows = words.plural(_pieces(results), "piece"), words.plural(len(results), "row")
    if not anchored:
        return _("{pieces} in {rows}", pieces=pieces, rows=rows)
    return _("{pieces} in {rows} ({anchored:,} of them anchored)", pieces=pieces, rows=rows, anchored=anchored)


def name_some(results: Sequence[ItemResult]) -> str:
    """Return the names of the first rows, and how many more there are."""
    return words.name_pieces([one.item.item for one in results], NAMED, 40)
