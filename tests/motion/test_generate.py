"""Ensembles against what is asked of them: the mean spectrum and the mean peaks, their scatter, and no drift.

Each record's generator is built once, in the one test that looks at all its figures.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.errors import CancelledError
from assess.motion import noise
from assess.motion.generate import CALIBRATED, Generator, build_generator
from assess.motion.record import Motion
from assess.motion.rows import GROUP
from assess.motion.spectrum import response_spectrum
from assess.motion.target import Target, build_grid, matched_to, recorded_target
from assess.motion.target_fit import Fit
from assess.progress import Progress
from assess.units import GRAVITY
from tests.motion.motions import GROUND, ROOF, TWELFTH, cut, make_motion, read_motion
from tests.stopping import StopsAt

STEP = 0.005
CREST = 4.905
"""Peak of made-up motions [m/s2]."""


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What is asked of an ensemble, computed here: deviations, ratios and coefficients of variation [-]."""

    mean_deviation: float
    worst_deviation: float
    pfa_ratio: float
    pfa_scatter: float
    pfv_ratio: float
    pfv_scatter: float
    spectrum_scatter: float
    drift: float


def measure(target: Target, motions: FloatArray) -> Figures:
    """Return the figures of motions [m/s2], at 300 periods that are not those matched."""
    periods = np.geomspace(0.05, matched_to(target.periods, target.pseudo), 300)
    spectra = response_spectrum(motions, STEP, periods).pseudo
    wanted = response_spectrum(target.acceleration, STEP, periods).pseudo
    deviation = spectra.mean(axis=0) / wanted - 1
    velocity = np.cumsum((motions[:, 1:] + motions[:, :-1]) * STEP / 2, axis=1)
    pfas, pfvs = np.abs(motions).max(axis=1), np.abs(velocity).max(axis=1)
    return Figures(
        mean_deviation=float(np.abs(deviation).mean()),
        worst_deviation=float(np.abs(deviation).max()),
        pfa_ratio=float(pfas.mean() / target.pfa),
        pfa_scatter=float(pfas.std() / pfas.mean()),
        pfv_ratio=float(pfvs.mean() / target.pfv),
        pfv_scatter=float(pfvs.std() / pfvs.mean()),
        spectrum_scatter=float((spectra.std(axis=0) / spectra.mean(axis=0)).mean()),
        drift=float((np.abs(velocity[:, -1]) / pfvs).max()),
    )


def check_fit(fit: Fit | None, figures: Figures) -> None:
    """Assert that a fit agrees with the figures, which are of other periods."""
    assert fit is not None
    for name in ("pfa_ratio", "pfa_scatter", "pfv_ratio", "pfv_scatter"):
        assert getattr(fit, name) == pytest.approx(getattr(figures, name), rel=1e-5)
    assert fit.mean_deviation == pytest.approx(figures.mean_deviation, abs=0.005)
    assert abs(fit.worst_deviation) == pytest.approx(figures.worst_deviation, abs=0.025)
    assert fit.spectrum_scatter == pytest.approx(figures.spectrum_scatter, rel=0.03)
    assert fit.drift < 1e-5


def build(motion: Motion, *, seed: int = 1, axis: str = "X", threads: int = 1) -> Generator:
    grid = build_grid([motion])
    return build_generator(recorded_target(motion, grid), grid, seed=seed, axis=axis, threads=threads)


# --- what is asked ---


@pytest.mark.parametrize(
    "name",
    [
        *(pytest.param(name, marks=pytest.mark.slow) for name in (ROOF, GROUND)),
        *(pytest.param(name, marks=pytest.mark.long) for name in ("a", "b", "e", "i", "k", TWELFTH)),
    ],
)
def test_ensembles_match_their_record(name: str) -> None:
    generator = build(read_motion(name))
    figures = measure(generator.target, generator.realise())
    assert figures.worst_deviation < 0.10
    assert figures.mean_deviation < 0.03
    assert figures.pfa_ratio == pytest.approx(1, abs=0.05)
    assert figures.pfv_ratio == pytest.approx(1, abs=0.15)
    assert figures.pfa_scatter > 0.05
    assert figures.spectrum_scatter > 0.1
    assert figures.drift < 1e-5
    check_fit(generator.fit, figures)
    assert generator.fit is not None
    assert generator.fit.count == CALIBRATED == 100
    further = measure(generator.target, generator.realise(0, 200))
    assert further.worst_deviation < 0.13
    assert further.mean_deviation < 0.05
    assert further.pfa_ratio == pytest.approx(1, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "axis"), [(2, "X"), (1, "Y"), pytest.param(123456789, "Y", marks=pytest.mark.long)])
