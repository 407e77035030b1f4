"""One block under one record, for `assess rock`: what was asked for, and what came out as document, text and figure."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Protocol, cast, get_args

import numpy as np

from assess.errors import InputError
from assess.inventory.columns import ITEMS
from assess.motion.record import MOST_ACCELERATION, Baseline, FloatArray, Motion, treatment
from assess.report import words
from assess.report.commands.records import Channel, check_figure, read_channel, save_figure
from assess.units import GRAVITY, LENGTH

LIMITS = "one rigid block in plane motion: no sliding, no vertical motion, nothing beside it"
TALLEST_DRAWN = 2.0
"""Largest share of the critical angle that the figure shows of a block that overturns [-]."""
MOST_POINTS = 12_000
"""Points of the drawn path."""
LONGEST_NAME = 60
"""Characters of the record's name that the figure shows."""
RECORD, AFTER, PATH, MARK = "#444444", "#b8b8b8", "#1b4f72", "#b03a2e"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Case:
    """What `assess rock` was asked for.

    Parameters
    ----------
    breadth, height : float
        Sizes of the block [m].
    restitution : float
        As given [-]; NaN is Housner's.
    channel : Channel
        The record, as in its file and as treated.
    baseline : str
        How it was treated.
    motion : Motion
        The treated motion times `factor`.
    factor : float
        1 where no peak was asked for [-].
    pfa_g : float
        Peak of the scaled motion [g].
    """

    breadth: float
    height: float
    restitution: float
    channel: Channel
    baseline: Baseline
    motion: Motion
    factor: float
    pfa_g: float

    @property
    def threshold_g(self) -> float:
        """Acceleration above which the block starts to rock, B/H [g]."""
        return self.breadth / self.height


class Response(Protocol):
    """What the block did: what is shown of `assess.rocking.response.Response`, as reports import no physics."""

    # Properties, since nothing here sets them. fmt: off
    @property
    def critical_angle(self) -> float: ...  # noqa: D102
    @property
    def frequency_parameter(self) -> float: ...  # noqa: D102
    @property
    def restitution(self) -> float: ...  # noqa: D102
    @property
    def overturned(self) -> bool: ...  # noqa: D102
    @property
    def rotation(self) -> float: ...  # noqa: D102
    @property
    def fall_time(self) -> float: ...  # noqa: D102
    @property
    def impacts(self) -> int: ...  # noqa: D102
    @property
    def times(self) -> FloatArray: ...  # noqa: D102
    @property
    def theta(self) -> FloatArray: ...  # noqa: D102
    @property
    def impact_times(self) -> FloatArray: ...  # noqa: D102

    # fmt: on


def read_case(
    breadth_cm: float, height_cm: float, record: str, pfa_g: float | None, restitution: float | None, baseline: str
) -> Case:
    """Check what was typed, by the rules of workbooks, and read the record.

    Raises
    ------
    InputError
        If a number or a word cannot be used, and the message names its option; or if the record cannot be read, holds
        several channels and none is named, or is vertical.
    """
    _check_size("breadth", breadth_cm)
    _check_size("height", height_cm)
    most = MOST_ACCELERATION / GRAVITY
    if pfa_g is not None and not 0 < pfa_g <= most:
        raise InputError(f"--pfa is {pfa_g:g} g, expected above 0 and at most {most:g} g")
    if restitution is not None and not 0 <= restitution <= 1:
        raise InputError(f"--restitution is {restitution:g}, expected 0 to 1")
    if baseline not in get_args(Baseline):
        raise InputError(f"--baseline is {baseline!r}, expected one of: {', '.join(get_args(Baseline))}")
    channel = read_channel(record, cast("Baseline", baseline))
    if channel.record.vertical:
        raise InputError(f"{channel.name} is a vertical channel, which topples no furniture. Name a horizontal one.")
    own = channel.motion.pfa / GRAVITY
    factor = 1.0 if pfa_g is None else pfa_g / own
    return Case(
        breadth=breadth_cm * LENGTH["cm"],
        height=height_cm * LENGTH["cm"],
        restitution=math.nan if restitution is None else restitution,
        channel=channel,
        baseline=cast("Baseline", baseline),
        motion=_scale(channel.motion, factor),
        factor=factor,
        pfa_g=own if pfa_g is None else pfa_g,
    )


