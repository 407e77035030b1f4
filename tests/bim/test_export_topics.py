"""What to fix as BCF topics: by buildingSMART's schemas, with the right elements, as a coordinator reads them."""

import io
import itertools
import json
import math
import zipfile
from functools import cache
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import numpy as np
import pytest
from lxml import etree

from assess.bim import export_topics as topics_module
from assess.bim.export_results import read_export
from assess.bim.export_topics import FIELD_OF_VIEW, PRIORITIES, Topics, find_date
from assess.i18n import load_catalogue, speaking
from assess.risk import RiskClass
from tests.bim.export_runs import (
    BUILDING,
    CUPBOARD_1,
    CUPBOARD_2,
    CUPBOARDS,
    DOOR_B202,
    DUPLEX,
    FLOORS,
    OFFICE,
    PLACES,
    ROUTES,
    SIMULATED,
    SOFA,
    export,
    import_results,
    piece,
    write_adopted,
    write_results,
)

SCHEMAS = Path(__file__).parents[1] / "data" / "bcf"
BOTH = {CUPBOARD_1, CUPBOARD_2}


class Bcf:
    """A BCF file: its files, and the topics in the order of Index."""

    def __init__(self, data: bytes) -> None:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            self.names = archive.namelist()
            self.files = {name: archive.read(name) for name in self.names}
        folders = [name for name in self.names if name.endswith("/")]
        markups = {folder: etree.fromstring(self.files[f"{folder}markup.bcf"]) for folder in folders}
        self.topics = sorted((Read(self, folder, one) for folder, one in markups.items()), key=lambda one: one.index)


class Read:
    def __init__(self, bcf: Bcf, folder: str, markup: Any) -> None:
        self.folder, self.markup = folder, markup
        self.view = etree.fromstring(bcf.files[f"{folder}viewpoint.bcfv"])
        self.index = int(self.text("Index"))

    def text(self, name: str) -> str:
        return str(self.markup.findtext(f"Topic/{name}"))

    @property
    def labels(self) -> list[str]:
        return [one.text for one in self.markup.iterfind("Topic/Labels")]

    @property
    def selected(self) -> list[str]:
        return [one.get("IfcGuid") for one in self.view.iterfind("Components/Selection/Component")]

    def point(self, name: str) -> tuple[float, ...]:
        return tuple(float(one.text) for one in self.view.find(f"PerspectiveCamera/{name}"))


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """Return results in which each cupboard blocks the way out, and both surely fall: only fixing both opens it."""
    items = [CUPBOARDS[0] | {"description": "Armadio"}, CUPBOARDS[1] | {"description": "Libreria"}]
    floors = [{"floor": "2", "elevation": 3.1, "pfa_x": 2.5, "pfa_y": 2.5, "pfv_x": 400.0, "pfv_y": 400.0}]
    return write_results(tmp_path_factory.mktemp("pair"), items, floors, SIMULATED, places=PLACES, routes=ROUTES)


def export_topics(results: Path, model: Path = DUPLEX) -> Topics:
    found = export(results, model, with_properties=False).topics
    assert found is not None
    return found


def read_topics(results: Path, model: Path = DUPLEX) -> "Bcf":
    return Bcf(export_topics(results, model).data)


@pytest.fixture(scope="module")
def made(simulated):
    return export_topics(simulated)


@pytest.fixture(scope="module")
def bcf(made):
    return Bcf(made.data)


def find(bcf: Bcf, key: str) -> Read:
    return next(one for one in bcf.topics if key in one.selected)


def test_every_file_is_valid_and_laid_out_as_the_documentation_asks_with_a_topic_for_each_entry(bcf, simulated, made):
    for end, schema in (("markup.bcf", "markup"), (".bcfv", "visinfo"), ("bcf.version", "version")):
        rules = etree.XMLSchema(etree.parse(str(SCHEMAS / f"{schema}.xsd")))
        files = {name: data for name, data in bcf.files.items() if name.endswith(end)}
        assert len(files) == (1 if schema == "version" else len(bcf.topics))
        for data in files.values():
            rules.assertValid(etree.fromstring(data))
    assert bcf.names[0] == "bcf.version"
    assert len(bcf.names) == 1 + 3 * len(bcf.topics)
    for topic in bcf.topics:
        own = topic.markup.find("Topic").get("Guid")
        assert topic.folder == f"{own}/"
        link = topic.markup.find("Viewpoints")
        assert (link.findtext("Viewpoint"), link.get("Guid")) == ("viewpoint.bcfv", topic.view.get("Guid"))
    entries = json.loads(simulated.read_text(encoding="utf-8"))["schedule"]["entries"]
    assert [one.index for one in bcf.topics] == [one["place"] for one in entries]
    assert (made.count, made.unplaced, made.beyond) == (len(entries), 0, 0)


