"""What browser tests look for in every view: what axe-core finds, requests to others."""

from pathlib import Path

from playwright.sync_api import expect

AXE = Path(__file__).parents[1] / "data" / "axe-core" / "axe.min.js"
VIEWS = ("overview", "sheet", "plan", "what-if", "results", "start")
GRAVE = ("serious", "critical")
OF_COLOURS = ("color-contrast", "link-in-text-block")
"""Rules about colours: what is to be looked at again in another theme, in which all else is the same."""
THEMES = (("light", ()), ("dark", OF_COLOURS))
"""Themes, and the rules by which each is examined: the first by all."""
EXAMINE = """async ([grave, rules]) => {
    const options = { resultTypes: ["violations"], iframes: false, preload: false };
    if (rules.length) options.runOnly = { type: "rule", values: rules };
    const { violations } = await axe.run(document, options);
    return violations
        .filter((one) => grave.includes(one.impact))
        .map((one) => [one.id, one.impact, one.nodes[0].html.slice(0, 200)]);
}"""
"""What is found is picked in the page: all that axe-core returns takes longer to hand over than to find."""


def show(page, view):
    """Show a view by its address, and wait until it is there."""
    page.evaluate("view => { location.hash = view; }", view)
    expect(page.locator(f"#view-{view}")).to_be_visible()
    expect(page.locator(f"#view-{view} > *").first).to_be_attached()
    expect(page.locator(f"#view-{view} [aria-busy=true]")).to_have_count(0)


def open_menu(page):
    """Open the menu of the header, which holds what is not always needed."""
    page.get_by_role("button", name="Menu").click()
    expect(page.locator("#menu")).to_be_visible()
    return page


def examine(page, rules=()):
    """Return what axe-core is sure of that is grave: rule, impact and the first element of each; of `rules` alone."""
    if not page.evaluate("() => 'axe' in window"):
        page.evaluate(AXE.read_text(encoding="utf-8"))
    return [tuple(one) for one in page.evaluate(EXAMINE, [GRAVE, rules])]


def note_requests(page):
    """Return a list to which the address of every request of a page is added."""
    addresses = []
    page.on("request", lambda request: addresses.append(request.url))
    return addresses
