"""The plan of the page as a user handles it: places in metres, real movements of the mouse."""

import re

from playwright.sync_api import expect

from tests.web.opened import write_template
from tests.web.sheet_page import opened

FLOORS = [
    {"floor": "1", "name": "Ground", "pfa_x": 0.3, "pfv_x": 30.0},
    {"floor": "2", "name": "First", "pfa_x": 0.5, "pfv_x": 45.0},
]
SIZES = {"breadth": 40, "width": 80, "height": 200}
ITEMS = [
    {"item": "A1", "floor": "1", "description": "Bookcase", **SIZES, "x": 2.0, "y": 2.0, "angle_deg": 90},
    {"item": "A2", "floor": "1", "room": "Hall", **SIZES, "x": 5.0, "y": 4.0, "angle_deg": 0, "anchored": "no"},
    {"item": "A3", "floor": "1", "room": "Hall", **SIZES, "notes": "in the store"},
    {"item": "B1", "floor": "2", **SIZES, "x": 1.0, "y": 1.0},
]  # fmt: skip
PLACES = [
    {"place": "Hall", "floor": "1", "kind": "room", "x": 4, "y": 3, "outline": "0 0; 8 0; 8 6; 0 6"},
    {"place": "Door", "floor": "1", "kind": "exit", "x": 8, "y": 3},
]
ROUTES = [{"route": "Way out", "segment": "1", "floor": "1", "start": "Hall", "end": "Door"}]


def write_floor(path, units="si", items=ITEMS, floors=FLOORS, places=PLACES, routes=ROUTES):
    """Write a workbook with a hall of 8 by 6 m, two pieces on its plan, and a way out."""
    rows = {"Building": [{}], "Floors": floors, "Items": items, "Places": places, "Routes": routes}
    return write_template(path, rows, units, spare=8)


class PlanPage:
    def __init__(self, sheet):
        self.sheet, self.page, self.server = sheet, sheet.page, sheet.server
        self.keyboard, self.mouse = sheet.page.keyboard, sheet.page.mouse
        self.panel = sheet.page.locator(".plan-panel")

    def open(self):
        self.page.locator("nav.tabs [data-tab=plan]").click()
        expect(self.page.locator("svg.plan .world")).to_have_attribute("transform", re.compile("scale"))
        expect(self.page.locator(".plan-toolbar .plan-floors *").first).to_be_visible()
        return self

    def piece(self, row):
        return self.page.locator(f".piece[data-row='{row}']")

    def place(self, x, y):
        """Return where a point of the floor lies in the window [px]."""
        a, e, f = self.page.evaluate("""() => {
            const { a, e, f } = document.querySelector("svg.plan .world").getScreenCTM();
            return [a, e, f];
        }""")
        return e + a * x, f - a * y

    def press(self, x, y):
        self.mouse.move(*self.place(x, y))
        self.mouse.down()

    def drag(self, start, *stops, keys=()):
        """Drag from a point over others, by steps as a hand does."""
        self.press(*start)
        for key in keys:
            self.keyboard.down(key)
        for stop in stops:
            self.mouse.move(*self.place(*stop), steps=6)
        self.mouse.up()
        for key in keys:
            self.keyboard.up(key)
        return self.settle()

    def click(self, x, y, **options):
        self.mouse.click(*self.place(x, y), **options)
        return self

    def keys(self, *names):
        for name in names:
            self.keyboard.press(name)
        return self

    def tab(self, name):
        self.panel.locator(f"[data-panel={name}]").click()
        return self

    def tool(self, name):
        self.page.locator(f"[data-tool={name}]").click()
        return self

    def settle(self):
        self.sheet.settle()
        return self

    def at(self, row):
        """Return X, Y and Angle of a piece as the workbook on the server has them."""
        self.settle()
        return tuple(self.sheet.values("Items", field).get(row) for field in ("x", "y", "angle_deg"))

    def values(self, sheet, field):
        self.settle()
        return self.sheet.values(sheet, field)

    def outline(self, row):
        """Return the corners of a place as the workbook on the server has them."""
        return [[float(one) for one in corner.split()] for corner in self.values("Places", "outline")[row].split("; ")]

    def scale(self):
        """Return the pixels of a metre."""
        return self.page.evaluate("() => document.querySelector('svg.plan .world').getScreenCTM().a")

    def shown_at(self, row):
        """Return where a piece is drawn [m]."""
        found = re.match(r"translate\(([-\d.]+) ([-\d.]+)\)", self.piece(row).get_attribute("transform"))
        assert found
        return round(float(found[1]), 2), round(-float(found[2]), 2)

    def say(self):
        return self.page.locator(".plan-drawing [role=status]")


def opened_plan(page, server, **options):
    return PlanPage(opened(page, server, **options)).open()
