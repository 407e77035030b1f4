"""The live columns against the program: the same numbers to 1e-9, whatever units the headers give.

Every stored result is overwritten with a wrong one first, so that an engine which does not calculate is found out.
"""

import re
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from openpyxl.formula.translate import Translator

from assess.errors import WorkbookError
from assess.i18n import gettext, load_catalogue, speaking
from assess.pipeline.live_values import live_values, without_shaking
from assess.units import QUANTITIES
from assess.workbook.catalogue import read_catalogue
from assess.workbook.lists import LETTERS, PLACES
from assess.workbook.names import translate_header
from assess.workbook.read import read_inventory
from assess.workbook.schema import LIVE, SHEETS, WORKINGS
from assess.workbook.template import ROWS, Content, Units, write_workbook
from tests.recalculate import evaluate, same
from tests.workbook.books import change_parts, read_part

Live = list[Any]
Rows = list[dict[str, Any]]

AGREEMENT = 1e-9
POISON = 0.123
MOST_COLUMNS = 80
ITEMS_AT = 3
"""Place of the sheet Items, whatever its name: after Help, Building and Floors."""

FLOORS: Rows = [
    {"floor": "x", "pfa_x": 0.45},
    {"floor": "y", "pfa_y": 0.3},
    {"floor": "alike", "pfa_x": 0.4, "pfa_y": 0.4, "pfv_x": 40, "pfv_y": 90},
    {"floor": "both", "pfa_x": 0.6, "pfa_y": 0.35, "pfv_x": 25, "pfv_y": 110},
    {"floor": "Y more", "pfa_x": 0.2, "pfa_y": 0.25, "pfv_x": 60},
    {"floor": "6", "pfa_x": 0.15, "pfa_y": 0.95, "pfv_y": 45},
    {"floor": "strong", "pfa_x": 1.6, "pfa_y": 0.9, "pfv_x": 150, "pfv_y": 20},
    {"floor": "still", "pfa_x": 0.0001, "pfa_y": 0.02},
]
SIZES: Rows = [
    {"breadth": 10, "height": 200}, {"breadth": 28, "height": 200}, {"breadth": 40, "height": 180},
    {"breadth": 75, "height": 150}, {"breadth": 150, "height": 100}, {"type": "Bookcase 5 shelves"},
    {"type": "bookcase 6 shelves", "breadth": 55, "centre_of_gravity": 30},
    {"breadth": 90, "height": 180, "centre_of_gravity": 75},
]  # fmt: skip
DIRECTIONS: Rows = [
    {}, {"axis": "X"}, {"axis": "Y"}, {"angle_deg": 15}, {"angle_deg": 45}, {"angle_deg": -80},
    {"angle_deg": 90, "axis": "X"},
]  # fmt: skip
GRID: Rows = [
    {"item": f"A{number}", "floor": floor["floor"], **size, **direction}
    for number, (floor, size, direction) in enumerate(product(FLOORS, SIZES, DIRECTIONS))
]

RETYPED: Mapping[str, Mapping[tuple[str, str], str]] = {
    "mm": {("Items", "breadth"): "mm", ("Items", "height"): "mm", ("Floors", "pfa_x"): "gal"},
    "mixed": {
        ("Items", "breadth"): "in", ("Items", "height"): "ft", ("Catalogue", "breadth"): "m",
        ("Catalogue", "height"): "mm", ("Floors", "pfa_x"): "m/s²", ("Floors", "pfa_y"): " CM / S2 ",
        ("Floors", "pfv_x"): "m/s", ("Floors", "pfv_y"): "In/s",
    },
    "powers": {("Floors", "pfa_x"): "m/s^2", ("Floors", "pfa_y"): "cm/s^2"},
}  # fmt: skip


TYPES = ("Bookcase 5 shelves", "Bookcase 6 shelves")


# ---------------------------------------------------------------- workbooks


def fill(
    path: Path, items: Rows, floors: Rows, building: dict[str, Any], units: Units = "si", spare: int | None = 5,
    catalogue: Rows | None = None,
) -> Path:  # fmt: skip
    """Write a workbook whose values mean the same in any units: they are given in cm, g and cm/s.

    It has `spare` prepared rows a table in place of hundreds, which take long to recalculate, and the types that are
    used here alone; None leaves them all.
    """
    if catalogue is None and spare is not None:
        catalogue = [row for row in read_catalogue() if row["type"] in map(gettext, TYPES)]
    rows = {"Items": items, "Floors": floors, "Building": [building], "Catalogue": catalogue or []}
    if units == "imperial":
        rows = {sheet: [_convert(sheet, row, units) for row in given] for sheet, given in rows.items()}
    with pytest.MonkeyPatch.context() as patch:
        for name in ROWS if spare is not None else ():
            patch.setitem(ROWS, name, spare)
        write_workbook(path, Content(rows), units)
    return path


def _convert(sheet: str, row: dict[str, Any], units: Units) -> dict[str, Any]:
    columns = {column.name: column for one in SHEETS if one.name == sheet for column in one.columns}
    scale = {name: column.factor / QUANTITIES[column.quantity][column.header(units).split("[")[1].rstrip("]")]
             for name, column in columns.items() if column.quantity}  # fmt: skip
    return {name: value * scale[name] if name in scale and not isinstance(value, str) else value
            for name, value in row.items()}  # fmt: skip


