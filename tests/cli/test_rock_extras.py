"""`assess rock` with vertical motion, a wall and friction: documents, lines and errors, by hand from the library."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from assess.motion.formats import read_channel
from assess.rocking.planar import Body, follow_body
from assess.rocking.sliding import critical_friction, peak_slip
from assess.units import GRAVITY as G
from tests.cli.calling import error, run

SAMPLES = Path(__file__).parents[2] / "samples" / "records"
SWEEP, FLOOR, BASEMENT = SAMPLES / "made-up-sweep.csv", SAMPLES / "0165a_u.smc", SAMPLES / "1103.HNZ.NP.BE_a.smc"
VERDICT = {"overturned", "max_rotation_ratio", "impacts", "overturn_time_s"}


def rock(*flags, record=f"{SWEEP}#north", breadth=40):
    given = ["rock", "--breadth", str(breadth), "--height", "180", "--record", str(record), *map(str, flags)]
    return run(*given)


def document(*flags, **options):
    done = rock("--json", *flags, **options)
    assert (done.exit_code, done.stderr) == (0, "")
    return json.loads(done.stdout)


def test_without_options_nothing_is_added():
    plain = document()
    assert not {"wall", "vertical", "friction"} & set(plain)
    for flags, key in ((("--wall",), "wall"), (("--friction", 0.3), "friction")):
        found = document(*flags)
        assert {name: found[name] for name in plain} == plain, "the verdict is that of the free block without sliding"
        assert set(found) == {*plain, key}


def test_friction():
    found = document("--friction", 0.25, "--pfa", 0.5)["friction"]
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
    branches = [document("--friction", mu, "--pfa", 0.5)["friction"]["branch"] for mu in (0.2, 0.6)]
    assert branches == ["slide", "rock"]
    rests = document("--friction", 0.6, "--pfa", 0.1)["friction"]
    assert (rests["branch"], rests["critical_friction"], rests["peak_slip_cm"]) == ("rest", None, 0)


def test_a_wall_on_either_side():
    found = document("--wall")["wall"]
    body, motion = Body.rectangular(0.4, 1.8), read_channel(f"{SWEEP}#north").motion
    assert found["rebound"] == pytest.approx(float(body.rebound), rel=1e-12)
    for where, away in (("negative_side", 1), ("positive_side", -1)):
        one = follow_body(body, motion.acceleration, motion.time_step, away=away)
        assert set(found[where]) == VERDICT
        assert found[where]["overturned"] == one.overturned
        assert found[where]["max_rotation_ratio"] == pytest.approx(one.rotation, rel=1e-6)
    assert found["negative_side"]["max_rotation_ratio"] != found["positive_side"]["max_rotation_ratio"]


def test_vertical_motion():
    found, plain = document("--vertical", f"{SWEEP}#up", "--pfa", 0.29), document("--pfa", 0.29)
    across, up = (read_channel(f"{SWEEP}#{name}").motion for name in ("north", "up"))
    factor = 0.29 * G / across.pfa
    one = follow_body(
        Body.rectangular(0.4, 1.8), across.acceleration * factor, across.time_step, vertical=up.acceleration * factor
    )
    assert found["max_rotation_ratio"] == pytest.approx(one.rotation, rel=1e-6)
    assert found["max_rotation_ratio"] != pytest.approx(plain["max_rotation_ratio"], rel=1e-3)
    assert found["vertical"]["pfa_g"] == pytest.approx(factor * up.pfa / G, rel=1e-12)
    assert found["vertical"]["without"] == {name: plain[name] for name in VERDICT}
    assert document("--vertical", SWEEP, "--pfa", 0.29) == found, "the only vertical channel of a file needs no name"


def test_a_vertical_channel_with_another_time_step(tmp_path):
    """The same straight lines with three times as many points."""
    across, up = (read_channel(f"{SWEEP}#{name}").motion for name in ("north", "up"))
    size = 3 * (up.acceleration.size - 1) + 1
    fine = np.interp(np.arange(size) / 3, np.arange(up.acceleration.size), up.acceleration)
    lines = ["# corrected: yes", "time [s], up [m/s2]"]
    lines += [f"{at * up.time_step / 3:.9f}, {value:.17g}" for at, value in enumerate(fine)]
    (tmp_path / "fine.csv").write_text("\n".join(lines), encoding="utf-8")
    usual, found = document("--vertical", SWEEP), document("--vertical", tmp_path / "fine.csv")
    assert found["max_rotation_ratio"] == pytest.approx(usual["max_rotation_ratio"], rel=1e-6)
    assert across.time_step == up.time_step


def test_the_walls_verdicts_hold_the_vertical_motion():
    both, alone = document("--vertical", SWEEP, "--wall", "--pfa", 0.29), document("--wall", "--pfa", 0.29)
    assert both["wall"]["negative_side"] != alone["wall"]["negative_side"]


@pytest.mark.slow
def test_the_figure_is_of_the_outcome(tmp_path):
    drawn = {}
    for name, flags in (("plain", ()), ("vertical", ("--vertical", SWEEP)), ("wall", ("--wall",))):
        assert rock("--pfa", 0.29, "--plot", tmp_path / f"{name}.svg", *flags).exit_code == 0
        drawn[name] = (tmp_path / f"{name}.svg").read_bytes()
    assert drawn["wall"] == drawn["plain"] != drawn["vertical"]


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (("--friction", 0), "--friction is 0, expected 0.01 to 2"),
        (("--friction", -0.3), "--friction is -0.3, expected 0.01 to 2"),
        (("--friction", 2.01), "--friction is 2.01, expected 0.01 to 2"),
        (("--friction", "nan"), "--friction is nan, expected 0.01 to 2"),
        (("--friction", "much"), "Invalid value for '--friction'"),
        (("--vertical", f"{SWEEP}#east"), "--vertical: made-up-sweep.csv#east is a horizontal channel: choose the"),
        (("--vertical", FLOOR), "--vertical: 0165a_u.smc is a horizontal channel: choose the vertical one"),
        (("--vertical", f"{SWEEP}#west"), "made-up-sweep.csv has no channel 'west'"),
        (("--vertical", "none.csv"), "none.csv: there is no such file"),
        (("--vertical", BASEMENT), "horizontal one 12.00 s: give the vertical channel of the same recording"),
        (("--vertical", SWEEP, "--pfa", 4), "--vertical: the vertical acceleration is -1.33 g, expected above -1 g"),
    ],
)
def test_bad_input_is_named(flags, message):
    assert message in error(rock(*flags))


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (
            "north [g], east [g]",
            "--vertical: made.csv holds no vertical channel: it holds made.csv#north, made.csv#east",
        ),
        ("up [g], down [g]", "--vertical: made.csv holds 2 vertical channels: name one of made.csv#up, made.csv#down"),
    ],
)
def test_files_without_one_vertical_channel(tmp_path, columns, message):
    rows = [f"{at / 100}, {math.sin(at / 10):.4f}, {math.cos(at / 10):.4f}" for at in range(1201)]
    (tmp_path / "made.csv").write_text("\n".join([f"time [s], {columns}", *rows]), encoding="utf-8")
    assert message in error(rock("--vertical", tmp_path / "made.csv"))
