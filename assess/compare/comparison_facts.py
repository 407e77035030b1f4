"""What two runs are, line by line: where they come from, and the settings and lines of the workbook that differ."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from assess.compare import comparison_words as say
from assess.compare.changes import Comparison
from assess.compare.past_run import PastRun
from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.provenance import say_date
from assess.report.results_schema import building_key
from assess.workbook.schema import BUILDING

LONGEST = 80
"""Characters of a name that a line shows."""


@dataclass(frozen=True, slots=True)
class Fact:
    """One line about the two runs; `differs` is whether they differ in it."""

    label: str
    before: str
    after: str
    differs: bool


def list_facts(found: Comparison) -> list[Fact]:
    """Return what the two runs are, and the settings, uncertainties, motions, lines and versions that differ."""
    before, after = found.before, found.after
    uncertainty = {"motion": _("Motion uncertainty"), "piece": _("Piece uncertainty")}
    lines = {building_key(column): _(column.label) for column in BUILDING.columns}
    motions = _say_motions(before, after), _say_motions(after, before)
    return [
        *_list_origins(before, after),
        *_list_settings(before.settings, after.settings),
        *_list_differing(before.uncertainty, after.uncertainty, uncertainty),
        *_list_differing({"shaking": before.shaking}, {"shaking": after.shaking}, {"shaking": _("Assumed shaking")}),
        *_list_differing({"site": before.site_ground}, {"site": after.site_ground}, {"site": _("Ground motion")}),
        *([Fact(_("Recorded motions"), *motions, differs=True)] if before.motions != after.motions else []),
        *_list_differing(before.building, after.building, lines, left_out=("building", "report_date")),
        *_list_differing(before.platform, after.platform, {}),
    ]


def _list_origins(before: PastRun, after: PastRun) -> Iterator[Fact]:
    def fact(label: str, read: Callable[[PastRun], str]) -> Fact:
        was, now = (words.cut(read(run), LONGEST) or words.DASH for run in (before, after))
        return Fact(label, was, now, differs=was != now)

    yield fact(_("Results"), lambda run: "/".join(run.path.absolute().parts[-2:]))
    yield fact(_("Building"), lambda run: run.name)
    yield fact(_("Workbook"), lambda run: run.workbook)
    yield fact(_("SHA-256 of the workbook"), lambda run: run.workbook_sha256)
    yield fact(_("Date of the report"), lambda run: say_date(str(run.building.get("report_date") or "")))
    yield fact(_("Results written (UTC)"), lambda run: f"{run.written:%Y-%m-%d %H:%M}")
    yield fact(_("Classes rest on"), lambda run: say.name_basis(run.main_basis))
    yield fact(
        _("Version of assess"),
        lambda run: _("{version}, schema {schema}", version=run.version, schema=run.schema),
    )
    yield fact(_("SHA-256 of the program's code"), lambda run: run.code)


def _list_settings(before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[Fact]:
    for name in dict.fromkeys((*say.SETTINGS, *sorted({*before, *after}))):
        was, now = before.get(name), after.get(name)
        if was != now or name in say.ALWAYS:
            show = say.say_anchor if name == "anchor" else say.say_value
            yield Fact(say.name_setting(name), show(was), show(now), differs=was != now)


def _say_motions(run: PastRun, other: PastRun) -> str:
    own = [name for name, digest in run.motions.items() if other.motions.get(name) != digest]
    if not own:
        return ngettext("{n:,} file", "{n:,} files", len(run.motions))
    return ngettext(
        "{n:,} file; differs: {names}",
        "{n:,} files; differ: {names}",
        len(run.motions),
        names=words.name_first(own, 3),
    )


def _list_differing(
    before: Mapping[str, Any], after: Mapping[str, Any], names: Mapping[str, str], left_out: Sequence[str] = ()
) -> Iterator[Fact]:
    for name in dict.fromkeys((*before, *after)):
        was, now = before.get(name), after.get(name)
        if was != now and name not in left_out:
            yield Fact(names.get(name, name), say.say_value(was), say.say_value(now), differs=True)
