"""The PDF as it is laid out: nothing runs past the margin, words stay whole, sections keep their heads."""

import pytest

import assess
from assess.report.report_options import ReportOptions
from tests.report.reading import lay_out, render
from tests.workbooks import UNVERIFIED, write_sheets

pytestmark = pytest.mark.slow

boxes = pytest.importorskip("weasyprint.formatting_structure.boxes")

LONG = "Supercalifragilisticexpialidocious-wing"
FLOORS = [
    {"floor": LONG[:30], "name": f"{LONG} and annex", "pfa_x": 0.9, "pfv_x": 90.0, "pfa_y": 0.8, "pfv_y": 80.0},
    {"floor": "2", "pfa_x": 0.5, "pfv_x": 50.0, "pfa_y": 0.5, "pfv_y": 50.0},
]
PIECES = [
    {"item": f"{LONG}-{at}", "floor": FLOORS[at % 2]["floor"], "room": LONG, "description": f"{LONG} of metal",
     "breadth": 30, "width": 80, "height": 200, "x": 2.0 + at, "y": 3.0 + at % 3,
     "anchored": "yes" if at == 3 else "no", "notes": f"{LONG} note"}
    | ({"route": f"{LONG} route", "segment": f"{LONG} segment"} if at % 2 else {})
    for at in range(8)
]  # fmt: skip
PLACES = [
    {"place": f"{LONG} {name}", "floor": "2", "x": x, "y": 1.0, "kind": kind}
    for name, x, kind in (("hall", 1.0, "room"), ("stair", 6.0, "stair"))
]
ROUTES = [
    {"route": f"{LONG} route", "segment": f"{LONG} segment", "floor": "2", "start": f"{LONG} hall",
     "end": f"{LONG} stair", "clear_width": 1.2, "occupants": 900, "notes": f"{LONG} note"},
]  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    path = tmp_path_factory.mktemp("layout") / "w.xlsx"
    building = [{"building": f"{LONG} hall", "revision": "B", "azimuth_deg": 45, "prepared_by": LONG}]
    rows = {"Building": building, "Floors": FLOORS, "Items": PIECES, "Places": PLACES, "Routes": ROUTES}
    write_sheets(path, rows)
    return assess.run(path, UNVERIFIED)


@pytest.fixture(scope="module")
def pages(results):
    """In Italian, whose words are longer."""
    return lay_out(render(results, ReportOptions(language="it"), for_print=True))


def _walk(box):
    yield box
    for child in getattr(box, "children", ()):
        yield from _walk(child)


def _of(box, kind):
    return [one for one in _walk(box) if isinstance(one, kind)]


def _text(box):
    return "".join(one.text for one in _of(box, boxes.TextBox))


def _right(box):
    return max((one.position_x + one.width for one in _of(box, boxes.TextBox)), default=0)


def test_no_table_runs_past_the_margin(pages):
    tables = [(page, table) for page in pages for table in _of(page, boxes.TableBox)]
    assert len(tables) > 10
    for page, table in tables:
        assert table.position_x + table.margin_width() <= page.content_box_x() + page.width + 0.5, _text(table)[:80]


def test_no_text_runs_out_of_its_cell(pages):
    for page in pages:
        for table in _of(page, boxes.TableBox):
            if "short" in table.element.get("class", ""):  # rows of one line, cut at the end of the cell
                continue
            for cell in _of(table, boxes.TableCellBox):
                end = cell.content_box_x() + cell.width
                assert all(_right(line) <= end + 0.5 for line in _of(cell, boxes.LineBox)), _text(cell)