def retype(path: Path, units: Mapping[tuple[str, str], str]) -> Path:
    """Type other units into the headers, as a user does, and change the numbers below to match."""
    book = openpyxl.load_workbook(path)
    for sheet in SHEETS:
        for column in sheet.columns:
            at = PLACES[sheet.name, column.name] + 1
            if (sheet.name, column.name) in units:
                unit = units[sheet.name, column.name]
                spelt = unit.replace(" ", "").lower().replace("²", "2").replace("^", "")
                page, scale = book[sheet.name], column.factor / QUANTITIES[column.quantity][spelt]
                page.cell(1, at).value = f"{column.label} [{unit}]"
                for row in range(2, page.max_row + 1):
                    cell: Any = page.cell(row, at)
                    if cell.value is not None:
                        cell.value *= scale
    book.save(path)
    return path


def poison(path: Path) -> Path:
    """Overwrite the stored result of every formula with a wrong one."""

    def wrong(cell: re.Match[bytes]) -> bytes:
        return b"<c" + re.sub(rb' t="\w+"', b"", cell[1]) + b">" + cell[2] + f"<v>{POISON}</v></c>".encode()

    def overwrite(data: bytes) -> bytes:
        changed, count = re.subn(rb"<c( [^>]*)>(<f[^>]*>[^<]*</f>)(?:<v>[^<]*</v>|<v ?/>)?</c>", wrong, data)
        assert count == len(re.findall(rb"<f[ >]", data))
        return changed

    return change_parts(path, {f"xl/worksheets/sheet{number}.xml": overwrite for number in range(1, len(SHEETS) + 3)})


# ---------------------------------------------------------------- engines


def by_formualizer(path: Path) -> dict[int, Live]:
    last = int(re.findall(r'<row r="(\d+)"', read_part(path, f"xl/worksheets/sheet{ITEMS_AT + 1}.xml"))[-1])
    book = evaluate(path)
    name = book.sheet_names[ITEMS_AT]
    heads = {book.get_value(name, 1, at): at for at in range(1, MOST_COLUMNS)}
    places = [heads[translate_header(label)] for label in LIVE]
    return {row: [book.get_value(name, row, at) for at in places] for row in range(2, last + 1)}


# ---------------------------------------------------------------- comparison


def check(path: Path) -> None:
    shown, inventory = by_formualizer(poison(path)), read_inventory(path)
    found = [f"{item.item} {item}: {shown[item.row]}, expected {wanted}"
             for item, wanted in zip(inventory.items, live_values(inventory), strict=True)
             if not all(map(same, shown[item.row], wanted))]  # fmt: skip
    assert not found, f"{len(found)} differ, such as {found[0]}"


BUILDINGS = [
    {"motion_uncertainty": 0}, {"period": 0.4}, {"period": 1.7, "scenario_kind": "given", "motion_uncertainty": 0.15},
    {"period": 2.5, "ground_pga": 0.14, "ground_pgv": 14.0, "structure": "walls"}, {"ground_pgv": 14.0},
]  # fmt: skip


@pytest.mark.parametrize(
    "at",
    [0, 1, *(pytest.param(at, marks=pytest.mark.slow) for at in range(2, len(BUILDINGS)))],
    ids=["no T1", "short T1", "long T1", "ground", "PGV alone"],
)
def test_live_columns_equal_the_program(tmp_path: Path, at: int) -> None:
    units: Units = "imperial" if at % 2 else "si"
    check(fill(tmp_path / "book.xlsx", GRID, FLOORS, BUILDINGS[at], units))


@pytest.mark.slow
@pytest.mark.parametrize("units", RETYPED)
def test_live_columns_follow_the_headers(tmp_path: Path, units: str) -> None:
    path = fill(tmp_path / "book.xlsx", GRID, FLOORS, {"period": 0.9})
    check(retype(path, RETYPED[units]))


def test_a_stored_result_is_not_taken_for_a_computed_one(tmp_path: Path) -> None:
    """The poison is there: without it, and without a recalculation, the tests above would compare nothing."""
    path = poison(fill(tmp_path / "book.xlsx", GRID[:1], FLOORS, {}))
    stored = openpyxl.load_workbook(path, data_only=True)["Items"][f"{LETTERS['Items', 'B/H']}2"].value
    assert stored == POISON
    assert by_formualizer(path)[2][0] == pytest.approx(0.05)


ITALIAN_TYPES = {"Bookcase 5 shelves": "Libreria a 5 ripiani", "bookcase 6 shelves": "libreria a 6 ripiani"}


def italian_grid(path: Path, units: Units) -> Path:
    """Write every piece into a workbook of the language that is spoken, which is to be Italian."""
    grid = [row | ({"type": ITALIAN_TYPES[row["type"]]} if "type" in row else {}) for row in GRID]
    return fill(path, grid, FLOORS, {"period": 0.4, "scenario_kind": "given"}, units)


@pytest.mark.parametrize("units", ["si", "imperial"])
def test_live_columns_of_an_italian_workbook_equal_the_program(tmp_path: Path, units: Units) -> None:
    with speaking(load_catalogue("it")):
        check(italian_grid(tmp_path / "book.xlsx", units))


# ---------------------------------------------------------------- words in place of numbers


