"""The files of the page as a browser gets them: compressed once, and not sent again as long as they are the same.

Fonts are those of the reports. What is compressed holds no secret next to text that others choose, and nobody but the
page of a session gets an answer (see `guard.py`), so nothing can be guessed from its length.
"""

import gzip
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

from starlette.responses import Response

from assess import resources
from assess.web.texts import PAGE

TYPES = {
    ".html": "text/html", ".css": "text/css", ".mjs": "text/javascript", ".js": "text/javascript",
    ".svg": "image/svg+xml", ".woff2": "font/woff2",
}  # fmt: skip
"""Kinds of the files of the page, whatever the registry of the machine calls them."""
PACKED = ("text/", "application/json", "image/svg+xml")
"""Kinds that become smaller; all others are compressed already."""
LEAST_PACKED = 1000
"""Bytes of the smallest answer that is compressed."""
FAST, SMALLEST = 1, 9
ASK_AGAIN, FOR_EVER = "no-cache", "max-age=31536000, immutable"


@dataclass(frozen=True, slots=True)
class Asset:
    """A file of the page: its bytes, the same compressed, its mark, which is another one after every change."""

    media_type: str
    data: bytes
    packed: bytes
    mark: str


def find_asset(name: str) -> Asset | None:
    """Return a file of the page by its name; nothing outside the folder of the page and the fonts has one."""
    path = _list_fonts().get(name)
    if path is None:
        files = {path.relative_to(PAGE).as_posix(): path for path in PAGE.rglob("*") if path.is_file()}
        path = files.get(name or "index.html")
    return _read(path, path.stat().st_mtime_ns) if path else None


@cache
def _list_fonts() -> dict[str, Path]:
    return {f"fonts/{path.name}": path for path in resources.web_fonts().values()}


@lru_cache(maxsize=512)
def _read(path: Path, _changed: int) -> Asset:
    data, media_type = path.read_bytes(), TYPES.get(path.suffix, "application/octet-stream")
    packed = gzip.compress(data, SMALLEST, mtime=0) if media_type.startswith(PACKED) else b""
    return Asset(media_type, data, packed, hashlib.sha256(data).hexdigest()[:16])


def answer_asset(asset: Asset, asked: Mapping[str, str], version: str = "") -> Response:
    """Answer with a file, or with 304 where the browser has it; `version`, the begin of its mark, never changes."""
    is_fixed = len(version) > 7 and asset.mark.startswith(version)
    headers = {
        "etag": f'W/"{asset.mark}"',
        "cache-control": FOR_EVER if is_fixed else ASK_AGAIN,
        "vary": "accept-encoding",
    }
    if headers["etag"] in [one.strip() for one in asked.get("if-none-match", "").split(",")]:
        return Response(status_code=304, headers=headers)
    if not (asset.packed and _takes_gzip(asked)):
        return Response(asset.data, media_type=asset.media_type, headers=headers)
    return Response(asset.packed, media_type=asset.media_type, headers={**headers, "content-encoding": "gzip"})


def pack(answer: Response, asked: Mapping[str, str]) -> Response:
    """Return an answer, its body compressed where the browser takes that and it becomes smaller by it."""
    is_text = answer.headers.get("content-type", "").startswith(PACKED)
    if is_text and "content-encoding" not in answer.headers and len(answer.body) >= LEAST_PACKED:
        answer.headers["vary"] = "accept-encoding"
        if _takes_gzip(asked):
            answer.body = gzip.compress(answer.body, FAST, mtime=0)
            answer.headers["content-encoding"] = "gzip"
            answer.headers["content-length"] = str(len(answer.body))
    return answer


def _takes_gzip(asked: Mapping[str, str]) -> bool:
    """Return whether a request accepts gzip: named, and not with the quality 0."""
    for one in asked.get("accept-encoding", "").lower().split(","):
        name, _, quality = one.replace(" ", "").partition(";q=")
        if name in ("gzip", "*"):
            return not quality or quality.strip("0.") != ""
    return False
