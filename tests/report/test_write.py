"""Reports appear whole or not at all: a full disk, a killed process, a missing library."""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys

import pytest

import assess
from assess.report import FILES, FORMATS
from tests.workbooks import assessed, write

DEFAULT = {FILES[name] for name in FORMATS}


def _contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def _code(*arguments, patch=""):
    words = ["assess", *map(str, arguments)]
    return f"{patch}\nimport sys\nfrom assess.cli.app import main\nsys.argv = {words!r}\nmain()"


def _assess(*arguments, limit=None, patch=""):
    """The command in a process of its own; no file it writes may grow beyond `limit` bytes.

    -B: under a limit, Python would leave cut-off bytecode behind for whoever imports the module next.
    """
    code = _code(*arguments, patch=patch)
    preexec = (lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))) if limit else None
    return subprocess.run(
        [sys.executable, "-B", "-c", code], capture_output=True, text=True, timeout=120, preexec_fn=preexec, check=False
    )


def _run(path, out, *more, limit=None, patch=""):
    return _assess("run", path, "--verify", "none", "--out", out, *more, limit=limit, patch=patch)


def test_all_formats_are_written(tmp_path):
    written = assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out")
    assert set(written) == set(FORMATS)
    assert {path.name for path in (tmp_path / "out").iterdir()} == DEFAULT


def test_an_unknown_format_is_refused(tmp_path):
    with pytest.raises(assess.InputError, match="formats: 'docx' is unknown, expected some of: pdf, xlsx, html, json"):
        assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ("docx",))
    assert not (tmp_path / "out").exists()


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "out").write_text("x")
    with pytest.raises(assess.OutputError, match="cannot be written to"):
        assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ("json",))


def test_other_files_in_the_folder_are_left_alone(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine")
    assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ("json", "csv"))
    assert (tmp_path / "out" / "mine.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("formats", "limit"),
    [
        ("json,csv,xlsx", 4_000),
        pytest.param("json,csv,xlsx", 20_000, marks=pytest.mark.slow),
        pytest.param("xlsx", 4_000, marks=pytest.mark.slow),
        pytest.param("csv", 100, marks=pytest.mark.slow),
        pytest.param("json", 20_000, marks=pytest.mark.slow),
    ],
)
def test_a_disk_that_fills_leaves_the_old_report_whole(tmp_path, formats, limit):
    """A limit on the size of files makes every write beyond it fail as a full disk does."""
    items = [{"item": f"i{at}", "floor": "1", "breadth": 30, "height": 180, "notes": f"{at} " * 40} for at in range(60)]
    old = write(tmp_path / "old.xlsx")
    new = write(tmp_path / "new.xlsx", items)
    out = tmp_path / "out"
    assert _run(old, out, "--formats", "json,csv,xlsx,html").returncode == 0
    before = _contents(out)
    done = _run(new, out, "--formats", formats, limit=limit)
    assert done.returncode == 1, done.stderr
    assert "could not be written" in done.stderr
    assert "left as it was" in done.stderr
    assert "Traceback" not in done.stderr
    assert _contents(out) == before


@pytest.mark.slow
@pytest.mark.parametrize("limit", [100, 4_000, 20_000])
def test_a_disk_that_fills_leaves_the_old_workbook_whole(tmp_path, limit):
    """At 100 and 4,000 bytes a part of the workbook fails, at 20,000 the whole."""
    path = tmp_path / "office.xlsx"
    path.write_bytes(b"mine")
    done = _assess("new", path, "--force", limit=limit)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.split() == f"error {path} could not be written: File too large.".split()
    assert [each.name for each in tmp_path.iterdir()] == ["office.xlsx"]
    assert path.read_bytes() == b"mine"


@pytest.mark.slow
def test_a_killed_process_leaves_the_old_report_whole(tmp_path):
    """Killed at six moments, from the first file on: what is in place is all old or a whole new file, never a part."""
    items = [{"item": f"i{at}", "floor": "1", "breadth": 30, "height": 180} for at in range(400)]
    old, new, out = write(tmp_path / "old.xlsx"), write(tmp_path / "new.xlsx", items), tmp_path / "out"
    formats = "json,csv,xlsx,html"
    assert _run(new, tmp_path / "whole", "--formats", formats).returncode == 0
    wanted = {name: len(data) for name, data in _contents(tmp_path / "whole").items()}
    assert _run(old, tmp_path / "before", "--formats", formats).returncode == 0
    before = _contents(tmp_path / "before")
    killed = 0
    for moment in range(6):
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(tmp_path / "before", out)
        code = _code("run", new, "--verify", "none", "--out", out, "--formats", formats)
        process = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        size = wanted["results.json"] * moment // 6
        while process.poll() is None:
            parts = [part for stage in out.glob(".assess-writing-*") for part in stage.glob("*")]
            if sum(part.stat().st_size for part in parts if part.exists()) >= size and parts:
                process.send_signal(signal.SIGKILL)
                process.wait()
                killed += 1
        for name, data in before.items():
            now = (out / name).read_bytes()
            assert now == data or len(now) == wanted[name], name
    assert killed


@pytest.mark.slow
def test_without_the_native_libraries_all_else_is_written(tmp_path):
    """The process that lays the PDF out finds a module that fails as WeasyPrint does where Pango is not installed."""
    (tmp_path / "modules").mkdir()
    (tmp_path / "modules" / "weasyprint.py").write_text(
        "print('advice on where to look')\n"
        "raise OSError(\"cannot load library 'libpango-1.0-0': cannot open shared object file\\nand more\")\n"
    )
    patch = f"import sys\nsys.path.insert(0, {str(tmp_path / 'modules')!r})\n"
    done = _run(write(tmp_path / "w.xlsx"), tmp_path / "out", patch=patch)
    assert done.returncode == 1
    assert "the PDF was not written: a native library is missing" in done.stderr
    assert "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0" in done.stderr or sys.platform != "linux"
    assert {path.name for path in (tmp_path / "out").iterdir()} == DEFAULT - {"report.pdf"}
    json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_an_interrupt_leaves_nothing_behind(tmp_path):
    items = [{"item": f"i{at}", "floor": "1", "breadth": 30, "height": 180} for at in range(2000)]
    new, out = write(tmp_path / "new.xlsx", items), tmp_path / "out"
    code = _code("run", new, "--verify", "none", "--out", out, "--formats", "csv,json,xlsx,html,pdf")
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background jobs ignore it
    )
    while process.poll() is None and not list(out.glob(".assess-writing-*/*")):
        os.sched_yield()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode != 0
    assert "Traceback" not in errors
    assert list(out.iterdir()) == []
