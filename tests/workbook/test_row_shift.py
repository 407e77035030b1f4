"""Rows inserted, deleted, or filled in below a table: every reference to cells follows, as in a spreadsheet program."""

import io
import re
from pathlib import Path

import openpyxl
import pytest
import xlsxwriter

from assess.errors import WorkbookError
from assess.workbook.plain_rows import column_letters, split_address
from assess.workbook.read import open_workbook
from assess.workbook.row_shift import Growth, RowMove, RowShift, shift_formula, translate_formula
from tests.recalculate import libreoffice, needs_libreoffice, stored_cells
from tests.workbook.raw import SHEET
from tests.workbook.test_patch import minimal
from tests.workbooks import parts_of

WORKBOOKS = Path(__file__).parents[1]
INSERTED, DELETED = RowShift(5, 2), RowShift(5, -2)
MOVED = [
    ("A4+A5+$A$6", "A4+A7+$A$8", "A4+#REF!+#REF!"), ("SUM(B2:B10)", "SUM(B2:B12)", "SUM(B2:B8)"),
    ("SUM(B5:B6)", "SUM(B7:B8)", "SUM(#REF!)"), ("SUM(B$4:$B5)", "SUM(B$4:$B7)", "SUM(B$4:$B4)"),
    ("SUM(B6:B9)", "SUM(B8:B11)", "SUM(B5:B7)"), ("SUM(5:7)+SUM($1:$3)", "SUM(7:9)+SUM($1:$3)", "SUM(5:5)+SUM($1:$3)"),
    ("SUM(A:C)", "SUM(A:C)", "SUM(A:C)"), ("Items!A9&'Items'!B9", "Items!A11&'Items'!B11", "Items!A7&'Items'!B7"),
    ("Other!A9+'My A9'!A9+[1]Items!A9", "Other!A9+'My A9'!A9+[1]Items!A9", "Other!A9+'My A9'!A9+[1]Items!A9"),
    ('"A9 and ""A9"""&A9', '"A9 and ""A9"""&A11', '"A9 and ""A9"""&A7'),
    ("LOG10(A9)+ATAN2(A9,B9)", "LOG10(A11)+ATAN2(A11,B11)", "LOG10(A7)+ATAN2(A7,B7)"),
    ("Pieces[Cost]+Pieces[[#This Row],[A9]]",) * 3, ("my_A9+A9.x+xA9",) * 3,
    ("OFFSET(A9,1,1):B9", "OFFSET(A11,1,1):B11", "OFFSET(A7,1,1):B7"), ("1E5+2.5E7",) * 3,
]  # fmt: skip


def test_formulas_and_areas_follow_the_cells() -> None:
    for before, inserted, deleted in MOVED:
        assert shift_formula(before, "Items", True, INSERTED) == inserted
        assert shift_formula(before, "Items", True, DELETED) == deleted
    text = "A9+Items!A9+items!$A$9:B$12+'Items'!A9"
    assert shift_formula(text, "Items", False, INSERTED) == "A9+Items!A11+items!$A$11:B$14+'Items'!A11"
    assert shift_formula("'R&D ''5'''!A9", "R&D '5'", False, INSERTED) == "'R&D ''5'''!A11"
    assert translate_formula("C4*$D$4+C$4&$C4", 2) == "C6*$D$4+C$4&$C6"
    assert translate_formula("B4:C5+A$1", 1, 2) == "D5:E6+C$1"
    assert translate_formula("A1+Items!B2", -1) == "#REF!+Items!B1"
    assert INSERTED.area((1, 2, 1, 1_048_576)) == (1, 2, 1, 1_048_576)
    assert DELETED.area((1, 2, 5, 6)) is None
    assert DELETED.area((1, 2, 4, 6)) == (1, 2, 4, 4)
    assert DELETED.area((1, 2, 6, 9)) == (1, 2, 5, 7)
    assert Growth(((7, 9, frozenset({0})),)).area((1, 2, 1, 6)) == (1, 2, 1, 9)
    assert all(INSERTED.back(INSERTED.row(row) or 0) == row for row in range(1, 12))


