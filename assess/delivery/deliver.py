"""What is in a stage brought to its place, whole or not at all: a folder of reports, or some files."""

import hashlib
import os
import shutil
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from assess.delivery.folders import NEW, OLD, locked, moving, staging
from assess.errors import OutputError
from assess.i18n import fill
from assess.progress import SILENT, Progress


def name_aside(data: str) -> tuple[str, str]:
    """Return how the lists of the earlier and of the new run are called while files are moved: hidden files."""
    stem, dot, ending = data.rpartition(".")
    return f".{stem}.old{dot}{ending}", f".{stem}.new{dot}{ending}"


def is_unfinished(folder: Path, data: str) -> bool:
    """Whether a process was killed while it moved files into a folder, which has no list of them since."""
    return not (folder / data).exists() and any((folder / name).is_file() for name in name_aside(data))


def explain_unfinished(folder: Path) -> str:
    """Return what is said of such a folder."""
    return fill(
        "{folder} is unfinished: a run was stopped while it moved its files there. Run it again into this folder.",
        folder=folder,
    )


class Written(dict[str, Path]):
    """The files that were written, by format; `removed` are those of an earlier run that were not replaced."""

    def __init__(self, files: Mapping[str, Path], removed: Sequence[Path] = ()) -> None:
        super().__init__(files)
        self.removed = tuple(removed)


@contextmanager
def stage_for(folder: Path) -> Iterator[Path]:
    """Make the stage of what is to be in a folder: in it, or, where it does not exist yet, next to it."""
    place = folder.resolve()
    with staging(next(one for one in (place, *place.parents) if one.is_dir())) as stage:
        yield stage


def deliver(
    stage: Path, folder: Path, find_old: Callable[[Path], Collection[str]], data: str, progress: Progress = SILENT
) -> list[str]:
    """Bring what is in the folder `NEW` of a stage to a folder, which is made if missing; return what is gone from
    there. `find_old` returns the names of files there that are replaced or removed, called while the folder is locked;
    whatever it raises leaves all as it was. `data` is the new file that lists the others. Raises OSError if a file
    cannot be moved, and all is as it was; OutputError if another run writes to the folder.
    """
    flush_folder(stage / NEW)
    target = folder.resolve()
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            with moving():
                (stage / NEW).rename(target)
                flush_folder(target.parent)
        except OSError:  # another run was faster
            target.mkdir(exist_ok=True)
        else:
            return []
    with locked(target, progress):
        old = frozenset(find_old(target))
        progress.check()
        aside, coming = (target / name for name in name_aside(data))
        names = sorted(path.name for path in (stage / NEW).iterdir() if path.name != data)
        gone = sorted(name for name in old if name not in names and name != data)
        with moving(), _taken_back(stage, target, [*names, *gone, data, aside.name, coming.name]):
            if is_unfinished(target, data):  # its files may be of two runs: after a second kill they would be of three
                for name in old:
                    (target / name).unlink(missing_ok=True)
            (stage / NEW / data).replace(coming)
            if (target / data).exists():
                (target / data).replace(aside)
            flush_folder(target)
            for name in names:
                _bring(stage / NEW / name, target / name)
            for name in gone:
                (target / name).unlink(missing_ok=True)
            flush_folder(target)
            coming.replace(target / data)
            aside.unlink(missing_ok=True)
            flush_folder(target)
        return gone


@contextmanager
def _taken_back(stage: Path, target: Path, names: Sequence[str]) -> Iterator[None]:
    """Keep what stands at some names in the folder `OLD` of a stage, and put it back if anything is raised."""
    kept = stage / OLD
    kept.mkdir(exist_ok=True)
    there = [name for name in names if (target / name).is_file()]
    for name in there:
        os.replace(target / name, target / name)  # noqa: PTH105 - on Windows fails if it is open
        try:
            os.link(target / name, kept / name)
        except OSError:  # a file system without links
            shutil.copy2(target / name, kept / name)
            flush_file(kept / name)
    try:
        yield
    except BaseException:
        for name in names:
            with suppress(OSError):
                if name in there:
                    (kept / name).replace(target / name)
                else:
                    (target / name).unlink(missing_ok=True)
        raise


def _bring(path: Path, to: Path) -> None:
    if to.is_dir():
        raise IsADirectoryError(0, fill("it is a folder"), str(to))
    path.replace(to)


def explain_fault(folder: Path, error: OSError, files: Collection[str]) -> OutputError:
    """Return the error of `files` that could not be brought to a folder, from what the system refused."""
    why = error.strerror or str(error)
    where = Path(error.filename2 or error.filename or folder)
    if where.name in files:
        path = folder / where.name
        return OutputError.about(
            "{path} could not be replaced: {why}. Is it open in another program?", path=path, why=why
        )
    return OutputError.about("{folder} cannot be written to: {why}.", folder=folder, why=why)


def save(files: Mapping[Path, bytes]) -> None:
    """Write files, whole or none of them; a folder below one that exists is made if missing. Raises OSError if one
    cannot be written, which `filename` names, or its folder; OutputError if another run writes to a folder.
    """
    made: list[Path] = []
    try:
        with ExitStack() as stack:
            stages: dict[Path, Path] = {}
            for path, data in files.items():
                folder = path.parent.resolve()
                if folder not in stages:
                    missing = [one for one in (folder, *folder.parents) if not one.exists()][::-1]
                    folder.mkdir(parents=True, exist_ok=True)
                    made += missing
                    stages[folder] = stack.enter_context(staging(folder))
                write_through(stages[folder] / NEW / path.name, data)
            _place(stages, stack)
    except BaseException:
        for folder in reversed(made):
            with suppress(OSError):
                folder.rmdir()
        raise


@contextmanager
def saving(path: Path) -> Iterator[Path]:
    """Yield where to write a file, which then comes to its place whole, if nothing was raised. OSError as in `save`."""
    folder = path.parent.resolve()
    with ExitStack() as stack:
        stage = stack.enter_context(staging(folder))
        yield stage / NEW / path.name
        flush_file(stage / NEW / path.name)
        _place({folder: stage}, stack)


def _place(stages: Mapping[Path, Path], stack: ExitStack) -> None:
    if sum(1 for stage in stages.values() for _ in (stage / NEW).iterdir()) > 1:
        for folder in sorted(stages):
            stack.enter_context(locked(folder))
    with moving(), ExitStack() as kept:
        for folder, stage in stages.items():
            kept.enter_context(_taken_back(stage, folder, [path.name for path in (stage / NEW).iterdir()]))
        for folder, stage in stages.items():
            for path in sorted((stage / NEW).iterdir()):
                _bring(path, folder / path.name)
            flush_folder(folder)


# ---------------------------------------------------------------- bytes that are on the disk


def write_through(path: Path, data: bytes) -> None:
    """Write a file down to the disk, so that a full disk shows here; its folder is made if missing.

    Raises OSError if it cannot be written; `filename` names it, which the system leaves out where the disk is full.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with path.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from None


def flush_file(path: Path) -> None:
    """Have the system put a file's bytes on the disk, where a full disk shows."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def flush_folder(path: Path) -> None:
    """Have the system put a folder's entries on the disk, where it can: Windows cannot open a folder."""
    with suppress(OSError):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def find_digest(path: Path) -> str | None:
    """Return the SHA-256 of a file; None if it is missing, a folder or a link. OSError if it cannot be read."""
    if path.is_symlink() or not path.is_file():
        return None
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
