"""The sheets that list what was found or read: Motions, Verification, Annual, Methods, Assumptions, Quality log, Notes.

Each but Annual and Assumptions is one table: a function here returns its columns and its rows.
"""

from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any

from assess.fields import MOTION_FIELDS
from assess.i18n import gettext as _
from assess.report import statements, words
from assess.report.content import Content
from assess.report.page_columns import say_flag
from assess.report.provenance import say_reference
from assess.report.say.ground import (
    ENVELOPES,
    describe_origin,
    describe_source,
    describe_treatment,
    list_clauses,
    profile_status,
)
from assess.report.say.route import list_cautions, list_widths, say_default_width
from assess.report.say.simulation import describe_trials, list_misfits, list_references
from assess.report.xlsx.item_formulas import LIMITS as LIMIT_NAMES
from assess.report.xlsx.pen import COUNT, Column, Pen, of_field, row_height
from assess.results import MotionRow, Results
from assess.risk import LIMITS, RiskClass
from assess.workbook.formulas import say_class

if TYPE_CHECKING:
    from assess.methods import MethodInfo

Listing = tuple[list[Column], Sequence[Any]]
"""The columns of a sheet, and its rows."""
RATE, RARE = "0.00E+00", "0.000%"


def _of_texts(*heads: tuple[str, int]) -> list[Column]:
    """Return the columns of rows that are tuples of texts, from headings and widths."""
    return [Column(label, width, itemgetter(at)) for at, (label, width) in enumerate(heads)]


# ---------------------------------------------------------------- motions


def _of_motions(*keys: str, width: int = 10) -> list[Column]:
    return [of_field(one, width=width) for key in keys for one in MOTION_FIELDS if one.key == key]


def list_motions(content: Content) -> Listing:
    """Return every motion, with what was done to it."""
    columns = [
        Column(_("Floor"), 9, attrgetter("floor")),
        *_of_motions("axis", width=6),
        Column(_("Source"), 30, describe_source),
        Column(_("Record"), 30, attrgetter("record")),
        Column(_("Computed from"), 36, lambda one: "" if one.has_record else describe_origin(one)),
        *_of_motions("height_ratio", "amplification", "pfa_g", "pfv_cm_s", "pfa_file_g"),
        *_of_motions("station", "event", width=24),
        *_of_motions("azimuth_deg"),
        Column(_("Treatment"), 60, describe_treatment),
    ]
    return columns, [one for floor in content.floors for one in floor.motions]


def list_fits(content: Content) -> Listing:
    """Return the motions of every floor and axis under which pieces were simulated, and how they meet their target."""
    suite, seed = content.run.provenance.suite, content.run.settings.seed

    def kind(one: MotionRow) -> str:
        if suite is None:
            return _("assumed") if one.ensemble and one.ensemble.assumed_motion else _("recorded")
        folder = words.cut(suite.folder, 60)
        return _("suite {folder}, scaled", folder=folder) if suite.is_scaled else _("suite {folder}", folder=folder)

    columns = [
        Column(_("Floor"), 9, attrgetter("floor")),
        *_of_motions("axis", width=6),
        Column(_("Source"), 34, describe_source),
        Column(_("Record"), 30, attrgetter("record")),
        Column(_("Motion"), 14, kind),
        *_of_motions("ensemble_motions", width=9),
        Column(_("Seed"), 8, lambda _one: None if suite else seed, "0"),
        *_of_motions(
            "ensemble_fit_matched_to_s", "ensemble_fit_mean_deviation", "ensemble_fit_worst_deviation",
            "ensemble_fit_worst_period_s", "ensemble_fit_pfa_ratio", "ensemble_fit_pfa_scatter",
            "ensemble_fit_pfv_ratio", "ensemble_fit_pfv_scatter", "ensemble_fit_spectrum_scatter",
        ),
        Column(_("Rows"), 8, attrgetter("ensemble.cases"), COUNT),
        Column(_("Rows that overturn under the record"), 18, attrgetter("ensemble.fell_in_record"), COUNT),
    ]  # fmt: skip
    return columns, [one for floor in content.floors for one in floor.motions if one.ensemble]


# ---------------------------------------------------------------- chances a year