def _grid() -> bytes:
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed) as book:
        page, other = book.add_worksheet("Items"), book.add_worksheet("Other")
        bold = book.add_format({"bold": True})
        page.write_row(0, 0, ["Item", "Floor", "Cost"])
        for row in range(1, 6):
            page.write_row(row, 0, [f"A{row}", "1", 10 * row], bold)
            page.write_formula(row, 3, f"=C{row + 1}*2", None, 20 * row)
        page.write_comment("A3", "about A2")
        page.write_comment("A5", "about A4")
        page.write_url("B4", "https://example.org/")
        page.merge_range("F3:G4", "merged")
        page.data_validation("B2:B6", {"validate": "list", "source": ["1", "2"]})
        page.conditional_format("C2:C6", {"type": "data_bar", "data_bar_2010": True})
        page.set_h_pagebreaks([3])
        page.autofilter("A1:D6")
        page.print_area("A1:D6")
        other.write_formula("A1", "=SUM(Items!C2:C6)", None, 150)
        other.write_formula("A2", "=Items!C4", None, 30)
        other.write("A3", "Items!C4")
        other.add_sparkline("B1", {"range": "Items!C2:C6"})
        chart = book.add_chart({"type": "column"})
        chart.add_series({"values": "=Items!$C$2:$C$6"})
        other.insert_chart("C1", chart)
        book.define_name("Costs", "=Items!$C$2:$C$6")
    return packed.getvalue()


GRID = _grid()
_AREA = '<(?:mergeCell|dataValidation|conditionalFormatting|autoFilter|hyperlink)[^>]*?ref="([^"]*)'


def _refs(data: bytes) -> dict[str, list[str]]:
    parts = {name: text.decode(errors="replace") for name, text in parts_of(data).items()}
    items, other = (parts[f"xl/worksheets/sheet{number}.xml"] for number in (1, 2))
    return {
        "formulas": re.findall("<f>([^<]*)", items) + re.findall("<f>([^<]*)", other),
        "areas": re.findall(_AREA, items),
        "extension": re.findall("sqref>([^<]+)", items) + re.findall("xm:f>([^<]+)<", other),
        "breaks": re.findall('<brk id="([^"]*)', items),
        "comments": re.findall('<comment ref="([^"]*)', parts["xl/comments1.xml"]),
        "boxes": re.findall("<x:Row>([0-9]*)", parts["xl/drawings/vmlDrawing1.vml"]),
        "chart": re.findall("<c:f>([^<]*)", parts["xl/charts/chart1.xml"]),
        "names": re.findall("<definedName [^>]*>([^<]*)", parts["xl/workbook.xml"]),
    }


def test_everything_follows_rows_that_are_inserted_and_what_is_about_deleted_rows_goes_with_them() -> None:
    data = open_workbook(GRID, "book.xlsx").insert_rows("Items", 4, 2, like=3).to_bytes()
    assert _refs(data) == {
        "formulas": ["C2*2", "C3*2", "C4*2", "C5*2", "C6*2", "C7*2", "C8*2", "SUM(Items!C2:C8)", "Items!C6"],
        "areas": ["A1:D8", "F3:G6", "C2:C8", "B2:B8", "B6"], "extension": ["C2:C8", "Items!C2:C8"], "breaks": ["3"],
        "comments": ["A3", "A7"], "boxes": ["2", "6"], "chart": ["Items!$C$2:$C$8"],
        "names": ["Items!$A$1:$D$8", "Items!$C$2:$C$8", "Items!$A$1:$D$8"],
    }  # fmt: skip
    book = openpyxl.load_workbook(io.BytesIO(data))
    assert [book["Items"].cell(row, 1).value for row in range(1, 9)] == [
        "Item", "A1", "A2", None, None, "A3", "A4", "A5",
    ]  # fmt: skip
    assert book["Items"]["A4"].font.bold, "new rows look as the one that they are like"
    assert book["Other"]["A3"].value == "Items!C4", "a text is no reference"
    data = open_workbook(GRID, "book.xlsx").delete_rows("Items", 3, 2).to_bytes()
    assert _refs(data) == {
        "formulas": ["C2*2", "C3*2", "C4*2", "SUM(Items!C2:C4)", "Items!#REF!"], "areas": ["A1:D4", "C2:C4", "B2:B4"],
        "extension": ["C2:C4", "Items!C2:C4"], "breaks": [], "comments": ["A3"], "boxes": ["2"],
        "chart": ["Items!$C$2:$C$4"], "names": ["Items!$A$1:$D$4", "Items!$C$2:$C$4", "Items!$A$1:$D$4"],
    }  # fmt: skip
    assert b"<mergeCells" not in parts_of(data)[SHEET], "an empty list is no valid XML for Excel"


