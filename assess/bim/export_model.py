"""What an export needs to know of a building model, as plain data; call `read_elements` in a process of its own."""

import math
import uuid
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from assess.bim.ifc_model import find_unit, join_parts, read_with

PROPERTY_SET = "Assess_OverturningRisk"  # name of the set; the prefix Pset_ is that of buildingSMART
NOT_FURNITURE = (
    "IfcWall", "IfcCurtainWall", "IfcSlab", "IfcRoof", "IfcCovering", "IfcDoor", "IfcWindow", "IfcColumn", "IfcBeam",
    "IfcStair", "IfcStairFlight", "IfcRamp", "IfcRampFlight", "IfcRailing", "IfcFeatureElement",
)  # fmt: skip
"""Classes whose elements, with their subclasses, are no pieces: an import may take all others by name."""
_NAMESPACE = uuid.UUID("07e57c2d-3231-4d20-9929-8e605d3154f5")
"""Of identifiers that are made from what they stand for, so that the same export gives the same ones."""
Place = tuple[float, float, float]
Box = tuple[Place, Place]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelElement:
    """An element, its number in the file, and that of the OwnerHistory for what is added, or 0. `box` and `room` are
    the boxes around it and around its room [m]; None where there is none, or that was not asked for.
    """

    key: str
    name: str
    number: int
    owner: int
    has_set: bool
    box: Box | None = None
    room: Box | None = None


@dataclass(frozen=True, slots=True)
class ModelDoor:
    """A door: two points of its opening in plan, the height of its sill, and corners of the box around it [m]."""

    key: str
    name: str
    points: tuple[tuple[float, float], ...]
    bottom: float
    box: Box | None = None


@dataclass(frozen=True, slots=True)
class ModelPart:
    """What was found of a model; `refused` are the classes, by GlobalId, of what was sought but is not furniture."""

    project: str
    last_number: int
    elements: tuple[ModelElement, ...]
    doors: tuple[ModelDoor, ...] = ()
    refused: Mapping[str, str] = field(default_factory=dict)


def make_uuid(kind: str, *keys: str) -> uuid.UUID:
    """Return the identifier of what is made of something in a model: always the same for the same kind and keys."""
    return uuid.uuid5(_NAMESPACE, "\n".join((kind, *keys)))


def read_elements(path: Path, name: str, keys: Sequence[str], placed: Sequence[str] | None) -> ModelPart:
    """Find elements in a building model by their GlobalIds.

    `keys`: GlobalIds; those that nothing in the model has are left out of what is returned.
    `placed`: those of which the place is needed, and with them the doors; None where no place is.
    Raises ModelError if it is not a whole building model, or names no unit of length and places are needed.
    """

    def understand(model: Any) -> ModelPart:
        from ifcopenshell.util.element import get_psets

        known: dict[str, Any] = {}
        for key in keys:
            with suppress(RuntimeError):  # nothing has it
                known[key] = model.by_guid(key)
        found = {
            key: one
            for key, one in known.items()
            if one.is_a("IfcElement") and not any(one.is_a(name) for name in NOT_FURNITURE)
        }
        boxes, rooms, doors = dict[int, Box](), list[Box](), list[ModelDoor]()
        if placed is not None:
            unit = find_unit(model, name)
            boxes = _find_boxes(model, [found[key] for key in placed if key in found], unit)
            rooms = list(_find_boxes(model, model.by_type("IfcSpace"), unit).values()) if boxes else []
            rooms.sort(key=lambda box: math.prod(high - low for low, high in zip(*box, strict=True)))
            door_boxes = _find_boxes(model, model.by_type("IfcDoor"), unit)
            for one in model.by_type("IfcDoor"):  # its origin is at one of its jambs, its opening lies along X
                middle = float(one.OverallWidth or 0.0) * unit / 2
                places = [place for along in (0.0, middle) if (place := _find_origin(one, unit, along)) is not None]
                if places:
                    points, box = tuple((x, y) for x, y, _ in places), door_boxes.get(one.id())
                    doors.append(ModelDoor(str(one.GlobalId), str(one.Name or ""), points, places[0][2], box))
        elements = []
        for key, one in found.items():
            box, owner = boxes.get(one.id()), one.OwnerHistory
            around = (
                room
                for room in rooms
                if box
                and all(low <= x <= high for low, x, high in zip(room[0], find_middle(box), room[1], strict=True))
            )
            if not owner and model.schema == "IFC2X3":  # which demands one
                owner = next(iter(model.by_type("IfcOwnerHistory")), None)
            elements.append(
                ModelElement(
                    key=key, name=str(one.Name or ""), number=one.id(), owner=owner.id() if owner else 0, box=box,
                    has_set=PROPERTY_SET in get_psets(one, psets_only=True, should_inherit=False),
                    room=next(around, None),  # the smallest
                )
            )  # fmt: skip
        projects = model.by_type("IfcProject")
        return ModelPart(
            project=str(projects[0].GlobalId) if projects else "",
            last_number=max((one.id() for one in model), default=0),
            elements=tuple(elements),
            doors=tuple(doors),
            refused={key: str(one.is_a()) for key, one in known.items() if key not in found},
        )

    return read_with(path, name, understand)


def find_middle(box: Box) -> Place:
    """Return the middle of a box."""
    x, y, z = ((low + high) / 2 for low, high in zip(*box, strict=True))
    return x, y, z


def _find_boxes(model: Any, elements: Sequence[Any], unit: float) -> dict[int, Box]:
    boxes = {one.id(): (place, place) for one in elements if (place := _find_origin(one, unit)) is not None}
    for number, shape in join_parts(model, elements):
        low, high = shape.points.min(axis=0).tolist(), shape.points.max(axis=0).tolist()
        boxes[number] = ((low[0], low[1], low[2]), (high[0], high[1], high[2]))
    return boxes


def _find_origin(one: Any, unit: float, along: float = 0.0) -> Place | None:
    """Return the origin of an element [m], or the point at a distance [m] `along` its X axis."""
    from ifcopenshell.util.placement import get_local_placement

    if one.ObjectPlacement is None:
        return None
    matrix = get_local_placement(one.ObjectPlacement)
    x, y, z = (float(matrix[axis][3]) * unit + along * float(matrix[axis][0]) for axis in range(3))
    return x, y, z
