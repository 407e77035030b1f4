"""The calibration: its arithmetic by hand, its errors on groups that are known, its floor motions, and its page."""

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.motion.generate import build_generator
from assess.motion.target import build_grid, recorded_target
from assess.risk import RiskClass
from assess.rocking.ensemble import rock_blocks
from assess.studies import calibration
from assess.studies.buildings import all_buildings
from assess.studies.calibration import (
    BEAMS,
    BLOCKS,
    LEVELS,
    RECORDED,
    Outcomes,
    Tried,
    by_chance,
    by_class,
    calibrate,
    collect,
    draw_seed,
    find_error,
    find_score,
    list_beams,
    list_recorded,
    try_floors,
)  # fmt: skip
from assess.studies.study import PARTS, Options, render_block
from assess.units import GRAVITY

RUNS = 100
SHAPE = (8, 12)


def outcomes(chance, fell, floor=None, source=None):
    floor = range(len(chance)) if floor is None else floor
    source = floor if source is None else source
    return Outcomes(np.array(chance), np.array(fell, dtype=bool), np.array(floor), np.array(source))


# ---------------------------------------------------------------- the arithmetic


def test_score_by_hand():
    found = find_score(outcomes([0.1, 0.2, 0.6], [0, 0, 1], floor=[0, 0, 1]))
    assert (found.cases, found.fallen, found.floors) == (3, 1, 2)
    assert (found.chance, found.share) == pytest.approx((0.3, 1 / 3))
    assert found.difference == pytest.approx(0.3 - 1 / 3)
    assert find_score(outcomes([], [])) is None


def test_classes_and_points_of_the_figure_take_every_case_once():
    """The limits 0.03, 0.3 and 0.7 belong to the higher class."""
    found = by_class(outcomes([0.0, 0.02, 0.03, 0.29, 0.3, 0.69, 0.7, 1.0], [0, 1, 0, 0, 1, 0, 1, 1]))
    assert [(one.cases, one.fallen) for one in found.values()] == [(2, 1), (2, 0), (2, 1), (2, 2)]
    assert list(found) == list(RiskClass)
    assert found[RiskClass.LOW].difference == pytest.approx(0.01 - 0.5)
    assert list(by_class(outcomes([0.5], [1]))) == [RiskClass.HIGH]
    chance = np.round(np.arange(0, 1.001, 0.01), 2)
    points = list(by_chance(outcomes(chance, chance > 0.5)))
    assert [one.cases for one in points] == [3, 7, *[10] * 8, 11]
    assert (points[0].chance, points[-1].share) == pytest.approx((0.01, 1))


def test_error_knows_that_cases_of_a_group_are_not_independent_and_weighs_unequal_groups():
    """Each value ten times over is no more than the value once, and the names of the groups do not matter."""
    values = np.array([0.1, -0.3, 0.5, 0.2, 0.0, -0.4])
    one = find_error(values, np.arange(6))
    assert one == pytest.approx(values.std(ddof=1) / math.sqrt(6)), "that of a mean"
    assert find_error(np.repeat(values, 10), np.repeat([9, 2, 5, 70, 1, 3], 10)) == pytest.approx(one)
    assert find_error(np.repeat(values, 10), np.arange(60)) < 0.4 * one
    # three groups: means without each are 1.5/3, 2/3 and 0.5/2 of the sums 1, 0.5, 1 of 1, 1 and 2 values
    values, groups = np.array([1.0, 0.5, 0.25, 0.75]), np.array([0, 1, 2, 2])
    without = np.array([1.5 / 3, 2 / 3, 1.5 / 2])
    assert find_error(values, groups) == pytest.approx(math.sqrt(2 / 3 * np.sum((without - without.mean()) ** 2)))


def test_error_of_one_group_and_of_what_never_or_always_happened_is_unknown():
    assert math.isnan(find_error(np.array([0.1, 0.2]), np.array([3, 3])))
    alone = find_score(outcomes([0.1, 0.9], [0, 1], floor=[0, 1], source=[0, 0]))
    assert math.isnan(alone.error_by_source)
    assert alone.largest_error == alone.error > 0
    for fell in ([0, 0, 0], [1, 1, 1]):
        found = find_score(outcomes([0.1, 0.2, 0.3], fell))
        assert math.isnan(found.error)
        assert math.isnan(found.error_by_source)
        assert not found.is_clear


def test_error_is_the_scatter_of_the_mean():
    """Drawn often, with values that are alike within groups, the mean scatters as the error says, within 10 %."""
    rng = np.random.default_rng(5)
    groups = np.repeat(np.arange(30), rng.integers(3, 20, 30))
    drawn = [rng.normal(size=30)[groups] + 0.5 * rng.normal(size=groups.size) for _ in range(500)]
    scatter = np.std([values.mean() for values in drawn])
    assert np.mean([find_error(values, groups) for values in drawn]) == pytest.approx(scatter, rel=0.1)


