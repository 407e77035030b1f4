"""What is in a stage brought to its place, whole or not at all: a folder of reports, or some files."""

import os
import shutil
import stat
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from assess.delivery.disk import flush_file, flush_folder, write_through
from assess.delivery.folder_lock import locked
from assess.delivery.moves import Move, has_journal, plan_move, recover
from assess.delivery.stages import NEW, note_exchange, staging
from assess.delivery.traces import moving
from assess.errors import OutputError
from assess.i18n import fill
from assess.progress import SILENT, Progress

# ---------------------------------------------------------------- a folder

_AT_FDCWD, _RENAME_EXCHANGE, _RENAME_SWAP = -100, 2, 2


@contextmanager
def stage_for(folder: Path) -> Iterator[Path]:
    """Make the stage of what is to be in a folder, which need not exist: beside it, or in it if that cannot be."""
    with ExitStack() as stack:
        stage = None
        if not folder.exists() or (can_exchange() and _is_plain(folder)):
            with suppress(OSError):
                stage = stack.enter_context(staging(_find_existing(folder.resolve().parent)))
        yield stage or stack.enter_context(staging(_find_existing(folder.resolve())))


def _find_existing(folder: Path) -> Path:
    return next(one for one in (folder, *folder.parents) if one.is_dir())


def deliver(
    stage: Path, folder: Path, find_old: Callable[[Path], Collection[str]], progress: Progress = SILENT
) -> None:
    """Bring what is in the folder `NEW` of a stage to a folder, which is made if missing.

    Parameters
    ----------
    stage : Path
        From `stage_for`.
    folder : Path
        Where to.
    find_old : callable
        Returns the names of the files in the folder that are an earlier run's, which are replaced or removed; whatever
        it raises leaves all as it was. Called while the folder is locked.
    progress : Progress
        Checked while another run is waited for.

    Raises
    ------
    OSError
        If a file cannot be moved; all is as it was.
    InputError
        If a file of a move that was killed was changed since.
    OutputError
        If another run writes to the folder.
    """
    flush_folder(stage / NEW)
    target = folder.resolve()
    if not target.exists() and _put(stage / NEW, target):
        return
    with locked(target, progress):
        finish_move(target)
        old = frozenset(find_old(target))
        progress.check()
        with moving():
            if not _swap(stage, target, old):
                _move(stage, target, old)


def finish_move(folder: Path) -> None:
    """Finish the move of a process that was killed, if there is one, under the folder's lock."""
    if has_journal(folder):
        with moving():
            recover(folder)


def check_moves(folder: Path) -> None:
    """Finish the move of a process that was killed, if there is one."""
    if has_journal(folder):
        with locked(folder):
            finish_move(folder)


def explain_fault(folder: Path, error: OSError, files: Collection[str]) -> OutputError:
    """Return the error of `files` that could not be brought to a folder, from what the system refused."""
    why = error.strerror or str(error)
    where = Path(error.filename2 or error.filename or folder)
    if where.name in files:
        path = folder / where.name
        return OutputError(
            fill("{path} could not be replaced: {why}. Is it open in another program?", path=path, why=why)
        )
    return OutputError(fill("{folder} cannot be written to: {why}.", folder=folder, why=why))


def _put(new: Path, target: Path) -> bool:
    """Give a folder its name, which nothing has; if that cannot be, make a folder of this name and return False."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with moving():
            new.rename(target)
            flush_folder(target.parent)
    except OSError:  # another file system, or another run was faster
        target.mkdir(exist_ok=True)
        return False
    return True


def _swap(stage: Path, target: Path, old: Collection[str]) -> bool:
    """Exchange the folder if it holds old files alone; False if it cannot be, and then nothing has changed."""
    new = stage / NEW
    held = {path.name for path in target.iterdir()}
    if not (held <= set(old) and can_exchange() and _is_alike(target, new) and not _is_stood_in(target)):
        return False
    new.chmod(stat.S_IMODE(target.stat().st_mode))
    note_exchange(stage, {*held, *(path.name for path in new.iterdir())})
    if not exchange(new, target):
        return False
    flush_folder(target.parent)
    for path in new.iterdir():
        if path.name not in held and not (target / path.name).exists():  # it came in between
            path.rename(target / path.name)
    return True


def _is_plain(folder: Path) -> bool:
    """Whether another folder in its place would have the same owner and rights; this user's, without special bits."""
    try:
        found, parent = folder.stat(), folder.resolve().parent.stat()
        attributes = os.listxattr(folder) if hasattr(os, "listxattr") else []
    except OSError:
        return False
    is_ours = found.st_uid == os.geteuid() and found.st_dev == parent.st_dev
    special = stat.S_ISUID | stat.S_ISGID | stat.S_ISVTX
    return is_ours and not found.st_mode & special and not any("posix_acl" in name for name in attributes)


