"""The furniture of a building model: which elements are pieces, where they stand, and what is left out."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from assess.bim.building_model import (
    NOT_ON_FLOOR,
    ON_FLOOR,
    Piece,
    Point,
    Skipped,
    Space,
    Storey,
    count_skipped,
    name_skipped,
)
from assess.bim.ifc_elements import (
    Element,
    find_holders,
    find_key,
    find_storey,
    find_whole,
    join_parts,
    list_elements,
    list_outer,
    say,
    tell_apart,
)
from assess.bim.plan_shapes import FloatArray, Shape, SpaceSearch, find_box, find_stacks, join, note_stacked
from assess.errors import ModelError
from assess.i18n import Text, fill

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


def find_pieces(
    model: Any, storeys: Sequence[Storey], spaces: Sequence[Space], also: Sequence[str] = ()
) -> tuple[list[Piece], tuple[Storey, ...], tuple[Skipped, ...], list[Text]]:
    """Return the pieces of a model, its storeys with the levels of their floors, what was left out, and warnings.

    Raises ModelError if `also` names a class that the schema of the model does not have, or there are over
    `MOST_PIECES` pieces.
    """
    from ifcopenshell.util.element import get_type

    _check_classes(model, also)
    wanted = {one.id() for one in list_elements(model, (*FURNITURE, *also))}
    every = list_outer(list_elements(model, (*FURNITURE, *OTHERS, *also)))

    def is_appliance(one: Element) -> bool:
        kind = get_type(one) if one.is_a("IfcDistributionElement") else None
        return kind is not None and kind.is_a() in APPLIANCES

    elements = {one.id(): one for one in every if one.id() in wanted or is_appliance(one)}
    if len(elements) > MOST_PIECES:
        raise ModelError(
            fill("The model holds {n:,} pieces of furniture, more than {most:,}. Export fewer storeys.",
                 n=len(elements), most=MOST_PIECES)
        )  # fmt: skip
    skipped: list[tuple[str, Text, bool]] = []

    def skip(one: Element, reason: Text, *, is_furniture: bool = True) -> None:
        skipped.append((name_skipped(one.is_a(), _name_type(one)), reason, is_furniture))

    for one in every:
        if one.id() not in elements:
            skip(one, NO_PIECE, is_furniture=False)
    shaped = _Shaped(model, elements, storeys, spaces)
    warnings = shaped.settle_levels()
    parts = shaped.join_groups()
    pieces = []
    for number, element in elements.items():
        piece = shaped.pieces.get(number)
        if piece is None and number not in parts:
            skip(element, NO_SHAPE)
        elif piece is not None and piece.bottom > ON_FLOOR:
            skip(element, NOT_ON_FLOOR)
        elif piece is not None:
            pieces.append(piece)
    return pieces, tuple(shaped.storeys.values()), count_skipped(skipped), [*warnings, *shaped.note_stacked()]


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
        element, box = self.elements[number], find_box(shape)
        storey, space = self._find_place(element, (box.x, box.y), shape.bottom)
        floor = space.bottom if space is not None else self.storeys[storey].level
        kind = name or _name_type(element)
        self.pieces[number] = Piece(
            key=self.keys[number], storey=storey, space=space.key if space is not None else "",
            ifc_class=element.is_a(), name=name or say(element.Name), type=kind, bottom=shape.bottom - floor,
            is_fitted=any(word in kind.casefold() for word in FITTED), **asdict(box),
        )  # fmt: skip
        self.bounds[number] = np.concatenate([shape.points.min(axis=0), shape.points.max(axis=0)])

    def _find_place(self, element: Element, at: Point, bottom: float) -> tuple[str, Space | None]:
        """Return storey and room of an element: what holds it in the model, else the smallest that it stands in."""
        holder = next((find_key(one) for one in find_holders(element) if one.is_a("IfcSpace")), "")
        if holder in self._spaces:
            return self._spaces[holder].storey, self._spaces[holder]
        storey = find_storey(element)
        if storey not in self.storeys:
            below = [one for one in self.storeys.values() if one.level <= bottom + _NEAR_FLOOR]
            storey = (max(below, key=lambda one: one.level) if below else next(iter(self.storeys.values()))).key
        there = self._search.find(storey, at)
        return storey, next((one for one in there if one.bottom - _NEAR_FLOOR <= bottom <= one.top), None)

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

    def note_stacked(self) -> list[Text]:
        on_floor = [number for number, one in self.pieces.items() if one.bottom <= ON_FLOOR]
        off = [number for number, one in self.pieces.items() if one.bottom > ON_FLOOR]
        names = [self.pieces[number].name or self.pieces[number].type for number in on_floor]
        return note_stacked(names, *(np.array([self.bounds[one] for one in own]) for own in (on_floor, off)))


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


def _check_classes(model: Any, classes: Sequence[str]) -> None:
    import ifcopenshell

    schema = ifcopenshell.ifcopenshell_wrapper.schema_by_name(model.schema_identifier)
    for name in classes:
        try:
            entity = schema.declaration_by_name(name).as_entity()
        except RuntimeError:
            entity = None
        if entity is None:
            raise ModelError(
                fill("{name} is not a class of {schema}. Classes have names such as {example}.", name=name[:60],
                     schema=model.schema_identifier, example="IfcBuildingElementProxy")
            )  # fmt: skip


def _name_type(element: Element) -> str:
    """Return the type of an element in words: as a program for buildings shows it, without its number.

    Revit writes ``Family:Type:Number`` as the name, others the name of the type alone.
    """
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
