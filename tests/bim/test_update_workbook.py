"""A building model imported again: what it tells is updated, what people typed stays, and everything is listed."""

import io
import zipfile
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.bim.import_workbook import build_workbook
from assess.bim.read_source import read_source
from assess.bim.update_workbook import describe, update_workbook
from assess.errors import CancelledError, InputError, WorkbookError
from assess.i18n import gettext, load_catalogue, speaking
from assess.progress import Progress
from assess.workbook.patch import patch_workbook
from tests.bim.cobie_files import COMPONENTS, TYPES, write_cobie
from tests.bim.update_books import (
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
    texts,
    typed,
    update,
    without,
)
from tests.workbook.books import change_parts, replace, write_book
from tests.workbooks import address

TYPED = {
    "axis": "X", "anchored": "yes", "friction": 0.4, "route": "R1", "segment": "a", "edge_distance": 0.2,
    "importance": "life safety", "centre_of_gravity": 55, "against_wall": "yes", "weight": 80, "bracket_height": 150,
    "bracket_capacity": 1.5, "photo": "w1.jpg", "notes": "Two brackets\nto the wall", "description": "Wardrobe of Ann",
}  # fmt: skip
"""What people type about a piece."""


# ---------------------------------------------------------------- the same model again


def test_the_same_import_changes_nothing_to_the_byte(book: bytes) -> None:
    found = update_workbook(book, building(), "house.xlsx")
    assert (found.data, found.changes, found.problems, found.is_changed) == (book, (), (), False)


@pytest.mark.slow
def test_a_real_model_again_changes_nothing() -> None:
    name = "LargeBuilding.ifc"
    model = read_source(Path(__file__).parents[2] / "samples" / "models" / name, name, routes="draft")
    data = build_workbook(model)
    assert update_workbook(data, model, "b.xlsx").data is data


@pytest.mark.slow
def test_a_cobie_file_again_adds_what_is_new_and_its_sizes_follow(tmp_path: Path) -> None:
    """Such files have no positions, and nothing in them says where sizes come from."""
    path = write_cobie(tmp_path / "handover.xlsx")
    data = build_workbook(read_source(path, path.name))
    assert update_workbook(data, read_source(path, path.name), "b.xlsx").data is data
    more = [*COMPONENTS, {**COMPONENTS[0], "Name": "Bookcase A:9", "ExtIdentifier": "new"}]
    write_cobie(path, types=({**TYPES[0], "NominalHeight": 1850}, *TYPES[1:]), components=more)
    found = update_workbook(data, read_source(path, path.name), "b.xlsx")
    of_items = [one for one in found.changes if one.sheet == "Items"]
    assert [(one.label, one.now) for one in of_items[:2]] == [("Height [cm]", 185)] * 2
    assert [str(describe(one)) for one in of_items[2:]] == ["Items A4 Bookcase A:9 was added"]


# ---------------------------------------------------------------- pieces that both have

STAYS = "Items {breadth} Breadth [cm] of A102-03 stays 52; the model has 54.5: it was measured"
BREADTH_60 = "Items {breadth} Breadth [cm] of A102-03: 54.5 -> 60"
FIELDS: list[tuple[dict[str, Any], dict[str, Any], list[str]]] = [
    ({}, {"breadth": 60.0}, [BREADTH_60]),
    ({"breadth": None, "room": None}, {}, ["Items {room} Room of A102-03: blank -> 'A102 Office'",
                                           "Items {breadth} Breadth [cm] of A102-03: blank -> 54.5"]),
    ({"breadth": "wide"}, {}, ["Items {breadth} Breadth [cm] of A102-03: 'wide' -> 54.5"]),
    ({}, {"breadth": 2.0}, ["Items {breadth} Breadth [cm] of A102-03: 54.5 -> 2"]),  # out of range: written once
    ({"breadth": 52, "sizes_from": "measured"}, {"x": 8.0}, [STAYS, "Items {x} X [m] of A102-03: 3 -> 8"]),
    ({"breadth": 52, "sizes_from": None}, {}, [STAYS]),  # a blank cell means measured
    ({"breadth": None, "width": None, "height": None, "sizes_from": None}, {},  # nothing was measured
     ["Items {breadth} Breadth [cm] of A102-03: blank -> 54.5", "Items {width} Width [cm] of A102-03: blank -> 80",
      "Items {height} Height [cm] of A102-03: blank -> 200",
      "Items {sizes_from} Sizes from of A102-03: blank -> 'model'"]),
    ({}, {"breadth": 60.0, "sizes_from": "scan"},
     [BREADTH_60, "Items {sizes_from} Sizes from of A102-03: 'model' -> 'scan'"]),
    ({"type": "Writing desk"}, {},
     ["Items {type} Type of A102-03 stays 'Writing desk'; the model has 'Wardrobe 80'"]),
    ({"quantity": 3, "x": None, "y": None, "angle_deg": None}, {"breadth": 60.0},
     [BREADTH_60, "Items {x} X [m] of A102-03 stays blank; the model has 3: the row stands for 3 pieces"]),
    ({"breadth": "54,5 cm", "height": "2 m", "room": "a102  office", "x": 3.0004}, {}, []),
    ({"angle_deg": -90}, {}, []),  # by half a turn
    ({"angle_deg": 45}, {}, ["Items {angle_deg} Angle [deg] of A102-03: 45 -> 90"]),
]  # fmt: skip
"""What is typed into the row of a piece, what the model has anew, and what is then done."""


