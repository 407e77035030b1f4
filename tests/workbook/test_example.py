"""The example of `assess new --example`: it stands alone, and its live columns tell what the program does; the rooms of each use."""

from itertools import cycle
from typing import Any

import openpyxl
import pytest

from assess.cli.command_new import write_new_workbook
from assess.i18n import load_catalogue, speaking
from assess.pipeline.live_values import live_values, with_live
from assess.workbook.catalogue import read_catalogue
from assess.workbook.example import SCENARIO, example_content, room_content
from assess.workbook.lists import PLACES
from assess.workbook.read import read_inventory
from assess.workbook.schema import ITEMS, LIVE, SHEETS, USES
from assess.workbook.template import write_workbook
from tests.cli.calling import error, run
from tests.recalculate import evaluate
from tests.workbook.test_live import AGREEMENT, by_formualizer, poison


@pytest.fixture(scope="module", params=["si", "imperial"])
def path(request, tmp_path_factory):
    units = request.param
    path = tmp_path_factory.mktemp(units) / "example.xlsx"
    write_workbook(path, with_live(example_content(units), units), units)
    return path


def same(one: Any, other: Any) -> bool:
    return bool(one == other if isinstance(other, str) else one == pytest.approx(other, abs=1e-9, rel=0))


@pytest.mark.parametrize("sheet", SHEETS[:5], ids=lambda sheet: sheet.name)
def test_imperial_rows_are_the_si_rows_converted(sheet):
    rows = zip(*(example_content(units).rows[sheet.name] for units in ("si", "imperial")), strict=True)
    for si, imperial in rows:
        assert si.keys() == imperial.keys()
        for name, value in si.items():
            if isinstance(value, str) or sheet.column(name).imperial == sheet.column(name).unit:
                assert imperial[name] == value
            else:
                factor = {"in": 1 / 2.54, "ft": 1 / 0.3048, "in/s": 1 / 2.54}[sheet.column(name).imperial]
                assert imperial[name] == pytest.approx(value * factor, abs=0.051)


def test_stored_live_values_are_the_programs_and_those_of_a_spreadsheet_engine(path):
    page = openpyxl.load_workbook(path, data_only=True)["Items"]
    book = evaluate(path)
    for row, values in enumerate(live_values(read_inventory(path)), 2):
        for label, value in zip(LIVE, values, strict=True):
            at = PLACES["Items", label] + 1
            assert same(page.cell(row, at).value, value), (row, label)
            assert same(book.get_value("Items", row, at), value), (row, label)


def new(folder, use, units="si", language="en", *, example=False):
    path = folder / f"{use}-{units}-{language}.xlsx"
    write_new_workbook(path, units, language=language, use=use, example=example)
    return path


def stored(path):
    book = openpyxl.load_workbook(path, data_only=True)
    places = [PLACES[ITEMS.name, label] for label in LIVE]
    rows = book.worksheets[3].iter_rows(min_row=2, values_only=True)
    return [tuple(row[at] for at in places) for row in rows if row[0]]


@pytest.mark.slow
def test_every_use_lacks_nothing_but_shaking_and_its_example_shows_the_results_of_a_run(tmp_path):
    for use, (units, language) in zip(USES, cycle([("si", "it"), ("imperial", "en")])):
        inventory = read_inventory(new(tmp_path, use, units, language), strict=False)
        assert {one.sheet for one in inventory.errors} <= {"Floors", "Piani", "Building", "Edificio"}, use
        with speaking(load_catalogue(language)):
            rows = room_content(use, units).rows
        assert len(inventory.catalogue) == len(rows["Catalogue"])
        assert (inventory.building.use, inventory.language) == (rows["Building"][0]["use"], language)
    for use, (units, language) in zip(USES, cycle([("si", "en"), ("imperial", "it")])):
        path = new(tmp_path, use, units, language, example=True)
        inventory = read_inventory(path)
        assert inventory.problems == ()
        assert [item.item for item in inventory.items] == [row["item"] for row in room_content(use).rows["Items"]]
        with speaking(load_catalogue(language)):
            wanted = live_values(inventory)
            assert inventory.building.scenario == load_catalogue(language).find(SCENARIO)
        for row, values in zip(stored(path), wanted, strict=True):
            assert row == tuple(one if isinstance(one, str) else pytest.approx(one, abs=1e-3) for one in values)


@pytest.mark.slow
def test_without_shaking_the_live_columns_tell_the_slenderness(tmp_path):
    path = new(tmp_path, "Hospital", "imperial")
    shown = stored(path)
    types = {row["type"]: row["breadth"] / row["height"] for row in read_catalogue()}
    named = [row["type"] for row in room_content("Hospital").rows["Items"]]
    assert [row[0] for row in shown] == [pytest.approx(types[name], rel=1e-3) for name in named]
    assert all(set(row[1:]) == {"needs shaking"} for row in shown)
    computed = by_formualizer(poison(path))
    for at, row in enumerate(shown, 2):
        assert computed[at] == [pytest.approx(row[0], abs=AGREEMENT), *row[1:]]


@pytest.mark.slow
def test_the_command_writes_it_and_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    message = error(run("new", "ward.xlsx", "--for", "hotel"))
    assert all(word in message for word in ("'hotel'", "laboratory"))
    assert list(tmp_path.iterdir()) == []
    done = run("new", "ward.xlsx", "--for", "hospital")
    assert done.exit_code == 0
    assert "in place of the example room" in done.stderr
    assert "assess check ward.xlsx" in done.stderr
    assert run("new", "ward.xlsx", "--for", "hospital").exit_code == 1, "it is not replaced unasked"
    assert run("new", "ward.xlsx", "--for", "school", "--force", "--example").exit_code == 0
    assert read_inventory(tmp_path / "ward.xlsx").building.use == "School"
