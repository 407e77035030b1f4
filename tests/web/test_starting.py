"""New workbooks made from the page, and the texts that it asks for."""

import re

import pytest

import assess
from assess.web import texts
from assess.web.file_names import make_safe

ASKED = {
    "kind": "template", "name": "ufficio", "use": "Office", "building": "Sede", "town": "Avellino", "language": "it",
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
    server.client.post("/api/start", {**ASKED, "name": "third", "floor": "3", "language": "en"})
    live = server.client.get("/api/live").json()  # the height of the floor is not known
    assert (live["error"], len(live["items"]["class"])) == ("", 2)
    assert set(live["items"]["class"]) <= {"low", "medium", "high", "very_high"}
    (floor,) = assess.read_inventory(server.folder / "third.xlsx").floors
    assert floor.elevation is None


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
