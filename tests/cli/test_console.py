"""Progress on standard error, and errors of the library as messages of the command line."""

import io
import re
import subprocess
import sys
import threading
from types import SimpleNamespace
from typing import Annotated

import pytest
import typer

from assess.cli import console
from assess.cli.console import MOST_PRINTED, QUIET, REPEAT, guard, print_problems
from assess.errors import AssessError, InputError, OutputError, Problem, RecordError, WorkbookError
from assess.progress import Progress, Report


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def clock(monkeypatch):
    """Time that passes when a test sets it."""
    clock = SimpleNamespace(now=0.0)
    clock.monotonic = lambda: clock.now
    monkeypatch.setattr(console, "time", clock)
    return clock


def report(share, stage="verification", detail="5 rows on 2 floors", left=None):
    return Report(stage, share, detail, left)


# ---------------------------------------------------------------- progress


def test_away_from_a_terminal_a_line_now_and_then(clock):
    stream = io.StringIO()
    line = console._Line(stream)
    clock.now = QUIET - 0.1
    line(report(0.0))
    line(report(0.1))
    assert stream.getvalue() == "", "a short run prints nothing"
    clock.now = REPEAT
    line(report(0.4, left=30.0))
    line(report(0.0))
    clock.now += 1
    line(report(0.5))
    line(report(1.0))
    line(report(0.0, "rendering", "report.pdf"))
    clock.now += REPEAT
    line(report(0.2, "rendering", "report.pdf"))
    line.clear()
    assert stream.getvalue().splitlines() == [
        "Simulating 5 rows on 2 floors: 40 %, about 30 s left",
        "Writing report.pdf: 0 %",
        "Writing report.pdf: 20 %",
    ]


def shown(stream):
    """Return what a terminal shows now; everything stays on one line."""
    assert "\n" not in stream.getvalue()
    return stream.getvalue().split("\r\x1b[K")[-1]


def test_on_a_terminal_one_line_changes_and_is_removed_and_none_is_written_while_nothing_is_reported(clock):
    stream = Terminal()
    line = console._Line(stream)
    line(report(0.0))
    assert shown(stream) == "Simulating 5 rows on 2 floors: 0 %"
    clock.now = 0.1
    line(report(0.1))
    assert shown(stream) == "Simulating 5 rows on 2 floors: 0 %", "not more often than one can read"
    clock.now = 0.3
    line(report(0.2))
    assert shown(stream) == "Simulating 5 rows on 2 floors: 20 %"
    line(report(1.0))
    assert shown(stream) == ""
    written = stream.getvalue()
    line.clear()
    assert stream.getvalue() == written
    line(report(0.0))
    written = stream.getvalue()
    clock.now = 100.0
    line.repeat()
    assert stream.getvalue() == written


def test_many_threads_report_at_once(monkeypatch):
    monkeypatch.setattr(console, "REDRAW", -1.0)
    stream, threads = Terminal(), 8
    with Progress(console._Line(stream)).stage("rocking", "8 pieces on 8 floors", threads) as stage:

        def run(number):
            for step in range(200):
                stage.at(step / 200, number)

        running = [threading.Thread(target=run, args=(number,)) for number in range(threads)]
        for one in running:
            one.start()
        for one in running:
            one.join()
    lines = stream.getvalue().split("\r\x1b[K")
    assert len(lines) == 1 + 1 + 200 * threads + 1
    assert lines[-1] == ""
    assert all(re.fullmatch(r"Rocking 8 pieces on 8 floors: \d+ %(, about \d+ s left)?", one) for one in lines[1:-1])


# ---------------------------------------------------------------- errors and exit status


def run(error):
    """Return exit status and messages of a command with three options that ends with an error."""

    def command(
        path: str,
        runs: Annotated[str, typer.Option()] = "",
        route_risk: Annotated[float, typer.Option()] = 0.0,
        as_json: Annotated[bool, typer.Option("--json")] = False,
    ) -> None:
        raise error

    with pytest.raises(typer.Exit) as caught:
        guard(command)(path="x")
    return caught.value.exit_code


@pytest.mark.parametrize(
    ("error", "status", "message"),
    [
        (InputError("runs is 0, expected 1"), 2, "error  --runs is 0, expected 1\n"),
        (InputError("route_risk: too large"), 2, "error  --route-risk: too large\n"),
        (InputError("as_json is 3"), 2, "error  --json is 3\n"),
        (InputError("path is no option"), 2, "error  path is no option\n"),
        (InputError("--runs and --seed"), 2, "error  --runs and --seed\n"),
        (RecordError("runs: a file of this name"), 2, "error  runs: a file of this name\n"),
        (OutputError("the disk is full"), 1, "error  the disk is full\n"),
        (AssessError("something else"), 1, "error  something else\n"),
        (WorkbookError([Problem("error", "Items", "B2", "bad.")]), 2, "error    Items!B2: bad.\n1 error; nothing"),
    ],
)
def test_errors_become_messages_that_name_options(capsys, error, status, message):
    assert run(error) == status
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(message)


def test_many_problems_are_counted_not_all_printed(capsys):
    print_problems([Problem("note", "Items", f"A{at}", "wrong") for at in range(MOST_PRINTED + 1000)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == MOST_PRINTED + 1
    assert lines[-1] == "... and 1,000 more."


# ---------------------------------------------------------------- while nothing is reported


def test_a_line_repeats_what_was_reported_last(clock):
    stream = io.StringIO()
    line = console._Line(stream)
    clock.now = QUIET - 0.1
    line.repeat()
    assert stream.getvalue() == ""
    clock.now = QUIET
    line.repeat()
    clock.now += REPEAT - 0.1
    line.repeat()
    line(report(0.0, "rendering", "pdf"))
    clock.now += REPEAT
    line.repeat()
    line(report(1.0, "rendering", "pdf"))
    clock.now += REPEAT
    line.repeat()
    assert stream.getvalue().splitlines() == [
        "Working, 2 s so far", "Writing pdf: 0 %", "Writing pdf: 0 %, 12 s so far", "Working, 17 s so far",
    ]  # fmt: skip


SLOW = """
import threading, time
from assess.cli import console
console.QUIET, console.REPEAT, console.LOOK = 0.0, 0.0, 0.01

class Stream:
    def __init__(self):
        self.text, self.wanted, self.seen = "", "", threading.Event()
    def isatty(self):
        return False
    def flush(self):
        if self.wanted and self.text.count(self.wanted) >= 3:
            self.seen.set()
    def write(self, text):
        self.text += text
    def wait_for_three(self, wanted):
        self.wanted = wanted
        assert self.seen.wait(60), self.text
        self.wanted, _ = "", self.seen.clear()

console.sys.stderr = stream = Stream()
with console.show_progress() as progress:
    stream.wait_for_three("Working, ")  # an import, a compilation
    with progress.stage("rendering", "pdf"):
        stream.wait_for_three("Writing pdf: 0 %, ")  # the layout of a PDF
print(threading.active_count() == 1 or [one.name for one in threading.enumerate()])
"""


def test_lines_go_on_while_a_stage_reports_nothing():
    """In a process of its own, whose work waits until three lines have come: nothing here depends on the time."""
    done = subprocess.run([sys.executable, "-c", SLOW], capture_output=True, text=True, timeout=120, check=False)
    assert "assess-progress" not in done.stdout
    assert done.returncode == 0, done.stderr
