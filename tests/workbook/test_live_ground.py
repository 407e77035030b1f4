"""The live columns of floors without a record: PFV of a typed PFA, and floors that follow from the ground.

They are the program's numbers to 1e-9, or a word in place of a class.
"""

import csv
from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.i18n import load_catalogue, speaking
from assess.intensity import SHAKINGS
from assess.model import STRUCTURES
from assess.motion.floor_medians import TABLE
from assess.units import GRAVITY
from assess.workbook.template import Units
from tests.recalculate import evaluate
from tests.workbook.test_live import Rows, by_formualizer, check, fill, poison

pytestmark = pytest.mark.slow

UNPLACED = {"floor": "loft"}
FLOORS: Rows = [*({"floor": str(at), "elevation": z} for at, z in enumerate((-3, 0, 3.5, 7.25, 30))), UNPLACED]
SIZES: Rows = [
    {"breadth": 30, "height": 190}, {"breadth": 60, "height": 180, "axis": "Y"},
    {"breadth": 120, "height": 100, "centre_of_gravity": 40}, {"type": "Bookcase 5 shelves"},
]  # fmt: skip
ITALIAN_SIZES = [*SIZES[:3], {"type": "Libreria a 5 ripiani"}]


def furnish(floors: Rows, sizes: Rows = SIZES) -> Rows:
    return [{"item": f"{one['floor']} {at}", "floor": one["floor"], **size}
            for one, (at, size) in product(floors, enumerate(sizes))]  # fmt: skip


UNITS: tuple[Units, ...] = ("si", "imperial")


def with_others_long(choices: Iterable[Any]) -> list[Any]:
    """Return choices, every other one for the long tests."""
    return [pytest.param(one, marks=pytest.mark.long) if at % 2 else one for at, one in enumerate(choices)]


def slender(path: Path, floors: Rows, **building: Any) -> Path:
    """Write a slender piece on each floor that has a name, governed by the larger motion."""
    names = [one["floor"] for one in floors if "floor" in one]
    items = [{"item": name, "floor": name, "breadth": 20, "height": 180} for name in names]
    return fill(path, items, floors, building)


def show(folder: Path, floors: Rows, **building: Any) -> dict[str, list[Any]]:
    """Return what is shown of such a piece on each floor."""
    folder.mkdir(exist_ok=True)
    shown = by_formualizer(poison(slender(folder / "book.xlsx", floors, **building)))
    return {one["floor"]: shown[row] for row, one in enumerate(floors, 2)}


def write_record(folder: Path, name: str = "roof.csv") -> None:
    """Write a record of alternate sign and growing size, 0.2 g at most."""
    rows = "".join(f"{at * 0.02:.2f},{0.2 * at / 400 * (-1) ** (at // 10):.6f}\n" for at in range(401))
    (folder / name).write_text(f"time [s],acceleration [g]\n{rows}", encoding="utf-8")


# ---------------------------------------------------------------- floors that follow from the ground

BUILDINGS: dict[str, dict[str, Any]] = {
    "PGA and PGV": {"ground_pga": 0.3, "ground_pgv": 25.0, "period": 0.7, "structure": "frame"},
    "PGA": {"ground_pga": 0.3, "period": 0.3, "structure": "walls"},
    "PGV": {"ground_pgv": 40.0, "height": 45, "structure": "dual"},
    "SDS": {"sds": 1.1, "height": 12},
    "SDS and PGV": {"sds": 0.4, "ground_pgv": 60.0, "storeys": 12},
    "PGA before SDS": {"ground_pga": 0.12, "sds": 1.5, "storeys": 4, "shaking": "JMA 7"},
    "MMI": {"shaking": "MMI VI, strong", "period": 2.1},
    "JMA": {"shaking": "JMA 5-, lower"},
    "MMI and PGV": {"shaking": "MMI VIII, severe", "ground_pgv": 9.0, "motion_uncertainty": 1.1},
    "JMA and PGV": {"shaking": "JMA 6+, upper", "ground_pgv": 90.0, "motion_uncertainty": 0.2},
    "typed scatter": {"ground_pga": 0.1, "motion_uncertainty": 0.4},
    "no scatter": {"ground_pgv": 11.0, "motion_uncertainty": 0},
    "as filled": {"ground_pga": 0.25, "period": 3.0, "scenario_kind": "as filled"},
    "shortest T1": {"ground_pga": 0.2, "ground_pgv": 20.0, "period": 0.02},
    "longest T1": {"ground_pga": 0.2, "ground_pgv": 20.0, "period": 20},
    "small ratio": {"ground_pga": 1.0, "ground_pgv": 5.0, "structure": "masonry"},
    "large ratio": {"ground_pga": 0.05, "ground_pgv": 60.0, "structure": "timber"},
}


