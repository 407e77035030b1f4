"""A building model in IFC (ISO 16739-1: IFC2X3, IFC4, IFC4X3) as plain data: its furniture, rooms, doors and stairs.

Shapes are trusted, names and properties are not: sizes are those of the shapes, exits are found by the rooms on both
sides of a door, whatever its IsExternal says.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
from shapely import Polygon

from assess.bim.building_model import (
    NOT_ON_FLOOR,
    ON_FLOOR,
    Area,
    BuildingModel,
    Door,
    Piece,
    Point,
    Skipped,
    Space,
    Stair,
    Storey,
    bring_near,
    count_skipped,
    name_skipped,
)
from assess.bim.ifc_file import (
    Element,
    find_holders,
    find_key,
    find_storey,
    find_unit,
    find_whole,
    join_parts,
    list_elements,
    list_outer,
    list_shapes,
    read_with,
    say,
    tell_apart,
)
from assess.bim.plan_shapes import (
    FloatArray,
    Shape,
    SpaceSearch,
    cut,
    find_base,
    find_box,
    find_rectangle,
    find_stacks,
    join,
    merge,
    note_stacked,
)
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
FURNITURE = ("IfcFurnishingElement", "IfcElectricAppliance", "IfcMedicalDevice")
"""Classes whose elements are pieces of furniture, with their subclasses (IfcFurniture, IfcSystemFurnitureElement)."""
APPLIANCES = ("IfcElectricApplianceType", "IfcMedicalDeviceType")
"""Types by which an element is a piece in IFC2X3, where it has no class of its own."""
OTHERS = (
    "IfcBuildingElementProxy", "IfcTransportElement", "IfcFlowTerminal", "IfcFlowStorageDevice",
    "IfcFlowMovingDevice", "IfcFlowTreatmentDevice", "IfcEnergyConversionDevice", "IfcDistributionControlElement",
)  # fmt: skip
"""Classes that may hold furniture or equipment, and mostly hold something else: they are listed, and taken by name."""
FITTED = (
    "base cabinet", "casework", "kitchen", "counter", "vanity", "built-in", "builtin", "worktop", "einbau", "küche",
    "kueche", "cucina", "incasso",
)  # fmt: skip
"""Words in names of fitted furniture, which is usually fixed."""
MOST_PIECES = 20_000
"""Pieces of a model that are read."""
NO_SHAPE = fill("no geometry")
NO_PIECE = fill("its class is not furniture; it can be imported by the name of its class")
_FEWEST, _NEARLY_ALL, _ALIKE = 3, 0.8, 0.03
"""Pieces, their share [-] and their heights [m] by which furniture tells the floor of its storey."""
_HUNG = (0.6, 2.4)
"""Heights at which furniture hangs on walls [m]."""
_NEAR_FLOOR = 0.3
"""How far below the floor of a room a piece may begin to stand in it [m]."""


def read_model(path: Path, name: str, also: Sequence[str] = ()) -> BuildingModel:
    """Read a building model; call it in a process of its own (`assess.bim.model_process`). `also`: further classes of
    pieces. Raises ModelError if it is not whole, names no unit of length, holds no building, or lacks a class of
    `also`.
    """
    return read_with(path, name, lambda model: _understand(model, name, also))


def _understand(model: Any, name: str, also: Sequence[str]) -> BuildingModel:
    unit = find_unit(model, name)
    storeys, warnings = _list_storeys(model, unit)
    if not storeys:  # the floor of all is the lowest point of rooms, furniture or walls
        kinds = (list_elements(model, classes) for classes in (("IfcSpace",), FURNITURE, ("IfcWall",)))
        bottoms = ([shape.bottom for _, shape in list_shapes(model, elements)] for elements in kinds)
        lowest = next((min(one) for one in bottoms if one), None)
        if lowest is None:
            raise ModelError(
                fill("{name} holds neither storeys nor rooms, furniture or walls with a shape. Export the building "
                     "with its storeys.", name=name)
            )  # fmt: skip
        storeys = [Storey("", "1", 0.0, lowest)]
        warnings.append(
            fill("The model has no storeys: all of it was put on one floor, {floor}. Check Floor in Items.",
                 floor=storeys[0].name)
        )  # fmt: skip
    known = {one.key for one in storeys}
    spaces = tuple(_list_spaces(model, known))
    pieces, levelled, skipped, doubts = _find_pieces(model, storeys, spaces, also)
    walls, windows = _cut_walls(model, levelled)
    remarks = []
    missing = len(model.by_type("IfcSpace")) - len(spaces)
    if not spaces and not missing:
        remarks.append(
            fill("The model has no rooms (IfcSpace): Room stays blank, and heights are taken from the storeys.")
        )
    if missing:
        remarks.append(
            nfill("{n:,} room of the model has no plan or no storey: left out.",
                  "{n:,} rooms of the model have no plan or no storey: left out.", missing)
        )  # fmt: skip
    outside = sum(not piece.space for piece in pieces) if spaces else 0
    if outside:
        remarks.append(
            nfill("{n:,} piece stands in no room of the model: its Room stays blank.",
                  "{n:,} pieces stand in no room of the model: their Room stays blank.", outside)
        )  # fmt: skip
    read = BuildingModel(
        source=name, schema=model.schema_identifier, storeys=levelled, spaces=spaces,
        doors=tuple(_list_doors(model, known, unit)), stairs=tuple(_list_stairs(model, levelled)),
        pieces=tuple(pieces), walls=walls, windows=windows, skipped=skipped, warnings=(*warnings, *doubts),
        remarks=tuple(remarks), **_describe_site(model),
    )  # fmt: skip
    return bring_near(read)


def _describe_site(model: Any) -> dict[str, Any]:
    """Return name, address, latitude, longitude and the compass direction of X [deg], as far as they are given."""
    buildings, projects = model.by_type("IfcBuilding"), model.by_type("IfcProject")
    named = [say(one.LongName) or say(one.Name) for one in (*buildings, *projects)]
    address = next((one.BuildingAddress for one in buildings if one.BuildingAddress), None)
    lines = [*(address.AddressLines or ())] if address is not None else []
    lines += [getattr(address, name, None) for name in ("PostalCode", "Town", "Region", "Country")]
    found: dict[str, Any] = {"name": next(filter(None, named), ""), "address": ", ".join(filter(None, map(say, lines)))}
    for site in model.by_type("IfcSite"):
        latitude, longitude = (
            round(sum(part / size for part, size in zip(angle, _ARC, strict=False)), 6)
            if angle and len(angle) <= len(_ARC) else math.nan
            for angle in (site.RefLatitude, site.RefLongitude)
        )  # fmt: skip
        if abs(latitude) <= 90 and abs(longitude) <= 180 and (latitude or longitude):
            found |= {"latitude": latitude, "longitude": longitude}
            break
    for context in model.by_type("IfcGeometricRepresentationContext", include_subtypes=False):
        if context.TrueNorth is not None:
            x, y = context.TrueNorth.DirectionRatios[:2]
            found["azimuth_deg"] = round(math.degrees(math.atan2(y, x)), 3) % 360
            break
    return found


# ---------------------------------------------------------------- storeys, rooms, doors, stairs, walls


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


# ---------------------------------------------------------------- furniture


def _find_pieces(
    model: Any, storeys: Sequence[Storey], spaces: Sequence[Space], also: Sequence[str]
) -> tuple[list[Piece], tuple[Storey, ...], tuple[Skipped, ...], list[Text]]:
    """Return the pieces, the storeys with the levels of their floors, what was left out, and warnings."""
    import ifcopenshell
    from ifcopenshell.util.element import get_type

    schema = ifcopenshell.ifcopenshell_wrapper.schema_by_name(model.schema_identifier)
    for name in also:
        entity = None
        with suppress(RuntimeError):
            entity = schema.declaration_by_name(name).as_entity()
        if entity is None:
            raise ModelError(
                fill("{name} is not a class of {schema}. Classes have names such as {example}.", name=name[:60],
                     schema=model.schema_identifier, example="IfcBuildingElementProxy")
            )  # fmt: skip
    wanted = {one.id() for one in list_elements(model, (*FURNITURE, *also))}
    elements: dict[int, Element] = {}
    skipped: list[tuple[str, Text, bool]] = []
    for one in list_outer(list_elements(model, (*FURNITURE, *OTHERS, *also))):
        kind = get_type(one) if one.is_a("IfcDistributionElement") else None
        if one.id() in wanted or (kind is not None and kind.is_a() in APPLIANCES):
            elements[one.id()] = one
        else:
            skipped.append((name_skipped(one.is_a(), _name_type(one)), NO_PIECE, False))
    if len(elements) > MOST_PIECES:
        raise ModelError(
            fill("The model holds {n:,} pieces of furniture, more than {most:,}. Export fewer storeys.",
                 n=len(elements), most=MOST_PIECES)
        )  # fmt: skip
    shaped = _Shaped(model, elements, storeys, spaces)
    warnings = shaped.settle_levels()
    parts = shaped.join_groups()
    on_floor = [number for number, one in shaped.pieces.items() if one.bottom <= ON_FLOOR]
    off = [number for number, one in shaped.pieces.items() if one.bottom > ON_FLOOR]
    for number, element in elements.items():
        if number not in shaped.pieces and number not in parts:
            skipped.append((name_skipped(element.is_a(), _name_type(element)), NO_SHAPE, True))
        elif number in shaped.pieces and shaped.pieces[number].bottom > ON_FLOOR:
            skipped.append((name_skipped(element.is_a(), _name_type(element)), NOT_ON_FLOOR, True))
    names = [shaped.pieces[number].name or shaped.pieces[number].type for number in on_floor]
    warnings += note_stacked(names, *(np.array([shaped.bounds[one] for one in own]) for own in (on_floor, off)))
    pieces = [piece for number in elements if (piece := shaped.pieces.get(number)) and piece.bottom <= ON_FLOOR]
    return pieces, tuple(shaped.storeys.values()), count_skipped(skipped), warnings


class _Shaped:
    """The pieces that have a shape, by the number of their element, and the box round each in the model's axes."""

    def __init__(
        self, model: Any, elements: Mapping[int, Element], storeys: Sequence[Storey], spaces: Sequence[Space]
    ) -> None:
        self.elements, self.keys = elements, tell_apart(elements.values())
        self.storeys = {one.key: one for one in storeys}
        self.pieces: dict[int, Piece] = {}
        self.bounds: dict[int, FloatArray] = {}
        self._spaces, self._search = {one.key: one for one in spaces}, SpaceSearch(spaces)
        self._wholes = {number: whole for number, one in elements.items() if (whole := find_whole(one)) is not None}
        self._shapes: dict[int, Shape] = {}  # of parts alone: a building may hold thousands of chairs
        for number, shape in join_parts(model, list(elements.values())):
            self._take(number, shape)
            if number in self._wholes:
                self._shapes[number] = shape

    def _take(self, number: int, shape: Shape, name: str = "") -> None:
        element, box, bottom = self.elements[number], find_box(shape), shape.bottom
        # storey and room are what holds it in the model, else the smallest that it stands in
        holder = next((find_key(one) for one in find_holders(element) if one.is_a("IfcSpace")), "")
        space = self._spaces.get(holder)
        if space is not None:
            storey = space.storey
        else:
            storey = find_storey(element)
            if storey not in self.storeys:
                below = [one for one in self.storeys.values() if one.level <= bottom + _NEAR_FLOOR]
                storey = (max(below, key=lambda one: one.level) if below else next(iter(self.storeys.values()))).key
            there = self._search.find(storey, (box.x, box.y))
            space = next((one for one in there if one.bottom - _NEAR_FLOOR <= bottom <= one.top), None)
        floor = space.bottom if space is not None else self.storeys[storey].level
        kind = name or _name_type(element)
        self.pieces[number] = Piece(
            key=self.keys[number], storey=storey, space=space.key if space is not None else "",
            ifc_class=element.is_a(), name=name or say(element.Name), type=kind, bottom=bottom - floor,
            is_fitted=any(word in kind.casefold() for word in FITTED), **asdict(box),
        )  # fmt: skip
        self.bounds[number] = np.concatenate([shape.points.min(axis=0), shape.points.max(axis=0)])

    def settle_levels(self) -> list[Text]:
        """Move the floor of a storey where nearly all pieces are off it by one height; return warnings."""
        warnings = []
        for storey in self.storeys.values():
            own = [number for number, one in self.pieces.items() if one.storey == storey.key and not one.space]
            shift = find_shift([self.pieces[number].bottom for number in own], storey.elevation - storey.level)
            if shift:
                for number in own:
                    self.pieces[number] = replace(self.pieces[number], bottom=self.pieces[number].bottom - shift)
                self.storeys[storey.key] = replace(storey, level=storey.level + shift)
                warnings.append(
                    fill("The furniture of {storey} stands {shift:.2f} m above where the model has its floor: that "
                         "height was taken as its floor. Check Elevation in Floors.", storey=storey.name, shift=shift)
                )  # fmt: skip
        return warnings

    def join_groups(self) -> set[int]:
        """Make one piece of the parts that stand on each other; return the elements that are pieces no longer."""
        groups: dict[int, list[int]] = {}
        for number, whole in self._wholes.items():
            if number in self._shapes:
                groups.setdefault(whole.id(), []).append(number)
        gone = set[int]()
        on_floor = {number for number, one in self.pieces.items() if one.bottom <= ON_FLOOR}
        for (first, *others), is_whole in list(find_stacks(groups.values(), self.bounds, on_floor, beside=True)):
            name = say(self._wholes[first].Name) if is_whole else ""
            self._take(first, join([self._shapes[number] for number in (first, *others)]), name)
            gone |= {*others}
        for number in gone:
            del self.pieces[number], self.bounds[number]
        return gone


