"""What an export takes from results.json: its pieces with their identifiers, its schedule, and what obstructs routes.

The file is read and checked as `assess compare` does it, and further values by the same reader.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from assess.compare.past_run import CLASSES, PastPiece, PastRun, Reader, read_record
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
    run, record, reader = read_record(path)
    rows = reader.rows(record, "items", "")
    pieces = tuple(
        _read_piece(reader, row, past, f"items[{at}]")
        for at, (row, past) in enumerate(zip(rows, run.pieces, strict=True))
    )
    if not any(one.source_id for one in pieces):
        raise InputError(
            fill("{path} holds no Source ID, by which a piece is found in the model. Import the workbook from the "
                 "model, or fill in Source ID in Items with GlobalIds, and run assess again.", path=run.path)
        )  # fmt: skip
    routes, schedule = (reader.part(record, name, "") for name in ("routes", "schedule"))
    places = {one.item: at for at, one in enumerate(pieces)}
    return ExportRun(
        run=run,
        language=str(reader.part(record, "assess", "").get("language") or ""),
        pieces=pieces,
        entries=tuple(
            _read_entry(reader, row, f"schedule.entries[{at}]", places)
            for at, row in enumerate(reader.rows(schedule, "entries", "schedule"))
        ),
        segments=tuple(_read_segments(reader, routes)),
        steps=tuple(_read_steps(reader, routes, {key(item): at for item, at in places.items()})),
    )


def _read_piece(reader: Reader, row: Mapping[str, Any], past: PastPiece, place: str) -> ExportPiece:
    def text(name: str) -> str:
        return "" if row.get(name) is None else reader.text(row, name, place)

    adopted, inside = reader.part(row, "adopted", place), f"{place}.adopted"
    toward = _number(row, "falls_toward_deg")
    return ExportPiece(
        **{one.name: getattr(past, one.name) for one in fields(past)},
        source_id=text("source_id").strip(),
        upper=CLASSES[reader.choice(adopted, "class_upper", inside, [risk.word for risk in RiskClass])],
        has_simulated=adopted.get("method") is not None and reader.text(adopted, "method", inside) == simulation().key,
        importance=text("importance"),
        pfa_source=text("pfa_source"),
        place=_point(row, "x_m", "y_m"),
        faces=_number(row, "angle_deg") if toward is None else toward,
        falls_one_way=toward is not None,
    )


def _number(row: Mapping[str, Any], name: str) -> float | None:
    value = row.get(name)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e9 else None  # type: ignore[arg-type]


def _point(row: Mapping[str, Any], *names: str) -> Point | None:
    x, y = (_number(row, name) for name in names)
    return None if x is None or y is None else (x, y)


_READ = {"int": Reader.count, "float": Reader.number, "str": Reader.text}


def _read_plain(reader: Reader, kind: type, row: Mapping[str, Any], place: str, other: set[str]) -> dict[str, Any]:
    """Return the numbers and texts of a row of the schedule, but for `other` fields."""
    wanted = {one.name: getattr(one.type, "__name__", "") for one in fields(kind) if one.name not in other}
    return {name: _READ[type_](reader, row, name, place) for name, type_ in wanted.items() if type_ in _READ}


def _read_entry(reader: Reader, row: Mapping[str, Any], place: str, known: Mapping[str, int]) -> ScheduleRow:
    works = tuple(
        _read_work(reader, work, f"{place}.works[{at}]", known)
        for at, work in enumerate(reader.rows(row, "works", place))
    )
    return ScheduleRow(
        **_read_plain(reader, ScheduleRow, row, place, set()),
        item_indices=tuple(at for work in works for at in work.item_indices),
        is_together=row.get("only_together") is True,
        works=works,
    )


def _read_work(reader: Reader, row: Mapping[str, Any], place: str, known: Mapping[str, int]) -> WorkRow:
    """Return a part of an entry, without its costs; pieces that the results do not hold are left out."""
    items = tuple(one for one in reader.list_texts(row, "items", place) if one in known)
    has_code = row.get("tension_code_kn") is not None
    return WorkRow(
        **_read_plain(reader, WorkRow, row, place, {"detail", "cost_source"}),
        items=items,
        item_indices=tuple(known[one] for one in items),
        detail=reader.choice(row, "detail", place, tuple(DETAILS)),
        tension_code_kn=reader.number(row, "tension_code_kn", place) if has_code else None,
        is_per_metre=row.get("is_per_metre") is True,
        unit_cost=None,
        cost=None,
        cost_source="",
    )


def _read_segments(reader: Reader, routes: Mapping[str, Any]) -> Iterator[ExportSegment]:
    for at, row in enumerate(reader.rows(routes, "segments", "routes")):
        place = f"routes.segments[{at}]"
        is_open = reader.text(row, "state", place) == RouteState.OPEN
        items = frozenset(
            reader.text(one, "item", f"{place}.pieces[{number}]")
            for number, one in enumerate(reader.rows(row, "pieces", place))
            if not is_open or one.get("blocks_alone") is True
        )
        if items:
            start, end = (_point(row, f"{side}_x_m", f"{side}_y_m") for side in ("start", "end"))
            ends = None if start is None or end is None else (start, end)
            yield ExportSegment(route=reader.text(row, "route", place), ends=ends, items=items)


def _read_steps(reader: Reader, routes: Mapping[str, Any], index: Mapping[str, int]) -> Iterator[RouteStep]:
    """Yield what to fix for every route, as `assess.report.say.work.list_steps` does of results."""
    for at, row in enumerate(reader.rows(routes, "routes", "routes")):
        place = f"routes.routes[{at}]"
        route, fixes = reader.text(row, "route", place), reader.rows(row, "fixes", place)
        left = [reader.share(one, "left", f"{place}.fixes[{number}]") for number, one in enumerate(fixes)]
        for number, one in enumerate(fixes):
            inside = f"{place}.fixes[{number}]"
            known = index.get(key(reader.text(one, "item", inside)))
            if known is not None:
                before = left[number] + reader.share(one, "gain", inside)
                is_bound = row.get("blocked_if_unconfirmed_fall") is not None
                yield RouteStep(route, known, number + 1, len(fixes), before, left[number], left[-1], is_bound)
