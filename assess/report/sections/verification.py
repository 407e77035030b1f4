"""What was simulated, under which motions, and what it changed; risk over breadth and PFA; chances a year."""

import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import replace

from assess.annual_results import YEARS
from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import blocks, words
from assess.report.figures.motion_figures import draw_traced
from assess.report.figures.risk_map import draw_contours
from assess.report.say import annual
from assess.report.say.annual import AnnualLine
from assess.report.say.simulation import count_rows, describe_trials, list_misfits, name_some
from assess.report.view import Part, View, say_left
from assess.results import EnsembleRow, MotionRow, count_pieces
from assess.risk import RiskClass

MOST, MISFITS = 60, 6
"""Motions, and sentences on large misfits, that are shown."""
LISTED = 20
"""Rows of the lists of changes, of falls under the record, and of chances a year."""


def build(view: View) -> blocks.Section:
    """Return the status, the motions of each floor with their fit, figures, and what simulation changed."""
    verified = view.content.verified
    if not verified.done:
        text = blocks.rich(_("<strong>Not simulated.</strong> The risks in this report come from published formulas. "
                             "No rocking has been simulated, so no class has been confirmed, raised or lowered, and no "
                             "interval is given."))  # fmt: skip
        return blocks.Section([blocks.Paragraph(text)], "run-on")
    status, why = verified.status
    return blocks.Section([
        blocks.Paragraph([blocks.strong(status), f": {why}."], "lead"),
        *map(blocks.Paragraph, describe_trials(verified)),
        blocks.Bullets(list(_list_found(view))),
        *_list_motions(view),
        *view.once("verification", lambda: list(draw_traced(view.content, view.progress))),
    ])  # fmt: skip


def _list_found(view: View) -> Iterator[str]:
    """Yield what simulation changed, and what is open, line by line."""
    found, lowered, raised = view.content.verified, list[str](), list[str]()
    for risk in reversed(RiskClass):
        if n := count_pieces(one for one in found.lowered if one.adopted.lowered_from == risk):
            lowered.append(_("{n:,} from {risk}", n=n, risk=words.risk_word(risk)))
        if n := count_pieces(one for one in found.raised if one.adopted.risk == risk):
            raised.append(_("{n:,} to {risk}", n=n, risk=words.risk_word(risk)))
    most = view.run.provenance.looks[-1]
    lines = [
        (_("Class lowered by simulation"), found.lowered, ", ".join(lowered)),
        (_("Class raised by simulation"), found.raised, ", ".join(raised)),
        (_("Unconfirmed, as nothing is known of the building, or the formula's class although simulation gave a "
           "lower one, as the motions are weaker than the floor's"),
         found.unconfirmed, name_some(found.unconfirmed)),
        (_("Could be of a higher class: the range reaches into it"), found.may_be, ""),
        (_("Would be of a higher class if exactly this motion recurred and the piece were exactly as given"),
         found.ideal_higher, name_some(found.ideal_higher)),
        (_("Undecided: the interval still covers more than one class after {most:,} motions", most=most),
         found.undecided, name_some(found.undecided)),
        (_("Overturn under the recorded motion itself, and so are at least high"), found.fell, name_some(found.fell)),
        (_("Not simulated: chance and class come from the formula"), found.left, ""),
    ]  # fmt: skip
    for label, rows, more in lines:
        if rows:
            yield f"{label}: {count_rows(rows)}{': ' if more else ''}{more}."


def _list_motions(view: View) -> list[blocks.Block]:
    made = [(one, one.ensemble) for one in view.run.motions if one.ensemble is not None]
    misfits = list_misfits(view.run)
    heads = blocks.list_columns(
        (_("Floor"), "w8"), (_("Axis"), "w6"), (_("Floor motion"), ""), (_("Motions made for"), "w12"),
        (_("Motions"), "w9", "num"), (_("Rows simulated"), "w11", "num"),
        (_("Spectral misfit (mean; most)"), "w15", "num"), (_("PFA, ratio"), "w11", "num"),
        (_("PFV, ratio"), "w11", "num"),
    )  # fmt: skip
    misfit = _("Spectral misfit: mean deviation of the motions' mean 5 % spectrum from its target, over its periods; "
               "then the largest, and its period. Ratios: mean peak of the motions over the floor's, ± the scatter "
               "from motion to motion.")  # fmt: skip
    left = len(misfits) - MISFITS
    more = ngettext("{n:,} more floor motion with a large misfit is in the table.",
                    "{n:,} more floor motions with a large misfit are in the table.", left)  # fmt: skip
    return [
        blocks.Heading(_("Motions of each floor")),
        blocks.table(heads, (_list_fit(view, *one) for one in made[:MOST]), "motions"),
        *say_left(len(made) - MOST),
        blocks.Paragraph(misfit, "small"),
        *(blocks.Paragraph(text, "caution") for text in misfits[:MISFITS]),
        *([blocks.Paragraph(more, "small")] if left > 0 else []),
    ]


