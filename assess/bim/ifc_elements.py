"""Elements of an open building model: its unit, elements by class, their texts, parts, storeys and shapes."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from assess.bim.plan_shapes import FloatArray, Shape, join
from assess.errors import ModelError
from assess.i18n import fill
from assess.workbook.values import ERRORS, read_text

Element = Any
"""An entity of ifcopenshell."""
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
    def is_near(values: FloatArray) -> bool:
        return bool((np.abs(values) <= FARTHEST).all())

    points = np.array(found.geometry.verts, float).reshape(-1, 3)
    triangles = np.array(found.geometry.faces, np.int64).reshape(-1, 3)
    matrix = np.array(found.transformation.matrix, float).reshape(4, 4).T  # column-major
    if not 0 < len(triangles) <= MOST_TRIANGLES or not (is_near(points) and is_near(matrix)):
        return None
    placed = points @ matrix[:3, :3].T + matrix[:3, 3]
    return Shape(placed, triangles, matrix[:3, :3]) if is_near(placed) else None


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
