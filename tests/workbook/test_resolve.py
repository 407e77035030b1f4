"""What a sound workbook is read as: defaults, the catalogue, the building, names that fit together."""

import dataclasses
from pathlib import Path

import pytest

from assess.model import axis_of
from assess.units import GRAVITY
from assess.workbook.read import read_inventory
from assess.workbook.schema import BUILDING, SHEETS
from tests.workbook.books import (
    ITEMS,
    Sheet,
    errors_of,
    read,
    read_item,
    remarks,
    write,
)

TYPES: Sheet = [["Type", "Breadth [in]", "Width [in]", "Height [in]", "Source"], ["Locker", 12, 24, 72, "catalogue"]]


def test_blank_sizes_come_from_the_catalogue(tmp_path: Path) -> None:
    found = read_item(tmp_path, ["Type", "Breadth [cm]", "Height [cm]"], ["locker", None, 200], Catalogue=TYPES)
    assert (found.type, found.breadth, found.width, found.height) == (
        "Locker", 12 * 0.0254, 24 * 0.0254, 2.0,
    )  # fmt: skip
    assert found.assumed == ("breadth", "width", "quantity", "anchored")


def test_no_assumption_where_all_is_given(tmp_path: Path) -> None:
    header = ["Type", "Breadth [cm]", "Width [cm]", "Height [cm]", "Quantity", "Anchored", "Friction", "Axis"]
    found = read_item(tmp_path, header, ["Locker", 40, 60, 200, 2, "no", 0.4, "X"], Catalogue=TYPES)
    assert (found.assumed, found.friction, found.quantity) == ((), 0.4, 2)


def test_a_type_without_that_size(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item", "Floor", "Type"], ["A1", "1", "Shelf"]],
                 Catalogue=[["Type", "Breadth [cm]"], ["Shelf", 30]])  # fmt: skip
    assert errors_of(path) == {
        "Items!A1: the column Height [cm] is missing, and row 2 has no Type that gives it. Add the column, or give those rows such a Type."
    }


def test_breadth_is_the_shorter_side_with_the_catalogue_too(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item", "Floor", "Type", "Breadth [cm]"], ["A1", "1", "Locker", 70]],
                 Catalogue=[*TYPES, ["Bench", 30, 20, 40, ""]])  # fmt: skip
    assert errors_of(path) == {
        "Items!D2: Breadth 70 cm is greater than Width 60.96 cm. Breadth is the shorter plan side: exchange the two.",
        "Catalogue!B3: Breadth 76.2 cm is greater than Width 50.8 cm. "
        "Breadth is the shorter plan side: exchange the two.",
    }


def test_breadth_equal_to_width_in_other_units(tmp_path: Path) -> None:
    assert read_item(tmp_path, ["Breadth [in]", "Width [cm]", "Height [cm]"], [40 / 2.54, 40, 180]).width == 0.4


def test_breadth_greater_than_height_is_warned_of(tmp_path: Path) -> None:
    inventory = read(tmp_path, [ITEMS[0], ["A1", "1", 180, 75]])
    assert remarks(inventory, "warning") == {
        "Items!C2: Breadth 180 cm is greater than Height 75 cm. Are the two exchanged?"
    }


@pytest.mark.parametrize(
    ("sizes", "severity"),
    [((180, 40), "error"), ((150, 60), "error"), ((70, 60), None), ((600, 30), None), ((40, 180), None)],
)
def test_sizes_are_exchanged_where_those_of_the_type_say_so(
    tmp_path: Path, sizes: tuple[int, int], severity: str | None
) -> None:
    items: Sheet = [["Item", "Floor", "Type", "Breadth [cm]", "Height [cm]"], ["A1", "1", "Rack", *sizes]]
    types: Sheet = [["Type", "Breadth [cm]", "Height [cm]"], ["Rack", 45, 200]]
    path = write(tmp_path, items, Catalogue=types)
    message = f"Breadth {sizes[0]} cm is greater than Height {sizes[1]} cm. "
    if severity == "error":
        assert errors_of(path) == {f"Items!D2: {message}Its Type is 45 cm deep and 200 cm high: exchange the two."}
    else:
        assert not any("Height" in str(one) for one in read_inventory(path).problems)


