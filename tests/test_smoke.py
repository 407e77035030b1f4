"""What shows that the product works on another Python: each command starts, and one workbook goes through every format.

`make test-smoke` runs these with `tests/validation` and `tests/rocking`: the gate, on each other Python; on its own it
runs all that they look at.
"""

import csv
import json
import subprocess
import sys
from pathlib import Path

import docx
import duckdb
import numpy as np
import openpyxl
import pypdfium2
import pytest

from assess.cli.app import find_commands
from assess.report_formats import FILES
from tests.shaking import write_records
from tests.workbooks import ITEMS, write

pytestmark = pytest.mark.smoke


def assess_command(*words: object) -> str:
    """Run `assess` as a user does, in a process of its own, and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-m", "assess", *map(str, words)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout


def test_each_command_prints_its_help():
    for name, module in find_commands():
        text = assess_command(name, "--help")
        assert f"Usage: assess {name}" in text
        assert all(f"assess {name}" in example for example in module.EXAMPLES)


FLOORS = [{"floor": "1", "record_x": "pulse.csv", "pfa_y": 0.2, "pfv_y": 45.0}, {"floor": "2", "pfa_x": 0.5}]


@pytest.fixture(scope="module")
def out(tmp_path_factory) -> Path:
    """The reports of a workbook with a recorded floor and one without, in every format."""
    folder: Path = tmp_path_factory.mktemp("smoke")
    write_records(folder, "pulse")
    book = write(folder / "school.xlsx", ITEMS, FLOORS, building="Hill School", height=9.0, storeys=3)
    assess_command("run", book, "--out", folder / "out", "--runs", 25, "--formats", ",".join(FILES))
    return folder / "out"


def read_pdf(path: Path) -> str:
    """Return the text of all pages."""
    document = pypdfium2.PdfDocument(path)
    return "\n".join(page.get_textpage().get_text_range() for page in document)


def read_classes(out: Path, file: str) -> dict[str, str]:
    """Return the class of each piece as a table of the reports holds it."""
    if file == "results.json":
        items = json.loads((out / file).read_text(encoding="utf-8"))["items"]
        return {one["item"]: one["adopted"]["class"] for one in items}
    if file == "items.csv":
        with (out / file).open(encoding="utf-8-sig", newline="") as stream:
            return {row["item"]: row["adopted_class"] for row in csv.DictReader(stream)}
    rows = duckdb.sql(f"SELECT item, adopted_class FROM read_parquet('{out / file}')").fetchall()
    return dict(rows)


def test_each_format_holds_each_piece(out):
    classes = read_classes(out, "results.json")
    assert list(classes) == [one["item"] for one in ITEMS]
    assert len(set(classes.values())) > 1
    assert read_classes(out, "items.csv") == classes
    assert read_classes(out, "items.parquet") == classes
    with np.load(out / "outcomes.npz") as outcomes:
        assert any(values.size for values in outcomes.values())
    rows = openpyxl.load_workbook(out / "report.xlsx", data_only=True)["Items"].iter_rows(values_only=True)
    texts = {
        "report.xlsx": " ".join(str(cell) for row in rows for cell in row),
        "report.html": (out / "report.html").read_text(encoding="utf-8"),
        "annex.pdf": read_pdf(out / "annex.pdf"),
    }
    assert [(file, item) for file, text in texts.items() for item in classes if item not in text] == []


def test_both_editions_for_the_client_name_the_building(out):
    word = "\n".join(one.text for one in docx.Document(str(out / "report.docx")).paragraphs)
    for text in (read_pdf(out / "report.pdf"), word):
        assert "Hill School" in text
