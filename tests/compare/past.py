"""Small results.json for tests of comparisons, as `assess run` writes them, and copies of them with changes."""

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import assess
from assess.compare.past_run import PastRun, read_run
from assess.settings import Settings
from tests.report.routed import write_routed
from tests.workbooks import write

HALL = {"building": "Town hall"}


def write_run(folder: Path, settings: Settings, **rows: Any) -> Path:
    """Assess the small workbook and return the folder of its results.json."""
    return _save(write(folder.with_suffix(".xlsx"), **HALL, **rows), settings, folder)


def write_routed_run(folder: Path, settings: Settings, **sheets: Any) -> Path:
    """Assess the building with evacuation routes likewise."""
    return _save(write_routed(folder.with_suffix(".xlsx"), **sheets), settings, folder)


def _save(workbook: Path, settings: Settings, folder: Path) -> Path:
    assess.write_reports(assess.run(assess.read_inventory(workbook), settings), folder, "json")
    return folder


def change(source: Path, target: Path, edit: Callable[[dict[str, Any]], None]) -> Path:
    """Write a copy of a results.json in which something is changed."""
    record = copy.deepcopy(json.loads((source / "results.json").read_text(encoding="utf-8")))
    edit(record)
    target.mkdir(parents=True, exist_ok=True)
    (target / "results.json").write_text(json.dumps(record), encoding="utf-8")
    return target


def read_changed(source: Path, target: Path, edit: Callable[[dict[str, Any]], None]) -> PastRun:
    """Return such a copy as it is read."""
    return read_run(change(source, target, edit))


def item(record: dict[str, Any], name: str) -> dict[str, Any]:
    """Return an item of a record by its name."""
    return next(one for one in record["items"] if one["item"] == name)
