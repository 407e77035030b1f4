"""Figures of the verification: how sure the chance is, what the motions look like, and how far pieces turned."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.demand import Demand
from assess.methods._method import Joint
from assess.methods.housner_monte_carlo import interval_width
from assess.motion.record import FloatArray
from assess.motion.spectrum import build_periods, response_spectrum
from assess.report import words
from assess.report.content import Content
from assess.report.figures import draw, label, thin_out
from assess.results import Assessment, ItemResult
from assess.risk import LIMITS, RiskClass, wilson_interval
from assess.settings import AUTO
from assess.units import GRAVITY

MOST = 5
"""Pieces whose motions are drawn."""
MOST_STEPS = 300
"""Points of a curve of convergence."""
RECORD, OWN, BAND = "#1c1c1c", ("#1b4f72", "#b9770e", "#7d7d7d"), "#c6d3dd"
BINS = 10
"""Bars between rest and the critical angle."""


@dataclass(frozen=True, slots=True, eq=False)
class Traced:
    """A piece whose motions are drawn; `alike` are the other rows of its size under the same floor motion.

    `fell` (n,) tells under which of its n motions it overturned, `rotation` (n,) how far it turned, as a ratio to the
    critical angle.
    """

    one: ItemResult
    alike: int
    demand: Demand
    joint: Joint
    fell: NDArray[np.bool_]
    rotation: NDArray[np.float32]

    @property
    def name(self) -> str:
        """Its name, and how many are like it."""
        return words.clip(self.one.item.item, 40) + (f" (and {self.alike:,} alike)" if self.alike else "")


def choose_traced(content: Content) -> tuple[Traced, ...]:
    """Return the worst verified piece, those left undecided, and the next worst; of equal pieces one."""
    results = content.results
    verified = [index for index, one in enumerate(results) if one.is_verified]
    free = [index for index in verified if not results[index].is_anchored]
    ordered = sorted(free or verified, key=lambda index: _by_risk(results[index]))
    alike: dict[tuple[Demand, float, float], list[int]] = {}
    for index in ordered:
        item = results[index].item
        alike.setdefault((results[index].governing.demand, item.breadth, item.height), []).append(index)
    firsts = {own[0]: len(own) - 1 for own in alike.values()}
    undecided = [index for index in firsts if "undecided" in results[index].adopted.flags]
    chosen = list(dict.fromkeys([*list(firsts)[:1], *undecided, *firsts]))[:MOST]
    return tuple(
        _trace(content.assessment, index, results[index], firsts[index]) for index in firsts if index in chosen
    )


def _by_risk(one: ItemResult) -> tuple[float, float, str]:
    found = one.governing.verification
    return -one.adopted.upper, -found.probability if found else 0.0, one.item.item


def _trace(assessment: Assessment, index: int, one: ItemResult, alike: int) -> Traced:
    demand = one.governing.demand
    joint = assessment.joints[demand]
    at = int(np.flatnonzero(joint.cases == assessment.governing[index])[0])
    runs = int(joint.runs[at])
    return Traced(one, alike, demand, joint, joint.fell[at, :runs], joint.rotation[at, :runs])


def draw_traced(content: Content, traced: Sequence[Traced]) -> dict[str, bytes]:
    """Draw the figures of the verification by the names that the template asks for; none where nothing is verified."""
    if not traced:
        return {}
    settings = content.assessment.settings
    z, is_long = interval_width(settings), settings.runs == AUTO
    rows = 1 + len(_series(traced[0]))
    return {
        "convergence": draw(7, 2.1, partial(_paint_panels, traced, partial(_paint_convergence, z, is_long))),
        "motions": draw(7, 0.5 + 0.75 * rows, partial(_paint_motions, traced[0])),
        "rotations": draw(7, 2.1, partial(_paint_panels, traced, _paint_rotations)),
    }


def _paint_panels(traced: Sequence[Traced], paint: Callable[[Any, Traced, bool], None], figure: Any) -> None:
    """Paint one panel a piece, side by side; places that stay free keep the panels of one width."""
    columns = max(3, len(traced))
    panels = figure.subplots(1, columns, sharey=True, squeeze=False)[0]
    for at, axes in enumerate(panels):
        if at >= len(traced):
            axes.remove()
            continue
        paint(axes, traced[at], at == 0)
        one = traced[at].one
        axes.set_title(f"{label(one.item.item, 20)}\nfloor {label(one.item.floor, 12)}", fontsize=7, loc="left")
        axes.tick_params(labelsize=6)
        axes.spines[["top", "right"]].set_visible(False)


def _paint_convergence(z: float, is_long: bool, axes: Any, one: Traced, is_first: bool) -> None:
    spaced = np.geomspace if is_long else np.linspace
    counts = np.unique(spaced(1, one.fell.size, MOST_STEPS).round().astype(int))
    fallen = np.cumsum(one.fell)[counts - 1]
    low, high = wilson_interval(fallen, counts, z)
    axes.fill_between(counts, low, high, color=BAND, linewidth=0).set_gid("interval")
    axes.plot(counts, fallen / counts, color="#1b4f72", linewidth=1.1, clip_on=False)[0].set_gid("chance")
    for limit in LIMITS:
        axes.axhline(limit, color="#444444", linewidth=0.6, linestyle="--").set_gid("class-limit")
    axes.set_yscale("function", functions=(_root, np.square))
    axes.set_ylim(0, 1)
    axes.set_yticks([0, *LIMITS, 1], [f"{100 * tick:g} %" for tick in (0, *LIMITS, 1)])
    axes.set_xscale("log" if is_long else "linear")
    axes.set_xlim(1, max(2, one.fell.size))
    axes.set_xlabel("motions", fontsize=6)
    if is_first:
        axes.set_ylabel("chance of overturning", fontsize=7)


def _root(values: Any) -> Any:
    return np.sqrt(np.maximum(values, 0))


def _paint_rotations(axes: Any, one: Traced, is_first: bool) -> None:
    """Paint how many motions turned a piece how far: at rest, ten steps to the critical angle, beyond, overturned."""
    stood = one.rotation[~one.fell]
    counts, _ = np.histogram(stood[stood > 0], bins=np.append(np.linspace(0, 1, BINS + 1), np.inf))
    share = 100 / one.fell.size
    axes.bar(-1, share * np.sum(stood == 0), width=0.8, color="#ffffff", edgecolor="#444444", linewidth=0.5)
    axes.bar(np.arange(BINS + 1) + 0.5, share * counts, width=0.9, color="#8fb3cc", edgecolor="#444444", linewidth=0.5)
    fallen = axes.bar(BINS + 3, share * one.fell.sum(), width=1.2, color=RiskClass.VERY_HIGH.fill, hatch="///",
                      edgecolor="#ffffff", linewidth=0.5)  # fmt: skip
    fallen[0].set_gid("overturned")
    axes.axvline(BINS, color="#444444", linewidth=0.6, linestyle="--")
    axes.set_xticks([-1, BINS / 2, BINS, BINS + 3], ["at rest", "0.5", "1", "overturned"], rotation=60, ha="right",
                    rotation_mode="anchor")  # fmt: skip
    axes.set_ylim(0, 100)
    if is_first:
        axes.set_ylabel("share of the motions [%]", fontsize=7)


def _series(one: Traced) -> list[tuple[str, FloatArray, float]]:
    """Return the record, where one is known, and the first motions: name, acceleration [m/s2], time step [s]."""
    motion = one.demand.motion
    record = [] if motion is None else [("record", motion.acceleration, motion.time_step)]
    examples = [(f"motion {at}", np.asarray(values, dtype=np.float64), step)
                for at, (values, step) in enumerate(one.joint.examples, 1)]  # fmt: skip
    return record + examples


def _paint_motions(one: Traced, figure: Any) -> None:
    left, right = figure.subfigures(1, 2, width_ratios=(1.75, 1))
    series = _series(one)
    panels = left.subplots(len(series), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, (name, values, step), colour in zip(panels, series, _colours(series), strict=True):
        times, shown = thin_out(np.arange(values.size) * step, values / GRAVITY)
        axes.plot(times, shown, color=colour, linewidth=0.5)[0].set_gid(name.replace(" ", "-"))
        axes.set_title(f"{name}: PFA {np.abs(values).max() / GRAVITY:.3f} g", loc="left", fontsize=7)
        axes.margins(x=0)
        axes.tick_params(labelsize=6)
        axes.spines[["top", "right"]].set_visible(False)
    left.supylabel("acceleration [g]", fontsize=7)
    panels[-1].set_xlabel("time [s]", fontsize=7)
    _paint_spectra(right.subplots(), series)


def _colours(series: Sequence[tuple[str, FloatArray, float]]) -> list[str]:
    own = iter(OWN)
    return [RECORD if name == "record" else next(own) for name, _, _ in series]


def _paint_spectra(axes: Any, series: Sequence[tuple[str, FloatArray, float]]) -> None:
    periods, styles = build_periods(0.03, 10.0, 120), iter(("--", "-.", ":"))
    for (name, values, step), colour in zip(series, _colours(series), strict=True):
        pseudo = response_spectrum(values, step, periods).pseudo / GRAVITY
        style, width = ("-", 1.6) if name == "record" else (next(styles), 1.0)
        axes.plot(periods, pseudo, color=colour, linestyle=style, linewidth=width, label=name)
    axes.set_xscale("log")
    ticks = (0.1, 0.3, 1, 3, 10)
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(0.03, 10)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("period [s]", fontsize=7)
    axes.set_title("5 % pseudo-acceleration [g]", loc="left", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.grid(visible=True, color="#e0e0e0", linewidth=0.5)
    axes.legend(fontsize=6, frameon=False)