def test_so_they_do_with_other_draws(seed: int, axis: str) -> None:
    generator = build(cut(TWELFTH, 0, 15), seed=seed, axis=axis)
    figures = measure(generator.target, generator.realise())
    assert figures.worst_deviation < 0.10
    assert figures.mean_deviation < 0.03
    assert figures.pfa_ratio == pytest.approx(1, abs=0.05)
    assert figures.pfv_ratio == pytest.approx(1, abs=0.15)


def test_realisations_beyond_those_calibrated_match_too() -> None:
    """Fifty others have a mean of their own: its standard error alone is 3 %."""
    generator = build(cut(TWELFTH, 0, 15))
    motions = generator.realise(100, 50)
    assert motions.shape == (50, generator.phases.grid.count)
    figures = measure(generator.target, motions)
    assert figures.mean_deviation < 0.06
    assert figures.worst_deviation < 0.2
    assert figures.pfa_ratio == pytest.approx(1, abs=0.1)
    assert figures.pfv_ratio == pytest.approx(1, abs=0.2)
    assert figures.drift < 1e-5
    assert not np.isin(motions[:, 500], generator.realise()[:, 500]).any()


# --- a realisation is one, whatever else is made ---

SHORT, FEW = cut("b", 8, 13), 20


@pytest.mark.slow
def test_a_realisation_is_the_same_to_the_bit() -> None:
    generator, again = (build(SHORT, threads=threads) for threads in (1, 2))
    everything = generator.realise(0, CALIBRATED + 47)
    assert everything.dtype == np.float32
    np.testing.assert_array_equal(again.realise(0, CALIBRATED + 47), everything)
    assert again.fit == generator.fit
    np.testing.assert_array_equal(again.spectra.ordinates, generator.spectra.ordinates)
    afresh = replace(again, made=np.empty((0, 0), np.float32))
    # the first motions, too, are made once more
    for first, count in [(0, CALIBRATED), (5, 1), (3, 2), (41, 1), (CALIBRATED - 2, 5), (1, 146), (120, 20), (139, 3)]:
        np.testing.assert_array_equal(afresh.realise(first, count), everything[first : first + count])
        np.testing.assert_array_equal(generator.realise(first, count), everything[first : first + count])


def test_it_does_not_depend_on_what_was_made_before_nor_on_what_is_done_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The noise that is kept is that which would be drawn."""
    first = build(SHORT).realise(0, 2)
    build(cut("d", 8, 13), seed=7)
    monkeypatch.setattr(noise.KEPT, "most", 0)
    np.testing.assert_array_equal(build(SHORT).realise(0, 2), first)
    generator = build(SHORT)
    kept = generator.realise(0, 2).copy()
    generator.realise(0, 2)[:] = 0.0
    np.testing.assert_array_equal(generator.realise(0, 2), kept)


def test_the_target_and_the_motion_are_left_alone() -> None:
    grid = build_grid([SHORT])
    target = recorded_target(SHORT, grid)
    pseudo, acceleration, envelopes = target.pseudo.copy(), SHORT.acceleration.copy(), target.envelopes.values.copy()
    build_generator(target, grid, seed=1, axis="X")
    np.testing.assert_array_equal(target.pseudo, pseudo)
    np.testing.assert_array_equal(SHORT.acceleration, acceleration)
    np.testing.assert_array_equal(target.envelopes.values, envelopes)


@pytest.mark.slow
def test_floors_share_their_phases_and_axes_and_seeds_do_not() -> None:
    """42nd and 34th floor of 575 Market Street, azimuth 225."""
    upper, lower = (build(cut(name, 5, 17)).realise(0, FEW) for name in "be")
    correlation = np.corrcoef(upper, lower)[:FEW, FEW:]
    same, different = np.diag(correlation), correlation[~np.eye(FEW, dtype=bool)]
    assert same.min() > 0.3
    assert same.mean() > 0.6
    assert abs(different.mean()) < 0.05
    across = np.diag(np.corrcoef(upper, build(cut("b", 5, 17), axis="Y").realise(0, FEW))[:FEW, FEW:])
    assert abs(across.mean()) < 0.15
    assert across.max() < same.mean()
    seeded = build(cut("b", 5, 17), seed=2).realise(0, FEW)
    assert abs(np.diag(np.corrcoef(upper, seeded)[:FEW, FEW:]).mean()) < 0.15


# --- odd input ---


def pulse(duration: float) -> Motion:
    """Return 10 s of rest with part of a sine of 1 s in the middle."""
    times = np.arange(2000) * STEP
    return make_motion(np.where((times > 4) & (times < 4 + duration), CREST * np.sin(2 * np.pi * times), 0.0), STEP)


def refined(time_step: float) -> Motion:
    motion = cut(TWELFTH, 0, 15)
    times = np.arange(round(15 / time_step) + 1) * time_step
    return make_motion(np.interp(times, np.arange(motion.acceleration.size) * STEP, motion.acceleration), time_step)


ODD = {
    "5 s, cut on both sides": lambda: cut("a", 8, 13),
    "5 s": lambda: cut(TWELFTH, 4, 9),
    "a cycle": lambda: pulse(1.0),
    "half a cycle": lambda: pulse(0.5),
    "step of 0.02 s": lambda: refined(0.02),
    "step of 0.0025 s": lambda: refined(0.0025),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ODD)
def test_odd_records_still_give_sensible_motions(name: str) -> None:
    """The mean spectrum and PFA are matched; PFV may be off by a third, and a cut record's long periods by 30 %."""
    generator = build(ODD[name]())
    motions = generator.realise()
    assert np.isfinite(motions).all()
    figures = measure(generator.target, motions)
    assert figures.mean_deviation < 0.06
    assert figures.worst_deviation < 0.37
    assert figures.pfa_ratio == pytest.approx(1, abs=0.05)
    assert 0.6 < figures.pfv_ratio < 1.3
    assert figures.drift < 1e-5
    check_fit(generator.fit, figures)


