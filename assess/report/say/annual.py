"""What is said of chances a year: of pieces, routes and rooms, and what they rest on."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from assess.annual_results import AnnualRow, AnnualTables
from assess.i18n import gettext as _, ngettext, number
from assess.report.say.piece import describe
from assess.results import ItemResult, Results
from assess.text import natural_key

LEAST, MOST = 1e-5, 0.999
"""Chances beyond which no digits are shown [-]."""


class AnnualLine(NamedTuple):
    """One line of a table: its name, what and where it is, its chances, and those of a route if anchors fail."""

    name: str
    what: str
    where: str
    row: AnnualRow
    fail: AnnualRow | None = None


class Annual(NamedTuple):
    """Chances a year, the likeliest first; the first of `paragraphs` is the building's own, or why there are none."""

    paragraphs: Sequence[str]
    pieces: Sequence[AnnualLine]
    routes: Sequence[AnnualLine]
    rooms: Sequence[AnnualLine]


def list_annual(results: Results, rows: Sequence[ItemResult]) -> Annual | None:
    """Return the chances a year; None where the workbook names no hazard file."""
    found, ways = results.annual, results.route_tables
    if found is None:
        return None
    if not found.is_evaluated:
        missing = _("Chances a year were not evaluated: {why}.", why=_(found.missing))
        return Annual((missing,), (), (), ())
    pieces = [
        AnnualLine(one.item.item, describe(one), ", ".join(filter(None, (one.item.floor, one.item.room))),
                   one.item.annual)
        for one in rows if one.item.annual is not None and not one.is_anchored
    ]  # fmt: skip
    routes = [
        AnnualLine(one.route, "", ", ".join(one.floors), one.annual, one.annual_if_anchors_fail)
        for one in ways.routes
        if one.annual
    ]
    rooms = [AnnualLine(one.room, "", one.floor, one.annual) for one in ways.rooms if one.annual]
    for lines in (pieces, routes, rooms):
        lines.sort(key=lambda one: (-one.row.rate, natural_key(one.name)))
    counted = [
        ngettext("{n:,} free-standing piece is counted.", "{n:,} free-standing pieces are counted.", found.pieces)
    ]
    if found.not_evaluated:
        counted.append(ngettext("{n:,} more was not simulated and is not counted.",
                                "{n:,} more were not simulated and are not counted.",
                                found.not_evaluated))  # fmt: skip
    if found.cannot_rock:
        counted.append(ngettext("{n:,} more is too stocky to rock and has no chance here; beside a route it falls by "
                                "the formula.",
                                "{n:,} more are too stocky to rock and have no chance here; beside a route they fall "
                                "by the formula.", found.cannot_rock))  # fmt: skip
    counted += [
        _("Anchored pieces are not counted."),
        _("≥ marks a lower bound: the motions may be too weak, the hazard curve does not reach far enough, pieces of "
          "one row (Quantity) were taken to fall together, or some were not simulated."),
        _("The intervals cover the number of draws only, not what is not known of the hazard."),
    ]  # fmt: skip
    paragraphs = (" ".join(_say_building(found)), " ".join(_say_basis(found, results)), " ".join(counted))
    return Annual(paragraphs, pieces, routes, rooms)


def _say_building(found: AnnualTables) -> Iterator[str]:
    low, high, falls = found.expected_low, found.expected_high, _say_number(found.expected_falls)
    if not found.pieces:
        yield _("There is no free-standing piece that was simulated and can rock.")
    elif found.is_lower_bound:
        yield _("Over all earthquakes that the hazard curve counts, at least {falls} free-standing pieces are expected "
                "to fall a year.", falls=falls)  # fmt: skip
    else:
        text = _("Over all earthquakes that the hazard curve counts, {falls} free-standing pieces are expected to fall "
                 "a year", falls=falls)  # fmt: skip
        if low is not None and high is not None:
            interval = _("95 % sampling interval {low} to {high}", low=_say_number(low), high=_say_number(high))
            text = f"{text} ({interval})"
        yield f"{text}."
    row = found.life_safety
    if row is None:
        yield _("No simulated free-standing piece has the Importance life safety.")
    else:
        yield _("The chance that any piece of the Importance life safety falls is {year} a year, and {years} in 50 "
                "years.", year=say_share(row.chance_a_year, row),
                years=say_share(row.chance_in_50_years, row))  # fmt: skip
    if found.is_lower_bound or (row and row.at_least):
        yield _("Why these are lower bounds is said in the chapter on chances a year.")


def _say_basis(found: AnnualTables, results: Results) -> Iterator[str]:
    yield _("The hazard curve is that of the file {file}, from {first} to {last} g.", file=found.file,
            first=number(found.curve_pga_g[0], ".3g"), last=number(found.curve_pga_g[-1], ".3g"))  # fmt: skip
    if found.latitude is not None and found.longitude is not None:
        place = _("Its site is at {lat:.3f} north, {lon:.3f} east", lat=found.latitude, lon=found.longitude)
        if found.distance_km is not None:
            far = _("{km:.1f} km from the building", km=found.distance_km)
            place = f"{place}, {far}"
        yield f"{place}."
    yield ngettext("Every piece that can rock was rocked in {n:,} draw under the motions of the simulation times each "
                   "of {levels} factors, from {first} to {last}: the motions of all floors were taken to grow in "
                   "proportion to the ground PGA, which is {ground:.3g} g in this scenario. Damage to the building, "
                   "which changes how its floors move, is left out.",
                   "Every piece that can rock was rocked in {n:,} draws under the motions of the simulation times each "
                   "of {levels} factors, from {first} to {last}: the motions of all floors were taken to grow in "
                   "proportion to the ground PGA, which is {ground:.3g} g in this scenario. Damage to the building, "
                   "which changes how its floors move, is left out.", found.runs, levels=len(found.factors),
                   first=_say_number(found.factors[0]), last=_say_number(found.factors[-1]),
                   ground=found.ground_pga_g or 0.0)  # fmt: skip
    scatter = (
        _("At a given ground PGA the motions of the floors scatter, with the logarithmic standard deviation of "
          "{beta:.2g} of the workbook.", beta=found.motion_dispersion)
        if results.building.motion_uncertainty else
        _("At a given ground PGA the motions of the floors scatter, with a logarithmic standard deviation of "
          "{beta:.2g}, which is assumed, also where the scenario is taken as exactly known.",
          beta=found.motion_dispersion)
    )  # fmt: skip
    yield scatter
    yield _("The shares that fall were integrated over the curve by the lognormal that fits them, or as a table where "
            "that misses a share by more than 0.05.")  # fmt: skip


def say_share(value: float, row: AnnualRow) -> str:
    """Return a chance with two significant digits; lower bounds are marked."""
    mark = "≥ " if row.at_least else ""
    if value < LEAST and row.at_least:
        return _("not known")
    if value == 0:
        return "0 %"
    if value < LEAST:
        return f"< {number(100 * LEAST, '.3f')} %"
    if value > MOST:
        return f"> {number(100 * MOST, '.1f')} %"
    decimals = 1 if value >= 0.01 else 2 if value >= 0.001 else 3
    return f"{mark}{number(100 * value, f'.{decimals}f')} %"


def _say_number(value: float) -> str:
    """Return a number with two significant digits, without an exponent."""
    rounded = float(f"{value:.2g}")
    if rounded == 0 or rounded >= 10:
        return number(rounded, ",.0f")
    return number(rounded, f".{1 - math.floor(math.log10(rounded))}f")
