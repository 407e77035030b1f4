"""The same targets under atheris (libFuzzer), where it is installed: it knows edges, where `engine` knows lines.

libFuzzer ends its process by itself: the loop runs in a child process, which hands over its counts in a file.
"""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.fuzz.engine import Finding, Summary, Target, find_fault
from tests.fuzz.havoc import LARGEST


def fuzz(
    target: Target,
    seconds: float,
    *,
    seed: int = 1,
    deep: bool = False,
    report: Callable[[Summary], None] | None = None,
) -> Summary:
    """Do what `engine.fuzz` does, without reports on the way."""
    del report
    from tests.fuzz.targets import TARGETS

    name = next(name for name, one in TARGETS.items() if one is target)
    with tempfile.TemporaryDirectory(prefix="fuzz-") as box:
        command = [
            sys.executable,
            "-m",
            "tests.fuzz.atheris_engine",
            name,
            str(seconds),
            str(seed),
            str(int(deep)),
            box,
        ]
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
        result = Path(box) / "summary.json"
        if not result.exists():
            raise RuntimeError(f"atheris did not end as it should:\n{done.stderr[-3000:]}")
        return _read(json.loads(result.read_text(encoding="utf-8")), done.stderr)


def _read(found: dict[str, Any], log: str) -> Summary:
    covered = [int(part.split()[1]) for part in log.replace("cov:", "\ncov: ").split("\n") if part.startswith("cov:")]
    summary = Summary(
        unit="edges",
        executions=found["executions"],
        seconds=found["seconds"],
        lines_of_seeds=covered[0] if covered else 0,
        lines=covered[-1] if covered else 0,
        outcomes=Counter(found["outcomes"]),
        slowest=found["slowest"],
    )
    for key, detail, data in found["findings"]:
        summary.findings[key] = Finding(key, detail, bytes.fromhex(data))
    return summary


# ---------------------------------------------------------------- the child


def _main(name: str, seconds: str, seed: str, deep: str, box: str) -> None:
    import atheris

    with atheris.instrument_imports(include=["assess"]):
        from tests.fuzz.targets import TARGETS

    target, folder = TARGETS[name], Path(box)
    summary, started = Summary(), time.process_time()
    pool = [*target.seeds()]
    corpus = folder / "corpus"
    corpus.mkdir()
    for number, data in enumerate(pool):
        (corpus / str(number)).write_bytes(data)

    def mutate(data: bytes, size: int, chosen: int) -> bytes:
        return target.mutate(random.Random(chosen), bytes(data) or pool[0], pool)[:size]

    def test_one(data: bytes) -> None:
        before = time.process_time()
        outcome, finding = find_fault(target, data, deep=deep == "1")
        after = time.process_time()
        summary.executions += 1
        summary.outcomes[outcome] += 1
        summary.slowest, summary.seconds = max(summary.slowest, after - before), after - started
        if finding is not None:
            summary.findings.setdefault(finding.key, finding)
        if summary.seconds >= float(seconds):
            _hand_over(summary, folder)
            os.kill(os.getpid(), signal.SIGTERM)

    options = [f"-seed={seed}", f"-max_len={LARGEST}", "-rss_limit_mb=4096", "-timeout=600", "-print_final_stats=1"]
    atheris.Setup([sys.argv[0], *options, str(corpus)], test_one, custom_mutator=mutate)
    atheris.Fuzz()


def _hand_over(summary: Summary, folder: Path) -> None:
    found = {
        "executions": summary.executions,
        "seconds": summary.seconds,
        "outcomes": summary.outcomes,
        "slowest": summary.slowest,
        "findings": [(one.key, one.detail, one.data.hex()) for one in summary.findings.values()],
    }
    (folder / "summary.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    _main(*sys.argv[1:])
