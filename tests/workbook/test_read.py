"""`read_inventory`: from a path, from bytes or from rows in code; strict or not; cancelled; in the user's language."""

import hashlib
import threading
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from assess.errors import CancelledError, InputError, WorkbookError
from assess.i18n import gettext, load_catalogue, speaking
from assess.model import Inventory
from assess.progress import Progress, Report
from assess.workbook.catalogue import read_catalogue
from assess.workbook.example import example_content
from assess.workbook.read import read_inventory
from assess.workbook.template import write_workbook
from tests.workbook.books import FLOORS, ITEMS, Sheet, problems_of, write, write_book
from tests.workbook.test_records import floors_with, write_record

CODE: dict[str, Any] = {
    "Building": {"building": "Town hall", "Default friction": 0.4},
    "Floors": [{"floor": "1", "pfa_x": 0.5}],
    "Items": [
        {"item": "A1", "floor": "1", "breadth": 40, "Height [m]": 1.8},
        {"item": "A2", "floor": 1, "breadth": 30, "Height [m]": 1.5, "quantity": 2},
    ],
}


def lenient(path: Path) -> Inventory:
    return read_inventory(path, strict=False)


def test_the_bytes_that_are_read_are_hashed_and_kept_and_records_may_be_handed_over_as_bytes(tmp_path: Path) -> None:
    path = write(tmp_path)
    data = path.read_bytes()
    inventory, by_bytes = read_inventory(path), read_inventory(data)
    assert lenient(path) == inventory
    assert (by_bytes.items, by_bytes.floors, by_bytes.sha256) == (inventory.items, inventory.floors, inventory.sha256)
    assert by_bytes.read_bytes() == data
    path.write_bytes(b"changed since")
    assert inventory.read_bytes() == data
    assert inventory.sha256 == hashlib.sha256(data).hexdigest()
    (tmp_path / "records" / "a").mkdir(parents=True)
    write_record(tmp_path / "records" / "a" / "one.csv")
    path = write(tmp_path, floors=floors_with(r"a\one.csv"))
    data, record = path.read_bytes(), (tmp_path / "records" / "a" / "one.csv").read_bytes()
    inventory = read_inventory(data, records={"a/one.csv": record})
    assert inventory.files == {r"a\one.csv": hashlib.sha256(record).hexdigest()}
    assert inventory.floors[0].records["X"][0].record.channel == "NS"
    assert read_inventory(path, records=tmp_path / "records").floors[0].records["X"]
    with pytest.raises(WorkbookError, match=r"Floors!B2: the file .* is not among the records that were passed"):
        read_inventory(data)


def test_tables_of_pandas_are_rows_in_code() -> None:
    rows = {name: [content] if isinstance(content, dict) else content for name, content in CODE.items()}
    tables = {name: pd.DataFrame(content) for name, content in rows.items()}
    assert read_inventory(tables).items == read_inventory(CODE).items
    wider = tables["Items"].assign(notes=pd.Series([None, "Shelf"]), quantity=pd.array([pd.NA, 2], dtype="Int64"))
    assert [(one.notes, one.quantity) for one in read_inventory({**tables, "Items": wider}).items] == [
        ("", 1),
        ("Shelf", 2),
    ]
    longer = pd.concat([wider] * 40, ignore_index=True).assign(item=[f"A{at}" for at in range(80)])
    changed = longer.assign(notes=pd.Series(["Desk" if at == 40 else None for at in range(80)]))
    hashes = {read_inventory({**tables, "Items": one}).sha256 for one in (longer, changed)}
    assert len(hashes) == 2  # of all rows, not of the few that a table prints


def test_the_example_in_code_is_the_example_of_a_file(tmp_path: Path) -> None:
    content = example_content()
    write_workbook(tmp_path / "example.xlsx", content)
    by_file, by_code = (
        read_inventory(tmp_path / "example.xlsx"),
        read_inventory({**content.rows, "Catalogue": read_catalogue()}),
    )
    for name in ("items", "floors", "places", "routes"):
        pairs = zip(getattr(by_file, name), getattr(by_code, name), strict=True)
        assert [
            (one, two)
            for file, code in pairs
            for field in file.__dataclass_fields__
            if field not in ("row", "cells", "assumed", "breadth", "width", "height")
            and (one := getattr(file, field)) != (two := getattr(code, field))
        ] == []


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"height": 1.8}, "Items row 3 Height: Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?"),
    ({"item": "a1"}, "Items row 3 Item: duplicate Item 'a1', also in row 1 Item. Give each its own name."),
    ({"height": float("nan")}, "Items row 3 Height: Height is blank and no Type gives it. Fill it in, or choose a Type "
                               "that has one."),
]  # fmt: skip


