"""What `assess rock` adds on request: vertical motion, a wall at the back, sliding."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from assess.cli.console import count
from assess.errors import InputError
from assess.units import GRAVITY, LENGTH

if TYPE_CHECKING:
    from assess.motion.record import Baseline, FloatArray, Motion
    from assess.rocking.planar import Away, Body
    from assess.rocking.response import Response

LENGTHS_WITHIN = 0.01
"""Share by which the vertical channel may be shorter or longer than the horizontal one [-]."""
SIDES: "Mapping[str, Away]" = {"negative_side": 1, "positive_side": -1}
"""On which side of the block the wall is, by the sign of the record, and to which it can turn then."""


class RockCase(Protocol):
    """What `assess rock` was asked for, as far as it is needed here."""

    @property
    def breadth(self) -> float:
        """Side parallel to the motion [m]."""
        ...

    @property
    def height(self) -> float:
        """[m]."""
        ...

    @property
    def baseline(self) -> "Baseline":
        """How records are treated."""
        ...

    @property
    def motion(self) -> "Motion":
        """The scaled motion."""
        ...

    @property
    def factor(self) -> float:
        """What it was scaled by [-]."""
        ...

    @property
    def pfa_g(self) -> float:
        """Its peak [g]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Extras:
    """What was asked for besides the block under its record.

    Parameters
    ----------
    response : Response
        The outcome that counts: with the vertical motion, where one was given.
    document : dict
        Keys that are added to the document of `assess rock --json`.
    lines : tuple of str
        Lines that are added to the text.
    has_vertical : bool
        Whether `response` is under vertical motion, too.
    """

    response: "Response"
    document: dict[str, Any] = field(default_factory=dict)
    lines: tuple[str, ...] = ()
    has_vertical: bool = False


def evaluate_extras(
    case: RockCase, response: "Response", *, wall: bool, vertical: str | None, friction: float | None
) -> Extras:
    """Evaluate what was asked for beside the `response` of a free block under horizontal motion.

    Raises
    ------
    InputError
        If friction lies outside the limits of the workbook, or the vertical channel cannot be used.
    """
    if friction is not None:
        from assess.workbook.schema import ITEMS

        column = ITEMS.column("friction")
        low, high = column.low or 0.0, column.high or math.inf
        if not low <= friction <= high:
            raise InputError(f"--friction is {friction:g}, expected {low:g} to {high:g}")
    document: dict[str, Any] = {}
    lines: list[str] = []
    body, up, found = _build_body(case, response), None, response
    if vertical is not None:
        name, up = read_vertical(vertical, case)
        found = _follow(case, body, up, 0)
        document["vertical"] = {
            "channel": name,
            "pfa_g": float(np.abs(up).max()) / GRAVITY,
            "without": describe_verdict(response),
        }
        scaled = "" if case.factor == 1 else f", scaled by {case.factor:.4g} like the horizontal motion"
        lines.append(f"Vertical {name}: peak {np.abs(up).max() / GRAVITY:.4f} g{scaled}")
        lines.append(f"         without it, the block {_tell(response)}")
    if wall:
        beside = {where: _follow(case, body, up, away) for where, away in SIDES.items()}
        document["wall"] = {"rebound": float(body.rebound)} | {
            where: describe_verdict(one) for where, one in beside.items()
        }
        lines += _list_wall(body, beside)
    if friction is not None:
        document["friction"] = _describe_friction(case, response, friction)
        lines += _list_friction(document["friction"])
    return Extras(response=found, document=document, lines=tuple(lines), has_vertical=up is not None)


def _build_body(case: RockCase, response: "Response") -> "Body":
    """Return the block of a response, whose half base and angle give the height of its centre of gravity."""
    from assess.rocking.planar import Body

    return Body.of(
        half_base=case.breadth / 2,
        centre_height=_centre_height(case, response),
        frequency_parameter=response.frequency_parameter,
        restitution=response.restitution,
    )


def _centre_height(case: RockCase, response: "Response") -> float:
    return case.breadth / 2 / math.tan(response.critical_angle)


def _follow(case: RockCase, body: "Body", up: "FloatArray | None", away: "Away") -> "Response":
    from assess.rocking.planar import follow_body

    try:
        return follow_body(body, case.motion.acceleration, case.motion.time_step, vertical=up, away=away)
    except ValueError as error:
        raise InputError(f"--vertical: {error}") from None


# ---------------------------------------------------------------- vertical motion


