"""What `assess rock` shows: the words of each outcome, and a figure that holds the motion and the path."""

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from assess.errors import InputError
from assess.report.commands import rocking
from assess.report.commands.rocking import describe, list_lines, read_case, tell_outcome, write_figure
from assess.report.figures import draw as figures

SAMPLES = Path(__file__).parents[2] / "samples" / "records"
FLOOR, SWEEP = str(SAMPLES / "0165a_u.smc"), str(SAMPLES / "made-up-sweep.csv")


@dataclass
class Found:
    """What a block did, made up."""

    critical_angle: float = 0.2
    frequency_parameter: float = 2.8
    restitution: float = 0.93
    overturned: bool = False
    rotation: float = 0.0
    fall_time: float = math.nan
    impacts: int = 0
    times: np.ndarray = field(default_factory=lambda: np.array([0.0, 30.0]))
    theta: np.ndarray = field(default_factory=lambda: np.zeros(2))
    impact_times: np.ndarray = field(default_factory=lambda: np.zeros(0))


def fallen(side=1, at=5.39):
    return Found(
        overturned=True, rotation=7.9, fall_time=at, impacts=3, times=np.array([0, 2, 3, 4, at]),
        theta=side * np.array([0, 0, -0.05, 0, math.pi / 2]), impact_times=np.array([2.5, 2.8, 4.0]),
    )  # fmt: skip


def case(pfa=0.5, record=FLOOR, restitution=None):
    return read_case(40, 180, record, pfa, restitution, "standard")


@pytest.mark.parametrize(
    ("pfa", "found", "words"),
    [
        (0.5, fallen(), "overturns at 5.39 s, after 3 impacts"),
        (0.5, Found(overturned=True, fall_time=2.0, impacts=1), "overturns at 2.00 s, after 1 impact"),
        (0.5, Found(rotation=0.333, impacts=135), "does not overturn: rotates to 0.33 of the critical angle, 135 imp"),
        (0.5, Found(rotation=1.05, impacts=1), "does not overturn: rotates to 1.05 of the critical angle, 1 impact"),
        (0.5, Found(rotation=0.0123), "does not overturn: rotates to 0.012 of the critical angle, 0 impacts"),
        (
            0.5,
            Found(rotation=1e-7, impacts=1),
            "does not overturn: rotates to less than 0.001 of the critical angle, 1 impact",
        ),
        (0.1, Found(), "does not start to rock: the peak 0.1000 g does not exceed its threshold 0.2222 g"),
        (0.23, Found(), "does not start to rock: the peak 0.2300 g does not stay above its threshold 0.2222 g"),
    ],
)
def test_outcomes_in_words(pfa, found, words):
    assert tell_outcome(case(pfa), found).startswith(words)


def test_the_document_says_null_where_nothing_falls():
    assert describe(case(), Found(rotation=0.3, impacts=4)) == {
        "overturned": False,
        "max_rotation_ratio": 0.3,
        "impacts": 4,
        "overturn_time_s": None,
        "pfa_g": 0.5,
        "critical_angle_rad": 0.2,
        "frequency_parameter_rad_s": 2.8,
        "restitution": 0.93,
    }
    assert describe(case(), fallen())["overturn_time_s"] == 5.39


def test_the_lines_fit_a_screen_and_say_what_was_done():
    lines = list(list_lines(case(), fallen()))
    assert [line[:9].strip() for line in lines] == ["Block", "Record", "", "Motion", "Rocks", "Outcome", "Limits"]
    assert lines[0].endswith("restitution 0.9300 (Housner's)")
    assert next(list_lines(case(restitution=0.93), fallen())).endswith("(given)")


