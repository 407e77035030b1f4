"""What browser tests look for in every view: what axe-core finds, requests to others."""

from pathlib import Path

from playwright.sync_api import expect

AXE = Path(__file__).parents[1] / "data" / "axe-core" / "axe.min.js"
VIEWS = ("sheet", "plan", "what-if", "simulate", "start")
GRAVE = ("serious", "critical")


def show(page, view):
    """Show a view by its address, and wait until it is there."""
    page.evaluate("view => { location.hash = view; }", view)
    expect(page.locator(f"#view-{view}")).to_be_visible()
    expect(page.locator(f"#view-{view} > *").first).to_be_attached()
    expect(page.locator(f"#view-{view} [aria-busy=true]")).to_have_count(0)


def examine(page):
    """Return what axe-core is sure of that is grave: rule, impact and the first element of each."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    options = {"resultTypes": ["violations"], "iframes": False, "preload": False}
    found = page.evaluate("options => axe.run(document, options)", options)["violations"]
    return [(one["id"], one["impact"], one["nodes"][0]["html"][:200]) for one in found if one["impact"] in GRAVE]


def note_requests(page):
    """Return a list to which the address of every request of a page is added."""
    addresses = []
    page.on("request", lambda request: addresses.append(request.url))
    return addresses
