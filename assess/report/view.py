"""What the sections of a report read: its content, the edition and medium that they are shown in, and their order."""

import importlib
import pkgutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, partial
from typing import Any, Literal

from markupsafe import escape

from assess.details import Detail
from assess.i18n import gettext as _, ngettext, number
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.blocks import Block, Inline, Paragraph, Section, Span
from assess.report.content import Content
from assess.report.embedded import Photos
from assess.report.figures.plan import Plan, build_plan
from assess.report.figures.ways import build_stretches
from assess.report.page_columns import PageColumn, list_columns, short_columns
from assess.report.provenance import say_date
from assess.report.report_options import ReportOptions
from assess.report.say.route import list_segments
from assess.results import ItemResult, Results
from assess.route_results import SegmentRow
from assess.workbook.schema import BUILDING

Edition = Literal["client", "annex", "work", "all"]
"""What a manager acts on; what that rests on; what a caretaker does; the first two, for a screen."""
FULL_ROWS = 150
"""Rows up to which a PDF shows whole tables of all pieces; longer ones go to the appendix in a compact form."""
MOST_ROWS = 5000
"""Rows that the table of all pieces shows; the Excel report holds all."""
MOST_SEGMENTS = 150
"""Segments of routes that are listed, those most likely to be blocked; the Excel report holds all."""


