"""The command line: a file ``command_NAME.py`` of this folder is the command ``assess NAME``.

Such a file defines ``command``, whose docstring and options are its help, ``EXAMPLES`` (lines that can be typed) and
``ORDER`` (its place in the list of commands). Each command imports what it needs when it runs, so that ``--help``
answers at once. Exit status: see `assess.cli.console`.
"""

import contextlib
import errno
import gc
import importlib
import os
import pkgutil
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Annotated, TextIO

import typer

import assess.cli
from assess.cli.console import describe_fault, guard, print_error, say
from assess.cli.interrupts import answer_signals
from assess.version import __version__

PROGRAM, PREFIX = "assess", "command_"
ASKED = f"_{PROGRAM.upper()}_COMPLETE"
"""Variable that a shell sets when it asks for completions, to what it asks and its own name: ``complete_bash``.

It calls ``assess`` without arguments; typer answers with the options and the words that follow them. Files are left to
the shell.
"""
TYPED = ("_TYPER_COMPLETE_ARGS", "COMP_WORDS")
"""Variables that hold the line as it is typed: of zsh, fish and PowerShell, and of bash."""
BAD_USAGE, NOT_WRITTEN = 2, 1  # exit status of a blank word, and of an output that cannot be written
START = """\b
Start here:
  assess new building.xlsx     a workbook to fill in; with --example a filled one
  assess check building.xlsx   every problem of it, by sheet and cell
  assess open building.xlsx    the workbook as sheets and as a plan in the browser
  assess run building.xlsx     the reports
\b
assess COMMAND --help shows the options of a command, with examples.
"""
"""What stands below the list of commands."""


def main() -> None:
    """Run the command line, importing only the module of the command that is named, where one is.

    A shell that asks for completions names the command in its own way. Whatever the output does, there is one line and
    an exit status, and no traceback. A blank word is refused: as a path it would mean the folder that one is in.
    """
    answer_signals()
    gc.set_threshold(50_000)  # a short process makes many rows, and no cycles worth looking for
    typed = sys.argv[1] if len(sys.argv) > 1 else ""
    if ASKED in os.environ:  # the command in the line that is to be completed, if it is typed to its end
        line = next((os.environ[name] for name in TYPED if os.environ.get(name)), "")
        words = line.split()
        typed = words[1] if len(words) > 2 or (len(words) == 2 and line[-1].isspace()) else ""
        os.environ["COLUMNS"] = "1000"  # a shell would lose the help of an option after a line break
    app = build_app([typed] if typed in list_names() else ())
    if (blank := find_blank(sys.argv[1:])) is not None:
        print_error(f"{blank} is blank: fill it in, or leave it out.")
        sys.exit(BAD_USAGE)
    try:
        try:
            app(prog_name=PROGRAM)
        finally:
            # None where it was closed before the program began
            if sys.stdout is not None and not sys.stdout.closed:
                sys.stdout.flush()
    except OSError as error:
        _drop(sys.stdout)
        if error.errno != errno.EPIPE:  # whoever reads the output may stop, as head does
            with contextlib.suppress(OSError):
                print_error(describe_fault(error))
        _drop(sys.stderr)
        sys.exit(NOT_WRITTEN)


def find_blank(words: Sequence[str]) -> str | None:
    """Return what the first blank word of a command line is called: the option before it, or its place."""
    for at, word in enumerate(words):
        if word == "--":
            return None
        if word.startswith("--") and word.endswith("="):
            return word[:-1]
        if not word.strip():
            before = words[at - 1] if at else ""
            return before if before.startswith("-") else f"word {at + 1} of the command"
    return None


def _drop(stream: TextIO | None) -> None:
    """Have what cannot be written go nowhere, or Python would try again at its own end."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())  # type: ignore[union-attr]
        os.close(nowhere)


def list_names() -> list[str]:
    """Return the names of the commands, from the names of their files."""
    names = (one.name for one in pkgutil.iter_modules(assess.cli.__path__))
    return [name.removeprefix(PREFIX) for name in names if name.startswith(PREFIX)]


def find_commands(names: Sequence[str] = ()) -> list[tuple[str, ModuleType]]:
    """Return name and module of commands, by default of all, in the order of the help."""
    found = [(name, importlib.import_module(f"assess.cli.{PREFIX}{name}")) for name in names or list_names()]
    return sorted(found, key=lambda one: (one[1].ORDER, one[0]))


def build_app(names: Sequence[str] = ()) -> typer.Typer:
    """Return the command line with some commands, by default with all."""
    app = typer.Typer(
        help="Which furniture overturns in an earthquake, and what to fix first.",
        epilog=START, no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode=None,
    )  # fmt: skip
    app.callback()(_options)
    for name, module in find_commands(names):
        examples = "\n".join(f"  {line}" for line in module.EXAMPLES)
        app.command(name, epilog=f"\b\nExamples:\n{examples}")(guard(module.command))
    return app


def _show_version(wanted: bool) -> None:
    if wanted:
        say(f"assess {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Which furniture overturns in an earthquake, and what to fix first."""


def __getattr__(name: str) -> typer.Typer:
    """Return the command line with all commands as ``app``."""
    if name == "app":
        return build_app()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
