"""What the PDF carries along: the workbook that it was made from, and results.json."""

import hashlib
import tempfile
from dataclasses import dataclass
from pathlib import Path

from assess.errors import Problem
from assess.inventory.model import Inventory
from assess.language import fill
from assess.language import gettext as _
from assess.report.data import write_json
from assess.results import Assessment

DATA = "results.json"
_KINDS = {
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".xlsm": "application/vnd.ms-excel.sheet.macroenabled.12",
    ".json": "application/json",
}


@dataclass(frozen=True, slots=True)
class Attached:
    """One file inside the PDF; `relationship` is one of PDF/A-3's, `kind` its media type."""

    name: str
    kind: str
    relationship: str
    description: str
    data: bytes


def list_attached(assessment: Assessment) -> list[Attached]:
    """Return what to attach, sorted by name as a PDF wants it; no workbook that is not the one that was read."""
    workbook = read_workbook(assessment.inventory)
    files = [Attached(DATA, _KINDS[".json"], "Data", _("The results, for other programs"), _results(assessment))]
    if workbook is not None:
        name = assessment.inventory.source.name
        kind = _KINDS.get(Path(name).suffix.lower(), "application/octet-stream")
        files.append(Attached(name, kind, "Source", _("The inventory that this report was made from"), workbook))
    return sorted(files, key=lambda file: file.name.encode("utf-8", "ignore"))


def read_workbook(inventory: Inventory) -> bytes | None:
    """Return the bytes of the workbook; None where it has gone, or is no longer what was read."""
    try:
        data = inventory.source.read_bytes()
    except OSError:
        return None
    return data if hashlib.sha256(data).hexdigest() == inventory.sha256 else None


def list_unattached(inventory: Inventory) -> list[Problem]:
    """Return a warning where the workbook cannot be attached."""
    if read_workbook(inventory) is not None:
        return []
    is_there = inventory.source.is_file()
    why = fill("it has changed since it was read") if is_there else fill("it can no longer be read")
    message = fill("{name} is not attached to the PDF: {why}.", name=inventory.source.name, why=why)
    mend = fill("Run it again, so that report and workbook agree.") if is_there else ""
    return [Problem("warning", "", "", message, mend)]


def _results(assessment: Assessment) -> bytes:
    with tempfile.TemporaryDirectory(prefix="assess-") as folder:
        path = Path(folder) / DATA
        write_json(assessment, path)
        return path.read_bytes()
