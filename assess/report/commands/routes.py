"""How likely each route is blocked against the PFA on its floors, for `assess routes`: document, text, table."""

import csv
import io
import json
import math
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from assess.errors import InputError
from assess.report import words
from assess.report.commands.records import check_figure, save_figure
from assess.report.findings.routes import say_basis
from assess.report.provenance import versions
from assess.report.table import disarm
from assess.results import Assessment
from assess.routes.fragility import JUMP, Fragility, RouteFragility, find_passing
from assess.routes.model import Chance
from assess.units import GRAVITY
from assess.version import __version__

LEVELS = (0.03, 0.3, 0.5)
"""Chances of blockage whose PFA is told [-]."""
A_LINE = 12
"""Values side by side in the text."""
WIDE = 110
"""Characters of a line of its sentences."""
HEADS = (
    "route", "floors", "pfa_g", "blocked", "low", "high", "independent", "correlated", "if_anchors_fail", "pieces",
    "unverified", "runs",
)  # fmt: skip
MEANING = (
    "Chance that each evacuation route is blocked, if every floor of it shakes with the PFA along both axes; not per "
    "year.",
    "The motions are the floor's own, each scaled by value / the floor's PFA: the same ones at every value, so that "
    "each is one earthquake. The spectrum keeps its shape, PFV scales along; the mean of their peaks is about the "
    "value.",
    "Rocking is not monotone: a stronger motion may spare a piece that a weaker one overturns. Sliding, castors and "
    "spilt contents are not counted.",
    "Where not all pieces were rocked together, the chance is the largest of three ways of falling together, and its "
    "range spans them; else the range is the 95 % interval of the number of motions.",
    "Where a chance reaches a level is read on straight lines between the values; where it jumps by more than "
    f"{100 * JUMP:g} percentage points from one to the next, only these two are told (between_g, without pfa_g).",
)
FINER = "Take smaller steps for those that lie between two values: --pfa LOW:HIGH:STEP"


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """What `assess routes` found."""

    assessment: Assessment
    fragility: Fragility

    @property
    def pfa_g(self) -> list[float]:
        """The values of PFA [g], as they were typed."""
        return [_in_g(value) for value in self.fragility.values]

    def cautions(self) -> Iterator[str]:
        """Yield what must be known to read the chances."""
        if floors := self.fragility.generic:
            named = words.name_first([repr(words.cut(floor, 20)) for floor in floors], 8)
            yield (
                f"Only peaks are known of {'floor' if len(floors) == 1 else 'floors'} {named}: the motions follow a "
                "generic spectrum. Where the formula gives a piece a higher class, assess run keeps it there, so its "
                "chances may be larger than these."
            )
        if count := self.fragility.stocky:
            yield (
                f"{words.plural(count, 'piece')} beside routes too stocky to rock (B/H of 1.41 or more): taken to fall "
                "by the formula's chance at each PFA, by bounds."
            )

    def describe(self) -> dict[str, Any]:
        """Return the document of `assess routes --json`."""
        inventory, fragility = self.assessment.inventory, self.fragility
        return {
            "workbook": {"file": inventory.source.name, "sha256": inventory.sha256},
            "assess": {"version": __version__, "platform": dict(versions(has_rocked=True, has_routes=True))},
            "meaning": " ".join(MEANING),
            "cautions": list(self.cautions()),
            "scenario": self.assessment.scenario,
            "runs": fragility.runs,
            "seed": fragility.seed,
            "pfa_g": self.pfa_g,
            "routes": [self._describe(route) for route in fragility.routes],
        }

    def _describe(self, one: RouteFragility) -> dict[str, Any]:
        anchored = one.if_anchors_fail or (None,) * len(one.blocked)
        pairs = zip(self.pfa_g, one.blocked, anchored, strict=True)
        peaks = one.scenario_pfa
        return {
            "route": one.route,
            "floors": list(one.floors),
            "scenario_pfa_g": None if peaks is None else [_in_g(peak) for peak in peaks],
            "evaluated": one.is_evaluated,
            "chances": [{"pfa_g": pfa, **_chance(chance, fails)} for pfa, chance, fails in pairs if one.is_evaluated],
            "passes": [self._pass(one.blocked, level) for level in LEVELS if one.is_evaluated],
            "passes_if_anchors_fail": one.if_anchors_fail
            and [self._pass(one.if_anchors_fail, level) for level in LEVELS],
        }

    def _pass(self, chances: Sequence[Chance], level: float) -> dict[str, Any]:
        found = self._passing(chances, level)
        sides = {-math.inf: "below", math.inf: "above"}
        return {
            "chance": level,
            "where": sides.get(found.low, "between"),
            "pfa_g": None if found.is_jump else _finite(found.low),
            "between_g": [found.low, found.high] if found.is_jump else None,
            "earliest_g": _finite(found.earliest),
            "latest_g": _finite(found.latest),
        }

    def _passing(self, chances: Sequence[Chance], level: float) -> "_Passing":
        ways = [[getattr(chance, end) for chance in chances] for end in ("probability", "high", "low")]
        (low, high), first, last = (find_passing(self.pfa_g, way, level) for way in ways)
        return _Passing(low, high, min(low, first[0]), max(high, last[1]))

    def to_json(self) -> str:
        """Return the document as text."""
        return json.dumps(self.describe(), ensure_ascii=False, indent=1)

    def to_csv(self) -> str:
        """Return a line a route and value, for other programs."""
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\r\n")
        writer.writerow(HEADS)
        for one in self.describe()["routes"]:
            if not one["evaluated"]:
                writer.writerow([disarm(one["route"]), disarm(one["floors"]), *[None] * (len(HEADS) - 2)])
            for at in one["chances"]:
                fails = at["if_anchors_fail"]
                row = at | {"route": disarm(one["route"]), "floors": disarm(one["floors"])}
                row["if_anchors_fail"] = fails and fails["blocked"]
                writer.writerow([row[name] for name in HEADS])
        return file.getvalue()

    def to_text(self) -> str:
        """Return what a person reads."""
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        for paragraph in (*MEANING, *self.cautions()):
            yield from textwrap.wrap(paragraph, WIDE)
        fragility = self.fragility
        yield (
            f"{self.assessment.inventory.source.name}: scenario {self.assessment.scenario}, "
            f"{words.plural(fragility.runs, 'motion')} of each floor and axis, seed {fragility.seed}"
        )
        for one in fragility.routes:
            yield ""
            yield from self._route_lines(one)
        every = [way for one in fragility.routes for way in (one.blocked, one.if_anchors_fail) if way]
        if any(self._passing(way, level).is_jump for way in every for level in LEVELS):
            yield from ("", FINER)

    def _route_lines(self, one: RouteFragility) -> Iterator[str]:
        first, floors = one.blocked[0], ", ".join(one.floors)
        where = f" (floor{'' if len(one.floors) == 1 else 's'} {words.cut(floors, 60)})" if floors else ""
        rows = {"PFA [g]": [f"{pfa:g}" for pfa in self.pfa_g]}
        if first.pieces:
            rows |= {
                "chance [%]": [words.in_percent(chance.probability) for chance in one.blocked],
                "  from": [words.in_percent(chance.low) for chance in one.blocked],
                "  to": [words.in_percent(chance.high) for chance in one.blocked],
            }
        if one.if_anchors_fail:
            rows["if anchors fail"] = [words.in_percent(chance.probability) for chance in one.if_anchors_fail]
        yield f"{words.cut(one.route, 60)}{where}: {_say_pieces(one)}"
        yield from _grid(rows) if len(rows) > 1 else ()
        if first.pieces:
            yield f"  reaches {self._say_levels(one.blocked)}"
        if one.if_anchors_fail:
            yield f"  if anchors fail, {self._say_levels(one.if_anchors_fail)}"

    def _say_levels(self, chances: Sequence[Chance]) -> str:
        return "; ".join(self._say_passing(chances, level) for level in LEVELS)

    def _say_passing(self, chances: Sequence[Chance], level: float) -> str:
        found = self._passing(chances, level)
        low, high, first, last = (_say_pfa(one, self.pfa_g) for one in astuple(found))
        spread = "" if first == last or (first, last) == (low, high) else f" ({first} to {last})"
        at = f"between {low} and {high}" if found.is_jump else f"at {low}" if math.isfinite(found.low) else low
        return f"{100 * level:g} % {at} g{spread}"


