"""``assess rock``: one block under one record, as text, as one JSON document, as a figure."""

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast, get_args

import typer

from assess.cli.completion import one_of
from assess.cli.console import count, say, show_progress
from assess.cli.options import SIZE, AsJson, check_file, check_size, figure_kind, save_file
from assess.errors import InputError
from assess.units import GRAVITY, LENGTH, SHARE, VELOCITY

if TYPE_CHECKING:
    from assess.cli.rock_extras import Extras
    from assess.motion.formats import Channel
    from assess.motion.record import Baseline, Motion
    from assess.rocking.response import Response

ORDER = 5
EXAMPLES = (
    "assess rock --breadth 40 --height 180 --record floor12.smc",
    "assess rock --breadth 40 --height 180 --record floor12.csv#east --pfa 0.5 --plot rocking.png",
    "assess rock --breadth 40 --height 180 --record floor12.smc --cg 60",
    "assess rock --breadth 40 --height 180 --record floor12.csv#east --vertical floor12.csv#up --wall --friction 0.3",
    "assess rock --breadth 40 --height 180 --record floor12.smc --restitution 0.9 --baseline none --json",
)

LIMITS = "one rigid block in plane motion: no sliding, no vertical motion, nothing beside it"
HIGHEST_DRAWN = 2.0
"""Largest rotation that the figure shows of a block that overturns, as a share of the critical angle [-]."""
MOST_POINTS = 12_000
"""Points of the drawn path."""
LONGEST_NAME = 60
"""Characters of the record's name that the figure shows."""
RECORD, AFTER, PATH, MARK = "#444444", "#b8b8b8", "#1b4f72", "#b03a2e"


def command(
    breadth: Annotated[float, typer.Option(help="Side parallel to the motion [cm].", show_default=False, **SIZE)],
    height: Annotated[float, typer.Option(help="Height [cm].", show_default=False, **SIZE)],
    record: Annotated[str, typer.Option(help="The motion: FILE or FILE#channel.", show_default=False)],
    pfa: Annotated[
        float | None, typer.Option(help="Scale the motion to this peak [g].", show_default="not scaled")
    ] = None,
    cg: Annotated[
        float | None, typer.Option(help="Height of the centre of gravity [% of the height].", show_default="50")
    ] = None,
    restitution: Annotated[
        float | None,
        typer.Option(help="Ratio of angular velocity after an impact to that before it.", show_default="Housner 1963"),
    ] = None,
    baseline: Annotated[
        str,
        typer.Option(
            help="Treatment of an uncorrected record: standard, none.", autocompletion=one_of(("standard", "none"))
        ),
    ] = "standard",
    wall: Annotated[bool, typer.Option("--wall", help="Show what it does with a wall on either side.")] = False,
    vertical: Annotated[
        str | None,
        typer.Option(
            help="Vertical motion, scaled like the horizontal one: FILE or FILE#channel.", show_default="none"
        ),
    ] = None,
    friction: Annotated[
        float | None, typer.Option(help="Show how it starts to move, and how far it slides.", show_default="no sliding")
    ] = None,
    as_json: AsJson = False,
    plot: Annotated[Path | None, typer.Option(help="Draw motion and rotation to this .png, .svg or .pdf.")] = None,
) -> None:
    """Integrate the rocking of one block under one record, by Housner's equation."""
    check_file(plot, "figure")
    with show_progress():
        case = read_case(breadth, height, record, pfa, restitution, baseline, cg)
        from assess.rocking.response import follow_block

        try:
            response = follow_block(
                case.breadth, case.height, case.motion.acceleration, case.motion.time_step,
                restitution=case.restitution, centre=case.centre,
            )  # fmt: skip
        except ValueError as error:  # the stockiest block that rocks is a limit of the integration
            named = "--breadth and --height" if case.is_mid_height else "--breadth, --height and --cg"
            raise InputError(f"{named}: {error}") from None
        from assess.cli.rock_extras import evaluate_extras

        extras = evaluate_extras(case, response, wall=wall, vertical=vertical, friction=friction)
    response, document = extras.response, describe(case, extras.response) | extras.document
    say(json.dumps(document, indent=1) if as_json else "\n".join(list_lines(case, response, extras)))
    if plot is not None:
        write_figure(case, response, plot)
        say(f"wrote {plot}", err=True)


