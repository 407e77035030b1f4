from dataclasses import replace

import pytest

from assess.errors import InputError
from assess.portfolio.assumed_inventory import Quantity, build_assumed, spread_pieces
from assess.portfolio.index_file import IndexRow
from assess.workbook.read import read_inventory

OFFICE = IndexRow(
    building="Town office", use="Office", storeys=4, height_m=16.0, floor_area_m2=1000.0, ground_pga_g=0.3
)

INCH = 0.0254


def _count(row: IndexRow) -> dict[str, tuple[int, int, int]]:
    """Return 10 %, 50 % and 90 % quantity of the building by kind of piece."""
    found = build_assumed(row)
    sums: dict[str, list[int]] = {}
    for item in found.rows["Items"]:
        name = item["item"]
        total = sums.setdefault(name.rpartition(" ")[0], [0, 0, 0])
        for at, number in enumerate((found.low[name], item["quantity"], found.high[name])):
            total[at] += number
    return {kind: (one[0], one[1], one[2]) for kind, one in sums.items()}


@pytest.mark.parametrize(
    ("use", "expected"),
    [
        ("healthcare", {"bookcase": (27, 108, 323), "lateral file": (22, 43, 65)}),
        ("laboratory", {"bookcase": (54, 323, 431), "lateral file": (22, 32, 43)}),
        ("Uffici", {"bookcase": (54, 215, 431), "lateral file": (54, 86, 215)}),
    ],
)
def test_quantities_by_use(use, expected):
    assert _count(replace(OFFICE, use=use, floor_area_m2=10_000.0)) == expected
    assert _count(OFFICE) == {"bookcase": (5, 22, 43), "lateral file": (5, 9, 22)}
    assert _count(replace(OFFICE, floor_area_m2=50.0))["lateral file"] == (0, 1, 1), "many buildings have one"


def test_storeys_keep_the_quantities_of_the_building():
    for area in (60.0, 1000.0, 33_333.0):
        whole = _count(replace(OFFICE, storeys=1, floor_area_m2=area))
        for storeys in (2, 7, 60):
            assert _count(replace(OFFICE, storeys=storeys, floor_area_m2=area)) == whole


def test_what_is_left_over_stands_on_the_upper_storeys():
    assert spread_pieces(Quantity(2, 5, 9), 3) == [Quantity(0, 1, 3), Quantity(1, 2, 3), Quantity(1, 2, 3)]
    assert spread_pieces(Quantity(1, 2, 7), 4) == [
        Quantity(0, 0, 0), Quantity(0, 0, 0), Quantity(0, 1, 3), Quantity(1, 1, 4),
    ]  # fmt: skip


def test_uses_without_quantities_are_refused_with_the_reason():
    for use in ("School", "Home", "apartment", "retail", "Shop", "warehouse", "hospitality", "Library", "xyz"):
        match = f"^no inventory can be assumed for the use '{use}': FEMA P-58 gives quantities of furniture for "
        with pytest.raises(InputError, match=match):
            build_assumed(replace(OFFICE, use=use))


@pytest.mark.parametrize(
    ("blank", "message"),
    [
        ({"use": ""}, r"^no inventory can be assumed without use\. Give it in the index"),
        ({"storeys": None}, r"^no inventory can be assumed without storeys\. Give it in"),
        ({"floor_area_m2": None, "storeys": None}, r"without storeys, floor_area_m2\."),
        ({"floor_area_m2": 5.0}, "for a floor area of 5 m2: FEMA P-58 gives less than one piece"),
        (
            {"floor_area_m2": 1e7},
            "10,000,000 m2 on 4 storeys is more than 10,000 pieces of a kind a storey: check both",
        ),
    ],
)
def test_what_is_needed(blank, message):
    with pytest.raises(InputError, match=message):
        build_assumed(replace(OFFICE, **blank))


def test_a_blank_height_is_assumed_and_said():
    found = build_assumed(replace(OFFICE, height_m=None))
    assert found.problems[1].message == "height_m is blank: 4 m a storey assumed, 16 m."
    assert found.rows["Building"][0]["height"] == 16.0


def test_it_is_an_inventory_with_the_sizes_of_p58():
    assumed = build_assumed(OFFICE)
    assert assumed.problems[0].message.startswith(
        "inventory assumed: no piece of this building has been seen. 22 bookcases (5 to 43), 9 lateral files (5 to "
        "22), by its use (office) and its gross floor area (1,000 m2)"
    )
    inventory = read_inventory(assumed.rows)
    found = {one.type: one for one in inventory.items}
    bookcase, file = found["Bookcase 6 shelves"], found["Lateral file 4 drawers"]
    assert (bookcase.breadth, bookcase.height) == pytest.approx((12.625 * INCH, 81.25 * INCH), abs=1e-3)
    assert (file.breadth, file.height) == pytest.approx((18.6 * INCH, 52.5 * INCH), abs=1e-3)
    assert (bookcase.width, file.width) == (0.914, None)
    assert [floor.elevation for floor in inventory.floors] == [0.0, 4.0, 8.0, 12.0]
    assert {one.anchored for one in inventory.items} == {"unknown"}
    assert not [one for one in inventory.problems if one.severity == "error"]
