"""Results of `assess routes`, the chance of blockage against PFA: as JSON, CSV and text, the verdict first."""

import csv
import io
import json
import math
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, NamedTuple

from assess.i18n import count
from assess.pipeline.adopt import Assessment
from assess.pipeline.route_sweep import FINEST, JUMP, Fragility, RouteFragility, find_jumps, find_passing
from assess.report import words
from assess.report.data import disarm
from assess.report.say.route import say_basis
from assess.route_results import Chance
from assess.units import GRAVITY
from assess.version import __version__, versions

LEVELS = (0.03, 0.3, 0.5)  # chances of blockage whose PFA is given [-]
MOST_CAUSES = 6  # pieces named in the lines of a route
A_LINE = 12  # values side by side in the text
WIDE = 110  # characters of a line of its sentences
VERDICT_ROUTES, VERDICT_PIECES, LONGEST = 3, 4, 40
"""Routes, and pieces of a route, that the text of the verdict names, and characters of a name; the data has all."""
HEADS = (
    "route", "floors", "pfa_g", "blocked", "low", "high", "independent", "correlated", "if_anchors_fail", "pieces",
    "unverified", "runs", "inserted",
)  # fmt: skip
MEANING = (
    "Chance that an evacuation route is blocked if every floor of it shakes with the PFA along both axes; not a chance "
    "per year.",
    "Motions: the floor's own, each scaled by value / the floor's PFA, and the same at every value. The spectrum keeps "
    "its shape, PFV scales along; the mean of their peaks is close to the value before anything is taken as uncertain.",
    "Rocking is not monotone: a piece may stand in a stronger motion and overturn in a weaker one. Sliding, castors "
    "and spilt contents are not modelled.",
    "Range: the 95 % sampling interval, for the number of draws only. Where not all pieces were rocked together, "
    "the chance is the largest under three assumptions on their correlation, and the range covers all three.",
    "The PFA at which a chance reaches a level is interpolated linearly. Where the chance jumps by more than "
    f"{100 * JUMP:g} percentage points between two values, only these two are given (between_g, without pfa_g).",
    "Values are inserted halfway between two at which the chance of any route differs by more than "
    f"{100 * JUMP:g} percentage points, down to steps of {100 * FINEST:g} % of the PFA; the same draws serve there.",
)
NOTES = (
    "Chances are of an earthquake with that PFA, not per year. The range (from, to) covers the number of draws only. "
    "Sliding, castors and spilt contents are not modelled. Method: assess routes --help.",
    f"* inserted, as the chance differs by more than {100 * JUMP:g} percentage points between the values next to it.",
    "Between two values: the chance jumps from one to the other. For a level between them, take smaller steps: "
    "--pfa LOW:HIGH:STEP",
)
"""What ends the text: always, where values are inserted, and where a wide step has a jump."""


