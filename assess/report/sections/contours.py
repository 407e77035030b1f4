"""The risk of pieces of one height over breadth and acceleration."""

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report.blocks import Figure, Image, Paragraph, Section
from assess.report.embedded import data_uri
from assess.report.figures.risk_contours import build_contours, draw_contours
from assess.report.view import Part, View


def build(view: View) -> Section:
    """Return the figure; nothing where the pieces have none."""
    found = view.once("contours", lambda: _draw(view))
    kind = "" if view.content.verified.done else "run-on"
    if found is None:
        return Section([], kind)
    contours, drawn = found
    text = _(
        "The chance of overturning by the formulas for pieces of one height, over Breadth and PFA, with the pieces of "
        "this building."
    )
    return Section([Paragraph(text), Figure(Image(drawn, contours.alt), " ".join(contours.caption))], kind)


def _draw(view: View) -> object:
    contours = view.progress.wait_for(lambda: build_contours(view.run))
    return contours and (contours, data_uri(draw_contours(contours, view.progress), "image/svg+xml"))


PART = Part(
    key="contours", heading=fill("Risk over breadth and acceleration"), places={"annex": 40, "all": 120}, build=build,
    is_shown=lambda view: "contours/items" in view.run.series,
)  # fmt: skip
