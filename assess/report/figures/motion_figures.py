"""Figures of motions: recorded ones, and how simulated pieces respond: how sure the chance is, how far they turned."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.i18n import gettext as _, ngettext, number
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.blocks import Figure
from assess.report.content import Content
from assess.report.figures.draw import build_figure, draw, label, thin_out
from assess.results import ItemResult, MotionRow, Results, Series
from assess.risk import LIMITS, RiskClass, wilson_interval
from assess.settings import AUTO
from assess.text import natural_key

FloatArray = NDArray[np.float64]

MOST = 5
"""Pieces whose motions are drawn."""
MOST_STEPS = 300
"""Points of a curve of convergence."""
MOST_SAMPLES, MOST_ORDINATES = 800, 60
"""Points of a curve of acceleration, and of each of the thin spectra."""
RECORD, MOTION, MEAN, BAND = "#1c1c1c", "#1b4f72", "#db7133", "#c6d3dd"
BINS = 10
"""Bars between rest and the critical angle."""


def get_acceleration(results: Results, motion: MotionRow) -> FloatArray | None:
    """Return a recorded motion as treated [g] (n,); None where it is not recorded, or the series are gone.

    That of a motion which serves both axes is kept under the axis that it was recorded along.
    """
    same = (one for one in results.motions if (one.floor, one.record) == (motion.floor, motion.record))
    names = [f"motion/{one.index}/acceleration_g" for one in (motion, *same)] if motion.has_record else []
    found = next((name for name in names if name in results.series), None)
    return None if found is None else results.series[found].astype(np.float64)


def draw_motion(values: FloatArray, time_step_s: float, progress: Progress = SILENT) -> bytes:
    """Draw the treated acceleration [g] of a recorded motion."""

    def paint(figure: Any) -> None:
        axes = figure.subplots()
        times, shown = thin_out(np.arange(values.size) * time_step_s, values)
        axes.plot(times, shown, lw=0.5, color="#1f3a4d")
        peak = int(np.abs(shown).argmax())
        axes.plot([times[peak]], [shown[peak]], "o", ms=4, mfc="none", color="#8c1d3f")
        axes.annotate(_("PFA {pfa:.3f} g", pfa=abs(shown[peak])), (times[peak], shown[peak]), xytext=(6, 0),
                      textcoords="offset points", fontsize=7, va="center")  # fmt: skip
        axes.set_xlabel(_("time [s]"))
        axes.set_ylabel(_("acceleration [g]"))
        axes.margins(x=0.01)
        axes.spines[["top", "right"]].set_visible(False)

    return draw(7, 1.6, paint, progress=progress)


# ---------------------------------------------------------------- the pieces that are drawn


@dataclass(frozen=True, slots=True, eq=False)
class Traced:
    """A piece whose motions are drawn; `alike` are the other rows of its size under the same floor motion.

    `fell` (n,) is whether it overturned under each of its n motions, `rotation` (n,) how far it turned, over the
    critical angle.
    """

    one: ItemResult
    alike: int
    fell: NDArray[np.bool_]
    rotation: NDArray[np.float32]

    @property
    def name(self) -> str:
        """Its name, and how many are like it."""
        name = words.cut(self.one.item.item, 40)
        alike = ngettext("{name} (and {n:,} alike)", "{name} (and {n:,} alike)", self.alike, name=name)
        return alike if self.alike else name


def choose_traced(results: Results, rows: Sequence[ItemResult]) -> list[Traced]:
    """Return the worst simulated piece, those left undecided, and the next worst; of equal pieces one."""
    if not results.series.is_there:
        return []
    simulated = [one for one in rows if one.is_simulated]
    by_risk = sorted(
        [one for one in simulated if not one.is_anchored] or simulated,
        key=lambda one: (
            bool(one.apart), -one.adopted.upper, -found.probability if (found := one.governing.simulation) else 0.0,
            natural_key(one.item.item),
        ),
    )  # fmt: skip
    alike: dict[tuple[int, float, float], list[ItemResult]] = {}
    for one in by_risk:
        alike.setdefault((one.governing.motion.index, one.item.breadth_cm, one.item.height_cm), []).append(one)
    firsts = {own[0].item.index: own for own in alike.values()}
    undecided = [index for index, own in firsts.items() if "undecided" in own[0].adopted.flags]
    chosen = set(list(dict.fromkeys([*list(firsts)[:1], *undecided, *firsts]))[:MOST])
    traced, series = [], results.series
    for one, *others in (own for index, own in firsts.items() if index in chosen):
        motion = f"motion/{one.governing.motion.index}"
        at = int(np.flatnonzero(series[f"{motion}/cases"] == one.governing.index)[0])
        runs, rotation = int(series[f"{motion}/runs"][at]), series[f"{motion}/rotation"][at]
        fell = np.unpackbits(series[f"{motion}/overturned"][at], count=rotation.size).astype(np.bool_)
        traced.append(Traced(one, len(others), fell[:runs], rotation[:runs]))
    return traced


def draw_traced(content: Content, progress: Progress = SILENT) -> Iterator[Figure]:
    """Draw the figures of the simulation, one by one; none where nothing is simulated."""
    traced = choose_traced(content.run, content.results)
    if not traced:
        return
    yield _draw_motions(content.run, traced[0], progress)
    names = ", ".join(one.name for one in traced)
    which = (_("the worst simulated pieces and those left undecided") if content.verified.undecided
             else _("the worst simulated pieces"))  # fmt: skip
    z, is_long = content.run.provenance.interval_z, content.run.settings.runs == AUTO
    yield build_figure(
        draw(7, 2.4, partial(_paint_convergences, traced, z, is_long), progress=progress),
        _("Chance of overturning against the number of motions, with its interval, of {names}", names=names),
        _("Chance of overturning against the number of motions: {names} ({which}). Band: the interval; dashed: the "
          "limits of the classes, 3, 30 and 70 %. The vertical scale is stretched towards 0.",
          names=names, which=which),
    )  # fmt: skip
    yield build_figure(
        draw(7, 2.2, partial(_paint_rotations, traced), progress=progress),
        _("Bars: share of the motions by the largest rotation over the critical angle, and overturned, of {names}",
          names=names),
        _("How far the same pieces turned: largest rotation over the critical angle in each motion. White bar: at "
          "rest; hatched bar: overturned; right of the dashed line: past the critical angle, but without "
          "overturning."),
    )  # fmt: skip


def _draw_motions(results: Results, worst: Traced, progress: Progress) -> Figure:
    governing, series = worst.one.governing.motion, results.series
    floor, axis, motion = words.cut(governing.floor, 20), governing.axis, f"motion/{governing.index}"
    record = get_acceleration(results, governing)
    accelerations: list[Acceleration] = []
    if record is not None:
        accelerations.append(("record", _("record"), record, governing.time_step_s or 0.0))
    for at, step in enumerate(series[f"{motion}/example_steps_s"].tolist()):
        values = series[f"{motion}/example/{at}"].astype(np.float64)
        accelerations.append((f"motion-{at + 1}", _("motion {number}", number=at + 1), values, step))
    has_spectra = f"{motion}/periods_s" in series
    texts = [_("Floor {floor} along {axis}, where {item} stands, the worst simulated piece.",
               floor=floor, axis=axis, item=worst.name)]  # fmt: skip
    examples = len(accelerations) - (record is not None)
    if not has_spectra:
        texts.append(ngettext("The first of the motions.", "The first {n:,} of the motions.", examples))
        shown = _("Acceleration against time of the motions of floor {floor}, {axis}", floor=floor, axis=axis)
    else:
        texts.append(
            ngettext("Left: the recorded motion and the first of those made for it.",
                     "Left: the recorded motion and the first {n:,} of those made for it.", examples)
            if record is not None else
            ngettext("Left: the first of the motions.", "Left: the first {n:,} of the motions.", examples)
        )  # fmt: skip
        texts.append(ngettext(
            "Right: the 5 % response spectrum of {n:,} motion, with the target.",
            "Right: the 5 % response spectra of {n:,} motions, their mean and the band from the 16th to the 84th "
            "percentile, with the target.", len(series[f"{motion}/spectra_g"]),
        ))  # fmt: skip
        shown = _("Acceleration against time and 5 % response spectra of the motions of floor {floor}, {axis}",
                  floor=floor, axis=axis)  # fmt: skip
    height = max(2.9, 0.5 + 0.75 * (1 + len(accelerations)))
    paint = partial(_paint_motions, accelerations, series, motion if has_spectra else "")
    return build_figure(draw(7, height, paint, progress=progress), shown, " ".join(texts))


# ---------------------------------------------------------------- convergence and rotations, one panel a piece


def _list_panels(figure: Any, traced: Sequence[Traced]) -> Iterator[tuple[Any, Traced]]:
    """Yield one panel a piece, and then name it; places that stay free keep the panels of one width."""
    panels = figure.subplots(1, max(3, len(traced)), sharey=True, squeeze=False)[0]
    for axes, one in zip_longest(panels, traced):
        if one is None:
            axes.remove()
            continue
        yield axes, one
        floor = _("floor {floor}", floor=label(one.one.item.floor, 12))
        axes.set_title(f"{label(one.one.item.item, 20)}\n{floor}", fontsize=8, loc="left")
        axes.tick_params(labelsize=7)
        axes.spines[["top", "right"]].set_visible(False)


def _paint_convergences(traced: Sequence[Traced], z: float, is_long: bool, figure: Any) -> None:
    """Paint the chance of each piece as motions are added, with the names of the classes next to the last."""
    spaced = np.geomspace if is_long else np.linspace
    name = _("chance of overturning, by the motions so far")
    for at, (axes, one) in enumerate(_list_panels(figure, traced)):
        counts = np.unique(spaced(1, one.fell.size, MOST_STEPS).round().astype(int))
        fallen = np.cumsum(one.fell)[counts - 1]
        low, high = wilson_interval(fallen, counts, z)
        axes.fill_between(counts, low, high, color=BAND, linewidth=0, label=_("its interval")).set_gid("interval")
        axes.plot(counts, fallen / counts, color=MOTION, linewidth=1.1, clip_on=False, label=name)[0].set_gid("chance")
        for limit in LIMITS:
            axes.axhline(limit, color="#444444", linewidth=0.6, linestyle="--").set_gid("class-limit")
        axes.set_yscale("function", functions=(lambda values: np.sqrt(np.maximum(values, 0)), np.square))
        axes.set_ylim(0, 1)
        axes.set_yticks([0, *LIMITS, 1], [f"{number(100 * tick, 'g')} %" for tick in (0, *LIMITS, 1)])
        axes.set_xscale("log" if is_long else "linear")
        axes.set_xlim(1, max(2, one.fell.size))
        axes.set_xlabel(_("motions"), fontsize=7)
        if at == 0:
            axes.set_ylabel(_("chance of overturning"), fontsize=8)
    edges = np.sqrt([0, *LIMITS, 1])
    for risk, middle in zip(RiskClass, (edges[1:] + edges[:-1]) / 2, strict=True):
        named = axes.text(1.06, middle, words.risk_label(risk), transform=axes.transAxes, fontsize=7, va="center")
        named.set_gid("class")
    drawn, names = axes.get_legend_handles_labels()
    figure.legend(drawn[::-1], names[::-1], loc="outside lower center", ncols=3, fontsize=7, frameon=False)


def _paint_rotations(traced: Sequence[Traced], figure: Any) -> None:
    """Paint how many motions turned a piece how far: at rest, ten steps to the critical angle, beyond, overturned."""
    edge = {"edgecolor": "#444444", "linewidth": 0.5}
    for at, (axes, one) in enumerate(_list_panels(figure, traced)):
        stood = one.rotation[~one.fell]
        counts = np.histogram(stood[stood > 0], bins=np.append(np.linspace(0, 1, BINS + 1), np.inf))[0]
        share = 100 / one.fell.size
        axes.bar(-1, share * np.sum(stood == 0), width=0.8, color="#ffffff", **edge)
        axes.bar(np.arange(BINS + 1) + 0.5, share * counts, width=0.9, color="#8fb3cc", **edge)
        fallen = axes.bar(BINS + 3, share * one.fell.sum(), width=1.2, color=RiskClass.VERY_HIGH.fill, hatch="///",
                          edgecolor="#ffffff", linewidth=0.5)  # fmt: skip
        fallen[0].set_gid("overturned")
        axes.axvline(BINS, color="#444444", linewidth=0.6, linestyle="--")
        names = [_("at rest"), number(0.5, "g"), "1", _("overturned")]
        axes.set_xticks([-1, BINS / 2, BINS, BINS + 3], names, rotation=60, ha="right", rotation_mode="anchor")
        axes.set_ylim(0, 100)
        if at == 0:
            axes.set_ylabel(_("share of the motions [%]"), fontsize=8)
    figure.supxlabel(_("largest rotation, over the critical angle"), fontsize=8)


# ---------------------------------------------------------------- motions and their spectra


Acceleration = tuple[str, str, FloatArray, float]
"""Id, name, acceleration [g] (n,) and time step [s]."""


def _paint_motions(accelerations: Sequence[Acceleration], series: Series, motion: str, figure: Any) -> None:
    """Paint accelerations, and next to them the spectra of a motion, if one is named, their band, mean and target."""
    left = figure
    if motion:
        left, right = figure.subfigures(1, 2, width_ratios=(1.2, 1))
    panels = left.subplots(len(accelerations), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, (gid, name, values, step) in zip(panels, accelerations, strict=True):
        times, shown = thin_out(np.arange(values.size) * step, values, MOST_SAMPLES)
        colour = RECORD if gid == "record" else MOTION
        axes.plot(times, shown, color=colour, linewidth=0.5)[0].set_gid(gid)
        title = _("{name}: PFA {pfa:.3f} g", name=name, pfa=float(np.abs(values).max()))
        axes.set_title(title, loc="left", fontsize=8)
        axes.margins(x=0)
        axes.tick_params(labelsize=7)
        axes.spines[["top", "right"]].set_visible(False)
    left.supylabel(_("acceleration [g]"), fontsize=8)
    panels[-1].set_xlabel(_("time [s]"), fontsize=8)
    if not motion:
        return
    axes = right.subplots()
    periods, pseudo = series[f"{motion}/periods_s"], series[f"{motion}/spectra_g"]
    shown = slice(None, None, max(1, -(-periods.size // MOST_ORDINATES)))
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
    wanted = {"target_g": _("record, which is the target"), "record_spectrum_g": _("record")}
    for key in [key for key in wanted if f"{motion}/{key}" in series][:1]:
        axes.plot(periods, series[f"{motion}/{key}"], color=RECORD, linewidth=2.2, zorder=3,
                  label=wanted[key])[0].set_gid("wanted")  # fmt: skip
    axes.set_xscale("log")
    ticks = [tick for tick in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10) if periods[0] * 0.99 <= tick <= periods[-1] * 1.01]
    axes.set_xticks(ticks, [number(tick, "g") for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(periods[0], periods[-1])
    axes.set_ylim(bottom=0)
    axes.set_xlabel(_("period [s]"), fontsize=8)
    axes.set_title(_("5 % pseudo-acceleration [g]"), loc="left", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(visible=True, color="#e0e0e0", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=7, frameon=False, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))