def test_rows_that_are_moved_take_along_what_is_about_them_and_areas_that_hold_them_stay() -> None:
    book = open_workbook(GRID, "book.xlsx")
    data = book.move_rows("Items", 5, 2, 2).to_bytes()  # A4 and A5 before A1
    assert _refs(data) == {
        "formulas": [*(f"C{row}*2" for row in range(2, 7)), "SUM(Items!C2:C6)", "Items!C6"],
        "areas": ["A1:D6", "F5:G6", "C2:C6", "B2:B6", "B6"], "extension": ["C2:C6", "Items!C2:C6"], "breaks": ["3"],
        "comments": ["A5", "A2"], "boxes": ["4", "1"], "chart": ["Items!$C$2:$C$6"],
        "names": ["Items!$A$1:$D$6", "Items!$C$2:$C$6", "Items!$A$1:$D$6"],
    }  # fmt: skip
    page = openpyxl.load_workbook(io.BytesIO(data))["Items"]
    assert [page.cell(row, 1).value for row in range(1, 7)] == ["Item", "A4", "A5", "A1", "A2", "A3"]
    again = open_workbook(data, "book.xlsx").move_rows("Items", 2, 2, 7)
    assert _refs(again.to_bytes()) == _refs(GRID)
    assert book.move_rows("Items", 2, 1, 7).sheet("Items").value((6, 0)) == "A1"
    with pytest.raises(WorkbookError, match="merged"):
        book.move_rows("Items", 4, 1, 2)
    table = open_workbook((WORKBOOKS / "data" / "workbooks" / "table.xlsx").read_bytes(), "book.xlsx")
    with pytest.raises(WorkbookError, match="into or out of a table"):
        table.move_rows("Items", 2, 1, 40)
    move = RowMove(5, 3, 2)
    assert [move.row(row) for row in range(1, 10)] == [1, 5, 6, 7, 2, 3, 4, 8, 9]
    assert all(one.back(one.row(row)) == row for one in (move, RowMove(2, 2, 9)) for row in range(1, 12))
    text = "A5+A4+SUM(A6:A7)+SUM(A1:A9)+SUM(A1:A6)+SUM(A4:A9)"
    assert shift_formula(text, "Items", True, move) == "A2+A7+SUM(A3:A4)+SUM(A1:A9)+SUM(A1:A7)+SUM(A7:A9)"


def test_rows_that_are_filled_in_below_join_what_ends_above_them_and_a_table_keeps_its_totals() -> None:
    book = open_workbook(GRID, "book.xlsx")
    found = _refs(book.set({"Items": {(7, 0): "A6", (8, 0): "A7", (8, 2): 70}}).to_bytes())
    assert found["areas"] == ["A1:D8", "F3:G4", "C2:C8", "B2:B8", "B4"]
    assert found["extension"] == ["C2:C8", "Items!C2:C6"]
    assert found["names"] == ["Items!$A$1:$D$8", "Items!$C$2:$C$6", "Items!$A$1:$D$8"]
    assert _refs(book.set({"Items": {(9, 0): "apart"}}).to_bytes()) == _refs(GRID), "a row apart joins nothing"
    assert _table({(5, 0): "d", (6, 1): 2}, totals=False) == "A1:B6; A1:B6"
    assert _table({(5, 4): "in another column"}, totals=False) == "A1:B4; A1:B4"
    assert _table({(5, 0): "d"}, totals=True) == "A1:B4; A1:B3"
    with pytest.raises(WorkbookError, match="it is in the totals row of a table"):
        _table({(4, 0): "d"}, totals=True)


def _table(changes: dict[tuple[int, int], float | str | bool | None], *, totals: bool) -> str:
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed) as book:
        page = book.add_worksheet("Items")
        columns = [{"header": "Item"}, {"header": "Cost", **({"total_function": "sum"} if totals else {})}]
        page.add_table("A1:B4", {"columns": columns, "total_row": totals})
        page.write_column("A2", ["a", "b"] if totals else ["a", "b", "c"])
    data = open_workbook(packed.getvalue(), "book.xlsx").set({"Items": changes}).to_bytes()
    return "; ".join(re.findall('ref="([^"]*)"', parts_of(data)["xl/tables/table1.xml"].decode()))


