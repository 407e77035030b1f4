"""Every target for some seconds, what it once found for ever; and the loop itself finds what is planted."""

import random
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import assess
from assess.units import read_unit
from tests.fuzz.engine import BrokenRuleError, Lines, find_fault, fuzz
from tests.fuzz.targets import CORPUS, TARGETS, list_corpus

SECONDS = {"workbooks": 6.0}
"""Processor time for which a target is fuzzed [s], where that is not `FEW`."""
FEW, MANY = 2.0, 10.0
MOST_REFUSED = 0.2
"""Share of the changed workbooks that may be of no use to an assessment."""


@pytest.mark.parametrize("name", TARGETS)
def test_seeds_and_what_was_found_before(name: str) -> None:
    target = TARGETS[name]
    kept = {path.name: path.read_bytes() for path in list_corpus(name)}
    seeds = {f"seed {number}": data for number, data in enumerate(target.seeds())}
    assert {one: fault.detail for one, data in (seeds | kept).items() if (fault := find_fault(target, data)[1])} == {}


def test_the_corpus_is_small_and_of_known_targets() -> None:
    assert {path.name for path in CORPUS.iterdir()} <= {*TARGETS, "README.md"}
    assert max((path.stat().st_size for name in TARGETS for path in list_corpus(name)), default=0) < 100_000


def check_for(name: str, seconds: float) -> None:
    """Fuzz a target for so many seconds, and assert that nothing was found."""
    summary = fuzz(TARGETS[name], seconds)
    print(summary.describe(name))
    assert {key: finding.detail for key, finding in summary.findings.items()} == {}
    assert summary.executions > len(TARGETS[name].seeds())
    if name == "workbooks":
        refused = sum(count for word, count in summary.outcomes.items() if not word.startswith("assessed"))
        assert refused < MOST_REFUSED * summary.executions
        assert summary.outcomes["assessed"] > summary.executions / 3


@pytest.mark.slow
@pytest.mark.parametrize("name", TARGETS)
def test_some_seconds(name: str) -> None:
    check_for(name, SECONDS.get(name, FEW))


@pytest.mark.long
@pytest.mark.parametrize("name", TARGETS)
def test_ten_seconds(name: str) -> None:
    check_for(name, MANY)


# ---------------------------------------------------------------- the loop


class Planted:
    """A target that fails in a known way for each of three bytes."""

    suffix, most_seconds, further = ".bin", 0.2, frozenset({"sound"})

    def seeds(self) -> Sequence[bytes]:
        return [b"sound"]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        return data + draw.choice([b"a", b"b", b"c", b"d"])

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        (folder / "x").write_bytes(data)
        if data.endswith(b"a"):
            read_unit(None)
        if data.endswith(b"b"):
            raise BrokenRuleError("a rule")
        while data.endswith(b"c"):
            pass
        return "sound"


@pytest.mark.slow
def test_planted_faults_are_found_once_each() -> None:
    summary = fuzz(Planted(), 2.0)
    assert len(summary.findings) == 3
    found = sorted(re.sub(r":\d*", "", key) for key in summary.findings)
    assert found == ["AttributeError at units.py", "BrokenRuleError a rule", "OverTimeError longer than 0.2 s"]
    assert min(len(one.data) for one in summary.findings.values()) == len(b"sounda")
    assert summary.outcomes["sound"] > 0
    assert "3 findings" in summary.describe("planted")


@pytest.mark.skipif(sys.version_info < (3, 12), reason="sys.monitoring is new in Python 3.12")
def test_new_lines_are_counted_once() -> None:
    with Lines() as lines:
        read_unit("m/s2")
        once = lines.count
        read_unit("m/s2")
        assert lines.count == once > 0


@pytest.mark.slow
def test_the_command(tmp_path: Path) -> None:
    root = Path(assess.__file__).parents[1]
    command = [sys.executable, "-m", "tests.fuzz", "models", "--seconds", "0.5", "--quick"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.match(r"models: [\d,]+ executions in \d s of processor time \(refused .*; 0 findings\n$", done.stdout)
