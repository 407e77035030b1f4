"""Sheets of the Excel report: what they are, how they are printed and read, with few rows, many floors, long texts."""

import re
from collections.abc import Mapping
from html import unescape
from itertools import pairwise
from threading import Event
from typing import Any

import openpyxl
import openpyxl.utils
import pytest
from openpyxl.packaging.custom import StringProperty

import assess
from assess.errors import CancelledError, WorkbookError
from assess.i18n import Catalogue, speaking
from assess.progress import Progress
from assess.report.content import Content
from assess.report.xlsx import write_xlsx
from assess.report.xlsx.item_formulas import literal, sentence
from assess.report.xlsx.pen import name_sheets, refer
from assess.route_results import RouteState
from assess.settings import Settings
from tests.nets.nets import find_shown
from tests.recalculate import (
    compare_formulas,
    evaluate,
    libreoffice,
    needs_libreoffice,
    poison,
    same,
    stored_cells,
    write_report,
)
from tests.report.routed import DOUBTED, assess_routed
from tests.workbook.books import read_part
from tests.workbooks import FLOORS, ITEMS, assessed, parts_of

NAMES = [
    "Summary", "Work list", "Floors", "Items", "Motions", "Routes", "FEMA E-74", "Tokyo 21 items", "Methods",
    "Assumptions", "Quality log",
]  # fmt: skip
LONG = "A very long name of a cabinet " * 10


def _report(folder, *args, **named):
    write_report(assessed(folder / "w.xlsx", *args, **named), folder / "r.xlsx")
    return folder / "r.xlsx"


def test_every_sheet_is_set_up_for_print_and_items_show_bars_colours_and_choices(tmp_path):
    book = openpyxl.load_workbook(_report(tmp_path, building="575 Market & Sons"))
    assert book.sheetnames == NAMES
    for sheet in book:
        assert (sheet.page_setup.orientation, sheet.page_setup.paperSize) == ("landscape", 9)
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        assert sheet.page_setup.fitToWidth in (None, 1)
        assert sheet.oddHeader.left.text.strip() == "575 Market && Sons"
        assert sheet.oddHeader.right.text.strip() == sheet.title
        assert sheet.oddFooter.left.text.strip() == "Chance of overturning in an earthquake like this one, not per year"
        assert sheet.oddFooter.right.text.strip() == "Page &P of &N"
        if sheet.title != "Summary":
            assert sheet.print_title_rows == ("$1:$2" if sheet.title == "Work list" else "$1:$1")
            assert sheet.freeze_panes in ({"Items": ("D2",), "Work list": ("C3",)}.get(sheet.title, ("A2", "B2")))
        if sheet.title not in ("Summary", "Assumptions"):
            assert sheet.auto_filter.ref
    book = openpyxl.load_workbook(_report(tmp_path, building="&P 9 &R" + "long " * 60))
    text = read_part(tmp_path / "r.xlsx", f"xl/worksheets/sheet{book.sheetnames.index('Items') + 1}.xml")
    header = unescape(re.findall("<oddHeader>(.*?)</oddHeader>", text)[0])
    assert re.fullmatch(r"&L&8 &&P 9 &&Rlong (long )+.*…&R&8 Items", header)
    assert len(header) < 120
    sheet = openpyxl.load_workbook(_report(tmp_path))["Items"]
    rules = [rule.type for area in sheet.conditional_formatting for rule in area.rules]
    assert rules.count("dataBar") == 5
    assert rules.count("beginsWith") == 3 * 4 + 2
    heads = {cell.value: cell.column_letter for cell in sheet[1]}
    choices = {
        str(rule.sqref).rstrip("0123456789").split(":")[0][:-1]: rule for rule in sheet.data_validations.dataValidation
    }
    assert choices[heads["Anchored"]].formula1 == '"no,yes,partly,unknown"'
    assert choices[heads["Height [cm]"]].operator == "greaterThan"
    assert sheet.row_dimensions[1].height >= 30
    comments = [cell.comment.text for cell in sheet[1] if cell.comment]
    assert len(comments) == 7
    assert sheet.print_area.endswith(f"${heads['Basis']}$6")
    assert [heads[label] for label in ("Item", "Class", "Upper class", "Floor")] == list("ABCD")
    for label in ("Chance in an earthquake like this one", "Upper class", "Order: simulated"):
        at, own = openpyxl.utils.column_index_from_string(heads[label]), sheet.column_dimensions
        assert own[heads[label]].hidden or any(one.hidden and one.min <= at <= one.max for one in own.values())


@pytest.mark.parametrize("count", [0, 1])
def test_few_items(tmp_path, count):
    path = _report(tmp_path, ITEMS[:count])
    stored = stored_cells(path)
    assert stored["Floors", "A3"] == "2"  # a floor without items
    assert not [place for place, value in stored.items() if isinstance(value, str) and value.startswith("#")]
    assert compare_formulas(path) > count


