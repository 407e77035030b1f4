"""The files of a comparison, whole or none of them: compare.html, compare.pdf, compare.xlsx, and compare.json.

As with reports, a later comparison replaces or removes only what compare.json lists, so that it is always written.
compare.json is for other programs and the same in every language; units stand in the names. Its first two entries are
those of results.json, so that a later comparison knows which files next to it are its own (`assess.report.ownership`).
Standings, directions and states are the words of `assess.compare`; null is what a run lacks. compare.xlsx has every
row, whether it changed or not.
"""

import datetime
import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from assess.compare import comparison_document as say
from assess.compare.changes import Change, Comparison, StateChange, Total, count_states
from assess.compare.comparison_document import View, render_comparison
from assess.compare.past_run import COMPARISON, PastChance, PastPiece, PastRun, PastState
from assess.delivery.deliver import Written, deliver, explain_fault, find_digest, flush_file, stage_for
from assess.delivery.folders import NEW
from assess.errors import InputError, PdfUnavailableError
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import check_folder, words
from assess.report.blocks import Cell, Table, plain_words
from assess.report.measures import reading
from assess.report.ownership import find_reports, seal
from assess.report.pages.pdf import attach, print_page
from assess.report.provenance import report_time
from assess.report.report_options import ReportOptions
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, write_sheets
from assess.route_results import RouteState
from assess.version import __version__

_Past = TypeVar("_Past", PastPiece, PastState)

SCHEMA = "1.1"
"""Version of the shape of compare.json."""
FILES: Mapping[str, str] = {name: f"compare.{name}" for name in ("xlsx", "html", "json", "pdf")}
"""The formats in the order in which they are written: compare.json lists the others, and the PDF carries it."""
FORMATS = ("html", "pdf", "xlsx")
"""The default formats, in addition to compare.json."""

_TONES: dict[str, dict[str, Any]] = {
    "worse": {"bg_color": "#8c1d3f", "font_color": "#ffffff", "bold": True},
    "better": {"bg_color": "#d5e9f6", "font_color": "#1c1c1c"},
    "same": {"bg_color": "#e9edf0"},
}
"""Looks of what gets worse or better."""


def write_comparison(
    comparison: Comparison,
    folder: str | Path,
    formats: Sequence[str] = FORMATS,
    options: ReportOptions | None = None,
    *,
    progress: Progress = SILENT,
) -> Written:
    """Write the files of a comparison into a folder, which is made where it is missing; compare.json is always written.

    `formats` are of "html", "pdf", "xlsx", "json"; `options` language and kind of PDF. Files of an earlier comparison
    in the folder are replaced or removed, others stay. Returns the file of each format, and what was removed.

    Raises InputError if a format is unknown, or a file of the user's stands at the name of one of the files;
    PdfUnavailableError if the native libraries of the PDF are missing; all other formats have been written; OutputError
    if a file cannot be written; what was there before is left as it was; CancelledError if the work was cancelled;
    nothing was written.
    """
    folder, options = Path(folder), options or ReportOptions()
    wanted = _arrange(formats)
    check_out(folder, formats)
    listed: dict[str, str | None] = {}
    try:
        units = str(comparison.after.building.get("report_units") or "")
        with stage_for(folder) as stage, options.spoken(), reading(units):
            missing = _write_all(View(comparison), stage / NEW, wanted, options, progress, listed)
            names = [*listed, FILES["json"]]
            gone = deliver(stage, folder, lambda target: _find_old(target, names), FILES["json"], progress)
    except OSError as error:
        raise explain_fault(folder, error, FILES.values()) from None
    if missing:
        raise missing
    files = {name: folder / file for name, file in FILES.items() if file in names}
    return Written(files, removed=[folder / name for name in gone])


def _find_old(folder: Path, wanted: Collection[str]) -> frozenset[str]:
    return find_reports(folder, wanted, lambda name: name in FILES.values(), FILES["json"])