@dataclass(frozen=True, kw_only=True)
class View:
    """A report as it is shown: `content` in an edition, for a screen or for print."""

    content: Content
    edition: Edition = "all"
    for_print: bool = False
    options: ReportOptions = field(default_factory=ReportOptions)
    progress: Progress = field(default=SILENT, repr=False)

    @property
    def run(self) -> Results:
        """The results."""
        return self.content.run

    @property
    def results(self) -> Sequence[ItemResult]:
        """The rows of furniture."""
        return self.content.results

    @property
    def is_long(self) -> bool:
        """Whether there are too many rows for whole tables in print."""
        return len(self.results) > FULL_ROWS

    @property
    def is_compact(self) -> bool:
        """Whether the pieces have an appendix of lines in place of whole tables."""
        return self.is_long and self.for_print and not self.options.accessible

    @cached_property
    def parts(self) -> Sequence["Part"]:
        """The sections that are shown, in their order."""
        return self.list_parts(self.edition)

    def list_parts(self, edition: Edition) -> Sequence["Part"]:
        """Return the sections of an edition that the run has something on, in their order."""
        own = replace(self, edition=edition) if edition != self.edition else self
        found = [part for part in list_all_parts() if edition in part.places and part.is_shown(own)]
        return sorted(found, key=lambda part: part.places[edition])

    def shows(self, key: str) -> bool:
        """Tell whether a section is shown."""
        return any(part.key == key for part in self.parts)

    @cached_property
    def photos(self) -> Photos:
        """The photos that the report embeds."""
        return Photos(self.run)

    @cached_property
    def plans(self) -> Mapping[str, Plan | None]:
        """The plans by floor, None of one without a position; none in an edition that has no floors."""
        if not self.shows("floors") and not self.shows("work"):
            return {}
        stretches, plans = build_stretches(self.run.route_tables), dict[str, Plan | None]()
        for page in self.progress.checked(self.content.shown_floors):
            name = page.floor.floor
            plans[name] = self.once(f"plan {name}", partial(build_plan, page, self.run, stretches.get(name, ())))
        return plans

    @cached_property
    def shown_segments(self) -> Sequence[tuple[int, SegmentRow]]:
        """The segments that are listed, with their numbers from 1."""
        if not self.run.has_routes:
            return ()
        return list_segments(self.run.route_tables, MOST_SEGMENTS, is_short=self.for_print)

    @cached_property
    def floor_titles(self) -> Mapping[str, str]:
        """The titles of the floors by their names."""
        return {page.floor.floor: page.title for page in self.content.floors}

    def once(self, name: str, draw: Callable[[], Any]) -> Any:
        """Return what is drawn once for HTML, PDF and Word."""
        if name not in self.content.drawn:
            self.content.drawn[name] = draw()
        return self.content.drawn[name]

    def columns(self, *keys: str) -> Sequence[PageColumn]:
        """Return the columns of a list of pieces: all of "pieces", "risky" or "methods", or those of some keys."""
        return list_columns(self.run, keys[0]) if len(keys) == 1 else short_columns(self.run, *keys)  # type: ignore[arg-type]

    def lead_to(self, key: str, text: str) -> list[Inline]:
        """Return a text that leads to a section, or says that the annex has it."""
        if self.shows(key):
            return [Span(text, href=f"#{key}")]
        annex = _("(annex)")
        return [f"{text} {annex}" if self.edition == "client" else text]

    def list_facts(self, names: Sequence[str]) -> list[tuple[str, str]]:
        """Return what the sheet Building says in some of its lines, in words: each label with its text, "" if blank."""
        found = []
        for column in map(BUILDING.column, names):
            value = getattr(self.run.building, column.name)
            if column.kind == "date":
                value = say_date(str(value or ""))
            elif isinstance(value, float):
                value = f"{number(value / column.factor, '.4g')} {column.unit}".strip()
            elif column.kind in ("choice", "flag") and value not in (None, ""):
                value = _(str(value))
            found.append((_(column.label), "" if value is None else str(value)))
        return found

    def read_drawing(self, detail: Detail) -> str:
        """Return the drawing of a way to fix a piece, as SVG with its title; "" where there is none."""
        if not any((folder / "details" / (detail.drawing or "-")).is_file() for folder in self.options.folders):
            return ""
        drawn = self.options.read(f"details/{detail.drawing}")
        title = escape(_("Drawing: {detail}", detail=_(detail.title)))
        head, mark, rest = drawn[drawn.index("<svg") :].partition(">")
        return f'{head} role="img" aria-label="{title}"{mark}<title>{title}</title>{rest.strip()}'

    def list_texts(self, section: str) -> list[Block]:
        """Return the free texts that the workbook has for a section; the summary has those of sections not shown."""
        keys = {"What to fix": "schedule", "Ways out": "routes"}
        found = ((name if self.shows(keys.get(name, "summary")) else "Summary", text) for name, text in self.run.texts)
        return [Paragraph(text, "free-text") for name, text in found if name == section]

    def name_piece(self, at: int, longest: int = 20) -> Inline:
        """Return the name of a piece by its index, a link to its row where that is shown."""
        name = words.cut(self.results[at].item.item, longest)
        if self.for_print or self.is_compact or at >= MOST_ROWS:
            return name
        return Span(name, "whole" if len(name) <= 10 else "", f"#row-{at + 1}")  # a short one is not broken at a hyphen

    def name_row(self, at: int, longest: int = 20) -> list[Inline]:
        """Return the name of a piece, with how many pieces its row has where they are several."""
        count = self.results[at].item.quantity
        return [self.name_piece(at, longest), *([f" ({words.plural(count, 'piece')})"] if count > 1 else [])]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A section of the report: one of the `PARTS` of a module in `assess.report.sections`, which is found there.

    * `key`: its anchor.
    * `heading`: in English; it stands in the contents as well.
    * `places`: by edition, where it stands: a section of a smaller number comes first.
    * `build`: from the view to its blocks, as a section, or several of which the first has the heading.
    * `is_shown`: whether the run has something on it; by default it has.
    """

    key: str
    heading: str
    places: Mapping[Edition, int]
    build: Callable[[View], Section | Sequence[Section]]
    is_shown: Callable[[View], bool] = lambda _view: True


@cache
def list_all_parts() -> Sequence[Part]:
    """Return every section there is, by key: those of the modules in `assess.report.sections`."""
    sections = importlib.import_module("assess.report.sections")
    names = [one.name for one in pkgutil.iter_modules(sections.__path__)]
    parts = [part for name in names for part in importlib.import_module(f"{sections.__name__}.{name}").PARTS]
    return sorted(parts, key=lambda part: part.key)


def say_left(left: int, *, is_likely: bool = False) -> list[Block]:
    """Return a line on how many rows only the Excel report has, if any; `is_likely`: the likeliest are shown."""
    if left <= 0:
        return []
    text = ngettext("{n:,} more is in the Excel report.", "{n:,} more are in the Excel report.", left)
    if is_likely:
        text = ngettext("{n:,} more, less likely, is in the Excel report.",
                        "{n:,} more, less likely, are in the Excel report.", left)  # fmt: skip
    return [Paragraph(text, "small")]