@dataclass(frozen=True, slots=True)
class _Passing:
    """Between which PFA a chance reaches a level, and the earliest and latest by the ends of its range [g]."""

    low: float
    high: float
    earliest: float
    latest: float

    @property
    def is_jump(self) -> bool:
        return self.low < self.high


def _say_pieces(one: RouteFragility) -> str:
    first = one.blocked[0]
    if not one.is_evaluated:
        return "not evaluated: nothing tells what can reach it"
    if first.pieces:
        return f"{words.plural(first.pieces, 'piece')}; {say_basis(first)}"
    if first.probability > 0:
        return "blocked as it stands"
    return (
        "0 %: no piece reaches it" if one.if_anchors_fail is None else "0 % if anchors hold: no other piece reaches it"
    )


def _say_pfa(value: float, values: Sequence[float]) -> str:
    """Return a PFA [g], or on which side of the values it lies; one of the values as it was typed."""
    if math.isfinite(value):
        return f"{value:g}" if value in values else f"{value:.2f}"
    return f"below {values[0]:g}" if value < 0 else f"above {values[-1]:g}"


def _grid(rows: dict[str, list[str]]) -> Iterator[str]:
    wide, count = 1 + max(len(text) for row in rows.values() for text in row), len(next(iter(rows.values())))
    for start in range(0, count, A_LINE):
        for label, row in rows.items():
            yield f"  {label:<16}" + "".join(f"{text:>{wide}}" for text in row[start : start + A_LINE])


