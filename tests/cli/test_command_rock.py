"""`assess rock`: the document, the text and the figure of one block under one record, and what it says of bad input."""

import json
import math
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from assess.cli import rock_output
from assess.cli.rock_output import describe_outcome, draw_figure, read_case
from assess.motion.formats import read_channel
from assess.rocking.planar import Body, follow_body
from assess.rocking.sliding import critical_friction, peak_slip
from assess.units import GRAVITY as G
from tests.cli.calling import error, run
from tests.motion.writers import THREE, csmip_v2, zipped

ROOT = Path(__file__).parents[2]
SAMPLES = ROOT / "samples" / "records"
FLOOR, SWEEP = SAMPLES / "0165a_u.smc", SAMPLES / "made-up-sweep.csv"
KEYS = {
    "overturned", "max_rotation_ratio", "impacts", "overturn_time_s", "pfa_g", "critical_angle_rad",
    "frequency_parameter_rad_s", "restitution",
}  # fmt: skip
USUAL = {"breadth": 40, "height": 180, "record": FLOOR}


def rock(*flags: object, **options: object):
    given = {**USUAL, **options}
    arguments = [str(part) for name, value in given.items() for part in (f"--{name}", value)]
    return run("rock", *arguments, *flags)


def document(*flags: object, **options: object):
    done = rock("--json", *flags, **options)
    assert (done.exit_code, done.stderr) == (0, "")
    return json.loads(done.stdout)


def test_the_document_has_the_keys_of_the_contract():
    falls, stands = document(pfa=0.5), document(pfa=0.3)
    assert set(falls) == set(stands) == KEYS
    assert (falls["overturned"], stands["overturned"]) == (True, False)
    assert 0 < falls["overturn_time_s"] < 31
    assert stands["overturn_time_s"] is None
    assert falls["max_rotation_ratio"] == pytest.approx(1.5707963267948966 / falls["critical_angle_rad"])
    assert 0 < stands["max_rotation_ratio"] < 1
    assert stands["critical_angle_rad"] == pytest.approx(0.21866894587)
    assert stands["frequency_parameter_rad_s"] == pytest.approx(2.82446526)
    assert stands["restitution"] == pytest.approx(0.92941176)
    assert isinstance(stands["impacts"], int)


def test_the_motion_is_scaled_to_the_peak_that_is_asked_for():
    own = json.loads(run("record", FLOOR, "--json").stdout)["channels"][0]["pfa_g"]
    assert document()["pfa_g"] == own
    assert document(pfa=0.31)["pfa_g"] == 0.31
    assert document(pfa=own) == document()
    ratios = [document(pfa=pfa)["max_rotation_ratio"] for pfa in (0.1, 0.25, 0.3, 0.5)]
    assert ratios == sorted(ratios)
    assert ratios[0] == 0


def test_restitution_and_baseline_change_the_outcome():
    usual = document(pfa=0.3)
    other = document(pfa=0.3, restitution=0.9)
    assert other["restitution"] == 0.9
    assert other["max_rotation_ratio"] != usual["max_rotation_ratio"]
    assert document(pfa=0.3, baseline="standard") == usual
    plain = document(pfa=0.3, baseline="none")
    assert plain["max_rotation_ratio"] != usual["max_rotation_ratio"]
    corrected = SAMPLES / "np01002p_4225a_a.smc"
    assert document(record=corrected, baseline="none") == document(record=corrected)


def test_the_centre_of_gravity_changes_angle_frequency_restitution_and_threshold():
    """Reference values: a 40 x 190 cm block by the equations of a body with I_cg = m (B2 + H2)/12."""
    expected = {40: (0.25732, 2.87596, 0.91414), 50: (0.20750, 2.75246, 0.93634), 60: (0.17367, 2.61979, 0.95163)}
    for cg, values in expected.items():
        found = document(height=190, pfa=0.1, cg=cg)
        names = ("critical_angle_rad", "frequency_parameter_rad_s", "restitution")
        assert [found[name] for name in names] == pytest.approx(values, abs=6e-6)
    assert document(height=190, pfa=0.1, cg=50) == document(height=190, pfa=0.1)
    starts = {cg: document(height=190, pfa=0.19, cg=cg)["max_rotation_ratio"] > 0 for cg in expected}
    assert starts == {40: False, 50: False, 60: True}


def test_a_channel_of_a_file_and_of_an_archive(tmp_path):
    assert document(record=f"{SWEEP}#north")["pfa_g"] == pytest.approx(0.3)
    named = "Record   made-up-sweep.csv#east (channel east, 3rd floor, 90 deg, plain CSV)"
    assert named in rock(record=f"{SWEEP}#east").stdout
    (tmp_path / "set.zip").write_bytes(zipped({"CHAN.V2": csmip_v2(*THREE)}))
    assert "Record   set.zip#11 (channel 11, " in rock(record=f"{tmp_path / 'set.zip'}#11").stdout


