"""Workbooks held as the server holds them, for tests that need no server; workbooks as the template makes them."""

import json
import tempfile
from functools import cache
from pathlib import Path

from assess.settings import Settings
from assess.web.book import Book
from assess.web.evaluation import AS_RUN, Evaluation, evaluate
from assess.workbook.template import Content, Units, write_workbook
from tests.waiting import wait_until
from tests.workbooks import FLOORS, ITEMS

MARKET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"


def hold(path: Path) -> Book:
    """Hold the bytes of a workbook, with the files next to it."""
    return Book.hold(path.name, path.read_bytes(), path.parent)


def edit(book: Book, *cells) -> None:
    """Change cells, each a sheet, a row, a field and a value."""
    edits = []
    for sheet, row, field, value in cells:
        place = book.sheets[sheet].place(field, row)
        assert place is not None, field
        edits.append([sheet, *place, value])
    book.edit(book.version, edits, "test")


def settle(book: Book, settings: Settings = AS_RUN) -> Evaluation:
    """Wait until every piece of the workbook as it is now has been simulated."""
    found: Evaluation = wait_until(
        lambda: evaluate(book.snapshot(), settings, routes=False),
        lambda one: one.simulation.state in ("done", "failed"),
    )
    return found


@cache
def _make(rows: str, units: Units, spare: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "made.xlsx"
        write_workbook(path, Content(rows=json.loads(rows)), units, spare=spare)
        return path.read_bytes()


def write_template(path: Path, rows, units: Units = "si", spare: int = 3) -> Path:
    """Write a workbook as users have it, with its formulas in few rows; the same rows are made once."""
    path.write_bytes(_make(json.dumps(rows), units, spare))
    return path


def write_office(path: Path, items=None, floors=None, **building) -> Path:
    return write_template(path, {"Building": [building], "Floors": floors or FLOORS, "Items": items or ITEMS})


def write_one_floor(path: Path, **building) -> Path:
    """Write the small workbook with all pieces on one floor, along one axis: its report has fewer figures."""
    lying = ("axis", "x", "y", "angle_deg")
    items = [{name: value for name, value in one.items() if name not in lying} | {"floor": "1"} for one in ITEMS]
    return write_office(path, items, [{"floor": "1", "pfa_x": 0.5, "pfv_x": 45.0}], **building)
