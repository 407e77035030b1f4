"""The furniture: sizes from the catalogue, the axis from the angle, and what does not fit together."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from assess.inventory.axes import axis_of
from assess.inventory.beside import check_beside
from assess.inventory.labels import key
from assess.inventory.model import Building, CatalogueType, Item
from assess.inventory.names import check_references, check_unique
from assess.inventory.tables import Row, Table
from assess.language import fill
from assess.units import ROUNDING


@dataclass(frozen=True, slots=True)
class ItemReader:
    """Builds the items from their table; problems are reported to it."""

    tables: Mapping[str, Table]
    building: Building
    types: Mapping[str, CatalogueType]
    lacking: dict[str, list[int]] = field(default_factory=dict)

    def read(self) -> tuple[Item, ...]:
        """Return the items."""
        table = self.tables["Items"]
        check_unique(table, "item")
        check_references(table, "floor", self.tables["Floors"], "floor")
        check_references(table, "type", self.tables["Catalogue"], "type")
        check_beside(self.tables)
        built = (self._item(table, row) for row in table.rows)
        items = tuple(item for item in built if item is not None)
        for name, rows in self.lacking.items():
            header = table.sheet.column(name).header()
            which = f"row {rows[0]} has" if len(rows) == 1 else f"row {rows[0]} and {len(rows) - 1} more have"
            message = f"the column {header} is missing, and {which} no Type that gives it."
            table.report("A1", message, "Add the column, or give those rows such a Type.")
        return items

    def _item(self, table: Table, row: Row) -> Item | None:
        values = dict(row.values)
        assumed = self._fill_sizes(table, row.number, values)
        _check_sizes(table, row.number, values)
        _check_position(table, row.number, values)
        _check_axis(table, row.number, values)
        if values.get("axis") is None and values.get("angle_deg") is not None:
            values["axis"] = axis_of(values["angle_deg"])
            assumed += ["axis"] if values["axis"] else []
        if values.get("friction") is None and self.building.friction is not None:
            values["friction"] = self.building.friction
            assumed.append("friction")
        assumed += [name for name in ("quantity", "anchored") if values.get(name) is None]
        if any(values.get(name) is None for name in ("item", "floor", "breadth", "height")):
            return None  # the reason has been reported
        filled = {name: value for name, value in values.items() if value is not None}
        return Item(row=row.number, **filled, assumed=tuple(assumed), extra=row.extra)

    def _fill_sizes(self, table: Table, row: int, values: dict[str, Any]) -> list[str]:
        """Fill blank sizes in from the catalogue; return the fields filled in."""
        assumed, kind = [], self.types.get(key(values.get("type") or ""))
        for name in ("breadth", "width", "height"):
            if values.get(name) is not None or table.spoilt(name, row):
                continue
            values[name] = getattr(kind, name, None)
            if values[name] is not None:
                assumed.append(name)
            elif name != "width" and name not in table.letters:
                self.lacking.setdefault(name, []).append(row)  # said once for the column, not in every row
            elif name != "width" and not table.spoilt("type", row):
                label = table.label("type")
                message = f"{table.label(name)} is blank and no {label} gives it."
                table.report(table.cell(name, row), message, f"Fill it in, or choose a {label} that has one.")
        return assumed


def _check_axis(table: Table, row: int, values: Mapping[str, Any]) -> None:
    """Warn of an axis that the angle contradicts: one of the two is a slip, and one of them may be the milder."""
    axis, angle = values.get("axis"), values.get("angle_deg")
    turned = axis_of(angle) if angle is not None else None
    if axis is not None and turned is not None and axis != turned:
        message = fill(
            "Axis is {axis}, but an Angle of {angle:g} deg lies along {turned}; {axis} is used.",
            axis=axis,
            angle=angle,
            turned=turned,
        )
        table.report(table.cell("axis", row), message, fill("Correct one of the two."), "warning")


def check_plan_sides(table: Table, row: int, values: Mapping[str, Any]) -> None:
    """Report a Breadth that is greater than the Width: Breadth is the shorter plan side."""
    breadth, width = values.get("breadth"), values.get("width")
    if breadth is not None and width is not None and breadth > width * (1 + ROUNDING):
        shorter = table.label("breadth")
        message = f"{shorter} {breadth * 100:g} cm is greater than {table.label('width')} {width * 100:g} cm."
        mend = f"{shorter} is the shorter plan side: exchange the two."
        table.report(table.cell("breadth", row), message, mend)


def _check_sizes(table: Table, row: int, values: Mapping[str, Any]) -> None:
    check_plan_sides(table, row, values)
    breadth, height = values.get("breadth"), values.get("height")
    if breadth is not None and height is not None and breadth > height * (1 + ROUNDING):
        message = fill(
            "Breadth {breadth:g} cm is greater than Height {height:g} cm.", breadth=breadth * 100, height=height * 100
        )
        table.report(table.cell("breadth", row), message, fill("Are the two exchanged?"), "warning")


def _check_position(table: Table, row: int, values: Mapping[str, Any]) -> None:
    x, y, quantity = (values.get(name) for name in ("x", "y", "quantity"))
    if (x is not None or y is not None) and (quantity or 1) > 1:
        message = f"{table.label('quantity')} is {quantity} on a row with a position."
        table.report(table.cell("quantity", row), message, "Write one row a piece, or clear X and Y.")
    if (x is None) != (y is None) and not (table.spoilt("x", row) or table.spoilt("y", row)):
        cell = table.cell("y" if y is None else "x", row)
        message = fill("a position needs both X and Y.")
        table.report(cell, message, fill("Fill in the other, or clear both."), "warning")
