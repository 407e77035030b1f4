"""A request that is not carried out: its status, a message, how to fix it, and the problems of a workbook."""

import re
from typing import Any

from assess.errors import AssessError, CancelledError, InputError, OutputError, Problem, WorkbookError
from assess.i18n import Text, fill, gettext

BAD_REQUEST, NO_SESSION, FORBIDDEN, NOT_FOUND, WRONG_METHOD = 400, 401, 403, 404, 405
TIMEOUT, CONFLICT, TOO_LARGE, WRONG_HOST, UNUSABLE, TOO_MANY = 408, 409, 413, 421, 422, 429
BROKEN, UNAVAILABLE = 500, 503
_FIRST = re.compile(r"\{(\w+)")
MOST = 200
"""Problems in one answer."""


class RequestError(InputError):
    """A request is refused: why, its status (see docs/page.md), how to fix it, and further entries of the answer."""

    def __init__(self, message: Text, status: int, fix: Text | str = "", more: dict[str, Any] | None = None) -> None:
        super().__init__(message)
        self.status, self.fix, self.more = status, fix, more or {}


def describe_fault(error: Exception) -> tuple[int, dict[str, Any]]:
    """Return the status and the body of the answer to a request that went wrong, in the language in use."""
    if isinstance(error, RequestError):
        return error.status, {**_say(error.message, error.fix), **error.more}
    if isinstance(error, WorkbookError):
        message = fill("The workbook cannot be used.")
        return UNUSABLE, {**_say(message), "problems": [describe_problem(one) for one in error.problems[:MOST]]}
    if isinstance(error, OutputError | CancelledError):
        return CONFLICT, _say(error.message)
    if isinstance(error, AssessError):
        return UNUSABLE, _say(error.message)
    if isinstance(error, OSError) and error.strerror:
        return CONFLICT, _say(fill("A file cannot be used: {why}.", why=error.strerror))
    return BROKEN, _say(fill("Something went wrong here; nothing was changed. The window of assess shows more."))


def _say(message: str, fix: str = "") -> dict[str, Any]:
    return {"message": say_sentence(message), "fix": say_sentence(fix), "problems": []}


def say_sentence(text: str) -> str:
    """Return a text in the language in use, with a capital unless a name begins it: elsewhere it follows a place."""
    said, first = gettext(text), text
    while isinstance(first, Text) and (found := _FIRST.match(first.template)):
        first = first.values.get(found[1], "")
    return f"{said[:1].upper()}{said[1:]}" if isinstance(first, Text) else said


def describe_problem(problem: Problem) -> dict[str, Any]:
    """Return a problem as the page lists it."""
    return {
        "severity": problem.severity,
        "sheet": problem.sheet,
        "cell": problem.cell,
        "message": say_sentence(problem.message),
        "fix": say_sentence(problem.fix),
    }
