"""Pieces on the plan by a real mouse and by keys: what lands in the workbook, what stays, what undo brings back."""

import re
from itertools import pairwise

import pytest
from playwright.sync_api import expect

from tests.web.plan_page import opened_plan, write_floor
from tests.web.sheet_page import CLASS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

TOOLS = ("select", "measure", "room", "corridor", "door", "stair", "exit", "way")
A1, A2, A3, FREE = 2, 3, 4, 6
"""Rows of the pieces, and the first free one."""


@pytest.fixture
def plan(page, served_here, tmp_path):
    return opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx")))


def test_a_dragged_piece_moves_in_the_workbook_and_undo_brings_it_back(page, served_here, tmp_path):
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx")), width=2200)
    before = plan.server.client.get("/api/download").data
    expect(plan.piece(A2)).to_have_class(re.compile("class-medium unconfirmed"))
    shown = plan.piece(A2).get_attribute("class")
    plan.drag((5, 4), (5.5, 3.5), (3.5, 2.5), keys=["Alt"])
    assert plan.at(A2) == (3.5, 2.5, 0)
    assert plan.shown_at(A2) == (3.5, 2.5)
    assert re.sub(" selected", "", plan.piece(A2).get_attribute("class")) == shown
    plan.keyboard.press("Control+z")
    assert plan.at(A2) == (5, 4, 0)
    expect(plan.piece(A2)).to_have_attribute("transform", "translate(5.0000 -4.0000)")
    assert plan.server.client.get("/api/download").data == before
    plan.keyboard.press("Control+y")
    assert plan.at(A2) == (3.5, 2.5, 0)
    plan.page.locator("nav.tabs [data-tab=sheet]").click()
    sheet = plan.sheet.open("Items")
    expect(sheet.cell("X", A2)).to_have_text("3.5")
    expect(sheet.cell(CLASS, A2)).to_contain_text("medium")
    sheet.select("X", A2).type("<Control+z>")
    expect(sheet.cell("X", A2)).to_have_text("5")
    plan.open()
    expect(plan.piece(A2)).to_have_attribute("transform", "translate(5.0000 -4.0000)")


def test_a_late_answer_does_not_move_a_piece_back_and_the_selection_is_shared_with_the_sheet(plan):
    """While the server still answers for the plan before, the piece stays where it was dropped."""
    held = []
    plan.page.route("**/api/plan*", lambda route: held.append(route))  # noqa: PLW0108 - it looks at its arguments
    plan.drag((5, 4), (4, 2), keys=["Alt"])
    assert plan.shown_at(A2) == (4, 2)
    plan.drag((4, 2), (3, 3), keys=["Alt"])
    held[-1].continue_()
    plan.page.unroute("**/api/plan*")
    plan.settle()
    expect(plan.piece(A2)).to_have_attribute("transform", "translate(3.0000 -3.0000)")
    assert plan.at(A2)[:2] == (3, 3)
    plan.click(3, 3)
    plan.page.locator("nav.tabs [data-tab=sheet]").click()
    expect(plan.page.locator(".sheet-cell")).to_have_text(re.compile(f"{A2}$"))
    plan.sheet.open("Items").select("Description", 5)
    plan.open()
    expect(plan.page.get_by_role("button", name="First")).to_have_attribute("aria-pressed", "true")
    expect(plan.piece(5)).to_have_class(re.compile("selected"))


def test_several_pieces_are_dragged_in_one_step_and_undone_wherever_the_focus_is(plan):
    plan.drag((1, 5.5), (6, 1))
    expect(plan.page.locator(".piece.selected")).to_have_count(2)
    plan.drag((2, 2), (3, 3), keys=["Alt"])
    assert (plan.at(A1)[:2], plan.at(A2)[:2]) == ((3, 3), (6, 5))
    plan.keyboard.press("Control+z")
    assert (plan.at(A1)[:2], plan.at(A2)[:2]) == ((2, 2), (5, 4))
    plan.drag((2, 2), (3, 3), keys=["Alt"])
    for focused in (
        plan.page.get_by_label("Snap"),
        plan.page.get_by_label("Show fall zones:"),
        plan.page.locator("[data-tool=select]"),
    ):
        focused.focus()
        plan.keyboard.press("Control+z")
        assert plan.at(A1)[:2] == (2, 2)
        plan.keyboard.press("Control+y")
        assert plan.at(A1)[:2] == (3, 3)


