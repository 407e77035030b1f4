"""One building of a portfolio: read, completed from the index, put on the ground motion, assessed, written as a part.

What it gives depends on nothing but the building itself and the settings. Whatever goes wrong ends in a building that
is `skipped` with the reason.

A part is what was found of one building, in a file whose name is its key: that is how a run goes on where it was. It is
compressed JSON, which carries a checksum: a part that was cut off or damaged is computed again. It is written under a
temporary name and renamed, so that a process that is killed leaves no half of a part. It is not flushed to the disk:
what a power cut takes is computed again.
"""

import gzip
import hashlib
import json
import os
import traceback
import zlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from assess.delivery.deliver import find_digest
from assess.errors import AssessError, Problem, WorkbookError
from assess.i18n import fill
from assess.motion.site_ground import GroundField
from assess.portfolio.building_rows import build_skipped, build_tables
from assess.portfolio.sources import Source
from assess.portfolio.table_schemas import TABLES
from assess.settings import Settings
from assess.version import find_code

FOLDER = "parts"  # folder of the parts in the folder of the results
ENDING = ".part"
WRITING = ".writing-"


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What was found of one building: rows of the tables in the order of their columns, and by what it was computed.

    `status` is one of `STATUSES`; `draws`, by columns of the table draws, are empty where nothing was simulated in
    common draws; `files` that the workbook names, relative to its folder, have their SHA-256.
    """

    path: str
    key: str
    status: str
    tables: Mapping[str, list[list[Any]]]
    draws: Mapping[str, list[int]] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)

    def rows(self, name: str) -> list[list[Any]]:
        """Return the rows of a table, draws included."""
        if name != "draws":
            return self.tables.get(name, [])
        columns = [self.draws[field.key] for field in TABLES["draws"][2:]] if self.draws else []
        return [[self.path, number, *row] for number, row in enumerate(zip(*columns, strict=True))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One building to assess into the folder `out`; its ground motion pickles as file and hash, read once a process."""

    source: Source
    settings: Settings
    ground: GroundField | None
    out: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """What a task tells of its building: the rest is in its part, which is here only where it could not be written.

    `is_kept` is whether that of an earlier run was there, `content` the SHA-256 [hex] of its workbook, "" without one.
    """

    path: str
    key: str
    status: str
    is_kept: bool = False
    part: Part | None = None
    content: str = ""


def run_task(task: Task) -> Summary:
    """Assess a building and write its part, unless it is there already."""
    from assess.workbook.open import read_file

    source, data, content = task.source, None, None
    if source.file is not None and not source.refused:
        with suppress(AssessError, OSError):  # reported when the building is assessed
            data = read_file(source.file)
            content = hashlib.sha256(data).hexdigest()
    ground = None if task.ground is None else (type(task.ground).__name__, task.ground.file, task.ground.sha256)
    row = None if source.index is None else asdict(replace(source.index, line=0))  # a row may move in the index
    key = find_key(source.path, source.kind, content, row, task.settings.as_record(), ground, find_code())
    lost, is_kept = None, False
    part = read_part(task.out, key)
    if part is not None and part.status == "assessed":  # else tried again: a file may be there, or memory free now
        with suppress(OSError):  # the files that its workbook names are to be the same
            is_kept = all(
                source.file is not None and find_digest(source.file.parent / name) == digest
                for name, digest in part.files.items()
            )
    if part is None or not is_kept:
        part = _assess(task, key, data)
        try:
            write_part(task.out, part)
        except OSError as error:
            why = error.strerror or str(error)
            fault = fill("what was found could not be written to {folder}: {why}.", folder=task.out, why=why)
            fix = fill("Make room there and run the same command again: the other buildings are kept.")
            part = lost = _skip(source, key, fault, fix)
    return Summary(path=part.path, key=key, status=part.status, is_kept=is_kept, part=lost, content=content or "")


def give_up(task: Task) -> Summary:
    """Return the summary of a building that every process died of."""
    fault = fill(
        "every process that assessed it was ended by the system: its workbook may need more memory than there is."
    )
    fix = fill("Assess it by itself with `assess run`, on a machine with more memory.")
    return Summary(path=task.source.path, key="", status="skipped", part=_skip(task.source, "", fault, fix))


