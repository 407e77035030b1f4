"""The nets: 25 workbooks, what was found of each, and what every output says of it.

Outputs are rendered from results that are kept in a file, so that they are the same on every machine: ``make nets``
writes the outputs anew, ``python -m tests.nets.nets`` assesses the workbooks anew, or those that are named.
"""

import argparse
import tempfile
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

import pytest

import assess
from assess.report import html_blocks
from assess.report.figures import motion_figures, risk_map
from assess.report.figures.math_figures import MathFigure
from assess.report.word import writer
from assess.results import Results
from assess.settings import Settings
from tests.nets.lines import PDFS, QUICK, render
from tests.nets.make import CITY, MADE, ROOT, make_workbooks
from tests.nets.stored import read_results, write_results
from tests.pictures import picture
from tests.report.reading import leave_room

HERE = Path(__file__).parent
OWN = HERE / "workbooks"
USERS = tuple(sorted(path.stem for path in OWN.iterdir() if path.suffix in (".xlsx", ".xlsm")))
"""What users and their programs wrote."""
NAMES = (
    "market-street", *MADE, "everything-it", "routed-imperial", "duplex", "LargeBuilding",
    *(f"city-{at}" for at in range(1, CITY + 1)), *USERS,
)  # fmt: skip
MOST_ROWS = 4
"""Of results.json and items.csv the first of each list are held: the others are written alike."""
SETTINGS = Settings(runs=100)
PRINTED = ("everything", "everything-it", "imperial", "doubted", "city-1")
"""Of these the words of the PDFs are held."""
BY_FORMULA = frozenset(("doubted", "LargeBuilding", "city-2", "table-totals"))
SHAKING = {"shaking": "MMI VIII, severe"}
"""What is typed in Building where a model tells nothing of it."""
STORED, SHOWN = HERE / "stored", HERE / "shown"
EMPTY, NO_ROOM = picture("PNG"), MathFigure({}, "", (0, 0, 1, 1), 0)
DATE = "1767225600"
"""1 January 2026 as SOURCE_DATE_EPOCH: reports are dated by it."""


def find_workbook(name: str, made: Path) -> Path:
    """Return a workbook; `made` is where `make_workbooks` wrote."""
    if name == "market-street":
        return ROOT / "inventories" / "market-street.xlsx"
    folder = OWN if name in USERS else made
    return next(path for path in folder.iterdir() if path.stem == name and path.suffix.startswith(".xls"))


def assess_workbook(name: str, made: Path) -> Results:
    """Assess a workbook."""
    given = SHAKING if name in ("duplex", "LargeBuilding") or name.startswith("city") else None
    inventory = assess.read_inventory(find_workbook(name, made), building=given, strict=False)
    return assess.run(inventory, replace(SETTINGS, verify="none") if name in BY_FORMULA else SETTINGS)


def read_stored(name: str, box: Path) -> Results:
    """Return the results that are kept."""
    return read_results(STORED / f"{name}.npz", box)


def store(name: str, results: Results) -> None:
    """Keep results."""
    STORED.mkdir(exist_ok=True)
    write_results(results, STORED / f"{name}.npz")


def show(name: str, results: Results, folder: Path, formats: Collection[str] = QUICK) -> Mapping[str, list[str]]:
    """Return the lines of outputs. Figures are no lines: empty pictures stand in their places.

    So do they in place of equations; in PDFs as large as these, as the pages follow from their sizes.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", DATE)
        for module in (motion_figures, risk_map):
            patch.setattr(module, "draw", lambda *_, **__: b"")
        patch.setattr(html_blocks, "draw_math", leave_room if set(formats) & set(PDFS) else lambda _: NO_ROOM)
        patch.setattr(writer, "draw_all", lambda given, *_: [EMPTY for _ in given])
        found = render(results, folder, formats)
    if "json" in found:
        found["json"] = [line for line in found["json"] if not _is_far(line)]
    if "csv" in found:
        found["csv"] = found["csv"][: MOST_ROWS + 1]
    return found


def _is_far(line: str) -> bool:
    return any(part.isdigit() and int(part) >= MOST_ROWS for part in line.partition(" ")[0].split("/"))


def find_shown(name: str, kind: str) -> Path:
    """Return where the lines of an output are kept."""
    return SHOWN / f"{name}.{kind}.txt"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=NAMES, help="workbooks")
    with tempfile.TemporaryDirectory() as box:
        make_workbooks(Path(box))
        for name in parser.parse_args().names:
            store(name, assess_workbook(name, Path(box)))
