"""A building model imported again: what it tells is updated, what people typed stays, and everything is listed."""

from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from hypothesis import given, settings, strategies as st

from assess.bim.import_workbook import ImportedBuilding, build_workbook
from assess.bim.read_source import read_source
from assess.bim.update_workbook import describe, update_workbook
from assess.errors import CancelledError, InputError, WorkbookError
from assess.i18n import gettext, load_catalogue, speaking
from assess.progress import Progress
from tests.bim import cobie_files
from tests.bim.update_books import (
    FLOORS,
    IDS,
    ITEMS,
    PLACES,
    TYPES,
    building,
    changed,
    faults,
    first_book,
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
    without,
    write_first,
)
from tests.workbook import books
from tests.workbook.books import change_parts, write_book
from tests.workbooks import address, edited, parts_of

TYPED = {
    "axis": "X", "anchored": "yes", "friction": 0.4, "route": "R1", "segment": "a", "edge_distance": 0.2,
    "importance": "life safety", "centre_of_gravity": 55, "against_wall": "yes", "weight": 80, "bracket_height": 150,
    "bracket_capacity": 1.5, "photo": "w1.jpg", "notes": "Two brackets\nto the wall", "description": "Wardrobe of Ann",
}  # fmt: skip
"""What people type about a piece."""


# ---------------------------------------------------------------- the same model again


def test_the_same_import_changes_nothing_and_another_leaves_every_other_byte(book: bytes, tmp_path: Path) -> None:
    found = update_workbook(book, building(), "house.xlsx")
    assert (found.data, found.changes, found.problems, found.is_changed) == (book, (), (), False)
    # A comment, a part that no program knows, a sheet of the user, and the sheets that the model does not tell of.
    path = tmp_path / "house.xlsx"
    path.write_bytes(book)
    kind = '<Default Extension="bin" ContentType="application/octet-stream"/></Types>'
    change_parts(path, {"xl/unknown.bin": bytes(range(256)), "[Content_Types].xml": books.replace("</Types>", kind)})
    data = path.read_bytes()
    found = update(data, changed(p3={"breadth": 60.0}, p4={"x": 9.0}))
    before, after = parts_of(data), parts_of(found.data)
    different = {name for name in before if before[name] != after.get(name)}
    assert before.keys() == after.keys()
    assert different <= {"xl/worksheets/sheet4.xml", "xl/worksheets/sheet9.xml", "xl/workbook.xml"}  # Items, Lists
    items, new = (one["xl/worksheets/sheet4.xml"].split(b"<row ") for one in (before, after))
    live = table(data).letters["breadth"].encode()
    unlike = [
        at for at, (one, other) in enumerate(zip(items, new, strict=True)) if live + b'4"' in one and one != other
    ]
    assert unlike == [4]


@pytest.mark.slow
def test_a_real_model_again_changes_nothing() -> None:
    name = "LargeBuilding.ifc"
    model = read_source(Path(__file__).parents[2] / "samples" / "models" / name, name, routes="draft")
    data = build_workbook(model)
    assert update_workbook(data, model, "b.xlsx").data is data


@pytest.mark.slow
def test_a_cobie_file_again_adds_what_is_new_and_its_sizes_follow(tmp_path: Path) -> None:
    """Such files have no positions, and nothing in them says where sizes come from."""
    path = cobie_files.write_cobie(tmp_path / "handover.xlsx")
    data = build_workbook(read_source(path, path.name))
    assert update_workbook(data, read_source(path, path.name), "b.xlsx").data is data
    more = [*cobie_files.COMPONENTS, {**cobie_files.COMPONENTS[0], "Name": "Bookcase A:9", "ExtIdentifier": "new"}]
    cobie_files.write_cobie(
        path, types=({**cobie_files.TYPES[0], "NominalHeight": 1850}, *cobie_files.TYPES[1:]), components=more
    )
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


def test_what_people_typed_and_what_the_model_lost_stays_and_is_listed(book: bytes, tmp_path: Path) -> None:
    data = typed(book, **TYPED)
    every: dict[str, Any] = {"breadth": 61.0, "width": 81.0, "height": 210.0, "x": 7.0, "y": 7.0, "angle_deg": 10.0}
    every |= {"room": "A102 Office"}
    found = update(data, changed(p1=every | {"notes": "other", "anchored": "unknown", "item": "Z", "description": "Z"}))
    before, after = ({**row(one).values} for one in (data, found.data))
    for name in (*every, "floor"):
        del before[name], after[name]
    assert after == before
    assert len(found.changes) == len(every)
    bare = [{name: value for name, value in one.items() if name in ("item", "floor", "source_id")} for one in ITEMS]
    own = {"item": "Own 1", "floor": "Level 1", "breadth": 40, "height": 180, "x": 1, "y": 1}
    assert update(typed(book, row=8, **own), building(items=bare, building={})).changes == ()
    found = update(book, without(building(), 2))
    assert texts(found) == ["Items A3 A101-02 is missing in the model; its row stays"]
    assert found.data is book
    assert not found.is_changed
    path = tmp_path / "house.xlsx"
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    old, new = f'<c r="{cell}"><v>50</v>', f'<c r="{cell}"><f>2*25</f><v>50</v>'
    change_parts(path, {"xl/worksheets/sheet4.xml": books.replace(old, new)})
    assert texts(update(path.read_bytes())) == [
        f"Items {cell} Breadth [cm] of A102-03 stays 50; the model has 54.5: the cell holds a formula"
    ]