def find_shift(bottoms: Sequence[float], stated: float) -> float:
    """Return by what height nearly all pieces of a storey stand above its floor, 0 where they do not [m].

    `bottoms`: heights of the lowest points of its pieces. `stated`: how much higher the floor is by the Elevation of
    the model: where that is the height, one piece tells it. At heights of `_HUNG` furniture may hang on walls.
    """
    height = float(np.median(bottoms)) if bottoms else 0.0
    nearly_all = sum(abs(one - height) <= _ALIKE for one in bottoms) >= _NEARLY_ALL * len(bottoms)
    is_clear = len(bottoms) >= _FEWEST and not _HUNG[0] <= height <= _HUNG[1]
    is_told = nearly_all and (is_clear or abs(height - stated) <= _ALIKE)
    return height if abs(height) > ON_FLOOR and is_told else 0.0


def _name_type(element: Element) -> str:
    """Return the type of an element in words. Revit writes ``Family:Type:Number`` as the name, others the type."""
    from ifcopenshell.util.element import get_type

    kind = get_type(element)
    type_name = say(kind.Name) if kind is not None else ""
    name, tag = say(element.Name), say(getattr(element, "Tag", None))
    parts = [part.strip() for part in name.split(":")]
    if len(parts) > 1:
        if parts[-1] == tag or parts[-1].isdigit():
            parts.pop()
        return " ".join(dict.fromkeys(filter(None, parts)))
    return type_name or say(getattr(element, "ObjectType", None)) or name or element.is_a()