def test_difference_beyond_twice_the_larger_error_is_clear():
    found = find_score(outcomes([0.1, 1.0, 0.8], [0, 0, 1]))
    assert found is not None
    score = replace(found, difference=0.2, error=0.1, error_by_source=0.1)
    assert not replace(score, error_by_source=0.101).is_clear
    assert replace(score, error=0.09, error_by_source=0.02).is_clear
    assert not replace(score, error=math.nan, error_by_source=math.nan).is_clear


# ---------------------------------------------------------------- chances that are known


def make_tried(floors, chance, seed):
    """Trials whose chances ``chance`` are right: what falls is drawn by them."""
    rng = np.random.default_rng(seed)
    found = []
    for floor in floors:
        right = chance(rng, SHAPE)
        fallen = np.rint(right * RUNS).astype(np.int64)
        found.append(Tried(floor, np.arange(1.0, 9.0), fallen, rng.random(SHAPE) < right, RUNS))
    return found


def test_right_chances_are_found_right_and_wrong_ones_wrong():
    """Wrong are chances of 0.2 that come true in half of the cases."""
    found = calibrate(make_tried(list_beams(), lambda rng, shape: np.round(rng.random(shape), 2), 8))
    assert found.whole.cases == 56 * 96
    assert abs(found.whole.difference) < 3 * found.whole.error < 0.03
    assert set(found.classes) == set(RiskClass)
    for one in found.classes.values():
        assert abs(one.difference) < (3 * one.error if one.fallen else 0.03)
    tried = make_tried(list_beams(), lambda _, shape: np.full(shape, 0.5), 9)
    wrong = calibrate([replace(one, fallen=np.full(SHAPE, 20)) for one in tried])
    assert wrong.whole.difference == pytest.approx(-0.3, abs=0.03)
    assert wrong.whole.is_clear
    assert list(wrong.classes) == [RiskClass.MEDIUM]


def test_cases_are_of_their_floor_and_of_its_site_and_axis():
    tried = make_tried(list_recorded(), lambda _, shape: np.full(shape, 0.5), 1)
    found = Outcomes.of(tried)
    assert found.floor.tolist() == np.repeat(np.arange(21), 96).tolist()
    sources = [{tried[floor].floor.source for floor in found.floor[found.source == one]} for one in range(5)]
    assert sources == [
        {"575 Market Street, Y"}, {"575 Market Street, X"}, {"Great Western Savings, X"},
        {"Great Western Savings, Y"}, {"LACPW headquarters, X"},
    ]  # fmt: skip


# ---------------------------------------------------------------- the floor motions


def test_floors_are_all_channels_of_the_buildings_and_beams_on_every_ground_motion():
    channels = [one for building in all_buildings() for one in building.channels]
    floors, beams = list_recorded(), list_beams()
    assert [(one.channel.file, one.channel.axis) for one in floors] == [(one.file, one.axis) for one in channels]
    assert floors[3].read().pfa == channels[3].read().pfa
    grounds = {one.channel.file.name for one in beams}
    assert len(beams) == len(set(map(str, beams))) == 8 * len(grounds)
    assert grounds == {
        "891018_1.cra-1.0210k.smc", "1103.HN2.NP.BE_a.smc", "1103.HN2.NP.BW_a.smc", "1103.HN3.NP.BE_a.smc",
        "1103.HN3.NP.BW_a.smc", "np01002p_4225a_a.smc", "np01002p_4225c_a.smc",
    }  # fmt: skip
    seeds = {draw_seed(one, 1) for one in floors + beams}
    assert len(seeds) == len(floors + beams)
    assert not seeds & {draw_seed(one, 2) for one in floors + beams}
    assert draw_seed(floors[0], 1) == draw_seed(list_recorded()[0], 1)


def test_floors_of_beams_swing_on_after_the_ground_motion():
    """T1 of 4 s: 20 s longer than the record, and what swings on does so at an odd multiple of 1/T1."""
    (beam,) = (
        one for one in list_beams()
        if one.channel.file.name == "np01002p_4225a_a.smc" and (one.beam.period, one.beam.place) == (4.0, 1.0)
    )  # fmt: skip
    floor, ground = beam.read(), replace(beam, beam=None).read()
    assert floor.acceleration.size * floor.time_step == pytest.approx(ground.acceleration.size * 0.005 + 20, abs=0.02)
    after = floor.acceleration[ground.acceleration.size :]
    assert 0.02 < np.abs(after).max() / floor.pfa < 1
    spectrum = np.abs(np.fft.rfft(after * np.hanning(after.size), 2**15))
    multiple = 4.0 * np.fft.rfftfreq(2**15, floor.time_step)[spectrum.argmax()]
    assert min(abs(multiple - odd) for odd in (1, 3, 5)) < 0.1


# ---------------------------------------------------------------- what falls


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """Two floor motions, one of each kind, with few motions."""
    folder = tmp_path_factory.mktemp("calibration")
    return folder, try_floors(pick(), Options(out=folder, runs=4, seed=3))


