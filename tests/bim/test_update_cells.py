"""New rows of a model in workbooks of all kinds: units, languages, orders of columns, tables, headings, formulas."""

import io
from pathlib import Path
from typing import Any

import openpyxl
import pytest
import xlsxwriter
from openpyxl.worksheet.table import Table as ExcelTable

from assess.bim.import_workbook import ImportedBuilding
from assess.bim.update_workbook import update_workbook
from tests.bim.update_books import (
    FLOORS,
    ITEMS,
    PLACES,
    TYPES,
    building,
    changed,
    faults,
    in_units,
    inventory,
    kinds,
    line,
    piece,
    resaved,
    row,
    table,
    texts,
    typed,
    update,
)
from tests.recalculate import evaluate, stored_cells
from tests.workbook.books import write_book
from tests.workbooks import address

NEW = piece(7, "Level 2", "B201 Office", breadth=44.5)


def grown(*new: dict[str, Any], **more: Any) -> ImportedBuilding:
    return building(items=[*ITEMS, *(new or (NEW,))], **more)


@pytest.mark.slow
def test_a_new_piece_goes_into_the_next_row_under_a_name_of_its_own(
    book: bytes,
) -> None:
    found = update(book, grown())
    assert texts(found) == ["Items A8 B201-07 was added"]
    one = inventory(found.data).items[-1]
    assert (one.row, one.item, one.floor, one.room, one.type) == (8, "B201-07", "Level 2", "B201 Office", "Wardrobe 80")
    assert [one.breadth, one.x, one.y, one.angle_deg] == pytest.approx([0.445, 7, 1.5, 90])
    assert one.more["source_id"] == NEW["source_id"]
    new = [{**NEW, "item": f"N{at}", "source_id": f"new {at}"} for at in range(20)]
    found = update(book, grown(*new))
    assert kinds(found) == ["added"] * 20
    assert len(inventory(found.data).items) == 26
    data = typed(book, row=3, item="b201-07")
    found = update(data, grown(NEW, {**NEW, "source_id": "other"}))
    assert texts(found) == ["Items A8 B201-07 (2) was added", "Items A9 B201-07 (3) was added"]
    assert faults(found.data) == []
    data = typed(book, row=12, item="Own", floor="Level 1", breadth=40, height=180)
    assert texts(update(data, grown())) == ["Items A13 B201-07 was added"]


@pytest.mark.slow
def test_live_formulas_stay_and_work_in_new_rows(book: bytes, tmp_path: Path) -> None:
    data = line(book, shaking="MMI VIII, severe")
    found = update(data, grown())
    path = tmp_path / "new.xlsx"
    path.write_bytes(found.data)
    was, new = (openpyxl.load_workbook(io.BytesIO(one))["Items"] for one in (data, found.data))
    formulas = {cell.coordinate: cell.value for line in was.iter_rows() for cell in line if cell.data_type == "f"}
    assert formulas == {
        cell.coordinate: cell.value for line in new.iter_rows() for cell in line if cell.data_type == "f"
    }
    evaluated, stored, ratio = evaluate(path), stored_cells(path), address("B/H", 8)
    assert stored["Items", ratio] == pytest.approx(44.5 / 200)
    for label in ("B/H", "PFA used [g]", "OR", "Class (formula)", "Can rock"):
        cell, expected = new[address(label, 8)], stored["Items", address(label, 8)]
        result = evaluated.get_value("Items", cell.row, cell.column)
        assert result == (expected if isinstance(expected, str) else pytest.approx(expected)), label


@pytest.mark.slow
def test_below_something_else_nothing_is_added_and_all_is_listed(book: bytes) -> None:
    model = building(items=[*changed(p1={"breadth": 60.0}).items, NEW])
    for fields in ({"item": "Total", "quantity": 6}, {"notes": "Checked by Ann"}, {"item": "Next ward"}):
        found = update(typed(book, row=9, **fields), model)
        assert texts(found)[1:] == ["Items B201-07 of the model was left out"]
        (problem,) = found.problems
        assert str(problem) == (
            "Items!A9: 1 new row of the model was not added: row 9, the last that holds something, is not a complete "
            "entry. Move what stands below the last complete row of this sheet elsewhere, then import again."
        )
        assert row(found.data).get("breadth") == pytest.approx(0.6), "what is there already is updated all the same"

    def total(workbook: Any) -> None:
        workbook["Items"][address("quantity", 10)] = "=SUM(G2:G8)"

    found = update(resaved(book, total), grown())
    assert kinds(found) == ["left_out"]
    assert "row 10" in str(found.problems[0])


