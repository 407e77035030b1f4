"""Reports appear whole or not at all: a full disk, a killed process, a missing library."""

import hashlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys

import pytest

import assess
from assess.report import check_folder, list_formats
from assess.report.data import write_json
from assess.report.ownership import read_list
from assess.report_formats import DEFAULT, FILES
from tests.cli.calling import error, run
from tests.report.reading import no_figures
from tests.waiting import PATIENCE
from tests.workbooks import assessed, write

USUAL = {FILES[name] for name in DEFAULT}


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


def test_an_unknown_format_and_a_folder_that_is_a_file_are_refused(tmp_path):
    with pytest.raises(assess.InputError, match="formats: 'odt' is unknown, expected some of: pdf, annex, work, xlsx"):
        assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ("odt",))
    assert not (tmp_path / "out").exists()
    (tmp_path / "out").write_text("x")
    with pytest.raises(assess.OutputError, match="cannot be written to"):
        assess.write_reports(assessed(tmp_path / "w.xlsx"), tmp_path / "out", ("json",))


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("results") / "w.xlsx")


def _names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("has_other", [False, True])
@pytest.mark.slow
def test_the_reports_in_a_folder_are_of_one_run(tmp_path, results, has_other):
    """Reports of an earlier run in other formats go, whether the folder is exchanged or its files are moved."""
    own = ["mine.txt"] if has_other else []
    for name in own:
        (tmp_path / name).write_text("mine")
    assess.write_reports(results, tmp_path, ("html", "xlsx", "csv"))
    assert _names(tmp_path) == sorted(["items.csv", "report.html", "report.xlsx", "results.json", *own])
    written = assess.write_reports(results, tmp_path, "csv")
    assert set(written) == {"json", "csv"}
    assert _names(tmp_path) == sorted(["items.csv", "results.json", *own])
    assert all((tmp_path / name).read_text() == "mine" for name in own)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda path: path.write_text("mine"),
            "out: .* would be replaced, but no results.json beside them lists them .*: {}",
        ),
        (lambda path: path.mkdir(), "{} is a folder or a link, where a report is to be written"),
        (lambda path: path.symlink_to("elsewhere"), "{} is a folder or a link, where a report is to be written"),
    ],
)
@pytest.mark.parametrize("name", ["report.html", "results.json"])
def test_what_is_in_the_way_is_named_before_the_run(tmp_path, results, name, make, message):
    out = tmp_path / "out"
    out.mkdir()
    make(out / name)
    with pytest.raises(assess.InputError, match=message.format(name)):
        check_folder(out, ("html",))
    with pytest.raises(assess.InputError, match=message.format(name)):
        assess.write_reports(results, out, "html")
    assert (_names(out), _names(tmp_path)) == ([name], ["out"])
    check_folder(tmp_path / "other", ("html",))


def test_the_command_names_what_is_in_the_way_first_and_a_list_leads_out_of_no_folder(tmp_path):
    (tmp_path / "out" / "report.html").mkdir(parents=True)
    text = error(run("run", tmp_path / "missing.xlsx", "--out", tmp_path / "out"))
    assert "report.html is a folder or a link" in text
    listed = {"../mine.txt": None, "a/b": None, "..": None, "c:x": None, "report.html": "0" * 64}
    text = json.dumps({"schema": "4.2", "assess": {"version": "1", "files": listed}}, indent=2)
    (tmp_path / "results.json").write_text(text)
    assert read_list(tmp_path / "results.json") == {"report.html": "0" * 64, "results.json": None}


def test_a_file_of_the_users_that_is_not_in_the_way_stays_and_results_of_others_list_nothing(tmp_path, results):
    (tmp_path / "report.pdf").write_text("mine")
    assess.write_reports(results, tmp_path, "csv")
    assert (tmp_path / "report.pdf").read_text() == "mine"
    for text in ("", "{}", '{"a": 1}', "[]", '{"schema": "1.0"}', '{"schema": "1.0", "assess": {}}', "{" * 5000):
        (tmp_path / "results.json").write_text(text)
        assert read_list(tmp_path / "results.json") == {}, text


