"""New workbooks made from the page, and the texts that it asks for."""

import re
from pathlib import Path

import pytest

import assess
from assess.web import texts
from assess.web.book import Book
from assess.web.file_names import make_safe
from assess.web.live import LiveView
from assess.web.request_errors import RequestError
from assess.web.starting import build_workbook
from tests.conftest import EXAMPLE

ASKED = {
    "kind": "template", "name": "ufficio", "use": "Office", "building": "Sede", "address": "Avellino", "language": "it",
    "shaking": "MMI VIII, severe", "floor": "1", "room": "Archivio", "units": "imperial",
    "pieces": [{"type": "Bookcase 5 shelves", "count": 2}],
}  # fmt: skip
"""A type in English: the page may speak another language than the workbook."""


@pytest.mark.slow
def test_a_template_has_classes_at_once(served):
    server = served()
    offers = server.client.get("/api/book")
    assert (offers.status, offers.json()["can_save"], offers.json()["folder"]) == (200, True, "home")
    cookie = f"{server.client.headers['Cookie']}; assess-language=it"
    types = server.client.get("/api/start", Cookie=cookie).json()["types"]["Office"]
    asked = {**ASKED, "pieces": [*ASKED["pieces"], {"type": types[0]["type"], "count": 1}]}
    book = server.client.post("/api/start", asked).json()
    assert (book["name"], book["mode"], book["language"], book["units"]) == ("ufficio.xlsx", "disk", "it", "imperial")
    live = server.client.get("/api/live").json()
    assert live["error"] == ""
    assert all(live["items"]["class"])
    inventory = assess.read_inventory(server.folder / "ufficio.xlsx")
    assert [one.item for one in inventory.items] == ["A1", "A2", "A3"]
    assert {one.room for one in inventory.items} == {"Archivio"}
    assert (inventory.building.address, inventory.building.use) == ("Avellino", "Office")
    assert inventory.language == "it"
    server.client.post("/api/start", {**ASKED, "name": "attic", "floor": "Attic", "language": "en"})
    live = server.client.get("/api/live").json()  # the height of the floor is not known
    assert (live["error"], len(live["items"]["class"])) == ("", 2)
    assert set(live["items"]["class"]) <= {"low", "medium", "high", "very_high"}
    assert [one.elevation for one in assess.read_inventory(server.folder / "attic.xlsx").floors] == [0, None]


@pytest.mark.parametrize(
    ("asked", "floors", "on"),
    [
        ({"floor": "3rd floor"}, {"0": 0, "1": 3.3, "2": 6.6, "3": 9.9}, "3"),
        ({"floor": "2", "storeys": "4", "height": "16 m"}, {"0": 0, "1": 4, "2": 8, "3": 12}, "2"),
        ({"floor": "1° piano", "storeys": "2"}, {"0": 0, "1": 3.3}, "1"),
        ({"floor": "Ground floor", "storeys": "3", "height": "36", "units": "imperial"},
         {"0": 0, "1": 3.6576, "2": 7.3152}, "0"),
        ({"floor": "B1", "storeys": "2", "height": "7"}, {"0": 0, "1": 3.5, "B1": None}, "B1"),
        ({"floor": "5", "storeys": "3", "height": "9"}, {"0": 0, "1": 3, "2": 6, "3": 9, "4": 9, "5": 9}, "5"),
    ],
)  # fmt: skip
def test_floors_are_made_from_storeys_and_height_and_the_first_piece_has_a_class(asked, floors, on):
    request = {"use": "Hospital", "shaking": "MMI VIII, severe", "pieces": [{"type": "Medicine cabinet", "count": 1}]}
    book = Book.hold("w.xlsx", build_workbook({**request, **asked}).data, Path())
    inventory = book.snapshot().inventory
    assert {one.floor: one.elevation for one in inventory.floors} == pytest.approx(floors, abs=0.01)
    assert [one.floor for one in inventory.items] == [on]
    assert LiveView().answer(book, None)["items"]["class"] != [""]
    is_assumed = [one.name == "elevation assumed" for one in inventory.floors]
    assert any(is_assumed) == ("height" not in asked)
    assert inventory.building.height == (
        {"16 m": 16, "36": pytest.approx(10.9728), "7": 7, "9": 9}.get(asked.get("height"))
    )


def test_what_is_typed_of_the_building_is_read_as_its_cells_are_and_refused_with_the_reason():
    typed = {"address": "Via Roma 1", "latitude": "43.7", "longitude": "-122.2", "storeys": "4", "structure": "walls",
             "ground_pga": "25 %g", "ground_pgv": "0,3 m/s", "records": ["a b#1;2.smc", "../c.smc"]}  # fmt: skip
    book = Book.hold("w.xlsx", build_workbook({"use": "Office", **typed}).data, Path())
    building = book.snapshot().inventory.building
    assert (building.address, building.latitude, building.longitude, building.storeys, building.structure) == (
        "Via Roma 1", 43.7, -122.2, 4, "walls",
    )  # fmt: skip
    assert (building.ground_pga, building.ground_pgv) == pytest.approx((0.25 * 9.80665, 0.3))
    assert {one["name"] for one in book.describe()["missing"]} == {"a b-1-2.smc", "c.smc"}
    for field, text, why in (
        ("height", "1", "Height is 1 m, expected 2 to 1000 m"), ("storeys", "2.5", "expected a whole number"),
        ("latitude", "99", "expected -90 to 90"), ("structure", "straw", "expected one of"),
        ("ground_pga", "lots", "expected a number"),
    ):  # fmt: skip
        with pytest.raises(RequestError, match=why) as refused:
            build_workbook({"use": "Office", field: text})
        assert (refused.value.status, refused.value.more) == (422, {"field": field})
    with pytest.raises(RequestError, match="at most 2 files"):
        build_workbook({"use": "Office", "records": ["a", "b", "c"]})


