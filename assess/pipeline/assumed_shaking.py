"""Notes on an assumed intensity: that it is used and how to do better, or why it is not used."""

from collections.abc import Iterator

from assess.errors import Problem
from assess.i18n import fill
from assess.intensity import SHAKINGS, Shaking
from assess.model import Building, Inventory
from assess.pipeline.demand import Demands, find_ground, find_shaking
from assess.units import GRAVITY, VELOCITY


def remark_on_shaking(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Yield the notes on the line Shaking of Building; none where it is blank."""
    building = inventory.building
    if building.shaking not in SHAKINGS:
        return
    cell, used = building.cell("shaking"), find_shaking(demands)
    if used is None:
        ground, why = find_ground(inventory), fill("no floor follows a profile")
        if ground.shaking is None:
            why = fill("a ShakeMap gives the ground motion") if ground.site else fill("Ground PGA or SDS is filled in")
        yield Problem("note", "Building", cell, fill("{what} is not used: {why}.", what=fill("Shaking"), why=why))
        return
    message = fill(
        "the shaking is assumed: '{choice}' stands for a ground PGA of {pga:.3f} g and a PGV of {pgv:.1f} cm/s, the "
        "published medians.",
        choice=fill(used.choice), pga=used.pga / GRAVITY, pgv=used.pgv / VELOCITY["cm/s"],
    )  # fmt: skip
    fix = fill(
        "To know it better: type the PGA of a hazard map or a ShakeMap at the address into Ground PGA, or name records "
        "in Floors."
    )
    yield Problem("note", "Building", cell, message, fix)
    yield from _remark_on_scatter(building, used)


def _remark_on_scatter(building: Building, used: Shaking) -> Iterator[Problem]:
    given = building.motion_uncertainty
    if given is not None and given < used.scatter:
        why = fill("{scatter:.2f}, the scatter of ln PGA given the assumed intensity, is larger", scatter=used.scatter)
        what = fill("Motion uncertainty {given:g}", given=given)
        message = fill("{what} is not used: {why}.", what=what, why=why)
        yield Problem("note", "Building", building.cell("motion_uncertainty"), message)
