"""Plans of floors and photos of pieces: their columns, files and places."""

from pathlib import Path
from typing import Any

import pytest

import assess
from assess.model import FloorPlan, Inventory
from assess.plans import Drawing, read_plan
from assess.plans.linework import unpack
from assess.workbook import kept_files, picture_files
from assess.workbook.read import read_inventory
from assess.workbook.template import Units
from tests.pictures import picture
from tests.plans.drawings import PLAN_SVG, dxf
from tests.workbook.books import errors_of, remarks
from tests.workbooks import address, write

PLACED = {"plan_left": 1.0, "plan_bottom": 2.0, "plan_width": 16.0}
PIECE = {"item": "A1", "floor": "1", "breadth": 30, "width": 80, "height": 200}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {"p.png": picture("PNG", size=(1600, 1200)), "p.jpg": picture("JPEG", size=(1600, 1200)), "p.svg": PLAN_SVG}
    for name, data in (files | {"p.dxf": dxf(), "unitless.dxf": dxf(0), "text.png": b"no picture"}).items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


def _write(folder: Path, floor: dict[str, Any], *items: dict[str, Any], units: Units = "si") -> Path:
    return write(folder / "w.xlsx", [PIECE, *items], [{"floor": "1", "pfa_x": 0.3, **floor}], units)


def _read(folder: Path, floor: dict[str, Any], *items: dict[str, Any], units: Units = "si") -> Inventory:
    return read_inventory(_write(folder, floor, *items, units=units))


def _cell(field: str) -> str:
    return "Floors!" + address(field, 2, "Floors")


def _plan(inventory: Inventory) -> FloorPlan:
    plan = inventory.floors[0].plan
    assert plan is not None
    return plan


def test_every_format_is_placed_by_its_numbers_and_a_dxf_file_by_its_units(folder: Path) -> None:
    for name in ("p.png", "p.jpg", "p.svg", "p.dxf", "unitless.dxf"):
        inventory = _read(folder, {"plan": name, **PLACED, "plan_turn": 90})
        plan, is_lines = _plan(inventory), name[-3:] in ("svg", "dxf")
        assert (plan.path, plan.is_lines) == (folder / name, is_lines)
        assert (plan.left, plan.bottom, plan.width, plan.turn_deg) == (1.0, 2.0, 16.0, 90.0)
        assert plan.height == pytest.approx(12.0, rel=1e-3)
        assert plan.holds((0.5, 2.5))
        assert not plan.holds((1.5, 2.5))  # it lies to the left of its lower left corner once turned
        assert unpack(plan.content) if is_lines else plan.content.startswith(b"\xff\xd8\xff")
        assert remarks(inventory, "warning") == set()
    plan = _plan(_read(folder, {"plan": "p.png", **PLACED}, units="imperial"))
    assert (plan.left, plan.width) == pytest.approx((0.3048, 16 * 0.3048))
    corner = {"plan_left": 0.0, "plan_bottom": 0.0}
    assert _plan(_read(folder, {"plan": "p.dxf", **corner})).width == 16.0
    assert _plan(_read(folder, {"plan": "p.dxf", **corner, "plan_width": 8.0})).width == 8.0
    unknown = _read(folder, {"plan": "unitless.dxf", **corner})
    assert unknown.floors[0].plan is None
    assert any("the plan is not drawn: Plan width is blank." in one for one in remarks(unknown, "warning"))


def test_a_plan_without_its_numbers_is_not_drawn_and_what_is_left_out_is_noted(folder: Path) -> None:
    inventory = _read(folder, {"plan": "p.png", "plan_left": 0.0})
    assert inventory.floors[0].plan is None
    assert remarks(inventory, "warning") == {
        f"{_cell('plan')}: the plan is not drawn: Plan bottom Y, Plan width are blank. Fill in X and Y of its lower left "
        "corner, and its width in the building."
    }
    assert remarks(_read(folder, PLACED), "warning") == {
        f"{_cell('plan_left')}: Plan left X is filled in without Plan. Name the file of the plan, or clear it."
    }
    (folder / "x.dxf").write_bytes(dxf(xref=True))
    inventory = _read(folder, {"plan": "x.dxf", **PLACED})
    assert f"{_cell('plan')}: of the plan the lines alone are drawn; left out: 1 TEXT, 1 XREF OTHER." in remarks(
        inventory, "note"
    )


def test_errors_by_cell_and_pieces_that_are_read_without_pictures_that_are_wrong(folder: Path) -> None:
    (folder / "logo.svg").write_bytes(b"<svg onload='x'/>")
    (folder / "large.png").write_bytes(picture("PNG") + bytes(10 * 2**20))
    useless = "the picture '{}' cannot be used: "
    for floor, message in (
        ({"plan": "text.png"}, useless + "it is no PNG, JPEG, SVG or DXF file."),
        ({"plan": "logo.svg"}, useless + "it holds no lines that can be drawn."),
        ({"plan": "large.png"}, useless + "it is larger than 10 MB."),
        ({"plan": "../p.png"}, "the file '{}' is outside the workbook's folder."),
        ({"plan": "p.png", "plan_width": 0}, "Plan width is {} m, expected 0.5 to 5000 m"),
        ({"plan": "p.png", "plan_turn": 999}, "Plan turn is {} deg, expected -360 to 360 deg"),
    ):
        (error,) = errors_of(_write(folder, {**PLACED, **floor}))
        (*_, cell), (*_, value) = floor, floor.values()
        assert error.startswith(f"{_cell(cell)}: {message.format(value)}")
    path = _write(folder, {"plan": "gone.png"}, PIECE | {"item": "A2", "photo": "gone.jpg"})
    inventory = read_inventory(path, strict=False)
    assert [item.item for item in inventory.items] == ["A1", "A2"]
    assert inventory.floors[0].plan is None
    assert inventory.photos == {}
    assert len(inventory.errors) == 1
    both = _write(folder, {}, PIECE | {"item": "A2", "photo": "gone.jpg", "height": "tall"})
    assert [item.item for item in read_inventory(both, strict=False).items] == ["A1"]


