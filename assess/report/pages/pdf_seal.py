"""The identifiers of report.pdf and annex.pdf, by which a file that was changed since is known.

Both carry results.json, which therefore cannot list its hash. So the file identifier of the PDF (ISO 32000-1,
14.4: two strings in the trailer, the first one permanent, the second one anew with each change) tells it: the first is
made of results.json, the second of all other bytes of the file. Both keep their length, so that no offset changes.
"""

import hashlib
import re
from pathlib import Path

_ID = re.compile(rb"/ID ?\[\(([0-9a-f]{32})\) ?\(([0-9a-f]{32})\)\]")


def seal(path: Path, data: Path) -> bool:
    """Write the identifiers into a PDF that carries `data`; False if it has none of the expected form. OSError."""
    sealed = _put_identifiers(path.read_bytes(), data)
    if sealed is not None:
        path.write_bytes(sealed)
    return sealed is not None


def is_sealed(path: Path, data: Path) -> bool:
    """Whether a PDF is as it was written, next to a results.json as it was written. OSError if unreadable."""
    content = path.read_bytes()
    return data.is_file() and _put_identifiers(content, data) == content


def _put_identifiers(content: bytes, data: Path) -> bytes | None:
    places = list(_ID.finditer(content))
    if len(places) != 1:
        return None
    (start, end), (own_start, own_end) = places[0].span(1), places[0].span(2)
    content = content[:start] + _hash(data.read_bytes()) + content[end:]
    before, after = content[:own_start], content[own_end:]
    return before + _hash(before + b"0" * 32 + after) + after


def _hash(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest()[:32].encode()
