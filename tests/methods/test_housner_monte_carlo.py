"""Housner Monte Carlo: counting, looks, threads; the ensembles are made up, the rocking is integrated."""

import dataclasses
import itertools
import threading
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from assess.arrays import FloatArray
from assess.errors import CancelledError
from assess.methods import Cases, Motions
from assess.methods.housner_monte_carlo import BATCH, METHOD, evaluate
from assess.methods.simulate import LOOKS, LOOKS_Z, interval_width
from assess.motion.target_fit import Fit, Spectra
from assess.progress import SILENT, Progress, Report
from assess.risk import classify_all, wilson_interval
from assess.rocking.draws import MOTION, TRIED, Uncertainty, draw_bodies, draw_earthquakes
from assess.rocking.ensemble import rock_blocks
from assess.settings import Settings
from tests.methods.ensembles import STEP, MadeUp, make_motion

AUTO = Settings(runs="auto")
LEVELS = {"thin": 3.0, "usual": 6.0, "stout": 12.0}
"""Amplitudes [m/s2] of a long push under which only pieces up to that stoutness overturn."""
SIZES = {"thin": (0.3, 1.8), "usual": (0.8, 1.8), "stout": (1.5, 1.8)}

PUSH = np.concatenate([[0.0], np.ones(150), np.zeros(2)])
"""A long push of 1 m/s2, and rest."""


@dataclass(frozen=True, slots=True, eq=False)
class Pushes:
    """Motion k is a long push by which pieces overturn, or rest: `levels[k % len(levels)]` [m/s2]."""

    levels: tuple[float, ...]
    is_assumed: bool = False
    is_unknown: bool = False
    is_weak: bool = False
    record: tuple[FloatArray, float] | None = None
    fit: Fit | None = None
    spectra: Spectra | None = None
    bands: tuple[float, float] | None = None
    asked: list[tuple[int, int]] = field(default_factory=list)

    def open(self, threads: int, progress: Progress = SILENT) -> Motions:
        return Motions(self.realise, self.fit, self.spectra, self.is_weak, self.bands)

    def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
        self.asked.append((first, count))
        own = [self.levels[number % len(self.levels)] for number in range(first, first + count)]
        return [(np.array(own)[:, np.newaxis] * PUSH, STEP)]


CERTAIN = Uncertainty(motion=0.0, piece=False)
"""Nothing is drawn: what is adopted is then what happens if exactly this motion recurs."""


def _cases(
    ensemble: ArrayLike,
    *ensembles: MadeUp | Pushes,
    breadth: ArrayLike = 0.3,
    height: ArrayLike = 1.8,
    uncertainty: Uncertainty = CERTAIN,
    **more: ArrayLike,
) -> Cases:
    return Cases.of(
        breadth=breadth, height=height, ensemble=ensemble, ensembles=ensembles, uncertainty=uncertainty, **more
    )


def _grid(ensembles: int, seed: int = 3, count: int = 24) -> Cases:
    """Pieces of many sizes, some of them twice, shared out among ensembles."""
    random = np.random.default_rng(seed)
    height = random.uniform(0.8, 2.2, count)
    breadth = height * random.uniform(0.1, 0.4, count)
    breadth[-4:], height[-4:] = breadth[:4], height[:4]
    made = (MadeUp(one, has_record=one % 2 == 0) for one in range(ensembles))
    return _cases(np.arange(count) % ensembles, *made, breadth=breadth, height=height)


# --- counting ---


def test_the_risk_is_the_share_of_motions_that_overturn_it() -> None:
    cases = _grid(1)
    outcome = evaluate(cases, Settings(runs=40))
    motions = np.stack([make_motion(0, number) for number in range(40)])
    found = rock_blocks(cases.breadth, cases.height, motions, STEP)
    np.testing.assert_array_equal(outcome.value, found.overturned.sum(axis=1) / 40)
    np.testing.assert_array_equal(outcome.detail["overturned"], found.overturned.sum(axis=1))
    assert set(outcome.detail["runs"]) == {40.0}
    assert 0 < outcome.value.min() + outcome.value.max() < 2, "some fall and some stand"
    low, high = wilson_interval(found.overturned.sum(axis=1), 40)
    np.testing.assert_array_equal(outcome.detail["low"], low)
    np.testing.assert_array_equal(outcome.detail["high"], high)


