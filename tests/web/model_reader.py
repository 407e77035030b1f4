"""The process in which a server reads a building model: found, and held as long as a test wants it to take."""

import os
import signal
from pathlib import Path

import pytest

from tests.waiting import wait_until

linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="processes are found in /proc")


def find_reader(server):
    """Return the process of a server that reads a model, 0 where there is none."""
    pid = server.process.pid
    children = "".join(path.read_text() for path in Path(f"/proc/{pid}/task").glob("*/children")).split()
    return next((int(child) for child in children if _is_reader(child)), 0)


def _is_reader(pid):
    try:
        return b"assess.bim.model_worker" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def hold_reader(server):
    """Have the process stand still once it has begun; return its number. SIGCONT has it go on, SIGKILL ends it."""
    pid = wait_until(lambda: find_reader(server), bool)
    os.kill(pid, signal.SIGSTOP)
    return pid


def is_gone(pid):
    """Whether a process has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().split(")")[1].split()[0] == "Z"
    except FileNotFoundError:
        return True
