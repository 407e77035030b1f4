"""Signs between floors: of made-up modes, of the records of 575 Market Street, and what they do to common phases."""

import numpy as np
import pytest

from assess.motion.floor_signs import find_coherence, find_levels, find_signs, turn_phases
from assess.motion.target import build_grid, octaves, put_on_grid
from tests.motion.motions import read_motion

STEP = 0.005
TIMES = np.arange(8000) * STEP
FADE = np.sin(np.pi * TIMES / TIMES[-1]) ** 2
AT = {round(float(centre), 1): place for place, centre in enumerate(octaves())}


def wave(frequency):
    return FADE * np.sin(2 * np.pi * frequency * TIMES)


def read_floors(names):
    motions = [read_motion(name) for name in names]
    grid = build_grid(motions)
    return np.array([put_on_grid(one, grid) for one in motions]), grid.time_step


def test_each_octave_has_the_sign_of_its_mode():
    """A first mode that moves both floors alike, and a second that moves them against each other."""
    top = 3 * wave(0.4) + wave(1.6)
    middle = wave(0.4) - 1.5 * wave(1.6)
    signs = find_signs(np.array([middle, top]), STEP)
    assert signs.shape == (2, 9)
    assert (signs[1] == 1).all()
    assert (signs[0, AT[0.4]], signs[0, AT[1.6]]) == (1, -1)
    found = find_coherence(np.array([middle, top]), STEP)
    assert found.shape == (2, 2, 9)
    assert found[0, 1, [AT[0.4], AT[1.6]]] == pytest.approx([1, -1], abs=0.01)
    np.testing.assert_allclose(found[0, 1], found[1, 0], atol=1e-12)


def test_the_reference_is_the_floor_of_the_largest_peak():
    """Signs are relative: a factor on the reference changes all others, a positive one on a floor nothing."""
    floors = np.array([wave(0.8), -5 * wave(0.8), 2 * wave(0.8)])
    assert find_signs(floors, STEP)[:, AT[0.8]].tolist() == [-1, 1, -1]
    assert find_signs(floors * [[6], [1], [1]], STEP)[:, AT[0.8]].tolist() == [1, -1, 1]
    assert (find_signs(floors * [[0.1], [1], [2]], STEP) == find_signs(floors, STEP)).all()


def test_floors_that_move_alike_and_one_alone_have_no_other_sign():
    noise = np.random.default_rng(1).normal(size=8000)
    assert (find_signs(np.array([noise, 0.5 * noise]), STEP) == 1).all()
    assert (find_signs(noise[None], STEP) == 1).all()
    assert (find_signs(np.array([noise, -0.5 * noise]), STEP) == [[1], [-1]]).all()


def test_what_is_a_quarter_of_a_cycle_apart_is_not_coherent():
    late = FADE * np.cos(2 * np.pi * 0.8 * TIMES)
    floors = np.array([wave(0.8), -0.9 * late])
    assert abs(find_coherence(floors, STEP)[0, 1, AT[0.8]]) < 0.02
    assert find_signs(floors, STEP)[1, AT[0.8]] == 1


@pytest.mark.long
def test_unrelated_noise_has_no_sign_but_by_chance():
    """Its coherence is above the level in 5 % of cases, whatever the octave, also where it fades in and out."""
    random, above = np.random.default_rng(3), np.zeros(9)
    spells = np.array([FADE**2, np.roll(FADE, 1000) * (TIMES > 5)])
    for _ in range(300):
        floors = spells * random.normal(size=(2, 8000))
        above += np.abs(find_coherence(floors, STEP)[0, 1]) > find_levels(floors, STEP)[0, 1]
    assert (above / 300).max() < 0.12
    assert (above / 300).mean() == pytest.approx(0.05, abs=0.025)


def test_floors_are_joined_by_the_most_coherent_first():
    """Two floors that move against each other in a mode in which the reference, at a node of it, does not move."""
    random = np.random.default_rng(4)
    reference = 5 * wave(0.2) + random.normal(size=8000)
    upper, lower = (wave(0.2) + turn * 2 * wave(1.6) + 0.1 * random.normal(size=8000) for turn in (1, -1))
    floors = np.array([lower, reference, upper])
    assert np.abs(find_coherence(floors, STEP)[1, [0, 2], AT[1.6]]).max() < find_levels(floors, STEP)[1, 0, AT[1.6]]
    signs = find_signs(floors, STEP)
    assert (signs[1] == 1).all()
    assert signs[:, AT[0.2]].tolist() == [1, 1, 1]
    assert signs[0, AT[1.6]] * signs[2, AT[1.6]] == -1