@pytest.mark.slow
def test_two_hundred_floors_stay_readable(tmp_path):
    floors = [{"floor": str(at), "name": f"Level {at}", "pfa_x": 0.2 + at / 400} for at in range(200)]
    items = [{"item": f"i{at}", "floor": str(at), "breadth": 30, "width": 80, "height": 150} for at in range(0, 200, 2)]
    path = _report(tmp_path, items, floors)
    charts = "".join(data.decode() for name, data in parts_of(path).items() if "charts/chart" in name)
    assert int(re.findall(r'<c:tickLblSkip val="(\d+)"', charts)[0]) >= 2
    sheet = openpyxl.load_workbook(path)["Summary"]
    assert sheet.page_setup.fitToHeight == 0
    assert int(sheet.print_area.rsplit("$", 1)[1]) < 350
    assert compare_formulas(path) > 2000


def test_long_names_are_whole_in_rows_that_grow_and_columns_hold_the_longest_word(tmp_path):
    items = [ITEMS[0] | {"description": LONG, "notes": "https://example.org"}, *ITEMS[1:]]
    book = openpyxl.load_workbook(_report(tmp_path, items))
    sheet = book["Items"]
    heads = {cell.value: cell.column for cell in sheet[1]}
    cell = sheet.cell(2, heads["Description"])
    assert cell.value == LONG.strip()
    assert cell.alignment.wrap_text
    assert 60 <= sheet.row_dimensions[2].height <= 90
    assert sheet.row_dimensions[3].height in (None, 15)
    assert [row[1:3] for row in book["Notes"].iter_rows(min_row=2, values_only=True)] == [("A1", "https://example.org")]
    words = ("Electrocardiograph-1", "Mezzanine", "Gastroenterology", "Uninterruptible")
    names = ("item", "floor", "room", "description")
    items = [ITEMS[0] | dict(zip(names, words, strict=True))]
    sheet = openpyxl.load_workbook(_report(tmp_path, items, [{"floor": "Mezzanine", "pfa_x": 0.5}]))["Items"]
    letters = {cell.value: cell.column_letter for cell in sheet[1]}
    for name, word in zip(names, words, strict=True):
        assert sheet.column_dimensions[letters[name.capitalize()]].width > len(word.split("-")[0]), name


def test_a_cancelled_report_leaves_nothing(tmp_path):
    content, cancel, rows = Content(assessed(tmp_path / "w.xlsx")), Event(), []

    class Fifth(Progress):
        def check(self):
            rows.append(1)
            if len(rows) == 5:
                cancel.set()
            super().check()

    with pytest.raises(CancelledError):
        write_xlsx(content, tmp_path / "r.xlsx", Fifth(cancel=cancel))
    assert [path.name for path in tmp_path.iterdir()] == ["w.xlsx"]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("routes")
    results = assess_routed(folder / "w.xlsx", Settings(verify="all", runs=20), **DOUBTED)
    write_report(results, folder / "r.xlsx")
    return results, openpyxl.load_workbook(folder / "r.xlsx"), folder / "r.xlsx"


def _colour(state):
    return f"FF{state.fill.removeprefix('#').upper()}"


def test_sheets_of_routes_are_set_up_and_states_have_sign_and_colour(written):
    results, book, _ = written
    for at, one in enumerate(results.route_tables.segments, 2):
        cell = book["Routes"].cell(at, 6)
        assert cell.value.startswith(f"{one.state.symbol} ")
        assert cell.fill.fgColor.rgb == _colour(one.state)
    worst = max((one.state for one in results.route_tables.segments), key=lambda state: state.severity)
    assert worst in (RouteState.BLOCKED, RouteState.NOT_KNOWN)
    assert _colour(worst) in {cell.fill.fgColor.rgb for row in book["Routes"].iter_rows() for cell in row}
    for name, frozen, area in (("Routes", "C2", "A1:AF6"), ("Route pieces", "A2", "A1:P4"),
                               ("Route rooms", "B2", "A1:Z3")):  # fmt: skip
        sheet = book[name]
        assert sheet.freeze_panes == frozen
        assert sheet.auto_filter.ref == area
        assert sheet.print_title_rows == "$1:$1"
        assert sheet.page_setup.orientation == "landscape"
        assert sheet["A1"].fill.fgColor.rgb == "FF1F3A4D"
    assert book["Routes"]["G2"].number_format == "0.0%"
    assert book["Routes"]["U2"].number_format == "0.00"


@pytest.mark.slow
def test_no_text_is_a_formula(written):
    _, book, path = written
    for name in ("Routes", "Route pieces", "Route rooms"):
        for row in book[name].iter_rows():
            assert all(cell.data_type != "f" and cell.hyperlink is None for cell in row)
    assert book["Routes"]["AF2"].value == "=1+1"
    assert compare_formulas(path) > len(ITEMS)


class _Marked(Mapping[str, tuple[str, ...]]):
    """Every text between marks, among them an apostrophe, which names of sheets have to double."""

    def __getitem__(self, key):
        return (f"l'{key} à",) * 2

    def __iter__(self):
        return iter(())

    def __len__(self):
        return 0


MARKED = Catalogue("xx", _Marked())


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    path = tmp_path_factory.mktemp("language") / "w.xlsx"
    return assessed(path, ITEMS, FLOORS, settings=Settings(verify="all", runs=10))


