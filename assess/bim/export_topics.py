"""What to fix as topics of the BIM Collaboration Format, one for each entry of the schedule: a BCF 2.1 file.

Topics carry no snapshot: a picture needs a viewer of the model, which makes its own from the viewpoint.

Positions of the workbook are those of the model but for a shift of whole metres, which is found from the pieces that
have both. A topic has all of its pieces, and the doors that they obstruct, within the picture, if it can be. The camera
stands in the room of the first piece; where not all is in view from there, it steps back through a wall. BCF 2.1 allows
no wider field of view than 60 degrees. A viewer fits it to a picture of its own: here it is taken as the broader side
of 4:3, so that as much is in view where a viewer takes it as the height. Lengths are in metres, in the axes of the
model.

Reference
---------
buildingSMART International. BIM Collaboration Format 2.1: markup.xsd, visinfo.xsd, version.xsd, and the documentation
of BCF-XML, release 2.1 (a folder entry for every topic, forward slashes).
"""

import datetime
import io
import itertools
import math
import statistics
import zipfile
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import shapely

from assess.bim.export_model import Box, ModelDoor, ModelElement, ModelPart, Place, find_middle, make_uuid
from assess.bim.export_results import (
    ExportPiece,
    ExportRun,
    ExportSegment,
    Point,
    list_importance,
    list_items,
    list_lines,
    list_routes,
    name_program,
    write_title,
)
from assess.bim.plan_shapes import FloatArray, direction_of
from assess.compare.past_run import UNCONFIRMED, PastRun
from assess.environment import find_source_date
from assess.i18n import gettext as _
from assess.report import words
from assess.risk import RiskClass
from assess.schedule_results import ScheduleRow
from assess.text import plain_text

MOST = 200  # topics in a file; the rest are counted
PRIORITIES = {
    RiskClass.VERY_HIGH: "Critical", RiskClass.HIGH: "Major", RiskClass.MEDIUM: "Normal", RiskClass.LOW: "Minor",
}  # fmt: skip
"""Priority by the class, upper estimate: words that programs for BCF know."""
VERSION = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<Version VersionId="2.1" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="version.xsd">\n'
    "  <DetailedVersion>2.1</DetailedVersion>\n</Version>\n"
)
FIELD_OF_VIEW = 60.0  # horizontal [deg]; BCF 2.1 allows 45 to 60
PICTURE = 4 / 3  # width over height of the picture
USED = 0.95  # part of the picture that may be used: a rim stays free
DISTANCE, EYE, LOWER = 3.0, 2.2, 1.5
"""Distance of the camera from a piece, and its height above the piece's base: under the usual ceilings [m].

`LOWER` is tried where not all is in view from `EYE`.
"""
FROM_WALL, NEAREST = 0.3, 0.2
"""Least distance of the camera from walls and ceiling, and from what it looks at, along its direction [m]."""
LARGEST = 20.0
"""Extent of pieces and doors that are looked at together; beyond it, doors may be left out of the picture [m]."""
GRID, RAYS, RINGS = 9, 16, (0.6, 0.8, 1.0, 1.5, 2.0)
"""Where in a room a camera is tried: places along each side, directions around the pieces, parts of the distance."""
TURNS = tuple(math.radians(sign * turn) for turn in (0, 22.5, 45, 67.5) for sign in (1, -1))
"""Directions in which the camera steps back, from that to which the first piece may fall."""
FARTHER, STEPS = 1.1, 100  # factor by which the camera steps back, and how often at most
ROUNDS = 6  # how often the direction of a camera is turned to the middle of what it sees
STEEPEST = 1e-3
"""Sine of the angle between the camera's direction and the vertical below which it looks straight down."""
NO_SIDE = 0.5
"""Distance from the middle of the room up to which a piece whose back is not known is seen from anywhere [m]."""
AGREE = 0.5  # distance up to which the positions of workbook and model are the same, in the median [m]
NEAR_DOOR = 1.0  # distance from an end of a segment, or from its line, up to which a door belongs to it [m]
SAME_STOREY = 2.0  # difference in height up to which a door is on the storey of a piece [m]
Pair = tuple[ExportPiece, ModelElement]


@dataclass(frozen=True, slots=True)
class Topics:
    """A file of topics. `unplaced` entries have no piece in the model, `beyond` are more than a file holds; `doors`
    counts topics that select one. `is_placed`: whether the positions of workbook and model agree, so that doors could
    be found.
    """

    data: bytes
    count: int
    unplaced: int
    beyond: int
    doors: int
    is_placed: bool


