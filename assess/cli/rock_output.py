"""What `assess rock` finds and shows: a block under its record; on request vertical motion, a wall and sliding."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np

from assess.arrays import FloatArray
from assess.cli.options import check_size
from assess.errors import InputError
from assess.i18n import count
from assess.motion.formats import Channel, read_channel, read_channels
from assess.motion.record import MOST_ACCELERATION, Baseline, Motion, treat, treatment
from assess.report.figures.draw import draw, thin_out
from assess.rocking.block import MIDDLE, threshold
from assess.rocking.ensemble import Response, follow_block
from assess.rocking.planar import Away, Body, follow_body
from assess.rocking.sliding import Branch, branch, critical_friction, is_outside_shenton, peak_slip
from assess.units import GRAVITY, LENGTH, SHARE, VELOCITY

LIMITS = "one rigid block in plane motion: no sliding, no vertical motion, nothing beside it"
LENGTHS_WITHIN = 0.01
"""Share by which the vertical channel may be shorter or longer than the horizontal one [-]."""
SIDES: Mapping[str, Away] = {"negative_side": 1, "positive_side": -1}
"""On which side of the block the wall is, by the sign of the record, and to which it can turn then."""
HIGHEST_DRAWN = 2.0
"""Largest rotation that the figure shows of a block that overturns, as a share of the critical angle [-]."""
MOST_POINTS = 12_000  # points of the drawn path
LONGEST_NAME = 60  # characters of the record's name that the figure shows
RECORD, AFTER, PATH, MARK = "#444444", "#b8b8b8", "#1b4f72", "#b03a2e"
BOX = {"facecolor": "white", "edgecolor": "none", "pad": 1, "alpha": 0.85}
"""What stands behind a note in the figure."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Case:
    """What `assess rock` was asked for: sizes in m, the height of the centre of gravity as a share of the height.

    A restitution of NaN is Housner's. `channel` is the record as treated by `baseline`, `motion` that times `factor`,
    and `pfa_g` its peak [g].
    """

    breadth: float
    height: float
    centre: float
    restitution: float
    channel: Channel
    baseline: Baseline
    motion: Motion
    factor: float
    pfa_g: float

    @property
    def threshold_g(self) -> float:
        """Acceleration above which the block starts to rock [g]: b/z_c, half base over centre of gravity."""
        return float(threshold(self.breadth, self.height, self.centre))

    @property
    def is_mid_height(self) -> bool:
        """Whether the centre of gravity is at mid-height, where b/z_c is B/H."""
        return self.centre == MIDDLE

    @property
    def threshold_name(self) -> str:
        """What the threshold is called."""
        return "B/H" if self.is_mid_height else "b/z_c"


