"""The furniture of a building model: which elements are pieces, where they stand, and what is left out."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from assess.bim.building_model import NOT_ON_FLOOR, ON_FLOOR, LeftOut, Piece, Space, Storey
from assess.bim.ifc_elements import (
    Element,
    find_holders,
    find_key,
    find_storey,
    join_parts,
    list_elements,
    list_outer,
    tell_apart,
)
from assess.bim.ifc_site import say
from assess.bim.plan_shapes import Shape, find_box
from assess.bim.space_search import SpaceSearch
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
_NEAR_FLOOR = 0.3
"""How far below the floor of a room a piece may begin to stand in it [m]."""


@dataclass(slots=True)
class FoundPieces:
    """Pieces, and how many elements were left out by class, type, reason and whether they may be furniture."""

    pieces: list[Piece] = field(default_factory=list)
    left_out: Counter[tuple[str, str, Text, bool]] = field(default_factory=Counter)

    def leave_out(self, element: Element, reason: Text, *, is_furniture: bool = True) -> None:
        """Count an element that is left out."""
        self.left_out[element.is_a(), name_type(element), reason, is_furniture] += 1

    def list_left_out(self) -> tuple[LeftOut, ...]:
        """Return what was left out."""
        return tuple(LeftOut(*one[:3], count=number, is_furniture=one[3]) for one, number in self.left_out.items())


def find_pieces(
    model: Any, storeys: Sequence[Storey], spaces: Sequence[Space], also: Sequence[str] = ()
) -> FoundPieces:
    """Return the pieces of a model.

    Raises ModelError if `also` names a class that the schema of the model does not have, or there are over
    `MOST_PIECES` pieces.
    """
    found = FoundPieces()
    _check_classes(model, also)
    wanted = {one.id() for one in list_elements(model, (*FURNITURE, *also))}
    every = list_outer(list_elements(model, (*FURNITURE, *OTHERS, *also)))
    pieces = {one.id(): one for one in every if one.id() in wanted or _is_appliance(one)}
    if len(pieces) > MOST_PIECES:
        raise ModelError(
            fill("The model holds {n:,} pieces of furniture, more than {most:,}. Export fewer storeys.", n=len(pieces),
                 most=MOST_PIECES)
        )  # fmt: skip
    for one in every:
        if one.id() not in pieces:
            found.leave_out(one, NO_PIECE, is_furniture=False)
    places, keys = _Places(storeys, spaces), tell_apart(pieces.values())
    shaped: dict[int, Piece] = {}
    for number, shape in join_parts(model, list(pieces.values())):
        shaped[number] = _to_piece(pieces[number], keys[number], shape, places)
    for number, element in pieces.items():
        piece = shaped.get(number)
        if piece is None:
            found.leave_out(element, NO_SHAPE)
        elif piece.bottom > ON_FLOOR:
            found.leave_out(element, NOT_ON_FLOOR)
        else:
            found.pieces.append(piece)
    return found


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


def _is_appliance(element: Element) -> bool:
    from ifcopenshell.util.element import get_type

    if not element.is_a("IfcDistributionElement"):
        return False
    kind = get_type(element)
    return kind is not None and kind.is_a() in APPLIANCES


def name_type(element: Element) -> str:
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


def _is_fitted(kind: str) -> bool:
    return any(word in kind.casefold() for word in FITTED)


class _Places:
    """Finds the storey and the room of an element: that which holds it in the model, else the smallest it stands in."""

    def __init__(self, storeys: Sequence[Storey], spaces: Sequence[Space]) -> None:
        self.storeys = {one.key: one for one in storeys}
        self._spaces = {one.key: one for one in spaces}
        of_storey: dict[str, list[Space]] = {}
        for one in spaces:
            of_storey.setdefault(one.storey, []).append(one)
        self._searches = {storey: SpaceSearch(own) for storey, own in of_storey.items()}

    def find(self, element: Element, x: float, y: float, bottom: float) -> tuple[str, Space | None]:
        """Return the key of the storey, and the space."""
        holder = next((find_key(one) for one in find_holders(element) if one.is_a("IfcSpace")), "")
        if holder in self._spaces:
            return self._spaces[holder].storey, self._spaces[holder]
        storey = find_storey(element)
        if storey not in self.storeys:
            below = [one for one in self.storeys.values() if one.level <= bottom + _NEAR_FLOOR]
            storey = (max(below, key=lambda one: one.level) if below else next(iter(self.storeys.values()))).key
        return storey, next(self._list_at(storey, x, y, bottom), None)

    def _list_at(self, storey: str, x: float, y: float, bottom: float) -> Iterator[Space]:
        if storey in self._searches:
            for space in self._searches[storey].find_all([(x, y)])[0]:
                if space.bottom - _NEAR_FLOOR <= bottom <= space.top:
                    yield space


def _to_piece(element: Element, key: str, shape: Shape, places: _Places) -> Piece:
    box = find_box(shape)
    storey, space = places.find(element, box.x, box.y, shape.bottom)
    floor = space.bottom if space is not None else places.storeys[storey].level
    kind = name_type(element)
    return Piece(
        key=key, storey=storey, space=space.key if space is not None else "",
        ifc_class=element.is_a(), name=say(element.Name), type=kind, x=box.x, y=box.y, breadth=box.breadth,
        width=box.width, height=box.height, angle_deg=box.angle_deg, support_breadth=box.support_breadth,
        support_width=box.support_width, bottom=shape.bottom - floor, is_fitted=_is_fitted(kind),
        support_reach=box.base.reach, support_angle_deg=box.base.angle_deg, support_across=box.base.across,
    )  # fmt: skip
