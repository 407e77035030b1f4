"""The floor under the pieces, drawn by a real mouse: its picture, rooms, doors, segments of routes and their states."""

import re

import pytest
from PIL import Image, ImageDraw
from playwright.sync_api import expect

from tests.web.plan_page import FLOORS, ITEMS, opened_plan, write_floor

pytestmark = [pytest.mark.browser, pytest.mark.slow]

NUMBERS = ("plan_left", "plan_bottom", "plan_width", "plan_turn")


@pytest.fixture
def plan(page, served_here, tmp_path):
    return opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", items=ITEMS[:2])))


@pytest.fixture
def empty(page, served_here, tmp_path):
    return opened_plan(page, served_here(write_floor(tmp_path / "empty.xlsx", items=[], places=[], routes=[])))


def draw_picture(path):
    """Write a picture twice as wide as high, with a line from 0.1 to 0.6 of its width."""
    picture = Image.new("RGB", (600, 300), "white")
    ImageDraw.Draw(picture).line([(60, 240), (360, 240)], fill="black", width=3)
    picture.save(path)


def on_picture(plan, u, v):
    """Return where a point of the picture is shown [px]; u and v are shares of its width, from its lower left."""
    return plan.page.locator("svg.plan .picture").evaluate(
        """(node, [u, v]) => {
        const width = node.width.baseVal.value;
        const point = new DOMPoint(u * width, -v * width).matrixTransform(node.getScreenCTM());
        return [point.x, point.y];
    }""",
        [u, v],
    )


def numbers(plan):
    return [plan.values("Floors", name).get(2) for name in NUMBERS]


def test_a_picture_is_placed_by_two_clicks_and_a_distance(page, served_here, tmp_path):
    draw_picture(tmp_path / "plan.png")
    floors = [FLOORS[0] | {"plan": "plan.png"}, FLOORS[1]]
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", floors=floors)))
    plan.tab("picture")
    for run, turn in (("", 0), ("90", 90)):
        expect(plan.panel).to_contain_text("Not placed yet")
        plan.page.get_by_role("button", name="Place by two points").click()
        plan.mouse.click(*on_picture(plan, 0.1, 0.1))
        plan.mouse.click(*on_picture(plan, 0.6, 0.1))
        form = plan.panel.locator("form")
        form.get_by_label("Distance of the two points").fill("6,5")
        form.get_by_label("X of the first point").fill("1")
        form.get_by_label("Y of the first point").fill("1.5")
        form.get_by_label("it runs").select_option(run)
        form.get_by_role("button", name="Place the picture").click()
        expect(plan.panel).to_contain_text("Placed: 13.00 m wide")
        plan.settle()
        box = plan.page.locator("svg.plan").bounding_box()
        for u, v in ((0, 0), (1, 0.5)):
            x, y = on_picture(plan, u, v)
            assert 0 <= x - box["x"] <= box["width"], "the placed picture is seen whole"
            assert 0 <= y - box["y"] <= box["height"]
        left, bottom, width, turned = numbers(plan)
        assert None not in (left, bottom)
        assert (width, turned) == (pytest.approx(13, abs=0.05), pytest.approx(turn, abs=0.3))
        ends = on_picture(plan, 0.1, 0.1), on_picture(plan, 0.6, 0.1)
        assert ends[0] == pytest.approx(plan.place(1, 1.5), abs=1.5)
        plan.tool("measure")
        for end in ends:
            plan.mouse.click(*end)
        plan.mouse.move(10, 400)
        length = float(plan.page.locator(".readout").text_content().split()[0])
        assert length == pytest.approx(6.5, abs=0.06), "the clicks lie within a pixel"
        plan.tool("select")
        plan.keyboard.press("Control+z")
        assert numbers(plan) == [None] * 4


def test_a_picture_is_added_to_the_floor_that_is_shown_and_dragged_when_unlocked(plan, tmp_path):
    draw_picture(tmp_path / "new.png")
    plan.tab("picture")
    plan.page.get_by_role("button", name="First").click()
    plan.page.locator("input[type=file]").last.set_input_files(tmp_path / "new.png")
    expect(plan.panel).to_contain_text("Not placed yet")
    expect(plan.page.get_by_role("button", name="First")).to_have_attribute("aria-pressed", "true")
    assert plan.values("Floors", "plan") == {3: "new.png"}
    plan.page.locator("nav.tabs [data-tab=sheet]").click()
    plan.open()
    expect(plan.page.get_by_role("button", name="First")).to_have_attribute("aria-pressed", "true")
    plan.page.get_by_role("button", name="Ground").click()
    plan.page.locator("input[type=file]").last.set_input_files(tmp_path / "new.png")
    expect(plan.panel).to_contain_text("Not placed yet")
    plan.panel.get_by_label("Unlocked").check()
    plan.drag((3, 3), (4, 3.5))
    left, bottom, width, turn = numbers(plan)
    assert None not in (left, bottom, width)
    plan.drag((3, 3), (3.5, 2))
    assert numbers(plan) == [pytest.approx(left + 0.5, abs=0.05), pytest.approx(bottom - 1, abs=0.05), width, turn]
    plan.keyboard.press("Control+z")
    assert numbers(plan) == [left, bottom, width, turn]


