"""The sheet Annual: chances a year of pieces, routes and rooms, the hazard curve, and what they rest on; as run."""

from collections.abc import Callable, Iterator
from typing import Any

from assess.i18n import gettext as _
from assess.report.content import Content
from assess.report.say.simulation import AnnualLine
from assess.report.xlsx.pen import COUNT, Column, Pen

RATE, RARE = "0.00E+00", "0.000%"


def write_annual(pen: Pen, page: Any, content: Content) -> None:
    """Write every piece, route and room that has a chance a year, then the hazard curve and what was done with it."""
    annual, tables = content.annual, content.run.annual
    if annual is None or tables is None:
        return
    columns = list(_columns())
    widths = [one.width for one in columns]
    kinds = ((_("piece"), annual.pieces), (_("route"), annual.routes), (_("room"), annual.rooms))
    row = pen.listing(page, columns, [(kind, line) for kind, lines in kinds for line in lines])
    curve = [
        Column(_("PGA [g]"), 9, lambda one: one[0], "0.0000"),
        Column(_("Exceeded, times a year"), 24, lambda one: one[1], RATE),
    ]
    points = list(zip(tables.curve_pga_g, tables.curve_rate, strict=True))
    row = pen.below(page, row + 1, _("Hazard curve"), curve, widths, points)
    as_run = _("All of this is as run: it does not follow when a cell of another sheet is edited.")
    for at, text in enumerate((*annual.paragraphs, *annual.remarks, as_run), row + 1):
        page.write_string(at, 0, text)
    page.freeze_panes(1, 2)
    page.fit_to_pages(1, 0)


def _columns() -> Iterator[Column]:
    yield Column(_("What"), 9, lambda one: one[0])
    yield Column(_("Name"), 24, lambda one: one[1].name)
    yield Column(_("Description"), 32, lambda one: one[1].what)
    yield Column(_("Floor, room"), 20, lambda one: one[1].where)
    known = (
        (_("Chance a year"), "chance_a_year", RARE),
        (_("Chance in 50 years"), "chance_in_50_years", "0.0%"),
        (_("Times a year"), "rate", RATE),
        (_("Sampling interval, from"), "low", RATE),
        (_("to"), "high", RATE),
    )
    for label, name, format_ in known:
        yield Column(label, 12, _reader(name), format_)
    yield Column(_("Once in [years]"), 10, lambda one: 1 / one[1].row.rate if one[1].row.rate > 0 else None, COUNT)
    yield Column(_("Lower bound"), 8, lambda one: _("yes") if one[1].row.at_least else _("no"))
    yield Column(_("Ends of the curve matter"), 10, lambda one: _("yes") if one[1].row.ends_matter else _("no"))
    yield Column(_("Integrated"), 12, lambda one: _(one[1].row.fit))
    yield Column(
        _("If anchors fail (50 years)"), 10,
        lambda one: None if one[1].fail is None else one[1].fail.chance_in_50_years, "0.0%",
    )  # fmt: skip
    for label, name in (
        (_("Median ground PGA [g]"), "median_g"), (_("Dispersion"), "dispersion"), (_("Misfit"), "misfit"),
    ):  # fmt: skip
        yield Column(label, 10, _reader(name), "0.000")


def _reader(name: str) -> Callable[[tuple[str, AnnualLine]], Any]:
    return lambda one: getattr(one[1].row, name)
