"""What to fix as topics of the BIM Collaboration Format, one for each entry of the schedule: a BCF 2.1 file.

Topics carry no snapshot: a picture needs a viewer of the model, which makes its own from the viewpoint.

Reference
---------
buildingSMART International. BIM Collaboration Format 2.1: markup.xsd, visinfo.xsd, version.xsd, and the documentation
of BCF-XML, release 2.1 (a folder entry for every topic, forward slashes).
"""

import datetime
import io
import zipfile
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from assess.bim.export_camera import FIELD_OF_VIEW, Camera, Pair, find_camera, find_doors, find_shift
from assess.bim.export_model import ModelDoor, ModelPart, find_middle
from assess.bim.export_properties import make_uuid
from assess.bim.export_results import ExportRun, list_items
from assess.bim.export_words import list_importance, list_lines, list_routes, say_program, say_title
from assess.compare.past_run import UNCONFIRMED, PastRun
from assess.environment import find_source_date
from assess.i18n import gettext as _
from assess.report import words
from assess.risk import RiskClass
from assess.schedule_results import ScheduleRow
from assess.text import plain_text

MOST = 200
"""Topics in a file; the rest are counted."""
TYPE, STATUS = "Issue", "Open"
PRIORITIES = {
    RiskClass.VERY_HIGH: "Critical", RiskClass.HIGH: "Major", RiskClass.MEDIUM: "Normal", RiskClass.LOW: "Minor",
}  # fmt: skip
"""Priority by the class, upper estimate: words that programs for BCF know."""
VERSION = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<Version VersionId="2.1" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="version.xsd">\n'
    "  <DetailedVersion>2.1</DetailedVersion>\n</Version>\n"
)
_Element = ElementTree.Element


@dataclass(frozen=True, slots=True)
class Topics:
    """A file of topics: its bytes, how many there are, and how many entries of the schedule it leaves out.

    `unplaced` have no piece in the model; `beyond` are more than a file holds. `doors` counts topics that select a
    door. `is_placed` tells whether the positions of workbook and model agree, so that doors could be found.
    """

    data: bytes
    count: int
    unplaced: int
    beyond: int
    doors: int
    is_placed: bool


def list_entries(found: ExportRun, items: Collection[str]) -> list[ScheduleRow]:
    """Return the entries of the schedule that have a piece in the model, `MOST` at most.

    `items` are the names of the pieces in the model.
    """
    return [one for one in found.entries if any(item in items for item in list_items(one))][:MOST]


