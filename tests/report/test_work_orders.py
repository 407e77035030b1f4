"""Work orders: a page a room, what to bring, stickers whose codes can be read, and codes that would not be."""

import re

import pypdfium2
import pytest

import assess
from assess.cli.command_new import write_new_workbook
from assess.errors import WorkbookError
from assess.report.content import Content
from assess.report.figures.codes import MOST_BYTES, draw_code
from assess.report.report_options import ReportOptions
from assess.report.say.orders import list_lines, list_orders, list_stickers
from assess.report_formats import DEFAULT
from assess.workbook.read import read_inventory
from tests.report.reading import read_pages, render, write_pdf
from tests.workbooks import ITEMS, UNVERIFIED, assessed

LOOSE = [
    {"item": f"C-{at}", "floor": "2", "room": "Archive", "description": "Cabinet", "breadth": 30, "width": 90,
     "height": 200, "x": float(at), "y": 1.0, "anchored": "no"}
    for at in range(1, 4)
]  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("work") / "w.xlsx", [*LOOSE, *ITEMS])


def test_a_page_a_room_with_its_lines_sums_and_plan(results):
    content = Content(results)
    orders = list_orders(content)
    assert len(orders) >= 3
    page = render(results, for_print=True, edition="work")
    sections = re.findall(r'<section id="work-(\d+)".*?</section>', page, re.DOTALL)
    assert len(sections) == len(orders)
    archive = next(one for one in orders if one.room == "Archive")
    html = next(text for text in re.split(r'(?=<section id="work-)', page) if f"{archive.title}</h2>" in text)
    for line in archive.lines:
        assert f"<strong>{line.number}</strong>" in html
        assert line.say_pull() in html
    fixings = sum(line.work.row.all_fixings for line in archive.lines)
    assert re.search(rf"Fixings in all: [^<]*: {fixings}\+?[.;]", html)
    assert html.count("floor-plan") == 1
    drawn = re.findall(r"<text [^>]*>([^<]+)</text>", html)
    assert {line.number for line in archive.lines} <= set(drawn)
    assert "Signature" in html
    nowhere = next(one for one in orders if not any(each.item.x_m for line in one.lines for each in line.work.results))
    bare = next(text for text in re.split(r'(?=<section id="work-)', page) if f"{nowhere.title}</h2>" in text)
    assert "floor-plan" not in bare.partition("</section>")[0]


def test_what_is_listed_only_is_not_ordered_and_checks_are(results):
    content = Content(results)
    lines, ordered = list_lines(content), [line for one in list_orders(content) for line in one.lines]
    assert {line.phase for line in ordered} <= {"A", "B", ""}
    assert len(ordered) == sum(line.phase != "C" for line in lines)
    assert any("A4" in line.work.row.items for line in ordered), "an anchored piece is to be checked"
    assert len({line.number for line in lines}) == len(lines)


def test_a_sticker_for_each_piece_says_item_room_detail_and_building(results):
    content = Content(results)
    orders = list_orders(content)
    stickers = list(list_stickers(orders, "Town hall"))
    assert len(stickers) == sum(one.pieces for one in orders)
    first = next(one for one in stickers if one.result.item.item == "C-1")
    assert first.text == f"C-1 | Archive | {first.detail} | Town hall"


def test_a_code_is_the_matrix_of_its_text():
    import segno

    text = "C-1 | Archive | L-bracket & straps | Café"
    drawn = draw_code(text)
    assert "<title>C-1 | Archive | L-bracket &amp; straps | Café</title>" in drawn
    dark = set()
    x = y = 0.0
    (path,) = re.findall(r' d="([^"]+)"', drawn)
    for step, values in re.findall(r"([Mmh])(-?[\d.]+(?: ?-?[\d.]+)?)", path):
        numbers = [float(one) for one in re.findall(r"-?\d*\.?\d+", values)]
        if step == "h":
            dark |= {(int(x) + at - 4, int(y) - 4) for at in range(int(numbers[0]))}
            x += numbers[0]
        else:
            x, y = (numbers[0], numbers[1]) if step == "M" else (x + numbers[0], y + numbers[1])
    matrix = segno.make(text, error="m", micro=False, encoding="utf-8").matrix
    assert dark == {(x, y) for y, row in enumerate(matrix) for x, bit in enumerate(row) if bit}
    assert segno.make("x" * MOST_BYTES, error="m", micro=False, boost_error=False, mode="byte").version == 10
    assert segno.make("x" * (MOST_BYTES + 1), error="m", micro=False, boost_error=False, mode="byte").version == 11


def test_a_text_too_long_for_a_code_names_the_cell_and_nothing_is_written(tmp_path):
    results = assessed(tmp_path / "w.xlsx", [LOOSE[0], LOOSE[1] | {"room": "Archive " * 30}])
    with pytest.raises(
        WorkbookError, match=r"Items!A3: the QR code of its sticker would hold 2\d\d bytes, 213 at most"
    ):
        assess.write_reports(results, tmp_path / "out", ("work", "csv"))
    assert not (tmp_path / "out").exists()
    assess.write_reports(results, tmp_path / "out", ("csv",))
    assert "work" not in DEFAULT


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "it"])
def test_the_pdf_of_the_worked_example_has_each_room_and_the_sums(verified_example, tmp_path, language):
    options = ReportOptions(language=language)
    with options.spoken():
        content = Content(verified_example)
        write_pdf(content, tmp_path / "work.pdf", options, edition="work")
        orders = list_orders(content)
        stickers = list(list_stickers(orders, content.title))
    pages = read_pages(tmp_path / "work.pdf")
    sheets = -(-len(stickers) // 24)
    assert 1 + len(orders) + sheets <= len(pages) <= 4 + len(orders) + sheets
    for order in orders:
        page = " ".join(page for page in pages[1:-sheets] if order.title in page)
        assert page
        sums = [line.say_fixings(in_all=True) for line in order.lines if line.work.row.fixings]
        assert all(f" {one} " in page for one in sums)
    text = " ".join(pages[-sheets:])
    assert all(one.result.item.item in text for one in stickers)


@pytest.mark.slow
def test_a_hospital_has_its_work_orders(tmp_path):
    source = tmp_path / "hospital.xlsx"
    write_new_workbook(source, "si", use="Hospital", example=True)
    results = assess.run(read_inventory(source), UNVERIFIED)
    written = assess.write_reports(results, tmp_path / "out", ("work",))
    assert len(pypdfium2.PdfDocument(written["work"])) > len(list_orders(Content(results)))