def test_pushes_overturn_pieces_up_to_their_stoutness() -> None:
    """What the tests of the looks rest on."""
    breadth, height = np.array(list(SIZES.values())).T
    cases = _cases(0, Pushes((0.0, *LEVELS.values())), breadth=breadth, height=height)
    assert evaluate(cases, Settings(runs=4)).value.tolist() == [0.75, 0.5, 0.25]


def test_restitution_is_used_and_equal_pieces_do_the_same() -> None:
    cases = _grid(1)
    lively = dataclasses.replace(cases, restitution=np.full(cases.breadth.size, 0.99))
    one, other = (evaluate(which, Settings(runs=60)) for which in (cases, lively))
    assert (one.joints[0].rotation != other.joints[0].rotation).any()
    np.testing.assert_array_equal(one.joints[0].rotation[-4:], one.joints[0].rotation[:4])


def test_the_record_itself_is_integrated_too_and_without_one_nothing_is_known_of_it() -> None:
    ensemble = MadeUp(0, has_record=True)
    assert ensemble.record is not None
    breadth = np.linspace(0.1, 0.5, 9)
    cases = _cases(0, ensemble, breadth=breadth)
    outcome = evaluate(cases, Settings(runs=3))
    found = rock_blocks(breadth, np.full(9, 1.8), ensemble.record[0][np.newaxis], STEP)
    np.testing.assert_array_equal(outcome.detail["record_overturned"], found.overturned[:, 0])
    np.testing.assert_array_equal(outcome.detail["record_rotation"], found.rotation[:, 0])
    np.testing.assert_array_equal(outcome.flags["fell_in_record"], found.overturned[:, 0])
    without = evaluate(_cases(0, MadeUp(0)), Settings(runs=3))
    assert np.isnan([without.detail["record_overturned"][0], without.detail["record_rotation"][0]]).all()
    assert not without.flags["fell_in_record"].any()


def test_a_piece_may_fall_in_the_record_alone() -> None:
    outcome = evaluate(_cases(0, Pushes((0.0,), record=(12 * PUSH, STEP))), Settings(runs=30))
    assert (outcome.value[0], outcome.detail["record_overturned"][0]) == (0.0, 1.0)
    assert outcome.flags["fell_in_record"][0]


def test_flags_and_pieces_without_motions_or_too_stocky() -> None:
    ensembles = (MadeUp(0), MadeUp(1, is_assumed=True, is_unknown=True, is_weak=True))
    cases = _cases([0, 1, -1, 1, 0], *ensembles, breadth=[0.3, 0.3, 0.3, 1.41, 1.409], height=[1.8, 1.8, 1.8, 1.0, 1.0])
    outcome = evaluate(cases, Settings(runs=5))
    assert np.isnan(outcome.value).tolist() == [False, False, True, True, False]
    for name in ("runs", "overturned", "low", "high"):
        assert np.isnan(outcome.detail[name]).tolist() == [False, False, True, True, False], name
    for name in ("assumed_motion", "unknown_building", "weak_motions"):
        assert outcome.flags[name].tolist() == [False, True, False, False, False], name
    assert outcome.flags["does_not_rock"].tolist() == [False, False, False, True, False]
    assert not outcome.flags["undecided"].any(), "a fixed number is not a question"


def test_an_ensemble_without_pieces_that_rock_is_not_opened() -> None:
    idle, stocky = MadeUp(0), MadeUp(1)
    outcome = evaluate(_cases([1], idle, stocky, breadth=1.5, height=1.0), Settings(runs=5))
    assert (idle.opened, stocky.opened, list(outcome.joints)) == ([], [], [])


# --- what is not known ---


