"""Code in a process of its own, held to an amount of memory."""

import subprocess
import sys
from pathlib import Path

_TELL_PEAK = """
try:
    with open("/proc/self/status") as status:
        print(next(line for line in status if line.startswith("VmHWM")).split()[1])
except FileNotFoundError:
    print(0)  # no Linux: the memory is not checked there
"""


def run_apart(code: str, path: Path, *, most_memory: float, seconds: float) -> str:
    """Run code that reads `sys.argv[1]`; return what it prints, having checked how much memory [MB] it took."""
    command = [sys.executable, "-c", code + _TELL_PEAK, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    text, _, peak = done.stdout.rstrip().rpartition("\n")
    assert int(peak) / 1024 < most_memory, f"{int(peak) // 1024} MB"
    return text
