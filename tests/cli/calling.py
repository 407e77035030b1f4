"""The command line, called inside the process of the tests."""

import math
import re
from unittest.mock import patch

from typer.testing import CliRunner

from assess.cli import console
from assess.cli.app import app
from tests.report.reading import no_figures


def run(*words: object):
    """Call `assess` with some words, without the figures of reports; no line of progress is printed."""
    with patch.object(console, "QUIET", math.inf), no_figures():
        return CliRunner().invoke(app, [str(word) for word in words])


def error(done):
    """The message of a run that failed as it should: status 2, nothing printed, no traceback."""
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.exception is None or isinstance(done.exception, SystemExit)
    return " ".join(re.sub(r"[│╭╮╰╯─\n]", " ", done.stderr).split())