def test_the_centre_of_gravity_is_the_rows_own_else_the_types_else_at_mid_height(tmp_path: Path) -> None:
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


def test_an_impossible_centre_of_gravity_of_a_type_is_named(tmp_path: Path) -> None:
    types: Sheet = [["Type", "Height [cm]", "Centre of gravity [%]"], ["Rack", 200, 0.6], ["Lamp", 160, 99]]
    assert errors_of(write(tmp_path, Catalogue=types)) == {
        "Catalogue!C2: Centre of gravity is 0.6 %, expected 5 to 95 %. Write 60 for 60 %.",
        "Catalogue!C3: Centre of gravity is 99 %, expected 5 to 95 %. Check the number and the unit in the header.",
    }


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("Centre of gravity", "Centre of gravity has no unit. Write the unit that the numbers are in"),
        ("Centre of gravity [cm]", "the unit 'cm' of Centre of gravity is not known. Write the unit that the numbers"),
        ("Centre of gravity %", "the column 'Centre of gravity %' is not known. Did you mean Centre of gravity [%]?"),
        (
            "Center of gravity [%]",
            "the column 'Center of gravity [%]' is not known. Did you mean Centre of gravity [%]?",
        ),
    ],
)
def test_a_centre_of_gravity_needs_its_unit(tmp_path: Path, header: str, message: str) -> None:
    (error,) = errors_of(write(tmp_path, [[*ITEMS[0], header], [*ITEMS[1], 45]]))
    assert error.startswith(f"Items!E1: {message}")


ANGLES = [
    (0, "X"), (15, "X"), (15.001, None), (-15, "X"), (45, None), (74.999, None), (75, "Y"), (90, "Y"), (105, "Y"),
    (106, None), (164, None), (165, "X"), (180, "X"), (-90, "Y"), (270, "Y"), (360, "X"), (-345, "X"), (-344, None),
]  # fmt: skip


@pytest.mark.parametrize(("angle", "axis"), ANGLES)
def test_axis_from_the_angle(tmp_path: Path, angle: float, axis: str | None) -> None:
    found = read_item(tmp_path, ["Breadth [cm]", "Height [cm]", "Angle [deg]"], [40, 180, angle])
    assert found.axis == axis_of(angle) == axis
    assert ("axis" in found.assumed) == (axis is not None)


def test_a_given_axis_comes_before_the_angle(tmp_path: Path) -> None:
    found = read_item(tmp_path, ["Breadth [cm]", "Height [cm]", "Angle [deg]", "Axis"], [40, 180, 90, "X"])
    assert (found.axis, "axis" in found.assumed) == ("X", False)