def test_a_piece_is_turned_and_snaps_to_the_wall_and_to_another_piece_unless_alt_is_held(plan):
    plan.click(5, 4)
    handle = plan.page.locator(".handle.turn")
    box = handle.locator("circle").last.bounding_box()
    plan.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    plan.mouse.down()
    plan.mouse.move(*plan.place(4.9, 5.5), steps=8)
    plan.mouse.up()
    assert plan.at(A2) == (5, 4, 90)
    plan.keyboard.press("Shift+R")
    assert plan.at(A2) == (5, 4, 105)
    plan.keyboard.press("r")
    assert plan.at(A2) == (5, 4, 195)
    for angle in (105, 90, 0):
        plan.keyboard.press("Control+z")
        assert plan.at(A2) == (5, 4, angle)
    near = 3 / plan.scale()
    plan.drag((5, 4), (7.8 - near, 4.03))
    assert plan.at(A2)[0] == 7.8, "its side, 0.2 m from its centre, lies on the wall at 8 m"
    plan.drag((7.8, 4), (2 + 0.4 + 0.2 + near, 3.2))
    assert plan.at(A2)[0] == 2.6, "side by side with A1, which is turned by 90 degrees and 0.8 m wide along X"
    x = plan.at(A2)[0]
    plan.drag((x, 3.2), (7.8 - near, 3.2), keys=["Alt"])
    assert plan.at(A2)[0] == pytest.approx(7.8 - near, abs=0.011)
    assert plan.at(A2)[0] != 7.8 or near < 0.005


def test_keys_alone_select_move_copy_and_take_off(plan):
    plan.page.locator("svg.plan").focus()
    for _ in range(12):
        plan.keyboard.press("Tab")
        if plan.piece(A2).evaluate("node => node === document.activeElement"):
            break
    expect(plan.piece(A2)).to_be_focused()
    expect(plan.piece(A2)).to_have_attribute("aria-label", re.compile("A2.*class medium.*chance.*X 5.00 m, Y 4.00 m"))
    plan.keys("Enter", "ArrowLeft", "Shift+ArrowUp")
    assert plan.at(A2) == (4.95, 4.01, 0)
    plan.keyboard.down("ArrowRight")
    for _ in range(9):
        plan.keyboard.down("ArrowRight")
    plan.keyboard.up("ArrowRight")
    assert plan.at(A2)[0] == 5.45
    plan.keyboard.press("Control+z")
    assert plan.at(A2)[0] == 4.95, "a held key is one step"
    plan.keyboard.press("Control+d")
    expect(plan.piece(FREE)).to_be_focused()
    assert plan.at(FREE) == (5.45, 3.51, 0)
    assert plan.values("Items", "item")[FREE] == "A4"
    assert plan.values("Items", "anchored")[FREE] == "no"
    plan.keyboard.press("Delete")
    plan.page.get_by_role("button", name="Remove from the plan").click()
    assert plan.at(FREE) == (None, None, 0)
    plan.keyboard.press("Control+z")
    expect(plan.piece(FREE)).to_be_visible()
    plan.click(5.45, 3.51)
    plan.keyboard.press("Delete")
    plan.page.get_by_role("button", name="Delete the row").click()
    expect(plan.piece(FREE)).to_have_count(0)
    assert FREE not in plan.values("Items", "item")


def test_a_copy_lies_beside_the_original_or_on_another_floor(plan):
    plan.click(2, 2)
    plan.keys("Control+c", "Control+v")
    assert plan.at(FREE)[:2] == (2.5, 1.5)
    expect(plan.say()).to_have_text("1 piece pasted")
    plan.keyboard.press("Control+v")
    assert plan.at(FREE + 1)[:2] == (3, 1)
    plan.keys("Control+z", "Control+z")
    plan.settle()
    plan.click(2, 2)
    plan.keyboard.press("Control+c")
    plan.page.get_by_role("button", name="First").click()
    expect(plan.piece(5)).to_be_visible()
    plan.mouse.move(*plan.place(1.5, 1.2))
    plan.keyboard.press("Control+v")
    expect(plan.piece(FREE)).to_be_visible()
    x, y, angle = plan.at(FREE)
    assert (x, y, angle) == (pytest.approx(1.5, abs=0.02), pytest.approx(1.2, abs=0.02), 90)
    assert plan.values("Items", "floor")[FREE] == "2"
    assert plan.values("Items", "description")[FREE] == "Bookcase"