class Verdict:
    """What a sweep comes to, at the values of PFA that were evaluated; a value is None where there is none [g].

    A route can be judged if all its segments are evaluated, or those that are reach the limit. The chances of all these
    are below the limit up to `below_up_to_g`; at `reached_at_g` that of `first` is not, the largest chance first. If
    anchors fail this may be at a smaller value. `reaching` counts the routes that reach the limit at any value.
    """

    def __init__(self, fragility: Fragility, pfa_g: Sequence[float]) -> None:
        def reach(chances: Sequence[Chance] | None) -> int | None:
            """Return the number of the first value at which a chance is not below the limit."""
            return next((at for at, one in enumerate(chances or ()) if one.probability >= fragility.limit), None)

        self.fragility, self.pfa_g = fragility, pfa_g
        self.evaluated: list[RouteFragility] = []
        self.not_evaluated: list[RouteFragility] = []
        for one in fragility.routes:
            is_judged = one.is_evaluated and (not one.unevaluated or reach(one.blocked) is not None)
            (self.evaluated if is_judged else self.not_evaluated).append(one)
        reached = [(reach(one.blocked), one) for one in self.evaluated]
        failed = [(reach(one.if_anchors_fail), one) for one in self.evaluated]
        at, early = (min((n for n, _one in ways if n is not None), default=None) for ways in (reached, failed))
        first = [one for n, one in reached if n is not None and n == at]
        self.first = sorted(first, key=lambda one: -one.blocked[at or 0].probability)
        self.reaching = sum(n is not None for n, _one in reached)
        if early is not None and at is not None and early >= at:
            early = None
        self.anchored = [one for n, one in failed if n is not None and n == early]
        self.anchored_at_g = None if early is None else pfa_g[early]
        last = len(pfa_g) - 1 if at is None else at - 1
        self.below_up_to_g = pfa_g[last] if last >= 0 and self.evaluated else None
        self.reached_at_g = None if at is None else pfa_g[at]

    @property
    def lower_bounds(self) -> list[str]:
        """The routes whose chances are lower bounds: motions may be too weak, or a segment is not evaluated."""
        return [one.route for one in self.evaluated if one.doubtful or one.unevaluated]

    def describe(self) -> dict[str, Any]:
        """Return it as data, with its text."""
        return {
            "text": self.say(), "limit": self.fragility.limit, "evaluated_routes": len(self.evaluated),
            "not_evaluated": [one.route for one in self.not_evaluated],
            "not_evaluated_segments": [
                {"route": one.route, "segments": list(one.unevaluated)}
                for one in (*self.not_evaluated, *self.evaluated)
                if one.unevaluated
            ],
            "below_up_to_g": self.below_up_to_g, "reached_at_g": self.reached_at_g,
            "first": [{"route": one.route, "pieces": _list_causes(one)} for one in self.first],
            "routes_reaching": self.reaching,
            "reached_at_g_if_anchors_fail": self.anchored_at_g or self.reached_at_g,
            "first_if_anchors_fail": [one.route for one in self.anchored],
            "lower_bounds": self.lower_bounds, "pieces_left_out": self.fragility.unplaced,
        }  # fmt: skip

    def say(self) -> str:
        """Return it in a sentence or two, with what decides how far it can be relied on."""
        level, number, first = f"{100 * self.fragility.limit:g} %", len(self.evaluated), self.first
        whole = count(number, "evaluated route" if self.not_evaluated else "route")
        if not number and not any(one.is_evaluated for one in self.not_evaluated):
            return "No route can be evaluated: the workbook places no furniture next to any."
        said = [] if number else ["No route can be evaluated as a whole."]
        if number and self.below_up_to_g is not None:
            every = f"All {whole} stay" if number > 1 else f"The only {whole.removeprefix('1 ')} stays"
            every = every.replace("All 2", "Both") if number == 2 else every
            last = "" if self.reached_at_g else ", the largest PFA evaluated"
            said.append(f"{every} below {level} up to {self.below_up_to_g:.4g} g{last}.")
        if number and self.reached_at_g is not None:
            more = (
                f"; up to {self.pfa_g[-1]:.4g} g, {self.reaching} of {whole} do" if self.reaching > len(first) else ""
            )
            where = f"From {self.reached_at_g:.4g} g"
            if self.below_up_to_g is None:
                where = f"Already at {self.pfa_g[0]:.4g} g, the smallest PFA evaluated,"
            named = []
            for one in first:  # fixing no piece would help a route that is blocked with nothing fallen
                pieces = _name([piece.item for piece in one.causes], VERDICT_PIECES)
                blame = f"because of {pieces}" if one.causes else "blocked with nothing fallen"
                named.append(f"{_quote(one.route)} ({blame})")
            reach = "reaches" if len(first) == 1 else "reach"
            said.append(f"{where} {words.name_first(named, VERDICT_ROUTES)} {reach} {level}{more}.")
        if self.anchored_at_g is not None:
            routes = _name([one.route for one in self.anchored], VERDICT_ROUTES)
            reach = "reaches" if len(self.anchored) == 1 else "reach"
            said.append(f"If the anchors fail, {routes} {reach} {level} from {self.anchored_at_g:.4g} g.")
        if self.lower_bounds:
            said.append(f"The chances of {_name(self.lower_bounds, VERDICT_ROUTES)} are lower bounds.")
        parts = [one for one in self.evaluated if one.unevaluated]
        for what, others in (
            ("Not evaluated", self.not_evaluated), ("Counted without what is not evaluated", parts),
        ):  # fmt: skip
            named = []
            for one in others:
                segments = f"segment{'' if len(one.unevaluated) == 1 else 's'} {_name(one.unevaluated, VERDICT_PIECES)}"
                named.append(f"{_quote(one.route)} ({segments})" if one.is_evaluated else _quote(one.route))
            said += [f"{what}: {words.name_first(named, VERDICT_ROUTES)}."] if named else []
        if self.fragility.unplaced:
            said.append(f"Left out: {count(self.fragility.unplaced, 'piece')} without a usable position or route.")
        return " ".join(said)