def _chance(chance: Chance, fails: Chance | None) -> dict[str, Any]:
    own = ("low", "high", "joint", "independent", "correlated", "is_joint", "pieces", "unverified", "runs")
    found = {"blocked": chance.probability, **{name: getattr(chance, name) for name in own}}
    return found | {"if_anchors_fail": None if fails is None else _chance(fails, None)}


def _in_g(value: float) -> float:
    return round(value / GRAVITY, 12)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


# ---------------------------------------------------------------- files


def check_files(table: Path | None, plot: Path | None) -> None:
    """Raise InputError unless the files can be written, as far as can be told before the work."""
    if plot is not None:
        check_figure(plot)
    if table is None:
        return
    if table.suffix.lower() != ".csv":
        raise InputError(f"the table {table.name} is of no known kind: end its name in .csv")
    try:
        can_be = table.parent.is_dir() and not table.is_dir()
    except OSError:  # a name that is too long
        can_be = False
    if not can_be:
        raise InputError(f"the table {table} cannot be written there: name a file in a folder that exists")


def write_files(sweep: Sweep, table: Path | None, plot: Path | None) -> Iterator[str]:
    """Write the table and the figure, and yield what is to be said of it; OutputError if one cannot be written."""
    if table is not None:
        save_figure(sweep.to_csv().encode("utf-8-sig"), table)
        yield f"wrote {table}"
    if plot is not None:
        from assess.report.commands.fragility_figure import choose_drawn, paint, size
        from assess.report.figures.draw import draw

        drawn, left = choose_drawn(sweep.fragility.routes)
        kind = plot.suffix.lower().removeprefix(".")
        save_figure(draw(*size(drawn), partial(paint, sweep.fragility, drawn, sweep.pfa_g), kind), plot)
        yield f"wrote {plot}{_say_left(left)}"


def _say_left(left: Sequence[RouteFragility]) -> str:
    return f"; {len(left)} more routes are not drawn" if left else ""