def test_draws_scale_the_motion_and_change_the_piece() -> None:
    """Draw k is motion k, scaled by the earthquake's factor at the floor's dispersion, on the body of that draw."""
    own = np.repeat(np.linspace(0.0, 0.6, 12), 2)
    cases = dataclasses.replace(_grid(1), uncertainty=Uncertainty(), name=np.arange(24) // 2, dispersion=own)
    outcome = evaluate(cases, Settings(runs=40, seed=7))
    motions = np.stack([make_motion(0, number) for number in range(40)])
    drawn = draw_bodies(
        cases.breadth, cases.height, cases.centre, cases.restitution, cases.name, seed=7, first=0, count=40
    )
    for dispersion in (own[:, None], *TRIED):
        scale = np.exp(dispersion * draw_earthquakes(7, 0, 40)[None])
        found = rock_blocks(
            drawn.breadth, drawn.height, motions, STEP, restitution=drawn.restitution, centre=drawn.centre, scale=scale
        )
        share = outcome.detail[f"dispersion_{dispersion:g}"] if isinstance(dispersion, float) else outcome.value
        np.testing.assert_array_equal(share, found.overturned.mean(axis=1))
    assert (outcome.value != outcome.detail["ideal"]).any()


def test_ideal_is_the_piece_as_given_under_the_motions_themselves() -> None:
    uncertain = dataclasses.replace(_grid(1), uncertainty=Uncertainty())
    one, other = evaluate(_grid(1), Settings(runs=40)), evaluate(uncertain, Settings(runs=40))
    np.testing.assert_array_equal(one.value, one.detail["ideal"])
    np.testing.assert_array_equal(one.value, other.detail["ideal"])
    for name in ("overturned", "low", "high"):
        np.testing.assert_array_equal(one.detail[name], other.detail[f"ideal_{name}"])
    np.testing.assert_array_equal(one.joints[0].ideal, other.joints[0].ideal)


@pytest.mark.parametrize("ideal", [False, True])
def test_of_drawn_motions_none_recurs_and_the_thirds_by_velocity_are_told_apart(ideal: bool) -> None:
    settings = Settings(runs=30, ideal=ideal)
    drawn = evaluate(_cases(0, MadeUp(0, is_assumed=True)), settings)
    recorded = evaluate(_cases(0, MadeUp(0)), settings)
    assert drawn.value == recorded.value
    assert np.isnan(drawn.detail["ideal"][0]) == (not ideal)
    for name in (f"dispersion_{one:g}" for one in TRIED):
        assert np.isnan(drawn.detail[name][0])
        assert not np.isnan(recorded.detail[name][0])
    motions = np.stack([make_motion(0, number) for number in range(30)])
    speed = np.cumsum((motions[:, 1:] + motions[:, :-1]) * STEP / 2, axis=1)
    order = np.argsort(np.abs(speed).max(axis=1) / np.abs(motions).max(axis=1))
    fell = rock_blocks(np.array([0.3]), np.array([1.8]), motions, STEP).overturned[0]
    expected = fell[order[:10]].mean(), fell[order[-10:]].mean()
    assert (drawn.detail["if_slower"][0], drawn.detail["if_faster"][0]) == expected
    assert expected[0] < expected[1]
    assert np.isnan([recorded.detail["if_slower"][0], recorded.detail["if_faster"][0]]).all()


def test_a_draw_of_a_piece_is_its_own() -> None:
    """Neither other pieces nor their order nor the number of draws change what a piece does in draw k."""
    names = {"uncertainty": Uncertainty(), "name": np.arange(100, 124)}
    cases, order = dataclasses.replace(_grid(1), **names), np.random.default_rng(1).permutation(24)
    moved = {one: getattr(cases, one)[order] for one in ("breadth", "height", "centre", "restitution", "name")}
    (all_of_them,) = evaluate(cases, Settings(runs=30)).joints
    (shuffled,) = evaluate(dataclasses.replace(cases, **moved), Settings(runs=30)).joints
    np.testing.assert_array_equal(shuffled.fell, all_of_them.fell[order])
    (fewer,) = evaluate(cases, Settings(runs=12)).joints
    np.testing.assert_array_equal(fewer.fell, all_of_them.fell[:, :12])


def test_batches_go_on_with_the_draws() -> None:
    """Draws beyond a batch are those that one batch of all would have had."""
    cases = _cases(0, Pushes((3.0,)), uncertainty=Uncertainty(), name=5)
    (joint,) = evaluate(cases, Settings(runs=BATCH + 40)).joints
    late = draw_earthquakes(1, BATCH, 40)
    np.testing.assert_array_equal(late, draw_earthquakes(1, 0, BATCH + 40)[BATCH:])
    breadth, height, centre, restitution = (np.array([one]) for one in (0.3, 1.8, 0.5, np.nan))
    drawn = draw_bodies(breadth, height, centre, restitution, [5], seed=1, first=BATCH, count=40)
    motions = np.repeat(3.0 * PUSH[None], 40, axis=0)
    found = rock_blocks(
        drawn.breadth, drawn.height, motions, STEP, restitution=drawn.restitution, centre=drawn.centre,
        scale=np.exp(MOTION * late)[None],
    )  # fmt: skip
    np.testing.assert_array_equal(joint.fell[:, BATCH:], found.overturned)
    assert 0 < found.overturned.sum() < 40


def test_a_centre_of_gravity_is_used() -> None:
    outcomes = [evaluate(_cases(0, Pushes((1.7,)), centre=centre), Settings(runs=3)) for centre in (0.4, 0.6)]
    assert [one.value[0] for one in outcomes] == [0.0, 1.0]
    high = _cases([0, 0], Pushes((2.2,)), breadth=[1.5, 1.5], height=[1.0, 1.0], centre=[0.5, 0.7])
    assert evaluate(high, Settings(runs=3)).flags["does_not_rock"].tolist() == [True, False]


# --- motion by motion ---


def test_joints_hold_what_each_piece_did_under_each_motion() -> None:
    cases = _grid(2)
    outcome = evaluate(cases, Settings(runs=12))
    assert [joint.ensemble for joint in outcome.joints] == [0, 1]
    for joint in outcome.joints:
        np.testing.assert_array_equal(joint.cases, np.flatnonzero(cases.ensemble == joint.ensemble))
        motions = np.stack([make_motion(joint.ensemble, number) for number in range(12)])
        found = rock_blocks(cases.breadth[joint.cases], cases.height[joint.cases], motions, STEP)
        np.testing.assert_array_equal(joint.fell, found.overturned)
        np.testing.assert_array_equal(joint.rotation, found.rotation.astype(np.float32))
        assert joint.runs.tolist() == [12] * len(joint.cases)
        assert joint.fit is None
        for (shown, step), motion in zip(joint.examples, motions[:3], strict=True):
            np.testing.assert_array_equal(shown, motion.astype(np.float32))
            assert step == STEP


def test_the_spectra_kept_are_those_of_motions_that_were_run_and_of_fewer_than_three_all_are_shown() -> None:
    periods = np.array([0.5, 1.0])
    known = Spectra(periods=periods, ordinates=np.ones((100, 2), dtype=np.float32), target=periods)
    for runs, kept in ((2, 2), (100, 100), (120, 100)):
        (joint,) = evaluate(_cases(0, MadeUp(0, spectra=known)), Settings(runs=runs)).joints
        assert joint.spectra is not None
        assert (len(joint.spectra.ordinates), joint.spectra.target is periods) == (kept, True)
    (joint,) = evaluate(_cases(0, MadeUp(0)), Settings(runs=2)).joints
    assert joint.spectra is None
    assert len(joint.examples) == 2


def test_many_motions_are_made_in_batches() -> None:
    ensemble = Pushes((0.0, 3.0))
    outcome = evaluate(_cases(0, ensemble), Settings(runs=2 * BATCH + 1))
    assert ensemble.asked == [(0, BATCH), (BATCH, BATCH), (2 * BATCH, 1), (0, 3)]
    assert outcome.detail["overturned"][0] == BATCH


def test_batches_of_several_time_steps_are_put_together() -> None:
    class Mixed(MadeUp):
        def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
            ((motions, step),) = MadeUp.realise(self, first, count)
            return [(motions[:2], step), (motions[2:], step / 2)]

    cases = _grid(1)
    outcome = evaluate(dataclasses.replace(cases, ensembles=(Mixed(0),)), Settings(runs=5))
    motions = np.stack([make_motion(0, number) for number in range(5)])
    halves = [
        rock_blocks(cases.breadth, cases.height, *batch) for batch in ((motions[:2], STEP), (motions[2:], STEP / 2))
    ]
    np.testing.assert_array_equal(outcome.joints[0].fell, np.concatenate([one.overturned for one in halves], axis=1))
    assert [step for _, step in outcome.joints[0].examples] == [STEP, STEP, STEP / 2]


# --- as many as it takes ---


@pytest.mark.parametrize(
    ("levels", "looks"),
    [
        ((12.0,), 1),  # 125 of 125: from 0.947
        ((0.0,), 2),  # 0 of 125: to 0.053; 0 of 250: to 0.027, low
        ((0.0, 12.0), 1),  # 0.5: 0.38 to 0.62, high
        ((12.0, *[0.0] * 9), 1),  # 13 of 125: 0.053 to 0.197, medium
        ((12.0, 12.0, 12.0, 12.0, 0.0), 2),  # 0.8: 0.69 to 0.88; then 0.72 to 0.86, very high
    ],
)
def test_auto_stops_at_the_first_look_that_lies_in_one_class(levels: tuple[float, ...], looks: int) -> None:
    ensemble = Pushes(levels)
    outcome = evaluate(_cases(0, ensemble), AUTO)
    runs = LOOKS[looks - 1]
    fell = int(sum(level > 0 for level, _ in zip(itertools.cycle(levels), range(runs), strict=False)))
    assert (outcome.detail["runs"][0], outcome.detail["overturned"][0]) == (runs, fell)
    assert outcome.value[0] == fell / runs
    assert (outcome.detail["low"][0], outcome.detail["high"][0]) == wilson_interval(fell, runs, LOOKS_Z)
    assert classify_all(outcome.detail["low"]) == classify_all(outcome.detail["high"])
    assert not outcome.flags["undecided"][0]
    assert ensemble.asked == [*[(0, 125), (125, 125)][:looks], (0, 3)]


def test_auto_ends_undecided_after_5000() -> None:
    """3 of 10 is the limit of a class: no interval about it lies in one."""
    ensemble = Pushes((12.0, 0.0, 0.0, 12.0, 0.0, 0.0, 12.0, 0.0, 0.0, 0.0))
    outcome = evaluate(_cases(0, ensemble), AUTO)
    assert (outcome.detail["runs"][0], outcome.value[0]) == (5000.0, 0.3)
    assert outcome.flags["undecided"][0]
    fresh = [number for first, count in ensemble.asked[:-1] for number in range(first, first + count)]
    assert fresh == list(range(5000)), "fresh motions for each look, none twice"
    assert ensemble.asked[-1] == (0, 3)
    assert max(count for _, count in ensemble.asked) == BATCH
    ends = np.cumsum([count for _, count in ensemble.asked[:-1]])
    assert set(LOOKS) <= set(ends.tolist())


def test_under_auto_pieces_leave_as_they_are_decided() -> None:
    breadth, height = np.array(list(SIZES.values())).T
    ensemble = Pushes((LEVELS["thin"], LEVELS["thin"], LEVELS["usual"], LEVELS["usual"], LEVELS["usual"]))
    outcome = evaluate(_cases(0, ensemble, breadth=breadth, height=height), AUTO)
    (joint,) = outcome.joints
    assert outcome.value.tolist() == [1.0, 0.6, 0.0]
    assert joint.runs.tolist() == outcome.detail["runs"].tolist() == [125, 250, 250]
    assert joint.fell.shape == joint.rotation.shape == (3, 250)
    assert not joint.fell[0, 125:].any()
    assert not joint.rotation[0, 125:].any()
    assert joint.fell.sum(axis=1).tolist() == outcome.detail["overturned"].tolist() == [125, 150, 0]


# --- threads, errors, progress ---


@pytest.mark.parametrize("settings", [Settings(runs=30), AUTO], ids=["30", "auto"])
@pytest.mark.parametrize("ensembles", [1, 3])
@pytest.mark.slow
def test_threads_change_nothing(ensembles: int, settings: Settings) -> None:
    expected = evaluate(_grid(ensembles), settings)
    for threads in (2, 3, 4):
        found = evaluate(_grid(ensembles), settings, threads=threads)
        np.testing.assert_array_equal(found.value, expected.value)
        for name in ("detail", "flags"):
            for key, values in getattr(found, name).items():
                np.testing.assert_array_equal(values, getattr(expected, name)[key], err_msg=key)
        for mine, its in zip(found.joints, expected.joints, strict=True):
            assert mine.ensemble == its.ensemble
            for key in ("cases", "runs", "fell", "ideal", "rotation"):
                np.testing.assert_array_equal(getattr(mine, key), getattr(its, key), err_msg=key)


def test_threads_are_shared_out_among_ensembles() -> None:
    for threads, ensembles, each in ((1, 3, 1), (4, 1, 4), (4, 2, 2), (4, 3, 1), (2, 3, 1)):
        cases = _grid(ensembles)
        evaluate(cases, Settings(runs=2), threads=threads)
        assert [one.opened for one in cases.ensembles] == [[each]] * ensembles  # type: ignore[attr-defined]


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("where", ["open", "realise"])
def test_what_an_ensemble_raises_comes_through(threads: int, where: str) -> None:
    class Broken(MadeUp):
        def open(self, threads: int, progress: Progress = SILENT) -> Motions:
            if where == "open":
                raise RuntimeError("cannot open")
            return super().open(threads, progress)

        def realise(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
            raise RuntimeError("cannot realise")

    cases = _cases([0, 1], MadeUp(0), Broken(1))
    with pytest.raises(RuntimeError, match=f"cannot {where}"):
        evaluate(cases, Settings(runs=5), threads=threads)


@pytest.mark.parametrize("settings", [Settings(runs=1200), AUTO], ids=["1200", "auto"])
@pytest.mark.parametrize("threads", [1, 2])
def test_it_reports_how_far_it_is(threads: int, settings: Settings) -> None:
    reports: list[Report] = []
    with Progress(reports.append).stage("verification", "", 2) as stage:
        evaluate(_cases([0, 1], Pushes((0.0,)), Pushes((12.0,))), settings, threads=threads, stage=stage)
    shares = [one.share for one in reports]
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert shares[-1] == 1.0
    assert len(shares) > 4


@pytest.mark.parametrize("threads", [1, 2])
def test_it_stops_between_batches(threads: int) -> None:
    cancel = threading.Event()
    progress = Progress(lambda report: cancel.set() if report.share > 0 else None, cancel)
    ensembles = Pushes((0.0,)), Pushes((12.0,))
    with pytest.raises(CancelledError), progress.stage("verification", "", 2) as stage:
        evaluate(_cases([0, 1], *ensembles), Settings(runs=10 * BATCH), threads=threads, stage=stage)


def test_its_description_tells_what_it_does_and_the_width_of_intervals() -> None:
    assert interval_width(AUTO) == 2.64
    assert interval_width(Settings(runs=100)) == pytest.approx(1.96, abs=1e-4)
    text = " ".join((*METHOD.assumptions, *METHOD.departures))
    for look in LOOKS:
        assert f"{look:,}" in text
    assert f"z = {LOOKS_Z}" in text
    assert f"N is {Settings().runs} by default" in text
    ends: NDArray[np.float64] = wilson_interval(0, 100)[1]
    assert f"{float(ends):.3f}" in text