def test_rows_in_code_get_the_checks_and_messages_of_a_workbook() -> None:
    sound = [{"item": f"A{at}", "floor": "1", "breadth": 40, "height": 180} for at in (1, 2, 3)]
    for cells, message in WRONG:
        with pytest.raises(WorkbookError) as caught:
            read_inventory({**CODE, "Items": [*sound[:2], sound[2] | cells]})
        assert [str(one) for one in caught.value.problems if one.severity == "error"] == [message]
    cases: list[tuple[dict[str, Any], type[Exception], str]] = [
        ({"Items": [], "Chairs": []}, InputError, "the sheet 'Chairs' is not known, expected: Building, Floors"),
        ({"Items": ["A1"]}, InputError, "Items: every row has to be a mapping of fields to values"),
        ({"Items": []}, WorkbookError, "Floors: the sheet is missing"),
        ({"Items": [{"Height": 180}], "Floors": []}, WorkbookError, "Items Height: Height has no unit"),
        ({"Items": [{"floor": "1"}], "Floors": []}, WorkbookError, r"Items: the column Item is missing\. Add it"),
        ({**CODE, "Building": {"Storeys": 0.5}}, WorkbookError, "Building Storeys: Storeys is 0.5, expected a whole"),
    ]
    for rows, error, message in cases:
        with pytest.raises(error, match=message):
            read_inventory(rows)


def test_a_faulty_row_or_sheet_is_left_out_with_the_rows_that_need_it(tmp_path: Path) -> None:
    items = [*ITEMS, ["A2", "1", 40, 1.8], ["A3", "1", 50, 170], ["A3", "1", 50, 170]]
    path = write(tmp_path, items, Building=[["Use", "school"], ["Storeys", "many"]])
    inventory = lenient(path)
    assert [one.item for one in inventory.items] == ["A1", "A3"]
    assert (inventory.building.use, inventory.building.storeys) == ("school", None)
    assert [one.place for one in inventory.errors] == ["Building!B2", "Items!D3", "Items!A5"]
    assert {str(one) for one in inventory.errors} == {str(one) for one in problems_of(path)}
    with pytest.raises(WorkbookError, match="is not an Excel workbook"):
        read_inventory(b"no workbook", strict=False)
    floors: Sheet = [*FLOORS, ["2", "strong"]]
    inventory = lenient(write(tmp_path, [*ITEMS, ["A2", "2", 40, 180], ["A3", "2", 40, 180]], floors))
    assert ([one.floor for one in inventory.floors], [one.item for one in inventory.items]) == (["1"], ["A1"])
    assert [str(one) for one in inventory.problems if one.severity == "warning"] == [
        "Items!B3: 2 rows that name Floor '2' are left out, as the row that defines '2' has errors. Correct that row."
    ]
    items = [["Item", "Floor", "Breadth [cm]", "Heigth [cm]"], ["A1", "1", 40, 180]]
    inventory = lenient(write(tmp_path, items))
    assert (inventory.items, [one.floor for one in inventory.floors]) == ((), ["1"])
    assert "Items!D1" in [one.place for one in inventory.errors]
    assert lenient(write(tmp_path, [])).items == ()
    places: Sheet = [["Place", "Floor", "X [m]", "Y [m]"], ["Hall", "1", "far", 1], ["Door", "1", 9, 1]]
    routes: Sheet = [["Route", "Segment", "From", "To", "Clear width [m]"], ["Way", "a", "Hall", "Door", 1.2]]
    items = [[*ITEMS[0], "Route", "Segment"], [*ITEMS[1], "Way", "a"], ["A2", "1", 40, 180, None, None]]
    inventory = lenient(write(tmp_path, items, Places=places, Routes=routes))
    assert ([one.item for one in inventory.items], inventory.routes) == (["A2"], ())
    assert [one.place for one in inventory.places] == ["Door"]


def test_reading_reports_obeys_a_cancel_and_says_errors_in_italian(tmp_path: Path) -> None:
    path, reports = write(tmp_path), list[Report]()
    read_inventory(path, progress=Progress(reports.append))
    assert [(one.stage, one.share) for one in reports] == [("reading", 0.0), ("reading", 0.5), ("reading", 1.0)]
    cancel = threading.Event()

    def stop(report: Report) -> None:
        cancel.set()

    with pytest.raises(CancelledError):
        read_inventory(path, progress=Progress(stop, cancel))
    floors: Sheet = [["Piano", "PFA X [g]"], ["1", 0.5]]
    items: Sheet = [["Elemento", "Piano", "Profondità [cm]", "Altezza [cm]"], ["A1", "9", 40, 1.8]]
    with pytest.raises(WorkbookError) as caught:
        read_inventory(write_book(tmp_path / "cartella.xlsx", {"Piani": floors, "Arredi": items}))
    assert caught.value.language == "it"
    with speaking(load_catalogue("it")):
        said = [f"{gettext(one.message)} {gettext(one.fix)}" for one in caught.value.problems]
    assert said == [
        "Altezza è 1,8 cm, atteso da 5 a 600 cm. Si intendeva 1,8 m = 180 cm?",
        "Piano '9' non è nel foglio Piani. Scegliere una voce del foglio Piani, oppure aggiungerla lì.",
    ]