def write_annual(pen: Pen, page: Any, content: Content) -> None:
    """Write every piece, route and room that has a chance a year, then the hazard curve and what was done with it."""
    annual, tables = content.annual, content.run.annual
    if annual is None or tables is None:
        return
    columns = list(_annual_columns())
    kinds = ((_("piece"), annual.pieces), (_("route"), annual.routes), (_("room"), annual.rooms))
    row = pen.listing(page, columns, [(kind, line) for kind, lines in kinds for line in lines])
    curve = [
        Column(_("PGA [g]"), 9, itemgetter(0), "0.0000"),
        Column(_("Exceeded, times a year"), 24, itemgetter(1), RATE),
    ]
    points = list(zip(tables.curve_pga_g, tables.curve_rate, strict=True))
    row = pen.below(page, row + 1, _("Hazard curve"), curve, [one.width for one in columns], points)
    as_run = _("All of this is as run: it does not follow when a cell of another sheet is edited.")
    for at, text in enumerate((*annual.paragraphs, *map(_, tables.remarks), as_run), row + 1):
        page.write_string(at, 0, text)
    page.freeze_panes(1, 2)
    page.fit_to_pages(1, 0)


def _annual_columns() -> Iterator[Column]:
    def of_row(name: str) -> Callable[[Any], Any]:
        return lambda one: getattr(one[1].row, name)

    yield Column(_("What"), 9, itemgetter(0))
    yield Column(_("Name"), 24, lambda one: one[1].name)
    yield Column(_("Description"), 32, lambda one: one[1].what)
    yield Column(_("Floor, room"), 20, lambda one: one[1].where)
    yield Column(_("Chance a year"), 12, of_row("chance_a_year"), RARE)
    yield Column(_("Chance in 50 years"), 12, of_row("chance_in_50_years"), "0.0%")
    yield Column(_("Times a year"), 12, of_row("rate"), RATE)
    yield Column(_("Sampling interval, from"), 12, of_row("low"), RATE)
    yield Column(_("to"), 12, of_row("high"), RATE)
    yield Column(_("Once in [years]"), 10, lambda one: 1 / one[1].row.rate if one[1].row.rate > 0 else None, COUNT)
    yield Column(_("Lower bound"), 8, lambda one: words.yes_or_no(one[1].row.at_least))
    yield Column(_("Ends of the curve matter"), 10, lambda one: words.yes_or_no(one[1].row.ends_matter))
    yield Column(_("Integrated"), 12, lambda one: _(one[1].row.fit))
    fail = attrgetter("fail.chance_in_50_years")
    yield Column(_("If anchors fail (50 years)"), 10, lambda one: one[1].fail and fail(one[1]), "0.0%")
    yield Column(_("Median ground PGA [g]"), 10, of_row("median_g"), "0.000")
    yield Column(_("Dispersion"), 10, of_row("dispersion"), "0.000")
    yield Column(_("Misfit"), 10, of_row("misfit"), "0.000")


# ---------------------------------------------------------------- methods


def list_methods(content: Content) -> Listing:
    """Return the classes, the methods, what was simulated how, what the marks mean, and the limits of it all."""
    return _of_texts((_("Method"), 28), (_("What"), 26), (_("Text"), 110)), list(_list_methods(content))


def _list_methods(content: Content) -> Iterator[tuple[str, str, str]]:
    for risk, text in words.list_limits():
        yield _("Classes"), say_class(risk), text
    for method in content.run.methods:
        yield from _describe(method)
    for profile in content.run.provenance.profiles:
        yield profile.title, _("Clause"), list_clauses(profile)
        yield profile.title, _("Equation"), _(profile.equation)
        yield profile.title, _("Status"), profile_status(profile)
        yield profile.title, _("Source"), profile.reference
    yield _("Floor motion by a code's profile"), _("Beware"), _(ENVELOPES)
    done, routes = _("What was done"), _("Evacuation routes")
    yield _("Adopted risk"), done, content.verified.adopted
    yield from ((_("Verification"), done, text) for text in describe_trials(content.verified))
    yield from ((_("Verification"), _("Beware"), text) for text in list_misfits(content.run))
    flags = statements.list_flags(content.run)
    yield from ((_("Marks"), say_flag(flag), meaning) for flag, meaning in flags.items())
    if content.run.has_routes:
        yield from ((routes, done, text) for text in list_cautions(content.run.route_tables))
        width = _("Required width")
        yield routes, width, say_default_width()
        for source, widths in list_widths():
            yield from ((routes, width, _("{asked} ({source})", asked=text, source=source)) for text in widths)
    yield from ((_("Limits of the method"), _("Limit"), text) for text in statements.list_limits(content.run))
    yield from ((_("References"), "", text) for text in list_references(content.run))