def _is_alike(folder: Path, other: Path) -> bool:
    """Whether a folder can stand in for another one: the same file system, owner, group and extended attributes."""
    try:
        one, two = folder.stat(), other.stat()
        attributes = [sorted(os.listxattr(each)) for each in (folder, other)] if hasattr(os, "listxattr") else [[], []]
    except OSError:
        return False
    same = (one.st_dev, one.st_uid, one.st_gid) == (two.st_dev, two.st_uid, two.st_gid)
    return _is_plain(folder) and same and attributes[0] == attributes[1]


def _is_stood_in(folder: Path) -> bool:
    """Whether a process works in a folder, as far as can be known: it would be left in one that is removed."""
    for place in (Path(), *Path("/proc").glob("[0-9]*/cwd")):
        with suppress(OSError):
            if place.samefile(folder):
                return True
    return False


def _move(stage: Path, target: Path, old: Collection[str]) -> None:
    with ExitStack() as stack:
        inside = stage if stage.parent == target else stack.enter_context(staging(target))
        if inside != stage:
            for path in (stage / NEW).iterdir():
                _bring(path, inside / NEW / path.name)
        _move_all([plan_move(target, inside, old)])


def _bring(path: Path, to: Path) -> None:
    """Move a file of a stage into another one: by name, or as a copy to another file system."""
    try:
        path.rename(to)
    except OSError:
        shutil.copyfile(path, to)
        flush_file(to)


def _move_all(moves: Collection[Move]) -> None:
    """Move the files of several folders; if one move fails, all are taken back."""
    begun: list[Move] = []
    try:
        for move in moves:
            begun.append(move)
            move.begin()
        for move in moves:
            move.do()
    except BaseException:
        for move in begun:
            if has_journal(move.folder):
                move.undo()
                move.end()
        raise
    for move in moves:
        move.end()


# ---------------------------------------------------------------- some files


def save(files: Mapping[Path, bytes]) -> None:
    """Write files, whole or none of them; a folder below one that exists is made if missing.

    Raises
    ------
    OSError
        If one cannot be written; all is as it was. `filename` names it, or its folder.
    OutputError
        If another run writes to a folder.
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
    """Bring the files of stages to their folders; a single one needs no journal."""
    staged = [(folder, path) for folder, stage in stages.items() for path in (stage / NEW).iterdir()]
    if len(staged) == 1:
        ((folder, path),) = staged
        with moving():
            path.replace(folder / path.name)
            flush_folder(folder)
        return
    for folder in sorted(stages):
        stack.enter_context(locked(folder))
        finish_move(folder)
    with moving():
        _move_all([plan_move(folder, stage) for folder, stage in stages.items()])


def can_exchange() -> bool:
    """Whether this system has such a call; a file system may refuse it."""
    return sys.platform in ("linux", "darwin")


def exchange(one: Path, other: Path) -> bool:
    """Exchange two folders; False if the system or the file system cannot, and then nothing has changed.

    Linux: renameat2 (man 2 rename; since 3.15). macOS: renamex_np (man 2 renamex_np; since 10.12, on APFS).
    """
    if not can_exchange():
        return False
    import ctypes

    try:
        library = ctypes.CDLL(None, use_errno=True)
        first, second = os.fsencode(one), os.fsencode(other)
        if sys.platform == "darwin":
            return int(library.renamex_np(first, second, _RENAME_SWAP)) == 0
        return int(library.renameat2(_AT_FDCWD, first, _AT_FDCWD, second, _RENAME_EXCHANGE)) == 0
    except (AttributeError, OSError):  # a C library that is older than the call
        return False