def test_a_motion_is_scaled_as_a_whole():
    own, scaled = case(None), case(0.5)
    assert (own.factor, own.motion.pfa) == (1, own.channel.motion.pfa)
    assert scaled.factor == pytest.approx(0.5 * 9.80665 / own.motion.pfa)
    for name in ("acceleration", "velocity", "displacement"):
        np.testing.assert_allclose(getattr(scaled.motion, name), scaled.factor * getattr(own.motion, name), rtol=1e-15)
    assert scaled.motion.pfa == pytest.approx(0.5 * 9.80665, rel=1e-15)
    np.testing.assert_array_equal(scaled.channel.motion.acceleration, own.motion.acceleration)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((4.9, 180, FLOOR, None, None, "standard"), r"--breadth is 4\.9 cm, expected 5 to 600 cm"),
        ((40, 601, FLOOR, None, None, "standard"), r"--height is 601 cm, expected 5 to 600 cm"),
        ((40, 180, FLOOR, 50.1, None, "standard"), r"--pfa is 50\.1 g, expected above 0 and at most 50 g"),
        ((40, 180, FLOOR, None, math.nan, "standard"), r"--restitution is nan, expected 0 to 1"),
        ((40, 180, FLOOR, None, None, ""), r"--baseline is '', expected one of: standard, none"),
        ((40, 180, SWEEP, None, None, "none"), r"holds 3 channels: north, east, up\. Write which"),
        ((40, 180, f"{SWEEP}#up", None, None, "none"), r"#up is a vertical channel, which topples no furniture"),
    ],
)
def test_what_cannot_be_asked_for(given, message):
    with pytest.raises(InputError, match=message):
        read_case(*given)


def paint(one, found):
    figure = Figure(figsize=(8, 4.6), layout="constrained")
    rocking._paint(one, found, figure)
    return figure


def test_the_figure_shows_motion_threshold_path_and_impacts():
    one, found = case(), fallen()
    top, bottom = paint(one, found).axes
    assert top.get_title(loc="left") == "The block overturns at 5.39 s, after 3 impacts"
    before, after, *limits = (line for line in top.lines if line.get_linestyle() != "")
    assert before.get_xdata().max() <= 5.39 < after.get_xdata().min()
    drawn = np.concatenate([before.get_ydata(), after.get_ydata()])
    assert np.abs(drawn).max() == pytest.approx(0.5)
    assert [line.get_ydata()[0] for line in limits[:2]] == pytest.approx([40 / 180, -40 / 180])
    path, *limits = bottom.lines
    np.testing.assert_array_equal(path.get_xdata(), found.times)
    assert path.get_ydata()[-1] == pytest.approx(math.pi / 2 / 0.2)
    assert [line.get_ydata()[0] for line in limits[:2]] == [1, -1]
    assert limits[2].get_xdata()[0] == 5.39
    ticks = [segment[0][0] for segment in bottom.collections[0].get_segments()]
    np.testing.assert_array_equal(ticks, found.impact_times)
    assert bottom.get_xlim() == (0, pytest.approx(30.055))
    low, high = bottom.get_ylim()
    assert (low, high) == pytest.approx((-1.5, 2.3))


def test_the_figure_is_turned_towards_the_fall_and_reaches_it():
    _, bottom = paint(case(), fallen(side=-1, at=33.0)).axes
    assert bottom.get_ylim() == pytest.approx((-2.3, 1.5))
    assert bottom.get_xlim()[1] == 33


def test_a_long_path_is_thinned_out_and_keeps_its_peak_and_its_end():
    times = np.linspace(0, 30, 200_001)
    theta = 0.1 * np.sin(times)
    theta[77_777], theta[-1] = 0.19, 0.05
    found = Found(rotation=0.95, times=times, theta=theta)
    _, bottom = paint(case(), found).axes
    drawn = bottom.lines[0]
    assert drawn.get_xdata().size <= rocking.MOST_POINTS + 1
    assert drawn.get_ydata().max() == pytest.approx(0.95)
    assert (drawn.get_xdata()[-1], drawn.get_ydata()[-1]) == (30, pytest.approx(0.25))


def test_thinning_out_keeps_a_peak_among_the_last_points():
    values = np.zeros(9_001)
    values[-2] = 1
    times, kept = figures.thin_out(np.arange(9_001.0), values)
    assert kept.max() == 1
    assert times[-1] == 9_000
    assert kept.size <= figures.MOST_POINTS + 2


def test_names_that_look_like_mathematics_are_drawn_as_they_are(tmp_path):
    path = tmp_path / "$x$_{.csv"
    path.write_bytes(Path(SWEEP).read_bytes())
    write_figure(case(record=f"{path}#north"), fallen(), tmp_path / "x.svg")
    text = (tmp_path / "x.svg").read_text(encoding="utf-8")
    assert ET.fromstring(text).tag.endswith("svg")
    assert re.search(r"\$x\$_\{", text)
