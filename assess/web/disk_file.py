"""The workbook's own file: read, watched for changes by other programs, and replaced as a whole."""

import errno
import hashlib
import os
import shutil
import stat
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from assess.delivery.deliver import flush_folder, write_through
from assess.delivery.folders import NEW, staging
from assess.errors import OutputError
from assess.i18n import fill
from assess.web.request_errors import CONFLICT, RequestError
from assess.workbook.open import read_file

IN_USE = frozenset((errno.EACCES, errno.EBUSY, errno.ETXTBSY))
"""What systems answer where another program holds a file open; rights have been looked at before."""
FULL = frozenset((errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)))


class ChangedOutsideError(RequestError):
    """The file was changed by another program since it was read; it is left as it is."""

    def __init__(self, path: Path) -> None:
        text = fill("{name} was changed by another program: read it again, or download your changes.", name=path.name)
        super().__init__(text, CONFLICT)


def find_hash(data: bytes) -> str:
    """Return the SHA-256 of bytes."""
    return hashlib.sha256(data).hexdigest()


@dataclass(slots=True)
class DiskFile:
    """A workbook on the disk, and what it held when it was last read or saved.

    Where `path` is a link, the file that it leads to is replaced, and the link stays.
    """

    path: Path
    digest: str = ""
    signature: tuple[int, ...] = ()

    def read(self) -> bytes:
        """Return the bytes; raises WorkbookError where they cannot be read."""
        self.signature = self._look()
        data = read_file(self.path)
        self.digest = find_hash(data)
        return data

    def is_changed(self) -> bool:
        """Tell whether it holds other bytes than those last read or saved; a file that is gone has not changed."""
        found = self._look()
        if not found or found == self.signature:
            return False
        try:
            is_same = find_hash(self.path.read_bytes()) == self.digest
        except OSError:
            return False
        if is_same:
            self.signature = found
        return not is_same

    def replace(self, data: bytes, begin: Callable[[str], None] = lambda _digest: None) -> None:
        """Replace it by other bytes, whole or not at all; its access rights stay. `begin` takes their digest before.

        Raises ChangedOutsideError if it holds other bytes than those last read or saved; OutputError if it cannot be
        written, with the reason.
        """
        try:
            target = self.path.resolve(strict=True)
            mode = stat.S_IMODE(target.stat().st_mode)
        except (OSError, RuntimeError):
            raise OutputError.about(
                "{name} is no longer in its folder: put it back, or download your version.", name=self.path.name
            ) from None
        if hindrance := self.find_hindrance():
            raise OutputError(hindrance)
        if self.is_changed():
            raise ChangedOutsideError(self.path)
        try:
            with staging(target.parent) as stage:
                staged = stage / NEW / target.name
                write_through(staged, data)
                staged.chmod(mode)
                _copy_rights(target, staged)
                if self.is_changed():  # while it was written
                    raise ChangedOutsideError(self.path)
                digest = find_hash(data)
                begin(digest)
                staged.replace(target)
            flush_folder(target.parent)
        except OSError as error:
            raise OutputError(self._explain(error)) from None
        self.digest, self.signature = digest, self._look()

    def find_hindrance(self) -> str:
        """Return why it cannot be replaced, as far as its rights and those of its folder tell; blank where it can."""
        try:
            target = self.path.resolve(strict=True)
            is_writable = bool(target.stat().st_mode & stat.S_IWUSR) and os.access(target, os.W_OK)
        except (OSError, RuntimeError):
            return ""
        if not is_writable:
            return fill("{name} is read-only: allow writing, or download your version.", name=self.path.name)
        if not os.access(target.parent, os.W_OK | os.X_OK):
            return fill(
                "The folder of {name} does not allow writing: changes can be downloaded, not saved in it.",
                name=self.path.name,
            )
        return ""

    def _explain(self, error: OSError) -> str:
        name, why = self.path.name, error.strerror or error
        if error.errno in FULL:
            return fill("{name} cannot be saved: {why}. Free some space, or download your version.", name=name, why=why)
        if error.errno in IN_USE:
            return fill("{name} cannot be saved: {why}. Close it in other programs.", name=name, why=why)
        return fill("{name} cannot be saved: {why}. Download your version.", name=name, why=why)

    def _look(self) -> tuple[int, ...]:
        """Return what tells a changed file without reading it, nothing where it is gone."""
        try:
            found = self.path.stat()
        except OSError:
            return ()
        return found.st_mtime_ns, found.st_size, found.st_ino


def _copy_rights(source: Path, target: Path) -> None:
    """Give a file the owner, the group, the access list and the extended attributes of another, as far as allowed.

    Others who write to a shared workbook keep their right to do so.
    """
    found = source.stat()
    if hasattr(os, "chown"):
        try:
            os.chown(target, found.st_uid, found.st_gid)
        except OSError:  # a group may be given by its members, an owner by root alone
            with suppress(OSError):
                os.chown(target, -1, found.st_gid)
    with suppress(OSError):
        shutil.copystat(source, target)
    os.utime(target)