def test_a_topic_selects_its_pieces_and_their_door_and_says_what_is_to_be_done(bcf, made):
    topic = find(bcf, CUPBOARD_1)
    assert topic.selected[-1] == DOOR_B202
    assert set(topic.selected[:-1]) <= BOTH
    sofa = find(bcf, SOFA)
    assert sofa.selected == [SOFA]
    assert sofa.text("Title").startswith("unconfirmed (high): ")
    assert "unconfirmed" in sofa.labels
    assert "block" not in sofa.text("Title")
    assert (made.is_placed, made.doors) == (True, sum(DOOR_B202 in one.selected for one in bcf.topics))
    topic = find(bcf, CUPBOARD_2)
    title, text = topic.text("Title"), topic.text("Description")
    assert title.startswith("very high")
    for words in ("Armadio è 2", "may overturn and block route Scala", "life safety"):
        assert words in title
    for words in (
        "Floor 2, room B202.", "Risk of overturning: very high", "Armadio è 2 (Cupboard): chance of overturning ",
        ", simulated; PFA 1.200 g (given).", "Earthquake: Forte – 475 anni 🏢",
        "Why it comes here: life safety, route Scala: ", "How to fix: L-bracket to studs. Fixings of each piece: ",
        "Force on the fixings of each piece: tension ", "Forces are for screening, not design",
        "Palazzo Duè, building.xlsx, revision B, 2026-05-04, results.json SHA-256 ",
        f"({DOOR_B202}), on the route that may be blocked.",
    ):  # fmt: skip
        assert words in text
    assert topic.labels[:3] == ["earthquake", "very high", "2"]
    assert {"evacuation route", "life safety"} <= set(topic.labels)
    assert (topic.text("CreationDate"), topic.text("CreationAuthor")) == ("2026-05-04T00:00:00Z", "Ing. Rossi")
    kind = topic.markup.find("Topic")
    assert (kind.get("TopicType"), kind.get("TopicStatus"), topic.text("Priority")) == ("Issue", "Open", "Critical")
    file = topic.markup.find("Header/File")
    assert (file.findtext("Filename"), file.get("IfcProject")) == ("duplex.ifc", "1xS3BCk291UvhgP2a6eflL")


def test_the_camera_looks_down_at_the_piece_from_inside_its_room(bcf):
    topic = find(bcf, CUPBOARD_1)
    point, direction, up = (topic.point(f"Camera{name}") for name in ("ViewPoint", "Direction", "UpVector"))
    assert math.hypot(*direction) == pytest.approx(1, abs=1e-5)
    assert math.hypot(*up) == pytest.approx(1, abs=1e-5)
    assert sum(one * other for one, other in zip(direction, up, strict=True)) == pytest.approx(0, abs=1e-5)
    assert direction[2] < 0 < up[2]
    assert 3.1 < point[2] < 3.1 + 2.5, "between floor and ceiling of Level 2"
    assert -17.4 < point[1] < -11.6, "in room B202, which lies south of the cupboards"
    target = [at + 3.5 * to for at, to in zip(point, direction, strict=True)]
    assert math.dist(target, (3.3, -11.41, 4.1)) < 1.0
    assert 45 <= float(topic.view.findtext("PerspectiveCamera/FieldOfView")) <= 60


@pytest.mark.slow
def test_a_later_run_of_the_same_pieces_has_the_same_topics(simulated, flat, tmp_path):
    """So that a program for BCF brings a topic up to date, and keeps what was answered to it."""
    first, same = export_topics(simulated, flat).data, export_topics(simulated, flat).data
    assert first == same
    later = write_results(tmp_path, settings=SIMULATED, places=PLACES, routes=ROUTES,
                          building=BUILDING | {"revision": "C"})  # fmt: skip
    again = read_topics(later, flat)
    assert {one.folder for one in again.topics} == {one.folder for one in Bcf(first).topics}
    assert "revision C" in again.topics[0].text("Description")