def shown_rows(
    folder: Path, items: Rows, floors: Rows | None = None, catalogue: Rows | None = None, **building: Any
) -> list[Live]:
    """Return what one workbook shows of each piece, which has the usual sizes where none are given."""
    rows = [{"item": f"A{at}", "floor": "1", "breadth": 40, "height": 180} | item for at, item in enumerate(items)]
    path = fill(folder / "book.xlsx", rows, floors or [{"floor": "1", "pfa_x": 0.5}], building, catalogue=catalogue)
    shown = by_formualizer(poison(path))
    return [shown[at] for at in range(2, 2 + len(rows))]


Case = tuple[dict[str, Any], Rows, list[tuple[dict[str, Any], Any]]]
"""Lines of Building, floors, and pieces with what they show: their PFA, or a word in place of all but B/H."""
TWO: Rows = [{"floor": "1", "pfa_x": 0.5}, {"floor": "2", "elevation": 4}]
RECORDED: Rows = [{"floor": "1", "pfa_x": 0.5, "record_x": "roof.csv"}]
WORDS: Sequence[Any] = [
    ({}, TWO, [({"floor": "9"}, "floor?"), ({"floor": None}, "floor?"), ({"type": "none such"}, 0.5)]),
    ({}, [{"floor": "1", "pfa_x": 0.3, "pfa_y": 0.5}], [({"axis": "x"}, 0.3), ({"axis": " Y "}, 0.5), ({"axis": "Z"}, "axis?")]),
    *(({}, [{"floor": "1", **floor}], [({}, "run assess")]) for floor in (
        {"record_x": "roof.csv"}, {"record_x": "roof.csv", "pfa_x": 0.5}, {"record_x": "roof.csv", "pfa_y": 0.5},
        {"record_y": "roof.csv", "pfa_x": 0.5},
    )),
    ({}, [{"floor": "1", "record_y": "roof.csv", "pfa_x": 0.5}], [({"axis": "X"}, 0.5)]),
    ({}, [{"floor": "1", "record_y": "  ", "pfa_x": 0.5}], [({}, 0.5)]),
    *(({"scenario_kind": kind}, RECORDED, [({}, shown)]) for kind, shown in {
        "given": 0.5, " GIVEN": 0.5, "recorded": "run assess", "as filled": "run assess", "As_Filled": "run assess",
        "ASCE 7-22": "needs shaking", "en 1998-1": "needs shaking",
    }.items()),
    *(({}, [{"floor": "1", "pfa_x": 0.5, "pfv_x": pfv}], [({}, "check")]) for pfv in ("1,5", 0, -20, 2000)),
    # cells that were emptied with the space bar
    ({}, TWO, [({"breadth": 40, "width": " ", "angle_deg": " ", "axis": " ", "type": " ", "centre_of_gravity": " "}, 0.5)]),
]  # fmt: skip
ITALIAN_WORDS: Sequence[Any] = [
    ({}, TWO, [({"floor": "9"}, "piano?"), ({"axis": "Z"}, "asse?"), ({}, 0.5), ({"floor": "2"}, "manca il moto")]),
    ({"ground_pga": 0.2}, TWO, [({"floor": "2"}, "eseguire assess")]),
    *(({"scenario_kind": kind}, TWO, [({}, shown)]) for kind, shown in {
        " REGISTRATO": "manca il moto", "Assegnato": 0.5, "given": 0.5, "come-compilato": 0.5, "as filled": 0.5,
        "NTC 2018": "manca il moto",
    }.items()),
]  # fmt: skip


@pytest.mark.parametrize(("language", "cases"), [("en", WORDS), ("it", ITALIAN_WORDS)])
def test_what_is_wrong_is_named_in_place_of_a_class(tmp_path: Path, language: str, cases: Sequence[Case]) -> None:
    for building, floors, rows in cases:
        with speaking(load_catalogue(language)):
            found = shown_rows(tmp_path, [item for item, _ in rows], floors, **building)
        for shown, (item, wanted) in zip(found, rows, strict=True):
            assert shown[1] == wanted, (building, floors, item)
            assert isinstance(wanted, float) or set(shown[1:]) == {wanted}


def test_blank_rows_show_nothing(tmp_path: Path) -> None:
    shown = by_formualizer(poison(fill(tmp_path / "book.xlsx", GRID[:1], FLOORS, {}, spare=None)))
    assert shown[2] != [""] * 8
    assert len(shown) == ROWS["Items"]
    assert all(shown[row] == [""] * 8 for row in range(3, ROWS["Items"] + 2))


def unknown_types(path: Path) -> Path:
    items: Rows = [{"item": "A1", "floor": "1", "type": "none such"}, {"item": "A2", "floor": "1", "type": " "},
                   {"item": "A3", "floor": "1", "type": "none such", "breadth": 40}]  # fmt: skip
    return fill(path, items, [{"floor": "1", "pfa_x": 0.5}], {})


def test_no_such_type_and_texts_for_numbers_show_no_class_and_a_breadth_up_to_the_width_does(tmp_path: Path) -> None:
    shown = by_formualizer(poison(unknown_types(tmp_path / "book.xlsx")))
    unknown = ["type?", 0.5, *["type?"] * 6]
    assert [shown[row] for row in (2, 3, 4)] == [unknown, ["", 0.5, *[""] * 6], unknown]
    shown = by_formualizer(poison(texts_for_numbers(tmp_path / "book.xlsx")))
    assert [shown[row][4:] for row in range(2, 5 * len(TEXTS) + 2)] == [["check"] * 4] * 5 * len(TEXTS)
    # Beside a width that is blank, no number, or the row's own in place of a narrower type's, Breadth is taken.
    shown = by_formualizer(poison(breadths_and_widths(tmp_path / "book.xlsx")))
    assert [shown[row][0] for row in range(2, 7)] == pytest.approx([40 / 180] * 5)


