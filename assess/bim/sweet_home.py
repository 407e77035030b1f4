"""Homes drawn with Sweet Home 3D: walls, rooms, doors, windows, stairs and furniture of an .sh3d file.

Such a file is a zip whose part Home.xml the program writes since version 5.3; older ones hold serialised Java alone.
Elements and attributes are those of the DTD in the documentation of HomeXMLHandler in the program's source. Lengths
are in centimetres, X to the right and Y downwards, angles in radians clockwise; an elevation is above the floor of the
level. No entity is expanded, and nothing that the file names is opened.
"""

import io
import math
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from xml.parsers import expat

import numpy as np
import shapely
from shapely import LineString, Polygon

from assess.bim.building_model import (
    IS_TILTED,
    NOT_ON_FLOOR,
    ON_FLOOR,
    SILL,
    SMALLEST_ROOM,
    Area,
    BuildingModel,
    Door,
    Piece,
    Point,
    Skipped,
    Space,
    Stair,
    Storey,
    count_skipped,
    half_turn,
    name_skipped,
)
from assess.bim.plan_shapes import (
    SpaceSearch,
    find_stacks,
    list_polygons,
    merge,
    note_stacked,
    place_at,
    to_area,
    to_polygon,
)
from assess.errors import ModelError
from assess.i18n import Text, fill, gettext, nfill

SCHEMA = "Sweet Home 3D"
HOME, OLD_HOME = "Home.xml", "Home"
MOST_BYTES, MOST_HOME = 256 * 2**20, 32 * 2**20
"""Size of a file, and of its home unpacked, that is read [bytes]; the rest of a file are pictures and shapes."""
MOST_ELEMENTS, DEEPEST = 100_000, 100  # elements of a home that are read, and elements inside each other
MOST_PIECES, MOST_WALLS, MOST_LEVELS = 10_000, 1_000, 100  # pieces, walls or rooms, and levels that are read
FARTHEST = 1e6  # largest number of a length [cm]
CENTIMETRE = 0.01
FURNITURE = ("pieceOfFurniture", "light", "shelfUnit", "doorOrWindow")

IS_HIDDEN = fill("hidden in the plan")
IS_STAIR = fill("a stair, listed in Places")
DRAWN_SIZES = fill(
    "Sizes are those of the drawing, which are often those of the program's catalogue: check them against the "
    "furniture."
)


@dataclass(slots=True)
class _Element:
    """An element of a home with what is inside it that counts, corners of a room, and the outermost group it is in."""

    place: str
    tag: str
    values: dict[str, str]
    corners: list[Point] = field(default_factory=list)
    group: "_Element | None" = None

    @property
    def name(self) -> str:
        return " ".join(self.values.get("name", "").split())