def check_out(folder: Path, formats: Sequence[str]) -> None:
    """Check before the work that the files can be written to a folder; raises what `write_comparison` does."""
    names = {FILES[name] for name in _arrange(formats)}
    check_folder(folder)
    if folder.is_dir():
        _find_old(folder, names)


def _arrange(formats: Sequence[str]) -> list[str]:
    unknown = [name for name in formats if name not in FILES]
    if unknown:
        known = ", ".join(sorted(FILES))
        raise InputError.about("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0], known=known)
    return [name for name in FILES if name in {*formats, "json"}]


def _write_all(
    view: View,
    stage: Path,
    formats: Sequence[str],
    options: ReportOptions,
    progress: Progress,
    listed: dict[str, str | None],
) -> PdfUnavailableError | None:
    """Write the files; return the error of a PDF that cannot be made.

    `listed` gets the files but for compare.json with their SHA-256: None of the PDF, which carries compare.json.
    """
    data, missing = stage / FILES["json"], None

    def write_data() -> None:
        data.write_text(dump(describe(view.found, dict(sorted(listed.items())))), encoding="utf-8")

    with progress.stage("rendering", ", ".join(formats)) as part:
        for at, name in enumerate(formats):
            part.at(at / len(formats))
            path = stage / FILES[name]
            if name == "json":
                listed.update({FILES["pdf"]: None} if "pdf" in formats else {})
                write_data()
            elif name == "pdf":
                try:
                    html = render_comparison(view, options, for_print=True, progress=progress)
                    files = [attach(data.name, "Data", _("The comparison, for other programs"), data.read_bytes())]
                    print_page(html, path, files, options, progress)
                except PdfUnavailableError as error:
                    missing = error
                    del listed[path.name]
                    write_data()
                    continue
                if not seal(path, data):
                    listed[path.name] = find_digest(path)
                    write_data()
            else:
                if name == "xlsx":
                    write_tables(view, path, progress)
                else:
                    path.write_text(render_comparison(view, options, progress=progress), encoding="utf-8")
                listed[path.name] = find_digest(path)
            flush_file(path)
        part.check()
    return missing


def dump(record: Mapping[str, Any]) -> str:
    """Return a document in JSON."""
    return json.dumps(record, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def describe(found: Comparison, files: Mapping[str, str | None] | None = None) -> dict[str, Any]:
    """Return the document; `files` are listed where it is written among them."""
    was, now, both = found.before, found.after, found.falls_of_both

    def pair(before: float, after: float) -> dict[str, float]:
        return {"before": before, "after": after}

    def total(one: Total) -> dict[str, Any]:
        fair, within = one.is_comparable, one.is_within
        return {**pair(one.before, one.after), "comparable": fair, "within_sampling_interval": within}

    return {
        "schema": SCHEMA,
        "assess": {"version": __version__, **({} if files is None else {"files": dict(files)})},
        COMPARISON: {
            "same_code": was.code == now.code,
            "same_basis": found.has_same_basis,
            "same_results": was.sha256 == now.sha256,
            "other_building": found.is_other_building,
        },
        "before": _run(was),
        "after": _run(now),
        "counts": {
            "pieces": {one: total(found.count_standing(one)) for one in found.standings()},
            "expected_falls": total(found.falls),
            "expected_falls_counted_in_both": both and total(both),
            "routes": {state: pair(*sides) for state, sides in count_states(was.routes, now.routes).items()},
            "blocked_routes_expected": pair(was.blocked_routes, now.blocked_routes),
            "rooms": {state: pair(*sides) for state, sides in count_states(was.rooms, now.rooms).items()},
            "unknown_routes": pair(was.unknown_routes, now.unknown_routes),
            "unknown_rooms": pair(was.unknown_rooms, now.unknown_rooms),
            "unjoined_rooms": pair(len(was.unjoined_rooms), len(now.unjoined_rooms)),
            "cut_off_rooms_expected": pair(was.cut_off_rooms, now.cut_off_rooms),
        },
        "recommendations": [
            {"status": one.status.value, "items": list(one.items), "phase": one.entry.phase, "place": one.entry.place}
            for one in found.recommendations
        ],
        "moves": [
            {"before": one or None, "after": to or None, "pieces": count} for (one, to), count in found.moves.items()
        ],
        "items": [
            {"item": one.row.item, **_change(one, _describe_piece),
             "inputs": {name: {"before": was, "after": now} for name, (was, now) in one.inputs.items()}}
            for one in found.pieces
        ],
        "routes": [{"route": one.row.name, **_change(one, _describe_state)} for one in found.routes],
        "rooms": [
            {"room": one.row.name, **_change(one, _describe_state), "floor": one.row.floor} for one in found.rooms
        ],
    }  # fmt: skip


def _change(one: Change[_Past], describe_side: Callable[[_Past, str], dict[str, Any]]) -> dict[str, Any]:
    before, after = (side and describe_side(side, state) for side, state in zip(one.sides, one.states, strict=True))
    within = one.is_within
    return {"change": one.direction.value, "within_sampling_interval": within, "before": before, "after": after}


def _describe_state(state: PastState, _standing: str) -> dict[str, Any]:
    return {"state": state.state, "chance": state.chance and asdict(state.chance)}


def _describe_piece(piece: PastPiece, standing: str) -> dict[str, Any]:
    return {
        "floor": piece.floor, "room": piece.room, "quantity": piece.quantity, "standing": standing,
        "class": piece.risk.word, "basis": piece.basis, **asdict(piece.chance),
    }  # fmt: skip


def _run(run: PastRun) -> dict[str, Any]:
    return {
        "results": run.path.name, "results_sha256": run.sha256, "results_written": f"{run.written:%Y-%m-%dT%H:%M:%SZ}",
        "schema": run.schema, "version": run.version, "code": run.code or None, "building": run.name,
        "workbook": run.workbook, "workbook_sha256": run.workbook_sha256, "basis": run.main_basis,
        "settings": dict(run.settings), "unjoined_rooms": list(run.unjoined_rooms),
    }  # fmt: skip


def write_tables(view: View, path: Path, progress: Progress = SILENT) -> None:
    """Write compare.xlsx in the language in use, as `assess.report.xlsx.pen.write_sheets` does."""
    found = view.found

    def write_status(pen: Pen, page: Any) -> None:
        table = view.tabulate_status(len(found.recommendations))
        pen.heads(page, [plain_words(one.heading) for one in table.columns], [22, 44, 26, 10, 30])
        _write_rows(pen, page, 1, table)

    items = [
        *_list_change_columns(),
        Column(_("Item"), 14, lambda one: one.row.item),
        Column(_("Description"), 22, lambda one: one.row.description),
        Column(_("Floor"), 8, lambda one: one.row.floor),
        Column(_("Room"), 14, lambda one: one.row.room),
        *_of_both(lambda run: _("Pieces, {run}", run=run), 9,
                  lambda one, at: getattr(one.sides[at], "quantity", None), COUNT),
        *_of_both(lambda run: _("Class, {run}", run=run), 16,
                  lambda one, at: plain_words(say.mark_standing(one.states[at]))),
        *_list_chances(lambda piece: piece.chance),
        *_of_both(lambda run: _("Basis, {run}", run=run), 13,
                  lambda one, at: say.name_basis(one.sides[at].basis) if one.sides[at] else None),
        Column(_("Input that differs"), 40, lambda one: "; ".join(say.say_inputs(one))),
    ]  # fmt: skip
    facts = [
        Column(_("What"), 40, lambda one: one.label),
        Column(_("BEFORE"), 44, lambda one: one.before),
        Column(_("AFTER"), 44, lambda one: one.after),
        Column(_("Differs"), 10, lambda one: words.yes_or_no(one.differs)),
    ]
    sheets: dict[str, Callable[[Pen, Any], object]] = {
        _("Summary"): partial(_write_summary, view),
        _("Recommendations"): write_status,
        _("Items"): lambda pen, page: pen.listing(page, items, found.pieces),
    }
    column = partial(Column, width=20, read=lambda one: one.row.name)
    if found.routes:
        sheets[_("Routes")] = partial(_write_states, [column(_("Route"))], found.routes)
    if found.rooms:
        own = [column(_("Room")), Column(_("Floor"), 8, lambda one: one.row.floor)]
        sheets[_("Rooms")] = partial(_write_states, own, found.rooms)
    sheets[_("The two runs")] = lambda pen, page: pen.listing(page, facts, view.list_facts())
    write_sheets(
        path,
        [(title, title, write) for title, write in sheets.items()],
        title=_("Furniture in earthquakes, before and after: {building}", building=words.cut(view.title, 120)),
        created=datetime.datetime.combine(report_time().date(), datetime.time()),
        # Excel takes 255 characters in all above or below a printed page
        texts=(words.cut(view.title, 40), words.cut(view.conditions, 80), words.cut(view.footer, 160)),
        progress=progress,
    )


def _write_summary(view: View, pen: Pen, page: Any) -> None:
    page.set_column(0, 0, 52)
    page.set_column(1, 2, 12)
    page.set_column(3, 3, 34)
    texts = [
        (view.title, "title"),
        *((text, "warning") for text in (view.conditions, *view.list_warnings())),
        *((text, "heading") for text in (*view.list_status(), view.headline)),
        *((text, "plain") for text in (*view.list_worse(), *view.list_others(), view.footer)),
    ]
    texts = [one for one in texts if one[0]]
    for row, (text, look) in enumerate(texts):
        pen.put(page, row, 0, text, pen.style(look))
    below = len(texts)
    for table in view.tabulate_counts():
        for at, column in enumerate(table.columns):
            pen.put(page, below + 1, at, column.heading, pen.style("head"))
        below = _write_rows(pen, page, below + 2, table)


def _write_rows(pen: Pen, page: Any, top: int, table: Table) -> int:
    for number, row in enumerate(table.groups[0], top):
        for at, one in enumerate(row.cells):
            cell = one if isinstance(one, Cell) else Cell(one)
            value = plain_words(cell.words) if cell.sort is None else cell.sort
            form = "" if isinstance(value, str) else COUNT if isinstance(value, int) else "#,##0.00"
            look = _TONES.get(row.kind if cell.kind == "change" else cell.kind, {})
            pen.put(page, number, at, value, pen.style("total" if row.kind == "total" else "plain", form, **look))
    return top + len(table.groups[0])


def _write_states(own: Sequence[Column], rows: Sequence[StateChange], pen: Pen, page: Any) -> None:
    columns = [
        *_list_change_columns(),
        *own,
        *_of_both(lambda run: _("State, {run}", run=run), 16, lambda one, at: say.name_state(one.states[at])),
        # what is missing is not in a chance that is not known
        *_list_chances(lambda state: None if state.state == RouteState.NOT_KNOWN else state.chance),
    ]
    pen.listing(page, columns, rows)


def _list_change_columns() -> list[Column]:
    return [
        Column(_("Change"), 20, lambda one: say.name_direction(one.direction)),
        Column(
            _("Within the sampling interval"),
            12,
            lambda one: "" if one.is_within is None else words.yes_or_no(one.is_within),
        ),
    ]


def _of_both(label: Callable[[str], str], width: int, read: Callable[[Any, int], Any], form: str = "") -> list[Column]:
    """Return a column of each run; `read` takes a change, and 0 for BEFORE or 1 for AFTER."""
    return [
        Column(label(run), width, partial(lambda at, one: read(one, at), at), form)
        for at, run in enumerate((_("BEFORE"), _("AFTER")))
    ]


def _list_chances(find: Callable[[Any], PastChance | None]) -> list[Column]:
    def part(at: int, name: str, one: Any) -> float | None:
        return getattr(find(one.sides[at]), name, None) if one.sides[at] else None

    return [
        Column(label, 10, partial(part, at, name), CHANCE)
        for at, run in enumerate((_("BEFORE"), _("AFTER")))
        for label, name in (
            (_("Chance, {run}", run=run), "probability"),
            (_("Interval low, {run}", run=run), "low"),
            (_("Interval high, {run}", run=run), "high"),
        )
    ]
