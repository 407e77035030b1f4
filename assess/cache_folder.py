"""Where compiled code is kept for the next process, and whether it is safe to load it from there.

Whoever can write to such a folder can have any code run as the user who loads it; so nothing is read from a folder
that others can write to, or replace.
"""

import os
import stat
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

_OTHERS = stat.S_IWGRP | stat.S_IWOTH


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
