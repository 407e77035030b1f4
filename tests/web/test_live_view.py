"""Classes, words, problems and what of them changed, as the page is told while one types."""

import json
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

import assess
from assess.i18n import load_catalogue, speaking
from assess.pipeline.live_values import live_values
from assess.report.counts import count
from assess.risk import RiskClass
from assess.web.live import LiveView
from assess.workbook.schema import CLASS, LIVE
from assess.workbook.template import Content, write_workbook
from tests.recalculate import evaluate
from tests.web.opened import MARKET, edit, hold, settle
from tests.workbook.books import change_parts, replace
from tests.workbooks import FLOORS, ITEMS, write

HERE = ("class", "word", "chance", "outside")


def _answer(book, view=None, since=None):
    settle(book)
    return json.loads(json.dumps(view.answer(book, since) if view else LiveView().answer(book, since)))


def _by_row(answer):
    """Return class, word, chance, whether outside, and live values of each row of an answer."""
    items = answer["items"]
    columns = [items[name] for name in HERE] + [items["values"][at] for at in sorted(items["values"], key=int)]
    return dict(zip(items["row"], zip(*columns, strict=True), strict=True))


def _expect(results):
    return {
        one.item.row: ("", "anchored", one.adopted.probability)
        if one.is_anchored
        else (one.adopted.risk.name.lower(), "", one.adopted.probability)
        for one in results
    }


def _classes(answer):
    return {row: shown[:3] for row, shown in _by_row(answer).items()}


def _write(path, rows, language="en"):
    with speaking(load_catalogue(language)):
        write_workbook(path, Content({"Floors": FLOORS, "Items": ITEMS, **rows}), spare=3)
    return path


@pytest.mark.slow
def test_classes_and_chances_are_those_of_the_run(example_inventory):
    """Floors with records, for which the sheet's own formulas ask for a run, among them."""
    answer, example = _answer(hold(MARKET)), assess.run(example_inventory, figures=False)
    assert _classes(answer) == _expect(example)
    counts = count("", tuple(example))
    expected = {risk.name.lower(): counts.by_class[risk] for risk in RiskClass}
    assert answer["counts"] == expected | {"": counts.anchored}
    assert answer["error"] == ""
    assert answer["whole"]
    pfa = {one["floor"]: (one["pfa_x"], one["pfa_y"]) for one in answer["floors"]}
    assert pfa["42"] == pytest.approx((0.2224, 0.1359), abs=1e-4)


@pytest.mark.parametrize("language", ["en", "it"])
def test_a_row_without_a_class_has_the_word_of_the_class_column(tmp_path, language):
    """What a spreadsheet program shows for the same cells; it knows nothing of a name that is there twice."""
    slips = [
        ("item", "A1"),  # duplicate
        ("item", None), ("floor", "9"), ("floor", None), ("axis", "Z"), ("height", None), ("height", "tall"),
        ("breadth", 4), ("anchored", "yes"),
    ]  # fmt: skip
    row = {"floor": "1", "breadth": 40, "height": 180}
    items = [{"item": f"A{at}", **row} for at in range(1, len(slips) + 2)] + [{**row, "item": "last", "floor": "3"}]
    floors = [*FLOORS, {"floor": "3"}]
    path = _write(tmp_path / "w.xlsx", {"Items": items, "Floors": floors}, language)
    book = hold(path)
    edit(book, *(("Items", at, field, value) for at, (field, value) in enumerate(slips, 3)))
    answer = _answer(book)
    words = {at: (risk, word) for at, (risk, word, *_) in _by_row(answer).items()}
    path.write_bytes(book.write())
    calculated = evaluate(path)
    title = book.sheets["Items"].title
    shown = {at: calculated.get_value(title, at, 2) or "" for at in words}
    assert words.pop(3)[1] == {"en": "check", "it": "controllare"}[language]
    for at, (risk, word) in words.items():
        assert (word if not risk else shown[at]) == shown[at], (at, slips[at - 3] if 2 < at < 12 else "")
    quick = answer["items"]["quick"][answer["items"]["row"].index(2)]
    assert (words[2][0], quick, shown[2]) == ("medium", "high", {"en": "▲ high", "it": "▲ alto"}[language])
    assert words[max(words)][1] == {"en": "needs shaking", "it": "manca il moto"}[language]


def test_floors_without_shaking_leave_the_others_their_classes_and_changes_make_up_the_whole(tmp_path):
    book = hold(write(tmp_path / "w.xlsx"))
    whole = _classes(_answer(book))
    edit(book, ("Floors", 3, "pfa_x", None))
    answer = _answer(book)
    found = _classes(answer)
    assert {row: found[row] for row in (2, 3)} == {row: whole[row] for row in (2, 3)}
    assert [found[row][1] for row in (4, 5, 6)] == ["needs shaking", "anchored", "needs shaking"]
    assert answer["error"] == ""
    assert [one["lacks"] for one in answer["problems"] if one["severity"] == "error"] == ["shaking"]
    edit(book, ("Floors", 2, "pfa_x", None), ("Floors", 2, "pfa_y", None), ("Floors", 2, "pfv_x", None),
         ("Floors", 2, "pfv_y", None))  # fmt: skip
    answer = _answer(book)
    assert "Floor '1'" in answer["error"]
    assert answer["counts"] == {"low": 0, "medium": 0, "high": 0, "very_high": 0, "": 7}
    book, view = hold(write(tmp_path / "w.xlsx")), LiveView()
    first = _answer(book, view)
    held, stamp = _by_row(first), first["stamp"]
    for step in [*STEPS, "undo", "undo", "redo"]:
        getattr(book, step)(book.version) if isinstance(step, str) else edit(book, *step)
        change = _answer(book, view, stamp)
        assert not change["whole"]
        held |= _by_row(change)
        for row in change["gone"]:
            del held[row]
        whole = _answer(book)
        assert held == _by_row(whole)
        assert {name: change[name] for name in ("problems", "counts", "floors", "error")} == {
            name: whole[name] for name in ("problems", "counts", "floors", "error")
        }
        stamp = change["stamp"]
    assert _answer(book, view, "99.0")["whole"]
    assert _answer(hold(tmp_path / "w.xlsx"), view, stamp)["whole"], "another workbook with the same versions"
    for height in range(100, 120):
        edit(book, ("Items", 2, "height", height))
        _answer(book, view, None)
    assert _answer(book, view, stamp)["whole"], "it is too old"


