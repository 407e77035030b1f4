"""The long tests, and the quick ones on the oldest and newest dependencies and on other versions of Python.

``make test-long`` runs them and writes docs/tests.md, which holds the last result with its date. Not part of the gate:
an hour on two cores.
"""

import datetime
import importlib.util
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))
from docs.machine import describe_machine  # noqa: E402
from tests.other_pythons import find_pythons  # noqa: E402

PAGE = ROOT / "docs" / "tests.md"
BUILD = ROOT / "build"
QUICK = "not (slow or browser or libreoffice or verapdf or long or smoke)"
SEEDS = range(1, 6)
CLOSING = re.compile(r"(\d+ (?:passed|failed|error|skipped|xfailed).*) in [\d.]+s")
FUZZED = ("records", "xml", "workbooks", "models", "pictures", "ground")
FUZZ_SECONDS = 60
LISTED = ("numpy", "scipy", "numba", "openpyxl", "xlsxwriter", "weasyprint", "matplotlib", "shapely", "pandas", "typer")


def main() -> int:
    """Run everything, write the page, and return 0 if nothing failed."""
    os.environ.pop("ASSESS_SINCE", None)
    rows = [
        run("whole studies and pages", sys.executable, "-m", "long", "-n", "auto"),
        draw_others(),
        *fuzz(),
        run_with("the oldest dependencies", sys.executable, "lowest-direct"),
        *(run_with(f"Python {version}", python) for version, python in find_pythons().items()),
        run_with("the newest dependencies", sys.executable),
    ]
    PAGE.write_text("\n".join(describe(rows)) + "\n", encoding="utf-8")
    return int(any(re.search(r"\b(failed|errors?)\b", row[1]) for row in rows))


def describe(rows: list[tuple[str, str, str]]) -> Iterator[str]:
    """Yield the lines of the page."""
    yield "# The long tests: their last result"
    yield ""
    yield f"Written by `make test-long` on {datetime.datetime.now(datetime.UTC):%d %B %Y}. {describe_machine()}"
    yield ""
    yield "| what | result | minutes |"
    yield "|---|---|---|"
    yield from (f"| {' | '.join(row)} |" for row in rows)


def run(what: str, python: str | Path, *arguments: str) -> tuple[str, str, str]:
    """Run pytest and return a row of the page."""
    started = time.monotonic()
    command = [str(python), "-m", "pytest", "--dist", "loadfile", "-q", *arguments]
    print(f"== {what}", flush=True)
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    print(done.stdout)
    closing = CLOSING.findall(done.stdout)
    result = closing[-1] if closing else f"error: pytest ended with {done.returncode}"
    return what, result, f"{(time.monotonic() - started) / 60:.0f}"


def fuzz() -> Iterator[tuple[str, str, str]]:
    """Fuzz every target, as tests/fuzz does for ten seconds, and with libFuzzer too where atheris is installed."""
    engines = {"": (), " with atheris": ("--atheris",)}
    for engine, more in engines.items() if importlib.util.find_spec("atheris") else [("", ())]:
        for target in FUZZED:
            started = time.monotonic()
            print(f"== fuzzing {target}{engine}", flush=True)
            command = [sys.executable, "-m", "tests.fuzz", target, f"--seconds={FUZZ_SECONDS}", *more]
            done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
            print(done.stdout)
            closing = [line for line in done.stdout.splitlines() if line.startswith(f"{target}: ")]
            result = closing[-1].partition(": ")[2] if closing else f"error: it ended with {done.returncode}"
            is_sound = done.returncode == 0 or not closing
            yield (
                f"fuzzing {target}{engine}",
                result if is_sound else f"failed: {result}",
                f"{(time.monotonic() - started) / 60:.0f}",
            )


def draw_others() -> tuple[str, str, str]:
    """Run the tests that draw their input (files, workbooks, sizes) with other draws than the quick tests make."""
    started, failed, passed = time.monotonic(), 0, 0
    for seed in SEEDS:
        more = ("-m", "hypothesis and not long", "--hypothesis-profile", "random", f"--hypothesis-seed={seed}")
        _, result, _ = run(f"drawn input, seed {seed}", sys.executable, "-n", "auto", *more)
        counts = {word: int(number) for number, word in re.findall(r"(\d+) (passed|failed|error)", result)}
        passed, failed = passed + counts.get("passed", 0), failed + counts.get("failed", 0) + ("error" in result)
    result = f"{failed} failed, {passed} passed" if failed else f"{passed} passed"
    what = f"drawn input, {len(SEEDS)} seeds: at least {150 * len(SEEDS):,} damaged workbooks and files a target"
    return what, result, f"{(time.monotonic() - started) / 60:.0f}"


def run_with(what: str, base: str, resolution: str = "highest") -> tuple[str, str, str]:
    """Run the quick tests in an environment of its own, on an interpreter and the lowest or the newest dependencies."""
    folder = BUILD / f"venv-{what.replace(' ', '-')}"
    uv = [sys.executable, "-m", "uv"]
    python = folder / "bin" / "python"
    for command in (
        [*uv, "venv", "--quiet", "--clear", "--python", base, str(folder)],
        [*uv, "pip", "install", "--quiet", "--python", str(python), "--resolution", resolution, "-e", ".[dev]"],
    ):
        done = subprocess.run(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            print(done.stderr)
            return what, "error: the dependencies cannot be installed", "0"
    code = (
        f"from importlib.metadata import version\nprint(*(f'{{one}} {{version(one)}}' for one in {LISTED!r}), sep=', ')"
    )
    listed = subprocess.run([python, "-c", code], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    return run(f"quick tests on {what}: {listed}", python, "-m", QUICK, "-n", "auto")


if __name__ == "__main__":
    sys.exit(main())
