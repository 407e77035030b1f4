"""A request that is not carried out: its status, why, and how to fix it."""

from typing import Any

from assess.errors import InputError
from assess.i18n import Text

BAD_REQUEST, NO_SESSION, FORBIDDEN, NOT_FOUND, WRONG_METHOD = 400, 401, 403, 404, 405
CONFLICT, TOO_LARGE, WRONG_HOST, UNUSABLE, TOO_MANY = 409, 413, 421, 422, 429


class RequestError(InputError):
    """A request is refused.

    Parameters
    ----------
    message : Text
        Why.
    status : int
        Of the answer: see the list in docs/page.md.
    fix : Text
        How to fix it; blank where the message says it.
    more : dict, optional
        Further entries of the answer.
    """

    def __init__(self, message: Text, status: int, fix: Text | str = "", more: dict[str, Any] | None = None) -> None:
        super().__init__(message)
        self.status, self.fix, self.more = status, fix, more or {}