UNSERVED: list[tuple[dict[str, Any], dict[str, Any], str | None]] = [
    ({}, {}, "needs shaking"), ({"elevation": 4}, {}, "needs shaking"), ({"pfv_x": 30}, {}, "needs shaking"),
    ({"record_x": " "}, {}, "needs shaking"), ({"elevation": 4}, {"ground_pga": 0.2}, None),
    ({"elevation": 4}, {"sds": 0.5}, None), ({"elevation": 4}, {"ground_pgv": 20}, None),
    ({"elevation": 4}, {"ground_pga": 0.2, "scenario_kind": "as filled"}, None),
    ({"elevation": 4}, {"ground_pga": 0.2, "scenario_kind": "given"}, "needs shaking"),
    ({"elevation": 4}, {"shaking": "MMI VII, very strong", "scenario_kind": "recorded"}, "needs shaking"),
    ({"elevation": 4}, {"ground_pga": 0.2, "scenario_kind": "NTC 2018"}, "run assess"),
    ({"elevation": 4}, {"ground_pgv": 20, "scenario_kind": "NTC 2018"}, "run assess"),
    ({"elevation": 4}, {"shaking": "JMA 7", "scenario_kind": "EN 1998-1"}, "run assess"),
    ({"elevation": 4}, {"scenario_kind": "EN 1998-1"}, "needs shaking"),
    ({"pfa_x": 0.5}, {"scenario_kind": "EN 1998-1"}, "needs shaking"),
    ({}, {"ground_pga": 0.2}, None), ({}, {"shaking": "JMA 7"}, None), ({}, {"ground_pgv": 20, "height": 9}, None),
    ({}, {"ground_pga": 0.2, "scenario_kind": "EN 1998-1"}, "needs shaking"),
    ({}, {"ground_pga": 0.2, "storeys": 3, "scenario_kind": "EN 1998-1"}, "run assess"),
    ({}, {"ground_pga": 0.2, "height": 9, "storeys": 3}, "run assess"), ({}, {"sds": 0.5, "storeys": 3}, "run assess"),
    ({}, {"height": 9, "storeys": 3}, "needs shaking"), ({}, {"shaking": "JMA 7", "height": 9}, None),
    ({}, {"shaking": "JMA 7", "height": 9, "storeys": 3, "scenario_kind": "given"}, "needs shaking"),
]  # fmt: skip


def test_what_a_floor_without_a_motion_of_its_own_shows(tmp_path: Path) -> None:
    """As the program finds it: where it refuses the floor, the row does not ask to run it."""
    for floor, building, word in UNSERVED:
        (shown,) = shown_rows(tmp_path, [{}], [{"floor": "1", **floor}], **building)
        assert isinstance(shown[1], float) if word is None else shown[1:] == [word] * 7, (floor, building)
        if floor.keys() <= {"elevation", "pfa_x"}:
            assert is_run(tmp_path / "book.xlsx") == (word != "needs shaking"), (floor, building)


def is_run(path: Path) -> bool:
    try:
        live_values(read_inventory(path))
    except WorkbookError:
        return False
    return True


BESIDE: list[tuple[tuple[Any, Any], float | None, str]] = [
    *(((0, 8), z, "as filled") for z in (4, 8, 9, -1, None)), ((4, 8), None, "as filled"), ((0, None), 4, "as filled"),
    ((None, None), 0, "as filled"), ((4, None), 4, "as filled"), ((0, "8 m"), 4, "as filled"), ((4, 8), 0, "as filled"),
    *(((0, 8), z, "given") for z in (4, 8, 9, -1)), ((4, 8), 3, "given"), ((4, 8), 6, "given"), ((0, None), 4, "given"),
    ((4, None), None, "given"), ((-3, 8), -1, "given"),
]  # fmt: skip
"""Elevations of floors with a PFA, that of the floor without, and the kind of scenario."""


def floors_beside(path: Path, elevations: Sequence[Any], z: float | None, kind: str = "as filled") -> Path:
    """Write a floor at z, of which nothing is known, beside others that have a PFA."""
    known = [{"floor": f"k{at}", "pfa_y": 0.3, "elevation": level} for at, level in enumerate(elevations)]
    row = {"item": "A1", "floor": "1", "breadth": 40, "height": 180}
    return fill(path, [row], [{"floor": "1", "elevation": z}, *known], {"scenario_kind": kind})


def test_a_floor_beside_others_is_left_to_the_program_where_that_serves_it(tmp_path: Path) -> None:
    words = []
    for elevations, z, kind in BESIDE:
        path = floors_beside(tmp_path / "book.xlsx", elevations, z, kind)
        (word,) = set(by_formualizer(poison(path))[2][1:])
        assert word == ("run assess" if is_run(path) else "needs shaking"), (elevations, z, kind)
        words.append(word)
    assert len(set(words)) == 2


