"""Building models, and the processes in which a server reads them or simulates: found, and held for a test."""

import os
import signal
from pathlib import Path

import pytest

from tests.bim.ifc_files import one_room
from tests.waiting import wait_until

linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="processes are found in /proc")


def write_house(path):
    """Write a small model: a room on one floor with two cabinets, and a shelf above them that is skipped."""
    model, _, room = one_room()
    for name, x, bottom in (("Cabinet", 1, 0), ("Cabinet", 3, 0), ("Shelf", 5, 1.4)):
        model.piece(name, (x, 1, bottom, 0.8, 0.4, 1.6), within=room)
    return model.write(path)


def find_worker(server, name):
    """Return the process of a server, or of its sessions, that runs a module, 0 where there is none."""
    return next((child for child in list_children(server.pid) if _runs(child, name)), 0)


def list_children(pid):
    """Yield the processes that a process has started, and those that they have."""
    for child in "".join(path.read_text() for path in Path(f"/proc/{pid}/task").glob("*/children")).split():
        yield int(child)
        yield from list_children(child)


def _runs(pid, name):
    try:
        return name in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def hold_reader(server):
    """Have the process stand still once it has begun; return its number. SIGCONT has it go on, SIGKILL ends it."""
    pid = wait_until(lambda: find_worker(server, b"assess.bim.model_process"))
    os.kill(pid, signal.SIGSTOP)
    return pid


def is_gone(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().split(")")[1].split()[0] == "Z"
    except FileNotFoundError:
        return True
