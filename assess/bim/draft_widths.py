"""The clear widths of drafted segments: what doors and openings leave at their ends, and walls and columns beside them.

Who walks along a segment passes between what stands to its left and what stands to its right. So no width is clear that
is more than the least distance between the two, wherever they stand along it.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import Point
from assess.bim.draft_floor import DOOR_LESS, JAMB, FloorPlan, Link, box_at
from assess.bim.plan_shapes import list_polygons
from assess.i18n import gettext
from assess.workbook.schema import DEFAULT_WIDTH, ROUTES

NARROWEST = ROUTES.column("clear_width").low or 0.0
"""Least clear width that a workbook takes [m]."""
BESIDE = 1.5
"""Walls and columns up to this far to the left and to the right of a segment bound it [m]."""
SLIVER = 1e-4
"""Area below which what stands beside a segment is an error of rounding [m2]."""
SHORTEST = 0.02
"""A part of a segment that is shorter than this has no sides [m]."""
AT_STAIR = 0.5
"""Around a stair, and so far beside it, no width is measured: ways lead to it from any side [m]."""


def measure_gap(plan: FloorPlan, space: str, ends: tuple[Point, Point], links: Iterable[Link]) -> float | None:
    """Return the least distance between what stands to the left and to the right of a segment [m].

    It is None where nothing stands on one of its sides up to `BESIDE`.

    Parameters
    ----------
    plan : FloorPlan
        The storey: its walls and windows bound a segment, and what is outside all rooms. Furniture does not.
    space : str
        Key of the space in which the segment lies.
    ends : tuple of Point
        Both ends of the segment [m].
    links : iterable of Link
        The doors, openings and stairs at its ends: in these no wall is met.
    """
    line = shapely.LineString(ends)
    wide = line.buffer(BESIDE, cap_style="flat")
    rooms = shapely.union_all([plan.polygons[at] for at in sorted(plan.tree.query(wide))])
    solids = plan.solids_near(wide)
    floor = plan.polygon(space).difference(solids)
    passages = [_pass_through(floor, link) for link in links]
    stands = shapely.union_all([wide.difference(rooms), wide.intersection(solids)])
    stands = stands.difference(shapely.union_all(passages))
    gaps = [gap for part in _list_lines(line.difference(stands)) if (gap := _measure_sides(part, stands)) is not None]
    return min(gaps, default=None)


def _pass_through(floor: BaseGeometry, link: Link) -> shapely.Polygon:
    at = shapely.Point(link.at)
    reach = floor.distance(at) if not floor.is_empty else 0.0
    if link.normal == (0.0, 0.0):
        return at.buffer(reach + AT_STAIR)
    return box_at(link.at, link.normal, reach + JAMB / 2, link.width / 2)


def _list_lines(geometry: Any) -> Iterator[shapely.LineString]:
    for one in getattr(geometry, "geoms", (geometry,)):
        if isinstance(one, shapely.LineString) and one.length > SHORTEST:
            yield one


def _measure_sides(line: shapely.LineString, stands: BaseGeometry) -> float | None:
    sides = [line.buffer(far, single_sided=True).intersection(stands) for far in (BESIDE, -BESIDE)]
    left, right = (shapely.union_all([one for one in list_polygons(side) if one.area > SLIVER]) for side in sides)
    return None if left.is_empty or right.is_empty else float(left.distance(right))


def set_widths(links: Sequence[Link], between_walls: float | None, gap: float | None) -> dict[str, Any]:
    """Return the widths of a segment and what is assumed of them.

    `between_walls`: the free width of a corridor in whose middle it lies [m].
    `gap`: from `measure_gap`: it counts beside one of the others, and where it is less than the width that must stay
    free otherwise.
    """
    narrow = [link for link in links if link.overall > 0 or 0 < link.clear < DEFAULT_WIDTH]
    known = [link.clear for link in narrow] + ([] if between_walls is None else [between_walls])
    if gap is not None and (known or gap < DEFAULT_WIDTH):
        known.append(gap)
    if not known:
        return {}
    clear = min(known)
    tightest = next((link for link in narrow if link.clear == clear), None)
    clear = max(int(100 * clear + 1e-6) / 100, NARROWEST)
    notes = gettext("Clear width: between the walls of the model.")
    if tightest is not None and tightest.overall > 0:
        notes = gettext("Clear width: the door's {overall:.2f} m in the model less {less:g} m for frame and leaf, "
                        "assumed.", overall=tightest.overall, less=DOOR_LESS)  # fmt: skip
    if clear >= DEFAULT_WIDTH:
        return {"clear_width": clear, "notes": notes}
    same = gettext("Required width: the same, as that is less than {default:g} m.", default=DEFAULT_WIDTH)
    return {"clear_width": clear, "required_width": clear, "notes": f"{notes} {same}"}