@pytest.mark.slow
def test_a_report_that_was_changed_is_the_users(tmp_path, results):
    """Whether its format is written again or not: next to a new report it would be of another run."""
    assess.write_reports(results, tmp_path, ("html", "csv"))
    before = _contents(tmp_path)
    with (tmp_path / "report.html").open("a") as file:
        file.write("<!-- signed -->")
    for formats in ("html", "csv"):
        with pytest.raises(assess.InputError, match=r"changed after they were written, .*: report\.html\. Move"):
            assess.write_reports(results, tmp_path, formats)
    (tmp_path / "report.html").rename(tmp_path / "signed.html")
    assess.write_reports(results, tmp_path, "csv")
    assert _names(tmp_path) == ["items.csv", "results.json", "signed.html"]
    assert (tmp_path / "items.csv").read_bytes() == before["items.csv"]


@pytest.mark.slow
def test_a_pdf_that_was_changed_is_the_users(tmp_path, results):
    assess.write_reports(results, tmp_path, "pdf")
    assess.write_reports(results, tmp_path, "pdf")
    path = tmp_path / "report.pdf"
    written = path.read_bytes()
    for changed in (written + b"\n", written.replace(b"endobj", b"Endobj", 1)):
        path.write_bytes(changed)
        with pytest.raises(assess.InputError, match=r"changed after they were written, .*: report\.pdf\. Move"):
            assess.write_reports(results, tmp_path, "csv")


@pytest.mark.parametrize("files", [None, {}, {"items.csv": None, "report.html": None}, {"items.csv": 1}])
def test_a_list_without_hashes_makes_nothing_a_report(tmp_path, results, files):
    write_json(results, tmp_path / "results.json", files=files)
    for name in ("report.html", "items.csv", "mine.txt", "annex.pdf"):
        (tmp_path / name).write_text("mine")
    before = _contents(tmp_path)
    with pytest.raises(assess.InputError, match=r"out: .*: items\.csv.* choose another folder\. Nothing was touched"):
        assess.write_reports(results, tmp_path, "csv")
    assert _contents(tmp_path) == before


@pytest.mark.parametrize("listed", [None, 1, "0" * 64, hashlib.sha256(b"mine").hexdigest()])
def test_a_stranger_s_list_removes_no_file_of_the_user_s(tmp_path, results, listed):
    """Whatever it says of names that the program never writes, even with their hash."""
    files = dict.fromkeys(("thesis.docx", "photo.jpg", "report.html.bak"), listed)
    (tmp_path / "results.json").write_text(json.dumps({"schema": "1", "assess": {"version": "0.1.0", "files": files}}))
    for name in files:
        (tmp_path / name).write_text("mine")
    written = assess.write_reports(results, tmp_path, "json")
    assert written.removed == ()
    assert all((tmp_path / name).read_text() == "mine" for name in files)


@pytest.mark.slow
def test_what_is_removed_and_not_replaced_is_said(tmp_path):
    book = write(tmp_path / "w.xlsx")
    words = ("run", book, "--verify", "none", "--out", tmp_path / "out")
    run(*words, "--formats", "html,csv")
    done = run(*words, "--formats", "json")
    gone = [f"removed {tmp_path / 'out' / name}, of an earlier run" for name in ("items.csv", "report.html")]
    assert [line for line in done.stderr.splitlines() if line.startswith("removed")] == gone


def test_a_folder_without_results_is_unfinished(tmp_path):
    book = write(tmp_path / "w.xlsx")
    words = ("run", book, "--verify", "none", "--formats", "csv", "--out", tmp_path / "out")
    run(*words)
    (tmp_path / "out" / "results.json").rename(tmp_path / "out" / ".results.old.json")
    said = error(run("compare", tmp_path / "out", tmp_path / "out"))
    assert "out is unfinished: a run was stopped while it moved its files there" in said
    assert run(*words).exit_code == 0
    assert _names(tmp_path / "out") == ["items.csv", "results.json"]


