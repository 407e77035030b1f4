"""What the page, the summary and the ranking of a city say in words: sums with their ranges, rows, what is left out."""

from collections.abc import Iterator

from assess.hazard import FAR
from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.motion.ground_scenarios import FAR_CAUTION
from assess.portfolio.city import City, Group, Row
from assess.portfolio.city_spread import Spread
from assess.report import words
from assess.report.say.route import say_state
from assess.risk import RiskClass
from assess.route_results import RouteState

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


def say_range(low: float | None, high: float | None) -> str:
    """Return a range of whole numbers, ``120 to 340``; a dash where nothing was drawn."""
    if low is None or high is None:
        return words.DASH
    return _("{low} to {high}", low=number(low, ",.0f"), high=number(high, ",.0f"))


def say_interval(low: float | None, high: float | None) -> str:
    """Return a range of expected numbers, ``12.0 to 34.5``; a dash where it is not known."""
    if low is None or high is None:
        return words.DASH
    return _("{low} to {high}", low=say_number(low), high=say_number(high))


def name_inventory(inventory: str | None) -> str:
    """Return where the pieces of a building come from."""
    return {
        "surveyed": _("surveyed"),
        "handover": _("handover file (COBie)"),
        "assumed": _("inventory assumed"),
    }.get(inventory or "", words.DASH)


def name_basis(basis: str | None) -> str:
    """Return what the numbers of a building rest on."""
    return {"simulated": _("simulated"), "formula": _("by formula only")}.get(basis or "", words.DASH)


def name_group(group: Group) -> str:
    """Return the name of a group of buildings: where their pieces come from, and what their numbers rest on."""
    heads = {
        "surveyed": _("Surveyed buildings"),
        "handover": _("Buildings from a handover file (COBie)"),
        "assumed": _("Buildings with an assumed inventory"),
    }
    return _("{inventory}, {basis}", inventory=heads[group.inventory], basis=name_basis(group.basis))


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
    parts = (_say_falls(group), _say_cannot_rock(group), _say_people(group), _say_works(group), _say_assumed(group))
    return [text for text in map(" ".join, parts) if text]


def _say_falls(group: Group) -> Iterator[str]:
    spread = group.falls
    yield _("Expected to overturn: {expected} of {counted} free-standing pieces in {buildings}.",
            expected=say_number(spread.expected), counted=say_whole(group.counted),
            buildings=ngettext("{n:,} building", "{n:,} buildings", group.buildings))  # fmt: skip
    if spread.draws:
        yield _say_range_of_draws(group, spread)
    else:
        yield _("No range is known, as nothing was simulated: the formula takes the median of the ground motion and "
                "leaves its uncertainty out.")  # fmt: skip
    apart = []
    if group.unconfirmed:
        apart.append(ngettext("{n:,} unconfirmed", "{n:,} unconfirmed", group.unconfirmed))
    if group.by_formula:
        apart.append(ngettext("{n:,} by formula only", "{n:,} by formula only", group.by_formula))
    if apart:
        yield _("Pieces that could fall as well and are in none of these numbers: {apart}.", apart=", ".join(apart))
    if group.left_out:
        yield ngettext("{n:,} component of the handover files was left out, as its size or place is missing, and is in "
                       "no number.",
                       "{n:,} components of the handover files were left out, as their sizes or places are missing, "
                       "and are in no number.", group.left_out)  # fmt: skip


def _say_range_of_draws(group: Group, spread: Spread) -> str:
    """Return the range of a sum, and what it is over."""
    ends = {"low": say_whole(spread.low), "high": say_whole(spread.high)}
    if group.range_over == "known ground":
        return _("In nine of ten draws, with the motion of the ground taken as known: between {low} and {high}.",
                 **ends)  # fmt: skip
    if group.range_over == "own grounds":
        return _("In nine of ten draws, as if the ground motions of all workbooks were of one earthquake: between "
                 "{low} and {high}.", **ends)  # fmt: skip
    if group.range_over == "motions":
        return _("In nine of ten motions like the given ones, without the uncertainty of the earthquake: between "
                 "{low} and {high}.", **ends)  # fmt: skip
    return _("In nine of ten earthquakes like this one between {low} and {high}.", **ends)


def _say_cannot_rock(group: Group) -> Iterator[str]:
    if group.cannot_rock:
        yield ngettext("{n:,} of the pieces is low as it cannot rock: it is too stocky, or no motion that may be drawn "
                       "can start it.",
                       "{n:,} of the pieces are low as they cannot rock: they are too stocky, or no motion that may be "
                       "drawn can start them.", group.cannot_rock)  # fmt: skip


def _say_people(group: Group) -> Iterator[str]:
    people = group.people
    if not group.occupants and any(group.routes.values()):
        yield _("How many people use the routes is not filled in.")
    if group.people_known:
        yield _("Expected on blocked evacuation routes: {expected} of {occupants} people.",
                expected=say_number(people.expected), occupants=say_whole(group.people_known))  # fmt: skip
    if group.people_known and people.draws:
        yield _say_range_of_draws(group, people)
        if people.apart > 0:
            yield _("Of the people expected on blocked routes, {apart} are in no range: their routes have no joint "
                    "draws.", apart=say_number(people.apart))  # fmt: skip
    if group.people_not_known:
        yield ngettext("{n:,} person is on a route whose state is not known, and is in no number.",
                       "{n:,} people are on routes whose state is not known, and are in no number.",
                       group.people_not_known)  # fmt: skip


