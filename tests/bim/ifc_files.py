"""Small building models, written with ifcopenshell: boxes on storeys, in rooms, with doors."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.guid

from assess.bim.building_model import BuildingModel
from assess.bim.ifc_model import read_model
from assess.bim.import_workbook import ImportedBuilding, build_workbook


@dataclass
class ModelWriter:
    """Writes one model; lengths are in its unit.

    `units` is what UnitsInContext holds: "METRE", "MILLI" (METRE), "FOOT" or None.
    """

    schema: str = "IFC4"
    units: str | None = "METRE"
    north: tuple[float, float] | None = None
    file: Any = None
    storeys: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.file = ifcopenshell.file(schema=self.schema)
        make = self.file.create_entity
        self.person = make("IfcPerson", FamilyName="Tester")
        organisation = make("IfcOrganization", Name="Tests")
        user = make("IfcPersonAndOrganization", self.person, organisation)
        program = make("IfcApplication", organisation, "1", "Tests", "tests")
        self.owner = make(
            "IfcOwnerHistory", OwningUser=user, OwningApplication=program, ChangeAction="ADDED", CreationDate=0
        )
        origin = self.place()
        north = make("IfcDirection", self.north) if self.north else None
        self.context = make("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, origin, north)
        project = self.root(
            "IfcProject", "Project", RepresentationContexts=[self.context], UnitsInContext=self._units()
        )
        self.site = self.root("IfcSite", "Site", ObjectPlacement=self.local())
        self.building = self.root("IfcBuilding", "Building", ObjectPlacement=self.local())
        self.aggregate(project, self.site)
        self.aggregate(self.site, self.building)

    def _units(self) -> Any:
        make = self.file.create_entity
        if self.units is None:
            return None
        if self.units == "FOOT":
            size = make(
                "IfcMeasureWithUnit",
                make("IfcLengthMeasure", 0.3048),
                make("IfcSIUnit", None, "LENGTHUNIT", None, "METRE"),
            )
            zero = make("IfcDimensionalExponents", 1, 0, 0, 0, 0, 0, 0)
            unit = make("IfcConversionBasedUnit", zero, "LENGTHUNIT", "FOOT", size)
        else:
            unit = make("IfcSIUnit", None, "LENGTHUNIT", "MILLI" if self.units == "MILLI" else None, "METRE")
        return make("IfcUnitAssignment", [unit])

    # ------------------------------------------------------------ parts

    def root(self, kind: str, name: str | None, **more: Any) -> Any:
        return self.file.create_entity(
            kind, GlobalId=ifcopenshell.guid.new(), OwnerHistory=self.owner, Name=name, **more
        )

    def aggregate(self, whole: Any, *parts: Any) -> None:
        self.root("IfcRelAggregates", None, RelatingObject=whole, RelatedObjects=parts)

    def place(self, at=(0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), x=(1.0, 0.0, 0.0)) -> Any:
        make = self.file.create_entity
        middle, axis, along = (tuple(map(float, one)) for one in (at, up, x))
        point = make("IfcCartesianPoint", middle)
        return make("IfcAxis2Placement3D", point, make("IfcDirection", axis), make("IfcDirection", along))

    def local(self, at=(0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), x=(1.0, 0.0, 0.0)) -> Any:
        return self.file.create_entity("IfcLocalPlacement", None, self.place(at, up, x))

    def solid(self, *boxes: tuple[float, float, float, float, float, float]) -> Any:
        """Return the shape of boxes: x, y, z of the middle of their base, sizes along x, y, z."""
        make = self.file.create_entity
        solids = []
        for x, y, z, wide, deep, tall in boxes:
            flat = make("IfcAxis2Placement2D", make("IfcCartesianPoint", (0.0, 0.0)), make("IfcDirection", (1.0, 0.0)))
            profile = make("IfcRectangleProfileDef", "AREA", None, flat, float(wide), float(deep))
            up = make("IfcDirection", (0.0, 0.0, 1.0))
            solids.append(make("IfcExtrudedAreaSolid", profile, self.place((x, y, z)), up, float(tall)))
        shape = make("IfcShapeRepresentation", self.context, "Body", "SweptSolid", solids)
        return make("IfcProductDefinitionShape", None, None, [shape])

    # ------------------------------------------------------------ what a building holds

    def storey(self, name: str = "Level 1", elevation: float | None = 0.0, z: float | None = None) -> Any:
        level = z if z is not None else elevation or 0.0
        one = self.root("IfcBuildingStorey", name, ObjectPlacement=self.local((0, 0, level)), Elevation=elevation)
        self.aggregate(self.building, one)
        self.storeys[name] = one
        return one

    def space(
        self,
        storey: Any,
        box: tuple[float, float, float, float, float, float],
        name: str = "101",
        title: str | None = None,
    ) -> Any:
        one = self.root("IfcSpace", name, LongName=title, ObjectPlacement=self.local(), Representation=self.solid(box))
        self.aggregate(storey, one)
        return one

    def element(
        self,
        kind: str,
        name: str | None,
        *boxes: Any,
        within: Any = None,
        at=(0, 0, 0),
        x=(1, 0, 0),
        up=(0, 0, 1),
        **more: Any,
    ) -> Any:
        """Return an element of boxes, placed, and contained in a storey or a space."""
        shape = self.solid(*boxes) if boxes else None
        one = self.root(kind, name, ObjectPlacement=self.local(at, up, x), Representation=shape, **more)
        if within is not None:
            self.root("IfcRelContainedInSpatialStructure", None, RelatedElements=[one], RelatingStructure=within)
        return one

    def piece(self, name: str | None, *boxes: Any, within: Any = None, **more: Any) -> Any:
        kind = "IfcFurnishingElement" if self.schema == "IFC2X3" else "IfcFurniture"
        return self.element(kind, name, *boxes, within=within, **more)

    def typed(self, kind: str, name: str, *elements: Any) -> Any:
        more = {"AssemblyPlace": "NOTDEFINED"} if kind == "IfcFurnitureType" else {"PredefinedType": "NOTDEFINED"}
        one = self.root(kind, name, **more)
        self.root("IfcRelDefinesByType", None, RelatedObjects=elements, RelatingType=one)
        return one

    def write(self, path: Path) -> Path:
        self.file.write(str(path))
        return path


def one_room(
    schema: str = "IFC4", units: str | None = "METRE", scale: float = 1.0, **more: Any
) -> tuple[ModelWriter, Any, Any]:
    """Return a writer with a storey and a room of 6 x 4 x 3 m, `scale` units a metre; also the two."""
    model = ModelWriter(schema, units, **more)
    storey = model.storey()
    room = model.space(storey, tuple(scale * one for one in (3, 2, 0, 6, 4, 3)), "101", "Office")
    return model, storey, room


def read(model: ModelWriter, folder: Path) -> BuildingModel:
    return read_model(model.write(folder / "a.ifc"), "a.ifc")


def write_import(found: ImportedBuilding, folder: Path) -> Path:
    """Write the workbook of an import, with its plans beside it."""
    for name, data in found.files.items():
        (folder / name).write_bytes(data)
    (folder / "book.xlsx").write_bytes(build_workbook(found))
    return folder / "book.xlsx"
