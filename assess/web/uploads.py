"""Raw bodies of requests, read up to a limit."""

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request

from assess.i18n import fill
from assess.web.guard import MOST_SKIPPED
from assess.web.request_errors import BAD_REQUEST, TOO_LARGE, RequestError


async def read_body(request: Request, most: int) -> bytes:
    """Return the body of a request; what is too large is read to its end, so that the browser gets to the answer.

    Raises
    ------
    RequestError
        If it has more than `most` bytes, or breaks off.
    """
    parts, size = [], 0
    try:
        async for part in request.stream():
            size += len(part)
            if size > MOST_SKIPPED:
                break
            if size <= most:
                parts.append(part)
    except ClientDisconnect:
        raise RequestError(fill("The request broke off."), BAD_REQUEST) from None
    check_size(size, most)
    return b"".join(parts)


async def save_body(request: Request, path: Path, most: int) -> int:
    """Write the body of a request to a new file, as it comes, and return how many bytes it has.

    No more than `most` are written; what is too large is read to its end, as above.

    Raises
    ------
    RequestError
        If it breaks off.
    OSError
        If it cannot be written.
    """
    size = 0
    with path.open("xb") as file:
        try:
            async for part in request.stream():
                size += len(part)
                if size > MOST_SKIPPED:
                    break
                if size <= most:
                    await run_in_threadpool(file.write, part)
        except ClientDisconnect:
            raise RequestError(fill("The request broke off."), BAD_REQUEST) from None
    return size


async def skip_body(request: Request) -> None:
    """Read a body that is refused, so that the browser gets to the answer."""
    size = 0
    with suppress(ClientDisconnect):
        async for part in request.stream():
            size += len(part)
            if size > MOST_SKIPPED:
                return


def check_size(size: int, most: int) -> None:
    """Raise RequestError where so many bytes are more than `most`."""
    if size > most:
        raise RequestError(fill("It is larger than {most:.0f} MB.", most=most / 2**20), TOO_LARGE)


def parse_body(data: bytes) -> dict[str, Any]:
    """Return a JSON body, {} for an empty one.

    Raises RequestError if it is no JSON object, or holds what no workbook can: numbers that are not finite, halves of
    characters.
    """
    if not data:
        return {}
    try:
        found = json.loads(data, parse_constant=_refuse_constant)
        json.dumps(found, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError):  # also UnicodeError, and a number such as 1e999
        found = None
    if not isinstance(found, dict):
        raise RequestError(fill("The request cannot be read."), BAD_REQUEST)
    return found


def _refuse_constant(name: str) -> None:
    raise ValueError(name)
