"""What was assumed uncertain, in the words of reports: of the earthquake, of the pieces, and what it changes."""

from collections.abc import Iterable, Iterator, Sequence

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.model import SCANNED
from assess.report import words
from assess.report.findings.ground_source import name_source, say_dispersion
from assess.results import ItemResult, Results, Simulation
from assess.risk import RiskClass, classify

NAMED = 4
"""Pieces that are named on every page."""


def list_conditions(results: Results) -> list[str]:
    """Return what every page of a report says: source of the ground motion, nothing varied, motions times a factor."""
    texts = []
    if shaking := results.provenance.shaking:
        texts.append(_("Assumed shaking: {intensity}", intensity=_(shaking.choice)))
    if site := results.provenance.site_ground:
        texts.append(_("Ground motion: {source}", source=name_source(site)))
    if results.settings.ideal and results.has_simulated:
        texts.append(_("Assumed: exactly this motion, and every piece exactly as given"))
    if results.settings.scale != 1:
        texts.append(_("Every floor's motion times {scale}", scale=number(results.settings.scale, "g")))
    if results.settings.anchor:
        texts.append(_say_anchored(results))
    return texts


def _say_anchored(results: Results) -> str:
    wanted = results.settings.anchor
    if isinstance(wanted, int):
        return ngettext(
            "Taken as anchored and holding: the first entry of what to fix",
            "Taken as anchored and holding: the first {n:,} entries of what to fix",
            wanted,
        )
    return _("Taken as anchored and holding: {items}", items=words.name_pieces(wanted, NAMED, 40))


def say_assumed(results: Results) -> str:
    """Return what was assumed uncertain, in a sentence or two; "" where nothing was simulated."""
    if not results.has_simulated:
        return ""
    if results.settings.ideal:
        return _(
            "It is assumed that exactly this motion recurs and that every piece is exactly as given: nothing is varied."
        )
    return f"{_say_motion(results)} {_say_piece(results)}"


def say_condition(results: Results) -> str:
    """Return for which earthquake and pieces a chance holds, as a part of a sentence, ``for an earthquake like``."""
    if not results.has_simulated:
        return _("by a published formula, as no rocking has been simulated")
    if results.settings.ideal:
        return _("if exactly this motion recurs and every piece is exactly as given")
    dispersion = results.provenance.uncertainty.motion
    motion = _("if exactly this motion recurs")
    if not dispersion and has_drawn(results):
        motion = _("for earthquakes with the given peaks")
    if dispersion:
        motion = _(
            "for an earthquake like this one (dispersion {dispersion}, {source})",
            dispersion=number(dispersion, ".3g"), source=say_source(results),
        )  # fmt: skip
    if not results.provenance.uncertainty.piece:
        return _("{motion} and pieces exactly as given", motion=motion)
    return _("{motion} and pieces that vary in size, centre of gravity and restitution", motion=motion)


def _say_motion(results: Results) -> str:
    dispersion = results.provenance.uncertainty.motion
    if not dispersion and not has_drawn(results):
        return _("The motions are not scaled, as Motion uncertainty is 0 in the workbook: exactly this motion recurs.")
    if not dispersion:
        return _("Chances hold for earthquakes with the given peaks: ground motions and buildings are drawn.")
    return _(
        "Chances hold for an earthquake like this one: each draw scales the motions of the whole building by one "
        "factor, with a dispersion of {dispersion} (standard deviation of ln amplitude; {source}).",
        dispersion=number(dispersion, ".3g"), source=say_source(results),
    )  # fmt: skip


def say_source(results: Results) -> str:
    """Return where the dispersion of the motions comes from."""
    shaking, given = results.provenance.shaking, results.building.motion_uncertainty
    if shaking and shaking.scatter == results.provenance.uncertainty.motion != given:
        return _("scatter of ln PGV given the intensity, {sources}", sources=", ".join(shaking.sources))
    if site := results.provenance.site_ground:
        return say_dispersion(site)
    return _("assumed") if results.building.motion_uncertainty is None else _("as filled in")


def has_drawn(results: Results) -> bool:
    """Return whether pieces were simulated under drawn motions: ground motion and building are assumed."""
    return any(one.ensemble is not None and one.ensemble.assumed_motion for one in results.motions)


