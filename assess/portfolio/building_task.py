"""One building of a portfolio: read, completed from the index, put on the ground motion, assessed, written as a part.

What it gives depends on nothing but the building itself and the settings. Whatever goes wrong ends in a building that
is `skipped` with the reason.
"""

import hashlib
import time
import traceback
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from assess.delivery.disk import find_digest
from assess.errors import AssessError, Problem, WorkbookError
from assess.i18n import fill
from assess.model import Inventory
from assess.motion.site_ground import GroundField
from assess.portfolio.building_rows import build_skipped, build_tables
from assess.portfolio.part_files import Part, find_key, find_place, is_done, read_part, write_part, write_whole
from assess.portfolio.sources import Source
from assess.settings import Settings
from assess.version import find_code


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One building to assess.

    Parameters
    ----------
    source : Source
        The building.
    settings : Settings
        Of the run; `city` is set.
    ground : GroundField, optional
        The ground motion; it pickles as its file and hash, and is read once a process.
    out : Path
        The folder of the results.
    """

    source: Source
    settings: Settings
    ground: GroundField | None
    out: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """What a task tells of its building; the rest is in its part.

    Parameters
    ----------
    path, key, status : str
        As in the part.
    pieces : int
        Pieces that were assessed.
    seconds : float
        Time that it took [s].
    is_kept : bool
        Whether the part of an earlier run was there.
    part : Part, optional
        The part itself where it could not be written.
    content : str
        SHA-256 [hex] of its workbook; "" where there is none, or it could not be read.
    """

    path: str
    key: str
    status: str
    pieces: int = 0
    seconds: float = 0.0
    is_kept: bool = False
    part: Part | None = None
    content: str = ""


def run_task(task: Task) -> Summary:
    """Assess a building and write its part, unless it is there already."""
    start = time.monotonic()
    data = _read_workbook(task.source)
    content = None if data is None else hashlib.sha256(data).hexdigest()
    return replace(_run(task, _find_key(task, content), data, start), content=content or "")


def _run(task: Task, key: str, data: bytes | None, start: float) -> Summary:
    known = read_part(task.out, key)
    folder = None if task.source.file is None else task.source.file.parent
    if known is not None and is_done(known, folder):
        return _sum_up(known, start, is_kept=True)
    part = _assess_surely(task, key, data)
    try:
        write_part(task.out, part)
    except OSError as error:
        why = error.strerror or str(error)
        fault = fill("what was found could not be written to {folder}: {why}.", folder=task.out, why=why)
        fix = fill("Make room there and run the same command again: the other buildings are kept.")
        lost = skip(task.source, key, [Problem("error", "", "", fault, fix)])
        return replace(_sum_up(lost, start), part=lost)
    return _sum_up(part, start)


def skip(source: Source, key: str, problems: list[Problem], inventory: str | None = None) -> Part:
    """Return the part of a building that is not assessed, with the reasons."""
    kind = "assumed" if source.kind == "assumed" else inventory
    tables = build_skipped(source.path, problems, source.index, kind)
    return Part(path=source.path, key=key, status="skipped", tables=tables)


def _sum_up(part: Part, start: float, *, is_kept: bool = False) -> Summary:
    return Summary(
        path=part.path,
        key=part.key,
        status=part.status,
        pieces=len(part.rows("pieces")),
        seconds=time.monotonic() - start,
        is_kept=is_kept,
    )


def _read_workbook(source: Source) -> bytes | None:
    """Return the bytes of the workbook of a building; None where it has none, or where they cannot be read."""
    if source.file is None or source.refused:
        return None
    from assess.workbook.open import read_file

    try:
        return read_file(source.file)
    except (AssessError, OSError):
        return None


def _find_key(task: Task, content: str | None) -> str:
    source = task.source
    ground = None if task.ground is None else (type(task.ground).__name__, task.ground.file, task.ground.sha256)
    row = None
    if source.index is not None:  # a row may move in the index
        row = {name: getattr(source.index, name) for name in source.index.__slots__} | {"line": 0}
    return find_key(source.path, source.kind, content, row, task.settings.as_record(), ground, find_code())


# ---------------------------------------------------------------- a building


def _assess_surely(task: Task, key: str, data: bytes | None) -> Part:
    """Return the part of a building, skipped with the reason if anything is wrong with it."""
    source = task.source
    if source.refused:
        return skip(source, key, [Problem("error", "", "", source.refused, source.fix)])
    try:
        return _assess(task, key, data)
    except WorkbookError as error:
        return skip(source, key, list(error.problems))
    except AssessError as error:
        return skip(source, key, [Problem("error", "", "", error.message)])
    except MemoryError:
        fault = fill("the memory of this machine does not suffice for it.")
        return skip(source, key, [Problem("error", "", "", fault, fill("Run fewer jobs at once."))])
    except Exception as error:  # whatever is wrong with one building, the others are assessed
        with suppress(OSError):
            text = traceback.format_exc()
            write_whole(find_place(task.out, key).with_suffix(".txt"), text.encode("utf-8", "backslashreplace"))
        fault = fill("it cannot be assessed: an unforeseen error ({kind}) in this program.", kind=type(error).__name__)
        fix = fill("Please report it, with the file {file}.", file=f"{find_place(Path(), key).with_suffix('.txt')}")
        return skip(source, key, [Problem("error", "", "", fault, fix)])


def _assess(task: Task, key: str, data: bytes | None) -> Part:
    from assess.pipeline.draw_sums import sum_draws
    from assess.pipeline.run import build_results, compute
    from assess.portfolio.building_inventory import read_building

    origin, inventory = read_building(task.source, data, task.ground)
    assessment = compute(inventory, task.settings, jobs=1)
    results = build_results(assessment, figures=False)
    sums = sum_draws(assessment, results)
    draws = {}
    if sums.falls is not None and sums.people_blocked is not None and sums.routes_blocked is not None:
        draws = {
            "falls": sums.falls.tolist(),
            "people_blocked": sums.people_blocked.tolist(),
            "routes_blocked": sums.routes_blocked.tolist(),
        }
    return Part(
        path=task.source.path,
        key=key,
        status="assessed",
        tables=build_tables(origin, inventory, results, sums),
        draws=draws,
        files=_list_files(inventory, task.source.file),
    )


def _list_files(inventory: Inventory, file: Path | None) -> Mapping[str, str]:
    """Return the files that a workbook names, relative to its folder, with their SHA-256."""
    if file is None:
        return {}
    folder = file.resolve().parent
    named = {name.replace("\\", "/"): digest for name, digest in inventory.files.items()}
    pictures = [inventory.building.logo, *(floor.plan.path for floor in inventory.floors if floor.plan)]
    paths = [one for one in pictures if one is not None] + [folder / name for name in inventory.photos]
    for path in paths:
        if digest := find_digest(path):
            named[path.relative_to(folder).as_posix()] = digest
    return dict(sorted(named.items()))