ROCKING: dict[Any, list[tuple[dict[str, Any], str]]] = {
    None: [({"breadth": 19}, "yes"), ({"breadth": 20}, "no"), ({"centre_of_gravity": "top"}, "check")],
    0: [
        ({"breadth": 20}, "no"), ({"breadth": 19}, "yes"), ({"breadth": 22, "sizes_from": "scan"}, "no"),
        *(({"breadth": 21, "sizes_from": one}, "yes") for one in ("scan", " Scan", "S")),
        *(({"breadth": 21, "sizes_from": one}, "no") for one in ("model", "measured", "lidar")),
    ],
    0.1: [
        ({"breadth": 32}, "no"), ({"breadth": 32, "centre_of_gravity": 80}, "yes"),
        ({"breadth": 32, "type": "heavy"}, "yes"), ({"breadth": 32, "type": "heavy", "centre_of_gravity": 50}, "no"),
        ({"breadth": 32, "type": "plain"}, "no"),
    ],
    0.4: [({}, "yes"), ({"breadth": 48}, "yes"), ({"breadth": 49}, "no")],
    1.5: [({"breadth": 255}, "no"), ({"breadth": 253}, "yes")],
    "much": [({}, "check")],
}  # fmt: skip
"""What is said of pieces by Motion uncertainty s: 0.05 g e^(3 s) against 0.65 g b/z. Without records a typed motion is
met in every draw."""


@pytest.mark.parametrize("uncertainty", ROCKING)
def test_whether_a_piece_can_rock(tmp_path: Path, uncertainty: Any) -> None:
    catalogue = [{"type": "heavy", "centre_of_gravity": 80}, {"type": "plain"}]
    floors = [{"floor": "1", "pfa_x": 0.05}]
    items, expected = zip(*ROCKING[uncertainty], strict=True)
    shown = shown_rows(tmp_path, list(items), floors, catalogue, motion_uncertainty=uncertainty)
    assert [row[-1] for row in shown] == list(expected)
    assert {row[-2] for row in shown if row[-1] == "no"} <= {"○ low"}


UNREADABLE = {
    ("Items", "breadth"): "Breadth [kg]", ("Items", "height"): "Height", ("Floors", "pfa_x"): "PFA X [m/s3]",
    ("Floors", "pfv_x"): "PFV X [knots]", ("Items", "centre_of_gravity"): "Centre of gravity",
    ("Catalogue", "height"): "Height (cm)",
}  # fmt: skip
"""Headers, by their columns."""


def test_unreadable_units(tmp_path: Path) -> None:
    for (sheet, name), header in UNREADABLE.items():
        path = fill(tmp_path / "book.xlsx", [GRID[0] | {"floor": "both", "centre_of_gravity": 60}], FLOORS, {})
        book = openpyxl.load_workbook(path)
        book[sheet][f"{LETTERS[sheet, name]}1"] = header
        book.save(path)
        assert by_formualizer(poison(path))[2][7] == "unit?", header


# ---------------------------------------------------------------- names and choices as people type them

STRAY = ["{} ", "  {}", "{}\u00a0", "\u00a0 {} \u00a0"]


def stray_names(path: Path) -> Path:
    items, floors, catalogue = list[Any](), list[Any](), list[Any]()
    for number, stray in enumerate(STRAY):
        floors += [{"floor": stray.format(f"Own {number}"), "pfa_x": 0.3}, {"floor": f"THEIR  {number}", "pfa_x": 0.5}]
        sizes = {"breadth": 30, "height": 150}
        catalogue += [{"type": stray.format(f"Case\u00a0{number}"), **sizes}, {"type": f"Box {number}", **sizes}]
        items += [
            {"item": f"A{number}", "floor": f"own {number}", "type": stray.format(f"box  {number}")},
            {"item": f"B{number}", "floor": stray.format(f"Their {number}"), "type": f"CASE {number}"},
        ]
    return fill(path, items, floors, {}, catalogue=catalogue)


def test_a_name_is_found_whatever_the_spaces_around_it_and_its_signs_stand_for_themselves(tmp_path: Path) -> None:
    """Wherever they stand: in Items, in Floors, in the Catalogue. The program finds the same floor and type."""
    path = stray_names(tmp_path / "book.xlsx")
    check(path)
    shown = by_formualizer(path)
    assert [round(shown[row][1], 9) for row in range(2, 2 * len(STRAY) + 2)] == [0.3, 0.5] * len(STRAY)
    # A star is no wildcard: the floor 12 serves no piece of the floor 1*, and none of 2*, which is no floor.
    check(floors_of_signs(tmp_path / "book.xlsx", [*SIGNS, "12"]))
    others = [f"{name}{end}" for name in SIGNS[:5] for end in ("*", "?")]
    shown = by_formualizer(floors_of_signs(tmp_path / "other.xlsx", others))
    assert [shown[row][1] for row in range(2, len(others) + 2)] == ["floor?"] * len(others)


SIGNS = ["1*", "1?", "~1", "1~*", "*", "?"]


def floors_of_signs(path: Path, names: Sequence[str]) -> Path:
    """Write a piece for each name of a floor, beside floors that are called by signs, and one called 12."""
    floors = [{"floor": "12", "pfa_x": 0.1}, *({"floor": name, "pfa_x": 0.6} for name in SIGNS)]
    return fill(path, [{"item": name, "floor": name, "breadth": 30, "height": 150} for name in names], floors, {})


