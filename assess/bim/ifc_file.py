"""A building model as a file, what can be told of it before the library opens it, and its elements: texts, shapes.

The library takes a file that breaks off as if it were whole, with the elements up to there. So the end is looked for
first. STEP physical files: ISO 10303-21, of which a first line, a header and a last line are required.
"""

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from assess.bim.plan_shapes import Shape, join
from assess.environment import say_install
from assess.errors import ModelError
from assess.i18n import Text, fill
from assess.resources import open_input
from assess.workbook.values import ERRORS, read_text

Element = Any
"""An entity of ifcopenshell."""
MOST_BYTES = 512 * 2**20
"""Size of a model that is read [bytes]."""
FIRST, LAST = b"ISO-10303-21;", b"END-ISO-10303-21;"
_LOOKED_AT = 65536
_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']{1,80})'", re.IGNORECASE)
SCHEMAS = ("IFC2X3", "IFC4", "IFC4X3")
"""Schemas that are read, with their corrections such as IFC4X3_ADD2."""
_NO_MODEL = fill("it does not begin as an IFC file (ISO-10303-21) does. Export the building as IFC (.ifc, STEP)")
_DEEPEST = 20
"""Levels of parts and containers that are followed: a model may hold a loop."""
THREADS = 1
"""Of the library: two wait for each other for ever at some damaged elements, and are no faster on small models."""
MOST_TRIANGLES = 2_000_000
"""Triangles of one element beyond which its shape is not taken."""
FARTHEST = 1e8
"""Distance from the origin beyond which a shape is not taken [m]: no map grid reaches as far."""

_PLACEHOLDERS = ("enter address here", "//", "default", "<default>", "project number", "project name", "undefined")
"""What programs write where nobody has typed a name or an address."""
LONGEST = 1000
"""Characters that are kept of a text."""
_Found = TypeVar("_Found")


def is_model(start: bytes) -> bool:
    """Tell whether a file begins as a STEP physical file does."""
    return start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(FIRST)


def check_model(path: Path, name: str) -> None:
    """Raise unless a file is a whole STEP file of a known schema, as far as can be told without reading all of it.

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
        why = _say_schema(schema)
    if why is not None:
        raise unreadable(name, why)


def unreadable(name: str, why: OSError | Text) -> ModelError:
    """Return the error of a file that cannot be read."""
    reason = why.strerror or str(why) if isinstance(why, OSError) else why
    return ModelError(fill("{name} cannot be read: {why}.", name=name, why=reason))


def _say_schema(schema: str) -> Text:
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
            raise unreadable(name, _say_schema(schema)) from None
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


def say(value: object) -> str:
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
    """Return the outermost element that an element is a part of; None where it is no part."""
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


def tell_apart(elements: Iterable[Element]) -> dict[int, str]:
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