def test_floors_42_34_and_25_of_575_market_street():
    """The record of 42 and 34 has a coherence of -0.96 at 0.8 to 1.6 Hz, and moves alike below 0.4 Hz."""
    floors, step = read_floors("ad")
    found = find_coherence(floors, step)
    assert found[0, 0] == pytest.approx(1)
    assert found[0, 1, AT[0.8]] < -0.8
    assert found[0, 1, [AT[0.1], AT[0.2]]].min() > 0.9
    signs = find_signs(floors, step)[1]
    assert (signs[AT[0.1]], signs[AT[0.2]], signs[AT[0.8]], signs[AT[1.6]]) == (1, 1, -1, -1)
    assert abs(found[0, 1, AT[0.4]]) < find_levels(floors, step)[0, 1, AT[0.4]], "too weak for a sign"
    assert signs[AT[0.4]] == 1
    transforms = np.fft.rfft(floors, axis=1)
    frequencies = np.fft.rfftfreq(floors.shape[1], step)
    a, d = transforms[:, (frequencies >= 0.8) & (frequencies < 1.6)]
    coherence = (a * d.conj()).sum().real / np.sqrt((np.abs(a) ** 2).sum() * (np.abs(d) ** 2).sum())
    assert coherence == pytest.approx(-0.96, abs=0.005)
    floors, step = read_floors("gh")  # both of the 25th, 45 and 225 deg: opposite wherever the floor moves as one
    assert (find_signs(floors, step)[0, : AT[6.4] + 1] == -1).all()


def test_turned_phases_give_common_noise_the_signs_of_the_records():
    """White noise, turned for floor 34: against it as it is for floor 42, in each octave whose sign is clear."""
    floors, step = read_floors("ad")
    own, signs = find_coherence(floors, step)[0, 1], find_signs(floors, step)[1]
    noise = np.random.default_rng(2).normal(size=16000)
    spectrum = np.fft.rfft(noise)
    turned = np.fft.irfft(spectrum * turn_phases(np.fft.rfftfreq(16000, STEP), signs), 16000)
    found = find_coherence(np.array([noise, 0.5 * turned]), STEP)[0, 1]
    clear = np.abs(own) > 0.6
    assert clear.sum() >= 4
    assert (np.sign(found) == signs)[clear].all()
    assert (np.abs(found[clear]) > 0.4).all()


def test_turning_keeps_amplitudes_is_the_sign_at_centres_and_keeps_the_relation_of_floors_that_both_turn():
    signs = np.array([1, -1, -1, 1, 1, -1, 1, 1, 1])
    assert turn_phases(octaves(), signs) == pytest.approx(signs)
    assert np.abs(turn_phases(np.linspace(0, 100, 5001), signs)) == pytest.approx(1)
    assert turn_phases(np.linspace(0, 100, 5001), np.ones(9, dtype=int)) == pytest.approx(1)
    # one of 1, -1, -1, 1 and one of 1, 1, 1, -1: against each other from the second octave on, also in between
    frequencies = np.geomspace(0.2, 1.6, 50)
    one, other = (turn_phases(frequencies, [*signs, *[signs[-1]] * 5]) for signs in ((1, -1, -1, 1), (1, 1, 1, -1)))
    assert one[frequencies > 0.2] * other[frequencies > 0.2].conj() == pytest.approx(-1)


@pytest.mark.parametrize(
    "floors", [np.zeros((0, 100)), np.ones(100), np.array([wave(1.0), 0 * TIMES]), np.array([[1.0, np.nan]])],
    ids=["no floor", "one row", "no motion", "not finite"],
)  # fmt: skip
def test_what_is_no_record_of_floors_is_refused(floors):
    with pytest.raises(ValueError, match="expected \\(k, n\\) finite samples, each row with motion"):
        find_signs(floors, STEP)
