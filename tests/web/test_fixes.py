"""The fixes of problems that one click makes: made as the page makes them, after which the problem is gone."""

from assess.i18n import load_catalogue, speaking
from assess.web.live import LiveView
from assess.workbook.template import Content, write_workbook
from tests.web.opened import hold

FLOORS = [{"floor": "0", "name": "Hall", "elevation": 0}, {"floor": "Piano terra"}, {"floor": "2", "elevation": 7.0}]
BARE = dict.fromkeys(("breadth", "height"))
SLIPS = [
    ({"floor": "2nd floor"}, ["Use 2"]), ({"floor": "hall"}, ["Use 0"]), ({"floor": "Ground floor"}, ["Use 0"]),
    ({"floor": "Piano tera"}, ["Use Piano terra", "Add floor Piano tera"]), ({"floor": "3"}, ["Add floor 3 at 10.5 m"]),
    ({"floor": "B1"}, ["Add floor B1"]), ({"type": "Medicin cabinet"}, ["Use Medicine cabinet"]),
    ({"type": "Locker", "breadth": 50, "width": 60, "height": 180}, ["Add Locker 50 × 60 × 180 cm to Catalogue"]),
    ({"type": "Thing"}, []), ({"anchored": "yess"}, ["Use yes"]), ({"height": 1.8}, ["Use 180 cm"]),
    ({"breadth": 90, "width": 40}, ["Exchange Breadth and Width"]),
    ({"breadth": 190, "width": 200, "height": 40}, ["Exchange Breadth and Height"]),
    ({"breadth": "45 cm"}, ["Write 45"]), ({"route": "Way"}, []),
]  # fmt: skip


def _open(path, items, floors=FLOORS, language="en", units="si", **building):
    named = [{"item": f"A{n}", "floor": "0", "breadth": 40, "height": 180} | own for n, own in enumerate(items, 1)]
    rows = {"Building": [{"shaking": "MMI VIII, severe"} | building], "Floors": floors, "Items": named}
    with speaking(load_catalogue(language)):
        write_workbook(path, Content(rows), units, spare=3)
    return hold(path)


def _list(book):
    """Return the problems of cells of Items, but not what is usual."""
    found = LiveView().answer(book, None)["problems"]
    return [one for one in found if one["sheet"] == "Items" and "usual" not in one["message"]]


def test_each_slip_offers_its_fix_and_is_gone_once_it_is_made(tmp_path):
    for own, labels in SLIPS:
        bare = BARE if "type" in own else {}
        book = _open(tmp_path / "w.xlsx", [bare | own])
        found = [action for one in _list(book) for action in one["actions"]]
        assert [one["label"] for one in found] == labels, own
        for fix in found:
            book.edit(book.version, fix["edits"], fix["label"])
            assert _list(book) == [], (own, fix)
            book.undo(book.version)


def test_one_click_fixes_all_cells_of_one_kind_in_one_step(tmp_path):
    words = [{"breadth": f"{40 + n} cm"} for n in range(3)]
    items = [*words, *[BARE | {"type": "Medicin cabinet"}] * 2, *[{"floor": "5"}] * 2]
    book = _open(tmp_path / "w.xlsx", items)
    fixes = {fix["label"]: fix["edits"] for one in _list(book) for fix in one["actions"]}
    assert {label: len(edits) for label, edits in fixes.items()} == {
        "Fix all 3": 3, "Use Medicine cabinet (all 2)": 2, "Add floor 5 at 17.5 m": 2,
    }  # fmt: skip
    for label, edits in fixes.items():
        book.edit(book.version, edits, label)
    assert _list(book) == []
    assert list(LiveView().answer(book, None)["items"]["word"]) == [""] * 7


def test_in_italian_and_in_feet_the_words_and_numbers_are_those_of_the_workbook(tmp_path):
    floors = [{"floor": "Terra", "elevation": 0}, {"floor": "1", "elevation": 12}]
    items = [{"breadth": 16, "height": 70, "floor": floor} for floor in ("2° piano", "Piano terra")]
    book = _open(
        tmp_path / "w.xlsx", [*items, {"type": "Armadio", "breadth": 20, "height": 70}], floors, "it", "imperial"
    )
    labels = [fix["label"] for one in _list(book) for fix in one["actions"]]
    assert labels == [
        "Aggiungi il piano 2° piano a 24 ft",
        "Usa Terra",
        "Usa Terra",
        "Aggiungi Armadio 20 × 70 in a Catalogo",
    ]
