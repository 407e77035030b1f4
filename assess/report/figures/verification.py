"""Figures of the verification: how sure the chance is, what the motions look like, and how far pieces turned."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.demand import Demand
from assess.language import gettext as _
from assess.language import ngettext, number
from assess.methods._method import Joint
from assess.methods.housner_monte_carlo import interval_width
from assess.motion.fit import Spectra
from assess.motion.record import FloatArray
from assess.motion.spectrum import pseudo_acceleration
from assess.report import words
from assess.report.content import Content
from assess.report.figures.draw import draw, label, thin_out
from assess.results import Assessment, ItemResult
from assess.risk import LIMITS, RiskClass, wilson_interval
from assess.settings import AUTO
from assess.units import GRAVITY

MOST = 5
"""Pieces whose motions are drawn."""
MOST_STEPS = 300
"""Points of a curve of convergence."""
MOST_SAMPLES, MOST_ORDINATES = 800, 60
"""Points of a curve of acceleration, and about as many of each of the thin spectra."""
RECORD, MOTION, MEAN, BAND = "#1c1c1c", "#1b4f72", "#db7133", "#c6d3dd"
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
        name = words.cut(self.one.item.item, 40)
        return (
            ngettext("{name} (and {n:,} alike)", "{name} (and {n:,} alike)", self.alike, name=name)
            if self.alike
            else name
        )


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
        "convergence": draw(7, 2.4, partial(_paint_convergences, traced, z, is_long)),
        "motions": draw(7, max(2.9, 0.5 + 0.75 * rows), partial(_paint_motions, traced[0])),
        "rotations": draw(7, 2.2, partial(_paint_all_rotations, traced)),
    }


def _paint_panels(traced: Sequence[Traced], paint: Callable[[Any, Traced, bool], None], figure: Any) -> Any:
    """Paint one panel a piece, side by side; places that stay free keep the panels of one width.

    Returns the last panel.
    """
    columns = max(3, len(traced))
    panels = figure.subplots(1, columns, sharey=True, squeeze=False)[0]
    for at, axes in enumerate(panels):
        if at >= len(traced):
            axes.remove()
            continue
        paint(axes, traced[at], at == 0)
        one = traced[at].one
        floor = _("floor {floor}", floor=label(one.item.floor, 12))
        axes.set_title(f"{label(one.item.item, 20)}\n{floor}", fontsize=7, loc="left")
        axes.tick_params(labelsize=6)
        axes.spines[["top", "right"]].set_visible(False)
    return panels[min(columns, len(traced)) - 1]


def _paint_convergences(traced: Sequence[Traced], z: float, is_long: bool, figure: Any) -> None:
    """Paint the chance of each piece as motions are added, with the names of the classes beside the last."""
    last = _paint_panels(traced, partial(_paint_convergence, z, is_long), figure)
    edges = np.sqrt([0, *LIMITS, 1])
    for risk, middle in zip(RiskClass, (edges[1:] + edges[:-1]) / 2, strict=True):
        name = last.text(1.06, middle, words.risk_label(risk), transform=last.transAxes, fontsize=6, va="center")
        name.set_gid("class")
    drawn, names = last.get_legend_handles_labels()
    figure.legend(drawn[::-1], names[::-1], loc="outside lower center", ncols=3, fontsize=6, frameon=False)


def _paint_convergence(z: float, is_long: bool, axes: Any, one: Traced, is_first: bool) -> None:
    spaced = np.geomspace if is_long else np.linspace
    counts = np.unique(spaced(1, one.fell.size, MOST_STEPS).round().astype(int))
    fallen = np.cumsum(one.fell)[counts - 1]
    low, high = wilson_interval(fallen, counts, z)
    axes.fill_between(counts, low, high, color=BAND, linewidth=0, label=_("its interval")).set_gid("interval")
    name = _("chance of overturning, by the motions so far")
    axes.plot(counts, fallen / counts, color=MOTION, linewidth=1.1, clip_on=False, label=name)[0].set_gid("chance")
    for limit in LIMITS:
        axes.axhline(limit, color="#444444", linewidth=0.6, linestyle="--").set_gid("class-limit")
    axes.set_yscale("function", functions=(_root, np.square))
    axes.set_ylim(0, 1)
    axes.set_yticks([0, *LIMITS, 1], [f"{number(100 * tick, 'g')} %" for tick in (0, *LIMITS, 1)])
    axes.set_xscale("log" if is_long else "linear")
    axes.set_xlim(1, max(2, one.fell.size))
    axes.set_xlabel(_("motions"), fontsize=6)
    if is_first:
        axes.set_ylabel(_("chance of overturning"), fontsize=7)


def _root(values: Any) -> Any:
    return np.sqrt(np.maximum(values, 0))


def _paint_all_rotations(traced: Sequence[Traced], figure: Any) -> None:
    _paint_panels(traced, _paint_rotations, figure)
    figure.supxlabel(_("largest rotation, over the critical angle"), fontsize=7)


def _paint_rotations(axes: Any, one: Traced, is_first: bool) -> None:
    """Paint how many motions turned a piece how far: at rest, ten steps to the critical angle, beyond, overturned."""
    stood = one.rotation[~one.fell]
    counts = np.histogram(stood[stood > 0], bins=np.append(np.linspace(0, 1, BINS + 1), np.inf))[0]
    share = 100 / one.fell.size
    axes.bar(-1, share * np.sum(stood == 0), width=0.8, color="#ffffff", edgecolor="#444444", linewidth=0.5)
    axes.bar(np.arange(BINS + 1) + 0.5, share * counts, width=0.9, color="#8fb3cc", edgecolor="#444444", linewidth=0.5)
    fallen = axes.bar(BINS + 3, share * one.fell.sum(), width=1.2, color=RiskClass.VERY_HIGH.fill, hatch="///",
                      edgecolor="#ffffff", linewidth=0.5)  # fmt: skip
    fallen[0].set_gid("overturned")
    axes.axvline(BINS, color="#444444", linewidth=0.6, linestyle="--")
    names = [_("at rest"), number(0.5, "g"), "1", _("overturned")]
    axes.set_xticks([-1, BINS / 2, BINS, BINS + 3], names, rotation=60, ha="right", rotation_mode="anchor")
    axes.set_ylim(0, 100)
    if is_first:
        axes.set_ylabel(_("share of the motions [%]"), fontsize=7)


def _series(one: Traced) -> list[tuple[str, str, FloatArray, float]]:
    """Return the record, where one is known, and the first motions: id, name, acceleration [m/s2], time step [s]."""
    motion = one.demand.motion
    record = [] if motion is None else [("record", _("record"), motion.acceleration, motion.time_step)]
    examples = [(f"motion-{at}", _("motion {number}", number=at), np.asarray(values, dtype=np.float64), step)
                for at, (values, step) in enumerate(one.joint.examples, 1)]  # fmt: skip
    return record + examples


def _paint_motions(one: Traced, figure: Any) -> None:
    left, right = figure.subfigures(1, 2, width_ratios=(1.2, 1))
    series = _series(one)
    panels = left.subplots(len(series), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, (gid, name, values, step) in zip(panels, series, strict=True):
        times, shown = thin_out(np.arange(values.size) * step, values / GRAVITY, MOST_SAMPLES)
        colour = RECORD if gid == "record" else MOTION
        axes.plot(times, shown, color=colour, linewidth=0.5)[0].set_gid(gid)
        title = _("{name}: PFA {pfa:.3f} g", name=name, pfa=float(np.abs(values).max()) / GRAVITY)
        axes.set_title(title, loc="left", fontsize=7)
        axes.margins(x=0)
        axes.tick_params(labelsize=6)
        axes.spines[["top", "right"]].set_visible(False)
    left.supylabel(_("acceleration [g]"), fontsize=7)
    panels[-1].set_xlabel(_("time [s]"), fontsize=7)
    if one.joint.spectra is None:
        return
    axes = right.subplots()
    _paint_spectra(axes, one.joint.spectra)
    _paint_wanted(axes, one)
    _frame_spectra(axes, one.joint.spectra.periods)


def _paint_spectra(axes: Any, spectra: Spectra) -> None:
    """Paint every spectrum as one thin curve, what lies between the 16th and the 84th percentile, and the mean."""
    periods, pseudo = spectra.periods, spectra.ordinates / GRAVITY
    shown = slice(None, None, max(1, periods.size // MOST_ORDINATES))
    ends = np.full((len(pseudo), 1), np.nan)  # lifts the pen between two spectra
    every = np.hstack([pseudo[:, shown], ends]).ravel()
    along = np.tile(np.append(periods[shown], np.nan), len(pseudo))
    thin = ngettext("{n} motion", "{n} motions", len(pseudo))
    axes.plot(along, every, color="#a9a9a9", linewidth=0.3, label=thin, zorder=1)[0].set_gid("spectra")
    low, high = np.percentile(pseudo, (16, 84), axis=0)
    axes.fill_between(periods, low, high, color=BAND, alpha=0.7, linewidth=0, zorder=2,
                      label=_("16th to 84th percentile")).set_gid("band")  # fmt: skip
    axes.plot(periods, pseudo.mean(axis=0), color=MEAN, linewidth=1.2, linestyle="--", zorder=4,
              label=_("their mean"))[0].set_gid("mean")  # fmt: skip


def _paint_wanted(axes: Any, one: Traced) -> None:
    """Paint the record's spectrum, which is the target of motions made for it, or the generic target."""
    spectra, motion = one.joint.spectra, one.demand.motion
    if spectra is None:
        return
    if spectra.target is not None:
        pseudo, name = spectra.target, _("target (generic)") if motion is None else _("record, which is the target")
    elif motion is None:
        return
    else:
        pseudo, name = pseudo_acceleration(motion.acceleration, motion.time_step, spectra.periods), _("record")
    axes.plot(spectra.periods, pseudo / GRAVITY, color=RECORD, linewidth=2.2,
              linestyle=":" if motion is None else "-", zorder=3, label=name)[0].set_gid("wanted")  # fmt: skip


def _frame_spectra(axes: Any, periods: FloatArray) -> None:
    axes.set_xscale("log")
    ticks = [tick for tick in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10) if periods[0] * 0.99 <= tick <= periods[-1] * 1.01]
    axes.set_xticks(ticks, [number(tick, "g") for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(periods[0], periods[-1])
    axes.set_ylim(bottom=0)
    axes.set_xlabel(_("period [s]"), fontsize=7)
    axes.set_title(_("5 % pseudo-acceleration [g]"), loc="left", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.grid(visible=True, color="#e0e0e0", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=6, frameon=False, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))
