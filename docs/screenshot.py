"""Take a picture of a report: ``python docs/screenshot.py report.html report.png``.

Needs playwright, and a Chromium or Chrome that is installed.
"""

import shutil
import sys
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
WIDTH, HEIGHT = 1280, 1600


def find_browser() -> str | None:
    """Return the path of an installed browser, or None."""
    return next((path for path in map(shutil.which, BROWSERS) if path), None)


def take_screenshot(html: Path, png: Path, width: int = WIDTH, height: int = HEIGHT) -> None:
    """Write a picture of the beginning of a page, as large as the window [px]."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_browser())
        page = browser.new_page(viewport={"width": width, "height": height})
        page.goto(html.resolve().as_uri())
        page.screenshot(path=png)
        browser.close()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    take_screenshot(Path(sys.argv[1]), Path(sys.argv[2]))
