"""The sheets Methods and Assumptions: what the methods are, assume and change, their limits, and what formulas use."""

from collections.abc import Iterator
from typing import Any

from assess.language import gettext as _
from assess.methods import Method
from assess.methods._method import Range
from assess.motion.scenario import PROFILES
from assess.report.content import Content
from assess.report.findings.motions import ENVELOPES, list_clauses, profile_status
from assess.report.findings.routes import list_cautions, list_widths, say_default_width
from assess.report.provenance import say_reference
from assess.report.words import name_ranges
from assess.report.xlsx.formulas import LIMITS as LIMIT_NAMES
from assess.report.xlsx.pen import Pen
from assess.risk import LIMITS

NAMES = (*LIMIT_NAMES, "zeta_a", "zeta_v", "slide_alpha")
"""Cells that formulas refer to by name, in the order of the sheet Assumptions."""


def write_methods(pen: Pen, page: Any, content: Content) -> None:
    """Write the classes, the methods, what was verified how, what the marks mean, and the limits of it all."""
    rows = [(_("Classes"), pen.terms.labels[risk], text) for risk, text in content.class_limits]
    rows += [row for method in content.methods for row in _method(method)]
    for profile in PROFILES.values():
        rows.append((profile.title, _("Clause"), list_clauses(profile)))
        rows.append((profile.title, _("Equation"), _(profile.equation)))
        rows.append((profile.title, _("Status"), profile_status(profile)))
        rows.append((profile.title, _("Source"), profile.reference))
    rows.append((_("Floor motion by a code's profile"), _("Beware"), _(ENVELOPES)))
    rows.append((_("Adopted risk"), _("What was done"), content.verified.adopted))
    rows += [(_("Verification"), _("What was done"), text) for text in content.trials.paragraphs]
    rows += [(_("Verification"), _("Beware"), text) for text in content.trials.misfits]
    rows += [(_("Marks"), _(flag.replace("_", " ")), meaning) for flag, meaning in content.flags.items()]
    routes = content.assessment.routes
    if routes:
        rows += [(_("Evacuation routes"), _("What was done"), text) for text in list_cautions(routes)]
        rows += [(_("Evacuation routes"), _("Required width"), text) for text in (say_default_width(), *_widths())]
    rows += [(_("Limits of the method"), _("Limit"), text) for text in content.limits]
    rows += [(_("References"), "", text) for text in content.references]
    pen.listing(page, (_("Method"), _("What"), _("Text")), (28, 26, 110), rows)


def _widths() -> Iterator[str]:
    for source, asked in list_widths():
        yield from (_("{asked} ({source})", asked=text, source=source) for text in asked)


def _method(method: Method) -> Iterator[tuple[str, str, str]]:
    title = _(method.title)
    parts = (
        (_("Predicts"), (method.predicts,)),
        (_("Equation"), method.equations),
        (_("Assumption"), method.assumptions),
        (_("Departure from the source"), method.departures),
        (name_ranges(method), tuple(_range(name, one) for name, one in method.valid.items())),
    )
    for what, texts in parts:
        yield from ((title, what, _(text)) for text in texts)
    yield title, _("Source"), say_reference(method.reference)


def write_assumptions(pen: Pen, page: Any, content: Content) -> None:
    """Write the values that formulas refer to, and what else was assumed."""
    settings = content.assessment.settings
    values = (*LIMITS, settings.zeta_acceleration, settings.zeta_velocity, settings.slide_coefficient)
    pen.listing(page, (_("Assumption"), _("Value")), (80, 60), ())
    for row, (label, value) in enumerate(zip(_labels(), values, strict=True), 1):
        page.write_string(row, 0, label, pen.wrap)
        page.write_number(row, 1, value, pen.input)
    rule = {"validate": "decimal", "criteria": "between", "minimum": 0, "maximum": 1}
    page.data_validation(1, 1, len(LIMITS), 1, rule)
    for row, (where, what) in enumerate(content.assumptions, len(NAMES) + 2):
        pen.put(page, row, 0, where, pen.wrap)
        pen.put(page, row, 1, what, pen.wrap)


def _labels() -> tuple[str, ...]:
    """Return what the values are that formulas refer to, in the order of `NAMES`."""
    classes = (_("Lower limit of medium"), _("Lower limit of high"), _("Lower limit of very high"))
    others = (_("Kaneko-Hayashi ζ_A"), _("Kaneko-Hayashi ζ_V"), _("Kaneko-Hayashi slide coefficient α"))
    return (
        *(_("{what} (edit the value: classes and counts follow)", what=one) for one in classes),
        *(_("{what} (edit the value: the column Kaneko-Hayashi follows)", what=one) for one in others),
    )


def _range(name: str, one: Range) -> str:
    """Return in words between what values a method has been checked."""
    what = {"breadth_to_height": _("B/H"), "pfa": _("PFA"), "height": "H", "pfv": "PFV"}.get(name, name)
    return _("{what} {low:g} to {high:g} {unit}", what=what, low=one.low, high=one.high, unit=one.unit).strip()