# ---------------------------------------------------------------- what was given


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Case:
    """What `assess rock` was asked for.

    Parameters
    ----------
    breadth, height : float
        Sizes of the block [m].
    centre : float
        Height of its centre of gravity as a share of its height [-].
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
    centre: float
    restitution: float
    channel: "Channel"
    baseline: "Baseline"
    motion: "Motion"
    factor: float
    pfa_g: float

    @property
    def threshold_g(self) -> float:
        """Acceleration above which the block starts to rock [g]: b/z_c, half base over centre of gravity."""
        from assess.rocking.block import threshold

        return float(threshold(self.breadth, self.height, self.centre))

    @property
    def is_mid_height(self) -> bool:
        """Whether the centre of gravity is at mid-height, where b/z_c is B/H."""
        from assess.rocking.block import MIDDLE

        return self.centre == MIDDLE

    @property
    def threshold_name(self) -> str:
        """What the threshold is called."""
        return "B/H" if self.is_mid_height else "b/z_c"


def read_case(
    breadth_cm: float,
    height_cm: float,
    record: str,
    pfa_g: float | None,
    restitution: float | None,
    baseline: str,
    centre_percent: float | None = None,
) -> Case:
    """Check the options, by the limits of the workbook, and read the record.

    Raises
    ------
    InputError
        If an option cannot be used; or if the record cannot be read, holds several channels and none is named, or is
        vertical.
    """
    from assess.motion.formats import read_channel
    from assess.motion.record import MOST_ACCELERATION, Baseline

    check_size("breadth", breadth_cm)
    check_size("height", height_cm)
    centre = _read_centre(centre_percent)
    most = MOST_ACCELERATION / GRAVITY
    if pfa_g is not None and not 0 < pfa_g <= most:
        raise InputError(f"--pfa is {pfa_g:g} g, expected above 0 and at most {most:g} g")
    if restitution is not None and not 0 <= restitution <= 1:
        raise InputError(f"--restitution is {restitution:g}, expected 0 to 1")
    if baseline not in get_args(Baseline):
        raise InputError(f"--baseline is {baseline!r}, expected one of: {', '.join(get_args(Baseline))}")
    channel = read_channel(record, cast("Baseline", baseline))
    if channel.record.vertical:
        raise InputError(f"{channel.name} is a vertical channel: choose a horizontal one.")
    own = channel.motion.pfa / GRAVITY
    factor = 1.0 if pfa_g is None else pfa_g / own
    return Case(
        breadth=breadth_cm * LENGTH["cm"],
        height=height_cm * LENGTH["cm"],
        centre=centre,
        restitution=math.nan if restitution is None else restitution,
        channel=channel,
        baseline=cast("Baseline", baseline),
        motion=_scale(channel.motion, factor),
        factor=factor,
        pfa_g=own if pfa_g is None else pfa_g,
    )


def _read_centre(percent: float | None) -> float:
    """Return the height of the centre of gravity as a share of the block's [-], by the limits of the workbook."""
    from assess.rocking.block import MIDDLE

    if percent is None:
        return MIDDLE
    check_size("cg", percent, "centre_of_gravity")
    return percent * SHARE["%"]


def _scale(motion: "Motion", factor: float) -> "Motion":
    from assess.motion.record import Motion

    own = (motion.acceleration, motion.velocity, motion.displacement)
    acceleration, velocity, displacement = (factor * values for values in own)
    return Motion(acceleration, velocity, displacement, motion.time_step)


# ---------------------------------------------------------------- document and text


def describe(case: Case, response: "Response") -> dict[str, Any]:
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


def list_lines(case: Case, response: "Response", extras: "Extras | None" = None) -> Iterator[str]:
    """Yield the lines of text: the case, its outcome, and what else was asked for."""
    from assess.motion.record import treatment

    record = case.channel.record
    whose = "given" if case.restitution == case.restitution else "Housner's"
    yield (
        f"Block    {_size(case, 'x')}: B/H {case.breadth / case.height:.4f}, "
        f"alpha {math.degrees(response.critical_angle):.2f} deg, p {response.frequency_parameter:.3f} rad/s, "
        f"restitution {response.restitution:.4f} ({whose})"
    )
    if not case.is_mid_height:
        yield f"         {_centre(case)}: b/z_c {case.threshold_g:.4f}"
    azimuth = "" if record.azimuth_deg is None else f"{record.azimuth_deg:g} deg"
    parts = (f"channel {record.channel}", record.location, azimuth, record.format)
    yield f"Record   {case.channel.name} ({', '.join(part for part in parts if part)})"
    yield f"         {treatment(record, case.baseline)}"
    yield from (f"         note: {note}" for note in record.notes)
    yield f"Motion   {_motion(case)}"
    exceeds = "exceeded" if case.pfa_g > case.threshold_g else "not exceeded"
    yield f"Rocks    above g {case.threshold_name} = {case.threshold_g:.4f} g: {exceeds}"
    yield f"Outcome  {describe_outcome(case, response)}"
    if extras is not None:
        yield from extras.lines
    yield f"Limits   {LIMITS.replace(' no vertical motion,', '') if extras and extras.has_vertical else LIMITS}"


def _size(case: Case, times: str) -> str:
    breadth, height = (round(size / LENGTH["cm"], 1) for size in (case.breadth, case.height))
    return f"{breadth:.12g} {times} {height:.12g} cm"


def _centre(case: Case) -> str:
    return f"centre of gravity at {case.centre / SHARE['%']:.12g} % of the height"


