"""A building model in IFC (ISO 16739-1: IFC2X3, IFC4, IFC4X3) as plain data.

Shapes are trusted, names and properties are not: sizes are those of the shapes, exits are found by the rooms on both
sides of a door, whatever its IsExternal says.
"""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from shapely import Polygon

from assess.bim.building_model import Area, BuildingModel, Door, Piece, Point, Space, Stair, Storey, bring_near
from assess.bim.ifc_elements import (
    Element,
    find_storey,
    find_unit,
    join_parts,
    list_elements,
    list_outer,
    list_shapes,
    say,
    tell_apart,
)
from assess.bim.ifc_file import read_with
from assess.bim.ifc_pieces import FURNITURE, find_pieces
from assess.bim.plan_shapes import FloatArray, cut, find_base, find_rectangle, merge
from assess.errors import ModelError
from assess.i18n import Text, fill, nfill

SAME = 0.05
"""Difference up to which two heights are the same [m]."""
MOST_NAMED = 20
_ARC = (1.0, 60.0, 3600.0, 3.6e9)
"""Parts of an IfcCompoundPlaneAngleMeasure in a degree: degrees, minutes, seconds, millionths of a second."""
CUT = 1.2
"""Height above the floor at which walls are cut for the plan [m]."""
WALLS = ("IfcWall", "IfcColumn", "IfcCurtainWall", "IfcPlate", "IfcMember")
STAIRS = ("IfcStair", "IfcStairFlight", "IfcRamp", "IfcRampFlight")
CLEARLY_LONGER = 2.0
"""Ratio of sides from which a plan tells the direction of a wall by itself [-]."""
RISER = 0.35
"""Height within which the first and the last step of a stair lie [m]."""
AT_FOOT, LEAST_RISE, ABOVE_HEAD = 0.7, 1.5, 0.3
"""A stair's foot lies within this of its storey's floor; its head is at the highest storey between these above its foot
and its top [m]."""


def read_model(path: Path, name: str, also: Sequence[str] = ()) -> BuildingModel:
    """Read a building model; call it in a process of its own (`assess.bim.model_process`).

    `also`: further classes whose elements are pieces, such as IfcBuildingElementProxy.
    Raises ModelError if it is no whole building model, names no unit of length, holds no building, or `also` names no
    class.
    """
    return read_with(path, name, lambda model: _understand(model, name, also))


def _understand(model: Any, name: str, also: Sequence[str]) -> BuildingModel:
    unit = find_unit(model, name)
    storeys, warnings = _list_storeys(model, unit)
    if not storeys:
        storeys = [_stand_in(model, name)]
        warnings.append(
            fill("The model has no storeys: all of it was put on one floor, {floor}. Check Floor in Items.",
                 floor=storeys[0].name)
        )  # fmt: skip
    known = {one.key for one in storeys}
    spaces = tuple(_list_spaces(model, known))
    pieces, levelled, skipped, doubts = find_pieces(model, storeys, spaces, also)
    walls, windows = _cut_walls(model, levelled)
    title, address = _find_names(model)
    latitude, longitude = _find_position(model) or (None, None)
    read = BuildingModel(
        source=name, schema=model.schema_identifier, name=title, address=address, storeys=levelled,
        spaces=spaces, doors=tuple(_list_doors(model, known, unit)), stairs=tuple(_list_stairs(model, levelled)),
        pieces=tuple(pieces), walls=walls, windows=windows, skipped=skipped,
        azimuth_deg=_find_azimuth(model), latitude=latitude, longitude=longitude,
        warnings=(*warnings, *doubts), remarks=tuple(_note_rooms(model, spaces, pieces)),
    )  # fmt: skip
    return bring_near(read)


def _stand_in(model: Any, name: str) -> Storey:
    """Return a storey for a model that has none: its floor is the lowest point of its furniture or rooms."""
    for classes in (("IfcSpace",), FURNITURE, ("IfcWall",)):
        bottoms = [shape.bottom for _, shape in list_shapes(model, list_elements(model, classes))]
        if bottoms:
            return Storey("", "1", 0.0, min(bottoms))
    raise ModelError(
        fill("{name} holds neither storeys nor rooms, furniture or walls with a shape. Export the building with its "
             "storeys.", name=name)
    )  # fmt: skip


