"""The sheet of the page as a user handles it: cells by the header of their column and the row of the spreadsheet."""

import json
import re

from playwright.sync_api import expect

from tests.waiting import PATIENCE

CLASS = "Class"
KEY = re.compile(r"<[A-Z][A-Za-z0-9+]*>")

SCROLL_TO = """async (head) => {
    const box = head.closest(".grid-box").getBoundingClientRect();
    const { left, right } = head.getBoundingClientRect();
    if (left < box.left + 260 || right > box.right) head.scrollIntoView({ inline: "center", block: "nearest" });
    for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
}"""


TWO_FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
"""The grid draws before the next frame."""
SETTLE = """async (patience) => {
    const { store } = await import("/store.mjs");
    let timer;
    const late = new Promise((_, no) => {
        timer = setTimeout(() => no(new Error("changes were not sent")), patience);
    });
    while (store.waiting) {
        await Promise.race([late, new Promise((done) => store.addEventListener("state", done, { once: true }))]);
    }
    await Promise.race([late, store.refreshLive()]);
    while (store.isSimulating) {
        await Promise.race([late, new Promise((done) => store.addEventListener("live", done, { once: true }))]);
    }
    clearTimeout(timer);
}"""
COPY = """([text, html]) => document.addEventListener("copy", (event) => {
    event.preventDefault();
    event.clipboardData.setData("text/plain", text);
    if (html) event.clipboardData.setData("text/html", html);
})"""


class SheetPage:
    """A page that shows the sheets; `server` is the running `assess open`."""

    def __init__(self, page, server):
        self.page, self.server = page, server
        self.keyboard = page.keyboard
        self.grid = page.get_by_role("grid")
        self.options = page.locator(".grid-choices [role=option]")

    def open(self, name):
        self.page.locator(f".sheet-tabs [data-sheet={name}]").click()
        return self

    def column(self, label):
        """Return the place of a column among those shown, from 1, as the grid counts them."""
        return self.head(label).get_attribute("aria-colindex")

    def cell(self, label, row):
        """Return a cell by its header and its row in the spreadsheet, which the number at its left tells."""
        line = self.grid.locator(".grid-row:not([hidden])").filter(
            has=self.page.locator(f".grid-number:text-is('{row}')")
        )
        return line.locator(f"[aria-colindex='{self.column(label)}']")

    def shown(self, label, row):
        """Return a cell after its column was scrolled to and drawn: only those in sight are elements."""
        self.head(label).evaluate(SCROLL_TO)
        return self.cell(label, row)

    def head(self, label):
        return self.grid.locator(f"[data-label='{label}']")

    def select(self, label, row, last=None, last_row=None):
        """Select a cell, or a range with Shift."""
        self.shown(label, row).click()
        if last:
            self.shown(last, last_row).click(modifiers=["Shift"])
        self.page.evaluate(TWO_FRAMES)
        return self

    def type(self, *keys):
        """Type texts; a word of its own in angle brackets is a key: "<Enter>"."""
        for one in keys:
            if KEY.fullmatch(one):
                self.keyboard.press(one[1:-1])
            elif KEY.search(one):
                raise ValueError(f"a key has to be a word of its own: {one!r}")
            else:
                self.keyboard.type(one)
        return self

    def settle(self):
        """Wait until the server has all changes and the page all answers, every piece simulated."""
        self.page.evaluate(SETTLE, 1e3 * PATIENCE)
        return self

    def cells(self, sheet, row):
        """Return the values of a row as the server has them."""
        book = json.loads(self.server.client.get("/api/book").data)
        rows = next(one for one in book["sheets"] if one["name"] == sheet)["rows"]
        return dict(map(tuple, rows)).get(row, [])

    def values(self, sheet, field):
        """Return the values of a column as the server has them: by rows."""
        book = json.loads(self.server.client.get("/api/book").data)
        found = next(one for one in book["sheets"] if one["name"] == sheet)
        at = next(one["at"] for one in found["columns"] if one["field"] == field)
        return {row: cells[at] for row, cells in found["rows"] if at < len(cells) and cells[at] is not None}

    def copy_text(self, text, html=None):
        """Put a text, and a table, on the clipboard as another program does: by Ctrl+C in another window."""
        other = self.page.context.new_page()
        other.set_content("<textarea autofocus>x</textarea>")
        other.evaluate(COPY, [text, html])
        other.locator("textarea").press("Control+c")
        other.close()
        self.page.bring_to_front()
        return self


def opened(page, server, **options):
    """Open the page of a server at its sheets, with the first answer of the server: tabs are drawn anew with it."""
    found = page(server, **options)
    expect(found.get_by_role("tab").first).to_be_visible()
    return SheetPage(found, server).settle()
