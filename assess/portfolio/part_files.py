"""Parts: what was found of one building, in a file whose name is its key. That is how a run goes on where it was.

A part is compressed JSON, which carries a checksum: one that was cut off or damaged is computed again. It is written
under a temporary name and renamed, so that a process that is killed leaves no half of a part. It is not brought down to
the disk: what a power cut takes is computed again.
"""

import gzip
import hashlib
import json
import os
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from assess.delivery.disk import find_digest
from assess.portfolio.table_schemas import TABLES

FOLDER = "parts"
"""Folder of the parts in the folder of the results."""
ENDING = ".part"
_COMPRESSION = 6
_WRITING = ".writing-"

Row = list[Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What was found of one building.

    Parameters
    ----------
    path : str
        The building, as in the tables.
    key : str
        By what it was computed.
    status : str
        One of `assess.portfolio.table_schemas.STATUSES`.
    tables : mapping of str to lists of rows
        Rows of buildings, pieces, routes and problems, in the order of the columns of `TABLES`.
    draws : mapping of str to lists of whole numbers
        By the column of the table draws; empty where nothing was simulated in common draws.
    files : mapping of str to str
        Files that the workbook names, relative to its folder, with their SHA-256.
    """

    path: str
    key: str
    status: str
    tables: Mapping[str, list[Row]]
    draws: Mapping[str, list[int]] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)

    def rows(self, name: str) -> list[Row]:
        """Return the rows of a table, draws included."""
        if name != "draws":
            return self.tables.get(name, [])
        columns = [self.draws[column.name] for column in TABLES["draws"][2:]] if self.draws else []
        return [[self.path, number, *row] for number, row in enumerate(zip(*columns, strict=True))]


def find_key(*parts: object) -> str:
    """Return the SHA-256 [hex] of what a part depends on: texts, numbers, None, mappings and sequences of these."""
    text = json.dumps(parts, sort_keys=True, ensure_ascii=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def find_place(out: Path, key: str) -> Path:
    """Return where the part of a key lies: in one of 256 folders, as file systems dislike many files in one."""
    return out / FOLDER / key[:2] / f"{key}{ENDING}"


def write_part(out: Path, part: Part) -> None:
    """Write a part; OSError if it cannot be written."""
    record = {"path": part.path, "key": part.key, "status": part.status, "tables": part.tables, "draws": part.draws,
              "files": part.files}  # fmt: skip
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    write_whole(find_place(out, part.key), gzip.compress(text.encode("utf-8", "replace"), _COMPRESSION, mtime=0))


def write_whole(place: Path, data: bytes) -> None:
    """Write a file under another name and rename it; OSError if it cannot be written, and nothing is left then."""
    place.parent.mkdir(parents=True, exist_ok=True)
    writing = place.with_name(f"{_WRITING}{os.getpid()}-{os.urandom(4).hex()}")
    try:
        writing.write_bytes(data)
        writing.replace(place)
    except BaseException:
        with suppress(OSError):
            writing.unlink()
        raise


def read_part(out: Path, key: str) -> Part | None:
    """Return the part of a key; None where there is none, or it cannot be read."""
    try:
        record = json.loads(gzip.decompress(find_place(out, key).read_bytes()))
        part = Part(**record)
    except (OSError, EOFError, zlib.error, ValueError, TypeError, RecursionError):
        return None
    return part if part.key == key and _is_whole(part) else None


def _is_whole(part: Part) -> bool:
    """Whether every row has the columns that tables have now."""
    return part.status != "" and all(
        len(row) == len(columns) for name, columns in TABLES.items() if name != "draws" for row in part.rows(name)
    )


def is_done(part: Part | None, folder: Path | None) -> bool:
    """Whether a part need not be computed again.

    It was assessed, and the files that its workbook names are what they were. What was skipped is tried again: a file
    may have been put there, or memory be free now.
    """
    if part is None or part.status != "assessed":
        return False
    with suppress(OSError):
        return all(folder is not None and find_digest(folder / name) == found for name, found in part.files.items())
    return False


def sweep_parts(out: Path) -> None:
    """Remove what killed processes have left half written; nobody else may write to the folder."""
    for path in (out / FOLDER).glob(f"*/{_WRITING}*"):
        with suppress(OSError):
            path.unlink()
