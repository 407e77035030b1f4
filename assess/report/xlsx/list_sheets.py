"""The sheets that list what was found or read, from the motions to the notes in the workbook."""

from collections.abc import Callable
from operator import attrgetter, itemgetter
from typing import Any

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
from assess.report.xlsx.pen import COUNT, Column, Pen, of_field, refer, row_height
from assess.results import MotionRow
from assess.risk import LIMITS, RiskClass
from assess.workbook.formulas import say_class

RATE = "0.00E+00"


def _of_texts(*heads: tuple[str, int]) -> list[Column]:
    return [Column(label, width, itemgetter(at)) for at, (label, width) in enumerate(heads)]


def _of_motions(*keys: str, width: int = 10) -> list[Column]:
    return [of_field(one, width=width) for key in keys for one in MOTION_FIELDS if one.key == key]


def write_motions(pen: Pen, page: Any, content: Content) -> None:
    """Write every motion, with what was done to it."""
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
    pen.listing(page, columns, [one for floor in content.floors for one in floor.motions])


def write_fits(pen: Pen, page: Any, content: Content) -> None:
    """Write the motions of every floor and axis under which pieces were simulated, and how they meet their target."""
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
    pen.listing(page, columns, [one for floor in content.floors for one in floor.motions if one.ensemble])


def write_annual(pen: Pen, page: Any, content: Content) -> None:
    """Write every piece, route and room that has a chance a year, then the hazard curve and what was done with it."""
    annual, tables = content.annual, content.run.annual
    if annual is None or tables is None:
        return

    def of_row(name: str) -> Callable[[Any], Any]:
        return lambda one: getattr(one[1].row, name)

    fail = attrgetter("fail.chance_in_50_years")
    columns = [
        Column(_("What"), 9, itemgetter(0)),
        Column(_("Name"), 24, lambda one: one[1].name),
        Column(_("Description"), 32, lambda one: one[1].what),
        Column(_("Floor, room"), 20, lambda one: one[1].where),
        Column(_("Chance a year"), 12, of_row("chance_a_year"), "0.000%"),
        Column(_("Chance in 50 years"), 12, of_row("chance_in_50_years"), "0.0%"),
        Column(_("Times a year"), 12, of_row("rate"), RATE),
        Column(_("Sampling interval, from"), 12, of_row("low"), RATE),
        Column(_("to"), 12, of_row("high"), RATE),
        Column(_("Once in [years]"), 10, lambda one: 1 / one[1].row.rate if one[1].row.rate > 0 else None, COUNT),
        Column(_("Lower bound"), 8, lambda one: words.yes_or_no(one[1].row.at_least)),
        Column(_("Ends of the curve matter"), 10, lambda one: words.yes_or_no(one[1].row.ends_matter)),
        Column(_("Integrated"), 12, lambda one: _(one[1].row.fit)),
        Column(_("If anchors fail (50 years)"), 10, lambda one: one[1].fail and fail(one[1]), "0.0%"),
        Column(_("Median ground PGA [g]"), 10, of_row("median_g"), "0.000"),
        Column(_("Dispersion"), 10, of_row("dispersion"), "0.000"),
        Column(_("Misfit"), 10, of_row("misfit"), "0.000"),
    ]
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