def _say_piece(results: Results) -> str:
    scanned = count_scanned(results)
    if not results.provenance.uncertainty.piece:
        given = _("Sizes, centre of gravity and restitution are exactly as given.")
        return given if not scanned else f"{given} {_say_scanned_as_given(scanned)}"
    varied = _("Sizes, centre of gravity and restitution of each piece are varied.")
    return varied if not scanned else f"{varied} {_say_scanned(scanned)}"


def count_scanned(results: Results) -> int:
    """Return how many pieces have sizes that were measured by a scan."""
    return sum(one.item.quantity for one in results if one.item.sizes_from == SCANNED)


def _say_scanned(scanned: int) -> str:
    return ngettext(
        "Those of {n:,} piece were measured by a scan, which is less accurate: its sizes are varied more.",
        "Those of {n:,} pieces were measured by a scan, which is less accurate: their sizes are varied more.",
        scanned,
    )


def _say_scanned_as_given(scanned: int) -> str:
    return ngettext(
        "Those of {n:,} piece were measured by a scan, which is less accurate: its chance may be higher or lower.",
        "Those of {n:,} pieces were measured by a scan, which is less accurate: their chances may be higher or lower.",
        scanned,
    )


def say_sensitivity(results: Results, rows: Sequence[ItemResult]) -> str:
    """Return how many simulated pieces would have another class under other assumptions; "" where none was simulated.

    Compared are the classes by the chance under the governing motion: with each other dispersion of the motions that
    was tried; where uncertainty was left out (`Settings.ideal`), with it.
    """
    counted = [one for one in rows if not one.is_anchored and one.adopted.is_simulated]
    simulated = [(one, found) for one in counted if (found := one.governing.simulation) is not None]
    if not results.settings.ideal:
        simulated = [(one, found) for one, found in simulated if found.tried]  # what is drawn scatters by itself
    if not simulated:
        return ""
    if results.settings.ideal:
        changes = _count((one, found.ideal.probability, found.probability) for one, found in simulated if found.ideal)
        return _(
            "In an earthquake like this one (dispersion {dispersion}), {changes}.",
            dispersion=number(results.provenance.uncertainty.motion, ".3g"), changes=_say_changes(*changes),
        )  # fmt: skip
    return " ".join(_list_tried(results, simulated))


def _list_tried(results: Results, simulated: Sequence[tuple[ItemResult, Simulation]]) -> Iterator[str]:
    """Yield what other dispersions would change; none below the scatter that a published relation gives."""
    assumed, site = results.provenance.shaking, results.provenance.site_ground
    least = assumed.scatter if assumed else site.dispersion if site else 0.0
    for dispersion in simulated[0][1].tried:
        if dispersion >= least and dispersion != results.provenance.uncertainty.motion:
            changes = _count((one, found.probability, found.tried[dispersion]) for one, found in simulated)
            yield _("With a dispersion of {dispersion}, {changes}.", dispersion=number(dispersion, ".3g"),
                    changes=_say_changes(*changes))  # fmt: skip


def _count(changes: Iterable[tuple[ItemResult, float, float]]) -> tuple[int, int]:
    """Return how many pieces would be of a higher and of a lower class, of rows with their chance now and then."""
    up = down = 0
    for one, now, then in changes:
        least = RiskClass.HIGH if one.fell_in_record else RiskClass.LOW
        change = max(_class(then), least) - max(_class(now), least)
        up += one.item.quantity * (change > 0)
        down += one.item.quantity * (change < 0)
    return up, down


def _class(probability: float) -> RiskClass:
    return classify(probability) or RiskClass.LOW


def _say_changes(up: int, down: int) -> str:
    if not up and not down:
        return _("no piece would change class")
    higher = ngettext("{n:,} piece would be in a higher class", "{n:,} pieces would be in a higher class", up)
    lower = ngettext("{n:,} piece would be in a lower class", "{n:,} pieces would be in a lower class", down)
    if up and down:
        return _("{higher} and {lower}", higher=higher, lower=lower)
    return higher if up else lower