def test_sizes_may_have_their_unit_as_in_the_workbook():
    usual = rock("--json", breadth=30.48, height=182.88).stdout
    for breadth, height in (("12in", "6ft"), ("1'", "6' 0\""), ("0.3048 m", "1828.8mm")):
        assert rock("--json", breadth=breadth, height=height).stdout == usual
    for size in ("forty", "12 apples", "1,234.5.6"):
        assert f"'{size}' is not a number; expected one such as 40 or 12in" in error(rock(breadth=size))


@pytest.mark.parametrize(
    ("kind", "magic", "pfa"), [("png", b"\x89PNG", 0.1), ("svg", b"<?xml", 0.3), ("pdf", b"%PDF", 0.5)]
)
@pytest.mark.slow
def test_the_figure_is_written_and_the_same_twice(tmp_path, kind, magic, pfa):
    paths = [tmp_path / f"a.{kind}", tmp_path / "b.svg"]
    for path in paths:
        done = rock("--json", pfa=pfa, plot=path)
        assert (done.exit_code, done.stderr) == (0, f"wrote {path}\n")
        assert set(json.loads(done.stdout)) == KEYS
    assert paths[0].read_bytes().startswith(magic)
    assert kind != "svg" or paths[0].read_bytes() == paths[1].read_bytes()
    assert sorted(tmp_path.iterdir()) == paths


def test_the_example_of_the_documentation_is_what_is_printed(monkeypatch):
    monkeypatch.chdir(ROOT)
    text = (ROOT / "docs" / "commands.md").read_text("utf-8")
    found = re.search(r"^assess (rock .*)\n\n((?:.+\n)+?)```", text, re.MULTILINE)
    assert found
    assert run(*found[1].split()).stdout == found[2]


# ---------------------------------------------------------------- made-up responses: words and figure


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


def case(pfa=0.5, record=FLOOR, restitution=None, cg=None):
    return read_case(40, 180, str(record), pfa, restitution, "standard", cg)


def test_outcomes_in_words():
    for pfa, found, words in (
        (0.5, Found(overturned=True, fall_time=2.0, impacts=1), "overturns at 2.00 s, after 1 impact"),
        (0.5, Found(rotation=1.05, impacts=1), "does not overturn: rotates to 1.05 of the critical angle, 1 impact"),
        (0.5, Found(rotation=0.0123), "does not overturn: rotates to 0.012 of the critical angle, 0 impacts"),
        (0.23, Found(), "does not start to rock: the peak 0.2300 g does not stay above its threshold 0.2222 g"),
    ):
        assert describe_outcome(case(pfa), found).startswith(words), words


def paint(one, found):
    figure = Figure(figsize=(8, 4.6), layout="constrained")
    rock_output.paint(one, found, figure)
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


def test_the_figure_shows_the_threshold_of_the_centre_of_gravity_and_is_turned_towards_the_fall():
    top, _ = paint(case(cg=60), fallen()).axes
    texts = [text.get_text() for text in top.texts]
    assert any(text.startswith("40 × 180 cm, B/H 0.222, centre of gravity at 60 % of the height, ") for text in texts)
    assert "dashed: ±b/z_c = ±0.185 g, above which it starts to rock" in texts
    assert top.lines[2].get_ydata()[0] == pytest.approx(20 / 108)
    _, bottom = paint(case(), fallen(side=-1, at=33.0)).axes
    assert bottom.get_ylim() == pytest.approx((-2.3, 1.5))
    assert bottom.get_xlim()[1] == 33


def test_a_long_path_is_thinned_out_and_keeps_its_peak_and_its_end():
    times = np.linspace(0, 30, 200_001)
    for at in (77_777, 199_998):
        theta = 0.1 * np.sin(times)
        theta[at], theta[-1] = 0.19, 0.05
        _, bottom = paint(case(), Found(rotation=0.95, times=times, theta=theta)).axes
        drawn = bottom.lines[0]
        assert drawn.get_xdata().size <= rock_output.MOST_POINTS + 2
        assert drawn.get_ydata().max() == pytest.approx(0.95)
        assert (drawn.get_xdata()[-1], drawn.get_ydata()[-1]) == (30, pytest.approx(0.25))


@pytest.mark.slow
def test_names_that_look_like_mathematics_are_drawn_as_they_are(tmp_path):
    path = tmp_path / "$x$_{.csv"
    path.write_bytes(SWEEP.read_bytes())
    text = draw_figure(case(record=f"{path}#north"), fallen(), "svg").decode()
    assert ET.fromstring(text).tag.endswith("svg")
    assert re.search(r"\$x\$_\{", text)


# ---------------------------------------------------------------- vertical motion, a wall and friction

VERDICT = {"overturned", "max_rotation_ratio", "impacts", "overturn_time_s"}


def north(*flags: object):
    return document(*flags, record=f"{SWEEP}#north")


