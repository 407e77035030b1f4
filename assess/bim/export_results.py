"""The results of a run as an export takes them from results.json, and what it says of them in the report's words.

Taken are pieces with their identifiers, the schedule, and what obstructs routes. The file is read and checked as
`assess compare` does it, and further values by the same reader.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from assess.compare.past_run import UNCONFIRMED, Part, PastPiece, PastRun, read_record
from assess.details import DETAILS
from assess.errors import InputError
from assess.i18n import fill, gettext as _, ngettext
from assess.intensity import SHAKINGS
from assess.methods import simulation
from assess.report import words
from assess.report.say.work import CHECKS, HOLDS, NAMED, RouteStep, join_names, say_effect, say_force, shorten_names
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass, classify
from assess.route_results import RouteState
from assess.schedule_results import ScheduleRow, WorkRow
from assess.settings import SCENARIOS
from assess.workbook.names import key

LONGEST = 60  # characters of a description that a title shows
MOST_KINDS = 3  # kinds of pieces that a title names; the rest are counted
MOST_CHANCES = 20  # pieces of a topic whose chances its description lists; the Excel report holds all

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
    """A segment that is not open, or that one piece alone would block: its ends [m], and pieces that reach into it."""

    route: str
    ends: tuple[Point, Point] | None
    items: frozenset[str]


@dataclass(frozen=True, kw_only=True)
class ExportRun:
    """The results of a run; `steps` are what to fix for its routes, `item_index` of which is a place in `pieces`."""

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
    """Read the results of a run; InputError as `read_run` raises it, or if they hold no identifier of any piece."""
    run, record = read_record(path)
    pieces = tuple(map(_read_piece, record.rows("items"), run.pieces))
    if not any(one.source_id for one in pieces):
        raise InputError(
            fill("{path} holds no Source ID, by which a piece is found in the model. Import the workbook from the "
                 "model, or fill in Source ID in Items with GlobalIds, and run assess again.", path=run.path)
        )  # fmt: skip
    routes, schedule = record.part("routes"), record.part("schedule")
    places = {one.item: at for at, one in enumerate(pieces)}
    entries = tuple(_read_entry(row, places) for row in schedule.rows("entries"))
    segments = []
    for row in routes.rows("segments"):
        is_open = row.text("state") == RouteState.OPEN
        items = frozenset(
            one.text("item") for one in row.rows("pieces") if not is_open or one.values.get("blocks_alone") is True
        )
        if items:
            start, end = (_point(row, f"{side}_x_m", f"{side}_y_m") for side in ("start", "end"))
            ends = None if start is None or end is None else (start, end)
            segments.append(ExportSegment(route=row.text("route"), ends=ends, items=items))
    # what to fix for every route, as `assess.report.say.work.list_steps` lists it of results
    steps, at_key = [], {key(item): at for item, at in places.items()}
    for row in routes.rows("routes"):
        route, fixes = row.text("route"), row.rows("fixes")
        is_bound = row.values.get("blocked_if_unconfirmed_fall") is not None
        left = [one.share("left") for one in fixes]
        for number, one in enumerate(fixes):
            known = at_key.get(key(one.text("item")))
            if known is not None:
                before = left[number] + one.share("gain")
                steps.append(RouteStep(route, known, number + 1, len(fixes), before, left[number], left[-1], is_bound))
    return ExportRun(
        run=run,
        language=str(record.part("assess").values.get("language") or ""),
        pieces=pieces,
        entries=entries,
        segments=tuple(segments),
        steps=tuple(steps),
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
    """Return an entry, without its costs; pieces that the results do not hold are left out."""
    works = []
    for work in row.rows("works"):
        items = tuple(one for one in work.list_texts("items") if one in known)
        has_code = work.values.get("tension_code_kn") is not None
        works.append(
            WorkRow(
                **_read_plain(WorkRow, work, {"detail", "like", "hours", "cost_source"}), items=items,
                item_indices=tuple(known[one] for one in items), detail=work.choice("detail", tuple(DETAILS)),
                like=work.choice("like" if "like" in work.values else "detail", tuple(DETAILS)), hours=0.0,
                tension_code_kn=work.number("tension_code_kn") if has_code else None,
                is_per_metre=work.values.get("is_per_metre") is True, unit_cost=None, cost=None, cost_source="",
            )
        )  # fmt: skip
    return ScheduleRow(
        **_read_plain(ScheduleRow, row, {"phase", "falls_at_most"}),
        phase=str(row.values.get("phase", "A")),
        falls_at_most=0.0,
        item_indices=tuple(at for work in works for at in work.item_indices),
        is_together=row.values.get("only_together") is True,
        works=tuple(works),
    )


# ---------------------------------------------------------------- in words


def describe_risk(run: PastRun, pieces: Sequence[ExportPiece]) -> str:
    """Return the highest class of some pieces in words, with what any of them could be, and why it is no lower."""
    highest = max(pieces, key=lambda one: one.risk)
    return describe_class(run, highest, max(one.upper for one in pieces), is_short=False)


def describe_class(run: PastRun, one: ExportPiece, upper: RiskClass, *, is_short: bool) -> str:
    """Return the class of a piece in words, with what it could be; of one outside the classes, on what it rests."""
    apart = "" if one.basis in (run.main_basis, CANNOT_ROCK) else one.basis
    is_by_faster = one.basis == UNCONFIRMED and one.has_simulated  # nothing is known of the building
    notes = [words.say_apart(one.risk, apart, has_simulated=one.has_simulated) or words.risk_word(one.risk)]
    if not (is_short or is_by_faster) and classify(one.chance.probability) != one.risk:
        notes.append(_("as it overturns under the record itself"))
    if upper > one.risk:
        notes.append(words.could_be(words.risk_word(upper)))
    return words.join_notes(notes, is_anchored=one.is_held)


def describe(one: ExportPiece) -> str:
    """Return what a piece is."""
    return one.description or str(one.inputs.get("type") or "") or _("no description")


def list_routes(found: ExportRun, items: Sequence[str]) -> list[str]:
    """Return the routes that any of some pieces may block."""
    wanted = set(items)
    return list(dict.fromkeys(one.route for one in found.segments if one.items & wanted))


def describe_scenario(run: PastRun) -> str:
    """Return the earthquake in words, and where the floor motion comes from."""
    building, settings = run.building, run.settings
    kind = str(settings.get("scenario") or building.get("scenario_kind") or "")
    choice = next((one.choice for one in SHAKINGS.values() if one.name == run.shaking), run.shaking)
    parts = [
        str(building.get("scenario") or ""),
        _("{intensity} (assumed)", intensity=_(choice)) if choice else "",
        run.site_ground,
        "" if kind == SCENARIOS[0] else kind,  # as filled in
    ]
    pga, scale = building.get("ground_pga_g"), settings.get("scale")
    if isinstance(pga, int | float):
        parts.append(_("ground PGA {pga} g", pga=words.in_g(pga)))
    if isinstance(scale, int | float) and scale != 1:
        parts.append(_("motions times {scale:g}", scale=scale))
    return "; ".join(dict.fromkeys(part for part in parts if part)) or _("floor motions of the workbook")


def describe_report(run: PastRun) -> str:
    """Return what names the report: building, revision, date, and the hash of its results."""
    building = run.building
    parts = [run.name, run.workbook]
    if building.get("revision"):
        parts.append(_("revision {revision}", revision=building["revision"]))
    parts += [str(building.get("report_date") or ""), f"{run.path.name} SHA-256 {run.sha256[:16]}"]
    return ", ".join(part for part in parts if part)


def name_program(run: PastRun) -> str:
    """Return the program that assessed it, with its version."""
    return f"assess {run.version}"


def write_title(found: ExportRun, entry: ScheduleRow, pieces: Sequence[ExportPiece]) -> str:
    """Return the title of the topic of an entry: class, pieces, and why they are to be fixed."""
    routes = list_routes(found, list_items(entry))
    values = {"risk": describe_risk(found.run, pieces), "names": _name_with_kind(entry, pieces)}
    if routes:
        text = ngettext(
            "{risk}: {names} may overturn and block route {routes}",
            "{risk}: {names} may overturn and block routes {routes}",
            len(routes), routes=words.name_first([words.cut(one, LONGEST) for one in routes], NAMED), **values,
        )  # fmt: skip
    else:
        text = _("{risk}: {names} may overturn", **values)
    return ", ".join((text, *map(_, list_importance(pieces))))


def _name_with_kind(entry: ScheduleRow, pieces: Sequence[ExportPiece]) -> str:
    names = join_names(shorten_names(one.item for one in pieces))
    kind = words.name_first(list(dict.fromkeys(words.cut(describe(one), LONGEST) for one in pieces)), MOST_KINDS, "; ")
    names = _("{names} together", names=names) if entry.is_together else names
    return names if kind == names else f"{names} ({kind})"


def list_importance(pieces: Sequence[ExportPiece]) -> list[str]:
    """Return the importance of some pieces, each once."""
    return list(dict.fromkeys(one.importance for one in pieces if one.importance))


def list_lines(found: ExportRun, entry: ScheduleRow, pieces: Sequence[ExportPiece]) -> Iterator[str]:
    """Yield the lines of the description of a topic: where, how likely, why, how to fix it, with what force."""
    run = found.run
    where = _("Floor {floor}, room {room}.", floor=entry.floor, room=entry.room or words.DASH)
    yield f"{_name_with_kind(entry, pieces)}: {words.plural(entry.pieces, 'piece')}. {where}"
    yield _("Risk of overturning: {risk}.", risk=describe_risk(run, pieces))
    are_alike = len(set(map(describe, pieces))) == 1
    for one in pieces[:MOST_CHANCES]:
        item, kind, pfa, chance = one.item, describe(one), one.inputs.get("pfa_g"), one.chance
        said = f"{words.say_chance(chance.probability, chance.low, chance.high)}, {_(words.BASES[one.basis])}"
        yield _("{item}: chance of overturning {chance}; PFA {pfa} g ({source}).",
                item=item if are_alike or kind == item else f"{item} ({kind})", chance=said,
                pfa=words.in_g(float(pfa)) if isinstance(pfa, int | float) else words.DASH,
                source=one.pfa_source or words.DASH)  # fmt: skip
    yield _("Earthquake: {scenario}. The chance is for this earthquake, not per year.",
            scenario=describe_scenario(run))  # fmt: skip
    # its importance, its routes, and the effect of fixing it on them
    steps: dict[str, list[RouteStep]] = {}
    for step in sorted(found.steps, key=lambda step: (step.route, step.place)):
        if step.item_index in entry.item_indices:
            steps.setdefault(step.route, []).append(step)
    others = [words.cut(one, LONGEST) for one in list_routes(found, list_items(entry)) if one not in steps]
    reasons = [*map(_, list_importance(pieces)), *map(say_effect, steps.values())]
    if others:
        named = words.name_first(others, NAMED)
        reasons.append(ngettext("route {routes}", "routes {routes}", len(others), routes=named))
    if reasons:
        yield _("Why it comes here: {reason}.", reason=", ".join(reasons))
    if entry.is_together:
        yield _("Fix all of these pieces: fixing only some of them opens no route.")
    for work in entry.works:
        yield from _list_work(work, is_only=len(entry.works) == 1)
    for detail in dict.fromkeys(work.detail for work in entry.works):
        known = DETAILS[detail]
        title = _capital(_(known.title))
        yield _("{title}: {what}. One fixing is: {fixing}.", title=title, what=_(known.what), fixing=_(known.fixing))
        yield _("Known against it: {weakness} ({source}).", weakness=_(known.weakness), source=_(known.source))
    yield _(CHECKS)
    yield _("Entry {place:,} of {n:,} of the schedule. {report}; {program}.", place=entry.place,
            n=len(found.entries), report=describe_report(run), program=name_program(run))  # fmt: skip


def _list_work(work: WorkRow, *, is_only: bool) -> Iterator[str]:
    title = _(DETAILS[work.detail].title)
    named = "" if is_only else f"{join_names(shorten_names(work.items))}: "
    least = _("at least {n}, as no capacity is printed", n=work.fixings) if work.is_least else f"{work.fixings:,}"
    yield _("{names}How to fix: {title}. Fixings of each piece: {fixings}.", names=named, title=title, fixings=least)
    lines = [_("Force on the fixings of each piece: tension {pfa} kN at PFA, {high} kN at 84 % of PFA; shear at the "
               "base {shear} kN.", pfa=say_force(work.tension_kn), high=say_force(work.tension_high_kn),
               shear=say_force(work.shear_kn))]  # fmt: skip
    if work.tension_code_kn is not None:
        lines.append(_("Tension by the code: {code} kN.", code=say_force(work.tension_code_kn)))
    if work.tension_high_kn == 0:
        lines.append(f"{_capital(_(HOLDS))}.")
    if work.is_per_metre:
        lines.append(_("Forces and fixings are per metre of width, as the width is not known."))
    if work.weights_assumed:
        lines.append(_("The weight is assumed."))
    if work.heights_assumed:
        lines.append(_("The height of the bracket is assumed: 0.9 of the piece's height."))
    yield " ".join(lines)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