def list_entries(found: ExportRun, items: Collection[str]) -> list[ScheduleRow]:
    """Return the entries of the schedule that have one of the `items` in the model, `MOST` at most."""
    return [one for one in found.entries if any(item in items for item in list_items(one))][:MOST]


def write_topics(name: str, part: ModelPart, found: ExportRun, pairs: Sequence[Pair]) -> Topics:
    """Return the topics of a schedule; `part` has the boxes of its pieces."""
    by_item = {piece.item: (piece, element) for piece, element in pairs}
    entries = list_entries(found, by_item)
    middles = [find_middle(box) for box in {one.key: one.box for _piece, one in pairs}.values() if box is not None]
    x, y, _z = np.mean(middles, axis=0).tolist() if middles else (0.0, 0.0, 0.0)
    shift = find_shift(pairs)
    files: dict[str, bytes] = {"bcf.version": VERSION.encode()}
    counts = Counter(element.key for _piece, element in pairs)
    with_door = 0
    for entry in entries:
        own = [by_item[item] for item in list_items(entry) if item in by_item]
        doors = find_doors(own, found.segments, part.doors, shift)
        with_door += bool(doors)
        # of pieces that share an element the names tell the topics apart; of the same pieces a later topic is the same
        names = (one.key if counts[one.key] == 1 else f"{one.key} {piece.item}" for piece, one in own)
        guid = str(make_uuid("topic", *sorted(names)))
        view = _build_view(own, doors, find_camera(own, doors, (x, y)))
        key = str(make_uuid("viewpoint", guid, _dump(view).decode()))
        view.set("Guid", key)
        markup = ElementTree.Element("Markup")
        header = _add(_add(markup, "Header"), "File", isExternal="true")
        if part.project:
            header.set("IfcProject", part.project)
        _add(header, "Filename", name)
        _add_topic(markup, guid, found, entry, [piece for piece, _element in own], doors)
        _add(_add(markup, "Viewpoints", Guid=key), "Viewpoint", "viewpoint.bcfv")
        files |= {f"{guid}/": b"", f"{guid}/markup.bcf": _dump(markup), f"{guid}/viewpoint.bcfv": _dump(view)}
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            one, is_folder = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0)), path.endswith("/")
            one.create_system = 3  # wherever it is written
            one.external_attr = (0o40755 << 16 | 0x10) if is_folder else 0o100644 << 16
            one.compress_type = zipfile.ZIP_STORED if is_folder else zipfile.ZIP_DEFLATED
            archive.writestr(one, data)
    placed = sum(any(item in by_item for item in list_items(one)) for one in found.entries)
    return Topics(
        data=packed.getvalue(), count=len(entries), unplaced=len(found.entries) - placed, beyond=placed - len(entries),
        doors=with_door, is_placed=shift is not None,
    )  # fmt: skip


def _add_topic(
    markup: ElementTree.Element, guid: str, found: ExportRun, entry: ScheduleRow, pieces: Sequence[ExportPiece],
    doors: Sequence[ModelDoor],
) -> None:  # fmt: skip
    run = found.run
    risk, upper = max(one.risk for one in pieces), max(one.upper for one in pieces)
    topic = _add(markup, "Topic", Guid=guid, TopicType="Issue", TopicStatus="Open")
    _add(topic, "Title", write_title(found, entry, pieces))
    _add(topic, "Priority", PRIORITIES[upper])
    _add(topic, "Index", str(entry.place))
    # by labels programs group topics
    labels = [_("earthquake"), *map(words.risk_word, sorted({risk, upper})), entry.floor]
    apart = dict.fromkeys(one.basis for one in pieces if one.basis != run.main_basis)
    labels += [_("unconfirmed") if basis == UNCONFIRMED else _("by formula only") for basis in apart]
    if list_routes(found, list_items(entry)):
        labels.append(_("evacuation route"))
    for label in (*labels, *map(_, list_importance(pieces))):
        _add(topic, "Labels", label)
    _add(topic, "CreationDate", find_date(run).strftime("%Y-%m-%dT%H:%M:%SZ"))
    _add(topic, "CreationAuthor", str(run.building.get("prepared_by") or "") or name_program(run))
    lines = [
        *list_lines(found, entry, pieces),
        *(_("Also selected: door {name} ({key}), on the route that may be blocked.", name=door.name, key=door.key)
          for door in doors),
    ]  # fmt: skip
    known = {piece.item for piece in pieces}
    missing = [item for item in list_items(entry) if item not in known]
    if missing:
        lines.append(_("Not in this model: {names}.", names=words.name_first(missing, 8)))
    _add(topic, "Description", "\n".join(lines))


