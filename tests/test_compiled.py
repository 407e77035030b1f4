"""Compiled code is kept in the user's cache folder, or where NUMBA_CACHE_DIR says; results hardly depend on it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import assess
from assess.compiled import cache_folder
from tests.shaking import write_records
from tests.workbooks import write

PACKAGE = Path(assess.__file__).parent


def _child(code, **changes):
    """Run `code` in a process of its own; a variable that is None is left out of its environment."""
    given = {"NUMBA_CACHE_DIR": None, "XDG_CACHE_HOME": None} | changes
    where = {name: value for name, value in os.environ.items() if name not in given}
    where |= {name: str(value) for name, value in given.items() if value is not None}
    done = subprocess.run(
        [sys.executable, "-c", code], env=where, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def _kept(folder):
    return sorted(path.name for path in folder.rglob("*.nbi"))


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="other systems have other folders")
@pytest.mark.slow
def test_it_is_kept_in_the_users_folder(tmp_path):
    """Only this package's functions are kept there, not those that a notebook compiles afterwards."""
    before = _kept(PACKAGE)
    code = (
        "import numpy as np\nfrom numba import config\nbefore = config.CACHE_DIR\n"
        "from assess.motion.recipe import bend_rows\nbend_rows(np.ones((1, 10), np.float32), 1.0, 0.1)\n"
        "assert config.CACHE_DIR == before"
    )
    _child(code, XDG_CACHE_HOME=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["assess"]
    assert [name for name in _kept(tmp_path / "assess") if name.startswith("bend_rows-") or ".bend_rows-" in name]
    assert _kept(PACKAGE) == before, "nothing beside the code, which may be read-only or shared"


def test_each_system_has_its_folder(monkeypatch):
    for system, variables, folder in (
        ("linux", {"XDG_CACHE_HOME": "/caches"}, "/caches/assess"),
        ("linux", {"XDG_CACHE_HOME": ""}, "{home}/.cache/assess"),
        ("darwin", {"XDG_CACHE_HOME": "/caches"}, "{home}/Library/Caches/assess"),
        ("win32", {"LOCALAPPDATA": "/local"}, "/local/assess/cache"),
        ("win32", {"LOCALAPPDATA": ""}, "{home}/AppData/Local/assess/cache"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(sys, "platform", system)
            for name, value in variables.items():
                patch.setenv(name, value)
            assert cache_folder() == Path(folder.format(home=Path.home()))


# --- another processor ---

ITEMS = [
    {"item": f"{floor} {breadth}", "floor": floor, "axis": "X", "breadth": breadth, "height": 180}
    for floor in ("1", "2")
    for breadth in range(24, 64, 4)
]
FLOORS = [{"floor": "1", "record_x": "slow.csv"}, {"floor": "2", "pfa_x": 0.3, "pfv_x": 30.0}]
MOST_APART = 0.06
"""Largest difference of a risk on another kind of processor [-], below the half width of its interval at 200 motions,
0.07: in single precision a wavelet may be put at another of two peaks that are nearly equal, and rounds follow from
it."""


@pytest.mark.long
def test_a_processor_without_wide_vectors_gives_the_same_risks(tmp_path):
    """All is compiled anew for it, and summed in another order."""
    write_records(tmp_path, "slow")
    path = write(tmp_path / "w.xlsx", ITEMS, FLOORS)
    risks = []
    for name, changes in (("native", {}), ("generic", {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""})):
        out = tmp_path / name
        words = ["assess", "run", str(path), "--verify", "all", "--formats", "json", "--out", str(out)]
        code = f"import sys\nfrom assess.cli.app import main\nsys.argv = {words!r}\nmain()"
        cache = tmp_path / f"cache-{name}" if changes else os.environ.get("NUMBA_CACHE_DIR")
        _child(code, NUMBA_CACHE_DIR=cache, **changes)
        found = json.loads((out / "results.json").read_text(encoding="utf-8"))
        risks.append({one["item"]: one["verification"]["probability"] for one in found["items"]})
    assert _kept(tmp_path / "cache-generic"), "NUMBA_CACHE_DIR names another folder"
    native, generic = risks
    assert native.keys() == generic.keys()
    assert any(0 < value < 1 for value in native.values())
    for name, value in native.items():
        assert abs(generic[name] - value) <= MOST_APART, name