def test_rooms_doors_and_a_way_are_drawn_and_its_state_follows(empty):
    plan = empty
    expect(plan.page.locator(".plan-empty")).to_contain_text("Nothing is on this floor yet")
    plan.tool("room")
    for corner in ((1, 1), (6, 1), (6, 5), (1, 5)):
        plan.click(*corner)
    plan.keyboard.press("Enter")
    room = plan.values("Places", "place")[2]
    outline = plan.outline(2)
    assert [one for corner in outline for one in corner] == pytest.approx([1, 1, 6, 1, 6, 5, 1, 5], abs=0.06)
    assert outline[0][1] == outline[1][1], "nearly level sides are level"
    assert plan.values("Places", "kind")[2] == "room"
    assert (plan.values("Places", "x")[2], plan.values("Places", "y")[2]) == pytest.approx((3.5, 3), abs=0.1)
    plan.keyboard.press("e")
    plan.page.get_by_label("Width of the door or exit").fill("1,1")
    near = 15 / plan.scale()
    plan.click(6 - near, 3.5)
    assert plan.values("Places", "kind")[3] == "exit"
    assert plan.values("Places", "x")[3] == outline[1][0], "it goes to the wall"
    left, right = (plan.page.locator(".opening .gap").bounding_box()[side] for side in ("y", "height"))
    assert right == pytest.approx(1.1 * plan.scale(), abs=6), left
    expect(plan.panel.get_by_label("Width")).to_have_value("1.1")
    plan.tool("way")
    plan.page.get_by_label("Route of new ways").fill("Way out")
    plan.click(3.5, 3.2)
    plan.click(6, 3.5)
    assert plan.values("Routes", "route") == {2: "Way out"}
    assert (plan.values("Routes", "start")[2], plan.values("Routes", "end")[2]) == (
        room,
        plan.values("Places", "place")[3],
    )
    assert plan.values("Routes", "clear_width") == {2: 1.1}, "the way is as wide as the exit"
    plan.keys("Escape", "Escape")
    expect(plan.page.locator("[data-tool=select]")).to_have_attribute("aria-pressed", "true")
    expect(plan.page.locator(".band")).to_have_class(re.compile("state-not-known"))  # no furniture is listed
    plan.click(6, 3.5)
    plan.panel.get_by_label("Width").fill("0.8")
    plan.keyboard.press("Enter")
    assert plan.values("Routes", "clear_width") == {2: 0.8}
    expect(plan.panel).to_contain_text("Narrower than Required width")
    plan.page.locator("svg.plan").focus()
    for _ in range(4):
        plan.keys("Control+z").settle()
    assert plan.values("Places", "place") == {}


def test_a_corridor_is_dragged_named_while_it_is_typed_and_a_draft_leaves_the_old_selection_alone(plan):
    plan.click(6.5, 1)
    expect(plan.panel.locator(".details h2")).to_have_text("Hall")
    plan.tool("corridor")
    expect(plan.panel.locator(".details h2")).to_have_text("Corridor")
    expect(plan.panel.locator("input:visible")).to_have_count(0)
    plan.click(9, 1)
    expect(plan.panel.locator("input:visible")).to_have_count(0)
    plan.keyboard.press("Escape")
    plan.press(8, 0)
    plan.mouse.move(*plan.place(10, 5), steps=6)
    expect(plan.page.locator(".readout")).to_have_text(re.compile(r"^2\.\d+ m × 5\.\d+ m$|^2\.\d+ m × 4\.9\d m$"))
    plan.mouse.up()
    assert plan.values("Places", "kind")[4] == "corridor"
    corners = plan.outline(4)
    assert corners[0] == [8, 0], "it snaps to the corner of the hall"
    assert corners[2] == pytest.approx([10, 5], abs=0.06)
    name = plan.panel.get_by_label("Place")
    name.fill("Long corridor")
    expect(plan.panel.locator(".details h2")).to_have_text("Long corridor")
    plan.click(9, 4)  # another click first writes what was typed, into the cell that it was typed for
    assert plan.values("Places", "place") == {2: "Hall", 3: "Door", 4: "Long corridor"}
    expect(plan.page.locator(".mark-corridor .place-name")).to_have_text("Long corridor")
    plan.page.get_by_role("button", name="Zoom out").click(click_count=4)
    plan.click(6.5, 1)
    expect(plan.panel.locator(".details h2")).to_have_text("Hall")
    name.fill("Great")
    plan.click(9, 4)
    assert plan.values("Places", "place") == {2: "Great", 3: "Door", 4: "Long corridor"}


