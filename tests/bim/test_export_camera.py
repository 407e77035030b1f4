"""What a topic's camera has in its picture: all that is selected, in any picture of 4:3 or broader."""

import itertools
import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import ifcopenshell
import ifcopenshell.geom
import numpy as np
import pytest

from assess.bim.export_camera import FIELD_OF_VIEW, find_camera
from assess.bim.export_model import ModelDoor, ModelElement
from assess.bim.export_results import ExportPiece
from assess.compare.past_run import PastChance, PastPiece
from assess.risk import RiskClass
from tests.bim.export_runs import DUPLEX, OFFICE, export, import_results, read_rows
from tests.bim.test_export_topics import Bcf

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
@pytest.mark.parametrize(
    "model", [pytest.param(DUPLEX, marks=pytest.mark.long, id="duplex"), pytest.param(OFFICE, id="office")]
)
def test_all_that_a_topic_selects_is_in_the_picture(tmp_path: Path, model: Path):
    """All pieces of an import are found again, and the topics of those on drafted routes select doors of the model."""
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
    if model == DUPLEX:
        assert (found.is_complete, found.written) == (True, len(read_rows(results)))
        assert (found.topics.unplaced, found.topics.is_placed, with_door > 0) == (0, True, True)


def wardrobe(x, y, *, room=None, faces=270.0):
    """Return a wardrobe of 2 m with its middle at x, y of the ground floor."""
    past = PastPiece(
        item=f"{x} {y}", floor="1", room="", description="", quantity=1, is_held=False, basis="formula",
        risk=RiskClass.HIGH, chance=PastChance(0.5), inputs={},
    )  # fmt: skip
    piece = ExportPiece(
        past=past, source_id="", upper=RiskClass.HIGH, has_simulated=False, importance="", pfa_source="",
        place=(x, y), faces=faces, falls_one_way=True,
    )  # fmt: skip
    low, high = (x - 0.4, y - 0.3, 0.0), (x + 0.4, y + 0.3, 2.0)
    return piece, ModelElement(key="", name="", number=1, owner=0, has_set=False, box=(low, high), room=room)


def corners_of(box):
    return list(itertools.product(*zip(*box, strict=True)))


def look(pairs, doors=()):
    """Return the point of a camera from which all boxes were found in view."""
    camera = find_camera(pairs, doors, (0.0, 0.0))
    boxes = [one.box for _piece, one in pairs] + [one.box for one in doors]
    assert all(in_view(corners_of(box), camera.point, camera.direction, camera.up) for box in boxes)
    return camera.point


def is_inside(point, room):
    return all(low < at < high for low, at, high in zip(room[0], point, room[1], strict=True))


def test_in_a_room_that_is_large_enough_the_camera_stands_in_it():
    room = ((0.0, -5.0, 0.0), (5.0, 0.0, 2.6))
    assert is_inside(look([wardrobe(2.0, -0.3, room=room), wardrobe(3.0, -0.3, room=room)]), room)


def test_from_a_closet_it_steps_back_through_the_wall_before_the_piece():
    room = ((0.0, -1.2, 0.0), (1.0, 0.0, 2.6))
    point = look([wardrobe(0.5, -0.3, room=room)])
    assert point[1] < -1.2, "on the side to which the piece falls"
    assert 0 < point[2] < 2.6, "under the ceiling"


def test_pieces_far_apart_and_a_door_behind_the_camera_are_all_in_the_picture():
    room = ((0.0, -5.0, 0.0), (5.0, 0.0, 2.6))
    look([wardrobe(2.0, -0.3, room=room), wardrobe(25.0, -18.3), wardrobe(-30.0, 2.0)])
    assert look([wardrobe(2.0, -0.3), wardrobe(9.0, -3.3)])[2] > 2.0, "without rooms from above"
    door = ModelDoor("door", "", ((1.0, -5.0),), 0.0, ((1.0, -5.1, 0.0), (1.9, -5.0, 2.0)))
    look([wardrobe(2.0, -0.3, room=room)], [door])


def test_a_door_far_away_is_left_out_rather_than_the_piece():
    room = ((0.0, -4.0, 0.0), (4.0, 0.0, 2.6))
    door = ModelDoor("door", "", ((90.0, -4.0),), 0.0, ((90.0, -4.1, 0.0), (90.9, -4.0, 2.0)))
    pairs = [wardrobe(2.0, -0.3, room=room)]
    camera = find_camera(pairs, [door], (0.0, 0.0))
    assert camera == find_camera(pairs, [], (0.0, 0.0))


def test_without_any_place_there_is_no_camera():
    piece, element = wardrobe(0.0, 0.0)
    assert find_camera([(piece, replace(element, box=None))], [], (0.0, 0.0)) is None
