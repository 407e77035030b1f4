"""All pieces as lines of fixed columns, where there are too many for tables in print."""

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report.blocks import Block, Heading, Paragraph, Section, join_words
from assess.report.compact import MOST_LINES, list_lines
from assess.report.view import Part, View


def build(view: View) -> Section:
    """Return one line a row, then the results of every method."""
    content = view.content
    is_cut = len(content.results) > MOST_LINES
    texts = [
        _("One line for each row; longer texts are cut, the Excel report has all of them."),
        view.marks,
        _("The first {n:,} rows; the Excel report lists all.", n=MOST_LINES) if is_cut else "",
    ]
    heading = Heading(_("Results of every method for each row under its governing motion"))
    pieces, methods = (list_lines(content.listed, view.columns(name)) for name in ("pieces", "methods"))
    blocks: list[Block] = [Paragraph(join_words(texts)), *pieces, heading, *methods]
    return Section(blocks, "wide")


PART = Part(
    key="lists", heading=fill("Appendix: all pieces"), places={"annex": 130, "all": 190}, build=build,
    is_shown=lambda view: view.is_compact,
)  # fmt: skip