def test_the_example_is_made_in_the_language_of_the_page(example_inventory):
    made = build_workbook({"kind": "example", "language": "it"})
    assert build_workbook({"kind": "example"}).data == EXAMPLE.read_bytes()
    folder = EXAMPLE.parent
    book = Book.hold(made.name, made.data, folder)
    found = book.snapshot().inventory
    assert (found.language, set(made.files)) == (
        "it",
        {one.file for floor in found.floors for axis in floor.records.values() for one in axis},
    )
    same = ("item", "floor", "breadth", "height", "axis", "anchored", "x", "y", "importance")
    known, translated = (
        [[getattr(one, name) for name in same] for one in of.items] for of in (example_inventory, found)
    )
    assert translated == known
    assert {one.room for one in found.items} >= {"Sala riunioni", "Ufficio sud"}
    assert {one.place for one in found.places} >= {"42 Ufficio nord", "G cortile"}
    assert "error" not in [one["severity"] for one in LiveView().answer(book, None)["problems"]]


@pytest.mark.slow
def test_a_new_workbook_replaces_no_file_and_every_text_of_the_page_is_found(served):
    server = served()
    taken = server.folder / "taken.xlsx"
    taken.write_bytes(b"mine")
    assert server.client.post("/api/start", {"kind": "blank", "name": "taken.xlsx"}).status == 409
    for name in ("../a.xlsx", "a/b.xlsx", "a\\b.xlsx", "C:\\a.xlsx", "/tmp/a.xlsx", "CON.xlsx", ".xlsx", ".a.xlsx",
                 "a\n.xlsx", "a\u202e.xlsx", "x" * 300, "-rf.xlsx", "a:b.xlsx", 5, ["a"]):  # fmt: skip
        assert server.client.post("/api/start", {"kind": "blank", "name": name}).status == 422, name
    refused = {"a<b>.xlsx": "cannot have < >", "nul": "Windows keeps", "-rf": "cannot begin", ".xlsx": "Choose a name"}
    for name, why in refused.items():
        assert why in server.client.post("/api/start", {"kind": "blank", "name": name}).json()["fix"]
    for wrong in ({"kind": "x"}, {"use": "Castle"}, {"shaking": "strong"}, {"units": "feet"}, {"language": "tlh"},
                  {"pieces": [{"type": "Throne", "count": 1}]}, {"pieces": [{"type": "Desk", "count": 10**9}]},
                  {"pieces": [3]}, {"pieces": "Desk"}, {"building": "x" * 1000}):  # fmt: skip
        assert server.client.post("/api/start", {"kind": "template", "name": "n", **wrong}).status == 422, wrong
    assert [one.name for one in server.folder.iterdir()] == ["taken.xlsx"]
    assert taken.read_bytes() == b"mine"
    assert server.client.get("/api/state").json()["state"] is None
    # A call of `t` or `tn` with anything but plain literals would stay English in every language.
    called = sum(
        len(re.findall(r"(?<![\w$.])(?<!function )tn?\(", path.read_text(encoding="utf-8")))
        for path in texts.PAGE.glob("*.mjs")
    )
    found = texts.list_texts()
    assert len(found) == called > 100
    italian = served().client.get("/api/texts?language=it").json()
    assert (italian["decimal"], italian["group"], italian["texts"]["low"]) == (",", ".", "basso")
    many = [one for one, other, _ in found if other]
    assert all(len(italian["texts"][one]) == 2 for one in many)


def test_names_that_were_sent_are_made_safe_and_literals_of_javascript_are_read_as_it_reads_them():
    assert make_safe("office.xlsx") == "office.xlsx"
    assert make_safe("../../etc/Büro 2.XLSM") == "Büro 2.XLSM"
    assert make_safe("C:\\Users\\a\\b?.xlsx") == "b.xlsx"
    assert {make_safe(name) for name in ("", "..", "\0", "con.xlsx", ".xlsx")} == {"workbook.xlsx"}
    source = r"""t("a \"b\" é"), t('it\'s'), tn("{n} x", '{n} ' + "xs", n), t(`c`), set("no"), x.t("no"), t("long " +
        "text")"""
    found = [
        [texts._evaluate(one[name] or "") for name in ("text", "one", "many")] for one in texts._CALL.finditer(source)
    ]
    assert found == [
        ['a "b" é', "", ""], ["it's", "", ""], ["", "{n} x", "{n} xs"], ["c", "", ""], ["long text", "", ""]
    ]  # fmt: skip
