"""Files moved into a folder one by one, so that a killed process leaves a move that can be finished.

1. The new files are in the folder `NEW` of a stage within the folder; what they replace, and what is to go, is kept in
   its folder `OLD` (by hard links, else by copies). Nothing can be seen of it yet.
2. The journal is written and moved into the folder: from here on `recover` finishes the moves.
3. The new files are moved over the old ones, and files of the earlier run that are not replaced are removed.
4. The journal is removed, then the stage.

A move that fails in step 3 is taken back: the journal gets the name of `_UNDO`, so that `recover` takes the rest back,
too, and the old files return. A file that is neither as it was nor as it is to be belongs to the user and stops all.
"""

import json
import os
import shutil
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from assess.delivery.disk import find_digest, flush_file, flush_folder, write_through
from assess.delivery.stages import JOURNALS, NEW, OLD, PREFIX, discard
from assess.errors import InputError
from assess.i18n import fill

_DO, _UNDO = JOURNALS
_ABOUT = "A run of assess was stopped while it moved files into this folder. The next run into it finishes the move."
_LONGEST = 1 << 20


@dataclass(frozen=True, slots=True)
class Move:
    """Files that are moved into a folder.

    Attributes
    ----------
    folder : Path
        Where to.
    stage : str
        Name of the stage in it.
    new, old : mapping of str to str
        SHA-256 of the files that come, and of those that are replaced or removed, by name.
    """

    folder: Path
    stage: str
    new: Mapping[str, str]
    old: Mapping[str, str]

    @property
    def path(self) -> Path:
        """The stage."""
        return self.folder / self.stage

    def begin(self) -> None:
        """Keep the old files, and write the journal."""
        for name in self.old:
            os.replace(self.folder / name, self.folder / name)  # noqa: PTH105 - on Windows fails if it is open
            _keep(self.folder / name, self.path / OLD / name)
        flush_folder(self.path / OLD)
        flush_folder(self.path / NEW)
        plan = {"about": _ABOUT, "stage": self.stage, "new": dict(self.new), "old": dict(self.old)}
        write_through(self.path / _DO, json.dumps(plan, indent=1).encode())
        (self.path / _DO).replace(self.folder / _DO)
        flush_folder(self.folder)

    def do(self) -> None:
        """Move the new files to their place, and remove the old ones that are not replaced."""
        for name in self.new:
            staged, target = self.path / NEW / name, self.folder / name
            if staged.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                staged.replace(target)
        for name in self.old.keys() - self.new.keys():
            (self.folder / name).unlink(missing_ok=True)

    def undo(self) -> None:
        """Move the old files back; called again, it goes on."""
        with suppress(FileNotFoundError):
            (self.folder / _DO).replace(self.folder / _UNDO)
        flush_folder(self.folder)
        for name in self.new:
            if not (self.path / NEW / name).exists() and name not in self.old:
                (self.folder / name).unlink(missing_ok=True)
        for name in self.old:
            kept, target = self.path / OLD / name, self.folder / name
            is_replaced = name in self.new and not (self.path / NEW / name).exists()
            if kept.exists() and (is_replaced or not target.exists()):
                kept.replace(target)

    def end(self) -> None:
        """Remove the journal: all is done, or undone."""
        flush_folder(self.folder)
        for name in JOURNALS:
            (self.folder / name).unlink(missing_ok=True)
        flush_folder(self.folder)


def plan_move(folder: Path, stage: Path, remove: Iterable[str] = ()) -> Move:
    """Plan to move what is in the folder `NEW` of a stage to `folder`, where `remove` goes if it is not replaced.

    Raises OSError if a folder stands where a file belongs.
    """
    root = stage / NEW
    new = {path.relative_to(root).as_posix(): find_digest(path) or "" for path in root.rglob("*") if path.is_file()}
    for name in new:
        if (folder / name).is_dir():
            raise IsADirectoryError(0, fill("it is a folder"), str(folder / name))
    old = {name: find_digest(folder / name) for name in sorted({*new, *remove})}
    return Move(folder, stage.name, new, {name: digest for name, digest in old.items() if digest is not None})


def _keep(path: Path, kept: Path) -> None:
    kept.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(path, kept)
    except OSError:
        shutil.copy2(path, kept)
        flush_file(kept)


def recover(folder: Path) -> None:
    """Finish the move of a process that was killed, if there is one; to be called under the folder's lock.

    Raises InputError if the journal is damaged, or a file was changed since; OSError if a file cannot be moved.
    """
    for name in JOURNALS:
        if (folder / name).is_file():
            move = _read(folder, name)
            _check(move)
            move.do() if name == _DO else move.undo()
            move.end()
            discard(move.path)


def has_journal(folder: Path) -> bool:
    """Whether a process was killed while it moved files into a folder, or is moving them now."""
    return any((folder / name).is_file() for name in JOURNALS)


def _read(folder: Path, name: str) -> Move:
    """Return the move that a journal describes; nothing leads out of the folder, which may come from someone else."""
    try:
        with (folder / name).open("rb") as file:
            found = json.loads(file.read(_LONGEST))
        del found["about"]
        move = Move(folder, **found)
        texts = [move.stage, *move.new, *move.old, *move.new.values(), *move.old.values()]
        is_sound = all(isinstance(one, str) for one in texts) and move.stage.startswith(PREFIX)
        is_sound = is_sound and "/" not in move.stage and not move.path.is_symlink()
        is_sound = is_sound and all(_is_inside(folder, one) for one in (move.stage, *move.new, *move.old))
    except (OSError, ValueError, TypeError, AttributeError, KeyError):
        is_sound = False
    if not is_sound:
        raise InputError(fill("{path} is damaged: remove it, or choose another folder.", path=folder / name))
    return move


def _is_inside(folder: Path, name: str) -> bool:
    path = PurePosixPath(name)
    is_plain = not path.is_absolute() and ".." not in path.parts and not set(name) & set("\\:\0")
    return bool(name) and is_plain and not any((folder / one).is_symlink() for one in list(path.parents)[:-1])


def _check(move: Move) -> None:
    for name in {**move.new, **move.old}:
        path = move.folder / name
        known = {move.new.get(name), move.old.get(name)} - {None}
        is_there = path.is_symlink() or path.exists()
        if is_there and find_digest(path) not in known:
            raise InputError(
                fill(
                    "{path} was changed while an earlier run was being finished. Move or rename it, then run again.",
                    path=path,
                )
            )
