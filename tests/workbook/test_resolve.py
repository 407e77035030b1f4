"""What a sound workbook is read as: defaults, the catalogue, the building, names that fit together."""

import dataclasses
from pathlib import Path

import pytest

from assess.model import axis_of
from assess.units import GRAVITY
from tests.workbook.books import ITEMS, Sheet, errors_of, read, read_item, remarks, write

TYPES: Sheet = [["Type", "Breadth [in]", "Width [in]", "Height [in]", "Source"], ["Locker", 12, 24, 72, "catalogue"]]


def test_sizes_are_exchanged_or_missing_where_those_of_the_type_say_so(
    tmp_path: Path,
) -> None:
    path = write(tmp_path, [["Item", "Floor", "Type", "Breadth [cm]"], ["A1", "1", "Locker", 70]],
                 Catalogue=[*TYPES, ["Bench", 30, 20, 40, ""]])  # fmt: skip
    assert errors_of(path) == {
        "Items!D2: Breadth 70 cm is greater than Width 60.96 cm. Breadth is the shorter plan side: exchange the two.",
        "Catalogue!B3: Breadth 76.2 cm is greater than Width 50.8 cm. "
        "Breadth is the shorter plan side: exchange the two.",
    }
    pairs = [(180, 40), (150, 60), (70, 60), (600, 30), (40, 180), (60.96, 200, 24)]
    header = ["Item", "Floor", "Type", "Breadth [cm]", "Height [cm]", "Width [in]"]
    items: Sheet = [header, *([f"A{at}", "1", "Rack", *pair] for at, pair in enumerate(pairs))]
    types: Sheet = [["Type", "Breadth [cm]", "Height [cm]"], ["Rack", 45, 200]]
    mend = "Its Type is 45 cm deep and 200 cm high: exchange the two."
    assert errors_of(write(tmp_path, items, Catalogue=types)) == {
        f"Items!D2: Breadth 180 cm is greater than Height 40 cm. {mend}",
        f"Items!D3: Breadth 150 cm is greater than Height 60 cm. {mend}",
    }
    assert remarks(read(tmp_path, [ITEMS[0], ["A1", "1", 180, 75]]), "warning") == {
        "Items!C2: Breadth 180 cm is greater than Height 75 cm. Are the two exchanged?"
    }
    path = write(tmp_path, [["Item", "Floor", "Type"], ["A1", "1", "Shelf"]],
                 Catalogue=[["Type", "Breadth [cm]"], ["Shelf", 30]])  # fmt: skip
    assert errors_of(path) == {
        "Items!A1: the column Height [cm] is missing, and row 2 has no Type that gives it. Add the column, or give those rows such a Type."
    }


def test_the_centre_of_gravity_is_the_rows_own_else_the_types_and_the_axis_that_of_the_angle(tmp_path: Path) -> None:
    angles = [
        (0, "X"), (15, "X"), (15.001, None), (-15, "X"), (45, None), (74.999, None), (75, "Y"), (90, "Y"), (105, "Y"),
        (106, None), (164, None), (165, "X"), (180, "X"), (-90, "Y"), (270, "Y"), (360, "X"), (-345, "X"), (-344, None),
    ]  # fmt: skip
    header = ["Item", "Floor", "Type", "Centre of gravity [%]"]
    types: Sheet = [["Type", "Breadth [cm]", "Height [cm]", "Centre of gravity [%]"], ["Rack", 60, 200, 60],
                    ["Desk", 70, 75, None]]  # fmt: skip
    rows: Sheet = [header, ["A1", "1", "Rack", 45], ["A2", "1", "rack", None], ["A3", "1", "Desk", None]]
    inventory = read(tmp_path, rows, Catalogue=types)
    assert [one.centre_of_gravity for one in inventory.items] == pytest.approx([0.45, 0.6, 0.5], abs=1e-15)
    assert ["centre_of_gravity" in one.assumed for one in inventory.items] == [False, True, False]
    assert inventory.items[1].assumed == ("breadth", "height", "centre_of_gravity", "quantity", "anchored")
    assert [one.centre_of_gravity for one in inventory.catalogue] == [0.6, None]
    assert inventory.frame()["centre_of_gravity"].tolist() == pytest.approx([0.45, 0.6, 0.5], abs=1e-15)
    assert all(one.more == {} for one in inventory.items)
    header = ["Item", "Floor", "Breadth [cm]", "Height [cm]", "Angle [deg]", "Axis"]
    rows = [[f"A{at}", "1", 40, 180, angle, None] for at, (angle, _) in enumerate(angles)]
    *found, last = read(tmp_path, [header, *rows, ["B", "1", 40, 180, 90, "X"]]).items
    assert [one.axis for one in found] == [axis for _, axis in angles] == [axis_of(angle) for angle, _ in angles]
    assert ["axis" in one.assumed for one in found] == [axis is not None for _, axis in angles]
    assert (last.axis, "axis" in last.assumed) == ("X", False)


