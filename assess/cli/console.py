"""What the command line prints besides results: problems, progress, and the exit status.

Exit status: 0 done; 1 done, but something could not be assessed or written (named), or `check` found a workbook that
is not complete yet; 2 bad input or usage, nothing written, but for the copy that `assess check --fix` writes and in
which errors may remain; 130 interrupted by Ctrl-C, 143 by SIGTERM (`assess.cli.interrupts`). Messages go to standard
error, what was asked for to standard output.
"""

import errno
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import Any, TextIO, get_type_hints

import typer
from typer.models import OptionInfo

from assess.cli import interrupts
from assess.environment import find_source_date
from assess.errors import AssessError, CancelledError, InputError, Problem, RecordError, WorkbookError
from assess.i18n import count
from assess.progress import Progress, Report
from assess.text import plain_line, plain_text

MOST_PRINTED = 200  # problems printed in one run; the rest are counted
LONGEST_NAME = 80  # characters of the name of a file that a message shows where the system refuses the name
REDRAW = 0.2  # shortest time between two states of the line on a terminal [s]
QUIET, REPEAT, LOOK = 2.0, 5.0, 0.5
"""Away from a terminal: silence at first, a line so often after that, and how often it is looked at [s]."""
STAGES = {
    "reading": "Reading",
    "buildings": "Assessing",
    "motions": "Preparing motions",
    "verification": "Simulating",
    "rocking": "Rocking",
    "routes": "Evaluating",
    "rendering": "Writing",
}
"""How stages are called; others by their own name."""


# ---------------------------------------------------------------- messages and exit status


class InterruptedWorkError(AssessError):
    """The user stopped the work; the message says what was kept of it."""


