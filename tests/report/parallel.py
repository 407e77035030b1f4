"""A workbook whose floors and pieces are of every kind that counts and lists tell apart, and what its reports show.

Floor 2 has two parallel records along X: the fast one has the larger PFA, the slow pulse overturns more.
"""

import csv
import html
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import openpyxl.utils
from openpyxl.utils.cell import coordinate_to_tuple

from assess.report.xlsx.items_sheet import item_columns
from assess.results import Results
from assess.settings import Settings
from tests.recalculate import evaluate
from tests.workbooks import assessed

FLOORS: list[dict[str, Any]] = [
    {"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0},
    {"floor": "2", "record_x": "fast.csv; pulse.csv", "record_y": "pulse.csv"},
    {"floor": "3", "pfa_x": 0.5, "pfv_x": 50.0},
    {"floor": "4", "record_x": "pulse.csv; fast.csv"},
]
SIZES = [(20, 100, "X"), (30, 200, ""), (50, 190, "X"), (60, 180, ""), (75, 160, "Y"), (45, 90, "X"), (150, 100, "")]
BRACKETS: list[tuple[str, float | None]] = [
    ("yes", None), ("yes", 0.01), ("yes", 50.0), ("partly", None), ("partly", 0.01), ("partly", 50.0), ("no", 50.0),
]  # fmt: skip
"""What stands in Anchored, and the bracket's capacity [kN]: too small for any motion here, or large enough for all."""
HELD = {"b": (True, False, True, False, False, True, False), "s": (True, True, True, False, None, True, False)}
"""Which of them count as anchored: slim pieces, and stocky ones. None: where the weight holds it at 84 % of PFA.

By hand: a stocky one pulls at its bracket where k z > B/2, with z = 0.8 m and B/2 = 0.75 m: from k = 0.94.
"""
VERY_STOCKY = {"breadth": 150, "width": 160, "height": 100}
"""It does not rock: in a run that simulates every piece its class is that of the formula."""
BASES = {"simulated": "simulated", "formula": "formula (not simulated)", "unconfirmed": "unconfirmed",
         "cannot rock": "cannot rock"}  # fmt: skip
"""What the Excel report calls the bases of classes."""


def list_items() -> list[dict[str, Any]]:
    """Return rows of every size on every floor, and on floors 1 and 2 of every bracket, for a slim and a stocky one."""
    items = [
        {"item": f"{floor}-{at}", "floor": floor, "breadth": breadth, "width": 160, "height": height, "axis": axis,
         "quantity": 1 + at % 3}
        for floor in "1234" for at, (breadth, height, axis) in enumerate(SIZES)
    ]  # fmt: skip
    slim = {"breadth": 30, "width": 100, "height": 200, "weight": 100}
    items += [
        {"item": f"{floor}-{name}{at}", "floor": floor, "anchored": word, "bracket_capacity": capacity, **size}
        for floor in "12"
        for name, size in (("b", slim), ("s", VERY_STOCKY | {"centre_of_gravity": 80, "weight": 900}))
        for at, (word, capacity) in enumerate(BRACKETS)
    ]
    return [{name: value for name, value in item.items() if value not in ("", None)} for item in items]


def write_wave(path: Path, time: Any, acceleration: Any) -> None:
    """Write a record [s], [cm/s2]."""
    rows = "\n".join(f"{at:.2f},{value:.4f}" for at, value in zip(time, acceleration, strict=True))
    path.write_text(f"time [s],x [cm/s2]\n{rows}\n", encoding="utf-8")


def write_records(folder: Path) -> None:
    """Write a burst of fast shaking, and one slow pulse."""
    time = np.arange(0, 12, 0.01)
    pulse = np.where((time > 4) & (time < 5), 412 * np.sin(2 * np.pi * (time - 4)), 0) + np.sin(4 * np.pi * time)
    write_wave(folder / "fast.csv", time, 680 * np.sin(2 * np.pi * 6 * time) * np.exp(-(((time - 5) / 2) ** 2)))
    write_wave(folder / "pulse.csv", time, pulse)


def assess_rich(folder: Path, settings: Settings) -> Results:
    """Assess this workbook; without T1 and height, so that floors with a PFA alone leave pieces unconfirmed."""
    write_records(folder)
    return assessed(folder / "w.xlsx", list_items(), FLOORS, settings=settings, restitution=0.9)


Cells = dict[tuple[str, str], Any]


def read_json(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def read_csv(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def read_items(cells: Cells, results: Results) -> list[dict[str, Any]]:
    """Return the rows of the sheet Items by the keys of its columns."""
    letters = {column.key: openpyxl.utils.get_column_letter(at) for at, column in enumerate(item_columns(results), 1)}
    return [{key: cells.get(("Items", f"{letter}{row}")) for key, letter in letters.items()}
            for row in range(2, 2 + len(results))]  # fmt: skip


def read_html(page: str) -> list[dict[str, tuple[str, float | None]]]:
    """Return the rows of the list of all pieces: text and number of each cell by its heading, and the row's class."""
    rows = re.findall(r'<tr id="row-\d+"[^>]*data-class="([^"]*)"[^>]*>(.*?)</tr>', page, re.DOTALL)
    start = page.index('<tr id="row-1"')
    head = page[page.rindex("<thead", 0, start) : start]
    heads = [_plain(one) for one in re.findall(r'<th scope="col"[^>]*>(.*?)</th>', head, re.DOTALL)]
    found = []
    for style, row in rows:
        cells = re.findall(r"<td([^>]*)>(.*?)</td>", row, re.DOTALL)
        numbers = (re.search(r'data-value="([^"]*)"', marks) for marks, _ in cells)
        values = [
            (_plain(text), float(one[1]) if one and one[1] else None)
            for (_, text), one in zip(cells, numbers, strict=True)
        ]
        found.append(dict(zip(heads, values, strict=True)) | {"style": (style, None)})
    return found


def _plain(text: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", text)).split())


Edit = tuple[str, str, Any]
"""Sheet, cell, value."""


def recalculate(path: Path, edits: list[Edit]) -> Cells:
    """Return every cell of a workbook after edits, as formualizer computes it."""
    book = evaluate(path, ((sheet, *coordinate_to_tuple(cell), value) for sheet, cell, value in edits))
    cells = [(sheet.title, cell) for sheet in openpyxl.load_workbook(path) for row in sheet.iter_rows() for cell in row]
    found = {(title, cell.coordinate): book.get_value(title, cell.row, cell.column) for title, cell in cells
             if cell.value is not None}  # fmt: skip
    return found | {(sheet, cell): value for sheet, cell, value in edits}


def write_edited(path: Path, edits: list[Edit], out: Path) -> Path:
    """Write a workbook after edits, with no result of a formula stored in it."""
    changed = openpyxl.load_workbook(path)
    for sheet, cell, value in edits:
        changed[sheet][cell] = value
    changed.save(out)
    return out
