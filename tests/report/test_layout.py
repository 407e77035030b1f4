"""The PDF as it is laid out: nothing runs past the margin, words stay whole, sections keep their heads."""

from itertools import pairwise

import pytest

import assess
from assess.report.report_options import ReportOptions
from tests.report.reading import lay_out, render
from tests.workbooks import UNVERIFIED, assessed, write_sheets

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
    building = [{"building": f"{LONG} hall", "revision": "B", "azimuth_deg": 45, "prepared_by": LONG}]
    rows = {"Building": building, "Floors": FLOORS, "Items": PIECES, "Places": PLACES, "Routes": ROUTES}
    return assess.run(write_sheets(tmp_path_factory.mktemp("layout") / "w.xlsx", rows), UNVERIFIED)


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


def test_no_table_runs_past_the_margin_and_no_text_out_of_its_cell(pages):
    tables = [(page, table) for page in pages for table in _of(page, boxes.TableBox)]
    assert len(tables) > 10
    for page, table in tables:
        assert table.position_x + table.margin_width() <= page.content_box_x() + page.width + 0.5, _text(table)[:80]
    for page in pages:
        for table in _of(page, boxes.TableBox):
            if "short" in table.element.get("class", ""):  # rows of one line, cut at the end of the cell
                continue
            for cell in _of(table, boxes.TableCellBox):
                end = cell.content_box_x() + cell.width
                assert all(
                    max((one.position_x + one.width for one in _of(line, boxes.TextBox)), default=0) <= end + 0.5
                    for line in _of(cell, boxes.LineBox)
                ), _text(cell)


def test_words_of_a_head_are_broken_at_a_syllable_only(pages):
    heads = [
        head
        for head in [cell for page in pages for cell in _of(page, boxes.TableCellBox) if cell.element_tag == "th"]
        if head.element.get("scope") == "col"
    ]
    assert len(heads) > 40
    for head in heads:
        whole = "".join(head.element.itertext()).split()
        for line in _of(head, boxes.LineBox):
            *words, last = _text(line).split() or [""]
            assert all(any(word in one for one in whole) for word in words)
            is_end_of_word = any(one.endswith(last) for one in whole) or last.endswith("-")
            assert is_end_of_word or (last.endswith("‐") and len(last) > 3), whole


def test_the_foot_of_a_page_is_one_line_and_its_head_the_section_in_force_where_it_begins(pages):
    for page in pages:
        feet = [one for one in _of(page, boxes.MarginBox) if one.at_keyword in ("@bottom-left", "@bottom-right")]
        assert len(feet) == 2
        for foot in feet:
            assert len(_of(foot, boxes.LineBox)) == 1, _text(foot)
    chapter = ""
    for page in pages:
        heads = [one for one in _of(page, boxes.BlockBox) if one.element_tag == "h2"]
        titles = [one for one in heads if one.element.get("class") != "plain"]
        body = next(one for one in page.children if not isinstance(one, boxes.MarginBox))
        top = min((line.position_y for line in _of(body, boxes.LineBox)), default=0)
        begins = bool(titles) and _of(titles[0], boxes.LineBox)[0].position_y <= top + 0.5
        head = "".join(_text(one) for one in _of(page, boxes.MarginBox) if one.at_keyword == "@top-right")
        expected = _text(titles[0]) if begins else chapter
        assert head == expected
        chapter = _text(titles[-1]) if titles else chapter


def test_a_floor_with_its_plan_stays_on_one_page_and_the_approval_block_has_room_for_signatures(pages):
    floors = [
        (at, one.element.get("id"))
        for at, page in enumerate(pages)
        for one in _of(page, boxes.BlockBox)
        if one.element_tag == "article" and one.element.get("id", "").startswith("floor-")
    ]
    assert len(floors) == len({name for _at, name in floors}) == 2
    (table,) = [one for one in _of(pages[0], boxes.TableBox) if "signing" in one.element.get("class", "")]
    rows = [row for row in _of(table, boxes.TableRowBox) if row.element.getparent().tag == "tbody"] if hasattr(
        table.element, "getparent") else _of(table, boxes.TableRowBox)[1:]  # fmt: skip
    assert len(rows) == 3
    assert all(row.height >= 9 / 25.4 * 96 - 1 for row in rows)


LEVELS = [
    {"floor": name, "name": title, "elevation": at, "pfa_x": 0.5, "pfv_x": 40, "pfa_y": 0.5, "pfv_y": 45}
    for name, title, at in (("Second", "Second floor", 8), ("Mezzanine", "", 4), ("Basement", "", -3))
]  # fmt: skip
ROOMS = ["Physiotherapy", "Echocardiography waiting area", "Gastroenterology", "Sterilisation"]
WHAT = ["Refrigerator for vaccines", "Electrocardiograph on a trolley", "Bookcase, partly anchored",
        "Uninterruptible power supply"]  # fmt: skip
HOSPITAL = [
    {"item": f"{LEVELS[at % 3]['floor']}-{at:02}", "floor": LEVELS[at % 3]["floor"], "room": ROOMS[at % 4],
     "description": WHAT[at % 4], "breadth": 30 + 5 * (at % 4), "width": 80, "height": 180,
     "anchored": "yes" if at % 7 == 0 else "no", "importance": "life safety" if at % 5 == 0 else None}
    for at in range(24)
]  # fmt: skip
TABLES = {"items", "pieces", "named"}


def _broken(cell):
    """Return where a line of a cell ends within a word: not at a space, hyphen or slash."""
    words = "".join(cell.element.itertext()).split()
    lines = ["".join(one.text for one in _of(line, boxes.TextBox)).split() for line in _of(cell, boxes.LineBox)]
    ends = [(one[-1], other[0]) for one, other in pairwise(line for line in lines if line)]
    return [
        (last, first)
        for last, first in ends
        if last[-1] not in "-/" and any(last.rstrip("\N{HYPHEN}") + first in word for word in words)
    ]


def test_no_word_of_the_inventory_is_broken_over_lines(tmp_path):
    results = assessed(tmp_path / "w.xlsx", HOSPITAL, LEVELS, building="General Hospital")
    seen = set()
    for page in lay_out(render(results, for_print=True)):
        for table in _of(page, boxes.TableBox):
            names = TABLES & set(table.element.get("class", "").split())
            for cell in _of(table, boxes.TableCellBox) if names else ():
                assert _broken(cell) == [], "".join(cell.element.itertext())
                seen |= set("".join(cell.element.itertext()).split())
    assert {"Physiotherapy", "Echocardiography", "Mezzanine", "Electrocardiograph"} <= seen