@pytest.mark.slow
def test_a_source_id_that_is_there_twice_is_listed_and_a_model_of_one_storey_touches_that_alone(book: bytes) -> None:
    data = typed(book, row=8, item="Copy", floor="Level 1", breadth=54.5, height=200, source_id=f" {IDS[2]} ")
    letters = table(data).letters["source_id"]
    assert texts(update(data, changed(p3={"breadth": 60.0}))) == [
        f"Items A4 A102-03 stays as it is: its Source ID stands in several rows ({letters}4, {letters}8)"
    ]
    found = update(book, building(items=[*ITEMS, piece(3, "Level 1", "A102 Office", x=9.0)]))
    assert texts(found) == ["Items A4 A102-03 stays as it is: the model has 2 pieces of its Source ID"]
    found = update(book, changed(p3={"source_id": IDS[2].lower(), "breadth": 60.0}))
    assert kinds(found) == ["added", "missing"]
    model: ImportedBuilding = replace(without(changed(p5={"breadth": 60.0}), 1, 2, 3, 4), floors=FLOORS[1:])
    found = update(book, replace(model, places=PLACES[3:]))
    assert kinds(found) == ["changed", *["missing"] * 4]


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


def test_what_cannot_be_updated_is_refused_and_an_update_can_be_cancelled(book: bytes, tmp_path: Path) -> None:
    other = [{**one, "source_id": f"other {at}"} for at, one in enumerate(ITEMS)]
    for data, model, message in (
        (book, building(items=other, source="tower.ifc"),
         r"house\.xlsx does not seem to be a workbook of tower\.ifc: it has no Source ID"),
        (typed(book, row=1, source_id=None), building(), r"house\.xlsx has no column Source ID in Items"),
        (book, building(items=[]), r"house\.ifc holds no furniture that can be imported; house\.xlsx stays"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=message):
            update_workbook(data, model, "house.xlsx")
    handover = cobie_files.write_cobie(tmp_path / "handover.xlsx").read_bytes()
    bare = write_book(tmp_path / "book.xlsx", {"Floors": [["Floor"], ["1"]], "Things": [["a"]]}).read_bytes()
    stray = edited(book, {"Items": {"A200001": "stray"}})
    for data, message in (
        (b"", "is empty"), (b"PK\x03\x04 no zip", "is damaged"), (b"text", "is not an Excel workbook"),
        (handover, "this is a COBie handover file"), (bare, "Items: the sheet is missing"),
        (stray, "Items!A200001: a value far below the table"),
    ):  # fmt: skip
        with pytest.raises(WorkbookError, match=message):
            update_workbook(data, building(), "house.xlsx")
    path = tmp_path / "house.xlsx"
    path.write_bytes(book)
    change_parts(path, {"_xmlsignatures/sig1.xml": b"<Signature/>"})
    with pytest.raises(WorkbookError, match="digitally signed"):
        update_workbook(path.read_bytes(), changed(p3={"breadth": 60.0}), "house.xlsx")
    assert update_workbook(path.read_bytes(), building(), "house.xlsx").changes == ()
    path.write_bytes(typed(book, row=4, breadth=50))
    cell = address("breadth", 4)
    formula = f'<f t="array" ref="{cell}:{address("breadth", 5)}">A1*2</f>'
    change_parts(path, {"xl/worksheets/sheet4.xml": books.replace(f'<c r="{cell}"><v>', f'<c r="{cell}">{formula}<v>')})
    with pytest.raises(WorkbookError, match=f"Items!{cell}: it belongs to an array formula"):
        update_workbook(path.read_bytes(), building(), "house.xlsx")
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


# ---------------------------------------------------------------- names that people have changed


def renamed(data: bytes, names: dict[str, str]) -> bytes:
    changes: dict[str, dict[str, Any]] = {}
    for sheet in ("Floors", "Items", "Places", "Routes", "Catalogue"):
        found = table(data, sheet)
        for one in found.rows:
            for name in ("floor", "room", "place", "type"):
                if one.get(name) in names:
                    changes.setdefault(sheet, {})[found.cell(name, one.number)] = names[one.get(name)]
    return edited(data, changes)


NEW_ON_2 = piece(7, "Level 2", "B201 Office")


# ---------------------------------------------------------------- floors


RENAMED = "it seems to have been renamed"


@pytest.mark.slow
def test_floors_that_were_renumbered_are_not_mixed_up() -> None:
    """People call 0 and 1 what the model calls 1 and 2: pieces stay, new ones go to the floor that is meant."""

    def rename(rows: Any, new: str = "") -> list[dict[str, Any]]:
        return [{**one, "floor": one["floor"].replace("Level ", new)} for one in rows]

    model = building(floors=rename(FLOORS), items=rename(ITEMS), places=rename(PLACES))
    data = renamed(write_first(model), {"1": "0", "2": "1"})
    assert kinds(update(data, model)) == ["kept", "kept"]
    moved = {**ITEMS[2], "floor": "2", "room": "B201 Office"}
    items = rename([*ITEMS[:2], moved, *ITEMS[3:], NEW_ON_2])
    found = update(data, replace(model, items=items))
    assert [one.floor for one in inventory(found.data).items] == ["0", "0", "1", "0", "1", "1", "1"]
    assert [one.get("floor") for one in table(found.data, "Floors").rows] == ["0", "1"]
    anew = building(floors=rename(FLOORS, "L0"), items=rename(ITEMS, "L0"), places=rename(PLACES, "L0"))
    assert kinds(update(data, anew)) == ["kept", "kept"], "names that the model gives anew"


def test_floors_are_added_their_plans_replaced_and_what_people_corrected_or_renamed_stays(book: bytes) -> None:
    floor = {"floor": "Level 3", "elevation": 6.2, "plan": "house-Level-3.svg", "plan_left": 0.0}
    found = update(book, building(floors=[*FLOORS, floor], items=[*ITEMS, piece(7, "Level 3", "C301")]))
    assert texts(found) == ["Floors A4 Level 3 was added", "Items A8 C301-07 was added"]
    added = row(found.data, 3, "Floors")
    assert (added.get("elevation"), added.get("plan"), added.get("plan_left")) == (6.2, "house-Level-3.svg", 0.0)
    assert faults(found.data) == []
    data = typed(typed(book, "Floors", 2, elevation=0.45), "Floors", 3, elevation=None)
    found = update(data)
    cell = address("elevation", 2, "Floors")
    assert texts(found) == [
        f"Floors {cell} Elevation [m] of Level 1 stays 0.45; the model has 0",
        f"Floors {cell[0]}3 Elevation [m] of Level 2: blank -> 3.1",
    ]
    # The types tell which files the workbook was imported from.
    floors = [{**one, "plan": one["plan"].replace("house", "house-v2")} for one in FLOORS]
    model = building(source="house_v2.ifc", floors=floors, files={one["plan"]: b"<svg/>" for one in floors})
    found = update(book, model)
    assert [(one.was, one.now) for one in found.changes] == [
        ("house-Level-1.svg", "house-v2-Level-1.svg"), ("house-Level-2.svg", "house-v2-Level-2.svg"),
    ]  # fmt: skip
    data = typed(book, "Floors", 6, name="Levels as of the survey in May")
    model = building(floors=[*FLOORS, {"floor": "Level 3", "elevation": 6.2}])
    with pytest.raises(WorkbookError, match="Floors!A6: 1 new row of the model was not added: row 6, the last"):
        update_workbook(data, model, "house.xlsx")
    data = renamed(book, {"Level 1": "EG", "A102 Office": "Archive", "Exit A101": "Main entrance"})
    found = update(data, building(items=[*changed(p3={"breadth": 60.0}).items, piece(7, "Level 1", "A102 Office")]))
    assert texts(found) == [
        f"Floors A2 Floor of EG stays 'EG'; the model has 'Level 1': {RENAMED}",
        f"Items {address('room', 4)} Room of A102-03 stays 'Archive'; the model has 'A102 Office': {RENAMED}",
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03: 54.5 -> 60",
        "Items A8 A102-07 was added",
        f"Places A4 Place of Main entrance stays 'Main entrance'; the model has 'Exit A101': {RENAMED}",
    ]
    piece_added = inventory(found.data).items[-1]
    assert (piece_added.floor, piece_added.room) == ("EG", "Archive")
    assert faults(found.data) == []


# ---------------------------------------------------------------- rooms and types


def test_rooms_and_types_follow_the_model_and_those_that_people_chose_stay(book: bytes) -> None:
    found = update(book, changed(p5={"room": "B202 Store"}, p6={"room": "A102 Office"}))
    assert [one.now for one in found.changes] == ["B202 Store", "A102 Office"]
    data = book
    for number in (2, 4, 6):
        data = typed(data, row=number, type="Bookcase tall")
    found = update(data, building(items=[*ITEMS, NEW_ON_2]))
    assert texts(found) == [
        f"Items {address('type', 2)} Type of A101-01 stays 'Bookcase tall'; the model has 'Wardrobe 80': it seems to "
        "have been renamed",
        "Items A8 B201-07 was added",
    ]
    assert inventory(found.data).items[-1].type == "Bookcase tall"
    new = {**TYPES[0], "type": "Wardrobe 90", "width": 90.0}
    pieces = {f"p{number}": {"type": "Wardrobe 90", "width": 90.0} for number in (1, 3, 5)}
    found = update(book, building(items=changed(**pieces).items, types=[new, TYPES[1]]))
    assert kinds(found) == ["changed", "kept"] * 3 + ["added"]
    assert inventory(found.data).items[0].width == pytest.approx(0.9)
    data = typed(book, "Catalogue", 2, weight=95)
    own = {"type": "Bookcase tall", "breadth": 77.0, "height": 222.0}
    found = update(data, building(types=[{**TYPES[0], "width": 82.0, "weight": 50.0}, TYPES[1], own]))
    assert kinds(found) == ["changed", "kept", "kept"]
    assert texts(found)[0] == f"Catalogue {address('width', 2, 'Catalogue')} Width [cm] of Wardrobe 80: 80 -> 82"
    assert texts(found)[1].endswith("the model has 77: the type comes with the program")
    kind = row(found.data, sheet="Catalogue")
    assert (kind.get("width"), kind.get("weight")) == (pytest.approx(0.82), 95)


@pytest.mark.slow
def test_types_told_apart_by_a_number_are_found_by_their_sizes_and_routes_are_peoples_own() -> None:
    """The numbers follow the order of the pieces: "Desk" of today may be "Desk (2)" of the workbook."""
    small, large = ({"type": "Desk", "breadth": 60.0, "width": width, "height": 75.0} for width in (120.0, 160.0))
    first = building(types=[small, {**large, "type": "Desk (2)"}])
    data = typed(write_first(first), "Catalogue", 2, weight=30)
    again = building(types=[large, {**small, "type": "Desk (2)"}])
    assert update(data, again).changes == ()
    third = {**small, "width": 140.0}
    found = update(data, building(types=[third, {**small, "type": "Desk (2)"}, {**large, "type": "Desk (3)"}]))
    assert texts(found) == [f"Catalogue A{table(data, 'Catalogue').rows[-1].number + 1} Desk (3) was added"]
    # Drafts number their points: "L1 point 1" of the model may be another one than that of a reviewed route.
    point = {"place": "L1 point 1", "floor": "Level 1", "x": 5.0, "y": 2.0}
    segment = {"route": "R", "segment": "a", "floor": "Level 1", "start": "L1 point 1", "end": "Exit A101"}
    data = write_first(building(places=[*PLACES, point], routes=[segment]))
    others = [{**point, "x": 9.0}, {**point, "place": "L1 point 2"}]
    other = [{**segment, "segment": "b", "clear_width": 1.2}, segment | {"route": "S"}]
    assert update(data, building(places=[*PLACES, *others], routes=other)).changes == ()


# ---------------------------------------------------------------- places and routes


def test_places_follow_their_kind_and_floor_stay_and_without_a_sheet_they_are_left_out(book: bytes) -> None:
    data = typed(book, "Places", 2, kind="corridor")
    data = typed(data, "Places", 6, place="Assembly point", floor="Level 1", x=-9, y=0, kind="exit")
    outline = "0 0; 7 0; 7 4; 0 4"
    found = update(data, building(places=[{**PLACES[0], "x": 3.5, "outline": outline}, *PLACES[2:]]))
    assert [(one.label, one.was, one.now) for one in found.changes] == [
        ("X [m]", 3, 3.5), ("Outline [m]", PLACES[0]["outline"], outline),
    ]  # fmt: skip
    assert row(found.data, sheet="Places").get("kind") == "corridor"
    data = typed(book, "Places", 6, place="Exit B", floor="Level 2", x=50, y=50)
    new = {"place": "exit b", "floor": "Level 1", "x": 20.0, "y": 2.0, "kind": "exit"}
    found = update_workbook(data, building(places=[*PLACES, new]), "house.xlsx")
    assert texts(found) == ["Places B6 Floor of Exit B stays 'Level 2'; the model has 'Level 1'"]
    found = update(resaved(book, lambda one: one.remove(one["Places"])))
    assert texts(found)[0] == "Places A101 Hall of the model was left out: the workbook lacks the sheet"
    assert kinds(found) == ["left_out"] * len(PLACES)
