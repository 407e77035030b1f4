"""The one treatment of records, against closed forms, an independent filter and the files of 575 Market Street."""

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from assess.arrays import FloatArray
from assess.errors import CancelledError, RecordError
from assess.motion.formats import read_records
from assess.motion.record import (
    CORNER,
    FEWEST_SAMPLES,
    RESAMPLED_STEP,
    Record,
    build_series,
    resample,
    treat,
    treatment,
)
from assess.progress import Progress
from tests.refusals import check_refusals

MARKET = Path(__file__).parents[2] / "inventories" / "records" / "575-market"
LETTERS = "abcdefghijk"
# Counted with other tools, within the number of samples that each header announces.
NOT_INCREASING = {"a": 6, "b": 6, "c": 2, "k": 3}
SAMPLES = dict(zip(LETTERS, [33449, 33475, 33490, 33515, 33415, 33538, 33509, 33580, 33510, 33518, 33532], strict=True))

RECORDS = Path(__file__).parents[2] / "samples" / "records"


def make_record(acceleration: FloatArray, time_step: float = 0.01, *, corrected: bool = False) -> Record:
    return Record(
        file="made.smc", format="none", channel="1", location="", azimuth_deg=None, vertical=False, station="",
        event="", start="", corrected=corrected, time_step=time_step, acceleration=acceleration,
        file_pfa=float(np.abs(acceleration).max()), header_pfa=None,
    )  # fmt: skip


def sine(frequency: float, duration: float, time_step: float = 0.01) -> FloatArray:
    return np.asarray(np.sin(2 * np.pi * frequency * np.arange(0, duration, time_step)))


def read_market(letter: str) -> Record:
    (record,) = read_records(MARKET / f"891018_1.cra-1.0210{letter}.smc")
    return record


@pytest.mark.parametrize("letter", LETTERS)
def test_market_street_as_its_header_says_and_against_an_independent_filter(letter: str) -> None:
    record = read_market(letter)
    assert record.header_pfa is not None
    # The header prints one digit after the point.
    assert record.file_pfa == pytest.approx(record.header_pfa, abs=0.000501)
    beyond = next(note for note in record.notes if "beyond" in note)
    assert beyond == f"8 numbers beyond the {2 * SAMPLES[letter]} that the header announces: left out"
    left_out = [int(note.split()[0]) for note in record.notes if "no later than" in note]
    assert left_out == ([NOT_INCREASING[letter]] if letter in NOT_INCREASING else [])
    assert record.time_step == RESAMPLED_STEP
    assert any(
        "unevenly sampled (median step 0.0014 s): resampled linearly to 0.005 s" in note for note in record.notes
    )
    assert not any("gap" in note for note in record.notes)
    assert record.vertical == (letter in "fj")
    assert "42n" in record.station or letter not in "abc"
    motion = treat(record)
    # Both passes of the analogue filter at once: |H|^2 = 1 / (1 + (fc/f)^4), with no phase.
    count = record.acceleration.size + 2 * round(200 / record.time_step)
    frequency = np.fft.rfftfreq(count, record.time_step)
    gain = np.zeros_like(frequency)
    gain[1:] = 1 / (1 + (CORNER / frequency[1:]) ** 4)
    filtered = np.fft.irfft(np.fft.rfft(record.acceleration - record.acceleration.mean(), count) * gain, count)
    assert motion.pfa == pytest.approx(np.abs(filtered[: record.acceleration.size]).max(), rel=1e-3)
    around = np.roll(filtered, 20_000)  # the part before the first sample stands at the end
    velocity = np.cumsum(around) * record.time_step
    own = velocity[20_000 : 20_000 + record.acceleration.size]
    assert motion.pfv == pytest.approx(np.abs(own).max(), rel=5e-3)


# After a band-pass of 0.1 to 25 Hz, made elsewhere [cm/s2, cm/s]; here nothing is cut off at 25 Hz.
@pytest.mark.parametrize(("letter", "pfa", "pfv"), [("a", 214, 40.9), ("h", 217, 39.4), ("k", 131, 23.3)])
def test_market_street_against_others(letter: str, pfa: float, pfv: float) -> None:
    motion = treat(read_market(letter))
    assert pfa < 100 * motion.pfa < 1.02 * pfa
    assert 100 * motion.pfv == pytest.approx(pfv, rel=0.02)


