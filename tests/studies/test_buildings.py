"""Direct integration under the motions of channels: what it is, how it is loaded, and what changes nothing."""

import io
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assess.motion.formats import read_records
from assess.motion.generate import build_generator
from assess.motion.target import build_grid, recorded_target
from assess.rocking.draws import draw_bodies, draw_earthquakes
from assess.rocking.ensemble import rock_blocks
from assess.studies.buildings import Trials, all_buildings, build_blocks, find_levels, rock_building
from assess.studies.study import PARTS, Options, load_or_compute
from assess.units import GRAVITY

LEVELS = (0.3, 0.6)
ROOF = ("HN2.NP.RS", "HN3.NP.RS")


@pytest.fixture(scope="module")
def buildings():
    return all_buildings()


def options(folder, **more):
    return Options(**{"out": folder, "runs": 4, "seed": 3, **more})


def rock(building, given):
    return rock_building(building, dict.fromkeys(building.channels, LEVELS), given)


def look(folder: Path) -> dict[Path, int]:
    """When each part that is kept was written."""
    return {file: file.stat().st_mtime_ns for file in (folder / PARTS).glob("*.npz")}


def assert_same(one: Trials, other: Trials) -> None:
    """To the bit."""
    assert one.channel == other.channel
    for name in ("pfa", "pfv", "breadth", "height", "fallen", "fallen_uncertain", "fell_in_record"):
        ours, theirs = getattr(one, name), getattr(other, name)
        assert ours.dtype == theirs.dtype
        assert ours.tobytes() == theirs.tobytes()
    assert (one.runs, one.mean_pfa, one.mean_pfv) == (other.runs, other.mean_pfa, other.mean_pfv)


@pytest.fixture(scope="module")
def kept(buildings, tmp_path_factory):
    """A run of one channel that was not ended, and its folder."""
    folder = tmp_path_factory.mktemp("kept")
    (trials,) = rock(buildings[2], options(folder))
    return folder, trials


@pytest.fixture
def copied(kept, tmp_path):
    """The same in a folder of its own, and its part."""
    shutil.copytree(kept[0], tmp_path, dirs_exist_ok=True)
    (part,) = (tmp_path / PARTS).iterdir()
    return tmp_path, part


# ---------------------------------------------------------------- the buildings


def test_every_record_comes_along(buildings):
    assert [len(one.channels) for one in buildings] == [9, 11, 1]
    assert [tuple(dict.fromkeys(channel.level for channel in one.channels)) for one in buildings] == [
        ("ground", "25th floor", "34th floor", "42nd floor"), ("basement", "4th floor", "roof"), ("12th floor",)
    ]  # fmt: skip


@pytest.mark.slow
def test_channels_hang_along_the_axes_that_their_files_say(buildings):
    for building in buildings:
        azimuths = {
            axis: [read_records(one.file)[0].azimuth_deg for one in building.channels if one.axis == axis]
            for axis in "XY"
        }
        lines = {axis: {round(angle) % 180 for angle in own if angle is not None} for axis, own in azimuths.items()}
        assert all(len(own) <= 1 for own in lines.values())
        if lines["X"] and lines["Y"]:
            assert abs(abs(lines["X"].pop() - lines["Y"].pop()) - 90) <= 1


@pytest.mark.slow
def test_channels_of_a_floor_are_moved_by_one_factor(buildings):
    for building in buildings:
        levels = find_levels(building)
        for channel in building.channels:
            own = [one for one in building.channels if one.level == channel.level]
            factors = {round(levels[one][-1] * GRAVITY / one.read().pfa, 9) for one in own}
            assert len(factors) == 1
            assert max(levels[one][-1] for one in own) == pytest.approx(0.7)
    assert np.ptp([levels[one][0] for one in building.channels]) == 0


# ---------------------------------------------------------------- what is found


def test_the_risk_is_that_of_the_blocks_under_the_scaled_motions(buildings, kept):
    """One block of one channel, done by hand."""
    building, (_, found) = buildings[2], kept
    motion = building.channels[0].read()
    grid = build_grid([motion])
    made = build_generator(recorded_target(motion, grid), grid, seed=3, axis="X").realise(0, 4)
    breadth, height = build_blocks()
    at = 40
    for level, pfa in enumerate(LEVELS):
        sizes, scale = (breadth[at], height[at]), pfa * GRAVITY / motion.pfa
        alone = rock_blocks(*sizes, scale * made, grid.time_step)
        assert found.fallen[level, at] == alone.overturned.sum()
        record = rock_blocks(*sizes, scale * motion.acceleration[None], motion.time_step)
        assert found.fell_in_record[level, at] == record.overturned[0, 0]
        own = [np.array([size]) for size in (*sizes, 0.5, np.nan)]
        drawn = draw_bodies(own[0], own[1], own[2], own[3], [at], seed=3, first=0, count=4)
        alone = rock_blocks(
            drawn.breadth, drawn.height, scale * made, grid.time_step,
            restitution=drawn.restitution, centre=drawn.centre, scale=np.exp(0.4 * draw_earthquakes(3, 0, 4))[None],
        )  # fmt: skip
        assert found.fallen_uncertain[level, at] == alone.overturned.sum()
    assert found.pfa == pytest.approx(np.array(LEVELS) * GRAVITY)
    assert found.pfv[1] / found.pfa[1] == pytest.approx(motion.pfv / motion.pfa)
    assert found.mean_pfa == pytest.approx(np.abs(made).max(axis=1).mean() / motion.pfa)
    assert 0.5 < found.mean_pfv < 2
    assert 0 < found.risk.mean() < 1
    assert (found.fallen_uncertain != found.fallen).any()
    assert found.fell_in_record.any()
    assert not found.fell_in_record.all()
    assert found.cases.breadth.reshape(found.risk.shape)[1] == pytest.approx(found.breadth)
    assert found.cases.pfa.reshape(found.risk.shape)[:, 7] == pytest.approx(found.pfa)


