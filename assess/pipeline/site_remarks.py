"""The ground motion of a ShakeMap or of scenarios: what results tell of it, and what its user is told."""

from collections.abc import Iterator

from assess.errors import Problem
from assess.i18n import Text, fill, nfill
from assess.model import Building, Inventory
from assess.motion.site_ground import SiteGround
from assess.pipeline.demand import Demands, find_site
from assess.pipeline.verify import find_uncertainty
from assess.results import GroundFact, GroundPsa, SiteGroundInfo
from assess.units import ACCELERATION, GRAVITY, VELOCITY, to_edge


def describe_site(building: Building, demands: Demands) -> SiteGroundInfo | None:
    """Return the ShakeMap or the scenarios on which the motion of a floor rests; None where none does."""
    site = find_site(demands)
    if site is None:
        return None
    profile = next(one.profile for parallel in demands.values() for one in parallel if one.site)
    return SiteGroundInfo(
        kind=site.kind,
        file=site.file,
        sha256=site.sha256,
        pga_g=to_edge(site.pga, ACCELERATION["g"]),
        pgv_cm_s=None if site.pgv is None else to_edge(site.pgv, VELOCITY["cm/s"]),
        psa=tuple(GroundPsa(period_s=period, psa_g=to_edge(value, ACCELERATION["g"])) for period, value in site.psa),
        dispersion=site.dispersion,
        dispersion_source=site.dispersion_source,
        own_dispersion=find_uncertainty(building).motion,
        shared=site.shared,
        distance_km=None if site.distance is None else site.distance / 1000,
        scenarios=len(site.scenarios),
        profile=profile.key if profile else "",
        facts=tuple(GroundFact(label=label, value=value) for label, value in site.facts),
        cautions=site.cautions,
    )


def remark_on_site(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Yield the notes and warnings on a ShakeMap or scenarios; none where the building has neither."""
    building, site = inventory.building, inventory.site_ground
    cell = building.cell("shakemap")
    if site is None:
        if building.shakemap:
            why = fill("Ground PGA or SDS is filled in")
            message = fill("{what} is not used: {why}.", what=fill("ShakeMap file"), why=why)
            yield Problem("note", "Building", cell, message)
        return
    used = find_site(demands)
    if used is None:
        message = fill("{what} is not used: {why}.", what=_name(site), why=fill("no floor follows a profile"))
        yield Problem("note", "Building", cell, message)
        return
    yield Problem("note", "Building", cell, _say_used(building, used, demands))
    yield from _list_own(demands)
    for caution in used.cautions:
        yield Problem("warning", "Building", cell, fill("{caution}.", caution=caution))


def _name(site: SiteGround) -> Text:
    if site.kind == "shakemap":
        return fill("The ShakeMap {file}", file=site.file)
    return fill("The ground motion of {file}", file=site.file)


def _say_used(building: Building, site: SiteGround, demands: Demands) -> Text:
    return fill(
        "{what} gives the ground a PGA of {pga:.3f} g at the building. The standard deviation of ln PGA there is "
        "{sigma:.3g} ({source}); with {own:.3g} of the building's own motion the dispersion is {motion:.3g}, the root "
        "of the sum of their squares.",
        what=_name(site),
        pga=site.pga / GRAVITY,
        sigma=site.dispersion,
        source=site.dispersion_source,
        own=find_uncertainty(building).motion,
        motion=find_uncertainty(building, demands).motion,
    )


def _list_own(demands: Demands) -> Iterator[Problem]:
    """Yield a note on the floors that keep a motion of their own."""
    every = {name: {one.source for one in parallel} for (name, _), parallel in demands.items()}
    own = [name for name, sources in every.items() if "profile" not in sources]
    if own:
        message = nfill(
            "floor {floors} keeps its own motion, which could be that of another earthquake.",
            "floors {floors} keep their own motions, which could be those of another earthquake.",
            len(own),
            floors=", ".join(own),
        )
        yield Problem("note", "Floors", "", message)
