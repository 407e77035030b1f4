"""Files that an inventory is imported from: the content of a file, not its name, decides which reader takes it."""

import hashlib
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePath

from assess.bim.building_model import BuildingModel
from assess.bim.cobie import read_cobie
from assess.bim.ifc_model import check_installed, check_model, is_model, read_model, unreadable
from assess.bim.import_workbook import ENDING, ImportedBuilding, describe
from assess.bim.model_process import run_apart
from assess.bim.model_rows import Drafts, list_building
from assess.bim.roomplan import MOST_BYTES as MOST_OF_SCAN, read_roomplan
from assess.bim.sweet_home import HOME, MOST_BYTES as MOST_OF_HOME, OLD_HOME, read_sweet_home
from assess.errors import InputError, ModelError
from assess.i18n import fill, load_catalogue, speaking, spoken
from assess.progress import SILENT, Progress
from assess.resources import open_input, read_input
from assess.text import plain_text
from assess.version import __version__

Reader = Callable[[Path, str, Sequence[str]], BuildingModel]
"""Reads a file, by its path, its name and further classes of furniture."""
_LOOKED_AT = 4096


def read_source(
    path: Path, name: str, progress: Progress = SILENT, *, routes: Drafts = "none", also: Sequence[str] = ()
) -> ImportedBuilding:
    """Read the furniture of a building model (IFC), a scan (RoomPlan), a home or a COBie file, with a record of the
    import. `also`: further classes of an IFC model. Raises ModelError or WorkbookError if it is none of these, is
    damaged, or beyond a limit; InputError if it cannot be opened.
    """
    if not path.exists():
        raise InputError(fill("{name} does not exist. Check the name and the folder.", name=name))
    if path.is_dir():
        raise InputError(fill("{name} is a folder. Name the file in it that is to be imported.", name=name))
    try:
        with open_input(path) as file:
            start = file.read(_LOOKED_AT)
        read = _choose(path, name, start)
        if read is not None:
            found = run_apart(name, progress, build, read, path.resolve(), name, routes, tuple(also), spoken().code)
        elif routes != "none":
            raise ModelError(fill("{name} holds no positions, so that no routes can be drafted from it.", name=name))
        else:
            found = progress.wait_for(lambda: read_cobie(path, name, progress))
        with open_input(path) as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise unreadable(name, error) from None
    head = f"Imported by assess {__version__} from {name}, SHA-256 {digest}"
    record = "".join(f"{plain_text(line)}\n" for line in (head, "", *describe(found)))
    return replace(found, files={**found.files, PurePath(name).stem + ENDING: record.encode()})


def _choose(path: Path, name: str, start: bytes) -> Reader | None:
    if start.startswith(b"PK\x03\x04"):
        try:
            with zipfile.ZipFile(path) as archive:
                parts = archive.namelist()
        except (OSError, zipfile.BadZipFile, NotImplementedError, ValueError):
            raise ModelError(
                fill("{name} is damaged: it cannot be unpacked. Copy or save it again.", name=name)
            ) from None
        if any(part.lower().endswith((".ifc", ".ifcxml")) for part in parts):
            check_model(path, name)
        return partial(_read_bytes, read_sweet_home, MOST_OF_HOME) if HOME in parts or OLD_HOME in parts else None
    if start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith((b"{", b"[")):
        return partial(_read_bytes, read_roomplan, MOST_OF_SCAN)
    if not is_model(start) and path.suffix.lower() not in (".ifc", ""):
        raise ModelError(
            fill("{name} is of a kind that is not imported: name an IFC model (.ifc), a RoomPlan scan (.json), a Sweet "
                 "Home 3D file (.sh3d) or a COBie spreadsheet (.xlsx).", name=name)
        )  # fmt: skip
    check_model(path, name)
    check_installed()
    return read_model


def build(read: Reader, path: Path, name: str, routes: Drafts, also: Sequence[str], language: str) -> ImportedBuilding:
    """Return what a reader finds in a file as rows, in a language by its code."""
    with speaking(load_catalogue(language)):
        return list_building(read(path, name, also), routes)


def _read_bytes(
    read: Callable[[bytes, str], BuildingModel], most: int, path: Path, name: str, _also: Sequence[str]
) -> BuildingModel:
    return read(read_input(path, most), name)
