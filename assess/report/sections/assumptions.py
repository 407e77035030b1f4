"""What was assumed, and where."""

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report.blocks import Section, list_columns, more, table
from assess.report.view import MOST_ASSUMPTIONS, Part, View, shorten


def build(view: View) -> Section:
    """Return the assumptions, in the client's edition as many as a page has room for."""
    found = view.content.assumptions
    shown, left = shorten(found, MOST_ASSUMPTIONS if view.edition == "client" else len(found))
    return Section([
        table(list_columns((_("Where"), "w36"), (_("Assumed"), "")), shown),
        *more(left, lambda n: ngettext("{n:,} more is in the annex.", "{n:,} more are in the annex.", n)),
    ])  # fmt: skip


PART = Part(
    key="assumptions", heading=fill("Assumptions and defaults"), places={"client": 80, "annex": 60, "all": 150},
    build=build, is_shown=lambda view: view.edition != "annex" or len(view.content.assumptions) > MOST_ASSUMPTIONS,
)  # fmt: skip