ANCHORED = [
    ("yes", True), (" YES\u00a0", True), ("y", True), ("sì", True), ("Si", True), ("no", False), ("partly", False),
    ("unknown", False), ("in parte", False), (None, False), ("?", False), ("*", False), ("|", False), ("es", False),
]  # fmt: skip


def anchored_pieces(path: Path) -> Path:
    row = {"floor": "1", "breadth": 40, "height": 180}
    items = [{"item": f"A{number}", "anchored": typed, **row} for number, (typed, _) in enumerate(ANCHORED)]
    return fill(path, items, [{"floor": "1", "pfa_x": 0.5}], {})


def test_an_anchored_piece_has_no_class(tmp_path: Path) -> None:
    shown = by_formualizer(poison(anchored_pieces(tmp_path / "book.xlsx")))
    for number, (typed, is_anchored) in enumerate(ANCHORED, 2):
        *numbers, label, by_paper, _ = shown[number]
        assert [label, by_paper] == (["anchored"] * 2 if is_anchored else ["▲ high", "■ very high"]), typed
        assert all(isinstance(one, float) for one in numbers)


CASTORS = [("yes", None), ("Sì", None), ("y\u00a0", None), ("no", None), (None, None), (None, "yes"), ("no", "yes")]
"""Mobile in Items and in the Catalogue."""


def pieces_on_castors(path: Path) -> Path:
    sizes: Rows = [{"breadth": 60, "height": 160}, {"breadth": 35, "height": 100}, {"breadth": 34.9, "height": 100},
                   {"breadth": 60, "height": 160, "centre_of_gravity": 60}]  # fmt: skip
    items = [{"item": f"A{at}", "floor": "1", "mobile": own, "type": "Cart" if listed else "Box", **size}
             for at, ((own, listed), size) in enumerate(product(CASTORS, sizes))]  # fmt: skip
    items.append({"item": "held", "floor": "1", "anchored": "yes", "mobile": "yes", **sizes[0]})
    return fill(
        path, items, [{"floor": "1", "pfa_x": 0.5}], {}, catalogue=[{"type": "Cart", "mobile": "yes"}, {"type": "Box"}]
    )


@pytest.mark.parametrize("language", ["en", "it"])
def test_a_piece_that_rolls_has_no_class_unless_it_is_slender(tmp_path: Path, language: str) -> None:
    with speaking(load_catalogue(language)):
        path, word = pieces_on_castors(tmp_path / "book.xlsx"), gettext("rolls")
        check(path)
        shown = by_formualizer(path)
    rolls = [shown[row][5:7] == [word] * 2 for row in range(2, 30)]
    assert rolls == [on_castors and at < 2 for on_castors in (1, 1, 1, 0, 0, 1, 0) for at in (0, 1, 2, 3)]
    assert shown[30][5] == gettext("anchored") if language == "en" else shown[30][5] != word


BRACKETS: Rows = [
    {"anchored": word, "bracket_capacity": capacity, "bracket_height": height}
    for word in ("yes", "Sì", "partly", "no", "unknown")
    for capacity, height in ((0.01, None), (50, 150), (None, 150), (" ", None))
]  # fmt: skip
"""Of the first two words a typed capacity leaves it to the program whether the piece counts as anchored."""


def typed_capacities(path: Path) -> Path:
    items = [{"item": f"A{at}", "floor": "1", "breadth": 40, "height": 180, **one} for at, one in enumerate(BRACKETS)]
    return fill(path, items, [{"floor": "1", "pfa_x": 0.5}], {})


@pytest.mark.parametrize("language", ["en", "it"])
def test_a_typed_capacity_leaves_it_to_the_program(tmp_path: Path, language: str) -> None:
    """Such a row says "run assess" in the sheet and in what the program stores there."""
    with speaking(load_catalogue(language)):
        path = typed_capacities(tmp_path / "book.xlsx")
        check(path)
        shown, run = by_formualizer(path), gettext("run assess")
        for row, one in enumerate(BRACKETS, 2):
            *numbers, label, by_paper, _ = shown[row]
            is_left = one["anchored"] in ("yes", "Sì") and isinstance(one["bracket_capacity"], float | int)
            assert (label == run) == (by_paper == run) == is_left, one
            assert all(isinstance(number, float) for number in numbers), "its chance as a free-standing piece"


# ---------------------------------------------------------------- what is no number, or no sensible one

TEXTS = ["45 cm", "0,15", "40,5", "40.5", "1.80 m", "1,500", "'12", "15 %", "4/5"]
"""A spreadsheet that groups thousands by commas takes some of them for larger numbers: a broader piece is safer."""


def texts_for_numbers(path: Path) -> Path:
    items: Rows = [{"item": f"B{text}", "floor": "1", "breadth": text, "height": 180} for text in TEXTS]
    items += [{"item": f"H{text}", "floor": "1", "breadth": 40, "height": text} for text in TEXTS]
    items += [{"item": f"A{text}", "floor": "1", "breadth": 40, "height": 180, "angle_deg": text} for text in TEXTS]
    items += [{"item": f"T{text}", "floor": "1", "type": text} for text in TEXTS]
    items += [{"item": f"F{text}", "floor": text, "breadth": 40, "height": 180} for text in TEXTS]
    catalogue: Rows = [{"type": text, "breadth": text, "height": 180} for text in TEXTS]
    floors: Rows = [{"floor": "1", "pfa_x": 0.5}, *({"floor": text, "pfa_y": text} for text in TEXTS)]
    return fill(path, items, floors, {}, catalogue=catalogue)


