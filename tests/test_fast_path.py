"""The formula path stays light: what it imports, and how much memory 20,000 items take."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.workbooks import write

HEAVY = (
    "pandas", "matplotlib", "weasyprint", "scipy.stats", "numba", "scipy", "xlsxwriter", "jinja2", "babel", "shapely",
    "networkx",
)  # fmt: skip


def _child(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def _items(count):
    return [
        {"item": f"i{at}", "floor": str(1 + at % 2), "room": f"room {at % 97}", "description": "Bookcase, steel",
         "breadth": 20 + at % 70, "width": 120, "height": 100 + at % 130, "axis": "XY"[at % 2], "notes": "by the door"}
        for at in range(count)
    ]  # fmt: skip


LOADED = "print(sorted({found} & {{name.split('.')[0] for name in sys.modules}} | {found} & {{*sys.modules}}))"


@pytest.mark.slow
def test_nothing_heavy_is_imported_before_it_is_needed(tmp_path):
    path = write(tmp_path / "w.xlsx", _items(50))
    words = ["assess", "run", str(path), "--verify", "none", "--formats", "json,csv", "--out", str(tmp_path / "out")]
    run = (
        f"sys.argv = {words!r}\nfrom assess.cli.app import main\n"
        "try:\n    main()\nexcept SystemExit as stop:\n    assert not stop.code"
    )
    for code, heavy in (
        ("import assess", {"numpy", "openpyxl", "typer"}),
        ("import assess.motion.formats as formats\nformats.all_formats()", {"obspy"}),
        ("import assess.hazard, assess.fragility", {"numba", "scipy"}),
        ("import assess.cli.app\nassess.cli.app.build_app()", {"starlette", "uvicorn", "anyio", "assess.web"}),
        (run, {*HEAVY, "assess.routes.evaluate", "assess.routes.obstructions"}),  # there are no routes
    ):
        loaded = _child(f"import sys\n{code}\n{LOADED.format(found=heavy)}")
        assert loaded.splitlines()[-1] == "[]", code


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="peak memory is read from /proc")
def test_20000_items_fit_in_300_mb(tmp_path):
    path = write(tmp_path / "w.xlsx", _items(20_000))
    peak = _child(
        "import assess, pathlib, re\n"
        f"assessment = assess.run(assess.read_inventory({str(path)!r}), assess.Settings(verify='none'))\n"
        f"written = assess.write_reports(assessment, {str(tmp_path / 'out')!r}, ('json', 'csv', 'xlsx'))\n"
        "assert len(written) == 3 and len(assessment) == 20_000\n"
        # the peak of this program alone: ru_maxrss would count the process that started it
        "print(int(re.search(r'VmHWM:\\s+(\\d+)', pathlib.Path('/proc/self/status').read_text())[1]) / 1024)"
    )
    assert float(peak) < 300
