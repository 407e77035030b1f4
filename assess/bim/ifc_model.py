"""A building model in IFC (ISO 16739-1: IFC2X3, IFC4, IFC4X3) as plain data: its furniture, rooms, doors and stairs.

Shapes are trusted, names and properties are not: sizes are those of the shapes, exits are found by the rooms on both
sides of a door, not by its IsExternal.

The library takes a file that breaks off as if it were whole, with the elements up to there. So the end is looked for
first. STEP physical files: ISO 10303-21, of which a first line, a header and a last line are required.
"""

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from shapely import Polygon

from assess.bim.building_model import (
    NOT_ON_FLOOR,
    ON_FLOOR,
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
from assess.environment import say_install
from assess.errors import ModelError
from assess.i18n import Text, fill, nfill
from assess.resources import open_input
from assess.workbook.values import ERRORS, read_text

Element = Any  # an entity of ifcopenshell
MOST_BYTES = 512 * 2**20  # size of a model that is read [bytes]
FIRST, LAST = b"ISO-10303-21;", b"END-ISO-10303-21;"
_LOOKED_AT = 65536
_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']{1,80})'", re.IGNORECASE)
SCHEMAS = ("IFC2X3", "IFC4", "IFC4X3")  # schemas that are read, with their corrections such as IFC4X3_ADD2
_NO_MODEL = fill("it does not begin as an IFC file (ISO-10303-21) does. Export the building as IFC (.ifc, STEP)")
_DEEPEST = 20  # levels of parts and containers that are followed: a model may hold a loop
THREADS = 1
"""Of the library: two wait for each other for ever at some damaged elements, and are no faster on small models."""
MOST_TRIANGLES = 2_000_000  # triangles of one element beyond which its shape is not taken
FARTHEST = 1e8  # distance from the origin beyond which a shape is not taken [m]: no map grid reaches as far

_PLACEHOLDERS = ("enter address here", "//", "default", "<default>", "project number", "project name", "undefined")
"""What programs write where nobody has typed a name or an address."""
LONGEST = 1000  # characters that are kept of a text
_Found = TypeVar("_Found")
SAME = 0.05  # difference up to which two heights are the same [m]
MOST_NAMED = 20
_ARC = (1.0, 60.0, 3600.0, 3.6e9)
"""Parts of an IfcCompoundPlaneAngleMeasure in a degree: degrees, minutes, seconds, millionths of a second."""
CUT = 1.2  # height above the floor at which walls are cut for the plan [m]
WALLS = ("IfcWall", "IfcColumn", "IfcCurtainWall", "IfcPlate", "IfcMember")
STAIRS = ("IfcStair", "IfcStairFlight", "IfcRamp", "IfcRampFlight")
CLEARLY_LONGER = 2.0  # ratio of sides from which a plan tells the direction of a wall by itself [-]
RISER = 0.35  # height within which the first and the last step of a stair lie [m]
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
MOST_PIECES = 20_000  # pieces of a model that are read
NO_SHAPE = fill("no geometry")
NO_PIECE = fill("its class is not furniture; it can be imported by the name of its class")
_FEWEST, _NEARLY_ALL, _ALIKE = 3, 0.8, 0.03
"""Pieces, their share [-] and their heights [m] by which furniture tells the floor of its storey."""
_HUNG = (0.6, 2.4)  # heights at which furniture hangs on walls [m]
_NEAR_FLOOR = 0.3  # how far below the floor of a room a piece may begin to stand in it [m]


def is_model(start: bytes) -> bool:
    """Tell whether a file begins as a STEP physical file does."""
    return start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(FIRST)


def check_model(path: Path, name: str) -> None:
    """Raise unless a file is a whole STEP file of a known schema, as far as its beginning and its end show.

    Raises ModelError if it cannot be opened, is empty, too large, packed, XML, no model, cut off, or of another schema.
    """
    try:
        size = path.stat().st_size
        with open_input(path) as file:
            start = file.read(_LOOKED_AT)
            file.seek(max(0, size - _LOOKED_AT))
            end = file.read()
    except OSError as error:
        raise unreadable(name, error) from None
    found = _SCHEMA.search(start)
    schema = found[1].decode("ascii", "replace") if found else "-"
    why: Text | None = None
    if size == 0:
        why = fill("it is empty. Export the building again")
    elif size > MOST_BYTES:
        why = fill("it has {size:,.0f} MB, more than {most:,} MB. Export fewer storeys, or furniture, "
                   "spaces, doors and walls only", size=size / 2**20, most=MOST_BYTES >> 20)  # fmt: skip
    elif start.startswith(b"PK\x03\x04"):
        why = fill("it is packed as a zip file. Unpack it and import the .ifc file in it")
    elif b"<ifcXML" in start or b"ifcXML" in start[:2048]:
        why = fill("it is an ifcXML file. Export the building as IFC (.ifc, STEP)")
    elif not is_model(start):
        why = _NO_MODEL
    elif LAST not in end:
        why = fill("it is cut off: its last line, {last}, is missing. Copy or export it again", last=LAST.decode())
    elif not schema.upper().startswith(SCHEMAS):
        why = _describe_schema(schema)
    if why is not None:
        raise unreadable(name, why)


def unreadable(name: str, why: OSError | Text) -> ModelError:
    """Return the error of a file that cannot be read."""
    reason = why.strerror or str(why) if isinstance(why, OSError) else why
    return ModelError(fill("{name} cannot be read: {why}.", name=name, why=reason))


def _describe_schema(schema: str) -> Text:
    known = ", ".join(SCHEMAS)
    return fill("its schema is {schema}, expected one of: {known}. Export it as IFC4", schema=schema, known=known)


def check_installed() -> None:
    """Raise ModelError with the line that tells how to install the library, if it is not there."""
    from importlib.util import find_spec

    if find_spec("ifcopenshell") is None:
        raise ModelError(fill("Building models (IFC) need the library ifcopenshell. {how}", how=say_install("ifc")))


def read_with(path: Path, name: str, understand: Callable[[Any], _Found]) -> _Found:
    """Return what `understand` finds in the model of a file; call it in a process of its own.

    `understand` may raise errors of Python where an entity is of another kind than its schema asks for.
    Raises ModelError as `check_model`, or if the library or `understand` cannot make sense of the file.
    """
    import ifcopenshell

    check_model(path, name)
    try:
        model = ifcopenshell.open(str(path))
    except (ifcopenshell.Error, RuntimeError, ValueError, OSError) as error:
        if "unsupported schema" in str(error).lower():
            schema = str(error).strip().split()[-1]
            raise unreadable(name, _describe_schema(schema)) from None
        raise _find_damage(name, error) from None
    if not isinstance(model, ifcopenshell.file):
        raise unreadable(name, _NO_MODEL)
    # Representations called Clearance, the room that an element needs, get a context of their own: they are no body. It
    # is the identifier of a representation that names its use (IFC4, IfcShapeRepresentation); some programs put it into
    # the context of bodies all the same.
    contexts: dict[int, Any] = {}
    for one in model.by_type("IfcShapeRepresentation"):
        if (one.RepresentationIdentifier or "").strip().casefold() == "clearance":
            whole = getattr(one.ContextOfItems, "ParentContext", None) or one.ContextOfItems
            if whole.id() not in contexts:
                contexts[whole.id()] = model.create_entity(
                    "IfcGeometricRepresentationSubContext", ContextIdentifier="Clearance", ContextType="Model",
                    ParentContext=whole, TargetView="MODEL_VIEW",
                )  # fmt: skip
            one.ContextOfItems = contexts[whole.id()]
    try:
        return understand(model)
    except (AssertionError, AttributeError, TypeError, ValueError, LookupError, RuntimeError) as error:
        raise _find_damage(name, error) from error


def _find_damage(name: str, error: Exception) -> ModelError:
    first = str(error).strip().split("\n")[0][:120].rstrip(".")
    return ModelError(fill("{name} is damaged: {why}. Export it again.", name=name, why=first or type(error).__name__))


# ---------------------------------------------------------------- elements


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


def clean_text(value: object) -> str:
    """Return a text of the model in one line, read as cells are; "" for what programs write in place of a text."""
    text = " ".join(read_text(value).split())[:LONGEST] if value is not None else ""
    return "" if text.casefold().startswith(_PLACEHOLDERS) or text in ERRORS else text


def list_elements(model: Any, classes: Iterable[str]) -> list[Element]:
    """Return the elements of some classes and their subclasses, in the order of the file; unknown classes have none."""
    found: dict[int, Element] = {}
    for name in classes:
        try:
            found |= {one.id(): one for one in model.by_type(name)}
        except RuntimeError:  # not a class of this schema
            continue
    return [found[number] for number in sorted(found)]


def list_outer(elements: Sequence[Element]) -> list[Element]:
    """Return the elements that are not parts of others among them."""
    from ifcopenshell.util.element import get_aggregate

    ids = {one.id() for one in elements}
    return [one for one in elements if (whole := get_aggregate(one)) is None or whole.id() not in ids]


def find_whole(element: Element) -> Element | None:
    """Return the outermost element that an element is a part of; None where it is not one."""
    from ifcopenshell.util.element import get_aggregate

    whole, one = None, element
    for _ in range(_DEEPEST):
        one = get_aggregate(one)
        if one is None or not one.is_a("IfcElement"):
            break
        whole = one
    return whole


def list_parts(element: Element) -> list[Element]:
    """Return an element and its parts; neither openings in it nor what fills them."""
    from ifcopenshell.util.element import get_components, get_parts

    found: dict[int, Element] = {}
    queue = [(element, 0)]
    while queue:
        one, depth = queue.pop()
        if one.id() in found or depth > _DEEPEST or one.is_a("IfcFeatureElement"):
            continue
        found[one.id()] = one
        queue += [(part, depth + 1) for part in (*get_parts(one), *get_components(one))]
    return list(found.values())


def find_holders(element: Element) -> Iterator[Element]:
    """Yield what holds an element, from the innermost: a space, a storey, a building."""
    from ifcopenshell.util.element import get_aggregate, get_container

    one = get_container(element) if not element.is_a("IfcSpatialStructureElement") else get_aggregate(element)
    for _ in range(_DEEPEST):
        if one is None:
            return
        yield one
        one = get_aggregate(one) or (get_container(one) if one.is_a("IfcElement") else None)


def find_storey(element: Element) -> str:
    """Return the key of the storey that holds an element, "" if none does."""
    return next((find_key(one) for one in find_holders(element) if one.is_a("IfcBuildingStorey")), "")


def find_key(element: Element) -> str:
    """Return the GlobalId of an element; of one without it, its number in the file."""
    return element.GlobalId or f"#{element.id()}"


def make_keys(elements: Iterable[Element]) -> dict[int, str]:
    """Return the key of each element by its number in the file; the second with a GlobalId gets its number added."""
    found: dict[int, str] = {}
    taken: set[str] = set()
    for one in elements:
        name = find_key(one)
        found[one.id()] = name if name not in taken else f"{name} #{one.id()}"
        taken.add(name)
    return found


def list_shapes(model: Any, elements: Sequence[Element], *, with_openings: bool = False) -> Iterator[tuple[int, Shape]]:
    """Yield the shape of each element that has one, by its number in the file; those of one kind are made once.

    `with_openings`: whether openings are cut out, which takes most of the time: needed for walls alone.
    """
    import ifcopenshell.geom

    drawn = [one for one in elements if one.Representation]
    if not drawn:
        return
    settings = ifcopenshell.geom.settings()
    settings.set("disable-opening-subtractions", not with_openings)
    done: set[int] = set()
    try:
        iterator = ifcopenshell.geom.iterator(settings, model, THREADS, include=drawn)
        goes_on = bool(iterator.initialize())
        while goes_on:
            one = iterator.get()
            shape = _to_shape(one)
            if shape is not None and one.id not in done:  # a damaged reference makes two of one element
                done.add(one.id)
                yield one.id, shape
            goes_on = bool(iterator.next())
    except RuntimeError:  # one of the elements is damaged: the others one by one, which takes longer
        for element in (one for one in drawn if one.id() not in done):
            try:
                found = _to_shape(ifcopenshell.geom.create_shape(settings, element))
            except (RuntimeError, ValueError, AttributeError):
                continue
            if found is not None:
                yield element.id(), found


def _to_shape(found: Any) -> Shape | None:
    points = np.array(found.geometry.verts, float).reshape(-1, 3)
    triangles = np.array(found.geometry.faces, np.int64).reshape(-1, 3)
    matrix = np.array(found.transformation.matrix, float).reshape(4, 4).T  # column-major
    is_near = (np.abs(points) <= FARTHEST).all() and (np.abs(matrix) <= FARTHEST).all()
    if not 0 < len(triangles) <= MOST_TRIANGLES or not is_near:
        return None
    placed = points @ matrix[:3, :3].T + matrix[:3, 3]
    return Shape(placed, triangles, matrix[:3, :3]) if (np.abs(placed) <= FARTHEST).all() else None


def join_parts(model: Any, elements: Sequence[Element]) -> Iterator[tuple[int, Shape]]:
    """Yield the shape of each element with all of its parts, by its number; none of one without any shape.

    A part that several elements name belongs to the first. What consists of one part is not kept: a building may hold
    thousands of chairs of thousands of triangles each.
    """
    owners: dict[int, int] = {}
    parts: dict[int, Element] = {}
    for element in elements:
        for part in list_parts(element):
            owners.setdefault(part.id(), element.id())
            parts.setdefault(part.id(), part)
    counts = Counter(owners[number] for number, part in parts.items() if part.Representation)
    kept: dict[int, dict[int, Shape]] = {}
    for number, shape in list_shapes(model, list(parts.values())):
        owner = owners[number]
        if counts[owner] == 1:
            yield owner, shape
        else:
            kept.setdefault(owner, {})[number] = shape
    for owner, shapes in kept.items():  # its own first: its axes count
        yield owner, join([shapes[number] for number in sorted(shapes, key=lambda number: (number != owner, number))])


# ---------------------------------------------------------------- the model


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
    outlines = {one.id(): one for one in list_elements(model, (*WALLS, "IfcWindow"))}
    cuts = {
        number: [cut(shape, storey.level + CUT) for storey in levelled]
        for number, shape in list_shapes(model, list(outlines.values()), with_openings=True)
    }
    walls, windows = dict[str, list[Polygon]](), dict[str, list[Polygon]]()
    for number in sorted(cuts):
        kept = windows if outlines[number].is_a("IfcWindow") else walls
        for storey, polygons in zip(levelled, cuts[number], strict=True):
            kept.setdefault(storey.key, []).extend(polygons)
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
        pieces=tuple(pieces), walls={key: merge(some) for key, some in walls.items()},
        windows={key: merge(some) for key, some in windows.items()}, skipped=skipped, warnings=(*warnings, *doubts),
        remarks=tuple(remarks), **_describe_site(model),
    )  # fmt: skip
    return bring_near(read)


