"""What a simulation takes from a workbook: its settings, a private copy of its files, and whether that has changed."""

import json
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.errors import WorkbookError
from assess.i18n import fill, spoken
from assess.model import Inventory
from assess.report_formats import FILES
from assess.settings import change_settings
from assess.web.job_process import INPUT, ORDER, OUT
from assess.web.named_files import list_present
from assess.web.request_errors import UNUSABLE, RequestError
from assess.workbook.records import find_place

if TYPE_CHECKING:
    from assess.web.book import Book, Snapshot

FORMATS = tuple(name for name in FILES if name not in ("npz", "parquet"))
"""Files that the page offers; results.json is always written."""
OPTIONS = ("verify", "runs", "seed", "scale", "scenario")
"""Settings that the page may choose; fitted models and templates are code, and never come from a page."""

ITEM_INPUTS = (
    "item", "floor", "breadth", "width", "height", "centre_of_gravity", "weight", "bracket_height", "bracket_capacity",
    "axis", "anchored", "friction", "angle_deg", "quantity",
)  # fmt: skip
"""Fields of a piece by which its simulated chance, whether it counts as anchored, or how many it is, is found."""
BUILDING_INPUTS = (
    "storeys", "height", "period", "structure", "azimuth_deg", "scenario_kind", "class_by", "ground_pga", "ground_pgv",
    "sds", "shaking", "friction", "restitution", "motion_uncertainty", "piece_uncertainty",
)  # fmt: skip
"""Fields of the building by which the chances of all pieces are found."""
FLOOR_INPUTS = ("floor", "elevation", "pfa", "pfv", "records")
"""Likewise of a floor; those of one floor serve the floors between, so that a change counts for all."""


def read_changes(body: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings that a request changes; SettingsError where one cannot be used."""
    given = {name: body[name] for name in OPTIONS if body.get(name) not in (None, "")}
    first = body.get("first") or 0
    if isinstance(first, bool) or not isinstance(first, int) or first < 0:
        raise RequestError(fill("first is {first}, expected a whole number, 0 or above.", first=str(first)), UNUSABLE)
    changes = given | ({"anchor": f"first:{first}"} if first else {})
    change_settings(None, changes)
    return changes


def read_formats(body: Mapping[str, Any], folder: Path) -> list[str]:
    """Return the formats of a request.

    Raises InputError if one is unknown, or needs a package that is not installed.
    """
    from assess.report import check_folder

    given = body.get("formats", ["html"])
    wanted = [str(one) for one in given] if isinstance(given, list) else [str(given)]
    unknown = [one for one in wanted if one not in FORMATS] or ([] if wanted else [""])
    if unknown:
        known = ", ".join(FORMATS)
        text = fill("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0][:40], known=known)
        raise RequestError(text, UNUSABLE)
    check_folder(folder, wanted)
    return list(dict.fromkeys(wanted))


def prepare(book: "Book", body: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], Inventory]:
    """Write the order of a job and a copy of the workbook with the files that it names.

    Raises InputError if an option cannot be used, or the workbook has errors: as `assess run`, which works with whole
    workbooks only.

    Returns
    -------
    order : dict
        What the process is told, with the version of the workbook.
    inventory : Inventory
        What the workbook holds.
    """
    changes, formats = read_changes(body), read_formats(body, folder / OUT)
    snapshot, data = _read(book)
    if any(one.severity == "error" for one in snapshot.problems):
        raise WorkbookError(snapshot.problems, snapshot.inventory.language)
    source = folder / INPUT
    source.mkdir(parents=True)
    (source / book.name).write_bytes(data)
    for name, path in list_present(snapshot.cells, snapshot.sheets, snapshot.files).items():
        target = find_place(name, source)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target)
    order = {"workbook": book.name, "version": snapshot.version, "settings": changes, "formats": formats}
    (folder / ORDER).write_text(json.dumps({**order, "language": spoken().code}), encoding="utf-8")
    return order, snapshot.inventory


def _read(book: "Book") -> "tuple[Snapshot, bytes]":
    while True:
        snapshot, data = book.snapshot(), book.write()
        if book.version == snapshot.version:
            return snapshot, data


def list_stale(before: Inventory, now: Inventory) -> list[int]:
    """Return the rows of furniture whose chance or number may be another one than when they were simulated.

    Among them are rows that are gone, or now have an error.
    """
    known, left = {one.row: one for one in before.items}, {one.row for one in now.items}
    is_other = not (
        _is_alike(before.building, now.building, BUILDING_INPUTS)
        and before.hazard == now.hazard
        and before.site_ground == now.site_ground
        and len(before.floors) == len(now.floors)
        and all(_is_alike(one, other, FLOOR_INPUTS) for one, other in zip(before.floors, now.floors, strict=True))
    )
    changed = [
        one.row
        for one in now.items
        if is_other or one.row not in known or not _is_alike(known[one.row], one, ITEM_INPUTS)
    ]
    return [*changed, *(row for row in known if row not in left)]


def _is_alike(one: object, other: object, fields: Iterable[str]) -> bool:
    return all(getattr(one, name) == getattr(other, name) for name in fields)
