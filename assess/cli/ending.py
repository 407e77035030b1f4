"""How the command line begins and ends: words that are blank, an output that cannot be written, a reader that left."""

import contextlib
import errno
import os
import sys
from collections.abc import Callable, Sequence
from typing import TextIO

from assess.cli.console import describe_fault, print_error

BAD_USAGE, NOT_WRITTEN = 2, 1


def run_to_the_end(app: Callable[[], object], words: Sequence[str]) -> None:
    """Call the command line; whatever its output does, there is one line and an exit status, and no traceback.

    A blank word is refused: as a path it would mean the folder that one is in.
    """
    if (blank := find_blank(words)) is not None:
        print_error(f"{blank} is blank: fill it in, or leave it out.")
        sys.exit(BAD_USAGE)
    try:
        try:
            app()
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