def write_methods(pen: Pen, page: Any, content: Content) -> None:
    """Write the classes, the methods, what was simulated how, what the marks mean, and the limits of it all."""
    run = content.run
    rows = [(_("Classes"), say_class(risk), text) for risk, text in words.list_limits()]
    names = {"breadth_to_height": _("B/H"), "pfa": _("PFA"), "height": "H", "pfv": "PFV"}
    for method in run.methods:
        title = _(method.title)
        parts = (
            (_("Predicts"), (method.predicts,)),
            (_("Equation"), method.equations),
            (_("Assumption"), method.assumptions),
            (_("Departure from the source"), method.departures),
        )
        rows += [(title, what, _(text)) for what, texts in parts for text in texts]
        for name, one in method.valid.items():
            text = _("{what} {low:g} to {high:g} {unit}", what=names.get(name, name), low=one.low, high=one.high,
                     unit=one.unit)  # fmt: skip
            rows.append((title, words.name_ranges(method), text.strip()))
        rows.append((title, _("Source"), say_reference(method.reference)))
    for profile in run.provenance.profiles:
        rows += [
            (profile.title, _("Clause"), list_clauses(profile)),
            (profile.title, _("Equation"), _(profile.equation)),
            (profile.title, _("Status"), profile_status(profile)),
            (profile.title, _("Source"), profile.reference),
        ]
    done, routes, verification = _("What was done"), _("Evacuation routes"), _("Verification")
    rows += [
        (_("Floor motion by a code's profile"), _("Beware"), _(ENVELOPES)),
        (_("Adopted risk"), done, content.verified.adopted),
        *((verification, done, text) for text in describe_trials(content.verified)),
        *((verification, _("Beware"), text) for text in list_misfits(run)),
        *((_("Marks"), say_flag(flag), meaning) for flag, meaning in statements.list_flags(run).items()),
    ]
    if run.has_routes:
        width = _("Required width")
        rows += [(routes, done, text) for text in list_cautions(run.route_tables)]
        rows.append((routes, width, say_default_width()))
        for source, widths in list_widths():
            rows += [(routes, width, _("{asked} ({source})", asked=text, source=source)) for text in widths]
    rows += [(_("Limits of the method"), _("Limit"), text) for text in statements.list_limits(run)]
    rows += [(_("References"), "", text) for text in list_references(run)]
    pen.listing(page, _of_texts((_("Method"), 28), (_("What"), 26), (_("Text"), 110)), rows)


def write_assumptions(pen: Pen, page: Any, content: Content) -> None:
    """Write the values that formulas refer to, and what else was assumed."""
    columns = _of_texts((_("Assumption"), 80), (_("Value"), 60))
    pen.listing(page, columns, ())
    values = [  # name of the cell, meaning and value
        (name, _("Lower limit of {risk} (edit the value: classes and counts follow)", risk=_(risk.word)), limit)
        for name, risk, limit in zip(LIMIT_NAMES, list(RiskClass)[1:], LIMITS, strict=True)
    ]
    for method in (one for one in content.run.methods if one.is_live):
        for one in method.parameters:
            meaning = _("{method} {symbol} (edit the value: the column {column} follows)", method=_(method.title),
                        symbol=one.symbol, column=_(method.short_title))  # fmt: skip
            values.append((one.cell, meaning, getattr(content.run.settings, one.setting)))
    for row, (name, meaning, value) in enumerate(values, 1):
        pen.book.define_name(name, f"={refer(pen.sheets['Assumptions'])}$B${row + 1}")
        page.write_string(row, 0, meaning, pen.style("text"))
        page.write_number(row, 1, value, pen.style("input"))
    rule = {"validate": "decimal", "criteria": "between", "minimum": 0, "maximum": 1}
    page.data_validation(1, 1, len(LIMITS), 1, rule)
    for row, texts in enumerate(content.assumptions, len(values) + 2):
        page.set_row(row, row_height(texts, [one.width for one in columns]))
        for at, text in enumerate(texts):
            pen.put(page, row, at, text, pen.style("text"))


def write_quality(pen: Pen, page: Any, content: Content) -> None:
    """Write every warning and note of the checks, then inputs with their hashes, program, settings and platform.

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
    pen.listing(page, _of_texts((_("Kind"), 14), (_("Place"), 40), (_("What"), 84), (_("How to fix it"), 60)), rows)


def write_notes(pen: Pen, page: Any, content: Content) -> None:
    """Write the notes in the workbook: their sheet, their row and their text."""
    rows = [(_("Items"), one.item.item, one.item.notes) for one in content.results if one.item.notes]
    segments = (one for one in content.run.route_tables.segments if one.notes)
    rows += [(_("Routes"), ", ".join(filter(None, (one.route, one.segment))), one.notes) for one in segments]
    pen.listing(page, _of_texts((_("Sheet"), 16), (_("Row"), 30), (_("Note"), 120)), rows)