def _scale(motion: Motion, factor: float) -> Motion:
    own = (motion.acceleration, motion.velocity, motion.displacement)
    acceleration, velocity, displacement = (factor * values for values in own)
    return Motion(acceleration, velocity, displacement, motion.time_step)


def _check_size(name: str, value: float) -> None:
    column = ITEMS.column(name)
    low, high = column.low or 0.0, column.high or math.inf
    if not low <= value <= high:
        raise InputError(f"--{name} is {value:g} cm, expected {low:g} to {high:g} cm")


def describe(case: Case, response: Response) -> dict[str, Any]:
    """Return the document of `assess rock --json`."""
    return {
        "overturned": response.overturned,
        "max_rotation_ratio": response.rotation,
        "impacts": response.impacts,
        "overturn_time_s": response.fall_time if response.overturned else None,
        "pfa_g": case.pfa_g,
        "critical_angle_rad": response.critical_angle,
        "frequency_parameter_rad_s": response.frequency_parameter,
        "restitution": response.restitution,
    }


def list_lines(case: Case, response: Response) -> Iterator[str]:
    """Yield the lines that tell a person what was asked for and what came out."""
    record = case.channel.record
    whose = "given" if case.restitution == case.restitution else "Housner's"
    yield (
        f"Block    {_size(case, 'x')}: B/H {case.threshold_g:.4f}, alpha {math.degrees(response.critical_angle):.2f} "
        f"deg, p {response.frequency_parameter:.3f} rad/s, restitution {response.restitution:.4f} ({whose})"
    )
    azimuth = "" if record.azimuth_deg is None else f"{record.azimuth_deg:g} deg"
    parts = (f"channel {record.channel}", record.location, azimuth, record.format)
    yield f"Record   {case.channel.name} ({', '.join(part for part in parts if part)})"
    yield f"         {treatment(record, case.baseline)}"
    yield from (f"         note: {note}" for note in record.notes)
    yield f"Motion   {_motion(case)}"
    exceeds = "exceeded" if case.pfa_g > case.threshold_g else "not exceeded"
    yield f"Rocks    above g B/H = {case.threshold_g:.4f} g: {exceeds}"
    yield f"Outcome  {tell_outcome(case, response)}"
    yield f"Limits   {LIMITS}"


def _size(case: Case, times: str) -> str:
    return f"{words.in_cm(case.breadth)} {times} {words.in_cm(case.height)} cm"


def _motion(case: Case) -> str:
    """Return the peaks of the motion, before and after scaling."""
    velocity = f"PFV {words.in_cm_s(case.motion.pfv)} cm/s"
    if case.factor == 1:
        return f"PFA {case.pfa_g:.4f} g, {velocity}, not scaled"
    own = case.channel.motion.pfa / GRAVITY
    return f"PFA {own:.4f} g, scaled by {case.factor:.4g} to {case.pfa_g:.4f} g, {velocity}"


def tell_outcome(case: Case, response: Response) -> str:
    """Say in words what the block did."""
    if response.overturned:
        return f"overturns at {response.fall_time:.2f} s, after {words.plural(response.impacts, 'impact')}"
    if response.rotation > 0:
        share = f"{response.rotation:.{2 if response.rotation >= 0.1 else 3}f}"
        share = "less than 0.001" if response.rotation < 0.001 else share
        impacts = words.plural(response.impacts, "impact")
        return f"does not overturn: rotates to {share} of the critical angle, {impacts}"
    above = "does not stay above" if case.pfa_g > case.threshold_g else "does not exceed"
    return f"does not start to rock: the peak {case.pfa_g:.4f} g {above} its threshold {case.threshold_g:.4f} g"


