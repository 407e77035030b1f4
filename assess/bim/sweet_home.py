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
MOST_ELEMENTS, DEEPEST = 100_000, 100
"""Elements of a home that are read, and elements inside each other."""
MOST_PIECES, MOST_WALLS, MOST_LEVELS = 10_000, 1_000, 100
"""Pieces, walls or rooms, and levels that are read."""
FARTHEST = 1e6
"""Largest number of a length [cm]."""
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
        """Its name; "" without one."""
        return " ".join(self.values.get("name", "").split())


def read_sweet_home(data: bytes, name: str) -> BuildingModel:
    """Return what a home tells of a building.

    Raises ModelError if it is no home, of a version that is not read, damaged, or beyond a limit; with the place in its
    Home.xml.
    """
    home = _Home(name)
    home.parse(_unpack(data, name))
    return home.build()


def _unpack(data: bytes, name: str) -> bytes:
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
    return found


def _no_home(name: str) -> ModelError:
    return ModelError(fill("{name} is not a file of Sweet Home 3D: it lacks Home.xml.", name=name))


def _damaged(name: str) -> ModelError:
    return ModelError(
        fill("{name} is damaged: its Home.xml cannot be read. Open it with Sweet Home 3D, and save it again.",
             name=name)
    )  # fmt: skip


# ---------------------------------------------------------------- the home as it stands in the file


class _Home:
    def __init__(self, name: str) -> None:
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
        self.root = ""
        self.remarks: list[Text] = []
        self.skipped: list[tuple[str, Text, bool]] = []
        self._open: list[_Element] = []
        self._counts: Counter[str] = Counter()

    def parse(self, data: bytes) -> None:
        parser = expat.ParserCreate()
        parser.StartElementHandler, parser.EndElementHandler = self._enter, lambda _: self._open.pop()
        parser.EntityDeclHandler = self._refuse
        try:
            parser.Parse(data, True)
        except (expat.ExpatError, ValueError, LookupError):  # an encoding that is not known
            raise _damaged(self.name) from None
        if self.root != "home":
            raise _no_home(self.name)

    def _refuse(self, *_: object) -> None:
        raise _damaged(self.name)

    def _enter(self, tag: str, values: dict[str, str]) -> None:
        self.root = self.root or tag
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

    # ------------------------------------------------------------ values

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
        """Return a length of an element [m]."""
        return CENTIMETRE * self.number(element, name, otherwise)

    # ------------------------------------------------------------ the model

    def build(self) -> BuildingModel:
        storeys = self._list_storeys()
        spaces = tuple(self._list_spaces(storeys))
        boxes = _join_groups([self._box(one, storeys) for one in self.furniture])
        drawn = [one for one in boxes if not one.is_hidden]
        passages = [one for one in drawn if one.is_opening]
        doors = [one for one in passages if one.bottom <= SILL]
        pieces, search = list[Piece](), SpaceSearch(spaces)
        for one in (one for one in boxes if not one.is_opening):
            reason = one.why_left_out()
            if reason is None:
                rooms = search.find(one.storey, (one.x, one.y))
                pieces.append(one.to_piece(rooms[0].key if rooms else ""))
            else:
                self.skipped.append((name_skipped(SCHEMA, one.name), reason, reason is not IS_STAIR))
        north = self.number(self.compass, "northDirection", 0.0) if self.compass else 0.0
        return BuildingModel(
            source=self.name,
            schema=SCHEMA,
            storeys=storeys,
            spaces=spaces,
            doors=tuple(one.to_door() for one in doors),
            stairs=tuple(_list_stairs(drawn, storeys)),
            pieces=tuple(pieces),
            walls={one.key: self._draw_walls(one.key, passages) for one in storeys},
            windows={
                one.key: merge(box.plan() for box in passages if box.storey == one.key and box not in doors)
                for one in storeys
            },
            skipped=count_skipped(self.skipped),
            azimuth_deg=round((90 - math.degrees(north)) % 360, 1) if north else None,
            warnings=(*((DRAWN_SIZES,) if pieces else ()), *_note_stacked(boxes)),
            remarks=tuple(self.remarks),
        )

    def _list_storeys(self) -> tuple[Storey, ...]:
        levels = ((one, self.metres(one, "elevation")) for one in self.levels)
        found = [Storey(one.values.get("id", one.place), one.name or one.place, z, z) for one, z in levels]
        return tuple(sorted(found, key=lambda one: one.level)) or (Storey("", gettext("Storey {n}", n=0), 0.0, 0.0),)

    def _storey_of(self, element: _Element, storeys: Sequence[Storey]) -> Storey:
        own = element.values.get("level")
        return next((one for one in storeys if one.key == own), storeys[0])

    def _list_spaces(self, storeys: Sequence[Storey]) -> Iterator[Space]:
        """Yield the rooms; their height is left out, as a ceiling tells nothing of the roof of the building."""
        for number, one in enumerate(self.rooms, 1):
            storey = self._storey_of(one, storeys)
            polygon = to_polygon((tuple(one.corners),)) if len(one.corners) >= 3 else Polygon()
            if polygon.area >= SMALLEST_ROOM:
                name = one.name or gettext("Room {n}", n=number)
                key = f"{one.values.get('id', '')} {one.place}".strip()
                yield Space(key, storey.key, name, "", to_area(polygon), storey.level, storey.level)

    def _box(self, one: _Element, storeys: Sequence[Storey]) -> "_Box":
        angle = -self.number(one, "angle", 0.0)  # clockwise in the file
        return _Box(
            element=one,
            storey=self._storey_of(one, storeys).key,
            name=one.name or one.tag,
            x=self.metres(one, "x"),
            y=-self.metres(one, "y"),
            angle=math.remainder(angle, math.tau),
            width=self.metres(one, "width"),
            depth=self.metres(one, "depth"),
            height=self.metres(one, "height"),
            bottom=self.metres(one, "elevation", 0.0),
            is_tilted=any(abs(self.number(one, name, 0.0)) > math.radians(2.6) for name in ("pitch", "roll")),
        )

    def _draw_walls(self, storey: str, passages: Sequence["_Box"]) -> tuple[Area, ...]:
        own = [one for one in self.walls if self.levels == [] or one.values.get("level", storey) == storey]
        straight = [one for one in own if not self.number(one, "arcExtent", 0.0)]
        if len(straight) < len(own):
            left = len(own) - len(straight)
            self.remarks.append(nfill("{n:,} round wall is not drawn.", "{n:,} round walls are not drawn.", left))
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
    """A piece, door or window: its centre, its sides along `angle` [rad] and across it, and its height [m].

    `feet` are the sides of what stands on the floor, where those of the body are others.
    """

    element: _Element
    storey: str
    name: str
    x: float
    y: float
    angle: float
    width: float
    depth: float
    height: float
    bottom: float
    is_tilted: bool
    feet: tuple[float, float] | None = None

    @property
    def key(self) -> str:
        """Its identifier in the file, "" without one."""
        return self.element.values.get("id", "")

    @property
    def is_hidden(self) -> bool:
        return self.element.values.get("visible") == "false"

    @property
    def is_opening(self) -> bool:
        return self.element.tag == "doorOrWindow" or self.element.values.get("doorOrWindow") == "true"

    @property
    def is_stair(self) -> bool:
        return "staircaseCutOutShape" in self.element.values

    def plan(self, least: float = 0.0) -> Polygon:
        """Return its plan, a little deeper than `least` and than itself where that is not 0."""
        u, v = self.width / 2, max(self.depth, 1.5 * least) / 2
        along = math.cos(self.angle), math.sin(self.angle)
        return place_at((self.x, self.y), along, ((-u, -v), (u, -v), (u, v), (-u, v)))

    def why_left_out(self) -> Text | None:
        """Return why it is not taken as a piece."""
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

    def to_piece(self, space: str) -> Piece:
        """Return it as a piece; what is part of the base plan, which the program calls not movable, as fitted."""
        short, long = sorted((self.width, self.depth))
        feet = (self.feet or (self.width, self.depth))[:: 1 if self.width <= self.depth else -1]
        angle = math.degrees(self.angle) + (0 if self.width <= self.depth else 90)
        return Piece(
            key=self.key, storey=self.storey, space=space, ifc_class=SCHEMA, name=self.name, type=self.name,
            x=self.x, y=self.y, breadth=short, width=long, height=self.height, angle_deg=half_turn(angle),
            support_breadth=feet[0], support_width=feet[1], bottom=self.bottom,
            is_fitted=self.element.values.get("movable") == "false",
        )  # fmt: skip

    def to_door(self) -> Door:
        """Return it as a door."""
        return Door(
            key=f"{self.key} {self.element.place}".strip(), storey=self.storey, name=self.name, x=self.x, y=self.y,
            normal_deg=math.degrees(self.angle) + 90, width=self.width, thickness=self.depth, overall=self.width,
        )  # fmt: skip


def _list_stairs(boxes: Sequence[_Box], storeys: Sequence[Storey]) -> Iterator[Stair]:
    keys = [one.key for one in storeys]
    for one in boxes:
        if one.is_stair and not one.is_opening:
            key = f"{one.key} {one.element.place}".strip()
            yield Stair(key, one.storey, one.name, "foot", one.x, one.y)
            above = keys[keys.index(one.storey) + 1 :]
            yield from (Stair(key, storey, one.name, "head", one.x, one.y) for storey in above[:1])


def _join_groups(boxes: Sequence[_Box]) -> list[_Box]:
    groups: dict[tuple[str, str], list[int]] = {}
    for at, one in enumerate(boxes):
        if one.element.group is not None and one.why_left_out() in (None, NOT_ON_FLOOR) and not one.is_opening:
            groups.setdefault((one.storey, one.element.group.place), []).append(at)
    bounds = {at: np.array(boxes[at].bounds) for members in groups.values() for at in members}
    on_floor = {at for at in bounds if boxes[at].bottom <= ON_FLOOR}
    joined: dict[int, _Box] = {}
    gone = set[int]()
    for (first, *others), is_whole in find_stacks(groups.values(), bounds, on_floor):
        group = boxes[first].element.group if is_whole else None
        joined[first] = _join_boxes([boxes[at] for at in (first, *others)], group.name if group is not None else "")
        gone |= {*others}
    return [joined.get(at, one) for at, one in enumerate(boxes) if at not in gone]


def _join_boxes(boxes: Sequence[_Box], name: str) -> _Box:
    """Return the box round several in the axes of the first, which carries the others."""
    first = boxes[0]
    c, s = math.cos(first.angle), math.sin(first.angle)
    turn = np.array([[c, -s], [s, c]])
    turned = [(np.array(one.plan().exterior.coords) - (first.x, first.y)) @ turn for one in boxes]
    points = np.concatenate(turned)
    feet = np.ptp(
        np.concatenate([own for own, one in zip(turned, boxes, strict=True) if one.bottom <= ON_FLOOR]), axis=0
    )
    (u, v), (width, depth) = (points.min(axis=0) + points.max(axis=0)) / 2, np.ptp(points, axis=0)
    top = max(one.bottom + one.height for one in boxes)
    return replace(
        first, x=first.x + float(c * u - s * v), y=first.y + float(s * u + c * v), width=float(width),
        depth=float(depth), height=top - first.bottom, name=name or first.name, feet=(float(feet[0]), float(feet[1])),
    )  # fmt: skip


def _note_stacked(boxes: Sequence[_Box]) -> Iterator[Text]:
    for storey in dict.fromkeys(one.storey for one in boxes):
        own = [(one, one.why_left_out()) for one in boxes if one.storey == storey and not one.is_opening]
        taken, left = ([one for one, reason in own if reason == why] for why in (None, NOT_ON_FLOOR))
        lists = (np.array([one.bounds for one in each]) for each in (taken, left))
        yield from note_stacked([one.name for one in taken], *lists)
