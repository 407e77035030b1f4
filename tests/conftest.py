"""Fixtures that several folders of tests share, and an environment that is the same on every machine."""

import gc
import os
import pickle
import shutil
import signal
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

import assess
from docs.screenshot import find_browser
from tests.alike import list_differences
from tests.waiting import PATIENCE
from tests.workbooks import UNVERIFIED

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "inventories" / "market-street.xlsx"
FOREIGN_VARIABLES = (
    "COLUMNS", "LINES", "TERMINAL_WIDTH", "FORCE_COLOR", "NO_COLOR", "PY_COLORS", "CLICOLOR_FORCE", "TTY_COMPATIBLE",
    "TTY_INTERACTIVE", "GITHUB_ACTIONS", "SOURCE_DATE_EPOCH",
)  # fmt: skip
"""Variables of a terminal or a build service that change what the command prints, or the date of a report."""

STAND_ALONE = ("studies", "bim", "portfolio", "web")
"""Packages that nothing of the core imports."""

settings.register_profile("same", derandomize=True, deadline=None)  # the same draws everywhere, on slow machines too
settings.register_profile("random", deadline=None, print_blob=True)  # other draws: `make test-long`
settings.load_profile("same")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take the commit since which changes count: tests of packages that stand alone run if they or the core changed."""
    parser.addoption("--since", metavar="COMMIT", default=os.environ.get("ASSESS_SINCE", ""))
    parser.addoption("--anew", action="store_true", help="write what outputs say where that differs from what is kept")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out the tests of packages of which nothing has changed, nor anything of the core."""
    return True if collection_path in _list_unchanged(config.getoption("--since")) else None


@cache
def _list_unchanged(since: str) -> frozenset[Path]:
    if not since:
        return frozenset()
    command = ["git", "diff", "--name-only", "--no-renames", since]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise pytest.UsageError(f"--since {since}: {done.stderr.strip()}")
    changed = [name.split("/") for name in done.stdout.splitlines()]
    packages = {name[1] if name[0] in ("assess", "tests") and len(name) > 2 else "" for name in changed}
    has_core = not packages <= {*STAND_ALONE}
    return frozenset(ROOT / "tests" / one for one in STAND_ALONE if not has_core and one not in packages)


def pytest_configure(config: pytest.Config) -> None:
    """Give commands that tests start what they would have in a plain terminal, and signals their usual effect.

    A shell makes what it starts in the background ignore SIGINT, nohup SIGHUP, and programs hand that down. They do not
    hand down a handler of their own, and this one keeps the tests running.
    """
    _list_unchanged(config.getoption("--since"))  # refuses a commit that is unknown
    for name in FOREIGN_VARIABLES:
        os.environ.pop(name, None)
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: None)


def pytest_collection_finish() -> None:
    """Leave what collecting made out of every later search for garbage."""
    gc.freeze()


@pytest.fixture
def differ(request):
    """Return how lines differ from those kept beside the test in shown/NAME.txt; with --anew they are written there."""

    def differ(name: str, now: list[str], by: Callable[..., list[str]] = list_differences) -> list[str]:
        path = request.path.parent / "shown" / f"{name}.txt"
        found = by(now, path.read_text(encoding="utf-8").splitlines() if path.exists() else [])
        if found and request.config.getoption("--anew"):
            path.write_text("".join(f"{line}\n" for line in now), encoding="utf-8")
            return []
        return found

    return differ


@pytest.fixture(scope="session")
def browser():
    """Start a browser without a window, one for all tests, which have contexts of their own in it."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=1e3 * PATIENCE)
    with sync_playwright() as playwright:
        shell = shutil.which("chromium-headless-shell")  # the same engine without windows: a page takes a third less
        browser = playwright.chromium.launch(executable_path=shell or find_browser())
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def make_once(tmp_path_factory):
    """Return what makes a thing in a folder of all workers, where no other worker has made it, and returns it."""
    fcntl = pytest.importorskip("fcntl")
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def make_once(name: str, make: Callable[[Path], Any]) -> Any:
        folder = shared / name
        folder.mkdir(exist_ok=True)
        with (folder / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (folder / "made.pickle").exists():
                made = pickle.dumps(make(folder))
                (folder / "made.pickle").write_bytes(made)
            return pickle.loads((folder / "made.pickle").read_bytes())

    return make_once


@pytest.fixture(scope="session")
def example_inventory():
    """Return the worked example as read."""
    return assess.read_inventory(EXAMPLE)


@pytest.fixture(scope="session")
def example(example_inventory):
    """Return the worked example assessed by the formulas."""
    return assess.run(example_inventory, UNVERIFIED)