def test_friction_of_the_building(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Friction"], [*ITEMS[1], None], ["A2", "1", 40, 180, 0.7]]
    inventory = read(tmp_path, items, Building=[["Default friction", 0.3]])
    one, other = inventory.items
    assert (inventory.friction_of(one), "friction" in inventory.assumed_of(one)) == (0.3, True)
    assert (inventory.friction_of(other), "friction" in inventory.assumed_of(other)) == (0.7, False)


def test_a_changed_default_friction_counts(tmp_path: Path) -> None:
    inventory = read(tmp_path)
    changed = dataclasses.replace(inventory, building=dataclasses.replace(inventory.building, friction=0.3))
    assert [one.friction_of(one.items[0]) for one in (inventory, changed)] == [None, 0.3]
    assert changed.complete(changed.items[0]).friction == 0.3
    assert changed.frame()["friction"].tolist() == [0.3]
    assert changed.assumed_of(changed.items[0]) == ("friction", "quantity", "anchored")


def test_no_friction(tmp_path: Path) -> None:
    assert read(tmp_path).items[0].friction is None


def test_one_row_a_piece_on_the_plan(tmp_path: Path) -> None:
    path = write(
        tmp_path, [[*ITEMS[0], "Quantity", "X [m]", "Y [m]"], [*ITEMS[1], 2, 1, 3], ["A2", "1", 40, 180, 1, 1, 3]]
    )
    assert errors_of(path) == {
        "Items!E2: Quantity is 2 on a row with a position. Write one row a piece, or clear X and Y."
    }


@pytest.mark.parametrize(("x", "y", "cell"), [(1, None, "F2"), (None, 2, "E2")])
def test_half_a_position(tmp_path: Path, x: float | None, y: float | None, cell: str) -> None:
    inventory = read(tmp_path, [[*ITEMS[0], "X [m]", "Y [m]", "Width [cm]"], [*ITEMS[1], x, y, 90]])
    message = "a position needs both X and Y. Fill in the other, or clear both."
    assert remarks(inventory, "warning") == {f"Items!{cell}: {message}"}


def test_building(tmp_path: Path) -> None:
    rows: Sheet = [["Building", "Town hall"], ["Storeys", 4], ["Height [ft]", 50], ["Period T1 [s]", 0.9],
            ["Azimuth of X [deg]", 30], ["Scenario kind", "Given"], ["Ground PGA [m/s2]", 3], ["SDS [g]", 1],
            ["Restitution", 0.9], ["Architect", "N. N."], ["Report language", None], [None, "stray"]]  # fmt: skip
    inventory = read(tmp_path, Building=rows)
    found = inventory.building
    assert (found.building, found.storeys, found.period, found.azimuth_deg) == ("Town hall", 4, 0.9, 30)
    assert (found.height, found.ground_pga, found.sds) == pytest.approx((15.24, 3, GRAVITY))
    assert (found.scenario_kind, found.restitution, found.language, found.logo) == ("given", 0.9, "", None)
    assert (found.cell("ground_pga"), found.cell("sds"), found.cell("friction")) == ("B7", "B8", "")
    assert remarks(inventory, "note") == {
        "Building!A10: 'Architect' is not known; it is not used.",
    }


def test_the_uncertainties_and_the_velocity_of_the_ground(tmp_path: Path) -> None:
    rows: Sheet = [["Ground PGV [in/s]", 10], ["Motion uncertainty", 0.6], ["Piece uncertainty", "No"]]
    found = read(tmp_path, Building=rows).building
    assert (found.motion_uncertainty, found.piece_uncertainty) == (0.6, False)
    assert found.ground_pgv == pytest.approx(0.254)
    assert (found.cell("ground_pgv"), found.cell("motion_uncertainty")) == ("B1", "B2")


def test_blank_uncertainties_are_left_to_the_defaults(tmp_path: Path) -> None:
    rows: Sheet = [["Ground PGV [cm/s]", None], ["Motion uncertainty", None], ["Piece uncertainty", None]]
    for found in (read(tmp_path).building, read(tmp_path, Building=rows).building):
        assert (found.ground_pgv, found.motion_uncertainty, found.piece_uncertainty) == (None, None, None)


@pytest.mark.parametrize(
    ("value", "is_uncertain"),
    [("yes", True), (" YES ", True), (True, True), ("sì", True), ("no", False), (False, False)],
)
def test_yes_and_no(tmp_path: Path, value: object, is_uncertain: bool) -> None:
    assert read(tmp_path, Building=[["Piece uncertainty", value]]).building.piece_uncertainty is is_uncertain


@pytest.mark.parametrize(
    ("label", "value", "message"),
    [
        ("Motion uncertainty", -0.1, "Motion uncertainty is -0.1, expected 0 to 1.5. Remove the minus sign."),
        ("Motion uncertainty", 1.6, "Motion uncertainty is 1.6, expected 0 to 1.5. Check the number and the unit in "),
        ("Motion uncertainty", 40, "Motion uncertainty is 40, expected 0 to 1.5. Did you mean 0.4?"),
        ("Piece uncertainty", 1, "Piece uncertainty is '1', expected one of: yes, no. Choose from the list."),
        ("Piece uncertainty", "partly", "Piece uncertainty is 'partly', expected one of: yes, no. Choose from the"),
        (
            "Ground PGV [cm/s]",
            0,
            "Ground PGV is 0 cm/s, expected 0.01 to 1000 cm/s. Clear the cell if it is not known.",
        ),
        ("Ground PGV [m/s]", 25, "Ground PGV is 25 m/s, expected 0.0001 to 10 m/s. Did you mean 25 cm/s = 0.25 m/s?"),
    ],
)
def test_uncertainties_that_are_wrong(tmp_path: Path, label: str, value: object, message: str) -> None:
    (error,) = errors_of(write(tmp_path, Building=[["Use", "Office"], [label, value]]))
    assert error.startswith(f"Building!B2: {message}")


def test_uncertainties_stand_at_their_limits(tmp_path: Path) -> None:
    for value in (0, 1.5):
        assert read(tmp_path, Building=[["Motion uncertainty", value]]).building.motion_uncertainty == value


def test_the_building_may_be_missing(tmp_path: Path) -> None:
    assert read(tmp_path).building.building == ""


PLACES: Sheet = [["Place", "Floor", "X [m]", "Kind"], ["Hall", 1, 2, "Room"], ["Exit", "1", None, None]]
ROUTES: Sheet = [["Route", "Segment", "Floor", "From", "To", "Clear width [cm]", "Occupants"],
                 ["R1", "a", "1", "Hall", "Exit", 120, 40], ["R1", "b", None, None, None, None, None]]  # fmt: skip


def test_places_and_routes(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Route", "Segment"], [*ITEMS[1], "r1", "A"]]
    inventory = read(tmp_path, items, Places=PLACES, Routes=ROUTES)
    assert [(one.place, one.floor, one.x, one.kind) for one in inventory.places] == [
        ("Hall", "1", 2, "room"), ("Exit", "1", None, ""),
    ]  # fmt: skip
    assert [(one.route, one.segment, one.clear_width, one.occupants) for one in inventory.routes] == [
        ("R1", "a", 1.2, 40), ("R1", "b", None, None),
    ]  # fmt: skip
    assert inventory.items[0].route == "R1"
    assert inventory.items[0].segment == "a", "spelt as in Routes"
    assert remarks(inventory, "note") == set()


def test_names_of_places_and_routes_that_do_not_fit(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Route", "Segment"], [*ITEMS[1], "R2", None], ["A2", "1", 40, 180, "R1", "c"],
             ["A3", "1", 40, 180, None, "a"]]  # fmt: skip
    path = write(tmp_path, items, Places=[*PLACES, ["hall", "9", None, None]], Routes=[*ROUTES, ["R3", "a", "8"]])
    listed = "Choose one of the {0} sheet, or add it there."
    assert errors_of(path) == {
        f"Items!E2: Route 'R2' is not in the Routes sheet. {listed.format('Routes')}",
        "Items!F3: Route 'R1' has no segment 'c'. Add it to Routes, or clear the cell.",
        "Items!F4: a Segment is named without its Route. Fill in Route.",
        "Places!A4: duplicate Place 'hall', also in A2. Give each its own name.",
        f"Places!B4: Floor '9' is not in the Floors sheet. {listed.format('Floors')}",
        f"Routes!C4: Floor '8' is not in the Floors sheet. {listed.format('Floors')}",
    }


def test_every_field_of_the_model_has_a_column() -> None:
    from dataclasses import fields

    from assess import model

    kinds = {"Building": model.Building, "Items": model.Item, "Places": model.Place, "Routes": model.Segment,
             "Catalogue": model.CatalogueType, "Costs": model.Cost}  # fmt: skip
    for sheet in SHEETS:
        if sheet.name != "Floors":
            own = {one.name for one in fields(kinds[sheet.name])} - {"row", "assumed", "extra", "more", "cells"}
            assert {column.name for column in sheet.columns} - {"photo", "source_id"} == own


def test_labels_are_told_apart() -> None:
    for sheet in SHEETS:
        labels = [column.label.replace(" ", "").casefold() for column in sheet.columns]
        assert len(set(labels)) == len(labels)
    assert BUILDING.column("period").header("imperial") == "Period T1 [s]"