def _describe(method: "MethodInfo") -> Iterator[tuple[str, str, str]]:
    title = _(method.title)
    names = {"breadth_to_height": _("B/H"), "pfa": _("PFA"), "height": "H", "pfv": "PFV"}
    ranges = [
        _("{what} {low:g} to {high:g} {unit}", what=names.get(name, name), low=one.low, high=one.high,
          unit=one.unit).strip()
        for name, one in method.valid.items()
    ]  # fmt: skip
    parts = (
        (_("Predicts"), (method.predicts,)),
        (_("Equation"), method.equations),
        (_("Assumption"), method.assumptions),
        (_("Departure from the source"), method.departures),
    )
    for what, texts in parts:
        yield from ((title, what, _(text)) for text in texts)
    yield from ((title, words.name_ranges(method), text) for text in ranges)
    yield title, _("Source"), say_reference(method.reference)


# ---------------------------------------------------------------- assumptions


def _list_values(results: Results) -> list[tuple[str, str, float]]:
    """Return what formulas refer to by name: name of the cell, meaning and value, in the order of the rows."""
    found = [
        (name, _("Lower limit of {risk} (edit the value: classes and counts follow)", risk=_(risk.word)), limit)
        for name, risk, limit in zip(LIMIT_NAMES, list(RiskClass)[1:], LIMITS, strict=True)
    ]
    for method in (one for one in results.methods if one.is_live):
        for one in method.parameters:
            meaning = _("{method} {symbol} (edit the value: the column {column} follows)", method=_(method.title),
                        symbol=one.symbol, column=_(method.short_title))  # fmt: skip
            found.append((one.cell, meaning, getattr(results.settings, one.setting)))
    return found


def write_assumptions(pen: Pen, page: Any, content: Content) -> None:
    """Write the values that formulas refer to, and what else was assumed."""
    columns = _of_texts((_("Assumption"), 80), (_("Value"), 60))
    pen.listing(page, columns, ())
    values = _list_values(content.run)
    for row, (name, meaning, value) in enumerate(values, 1):
        pen.book.define_name(name, f"={pen.refer('Assumptions')}$B${row + 1}")
        page.write_string(row, 0, meaning, pen.style("text"))
        page.write_number(row, 1, value, pen.style("input"))
    rule = {"validate": "decimal", "criteria": "between", "minimum": 0, "maximum": 1}
    page.data_validation(1, 1, len(LIMITS), 1, rule)
    for row, texts in enumerate(content.assumptions, len(values) + 2):
        page.set_row(row, row_height(texts, [one.width for one in columns]))
        for at, text in enumerate(texts):
            pen.put(page, row, at, text, pen.style("text"))


# ---------------------------------------------------------------- quality log and notes


def list_quality(content: Content) -> Listing:
    """Return every warning and note of the checks, then inputs with their hashes, program, settings and platform.

    Names are those of results.json.
    """
    rows = [(_(one.severity), one.place, _(one.message), _(one.fix) if one.fix else "") for one in content.problems]
    rows = rows or [(_("note"), "", _("No warnings or notes."), "")]
    origin = content.run.provenance
    files = {origin.workbook: origin.sha256, **origin.files, **(origin.suite.files if origin.suite else {})}
    rows += [(_("input"), name, f"SHA-256 {digest}", "") for name, digest in files.items()]
    rows += [(_("program"), "assess", content.run.provenance.version, ""), (_("program"), _("date"), content.date, "")]
    settings = content.run.settings.as_record() | {"scenario": origin.scenario}
    rows += [(_("setting"), name, str(value), "") for name, value in settings.items()]
    rows += [(_("platform"), name, value, "") for name, value in origin.platform.items()]
    return _of_texts((_("Kind"), 14), (_("Place"), 40), (_("What"), 84), (_("How to fix it"), 60)), rows


def list_notes(content: Content) -> Listing:
    """Return the notes in the workbook: their sheet, their row and their text."""
    rows = [(_("Items"), one.item.item, one.item.notes) for one in content.results if one.item.notes]
    segments = (one for one in content.run.route_tables.segments if one.notes)
    rows += [(_("Routes"), ", ".join(filter(None, (one.route, one.segment))), one.notes) for one in segments]
    return _of_texts((_("Sheet"), 16), (_("Row"), 30), (_("Note"), 120)), rows
