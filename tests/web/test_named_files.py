"""The files that a workbook names: a ShakeMap is asked for, taken in, and simulated with what lies beside it."""

import shutil

import pytest

from assess.web.book import Book
from assess.web.file_names import list_present
from assess.web.jobs import prepare
from assess.web.limits import OWN
from assess.workbook.template import Content, write_workbook
from tests.motion.grids import EPICENTRE
from tests.workbooks import RECORDS, write

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 6}]
EPICENTRE_PLACE = {"latitude": 37.04, "longitude": -121.88}


@pytest.fixture
def book(tmp_path):
    (tmp_path / "own").mkdir()
    path = write(tmp_path / "own" / "office.xlsx", floors=FLOORS, shakemap="grid.xml", **EPICENTRE_PLACE)
    return Book.open_disk(path)


def test_a_missing_shakemap_is_listed_and_taken_in(book):
    (missing,) = book.describe()["missing"]
    assert (missing["name"], missing["kind"]) == ("grid.xml", "hazard")
    book.add_file("grid.xml", EPICENTRE.read_bytes())
    assert book.describe()["missing"] == []
    site = book.snapshot().inventory.site_ground
    assert site is not None
    assert site.shared is None, "no uncertainty.xml lies beside it"


def test_a_job_works_with_the_uncertainties_that_lie_beside_it(book, tmp_path):
    for file in EPICENTRE.parent.iterdir():
        shutil.copy(file, tmp_path / "own")
    snapshot = book.snapshot()
    assert list(list_present(snapshot.workbook, snapshot.sheets, snapshot.files)) == ["grid.xml", "uncertainty.xml"]
    prepare(book, {"formats": ["json"]}, tmp_path / "job", OWN)
    assert sorted(one.name for one in (tmp_path / "job").rglob("*.xml")) == ["grid.xml", "uncertainty.xml"]


def test_a_file_that_is_added_counts_in_what_is_written(tmp_path):
    """The stored results of live columns rest on the records that the workbook names, too."""
    record = (RECORDS / "0165a_u.smc").read_bytes()
    floors = [{"floor": "1", "record_x": "a.smc", "record_y": "a.smc"}]
    write_workbook(
        tmp_path / "b.xlsx", Content({"Floors": floors, "Items": [{"item": "A", "floor": "1", "height": 180}]})
    )
    book = Book.hold("b.xlsx", (tmp_path / "b.xlsx").read_bytes(), tmp_path)
    place = book.sheets["Items"].place("breadth", 2) or ()
    book.edit(book.version, [["Items", *place, 45]], "typing")
    before = book.write()
    book.add_file("a.smc", record)
    assert book.write() != before