def test_a_corrected_record_is_used_as_it_is_and_treatment_leaves_records_alone() -> None:
    record = make_record(0.3 + sine(1, 10), corrected=True)
    before = record.acceleration.copy()
    for motion in (treat(record), treat(record, "none")):
        np.testing.assert_array_equal(motion.acceleration, before)
        assert motion.pfa == record.file_pfa
        assert motion.velocity[0] == 0
    record = make_record(0.3 + sine(1, 10))
    before = record.acceleration.copy()
    assert treat(record).acceleration.size == before.size == treat(record).velocity.size
    np.testing.assert_array_equal(record.acceleration, before)


def test_no_phase_is_shifted() -> None:
    time = np.linspace(-20, 20, 4001)
    pulse = np.exp(-((time / 0.5) ** 2))
    filtered = treat(make_record(pulse)).acceleration
    np.testing.assert_allclose(filtered, filtered[::-1], atol=1e-9)
    assert np.argmax(filtered) == 2000


@pytest.mark.parametrize(
    ("frequency", "gain", "within"),
    [(CORNER, 0.5, 1e-3), (1.0, 1.0, 1e-3), (0.02, 1 / 626, 1e-4), (0.2, 16 / 17, 1e-3)],
)
def test_response(frequency: float, gain: float, within: float) -> None:
    filtered = treat(make_record(sine(frequency, 1000, 0.02), 0.02)).acceleration
    middle = filtered[15_000:35_000]  # whole periods
    assert np.sqrt(2 * np.mean(middle**2)) == pytest.approx(gain, abs=within)


@pytest.mark.parametrize("frequency", [0.5, 1.0, 4.0])
def test_peak_velocity_of_a_sine(frequency: float) -> None:
    cosine = np.cos(2 * np.pi * frequency * np.arange(40_000) * 0.001)  # from rest, so that velocity is a sine
    motion = treat(make_record(cosine, 0.001, corrected=True))
    assert motion.pfv == pytest.approx(1 / (2 * np.pi * frequency), rel=1e-3)
    filtered = treat(make_record(sine(frequency, 200, 0.005), 0.005)).velocity
    assert np.abs(filtered[10_000:30_000]).max() == pytest.approx(1 / (2 * np.pi * frequency), rel=2e-3)


def test_an_offset_changes_nothing_drift_is_removed_and_without_a_filter_the_mean() -> None:
    plain, offset = (treat(make_record(sine(1, 40) + shift)) for shift in (0.0, 0.5))
    np.testing.assert_allclose(plain.acceleration, offset.acceleration, atol=1e-12)
    shaking = sine(1, 60) * np.hanning(6000)
    drifting = make_record(shaking + np.linspace(-0.05, 0.05, 6000))
    assert treat(drifting, "none").pfv > 0.7
    assert treat(drifting).pfv == pytest.approx(treat(make_record(shaking)).pfv, rel=0.2)
    values = 0.5 + sine(1, 10)
    np.testing.assert_allclose(treat(make_record(values), "none").acceleration, values - values.mean())


def test_velocity_and_displacement_are_those_of_the_provider() -> None:
    """The files of the same channel print peaks of 2.30 cm/s and 0.182 cm."""
    motion = treat(read_records(RECORDS / "1103.HN2.NP.RE_a.smc")[0])
    assert motion.pfv * 100 == pytest.approx(2.2956, rel=0.002)
    assert motion.pfd * 100 == pytest.approx(0.18171, rel=0.03)


def test_treatment_in_words() -> None:
    record = make_record(sine(1, 10))
    assert (
        "high-pass at 0.1 Hz without phase shift (order 2 forward and again backward: order 4 in effect"
        in treatment(record)
    )
    assert treatment(record, "none") == "Uncorrected: mean removed, not filtered."
    assert treatment(replace(record, corrected=True)) == "Corrected by its provider: used as it is in the file."


def test_resampling_follows_straight_lines_and_even_times_keep_every_sample() -> None:
    np.testing.assert_allclose(resample(np.array([1.0, 1.3, 1.4]), np.array([0.0, 3.0, 2.0]), 0.1), [0, 1, 2, 3, 2])
    times, values = 5 + np.arange(100) / 300, sine(2, 1)
    series = build_series(np.round(times, 4), values)
    assert series.time_step == pytest.approx(1 / 300, rel=1e-4)
    assert series.values is values or np.array_equal(series.values, values)
    assert series.notes == ()