@pytest.mark.slow
def test_a_disk_that_fills_leaves_the_old_report_whole(tmp_path, results):
    """A limit on the size of files makes every write beyond it fail as a full disk does."""
    items = [{"item": f"i{at}", "floor": "1", "breadth": 30, "height": 180, "notes": f"{at} " * 40} for at in range(60)]
    new = write(tmp_path / "new.xlsx", items)
    out = tmp_path / "out"
    with no_figures():
        assess.write_reports(results, out, ("json", "csv", "xlsx", "html"))
    before = _contents(out)
    done = _run(new, out, "--formats", "json,csv,xlsx", limit=4_000)
    assert done.returncode == 1, done.stderr
    assert "could not be written" in done.stderr
    assert "left as it was" in done.stderr
    assert "Traceback" not in done.stderr
    assert _contents(out) == before


@pytest.mark.slow
@pytest.mark.parametrize("limit", [100, 20_000])
def test_a_disk_that_fills_leaves_the_old_workbook_whole(tmp_path, limit):
    """At 100 bytes a part of the workbook fails, at 20,000 the whole."""
    path = tmp_path / "office.xlsx"
    path.write_bytes(b"mine")
    done = _assess("new", path, "--force", limit=limit)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.split() == f"error {path} could not be written: File too large.".split()
    assert [each.name for each in tmp_path.iterdir()] == ["office.xlsx"]
    assert path.read_bytes() == b"mine"


def _measure_stage(folder):
    """Return the bytes of the files that a run has begun to write, -1 before the first and once they move."""
    try:
        sizes = [part.stat().st_size for part in folder.glob(".assess-writing-*/new/*")]
    except FileNotFoundError:  # moved or removed while it was looked at
        return -1
    return sum(sizes) if sizes else -1


@pytest.mark.long
@pytest.mark.slow
def test_a_killed_process_leaves_the_old_report_whole(tmp_path):
    """Killed at six moments, from the first file on: beside results.json all is old or all is new."""
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
        size = wanted["results.json"] * moment // 6
        with subprocess.Popen(
            [sys.executable, "-c", code], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
        ) as new_run:
            while new_run.poll() is None:
                if _measure_stage(out) >= size:
                    new_run.kill()
                    new_run.wait()
                    killed += 1
        now = _contents(out)
        is_unfinished = "results.json" not in now
        assert is_unfinished or now == before or {name: len(data) for name, data in now.items()} == wanted
    assert _run(new, out, "--formats", formats).returncode == 0
    assert {path.name for path in tmp_path.iterdir()} == {"old.xlsx", "new.xlsx", "whole", "before", "out"}
    assert {path.name for path in out.iterdir()} == set(wanted)
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
    assert {path.name for path in (tmp_path / "out").iterdir()} == USUAL - {"report.pdf"}
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
    while process.poll() is None and _measure_stage(tmp_path) < 0:
        os.sched_yield()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert errors.endswith("\nInterrupted; nothing was written.\n")
    assert [path.name for path in tmp_path.iterdir()] == ["new.xlsx"]


def test_the_annex_is_written_where_it_is_asked_for_and_all_is_every_format_whose_packages_are_installed(monkeypatch):
    assert "annex" not in DEFAULT
    assert {"docx", "npz", "parquet"} & set(DEFAULT) == set()
    assert list_formats(("all",)) == list(FILES)
    missing = {"duckdb", "docx"}
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name in missing else name)
    assert list_formats(("json", "all")) == [name for name in FILES if name not in ("docx", "parquet")]
    assert list_formats(("docx",)) == ("docx",), "what is asked for by its name is missed"


@pytest.mark.slow
def test_results_list_the_files_of_their_run(tmp_path, results):
    assess.write_reports(results, tmp_path, ("html", "csv"))
    listed = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["assess"]["files"]
    assert listed == {
        name: hashlib.sha256((tmp_path / name).read_bytes()).hexdigest() for name in ("items.csv", "report.html")
    }