def say(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Print a text without what could command a terminal, as the name of a file may."""
    typer.echo(plain_text(text), err=err, nl=nl)


def say_written(files: Iterable[Path], removed: Iterable[Path] = ()) -> None:
    """Print what was written, and what of an earlier run is gone."""
    for file in files:
        say(f"wrote {file}", err=True)
    for file in removed:
        say(f"removed {file}, of an earlier run", err=True)


def guard(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command that turns each error of the library into a message and an exit status.

    A message that begins with a keyword argument is printed with its option: "runs is 0, ..." as "--runs is 0, ...".
    """

    @wraps(command)
    def run(*arguments: Any, **options: Any) -> None:
        interrupts.start()
        try:
            find_source_date()
            command(*arguments, **options)
        except InterruptedWorkError as error:
            interrupts.end_surely(str(error))
        except BaseException as error:
            if interrupts.heard or isinstance(error, KeyboardInterrupt | CancelledError):
                interrupts.end_surely()  # whatever became of the interrupt on its way
            if isinstance(error, WorkbookError):
                print_problems(error.problems)
                print_ways(error.problems)
                say(f"{count_errors(error.problems)}; nothing was written.", err=True)
                raise typer.Exit(2) from None
            if isinstance(error, AssessError):
                is_input, message = isinstance(error, InputError), str(error)
                if is_input and not isinstance(error, RecordError):  # with the option in place of the keyword argument
                    names = _list_options(command)
                    message = re.sub(r"^\w+(?=:| )", lambda found: names.get(found[0], found[0]), message)
                print_error(message)
                raise typer.Exit(2 if is_input else 1) from None
            if (
                isinstance(error, OSError) and error.filename is not None
            ):  # else the output itself, see `assess.cli.app`
                print_error(describe_fault(error))
                raise typer.Exit(2 if error.errno == errno.ENAMETOOLONG else 1) from None
            raise

    return run


def describe_fault(error: OSError) -> str:
    """Return in one line what the system refused, and of which file; without one, it is the output of the command."""
    why = error.strerror or type(error).__name__
    if error.filename is None:
        return f"the output could not be written: {why}."
    name = str(error.filename)
    return f"{name[:LONGEST_NAME]}{'…' if len(name) > LONGEST_NAME else ''} cannot be used: {why}."


def _list_options(command: Callable[..., None]) -> Mapping[str, str]:
    found: dict[str, str] = {}
    for name, hint in get_type_hints(command, include_extras=True).items():
        for info in getattr(hint, "__metadata__", ()):
            if isinstance(info, OptionInfo):
                spelt = (str(one) for one in (info.default, *(info.param_decls or ())))
                found[name] = next((one for one in spelt if one.startswith("--")), f"--{name.replace('_', '-')}")
    return found


def print_error(message: str) -> None:
    """Print one error to standard error."""
    say(f"error  {_lay_out(message)}", err=True)


def _lay_out(message: str) -> str:
    """Return a message without control characters, further lines indented: none looks like a message of its own."""
    return plain_text(message).replace("\n", "\n         ")


def print_problems(problems: Sequence[Problem]) -> None:
    """Print problems to standard error, those of one habit as one; the first `MOST_PRINTED` of them."""
    from assess.workbook.habits import group_problems

    shown = group_problems(problems)
    for problem in shown[:MOST_PRINTED]:
        say(f"{problem.severity:<7}  {_lay_out(str(problem))}", err=True)
    if len(shown) > MOST_PRINTED:
        say(f"... and {len(shown) - MOST_PRINTED:,} more.", err=True)


def print_ways(problems: Sequence[Problem]) -> None:
    """Print to standard error what completes a workbook that lacks the shaking or the furniture."""
    from assess.workbook.habits import list_ways

    print_numbered("To fill in what is missing:", list_ways(problems))


def print_numbered(heading: str, lines: Sequence[str]) -> None:
    """Print a heading and a numbered list below it to standard error; nothing where the list is empty."""
    if lines:
        say(heading, err=True)
    for number, line in enumerate(lines, 1):
        say(f"  {number}. {line}", err=True)


def print_warnings(problems: Sequence[Problem]) -> None:
    """Print the warnings among problems to standard error."""
    print_problems([problem for problem in problems if problem.severity == "warning"])


def count_errors(problems: Sequence[Problem]) -> str:
    """Return how many errors there are: "2 errors", or "3 kinds of error in 52 places" where some are of one habit."""
    from assess.workbook.habits import count_kinds

    kinds, errors = count_kinds(problems)
    if kinds == errors:
        return count(errors, "error")
    return f"{kinds:,} {'kind' if kinds == 1 else 'kinds'} of error in {errors:,} places"


# ---------------------------------------------------------------- progress and Ctrl-C


@contextmanager
def show_progress() -> Iterator[Progress]:
    """Show how far the work is on standard error, and have Ctrl-C or SIGTERM cancel it.

    On a terminal one line keeps changing. Elsewhere nothing is printed in the first `QUIET` seconds; then each stage
    gets a line when it begins, and one every `REPEAT` seconds. Work that does not stop in `interrupts.PATIENCE` after
    it is cancelled gets a KeyboardInterrupt.
    """
    cancel, done, line = threading.Event(), threading.Event(), _Line(sys.stderr)

    def repeat() -> None:
        while not done.wait(LOOK):
            line.repeat()

    watching = threading.Thread(target=repeat, name="assess-progress", daemon=True)
    with interrupts.cancel_by_signal(cancel):
        if not line.is_terminal:
            watching.start()
        try:
            yield Progress(line, cancel)
        finally:
            line.clear()
            done.set()
            if not line.is_terminal:
                watching.join()


class _Line:
    """Prints reports of progress: one changing line on a terminal, a line now and then elsewhere."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self.is_terminal = stream, stream.isatty()
        self._start = self._written = time.monotonic()
        self._due = self._start + QUIET
        self._is_shown, self._report, self._lock = False, _NOTHING, threading.Lock()

    def __call__(self, report: Report) -> None:
        def name(one: Report) -> tuple[str, str]:
            """Return what is worked on without its numbers, which count on while the work is the same."""
            return one.stage, re.sub(r"\d[\d,]*", "", one.detail)

        with self._lock:
            before, self._report = self._report, report if report.share < 1.0 else _NOTHING
            is_new, now = name(report) != name(before), time.monotonic()
            if report.share >= 1.0:
                self._clear()
            elif self.is_terminal and (is_new or now - self._written >= REDRAW):
                self._print(f"\r\x1b[K{describe_progress(report)}", now)
                self._is_shown = True
            elif not self.is_terminal and (now >= self._due or (is_new and now - self._start >= QUIET)):
                self._print(f"{describe_progress(report)}\n", now)

    def repeat(self) -> None:
        """Print how far the work is, away from a terminal, if it is time to and nothing was reported since."""
        with self._lock:
            now = time.monotonic()
            if not self.is_terminal and now >= self._due:
                known = self._report is not _NOTHING
                text = describe_progress(replace(self._report, seconds_left=None)) if known else "Working"
                self._print(f"{text}, {now - self._start:.0f} s so far\n", now)

    def clear(self) -> None:
        """Remove the line from the terminal."""
        with self._lock:
            self._clear()

    def _clear(self) -> None:
        if self._is_shown:
            self._print("\r\x1b[K", time.monotonic())
            self._is_shown = False

    def _print(self, text: str, now: float) -> None:
        self._stream.write(text)
        self._stream.flush()
        self._written, self._due = now, now + REPEAT


_NOTHING = Report("", 1.0, "", None)  # the state between two stages


def describe_progress(report: Report) -> str:
    """Return stage, share and time left: "Simulating 240 rows on 4 floors: 43 %, about 2 min left"."""
    stage, left = STAGES.get(report.stage, report.stage.capitalize()), ""
    if (seconds := report.seconds_left) is not None:  # with no more digits than can be known
        left = f", about {max(1, round(seconds))} s left" if seconds < 90 else f", about {round(seconds / 60)} min left"
    return f"{plain_line(' '.join((stage, report.detail))).strip()}: {int(100 * report.share)} %{left}"


# ---------------------------------------------------------------- the browser


def open_file(path: Path) -> str:
    """Open a file with the default browser, or the program that ``BROWSER`` names.

    Returns "" where a program was started; else one line that says where the file is.
    """
    if open_address(path.resolve().as_uri()):
        return ""
    why = "No browser could be started" if _has_display() else "There is no display here"
    return f"{why}. The report is {path.resolve()}"


def open_address(address: str) -> bool:
    """Open an address in the default browser; tell whether a program was started, which is never an error."""
    import webbrowser

    try:
        return _has_display() and webbrowser.open(address)
    except (webbrowser.Error, OSError, ValueError):  # no program, one that does not start, a BROWSER that is garbled
        return False


def _has_display() -> bool:
    """Whether a program with a window can be shown; a text browser would take the terminal over."""
    if os.environ.get("BROWSER") or sys.platform in ("win32", "darwin", "cygwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