def test_under_merged_cells_nothing_is_added_and_elsewhere_new_types_places_and_pieces(book: bytes) -> None:
    found = update(resaved(book, lambda one: one["Items"].merge_cells("A8:C9")), grown())
    assert kinds(found) == ["left_out"]
    assert "merged cells or a formula of several cells stand below row 7" in str(found.problems[0])
    kind = {**TYPES[0], "type": "Safe made to measure", "width": 60.0}
    place = {"place": "B202 Store", "floor": "Level 2", "x": 9.0, "y": 2.0, "kind": "room"}
    new = {**NEW, "type": "Safe made to measure", "room": "B202 Store"}
    found = update(book, grown(new, types=[*TYPES, kind], places=[*PLACES, place]))
    assert kinds(found) == ["added"] * 3
    read = inventory(found.data)
    assert faults(found.data) == []
    assert {one.type for one in read.catalogue} >= {"Safe made to measure"}
    assert len(table(found.data, "Catalogue").rows) == len(table(book, "Catalogue").rows) + 1
    model = grown(NEW, {**NEW, "item": "Other"})
    found = update_workbook(book, model, "house.xlsx")
    assert kinds(found) == ["added", "added"]
    again = update_workbook(found.data, model, "house.xlsx")
    assert (kinds(again), again.data) == (["kept"], found.data)


@pytest.mark.slow
def test_what_another_program_saved_with_formulas_in_a_column_of_its_own_is_updated(book: bytes) -> None:
    def prepare(workbook: Any) -> None:
        page = workbook["Items"]
        at = page.max_column + 1
        page.cell(1, at, "Volume")
        for number in range(2, 40):
            page.cell(number, at, f"=H{number}*I{number}")

    assert update(resaved(book)).changes == ()
    found = update(resaved(book, prepare), building(items=[*changed(p3={"breadth": 60.0}).items, NEW]))
    assert texts(found)[1:] == ["Items A8 B201-07 was added"]


@pytest.mark.parametrize("language", ["en", "it"])
@pytest.mark.slow
def test_imperial_headers_in_any_language(tmp_path: Path, language: str) -> None:
    data = in_units(tmp_path / "book.xlsx", building(), language)
    assert update(data).changes == ()
    model = changed(p3={"breadth": 60.0, "x": 4.0})
    new = {"place": "B202", "floor": "Level 2", "x": 9.0, "y": 2.0, "kind": "exit", "outline": "6 0; 12.5 0; 12.5 4"}
    found = update(data, building(items=[*model.items, NEW], places=[*PLACES, new]))
    assert kinds(found) == ["changed", "changed", "added", "added"]
    breadth, x = found.changes[:2]
    assert (breadth.now, x.now) == (23.622, 13.1234)
    assert (breadth.label.endswith("[in]"), x.label) == (True, "X [ft]")
    read = inventory(found.data)
    assert [read.items[2].breadth, read.items[2].x] == pytest.approx([0.6, 4.0], abs=5e-5)
    assert read.items[-1].breadth == pytest.approx(0.445, abs=5e-5)
    place = read.places[-1]
    assert place.kind == "exit"
    assert [one for corner in place.outline for one in corner] == pytest.approx([6, 0, 12.5, 0, 12.5, 4], abs=1e-4)
    word = openpyxl.load_workbook(io.BytesIO(found.data)).worksheets[4][address("kind", 6, "Places")].value
    assert word == {"en": "exit", "it": "uscita"}[language]


def in_own_order(path: Path, *, is_table: bool = False) -> bytes:
    """A workbook with columns of one's own, in another order and other units, and perhaps as a table of Excel."""
    head = ["Source ID", "Y [mm]", "X [mm]", "Inventory no.", "Floor", "Item", "Height [m]", "Breadth [mm]", "Room"]
    rows = [
        [one["source_id"], one["y"] * 1000, one["x"] * 1000, f"INV-{at}", one["floor"], one["item"],
         one["height"] / 100, one["breadth"] * 10, one["room"]]
        for at, one in enumerate(ITEMS)
    ]  # fmt: skip
    with xlsxwriter.Workbook(path) as book:
        page = book.add_worksheet("Items")
        for number, values in enumerate([head, *rows]):
            page.write_row(number + 2, 1, values)
        if is_table:
            page.add_table(2, 1, 2 + len(rows), len(head), {"columns": [{"header": one} for one in head]})
        floors = book.add_worksheet("Floors")
        floors.write_row(0, 0, ["Floor", "Elevation [m]"])
        for number, one in enumerate(FLOORS, 1):
            floors.write_row(number, 0, [one["floor"], one["elevation"]])
    return path.read_bytes()


