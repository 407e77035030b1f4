"""The sheets Quality log and Notes: what the checks found, what the report was made from and with, and own notes."""

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from assess.language import gettext as _
from assess.report.content import Content
from assess.report.xlsx.pen import Pen

Row = tuple[str, str, str, str]


def write_quality(pen: Pen, page: Any, content: Content) -> None:
    """Write every warning and note of the checks, then inputs with their hashes, program, settings and platform."""
    rows: list[Row] = [
        (_(one.severity), one.place, _(one.message), _(one.mend) if one.mend else "") for one in content.problems
    ]
    if not rows:
        rows.append((_("note"), "", _("Nothing to remark."), ""))
    rows += [*_inputs(content), *_program(content)]
    pen.listing(page, (_("Kind"), _("Place"), _("What"), _("Mend")), (14, 40, 84, 60), rows)


def _inputs(content: Content) -> Iterator[Row]:
    inventory, suite = content.assessment.inventory, content.assessment.suite
    files = {inventory.source.name: inventory.sha256, **inventory.files, **(suite.files if suite else {})}
    for name, digest in files.items():
        yield _("input"), name, f"SHA-256 {digest}", ""


def _program(content: Content) -> Iterator[Row]:
    """Yield what the report was made with; names are those of results.json."""
    assessment = content.assessment
    yield _("program"), "assess", content.version, ""
    yield _("program"), _("date"), content.date, ""
    settings = asdict(assessment.settings) | {"scenario": assessment.scenario}
    for name, value in settings.items():
        yield _("setting"), name, str(value), ""
    for name, value in content.platform.items():
        yield _("platform"), name, value, ""


def has_notes(content: Content) -> bool:
    """Tell whether somebody has written notes in the workbook."""
    return any(True for _row in _notes(content))


def write_notes(pen: Pen, page: Any, content: Content) -> None:
    """Write what the workbook's own notes say."""
    pen.listing(page, (_("Sheet"), _("Row"), _("Note")), (16, 30, 120), list(_notes(content)))


def _notes(content: Content) -> Iterator[tuple[str, str, str]]:
    for one in content.notes:
        yield _("Items"), one.item.item, one.item.notes
    for segment in content.assessment.inventory.routes:
        if segment.notes:
            yield _("Routes"), ", ".join(part for part in (segment.route, segment.segment) if part), segment.notes