def test_a_number_that_the_program_refuses_shows_no_class(tmp_path: Path) -> None:
    """A date read out of 4/5 is a breadth of 450 m; metres below a header in cm are a needle; 25 of PFA is a percentage."""
    refused: list[tuple[dict[str, Any], dict[str, Any]]] = [
        ({"breadth": 45000}, {}), ({"breadth": 0.4}, {}), ({"breadth": -40}, {}), ({"breadth": 0}, {}),
        ({"height": 1.8}, {}), ({"height": 700}, {}), ({}, {"pfa_x": -0.5}), ({}, {"pfa_x": "much"}),
        ({}, {"pfa_x": 25}), ({"breadth": 200, "width": 100}, {}), ({"type": "narrow"}, {}),
        ({"type": "narrow", "width": 39.9}, {}),
    ]  # fmt: skip
    narrow = [{"type": "narrow", "breadth": 20, "width": 30, "height": 180}]
    cases = [({}, {}), *refused]
    floors = [{"floor": str(at), "pfa_x": 0.5} | floor for at, (_, floor) in enumerate(cases)]
    items = [{"floor": str(at)} | item for at, (item, _) in enumerate(cases)]
    good, *others = (row[5] for row in shown_rows(tmp_path, items, floors, narrow))
    assert (good, others) == ("▲ high", ["check"] * len(refused))


def breadths_and_widths(path: Path) -> Path:
    rows: Rows = [
        {"width": 40}, {"width": " "}, {"width": "wide"}, {"type": "narrow", "width": 41}, {"type": "unsized"},
    ]  # fmt: skip
    items: Rows = [{"item": f"A{at}", "floor": "1", "breadth": 40, "height": 180, **row} for at, row in enumerate(rows)]
    catalogue: Rows = [{"type": "narrow", "breadth": 20, "width": 30, "height": 180}, {"type": "unsized"}]
    return fill(path, items, [{"floor": "1", "pfa_x": 0.5}], {}, "imperial", catalogue=catalogue)


def test_formulas_that_are_copied_down_compute(tmp_path: Path) -> None:
    path = fill(tmp_path / "book.xlsx", GRID[:1], FLOORS, {}, spare=len(FLOORS))
    book = openpyxl.load_workbook(path)
    page, last = book["Items"], len(FLOORS) + 1
    for name in (*LIVE, *WORKINGS):
        letter = LETTERS["Items", name]
        formula = Translator(page[f"{letter}{last}"].value, f"{letter}{last}").translate_formula(f"{letter}{last + 1}")
        page[f"{letter}{last + 1}"] = formula
    for name, value in GRID[40].items():
        page[f"{LETTERS['Items', name]}{last + 1}"] = value
    book.save(path)
    (_, wanted) = live_values(read_inventory(path))
    assert by_formualizer(path)[last + 1] == pytest.approx(wanted, abs=AGREEMENT)


def pieces_of_a_slower_motion(path: Path) -> Path:
    floors = [{"floor": "1", "pfa_x": 0.06, "pfv_x": 90, "pfa_y": 0.5, "pfv_y": 80}]
    rows: Rows = [{"item": "a"}, {"item": "x", "axis": "X"}, {"item": "turned", "angle_deg": 40}]
    rows += [{"item": "near", "angle_deg": 10}, {"item": "y", "axis": "Y"}]
    items = [{"floor": "1", "breadth": 60, "width": 90, "height": 100, **row} for row in rows]
    return fill(path, items, floors, {"period": 1.0})


def test_a_piece_that_the_slower_motion_alone_can_start_is_not_called_low(tmp_path: Path) -> None:
    """Along X 90 cm/s of 0.06 g cannot start it: a run goes by Y, the sheet by the larger PFV of both."""
    path = pieces_of_a_slower_motion(tmp_path / "book.xlsx")
    check(path)
    shown = by_formualizer(path)
    assert [shown[row][5] for row in range(2, 7)] == ["◇ medium", "○ low", "◇ medium", "○ low", "◇ medium"]


GROUND = {"period": 2.5, "ground_pga": 0.14, "ground_pgv": 28.0}


@pytest.mark.slow
@pytest.mark.parametrize(("header", "value"), [("Ground PGV [in/s]", 28 / 2.54), ("Ground PGV [m/s]", 0.28)])
def test_the_ground_follows_the_unit_of_its_line(tmp_path: Path, header: str, value: float) -> None:
    path = fill(tmp_path / "book.xlsx", GRID, FLOORS, GROUND)
    plain = by_formualizer(poison(path))
    retype_ground_velocity(path, header, value)
    check(path)
    assert by_formualizer(path)[2] == pytest.approx(plain[2])


def retype_ground_velocity(path: Path, header: str, value: float) -> None:
    book = openpyxl.load_workbook(path)
    (row,) = [row for row in book["Building"].iter_rows() if str(row[0].value).startswith("Ground PGV")]
    row[0].value, row[1].value = header, value
    book.save(path)


