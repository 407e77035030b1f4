"""An edit of a PFA, a size or a class limit gives what a run of the edited workbook would, charts included."""

import dataclasses
import re
from typing import Any

import openpyxl
import pytest
from openpyxl.utils.cell import coordinate_to_tuple

import assess
from assess.risk import RiskClass
from tests.recalculate import evaluate, libreoffice, needs_libreoffice, stored_cells, write_report
from tests.workbooks import UNVERIFIED, assessed, parts_of, write

FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2}, {"floor": "2", "pfa_x": 0.5, "pfv_x": 40.0}]
SIZES = [(20, 200), (30, 200), (36, 92), (45, 90), (60, 60), (28, 180), (33, 170)]
ITEMS: list[dict[str, Any]] = [
    {"item": f"{floor}-{at}", "floor": floor, "breadth": breadth, "width": 120, "height": height,
     "quantity": 1 + at % 2} | ({"anchored": "yes"} if at == 3 else {})
    for floor in "12" for at, (breadth, height) in enumerate(SIZES)
]  # fmt: skip
LIMITS = (0.03, 0.3, 0.7)
EDITS = {
    "nothing": ({}, {}, LIMITS),
    "a PFA and a size": ({"pfa_x": 0.85}, {"breadth": 70, "height": 90}, LIMITS),
    "all of them": ({"pfa_x": 0.12}, {"breadth": 40, "height": 250}, (0.01, 0.2, 0.45)),
}
EDITED_ITEM, EDITED_FLOOR = 1, 0


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("edits")
    write_report(assessed(folder / "w.xlsx", ITEMS, FLOORS), folder / "r.xlsx")
    return folder / "r.xlsx"


def _cells(path, floor, item, limits):
    """Return the cells of the report that an edit changes, with their new values."""
    heads = {cell.value: cell.column_letter for cell in openpyxl.load_workbook(path)["Items"][1]}
    cells = {("Floors", f"C{EDITED_FLOOR + 2}"): value for value in floor.values()}
    labels = {"breadth": "Breadth [cm]", "height": "Height [cm]"}
    cells |= {("Items", f"{heads[labels[name]]}{EDITED_ITEM + 2}"): value for name, value in item.items()}
    return cells | {("Assumptions", f"B{row}"): limit for row, limit in enumerate(limits, 2)}


def _run(folder, floor, item):
    floors, items = [dict(one) for one in FLOORS], [dict(one) for one in ITEMS]
    floors[EDITED_FLOOR] |= floor
    items[EDITED_ITEM] |= item
    return list(assessed(folder / "edited.xlsx", items, floors))


def _class(one, limits):
    return RiskClass(sum(one.adopted.probability >= limit for limit in limits))


def _expected(results, limits):
    """Return classes by item, counts by floor, and the highest chances."""
    classes = {one.item.item: ("⚓ " if one.is_anchored else "") + _class(one, limits).label for one in results}
    counts = {}
    for floor in ("1", "2"):
        here = [one for one in results if one.item.floor == floor]
        free = [one for one in here if not one.is_anchored]
        by_class = [sum(one.item.quantity for one in free if _class(one, limits) == risk) for risk in RiskClass]
        anchored = sum(one.item.quantity for one in here if one.is_anchored)
        counts[floor] = [*by_class, anchored, sum(by_class) + anchored]
    chances = sorted((one.adopted.probability for one in results if not one.is_anchored), reverse=True)
    return classes, counts, chances[:10]


def _shown(read, path):
    """Return the same from the report; `read` gives the value of a cell."""
    book = openpyxl.load_workbook(path)
    letters = {cell.value: cell.column_letter for cell in book["Items"][1]}
    rows = range(2, 2 + len(ITEMS))
    classes = {read("Items", f"A{row}"): read("Items", f"{letters['Class']}{row}").rstrip("*") for row in rows}
    at = {cell.value: cell.row for cell in book["Summary"]["A"] if isinstance(cell.value, str)}
    counts = {floor: [read("Summary", f"{letter}{at['Floor'] + int(floor)}") for letter in "BCDEHI"] for floor in "12"}
    total = [read("Summary", f"{letter}{at['Building'] + 1}") for letter in "BCDE"]
    total += [read("Summary", f"F{at['Building'] + 3}"), read("Summary", f"F{at['Building'] + 4}")]
    assert total == [sum(both) for both in zip(*counts.values(), strict=True)]
    chances = [read("Summary", f"E{at['Item'] + row}") for row in range(1, 11)]
    return classes, counts, chances


