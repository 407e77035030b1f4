"""A building model imported again: what it tells is updated, what people typed stays, and everything is listed."""

import io
import zipfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.bim.import_workbook import build_workbook
from assess.bim.read_source import read_source
from assess.bim.update_workbook import describe, update_workbook
from assess.errors import InputError, WorkbookError
from assess.i18n import load_catalogue, speaking
from assess.progress import Progress
from assess.workbook.patch import patch_workbook
from tests.bim.cobie_files import write_cobie
from tests.bim.update_books import (
    FLOORS,
    IDS,
    ITEMS,
    building,
    changed,
    first_book,
    inventory,
    kinds,
    line,
    piece,
    row,
    table,
    typed,
    update,
    without,
)
from tests.workbook.books import change_parts, replace
from tests.workbooks import address

TYPED = {
    "axis": "X", "anchored": "yes", "friction": 0.4, "route": "R1", "segment": "a", "edge_distance": 0.2,
    "importance": "life safety", "centre_of_gravity": 55, "against_wall": "yes", "weight": 80, "bracket_height": 150,
    "bracket_capacity": 1.5, "photo": "w1.jpg", "notes": "Two brackets\nto the wall", "description": "Wardrobe of Ann",
}  # fmt: skip
"""What people type about a piece."""


@pytest.fixture(scope="module")
def book() -> bytes:
    return first_book()


def texts(found: Any) -> list[str]:
    return [str(describe(one)) for one in found.changes]