def _name(names: Sequence[str], most: int) -> str:
    return words.name_first([_quote(name) for name in names], most)


def _quote(name: str) -> str:
    return repr(words.cut(name, LONGEST))


@dataclass(frozen=True, eq=False)
class Sweep:
    """What `assess routes` found."""

    assessment: Assessment
    fragility: Fragility

    @property
    def pfa_g(self) -> list[float]:
        """The values of PFA [g], as they were typed."""
        return [_in_g(value) for value in self.fragility.values]

    def cautions(self) -> Iterator[str]:
        """Yield what in this building makes the chances less certain."""
        found = self.fragility
        yield from say_motions(
            found.generic, found.unshaped, found.weak, "chances that rest on them are lower bounds.",
            "assess run --motions takes motions of your own.",
        )  # fmt: skip
        if found.stocky:
            yield (
                f"{count(found.stocky, 'piece')} next to routes too stocky to rock (B/H of 1.41 or more): the "
                "formula's chance at each PFA is used, with bounds on the correlation."
            )

    @cached_property
    def verdict(self) -> Verdict:
        """Up to which PFA every route stays below the limit, and which one first does not."""
        return Verdict(self.fragility, self.pfa_g)

    def describe(self) -> dict[str, Any]:
        """Return the document of `assess routes --json`."""
        fragility, found = self.fragility, self.fragility.uncertainty
        uncertain = []
        if found is not None and found.motion > 0:
            uncertain.append(
                f"the strength of the earthquake, a factor on the motions of all floors (standard deviation of ln: "
                f"{found.motion:g}), so that the PFA given is its median"
            )
        if found is not None and found.piece:
            uncertain.append("base, height, centre of gravity and restitution of each piece")
        drawn = "Nothing is taken as uncertain but the phases of the motions: the PFA and every piece are exact."
        if uncertain:
            drawn = (
                f"Taken as uncertain in each draw: {'; '.join(uncertain)}. All pieces of a draw share its earthquake."
            )
        routes = []
        for one in fragility.routes:
            anchored = one.if_anchors_fail or (None,) * len(one.blocked)
            pairs = zip(self.pfa_g, one.blocked, anchored, self._inserted, strict=True) if one.is_evaluated else ()
            routes.append({
                "route": one.route, "floors": list(one.floors),
                "scenario_pfa_g": one.scenario_pfa and [_in_g(peak) for peak in one.scenario_pfa],
                "evaluated": one.is_evaluated, "unevaluated_segments": list(one.unevaluated),
                "doubtful_pieces": one.doubtful, "causes": _list_causes(one),
                "chances": [
                    {"pfa_g": pfa, "inserted": inserted, **_describe_chance(chance, fails)}
                    for pfa, chance, fails, inserted in pairs
                ],
                "passes": self._describe_passing(one.blocked) if one.is_evaluated else [],
                "passes_if_anchors_fail": one.if_anchors_fail and self._describe_passing(one.if_anchors_fail),
            })  # fmt: skip
        return {
            **describe_run(self.assessment, has_routes=True),
            "verdict": self.verdict.describe(), "meaning": " ".join((*MEANING, drawn)),
            "cautions": list(self.cautions()), "scenario": self.assessment.scenario, "runs": fragility.runs,
            "seed": fragility.seed,
            "uncertainty": None if found is None else asdict(found),
            "pfa_g": self.pfa_g,
            "inserted_g": [_in_g(value) for value in fragility.values if value in fragility.inserted],
            "routes": routes,
        }  # fmt: skip

    @property
    def _inserted(self) -> list[bool]:
        return [value in self.fragility.inserted for value in self.fragility.values]

    def _describe_passing(self, chances: Sequence[Chance]) -> list[dict[str, Any]]:
        sides = {-math.inf: "below", math.inf: "above"}
        return [
            {
                "chance": level, "where": sides.get(found.low, "between"),
                "pfa_g": None if found.is_jump else finite(found.low),
                "between_g": [found.low, found.high] if found.is_jump else None,
                "earliest_g": finite(found.earliest), "latest_g": finite(found.latest),
            }
            for level in LEVELS
            for found in (self._find_passing(chances, level),)
        ]  # fmt: skip

    def _find_passing(self, chances: Sequence[Chance], level: float) -> "_Passing":
        ways = [[getattr(chance, end) for chance in chances] for end in ("probability", "high", "low")]
        (low, high), first, last = (find_passing(self.pfa_g, way, level) for way in ways)
        return _Passing(low, high, min(low, first[0]), max(high, last[1]))

    def to_json(self) -> str:
        """Return the document as text."""
        return json.dumps(self.describe(), ensure_ascii=False, indent=1)

    def to_csv(self) -> str:
        """Return a line a route and value, for other programs."""
        rows: list[dict[str, Any]] = []
        for one in self.describe()["routes"]:
            own = {"route": one["route"], "floors": one["floors"]}
            for at in one["chances"] if one["evaluated"] else ({},):
                fails = at.get("if_anchors_fail")
                rows.append(own | at | {"if_anchors_fail": fails and fails["blocked"]})
        return write_rows([{name: row.get(name) for name in HEADS} for row in rows])

    def to_text(self) -> str:
        """Return what a person reads."""
        fragility = self.fragility
        lines = textwrap.wrap(self.verdict.say(), WIDE)
        blocks = [self._list_lines(one) for one in fragility.routes]
        for block in (one for one in blocks if len(one) > 1):
            lines += ["", *block]
        if short := [line for block in blocks if len(block) == 1 for line in block]:
            lines += ["", *short]
        always, inserted, finer = NOTES
        notes = [*self.cautions(), *([inserted] if fragility.inserted else [])]
        every = [way for one in fragility.routes for way in (one.blocked, one.if_anchors_fail) if way]
        passed = (self._find_passing(way, level) for way in every for level in LEVELS)
        if any(one.is_jump and one.high - one.low >= FINEST * one.high for one in passed):
            notes.append(finer)
        lines += ["", *(line for text in (*notes, always) for line in textwrap.wrap(text, WIDE))]
        return "\n".join([*lines, say_run(self.assessment, fragility.runs, fragility.seed)])

    def _list_lines(self, one: RouteFragility) -> list[str]:
        """Return the lines of a route at the values that were asked for, and at inserted ones where it jumps there."""
        first, floors = one.blocked[0], ", ".join(one.floors)
        where = f" (floor{'' if len(one.floors) == 1 else 's'} {words.cut(floors, 60)})" if floors else ""
        lines = [f"{words.cut(one.route, 60)}{where}: {_describe_pieces(one)}"]
        asked = [at for at, is_inserted in enumerate(self._inserted) if not is_inserted]
        steps = set(asked)
        for way in (one.blocked, one.if_anchors_fail or ()):
            for jump in find_jumps([way[at].probability for at in asked] if way else []):
                steps |= set(range(asked[jump], asked[jump + 1]))
        shown = sorted(steps)
        rows = {"PFA [g]": [f"{self.pfa_g[at]:.4g}*" if self._inserted[at] else f"{self.pfa_g[at]:g}" for at in shown]}
        if first.pieces:
            for label, name in (("chance [%]", "probability"), ("  from", "low"), ("  to", "high")):
                rows[label] = [words.in_percent(getattr(one.blocked[at], name)) for at in shown]
        if one.if_anchors_fail:
            rows["if anchors fail"] = [words.in_percent(one.if_anchors_fail[at].probability) for at in shown]
        wide = 1 + max(len(text) for row in rows.values() for text in row)
        for start in range(0, len(shown) if len(rows) > 1 else 0, A_LINE):
            for label, row in rows.items():
                lines.append(f"  {label:<16}" + "".join(f"{text:>{wide}}" for text in row[start : start + A_LINE]))
        if first.pieces:
            lines.append(f"  reaches {self._describe_levels(one.blocked)}")
        if one.causes:
            named = _name([piece.item for piece in one.causes], MOST_CAUSES)
            lines.append(f"  {100 * self.fragility.limit:g} % first because of {named}")
        if one.if_anchors_fail:
            lines.append(f"  if anchors fail, {self._describe_levels(one.if_anchors_fail)}")
        return lines

    def _describe_levels(self, chances: Sequence[Chance]) -> str:
        values, texts = self.pfa_g, []
        for level in LEVELS:
            found = self._find_passing(chances, level)
            named = []
            for value in found:  # one of the values as it was typed
                if math.isfinite(value):
                    named.append(f"{value:.4g}" if value in values else f"{value:.2f}")
                else:
                    named.append(f"below {values[0]:g}" if value < 0 else f"above {values[-1]:g}")
            low, high, first, last = named
            spread = "" if first == last or (first, last) == (low, high) else f" ({first} to {last})"
            at = f"between {low} and {high}" if found.is_jump else f"at {low}" if math.isfinite(found.low) else low
            texts.append(f"{100 * level:g} % {at} g{spread}")
        return "; ".join(texts)


