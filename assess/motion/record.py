"""One recorded channel, and the one treatment that every use of it shares.

Uncorrected records pass a Butterworth high-pass, forward and backward, so that no phase is shifted.

Source of the length of the pads: Boore DM (2005). On pads and filters: processing strong-motion data. Bulletin of the
Seismological Society of America 95(2):745-750. doi:10.1785/0120040160
"""

import math
from dataclasses import dataclass, field
from threading import Lock
from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np

from assess.arrays import FloatArray
from assess.errors import RecordError
from assess.i18n import Text, fill, nfill
from assess.progress import SILENT, Progress
from assess.text import plain_line
from assess.units import GRAVITY

PASS_ORDER = 2
"""Order of the Butterworth filter in each pass."""
SLICE = 200_000
"""Samples that are filtered between two checks for a cancel: 0.05 s."""


def high_pass_both_ways(
    values: FloatArray, time_step: float, corner: float, pad: int, progress: Progress
) -> FloatArray:
    """Return `values` (n,), one every `time_step` [s], filtered above `corner` [Hz] with `pad` zeros at both ends.

    `progress` is asked for every `SLICE` samples whether to stop. Returned: (n + 2 pad,).
    """
    # A digital high-pass of PASS_ORDER 2 by the bilinear transform, in the steps of `scipy.signal.butter` and their
    # order: its poles nearly meet its zeros, and a rounding error in a coefficient changes a motion by up to 1e-12 of
    # its peak.
    prototype = -np.exp(1j * np.pi * np.array([-1.0, 1.0]) / (2 * PASS_ORDER))
    poles = 4.0 * np.tan(np.pi * (2 * corner / (1 / time_step)) / 2.0) / prototype
    gain = np.real(1 / np.prod(-prototype)) * np.real(16.0 / np.prod(4.0 - poles))
    pole = ((4.0 + poles) / (4.0 - poles))[0]
    _, a1, a2 = np.poly([pole, pole.conj()]).real.tolist()
    b0, b1, b2 = float(gain), -2.0 * float(gain), float(gain)
    section = b0, b1, b2, a1, a2
    # The zeros in front leave a filter at rest as it is: only those at the end are passed through it.
    forward = np.pad(_filter(section, np.pad(values, (0, pad)), (0.0, 0.0), progress), (pad, 0))
    value = float(forward[-1])
    # Backward it starts in the state of a section that has passed the same value for ever.
    z0, z1 = np.linalg.solve([[1.0 + a1, -1.0], [a2, 1.0]], [b1 - a1 * b0, b2 - a2 * b0])
    return _filter(section, forward[::-1], (float(z0) * value, float(z1) * value), progress)[::-1]


def _filter(
    section: tuple[float, ...], values: FloatArray, state: tuple[float, float], progress: Progress
) -> FloatArray:
    """Return `values` (n,) passed through a second-order section in transposed direct form II.

    A loop in Python takes 10 ms for a usual record; importing `scipy.signal`, whose results it equals bit by bit, takes
    a second.
    """
    (b0, b1, b2, a1, a2), (z0, z1) = section, state
    passed = np.empty_like(values)
    for start in range(0, values.size, SLICE):
        progress.check()
        part = []
        for value in values[start : start + SLICE].tolist():
            out = b0 * value + z0
            z0 = b1 * value - a1 * out + z1
            z1 = b2 * value - a2 * out
            part.append(out)
        passed[start : start + SLICE] = part
    return passed


SHOWN = ("file", "format", "channel", "location", "station", "event", "start", "recorder")
"""Fields of a record that hold texts of its file."""

Baseline = Literal["standard", "none"]

CORNER = 0.1
"""Corner of the high-pass [Hz]: the response is 1/sqrt(2) there in each of the two passes, 0.5 after both."""
PASSES = 2
"""Forward and backward, so that no phase is shifted; the order in effect is PASS_ORDER * PASSES = 4."""
PAD = 1.5 * PASS_ORDER * PASSES / CORNER
"""Zeros before and after the samples while they are filtered [s]: 1.5 n / fc (Boore 2005), here 60 s at each end."""

RESAMPLED_STEP = 0.005
"""Step of channels that are not evenly sampled [s], that of most corrected USGS files.

Measured on the eleven channels of 575 Market Street (median step 0.0014 s), treated at 0.005 s against 0.0005 s: PFA
falls by 0.01 to 0.40 %, PFV changes by -0.07 to +0.09 %. At 0.002 s that is 0.04 and 0.02 %, for 2.5 times the samples.
"""

SHORTEST_STEP, LONGEST_STEP = 1e-5, 0.1
"""Time steps that are believed [s]: a longer one misses the peaks, and mostly means milliseconds read as seconds."""
FEWEST_SAMPLES, MOST_SAMPLES = 10, 4_000_000
MOST_ACCELERATION = 50 * GRAVITY
"""Peaks above this [m/s2] are a slip in the unit or a damaged file."""
LATEST_TIME = 1e11
"""Times beyond this [s] are damaged; seconds since 1970 are fine."""
MOST_LEFT_OUT = 0.01
"""Share of a channel's samples that may be left out [-]."""
EVEN_WITHIN = 0.05
"""Times this close to an even grid, in steps [-], are even: it leaves room for times printed with few digits."""
GAP = 0.1
"""Steps above this [s] are named as gaps."""