@pytest.mark.slow
def test_entries_beyond_the_most_or_without_a_piece_are_counted(simulated, flat, tmp_path, monkeypatch):
    items = [CUPBOARDS[0], piece("Loose", "2", None, 3, -14, height=210.0)]
    found = export_topics(write_results(tmp_path, items), flat)
    assert (found.count, found.unplaced) == (1, 1)
    monkeypatch.setattr(topics_module, "MOST", 1)
    found = export_topics(simulated, flat)
    assert (found.count, found.beyond > 0) == (1, True)
    assert [one.index for one in Bcf(found.data).topics] == [1]


def test_pieces_that_only_help_together_are_one_topic(pair, flat):
    (entry,) = json.loads(pair.read_text(encoding="utf-8"))["schedule"]["entries"]
    assert (entry["only_together"], len(entry["works"])) == (True, 2)
    (topic,) = read_topics(pair, flat).topics
    assert set(topic.selected) == {*BOTH, DOOR_B202}
    title, text = topic.text("Title"), topic.text("Description")
    assert "Armadio è 1 and Armadio è 2 together" in title
    assert {"(Armadio; Libreria)" in title, "(Libreria; Armadio)" in title} == {True, False}
    assert "\nArmadio è 1 (Armadio): chance of overturning " in text
    assert "\nArmadio è 2 (Libreria): chance of overturning " in text
    assert "fixing only some of them opens no route" in text
    assert text.count("How to fix:") == 2


@pytest.mark.slow
def test_where_positions_do_not_agree_no_door_is_taken_and_shapeless_pieces_are_seen(flat, tmp_path):
    items = [CUPBOARDS[0], CUPBOARDS[1] | {"x": 9.0, "y": 4.0}, CUPBOARDS[3] | {"x": 1.0, "y": 30.0}]
    results = write_results(tmp_path, items, places=PLACES, routes=ROUTES)
    found = export_topics(results, flat)
    assert (found.is_placed, found.doors) == (False, 0)
    assert find(Bcf(found.data), CUPBOARD_1).point("CameraViewPoint")
    items[1] = CUPBOARDS[1]
    moved = read_topics(write_results(tmp_path, items, places=PLACES, routes=ROUTES), flat)
    assert DOOR_B202 in find(moved, CUPBOARD_1).selected
    model = ifcopenshell.open(str(flat))
    model.by_guid(CUPBOARD_1).Representation = None
    bare = tmp_path / "bare.ifc"
    model.write(str(bare))
    (topic,) = read_topics(write_results(tmp_path, CUPBOARDS[:1]), bare).topics
    assert math.dist(topic.point("CameraViewPoint")[:2], (2.91, -11.41)) < 4.5


WIDE = math.tan(math.radians(FIELD_OF_VIEW / 2))


def in_view(corners, point, direction, up):
    """Tell whether corners are in a picture of 4:3 whose broader side has the field of view."""
    ways = np.array(corners) - point
    depth, across, upward = (ways @ np.array(axis) for axis in (direction, np.cross(direction, up), up))
    return bool(
        (depth > 0).all() and (np.abs(across) <= WIDE * depth).all() and (np.abs(upward) <= WIDE * depth * 0.75).all()
    )


def read_corners(element):
    """Return the corners of the box around an element [m]."""
    shape = ifcopenshell.geom.create_shape(ifcopenshell.geom.settings(), element)
    points = np.array(shape.geometry.verts).reshape(-1, 3)
    matrix = np.array(shape.transformation.matrix).reshape(4, 4).T
    placed = points @ matrix[:3, :3].T + matrix[:3, 3]
    return list(itertools.product(*zip(placed.min(axis=0), placed.max(axis=0), strict=True)))


