"""Which files of a folder are reports of an earlier run, and may be replaced or removed: those that results.json lists.

results.json names the reports of its run with their SHA-256, so that a file that was changed since, or put there by
hand, is known to be the user's. It lists neither itself nor, by a hash, report.pdf and annex.pdf, which carry it. A
file is a report only by its hash, or as a sealed PDF, and only names that this program writes are looked at: folders of
reports are passed on, and a list may come from anyone.

A PDF is sealed by its file identifier (ISO 32000-1, 14.4: two strings in the trailer, the first one permanent, the
second one anew with each change): the first is made of results.json, the second of all other bytes of the file. Both
keep their length, so that no offset changes.
"""

import hashlib
import json
import os
import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from assess.delivery.deliver import find_digest, name_aside
from assess.errors import InputError

DATA = "results.json"
_HEAD = 4 << 20
"""Bytes at the head of results.json within which its first two entries stand."""
MOST_NAMED = 3
_ID = re.compile(rb"/ID ?\[\(([0-9a-f]{32})\) ?\(([0-9a-f]{32})\)\]")


def find_reports(
    folder: Path, wanted: Collection[str], known: Callable[[str], bool], data: str = DATA
) -> frozenset[str]:
    """Return the names of the files in a folder that are an earlier run's.

    * `folder`: may be missing.
    * `wanted`: names of the files that are to be written.
    * `known`: whether the program writes a file of this name into such a folder.
    * `data`: name of the file that lists those of the earlier run.

    Raises InputError if a folder or a file of the user's stands at one of these names, or a report was changed after it
    was written.
    """
    lists = [folder / name for name in (data, *name_aside(data))]
    try:
        listed = {path: read_list(path) for path in lists}
        names = {*wanted, *(name for found in listed.values() for name in found if known(name))}
        found = sorted(name for name in names if os.path.lexists(folder / name))
        others = [name for name in found if not _is_report(folder / name, listed)]
        mine = [name for name in others if find_digest(folder / name) is not None]
        blocked = [name for name in others if name in wanted and name not in mine]
    except OSError as error:
        why = error.strerror or str(error)
        raise InputError.about("{path} cannot be read: {why}.", path=error.filename or folder, why=why) from None
    if blocked:
        raise InputError.about("{path} is a folder or a link, where a report is to be written. Move or rename it.",
                               path=folder / blocked[0])  # fmt: skip
    if mine:
        shown = ", ".join(mine[:MOST_NAMED]) + (", ..." if len(mine) > MOST_NAMED else "")
        if any(name in own for own in listed.values() for name in mine):
            raise InputError.about(
                "out: {folder} holds files that were changed after they were written, or that its {data} lists without "
                "their hash: {names}. Move or rename them to keep them, or choose another folder. Nothing was touched.",
                folder=folder, data=data, names=shown,
            )  # fmt: skip
        raise InputError.about(
            "out: {folder} holds files that would be replaced, but no {data} beside them lists them as reports of an "
            "earlier run: {names}. Move or rename them, or choose another folder. Nothing was touched.",
            folder=folder, data=data, names=shown,
        )  # fmt: skip
    return frozenset(name for name in found if (folder / name).is_file() and name not in others)


def _is_report(path: Path, listed: Mapping[Path, Mapping[str, str | None]]) -> bool:
    """Whether a file is one that a list names by its hash, a PDF that is sealed with it, or the list itself."""
    digest = find_digest(path)
    return digest is not None and any(
        path == data or files.get(path.name) == digest
        or (files.get(path.name, "") is None and path.suffix == ".pdf" and is_sealed(path, data))
        for data, files in listed.items() if files
    )  # fmt: skip


def read_list(path: Path) -> Mapping[str, str | None]:
    """Return the reports that a results.json lists, itself among them, with their SHA-256 where it is known.

    A file of another name that begins alike serves as well. Empty if the file is missing or not of this program. Only
    its first two entries are read: it may be large.
    """
    if path.is_symlink() or not path.is_file():
        return {}
    with path.open("rb") as file:
        rest = file.read(_HEAD).decode("utf-8", "replace").lstrip()
    decoder, head = json.JSONDecoder(), dict[str, Any]()
    while rest[:1] in ("{", ",") and len(head) < 2:
        try:
            name, end = decoder.raw_decode(rest[1:].lstrip())
            rest = rest[1:].lstrip()[end:].lstrip()
            value, end = decoder.raw_decode(rest.removeprefix(":").lstrip())
            rest = rest.removeprefix(":").lstrip()[end:].lstrip()
        except (ValueError, RecursionError):
            break
        head[str(name)] = value
    origin = head.get("assess")
    if not (isinstance(head.get("schema"), str) and isinstance(origin, dict)):
        return {}
    files = origin.get("files") if isinstance(origin.get("version"), str) else None
    if not isinstance(files, dict):
        return {}
    plain = {name: value for name, value in files.items() if name not in (".", "..") and not set(name) & set("/\\:\0")}
    return {name: value if isinstance(value, str) else None for name, value in plain.items()} | {path.name: None}


# ---------------------------------------------------------------- PDFs


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
