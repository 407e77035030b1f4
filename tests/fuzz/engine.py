"""A fuzzing loop: inputs are changed at random, and those that reach new lines of the package are changed further.

Which lines are reached is known from `sys.monitoring` (Python 3.12 and later), which costs nothing for a line that was
reached before; on 3.11 inputs are chosen blindly. Where `atheris` is installed, libFuzzer can choose instead:
atheris_engine.py.
"""

import random
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType
from typing import Protocol

import assess

PACKAGE = str(Path(assess.__file__).parent)
MOST_GROWTH = 400_000
"""kB by which one input may raise the memory of the process at its peak."""
TOOL = 4
"""Number of this tool in `sys.monitoring`."""


class BrokenRuleError(Exception):
    """What came out of an input breaks a rule that holds for every input."""


class OverTimeError(BaseException):
    """An input took longer than any may; no code under test catches this."""


class Target(Protocol):
    """What is fuzzed.

    `seeds` are sound inputs, `suffix` that of their files, `most_seconds` the processor time that one input may take;
    inputs that got as far as one of `further` are changed further.
    """

    suffix: str
    most_seconds: float
    further: frozenset[str]

    def seeds(self) -> Sequence[bytes]:
        """Return the first inputs."""
        ...

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Return a changed input; `pool` are others, of which parts may be taken."""
        ...

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Give an input to the package and check what comes out; return how far it got, in a word.

        `deep` allows what takes seconds. Raises BrokenRuleError, or whatever the package should not raise.
        """
        ...


@dataclass(frozen=True, slots=True)
class Finding:
    """An input that broke a rule: which place and kind (findings of one place are listed once), and the traceback."""

    key: str
    detail: str
    data: bytes


@dataclass(slots=True)
class Summary:
    """What a run of the loop did; `seconds` of the processor, `lines` of the package (or what else `unit` names)."""

    executions: int = 0
    seconds: float = 0.0
    lines_of_seeds: int = 0
    lines: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    findings: dict[str, Finding] = field(default_factory=dict)
    slowest: float = 0.0
    unit: str = "lines"

    def describe(self, name: str) -> str:
        """Return the summary as a line, and a line for each finding."""
        shares = ", ".join(f"{word} {count:,}" for word, count in self.outcomes.most_common())
        lines = f"{self.lines:,} {self.unit} of the package, {self.lines_of_seeds:,} of them by the seeds"
        head = (
            f"{name}: {self.executions:,} executions in {self.seconds:.0f} s of processor time ({shares}); {lines}; "
            f"slowest {self.slowest:.1f} s; {len(self.findings)} findings"
        )
        return "\n".join([head, *(f"  {one}" for one in self.findings)])


# ---------------------------------------------------------------- one input


def run_one(target: Target, data: bytes, *, deep: bool = False) -> str:
    """Give an input to its target in an empty folder, bounded in time and memory; return how far it got."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with tempfile.TemporaryDirectory(prefix="fuzz-") as box, _limited(target.most_seconds * (10 if deep else 1)):
        outcome = target.check(data, Path(box), deep=deep)
    growth = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    if growth > MOST_GROWTH:
        raise BrokenRuleError(f"memory grew by {growth // 1024} MB")
    return outcome


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """Raise OverTimeError after so much time of the processor."""

    def stop(*_: object) -> None:
        raise OverTimeError(f"longer than {seconds:g} s")

    old = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, old)


def find_fault(target: Target, data: bytes, *, deep: bool = False) -> tuple[str, Finding | None]:
    """Return how far an input got, and what rule it broke, if any."""
    try:
        return run_one(target, data, deep=deep), None
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:
        return "broken", Finding(_name(error), "".join(traceback.format_exception(error)), data)


def _name(error: BaseException) -> str:
    """Return kind and place of an error: the last line of the package, or the rule."""
    frames = [one for one in traceback.extract_tb(error.__traceback__) if one.filename.startswith(PACKAGE)]
    place = f" at {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""
    text = str(error).splitlines()[0][:160] if str(error) else ""
    return (
        f"{type(error).__name__}{place}: {text}"
        if isinstance(error, BrokenRuleError) or not place
        else (f"{type(error).__name__}{place}")
    )


# ---------------------------------------------------------------- the lines reached


class Lines:
    """Counts the lines of the package that were reached; each is reported once."""

    def __init__(self) -> None:
        self.count = 0
        self._not_again: object = None

    def __enter__(self) -> "Lines":
        if sys.version_info >= (3, 12):
            monitoring = sys.monitoring
            self._not_again = monitoring.DISABLE
            monitoring.use_tool_id(TOOL, "fuzz")
            monitoring.register_callback(TOOL, monitoring.events.LINE, self._note)
            monitoring.set_events(TOOL, monitoring.events.LINE)
            monitoring.restart_events()
        return self

    def __exit__(self, *_: object) -> None:
        if sys.version_info >= (3, 12):
            sys.monitoring.set_events(TOOL, 0)
            sys.monitoring.register_callback(TOOL, sys.monitoring.events.LINE, None)
            sys.monitoring.free_tool_id(TOOL)

    def _note(self, code: CodeType, line: int) -> object:
        self.count += code.co_filename.startswith(PACKAGE)
        return self._not_again


# ---------------------------------------------------------------- the loop


def fuzz(
    target: Target,
    seconds: float,
    *,
    seed: int = 1,
    deep: bool = False,
    report: Callable[[Summary], None] | None = None,
) -> Summary:
    """Change and run inputs for so much time of the processor, one at least; `report` is called about every minute.

    Seeds come first, and take of that time.
    """
    draw, summary, pool, told = random.Random(seed), Summary(), list[bytes](), 0.0
    started = time.process_time()
    with Lines() as lines:
        for data in target.seeds():
            _count(summary, target, data, started, deep=deep)
            pool.append(data)
        summary.lines_of_seeds = summary.lines = lines.count
        seeds = summary.executions
        while summary.seconds < seconds or summary.executions == seeds:
            data = target.mutate(draw, _choose(draw, pool), pool)
            outcome = _count(summary, target, data, started, deep=deep)
            if lines.count > summary.lines and outcome in target.further:
                pool.append(data)
            summary.lines = lines.count
            if report and summary.seconds - told > 60:
                told = summary.seconds
                report(summary)
    return summary


def _choose(draw: random.Random, pool: Sequence[bytes]) -> bytes:
    """Return an input, half the time one of the latest: their neighbours are the least explored."""
    return draw.choice(pool[-10:] if draw.random() < 0.5 else pool)


def _count(summary: Summary, target: Target, data: bytes, started: float, *, deep: bool) -> str:
    before = time.process_time()
    outcome, finding = find_fault(target, data, deep=deep)
    after = time.process_time()
    summary.executions += 1
    summary.outcomes[outcome] += 1
    summary.slowest, summary.seconds = max(summary.slowest, after - before), after - started
    if finding is not None:
        kept = summary.findings.get(finding.key)
        if kept is None or len(finding.data) < len(kept.data):
            summary.findings[finding.key] = finding
    return outcome