def test_without_options_nothing_is_added():
    plain = north()
    assert not {"wall", "vertical", "friction"} & set(plain)
    for flags, key in ((("--wall",), "wall"), (("--friction", 0.3), "friction")):
        found = north(*flags)
        assert {name: found[name] for name in plain} == plain, "the verdict is that of the free block without sliding"
        assert set(found) == {*plain, key}


def test_friction():
    found = north("--friction", 0.25, "--pfa", 0.5)["friction"]
    motion = read_channel(f"{SWEEP}#north").motion
    scaled = motion.acceleration * 0.5 * G / motion.pfa
    assert found == {
        "coefficient": 0.25,
        "branch": "slide and rock",
        "critical_friction": pytest.approx(float(critical_friction(0.4, 1.8, 0.5 * G)), rel=1e-12),
        "outside_shenton": False,
        "peak_slip_cm": pytest.approx(100 * peak_slip(0.25, scaled[None], motion.time_step)[0, 0], rel=1e-9),
    }
    assert found["peak_slip_cm"] > 1
    branches = [north("--friction", mu, "--pfa", 0.5)["friction"]["branch"] for mu in (0.2, 0.6)]
    assert branches == ["slide", "rock"]
    rests = north("--friction", 0.6, "--pfa", 0.1)["friction"]
    assert (rests["branch"], rests["critical_friction"], rests["peak_slip_cm"]) == ("rest", None, 0)


def test_a_wall_on_either_side():
    found = north("--wall")["wall"]
    body, motion = Body.rectangular(0.4, 1.8), read_channel(f"{SWEEP}#north").motion
    assert found["rebound"] == pytest.approx(float(body.rebound), rel=1e-12)
    for where, away in (("negative_side", 1), ("positive_side", -1)):
        one = follow_body(body, motion.acceleration, motion.time_step, away=away)
        assert set(found[where]) == VERDICT
        assert found[where]["overturned"] == one.overturned
        assert found[where]["max_rotation_ratio"] == pytest.approx(one.rotation, rel=1e-6)
    assert found["negative_side"]["max_rotation_ratio"] != found["positive_side"]["max_rotation_ratio"]


def test_vertical_motion_which_the_walls_verdicts_hold_too():
    found, plain = north("--vertical", f"{SWEEP}#up", "--pfa", 0.29), north("--pfa", 0.29)
    across, up = (read_channel(f"{SWEEP}#{name}").motion for name in ("north", "up"))
    factor = 0.29 * G / across.pfa
    one = follow_body(
        Body.rectangular(0.4, 1.8), across.acceleration * factor, across.time_step, vertical=up.acceleration * factor
    )
    assert found["max_rotation_ratio"] == pytest.approx(one.rotation, rel=1e-6)
    assert found["max_rotation_ratio"] != pytest.approx(plain["max_rotation_ratio"], rel=1e-3)
    assert found["vertical"]["pfa_g"] == pytest.approx(factor * up.pfa / G, rel=1e-12)
    assert found["vertical"]["without"] == {name: plain[name] for name in VERDICT}
    assert north("--vertical", SWEEP, "--pfa", 0.29) == found, "the only vertical channel of a file needs no name"
    both, alone = north("--vertical", SWEEP, "--wall", "--pfa", 0.29), north("--wall", "--pfa", 0.29)
    assert both["wall"]["negative_side"] != alone["wall"]["negative_side"]


def test_a_vertical_channel_with_another_time_step(tmp_path):
    """The same straight lines with three times as many points."""
    across, up = (read_channel(f"{SWEEP}#{name}").motion for name in ("north", "up"))
    size = 3 * (up.acceleration.size - 1) + 1
    fine = np.interp(np.arange(size) / 3, np.arange(up.acceleration.size), up.acceleration)
    lines = ["# corrected: yes", "time [s], up [m/s2]"]
    lines += [f"{at * up.time_step / 3:.9f}, {value:.17g}" for at, value in enumerate(fine)]
    (tmp_path / "fine.csv").write_text("\n".join(lines), encoding="utf-8")
    usual, found = north("--vertical", SWEEP), north("--vertical", tmp_path / "fine.csv")
    assert found["max_rotation_ratio"] == pytest.approx(usual["max_rotation_ratio"], rel=1e-6)
    assert across.time_step == up.time_step


@pytest.mark.slow
def test_the_figure_is_of_the_outcome(tmp_path):
    drawn = {}
    for name, flags in (("plain", ()), ("vertical", ("--vertical", SWEEP)), ("wall", ("--wall",))):
        assert rock("--pfa", 0.29, "--plot", tmp_path / f"{name}.svg", *flags, record=f"{SWEEP}#north").exit_code == 0
        drawn[name] = (tmp_path / f"{name}.svg").read_bytes()
    assert drawn["wall"] == drawn["plain"] != drawn["vertical"]
