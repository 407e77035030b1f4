"""What an export takes from results.json: its pieces with their identifiers, its schedule, and what obstructs routes.

The file is read and checked as `assess compare` does it, and further values by the same reader.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from assess.compare.past_run import PastPiece, PastRun
from assess.compare.read_results import Reader, read_record
from assess.details import DETAILS
from assess.errors import InputError
from assess.i18n import fill
from assess.methods import simulation
from assess.report.say.work import RouteStep
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.schedule_results import ScheduleRow, WorkRow
from assess.workbook.names import key

_CLASSES = {risk.word: risk for risk in RiskClass}
Point = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportPiece:
    """A piece of the results.

    Attributes
    ----------
    past : PastPiece
        What `assess compare` reads of it.
    source_id : str
        Its identifier in the model, "" where it has none.
    upper : RiskClass
        Its class, upper estimate.
    has_simulated : bool
        Whether its chance is that of a simulation, be it confirmed or not.
    importance : str
        "" where none is given.
    pfa_source : str
        Where its PFA comes from.
    place : Point, optional
        Centre of its plan in the axes of the workbook [m].
    faces : float, optional
        Direction in which it falls, or may fall, anticlockwise from X [deg].
    falls_one_way : bool
        Whether it falls in that direction alone, away from a wall.
    """

    past: PastPiece
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

    @cached_property
    def routes(self) -> dict[str, list[str]]:
        """The routes that each piece may block, by its name."""
        found: dict[str, dict[str, None]] = {}
        for one in self.segments:
            for item in one.items:
                found.setdefault(item, {})[one.route] = None
        return {item: list(routes) for item, routes in found.items()}


def list_items(entry: ScheduleRow) -> list[str]:
    """Return the names of the pieces of an entry, the most urgent first."""
    return [name for work in entry.works for name in work.items]


def read_export(path: Path) -> ExportRun:
    """Read results.json for an export.

    Raises InputError if it cannot be read (see `assess.compare.read_results.read_run`), or holds no identifier of any
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
    routes = reader.part(record, "routes", "")
    schedule = reader.part(record, "schedule", "")
    places = {one.past.item: at for at, one in enumerate(pieces)}
    return ExportRun(
        run=run,
        language=str(reader.part(record, "assess", "").get("language") or ""),
        pieces=pieces,
        entries=tuple(
            _read_entry(reader, row, f"schedule.entries[{at}]", places)
            for at, row in enumerate(reader.rows(schedule, "entries", "schedule"))
        ),
        segments=tuple(_read_segments(reader, routes)),
        steps=tuple(_read_steps(reader, routes, pieces)),
    )


def _read_piece(reader: Reader, row: Mapping[str, Any], past: PastPiece, place: str) -> ExportPiece:
    adopted, inside = reader.part(row, "adopted", place), f"{place}.adopted"
    toward, breadth = _number(row, "falls_toward_deg"), _number(row, "angle_deg")
    x, y = _number(row, "x_m"), _number(row, "y_m")
    return ExportPiece(
        past=past,
        source_id=_text(reader, row, "source_id", place).strip(),
        upper=_CLASSES[reader.choice(adopted, "class_upper", inside, tuple(_CLASSES))],
        has_simulated=_text(reader, adopted, "method", inside) == simulation().key,
        importance=_text(reader, row, "importance", place),
        pfa_source=_text(reader, row, "pfa_source", place),
        place=None if x is None or y is None else (x, y),
        faces=breadth if toward is None else toward,
        falls_one_way=toward is not None,
    )


def _text(reader: Reader, row: Mapping[str, Any], name: str, place: str) -> str:
    return "" if row.get(name) is None else reader.text(row, name, place)


def _number(row: Mapping[str, Any], name: str) -> float | None:
    value = row.get(name)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e9 else None  # type: ignore[arg-type]


def _read_entry(reader: Reader, row: Mapping[str, Any], place: str, known: Mapping[str, int]) -> ScheduleRow:
    works = tuple(
        _read_work(reader, work, f"{place}.works[{at}]", known)
        for at, work in enumerate(reader.rows(row, "works", place))
    )
    return ScheduleRow(
        place=reader.count(row, "place", place),
        floor=reader.text(row, "floor", place),
        room=reader.text(row, "room", place),
        item_indices=tuple(at for work in works for at in work.item_indices),
        pieces=reader.count(row, "pieces", place),
        is_together=row.get("only_together") is True,
        works=works,
        falls_avoided=reader.number(row, "falls_avoided", place),
        falls_left=reader.number(row, "falls_left", place),
    )


def _read_work(reader: Reader, row: Mapping[str, Any], place: str, known: Mapping[str, int]) -> WorkRow:
    """Return a part of an entry, without its costs; pieces that the results do not hold are left out."""
    items = tuple(one for one in reader.list_texts(row, "items", place) if one in known)
    has_code = row.get("tension_code_kn") is not None
    return WorkRow(
        floor=reader.text(row, "floor", place),
        room=reader.text(row, "room", place),
        items=items,
        item_indices=tuple(known[one] for one in items),
        pieces=reader.count(row, "pieces", place),
        detail=reader.choice(row, "detail", place, tuple(DETAILS)),
        tension_kn=reader.number(row, "tension_kn", place),
        tension_high_kn=reader.number(row, "tension_high_kn", place),
        tension_code_kn=reader.number(row, "tension_code_kn", place) if has_code else None,
        shear_kn=reader.number(row, "shear_kn", place),
        fixings=reader.count(row, "fixings", place),
        weights_assumed=reader.count(row, "weights_assumed", place),
        heights_assumed=reader.count(row, "heights_assumed", place),
        is_per_metre=row.get("is_per_metre") is True,
        unit_cost=None,
        cost=None,
        cost_source="",
    )


def _read_segments(reader: Reader, routes: Mapping[str, Any]) -> Sequence[ExportSegment]:
    found = []
    for at, row in enumerate(reader.rows(routes, "segments", "routes")):
        place = f"routes.segments[{at}]"
        is_open = reader.text(row, "state", place) == RouteState.OPEN
        beside = reader.rows(row, "pieces", place)
        items = frozenset(
            reader.text(one, "item", f"{place}.pieces[{number}]")
            for number, one in enumerate(beside)
            if not is_open or one.get("blocks_alone") is True
        )
        if items:
            found.append(ExportSegment(route=reader.text(row, "route", place), ends=_read_ends(row), items=items))
    return found


def _read_ends(row: Mapping[str, Any]) -> tuple[Point, Point] | None:
    x1, y1, x2, y2 = (_number(row, name) for name in ("start_x_m", "start_y_m", "end_x_m", "end_y_m"))
    return None if x1 is None or y1 is None or x2 is None or y2 is None else ((x1, y1), (x2, y2))


def _read_steps(reader: Reader, routes: Mapping[str, Any], pieces: Sequence[ExportPiece]) -> Sequence[RouteStep]:
    """Return what to fix for every route, as `assess.report.say.work.list_steps` does of results."""
    index = {key(one.past.item): at for at, one in enumerate(pieces)}
    found = []
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
                found.append(RouteStep(route, known, number + 1, len(fixes), before, left[number], left[-1], is_bound))
    return found