def test_friction_of_the_building_half_a_position_and_cells_that_contradict_each_other(tmp_path: Path) -> None:
    inventory = read(tmp_path, [[*ITEMS[0], "Friction"], [*ITEMS[1], None], ["A2", "1", 40, 180, 0.7]])
    assert inventory.items[0].friction is None
    changed = dataclasses.replace(inventory, building=dataclasses.replace(inventory.building, friction=0.3))
    assert [[one.friction_of(item) for item in one.items] for one in (inventory, changed)] == [[None, 0.7], [0.3, 0.7]]
    assert changed.complete(changed.items[0]).friction == 0.3
    assert changed.frame()["friction"].tolist() == [0.3, 0.7]
    assert [changed.assumed_of(one) for one in changed.items] == [
        ("friction", "quantity", "anchored"), ("quantity", "anchored"),
    ]  # fmt: skip
    read_now = read(tmp_path, Building=[["Default friction", 0.3]])
    assert read_now.friction_of(read_now.items[0]) == 0.3
    header = [*ITEMS[0], "X [m]", "Y [m]", "Width [cm]"]
    inventory = read(tmp_path, [header, [*ITEMS[1], 1, None, 90], ["A2", "1", 40, 180, None, 2, 90]])
    message = "a position needs both X and Y. Fill in the other, or clear both."
    assert remarks(inventory, "warning") == {f"Items!F2: {message}", f"Items!E3: {message}"}
    header = [*ITEMS[0], "Axis", "Angle [deg]", "Anchored", "Bracket capacity [kN]"]
    rows: Sheet = [[*ITEMS[1], "X", 90], ["A2", "1", 40, 180, None, None, "no", 1]]
    messages = sorted(remarks(read(tmp_path, [header, *rows]), "warning"))
    assert messages[0] == (
        "Items!E2: Axis is X, but an Angle of 90 deg lies along Y; X is used. Correct one of the two."
    )
    assert [one.startswith("Items!H3: Bracket capacity is given, but Anchored is no.") for one in messages[1:]] == [
        True
    ]


def test_building_its_uncertainties_and_the_velocity_of_the_ground(tmp_path: Path) -> None:
    rows: Sheet = [["Building", "Town hall"], ["Storeys", 4], ["Height [ft]", 50], ["Period T1 [s]", 0.9],
            ["Azimuth of X [deg]", 30], ["Scenario kind", "Given"], ["Ground PGA [m/s2]", 3], ["SDS [g]", 1],
            ["Restitution", 0.9], ["Architect", "N. N."], ["Report language", None], [None, "stray"]]  # fmt: skip
    inventory = read(tmp_path, Building=rows)
    found = inventory.building
    assert (found.building, found.storeys, found.period, found.azimuth_deg) == ("Town hall", 4, 0.9, 30)
    assert (found.height, found.ground_pga, found.sds) == pytest.approx((15.24, 3, GRAVITY))
    assert (found.scenario_kind, found.restitution, found.language, found.logo) == ("given", 0.9, "", None)
    assert (found.cell("ground_pga"), found.cell("sds"), found.cell("friction")) == ("B7", "B8", "")
    assert remarks(inventory, "note") == {"Building!A10: 'Architect' is not known; it is not used."}
    for motion, piece, is_uncertain in (
        (0, "no", False), (1.5, " YES ", True), (0.6, True, True), (0.6, "sì", True), (0.6, False, False),
    ):  # fmt: skip
        rows = [["Ground PGV [in/s]", 10], ["Motion uncertainty", motion], ["Piece uncertainty", piece]]
        found = read(tmp_path, Building=rows).building
        assert (found.motion_uncertainty, found.piece_uncertainty) == (motion, is_uncertain)
        assert found.ground_pgv == pytest.approx(0.254)
        assert (found.cell("ground_pgv"), found.cell("motion_uncertainty")) == ("B1", "B2")
    rows = [["Ground PGV [cm/s]", None], ["Motion uncertainty", None], ["Piece uncertainty", None]]
    for found in (read(tmp_path).building, read(tmp_path, Building=rows).building):
        assert (found.ground_pgv, found.motion_uncertainty, found.piece_uncertainty) == (None, None, None)


def test_weights_and_brackets_are_read_in_any_unit_and_nothing_is_assumed_where_all_is_given(tmp_path: Path) -> None:
    sizes = ["Breadth [cm]", "Height [cm]", "Anchored"]
    for units, cells, expected in (
        (("kg", "cm", "kN"), [120, 170, 1.5], (120, 1.7, 1500)),
        (("lb", "in", "lbf"), [100, 60, 250], (45.359237, 1.524, 1112.0554)),
    ):
        labels = zip(("Weight", "Bracket height", "Bracket capacity"), units, strict=True)
        header = [*sizes, *(f"{label} [{unit}]" for label, unit in labels)]
        found = read_item(tmp_path, header, [40, 180, "yes", *cells])
        assert (found.weight, found.bracket_height, found.bracket_capacity) == pytest.approx(expected, rel=1e-6)
    header = ["Type", "Breadth [cm]", "Width [cm]", "Height [cm]", "Quantity", "Anchored", "Friction", "Axis"]
    found = read_item(tmp_path, header, ["Locker", 40, 60, 200, 2, "no", 0.4, "X"], Catalogue=TYPES)
    assert (found.assumed, found.friction, found.quantity) == ((), 0.4, 2)
    known = "the column '{}' is not known. Did you mean Centre of gravity [%]?"
    for label, message in {
        "Centre of gravity": "Centre of gravity has no unit. Write the unit that the numbers are in",
        "Centre of gravity [cm]": "the unit 'cm' of Centre of gravity is not known. Write the unit that the numbers",
        "Centre of gravity %": known,
        "Center of gravity [%]": known,
    }.items():
        (error,) = errors_of(write(tmp_path, [[*ITEMS[0], label], [*ITEMS[1], 45]]))
        assert error.startswith(f"Items!E1: {message.format(label)}")
