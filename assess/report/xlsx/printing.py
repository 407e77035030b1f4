"""How the sheets are printed: A4 across, fit to the width, with headers and footers."""

from typing import Any

from assess.language import gettext as _
from assess.report.xlsx.pen import clip

A4 = 9


def set_print(page: Any, title: str, sheet: str) -> None:
    """Set up the printed pages of a sheet; a sheet may set more itself."""
    page.set_landscape()
    page.set_paper(A4)
    page.set_margins(left=0.5, right=0.5, top=0.75, bottom=0.75)
    page.fit_to_pages(1, 0)
    pages = _("Page {page} of {pages}", page="\x01", pages="\x02")
    said = _plain(_("Chance of overturning in this scenario, not per year")), _plain(pages)
    page.set_header(f"&L&8 {_plain(clip(title, 80))}&R&8 {_plain(sheet)}")
    page.set_footer(f"&L&8 {said[0]}&R&8 {said[1]}".replace("\x01", "&P").replace("\x02", "&N"))


def _plain(text: str) -> str:
    """Return a text in which an ampersand is no command; a blank stands before it, as digits would be a size."""
    return text.replace("&", "&&")