def test_a_piece_that_would_block_the_way_changes_its_state(plan):
    expect(plan.page.locator(".band")).to_have_class(re.compile("state-open"))
    plan.drag((5, 4), (6.5, 3), keys=["Alt"])
    expect(plan.page.locator(".band")).to_have_class(re.compile("state-blocked|state-standing"))
    plan.tab("routes")
    expect(plan.panel.locator(".states")).to_have_count(2)
    expect(plan.panel.locator(".states").first).to_contain_text("✕ blocked")
    plan.page.locator("nav.tabs [data-tab=overview]").click()
    plan.page.locator("#view-overview .states").get_by_role("button", name="Hall").click()
    expect(plan.panel.locator(".details h2")).to_have_text("Hall")
    expect(plan.panel.locator(".details .state-line")).to_contain_text("✕ blocked")
    plan.tab("routes")
    plan.keyboard.press("Control+z")
    expect(plan.panel.locator(".states").first).to_contain_text("✓ open")


def test_corners_of_a_room_are_dragged_added_and_taken_out_and_a_new_name_keeps_its_segments(plan):
    def outline():
        return plan.values("Places", "outline")[2]

    plan.click(6.5, 1)
    expect(plan.page.locator(".handle.vertex")).to_have_count(4)
    plan.drag((8, 6), (7, 5), keys=["Alt"])
    corners = [[float(one) for one in corner.split()] for corner in outline().split("; ")]
    assert corners[2] == pytest.approx([7, 5], abs=0.02)
    plan.drag((4, 0), (4, 1), keys=["Alt"])
    assert len(outline().split("; ")) == 5
    plan.mouse.dblclick(*plan.place(4, 1))
    assert len(outline().split("; ")) == 4
    for _ in range(3):
        plan.keys("Control+z").settle()
    assert outline() == "0 0; 8 0; 8 6; 0 6"
    plan.click(6.5, 1)
    plan.panel.get_by_label("Place").fill("Great hall")
    plan.keyboard.press("Enter")
    assert plan.values("Places", "place")[2] == "Great hall"
    assert plan.values("Routes", "start")[2] == "Great hall"
    expect(plan.page.locator(".band")).to_have_class(re.compile("state-open"))


def test_a_click_on_a_way_splits_it_and_one_beside_it_tells_what_to_click(plan):
    before = plan.place(6, 3)
    plan.tool("way")
    assert plan.place(6, 3) == before, "choosing a tool moves nothing under the mouse"
    plan.page.get_by_label("Route of new ways").fill("Side way")
    plan.click(4, -0.4)
    expect(plan.page.locator(".readout")).to_have_text("Click a room, corridor, door, stair or exit.")
    assert plan.values("Routes", "route") == {2: "Way out"}
    plan.click(6, 3)
    plan.page.get_by_role("button", name="Split it here").click()
    plan.settle()
    assert plan.values("Places", "place")[4] == "1 corridor 1"
    assert plan.values("Places", "kind")[4] == "corridor"
    assert (plan.values("Places", "x")[4], plan.values("Places", "y")[4]) == pytest.approx((6, 3), abs=0.02)
    assert plan.values("Routes", "segment") == {2: "1", 3: "2"}
    assert plan.values("Routes", "start") == {2: "Hall", 3: "1 corridor 1"}
    assert plan.values("Routes", "end") == {2: "1 corridor 1", 3: "Door"}
    expect(plan.page.locator(".band")).to_have_count(2)
    plan.click(4, 3)
    assert plan.values("Routes", "start")[4] == "1 corridor 1", "the junction is where the next segment begins"
    assert plan.values("Routes", "end")[4] == "Hall"
    assert plan.values("Routes", "route")[4] == "Side way"
    plan.keys("Control+z", "Control+z")
    assert plan.values("Routes", "end") == {2: "Door"}
    assert plan.values("Places", "place") == {2: "Hall", 3: "Door"}


def test_a_room_is_drawn_by_keyboard_alone(empty):
    plan = empty
    plan.page.locator("svg.plan").focus()
    plan.keyboard.press("o")
    for keys in ("ArrowLeft", "ArrowUp " * 10, "ArrowRight " * 12, "Shift+ArrowDown " * 5):
        for key in keys.split():
            plan.keyboard.press(key)
        plan.keyboard.press("Enter")
    expect(plan.say()).to_have_text(re.compile(r"X .* m, Y .* m"))
    plan.keyboard.press("Enter")
    corners = plan.outline(2)
    (x, y), *others = corners
    assert [one for corner in others for one in corner] == pytest.approx([x, y + 1, x + 1.2, y + 1, x + 1.2, y + 0.95])
    expect(plan.page.locator("[data-tool=select]")).to_have_attribute("aria-pressed", "true")
