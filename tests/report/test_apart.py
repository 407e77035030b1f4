"""What was not simulated, or not to be relied on, stands apart: in counts, lists, sums, pages, files and at the end."""

import re
import shutil

import pytest

import assess
from assess.report.content import Content
from assess.report.counts import count
from assess.report.say.piece import list_apart, list_risky
from assess.results import BASES
from assess.risk import RiskClass
from assess.settings import Settings
from tests.report.reading import read_pages, render
from tests.shaking import RECORDS as SHAKING, write_record
from tests.workbooks import RECORDS, write

FLOORS = [
    {"floor": "1", "record_x": "made-up-sweep.csv#north"},
    {"floor": "2", "pfa_x": 0.2, "pfv_x": 45},
    {"floor": "3", "record_x": "weak.csv"},
]
SIZE = {"width": 110, "axis": "X"}
ITEMS = [
    SIZE | {"item": "wide", "floor": "2", "room": "Office", "breadth": 22, "height": 200, "quantity": 3},
    SIZE | {"item": "felled", "floor": "1", "room": "Hall", "breadth": 30, "height": 200, "x": 2, "y": 2},
    SIZE | {"item": "still", "floor": "3", "breadth": 45, "height": 200},
    SIZE | {"item": "broad", "floor": "2", "breadth": 25, "height": 180, "x": 4, "y": 2},
    SIZE | {"item": "calm", "floor": "2", "breadth": 78, "height": 200},
    SIZE | {"item": "fixed", "floor": "2", "breadth": 50, "height": 180, "anchored": "yes"},
]
EXPECTED = {"wide": "unconfirmed", "felled": "simulated", "still": "cannot rock", "broad": "unconfirmed",
            "calm": "formula", "fixed": "unconfirmed"}  # fmt: skip
"""Where nothing is known of the building, the class of a floor without a record is unconfirmed; the calm piece is not
chosen, and the still one cannot rock."""


def _assess(folder, items=ITEMS, building=(), **settings):
    shutil.copy(RECORDS / "made-up-sweep.csv", folder)
    write_record(folder / "weak.csv", 0.6 * SHAKING["still"])
    inventory = assess.read_inventory(write(folder / "w.xlsx", items, FLOORS, **dict(building)))
    return assess.run(inventory, Settings(**{"runs": 20, "verify": "high", **settings}), jobs=1)


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    return _assess(tmp_path_factory.mktemp("mixed"))


def test_counts_lists_and_the_table_of_all_pieces_never_mix_bases(mixed):
    assert {one.item.item: one.adopted.basis for one in mixed} == EXPECTED
    assert set(EXPECTED.values()) == set(BASES) - {"rolls"}
    assert {one.item.item: one.apart for one in mixed} == {
        name: "" if basis in ("simulated", "cannot rock") else basis for name, basis in EXPECTED.items()
    }
    rows = list(mixed)
    counts = count("all", rows)
    assert (counts.free, counts.unconfirmed, counts.by_formula, counts.anchored, counts.total) == (2, 4, 1, 1, 8)
    assert counts.expected == mixed["felled"].adopted.probability
    assert counts.falls == f"{counts.expected:.1f} ({counts.falls_low:.0f} to 1), and up to 4 more"
    assert mixed["wide"].adopted.risk >= RiskClass.HIGH, "which the counts leave out"
    assert counts.by_class[RiskClass.HIGH] + counts.by_class[RiskClass.VERY_HIGH] == 1
    assert count("simulated", [mixed["felled"]]).falls == counts.falls.partition(", and")[0]
    content = Content(mixed)
    assert [one.item.item for one in list_apart(mixed, "")] == ["felled", "still"]
    assert [one.item.item for one in list_risky(mixed)] == ["felled"]
    assert [one.item.item for one in list_apart(mixed, "unconfirmed")] == ["wide", "broad"]
    fixes = [(fix.results[0], fix.together) for fix in content.fixes]
    assert [one.apart for one, _share in fixes] == sorted((one.apart for one, _share in fixes), key=bool)
    assert [one.item.item for one, share in fixes if share is None] == ["wide", "broad", "calm"]
    assert [share for one, share in fixes if not one.apart][-1] == pytest.approx(1.0)
    # Rows that filters take for a class are simulated; all others stand in parts of their own, which say why.
    page = render(mixed)
    table = page[page.index('id="pieces"') :].partition("</table>")[0]
    bodies = re.findall(r"<tbody>(.*?)</tbody>", table, re.DOTALL)
    found = [re.findall(r'id="row-(\d+)".*?data-class="([^"]+)"', body) for body in bodies]
    rows = list(mixed)
    for at, (body, listed) in enumerate(zip(bodies, found, strict=True)):
        bases = {rows[int(number) - 1].adopted.basis for number, _style in listed}
        assert bases == ({"simulated", "cannot rock"}, {"unconfirmed"}, {"formula"})[at]
        assert ('<tr class="part">' in body) == (at > 0)
    styles = dict(pair for body in found for pair in body)
    assert {style for number, style in styles.items() if rows[int(number) - 1].apart} == {
        "apart-unconfirmed", "apart-formula", "anchored",
    }  # fmt: skip


@pytest.mark.slow
def test_other_conditions_are_named_on_every_page_of_the_pdf(mixed, tmp_path):
    conditions = ("Assumed: exactly this motion, and every piece exactly as given", "Every floor's motion times 1.2")
    exactly = _assess(tmp_path, ideal=True, scale=1.2)
    written = assess.write_reports(exactly, tmp_path / "out", ("pdf",))
    pages = read_pages(written["pdf"])
    assert len(pages) > 5
    assert all(condition in text for text in pages for condition in conditions)
    for edition in ("client", "annex"):
        page = render(mixed, for_print=True, edition=edition)
        assert 'data-conditions=""' in page
        assert "content: string(conditions)" not in page