def parts(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


# ---------------------------------------------------------------- the same model again


def test_the_same_import_changes_nothing_to_the_byte(book: bytes) -> None:
    found = update_workbook(book, building(), "house.xlsx")
    assert (found.data, found.changes, found.problems, found.is_changed) == (book, (), (), False)


@pytest.mark.parametrize("name", ["duplex.ifc", "LargeBuilding.ifc"])
def test_a_real_model_again_changes_nothing(name: str) -> None:
    path = Path(__file__).parents[2] / "samples" / "models" / name
    model = read_source(path, name, routes="draft")
    data = build_workbook(model)
    assert update_workbook(data, model, "b.xlsx").data is data


def test_a_cobie_file_again_adds_what_is_new(tmp_path: Path) -> None:
    """Such files have no positions."""
    from assess.bim.cobie import read_cobie
    from tests.bim.cobie_files import COMPONENTS

    path = write_cobie(tmp_path / "handover.xlsx")
    data = build_workbook(read_cobie(path, path.name))
    assert update_workbook(data, read_cobie(path, path.name), "b.xlsx").data is data
    more = [*COMPONENTS, {**COMPONENTS[0], "Name": "Bookcase A:9", "ExtIdentifier": "new"}]
    found = update_workbook(data, read_cobie(write_cobie(path, components=more), path.name), "b.xlsx")
    assert texts(found) == ["Items A4 Bookcase A:9 was added"]


# ---------------------------------------------------------------- pieces that both have


def test_a_changed_size_is_updated_and_listed_with_its_old_value(book: bytes) -> None:
    found = update(book, changed(p3={"breadth": 60.0}))
    assert texts(found) == [f"Items {address('breadth', 4)} Breadth [cm] of A102-03: 54.5 -> 60"]
    assert row(found.data, 3).get("breadth") == pytest.approx(0.6)
    assert found.is_changed


def test_a_piece_that_was_moved_gets_its_position_room_and_floor(book: bytes) -> None:
    moved = {"floor": "Level 2", "room": "B201 Office", "x": 4.25, "y": 3.0, "angle_deg": 0.0}
    found = update(book, changed(p3=moved))
    assert kinds(found) == ["changed"] * 5
    one = inventory(found.data).items[2]
    assert (one.item, one.floor, one.room, one.x, one.y, one.angle_deg) == (
        "A102-03", "Level 2", "B201 Office", 4.25, 3.0, 0.0,
    )  # fmt: skip


def test_what_people_typed_stays(book: bytes) -> None:
    data = typed(book, **TYPED)
    before = row(data)
    every = {
        "breadth": 61.0,
        "width": 81.0,
        "height": 210.0,
        "x": 7.0,
        "y": 7.0,
        "angle_deg": 10.0,
        "room": "A102 Office",
    }
    found = update(data, changed(p1=every | {"notes": "other", "anchored": "unknown", "item": "Z", "description": "Z"}))
    after = row(found.data)
    owned = {*every, "floor"}
    assert {name: after.get(name) for name in after.values if name not in owned} == {
        name: before.get(name) for name in before.values if name not in owned
    }
    assert len(found.changes) == len(every)


def test_every_other_byte_of_the_file_stays(book: bytes, tmp_path: Path) -> None:
    """A comment, a part that no program knows, a sheet of the user, and the sheets that the model does not tell of."""
    path = tmp_path / "house.xlsx"
    path.write_bytes(book)
    kind = '<Default Extension="bin" ContentType="application/octet-stream"/></Types>'
    change_parts(path, {"xl/unknown.bin": bytes(range(256)), "[Content_Types].xml": replace("</Types>", kind)})
    data = path.read_bytes()
    found = update(data, changed(p3={"breadth": 60.0}, p4={"x": 9.0}))
    before, after = parts(data), parts(found.data)
    different = {name for name in before if before[name] != after.get(name)}
    assert before.keys() == after.keys()
    assert different <= {"xl/worksheets/sheet4.xml", "xl/worksheets/sheet9.xml", "xl/workbook.xml"}  # Items, Lists
    items, new = (one["xl/worksheets/sheet4.xml"].split(b"<row ") for one in (before, after))
    assert len(items) == len(new)
    live = table(data).letters["breadth"].encode()
    unlike = [
        at for at, (one, other) in enumerate(zip(items, new, strict=True)) if live + b'4"' in one and one != other
    ]
    assert unlike == [4]


def test_rounding_and_spelling_are_no_change(book: bytes) -> None:
    data = typed(book, row=4, breadth="54,5 cm", height="2 m", room="a102  office", x=3.0004)
    assert update(data).changes == ()


def test_turned_by_half_a_turn_a_piece_lies_as_before(book: bytes) -> None:
    assert update(typed(book, angle_deg=-90)).changes == ()
    assert kinds(update(typed(book, angle_deg=45))) == ["changed"]


def test_nothing_in_the_model_clears_nothing_in_the_workbook(book: bytes) -> None:
    bare = [{name: value for name, value in one.items() if name in ("item", "floor", "source_id")} for one in ITEMS]
    assert update(book, building(items=bare, building={})).changes == ()


def test_blank_cells_that_the_model_owns_are_filled(book: bytes) -> None:
    found = update(typed(book, row=4, breadth=None, room=None))
    assert texts(found) == [
        f"Items {address('room', 4)} Room of A102-03: blank -> 'A102 Office'",
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03: blank -> 54.5",
    ]


def test_a_cell_that_cannot_be_read_is_replaced_and_listed(book: bytes) -> None:
    found = update(typed(book, row=4, breadth="wide"))
    assert texts(found) == [f"Items {address('breadth', 4)} Breadth [cm] of A102-03: 'wide' -> 54.5"]


def test_a_size_out_of_range_is_written_once(book: bytes) -> None:
    assert kinds(update(book, changed(p3={"breadth": 2.0}))) == ["changed"]


def test_sizes_that_people_have_measured_stay(book: bytes) -> None:
    data = typed(book, row=4, breadth=52, sizes_from="measured")
    found = update(data, changed(p3={"x": 8.0}))
    assert texts(found) == [
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03 stays 52; the model has 54.5: it was measured",
        f"Items {address('x', 4)} X [m] of A102-03: 3 -> 8",
    ]
    assert row(found.data, 3).get("breadth") == pytest.approx(0.52)


def test_sizes_stay_where_nothing_says_where_they_come_from(book: bytes) -> None:
    """A blank cell means measured."""
    data = typed(book, row=4, breadth=52, sizes_from=None)
    found = update(data)
    assert texts(found) == [
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03 stays 52; the model has 54.5: it was measured"
    ]
    assert inventory(found.data).items[2].sizes_from == "measured"


def test_without_sizes_nothing_was_measured(book: bytes) -> None:
    found = update(typed(book, row=4, breadth=None, width=None, height=None, sizes_from=None))
    assert kinds(found) == ["changed"] * 4
    assert inventory(found.data).items[2].sizes_from == "model"


def test_sizes_of_a_handover_file_follow_although_nothing_says_where_they_come_from(tmp_path: Path) -> None:
    from tests.bim.cobie_files import TYPES

    path = write_cobie(tmp_path / "handover.xlsx")
    data = build_workbook(read_source(path, path.name))
    write_cobie(path, types=({**TYPES[0], "NominalHeight": 1850}, *TYPES[1:]))
    found = update_workbook(data, read_source(path, path.name), "b.xlsx")
    assert [(one.label, one.now) for one in found.changes if one.sheet == "Items"] == [("Height [cm]", 185)] * 2


def test_where_sizes_come_from_follows_them(book: bytes) -> None:
    found = update(book, changed(p3={"breadth": 60.0, "sizes_from": "scan"}))
    assert kinds(found) == ["changed", "changed"]
    assert row(found.data, 3).get("sizes_from") == "scan"


def test_a_type_that_people_chose_stays_and_is_listed(book: bytes) -> None:
    found = update(typed(book, row=4, type="Writing desk"))
    assert texts(found) == [
        f"Items {address('type', 4)} Type of A102-03 stays 'Writing desk'; the model has 'Wardrobe 80'"
    ]


def test_a_row_of_several_pieces_gets_sizes_and_no_position(book: bytes) -> None:
    data = typed(book, row=4, quantity=3, x=None, y=None, angle_deg=None)
    found = update(data, changed(p3={"breadth": 60.0}))
    assert texts(found) == [
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03: 54.5 -> 60",
        f"Items {address('x', 4)} X [m] of A102-03 stays blank; the model has 3: the row stands for 3 pieces",
    ]
    assert [one for one in inventory(found.data).problems if one.severity == "error" and one.sheet == "Items"] == []


def test_rows_without_a_source_id_are_peoples_own(book: bytes) -> None:
    own = {"item": "Own 1", "floor": "Level 1", "breadth": 40, "height": 180, "x": 1, "y": 1}
    data = typed(book, row=8, **own)
    assert update(data).changes == ()


def test_a_piece_that_the_model_lost_stays_and_is_listed(book: bytes) -> None:
    found = update(book, without(building(), 2))
    assert texts(found) == ["Items A3 A101-02 is missing in the model; its row stays"]
    assert found.data is book
    assert not found.is_changed


def test_copied_rows_are_listed_and_none_is_changed(book: bytes) -> None:
    data = typed(book, row=8, item="Copy", floor="Level 1", breadth=54.5, height=200, source_id=f" {IDS[2]} ")
    found = update(data, changed(p3={"breadth": 60.0}))
    letters = table(data).letters["source_id"]
    assert texts(found) == [
        f"Items A4 A102-03 stays as it is: its Source ID stands in several rows ({letters}4, {letters}8)"
    ]


def test_a_source_id_that_the_model_has_twice_is_listed(book: bytes) -> None:
    found = update(book, building(items=[*ITEMS, piece(3, "Level 1", "A102 Office", x=9.0)]))
    assert texts(found) == ["Items A4 A102-03 stays as it is: the model has 2 pieces of its Source ID"]


def test_source_ids_are_told_apart_by_letter_case(book: bytes) -> None:
    found = update(book, changed(p3={"source_id": IDS[2].lower(), "breadth": 60.0}))
    assert kinds(found) == ["added", "missing"]


def test_a_formula_of_people_stays_and_is_listed(book: bytes, tmp_path: Path) -> None:
    path = tmp_path / "house.xlsx"
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    old, new = f'<c r="{cell}"><v>50</v>', f'<c r="{cell}"><f>2*25</f><v>50</v>'
    change_parts(path, {"xl/worksheets/sheet4.xml": replace(old, new)})
    found = update(path.read_bytes())
    assert texts(found) == [
        f"Items {cell} Breadth [cm] of A102-03 stays 50; the model has 54.5: the cell holds a formula"
    ]


@pytest.mark.slow
@settings(max_examples=10)
@given(st.dictionaries(st.integers(0, 5), st.fixed_dictionaries({}, optional={
    **dict.fromkeys(("breadth", "width", "height"), st.integers(50, 6000).map(lambda one: one / 10)),
    **dict.fromkeys(("x", "y"), st.integers(-10**6, 10**6).map(lambda one: one / 1000)),
    "angle_deg": st.integers(-900, 899).map(lambda one: one / 10),
})))  # fmt: skip
def test_whatever_changes_the_reader_sees_the_model_and_what_people_typed(changes: dict[int, dict[str, float]]) -> None:
    data = _typed_book()
    items = [{**one, **changes.get(at, {})} for at, one in enumerate(ITEMS)]
    found = update(data, building(items=items))
    for one, old, model in zip(table(found.data).rows, table(data).rows, items, strict=True):
        for name, factor in (("breadth", 0.01), ("width", 0.01), ("height", 0.01), ("x", 1), ("y", 1)):
            assert one.get(name) == pytest.approx(model[name] * factor, abs=5.1e-4)
        assert (one.get("angle_deg") - model["angle_deg"] + 0.06) % 180 <= 0.12
        for name in ("item", "anchored", "weight", "notes", "importance", "type", "quantity", "axis"):
            assert one.get(name) == old.get(name)
    assert {one.kind for one in found.changes} <= {"changed"}


_TYPED_BOOK: list[bytes] = []


def _typed_book() -> bytes:
    if not _TYPED_BOOK:
        _TYPED_BOOK.append(typed(typed(first_book(), **TYPED), row=5, **TYPED))
    return _TYPED_BOOK[0]


# ---------------------------------------------------------------- what cannot be updated


def test_a_workbook_of_another_model_is_refused(book: bytes) -> None:
    other = [{**one, "source_id": f"other {at}"} for at, one in enumerate(ITEMS)]
    with pytest.raises(
        InputError, match=r"house\.xlsx does not seem to be a workbook of tower\.ifc: it has no Source ID"
    ):
        update_workbook(book, building(items=other, source="tower.ifc"), "house.xlsx")


def test_a_workbook_without_the_column_is_refused(book: bytes) -> None:
    data = typed(book, row=1, source_id=None)
    with pytest.raises(InputError, match=r"house\.xlsx has no column Source ID in Items"):
        update_workbook(data, building(), "house.xlsx")


def test_a_model_without_furniture_changes_nothing(book: bytes) -> None:
    with pytest.raises(InputError, match=r"house\.ifc holds no furniture that can be imported; house\.xlsx stays"):
        update_workbook(book, building(items=[]), "house.xlsx")


@pytest.mark.parametrize(
    ("data", "message"),
    [(b"", "is empty"), (b"PK\x03\x04 no zip", "is damaged"), (b"text", "is not an Excel workbook")],
)
def test_what_is_no_workbook_is_refused(data: bytes, message: str) -> None:
    with pytest.raises(WorkbookError, match=message):
        update_workbook(data, building(), "house.xlsx")


def test_a_handover_file_is_no_workbook(tmp_path: Path) -> None:
    data = write_cobie(tmp_path / "handover.xlsx").read_bytes()
    with pytest.raises(WorkbookError, match="this is a COBie handover file"):
        update_workbook(data, building(), "handover.xlsx")


def test_a_workbook_without_items_says_what_it_lacks(tmp_path: Path) -> None:
    from tests.workbook.books import write_book

    path = write_book(tmp_path / "book.xlsx", {"Floors": [["Floor"], ["1"]], "Things": [["a"]]})
    with pytest.raises(WorkbookError, match="Items: the sheet is missing"):
        update_workbook(path.read_bytes(), building(), "book.xlsx")


def test_a_value_far_below_the_table_is_named(book: bytes) -> None:
    data = patch_workbook(book, {"Items": {"A200001": "stray"}}).data
    with pytest.raises(WorkbookError, match="Items!A200001: a value far below the table"):
        update_workbook(data, building(), "house.xlsx")


def test_a_signed_workbook_is_refused(book: bytes, tmp_path: Path) -> None:
    path = tmp_path / "house.xlsx"
    path.write_bytes(book)
    change_parts(path, {"_xmlsignatures/sig1.xml": b"<Signature/>"})
    with pytest.raises(WorkbookError, match="digitally signed"):
        update_workbook(path.read_bytes(), changed(p3={"breadth": 60.0}), "house.xlsx")
    assert update_workbook(path.read_bytes(), building(), "house.xlsx").changes == ()


def test_a_cell_of_an_array_formula_is_refused(book: bytes, tmp_path: Path) -> None:
    path = tmp_path / "house.xlsx"
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    formula = f'<f t="array" ref="{cell}:{address("breadth", 5)}">A1*2</f>'
    change_parts(path, {"xl/worksheets/sheet4.xml": replace(f'<c r="{cell}"><v>', f'<c r="{cell}">{formula}<v>')})
    with pytest.raises(WorkbookError, match=f"Items!{cell}: it belongs to an array formula"):
        update_workbook(path.read_bytes(), building(), "house.xlsx")


def test_it_can_be_cancelled(book: bytes) -> None:
    from threading import Event

    from assess.errors import CancelledError

    cancel = Event()
    cancel.set()
    with pytest.raises(CancelledError):
        update_workbook(book, changed(p3={"breadth": 60.0}), "house.xlsx", Progress(cancel=cancel))


# ---------------------------------------------------------------- Building


def test_only_blank_lines_of_the_building_are_filled(book: bytes) -> None:
    data = line(book, latitude=None, azimuth_deg=28, building="Town hall", client="Ann")
    found = update(data)
    assert texts(found) == [
        "Building B3 Latitude [deg]: blank -> 45.5",
        "Building B11 Azimuth of X [deg] stays 28; the model has 30",
    ]
    assert row(found.data, sheet="Building").get("building") == "Town hall"


def test_a_change_is_told_in_the_language_in_use(book: bytes) -> None:
    from assess.i18n import gettext

    (change,) = update(book, changed(p3={"breadth": 60.5})).changes
    with speaking(load_catalogue("it")):
        assert "60,5" in gettext(describe(change))


def test_floors_of_the_fixture_are_floors_of_the_workbook(book: bytes) -> None:
    assert [one.get("floor") for one in table(book, "Floors").rows] == [one["floor"] for one in FLOORS]
