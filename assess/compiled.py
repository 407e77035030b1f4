"""Functions as machine code, compiled when they are first called and kept for the next process where that is safe.

Whoever can write to the folder of compiled code can have any code run as the user who loads it; so nothing is read from
a folder that others can write to, or replace.
"""

import os
import stat
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

_Function = TypeVar("_Function", bound=Callable[..., object])
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
OPTIONS: Mapping[str, Any] = {
    "nogil": True,  # threads run side by side
    "error_model": "numpy",
    "fastmath": {"nnan", "nsz", "contract", "arcp"},  # what vector lanes need; sums keep their order
}


def compiled(function: _Function) -> _Function:
    """Compile `function` when it is first called, and keep that for the next process in the user's cache folder.

    A folder that NUMBA_CACHE_DIR names is used instead; where neither is safe, each process compiles anew.
    """
    from numba import config, njit  # a third of a second

    settings = cast("Any", config)
    before = settings.CACHE_DIR
    folder, _ = choose_folder(before)
    if folder is None:
        return cast("_Function", njit(**OPTIONS)(function))
    try:
        # numba has no argument for this folder, and takes it at this moment; so only this function is kept there.
        settings.CACHE_DIR = str(folder)
        return cast("_Function", njit(cache=True, **OPTIONS)(function))
    except (RuntimeError, OSError):
        return cast("_Function", njit(**OPTIONS)(function))
    finally:
        settings.CACHE_DIR = before


def compiled_into(function: _Function) -> _Function:
    """Compile `function` as a part of the compiled functions that call it, often; it may make no arrays.

    numba does not count references to arrays in it, which would cost more than the work of a small function.
    """
    from numba import njit

    try:
        return cast("_Function", cast("Any", njit)(_nrt=False, **OPTIONS)(function))
    except (KeyError, TypeError):  # numba does not promise to keep this option
        return cast("_Function", njit(**OPTIONS)(function))


def cache_folder() -> Path:
    """Return the user's folder for what can be made again, as each system has it."""
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local") / "assess" / "cache"
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "assess"
    return Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache") / "assess"


def choose_folder(chosen: str | None = None) -> tuple[Path | None, str]:
    """Return the folder that compiled code is kept in, None if none is safe, and what is wrong with one not used.

    `chosen` is the folder that numba has been given, "" for none; by default what NUMBA_CACHE_DIR names. Where that is
    not safe, it is the user's own, which is made for the user alone.
    """
    named = os.environ.get("NUMBA_CACHE_DIR", "") if chosen is None else chosen
    faults: list[str] = []
    for folder in (*((Path(named),) if named else ()), cache_folder()):
        fault = examine_folder(folder)
        if not fault:
            return folder, "; ".join(faults)
        faults.append(fault)
    return None, "; ".join(faults)


@cache
def examine_folder(folder: Path) -> str:
    """Return why compiled code is not kept in a folder, "" where it can be; a missing one is made."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not hasattr(os, "getuid"):
            return ""  # access rights of Windows: a profile is the user's own
        own = (folder.absolute(), folder.resolve())
        for place in dict.fromkeys([parent for one in own for parent in (one, *one.parents)]):
            found = place.stat()
            is_shared = bool(found.st_mode & stat.S_ISVTX) and place not in own
            if fault := _describe(place, found, is_shared=is_shared):
                return fault
        if not folder.stat().st_mode & (stat.S_IXGRP | stat.S_IXOTH):
            return ""  # nobody else comes in
        inside = (Path(top, name) for top, folders, files in os.walk(folder) for name in (*folders, *files))
        return next((fault for place in inside if (fault := _describe(place, place.lstat()))), "")
    except (OSError, RuntimeError) as error:  # RuntimeError: links that lead round in a circle
        return f"{folder} cannot be used: {getattr(error, 'strerror', None) or error}"


def _describe(place: Path, found: os.stat_result, *, is_shared: bool = False) -> str:
    """Return how others could change a place; in a shared folder, as /tmp is, each owns what they make."""
    if found.st_uid not in (0, os.getuid()):
        return f"{place} belongs to another user"
    if stat.S_ISLNK(found.st_mode):
        return f"{place} is a link"
    open_to = found.st_mode & _OTHERS
    if not open_to or is_shared:
        return ""
    if open_to == stat.S_IWGRP:  # many systems make a group for each user, with the user alone as its member
        import grp
        import pwd

        with suppress(KeyError):
            user, group = pwd.getpwuid(os.getuid()), grp.getgrgid(found.st_gid)
            is_own = found.st_gid == user.pw_gid and group.gr_name == user.pw_name
            if is_own and not {*group.gr_mem} - {user.pw_name}:
                return ""
    return f"others can write to {place}"