@pytest.mark.parametrize("at", with_others_long(range(len(BUILDINGS))), ids=BUILDINGS)
def test_floors_on_the_ground_equal_the_program(tmp_path: Path, at: int) -> None:
    building, units = list(BUILDINGS.values())[at], UNITS[at // 2 % 2]
    check(fill(tmp_path / "book.xlsx", furnish(FLOORS), FLOORS, building, units))


@pytest.mark.parametrize("structure", with_others_long(STRUCTURES))
@pytest.mark.parametrize("known", [{"period": 0.45}, {}], ids=["T1", "unknown building"])
def test_every_structure_equals_the_program(tmp_path: Path, structure: str, known: dict[str, Any]) -> None:
    floors = FLOORS if known else [UNPLACED]
    building = {"ground_pga": 0.3, "ground_pgv": 45.0, "structure": structure, **known}
    check(fill(tmp_path / "book.xlsx", furnish(floors), floors, building))


@pytest.mark.parametrize("choice", with_others_long(SHAKINGS))
def test_every_intensity_equals_the_program(tmp_path: Path, choice: str) -> None:
    floors = [FLOORS[1], FLOORS[4]]
    path = fill(tmp_path / "book.xlsx", furnish(floors), floors, {"shaking": choice, "period": 4.0})
    check(path)
    assert by_formualizer(path)[2][1] == pytest.approx(SHAKINGS[choice].pga / GRAVITY)


def test_a_motion_at_grade_serves_unknown_heights(tmp_path: Path) -> None:
    for grade, building in (({"elevation": 0}, {}), ({"elevation": -3}, {"storeys": 4})):
        write_record(tmp_path)
        for motion in ({"pfa_x": 0.3}, {"record_x": "roof.csv"}):
            floors = [{"floor": "G", **grade, **motion}, UNPLACED]
            assert show(tmp_path, floors, **building)["loft"][1:] == ["run assess"] * 7, (grade, building)
            check(fill(tmp_path / "book.xlsx", furnish(floors), floors, building))


ITALIAN = [{"shaking": "MMI VIII, severe"}, {"ground_pga": 0.2, "structure": "muratura"}]


@pytest.mark.parametrize("kind", ITALIAN)
def test_an_italian_workbook_equals_the_program(tmp_path: Path, kind: dict[str, Any]) -> None:
    with speaking(load_catalogue("it")):
        check(fill(tmp_path / "book.xlsx", furnish(FLOORS, ITALIAN_SIZES), FLOORS, kind))


AT_9_M: Rows = [{"floor": "a", "elevation": 9}]
ROOFS: dict[str, dict[str, Any]] = {
    name: {"ground_pga": 0.2, "period": 0.8} | one
    for name, one in {
        "highest": {}, "height": {"height": 9}, "storeys": {"storeys": 3}, "low": {"height": 5, "storeys": 9},
        "fewer": {"storeys": 2}, "higher": {"height": 18, "storeys": 2}, "more": {"storeys": 6},
    }.items()
}  # fmt: skip


def test_only_storeys_leave_floors_by_their_number_to_the_program(tmp_path: Path) -> None:
    """The sheet reads no numbers out of names; a floor of which PFA and PFV are typed needs no height."""
    floors: Rows = [{"floor": "1"}, {"floor": "2", "pfa_x": 0.3}, {"floor": "3", "pfa_x": 0.3, "pfv_x": 30}]
    check(fill(tmp_path / "book.xlsx", furnish(floors), floors, {"ground_pga": 0.2, "storeys": 4}))
    shown = show(tmp_path / "shown", floors, ground_pga=0.2, storeys=4)
    assert [one[1] for one in shown.values()] == ["run assess", "run assess", 0.3]
    alone = show(tmp_path / "alone", floors[:1], ground_pga=0.2, storeys=4)
    assert alone["1"][1:] == ["run assess"] * 7


def test_every_way_to_the_roof_and_floors_beside_a_ground_floor_at_0_equal_the_program(tmp_path: Path) -> None:
    for name, building in ROOFS.items():
        check(slender(tmp_path / f"{name}.xlsx", AT_9_M, **building))
    for floors in (BESIDE_0, TWO_AT_0):
        check(fill(tmp_path / "book.xlsx", furnish(floors), floors, {"ground_pga": 0.2, "storeys": 4}))


BESIDE_0: Rows = [{"floor": "1", "elevation": 0}, {"floor": "2"}]
TWO_AT_0: Rows = [*BESIDE_0, {"floor": "3", "elevation": 0}]
"""So that numbers do not tell where floor 2 lies."""


# ---------------------------------------------------------------- typed peaks

OWN: dict[str, Rows] = {
    "without PFV": [{"pfa_x": 0.3}, {"pfa_y": 0.2}, {"pfa_x": 0.4, "pfa_y": 0.5}, {"pfa_x": 0.6}, {"pfa_y": 0.1}],
    "with some": [
        {"pfa_x": 0.3, "pfv_x": 20}, {"pfa_y": 0.2, "pfv_y": 50}, {"pfa_x": 0.4, "pfv_x": 70, "pfa_y": 0.5},
        {"pfa_x": 0.4, "pfa_y": 0.4, "pfv_y": 35}, {},
    ],
    "at grade": [{}, {"pfa_x": 0.2, "pfv_x": 12}, {"pfa_x": 0.3}, {"pfa_y": 0.4}, {"pfa_x": 0.5, "pfa_y": 0.6}],
    "at grade, no PFV": [{"pfa_y": 0.2}, {}, {"pfa_x": 0.3}, {"pfa_y": 0.4}, {"pfa_x": 0.5, "pfa_y": 0.6}],
    "at grade, two ratios": [
        {}, {"pfa_x": 0.2, "pfv_x": 12, "pfa_y": 0.2, "pfv_y": 40}, {"pfa_x": 0.3}, {"pfa_y": 0.4}, {"pfa_x": 0.5},
    ],
    "below grade first": [{"pfa_y": 0.2, "pfv_y": 44}, {"pfa_x": 0.2, "pfv_x": 12}, {"pfa_x": 0.3}, {"pfa_y": 0.4}, {}],
}  # fmt: skip
AROUND: list[dict[str, Any]] = [
    {}, {"period": 0.5, "structure": "walls"}, {"height": 60, "ground_pga": 0.3, "ground_pgv": 90.0},
    {"storeys": 14, "shaking": "MMI IX, violent", "scenario_kind": "given", "motion_uncertainty": 0.3},
    {"sds": 0.9, "ground_pgv": 10.0, "structure": "frame"}, {"ground_pgv": 33.0},
]  # fmt: skip


def own_floors(name: str, unplaced: dict[str, Any] | None = None) -> Rows:
    placed = [floor | own for floor, own in zip(FLOORS[:5], OWN[name], strict=True)]
    return [*placed, UNPLACED | (unplaced or {"pfa_x": 0.35, "pfa_y": 0.2})]


@pytest.mark.parametrize("shift", [0, 1, *(pytest.param(at, marks=pytest.mark.long) for at in range(2, len(AROUND)))])
@pytest.mark.parametrize("at", range(len(OWN)), ids=OWN)
def test_typed_peaks_equal_the_program(tmp_path: Path, at: int, shift: int) -> None:
    """Each kind of floor with two buildings, and each building with two kinds; with all of them in the long tests."""
    floors, building = own_floors(list(OWN)[at]), AROUND[(at + shift) % len(AROUND)]
    if building.get("scenario_kind") == "given":  # which serves no floor above the highest typed one
        floors = [one for one in floors if one.keys() & {"pfa_x", "pfa_y"}]
    check(fill(tmp_path / "book.xlsx", furnish(floors), floors, building))


def test_a_typed_floor_leaves_the_others_to_the_program_and_rows_without_a_name_change_nothing(
    tmp_path: Path,
) -> None:
    shown = show(tmp_path, [*FLOORS[:4], FLOORS[4] | {"pfa_x": 0.4}], shaking="MMI VII, very strong")
    assert [one[1:] for one in shown.values()][:4] == [["run assess"] * 7] * 4
    assert shown["4"][1] == 0.4
    # They are no floors: neither their height is that of the roof, nor their motion that of the ground.
    alone = show(tmp_path / "alone", AT_9_M, ground_pga=0.2)["a"]
    beside = by_formualizer(poison(slender(tmp_path / "book.xlsx", [*AT_9_M, *NAMELESS], ground_pga=0.2)))[2]
    assert beside[:5] == pytest.approx(alone[:5])
    assert beside[4:] == alone[4:]


NAMELESS: Rows = [{"elevation": 60}, {"elevation": 0, "pfa_x": 0.9, "pfv_x": 200}, {"record_x": "roof.csv"}]


# ---------------------------------------------------------------- records and ShakeMaps beside

BESIDE_RECORDS: dict[str, Rows] = {
    "above": [{"elevation": 0, "pfa_x": 0.1}, {"elevation": 4, "pfa_x": 0.2, "pfv_x": 15}, {"elevation": 8}],
    "at grade": [{"elevation": 4, "pfa_x": 0.2}, {"elevation": 8, "pfa_y": 0.2, "pfv_y": 15}, {"elevation": 0}],
    "not placed": [{"pfa_x": 0.1}, {"elevation": 8, "pfa_y": 0.2, "pfv_y": 15}, {}],
}


@pytest.mark.parametrize("along", ["record_x", "record_y"])
@pytest.mark.parametrize("own", [{}, {"pfa_y": 0.15}], ids=["alone", "with PFA Y"])
@pytest.mark.parametrize("name", BESIDE_RECORDS)
def test_beside_records_the_sheet_equals_the_program(
    tmp_path: Path, name: str, own: dict[str, Any], along: str
) -> None:
    write_record(tmp_path)
    floors: Rows = [{"floor": str(at), **one} for at, one in enumerate(BESIDE_RECORDS[name])]
    floors[2] |= {along: "roof.csv", **own}
    check(fill(tmp_path / "book.xlsx", furnish(floors), floors, {"period": 0.6}))


def test_records_and_shakemaps_beside_typed_floors_give_them_their_scatter_or_their_class(
    tmp_path: Path,
) -> None:
    """0.05 g and B/H 0.2 may rock where motions are drawn with 0.4, not where the typed one is met in every draw."""
    typed: Rows = [{"floor": "a", "elevation": 4, "pfa_x": 0.05, "pfv_x": 9}]
    item = [{"item": "A1", "floor": "a", "breadth": 40, "height": 200}]
    for at, (beside, said) in enumerate(
        (([], "no"), ([{"floor": "b", "record_x": "roof.csv"}], "yes"), ([{"record_x": "roof.csv"}], "no"))
    ):
        path = fill(tmp_path / f"{at}.xlsx", item, [*typed, *beside], {})
        assert by_formualizer(poison(path))[2][7] == said
    # PFV of a typed PFA goes by the ratio of the map, which the program alone can read.
    floors = [FLOORS[1], FLOORS[2] | {"pfa_x": 0.1}, FLOORS[3] | {"pfa_x": 0.1, "pfv_x": 20}]
    assert [one[1] for one in show(tmp_path, floors, **PLACED).values()] == ["run assess", "run assess", 0.1]
    floors[0] = floors[0] | {"pfa_y": 0.1, "pfv_y": 8}
    assert [one[1] for one in show(tmp_path, floors, **PLACED).values()] == [0.1, "run assess", 0.1]


PLACED = {"shakemap": "grid.xml", "latitude": 37.7893, "longitude": -122.4008}


# ---------------------------------------------------------------- what is wrong, and what nothing serves

WRONG: list[tuple[dict[str, Any], str]] = [
    ({"ground_pga": "0,2"}, "check"), ({"ground_pga": -0.2}, "check"), ({"ground_pga": 0}, "check"),
    ({"ground_pga": 20}, "check"), ({"ground_pga": 0.2, "ground_pgv": "fast"}, "check"),
    ({"ground_pga": 0.2, "ground_pgv": 0}, "check"), ({"ground_pgv": "30 cm/s"}, "check"), ({"sds": "1,1"}, "check"),
    ({"ground_pga": "much", "sds": 0.5}, "check"), ({"ground_pga": 0.2, "period": "short"}, "check"),
    ({"ground_pga": 0.2, "period": 0}, "check"), ({"ground_pga": 0.2, "height": "12 m"}, "check"),
    ({"ground_pga": 0.2, "height": 1}, "check"), ({"ground_pga": 0.2, "storeys": "three"}, "check"),
    ({"ground_pga": 0.2, "structure": "steel thing"}, "check"), ({"ground_pga": 0.2, "structure": "*"}, "check"),
    ({"shaking": "much"}, "run assess"), ({"shaking": "MMI*"}, "run assess"), ({"shaking": "much", "ground_pgv": 30},
     "run assess"),
]  # fmt: skip


WRONG_FOR_TYPED: list[tuple[dict[str, Any], str]] = [
    ({"ground_pga": 0.2, "ground_pgv": "fast"}, "check"), ({"ground_pga": "much", "ground_pgv": 30}, "check"),
    ({"period": "short"}, "check"), ({"height": 0}, "check"), ({"structure": "steel thing"}, "check"),
    ({"shaking": "much", "ground_pgv": 30}, "run assess"),
]  # fmt: skip


def test_what_is_wrong_shows_no_class(tmp_path: Path) -> None:
    """With PFA and PFV typed, nothing is needed of the building nor of the ground."""
    for building, word in WRONG:
        shown = show(tmp_path, [{"floor": "1", "elevation": 4}, {"floor": "2", "elevation": 8}], **building)
        assert [one[1:] for one in shown.values()] == [[word] * 7] * 2, building
    floors: Rows = [{"floor": "1", "elevation": 4, "pfa_x": 0.3}, {"floor": "2", "elevation": 8, "pfa_x": 0.3,
                    "pfv_x": 30}]  # fmt: skip
    for building, word in WRONG_FOR_TYPED:
        shown = show(tmp_path, floors, **building)
        assert shown["1"][1:] == [word] * 7, building
        assert shown["2"][1] == 0.3, building


@pytest.mark.parametrize("ground", [{"ground_pga": 0.2}, {"shaking": "MMI VI, strong"}])
@pytest.mark.parametrize("given", ["0,4", -0.1, 1.6])
def test_a_wrong_uncertainty_shows_no_word_of_rocking(tmp_path: Path, ground: dict[str, Any], given: Any) -> None:
    shown = show(tmp_path, FLOORS[:4], **ground, motion_uncertainty=given)
    assert [one[7] for one in shown.values()] == ["check"] * 4
    assert all(isinstance(one[1], float) for one in shown.values())


def test_a_wrong_elevation_own_motions_alone_and_a_shakemap_show_no_class(tmp_path: Path) -> None:
    for z in ("8 metres high", 5000):
        for at, own in enumerate(({}, {"pfa_x": 0.3})):
            shown = show(tmp_path / str(at), [{"floor": "1", "elevation": z, **own}], ground_pga=0.2, period=0.5)
            assert shown["1"][1:] == ["check"] * 7, z
    for kind in ("given", "recorded"):
        shown = show(tmp_path, FLOORS[:3], shaking="MMI VII, very strong", scenario_kind=kind)
        assert [one[1:] for one in shown.values()] == [["needs shaking"] * 7] * 3, kind
    for more in ({}, {"shaking": "MMI IV, light"}, {"ground_pgv": 20}):
        shown = show(tmp_path, FLOORS, **PLACED | more)
        assert [one[1:] for one in shown.values()] == [["run assess"] * 7] * len(FLOORS), more


UNREADABLE = [
    ("Building", "Ground PGA"), ("Building", "Ground PGV"), ("Building", "Height"), ("Building", "Period T1"),
    ("Floors", "Elevation"),
]  # fmt: skip


@pytest.mark.parametrize(("sheet", "label"), UNREADABLE)
def test_unreadable_units(tmp_path: Path, sheet: str, label: str) -> None:
    building = {"ground_pga": 0.2, "ground_pgv": 20, "height": 12, "period": 0.6}
    item = {"item": "A1", "floor": "1", "breadth": 40, "height": 180}
    path = fill(tmp_path / "book.xlsx", [item], [{"floor": "1", "elevation": 4}], building)
    book = openpyxl.load_workbook(path)
    (cell,) = [one for row in book[sheet].iter_rows() for one in row if str(one.value).split(" [")[0] == label]
    cell.value = f"{label} [knots]"
    book.save(path)
    assert by_formualizer(poison(path))[2][1:] == ["unit?"] * 7


# ---------------------------------------------------------------- whether a piece can rock


ROCKING: list[tuple[dict[str, Any], float]] = [
    ({"ground_pga": 0.05}, 19.47), ({"ground_pga": 0.05, "motion_uncertainty": 0.4}, 48.2),
    ({"ground_pgv": 5.25}, 48.2), ({"shaking": "MMI IV, light", "motion_uncertainty": 0.1}, 109.4),
]  # fmt: skip
"""What is known of the ground, and the breadth below which a piece of 180 cm can rock on it [cm]."""


@pytest.mark.parametrize(("building", "limit"), ROCKING)
def test_on_the_ground_rocking_goes_by_what_is_known(tmp_path: Path, building: dict[str, Any], limit: float) -> None:
    """PFA e^(3 s) = 0.65 g B/H there; s holds 0.1136 of the piece.

    A typed PGA is met in every draw; by PGV alone it has the scatter of PGV/PGA, 0.40; MMI IV has 0.88, which 0.1 does
    not add to: 0.0276 g x e^(3 x 0.8873) = 0.3952 g.
    """
    floors: Rows = [{"floor": "1", "elevation": 0}]
    items: Rows = [
        {"item": str(one), "floor": "1", "breadth": one, "height": 180} for one in (limit - 1, limit + 1)
    ]  # fmt: skip
    path = fill(tmp_path / "book.xlsx", items, floors, building)
    assert [by_formualizer(poison(path))[row][7] for row in (2, 3)] == ["yes", "no"]
    check(path)


# ---------------------------------------------------------------- the lists


def show_velocity(folder: Path, floors: Rows, **building: Any) -> dict[str, Any]:
    """Return the PFV [cm/s] that the sheet Lists finds on X of each floor."""
    show(folder, floors, **building)
    book = openpyxl.load_workbook(folder / "book.xlsx")
    places = {cell.value: cell.column for cell in book["Lists"][1]}
    evaluated, at = evaluate(folder / "book.xlsx"), places["floor_pfv_x"]
    return {one["floor"]: evaluated.get_value("Lists", row, at) for row, one in enumerate(floors, 2)}


def test_a_floor_shows_the_entry_of_the_table_and_at_or_below_grade_the_motion_of_the_ground(tmp_path: Path) -> None:
    """T1 of 1.0 s, 105 cm/s per g and these z/h are entries, between which nothing is interpolated."""
    for structure, place in (("frame", 0.6), ("walls", 1.0), ("dual", 0.15)):
        with TABLE.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        (row,) = [
            one for one in rows
            if one["structure"] == structure and one["T1 [s]"] == "1.0"
            and float(one["PGV/PGA [s]"]) * 980.665 == pytest.approx(105, abs=0.1)
        ]  # fmt: skip
        floors = [{"floor": "a", "elevation": 20 * place}, {"floor": "b", "elevation": 20}]
        building = {"ground_pga": 0.4, "ground_pgv": 42.0, "period": 1.0, "height": 20, "structure": structure}
        shown = show(tmp_path, floors, **building)
        assert shown["a"][1] == pytest.approx(0.4 * float(row[f"PFA/PGA at {place}"])), (structure, place)
        velocity = show_velocity(tmp_path, floors, **building)
        assert velocity["a"] == pytest.approx(42 * float(row[f"PFV/PGV at {place}"])), (structure, place)
    for z in (0, -3):
        floors = [{"floor": "a", "elevation": z}, {"floor": "b", "elevation": 12}]
        building = {"ground_pga": 0.2, "ground_pgv": 31.0, "period": 0.5}
        assert show(tmp_path, floors, **building)["a"][1] == pytest.approx(0.2), z
        assert show_velocity(tmp_path, floors, **building)["a"] == pytest.approx(31), z


def test_without_t1_it_comes_by_height_and_above_the_ground_the_peak_is_drawn_too(tmp_path: Path) -> None:
    """T1 = 1.4 x 0.0488 x 20^0.75 = 0.6461 s."""
    floors: Rows = [{"floor": "a", "elevation": 20}]
    typed, by_height = (show(tmp_path / str(at), floors, ground_pga=0.2, **one)["a"] for at, one in enumerate(
        ({"period": 1.4 * 0.0488 * 20**0.75}, {})
    ))  # fmt: skip
    assert by_height[:5] == pytest.approx(typed[:5])
    # Its scatter is 0.35 there: e^(3 x 0.368) = 3.02 in place of e^(3 x 0.1136) = 1.41.
    floors = [{"floor": "g", "elevation": 0}, {"floor": "1", "elevation": 6}]
    building = {"ground_pga": 0.05, "period": 0.5}
    pfa = show(tmp_path / "shown", floors, **building)["1"][1]
    limit = 180 * pfa * 3.0163 / 0.65
    items: Rows = [{"item": str(one), "floor": "1", "breadth": one, "height": 180} for one in (limit - 1, limit + 1)]
    path = fill(tmp_path / "book.xlsx", items, floors, building)
    assert [by_formualizer(poison(path))[row][7] for row in (2, 3)] == ["yes", "no"]


def test_a_typed_pfa_is_shown_as_typed_and_its_pfv_has_the_ratio_of_a_typed_ground(tmp_path: Path) -> None:
    """At grade PFV/PFA is that of the ground; a typed motion there comes before Ground PGA and Ground PGV."""
    floors: Rows = [{"floor": "g", "elevation": 0, "pfa_x": 0.2, "pfv_x": 30}, {"floor": "b", "elevation": -3,
                    "pfa_x": 0.1}]  # fmt: skip
    assert show_velocity(tmp_path, floors, ground_pga=0.2, ground_pgv=99)["b"] == pytest.approx(15)
    assert show_velocity(tmp_path, floors[1:], ground_pga=0.2, ground_pgv=99)["b"] == pytest.approx(10.5), "no PFV"
    assert show_velocity(tmp_path, [{"floor": "b", "pfa_x": 0.1, "elevation": 8}, *floors[:1]])["b"] > 0
    floors = [{"floor": "a", "elevation": 6, "pfa_x": 0.35}]
    for at, building in enumerate(AROUND):
        assert show(tmp_path / str(at), floors, **building)["a"][1] == 0.35


@pytest.mark.parametrize("ground", [{"ground_pga": 0.2}, {"sds": 0.5}])
def test_where_the_ground_is_typed_the_map_changes_nothing(tmp_path: Path, ground: dict[str, Any]) -> None:
    with_map, without = (show(tmp_path / str(at), FLOORS, **one) for at, one in enumerate((PLACED | ground, ground)))
    assert with_map == without
    assert all(isinstance(one[1], float) for one in without.values())
