"""Take the pictures of the page in docs/figures, from the worked example: ``python docs/page_pictures.py``.

Needs the extra ``web``, playwright, and a Chromium or Chrome that is installed.
"""

import io
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from docs.screenshot import find_browser  # noqa: E402

if TYPE_CHECKING:
    from playwright.sync_api import Page

FIGURES = ROOT / "docs" / "figures"
EXAMPLE = ROOT / "inventories" / "market-street.xlsx"
WIDTH, HEIGHT = 1400, 860
PHONE_WIDTH, PHONE_HEIGHT = 390, 800
GAP = 20
PIECE = 3
"""Place, among the rows of the sheet, of the piece that is selected."""
COLOURS = 256
"""Colours of a picture: enough for a page, and half of the bytes."""


@contextmanager
def serve(folder: Path) -> Iterator[str]:
    """Serve a copy of the worked example, with the records that it names; yield the address of the page."""
    shutil.copytree(EXAMPLE.parent / "records", folder / "records")
    path = shutil.copy(EXAMPLE, folder)
    words = [sys.executable, "-m", "assess", "open", path, "--no-browser", "--port", "0"]
    with subprocess.Popen(  # noqa: S603 - our own command
        words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            yield next(line.strip() for line in process.stdout or () if re.match("https?://", line))
        finally:
            process.terminate()


def take(page: "Page", name: str) -> None:
    """Write a picture of what a page shows."""
    path = FIGURES / name
    page.screenshot(path=path, animations="disabled")
    _reduce(path)


def _reduce(path: Path) -> None:
    from PIL import Image

    with Image.open(path) as image:
        image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def show(page: "Page", view: str, ready: str) -> None:
    """Show a view, and wait for something of it and until nothing is asked of the server."""
    page.evaluate("view => { location.hash = view; }", view)
    page.locator(f"#view-{view}").locator(ready).first.wait_for()
    page.wait_for_load_state("networkidle")


def show_sheet(page: "Page") -> None:
    """Show the sheet with a piece selected."""
    show(page, "sheet", ".grid-cell.risk")
    page.locator(".grid-row:not([hidden]) .grid-cell.risk").nth(PIECE).click()


def show_plan(page: "Page") -> None:
    """Show the plan with the states of its routes."""
    show(page, "plan", ".piece")
    page.locator("#view-plan .state-sign").first.wait_for()


def show_what_if(page: "Page") -> None:
    """Show what a stronger shaking would do, the first entries of what to fix done."""
    show(page, "what-if", "table")
    for field, value in ((page.get_by_role("spinbutton").first, "1.3"), (page.get_by_role("slider").last, "6")):
        field.fill(value)
        field.press("Tab")
    page.wait_for_load_state("networkidle")
    page.locator("#view-what-if [aria-busy=false]").first.wait_for()


SHOWN = {"page-sheet.png": show_sheet, "page-plan.png": show_plan, "page-what-if.png": show_what_if}


def take_narrow(page: "Page") -> None:
    """Take the three views on a phone, next to each other."""
    from PIL import Image

    whole = Image.new("RGB", (len(SHOWN) * (PHONE_WIDTH + GAP) - GAP, PHONE_HEIGHT), "white")
    for at, show_view in enumerate(SHOWN.values()):
        show_view(page)
        data = page.screenshot(animations="disabled")
        whole.paste(Image.open(io.BytesIO(data)), (at * (PHONE_WIDTH + GAP), 0))
    whole.save(FIGURES / "page-phone.png")
    _reduce(FIGURES / "page-phone.png")


def main() -> None:
    """Take all pictures."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, serve(Path(folder)) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_browser())
        context = browser.new_context(viewport={"width": WIDTH, "height": HEIGHT}, reduced_motion="reduce")
        page = context.new_page()
        page.goto(address)
        page.locator("nav.tabs").wait_for()
        for name, show_view in SHOWN.items():
            show_view(page)
            take(page, name)
        page.set_viewport_size({"width": PHONE_WIDTH, "height": PHONE_HEIGHT})
        page.reload()
        take_narrow(page)
        browser.close()


if __name__ == "__main__":
    main()