def read_sweet_home(data: bytes, name: str) -> BuildingModel:
    """Return what a home tells of a building; ModelError, with the place in Home.xml, if damaged or too large."""
    too_large = ModelError(
        fill("{name} is too large: at most {file} MB are read, and {home} MB of the Home.xml in it. Save fewer "
             "levels.", name=name, file=MOST_BYTES // 2**20, home=MOST_HOME // 2**20)
    )  # fmt: skip
    if len(data) > MOST_BYTES:
        raise too_large
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = archive.namelist()
            if HOME not in parts and OLD_HOME in parts:
                raise ModelError(
                    fill("{name} was saved by an old version of Sweet Home 3D: it lacks Home.xml. Open it with version "
                         "5.3 or newer, and save it again.", name=name)
                )  # fmt: skip
            if HOME not in parts:
                raise _no_home(name)
            with archive.open(HOME) as part:
                found = part.read(MOST_HOME + 1)
    except (zipfile.BadZipFile, zipfile.LargeZipFile, OSError, EOFError, ValueError, RuntimeError, zlib.error):
        raise _damaged(name) from None
    if len(found) > MOST_HOME:
        raise too_large
    return _Home(name, found).build()


def _no_home(name: str) -> ModelError:
    return ModelError(fill("{name} is not a file of Sweet Home 3D: it lacks Home.xml.", name=name))


def _damaged(name: str) -> ModelError:
    return ModelError(
        fill("{name} is damaged: its Home.xml cannot be read. Open it with Sweet Home 3D, and save it again.",
             name=name)
    )  # fmt: skip


class _Home:
    def __init__(self, name: str, data: bytes) -> None:
        self.name = name
        self.levels: list[_Element] = []
        self.furniture: list[_Element] = []
        self.walls: list[_Element] = []
        self.rooms: list[_Element] = []
        self.kept = {
            "level": (self.levels, MOST_LEVELS),
            "wall": (self.walls, MOST_WALLS),
            "room": (self.rooms, MOST_WALLS),
            **dict.fromkeys(FURNITURE, (self.furniture, MOST_PIECES)),
        }
        self.compass: _Element | None = None
        self._root = ""
        self._open: list[_Element] = []
        self._counts: Counter[str] = Counter()

        def refuse(*_: object) -> None:
            raise _damaged(name)

        parser = expat.ParserCreate()
        parser.StartElementHandler, parser.EndElementHandler = self._enter, lambda _: self._open.pop()
        parser.EntityDeclHandler = refuse
        try:
            parser.Parse(data, True)
        except (expat.ExpatError, ValueError, LookupError):  # an encoding that is not known
            raise _damaged(name) from None
        if self._root != "home":
            raise _no_home(name)

    def _enter(self, tag: str, values: dict[str, str]) -> None:
        self._root = self._root or tag
        self._counts[""] += 1
        if self._counts[""] > MOST_ELEMENTS or len(self._open) >= DEEPEST:
            raise self._too_many(fill("elements"), MOST_ELEMENTS)
        element = _Element(f"{tag}[{self._counts[tag]}]", tag, values)
        self._counts[tag] += 1
        if tag == "point" and self._open and self._open[-1].tag == "room":
            self._open[-1].corners.append((self.metres(element, "x"), -self.metres(element, "y")))
        self._open.append(element)
        if tag == "compass":
            self.compass = element
        if tag in self.kept:
            group = next((one for one in reversed(self._open[:-1]) if one.tag == "furnitureGroup"), None)
            if group is not None:  # what is hidden or lies on a level as a whole
                for name in ("level", "visible"):
                    if name in group.values:
                        values.setdefault(name, group.values[name])
                element.group = group.group or group
            kept, most = self.kept[tag]
            kept.append(element)
            if len(kept) > most:
                raise self._too_many(fill("pieces, walls, rooms or levels"), most)

    def _too_many(self, what: Text, most: int) -> ModelError:
        return ModelError(
            fill("{name} holds more than {most:,} {what}, or too many inside each other. Save fewer levels.",
                 name=self.name, most=most, what=what)
        )  # fmt: skip

    def number(self, element: _Element, name: str, otherwise: float | None = None) -> float:
        text = element.values.get(name)
        if text is None and otherwise is not None:
            return otherwise
        try:
            found = float(text or "")
        except ValueError:
            found = math.nan
        if not abs(found) <= FARTHEST:
            raise ModelError(
                fill("{name}, {place}: {field} is {text!r}, not a number. Open the file with Sweet Home 3D, and save "
                     "it again.", name=self.name, place=element.place, field=name, text=(text or "")[:40])
            )  # fmt: skip
        return found

    def metres(self, element: _Element, name: str, otherwise: float | None = None) -> float:
        return CENTIMETRE * self.number(element, name, otherwise)

    def build(self) -> BuildingModel:
        levels = ((one, self.metres(one, "elevation")) for one in self.levels)
        found = [Storey(one.values.get("id", one.place), one.name or one.place, z, z) for one, z in levels]
        storeys = tuple(sorted(found, key=lambda one: one.level)) or (Storey("", gettext("Storey {n}", n=0), 0.0, 0.0),)
        by_key = {one.key: one for one in reversed(storeys)}
        spaces = []
        for number, room in enumerate(self.rooms, 1):
            storey = by_key.get(room.values.get("level", ""), storeys[0])
            polygon = to_polygon((tuple(room.corners),)) if len(room.corners) >= 3 else Polygon()
            if polygon.area >= SMALLEST_ROOM:
                name, key = room.name or gettext("Room {n}", n=number), f"{room.values.get('id', '')} {room.place}"
                # without height, as a ceiling tells nothing of the roof of the building
                spaces.append(Space(key.strip(), storey.key, name, "", to_area(polygon), storey.level, storey.level))
        boxes = _join_groups([
            _Box(
                element=one, key=one.values.get("id", ""), name=one.name or one.tag,
                storey=by_key.get(one.values.get("level", ""), storeys[0]).key,
                is_hidden=one.values.get("visible") == "false", is_stair="staircaseCutOutShape" in one.values,
                is_opening=one.tag == "doorOrWindow" or one.values.get("doorOrWindow") == "true",
                x=self.metres(one, "x"), y=-self.metres(one, "y"),
                angle=math.remainder(-self.number(one, "angle", 0.0), math.tau),  # clockwise in the file
                width=self.metres(one, "width"), depth=self.metres(one, "depth"), height=self.metres(one, "height"),
                bottom=self.metres(one, "elevation", 0.0),
                is_tilted=any(abs(self.number(one, name, 0.0)) > math.radians(2.6) for name in ("pitch", "roll")),
            )
            for one in self.furniture
        ])  # fmt: skip
        passages = [one for one in boxes if one.is_opening and not one.is_hidden]
        doors = [one for one in passages if one.bottom <= SILL]
        pieces, skipped = _sort_pieces(boxes, SpaceSearch(spaces))
        warnings, remarks = [DRAWN_SIZES] if pieces else [], list[Text]()
        north = self.number(self.compass, "northDirection", 0.0) if self.compass else 0.0
        walls, windows = dict[str, tuple[Area, ...]](), dict[str, tuple[Area, ...]]()
        for storey in storeys:
            walls[storey.key] = self._draw_walls(storey.key, passages, remarks)
            windows[storey.key] = merge(
                one.plan() for one in passages if one.storey == storey.key and one.bottom > SILL
            )
        for key in dict.fromkeys(one.storey for one in boxes):
            own = [(one, one.why_left_out()) for one in boxes if one.storey == key and not one.is_opening]
            taken, left = ([one for one, reason in own if reason == why] for why in (None, NOT_ON_FLOOR))
            bounds = (np.array([one.bounds for one in each]) for each in (taken, left))
            warnings += note_stacked([one.name for one in taken], *bounds)
        return BuildingModel(
            source=self.name, schema=SCHEMA, storeys=storeys, spaces=tuple(spaces),
            doors=tuple(
                Door(key=one.own_key, storey=one.storey, name=one.name, x=one.x, y=one.y, overall=one.width,
                     normal_deg=math.degrees(one.angle) + 90, width=one.width, thickness=one.depth)
                for one in doors
            ),
            stairs=tuple(_list_stairs(boxes, [one.key for one in storeys])), pieces=pieces, walls=walls,
            windows=windows, skipped=skipped, warnings=tuple(warnings), remarks=tuple(remarks),
            azimuth_deg=round((90 - math.degrees(north)) % 360, 1) if north else None,
        )  # fmt: skip

    def _draw_walls(self, storey: str, passages: Sequence["_Box"], remarks: list[Text]) -> tuple[Area, ...]:
        own = [one for one in self.walls if self.levels == [] or one.values.get("level", storey) == storey]
        straight = [one for one in own if not self.number(one, "arcExtent", 0.0)]
        if len(straight) < len(own):
            left = len(own) - len(straight)
            remarks.append(nfill("{n:,} round wall is not drawn.", "{n:,} round walls are not drawn.", left))
        bands = [
            LineString([(self.metres(one, f"x{end}"), -self.metres(one, f"y{end}")) for end in ("Start", "End")])
            .buffer(self.metres(one, "thickness") / 2, cap_style="square")
            for one in straight
        ]  # fmt: skip
        thick = [self.metres(one, "thickness") for one in straight]
        holes = [one.plan(median(thick) if thick else 0.0) for one in passages if one.storey == storey]
        return merge(list_polygons(shapely.union_all(bands).difference(shapely.union_all(holes))))


# ---------------------------------------------------------------- pieces, doors, stairs


@dataclass(frozen=True, slots=True)
class _Box:
    """A piece, door or window: its sides [m] along `angle` [rad] and across it; `feet`: of what stands on the floor."""

    element: _Element
    key: str
    storey: str
    name: str
    x: float
    y: float
    angle: float
    width: float
    depth: float
    height: float
    bottom: float
    is_hidden: bool
    is_opening: bool
    is_stair: bool
    is_tilted: bool
    feet: tuple[float, float] | None = None

    @property
    def own_key(self) -> str:
        return f"{self.key} {self.element.place}".strip()

    def plan(self, least: float = 0.0) -> Polygon:
        """Return its plan, a little deeper than `least` and than itself where that is not 0."""
        u, v = self.width / 2, max(self.depth, 1.5 * least) / 2
        along = math.cos(self.angle), math.sin(self.angle)
        return place_at((self.x, self.y), along, ((-u, -v), (u, -v), (u, v), (-u, v)))

    def why_left_out(self) -> Text | None:
        if self.is_hidden:
            return IS_HIDDEN
        if self.is_stair:
            return IS_STAIR
        if self.is_tilted:
            return IS_TILTED
        return NOT_ON_FLOOR if self.bottom > ON_FLOOR else None

    @property
    def bounds(self) -> tuple[float, ...]:
        """Least and largest X, Y and Z, as `find_stacks` takes them; storeys lie far from each other."""
        left, low, right, high = self.plan().bounds
        return left, low, self.bottom, right, high, self.bottom + self.height


def _sort_pieces(boxes: Sequence[_Box], search: SpaceSearch) -> tuple[tuple[Piece, ...], tuple[Skipped, ...]]:
    """Return the pieces, and what is left out; what is part of the base plan, not movable in the program, as fitted."""
    pieces, skipped = list[Piece](), list[tuple[str, Text, bool]]()
    for one in (one for one in boxes if not one.is_opening):
        reason = one.why_left_out()
        if reason is not None:
            skipped.append((name_skipped(SCHEMA, one.name), reason, reason is not IS_STAIR))
            continue
        rooms, is_broad = search.find(one.storey, (one.x, one.y)), one.width > one.depth
        short, long = sorted((one.width, one.depth))
        feet = (one.feet or (one.width, one.depth))[:: -1 if is_broad else 1]
        pieces.append(
            Piece(
                key=one.key, storey=one.storey, space=rooms[0].key if rooms else "", ifc_class=SCHEMA, name=one.name,
                type=one.name, x=one.x, y=one.y, breadth=short, width=long, height=one.height,
                angle_deg=half_turn(math.degrees(one.angle) + (90 if is_broad else 0)), support_breadth=feet[0],
                support_width=feet[1], bottom=one.bottom, is_fitted=one.element.values.get("movable") == "false",
            )
        )  # fmt: skip
    return tuple(pieces), count_skipped(skipped)


def _list_stairs(boxes: Sequence[_Box], storeys: Sequence[str]) -> Iterator[Stair]:
    for one in boxes:
        if one.is_stair and not (one.is_opening or one.is_hidden):
            yield Stair(one.own_key, one.storey, one.name, "foot", one.x, one.y)
            for above in storeys[storeys.index(one.storey) + 1 :][:1]:
                yield Stair(one.own_key, above, one.name, "head", one.x, one.y)


def _join_groups(boxes: Sequence[_Box]) -> list[_Box]:
    """Return pieces of which those that stand on each other are one, in the axes of the one that carries the others."""
    groups: dict[tuple[str, str], list[int]] = {}
    for at, one in enumerate(boxes):
        if one.element.group is not None and one.why_left_out() in (None, NOT_ON_FLOOR) and not one.is_opening:
            groups.setdefault((one.storey, one.element.group.place), []).append(at)
    bounds = {at: np.array(boxes[at].bounds) for members in groups.values() for at in members}
    on_floor = {at for at in bounds if boxes[at].bottom <= ON_FLOOR}
    joined: dict[int, _Box] = {}
    gone = set[int]()
    for stack, is_whole in find_stacks(groups.values(), bounds, on_floor):
        first, own = boxes[stack[0]], [boxes[at] for at in stack]
        group = first.element.group if is_whole else None
        c, s = math.cos(first.angle), math.sin(first.angle)
        turn = np.array([[c, -s], [s, c]])
        turned = [(np.array(one.plan().exterior.coords) - (first.x, first.y)) @ turn for one in own]
        points = np.concatenate(turned)
        standing = [corners for corners, one in zip(turned, own, strict=True) if one.bottom <= ON_FLOOR]
        feet_width, feet_depth = np.ptp(np.concatenate(standing), axis=0).tolist()
        u, v = ((points.min(axis=0) + points.max(axis=0)) / 2).tolist()
        width, depth = np.ptp(points, axis=0).tolist()
        joined[stack[0]] = replace(
            first, x=first.x + (c * u - s * v), y=first.y + (s * u + c * v), width=width, depth=depth,
            height=max(one.bottom + one.height for one in own) - first.bottom, feet=(feet_width, feet_depth),
            name=(group.name if group is not None else "") or first.name,
        )  # fmt: skip
        gone |= {*stack[1:]}
    return [joined.get(at, one) for at, one in enumerate(boxes) if at not in gone]
