"""Completion by the shell: which command is typed, and the values of options whose values are words.

A shell asks for completions by calling ``assess`` without arguments and with the variable `ASKED` set; typer answers,
with the options and the words that follow them. Files are left to the shell.
"""

import os
from collections.abc import Callable, Sequence

PROGRAM = "assess"
ASKED = f"_{PROGRAM.upper()}_COMPLETE"
"""Variable that a shell sets when it asks, to what it asks and its own name: ``complete_bash``."""
_WORDS = ("_TYPER_COMPLETE_ARGS", "COMP_WORDS")
"""Variables that hold the line as it is typed: of zsh, fish and PowerShell, and of bash."""

Completer = Callable[[str], list[str]]


def find_typed_command() -> str:
    """Return the command in the line that is to be completed, if it is typed to its end; else an empty text."""
    line = next((os.environ[name] for name in _WORDS if os.environ.get(name)), "")
    words = line.split()
    return words[1] if len(words) > 2 or (len(words) == 2 and line[-1].isspace()) else ""


def one_of(values: Sequence[str]) -> Completer:
    """Return what completes one of some words, in capitals or not.

    A space in one becomes a hyphen, so that no shell has to quote it.
    """

    def complete(incomplete: str) -> list[str]:
        plain = [value.replace(" ", "-").lower() for value in values]
        return [f"{incomplete}{value[len(incomplete) :]}" for value in plain if value.startswith(incomplete.lower())]

    return complete


def list_of(values: Sequence[str]) -> Completer:
    """Return what completes the last of some words that commas separate, without those that are there already."""

    def complete(incomplete: str) -> list[str]:
        before, comma, _last = incomplete.rpartition(",")
        there = before.split(",")
        return [f"{before}{comma}{value}" for value in values if value not in there]

    return complete