def test_backward_times_are_left_out_and_counted_and_gaps_are_named() -> None:
    times: FloatArray = np.arange(1000.0) / 100
    times[500] = times[497]
    series = build_series(times, sine(1, 10))
    assert series.notes[0] == "1 sample that is no later than one before it was left out"
    times[501] = times[500]
    notes = build_series(times, sine(1, 10)).notes
    assert notes[0] == "2 samples that are no later than one before them were left out"
    times = np.arange(1000.0) / 100
    times[500:] += 1.44
    assert build_series(times, sine(1, 10)).notes[-1] == "a gap of 1.45 s at 4.99 s is bridged by a straight line"
    times[800:] += 0.5
    expected = "2 gaps, the longest of 1.45 s at 4.99 s, are bridged by straight lines"
    assert build_series(times, sine(1, 10)).notes[-1] == expected


def test_times_samples_and_steps_that_cannot_be() -> None:
    check_refusals(RecordError, lambda times: build_series(times, sine(1, 10)), [
        (np.arange(1000) % 500 * 0.01, r"500 of 1000 samples are no later than one before them: times must increase"),
        (np.arange(1000.0), r"the time step is 1 s, expected 1e-05 to 0.1 s: is the time in seconds\?"),
        (np.append(np.arange(999) * 0.01, 1e6), r"the times span 1e\+06 s: cut the record to the shaking"),
        (np.append(np.arange(999) * 0.01, np.nan), r"the time of sample 1000 is nan s: correct it"),
        (np.append(np.arange(999) * 0.01, 1e300), r"the time of sample 1000 is 1e\+300 s: correct it"),
        (np.arange(1000) ** 2 * 1.0, r"the time step is 999 s"),
    ])  # fmt: skip
    check_refusals(RecordError, make_record, [
        (np.ones(FEWEST_SAMPLES - 1), r"the number of samples is 9, expected at least 10"),
        (np.append(np.arange(20.0), np.nan), r"sample 21 is not a number: correct or remove it"),
        (np.append(np.arange(20.0), np.inf), r"sample 21 is not a number"),
        (np.arange(20.0) * 100, r"the peak is 194 g, expected at most 50 g: is the unit right\?"),
        (np.full(20, 0.25), r"every sample is 0.25 m/s2: the channel holds no motion"),
    ])  # fmt: skip
    message = r"the time step is .* is the time in seconds\?"
    steps = [(time_step, message) for time_step in (0.0, -0.01, 1.0, 1e-9, float("nan"))]
    check_refusals(RecordError, lambda time_step: make_record(sine(1, 10), time_step), steps)


@pytest.mark.parametrize("time_step", [0.001, 1 / 256, 0.005, 0.01, 1 / 80, 0.02, 0.1])
def test_the_filter_is_scipys(time_step: float) -> None:
    values = np.random.default_rng(3).standard_normal(3000)
    sections = butter(2, CORNER, "highpass", fs=1 / time_step, output="sos")
    pad = math.ceil(60 / time_step)
    expected = sosfiltfilt(sections, np.pad(values - values.mean(), pad), padtype=None)[pad:-pad]
    found = treat(make_record(values, time_step)).acceleration
    # Rounding alone: the poles are so close to the zeros that other roundings move single samples by up to 1e-12.
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_filtering_a_long_record_can_be_cancelled(monkeypatch: pytest.MonkeyPatch) -> None:
    samples = sine(1.0, 30)
    whole = treat(make_record(samples)).acceleration
    monkeypatch.setattr("assess.motion.record.SLICE", 1000)
    np.testing.assert_array_equal(treat(make_record(samples)).acceleration, whole)
    cancel = Event()
    cancel.set()
    with pytest.raises(CancelledError):
        treat(make_record(samples), progress=Progress(cancel=cancel))


def test_a_record_in_use_is_treated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = make_record(sine(1.0, 30)), make_record(sine(1.0, 30))
    assert treat(one) is treat(one)
    assert treat(one) is not treat(other)
    assert treat(one, "none").pfa != treat(one).pfa
    monkeypatch.setattr("assess.motion.record.MOST_TREATED", 0)
    late = make_record(sine(1.0, 30))
    assert treat(late) is not treat(late)  # no more is kept than may be


def test_reading_and_treating_records_needs_no_scipy() -> None:
    path = MARKET / "891018_1.cra-1.0210a.smc"
    code = (
        "import pathlib, sys\n"
        "from assess.motion.formats import read_channels\n"
        f"assert read_channels({str(path)!r})[0].motion.pfa > 0\n"
        "sys.exit('scipy' in sys.modules or 'numba' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