@pytest.mark.parametrize(("pga", "shown"), [(0.14, "unit?"), (None, 0.3)])
def test_an_unreadable_unit_of_ground_velocity_shows_no_class(tmp_path: Path, pga: float | None, shown: Any) -> None:
    """Without Ground PGA the ratio of both does not depend on it. The program refuses the unit."""
    floors, item = [{"floor": "1", "pfa_x": 0.3}], {"item": "A1", "floor": "1", "breadth": 40, "height": 180}
    path = fill(tmp_path / "book.xlsx", [item], floors, GROUND | {"ground_pga": pga})
    retype_ground_velocity(path, "Ground PGV [knots]", 28.0)
    assert by_formualizer(poison(path))[2][1] == shown


def test_floors_without_a_motion_or_a_name_show_no_class_and_those_beside_them_keep_theirs(tmp_path: Path) -> None:
    """They may be interpolated, which is the program's task."""
    assert shown_rows(tmp_path, [{}], scenario_kind="recorded")[0][1:] == ["needs shaking"] * 7
    floors: Rows = [{"floor": "1", "pfa_x": 0.5, "elevation": 4}, *({"floor": f"r{z}", "elevation": z} for z in (0, 8))]
    between = [floors[0], *({**floor, "record_x": "roof.csv"} for floor in floors[1:])]
    (tmp_path / "between").mkdir()
    assert shown_rows(tmp_path / "between", [{}], between, scenario_kind="recorded")[0][1:] == ["run assess"] * 7
    # Rows without a name are no floors, whatever else they hold; nor is a blank name theirs.
    floors = [{"floor": "1", "elevation": 4}, {"pfa_x": 0.3, "elevation": 0}, {"pfa_x": 0.3, "elevation": 8}]
    named, blank = shown_rows(tmp_path, [{}, {"floor": None}], floors)
    assert (named[1:], blank[1:]) == (["needs shaking"] * 7, ["floor?"] * 7)
    floors = [{"floor": "0", "elevation": 0}, {"floor": "1", "pfa_x": 0.5, "elevation": 4}]
    assert shown_rows(tmp_path, [{}], floors, ground_pga=0.2)[0][1] == 0.5


@pytest.mark.parametrize("kind", ["ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"])
def test_a_profile_serves_floors_with_a_pfa_too(tmp_path: Path, kind: str) -> None:
    floors = [{"floor": "1", "pfa_x": 0.5, "elevation": 3}]
    items: Rows = [{}, {"axis": "X"}, {"axis": "Y"}]
    shown = shown_rows(tmp_path, items, floors, scenario_kind=kind, ground_pga=0.2)
    assert [row[1:] for row in shown] == [["run assess"] * 7] * 3


def test_sorting_floors_and_inserting_rows_moves_no_reference(tmp_path: Path) -> None:
    """The floors' helper rows find their row by number, not by a reference that sorting would drag along."""
    path = fill(tmp_path / "book.xlsx", GRID, list(reversed(FLOORS)), {})
    check(path)


@pytest.mark.parametrize("anchored", ["no", "yes", "partly", "unknown"])
def test_the_class_of_what_is_anchored_equals_the_program(tmp_path: Path, anchored: str) -> None:
    floors = [{"floor": "1", "pfa_x": 0.5}]
    row = {"item": "A1", "floor": "1", "breadth": 40, "height": 180, "anchored": anchored}
    check(fill(tmp_path / "book.xlsx", [row], floors, {}))
    with speaking(load_catalogue("it")):
        check(fill(tmp_path / "libro.xlsx", [row], floors, {}))


def test_what_is_anchored_says_so_without_shaking_and_a_typed_capacity_is_left_to_the_program(tmp_path: Path) -> None:
    assert shown_rows(tmp_path, [{"anchored": "yes", "floor": "9"}])[0][5] == "floor?"
    assert shown_rows(tmp_path, [{"anchored": "yes"}], [{"floor": "1", "record_x": "roof.csv"}])[0][1:] == [
        *["run assess"] * 4, *["anchored"] * 2, "run assess",
    ]  # fmt: skip
    (tmp_path / "none").mkdir()
    assert shown_rows(tmp_path / "none", [{"anchored": "yes"}], [{"floor": "1"}])[0][1:] == [
        *["needs shaking"] * 4, *["anchored"] * 2, "needs shaking",
    ]  # fmt: skip
    held = {"anchored": "yes", "bracket_capacity": 2.0}
    assert shown_rows(tmp_path, [held], [{"floor": "1"}])[0][1:] == [
        *["needs shaking"] * 4, *["run assess"] * 2, "needs shaking",
    ]  # fmt: skip
    unshaken = without_shaking(Content({"Items": [{"item": "A1", "floor": "1", "breadth": 40, "height": 180, **held}],
                                        "Floors": [{"floor": "1"}], "Building": [{}]}))  # fmt: skip
    assert [row[5] for row in unshaken.live or ()] == ["run assess"]


def test_whether_it_can_rock_rests_on_numbers_alone(tmp_path: Path) -> None:
    catalogue: Rows = [{"type": "light", "centre_of_gravity": 1}, {"type": "text", "centre_of_gravity": "40 %"}]
    items: Rows = [{}, {"centre_of_gravity": 0.6}, {"centre_of_gravity": "60"}, {"type": "light"}, {"type": "text"}]
    good, *others = shown_rows(tmp_path, [{"breadth": 150, **item} for item in items], catalogue=catalogue)
    assert good[7] in ("yes", "no")
    assert [row[7] for row in others] == ["check"] * 4
    for uncertainty in ("0,4", -1):
        assert shown_rows(tmp_path, [{"breadth": 150}], motion_uncertainty=uncertainty)[0][7] == "check"