def test_what_is_not_known_of_a_piece_is_marked_and_leads_to_its_cell(page, served_here, tmp_path):
    items = [{"item": "A1", "floor": "1", "type": "Bookcase 5 shelves", "x": 3, "y": 3, "angle_deg": 0}]
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", items=items, routes=[])))
    piece = plan.piece(A1)
    expect(piece).to_have_class(re.compile("width-missing"))
    expect(piece.locator(".unknown")).to_have_text(["?", "?"])
    assert piece.locator(".body").evaluate("node => getComputedStyle(node).strokeDasharray") != "none"
    plan.click(3, 3)
    expect(plan.page.locator(".fallen .unknown")).to_have_count(4)
    expect(plan.panel).to_contain_text("0.32 × ? × 1.8")
    plan.panel.get_by_role("button", name="Fill in Width: how far it reaches is not known.").click()
    expect(plan.page.locator(".sheet-cell")).to_have_text(re.compile(rf"![B-Z]{A1}$"))
    plan.sheet.type("80", "<Enter>")
    plan.open()
    expect(piece).not_to_have_class(re.compile("missing"))
    expect(piece.locator(".unknown")).to_have_count(0)
    assert plan.sheet.settle().values("Items", "width") == {A1: 80}


def test_a_type_is_dragged_from_the_catalogue_and_an_unplaced_piece_from_its_list(plan):
    plan.tab("add")
    plan.panel.get_by_label("Find a type").fill("bookcase tall")
    source = plan.panel.locator("[data-type='Bookcase tall']").bounding_box()
    plan.mouse.move(source["x"] + 20, source["y"] + 10)
    plan.mouse.down()
    plan.mouse.move(*plan.place(4, 1.5), steps=8)
    plan.mouse.up()
    expect(plan.piece(FREE)).to_be_visible()
    assert plan.at(FREE) == (pytest.approx(4, abs=0.02), pytest.approx(1.5, abs=0.02), 0)
    assert plan.values("Items", "type")[FREE] == "Bookcase tall"
    assert plan.values("Items", "floor")[FREE] == "1"
    assert plan.values("Items", "item")[FREE] == "A4"
    expect(plan.piece(FREE)).to_have_class(re.compile("class-(very-)?high"))
    plan.tab("pieces")
    source = plan.panel.locator(f".unplaced [data-row='{A3}']").bounding_box()
    plan.mouse.move(source["x"] + 20, source["y"] + 10)
    plan.mouse.down()
    plan.keyboard.down("Alt")
    plan.mouse.move(*plan.place(6, 1), steps=8)
    plan.mouse.up()
    plan.keyboard.up("Alt")
    assert plan.at(A3)[:2] == (pytest.approx(6, abs=0.02), pytest.approx(1, abs=0.02))
    expect(plan.piece(A3)).to_be_visible()
    plan.keyboard.press("Control+z")
    expect(plan.piece(A3)).to_have_count(0)
    assert plan.at(A3)[:2] == (None, None)


def test_positions_are_written_in_the_unit_of_the_workbook(page, served_here, tmp_path):
    foot = 0.3048
    items = [{"item": "A1", "floor": "1", "breadth": 16, "width": 32, "height": 80, "x": 2 / foot, "y": 2 / foot}]
    path = write_floor(tmp_path / "feet.xlsx", "imperial", items, places=[], routes=[])
    plan = opened_plan(page, served_here(path))
    plan.drag((2, 2), (3, 2.5), keys=["Alt"])
    assert plan.at(2)[:2] == (pytest.approx(3 / foot, abs=0.006), pytest.approx(2.5 / foot, abs=0.006))
    expect(plan.page.locator(".scale-bar")).to_have_text(re.compile("ft$"))