def write_topics(name: str, part: ModelPart, found: ExportRun, pairs: Sequence[Pair]) -> Topics:
    """Return the topics of a schedule.

    `part`: what was found of it, with the boxes of the pieces in the schedule.
    """
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
        # of pieces that share an element the names tell the topics apart
        names = (one.key if counts[one.key] == 1 else f"{one.key} {piece.item}" for piece, one in own)
        topic = _Topic(str(make_uuid("topic", *sorted(names))), entry, own, doors, find_camera(own, doors, (x, y)))
        files |= _write_topic(name, part, found, topic)
    all_placed = sum(any(item in by_item for item in list_items(one)) for one in found.entries)
    return Topics(
        _pack(files), len(entries), len(found.entries) - all_placed, all_placed - len(entries), with_door,
        shift is not None,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Topic:
    """An entry of the schedule: its identifier, its pieces in the model, the doors that they obstruct, its camera.

    The identifier is made of that of its pieces, so that a later export of theirs is the same topic.
    """

    guid: str
    entry: ScheduleRow
    pairs: Sequence[Pair]
    doors: Sequence[ModelDoor]
    camera: Camera | None


def _write_topic(name: str, part: ModelPart, found: ExportRun, topic: _Topic) -> dict[str, bytes]:
    view = _build_view(topic)
    key = str(make_uuid("viewpoint", topic.guid, _dump(view).decode()))
    view.set("Guid", key)
    markup = _Element("Markup")
    header = _add(_add(markup, "Header"), "File", isExternal="true")
    if part.project:
        header.set("IfcProject", part.project)
    _add(header, "Filename", name)
    markup.append(_build_topic(found, topic))
    link = _add(markup, "Viewpoints", Guid=key)
    _add(link, "Viewpoint", "viewpoint.bcfv")
    folder = f"{topic.guid}/"
    return {folder: b"", f"{folder}markup.bcf": _dump(markup), f"{folder}viewpoint.bcfv": _dump(view)}


def _build_topic(found: ExportRun, topic: _Topic) -> _Element:
    entry, run = topic.entry, found.run
    pieces = [piece for piece, _element in topic.pairs]
    risk, upper = max(one.risk for one in pieces), max(one.upper for one in pieces)
    one = _Element("Topic", Guid=topic.guid, TopicType=TYPE, TopicStatus=STATUS)
    _add(one, "Title", say_title(found, entry, pieces))
    _add(one, "Priority", PRIORITIES[upper])
    _add(one, "Index", str(entry.place))
    # by labels programs group topics
    labels = [_("earthquake"), *map(words.risk_word, sorted({risk, upper})), entry.floor]
    apart = dict.fromkeys(one.basis for one in pieces if one.basis != run.main_basis)
    labels += [_("unconfirmed") if basis == UNCONFIRMED else _("by formula only") for basis in apart]
    if list_routes(found, list_items(entry)):
        labels.append(_("evacuation route"))
    for label in (*labels, *map(_, list_importance(pieces))):
        _add(one, "Labels", label)
    _add(one, "CreationDate", find_date(run).strftime("%Y-%m-%dT%H:%M:%SZ"))
    _add(one, "CreationAuthor", str(run.building.get("prepared_by") or "") or say_program(run))
    lines = [
        *list_lines(found, entry, pieces),
        *(_("Also selected: door {name} ({key}), on the route that may be blocked.", name=door.name, key=door.key)
          for door in topic.doors),
    ]  # fmt: skip
    known = {piece.item for piece in pieces}
    missing = [item for item in list_items(entry) if item not in known]
    if missing:
        lines.append(_("Not in this model: {names}.", names=words.name_first(missing, 8)))
    _add(one, "Description", "\n".join(lines))
    return one


def find_date(run: PastRun) -> datetime.datetime:
    """Return the time of a run: the date of its report, else SOURCE_DATE_EPOCH, else when its results were written."""
    try:
        day = datetime.date.fromisoformat(str(run.building.get("report_date") or ""))
    except ValueError:
        return find_source_date() or run.written
    return datetime.datetime(day.year, day.month, day.day, tzinfo=datetime.UTC)


def _build_view(topic: _Topic) -> _Element:
    view = _Element("VisualizationInfo")
    components = _add(view, "Components")
    selection = _add(components, "Selection")
    for key in dict.fromkeys((*(one.key for _piece, one in topic.pairs), *(one.key for one in topic.doors))):
        _add(selection, "Component", IfcGuid=key)
    _add(components, "Visibility", DefaultVisibility="true")
    if topic.camera is not None:
        camera = _add(view, "PerspectiveCamera")
        named = {"ViewPoint": topic.camera.point, "Direction": topic.camera.direction, "UpVector": topic.camera.up}
        for name, place in named.items():
            one = _add(camera, f"Camera{name}")
            for axis, value in zip("XYZ", place, strict=True):
                _add(one, axis, f"{value:.6f}")
        _add(camera, "FieldOfView", f"{FIELD_OF_VIEW:g}")
    return view


def _add(parent: _Element, name: str, text: str | None = None, **attributes: str) -> _Element:
    one = ElementTree.SubElement(parent, name, attributes)
    one.text = None if text is None else plain_text(text)
    return one


def _dump(root: _Element) -> bytes:
    ElementTree.indent(root)
    data: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return data + b"\n"


def _pack(files: Mapping[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            is_folder = name.endswith("/")
            entry.create_system = 3  # wherever it is written
            entry.external_attr = (0o40755 << 16 | 0x10) if is_folder else 0o100644 << 16
            entry.compress_type = zipfile.ZIP_STORED if is_folder else zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return packed.getvalue()