def test_validations_never_come_to_overlap_and_shared_formulas_get_their_own_texts() -> None:
    shared = (
        '<sheetData><row r="1"><c r="A1"><v>1</v></c><c r="B1"><f t="shared" ref="B1:B4" si="0">A1*2+$A$4</f></c></row>'
        '<row r="2"><c r="A2"><v>2</v></c><c r="B2"><f t="shared" si="0"/><v>4</v></c></row>'
        '<row r="3"><c r="A3"><v>3</v></c><c r="B3"><f t="shared" si="0"/><v>6</v></c></row>'
        '<row r="4"><c r="A4"><v>4</v></c><c r="B4"><f t="shared" si="0"></f><v>8</v></c></row></sheetData>'
    )
    tail = '<dataValidations count="2"><dataValidation sqref="A1:A2"/><dataValidation sqref="A3:A9"/></dataValidations>'
    data = minimal('<sheetData><row r="1"><c r="A1"><v>1</v></c></row></sheetData>', tail=tail)
    after = parts_of(open_workbook(data, "book.xlsx").set({"Items": {(3, 0): 3}}).to_bytes())
    assert tail.encode() in after[SHEET]
    data = open_workbook(minimal(shared), "book.xlsx").insert_rows("Items", 3, like=2).to_bytes()
    texts = re.findall("<f[^>]*>([^<]*)</f>", parts_of(data)[SHEET].decode())
    assert texts == ["A1*2+$A$5", "A2*2+$A$5", "A3*2+$A$5", "A4*2+$A$5", "A5*2+$A$5"]


REFUSED = {
    '<sheetData><row r="2"><c r="A2"><f t="array" ref="A2:A5">B2:B5</f></c></row></sheetData>': "array formula",
    "<sheetData><row><c><v>1</v></c></row></sheetData>": "its rows have no numbers",
    '<sheetData><!-- a --><row r="1"/></sheetData>': "comments or raw text",
    '<sheetData><row r="9"><c r="A9"><f t="dataTable" ref="B9:B9" r1="A3"/></c></row></sheetData>': "rows that are deleted",
}


def test_what_cannot_be_moved_is_refused_and_sheets_are_found_by_names_that_formulas_quote() -> None:
    for rows, message in REFUSED.items():
        book = open_workbook(minimal(rows), "book.xlsx")
        with pytest.raises(WorkbookError, match=message):
            (book.delete_rows("Items", 3) if "deleted" in message else book.insert_rows("Items", 3)).to_bytes()
    table = open_workbook((WORKBOOKS / "data" / "workbooks" / "table.xlsx").read_bytes(), "book.xlsx")
    for first, count in ((1, 1), (2, 9)):
        with pytest.raises(WorkbookError, match="a table keeps its headers"):
            table.delete_rows("Items", first, count)
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed) as book:
        book.add_worksheet("Joe's R&D").write_column(0, 0, [1, 2, 3])
        book.add_worksheet("Other").write_formula("A1", "='Joe''s R&D'!A3", None, 3)
    data = open_workbook(packed.getvalue(), "book.xlsx").insert_rows("Joe's R&D", 2).to_bytes()
    assert openpyxl.load_workbook(io.BytesIO(data))["Other"]["A1"].value == "='Joe''s R&D'!A4"


@needs_libreoffice
@pytest.mark.libreoffice
@pytest.mark.slow
@pytest.mark.parametrize("name", ["nets/workbooks/hospital.xlsx", "data/workbooks/table.xlsx"])
def test_every_formula_gives_what_it_gave(tmp_path: Path, name: str) -> None:
    """Blank rows change no result, but where a formula counts rows of Floors (in Lists, too) or an array gets longer."""
    path = WORKBOOKS / name
    book, shifts = open_workbook(path.read_bytes(), path.name), dict[str, list[RowShift]]()
    for sheet, at, count, like in (("Items", 4, 2, 3), ("Floors", 3, 1, 2), ("Items", 2, 1, 2)):
        book = book.insert_rows(sheet, at, count, like=like)
        shifts.setdefault(book.sheet(sheet).title, []).append(RowShift(at, count))
    (tmp_path / "new.xlsx").write_bytes(book.to_bytes())
    old = stored_cells(libreoffice(path, tmp_path / "old-out.xlsx"))
    new = stored_cells(libreoffice(tmp_path / "new.xlsx", tmp_path / "new-out.xlsx"))
    counted = {cell.rstrip("0123456789") for (_, cell), text in old.items() if text == "Row in Floors"}
    differing = {}
    for (sheet, cell), value in old.items():
        column, row = split_address(cell) or (0, 0)
        for shift in shifts.get(sheet, []):
            row = shift.row(row) or 0
        found = new.get((sheet, f"{column_letters(column - 1)}{row}"))
        if found != (pytest.approx(value, rel=1e-12) if isinstance(value, float) else value):
            differing[sheet, cell] = value, found
    others = {key: both for key, both in differing.items() if key[0] not in ("Lists", "My analysis")}
    assert {cell.rstrip("0123456789") for _, cell in others} <= counted, others
    assert len(old) > 100