@pytest.mark.slow
def test_threads_and_a_part_that_was_cut_off_change_nothing(buildings, kept, copied):
    folder, part = copied
    part.write_bytes(DAMAGES["cut"](part))
    (two,) = rock(buildings[2], options(folder, jobs=2))
    assert_same(two, kept[1])
    with np.load(part) as again_kept:
        assert (again_kept["fallen"] == two.fallen).all()


# ---------------------------------------------------------------- what is loaded


def test_a_part_is_loaded(buildings, kept, copied):
    folder, _ = copied
    before = look(folder)
    (again,) = rock(buildings[2], options(folder, jobs=2))
    assert_same(again, kept[1])
    assert look(folder) == before


def _make_other_part(part: Path) -> bytes:
    load_or_compute(part.parent, "another", lambda: {"numbers": np.zeros(3)})
    (other,) = (one for one in part.parent.iterdir() if one != part)
    data = other.read_bytes()
    other.unlink()
    return data


def _pack(save, *arrays, **named) -> bytes:
    packed = io.BytesIO()
    save(packed, *arrays, **named)
    return packed.getvalue()


DAMAGES: dict[str, Callable[[Path], bytes]] = {
    "cut": lambda part: part.read_bytes()[:-50],
    "begun": lambda part: part.read_bytes()[:50],
    "empty": lambda _: b"",
    "a byte turned": lambda part: (data := part.read_bytes())[:400] + bytes([data[400] ^ 0xFF]) + data[401:],
    "a text": lambda _: b"mine",
    "other arrays": lambda _: _pack(np.savez, numbers=np.zeros(3)),
    "one array": lambda _: _pack(np.save, np.zeros(3)),
    "another part": _make_other_part,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_part_that_is_not_whole_or_not_ours_is_made_again(tmp_path, damage):
    def make():
        made.append(1)
        return {"numbers": np.arange(1000.0)}

    made: list[int] = []
    for _ in range(2):
        load_or_compute(tmp_path, "one", make)
    assert len(made) == 1
    (part,) = tmp_path.iterdir()
    part.write_bytes(DAMAGES[damage](part))
    for _ in range(2):
        assert load_or_compute(tmp_path, "one", make)["numbers"].tobytes() == np.arange(1000.0).tobytes()
    assert len(made) == 2
    assert list(tmp_path.iterdir()) == [part]


@pytest.mark.slow
def test_another_seed_number_of_motions_record_or_code_is_not_loaded(
    buildings, kept, copied, tmp_path_factory, monkeypatch
):
    """A part is that of what a file holds, not of the name or the place of the file."""
    folder, part = copied
    for at, more in enumerate(({"seed": 4}, {"runs": 5})):
        (other,) = rock(buildings[2], replace(options(folder), **more))
        assert len(look(folder)) == 2 + at
        assert (other.fallen != kept[1].fallen).any()
        assert (other.fell_in_record == kept[1].fell_in_record).all()
        assert part.is_file()
    (channel,) = buildings[2].channels
    moved = tmp_path_factory.mktemp("records") / "moved.smc"
    text = channel.file.read_bytes()
    moved.write_bytes(text)
    before = look(folder)
    rock(replace(buildings[2], channels=(replace(channel, file=moved),)), options(folder))
    assert look(folder) == before
    edited = moved.with_name("edited.smc")
    edited.write_bytes(_weaken(text))
    (other,) = rock(replace(buildings[2], channels=(replace(channel, file=edited),)), options(folder))
    assert len(look(folder)) == 4
    assert other.pfv[0] != kept[1].pfv[0]
    monkeypatch.setattr("assess.studies.study._state", lambda: ("another version",))
    rock(buildings[2], options(folder))
    assert len(look(folder)) == 5


def _weaken(text: bytes) -> bytes:
    """Change one digit of a sample near the end of a record."""
    at = next(one for one in range(len(text) - 2000, len(text)) if text[one : one + 1] in b"12345678")
    return text[:at] + bytes([text[at] + 1]) + text[at + 1 :]


# ---------------------------------------------------------------- a run that is killed

RUN = """
import sys
from pathlib import Path
from assess.studies.buildings import all_buildings, rock_building
from assess.studies.study import Options
from dataclasses import replace

names = sys.argv[2].split(",")
one = all_buildings()[1]
one = replace(one, channels=tuple(channel for channel in one.channels if channel.name in names))
rock_building(one, dict.fromkeys(one.channels, (0.3, 0.6)), Options(out=Path(sys.argv[1]), runs=2, seed=3))
"""


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL to send")
@pytest.mark.slow
def test_a_run_that_was_killed_goes_on_where_it_was(buildings, tmp_path):
    """Killed as soon as its first part is there: that part is left as it is, and the numbers are as of one run."""
    folder = tmp_path / "killed"
    building = replace(buildings[1], channels=tuple(one for one in buildings[1].channels if one.name in ROOF))
    run = subprocess.Popen([sys.executable, "-c", RUN, str(folder), ",".join(ROOF)])
    deadline = time.monotonic() + 60
    while not list((folder / PARTS).glob("*.npz")) and run.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    run.kill()
    assert run.wait() == -signal.SIGKILL, "it had ended before it was killed"
    before = look(folder)
    assert 0 < len(before) < len(ROOF)
    few = options(folder, runs=2)
    again = rock(building, few)
    after = look(folder)
    assert {file: after[file] for file in before} == before
    assert len(after) == len(ROOF)
    for one, other in zip(again, rock(building, replace(few, out=tmp_path / "never ended")), strict=True):
        assert_same(one, other)