def pick():
    return [list_recorded()[-1], list_beams()[-3]]


@pytest.mark.slow
def test_what_falls_is_that_of_the_scaled_motions(kept):
    """One block on both floors, by hand."""
    breadth, height = BLOCKS
    at = 5
    for tried in kept[1]:
        motion = tried.floor.read()
        grid = build_grid([motion])
        seed = draw_seed(tried.floor, 3)
        target, axis = recorded_target(motion, grid), tried.floor.channel.axis
        made = build_generator(target, grid, seed=seed, axis=axis).realise(0, 4)
        for level, pfa in enumerate(LEVELS):
            factor = pfa * GRAVITY / motion.pfa
            alone = rock_blocks(breadth[at], height[at], factor * made, grid.time_step)
            itself = rock_blocks(breadth[at], height[at], factor * motion.acceleration[None], motion.time_step)
            assert tried.fallen[level, at] == alone.overturned.sum()
            assert tried.fell[level, at] == itself.overturned[0, 0]
            assert tried.factors[level] == pytest.approx(factor)
        assert 0 < tried.fallen.mean() < 4
        assert 0 < tried.fell.mean() < 1


@pytest.mark.slow
def test_threads_change_nothing_and_a_part_is_loaded(kept, tmp_path):
    folder, found = kept
    before = {file: file.stat().st_mtime_ns for file in (folder / PARTS).iterdir()}
    assert len(before) == 2
    again = try_floors(pick(), Options(out=folder, runs=4, seed=3, jobs=2))
    assert {file: file.stat().st_mtime_ns for file in (folder / PARTS).iterdir()} == before
    anew = try_floors(pick()[1:], Options(out=tmp_path, runs=4, seed=3, jobs=2))
    for one, other in ((again[0], found[0]), (again[1], found[1]), (anew[0], found[1])):
        for name in ("factors", "fallen", "fell"):
            assert getattr(one, name).tobytes() == getattr(other, name).tobytes()


# ---------------------------------------------------------------- the page


def made_up_page(chance, fell):
    """Both kinds of floors with one chance, which comes true where ``fell`` says so, by the number of the floor."""
    found = {
        name: calibrate([Tried(one, np.ones(8), np.full(SHAPE, round(chance * RUNS)), fell(at), RUNS)
                         for at, one in enumerate(floors)])
        for name, floors in ((RECORDED, list_recorded()), (BEAMS, list_beams()))
    }  # fmt: skip
    values = collect(found, Options(out=None))
    return [" ".join(render_block("calibration", block, **values)) for block in ("summary", "page")]


def test_the_page_says_where_chances_did_not_come_true():
    summary, page = made_up_page(0.01, lambda _: np.zeros(SHAPE, dtype=bool))
    assert "+1.0 ± - points on recorded floors" in summary
    assert "Of 7,392 cases of class low the floor motions themselves overturned 0." in summary
    assert "| recorded floors | low | 2,016 | 21 | 1.0 % | 0 (0.0 %) | +1.0 | - | - |" in page
    said = "Of 2,016 cases of class low, with a mean chance of 1.0 %, the floor motions themselves overturned 0."
    assert said in page
    assert "In no other class is the difference beyond twice its error." in page
    _, page = made_up_page(0.5, lambda at: np.arange(96).reshape(SHAPE) % 4 < 3 - at % 2)
    assert "In class high the difference is beyond twice its error, -12." in page
    assert "points: chances are too low there." in page
    assert "more than twice its error: a bias" in page
    _, page = made_up_page(0.5, lambda at: np.full(SHAPE, at % 2 == 0))
    assert page.count("within twice its error: no bias is seen") == 2
    assert page.count("In no class is the difference beyond twice its error.") == 2


def test_tables_and_figure_hold_every_case(monkeypatch, tmp_path):
    def quick(floors, _):
        return make_tried(floors, lambda rng, shape: np.round(rng.random(shape), 2), 4)

    monkeypatch.setattr(calibration, "try_floors", quick)
    finding = calibration.STUDY.run(Options(out=tmp_path))
    rows = finding.tables["calibration-cases"].rows
    assert len(rows) == 77 * 96
    by_name, scores = (
        [dict(zip(table.columns, row, strict=True)) for row in table.rows]
        for table in (finding.tables["calibration-cases"], finding.tables["calibration"])
    )
    for name in (RECORDED, BEAMS):
        own = [row for row in by_name if row["kind"] == name]
        (whole,) = (row for row in scores if (row["kind"], row["class"]) == (name, "all"))
        assert whole["cases"] == len(own)
        assert whole["fallen"] == sum(bool(row["fell_itself"]) for row in own)
        assert whole["chance"] == pytest.approx(np.mean([row["fallen"] / row["runs"] for row in own]))
    text = finding.figures["calibration.svg"].decode()
    assert all(words in text for words in (RECORDED, BEAMS, "share that the floor motion itself overturned"))