def _note_rooms(model: Any, spaces: Sequence[Space], pieces: Sequence[Piece]) -> Iterator[Text]:
    missing = len(model.by_type("IfcSpace")) - len(spaces)
    if not spaces and not missing:
        yield fill("The model has no rooms (IfcSpace): Room stays blank, and heights are taken from the storeys.")
    if missing:
        yield nfill("{n:,} room of the model has no plan or no storey: left out.",
                    "{n:,} rooms of the model have no plan or no storey: left out.", missing)  # fmt: skip
    outside = sum(not piece.space for piece in pieces) if spaces else 0
    if outside:
        yield nfill("{n:,} piece stands in no room of the model: its Room stays blank.",
                    "{n:,} pieces stand in no room of the model: their Room stays blank.", outside)  # fmt: skip


def _find_names(model: Any) -> tuple[str, str]:
    """Return the name and the address of the building, "" where it has none."""
    buildings, projects = model.by_type("IfcBuilding"), model.by_type("IfcProject")
    named = [say(one.LongName) or say(one.Name) for one in (*buildings, *projects)]
    address = next((one.BuildingAddress for one in buildings if one.BuildingAddress), None)
    lines = [*(address.AddressLines or ())] if address is not None else []
    lines += [getattr(address, name, None) for name in ("PostalCode", "Town", "Region", "Country")]
    return next(filter(None, named), ""), ", ".join(filter(None, map(say, lines)))


def _find_position(model: Any) -> tuple[float, float] | None:
    """Return latitude and longitude of the site [deg], None where the model gives none, no such, or both are 0."""
    for site in model.by_type("IfcSite"):
        latitude, longitude = _to_degrees(site.RefLatitude), _to_degrees(site.RefLongitude)
        if latitude is not None and longitude is not None and (latitude or longitude) and abs(latitude) <= 90:
            return latitude, longitude
    return None


def _to_degrees(angle: Sequence[int] | None) -> float | None:
    """Return an IfcCompoundPlaneAngleMeasure in degrees; None if there is none, or it is no angle of a site."""
    if not angle or len(angle) > len(_ARC):
        return None
    degrees = sum(part / size for part, size in zip(angle, _ARC, strict=False))
    return round(degrees, 6) if abs(degrees) <= 180 else None


def _find_azimuth(model: Any) -> float | None:
    """Return the compass direction of the X axis [deg], None where no true north is given."""
    for context in model.by_type("IfcGeometricRepresentationContext", include_subtypes=False):
        if context.TrueNorth is not None:
            x, y = context.TrueNorth.DirectionRatios[:2]
            return round(math.degrees(math.atan2(y, x)), 3) % 360
    return None


def _list_storeys(model: Any, unit: float) -> tuple[list[Storey], list[Text]]:
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
    levels = {round(storey.level, 2) for storey, _ in found}
    if len(found) > 1 and len(levels) == 1:  # none is placed: what is in them is
        found = [(replace(storey, level=storey.level if own is None else own), own) for storey, own in found]
    found.sort(key=lambda pair: (pair[0].level, pair[0].name))
    datum = next((own - storey.level for storey, own in found if own is not None), 0.0)
    kept = [replace(storey, elevation=storey.level + datum) for storey, _ in found]
    pairs = zip(kept, (own for _, own in found), strict=True)
    odd = [storey.name for storey, own in pairs if own is not None and abs(own - storey.elevation) > SAME]
    if not odd:
        return kept, []
    text = fill("Elevation in the model differs from where these storeys are placed, which was taken: {names}. Check "
                "Elevation in Floors.", names=", ".join(odd[:MOST_NAMED]))  # fmt: skip
    return kept, [text]


def _list_spaces(model: Any, storeys: Collection[str]) -> Iterator[Space]:
    spaces = {one.id(): one for one in model.by_type("IfcSpace")}
    keys = tell_apart(spaces.values())
    shapes = dict(list_shapes(model, list(spaces.values())))
    for number, one in spaces.items():
        storey, shape = _find_known(one, storeys), shapes.get(number)
        if shape is not None and storey is not None and (area := find_base(shape)) is not None:
            name, title = say(one.Name), say(one.LongName)
            title = "" if title == name else title
            yield Space(keys[number], storey, name or title, title, area, shape.bottom, shape.top)