def test_a_spike_has_its_pfa_and_motions_that_are_stronger_than_it() -> None:
    """No motion of some duration has a spike's PFA and its spectrum: PFA takes precedence, and the fit says so."""
    generator = build(make_motion(CREST * np.eye(1, 2000, 1000)[0], STEP))
    figures = measure(generator.target, generator.realise())
    assert figures.pfa_ratio == pytest.approx(1, abs=0.01)
    assert 1.0 < figures.pfv_ratio < 1.6
    assert 0.1 < figures.mean_deviation < 0.5
    check_fit(generator.fit, figures)


def test_a_faint_record_is_matched_as_a_strong_one_is() -> None:
    motion = cut(TWELFTH, 0, 15)
    strong, faint = (build(make_motion(motion.acceleration * by, STEP)) for by in (1.0, 1e-4 * GRAVITY / motion.pfa))
    assert faint.target.pfa == pytest.approx(1e-4 * GRAVITY)
    assert strong.fit is not None
    assert faint.fit is not None
    for name in ("mean_deviation", "pfa_ratio", "pfv_ratio", "pfa_scatter", "spectrum_scatter"):
        assert getattr(faint.fit, name) == pytest.approx(getattr(strong.fit, name), rel=1e-3)


@pytest.mark.slow
def test_two_minutes_are_matched() -> None:
    motion = make_motion(np.tile(read_motion("a").acceleration, 3)[:24_001], STEP)
    generator = build(motion)
    figures = measure(generator.target, generator.realise())
    assert figures.mean_deviation < 0.03
    assert figures.worst_deviation < 0.12
    assert figures.pfa_ratio == pytest.approx(1, abs=0.05)
    assert figures.pfv_ratio == pytest.approx(1, abs=0.15)
    assert figures.drift < 1e-5


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.slow
def test_a_cancel_is_obeyed_wherever_the_work_is(threads: int) -> None:
    grid = build_grid([SHORT])
    target = recorded_target(SHORT, grid)

    def work(progress: Progress) -> None:
        generator = build_generator(target, grid, seed=1, axis="X", threads=threads, progress=progress)
        generator.realise(CALIBRATED, 50)

    counted = StopsAt(10**9)
    work(StopsAt(10**9))  # from here on the noise is kept: both ways take the same steps
    work(counted)
    assert counted.checks > 400
    for last in np.linspace(1, counted.checks, 6, dtype=int):
        stopping = StopsAt(int(last))
        with pytest.raises(CancelledError):
            work(stopping)
        assert stopping.checks <= last + CALIBRATED // GROUP  # the groups in hand, not another round of the work