def _say_works(group: Group) -> Iterator[str]:
    if not group.works:
        return
    yield ngettext("Fixing the {n:,} piece on the work list avoids {avoided} falls, if the anchors hold.",
                   "Fixing the {n:,} pieces on the work lists avoids {avoided} falls, if the anchors hold.",
                   group.works, avoided=say_number(group.falls_avoided))  # fmt: skip
    if group.cost is not None:
        yield _("Known costs of that work: {cost}, as the workbooks give them, taken as one currency.",
                cost=say_whole(group.cost))  # fmt: skip
    if group.works_without_cost:
        yield ngettext("{n:,} piece on the work lists has no cost.", "{n:,} pieces on the work lists have no cost.",
                       group.works_without_cost)  # fmt: skip


def _say_assumed(group: Group) -> Iterator[str]:
    if group.falls_low_inventory is not None and group.falls_high_inventory is not None:
        yield _("Bookcases and lateral files are assumed from the use and the floor area; other furniture is in no "
                "number. With few pieces everywhere (10 % quantities) {low} falls are expected, with many (90 %) "
                "{high}.",
                low=say_number(group.falls_low_inventory), high=say_number(group.falls_high_inventory))  # fmt: skip


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


def list_cautions(city: City) -> list[str]:
    """Return what a reader has to know before the numbers: what is left out, and what is in none of them."""
    return list(_list_cautions(city))


def _list_cautions(city: City) -> Iterator[str]:
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
    yield from list_setting_cautions(city)
    yield from list_copies(city)
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


def list_setting_cautions(city: City) -> Iterator[str]:
    """Yield what the settings of the run change in every number."""
    if city.settings.scale != 1:
        yield _("The motion of every floor is multiplied by {scale:g}.", scale=city.settings.scale)
    if city.settings.scenario:
        yield _("The motion of every floor follows {scenario}, as the settings ask.", scenario=city.settings.scenario)
    if city.settings.ideal:
        yield _("The uncertainty of the earthquake and of the pieces is left out, as the settings ask.")


def list_copies(city: City) -> Iterator[str]:
    """Yield how many workbooks have the same content as another one: their pieces and people are counted again."""
    copies = int(city.buildings["same_as"].notna().sum())
    if copies:
        yield ngettext("{n:,} workbook has the same content as another; it is counted as a building of its own.",
                       "{n:,} workbooks have the same content as others; each is counted as a building of its own.",
                       copies)  # fmt: skip


# ---------------------------------------------------------------- tables


def list_total_heads() -> list[str]:
    """Return the headings of the table of groups."""
    classes = [words.risk_label(risk) for risk in RiskClass]
    return [_("Buildings by inventory and basis"), _("Buildings"), _("Pieces"), *classes,
            _("unconfirmed or by formula only"), _("anchored"),
            _("Expected falls"), _("5 to 95 % of draws"), _("People on blocked routes"),
            _("People on routes of known state"), _("5 to 95 % of draws"),
            _("People on routes of unknown state")]  # fmt: skip


def list_total_rows(city: City) -> list[list[str]]:
    """Return the table of groups; there is no line of all, as groups are never added up."""
    return [
        [
            name_group(group), say_whole(group.buildings), say_whole(group.pieces),
            *(say_whole(group.by_class[risk]) for risk in RiskClass), say_whole(group.unconfirmed + group.by_formula),
            say_whole(group.anchored), say_number(group.falls.expected), say_range(group.falls.low, group.falls.high),
            say_number(group.people.expected) if group.people_known else words.DASH,
            say_whole(group.people_known) if group.people_known else words.DASH,
            say_range(group.people.low, group.people.high) if group.people_known else words.DASH,
            say_whole(group.people_not_known),
        ]
        for group in city.groups
    ]  # fmt: skip


def say_place(row: Row) -> str:
    """Return the place of a building in degrees; a dash where it is not known."""
    if row["latitude"] is None or row["longitude"] is None:
        return words.DASH
    return f"{number(row['latitude'], '.5f')}, {number(row['longitude'], '.5f')}"


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
    if row["basis"] == "formula" and basis != "formula":
        said = _("{risk} by formula only", risk=words.risk_word(risk))
        return f"{words.BY_FORMULA} {said}"
    upper = _CLASSES.get(row["risk_class_upper"] or "")
    note = f", {words.could_be(words.risk_word(upper))}" if upper is not None and upper > risk else ""
    return f"{words.risk_label(risk)}{note}"


def say_probability(row: Row) -> str:
    """Return a chance with its interval where it has one: ``12.3 % (10.1 to 15.0 %)``.

    Of an anchored piece it is said that it is the chance if it stood free; a route whose state is not known has none,
    as what is missing is left out of it.
    """
    if row.get("state") == RouteState.NOT_KNOWN:
        return words.DASH
    said = words.say_chance(row["probability"], row["probability_low"], row["probability_high"])
    return _("free-standing: {chance}", chance=said) if row.get("is_held") else said


def say_size(row: Row) -> str:
    """Return breadth, width and height [cm], a dash for what is not known."""
    return " × ".join(words.in_cm(row[name]) for name in ("breadth_cm", "width_cm", "height_cm"))


def say_kind(row: Row) -> str:
    """Return what a piece is: its description, else its type."""
    return str(row["description"] or row["type"] or "")


def label_state(state: str | None) -> str:
    """Return the state of a route as sign and words."""
    return say_state(RouteState(state or RouteState.NOT_KNOWN))


def say_severity(severity: str) -> str:
    """Return how grave a problem is."""
    return {"error": _("error"), "warning": _("warning"), "note": _("note")}.get(severity, severity)


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
    """Return the expected people on blocked routes of those on routes that are known; the others next to them.

    A dash where no people are filled in.
    """
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