@pytest.mark.parametrize(("own", "new", "done"), FIELDS)
def test_a_field_follows_the_model_or_stays_and_both_are_listed(
    book: bytes, own: dict[str, Any], new: dict[str, Any], done: list[str]
) -> None:
    found = update(typed(book, row=4, **own), changed(p3=new))
    places = {name: address(name, 4) for name in (*own, *new)}
    assert texts(found) == [one.format(**places) for one in done]
    assert found.is_changed == any("->" in one for one in done)


def test_a_piece_that_was_moved_gets_its_position_room_and_floor(book: bytes) -> None:
    moved = {"floor": "Level 2", "room": "B201 Office", "x": 4.25, "y": 3.0, "angle_deg": 0.0}
    found = update(book, changed(p3=moved))
    assert kinds(found) == ["changed"] * 5
    one = inventory(found.data).items[2]
    assert one.item == "A102-03"
    assert {name: getattr(one, name) for name in moved} == moved


def test_what_people_typed_stays(book: bytes) -> None:
    data = typed(book, **TYPED)
    every: dict[str, Any] = {"breadth": 61.0, "width": 81.0, "height": 210.0, "x": 7.0, "y": 7.0, "angle_deg": 10.0}
    every |= {"room": "A102 Office"}
    found = update(data, changed(p1=every | {"notes": "other", "anchored": "unknown", "item": "Z", "description": "Z"}))
    before, after = ({**row(one).values} for one in (data, found.data))
    for name in (*every, "floor"):
        del before[name], after[name]
    assert after == before
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
    live = table(data).letters["breadth"].encode()
    unlike = [
        at for at, (one, other) in enumerate(zip(items, new, strict=True)) if live + b'4"' in one and one != other
    ]
    assert unlike == [4]


