"""The sheets of texts: Methods, Assumptions with the values that formulas use, Quality log, Notes."""

from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from assess.i18n import gettext as _
from assess.report.content import Content
from assess.report.provenance import say_reference
from assess.report.say.ground import ENVELOPES, list_clauses, profile_status
from assess.report.say.route import list_cautions, list_widths, say_default_width
from assess.report.words import name_ranges
from assess.report.xlsx.item_formulas import LIMITS as LIMIT_NAMES
from assess.report.xlsx.pen import Column, Pen, row_height
from assess.results import Results
from assess.risk import LIMITS, RiskClass

if TYPE_CHECKING:
    from assess.methods import MethodInfo


def _columns(*heads: tuple[str, int]) -> list[Column]:
    """Return the columns of rows that are tuples of texts."""
    return [Column(label, width, itemgetter(at)) for at, (label, width) in enumerate(heads)]


def write_methods(pen: Pen, page: Any, content: Content) -> None:
    """Write the classes, the methods, what was simulated how, what the marks mean, and the limits of it all."""
    columns = _columns((_("Method"), 28), (_("What"), 26), (_("Text"), 110))
    pen.listing(page, columns, [*_list_methods(pen, content), *_list_run(content)])


def _list_methods(pen: Pen, content: Content) -> Iterator[tuple[str, str, str]]:
    for risk, text in content.class_limits:
        yield _("Classes"), pen.terms.labels[risk], text
    for method in content.methods:
        yield from _method(method)
    for profile in content.run.provenance.profiles:
        yield profile.title, _("Clause"), list_clauses(profile)
        yield profile.title, _("Equation"), _(profile.equation)
        yield profile.title, _("Status"), profile_status(profile)
        yield profile.title, _("Source"), profile.reference
    yield _("Floor motion by a code's profile"), _("Beware"), _(ENVELOPES)


def _list_run(content: Content) -> Iterator[tuple[str, str, str]]:
    done, routes = _("What was done"), _("Evacuation routes")
    yield _("Adopted risk"), done, content.verified.adopted
    yield from ((_("Verification"), done, text) for text in content.trials.paragraphs)
    yield from ((_("Verification"), _("Beware"), text) for text in content.trials.misfits)
    yield from ((_("Marks"), _(flag.replace("_", " ")), meaning) for flag, meaning in content.flags.items())
    if content.run.has_routes:
        yield from ((routes, done, text) for text in list_cautions(content.run.route_tables))
        yield routes, _("Required width"), say_default_width()
        for source, widths in list_widths():
            for text in widths:
                yield routes, _("Required width"), _("{asked} ({source})", asked=text, source=source)
    yield from ((_("Limits of the method"), _("Limit"), text) for text in content.limits)
    yield from ((_("References"), "", text) for text in content.references)


def _method(method: "MethodInfo") -> Iterator[tuple[str, str, str]]:
    title = _(method.title)
    parts = (
        (_("Predicts"), (method.predicts,)),
        (_("Equation"), method.equations),
        (_("Assumption"), method.assumptions),
        (_("Departure from the source"), method.departures),
        (name_ranges(method), tuple(_ranges(method))),
    )
    for what, texts in parts:
        yield from ((title, what, _(text)) for text in texts)
    yield title, _("Source"), say_reference(method.reference)


def _ranges(method: "MethodInfo") -> Iterator[str]:
    names = {"breadth_to_height": _("B/H"), "pfa": _("PFA"), "height": "H", "pfv": "PFV"}
    for name, one in method.valid.items():
        what = names.get(name, name)
        yield _("{what} {low:g} to {high:g} {unit}", what=what, low=one.low, high=one.high, unit=one.unit).strip()


def named_values(results: Results) -> list[tuple[str, str, float]]:
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
    columns = _columns((_("Assumption"), 80), (_("Value"), 60))
    pen.listing(page, columns, ())
    values = named_values(content.run)
    for row, (_name, meaning, value) in enumerate(values, 1):
        page.write_string(row, 0, meaning, pen.style("text"))
        page.write_number(row, 1, value, pen.style("input"))
    rule = {"validate": "decimal", "criteria": "between", "minimum": 0, "maximum": 1}
    page.data_validation(1, 1, len(LIMITS), 1, rule)
    for row, (where, what) in enumerate(content.assumptions, len(values) + 2):
        page.set_row(row, row_height((where, what), [one.width for one in columns]))
        pen.put(page, row, 0, where, pen.style("text"))
        pen.put(page, row, 1, what, pen.style("text"))


def write_quality(pen: Pen, page: Any, content: Content) -> None:
    """Write every warning and note of the checks, then inputs with their hashes, program, settings and platform."""
    rows: list[Sequence[str]] = [
        (_(one.severity), one.place, _(one.message), _(one.fix) if one.fix else "") for one in content.problems
    ]
    rows = rows or [(_("note"), "", _("No warnings or notes."), "")]
    columns = _columns((_("Kind"), 14), (_("Place"), 40), (_("What"), 84), (_("How to fix it"), 60))
    pen.listing(page, columns, [*rows, *_list_provenance(content)])


def _list_provenance(content: Content) -> Iterator[Sequence[str]]:
    """Yield what the report was made from and with; names are those of results.json."""
    origin = content.run.provenance
    files = {origin.workbook: origin.sha256, **origin.files, **(origin.suite.files if origin.suite else {})}
    for name, digest in files.items():
        yield _("input"), name, f"SHA-256 {digest}", ""
    yield _("program"), "assess", content.version, ""
    yield _("program"), _("date"), content.date, ""
    for name, value in (content.run.settings.as_record() | {"scenario": origin.scenario}).items():
        yield _("setting"), name, str(value), ""
    for name, value in origin.platform.items():
        yield _("platform"), name, value, ""


def write_notes(pen: Pen, page: Any, content: Content) -> None:
    """Write what the workbook's own notes say."""
    pen.listing(page, _columns((_("Sheet"), 16), (_("Row"), 30), (_("Note"), 120)), list_notes(content))


def list_notes(content: Content) -> list[tuple[str, str, str]]:
    """Return the notes in the workbook: their sheet, their row and their text."""
    own = [(_("Items"), one.item.item, one.item.notes) for one in content.notes]
    segments = (one for one in content.run.route_tables.segments if one.notes)
    return own + [(_("Routes"), ", ".join(filter(None, (one.route, one.segment))), one.notes) for one in segments]