def _describe_site(model: Any) -> dict[str, Any]:
    """Return name, address, latitude, longitude and the compass direction of X [deg], as far as they are given."""
    buildings, projects = model.by_type("IfcBuilding"), model.by_type("IfcProject")
    named = [clean_text(one.LongName) or clean_text(one.Name) for one in (*buildings, *projects)]
    address = next((one.BuildingAddress for one in buildings if one.BuildingAddress), None)
    lines = [*(address.AddressLines or ())] if address is not None else []
    lines += [getattr(address, name, None) for name in ("PostalCode", "Town", "Region", "Country")]
    found: dict[str, Any] = {
        "name": next(filter(None, named), ""),
        "address": ", ".join(filter(None, map(clean_text, lines))),
    }
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
    keys = make_keys(storeys)
    for number, one in enumerate(storeys, 1):
        own = None if one.Elevation is None else float(one.Elevation) * unit
        level = float(get_storey_elevation(one)) * unit if one.ObjectPlacement is not None else own or 0.0
        name = clean_text(one.Name) or clean_text(one.LongName) or str(number)
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
    keys = make_keys(spaces.values())
    shapes = dict(list_shapes(model, list(spaces.values())))
    for number, one in spaces.items():
        storey, shape = _find_known(one, storeys), shapes.get(number)
        if shape is not None and storey is not None and (area := find_base(shape)) is not None:
            name, title = clean_text(one.Name), clean_text(one.LongName)
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
    keys = make_keys(doors)
    fills = ((one.id(), fill.RelatingOpeningElement) for one in doors for fill in one.FillsVoids)
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
            keys[one.id()], storey, clean_text(one.Name), plan.x, plan.y, plan.angle_deg, plan.long, plan.short,
            overall if math.isfinite(overall) and overall > 0 else 0.0,
        )  # fmt: skip