def read_vertical(name: str, case: RockCase) -> tuple[str, "FloatArray"]:
    """Return the name of a vertical channel and its samples [m/s2] at the times of the horizontal one, scaled alike.

    Both are taken to begin at the same instant.

    Raises
    ------
    InputError
        If it cannot be read, or holds no vertical channel or several; or if it is not as long as the horizontal one.
    """
    from assess.motion.formats import read_channels
    from assess.motion.record import treat

    channels = read_channels(name)
    upright = [channel for channel in channels if channel.record.vertical]
    if not upright and len(channels) == 1 and channels[0].record.vertical is None:
        upright = channels  # named by the user; the file does not tell
    file, held = Path(name).name, ", ".join(channel.name for channel in upright or channels)
    if not upright and len(channels) == 1:
        raise InputError(f"--vertical: {held} is a horizontal channel: choose the vertical one")
    if not upright:
        raise InputError(f"--vertical: {file} holds no vertical channel: it holds {held}")
    if len(upright) > 1:
        raise InputError(f"--vertical: {file} holds {len(upright)} vertical channels: name one of {held}")
    own = treat(upright[0].record, case.baseline)
    return upright[0].name, case.factor * _put_on_times(own, case.motion)


def _put_on_times(vertical: "Motion", horizontal: "Motion") -> "FloatArray":
    """Return a vertical acceleration at the times of the horizontal one; InputError if they differ in length."""
    size = horizontal.acceleration.size
    lengths = [(motion.acceleration.size - 1) * motion.time_step for motion in (vertical, horizontal)]
    if abs(lengths[0] - lengths[1]) > LENGTHS_WITHIN * lengths[1]:
        raise InputError(
            f"--vertical: the channel lasts {lengths[0]:.2f} s and the horizontal one {lengths[1]:.2f} s: give the "
            "vertical channel of the same recording"
        )
    own = vertical.time_step * np.arange(vertical.acceleration.size)
    found = np.interp(horizontal.time_step * np.arange(size), own, vertical.acceleration, right=0.0)
    return np.asarray(found, dtype=np.float64)


# ---------------------------------------------------------------- wall


def _list_wall(body: "Body", beside: Mapping[str, "Response"]) -> Iterator[str]:
    begin = "Wall    "
    for where, one in beside.items():
        yield f"{begin} on the {where.replace('_', ' ')} of the record: {_tell(one)}"
        begin = " " * len(begin)
    yield f"{begin} rebound {float(body.rebound):.4f} times the velocity (after Sorrentino et al. 2011, to be checked)"
    yield f"{begin} the wall is taken to move with the floor, without pounding: this lowers no risk"


def describe_verdict(response: "Response") -> dict[str, Any]:
    """Return what a block did as a part of the document."""
    return {
        "overturned": response.overturned,
        "max_rotation_ratio": response.rotation,
        "impacts": response.impacts,
        "overturn_time_s": response.fall_time if response.overturned else None,
    }


def _tell(response: "Response") -> str:
    impacts = count(response.impacts, "impact")
    if response.overturned:
        return f"overturns at {response.fall_time:.2f} s, after {impacts}"
    if response.rotation == 0:
        return "does not start to rock"
    return f"rotates to {response.rotation:.3f} of the critical angle, {impacts}"


# ---------------------------------------------------------------- sliding


def _describe_friction(case: RockCase, response: "Response", friction: float) -> dict[str, Any]:
    from assess.rocking.sliding import Branch, branch, critical_friction, is_outside_shenton, peak_slip

    share = _centre_height(case, response) / case.height
    sizes, peak = (case.breadth, case.height), case.pfa_g * GRAVITY
    first = Branch(int(branch(*sizes, friction, peak, centre=share)[0]))
    needed = float(critical_friction(*sizes, peak, centre=share))
    slip = peak_slip(friction, case.motion.acceleration[np.newaxis], case.motion.time_step)[0, 0]
    return {
        "coefficient": friction,
        "branch": first.word,
        "critical_friction": None if math.isnan(needed) else needed,
        "outside_shenton": bool(is_outside_shenton(share)),
        "peak_slip_cm": float(slip) / LENGTH["cm"],
    }


def _list_friction(found: Mapping[str, Any]) -> Iterator[str]:
    from assess.rocking.sliding import Branch

    rests = found["branch"] == Branch.REST.word
    starts = "the block stays at rest" if rests else f"the block starts to {found['branch']}"
    needed = found["critical_friction"]
    yield f"Friction {found['coefficient']:g}: at the peak acceleration {starts} (Shenton 1996)"
    if needed is not None:
        yield f"         it rocks without sliding from a friction of {needed:.4f} on"
    if found["outside_shenton"]:
        yield "         extended from Shenton's centre of gravity at half height to this block's"
    yield f"         sliding without rocking, it slips by {found['peak_slip_cm']:.2f} cm at most (Newmark 1965)"
    yield "         the outcome above is that without sliding"
