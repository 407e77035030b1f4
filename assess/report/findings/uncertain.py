"""What was assumed uncertain, in the words of reports: of the earthquake, of the pieces, and what it changes."""

from collections.abc import Callable, Iterator, Sequence

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.results import ItemResult, Results, Simulation
from assess.risk import RiskClass, classify
from assess.rocking.draws import TRIED


def list_conditions(results: Results) -> list[str]:
    """Return what every page of a report says: a run with --ideal, and one with other motions than the workbook's."""
    texts = []
    if results.settings.ideal and results.has_simulated:
        texts.append(_("Assumed: exactly this motion, and every piece exactly as given (--ideal)"))
    if results.settings.scale != 1:
        texts.append(_("Every floor's motion times {scale} (--scale)", scale=number(results.settings.scale, "g")))
    return texts


def say_assumed(results: Results) -> str:
    """Return what was assumed uncertain, in a sentence or two; "" where nothing was simulated."""
    if not results.has_simulated:
        return ""
    if results.settings.ideal:
        return _("Assumed is that exactly this motion recurs and that every piece is exactly as given: nothing is varied.")
    return f"{_say_motion(results)} {_say_piece(results)}"


def _say_motion(results: Results) -> str:
    dispersion = results.provenance.uncertainty.motion
    if not dispersion:
        return _("The motions are not scaled, as the workbook sets Motion uncertainty to 0: exactly this motion recurs.")
    return _(
        "Chances hold for an earthquake like this one: in each draw the motions of the whole building are scaled by one "
        "factor, with a dispersion of {dispersion} (standard deviation of ln amplitude; {source}).",
        dispersion=number(dispersion, "g"), source=say_source(results),
    )  # fmt: skip


def say_source(results: Results) -> str:
    """Return where the dispersion of the motions comes from."""
    return _("assumed") if results.building.motion_uncertainty is None else _("as filled in")


def _say_piece(results: Results) -> str:
    if not results.provenance.uncertainty.piece:
        return _("Sizes, centre of gravity and restitution are exactly as given.")
    return _("Sizes, centre of gravity and restitution of each piece are varied.")


def say_sensitivity(results: Results, rows: Sequence[ItemResult]) -> str:
    """Return how many simulated pieces would have another class under other assumptions; "" where none was simulated.

    Compared are the classes by the chance under the governing motion: with the dispersion of the motions at each of
    `TRIED`; with `--ideal`, with the uncertainty that was left out.
    """
    found = [(one, one.governing.simulation) for one in rows if not one.is_anchored and one.adopted.is_simulated]
    simulated = [(one, simulation) for one, simulation in found if simulation is not None]
    if not simulated:
        return ""
    if results.settings.ideal:
        changes = _count(simulated, lambda found: found.ideal.probability, lambda found: found.probability)
        return _(
            "In an earthquake like this one (dispersion {dispersion}), {changes}.",
            dispersion=number(results.provenance.uncertainty.motion, "g"), changes=_say_changes(*changes),
        )  # fmt: skip
    return " ".join(_list_tried(results, simulated))


def _list_tried(results: Results, simulated: Sequence[tuple[ItemResult, Simulation]]) -> Iterator[str]:
    for dispersion in TRIED:
        if dispersion != results.provenance.uncertainty.motion:
            changes = _count(simulated, lambda found: found.probability, lambda found, at=dispersion: found.tried[at])
            yield _("With a dispersion of {dispersion}, {changes}.", dispersion=number(dispersion, "g"),
                    changes=_say_changes(*changes))  # fmt: skip


def _count(
    simulated: Sequence[tuple[ItemResult, Simulation]],
    now: Callable[[Simulation], float],
    then: Callable[[Simulation], float],
) -> tuple[int, int]:
    """Return how many pieces would be of a higher and of a lower class."""
    up = down = 0
    for one, found in simulated:
        least = RiskClass.HIGH if one.fell_in_record else RiskClass.LOW
        change = max(_class(then(found)), least) - max(_class(now(found)), least)
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
