"""``python -m tests.fuzz TARGET --seconds N``: fuzz a target for so much time of the processor.

Inputs that broke a rule are kept in build/fuzz/TARGET, each with its traceback. The exit status is 1 if there are any.
With ``--atheris``, libFuzzer chooses the inputs where atheris is installed.
"""

import argparse
import hashlib
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

from tests.fuzz.engine import Summary, fuzz
from tests.fuzz.targets import TARGETS

KEPT = Path(__file__).parents[2] / "build" / "fuzz"


def keep_findings(name: str, summary: Summary) -> None:
    """Write what broke a rule."""
    folder = KEPT / name
    folder.mkdir(parents=True, exist_ok=True)
    for finding in summary.findings.values():
        stem = hashlib.sha256(finding.key.encode()).hexdigest()[:12]
        (folder / f"{stem}{TARGETS[name].suffix}").write_bytes(finding.data)
        (folder / f"{stem}.txt").write_text(f"{finding.key}\n\n{finding.detail}", encoding="utf-8", errors="replace")


def main() -> int:
    """Fuzz, and print what was done."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz")
    parser.add_argument("target", choices=sorted(TARGETS))
    parser.add_argument("--seconds", type=float, default=60.0, help="time of the processor")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="leave out what takes seconds, such as simulations")
    parser.add_argument("--atheris", action="store_true", help="have libFuzzer choose the inputs")
    given = parser.parse_args()
    if given.atheris:
        from tests.fuzz.atheris_engine import fuzz as run
    else:
        run = fuzz

    def report(summary: Summary) -> None:
        keep_findings(given.target, summary)
        print(summary.describe(given.target), flush=True)

    summary = run(TARGETS[given.target], given.seconds, seed=given.seed, deep=not given.quick, report=report)
    report(summary)
    return int(bool(summary.findings))


if __name__ == "__main__":
    sys.exit(main())