def _skip(source: Source, key: str, fault: str, fix: str = "", problems: Sequence[Problem] = ()) -> Part:
    tables = build_skipped(source, problems or [Problem("error", "", "", fault, fix)])
    return Part(path=source.path, key=key, status="skipped", tables=tables)


def _assess(task: Task, key: str, data: bytes | None) -> Part:
    source = task.source
    if source.refused:
        return _skip(source, key, source.refused, source.fix)
    try:
        from assess.pipeline.draw_sums import sum_draws
        from assess.pipeline.run import build_results, compute
        from assess.portfolio.building_inventory import read_building

        origin, inventory = read_building(source, data, task.ground)
        assessment = compute(inventory, task.settings, jobs=1)
        results = build_results(assessment, figures=False)
        sums = sum_draws(assessment, results)
        drawn = {"falls": sums.falls, "people_blocked": sums.people_blocked, "routes_blocked": sums.routes_blocked}
        known = {name: values.tolist() for name, values in drawn.items() if values is not None}
        named: dict[str, str] = {}  # by the workbook, relative to its folder, with SHA-256
        if source.file is not None:
            folder = source.file.resolve().parent
            named = {name.replace("\\", "/"): digest for name, digest in inventory.files.items()}
            pictures = [inventory.building.logo, *(floor.plan.path for floor in inventory.floors if floor.plan)]
            for path in filter(None, (*pictures, *(folder / name for name in inventory.photos))):
                if digest := find_digest(path):
                    named[path.relative_to(folder).as_posix()] = digest
        return Part(
            path=source.path, key=key, status="assessed",
            tables=build_tables(source, origin, inventory, results, sums),
            draws=known if len(known) == len(drawn) else {}, files=dict(sorted(named.items())),
        )  # fmt: skip
    except WorkbookError as error:
        return _skip(source, key, "", problems=error.problems)
    except AssessError as error:
        return _skip(source, key, error.message)
    except MemoryError:
        fault = fill("the memory of this machine does not suffice for it.")
        return _skip(source, key, fault, fill("Run fewer jobs at once."))
    except Exception as error:  # whatever is wrong with one building, the others are assessed
        trace = find_place(Path(), key).with_suffix(".txt")
        with suppress(OSError):
            _write_whole(task.out / trace, traceback.format_exc().encode("utf-8", "backslashreplace"))
        fault = fill("it cannot be assessed: an unforeseen error ({kind}) in this program.", kind=type(error).__name__)
        return _skip(source, key, fault, fill("Please report it, with the file {file}.", file=f"{trace}"))


def find_key(*parts: object) -> str:
    """Return the SHA-256 [hex] of what a part depends on: texts, numbers, None, mappings and sequences of these."""
    text = json.dumps(parts, sort_keys=True, ensure_ascii=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def find_place(out: Path, key: str) -> Path:
    """Return where the part of a key lies: in one of 256 folders, as file systems dislike many files in one."""
    return out / FOLDER / key[:2] / f"{key}{ENDING}"


def write_part(out: Path, part: Part) -> None:
    """Write a part; OSError if it cannot be written."""
    record = {name: getattr(part, name) for name in Part.__slots__}
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    _write_whole(find_place(out, part.key), gzip.compress(text.encode("utf-8", "replace"), compresslevel=6, mtime=0))


def _write_whole(place: Path, data: bytes) -> None:
    """Write a file under another name and rename it; OSError if it cannot be written, and nothing is left then."""
    place.parent.mkdir(parents=True, exist_ok=True)
    writing = place.with_name(f"{WRITING}{os.getpid()}-{os.urandom(4).hex()}")
    try:
        writing.write_bytes(data)
        writing.replace(place)
    except BaseException:
        with suppress(OSError):
            writing.unlink()
        raise


def read_part(out: Path, key: str) -> Part | None:
    """Return the part of a key; None where there is none, it cannot be read, or tables have other columns now."""
    try:
        part = Part(**json.loads(gzip.decompress(find_place(out, key).read_bytes())))
    except (OSError, EOFError, zlib.error, ValueError, TypeError, RecursionError):
        return None
    widths = {name: len(columns) for name, columns in TABLES.items() if name != "draws"}
    is_whole = part.key == key and part.status != ""
    is_whole = is_whole and all(len(row) == width for name, width in widths.items() for row in part.rows(name))
    return part if is_whole else None