def read_case(
    breadth_cm: float, height_cm: float, record: str, pfa_g: float | None, restitution: float | None, baseline: str,
    centre_percent: float | None = None,
) -> Case:  # fmt: skip
    """Check the options, by the limits of the workbook, and read the record; InputError where one cannot be used."""
    check_size("breadth", breadth_cm)
    check_size("height", height_cm)
    if centre_percent is not None:
        check_size("cg", centre_percent, "centre_of_gravity")
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
    own = channel.motion
    factor = 1.0 if pfa_g is None else pfa_g / (own.pfa / GRAVITY)
    return Case(
        breadth=breadth_cm * LENGTH["cm"], height=height_cm * LENGTH["cm"],
        centre=MIDDLE if centre_percent is None else centre_percent * SHARE["%"],
        restitution=math.nan if restitution is None else restitution,
        channel=channel, baseline=cast("Baseline", baseline),
        motion=Motion(factor * own.acceleration, factor * own.velocity, factor * own.displacement, own.time_step),
        factor=factor, pfa_g=own.pfa / GRAVITY if pfa_g is None else pfa_g,
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What the block does, with the vertical motion where given, and what else was asked for, as data and lines."""

    response: Response
    document: dict[str, Any] = field(default_factory=dict)
    lines: tuple[str, ...] = ()


def evaluate(case: Case, *, wall: bool = False, vertical: str | None = None, friction: float | None = None) -> Found:
    """Integrate the block under its record, and evaluate what else was asked for; InputError where that cannot be."""
    motion = case.motion
    try:
        response = free = follow_block(
            case.breadth, case.height, motion.acceleration, motion.time_step,
            restitution=case.restitution, centre=case.centre,
        )  # fmt: skip
    except ValueError as error:  # the stockiest block that rocks is a limit of the integration
        named = "--breadth and --height" if case.is_mid_height else "--breadth, --height and --cg"
        raise InputError(f"{named}: {error}") from None
    if friction is not None:
        check_size("friction", friction)
    centre_height = case.breadth / 2 / math.tan(free.critical_angle)
    body = Body.of(
        half_base=case.breadth / 2, centre_height=centre_height, frequency_parameter=free.frequency_parameter,
        restitution=free.restitution,
    )  # fmt: skip
    document: dict[str, Any] = {}
    lines: list[str] = []
    up = None

    def follow(away: Away) -> Response:
        try:
            return follow_body(body, motion.acceleration, motion.time_step, vertical=up, away=away)
        except ValueError as error:
            raise InputError(f"--vertical: {error}") from None

    if vertical is not None:
        name, up = read_vertical(vertical, case)
        response, peak = follow(0), float(np.abs(up).max()) / GRAVITY
        document["vertical"] = {"channel": name, "pfa_g": peak, "without": describe_verdict(free)}
        scaled = "" if case.factor == 1 else f", scaled by {case.factor:.4g} like the horizontal motion"
        lines.append(f"Vertical {name}: peak {peak:.4f} g{scaled}")
        lines.append(f"         without it, the block {_tell(free)}")
    if wall:
        sides = {where: follow(away) for where, away in SIDES.items()}
        verdicts = {where: describe_verdict(one) for where, one in sides.items()}
        document["wall"] = {"rebound": float(body.rebound)} | verdicts
        for begin, (where, one) in zip(("Wall ", "     "), sides.items(), strict=True):
            lines.append(f"{begin}    on the {where.replace('_', ' ')} of the record: {_tell(one)}")
        lines += [
            f"         rebound {float(body.rebound):.4f} times the velocity (after Sorrentino et al. 2011, to be "
            "checked)",
            "         the wall is taken to move with the floor, without pounding: this lowers no risk",
        ]
    if friction is not None:
        document["friction"], said = _slide(case, centre_height / case.height, friction)
        lines += said
    return Found(response, document, tuple(lines))


def read_vertical(name: str, case: Case) -> tuple[str, FloatArray]:
    """Return the name of a vertical channel and its samples [m/s2] at the times of the horizontal one, scaled alike.

    Both are taken to begin at the same instant. InputError where there is not one such channel of that length.
    """
    channels = read_channels(name)
    upright = [channel for channel in channels if channel.record.vertical]
    if not upright and len(channels) == 1 and channels[0].record.vertical is None:
        upright = channels  # named by the user, while its file does not say whether it is vertical
    file, held = Path(name).name, ", ".join(channel.name for channel in upright or channels)
    if not upright and len(channels) == 1:
        raise InputError(f"--vertical: {held} is a horizontal channel: choose the vertical one")
    if not upright:
        raise InputError(f"--vertical: {file} holds no vertical channel: it holds {held}")
    if len(upright) > 1:
        raise InputError(f"--vertical: {file} holds {len(upright)} vertical channels: name one of {held}")
    own, across = treat(upright[0].record, case.baseline), case.motion
    lasts, wanted = ((motion.acceleration.size - 1) * motion.time_step for motion in (own, across))
    if abs(lasts - wanted) > LENGTHS_WITHIN * wanted:
        raise InputError(
            f"--vertical: the channel lasts {lasts:.2f} s and the horizontal one {wanted:.2f} s: give the vertical "
            "channel of the same recording"
        )
    times, wanted_times = (motion.time_step * np.arange(motion.acceleration.size) for motion in (own, across))
    found = np.interp(wanted_times, times, own.acceleration, right=0.0)
    return upright[0].name, case.factor * np.asarray(found, dtype=np.float64)


def _slide(case: Case, share: float, friction: float) -> tuple[dict[str, Any], list[str]]:
    """Return how the block starts to move and how far it slides, as data and lines; `share` as `Case.centre`."""
    sizes, peak = (case.breadth, case.height), case.pfa_g * GRAVITY
    needed = float(critical_friction(*sizes, peak, centre=share))
    slip = peak_slip(friction, case.motion.acceleration[np.newaxis], case.motion.time_step)[0, 0]
    start, is_outside = Branch(int(branch(*sizes, friction, peak, centre=share)[0])), bool(is_outside_shenton(share))
    starts = "the block stays at rest" if start is Branch.REST else f"the block starts to {start.word}"
    lines = [f"Friction {friction:g}: at the peak acceleration {starts} (Shenton 1996)"]
    if not math.isnan(needed):
        lines.append(f"         it rocks without sliding from a friction of {needed:.4f} on")
    if is_outside:
        lines.append("         extended from Shenton's centre of gravity at half height to this block's")
    slip_cm = float(slip) / LENGTH["cm"]
    lines.append(f"         sliding without rocking, it slips by {slip_cm:.2f} cm at most (Newmark 1965)")
    lines.append("         the outcome above is that without sliding")
    return {
        "coefficient": friction, "branch": start.word,
        "critical_friction": None if math.isnan(needed) else needed,
        "outside_shenton": is_outside, "peak_slip_cm": slip_cm,
    }, lines  # fmt: skip


def describe(case: Case, found: Found) -> dict[str, Any]:
    """Return the document of `assess rock --json`."""
    response = found.response
    return {
        **describe_verdict(response),
        "pfa_g": case.pfa_g, "critical_angle_rad": response.critical_angle,
        "frequency_parameter_rad_s": response.frequency_parameter, "restitution": response.restitution,
        **found.document,
    }  # fmt: skip


def describe_verdict(response: Response) -> dict[str, Any]:
    """Return what a block did as a part of the document."""
    return {
        "overturned": response.overturned, "max_rotation_ratio": response.rotation, "impacts": response.impacts,
        "overturn_time_s": response.fall_time if response.overturned else None,
    }  # fmt: skip


def list_lines(case: Case, found: Found) -> Iterator[str]:
    """Yield the lines of text: the case, its outcome, and what else was asked for."""
    record, response = case.channel.record, found.response
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
    peak = f"PFA {case.channel.motion.pfa / GRAVITY:.4f} g"
    velocity = f"PFV {case.motion.pfv / VELOCITY['cm/s']:.1f} cm/s"
    if case.factor == 1:
        yield f"Motion   PFA {case.pfa_g:.4f} g, {velocity}, not scaled"
    else:
        yield f"Motion   {peak}, scaled by {case.factor:.4g} to {case.pfa_g:.4f} g, {velocity}"
    exceeds = "exceeded" if case.pfa_g > case.threshold_g else "not exceeded"
    yield f"Rocks    above g {case.threshold_name} = {case.threshold_g:.4f} g: {exceeds}"
    yield f"Outcome  {describe_outcome(case, response)}"
    yield from found.lines
    yield f"Limits   {LIMITS.replace(' no vertical motion,', '') if 'vertical' in found.document else LIMITS}"


def _size(case: Case, times: str) -> str:
    breadth, height = (round(size / LENGTH["cm"], 1) for size in (case.breadth, case.height))
    return f"{breadth:.12g} {times} {height:.12g} cm"


def _centre(case: Case) -> str:
    return f"centre of gravity at {case.centre / SHARE['%']:.12g} % of the height"


def describe_outcome(case: Case, response: Response) -> str:
    """Return in words what the block did."""
    if response.overturned:
        return _tell(response)
    if response.rotation > 0:
        share = f"{response.rotation:.{2 if response.rotation >= 0.1 else 3}f}"
        share = "less than 0.001" if response.rotation < 0.001 else share
        impacts = count(response.impacts, "impact")
        return f"does not overturn: rotates to {share} of the critical angle, {impacts}"
    above = "does not stay above" if case.pfa_g > case.threshold_g else "does not exceed"
    return f"does not start to rock: the peak {case.pfa_g:.4f} g {above} its threshold {case.threshold_g:.4f} g"


def _tell(response: Response) -> str:
    """Return in short what a block did."""
    impacts = count(response.impacts, "impact")
    if response.overturned:
        return f"overturns at {response.fall_time:.2f} s, after {impacts}"
    if response.rotation == 0:
        return "does not start to rock"
    return f"rotates to {response.rotation:.3f} of the critical angle, {impacts}"


def draw_figure(case: Case, response: Response, kind: str) -> bytes:
    """Draw the motion and the block's rotation over time, as "svg", "pdf" or "png"."""
    return draw(8, 4.6, lambda figure: paint(case, response, figure), kind)


def paint(case: Case, response: Response, figure: Any) -> None:
    """Paint the motion above the block's rotation, with the limits of both and where it overturns."""
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(1, 1.25))
    outcome = describe_outcome(case, response)
    top.set_title(f"The block {outcome}", loc="left", fontsize=9.5, fontweight="bold", pad=18)
    scaled = "" if case.factor == 1 else f" (scaled by {case.factor:.3g})"
    name = case.channel.name[:LONGEST_NAME].replace("$", r"\$")
    centre = "" if case.is_mid_height else f", {_centre(case)}"
    block = f"{_size(case, '×')}, B/H {case.breadth / case.height:.3f}{centre}"
    under = f"{block}, under {name}, PFA {case.pfa_g:.3f} g{scaled}"
    top.text(0, 1.03, under, transform=top.transAxes, va="bottom")
    values = case.motion.acceleration / GRAVITY
    times, values = thin_out(case.motion.time_step * np.arange(values.size), values)
    after = times > response.fall_time  # nowhere, where it is NaN
    top.plot(times[~after], values[~after], color=RECORD, linewidth=0.6)
    top.plot(times[after], values[after], color=AFTER, linewidth=0.6)
    most = 1.3 * max(case.pfa_g, case.threshold_g)
    top.set_ylim(-most, most)
    top.set_ylabel("acceleration [g]")
    limit = f"±{case.threshold_name} = ±{case.threshold_g:.3f} g, above which it starts to rock"
    _paint_limits(top, case.threshold_g, limit)
    times, ratio = thin_out(response.times, response.theta / response.critical_angle, MOST_POINTS)
    bottom.plot(times, ratio, color=PATH, linewidth=1.1)
    low, high = (min(HIGHEST_DRAWN, float((side * ratio).max())) for side in (-1, 1))
    bottom.set_ylim(-max(1.5, 1.15 * low), max(1.5, 1.15 * high))
    bottom.vlines(response.impact_times, 0, 0.04, transform=bottom.get_xaxis_transform(), color="#000000",
                  linewidth=0.4)  # fmt: skip
    bottom.set_ylabel("rotation / critical angle [-]")
    _paint_limits(bottom, 1.0, f"±1, the critical angle{'; ticks: impacts' if response.impacts else ''}")
    end = max((case.motion.acceleration.size - 1) * case.motion.time_step, response.times[-1])
    bottom.set_xlabel("time [s]")
    bottom.set_xlim(0, end)
    for axes in (top, bottom):
        axes.spines[["top", "right"]].set_visible(False)
        if response.overturned:
            axes.axvline(response.fall_time, color=MARK, linewidth=1, linestyle=(0, (4, 2)))
    if response.overturned:
        side = 1 if response.fall_time < 0.7 * end else -1
        bottom.annotate(f"overturned at {response.fall_time:.2f} s", (response.fall_time, 0), xytext=(4 * side, 0),
                        textcoords="offset points", ha="left" if side > 0 else "right", va="center", color=MARK,
                        bbox=BOX)  # fmt: skip
    figure.align_ylabels()


def _paint_limits(axes: Any, limit: float, meaning: str) -> None:
    for side in (limit, -limit):
        axes.axhline(side, color="#000000", linewidth=0.6, linestyle="--")
    axes.text(0.995, 0.98, f"dashed: {meaning}", transform=axes.transAxes, ha="right", va="top", fontsize=7,
              color="#333333", bbox=BOX)  # fmt: skip