def _motion(case: Case) -> str:
    """Return the peaks of the motion, before and after scaling."""
    velocity = f"PFV {case.motion.pfv / VELOCITY['cm/s']:.1f} cm/s"
    if case.factor == 1:
        return f"PFA {case.pfa_g:.4f} g, {velocity}, not scaled"
    own = case.channel.motion.pfa / GRAVITY
    return f"PFA {own:.4f} g, scaled by {case.factor:.4g} to {case.pfa_g:.4f} g, {velocity}"


def describe_outcome(case: Case, response: "Response") -> str:
    """Return in words what the block did."""
    if response.overturned:
        return f"overturns at {response.fall_time:.2f} s, after {count(response.impacts, 'impact')}"
    if response.rotation > 0:
        share = f"{response.rotation:.{2 if response.rotation >= 0.1 else 3}f}"
        share = "less than 0.001" if response.rotation < 0.001 else share
        impacts = count(response.impacts, "impact")
        return f"does not overturn: rotates to {share} of the critical angle, {impacts}"
    above = "does not stay above" if case.pfa_g > case.threshold_g else "does not exceed"
    return f"does not start to rock: the peak {case.pfa_g:.4f} g {above} its threshold {case.threshold_g:.4f} g"


def write_figure(case: Case, response: "Response", path: Path) -> None:
    """Draw the motion and the block's rotation over time; OutputError if `path` cannot be written."""
    from assess.report.figures.draw import draw

    save_file(draw(8, 4.6, partial(_paint, case, response), figure_kind(path)), path)


def _paint(case: Case, response: "Response", figure: Any) -> None:
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(1, 1.25))
    outcome = describe_outcome(case, response)
    top.set_title(f"The block {outcome}", loc="left", fontsize=9.5, fontweight="bold", pad=18)
    scaled = "" if case.factor == 1 else f" (scaled by {case.factor:.3g})"
    name = case.channel.name[:LONGEST_NAME].replace("$", r"\$")
    centre = "" if case.is_mid_height else f", {_centre(case)}"
    block = f"{_size(case, '×')}, B/H {case.breadth / case.height:.3f}{centre}"
    under = f"{block}, under {name}, PFA {case.pfa_g:.3f} g{scaled}"
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


def _paint_motion(axes: Any, case: Case, response: "Response") -> None:
    import numpy as np

    from assess.report.figures.draw import thin_out

    values = case.motion.acceleration / GRAVITY
    times, values = thin_out(case.motion.time_step * np.arange(values.size), values)
    after = times > response.fall_time  # nowhere, where it is NaN
    axes.plot(times[~after], values[~after], color=RECORD, linewidth=0.6)
    axes.plot(times[after], values[after], color=AFTER, linewidth=0.6)
    _paint_limits(axes, case.threshold_g)
    most = 1.3 * max(case.pfa_g, case.threshold_g)
    axes.set_ylim(-most, most)
    axes.set_ylabel("acceleration [g]")
    _note(axes, f"dashed: ±{case.threshold_name} = ±{case.threshold_g:.3f} g, above which it starts to rock")


def _paint_path(axes: Any, response: "Response") -> None:
    from assess.report.figures.draw import thin_out

    times, ratio = thin_out(response.times, response.theta / response.critical_angle, MOST_POINTS)
    axes.plot(times, ratio, color=PATH, linewidth=1.1)
    _paint_limits(axes, 1.0)
    low, high = (min(HIGHEST_DRAWN, float((side * ratio).max())) for side in (-1, 1))
    axes.set_ylim(-max(1.5, 1.15 * low), max(1.5, 1.15 * high))
    axes.vlines(response.impact_times, 0, 0.04, transform=axes.get_xaxis_transform(), color="#000000", linewidth=0.4)
    axes.set_ylabel("rotation / critical angle [-]")
    ticks = "; ticks: impacts" if response.impacts else ""
    _note(axes, f"dashed: ±1, the critical angle{ticks}")


def _paint_limits(axes: Any, limit: float) -> None:
    for side in (limit, -limit):
        axes.axhline(side, color="#000000", linewidth=0.6, linestyle="--")


def _mark_fall(panels: tuple[Any, Any], response: "Response", end: float) -> None:
    for axes in panels:
        axes.axvline(response.fall_time, color=MARK, linewidth=1, linestyle=(0, (4, 2)))
    side = 1 if response.fall_time < 0.7 * end else -1
    panels[1].annotate(f"overturned at {response.fall_time:.2f} s", (response.fall_time, 0), xytext=(4 * side, 0),
                       textcoords="offset points", ha="left" if side > 0 else "right", va="center", color=MARK,
                       bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip


def _note(axes: Any, text: str) -> None:
    axes.text(0.995, 0.98, text, transform=axes.transAxes, ha="right", va="top", fontsize=7, color="#333333",
              bbox={"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85})  # fmt: skip