def _list_stairs(model: Any, storeys: Sequence[Storey]) -> Iterator[Stair]:
    stairs = {one.id(): one for one in list_outer(list_elements(model, STAIRS))}
    keys = make_keys(stairs.values())
    for number, shape in sorted(join_parts(model, list(stairs.values())), key=lambda one: one[0]):
        key, name, low, high = keys[number], clean_text(stairs[number].Name), shape.bottom, shape.top
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


# ---------------------------------------------------------------- furniture


def _find_pieces(
    model: Any, storeys: Sequence[Storey], spaces: Sequence[Space], also: Sequence[str]
) -> tuple[list[Piece], tuple[Storey, ...], tuple[Skipped, ...], list[Text]]:
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
        self.elements, self.keys = elements, make_keys(elements.values())
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
            ifc_class=element.is_a(), name=name or clean_text(element.Name), type=kind, bottom=bottom - floor,
            is_fitted=any(word in kind.casefold() for word in FITTED), **asdict(box),
        )  # fmt: skip
        self.bounds[number] = np.concatenate([shape.points.min(axis=0), shape.points.max(axis=0)])

    def settle_levels(self) -> list[Text]:
        """Move the floor of a storey where nearly all pieces are off it by one height; return warnings.

        One piece tells it where that is the height by the Elevation of the model. At heights of `_HUNG` furniture may
        hang on walls.
        """
        warnings = []
        for storey in self.storeys.values():
            own = [number for number, one in self.pieces.items() if one.storey == storey.key and not one.space]
            bottoms = [self.pieces[number].bottom for number in own]
            shift = float(np.median(bottoms)) if bottoms else 0.0
            nearly_all = sum(abs(one - shift) <= _ALIKE for one in bottoms) >= _NEARLY_ALL * len(bottoms)
            is_clear = len(bottoms) >= _FEWEST and not _HUNG[0] <= shift <= _HUNG[1]
            is_stated = abs(shift - (storey.elevation - storey.level)) <= _ALIKE
            if abs(shift) > ON_FLOOR and nearly_all and (is_clear or is_stated):
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
        for (first, *others), is_whole in list(find_stacks(groups.values(), self.bounds, on_floor, at_side=True)):
            name = clean_text(self._wholes[first].Name) if is_whole else ""
            self._take(first, join([self._shapes[number] for number in (first, *others)]), name)
            gone |= {*others}
        for number in gone:
            del self.pieces[number], self.bounds[number]
        return gone


def _name_type(element: Element) -> str:
    """Return the type of an element in words. Revit writes ``Family:Type:Number`` as the name, others the type."""
    from ifcopenshell.util.element import get_type

    kind = get_type(element)
    type_name = clean_text(kind.Name) if kind is not None else ""
    name, tag = clean_text(element.Name), clean_text(getattr(element, "Tag", None))
    parts = [part.strip() for part in name.split(":")]
    if len(parts) > 1:
        if parts[-1] == tag or parts[-1].isdigit():
            parts.pop()
        return " ".join(dict.fromkeys(filter(None, parts)))
    return type_name or clean_text(getattr(element, "ObjectType", None)) or name or element.is_a()
