"""Which earthquake draw k is for a building: by its place in a city, and by scenarios that were computed elsewhere."""

from collections.abc import Mapping

from assess.errors import InputError
from assess.i18n import fill, join
from assess.model import Inventory
from assess.motion.spatial_field import SCATTERS, Measure
from assess.pipeline.known_ground import find_ground
from assess.rocking.draws import Earthquakes, name_number
from assess.settings import AUTO, RUNS, Settings

MOST_DRAWS = 5000
"""Draws that scenarios may ask for at most."""


def find_earthquakes(inventory: Inventory, settings: Settings) -> Earthquakes:
    """Return by which numbers the draws of an earthquake scale the motions of a building.

    In a city draws differ from place to place; a building whose place is not known takes the common part alone.
    Scenarios carry the part of the variance that is not the building's own.
    """
    ground, own = inventory.site_ground, inventory.building.own_dispersion
    measure: Measure = "PGA" if find_ground(inventory).pgv is None else "PGV"
    spread = 0.0 if ground is None else ground.dispersion
    given_share = spread**2 / (own**2 + spread**2) if spread else 0.0
    shared = SCATTERS[measure].shared if ground is None or ground.shared is None else ground.shared
    return Earthquakes(
        place=_find_place(inventory, settings), shared=shared, measure=measure,
        given=() if ground is None or not given_share else ground.scenarios,
        given_share=0.0 if ground is None or not ground.scenarios else given_share,
    )  # fmt: skip


def _find_place(inventory: Inventory, settings: Settings) -> tuple[float, float] | None:
    latitude, longitude = inventory.building.latitude, inventory.building.longitude
    return None if latitude is None or longitude is None or not settings.city else (latitude, longitude)


def number_pieces(inventory: Inventory, settings: Settings) -> Mapping[str, int]:
    """Return by item the number by which it draws: in a city pieces of different places draw independently."""
    place = _find_place(inventory, settings)
    before = "" if place is None else f"{place[0]:.6f} {place[1]:.6f} "
    return {item.item: name_number(f"{before}{item.item}") for item in inventory.items}


def number_building(inventory: Inventory, settings: Settings) -> int:
    """Return the number by which a building draws its T1 and PGV/PGA: in a city by its name and place."""
    place = _find_place(inventory, settings)
    name = inventory.building.building
    return 0 if place is None else name_number(f"{place[0]:.6f} {place[1]:.6f} {name}")


def choose_runs(scenarios: int, runs: int | str | None = None) -> int | str:
    """Return the number of draws for a number of scenarios, 0 for none; `runs` is what was asked for.

    Without it the least multiple of the scenarios that is at least 200, so that each of them counts alike. Raises
    InputError if there are more scenarios than draws, if they do not count alike, or if the number of draws is "auto".
    """
    if not scenarios:
        return RUNS if runs is None else runs
    chosen = -(-RUNS // scenarios) * scenarios if runs is None else runs
    if scenarios > MOST_DRAWS:
        fault = fill("{scenarios:,} scenarios, expected at most {most:,}.", scenarios=scenarios, most=MOST_DRAWS)
        raise InputError(join(" ", (fault, fill("Keep fewer events in the file of ground motions."))))
    if chosen == AUTO or int(chosen) % scenarios:
        fault = fill(
            "runs is {runs}, expected a multiple of {scenarios:,}, the number of scenarios: each has to count alike.",
            runs=chosen, scenarios=scenarios,
        )  # fmt: skip
        fix = fill("Leave runs out, or set it to {runs}.", runs=choose_runs(scenarios))
        raise InputError(join(" ", (fault, fix)))
    return chosen


def check_draws(inventory: Inventory, settings: Settings) -> None:
    """Raise InputError where the number of draws does not fit scenarios, or differs between buildings of a city."""
    if settings.verify == "none":
        return
    if settings.city and settings.runs == AUTO:
        fault = fill("runs is {runs}: all buildings of a city need the same draws.", runs=AUTO)
        raise InputError(join(" ", (fault, fill("Set runs to a number, 200 for instance."))))
    ground = inventory.site_ground
    if ground is not None and ground.scenarios:
        choose_runs(len(ground.scenarios), settings.runs)