def _find_known(element: Element, storeys: Collection[str]) -> str | None:
    storey = find_storey(element)
    if storey in storeys:
        return storey
    return "" if "" in storeys else None


def _list_doors(model: Any, storeys: Collection[str], unit: float) -> Iterator[Door]:
    """Yield the doors that have a plan: that of their opening, else their own."""
    doors = model.by_type("IfcDoor")
    keys = tell_apart(doors)
    fills = [(one.id(), fill.RelatingOpeningElement) for one in doors for fill in one.FillsVoids]
    openings = {number: opening for number, opening in fills if opening is not None}
    shapes = dict(list_shapes(model, [*doors, *openings.values()]))
    for one in doors:
        storey = _find_known(one, storeys)
        opening = openings.get(one.id())
        shape = (shapes.get(opening.id()) if opening is not None else None) or shapes.get(one.id())
        plan = find_rectangle(shape.points[:, :2]) if shape is not None else None
        leaf = find_rectangle(shapes[one.id()].points[:, :2]) if one.id() in shapes else None
        if plan is not None and leaf is not None and plan.long < CLEARLY_LONGER * plan.short:
            # the short side of a rectangle is taken for the thickness of the wall; here the door itself tells it
            is_across = abs(math.sin(math.radians(leaf.angle_deg - plan.angle_deg))) > 0.9
            if is_across and leaf.long >= CLEARLY_LONGER * leaf.short:
                plan = replace(plan, short=plan.long, long=plan.short, angle_deg=leaf.angle_deg)
        if storey is None or plan is None:
            continue
        overall = float(one.OverallWidth or 0.0) * unit
        yield Door(
            keys[one.id()], storey, say(one.Name), plan.x, plan.y, plan.angle_deg, plan.long, plan.short,
            overall if math.isfinite(overall) and overall > 0 else 0.0,
        )  # fmt: skip


def _list_stairs(model: Any, storeys: Sequence[Storey]) -> Iterator[Stair]:
    stairs = {one.id(): one for one in list_outer(list_elements(model, STAIRS))}
    keys = tell_apart(stairs.values())
    for number, shape in sorted(join_parts(model, list(stairs.values())), key=lambda one: one[0]):
        key, name, low, high = keys[number], say(stairs[number].Name), shape.bottom, shape.top
        feet = [one for one in storeys if abs(one.level - low) < AT_FOOT]
        heads = [one for one in storeys if low + LEAST_RISE < one.level < high + ABOVE_HEAD]
        if feet:
            foot = min(feet, key=lambda one: abs(one.level - low))
            yield Stair(key, foot.key, name, "foot", *_find_step(shape.points, low))
        if heads:
            head = max(heads, key=lambda one: one.level)
            yield Stair(key, head.key, name, "head", *_find_step(shape.points, min(head.level, high)))


def _find_step(points: FloatArray, level: float) -> Point:
    near = points[np.abs(points[:, 2] - level) < RISER]
    plan = (near if len(near) else points)[:, :2]
    x, y = (plan.max(axis=0) + plan.min(axis=0)) / 2
    return float(x), float(y)


Plans = dict[str, tuple[Area, ...]]
"""Areas by the key of their storey."""


def _cut_walls(model: Any, storeys: Sequence[Storey]) -> tuple[Plans, Plans]:
    elements = {one.id(): one for one in list_elements(model, (*WALLS, "IfcWindow"))}
    walls, windows = dict[str, list[Polygon]](), dict[str, list[Polygon]]()
    cuts = {
        number: [cut(shape, storey.level + CUT) for storey in storeys]
        for number, shape in list_shapes(model, list(elements.values()), with_openings=True)
    }
    for number in sorted(cuts):
        kept = windows if elements[number].is_a("IfcWindow") else walls
        for storey, polygons in zip(storeys, cuts[number], strict=True):
            kept.setdefault(storey.key, []).extend(polygons)
    return {key: merge(some) for key, some in walls.items()}, {key: merge(some) for key, some in windows.items()}