def find_date(run: PastRun) -> datetime.datetime:
    """Return the time of a run: the date of its report, else SOURCE_DATE_EPOCH, else when its results were written."""
    try:
        day = datetime.date.fromisoformat(str(run.building.get("report_date") or ""))
    except ValueError:
        return find_source_date() or run.written
    return datetime.datetime(day.year, day.month, day.day, tzinfo=datetime.UTC)


def _build_view(pairs: Sequence[Pair], doors: Sequence[ModelDoor], camera: "Camera | None") -> ElementTree.Element:
    view = ElementTree.Element("VisualizationInfo")
    components = _add(view, "Components")
    selection = _add(components, "Selection")
    for key in dict.fromkeys((*(one.key for _piece, one in pairs), *(one.key for one in doors))):
        _add(selection, "Component", IfcGuid=key)
    _add(components, "Visibility", DefaultVisibility="true")
    if camera is not None:
        seen = _add(view, "PerspectiveCamera")
        for name, place in zip(("ViewPoint", "Direction", "UpVector"), camera, strict=True):
            one = _add(seen, f"Camera{name}")
            for axis, value in zip("XYZ", place, strict=True):
                _add(one, axis, f"{value:.6f}")
        _add(seen, "FieldOfView", f"{FIELD_OF_VIEW:g}")
    return view


def _add(parent: ElementTree.Element, name: str, text: str | None = None, **attributes: str) -> ElementTree.Element:
    one = ElementTree.SubElement(parent, name, attributes)
    one.text = None if text is None else plain_text(text)
    return one