MOST_TREATED = 2_000_000
"""Samples of the treated motions that are kept for as long as their records are in use: 48 MB."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, weakref_slot=True)
class Record:
    """One channel as its file has it, evenly sampled and in SI, but untreated.

    * `file`, `format`, `channel`, `location`, `station`, `event`, `start`: as shown to people, each on one line and
      without control characters; "" where the file does not say.
    * `azimuth_deg`: direction of positive acceleration, clockwise from north [deg].
    * `vertical`: whether the channel is vertical, None where it is unknown; only horizontal motion overturns furniture.
    * `corrected`: whether the provider has already filtered it.
    * `time_step`: [s]
    * `acceleration` (n,): [m/s2]
    * `file_pfa`, `header_pfa`: peak of the file's own samples, before any resampling, and the one printed in its
      header, if any [m/s2]. Where the samples carry the instrument's offset (K-NET, SAC, miniSEED), it is that about
      their mean.
    * `notes`: what reading changed, in plain words.
    * `recorder`: number of the recorder, whose channels share one clock; "" where the file does not say.

    Raises RecordError if the samples or the time step cannot be a recorded motion.
    """

    file: str
    format: str
    channel: str
    location: str
    azimuth_deg: float | None
    vertical: bool | None
    station: str
    event: str
    start: str
    corrected: bool
    time_step: float
    acceleration: FloatArray
    file_pfa: float
    header_pfa: float | None
    notes: tuple[str, ...] = ()
    recorder: str = ""

    def __post_init__(self) -> None:
        for name in SHOWN:
            object.__setattr__(self, name, plain_line(getattr(self, name)))
        check_samples(self.acceleration)
        check_time_step(self.time_step)


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A treated motion: acceleration [m/s2], velocity [m/s] and displacement [m], (n,), every `time_step` [s]."""

    acceleration: FloatArray
    velocity: FloatArray
    displacement: FloatArray
    time_step: float
    pfa: float = field(init=False)
    """Peak floor acceleration [m/s2]."""
    pfv: float = field(init=False)
    """Peak floor velocity [m/s]."""
    pfd: float = field(init=False)
    """Peak floor displacement [m]."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "pfa", peak(self.acceleration))
        object.__setattr__(self, "pfv", peak(self.velocity))
        object.__setattr__(self, "pfd", peak(self.displacement))


_TREATED: WeakKeyDictionary[Record, Motion] = WeakKeyDictionary()
"""Treated motions by their records: filtering takes most of a run by the formulas."""
_LOCK = Lock()


@dataclass(frozen=True, slots=True, eq=False)
class Series:
    """Evenly spaced `values` (n,), one every `time_step` [s], and what was done to make them so."""

    time_step: float
    values: FloatArray
    notes: tuple[str, ...] = ()


def peak(values: FloatArray) -> float:
    """Return the largest absolute value."""
    return float(np.abs(values).max())


def treat(record: Record, baseline: Baseline = "standard", *, progress: Progress = SILENT) -> Motion:
    """Return the motion that every method uses; `treatment` describes it in words.

    * `baseline`: "standard"; "none" leaves out the filter, not the removal of an uncorrected record's mean.
    * `progress`: asked often whether to stop; CancelledError then.

    It has as many samples as `record`. Velocity and displacement start from zero: at the first sample, or, where
    filtered, at the start of the zeros put before it, so that the pass backward in time leaves no false offset.
    """
    with _LOCK:
        found = _TREATED.get(record) if baseline == "standard" else None
    if found is not None:
        return found
    values, step, own = record.acceleration, record.time_step, slice(None)
    if not record.corrected:
        values = values - values.mean()
        if baseline == "standard":
            pad = math.ceil(PAD / step)
            own = slice(pad, pad + values.size)
            values = high_pass_both_ways(values, step, CORNER, pad, progress)
    every = [values]
    for _ in range(2):  # velocity and displacement: cumulative trapezoids from 0
        last = every[-1]
        every.append(np.concatenate([[0.0], np.cumsum((last[1:] + last[:-1]) / 2) * step]))
    if own != slice(None):  # copies, or each motion would keep its two minutes of pads in memory
        every = [one[own].copy() for one in every]
    acceleration, velocity, displacement = every
    motion = Motion(acceleration, velocity, displacement, step)
    if baseline == "standard":
        with _LOCK:
            kept = sum(one.acceleration.size for one in _TREATED.values())
            if kept + motion.acceleration.size <= MOST_TREATED:
                _TREATED[record] = motion
    return motion


def treatment(record: Record, baseline: Baseline = "standard") -> Text:
    """Return one sentence on what `treat` does to `record`."""
    if record.corrected:
        return fill("Corrected by its provider: used as it is in the file.")
    if baseline == "none":
        return fill("Uncorrected: mean removed, not filtered.")
    return fill(
        "Uncorrected: mean removed, then a Butterworth high-pass at {corner:g} Hz without phase shift (order {order} "
        "forward and again backward: order {in_effect} in effect; {pad:g} s of zeros at each end while filtering).",
        corner=CORNER, order=PASS_ORDER, in_effect=PASS_ORDER * PASSES, pad=PAD,
    )  # fmt: skip


def resample(times: FloatArray, values: FloatArray, time_step: float) -> FloatArray:
    """Return `values` at every `time_step` [s] from the first of the increasing `times` [s] on, on straight lines."""
    # The little more keeps the last sample where the division ends a hair below a whole number.
    count = math.floor((times[-1] - times[0]) / time_step + 1e-6) + 1
    return np.asarray(np.interp(times[0] + np.arange(count) * time_step, times, values), dtype=np.float64)


def build_series(times: FloatArray, values: FloatArray) -> Series:
    """Make accelerations [m/s2] (n,) at given times [s] (n,) evenly spaced, changing as little as that takes.

    Raises RecordError if over 1 % of the times do not run forwards, or times or values cannot be those of a record.
    """
    check_samples(values)
    wrong = ~(np.abs(times) <= LATEST_TIME)
    if wrong.any():
        place = int(wrong.argmax())
        time = float(times[place])
        raise RecordError.about("the time of sample {number} is {time:g} s: correct it", number=place + 1, time=time)
    forward = np.append(True, times[1:] > np.maximum.accumulate(times)[:-1])
    left_out = times.size - int(forward.sum())
    if left_out > MOST_LEFT_OUT * times.size:
        raise RecordError(
            nfill(
                "{n} of {count} samples is no later than one before it: times must increase down the file, and be "
                "printed with enough digits",
                "{n} of {count} samples are no later than one before them: times must increase down the file, and be "
                "printed with enough digits",
                left_out,
                count=times.size,
            )
        )
    note = nfill(
        "{n} sample that is no later than one before it was left out",
        "{n} samples that are no later than one before them were left out",
        left_out,
    )
    times, values, notes = times[forward], values[forward], (note,) if left_out else ()
    step = float(f"{(times[-1] - times[0]) / (times.size - 1):.12g}")
    if np.abs(times - times[0] - np.arange(times.size) * step).max() <= EVEN_WITHIN * step:
        check_time_step(step)
        return Series(step, values, notes)
    steps, span = np.diff(times), float(times[-1] - times[0])
    median = float(np.median(steps))
    check_time_step(median)
    if span > MOST_SAMPLES * RESAMPLED_STEP:
        raise RecordError.about("the times span {span:.6g} s: cut the record to the shaking", span=span)
    resampled = resample(times, values, RESAMPLED_STEP)
    note = fill(
        "unevenly sampled (median step {median:.3g} s): resampled linearly to {step:g} s, which changes the peak by "
        "{change:+.2f} %",
        median=median, step=RESAMPLED_STEP, change=100 * (peak(resampled) / peak(values) - 1),
    )  # fmt: skip
    gaps, longest = int((steps > max(GAP, 2 * median)).sum()), int(steps.argmax())
    bridged = nfill(
        "a gap of {long:.3g} s at {at:.5g} s is bridged by a straight line",
        "{n} gaps, the longest of {long:.3g} s at {at:.5g} s, are bridged by straight lines",
        gaps, long=float(steps[longest]), at=float(times[longest]),
    )  # fmt: skip
    return Series(RESAMPLED_STEP, resampled, (*notes, note, *((bridged,) if gaps else ())))


def check_count(count: int) -> None:
    """Raise RecordError if a channel has more samples than are read."""
    if count > MOST_SAMPLES:
        raise RecordError.about(
            "the number of samples is {count:,}, expected at most {most:,}: cut the record to the shaking",
            count=count,
            most=MOST_SAMPLES,
        )


def check_samples(values: FloatArray) -> None:
    """Raise RecordError unless `values` (n,) [m/s2] can be a recorded acceleration."""
    if values.size < FEWEST_SAMPLES:
        raise RecordError.about(
            "the number of samples is {count}, expected at least {least}", count=values.size, least=FEWEST_SAMPLES
        )
    check_count(values.size)
    if not np.isfinite(values).all():
        number = int(np.isfinite(values).argmin()) + 1
        raise RecordError.about("sample {number} is not a number: correct or remove it", number=number)
    if peak(values) > MOST_ACCELERATION:
        raise RecordError.about(
            "the peak is {peak:.3g} g, expected at most {most:g} g: is the unit right?",
            peak=peak(values) / GRAVITY,
            most=MOST_ACCELERATION / GRAVITY,
        )
    if values.min() == values.max():
        first = float(values[0])
        raise RecordError.about("every sample is {value:g} m/s2: the channel holds no motion", value=first)


def check_time_step(time_step: float) -> None:
    """Raise RecordError unless `time_step` [s] can be that of a record."""
    if not SHORTEST_STEP <= time_step <= LONGEST_STEP:
        raise RecordError.about(
            "the time step is {step:.4g} s, expected {shortest:g} to {longest:g} s: is the time in seconds?",
            step=time_step, shortest=SHORTEST_STEP, longest=LONGEST_STEP,
        )  # fmt: skip