def _compare(found, expected):
    assert found[:2] == expected[:2]
    assert found[2] == pytest.approx(expected[2], abs=1e-9)


@pytest.mark.parametrize("edit", EDITS)
def test_an_edit_gives_what_a_run_would(path, tmp_path, edit):
    floor, item, limits = EDITS[edit]
    edits = _cells(path, floor, item, limits).items()
    book = evaluate(path, ((sheet, *coordinate_to_tuple(cell), value) for (sheet, cell), value in edits))
    expected = _expected(_run(tmp_path, floor, item), limits)
    _compare(_shown(lambda sheet, cell: book.get_value(sheet, *coordinate_to_tuple(cell)), path), expected)


@pytest.mark.libreoffice
@needs_libreoffice
def test_an_edit_gives_in_libreoffice_what_a_run_would(path, tmp_path):
    floor, item, limits = EDITS["all of them"]
    book = openpyxl.load_workbook(path)
    for (sheet, cell), value in _cells(path, floor, item, limits).items():
        book[sheet][cell] = value
    book.save(tmp_path / "changed.xlsx")
    cells = stored_cells(libreoffice(tmp_path / "changed.xlsx", tmp_path / "again.xlsx"))
    expected = _expected(_run(tmp_path, floor, item), limits)
    _compare(_shown(lambda sheet, cell: cells.get((sheet, cell)), path), expected)


def test_every_chart_draws_cells_that_follow_an_edit_in_the_colours_of_the_classes_and_patterns(path):
    """What charts draw are formulas, or in Floors the cells to edit; and each tells in words what it shows."""
    book = openpyxl.load_workbook(path)
    parts = {name: data.decode() for name, data in parts_of(path).items() if name.endswith(".xml")}
    charts, drawings = (
        [text for name, text in parts.items() if kind in name] for kind in ("charts/chart", "drawings/drawing")
    )
    assert len(charts) == 4
    assert sum(text.count(' descr="') for text in drawings) == 4
    for chart in charts:
        areas = re.findall(r"<c:val><c:numRef><c:f>'?([^'!]+)'?!([^<]+)</c:f>", chart)
        assert areas
        for sheet, area in areas:
            cells = [cell for row in book[sheet][area.replace("$", "")] for cell in row]
            assert all(cell.data_type == "f" or cell.fill.fgColor.rgb == "FFFFFBE6" for cell in cells), (sheet, area)
            if any(
                any(one.hidden and one.min <= cell.column <= one.max for one in book[sheet].column_dimensions.values())
                for cell in cells
            ):
                assert '<c:plotVisOnly val="1"/>' not in chart, "it would be empty"
    text = "".join(charts)
    for risk in RiskClass:
        assert text.count(risk.fill.removeprefix("#").upper()) >= 3
    assert text.count("<a:pattFill") >= 6


GROUND = {"period": 1.0, "ground_pga": 0.2, "ground_pgv": 12.0}


def _run_following(folder, pfa, scale=1.0):
    floors = [{"floor": str(at), "pfa_x": one} for at, one in enumerate(pfa)]
    items = [
        {"item": f"{at}-{b}", "floor": str(at), "breadth": b, "width": 120, "height": 150, "axis": "X"}
        for at in range(len(pfa)) for b in (20, 40, 60)
    ]  # fmt: skip
    settings = dataclasses.replace(UNVERIFIED, scale=scale)
    return assessed(folder / "w.xlsx", items, floors, settings=settings, **GROUND)


def _edit_pfa(path, pfa, out):
    book = openpyxl.load_workbook(path)
    for row, value in enumerate(pfa, 2):
        book["Floors"][f"C{row}"] = value
    book.save(out)
    return out


EDITED = [0.06, 0.6, 0.09]
"""PFA to which the floors are edited, as scaled by 1.5."""