def _dump(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    data: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return data + b"\n"


# ---------------------------------------------------------------- what a topic selects, and from where it looks


def find_shift(pairs: Sequence[Pair]) -> Point | None:
    """Return whole metres that lead from positions of the workbook to the model; None if unknown, or they differ."""
    known = [(one.place, find_middle(element.box)) for one, element in pairs if one.place and element.box]
    if not known:
        return None
    x, y = (round(statistics.median(model[axis] - book[axis] for book, model in known)) for axis in (0, 1))
    left = statistics.median(math.dist((book[0] + x, book[1] + y), model[:2]) for book, model in known)
    return (float(x), float(y)) if left <= AGREE else None


def find_doors(
    pairs: Sequence[Pair], segments: Sequence[ExportSegment], doors: Sequence[ModelDoor], shift: Point | None
) -> list[ModelDoor]:
    """Return the door nearest to each piece on segments that it may block: those at their ends before others."""
    found: dict[str, ModelDoor] = {}
    for piece, element in pairs:
        if shift is None or element.box is None:
            continue
        lines = [
            shapely.LineString([(x + shift[0], y + shift[1]) for x, y in one.ends])
            for one in segments
            if one.ends and piece.item in one.items
        ]
        ends = [shapely.Point(end) for line in lines for end in line.coords]
        here, bottom = shapely.Point(find_middle(element.box)[:2]), element.box[0][2]
        storey = [(one, shapely.MultiPoint(one.points)) for one in doors if abs(one.bottom - bottom) <= SAME_STOREY]
        at_end = [one for one in storey if any(one[1].distance(end) <= NEAR_DOOR for end in ends)]
        near = at_end or [one for one in storey if any(one[1].distance(line) <= NEAR_DOOR for line in lines)]
        if near:
            door, _points = min(near, key=lambda one: (one[1].distance(here), one[0].key))
            found[door.key] = door
    return list(found.values())


class Camera(NamedTuple):
    """A perspective camera: its point, the direction in which it looks, and what is up in it, both of length 1."""

    point: Place
    direction: Place
    up: Place


def find_camera(pairs: Sequence[Pair], doors: Sequence[ModelDoor], centre: Point) -> Camera | None:
    """Return a camera that sees all of some pieces, the most urgent first, from the side to which that may fall.

    None where no place is known. Doors are seen as well, if they are not too far away. From `centre` a piece is seen
    whose back is not known, nor the room that it stands in.
    """
    placed = [(piece, one, one.box) for piece, one in pairs if one.box is not None]
    if not placed:
        return None
    piece, first, _box = placed[0]
    boxes = [box for _piece, _one, box in placed]
    x, y, _z = find_middle(_join(boxes))
    middle = find_middle(first.room) if first.room else centre
    dx, dy = middle[0] - x, middle[1] - y
    length = math.hypot(dx, dy)
    side = (dx / length, dy / length) if length > NO_SIDE else (-math.sqrt(0.5), -math.sqrt(0.5))
    if piece.faces is not None:
        u, v = direction_of(piece.faces)
        sign = -1 if not piece.falls_one_way and u * dx + v * dy < 0 else 1
        side = sign * u, sign * v
    for seen in ([*boxes, *(one.box for one in doors if one.box is not None)], boxes):
        corners = np.unique([corner for box in seen for corner in itertools.product(*zip(*box, strict=True))], axis=0)
        is_close = seen is boxes or math.dist(*_join(seen)) <= LARGEST
        for points in _list_points(_join(seen), side, first.room, steps_back=is_close):
            for some in np.array_split(points, max(1, len(points) // 32)):
                found = _aim(some, corners)
                if found is not None:
                    return found
    return None


def _join(boxes: Sequence[Box]) -> Box:
    x1, y1, z1 = (min(low[axis] for low, _ in boxes) for axis in range(3))
    x2, y2, z2 = (max(high[axis] for _, high in boxes) for axis in range(3))
    return (x1, y1, z1), (x2, y2, z2)


def _list_points(box: Box, side: Point, room: Box | None, *, steps_back: bool) -> Iterator[FloatArray]:
    """Yield where a camera is tried, (n, 3): inside the room at two heights, the nearest to the usual distance first.

    Then, if it `steps_back`, ever farther on the side to which the first piece may fall.
    """
    low, target = box[0], np.array(find_middle(box))
    if room is not None:
        start = np.array([target[0] + DISTANCE * side[0], target[1] + DISTANCE * side[1], low[2] + EYE])
        turns = np.arange(RAYS) * 2 * math.pi / RAYS
        rays = np.stack([np.cos(turns), np.sin(turns), np.zeros(RAYS)], axis=1)
        around = [target + DISTANCE * part * rays for part in RINGS]
        least, most = (np.array(corner) + sign * FROM_WALL for corner, sign in zip(room, (1, -1), strict=True))
        sides = (np.linspace(least[axis], most[axis], GRID) for axis in (0, 1))
        grid = np.array([(x, y, 0.0) for x, y in itertools.product(*sides)])
        plan = np.concatenate([start[None], *around, grid])
        for height in (EYE, LOWER):
            points = np.column_stack([plan[:, :2], np.full(len(plan), low[2] + height)])
            within = np.minimum(np.maximum(points, least), np.maximum(most, least))
            yield within[np.argsort(np.linalg.norm(within - start, axis=1), kind="stable")]
    if steps_back:
        own = math.atan2(side[1], side[0])
        rays = np.array([(math.cos(own + turn), math.sin(own + turn), 0.0) for turn in TURNS])
        distances = DISTANCE * FARTHER ** np.arange(STEPS)
        points = (target + distances[:, None, None] * rays).reshape(-1, 3)
        flat = np.repeat(distances, len(rays))
        points[:, 2] = low[2] + EYE if room else np.maximum(low[2] + EYE, target[2] + flat / 4)
        if room:
            points[:, 2] = np.minimum(points[:, 2], room[1][2] - FROM_WALL)
        yield points


def _aim(points: FloatArray, corners: FloatArray) -> Camera | None:
    """Return the camera at the first of some points from which all corners are in the picture, about its middle."""
    ways = corners[None] - points[:, None]
    forward = _scale((ways / np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), NEAREST)).mean(axis=1))
    for _round in range(ROUNDS):
        right, up = _find_axes(forward)
        _depth, across, upward = _project(ways, forward)
        x, y = ((one.min(axis=1) + one.max(axis=1))[:, None] / 2 for one in (across, upward))
        forward = _scale(forward + x * right + y * up)
    depth, across, upward = _project(ways, forward)
    most = USED * math.tan(math.radians(FIELD_OF_VIEW / 2))
    in_view = (depth >= NEAREST) & (np.abs(across) <= most) & (np.abs(upward) <= most / PICTURE)
    for at in np.flatnonzero(in_view.all(axis=1))[:1]:
        place, direction, up_vector = (
            (float(x), float(y), float(z)) for x, y, z in (points[at], forward[at], _find_axes(forward)[1][at])
        )
        return Camera(place, direction, up_vector)
    return None


def _scale(vectors: FloatArray) -> FloatArray:
    lengths: FloatArray = np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), STEEPEST)
    return vectors / lengths


def _find_axes(forward: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, y, _z = forward.T
    flat = np.hypot(x, y)
    right = np.stack([y, -x, np.zeros_like(x)], axis=1) / np.maximum(flat, STEEPEST)[:, None]
    right[flat < STEEPEST] = (1.0, 0.0, 0.0)
    return right, np.cross(right, forward)


def _project(ways: FloatArray, forward: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    depth, *off = (np.einsum("cna,ca->cn", ways, axis) for axis in (forward, *_find_axes(forward)))
    least = np.maximum(depth, NEAREST / 2)
    return depth, off[0] / least, off[1] / least
