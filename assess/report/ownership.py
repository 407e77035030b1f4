"""Which files of a folder are reports of an earlier run, and may be replaced or removed: those that results.json lists.

results.json names the reports of its run with their SHA-256, so that a file that was changed since, or put there by
hand, is known to be the user's. It lists neither itself nor, by a hash, the PDFs, which carry it: see
`assess.report.pages.pdf_seal`. Versions before the list wrote the files of `BEFORE`, which count as reports next to a
results.json without it.
"""

import json
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from assess.delivery.disk import find_digest
from assess.errors import InputError
from assess.i18n import fill
from assess.report.pages.pdf_seal import is_sealed

DATA = "results.json"
BEFORE = ("report.pdf", "report.xlsx", "report.html", DATA, "items.csv", "outcomes.npz")
"""The files that versions without a list have written."""
_HEAD = 4 << 20
"""Bytes at the head of results.json within which its first two entries stand."""


def find_reports(folder: Path, wanted: Collection[str], data: str = DATA) -> frozenset[str]:
    """Return the names of the files in a folder that are an earlier run's.

    Parameters
    ----------
    folder : Path
        May be missing.
    wanted : collection of str
        Names of the files that are to be written.
    data : str
        Name of the file that lists those of the earlier run.

    Raises
    ------
    InputError
        If a folder or a file of the user's stands at one of these names, or a report was changed after it was written.
    """
    try:
        listed = read_list(folder / data)
        found = {name for name in {*wanted, *listed} if os.path.lexists(folder / name)}
        for name in sorted(found):
            _check(folder / name, name in wanted, listed, folder / data)
    except OSError as error:
        why = error.strerror or str(error)
        raise InputError(fill("{path} cannot be read: {why}.", path=error.filename or folder, why=why)) from None
    return frozenset(name for name in found if (folder / name).is_file())


def _check(path: Path, is_wanted: bool, listed: Mapping[str, str | None], data: Path) -> None:
    """Raise InputError if what stands at the name of a report is the user's."""
    digest = find_digest(path)
    if digest is None and not is_wanted:
        return  # a folder or a link that took the place of a report that is not written again
    if digest is None:
        raise InputError(
            fill("{path} is a folder or a link, where a report is to be written. Move or rename it.", path=path)
        )
    if path.name not in listed:
        raise InputError(
            fill(
                "{path} would be replaced, but it is not a report of an earlier run: no {data} next to it lists it. "
                "Move or rename it, or choose another folder for the reports.",
                path=path,
                data=data.name,
            )
        )
    known = listed[path.name]
    if known != digest if known else path.suffix == ".pdf" and not is_sealed(path, data):
        raise InputError(
            fill(
                "{path} was changed after it was written. Move or rename it to keep it, or choose another folder for "
                "the reports.",
                path=path,
            )
        )


def read_list(path: Path) -> Mapping[str, str | None]:
    """Return the reports that a results.json lists, itself among them, with their SHA-256 where it is known.

    A file of another name that begins alike serves as well. Empty if the file is missing or not of this program. Only
    its head is read: it may be large.
    """
    if path.is_symlink() or not path.is_file():
        return {}
    with path.open("rb") as file:
        head = _read_head(file.read(_HEAD).decode("utf-8", "replace"))
    origin = head.get("assess")
    if not (
        isinstance(head.get("schema"), str) and isinstance(origin, dict) and isinstance(origin.get("version"), str)
    ):
        return {}
    files = origin.get("files")
    if not isinstance(files, dict):
        return dict.fromkeys(BEFORE if path.name == DATA else ())
    plain = {
        name: digest for name, digest in files.items() if name not in (".", "..") and not set(name) & set("/\\:\0")
    }
    return {name: digest if isinstance(digest, str) else None for name, digest in plain.items()} | {path.name: None}


def _read_head(text: str) -> dict[str, Any]:
    """Return the first two entries of an object in JSON; less if they cannot be read."""
    decoder, found = json.JSONDecoder(), dict[str, Any]()
    rest = text.lstrip()
    while rest[:1] in ("{", ",") and len(found) < 2:
        try:
            name, end = decoder.raw_decode(rest[1:].lstrip())
            rest = rest[1:].lstrip()[end:].lstrip()
            value, end = decoder.raw_decode(rest.removeprefix(":").lstrip())
            rest = rest.removeprefix(":").lstrip()[end:].lstrip()
        except (ValueError, RecursionError):
            break
        found[str(name)] = value
    return found