def test_several_pieces_are_aligned_and_given_one_value_in_one_step(plan):
    plan.click(2, 2)
    plan.keys("Control+d", "Control+d", "Control+a")
    expect(plan.panel.locator(".details h2")).to_have_text("4 pieces selected")
    before = {row: plan.at(row) for row in (A1, A2, FREE, FREE + 1)}
    for name, edge in (("Align left", -1), ("Align right", 1)):
        plan.panel.get_by_role("button", name=name).click()
        half = {A2: 0.2}  # A2 lies along Y, the others along X
        edges = {round(plan.at(row)[0] + edge * half.get(row, 0.4), 2) for row in before}
        assert len(edges) == 1, name
        assert [plan.at(row)[1:] for row in before] == [one[1:] for one in before.values()]
        plan.keyboard.press("Control+z")
        assert {row: plan.at(row) for row in before} == before, "one step"
    plan.panel.get_by_role("button", name="Align centres, side by side").click()
    assert len({plan.at(row)[1] for row in before}) == 1
    plan.panel.get_by_role("button", name="Equal gaps from left to right").click()
    ends = sorted((plan.at(row)[0] - half, plan.at(row)[0] + half) for row, half in
                  ((A1, 0.4), (A2, 0.2), (FREE, 0.4), (FREE + 1, 0.4)))  # fmt: skip
    gaps = [right[0] - left[1] for left, right in pairwise(ends)]
    assert gaps == pytest.approx([gaps[0]] * 3, abs=0.021)
    anchored = plan.panel.get_by_label("Anchored")
    assert anchored.evaluate("one => one.selectedOptions[0].textContent") == "several"
    anchored.select_option("yes")
    rows = (A1, A2, FREE, FREE + 1)
    assert [plan.values("Items", "anchored").get(row) for row in rows] == ["yes"] * 4
    plan.panel.get_by_label("Height").fill("150")
    plan.keyboard.press("Tab")
    assert [plan.values("Items", "height")[row] for row in rows] == [150] * 4
    plan.panel.get_by_label("Height").fill("tall")
    plan.keyboard.press("Tab")
    plan.keys("Control+z", "Control+z", "Control+z")
    assert [plan.values("Items", "height")[row] for row in rows] == [200] * 4
    assert [plan.values("Items", "anchored").get(row) for row in rows] == [None, "no", None, None]


def test_pieces_of_a_room_stand_along_its_walls_clear_of_doors_and_of_each_other(page, served_here, tmp_path):
    sizes = {"floor": "1", "room": "hall", "breadth": 40, "height": 200}
    items = [
        {"item": "A1", **sizes, "width": 80, "x": 3.0, "y": 0.2, "angle_deg": 90},
        *({"item": f"C{n}", **sizes, "width": 200} for n in range(1, 11)),
        {"item": "D1", **sizes, "width": 400, "axis": "X"},
        {"item": "E1", **sizes, "width": 80, "quantity": 4},
        {"item": "F1", **sizes | {"room": "Store"}, "width": 80},
    ]
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", items=items)))
    plan.tab("pieces")
    plan.panel.get_by_role("button", name="Place along the walls").click()
    expect(plan.page.locator(".piece")).to_have_count(10)
    told = plan.page.locator(".notice")
    expect(told).to_contain_text("9 pieces placed along the walls of Hall.")
    expect(told).to_contain_text("E1: give each piece a row of its own.")
    expect(told).to_contain_text("No room along the walls for C9, C10.")
    areas = []
    for row in (*range(2, 11), 13):
        x, y, angle = plan.at(row)
        along, across = (plan.values("Items", "width")[row] / 200, 0.2)
        half = (across, along) if angle == 0 else (along, across)
        assert angle in (0, 90)
        if row > 2:
            assert min(x - half[0], 8 - x - half[0], y - half[1], 6 - y - half[1]) == pytest.approx(0, abs=0.011), row
        areas.append((x - half[0], y - half[1], x + half[0], y + half[1]))
    areas.append((7.1, 2.55, 8.9, 3.45))  # before and behind the exit
    for n, (x0, y0, x1, y1) in enumerate(areas):
        for a0, b0, a1, b1 in areas[:n]:
            assert min(x1 - a0, a1 - x0, y1 - b0, b1 - y0) < 0.02
    assert plan.at(13)[2] == 0, "its Axis is X, so that its Breadth runs along X"
    plan.keyboard.press("Control+z")
    expect(plan.page.locator(".piece")).to_have_count(1)
    assert set(plan.values("Items", "x")) == {2}