def test_velocity_follows_an_edited_acceleration_as_in_a_run(tmp_path):
    """PGV/PGA 60 cm/s per g, T1 1 s, and an unknown height: PFV/PFA is 60 x 1.841/1.334 = 82.8 cm/s for each g."""
    write_report(_run_following(tmp_path, [0.3, 0.2, 0.03], 1.5), tmp_path / "r.xlsx")
    edited = _edit_pfa(tmp_path / "r.xlsx", EDITED, tmp_path / "edited.xlsx")
    book = evaluate(edited)
    at = {cell.value: cell.column for cell in openpyxl.load_workbook(edited)["Items"][1]}["Kaneko-Hayashi"]
    results = _run_following(tmp_path, [one / 1.5 for one in EDITED], 1.5)
    velocities = [results.motions_of(str(floor), axis)[0].pfv_cm_s for axis in "XY" for floor in range(3)]
    chances = [one.governing.methods["kaneko_hayashi"].value for one in results]
    assert velocities[:3] == pytest.approx([82.80 * one for one in EDITED], rel=1e-3)
    assert [book.get_value("Floors", row, column) for column in (4, 7) for row in (2, 3, 4)] == pytest.approx(
        velocities, abs=1e-9
    )
    assert [book.get_value("Items", row, at) for row in range(2, 11)] == pytest.approx(chances, abs=1e-9)


def test_the_velocity_of_a_floor_that_hardly_moves_and_an_axis_that_borrows_its_motion_follow_an_edit(tmp_path):
    results = assessed(tmp_path / "w.xlsx", ITEMS[:1], [{"floor": "1", "pfa_x": 0.0001}], period=1.0)
    write_report(results, tmp_path / "r.xlsx")
    book = evaluate(_edit_pfa(tmp_path / "r.xlsx", [0.5], tmp_path / "edited.xlsx"))
    ratio = results.motions[0].pfv_cm_s / results.motions[0].pfa_g
    assert ratio == pytest.approx(105 * 1.816 / 1.535, rel=1e-3)
    assert book.get_value("Floors", 2, 4) == pytest.approx(0.5 * ratio, abs=1e-9)
    items = [ITEMS[0] | {"axis": "X"}, ITEMS[1] | {"axis": "Y"}, ITEMS[2]]
    write_report(
        assessed(tmp_path / "w.xlsx", items, [{"floor": "1", "pfa_y": 0.9, "pfv_y": 12.0}]), tmp_path / "r.xlsx"
    )
    again = assessed(tmp_path / "edited.xlsx", items, [{"floor": "1", "pfa_y": 0.2, "pfv_y": 80.0}])
    book = evaluate(tmp_path / "r.xlsx", [("Floors", 2, 6, 0.2), ("Floors", 2, 7, 80.0)])
    at = {cell.value: cell.column for cell in openpyxl.load_workbook(tmp_path / "r.xlsx")["Items"][1]}
    for row, one in enumerate(again, 2):
        for label, key in (("OR", "proposed_or"), ("Kaneko-Hayashi", "kaneko_hayashi"), ("FEMA P-58", "fema_p58")):
            expected = pytest.approx(one.governing.methods[key].value, abs=1e-9)
            assert book.get_value("Items", row, at[label]) == expected


def test_a_size_that_is_no_number_shows_check_and_leaves_the_counts_alive(path):
    sheets = openpyxl.load_workbook(path)
    at: dict[Any, Any] = {cell.value: cell.column for cell in sheets["Items"][1]}
    book = evaluate(path, [("Items", 2, at["Breadth [cm]"], "abc")])
    for label in ("B/H", "OR as printed", "OR", "Kaneko-Hayashi", "Class (formula)"):
        assert book.get_value("Items", 2, at[label]) == "check"
    top = next(cell.row for cell in sheets["Summary"]["A"] if cell.value == "Floor")
    assert book.get_value("Summary", top + 1, 9) == sum(one["quantity"] for one in ITEMS[1:7])


def test_unknown_columns_come_back(tmp_path):
    path = write(tmp_path / "w.xlsx", ITEMS, FLOORS)
    book = openpyxl.load_workbook(path)
    book["Items"].cell(1, 30, "Inventory tag")
    book["Items"].cell(2, 30, "T-17")
    book.save(path)
    write_report(assess.run(assess.read_inventory(path), UNVERIFIED), tmp_path / "r.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "r.xlsx")["Items"]
    assert [row[0].value for row in sheet.iter_cols() if row[1].value == "T-17"] == ["Inventory tag"]