class _Passing(NamedTuple):
    """Between which PFA a chance reaches a level, and the earliest and latest by the ends of its range [g]."""

    low: float
    high: float
    earliest: float
    latest: float

    @property
    def is_jump(self) -> bool:
        return self.low < self.high


def _list_causes(one: RouteFragility) -> list[dict[str, Any]]:
    return [{"item": piece.item, "row": piece.row} for piece in one.causes]


def _describe_pieces(one: RouteFragility) -> str:
    if not one.is_evaluated:
        return "not evaluated: the workbook places no furniture there"
    first = one.blocked[0]
    if first.pieces:
        doubtful = f"; at least, as the motions of {count(one.doubtful, 'piece')} may be too weak"
        known = f"{count(first.pieces, 'piece')}; {say_basis(first)}{doubtful if one.doubtful else ''}"
    elif first.probability > 0:
        known = "blocked before any shaking"
    elif one.if_anchors_fail is None:
        known = "0 %: no piece can obstruct it"
    else:
        known = "0 % if the anchors hold: no other piece can obstruct it"
    named = _name(one.unevaluated, MOST_CAUSES)
    return f"{known}; without segments that are not evaluated: {named}" if one.unevaluated else known


def describe_run(assessment: Assessment, *, has_routes: bool = False) -> dict[str, Any]:
    """Return with what a document was made."""
    return {
        "workbook": {"file": assessment.inventory.file_name, "sha256": assessment.inventory.sha256},
        "assess": {"version": __version__, "platform": dict(versions(has_rocked=True, has_routes=has_routes))},
    }