@pytest.mark.parametrize("is_table", [False, True])
def test_columns_in_another_order_and_other_units(tmp_path: Path, is_table: bool) -> None:
    data = in_own_order(tmp_path / "book.xlsx", is_table=is_table)
    found = update(
        data, building(items=[*changed(p3={"breadth": 60.0, "height": 190.0}).items, NEW], places=[], types=[])
    )
    assert texts(found) == [
        "Floors Plan of the model was left out: the sheet has no such column",
        "Floors Plan left X of the model was left out: the sheet has no such column",
        "Floors Plan bottom Y of the model was left out: the sheet has no such column",
        "Floors Plan width of the model was left out: the sheet has no such column",
        "Items Width of the model was left out: the sheet has no such column",
        "Items Angle of the model was left out: the sheet has no such column",
        "Items I6 Breadth [mm] of A102-03: 545 -> 600",
        "Items H6 Height [m] of A102-03: 2 -> 1.9",
        "Items G10 B201-07 was added",
    ]
    one = inventory(found.data).items[-1]
    assert [one.breadth, one.height, one.x, one.y] == pytest.approx([0.445, 2.0, 7.0, 1.5])
    values = {
        cell.coordinate: cell.value for line in openpyxl.load_workbook(io.BytesIO(found.data))["Items"] for cell in line
    }
    assert (values["E9"], values["E10"], values["I10"]) == ("INV-5", None, 445)


def test_an_unknown_unit_is_left_alone_and_headings_blank_rows_and_typed_units_are_read(
    tmp_path: Path,
) -> None:
    data = resaved(in_own_order(tmp_path / "book.xlsx"), lambda one: one["Items"].__setitem__("I3", "Breadth [stone]"))
    found = update(data, building(items=changed(p3={"breadth": 60.0}).items, places=[], types=[], floors=FLOORS[:0]))
    assert "Items Breadth of the model was left out: its header gives no known unit" in texts(found)
    # As people fill in: a title, wards as headings, units in cells, a name with stray spaces.
    head = ["Item", "Floor", "Room", "Breadth [cm]", "Width [cm]", "Height [cm]", "Anchored", "X [m]", "Y [m]"]
    head += ["Source ID"]
    rows: list[list[Any]] = [["Furniture of the house, as of May"], [], head, ["GROUND FLOOR"]]
    for at, one in enumerate(ITEMS):
        rows += [[], ["UPPER FLOOR"]] if at == 4 else []
        rows.append([f"W-{at}", f"{one['floor']} ", one["room"], f"{one['breadth']} cm".replace(".", ","), one["width"],
                     f"{one['height'] / 100:g} m", "N", one["x"], one["y"], f" {one['source_id']}"])  # fmt: skip
    floors: list[list[Any]] = [["Floor", "Elevation [m]"], ["Level 1", "0,0"], ["Level 2", 3.1]]
    data = write_book(tmp_path / "book.xlsx", {"Items": rows, "Floors": floors}).read_bytes()
    model = building(items=[*changed(p2={"height": 80.0}).items, NEW], places=[], types=[], floors=[])
    found = update(data, model)
    assert [one for one in texts(found) if "no such column" not in one] == [
        "Items F6 Height [cm] of W-1: '0.75 m' -> 80",
        "Items A13 B201-07 was added",
    ]
    assert [one.item for one in inventory(found.data).items] == [*(f"W-{at}" for at in range(6)), "B201-07"]


@pytest.mark.parametrize("label", [None, "Total"])
def test_a_table_of_excel_with_a_row_of_totals(tmp_path: Path, label: str | None) -> None:
    def total(book: Any) -> None:
        page = book["Items"]
        page["B10"] = label
        page["I10"] = "=SUBTOTAL(109,I4:I9)"
        area = ExcelTable(displayName="Furniture", ref="B3:J10")
        area._initialise_columns()  # type: ignore[attr-defined]
        for column, value in zip(area.tableColumns, page["B3:J3"][0], strict=True):
            column.name = value.value
        area.totalsRowCount = 1
        page.add_table(area)

    found = update(resaved(in_own_order(tmp_path / "book.xlsx"), total), grown(places=[], types=[]))
    assert "Items B201-07 of the model was left out" in texts(found)
    assert "row 10 is the totals row of a table. Turn the totals row of the table off" in str(found.problems[0])