def test_formulas_agree_and_every_heading_is_translated(verified, tmp_path):
    with speaking(MARKED):
        write_report(verified, tmp_path / "r.xlsx")
    stored = stored_cells(tmp_path / "r.xlsx")
    assert not [place for place, value in stored.items() if isinstance(value, str) and value.startswith("#")]
    for sheet in openpyxl.load_workbook(tmp_path / "r.xlsx"):
        assert sheet.title.startswith("l'"), sheet.title
        heads = [str(cell.value) for row in sheet.iter_rows(1, 2 if "Work" in sheet.title else 1) for cell in row
                 if cell.value]  # fmt: skip
        assert heads
        assert all(head.startswith("l'") for head in heads), heads
    assert compare_formulas(tmp_path / "r.xlsx") > 12 * len(ITEMS)


@pytest.mark.libreoffice
@needs_libreoffice
def test_libreoffice_agrees_in_another_language(verified, tmp_path):
    path = tmp_path / "r.xlsx"
    with speaking(MARKED):
        write_report(verified, path)
    stored = stored_cells(path)
    poison(path)
    found = stored_cells(libreoffice(path, tmp_path / "again.xlsx"))
    assert not [place for place, value in stored.items() if not same(value, found.get(place))]


def test_names_of_sheets_hold_excels_rules_sentences_with_holes_are_expressions_and_headings_stay_apart():
    names = name_sheets({
        "a": "Qualità: log?", "b": "qualità  log", "c": "'x'", "d": "y" * 40, "e": "Y" * 40, "f": "[]",
    })  # fmt: skip
    assert names == {
        "a": "Qualità  log", "b": "qualità  log 2", "c": "x", "d": "y" * 31, "e": "Y" * 29 + " 2", "f": "f",
    }  # fmt: skip
    assert refer("L'arredo") == "'L''arredo'!"
    assert literal('a "b"') == '"a ""b"""'
    assert sentence("{all} of {some}.", some="A1", all="B2") == 'B2&" of "&A1&"."'
    # Columns are told apart by their headings: two with the same translation would be one.
    for name in ("everything-it", "italiano", "ospedale-san-carlo"):
        lines = find_shown(name, "xlsx").read_text(encoding="utf-8").splitlines()
        heads = [after for before, after in pairwise(lines) if before.startswith("# ") and after.startswith("1: A ")]
        assert len(heads) > 8
        for line in heads:
            texts = [cell.partition(" ")[2] for cell in line.removeprefix("1: ").split(" | ")]
            assert len(texts) == len(set(texts)), line


def test_a_report_is_no_workbook_and_names_the_one_to_edit(tmp_path):
    """Also after another program has saved it; and a file of the user's own, whatever it says of itself, is none."""
    results = assessed(tmp_path / "book.xlsx", ITEMS, FLOORS)
    write_xlsx(Content(results), tmp_path / "report.xlsx")
    name = results.provenance.workbook
    openpyxl.load_workbook(tmp_path / "report.xlsx").save(tmp_path / "saved.xlsx")
    for file in ("report.xlsx", "saved.xlsx"):
        with pytest.raises(WorkbookError) as caught:
            assess.read_inventory(tmp_path / file)
        (problem,) = caught.value.problems
        assert str(problem.message) == f"{file} is a report of {name}: edit {name} and run that."
    book = openpyxl.load_workbook(tmp_path / "book.xlsx")
    properties: Any = book
    properties.custom_doc_props.append(StringProperty(name="Report of", value="assess: report of a.xlsx"))
    book.save(tmp_path / "own.xlsx")
    assert assess.read_inventory(tmp_path / "own.xlsx", strict=False).items


def test_what_rolls_is_marked_and_counted_apart_and_no_edit_brings_it_into_a_class(tmp_path):
    cart = {"item": "cart", "floor": "1", "breadth": 60, "height": 160, "mobile": "yes", "quantity": 3}
    path = _report(tmp_path, [cart, {"item": "case", "floor": "1", "breadth": 40, "height": 180}])
    book = openpyxl.load_workbook(path, data_only=True)
    compare_formulas(path)
    heads = [cell.value for cell in book["Items"][1]]
    row = {head: cell.value for head, cell in zip(heads, book["Items"][2], strict=True)}
    assert row["Basis"] == "rolls: not covered"
    assert {str(row[name])[0] for name in ("Class", "Class (formula)", "Class (OR)")} == {"◎"}
    summary = {cells[0]: cells[1:] for cells in book["Summary"].iter_rows(values_only=True)}
    assert (summary["rolls: not covered"][4], summary["all"][4]) == (3, 4)
    assert sum(summary["formula (not simulated)"][:4]) == summary["formula (not simulated)"][4] == 1
    at = {head: place for place, head in enumerate(heads, 1)}
    edited = evaluate(path, [("Items", 2, at["Breadth [cm]"], 20)])
    assert edited.get_value("Items", 2, at["Class"]) == "run again"
    below = {edited.get_value("Summary", row, 1): row for row in range(1, 40)}
    assert edited.get_value("Summary", below["formula (not simulated)"], 6) == 1
    assert edited.get_value("Summary", below["run again"], 6) == 3
