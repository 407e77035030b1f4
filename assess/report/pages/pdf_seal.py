"""The identifiers of report.pdf and annex.pdf, by which a file that was changed since is known.

Both carry results.json, which therefore cannot list its hash. So the file identifier of the PDF (ISO 32000-1,
14.4: two strings in the trailer, the first one permanent, the second one anew with each change) tells it: the first is
made of results.json, the second of all other bytes of the file. Both keep their length, so that no offset changes.
"""

import hashlib
import re
from pathlib import Path

_ID = re.compile(rb"/ID ?\[\(([0-9a-f]{32})\) ?\(([0-9a-f]{32})\)\]")
_LENGTH = 32


def seal(path: Path, data: Path) -> bool:
    """Write the identifiers into a PDF that carries `data`; False if it has none of the expected form. OSError."""
    content = path.read_bytes()
    places = list(_ID.finditer(content))
    if len(places) != 1:
        return False
    content = _put(content, places[0], 1, _short(data.read_bytes()))
    path.write_bytes(_put(content, places[0], 2, _find_own(content, places[0])))
    return True


def is_sealed(path: Path, data: Path) -> bool:
    """Whether a PDF is as it was written, next to a results.json as it was written. OSError if unreadable."""
    content = path.read_bytes()
    places = list(_ID.finditer(content))
    if len(places) != 1 or not data.is_file():
        return False
    return places[0][1] == _short(data.read_bytes()) and places[0][2] == _find_own(content, places[0])


def _find_own(content: bytes, place: re.Match[bytes]) -> bytes:
    return _short(_put(content, place, 2, b"0" * _LENGTH))


def _put(content: bytes, place: re.Match[bytes], group: int, text: bytes) -> bytes:
    return content[: place.start(group)] + text + content[place.end(group) :]


def _short(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest()[:_LENGTH].encode()
