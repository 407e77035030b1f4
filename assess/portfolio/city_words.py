"""What the outputs of a city say in words: sums with their ranges, rows, what is left out, how numbers were made."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import PurePath

from assess.hazard import FAR
from assess.i18n import Text, fill, gettext as _, ngettext, number
from assess.methods import adopted_formula
from assess.motion.ground_scenarios import FAR_CAUTION
from assess.motion.spatial_field import SCATTERS, Measure
from assess.portfolio.city import PEOPLE_RULE, City, Group, Row, Spread
from assess.report import words
from assess.report.provenance import say_reference
from assess.report.say.route import say_state
from assess.results import ROLLS
from assess.risk import LIMITS, RiskClass
from assess.route_results import BLOCKED_FROM, RouteState
from assess.text import plain_text
from assess.version import __version__

REFERENCES = (
    "Jayaram N, Baker JW (2009). Correlation model for spatially distributed ground-motion intensities. Earthquake "
    "Engineering and Structural Dynamics 38(15):1687-1708. doi:10.1002/eqe.922",
    "Boore DM, Stewart JP, Seyhan E, Atkinson GM (2014). NGA-West2 equations for predicting PGA, PGV, and 5% damped "
    "PSA for shallow crustal earthquakes. Earthquake Spectra 30(3):1057-1085. doi:10.1193/070113EQS184M",
)
"""Sources of the draws of an earthquake that differ from place to place; named where anything was drawn."""
P58 = (
    "FEMA (2018). Seismic performance assessment of buildings, FEMA P-58, second edition, volume 1: normative "
    "quantities of components by occupancy. Federal Emergency Management Agency"
)
"""Source of assumed inventories."""
_CLASSES = {risk.word: risk for risk in RiskClass}


def say_number(value: float | None) -> str:
    """Return a sum as people read it: whole from 100, else with one decimal; a small one that is not 0 is no 0."""
    if value is None or value != value:
        return words.DASH
    if 0 < value < 0.05:
        return _("below {limit:.2f}", limit=0.05)
    return number(value, ",.0f" if abs(value) >= 100 else ",.1f")


def say_whole(value: float | None) -> str:
    """Return a whole number with its thousands marked."""
    return words.DASH if value is None else number(value, ",.0f")


def say_range(low: float | None, high: float | None, say: Callable[[float], str] = say_whole) -> str:
    """Return a range of numbers, ``120 to 340``; a dash where nothing was drawn."""
    return words.DASH if low is None or high is None else _("{low} to {high}", low=say(low), high=say(high))


_NAMES: Mapping[str, Text] = {
    "surveyed": fill("surveyed"), "handover": fill("handover file (COBie)"), "assumed": fill("inventory assumed"),
    "simulated": fill("simulated"), "formula": fill("by formula only"),
    "error": fill("error"), "warning": fill("warning"), "note": fill("note"),
}  # fmt: skip


def name(word: str | None) -> str:
    """Return an inventory, a basis or a severity as people read it; a dash where it is not known."""
    return _(_NAMES[word]) if word and word in _NAMES else word or words.DASH


def name_group(group: Group) -> str:
    """Return the name of a group of buildings: where their pieces come from, and what their numbers rest on."""
    heads = {
        "surveyed": _("Surveyed buildings"),
        "handover": _("Buildings from a handover file (COBie)"),
        "assumed": _("Buildings with an assumed inventory"),
    }
    return _("{inventory}, {basis}", inventory=heads[group.inventory], basis=name(group.basis))


def say_title(city: City) -> str:
    """Return the title: how many buildings were assessed, and whether they are made up."""
    listed = len(city.ranked)
    n = listed - len(city.skipped)
    if n < listed:
        return _("Furniture in an earthquake: {n:,} of {listed:,} buildings", n=n, listed=listed)
    if city.is_made_up:
        return ngettext("Furniture in an earthquake: {n:,} made-up building",
                        "Furniture in an earthquake: {n:,} made-up buildings", n)  # fmt: skip
    return ngettext("Furniture in an earthquake: {n:,} building", "Furniture in an earthquake: {n:,} buildings", n)


def say_ground(city: City) -> str:
    """Return in one sentence what earthquake it is."""
    if city.ground is None:
        return _("Every building has the ground motion of its own workbook or index row: they are not under one "
                 "earthquake.")  # fmt: skip
    if city.ground.kind == "shakemap":
        return _("Ground motion: the ShakeMap {file}.", file=city.ground.file)
    return _("Ground motion: the scenarios of {file}.", file=city.ground.file)


def list_facts(city: City) -> list[tuple[str, str]]:
    """Return what is to be known of the ground motion, as label and value."""
    return [(_(label), _(value)) for label, value in city.ground.facts] if city.ground else []


# ---------------------------------------------------------------- the answer


def list_group_lines(group: Group) -> list[str]:
    """Return the answer of one group, a paragraph each: falls, people, what fixing helps with its cost, assumptions."""
    lines = [" ".join(_say_falls(group))]
    if group.cannot_rock:
        lines.append(ngettext(
            "{n:,} of the pieces is low as it cannot rock: it is too stocky, or no motion that may be drawn can start "
            "it.",
            "{n:,} of the pieces are low as they cannot rock: they are too stocky, or no motion that may be drawn can "
            "start them.", group.cannot_rock,
        ))  # fmt: skip
    if people := " ".join(_say_people(group)):
        lines.append(people)
    if group.works:
        works = [ngettext("Fixing the {n:,} piece on the work list avoids {avoided} falls, if the anchors hold.",
                          "Fixing the {n:,} pieces on the work lists avoids {avoided} falls, if the anchors hold.",
                          group.works, avoided=say_number(group.falls_avoided))]  # fmt: skip
        if group.cost is not None:
            works.append(_("Known costs of that work: {cost}, as the workbooks give them, taken as one currency.",
                           cost=say_whole(group.cost)))  # fmt: skip
        if group.works_without_cost:
            works.append(ngettext(
                "{n:,} piece on the work lists has no cost.", "{n:,} pieces on the work lists have no cost.",
                group.works_without_cost,
            ))  # fmt: skip
        lines.append(" ".join(works))
    if group.falls_low_inventory is not None and group.falls_high_inventory is not None:
        lines.append(_(
            "Bookcases and lateral files are assumed from the use and the floor area; other furniture is in no number. "
            "With few pieces everywhere (10 % quantities) {low} falls are expected, with many (90 %) {high}.",
            low=say_number(group.falls_low_inventory), high=say_number(group.falls_high_inventory),
        ))  # fmt: skip
    return lines


def _say_falls(group: Group) -> Iterator[str]:
    spread = group.falls
    yield _("Expected to overturn: {expected} of {counted} free-standing pieces in {buildings}.",
            expected=say_number(spread.expected), counted=say_whole(group.counted),
            buildings=ngettext("{n:,} building", "{n:,} buildings", group.buildings))  # fmt: skip
    if spread.draws:
        yield _(group.range_over.template, low=say_whole(spread.low), high=say_whole(spread.high))
    else:
        yield _("No range is known, as nothing was simulated: the formula takes the median of the ground motion and "
                "leaves its uncertainty out.")  # fmt: skip
    apart = []
    if group.unconfirmed:
        apart.append(ngettext("{n:,} unconfirmed", "{n:,} unconfirmed", group.unconfirmed))
    if group.by_formula:
        apart.append(ngettext("{n:,} by formula only", "{n:,} by formula only", group.by_formula))
    if group.rolls:
        apart.append(ngettext("{n:,} on castors", "{n:,} on castors", group.rolls))
    if apart:
        yield _("Pieces that could fall as well and are in none of these numbers: {apart}.", apart=", ".join(apart))
    if group.left_out:
        yield ngettext("{n:,} component of the handover files was left out, as its size or place is missing, and is in "
                       "no number.",
                       "{n:,} components of the handover files were left out, as their sizes or places are missing, "
                       "and are in no number.", group.left_out)  # fmt: skip


def _say_people(group: Group) -> Iterator[str]:
    people = group.people
    if not group.occupants and any(group.routes.values()):
        yield _("How many people use the routes is not filled in.")
    if group.people_known:
        yield _("Expected on blocked evacuation routes: {expected} of {occupants} people.",
                expected=say_number(people.expected), occupants=say_whole(group.people_known))  # fmt: skip
    if group.people_known and people.draws:
        yield _(group.range_over.template, low=say_whole(people.low), high=say_whole(people.high))
        if people.apart > 0:
            yield _("Of the people expected on blocked routes, {apart} are in no range: their routes have no joint "
                    "draws.", apart=say_number(people.apart))  # fmt: skip
    if group.people_not_known:
        yield ngettext("{n:,} person is on a route whose state is not known, and is in no number.",
                       "{n:,} people are on routes whose state is not known, and are in no number.",
                       group.people_not_known)  # fmt: skip


def say_nothing(group: Group) -> str:
    """Return what is said of a group none of whose pieces and routes is expected to fail."""
    parts = [_("No fall and no blocked route is expected.")]
    spread = group.falls
    if spread.draws:
        parts = [ngettext("No fall was seen in {n:,} draw.", "No fall was seen in {n:,} draws.", spread.draws)]
        if spread.sampling_high:
            parts.append(_("An expected number of up to {high} falls would agree with that (sampling interval).",
                           high=say_number(spread.sampling_high)))  # fmt: skip
    if n := group.routes[RouteState.NOT_KNOWN]:
        parts.append(ngettext("The state of {n:,} route is not known.", "The state of {n:,} routes is not known.", n))
    return " ".join(parts)


# ---------------------------------------------------------------- what is not in it


def list_cautions(city: City) -> Iterator[str]:
    """Yield what a reader has to know before the numbers: what is left out, and what is in none of them."""
    if city.is_made_up:
        yield _("All buildings are made up: their places, furniture, routes, people and costs are random numbers.")
    yield from list_ground_cautions(city)
    if city.skipped:
        yield ngettext("{n:,} building could not be assessed and is in no number: see the list of skipped buildings.",
                       "{n:,} buildings could not be assessed and are in no number: see the list of skipped buildings.",
                       len(city.skipped))  # fmt: skip
    if len(city.groups) > 1:
        yield _("Surveyed, handed-over and assumed inventories, and simulated and formula results, are not added up: "
                "their uncertainties differ.")  # fmt: skip
    if city.settings.scale != 1:
        yield _("The motion of every floor is multiplied by {scale:g}.", scale=city.settings.scale)
    if city.settings.scenario:
        yield _("The motion of every floor follows {scenario}, as the settings ask.", scenario=city.settings.scenario)
    if city.settings.ideal:
        yield _("The uncertainty of the earthquake and of the pieces is left out, as the settings ask.")
    if copies := int(city.buildings["same_as"].notna().sum()):
        yield ngettext("{n:,} workbook has the same content as another; it is counted as a building of its own.",
                       "{n:,} workbooks have the same content as others; each is counted as a building of its own.",
                       copies)  # fmt: skip
    if own := sum(group.own_motions for group in city.groups):
        yield ngettext("{n:,} building has floors with a record or a PFA of their own, which may not be of this "
                       "earthquake; its falls are in the sums.",
                       "{n:,} buildings have floors with a record or a PFA of their own, which may not be of this "
                       "earthquake; their falls are in the sums.", own)  # fmt: skip
    if unplaced := sum(group.unplaced for group in city.groups):
        yield ngettext("{n:,} building has no Latitude and Longitude: it is not on the map.",
                       "{n:,} buildings have no Latitude and Longitude: they are not on the map, and their draws are "
                       "fully correlated with each other, which widens the ranges.", unplaced)  # fmt: skip


def list_ground_cautions(city: City) -> Iterator[str]:
    """Yield what holds for the ground motion of all buildings, and how many are far from the sites of its scenarios."""
    common = city.ground.cautions if city.ground else ()
    for text in (_(caution) for caution in common if caution.template != FAR_CAUTION):  # counted below
        yield f"{text[:1].upper()}{text[1:]}."
    distances = city.buildings["ground_distance_km"].dropna().astype("float64")
    far = distances[distances > FAR / 1000]
    if len(far):
        yield ngettext(
            "{n:,} building is farther than {limit} km from the nearest site of the scenarios, {most} km: its ground "
            "motion is that of another place.",
            "{n:,} buildings are farther than {limit} km from the nearest site of the scenarios, {most} km at most: "
            "their ground motion is that of another place.",
            len(far), limit=number(FAR / 1000, "g"), most=number(float(far.max()), ".0f"),
        )  # fmt: skip


# ---------------------------------------------------------------- rows


def label_piece(row: Row, basis: str | None) -> str:
    """Return the class of a piece as sign and words.

    `basis` is that of its building: where this is simulated, a piece that was not stands outside the classes.
    """
    risk = _CLASSES.get(row["risk_class"] or "")
    if row["is_held"]:
        said = _("anchored")
        return f"{words.ANCHORED} {said}"
    if risk is None:
        return words.DASH
    if row["basis"] == "unconfirmed":
        said = _("unconfirmed ({risk})", risk=words.risk_word(risk))
        return f"{words.UNCONFIRMED} {said}"
    if row["basis"] == ROLLS:
        return f"{words.ROLLING} {words.say_apart(risk, ROLLS, has_simulated=True)}"
    if row["basis"] == "formula" and basis != "formula":
        said = _("{risk} by formula only", risk=words.risk_word(risk))
        return f"{words.BY_FORMULA} {said}"
    upper = _CLASSES.get(row["risk_class_upper"] or "")
    note = f", {words.could_be(words.risk_word(upper))}" if upper is not None and upper > risk else ""
    return f"{words.risk_label(risk)}{note}"


def say_probability(row: Row) -> str:
    """Return a chance with its interval where it has one: ``12.3 % (10.1 to 15.0 %)``.

    That of an anchored piece is the one if it stood free; a route whose state is not known has none.
    """
    if row.get("state") == RouteState.NOT_KNOWN:
        return words.DASH
    said = words.say_chance(row["probability"], row["probability_low"], row["probability_high"])
    return _("free-standing: {chance}", chance=said) if row.get("is_held") else said


def say_size(row: Row) -> str:
    """Return breadth, width and height [cm], a dash for what is not known."""
    return " × ".join(words.in_cm(row[name]) for name in ("breadth_cm", "width_cm", "height_cm"))


def label_state(state: str | None) -> str:
    """Return the state of a route as sign and words."""
    return say_state(RouteState(state or RouteState.NOT_KNOWN))


def say_spot(row: Row) -> str:
    """Return where a problem is: sheet and cell."""
    return " ".join(str(row[name]) for name in ("sheet", "cell") if row[name])


def say_falls(row: Row) -> str:
    """Return the expected falls of a building, with the pieces that could fall as well and are not in them."""
    apart = [
        *([_("{pieces} unconfirmed", pieces=say_whole(row["unconfirmed"]))] if row["unconfirmed"] else []),
        *([_("{pieces} by formula only", pieces=say_whole(row["by_formula"]))] if row["by_formula"] else []),
        *([_("{pieces} left out of the COBie file", pieces=say_whole(row["left_out"]))] if row["left_out"] else []),
    ]
    expected = say_number(row["expected_falls"])
    return _("{falls} and up to {apart}", falls=expected, apart=", ".join(apart)) if apart else expected


def say_people(row: Row) -> str:
    """Return the expected people on blocked routes of those on known ones, and the others; a dash without people."""
    occupants, missing = row["occupants"], row["people_not_known"] or 0
    if not occupants:
        return words.DASH
    if missing >= occupants:
        return _("not known: {people} on routes not known", people=say_whole(missing))
    expected = say_number(row["people_blocked"])
    said = _("{people} of {occupants}", people=expected, occupants=say_whole(occupants - missing))
    return said + (_("; {people} on routes not known", people=say_whole(missing)) if missing else "")


def say_blocked(row: Row) -> str:
    """Return how many routes are blocked, and how many are not known; a dash where there are no routes."""
    missing = row["routes_not_known"] or 0
    if not row["routes"]:
        return words.DASH
    if missing >= row["routes"]:
        return _("not known")
    return say_whole(row["routes_blocked"]) + (_("; {routes} not known", routes=say_whole(missing)) if missing else "")


def mark_own_motions(text: str, row: Row) -> str:
    """Return a text with the mark of a building of which floors keep motions that may not be of this earthquake."""
    return _("{text} (floors with motions of their own)", text=text) if row["own_motions"] else text


def name_skipped(building: str | None, path: str) -> str:
    """Return the name of a building that was skipped, with its file where this differs; else its file alone."""
    return path if not building or building == path else f"{building} ({path})"


def explain_skipped(city: City, path: str) -> str:
    """Return the first problem of a building that could not be assessed, with how to fix it; "" where none is known."""
    problems = city.problems_of.get(path)
    if not problems:
        return ""
    first = problems[0]
    place = "!".join(one for one in (first["sheet"], first["cell"]) if one)
    said = " ".join(first[name] for name in ("message", "fix") if first[name])
    file = f"{plain_text(PurePath(path).name)} "
    said = f"it {said.removeprefix(file)}" if said.startswith(file) else said  # the path stands before it
    return f"{place}: {said}" if place else said[:1].upper() + said[1:]


# ---------------------------------------------------------------- how the numbers were made


def list_basis(city: City) -> list[tuple[str, str]]:
    """Return what the numbers rest on, as label and value: the ground motion, then the settings of the run."""
    settings, found = city.settings, list_facts(city)
    if city.ground is not None:
        found.append((_("SHA-256 of {file}", file=city.ground.file), city.ground.sha256))
    simulated = {"all": _("all pieces"), "high": _("pieces of high risk, doubtful, or on routes"), "none": _("none")}
    found.append((_("Simulated"), simulated[settings.verify]))
    if settings.verify != "none":
        found.append((_("Draws, seed"), f"{say_whole(int(settings.runs))}, {settings.seed}"))
    if settings.scenario:
        found.append((_("Motion of the floors"), settings.scenario))
    if settings.class_by:
        found.append((_("Class by"), _(settings.class_by)))
    if settings.scale != 1:
        found.append((_("Factor on all motions"), number(settings.scale, "g")))
    found.append((_("Limit on the chance that a route is blocked"), words.percent(settings.route_risk)))
    found.append((_("Program"), f"assess {__version__}"))
    return found


def list_method(city: City) -> Iterator[str]:
    """Yield how the numbers were made, in short paragraphs."""
    yield _("Every percentage and every expected number is for this scenario, not per year. Classes by the chance of "
            "overturning: low below {low}, medium below {medium}, high below {high}, very high above.",
            low=_share(LIMITS[0]), medium=_share(LIMITS[1]), high=_share(LIMITS[2]))  # fmt: skip
    group = next((group for group in city.groups if group.falls.draws), None)
    if group is not None:
        drawn = group.falls
        yield _say_draws(city, drawn)
        alone, together = say_range(drawn.independent_low, drawn.independent_high), say_range(drawn.low, drawn.high)
        if group.buildings > 1 and alone != together:
            yield _("If every building had an earthquake of its own, the range would be {alone} in place of {together}"
                    ": that is not so, and the difference shows why ranges of buildings must not be added up.",
                    alone=alone, together=together)  # fmt: skip
        yield _("The expected number itself is known within the sampling interval, by the number of draws alone "
                "(95 %): {interval}.",
                interval=say_range(drawn.sampling_low, drawn.sampling_high, say_number))  # fmt: skip
    drawn_motions = city.buildings["motion_uncertainty"].dropna().astype("float64")
    if city.ground is not None and not drawn_motions.empty:
        low, high = (number(float(end), ".2f") for end in (drawn_motions.min(), drawn_motions.max()))
        yield _("The standard deviation of ln amplitude that is drawn is √(β² + σ²): β the Motion uncertainty of the "
                "workbook, 0 where that is blank, σ that of the ground motion at the building. It is {low} to {high}.",
                low=low, high=high)  # fmt: skip
    if any(sum(group.routes.values()) for group in city.groups):
        yield _("A route is open where the upper end of its chance of being blocked is below {limit} and every piece "
                "that matters is known, doubtful below {blocked}, blocked from {blocked} on, and not known where "
                "something missing could change its state.",
                limit=words.percent(city.settings.route_risk), blocked=_share(BLOCKED_FROM))  # fmt: skip
        if any(group.occupants for group in city.groups):
            yield _(PEOPLE_RULE)
    if any(group.basis == "formula" for group in city.groups):
        formula = adopted_formula(city.settings.class_by)
        yield _("Results by formula only are chances by {formula}, under the median of the ground motion; nothing was "
                "simulated, so that no range is given.", formula=_(formula.title))  # fmt: skip
    if any(group.inventory == "assumed" for group in city.groups):
        yield _("Assumed inventories: pieces by use and floor area from the normative quantities of FEMA P-58; low, "
                "median and high are its 10, 50 and 90 % quantities. No piece of them has been seen.")  # fmt: skip


def _say_draws(city: City, drawn: Spread) -> str:
    ends = _("The range from 5 to 95 % of the draws is that of the sum over buildings, draw by draw.")
    if city.settings.ideal:
        start = _("Each of the {draws:,} draws is one motion of each floor, without the uncertainty of the earthquake.",
                  draws=drawn.draws)  # fmt: skip
    elif city.ground is not None and city.ground.is_known:
        start = _("The motion of the ground is taken as known. Each of the {draws:,} draws varies the buildings' own "
                  "motions alone.", draws=drawn.draws)  # fmt: skip
    elif city.ground is not None and city.ground.kind == "scenarios":
        start = _("Each of the {draws:,} draws takes one of the computed scenarios, the same for all buildings. The "
                  "uncertainty of the buildings' own motions is drawn besides.", draws=drawn.draws)  # fmt: skip
    else:
        start = _("Each of the {draws:,} draws is one earthquake for all buildings.", draws=drawn.draws)
    if city.settings.ideal:
        return f"{start} {ends}"
    measure: Measure = "PGV" if city.buildings["ground_pgv_cm_s"].notna().any() else "PGA"
    places = _(
        "Of the variance of ln {measure} that is drawn, {shared} is common to all buildings (Boore et al. 2014) unless "
        "the ShakeMap gives that share itself; the rest differs from place to place, with the correlation "
        "exp(-3 h / {range:g} km) at the distance h (Jayaram and Baker 2009).",
        measure=measure, shared=_share(SCATTERS[measure].shared), range=SCATTERS[measure].range_km,
    )  # fmt: skip
    return f"{start} {places} {ends}"


def _share(value: float) -> str:
    return f"{number(100 * value, '.0f')} %"


def list_references(city: City) -> list[str]:
    """Return the publications that the numbers rest on."""
    drawn = any(group.falls.draws for group in city.groups) and not city.settings.ideal
    by_formula = any(group.basis == "formula" or group.by_formula for group in city.groups)
    assumed = any(group.inventory == "assumed" for group in city.groups)
    formula = say_reference(adopted_formula(city.settings.class_by).reference)
    return [*((formula,) if by_formula else ()), *(REFERENCES if drawn else ()), *((P58,) if assumed else ())]
