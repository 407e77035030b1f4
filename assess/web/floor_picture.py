"""The picture under the plan of a floor: as reports draw it, and where it lies once it has been placed."""

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from assess.model import FloorPlan
from assess.plans.linework import unpack
from assess.workbook.parse import Row

if TYPE_CHECKING:
    from assess.web.book import Snapshot

WIDE = 1000
"""Width of the drawing made of a picture's lines, in its own units."""
STROKE = "#757575"
"""Colour of its lines, as in reports."""
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{tall:.2f}" viewBox="0 0 {wide} {tall:.2f}">'


@dataclass(frozen=True, slots=True)
class FloorPicture:
    """The picture of a floor; of one that has not been placed yet some of the numbers are None.

    Parameters
    ----------
    content : bytes
        As `assess.model.FloorPlan` has it: nothing of the user's file reaches the page as it is.
    is_lines : bool
        Whether it is a drawing of lines.
    aspect : float
        Height over width [-].
    left, bottom, width : float, optional
        Where it lies, and how wide it is [m].
    turn : float
        By how much it is turned [deg].
    """

    content: bytes
    is_lines: bool
    aspect: float
    left: float | None
    bottom: float | None
    width: float | None
    turn: float = 0.0

    @classmethod
    def of(cls, plan: FloorPlan) -> "FloorPicture":
        """Return that of a plan which is placed."""
        aspect = plan.height / plan.width
        return cls(plan.content, plan.is_lines, aspect, plan.left, plan.bottom, plan.width, plan.turn_deg)

    @property
    def is_placed(self) -> bool:
        """Whether it is known where it lies."""
        return None not in (self.left, self.bottom, self.width)

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Its frame [m], from its lower left corner anticlockwise; nothing where it is not placed."""
        if self.left is None or self.bottom is None or self.width is None:
            return []
        angle, tall = np.radians(self.turn), self.width * self.aspect
        cos, sin = float(np.cos(angle)), float(np.sin(angle))
        local = ((0.0, 0.0), (self.width, 0.0), (self.width, tall), (0.0, tall))
        return [(self.left + x * cos - y * sin, self.bottom + x * sin + y * cos) for x, y in local]

    def describe(self, floor: str) -> dict[str, Any]:
        """Return it as the page takes it."""
        digest = hashlib.sha256(self.content).hexdigest()[:16]
        return {
            "url": f"/api/picture?floor={quote(floor, safe='')}&v={digest}",
            "left": self.left,
            "bottom": self.bottom,
            "width": self.width,
            "height": None if self.width is None else self.width * self.aspect,
            "turn": self.turn,
            "placed": self.is_placed,
            "aspect": self.aspect,
        }

    def draw(self) -> tuple[bytes, str]:
        """Return what the browser shows of it, and its media type."""
        if not self.is_lines:
            return self.content, "image/jpeg"
        return draw_lines(self.content, self.aspect), "image/svg+xml"


def draw_lines(content: bytes, aspect: float) -> bytes:
    """Return the lines that are kept of a drawing as an SVG with one path."""
    tall = WIDE * aspect
    lines = (line * (WIDE, -WIDE) + (0, tall) for line in unpack(content))
    path = "".join("M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in line.tolist()) for line in lines)
    head = HEAD.format(wide=WIDE, tall=tall)
    return f'{head}<path d="{path}" fill="none" stroke="{STROKE}" stroke-width="1"/></svg>'.encode()


def find_floor_picture(snapshot: "Snapshot", row: Row) -> FloorPicture | None:
    """Return the picture of a floor by its row; None where it names none, or one that cannot be used."""
    plan = next((one.plan for one in snapshot.inventory.floors if one.row == row.number), None)
    if plan is not None:
        return FloorPicture.of(plan)
    text = row.get("plan")
    drawing = None if text is None else snapshot.find_drawing(text, row.get("plan_width"))
    if drawing is None:
        return None
    numbers = {name: row.get(f"plan_{name}") for name in ("left", "bottom", "width")}
    numbers["width"] = drawing.width if numbers["width"] is None else numbers["width"]
    return FloorPicture(drawing.content, drawing.is_lines, drawing.aspect, **numbers, turn=row.get("plan_turn") or 0.0)