def _list_fit(view: View, motion: MotionRow, ensemble: EnsembleRow) -> list[str]:
    fit, suite = ensemble.fit, view.run.provenance.suite
    pfa = pfv = spectrum = words.DASH
    if suite is not None:
        kind = _("own, scaled to PFA") if suite.is_scaled else _("own, not scaled")
        factors = [motion.pfa_g / one if suite.is_scaled else 1.0 for one in suite.pfa_g]
        pfa = _peak_ratio(suite.pfa_g, factors, motion.pfa_g)
        pfv = _peak_ratio(suite.pfv_cm_s, factors, motion.pfv_cm_s)
    elif ensemble.unknown_building:
        kind = _("assumed motion, nothing known of the building")
    else:
        kind = _("assumed motion") if ensemble.assumed_motion else _("recorded motion")
    if suite is None and fit is not None:
        pfa, pfv = _ratio(fit.pfa_ratio, fit.pfa_scatter), _ratio(fit.pfv_ratio, fit.pfv_scatter)
        spectrum = _("{mean}; {most:+.1f} % at {period:.2f} s", mean=words.deviation(fit.mean_deviation),
                     most=100 * fit.worst_deviation, period=fit.worst_period)  # fmt: skip
    least, most = ensemble.least_motions, ensemble.motions
    count = number(most, ",") if least == most else _("{least:,} to {most:,}", least=least, most=most)
    source = words.cut(_(motion.label).rsplit("/", 1)[-1], 60)
    rows = number(ensemble.cases, ",d")
    return [words.cut(motion.floor, 20), motion.axis, source, kind, count, rows, spectrum, pfa, pfv]


def _ratio(ratio: float | None, scatter: float) -> str:
    """Return a ratio of peaks with its scatter, a coefficient of variation."""
    return words.DASH if ratio is None else f"{number(ratio, '.2f')} ± {number(ratio * scatter, '.2f')}"


def _peak_ratio(peaks: Sequence[float], factors: Sequence[float], floor: float | None) -> str:
    if not floor:
        return words.DASH
    ratios = [peak * factor / floor for peak, factor in zip(peaks, factors, strict=True)]
    mean = statistics.fmean(ratios)
    return _ratio(mean, statistics.pstdev(ratios) / mean)


def build_contours(view: View) -> blocks.Section:
    """Return the figure; nothing where the pieces have none."""
    drawn = view.once("contours", lambda: draw_contours(view.run, view.progress))
    text = _("The chance of overturning by the formulas for pieces of one height, over Breadth and PFA, with the "
             "pieces of this building.")  # fmt: skip
    return blocks.Section([blocks.Paragraph(text), drawn], "" if view.content.verified.done else "run-on")


def build_annual(view: View) -> blocks.Section:
    """Return what the chances rest on, and the likeliest of each kind."""
    found, run = view.content.annual, view.run.annual
    if found is None or run is None:
        return blocks.Section([])
    listed: list[blocks.Block] = []
    if run.is_evaluated:
        text = _("These chances count all earthquakes of the site, weak and strong. All other chances in this report "
                 "are those in the scenario.")  # fmt: skip
        listed.append(blocks.Paragraph(text, "caution"))
    listed += [blocks.Paragraph(text, "" if at else "lead") for at, text in enumerate(found.paragraphs)]
    for one in run.remarks:
        listed.append(blocks.Paragraph(_("On the hazard curve: {remark}.", remark=_(one)), "caution"))
    listed += _list_annual(_("Pieces most likely to fall"), _("Piece"), found.pieces, has_what=True)
    listed += _list_annual(_("Routes: blocked, if all anchors hold"), _("Route"), found.routes)
    listed += _list_annual(_("Rooms: every exit lost, if all anchors hold"), _("Room"), found.rooms)
    return blocks.Section(listed)


def _list_annual(title: str, name: str, lines: Sequence[AnnualLine], *, has_what: bool = False) -> list[blocks.Block]:
    if not lines:
        return []
    has_fail = any(one.fail for one in lines)
    heads = blocks.list_columns(
        (name, "" if has_what else "w24"),
        *([(_("Description"), "w20")] if has_what else []),
        (_("Floor, room") if has_what else _("Floor"), ""),
        (_("Chance a year"), "w10", "num"), (_("Chance in 50 years"), "w10", "num"),
        (_("Interval (50 years)"), "w18", "num"), (_("Once in [years]"), "w8", "num"),
        (_("Median ground PGA [g] (dispersion)"), "w12", "num"),
        *([(_("If anchors fail (50 years)"), "w10", "num")] if has_fail else []),
    )  # fmt: skip
    rows: list[list[blocks.Cell | blocks.Words]] = []
    for one in lines[:LISTED]:
        row, fail, median, interval, years = one.row, *[words.DASH] * 4
        if one.fail is not None:
            fail = annual.say_share(one.fail.chance_in_50_years, one.fail)
        if row.median_g is not None and row.dispersion is not None:
            median = f"{number(row.median_g, '.2f')} ({number(row.dispersion, '.2f')})"
        if row.low is not None and row.high is not None:
            plain = replace(row, at_least=False)
            low, high = (annual.say_share(-math.expm1(-YEARS * rate), plain) for rate in (row.low, row.high))
            interval = _("{low} to {high}", low=low, high=high)
        if row.rate > 0:
            once = 1 / row.rate
            years = number(once, ".1f") if once < 10 else number(float(f"{once:.2g}"), ",.0f")
        rows.append([
            blocks.head(words.cut(one.name, 30)), *([words.cut(one.what, 40)] if has_what else []),
            words.cut(one.where, 24), annual.say_share(row.chance_a_year, row),
            annual.say_share(row.chance_in_50_years, row), interval, years, median,
            *([fail] if has_fail else []),
        ])  # fmt: skip
    left = say_left(len(lines) - LISTED, is_likely=True)
    return [blocks.Heading(title), blocks.table(heads, rows, "annual"), *left]


PARTS = (
    Part(key="verification", heading=fill("Verification"), places={"annex": 30, "all": 110}, build=build),
    Part(key="contours", heading=fill("Risk over breadth and acceleration"), places={"annex": 40, "all": 120},
         build=build_contours, is_shown=lambda view: "contours/items" in view.run.series),
    Part(key="annual", heading=fill("Chances a year"), places={"annex": 20, "all": 70}, build=build_annual,
         is_shown=lambda view: view.content.annual is not None),
)  # fmt: skip
