"""What a building model tells of its site: unit, name, address, latitude and longitude, true north, storeys."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from assess.bim.building_model import Storey
from assess.bim.ifc_elements import Element, tell_apart
from assess.errors import ModelError
from assess.i18n import Text, fill
from assess.workbook.values import ERRORS, read_text

_PLACEHOLDERS = ("enter address here", "//", "default", "<default>", "project number", "project name", "undefined")
"""What programs write where nobody has typed a name or an address."""
LONGEST = 1000
"""Characters that are kept of a text."""
SAME = 0.05
"""Difference up to which two heights are the same [m]."""
MOST_NAMED = 20
_ARC = (1.0, 60.0, 3600.0, 3.6e9)
"""Parts of an IfcCompoundPlaneAngleMeasure in a degree: degrees, minutes, seconds, millionths of a second."""


def find_unit(model: Any, name: str) -> float:
    """Return the metres in a unit of length of the model; raises ModelError if it names no unit of length."""
    from ifcopenshell.util.unit import calculate_unit_scale

    assigned = [one for project in model.by_type("IfcProject") if (one := project.UnitsInContext)]
    units = [unit for one in assigned for unit in one.Units or ()]
    if not any(getattr(unit, "UnitType", "") == "LENGTHUNIT" for unit in units):
        raise ModelError(
            fill("{name} has no unit of length, so its sizes are unknown. Set the unit in the program that made "
                 "it, and export again.", name=name)
        )  # fmt: skip
    scale = float(calculate_unit_scale(model))
    if not (math.isfinite(scale) and 1e-6 < scale < 1e4):
        raise ModelError(fill("{name}: its unit of length cannot be understood. Export it in metres.", name=name))
    return scale


def say(value: object) -> str:
    """Return a text of the model in one line; "" for none, and for what programs write in its place.

    What is no text is taken out as from cells (`assess.workbook.values`): else names that are read alike would differ.
    """
    text = " ".join(read_text(value).split())[:LONGEST] if value is not None else ""
    return "" if text.casefold().startswith(_PLACEHOLDERS) or text in ERRORS else text


def find_names(model: Any) -> tuple[str, str]:
    """Return the name and the address of the building, "" where it has none."""
    buildings, projects = model.by_type("IfcBuilding"), model.by_type("IfcProject")
    named = [say(one.LongName) or say(one.Name) for one in (*buildings, *projects)]
    address = next((one.BuildingAddress for one in buildings if one.BuildingAddress), None)
    return next(filter(None, named), ""), ", ".join(_list_address(address))


def _list_address(address: Element | None) -> Iterator[str]:
    if address is None:
        return
    lines = [say(line) for line in address.AddressLines or ()]
    for part in (*lines, *(say(getattr(address, name)) for name in ("PostalCode", "Town", "Region", "Country"))):
        if part:
            yield part


def find_position(model: Any) -> tuple[float, float] | None:
    """Return latitude and longitude of the site [deg], None where the model gives none, no such, or both are 0."""
    for site in model.by_type("IfcSite"):
        latitude, longitude = to_degrees(site.RefLatitude), to_degrees(site.RefLongitude)
        if latitude is not None and longitude is not None and (latitude or longitude) and abs(latitude) <= 90:
            return latitude, longitude
    return None


def to_degrees(angle: Sequence[int] | None) -> float | None:
    """Return an IfcCompoundPlaneAngleMeasure in degrees; None if there is none, or it is no angle of a site."""
    if not angle or len(angle) > len(_ARC):
        return None
    degrees = sum(part / size for part, size in zip(angle, _ARC, strict=False))
    return round(degrees, 6) if abs(degrees) <= 180 else None


def find_azimuth(model: Any) -> float | None:
    """Return the compass direction of the X axis [deg], None where no true north is given."""
    for context in model.by_type("IfcGeometricRepresentationContext", include_subtypes=False):
        if context.TrueNorth is not None:
            x, y = context.TrueNorth.DirectionRatios[:2]
            return round(math.degrees(math.atan2(y, x)), 3) % 360
    return None


def list_storeys(model: Any, unit: float) -> tuple[list[Storey], list[Text]]:
    """Return all storeys of a model, from the lowest, and warnings.

    Elevation counts from the building's zero, the placement from that of the model: they differ by one height in all
    storeys. Where they do not, Elevation was not kept up, and the placements tell the elevations.
    """
    from ifcopenshell.util.placement import get_storey_elevation

    storeys, found = model.by_type("IfcBuildingStorey"), []
    keys = tell_apart(storeys)
    for number, one in enumerate(storeys, 1):
        own = None if one.Elevation is None else float(one.Elevation) * unit
        level = float(get_storey_elevation(one)) * unit if one.ObjectPlacement is not None else own or 0.0
        name = say(one.Name) or say(one.LongName) or str(number)
        if math.isfinite(level) and (own is None or math.isfinite(own)):
            found.append((Storey(keys[one.id()], name, level, level), own))
    if (
        len(found) > 1 and len({round(storey.level, 2) for storey, _ in found}) == 1
    ):  # none is placed: what is in them is
        found = [(replace(storey, level=storey.level if own is None else own), own) for storey, own in found]
    found.sort(key=lambda pair: (pair[0].level, pair[0].name))
    return _count_from_zero(found)


def _count_from_zero(found: Sequence[tuple[Storey, float | None]]) -> tuple[list[Storey], list[Text]]:
    """Return storeys with their elevations, of which each may state its own [m], and warnings."""
    datum = next((own - storey.level for storey, own in found if own is not None), 0.0)
    kept = [replace(storey, elevation=storey.level + datum) for storey, _ in found]
    odd = [
        storey.name
        for storey, (_, own) in zip(kept, found, strict=True)
        if own is not None and abs(own - storey.elevation) > SAME
    ]
    if not odd:
        return kept, []
    text = fill("Elevation in the model differs from where these storeys are placed, which was taken: {names}. Check "
                "Elevation in Floors.", names=", ".join(odd[:MOST_NAMED]))  # fmt: skip
    return kept, [text]
