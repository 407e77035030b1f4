"""A process that is killed between any two operations on files never leaves files of two runs beside one list."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.delivery import killer
from tests.delivery.killer import FRESH, NEXT, OLD

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


@pytest.mark.parametrize("stride", STRIDES)
@pytest.mark.parametrize("way", ["twice", *(pytest.param(way, marks=pytest.mark.long) for way in ("list", "undo"))])
def test_readers_see_one_run_and_the_next_run_completes(tmp_path, way, stride):
    found, old, new = _run(way, tmp_path, stride), OLD | MINE, FRESH | MINE
    whole = [old, new, NEXT | MINE] if way == "twice" else [old, new]
    assert len(found) * stride > 100
    assert [one["before"] for one in found if one["before"] is not None and one["before"] not in whole] == []
    assert [one["after"] for one in found if one["after"] != NEXT | MINE] == []
    assert (found[0]["before"], found[-1]["before"]) == (old, {"list": new, "undo": old, "twice": NEXT | MINE}[way])


@pytest.mark.slow
def test_files_without_a_list_are_each_whole(tmp_path):
    found = _run("save", tmp_path, 1)
    assert {text for one in found for text in (one["before"] or {}).values()} == {"old", "new", "mine"}
    assert [one["after"] for one in found if one["after"] != NEXT | MINE | {"gone.pdf": "old"}] == []
