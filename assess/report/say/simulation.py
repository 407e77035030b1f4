"""What is said of the simulation: what it rests on, what was drawn, and what it changed."""

import re
from collections.abc import Sequence

from assess.i18n import fill, gettext as _, ngettext, number
from assess.model import SCANNED
from assess.report import words
from assess.report.provenance import say_reference
from assess.report.say.ground import describe_suite, list_narrowing, name_source, say_signs
from assess.results import EarthquakeDraws, ItemResult, Results, count_pieces
from assess.settings import AUTO

INTERVAL = fill("the sampling interval covers the number of draws only")
SHORTEST = 8
"""Characters of the beginning of a scenario that do not name it yet, as "M 6"."""
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
    if results.annual is not None and results.annual.is_evaluated:
        return _("Chance of overturning in an earthquake like this one, unless it is called a chance a year.")
    return _("Chance of overturning in an earthquake like this one, not per year.")


def name_earthquake(results: Results) -> str:
    """Return the earthquake in a few words: how the scenario of the workbook begins, or what shakes the floors."""
    scenario = " ".join(results.building.scenario.split())
    if scenario:
        first = re.split(r"[,;:(]|\.\s", scenario, maxsplit=1)[0].strip(" .")
        return words.cut(first if len(first) > SHORTEST else scenario.strip(" ."), 60)
    if results.provenance.shaking:
        return _("assumed: {intensity}", intensity=_(results.provenance.shaking.name))
    if results.provenance.site_ground:
        return name_source(results.provenance.site_ground)
    return (
        _("as it was recorded")
        if any(one.has_record for one in results.motions)
        else _("as strong as the workbook says")
    )


