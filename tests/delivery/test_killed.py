"""A process that is killed between any two operations on files leaves all old or all new files."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.delivery import killer
from tests.delivery.killer import FRESH, OLD

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
MINE = {"mine.txt": "mine"}
STRIDES = [29, pytest.param(1, marks=pytest.mark.slow)]
"""Every 29th moment, and every moment."""


def _run(way, folder, stride):
    """What was found after a kill at each moment; the last run came through."""
    root = Path(killer.__file__).parents[2]
    done = subprocess.run(
        [sys.executable, killer.__file__, way, str(folder), str(stride)],
        env=os.environ | {"PYTHONPATH": str(root)}, capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout)
    assert [one["left"] for one in found if one["left"]] == []
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="not every file system of macOS can exchange folders")
@pytest.mark.parametrize("stride", STRIDES)
def test_a_folder_of_reports_alone_is_of_one_run_at_every_moment(tmp_path, stride):
    """Without any recovery: whoever looks sees one run."""
    found = _run("exchange", tmp_path, stride)
    assert len(found) * stride > 200
    assert [one["before"] for one in found if one["before"] not in (OLD, FRESH)] == []
    assert not any(one["journal"] for one in found)
    assert (found[0]["before"], found[-1]["before"]) == (OLD, FRESH)


@pytest.mark.parametrize("stride", STRIDES)
@pytest.mark.parametrize(("way", "kept"), [("journal", {}), ("undo", {}), ("save", {"gone.pdf": "old"})])
def test_beside_other_files_the_next_run_finishes_or_takes_back(tmp_path, way, kept, stride):
    """Files of two runs are seen only next to a journal; after it was carried out all are old, or all new."""
    found, old, new = _run(way, tmp_path, stride), OLD | MINE, FRESH | MINE | kept
    assert len(found) * stride > 200
    assert [one["after"] for one in found if one["after"] not in (old, new)] == []
    assert [one["before"] for one in found if one["before"] not in (old, new) and not one["journal"]] == []
    assert (found[0]["after"], found[-1]["before"]) == (old, old if way == "undo" else new)


@pytest.mark.slow
def test_a_recovery_that_is_killed_goes_on_the_next_time(tmp_path):
    found, new = _run("recovery", tmp_path, 3), FRESH | MINE
    assert len(found) > 10
    assert [one["after"] for one in found if one["after"] != new] == []
    assert sum(one["before"] not in (OLD | MINE, new) for one in found) > 1