@pytest.mark.slow
def test_all_that_a_topic_selects_is_in_the_picture(tmp_path: Path):
    """All pieces of an import are found again, and the topics of those on drafted routes select doors of the model."""
    model = OFFICE
    results = import_results(tmp_path, model)
    found = export(results, model)
    elements, corners = ifcopenshell.open(str(model)), cache(read_corners)
    topics = Bcf(found.topics.data).topics
    assert len(topics) > 5
    with_door = 0
    for topic in topics:
        camera = [np.array(topic.point(f"Camera{name}")) for name in ("ViewPoint", "Direction", "UpVector")]
        assert float(topic.view.findtext("PerspectiveCamera/FieldOfView")) == FIELD_OF_VIEW
        selected = [elements.by_guid(key) for key in topic.selected]
        for element in selected:
            assert in_view(corners(element), *camera), (topic.text("Title"), element)
        has_door = any(one.is_a("IfcDoor") for one in selected)
        assert not has_door or "block route" in topic.text("Title")
        assert any(one.is_a("IfcFurnishingElement") for one in selected)
        with_door += has_door
    assert with_door == found.topics.doors


def test_topics_have_the_highest_and_the_upper_class_in_the_language_in_use(simulated, flat, tmp_path, pair):
    changed = write_adopted(simulated, tmp_path, {"class": "medium", "class_upper": "high", "probability": 0.2})
    for topic in read_topics(changed, flat).topics:
        assert {"medium", "high"} <= set(topic.labels)
        assert ", could be high: " in topic.text("Title")
        assert topic.text("Priority") == "Major"
    assert [PRIORITIES[risk] for risk in RiskClass] == ["Minor", "Normal", "Major", "Critical"]
    classes = [
        {"class": "medium", "class_upper": "very high", "probability": 0.5},
        {"class": "high", "class_upper": "high", "probability": 0.5},
    ]
    (topic,) = read_topics(write_adopted(pair, tmp_path, *classes), flat).topics
    assert topic.labels[:4] == ["earthquake", "high", "very high", "2"]
    assert topic.text("Title").startswith("high, could be very high: ")
    assert topic.text("Priority") == "Critical"
    with speaking(load_catalogue("it")):
        assert "molto alto" in find(read_topics(simulated, flat), CUPBOARD_1).labels


def test_entries_partly_in_the_model_pieces_of_one_source_id_and_doors_of_a_shifted_workbook_are_found(flat, tmp_path):
    items = [CUPBOARDS[0] | {"item": "C1"}, CUPBOARDS[0] | {"item": "C2", "source_id": None, "x": 3.71}]
    (topic,) = read_topics(write_results(tmp_path, items), flat).topics
    assert topic.selected == [CUPBOARD_1]
    assert "Not in this model: C2." in topic.text("Description")
    assert topic.text("Title").startswith("very high: C1 (")
    items = [CUPBOARDS[0], CUPBOARDS[1] | {"source_id": CUPBOARD_1, "height": 240.0, "room": "B203"}]
    found = read_topics(write_results(tmp_path, items), flat)
    assert [one.selected for one in found.topics] == [[CUPBOARD_1]] * 2
    assert len({one.folder for one in found.topics}) == 2
    assert all(not one.text("Description").count("Not in this model") for one in found.topics)
    # A workbook of a model far from its origin is shifted by whole metres; here there is no place at the door.
    places = [PLACES[0] | {"x": 1.9, "y": -13.5}, PLACES[2] | {"x": 1.0, "y": -10.3}]
    routes = [{"route": "Scala", "segment": "a", "floor": "2", "start": "B202", "end": "out"}]
    items = [CUPBOARDS[0] | {"edge_distance": 0.0, "route": "Scala"}]
    results = write_results(tmp_path, move(items, 1200), places=move(places, 1200), routes=routes)
    shifted = export_topics(results, flat)
    assert shifted.is_placed
    assert find(Bcf(shifted.data), CUPBOARD_1).selected == [CUPBOARD_1, DOOR_B202]


def move(rows: list[dict[str, Any]], by: float) -> list[dict[str, Any]]:
    return [one | {"x": one["x"] + by, "y": one["y"] - by} for one in rows]


def test_without_a_date_of_the_report_the_topics_have_that_of_the_results(tmp_path, monkeypatch):
    items = CUPBOARDS[:1]
    results = write_results(tmp_path, items, FLOORS, building=BUILDING | {"report_date": None})
    run = read_export(results).run
    assert find_date(run) == run.written
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert find_date(run).isoformat() == "1970-01-02T00:00:00+00:00"
