"""A building model in IFC (ISO 16739-1: IFC2X3, IFC4, IFC4X3) as plain data.

Shapes are trusted, names and properties are not: sizes are those of the shapes, exits are found by the rooms on both
sides of a door, whatever its IsExternal says.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from assess.bim.building_model import BuildingModel, Storey
from assess.bim.ifc_file import check_model, find_damage, open_model
from assess.bim.ifc_pieces import FoundPieces, find_pieces
from assess.bim.ifc_rooms import cut_walls, list_doors, list_spaces, list_stairs
from assess.bim.ifc_site import find_azimuth, find_names, find_position, find_unit, list_storeys
from assess.bim.model_position import bring_near
from assess.errors import ModelError
from assess.i18n import Text, fill, nfill


def read_model(path: Path, name: str, also: Sequence[str] = ()) -> BuildingModel:
    """Read a building model; call it in a process of its own (`assess.bim.model_process`).

    `also`: further classes whose elements are pieces, such as IfcBuildingElementProxy.
    Raises ModelError if it is no whole building model, names no unit of length, holds no building, or `also` names no
    class.

    """
    check_model(path, name)
    model = open_model(path, name)
    try:
        return _understand(model, name, also)
    except (AssertionError, AttributeError, TypeError, ValueError, LookupError, RuntimeError) as error:
        raise find_damage(name, error) from error


def _understand(model: Any, name: str, also: Sequence[str]) -> BuildingModel:
    """Return what a model holds; errors of Python where an entity is of another kind than its schema asks for."""
    unit = find_unit(model, name)
    storeys, warnings = list_storeys(model, unit)
    if not storeys:
        storeys = [_stand_in(model, name)]
        warnings.append(
            fill("The model has no storeys: all of it was put on one floor, {floor}. Check Floor in Items.",
                 floor=storeys[0].name)
        )  # fmt: skip
    return _read(model, name, unit, storeys, also, tuple(warnings))


def _stand_in(model: Any, name: str) -> Storey:
    """Return a storey for a model that has none: its floor is the lowest point of its furniture or rooms."""
    from assess.bim.ifc_elements import list_elements, list_shapes
    from assess.bim.ifc_pieces import FURNITURE

    for classes in (("IfcSpace",), FURNITURE, ("IfcWall",)):
        bottoms = [shape.bottom for _, shape in list_shapes(model, list_elements(model, classes))]
        if bottoms:
            return Storey("", "1", 0.0, min(bottoms))
    raise ModelError(
        fill("{name} holds neither storeys nor rooms, furniture or walls with a shape. Export the building with its "
             "storeys.", name=name)
    )  # fmt: skip


def _read(
    model: Any, name: str, unit: float, storeys: Sequence[Storey], also: Sequence[str], warnings: tuple[Text, ...]
) -> BuildingModel:
    known = {one.key: one for one in storeys}
    spaces = tuple(list_spaces(model, known))
    found = find_pieces(model, storeys, spaces, also)
    storeys = found.storeys
    known = {one.key: one for one in storeys}
    walls, windows = cut_walls(model, storeys)
    title, address = find_names(model)
    latitude, longitude = find_position(model) or (None, None)
    read = BuildingModel(
        source=name, schema=model.schema_identifier, name=title, address=address, storeys=tuple(storeys), spaces=spaces,
        doors=tuple(list_doors(model, known, unit)), stairs=tuple(list_stairs(model, storeys)),
        pieces=tuple(found.pieces), walls=walls, windows=windows, left_out=found.list_left_out(),
        azimuth_deg=find_azimuth(model), latitude=latitude, longitude=longitude,
        warnings=(*warnings, *found.warnings),
        remarks=tuple(_note_rooms(model, spaces, found)),
    )  # fmt: skip
    return bring_near(read)


def _note_rooms(model: Any, spaces: Sequence[Any], found: FoundPieces) -> list[Text]:
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
    outside = sum(not piece.space for piece in found.pieces) if spaces else 0
    if outside:
        remarks.append(
            nfill("{n:,} piece stands in no room of the model: its Room stays blank.",
                  "{n:,} pieces stand in no room of the model: their Room stays blank.", outside)
        )  # fmt: skip
    return remarks