def test_pieces_outside_the_plan_and_a_plan_in_another_unit(folder: Path) -> None:
    items = [{**PIECE, "item": f"B{n}", "x": x, "y": 5.0} for n, x in enumerate((0.9, 1.1, 17.1, 40.0, -3.0, 16.9))]
    (warning,) = remarks(_read(folder, {"plan": "p.png", **PLACED}, *items), "warning")
    assert warning.startswith(f"{_cell('plan')}: 4 pieces of 6 lie outside the plan: 'B0', 'B2', 'B3', ....")
    items = [{**PIECE, "item": f"B{n}", "x": 2.0 + 3 * n, "y": 5.0} for n in range(2)]
    plan = {"plan": "p.png", **PLACED, "plan_width": 160.0}
    (warning,) = remarks(_read(folder, plan, *items), "warning")
    assert f"{_cell('plan_width')}: the plan is 160 x 120 m, while the pieces on it lie within 3 m." in warning
    assert remarks(_read(folder, {**plan, "plan_width": 30.0}, *items), "warning") == set()


def _write_floors(folder: Path, plans: list[str]) -> Path:
    floors = [
        {"floor": str(n), "pfa_x": 0.3, "plan": plan, **PLACED, "plan_width": 10.0 + n}
        for n, plan in enumerate(plans, start=1)
    ]
    return write(folder / "w.xlsx", [PIECE], floors)


def test_a_drawing_is_read_once_and_a_picture_for_each_width(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[float | None] = []

    def count(data: bytes, width: float | None) -> Drawing:
        done.append(width)
        return read_plan(data, width)

    monkeypatch.setattr(picture_files, "read_plan", count)
    floors = read_inventory(_write_floors(folder, ["p.svg"] * 4 + ["p.png"] * 2)).floors
    assert [floor.plan.width for floor in floors if floor.plan] == [11, 12, 13, 14, 15, 16]
    assert done == [11, 15, 16]
    done.clear()
    assert len(errors_of(_write_floors(folder, ["text.png"] * 3))) == 3, "an error at every cell, of one reading"
    assert done == [11]


@pytest.mark.parametrize(("name", "most"), [("MOST_DRAWINGS", 1), ("MOST_DRAWING_BYTES", len(PLAN_SVG) + 9)])
def test_too_many_drawings(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, most: int) -> None:
    monkeypatch.setattr(kept_files, name, most)
    (folder / "q.svg").write_bytes(PLAN_SVG)
    (error,) = errors_of(_write_floors(folder, ["p.svg", "p.svg", "p.png", "q.svg"]))
    assert error.startswith(f"Floors!{address('plan', 5, 'Floors')}: this workbook names more than ")
    assert error.endswith(" MB. Save the walls and doors alone, or name fewer.")


def test_photos_are_read_once_and_kept_small_and_what_is_no_picture_is_left_out(folder: Path) -> None:
    items = [
        {**PIECE, "item": name, "photo": photo} for name, photo in (("B", "p.jpg"), ("C", "p.jpg"), ("D", "p.png"))
    ]
    inventory = _read(folder, {}, *items)
    assert [item.more.get("photo") for item in inventory.items] == [None, "p.jpg", "p.jpg", "p.png"]
    assert set(inventory.photos) == {"p.jpg", "p.png"}
    assert all(photo.startswith(b"\xff\xd8\xff") and len(photo) < 40_000 for photo in inventory.photos.values())
    path = _write(folder, {}, {**PIECE, "item": "B", "photo": "text.png"}, {**PIECE, "item": "C", "photo": "p.svg"})
    inventory = read_inventory(path)
    assert inventory.photos == {}
    assert remarks(inventory, "warning") == {
        f"Items!{address('photo', row)}: the picture '{name}' cannot be used: it is no PNG or JPEG picture. Save it as PNG "
        "or JPEG. It is left out."
        for row, name in ((3, "text.png"), (4, "p.svg"))
    }


def test_series_hold_plans_and_photos_and_results_json_does_not(folder: Path) -> None:
    inventory = _read(folder, {"plan": "p.svg", **PLACED}, {**PIECE, "item": "B", "photo": "p.jpg"})
    results = assess.run(inventory, assess.Settings(verify="none"))
    assert results.series["plan/0"].tobytes() == _plan(inventory).content
    assert results.series["photo/of_item"].tolist() == [-1, 0]
    assert results.series["photo/0"].tobytes() == inventory.photos["p.jpg"]
    row = results.floor_rows[0].plan
    assert row is not None
    assert (row.path.name, row.width, row.is_lines) == ("p.svg", 16.0, True)
    text = assess.write_reports(results, folder, "json")["json"].read_text(encoding="utf-8")
    assert "p.svg" not in text
