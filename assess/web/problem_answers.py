"""Errors as the page is told them: a status, a message, how to fix it, and the problems of a workbook."""

from collections.abc import Sequence
from typing import Any

from assess.errors import AssessError, CancelledError, OutputError, Problem, WorkbookError
from assess.i18n import fill, gettext
from assess.web.request_errors import CONFLICT, UNUSABLE, RequestError

MOST = 200
"""Problems in one answer."""
BROKEN = 500


def describe_fault(error: Exception) -> tuple[int, dict[str, Any]]:
    """Return the status and the body of the answer to a request that went wrong, in the language in use."""
    if isinstance(error, RequestError):
        return error.status, {**_say(error.message, error.fix), **error.more}
    if isinstance(error, WorkbookError):
        message = fill("The workbook cannot be used.")
        return UNUSABLE, {**_say(message), "problems": [describe_problem(one) for one in error.problems[:MOST]]}
    found = _find_book_error(error)
    if found is not None:
        return found
    if isinstance(error, OutputError | CancelledError):
        return CONFLICT, _say(error.message)
    if isinstance(error, AssessError):
        return UNUSABLE, _say(error.message)
    if isinstance(error, OSError) and error.strerror:
        return CONFLICT, _say(fill("A file cannot be used: {why}.", why=error.strerror))
    return BROKEN, _say(fill("Something went wrong here; nothing was changed. The window of assess shows more."))


def _find_book_error(error: Exception) -> tuple[int, dict[str, Any]] | None:
    """Return the answer to an edit that is refused, another version, or a file that another program changed."""
    from assess.web.book import ChangedOutsideError, EditsRefused, VersionError

    if isinstance(error, EditsRefused):
        return UNUSABLE, {**_say(error.message), "refused": error.refused}
    if isinstance(error, VersionError):
        return CONFLICT, {**_say(fill("The workbook was changed elsewhere.")), "state": error.state}
    if isinstance(error, ChangedOutsideError):
        return CONFLICT, _say(error.message)
    return None


def _say(message: str, fix: str = "") -> dict[str, Any]:
    return {"message": gettext(message), "fix": gettext(fix), "problems": []}


def describe_problem(problem: Problem) -> dict[str, Any]:
    """Return a problem as the page lists it."""
    return {
        "severity": problem.severity,
        "sheet": problem.sheet,
        "cell": problem.cell,
        "message": gettext(problem.message),
        "fix": gettext(problem.fix),
    }


def describe_problems(problems: Sequence[Problem]) -> list[dict[str, Any]]:
    """Return problems as the page lists them, as many as it shows."""
    return [describe_problem(one) for one in problems[:MOST]]
