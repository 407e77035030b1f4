"""The pieces of a floor on its plan: where they stand, and what they may cover when they fall."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from assess.model import AXES, CatalogueType, Inventory, Outline
from assess.report.figures.labels import Point
from assess.report.figures.underlay import Ring, cut_falls
from assess.routes.geometry import angle_apart, fallen, rectangle
from assess.routes.walls import find_walls
from assess.workbook.parse import Row, Table
from assess.workbook.resolve import SIZES, filled_sizes

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

DEFAULT_SIZE = 0.4
"""Side of a piece whose sizes are missing, so that it can be seen and moved [m]."""
DECIMALS = 4
"""Decimals of coordinates: a tenth of a millimetre."""


@dataclass(frozen=True, slots=True)
class PlacedPiece:
    """A piece with a position; `falls` is what it may cover beyond its footprint [m], `missing` its unknown sizes."""

    row: Row
    at: Point
    angle: float
    breadth: float
    width: float
    height: float | None
    missing: tuple[str, ...]
    falls: tuple[Ring, ...] = ()

    @property
    def corners(self) -> Ring:
        """Its footprint [m]."""
        return rectangle(self.at, self.angle, (-self.breadth / 2, self.breadth / 2), self.width)

    def describe(self) -> dict[str, Any]:
        """Return it as the page takes it."""
        row = self.row
        return {
            "row": row.number,
            "item": row.get("item") or "",
            "description": row.get("description") or row.get("type") or "",
            "x": round(self.at[0], DECIMALS),
            "y": round(self.at[1], DECIMALS),
            "angle": self.angle,
            "breadth": round(self.breadth, DECIMALS),
            "width": round(self.width, DECIMALS),
            "height": None if self.height is None else round(self.height, DECIMALS),
            "anchored": row.get("anchored") or "unknown",
            "quantity": row.get("quantity") or 1,
            "fallen": [round_points(ring) for ring in self.falls],
            "missing": [*self.missing],
        }


def place_pieces(
    table: Table, rows: Iterable[Row], types: Mapping[str, CatalogueType], away: Mapping[int, float]
) -> list[PlacedPiece]:
    """Return the pieces of some rows that have a position.

    `away` holds, of the pieces against a wall, the direction in which each falls [deg], by the number of their row.
    """
    return [
        _place(table, row, types, away.get(row.number))
        for row in rows
        if row.get("x") is not None and row.get("y") is not None
    ]


def _place(table: Table, row: Row, types: Mapping[str, CatalogueType], away: float | None) -> PlacedPiece:
    sizes = filled_sizes(table, row, types)
    breadth, height = sizes.get("breadth"), sizes.get("height")
    width = sizes.get("width", breadth)
    angle = row.get("angle_deg")
    if angle is None:
        angle = 90.0 if row.get("axis") == AXES[1] else 0.0
    piece = PlacedPiece(
        row=row,
        at=(row.get("x"), row.get("y")),
        angle=angle,
        breadth=min(DEFAULT_SIZE, width or DEFAULT_SIZE) if breadth is None else breadth,
        width=width or DEFAULT_SIZE,
        height=height,
        missing=tuple(name for name in SIZES if sizes.get(name) is None),
    )
    return piece if breadth is None or height is None else replace(piece, falls=_list_falls(piece, height, away))


def _list_falls(piece: PlacedPiece, height: float, away: float | None) -> tuple[Ring, ...]:
    ahead, behind = fallen(piece.at, piece.angle, piece.breadth, piece.width, height)
    if away is None:
        return ahead, behind
    return (ahead,) if abs(angle_apart(away, piece.angle)) < 90 else (behind,)


def find_away(inventory: Inventory, floor: str) -> dict[int, float]:
    """Return the direction in which the pieces of a floor that stand against a wall fall [deg], by their rows."""
    own = tuple(one for one in inventory.items if one.floor == floor and one.against_wall)
    walls = find_walls(replace(inventory, items=own))
    return {own[at].row: one.falls_toward for at, one in walls.items() if one.falls_toward is not None}


def cut_all(pieces: Sequence[PlacedPiece], edge: "BaseGeometry | None") -> list[PlacedPiece]:
    """Return pieces with what they may cover cut at the building's edge; as they are where that is not known."""
    if edge is None or not any(one.falls for one in pieces):
        return list(pieces)
    import numpy as np
    import shapely

    shapely.prepare(edge)
    rings = np.array([ring for one in pieces for ring in one.falls])
    is_inside = iter(np.asarray(shapely.covers(edge, shapely.polygons(rings)), dtype=np.bool_).tolist())
    return [replace(one, falls=tuple(_cut(one.falls, edge, is_inside))) for one in pieces]


def _cut(falls: Iterable[Ring], edge: "BaseGeometry", is_inside: Iterator[bool]) -> Iterator[Ring]:
    for ring in falls:
        yield from (ring,) if next(is_inside) else cut_falls([ring], edge)


def round_points(points: Iterable[Point] | Outline) -> list[list[float]]:
    """Return points for the page."""
    return [[round(x, DECIMALS), round(y, DECIMALS)] for x, y in points]