@pytest.mark.slow
def test_the_run_and_the_page_agree_on_a_faulty_workbook_and_two_languages_do_not_mix(tmp_path):
    """Whatever is left out, what stays is assessed as the command does."""
    book, view = hold(MARKET), LiveView()
    stamp = _answer(book, view)["stamp"]
    edit(book, ("Items", 5, "height", 90))
    for _ in range(2):
        found = _answer(book, view, stamp)
        assert found["items"]["row"] == [5, 6, 7], "it, and those that were exactly like it; asked again, the same"
    assert _answer(book, view, found["stamp"])["items"]["row"] == []
    wrong = [("Floors", 3, "pfa_x", "strong"), ("Items", 7, "height", "tall"), ("Items", 8, "axis", "Z"),
             ("Items", 9, "quantity", -3), ("Building", 0, "ground_pga", "a lot")]  # fmt: skip
    edit(book, *wrong)
    (tmp_path / "w.xlsx").write_bytes(book.write())
    inventory = assess.read_inventory(tmp_path / "w.xlsx", records=MARKET.parent, strict=False)
    expected, answer = _expect(assess.run(inventory, figures=False)), _answer(book)
    found = _classes(answer)
    assert {row: found[row] for row in expected} == expected
    assert all(found[row][0] == "" for row in found.keys() - expected.keys())
    cells = {(one["sheet"], *cell) for one in answer["problems"] if one["severity"] == "error" for cell in one["cells"]}
    assert cells >= {(sheet, *(book.sheets[sheet].place(field, row) or ())) for sheet, row, field, _ in wrong}

    def words(language):
        book = hold(paths[language])
        return {_by_row(_answer(book))[5][1] for _ in range(6)}

    paths = {code: _write(tmp_path / f"{code}.xlsx", {}, code) for code in ("en", "it")}
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(words, ["en", "it"] * 3)) == [{"anchored"}, {"ancorato"}] * 3


STEPS: list[list[Any]] = [
    [("Items", 3, "height", 90)],
    [("Items", 4, "anchored", "yes"), ("Items", 5, "anchored", "no")],
    [("Floors", 3, "pfa_x", 0.1)],
    [("Items", 2, field, None) for field in ("item", "floor", "room", "description", "breadth", "width", "height")],
    [("Items", 9, "item", "B1"), ("Items", 9, "floor", "2"), ("Items", 9, "breadth", 20), ("Items", 9, "height", 200)],
    [("Items", 9, "height", "high")],
    [("Floors", 2, "floor", "ground")],
]


def test_without_a_sheet_with_all_live_columns_and_with_an_unknown_type_a_workbook_is_answered(tmp_path):
    renamed = {"xl/workbook.xml": replace('name="Floors"', 'name="Mine"')}
    answer = _answer(hold(change_parts(write(tmp_path / "w.xlsx"), renamed)))
    assert any(one["sheet"] == "Floors" and one["row"] is None for one in answer["problems"])
    assert not any(answer["items"]["class"])
    book = hold(_write(tmp_path / "w.xlsx", {}))
    items = _answer(book)["items"]
    found = {one.label: items["values"][str(at)] for at, one in book.sheets["Items"].columns.items()
             if one.live in LIVE}  # fmt: skip
    assert len(found) == len(LIVE)
    rows = zip(*found.values(), strict=True)
    order = [LIVE.index(one.live) for one in book.sheets["Items"].columns.values() if one.live in LIVE]
    for shown, expected in zip(rows, live_values(book.snapshot().inventory), strict=True):
        for place, value in zip(order, shown, strict=True):
            if LIVE[place] == CLASS:  # of the sheet: by the formula
                continue
            assert value == (pytest.approx(expected[place]) if isinstance(expected[place], float) else expected[place])
    # Without sizes of its own the piece has no class for that; one that is only begun is left alone.
    items = [{"item": "A1", "floor": "1", "breadth": 40, "height": 180}] * 3
    book = hold(_write(tmp_path / "w.xlsx", {"Items": items, "Floors": FLOORS}))
    edit(
        book,
        ("Items", 2, "type", "Zorp"),
        *(("Items", row, name, None) for row in (2, 3) for name in ("breadth", "height")),
    )
    assert [word for _, word, *_ in _by_row(_answer(book)).values()] == ["type?", "", "check"]


def test_a_piece_that_rolls_has_the_word_in_place_of_a_class_and_gets_its_class_back(tmp_path):
    cart = {"item": "cart", "floor": "1", "breadth": 60, "height": 160, "quantity": 3}
    book = hold(write(tmp_path / "w.xlsx", [cart]))
    before = _answer(book)
    edit(book, ("Items", 2, "mobile", "yes"))
    answer = _answer(book)
    assert _classes(answer)[2][:2] == ("", "rolls")
    assert answer["counts"] == {"low": 0, "medium": 0, "high": 0, "very_high": 0, "": 3}
    edit(book, ("Items", 2, "mobile", "no"))
    assert _classes(_answer(book)) == _classes(before)