def write_figure(case: Case, response: Response, path: Path) -> None:
    """Draw the motion and the block's rotation over time; OutputError if `path` cannot be written."""
    from assess.report.figures.draw import draw

    check_figure(path)
    save_figure(draw(8, 4.6, partial(_paint, case, response), path.suffix.lower().removeprefix(".")), path)


def _paint(case: Case, response: Response, figure: Any) -> None:
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(1, 1.25))
    outcome = tell_outcome(case, response)
    top.set_title(f"The block {outcome}", loc="left", fontsize=9.5, fontweight="bold", pad=18)
    scaled = "" if case.factor == 1 else f" (scaled by {case.factor:.3g})"
    name = case.channel.name[:LONGEST_NAME].replace("$", r"\$")
    under = f"{_size(case, '×')}, B/H {case.threshold_g:.3f}, under {name}, PFA {case.pfa_g:.3f} g{scaled}"
    top.text(0, 1.03, under, transform=top.transAxes, va="bottom")
    _paint_motion(top, case, response)
    _paint_path(bottom, response)
    end = max((case.motion.acceleration.size - 1) * case.motion.time_step, response.times[-1])
    bottom.set_xlabel("time [s]")
    bottom.set_xlim(0, end)
    for axes in (top, bottom):
        axes.spines[["top", "right"]].set_visible(False)
    if response.overturned:
        _mark_fall((top, bottom), response, end)
    figure.align_ylabels()


def _paint_motion(axes: Any, case: Case, response: Response) -> None:
    from assess.report.figures.draw import thin_out

    values = case.motion.acceleration / GRAVITY
    times, values = thin_out(np.arange(values.size) * case.motion.time_step, values)
    after = times > response.fall_time  # nowhere, where it is NaN
    axes.plot(times[~after], values[~after], color=RECORD, linewidth=0.6)
    axes.plot(times[after], values[after], color=AFTER, linewidth=0.6)
    _paint_limits(axes, case.threshold_g)
    most = 1.3 * max(case.pfa_g, case.threshold_g)
    axes.set_ylim(-most, most)
    axes.set_ylabel("acceleration [g]")
    _note(axes, f"dashed: ±B/H = ±{case.threshold_g:.3f} g, above which it starts to rock")


def _paint_path(axes: Any, response: Response) -> None:
    from assess.report.figures.draw import thin_out

    times, ratio = thin_out(response.times, response.theta / response.critical_angle, MOST_POINTS)
    axes.plot(times, ratio, color=PATH, linewidth=1.1)
    _paint_limits(axes, 1.0)
    low, high = (min(TALLEST_DRAWN, float((side * ratio).max())) for side in (-1, 1))
    axes.set_ylim(-max(1.5, 1.15 * low), max(1.5, 1.15 * high))
    axes.vlines(response.impact_times, 0, 0.04, transform=axes.get_xaxis_transform(), color="#000000", linewidth=0.4)
    axes.set_ylabel("rotation / critical angle [-]")
    ticks = "; ticks: impacts" if response.impacts else ""
    _note(axes, f"dashed: ±1, the critical angle{ticks}")


def _paint_limits(axes: Any, limit: float) -> None:
    for side in (limit, -limit):
        axes.axhline(side, color="#000000", linewidth=0.6, linestyle="--")


def _mark_fall(panels: tuple[Any, Any], response: Response, end: float) -> None:
    for axes in panels:
        axes.axvline(response.fall_time, color=MARK, linewidth=1, linestyle=(0, (4, 2)))
    side = 1 if response.fall_time < 0.7 * end else -1
    panels[1].annotate(f"overturned at {response.fall_time:.2f} s", (response.fall_time, 0), xytext=(4 * side, 0),
                       textcoords="offset points", ha="left" if side > 0 else "right", va="center", color=MARK,
                       bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip


def _note(axes: Any, text: str) -> None:
    axes.text(0.995, 0.98, text, transform=axes.transAxes, ha="right", va="top", fontsize=7, color="#333333",
              bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip
