"""Processes that die, wait or lose their parent: no building is lost, none harms another."""

import os
import shutil
import signal
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from assess.errors import AssessError, CancelledError, OutputError
from assess.motion.shakemap import read_shakemap
from assess.portfolio.building_task import Task
from assess.portfolio.local_pool import run_local
from assess.portfolio.sources import find_sources
from assess.progress import Progress
from assess.resources import city_file
from assess.settings import Settings
from tests.portfolio.staged import HOLDS, StagedGround, write_city
from tests.waiting import wait_until

pytestmark = [pytest.mark.skipif(os.name == "nt", reason="signals of POSIX"), pytest.mark.slow]
SETTINGS = Settings(verify="none", city=True)


def _list_tasks(tmp_path, latitudes):
    city = write_city(tmp_path / "city", latitudes)
    ground = StagedGround(tmp_path)
    return [Task(source=one, settings=SETTINGS, ground=ground, out=tmp_path / "out") for one in find_sources(city)]


def _is_alive(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{number}/stat").read_text().split()[2] != "Z" if Path("/proc/self").exists() else True


def test_a_cancel_ends_the_processes_at_once(tmp_path):
    (tmp_path / "hold").touch()
    tasks, cancel = _list_tasks(tmp_path, [HOLDS, HOLDS]), threading.Event()

    def stop():
        wait_until(lambda: len(list(tmp_path.glob("held-*"))) == 2)
        cancel.set()

    watch = threading.Thread(target=stop)
    watch.start()
    with pytest.raises(CancelledError):
        list(run_local(tasks, 2, Progress(None, cancel)))
    watch.join()
    numbers = [int(path.name.partition("-")[2]) for path in tmp_path.glob("held-*")]
    assert len(numbers) == 2
    assert not any(map(_is_alive, numbers))


def test_processes_end_when_the_one_that_started_them_is_killed(tmp_path):
    (tmp_path / "hold").touch()
    write_city(tmp_path / "city", [HOLDS])
    code = (
        "from pathlib import Path\nfrom tests.portfolio import test_local_pool as t\n"
        f"from assess.portfolio.sources import find_sources\np = Path({str(tmp_path)!r})\n"
        "tasks = [t.Task(source=one, settings=t.SETTINGS, ground=t.StagedGround(p), out=p / 'out')\n"
        "         for one in find_sources(p / 'city')]\nlist(t.run_local(tasks, 1))"
    )
    root = Path(__file__).parents[2]
    with subprocess.Popen([sys.executable, "-c", code], cwd=root) as parent:
        held = wait_until(lambda: list(tmp_path.glob("held-*")))
        parent.send_signal(signal.SIGKILL)
    number = int(held[0].name.partition("-")[2])
    wait_until(lambda: not _is_alive(number))


def test_processes_that_cannot_start_end_the_run_with_the_reason(tmp_path, monkeypatch):
    tasks = _list_tasks(tmp_path, [40.0])
    monkeypatch.setattr(sys, "executable", shutil.which("false"))
    with pytest.raises(OutputError, match=r"processes end as soon as they are started \(exit status 1\)"):
        list(run_local(tasks, 1))


def test_a_ground_motion_that_was_changed_since_ends_the_run_with_its_reason(tmp_path):
    grid = tmp_path / "grid.xml"
    grid.write_bytes(city_file("grid.xml").read_bytes())
    ground = read_shakemap(grid)
    grid.write_bytes(city_file("grid.xml").read_bytes() + b"\n")
    tasks = [replace(one, ground=ground) for one in _list_tasks(tmp_path, [40.0])]
    with pytest.raises(AssessError, match=r"grid\.xml.* changed"):
        list(run_local(tasks, 1))
