"""The built-in types of furniture: sizes that make sense, sources that can be cited, names of their own."""

import re
from typing import Any

import pytest

from assess.details import FIX_BY
from assess.i18n import load_catalogue, speaking
from assess.workbook.catalogue import ASSUMED, catalogue_rows, catalogue_texts, is_assumed, read_catalogue
from assess.workbook.read import read_inventory
from assess.workbook.template import Content, write_workbook
from tests.workbook.books import problems_of, write

LANGUAGES = ("en", "it")
NUMBERS = ("breadth", "width", "height", "weight", "centre_of_gravity")
FLOORS = [{"floor": "1", "pfa_x": 0.5}]


def test_sizes_make_sense_and_sources_can_be_cited_or_are_marked_assumed():
    for row in read_catalogue():
        breadth, width, height = row["breadth"], row.get("width"), row["height"]
        assert 5 <= breadth <= height <= 600, row
        assert width is None or breadth <= width <= 600, row
        assert 5 <= row.get("centre_of_gravity", 50) <= 95, row
        if "weight" in row:  # with what it holds: between paper in a light case and solid water
            density = row["weight"] / (breadth * width * height * 1e-6)
            assert 50 <= density <= 1000, row
    for row in catalogue_rows():
        source = row["source"]
        assert len(source) > 20, row
        assert not re.search(r"https?:|www\.|\.com\b|\.org\b|shop|product page|Wikipedia|IKEA", source), row
        if source.startswith(ASSUMED):
            assert not row["weight_kg"], row  # a weight of no source would pass for one with
            assert bool(row["centre_percent"]) == ("centre of gravity" in source), row
        else:
            assert re.search(r"\d", source), row
            assert not row["centre_percent"], row


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_assumed_source_is_known_in_every_language(language):
    """They are translated; other sources are titles, which are not."""
    rows = catalogue_rows()
    assumed = [row["source"] for row in rows if row["source"].startswith(ASSUMED)]
    assert set(assumed) < set(catalogue_texts())
    with speaking(load_catalogue(language)):
        marked = {row["type"] for row in read_catalogue() if is_assumed(row["source"])}
        names = [row["type"] for row in read_catalogue()]
    assert 0 < len(marked) == len(assumed) < len(rows)
    assert not is_assumed("Assumedly: a size")
    assert not is_assumed("")
    assert len({name.casefold() for name in names}) == len(names) == len(rows)
    padded = [re.sub(r"\d+", lambda found: found[0].zfill(4), name.casefold()) for name in names]
    assert padded == sorted(padded), "as people sort them"


@pytest.mark.parametrize("units", ["si", "imperial"])
def test_every_type_gives_what_a_piece_lacks(tmp_path, units):
    types = {row["type"]: row for row in read_catalogue()}
    items = [{"item": name, "floor": "1", "type": name} for name in types]
    write_workbook(tmp_path / "book.xlsx", Content({"Items": items, "Floors": FLOORS}), units)
    inventory = read_inventory(tmp_path / "book.xlsx")
    assert inventory.problems == ()
    assert len(inventory.items) == len(inventory.catalogue) == len(types)
    for item in inventory.items:
        row = types[item.type]
        assert {name for name in item.assumed if name in NUMBERS} == row.keys() & set(NUMBERS)
        assert (item.breadth, item.height) == pytest.approx((row["breadth"] / 100, row["height"] / 100), rel=1e-3)
        assert item.weight == (pytest.approx(row["weight"], rel=1e-3) if "weight" in row else None)
        assert item.centre_of_gravity == pytest.approx(row.get("centre_of_gravity", 50) / 100)


def test_every_type_has_a_way_to_fix_it_and_what_is_on_castors_is_never_fixed_to_a_wall():
    rows = catalogue_rows()
    assert {row["fix_by"] for row in rows} == {*FIX_BY}
    assert {row["mobile"] for row in rows} == {"", "yes"}
    for row in rows:
        assert row["mobile"] or "on castors" not in row["type"], row
        assert not row["mobile"] or row["fix_by"] in ("castors", "chain", "by the maker"), row


def test_an_unknown_way_to_fix_names_its_cell_and_the_choices(tmp_path):
    header = ["Type", "Breadth [cm]", "Height [cm]", "Fix by", "Mobile"]
    path = write(tmp_path, Catalogue=[header, ["Shelf", 30, 180, "glue", None], ["Cart", 60, 90, "castors", "perhaps"]])
    found = {one.cell: one for one in problems_of(path)}
    assert found.keys() == {"D2", "E3"}
    assert "Fix by is 'glue', expected one of: wall bracket, strap, base angle, chain" in str(found["D2"].message)
    assert {one.sheet for one in found.values()} == {"Catalogue"}


def test_words_for_castors_only_ask_where_nothing_else_tells(tmp_path):
    header = ["Item", "Floor", "Breadth [cm]", "Height [cm]", "Type", "Mobile", "Notes"]
    rows: list[list[Any]] = [["A", None, "On castors"], ["A", "no", "On castors"], ["Crash cart on castors", None, "Trolley"],
            ["Linen cart", None, None], ["A", None, "carts to the left? no: see A1"], ["A", None, None]]  # fmt: skip
    items: list[list[Any]] = [header, *([f"P{at}", "1", 60, 100, *row] for at, row in enumerate(rows))]
    inventory = read_inventory(write(tmp_path, items))
    found = {one.cell: one for one in inventory.problems if "castors" in str(one.message)}
    assert found.keys() == {"G2", "E5", "G6"}
    assert {one.severity for one in found.values()} == {"note"}
    assert "Fill in Mobile: yes or no." in str(found["G2"].fix)
    assert [item.mobile for item in inventory.items] == [None, False, True, None, None, None]
