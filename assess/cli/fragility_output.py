"""Results of `assess fragility`, the chance of overturning against PFA or PFV: as files, JSON and text."""

import json
import math
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from assess.cli.route_output import WIDE, describe_run, finite, say_motions, say_run, write_rows
from assess.fragility import MOST_MISFIT, lognormal_chance
from assess.i18n import count
from assess.pipeline.adopt import Assessment
from assess.pipeline.piece_fragility import UNITS, FloorMotions, PieceFragilities, PieceFragility
from assess.report import words
from assess.report.interchange.exchange_files import LABELS, Exchange
from assess.report.interchange.nrml import write_nrml
from assess.report.interchange.pelicun import write_pelicun
from assess.text import plain_line
from assess.units import GRAVITY, LENGTH, to_edge

SCHEMA = "1.0"
"""Version of the document's shape: the first number changes where a key goes or gets another meaning."""
MOST_LINES = 200  # curves that the text lists; files and the document hold all
MOST_NAMES = 8  # names of curves that a line of those left out lists
COLUMNS: Mapping[str, str] = {"pfa": "pfa_g", "pfv": "pfv_cm_s"}  # names of the levels in files
DECIMALS = 12
PIECES_DRAWN = (
    "Each draw has a base, height, centre of gravity and restitution of its own (Piece uncertainty of the sheet "
    "Building)."
)
POOLED = (
    "The rows of a Type are pooled over their sizes and floors, each by its Quantity; rows without a Type by equal "
    "size. Pieces of a row fall alike, so that trials count each draw once for each piece."
)


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """What `assess fragility` found."""

    assessment: Assessment
    found: PieceFragilities

    @property
    def measure(self) -> str:
        """The intensity measure in words."""
        return self.found.im.upper()

    def say(self) -> Iterator[str]:
        """Yield what the numbers mean, in paragraphs."""
        measure, unit = self.measure, LABELS[self.found.im]
        pieces = PIECES_DRAWN if self.found.has_drawn_pieces else "Every piece is exactly as filled in."
        yield (
            f"Chance that a free-standing piece overturns, given the {measure} of its floor; not a chance per year. "
            f"The uncertainty of the motion is not in it: whoever applies a curve to a {measure} brings that of the "
            f"demand. {pieces}"
        )
        yield (
            f"Motions: the floor's own, all multiplied by level / the floor's {measure}, and the same at every level; "
            "their single peaks scatter about it. The spectrum keeps its shape: a curve holds for motions of the "
            "PFV/PFA stated (mean PFV over mean PFA of the motions). A blank axis takes the worse one at each level. "
            "Sliding, castors, walls and anchors are not modelled; anchored pieces are taken as free-standing."
        )
        if self.found.by == "type":
            yield POOLED
        draws, error = count(self.found.runs, "draw"), 50 / math.sqrt(self.found.runs)
        yield (
            f"Median [{unit}] and beta (standard deviation of ln) are those of a lognormal fitted by maximum binomial "
            "likelihood (Baker 2015). Misfit: the largest difference between it and the share that fell, at any "
            f"level; up to {MOST_MISFIT:g} the lognormal stands in for the table, else use the table. With {draws} a "
            f"share has a standard error of up to {error:.1f} percentage points, which is part of the misfit."
        )

    def cautions(self) -> Iterator[str]:
        """Yield what in this building makes the curves less certain, and what was left out."""
        every = [one for curve in self.found.curves for one in curve.motions]

        def list_floors(holds: Callable[[FloorMotions], bool]) -> list[str]:
            names = {one.floor for one in every if holds(one)}
            return [floor.floor for floor in self.assessment.inventory.floors if floor.floor in names]

        yield from say_motions(
            list_floors(lambda one: one.is_assumed), list_floors(lambda one: one.is_unknown),
            list_floors(lambda one: one.is_weak),
            "pieces may overturn at lower levels than curves that rest on them say.",
        )  # fmt: skip
        if stocky := sum(item.quantity for item in self.found.stocky):
            yield f"Left out: {count(stocky, 'piece')} too stocky to rock."

    def describe(self) -> dict[str, Any]:
        """Return the document of `assess fragility --json` and fragility.json."""
        found = self.found
        motions = {id(one): one for curve in found.curves for one in curve.motions}  # each once
        return {
            "schema": SCHEMA,
            **describe_run(self.assessment),
            "meaning": " ".join(self.say()), "cautions": list(self.cautions()), "scenario": self.assessment.scenario,
            "by": found.by,
            "intensity_measure": {"name": found.im, "unit": LABELS[found.im], "key": COLUMNS[found.im]},
            "draws": found.runs, "seed": found.seed,
            "uncertainty": {"motion": 0.0, "piece": found.has_drawn_pieces},
            "too_stocky": [item.item for item in found.stocky],
            "motions": [
                {
                    "floor": one.floor, "axis": one.demand.axis, "source": str(one.demand.label),
                    "spectrum": str(one.spectrum), "pfa_g": one.demand.pfa / GRAVITY,
                    "pfv_cm_s": finite(100 * one.demand.pfv), "mean_pfa_g": one.mean_pfa / GRAVITY,
                    "mean_pfv_cm_s": 100 * one.mean_pfv, "pfv_per_pfa_s": one.pfv_per_pfa,
                    "assumed_motion": one.is_assumed, "unknown_building": one.is_unknown, "weak_motions": one.is_weak,
                }
                for one in motions.values()
            ],
            "curves": [self._describe(curve) | {"table": list(self.tabulate(curve))} for curve in found.curves],
        }  # fmt: skip

    def _describe(self, one: PieceFragility) -> dict[str, Any]:
        """Return a curve without its table, flat."""
        curve, unit, level = one.curve, UNITS[self.found.im], COLUMNS[self.found.im]
        motions = one.motions
        ranges = {
            "breadth_{}_cm": [to_edge(item.breadth, LENGTH["cm"]) for item in one.items],
            "height_{}_cm": [to_edge(item.height, LENGTH["cm"]) for item in one.items],
            "breadth_to_height_{}": [item.breadth / item.height for item in one.items],
            "centre_of_gravity_{}_percent": [round(100 * item.centre_of_gravity, DECIMALS) for item in one.items],
            "rocks_from_{}_g": [value / GRAVITY for value in one.thresholds],
            "pfv_per_pfa_{}_s": one.pfv_per_pfa,
        }
        return {
            "name": one.name, "type": one.type or None, "items": [item.item for item in one.items],
            "floors": list(one.floors), "pieces": one.pieces,
            "anchored_pieces": sum(item.quantity for item in one.items if item.anchored == "yes"),
            "kind": curve.kind, "why": str(curve.why),
            f"median_{level}": finite(curve.median / unit),
            "beta": finite(curve.dispersion), "misfit": finite(curve.misfit), "is_lognormal": curve.is_lognormal,
            **{
                name.format(end): choose(values)
                for name, values in ranges.items()
                for end, choose in (("min", min), ("max", max))
            },
            "assumed_motion": any(motion.is_assumed for motion in motions),
            "unknown_building": any(motion.is_unknown for motion in motions),
            "weak_motions": any(motion.is_weak for motion in motions),
            "may_be_too_low": one.may_be_too_low,
        }  # fmt: skip

    def tabulate(self, one: PieceFragility) -> Iterator[dict[str, Any]]:
        """Yield the levels of a curve with what fell at each."""
        curve, unit = one.curve, UNITS[self.found.im]
        fitted = lognormal_chance(curve.levels, curve.median, curve.dispersion) if curve.kind == "fitted" else None
        for at, level in enumerate(curve.levels.tolist()):
            yield {
                COLUMNS[self.found.im]: round(level / unit, DECIMALS),
                "trials": int(curve.trials[at]), "fallen": int(curve.fallen[at]), "share": float(curve.shares[at]),
                "fitted": None if fitted is None else float(fitted[at]),
            }  # fmt: skip

    def to_json(self) -> str:
        """Return the document as text."""
        return json.dumps(self.describe(), ensure_ascii=False, allow_nan=False, indent=1)

    def to_csv(self) -> str:
        """Return a line a curve, for other programs; the last column says what it is conditional on."""
        pieces = "that of the pieces is" if self.found.has_drawn_pieces else "neither is that of the pieces"
        conditions = (
            f"chance of overturning given the floor's {self.measure}; the uncertainty of the motion is not in it, "
            f"{pieces}; holds for motions of the stated PFV/PFA"
        )
        own = {"by": self.found.by, "draws": self.found.runs, "seed": self.found.seed, "conditions": conditions}
        return write_rows({**self._describe(curve), **own} for curve in self.found.curves)

    def to_text(self) -> str:
        """Return what a person reads."""
        found, unit = self.found, UNITS[self.found.im]
        heads = [found.by, "pieces", "floors", "B/H", f"median [{LABELS[found.im]}]", "beta", "misfit", "PFV/PFA [s]"]
        rows = [[*heads, ""]]
        for one in found.curves[:MOST_LINES]:
            curve = one.curve
            fitted, remarks = ["-", "-", "-"], [str(curve.why)]
            if curve.kind == "fitted":
                fitted = [f"{curve.median / unit:.3g}", f"{curve.dispersion:.2f}", f"{curve.misfit:.3f}"]
                remarks = [] if curve.is_lognormal else ["use the table"]
            remarks += ["may be too low"] if one.may_be_too_low else []
            rows.append([
                words.cut(one.name, 34), f"{one.pieces:,}", words.cut(", ".join(one.floors), 16),
                _spread([item.breadth / item.height for item in one.items]), *fitted, _spread(one.pfv_per_pfa),
                "; ".join(remarks),
            ])  # fmt: skip
        lines = [f"{say_run(self.assessment, found.runs, found.seed)}; against the floor's {self.measure}", ""]
        wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
        for first, *middle, last in rows:  # the first and the last to the left, the others to the right
            numbers = (f"{text:>{width}}" for text, width in zip(middle, wide[1:-1], strict=True))
            lines.append("  ".join([f"{first:<{wide[0]}}", *numbers, last]).rstrip())
        if len(found.curves) > MOST_LINES:
            lines.append(f"... and {len(found.curves) - MOST_LINES:,} more, which files and --json hold.")
        for paragraph in (*self.cautions(), *self.say()):
            lines += ["", *textwrap.wrap(paragraph, WIDE)]
        return "\n".join(lines)