def test_lists_have_the_worst_first_and_a_word_for_pieces_without_a_class(page, served_here, tmp_path):
    sizes = {"floor": "1", "room": "Hall", "width": 80, "height": 200}
    placed = [{**sizes, "item": f"A{n}", "breadth": breadth, "x": n, "y": 1.0}
              for n, breadth in enumerate((60, 30, 45, 50), 1)]  # fmt: skip
    items = [*placed, {**sizes, "item": "B1", "breadth": 60, "height": 60}, {**sizes, "item": "B2", "breadth": 25}]
    items.append({**sizes, "item": "C1", "breadth": 40, "anchored": "yes", "x": 6.0, "y": 3.0})
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", items=items)))
    plan.tab("pieces").settle()
    expect(plan.panel.locator(".by-class b").first).to_have_text("A2")
    for group in plan.panel.locator(".by-class .rows").all():
        shown = [float(one) for one in re.findall(r"([\d.]+)\s%", group.inner_text())]
        assert shown == sorted(shown, reverse=True)
    expect(plan.panel.locator(".unplaced b")).to_have_text(["B2", "B1"])
    expect(plan.panel.locator(".unplaced .badge").first).to_have_class(re.compile("class-(very-)?high"))
    expect(plan.panel.locator(".unplaced .badge").last).to_have_class(re.compile("class-low"))
    expect(plan.panel.locator(".by-class .end").last).to_have_text(re.compile("% if the anchor fails$"))
    names = plan.page.locator(".piece:not(.selected) .name:visible")
    while plan.scale() < 90:
        plan.page.get_by_role("button", name="Zoom in").click()
    expect(names).to_have_count(4)
    while plan.scale() > 20:
        plan.page.get_by_role("button", name="Zoom out").click()
    expect(names).to_have_count(0)


def test_on_a_phone_the_plan_is_read_and_a_panel_rises_over_it(page, served_here, tmp_path):
    server = served_here(write_floor(tmp_path / "hall.xlsx"))
    plan = opened_plan(page, server, width=390, height=844, has_touch=True)
    assert plan.page.locator("svg.plan").bounding_box()["height"] > 500
    assert plan.page.locator(".plan-toolbar").bounding_box()["height"] < 60, "one line"
    body = plan.panel.locator(".plan-body")
    expect(body).to_be_hidden()
    plan.page.touchscreen.tap(*plan.place(2, 2))
    expect(plan.panel.locator(".details h2")).to_have_text("A1")
    expect(plan.panel.locator("input:visible, [data-panel=add]")).to_have_count(0)
    shown, risen = plan.piece(A1).bounding_box(), plan.panel.bounding_box()
    assert shown["y"] + shown["height"] < risen["y"], "the panel does not cover what was tapped"
    plan.page.touchscreen.tap(*plan.place(4, 6.5))
    expect(body).to_be_hidden()
    before = plan.place(2, 2)
    plan.drag((2, 2), (3, 2))
    expect(plan.page.locator("[data-tool]:visible")).to_have_count(0)
    assert plan.at(A1)[:2] == (2, 2)
    plan.page.get_by_role("button", name="Zoom in").click()
    assert plan.place(2, 2) != before
    plan.tab("routes")
    expect(plan.panel.locator(".states li")).to_have_count(2)
    expect(plan.panel.locator(".states li").last).to_be_in_viewport()
    plan.tab("routes")
    expect(body).to_be_hidden()
    plan.tab("pieces")
    expect(plan.panel.locator(".by-class li").first).to_be_in_viewport()
    assert plan.page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")


def test_the_tools_stand_beside_the_plan_and_the_settings_in_one_line(page, served_here, tmp_path):
    floors = [{"floor": str(n), "name": f"Floor number {n}", "pfa_x": 0.3} for n in range(1, 7)]
    plan = opened_plan(page, served_here(write_floor(tmp_path / "hall.xlsx", floors=floors)), width=1400)
    for tool in ("select", "door", "way"):
        plan.tool(tool)
        assert plan.page.locator(".plan-toolbar").bounding_box()["height"] < 60
        assert plan.page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    for key, name in zip("VMOCDSEW", TOOLS, strict=True):
        plan.page.locator("svg.plan").focus()
        plan.keyboard.press(key.lower())
        expect(plan.page.locator(f"[data-tool={name}]")).to_have_attribute("aria-pressed", "true")