class Verified:
    """The rows of a report by what simulation found.

    `done` were simulated, `left` were not and can rock. Of those done, `unconfirmed` have a class that cannot be relied
    on: nothing is known of their building, or they keep the formula's, as the motions are weak. Of the others,
    `lowered` and `raised` have another class than the formula's; `may_be` have a range that reaches into a higher
    class; `undecided` are not resolved after the last check of "auto"; `fell` overturn under a recorded motion itself;
    `ideal_higher` would have a higher class if exactly this motion recurred.
    """

    def __init__(self, run: Results, results: Sequence[ItemResult]) -> None:
        self.run = run
        self.left = [one for one in results if not one.is_simulated and one.adopted.can_rock]
        self.done = [one for one in results if one.is_simulated]
        self.unconfirmed = [one for one in self.done if one.adopted.is_unconfirmed]
        main = [one for one in self.done if not one.apart]
        self.lowered = [one for one in main if one.adopted.lowered_from is not None]
        self.raised = [one for one in main if one.adopted.risk > one.formula_class]
        self.may_be = [one for one in main if words.find_highest(one) > one.adopted.risk]
        self.undecided = [one for one in main if "undecided" in one.adopted.flags]
        self.fell = [one for one in main if one.fell_in_record]
        self.ideal_higher = [one for one in main if "ideal_higher" in one.adopted.flags]

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
            ngettext("rocking of {done:,} of {n:,} row simulated, {motions}",
                     "rocking of {done:,} of {n:,} rows simulated, {motions}", len(self.run), done=len(self.done),
                     motions=self.motions)
        ]  # fmt: skip
        if self.unconfirmed:
            texts.append(ngettext("{n:,} row is unconfirmed and counted apart",
                                  "{n:,} rows are unconfirmed and counted apart", len(self.unconfirmed)))  # fmt: skip
        if self.left:
            texts.append(_("the other rows have a class by a published formula, and are counted apart"))
        return _("Partly simulated") if self.left else _("Simulated"), "; ".join(texts)

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
            text = _("Adopted risk: {simulation} (direct integration) where a piece was simulated, otherwise "
                     "{formula}, counted apart. The other methods are shown for comparison.", **titles)  # fmt: skip
        if any(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _("Where nothing is known of the building, the class is at least that of the faster third of "
                            "the draws, unconfirmed.")  # fmt: skip
        if not all(one.adopted.has_simulated for one in self.unconfirmed):
            text += " " + _("Where simulation gave a lower class under motions weaker than the floor's, the class is "
                            "that of {formula}, unconfirmed.", **titles)  # fmt: skip
        return text

    @property
    def sentence(self) -> str:
        """How much was simulated, and what that changed, in one sentence."""
        if not self.done:
            return _("Not simulated.")
        extent = ngettext("Simulated by direct integration: {done:,} of {n:,} row, {motions} each",
                          "Simulated by direct integration: {done:,} of {n:,} rows, {motions} each", len(self.run),
                          done=len(self.done), motions=count_motions(self.run))  # fmt: skip
        changes = [
            _("class lowered: {pieces}", pieces=count_rows(self.lowered)) if self.lowered else "",
            _("class raised: {pieces}", pieces=count_rows(self.raised)) if self.raised else "",
            _("could be of a higher class: {pieces}", pieces=count_rows(self.may_be)) if self.may_be else "",
            _("unconfirmed: {pieces}", pieces=count_rows(self.unconfirmed)) if self.unconfirmed else "",
            ngettext("{n:,} row overturns under the record itself", "{n:,} rows overturn under the record itself",
                     len(self.fell)) if self.fell else "",
            ngettext("{n:,} row still undecided", "{n:,} rows still undecided", len(self.undecided))
            if self.undecided else "",
        ]  # fmt: skip
        return "; ".join(filter(None, (extent, *changes))) + "."


def count_motions(results: Results) -> str:
    """Return how many motions each piece was simulated under."""
    runs, looks = results.settings.runs, results.provenance.looks
    if runs == AUTO:
        return _("{least:,} to {most:,} motions", least=looks[0], most=looks[-1])
    return words.plural(int(runs), "motion")


def count_rows(results: Sequence[ItemResult]) -> str:
    """Return ``5 pieces in 3 rows``, with the number of anchored pieces, which have no class."""
    anchored = count_pieces(one for one in results if one.is_anchored)
    pieces, rows = words.plural(count_pieces(results), "piece"), words.plural(len(results), "row")
    if not anchored:
        return _("{pieces} in {rows}", pieces=pieces, rows=rows)
    return _("{pieces} in {rows} ({anchored:,} of them anchored)", pieces=pieces, rows=rows, anchored=anchored)


def name_some(results: Sequence[ItemResult]) -> str:
    """Return the names of the first rows, and how many more there are."""
    return words.name_pieces([one.item.item for one in results], 12, 40)


def describe_trials(verified: Verified) -> list[str]:
    """Return what was simulated, under which motions and draws, in paragraphs; none where nothing was simulated."""
    if not verified.done:
        return []
    results, restitution = verified.run, verified.run.building.restitution
    origin, looks = results.provenance, results.provenance.looks
    extent = [_("The rocking of {done:,} of {rows} was integrated step by step (Housner's equations of a rigid block, "
                "see Methods). The chance is the share of draws in which the piece overturns, each of one motion.",
                done=len(verified.done), rows=words.plural(len(results), "row"))]  # fmt: skip
    if n := sum("does_not_rock" in one.adopted.flags for one in results):
        extent.append(ngettext("{n:,} row is too stocky to rock (B/H of {limit:.2f} or more).",
                               "{n:,} rows are too stocky to rock (B/H of {limit:.2f} or more).",
                               n, limit=1.41))  # fmt: skip
    extent.append(
        _("All rows were chosen.") if results.settings.verify == "all" else
        _("Chosen were the rows of high or very high class by any of these under any of their motions: {methods}; "
          "those outside the range in which one of these was checked: {formulas}; and those on a route.",
          methods=", ".join(_(one.title) for one in results.methods if one.selects),
          formulas=", ".join(_(one.title) for one in results.methods if one.selecting_flags))
    )  # fmt: skip
    draws = [
        _say_draws(results),
        _("At each impact a piece keeps 1 - 1.5 sin²α of its angular velocity (Housner 1963).") if restitution is None
        else _("At each impact a piece keeps {share:g} of its angular velocity, as set in the workbook.",
               share=restitution),
        _("The sampling interval is Wilson's with z = {z:.2f}; it covers the number of draws only: not the model of "
          "the block, not how well the floor's motion is known, not the assumed dispersions.", z=origin.interval_z),
    ]  # fmt: skip
    texts = [" ".join(extent), _say_motions(results), " ".join(draws)]
    if results.settings.runs == AUTO:
        text = _("Motions were added until every class was statistically resolved, each piece's interval lying within "
                 "one class. This was checked after {looks} and {last:,} motions, with an interval (z = {z:g}) that "
                 "holds with 95 % for all {checks} checks together.",
                 looks=", ".join(number(look, ",") for look in looks[:-1]), last=looks[-1], z=origin.interval_z,
                 checks=len(looks))  # fmt: skip
        left = (_("Undecided after {last:,}: {pieces}.", last=looks[-1], pieces=name_some(verified.undecided))
                if verified.undecided else _("No piece is left undecided."))  # fmt: skip
        texts.append(f"{text} {left}")
    return texts


def _say_motions(results: Results) -> str:
    if results.provenance.suite:
        return _("The motions are the user's own: {motions}. Motion k serves every floor and axis.",
                 motions=describe_suite(results))  # fmt: skip
    runs = results.settings.runs
    made = _("On each floor and axis {motions} were generated (seed {seed}). Their mean 5 % response spectrum matches "
             "that of the floor's recorded motion, or of drawn earthquakes in drawn buildings where no record is "
             "known. The former differ by their random phases alone, which is less than earthquakes differ.",
             motions=_("as many motions as are needed") if runs == AUTO else words.plural(int(runs), "motion"),
             seed=results.settings.seed)  # fmt: skip
    return f"{made} {say_signs(results)}"


def _say_draws(results: Results) -> str:
    uncertainty = results.provenance.uncertainty
    if results.settings.ideal:
        return _("The adopted chance is the one if exactly this motion recurred and every piece were exactly as given.")
    parts = []
    if uncertainty.motion:
        parts.append(_("In draw k, motion k is scaled by exp({dispersion} ε), with one normal number ε for the whole "
                       "building ({source}).", dispersion=number(uncertainty.motion, ".3g"),
                       source=say_source(results)))  # fmt: skip
    parts += filter(None, [say_draws(results)])
    if uncertainty.piece:
        parts.append(_("Each piece draws its base × N({mean}, {base}), its height × N(1, {height}), its centre of "
                       "gravity N(as given, {centre}) of its height and its restitution N(as given or Housner's, "
                       "{restitution}), as assumed.", mean=number(uncertainty.base[0]),
                       base=number(uncertainty.base[1]), height=number(uncertainty.height),
                       centre=number(uncertainty.centre), restitution=number(uncertainty.restitution)))  # fmt: skip
        if count_scanned(results):
            parts.append(_("A piece whose sizes were measured by a scan draws its base × N({mean}, {base}) and its "
                           "height × N(1, {height}), as assumed: no accuracy of such sizes is published.",
                           mean=number(uncertainty.scanned_base[0]), base=number(uncertainty.scanned_base[1]),
                           height=number(uncertainty.scanned_height)))  # fmt: skip
    if parts:
        parts.append(_("Normal numbers are cut at {cut:g} standard deviations.", cut=uncertainty.cut))
    return " ".join([*parts, _("“If exactly this motion recurred” is the chance without either uncertainty.")])


def list_misfits(results: Results) -> list[str]:
    """Return which floor motions the generated motions do not match well."""
    made = [(one, one.ensemble.fit) for one in results.motions if one.ensemble is not None]
    return [
        _("Floor {floor} {axis}: PFA and the spectrum cannot both be matched. PFA takes precedence; the mean spectrum "
          "deviates by {mean} on average, and by {most} at {period:.2f} s, where it is worst.",
          floor=words.cut(motion.floor, 20), axis=motion.axis, mean=words.deviation(fit.mean_deviation),
          most=words.deviation(abs(fit.worst_deviation)), period=fit.worst_period)
        for motion, fit in made if fit is not None and fit.mean_deviation > 0.10
    ]  # fmt: skip


def list_assumed_draws(results: Results, verified: Verified) -> list[tuple[str, str]]:
    """Return the assumptions of the simulation; nothing where none ran."""
    if not verified.done:
        return []
    own, z, uncertainty = results.building.restitution, results.provenance.interval_z, results.provenance.uncertainty
    restitution = (_("1 - 1.5 sin²α (Housner 1963), as the workbook leaves it blank") if own is None
                   else _("{ratio:g}, the workbook's", ratio=own))  # fmt: skip
    motions = verified.motions
    if results.provenance.suite is None:
        motions = _("{motions}, generated with seed {seed}", motions=motions, seed=results.settings.seed)
    interval = _("Wilson's, z = {z:.2f}: 95 %", z=z)
    if results.settings.runs == AUTO:
        checks = len(results.provenance.looks)
        interval = _("Wilson's, z = {z:.2f}: 95 % for all {checks} checks together", z=z, checks=checks)
    motion = _("{dispersion}, {source}", dispersion=number(uncertainty.motion, ".3g"), source=say_source(results))
    piece = (_("base, height, centre of gravity and restitution are drawn, with assumed dispersions")
             if uncertainty.piece else _("none: every piece is exactly as given"))  # fmt: skip
    if results.settings.ideal:
        motion, piece = (_("{text}; left out in this run", text=text) for text in (motion, piece))
    lines = [
        (_("Motion uncertainty (standard deviation of ln amplitude, one draw for the whole building)"), motion),
        (_("Draws of an earthquake (ε is the number by which draw k scales the motions)"), say_draws(results)),
        (_("Piece uncertainty"), piece),
        (_("Restitution (angular velocity after an impact over that before)"), restitution),
        (_("Motions of the simulation"), motions),
        (_("Interval of a simulated chance"), interval),
    ]
    return [one for one in lines if one[1]]


def list_conditions(results: Results) -> list[str]:
    """Return what every page of a report says: source of the ground motion, nothing varied, motions times a factor."""
    settings, texts = results.settings, []
    if shaking := results.provenance.shaking:
        texts.append(_("Assumed shaking: {intensity}", intensity=_(shaking.choice)))
    if site := results.provenance.site_ground:
        texts.append(_("Ground motion: {source}", source=name_source(site)))
    if settings.ideal and results.has_simulated:
        texts.append(_("Assumed: exactly this motion, and every piece exactly as given"))
    if settings.scale != 1:
        texts.append(_("Every floor's motion times {scale}", scale=number(settings.scale, "g")))
    if isinstance(settings.anchor, int):
        if settings.anchor:
            texts.append(ngettext("Taken as anchored and holding: the first entry of what to fix",
                                  "Taken as anchored and holding: the first {n:,} entries of what to fix",
                                  settings.anchor))  # fmt: skip
    elif settings.anchor:
        named = words.name_pieces(settings.anchor, 4, 40)
        texts.append(_("Taken as anchored and holding: {items}", items=named))
    return texts


def say_assumed(results: Results) -> str:
    """Return what was assumed uncertain, in a sentence or two; "" where nothing was simulated."""
    if not results.has_simulated:
        return ""
    if results.settings.ideal:
        return _("It is assumed that exactly this motion recurs and that every piece is exactly as given: nothing is "
                 "varied.")  # fmt: skip
    scanned, dispersion = count_scanned(results), results.provenance.uncertainty.motion
    if dispersion:
        motion = _("Chances hold for an earthquake like this one: each draw scales the motions of the whole building "
                   "by one factor, with a dispersion of {dispersion} (standard deviation of ln amplitude; {source}).",
                   dispersion=number(dispersion, ".3g"), source=say_source(results))  # fmt: skip
    elif _has_drawn(results):
        motion = _("Chances hold for earthquakes with the given peaks: ground motions and buildings are drawn.")
    else:
        motion = _("The motions are not scaled, as Motion uncertainty is 0 in the workbook: exactly this motion "
                   "recurs.")  # fmt: skip
    if results.provenance.uncertainty.piece:
        piece = _("Sizes, centre of gravity and restitution of each piece are varied.")
        of_scanned = ngettext("Those of {n:,} piece were measured by a scan, which is less accurate: its sizes are "
                              "varied more.",
                              "Those of {n:,} pieces were measured by a scan, which is less accurate: their sizes are "
                              "varied more.", scanned)  # fmt: skip
    else:
        piece = _("Sizes, centre of gravity and restitution are exactly as given.")
        of_scanned = ngettext("Those of {n:,} piece were measured by a scan, which is less accurate: its chance may be "
                              "higher or lower.",
                              "Those of {n:,} pieces were measured by a scan, which is less accurate: their chances "
                              "may be higher or lower.", scanned)  # fmt: skip
    return " ".join((motion, piece, *([of_scanned] if scanned else [])))


def say_condition(results: Results) -> str:
    """Return for which earthquake and pieces a chance holds, as a part of a sentence, ``for an earthquake like``."""
    if not results.has_simulated:
        return _("by a published formula, as no rocking has been simulated")
    if results.settings.ideal:
        return _("if exactly this motion recurs and every piece is exactly as given")
    dispersion = results.provenance.uncertainty.motion
    motion = _("if exactly this motion recurs")
    if dispersion:
        motion = _("for an earthquake like this one (dispersion {dispersion}, {source})",
                   dispersion=number(dispersion, ".3g"), source=say_source(results))  # fmt: skip
    elif _has_drawn(results):
        motion = _("for earthquakes with the given peaks")
    if not results.provenance.uncertainty.piece:
        return _("{motion} and pieces exactly as given", motion=motion)
    return _("{motion} and pieces that vary in size, centre of gravity and restitution", motion=motion)


def say_source(results: Results) -> str:
    """Return where the dispersion of the motions comes from."""
    shaking, given = results.provenance.shaking, results.building.motion_uncertainty
    if shaking and shaking.scatter == results.provenance.uncertainty.motion != given:
        return _("scatter of ln PGV given the intensity, {sources}", sources=", ".join(shaking.sources))
    if (site := results.provenance.site_ground) and given:
        return _("the root of {own}² + {sigma}²: Motion uncertainty, and the standard deviation of ln {measure} at the "
                 "building", own=number(given, ".3g"), sigma=number(site.dispersion, ".3g"),
                 measure=site.measure)  # fmt: skip
    if site:
        return _("the standard deviation of ln {measure} at the building", measure=site.measure)
    return _("assumed") if given is None else _("as filled in")


def _has_drawn(results: Results) -> bool:
    return any(one.ensemble is not None and one.ensemble.assumed_motion for one in results.motions)


def count_scanned(results: Results) -> int:
    """Return how many pieces have sizes that were measured by a scan."""
    return count_pieces(one for one in results if one.item.sizes_from == SCANNED)


def list_effects(results: Results, rows: Sequence[ItemResult]) -> list[tuple[str, float, float]]:
    """Return what could be otherwise than assumed, with the least and the largest expected falls then.

    Counted are the pieces that the classes count. Where ground and building are drawn, it is what the slower and the
    faster third of the draws give; else what the dispersions of the motion that were tried give.
    """
    counted = [one for one in rows if not one.is_anchored and one.adopted.is_simulated]
    found = [(one.item.quantity, sim) for one in counted if (sim := one.governing.simulation) is not None]
    now, effects = sum(n * sim.probability for n, sim in found), list[tuple[str, float, float]]()

    def add(label: str, ends: Sequence[float]) -> None:
        effects.append((label, min(*ends, now), max(*ends, now)))

    if drawn := [(n, (sim.if_slower, sim.if_faster)) for n, sim in found if None not in (sim.if_slower, sim.if_faster)]:
        held = sum(n * sim.probability for n, sim in found if sim.if_slower is None)
        ends = [held + sum(n * (pair[at] or 0.0) for n, pair in drawn) for at in (0, 1)]
        add(_("ground motion and building: slow or fast for their peak"), ends)
    tried = sorted({at for _n, sim in found for at in sim.tried})
    if tried and not results.settings.ideal:
        low, high = tried[0], tried[-1]
        ends = [sum(n * sim.tried.get(at, sim.probability) for n, sim in found) for at in (low, high)]
        add(_("strength of such an earthquake: dispersion {low} to {high}", low=number(low), high=number(high)), ends)
    if results.size_falls is not None:
        add(_("sizes from the catalogue: bases about 5 % narrower or broader"), results.size_falls)
    return effects


def say_effects(results: Results, rows: Sequence[ItemResult]) -> str:
    """Return what the expected falls would be if it were otherwise than assumed; "" where that is not known."""
    effects = [
        _("{what}: {low} to {high}", what=what, low=words.round_falls(low), high=words.round_falls(high))
        for what, low, high in list_effects(results, rows)
    ]
    said = "; ".join(effects)
    return _("Expected falls if it is otherwise than assumed: {effects}.", effects=said) if effects else ""


BOORE = (
    "Boore D, Stewart J, Seyhan E, Atkinson G (2014). NGA-West2 equations for predicting PGA, PGV, and 5 % damped PSA "
    "for shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M"
)
JAYARAM = (
    "Jayaram N, Baker J (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake "
    "Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922"
)


def _find_draws(results: Results) -> EarthquakeDraws | None:
    """Return how earthquakes were drawn; None where one factor for the building alone was, or none."""
    is_drawn = results.has_simulated and not results.settings.ideal and results.provenance.uncertainty.motion > 0
    return results.provenance.earthquakes if is_drawn else None


def say_draws(results: Results) -> str:
    """Return how the number of a draw depends on the place and on scenarios, in sentences; "" where it does not."""
    draws, texts = _find_draws(results), []
    if draws is None:
        return ""
    if draws.scenarios:
        texts.append(ngettext("A share of {share} of the variance of ε is that of {n:,} scenario of the ground; the "
                              "rest is drawn.",
                              "A share of {share} of the variance of ε is that of {n:,} scenarios of the ground, draw "
                              "by draw in their order; the rest is drawn.", draws.scenarios,
                              share=number(draws.scenario_share, ".2f")))  # fmt: skip
    if not draws.is_city:
        return " ".join(texts)
    if draws.is_placed:
        source = _("as the ShakeMap gives it") if draws.is_shared_given else _("Boore et al. 2014")
        texts.append(_("The draws are those of a city: what is drawn, of ln {measure}, has a part that is common to "
                       "all places, a share of {shared} of its variance ({source}), and one that is correlated with "
                       "that of a place at a distance h by exp(-3h/{range} km) (Jayaram and Baker 2009).",
                       measure=draws.measure, shared=number(draws.shared, ".3f"), source=source,
                       range=number(draws.range_km, "g")))  # fmt: skip
    else:
        texts.append(_("The draws are those of a city, but the building's Latitude and Longitude are not filled in: ε "
                       "is the number that all places have in common, so that buildings without a place are fully "
                       "correlated."))  # fmt: skip
    if results.provenance.suite is None:
        texts.append(_("Motion k has the same random phases in every building, so that sums over buildings vary more "
                       "than they should, not less."))  # fmt: skip
    return " ".join(texts)


def list_references(results: Results) -> list[str]:
    """Return the publications that a run rests on: its methods, intervals, draws and assumed shaking, each once."""
    draws, shaking = _find_draws(results), results.provenance.shaking
    placed = ([JAYARAM] if draws.is_shared_given else [BOORE, JAYARAM]) if draws and draws.is_placed else []
    found = [say_reference(one.reference) for one in results.methods]
    return list(dict.fromkeys([*found, WILSON, *placed, *(shaking.references if shaking else ())]))
