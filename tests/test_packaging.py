"""The wheel, installed in a clean environment away from the checkout, renders a report and does a study."""

import os
import re
import subprocess
import sys
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

from assess.environment import say_install
from tests.conftest import STAND_ALONE
from tests.other_pythons import find_pythons, list_versions
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
    listed = zipfile.ZipFile(wheel).namelist()
    names = set(listed)
    assert len(names) == len(listed), "no file hides another"
    sought = [
        "templates/page.html.j2", "templates/style/print.css", "templates/studies/table3.md.j2",
        "templates/city.html.j2", "templates/script/city.js", "workbook/catalogue.csv", "report/results.schema.json",
        "py.typed", "web/page/index.html", "web/page/main.mjs", "fonts/IBMPlexSans-Regular.ttf", "fonts/LICENSE.txt",
        "studies/facts/table1_buildings.csv", "examples/market-street.xlsx", "examples/city/grid.xml",
        "examples/city/coast.geojson",
    ]  # fmt: skip
    assert {f"assess/{name}" for name in sought} <= names
    records = {name.split("/")[2] for name in names if name.startswith("assess/records/")}
    assert records == {"575-market", "berkeley-1103", "others"}
    assert not [name for name in names if name.startswith(("tests", "inventories", "samples"))]
    # 3 MB of it are the records of the studies, 0.4 MB the fonts, 0.3 MB the page and its example, 0.1 MB the city,
    # 0.1 MB what reads and writes building models
    assert wheel.stat().st_size < 5.35e6


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Its dependencies are those of this environment, put on the path behind its own packages."""
    home = tmp_path_factory.mktemp("installed") / "venv"
    venv.create(home, with_pip=True)
    python = home / ("Scripts" if os.name == "nt" else "bin") / "python"
    _run(str(python), "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", str(wheel))
    packages = next(path for path in map(Path, sys.path) if (path / "openpyxl").is_dir())
    own = _run(str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
    (Path(own) / "dependencies.pth").write_text(f"{packages}\n", encoding="utf-8")
    return python


def _elsewhere(python, folder, *words):
    """Run the installed Python in a folder, without what points it to the checkout."""
    where = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    return _run(str(python), *words, cwd=folder, env=where)


@pytest.mark.long
@pytest.mark.slow
def test_the_installed_wheel_renders_a_report_elsewhere(installed, tmp_path):
    book = write(tmp_path / "w.xlsx")
    place = _elsewhere(installed, tmp_path, "-c", "import assess; print(assess.__file__)")
    assert Path(place.strip()).is_relative_to(installed.parents[1])
    _elsewhere(installed, tmp_path, "-m", "assess", "run", str(book), "--runs", "20", "--out", "out")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "report.pdf", "report.xlsx", "report.html", "results.json", "items.csv",
    }  # fmt: skip


READ_ALL = """
from assess.studies.buildings import all_buildings
channels = [one for building in all_buildings() for one in building.channels]
print(len(channels), all(one.read().pfa > 0 and "site-packages" in str(one.file) for one in channels))
"""


@pytest.mark.slow
def test_the_installed_wheel_reads_its_records_elsewhere(installed, tmp_path):
    assert _elsewhere(installed, tmp_path, "-c", READ_ALL).split() == ["21", "True"]


def test_every_extra_that_a_text_names_exists_and_none_is_installed_by_the_name_of_the_project():
    """On PyPI `assess` is another project."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    texts = {path: path.read_text(encoding="utf-8") for path in (ROOT / "assess").rglob("*.py")}
    assert [path for path, text in texts.items() if re.search(r"pip install [\"']?assess\[", text)] == []
    named = {one for text in texts.values() for one in re.findall(r"(?:say_install\(|extra=)[\"'](\w+)[\"']", text)}
    assert {"parquet", "cluster", "web", "word", "plans"} <= named <= set(extras)
    said = say_install("parquet")
    assert "\n" not in said
    assert "python -m pip install '.[parquet]'" in said
    assert "pipx install --force '.[parquet]'" in said


def test_other_pythons_are_those_that_run_on_the_path_or_in_pyenv(tmp_path, monkeypatch):
    this = "{}.{}".format(*sys.version_info)
    supported = {"3.11", "3.12", "3.13"} - {this}
    assert set(list_versions()) == supported
    for version, status in {"3.11.2": 0, "3.12.0": 1, "3.12.4": 0, "3.13.1": 1, "3.99.0": 0}.items():
        python = tmp_path / "versions" / version / "bin" / "python"
        python.parent.mkdir(parents=True)
        python.write_text(f"#!/bin/sh\nexit {status}\n")
        python.chmod(0o755)
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    places = {"3.11": "3.11.2", "3.12": "3.12.4"}
    expected = {one: str(tmp_path / "versions" / place / "bin/python") for one, place in places.items() if one != this}
    assert find_pythons() == expected


_CORE = """
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name in {names}:
            raise ImportError(name + " is not part of the core")

sys.meta_path.insert(0, Refuse())
from assess.__main__ import main
sys.argv = ["assess", *{arguments}]
main()
"""


@pytest.mark.slow
def test_the_core_works_without_the_packages_that_stand_alone(tmp_path):
    names = [f"assess.{one}" for one in STAND_ALONE]
    for arguments in (["new", "office.xlsx", "--example"], ["run", "office.xlsx", "--verify", "none"], ["--help"]):
        code = _CORE.format(names=names, arguments=arguments)
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "office-report" / "report.pdf").is_file()
