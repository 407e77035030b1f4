"""What an export takes from results.json: its pieces with their identifiers, its schedule, and what obstructs routes.

The file is read and checked as `assess compare` does it, and further values by the same reader.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from assess.compare.past_run import Part, PastPiece, PastRun, read_record
from assess.details import DETAILS
from assess.errors import InputError
from assess.i18n import fill
from assess.methods import simulation
from assess.report.say.work import RouteStep
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.schedule_results import ScheduleRow, WorkRow
from assess.workbook.names import key

Point = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportPiece(PastPiece):
    """A piece of the results with what a comparison does not need of it; "" or None where it is not known.

    `has_simulated` tells whether its chance is that of a simulation, be it confirmed or not. `place` is the centre of
    its plan in the axes of the workbook [m], `faces` the direction in which it falls, or may fall, anticlockwise from X
    [deg]; it falls one way where it falls in that direction alone, away from a wall.
    """

    source_id: str
    upper: RiskClass
    has_simulated: bool
    importance: str
    pfa_source: str
    place: Point | None
    faces: float | None
    falls_one_way: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportSegment:
    """A segment of a route that is not open, or would be blocked by one piece alone.

    `ends` are those of its centre line on the plan [m], None where they are not known; `items` are the pieces that
    reach into it.
    """

    route: str
    ends: tuple[Point, Point] | None
    items: frozenset[str]


@dataclass(frozen=True, kw_only=True)
class ExportRun:
    """The results of a run; `steps` are what to fix for its routes, `item_index` of which is a place in `pieces`.

    `language` is the code of the language of its reports, "" where the file does not tell it.
    """

    run: PastRun
    language: str
    pieces: tuple[ExportPiece, ...]
    entries: tuple[ScheduleRow, ...]
    segments: tuple[ExportSegment, ...]
    steps: tuple[RouteStep, ...]

    @cached_property
    def works(self) -> dict[str, tuple[ScheduleRow, WorkRow]]:
        """The part of the schedule that each piece in it belongs to, in its entry, by the name of the piece."""
        return {item: (entry, work) for entry in self.entries for work in entry.works for item in work.items}


def list_items(entry: ScheduleRow) -> list[str]:
    """Return the names of the pieces of an entry, the most urgent first."""
    return [name for work in entry.works for name in work.items]


def read_export(path: Path) -> ExportRun:
    """Read results.json for an export.

    Raises InputError if it cannot be read (see `assess.compare.past_run.read_run`), or holds no identifier of any
    piece.
    """
    run, record = read_record(path)
    pieces = tuple(map(_read_piece, record.rows("items"), run.pieces))
    if not any(one.source_id for one in pieces):
        raise InputError(
            fill("{path} holds no Source ID, by which a piece is found in the model. Import the workbook from the "
                 "model, or fill in Source ID in Items with GlobalIds, and run assess again.", path=run.path)
        )  # fmt: skip
    routes, schedule = record.part("routes"), record.part("schedule")
    places = {one.item: at for at, one in enumerate(pieces)}
    return ExportRun(
        run=run,
        language=str(record.part("assess").values.get("language") or ""),
        pieces=pieces,
        entries=tuple(_read_entry(row, places) for row in schedule.rows("entries")),
        segments=tuple(_read_segments(routes)),
        steps=tuple(_read_steps(routes, {key(item): at for item, at in places.items()})),
    )


def _read_piece(row: Part, past: PastPiece) -> ExportPiece:
    def text(name: str) -> str:
        return "" if row.values.get(name) is None else row.text(name)

    adopted, toward = row.part("adopted"), _number(row, "falls_toward_deg")
    return ExportPiece(
        **{one.name: getattr(past, one.name) for one in fields(past)},
        source_id=text("source_id").strip(),
        upper=adopted.risk("class_upper"),
        has_simulated=adopted.values.get("method") is not None and adopted.text("method") == simulation().key,
        importance=text("importance"),
        pfa_source=text("pfa_source"),
        place=_point(row, "x_m", "y_m"),
        faces=_number(row, "angle_deg") if toward is None else toward,
        falls_one_way=toward is not None,
    )


def _number(row: Part, name: str) -> float | None:
    value = row.values.get(name)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e9 else None  # type: ignore[arg-type]


def _point(row: Part, *names: str) -> Point | None:
    x, y = (_number(row, name) for name in names)
    return None if x is None or y is None else (x, y)


_READ = {"int": Part.count, "float": Part.number, "str": Part.text}


def _read_plain(kind: type, row: Part, other: set[str]) -> dict[str, Any]:
    """Return the numbers and texts of a row of the schedule, but for `other` fields."""
    wanted = {one.name: getattr(one.type, "__name__", "") for one in fields(kind) if one.name not in other}
    return {name: _READ[type_](row, name) for name, type_ in wanted.items() if type_ in _READ}


def _read_entry(row: Part, known: Mapping[str, int]) -> ScheduleRow:
    works = tuple(_read_work(work, known) for work in row.rows("works"))
    return ScheduleRow(
        **_read_plain(ScheduleRow, row, set()),
        item_indices=tuple(at for work in works for at in work.item_indices),
        is_together=row.values.get("only_together") is True,
        works=works,
    )


def _read_work(row: Part, known: Mapping[str, int]) -> WorkRow:
    """Return a part of an entry, without its costs; pieces that the results do not hold are left out."""
    items = tuple(one for one in row.list_texts("items") if one in known)
    has_code = row.values.get("tension_code_kn") is not None
    return WorkRow(
        **_read_plain(WorkRow, row, {"detail", "cost_source"}),
        items=items,
        item_indices=tuple(known[one] for one in items),
        detail=row.choice("detail", tuple(DETAILS)),
        tension_code_kn=row.number("tension_code_kn") if has_code else None,
        is_per_metre=row.values.get("is_per_metre") is True,
        unit_cost=None,
        cost=None,
        cost_source="",
    )


def _read_segments(routes: Part) -> Iterator[ExportSegment]:
    for row in routes.rows("segments"):
        is_open = row.text("state") == RouteState.OPEN
        items = frozenset(
            one.text("item") for one in row.rows("pieces") if not is_open or one.values.get("blocks_alone") is True
        )
        if items:
            start, end = (_point(row, f"{side}_x_m", f"{side}_y_m") for side in ("start", "end"))
            ends = None if start is None or end is None else (start, end)
            yield ExportSegment(route=row.text("route"), ends=ends, items=items)


def _read_steps(routes: Part, index: Mapping[str, int]) -> Iterator[RouteStep]:
    """Yield what to fix for every route, as `assess.report.say.work.list_steps` does of results."""
    for row in routes.rows("routes"):
        route, fixes = row.text("route"), row.rows("fixes")
        left = [one.share("left") for one in fixes]
        for number, one in enumerate(fixes):
            known = index.get(key(one.text("item")))
            if known is not None:
                before = left[number] + one.share("gain")
                is_bound = row.values.get("blocked_if_unconfirmed_fall") is not None
                yield RouteStep(route, known, number + 1, len(fixes), before, left[number], left[-1], is_bound)