def say_run(assessment: Assessment, runs: int, seed: int) -> str:
    """Return with what a text was made."""
    return f"{assessment.inventory.file_name}: scenario {assessment.scenario}, {count(runs, 'draw')}, seed {seed}"


def say_motions(
    drawn: Sequence[str], unknown: Sequence[str], weak: Sequence[str], meaning: str, stronger: str = ""
) -> Iterator[str]:
    """Yield what makes results less certain by floors: motions that are drawn, or may be too weak."""
    if drawn:
        yield f"No record is known for {name_floors(drawn)}: ground motion and building are drawn."
    known = "Enter Storeys or the Period T1 in the sheet Building."
    for floors, why, fix in (
        (unknown, "as nothing is known of the building", known), (weak, "as they are weaker than the floor's", stronger)
    ):  # fmt: skip
        if floors:
            yield f"The motions of {name_floors(floors)} may be too weak, {why}: {meaning} {fix}".strip()


def write_rows(rows: Iterable[Mapping[str, Any]]) -> str:
    """Return rows as CSV, in which no text is taken for a formula; the first one names the columns."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    for number, row in enumerate(rows):
        if number == 0:
            writer.writerow(row)
        writer.writerow([disarm(value) for value in row.values()])
    return file.getvalue()


def name_floors(floors: Sequence[str]) -> str:
    """Return floors by name in running text, the first of many."""
    named = words.name_first([repr(words.cut(floor, 20)) for floor in floors], 8)
    return f"{'floor' if len(floors) == 1 else 'floors'} {named}"


def _describe_chance(chance: Chance, fails: Chance | None) -> dict[str, Any]:
    own = ("low", "high", "joint", "independent", "correlated", "is_joint", "pieces", "unverified", "runs")
    found = {"blocked": chance.probability, **{name: getattr(chance, name) for name in own}}
    return found | {"if_anchors_fail": None if fails is None else _describe_chance(fails, None)}


def _in_g(value: float) -> float:
    return round(value / GRAVITY, 12)


def finite(value: float) -> float | None:
    """Return a number, None for what is not finite."""
    return value if math.isfinite(value) else None