def parts(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_nothing_in_the_model_clears_nothing_and_rows_without_a_source_id_are_peoples_own(book: bytes) -> None:
    bare = [{name: value for name, value in one.items() if name in ("item", "floor", "source_id")} for one in ITEMS]
    own = {"item": "Own 1", "floor": "Level 1", "breadth": 40, "height": 180, "x": 1, "y": 1}
    assert update(typed(book, row=8, **own), building(items=bare, building={})).changes == ()


def test_a_piece_that_the_model_lost_stays_and_is_listed(book: bytes) -> None:
    found = update(book, without(building(), 2))
    assert texts(found) == ["Items A3 A101-02 is missing in the model; its row stays"]
    assert found.data is book
    assert not found.is_changed


@pytest.mark.slow
def test_a_source_id_that_is_there_twice_is_listed_and_one_of_other_letter_case_is_another(book: bytes) -> None:
    data = typed(book, row=8, item="Copy", floor="Level 1", breadth=54.5, height=200, source_id=f" {IDS[2]} ")
    letters = table(data).letters["source_id"]
    assert texts(update(data, changed(p3={"breadth": 60.0}))) == [
        f"Items A4 A102-03 stays as it is: its Source ID stands in several rows ({letters}4, {letters}8)"
    ]
    found = update(book, building(items=[*ITEMS, piece(3, "Level 1", "A102 Office", x=9.0)]))
    assert texts(found) == ["Items A4 A102-03 stays as it is: the model has 2 pieces of its Source ID"]
    found = update(book, changed(p3={"source_id": IDS[2].lower(), "breadth": 60.0}))
    assert kinds(found) == ["added", "missing"]


def test_a_formula_of_people_stays_and_is_listed(book: bytes, tmp_path: Path) -> None:
    path = tmp_path / "house.xlsx"
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    old, new = f'<c r="{cell}"><v>50</v>', f'<c r="{cell}"><f>2*25</f><v>50</v>'
    change_parts(path, {"xl/worksheets/sheet4.xml": replace(old, new)})
    assert texts(update(path.read_bytes())) == [
        f"Items {cell} Breadth [cm] of A102-03 stays 50; the model has 54.5: the cell holds a formula"
    ]


@pytest.fixture(scope="module")
def typed_book() -> bytes:
    return typed(typed(first_book(), **TYPED), row=5, **TYPED)


@pytest.mark.slow
@settings(max_examples=10)
@given(st.dictionaries(st.integers(0, 5), st.fixed_dictionaries({}, optional={
    **dict.fromkeys(("breadth", "width", "height"), st.integers(50, 6000).map(lambda one: one / 10)),
    **dict.fromkeys(("x", "y"), st.integers(-10**6, 10**6).map(lambda one: one / 1000)),
    "angle_deg": st.integers(-900, 899).map(lambda one: one / 10),
})))  # fmt: skip
def test_whatever_changes_the_reader_sees_the_model_and_what_people_typed(
    typed_book: bytes, changes: dict[int, dict[str, float]]
) -> None:
    items = [{**one, **changes.get(at, {})} for at, one in enumerate(ITEMS)]
    found = update(typed_book, building(items=items))
    for one, old, model in zip(table(found.data).rows, table(typed_book).rows, items, strict=True):
        for name, factor in (("breadth", 0.01), ("width", 0.01), ("height", 0.01), ("x", 1), ("y", 1)):
            assert one.get(name) == pytest.approx(model[name] * factor, abs=5.1e-4)
        assert (one.get("angle_deg") - model["angle_deg"] + 0.06) % 180 <= 0.12
        for name in ("item", "anchored", "weight", "notes", "importance", "type", "quantity", "axis"):
            assert one.get(name) == old.get(name)
    assert {one.kind for one in found.changes} <= {"changed"}


# ---------------------------------------------------------------- what cannot be updated


def test_a_workbook_or_model_that_does_not_fit_is_refused(book: bytes) -> None:
    other = [{**one, "source_id": f"other {at}"} for at, one in enumerate(ITEMS)]
    for data, model, message in (
        (book, building(items=other, source="tower.ifc"),
         r"house\.xlsx does not seem to be a workbook of tower\.ifc: it has no Source ID"),
        (typed(book, row=1, source_id=None), building(), r"house\.xlsx has no column Source ID in Items"),
        (book, building(items=[]), r"house\.ifc holds no furniture that can be imported; house\.xlsx stays"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=message):
            update_workbook(data, model, "house.xlsx")


def test_what_is_no_workbook_of_an_import_is_refused(book: bytes, tmp_path: Path) -> None:
    handover = write_cobie(tmp_path / "handover.xlsx").read_bytes()
    bare = write_book(tmp_path / "book.xlsx", {"Floors": [["Floor"], ["1"]], "Things": [["a"]]}).read_bytes()
    stray = patch_workbook(book, {"Items": {"A200001": "stray"}}).data
    for data, message in (
        (b"", "is empty"), (b"PK\x03\x04 no zip", "is damaged"), (b"text", "is not an Excel workbook"),
        (handover, "this is a COBie handover file"), (bare, "Items: the sheet is missing"),
        (stray, "Items!A200001: a value far below the table"),
    ):  # fmt: skip
        with pytest.raises(WorkbookError, match=message):
            update_workbook(data, building(), "house.xlsx")


def test_a_signed_workbook_and_a_cell_of_an_array_formula_are_refused(book: bytes, tmp_path: Path) -> None:
    path = tmp_path / "house.xlsx"
    path.write_bytes(book)
    change_parts(path, {"_xmlsignatures/sig1.xml": b"<Signature/>"})
    with pytest.raises(WorkbookError, match="digitally signed"):
        update_workbook(path.read_bytes(), changed(p3={"breadth": 60.0}), "house.xlsx")
    assert update_workbook(path.read_bytes(), building(), "house.xlsx").changes == ()
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    formula = f'<f t="array" ref="{cell}:{address("breadth", 5)}">A1*2</f>'
    change_parts(path, {"xl/worksheets/sheet4.xml": replace(f'<c r="{cell}"><v>', f'<c r="{cell}">{formula}<v>')})
    with pytest.raises(WorkbookError, match=f"Items!{cell}: it belongs to an array formula"):
        update_workbook(path.read_bytes(), building(), "house.xlsx")


def test_it_can_be_cancelled(book: bytes) -> None:
    cancel = Event()
    cancel.set()
    with pytest.raises(CancelledError):
        update_workbook(book, changed(p3={"breadth": 60.0}), "house.xlsx", Progress(cancel=cancel))


# ---------------------------------------------------------------- Building


@pytest.mark.slow
def test_only_blank_lines_of_the_building_are_filled(book: bytes) -> None:
    data = line(book, latitude=None, azimuth_deg=28, building="Town hall", client="Ann")
    found = update(data)
    assert texts(found) == [
        "Building B3 Latitude [deg]: blank -> 45.5",
        "Building B11 Azimuth of X [deg] stays 28; the model has 30",
    ]
    assert row(found.data, sheet="Building").get("building") == "Town hall"
    (change,) = update(book, changed(p3={"breadth": 60.5})).changes
    with speaking(load_catalogue("it")):
        assert "60,5" in gettext(describe(change)), "in the language in use"