def _write_csv(curves: Curves) -> Exchange:
    """Write a line a curve, and a line a curve and level."""
    table = write_rows(
        {"name": curve.name, "type": curve.type or None, "items": [item.item for item in curve.items], **row}
        for curve in curves.found.curves
        for row in curves.tabulate(curve)
    )
    tables = {"fragility.csv": curves.to_csv(), "fragility_table.csv": table}
    return Exchange({name: text.encode("utf-8-sig") for name, text in tables.items()}, ())


FORMATS: Mapping[str, Callable[[Curves], Exchange]] = {
    "csv": _write_csv,
    "json": lambda curves: Exchange({"fragility.json": f"{curves.to_json()}\n".encode()}, ()),
    "pelicun": lambda curves: write_pelicun(curves.assessment, curves.found),
    "nrml": lambda curves: write_nrml(curves.assessment, curves.found),
}
"""What writes each format: the bytes of its files by their names, and the curves that it has no place for."""


def say_left_out(exchange: Exchange) -> Iterator[str]:
    """Yield what the files of a format do not hold, a line a reason."""
    reasons: dict[str, list[str]] = {}
    for one in exchange.left_out:
        reasons.setdefault(str(one.why), []).append(plain_line(one.name))
    file = next(iter(exchange.files))
    for why, names in reasons.items():
        more = f", and {len(names) - MOST_NAMES:,} more" if len(names) > MOST_NAMES else ""
        listed = ", ".join(names[:MOST_NAMES])
        yield f"left out of {file}: {count(len(names), 'curve')} ({listed}{more}): {why}"


def _spread(values: Sequence[float]) -> str:
    low, high = f"{min(values):.2f}", f"{max(values):.2f}"
    return low if low == high else f"{low}-{high}"
