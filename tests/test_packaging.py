"""The wheel, installed in a clean environment away from the checkout, renders a report."""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from tests.workbooks import write

ROOT = Path(__file__).parents[1]


def _run(*command, **more):
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, **more)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    _run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder), cwd=ROOT)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_carries_templates_catalogue_schema_and_types(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {
        "assess/templates/report.html.j2",
        "assess/templates/style/print.css",
        "assess/inventory/catalogue.csv",
        "assess/report/results.schema.json",
        "assess/py.typed",
    } <= names
    assert not [name for name in names if name.startswith(("tests", "inventories", "samples"))]


@pytest.mark.slow
def test_the_installed_wheel_renders_a_report_elsewhere(wheel, tmp_path):
    """Its dependencies are those of this environment, put on the path behind its own packages."""
    home = tmp_path / "venv"
    venv.create(home, with_pip=True)
    python = home / ("Scripts" if os.name == "nt" else "bin") / "python"
    _run(str(python), "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", str(wheel))
    packages = next(path for path in map(Path, sys.path) if (path / "openpyxl").is_dir())
    own = _run(str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
    (Path(own) / "dependencies.pth").write_text(f"{packages}\n", encoding="utf-8")
    book = write(tmp_path / "w.xlsx")
    where = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    place = _run(str(python), "-c", "import assess; print(assess.__file__)", cwd=tmp_path, env=where)
    assert Path(place.strip()).is_relative_to(home)
    _run(str(python), "-m", "assess", "run", str(book), "--runs", "20", "--out", "out", cwd=tmp_path, env=where)
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "report.pdf", "report.xlsx", "report.html", "results.json", "items.csv",
    }  # fmt: skip
