"""Files that a workbook names: records, their channels and directions, pictures."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import assess
from assess.errors import WorkbookError
from assess.units import GRAVITY
from assess.workbook.read import read_inventory
from tests.pictures import claim_size, picture
from tests.workbook.books import (
    ITEMS,
    Sheet,
    errors_of,
    read,
    remarks,
    write,
)

PNG, JPEG = picture("PNG"), picture("JPEG")


def write_record(path: Path, heading: str = "time [s],NS [g]", comments: str = "") -> None:
    times = np.arange(0, 4, 0.01)
    motion = 0.2 * np.sin(6 * times) * np.sin(np.pi * times / 4)
    channels = heading.count(",")
    rows = [f"{t:.2f}," + ",".join([f"{a:.6f}"] * channels) for t, a in zip(times, motion, strict=True)]
    path.write_text(comments + heading + "\n" + "\n".join(rows) + "\n", encoding="utf-8")


def floors_with(record: str, axis: str = "X") -> Sheet:
    return [["Floor", f"Record {axis}"], ["1", record]]


def test_records(tmp_path: Path) -> None:
    (tmp_path / "records").mkdir()
    write_record(tmp_path / "one.csv")
    write_record(tmp_path / "records" / "two.csv", "time [s],NS [g],EW [g]")
    inventory = read(tmp_path, floors=floors_with(r" one.csv ; records\two.csv#ew; records/two.csv # 1;"))
    records = inventory.floors[0].records
    assert list(records) == ["X"]
    assert [one.name for one in records["X"]] == ["one.csv", r"records\two.csv#ew", "records/two.csv # 1"]
    assert [one.record.channel for one in records["X"]] == ["NS", "EW", "NS"]
    assert sorted(inventory.files) == ["one.csv", r"records\two.csv"]
    assert all(re.fullmatch("[0-9a-f]{64}", digest) for digest in inventory.files.values())


def test_a_direction_that_is_not_known_is_asked_for(tmp_path: Path) -> None:
    write_record(tmp_path / "one.csv", "time [s],acceleration [g]")
    (warning,) = remarks(read(tmp_path, floors=floors_with("one.csv")), "warning")
    assert warning.startswith("Floors!B2: the direction of 'one.csv' is not known: is it horizontal?")
    write_record(tmp_path / "one.csv", "time [s],x [g]")
    assert not remarks(read(tmp_path, floors=floors_with("one.csv")), "warning")


BAD_RECORDS = [
    ("two.csv", "two.csv holds 2 channels: NS, Up. Name one of them, such as two.csv#NS."),
    ("two.csv#9", "two.csv has no channel '9'. It holds: NS, Up."),
    ("two.csv#up", "'two.csv#up' is a vertical channel. Choose a horizontal one."),
    ("gone.csv", "the file 'gone.csv' was not found next to the workbook. Check the name, or copy the file there."),
    ("gone.csv#NS", "the file 'gone.csv' was not found next to the workbook."),
    ("#NS", "the file '' was not found next to the workbook."),
    ("noise.csv", "the record cannot be read: noise.csv: the file format is not supported"),
    (" ; ", "';' names no file. Name a record, or clear the cell."),
    (".", "the file '.' was not found next to the workbook."),
    ("n" * 300 + ".csv", f"the file '{'n' * 60}…' cannot be found under that name. Give it a shorter, simpler name."),
]


@pytest.mark.parametrize(("record", "message"), BAD_RECORDS, ids=[record[:12] for record, _ in BAD_RECORDS])
def test_records_that_cannot_be_used(tmp_path: Path, record: str, message: str) -> None:
    write_record(tmp_path / "two.csv", "time [s],NS [g],Up [g]")
    (tmp_path / "noise.csv").write_text("no record", encoding="utf-8")
    (error,) = errors_of(write(tmp_path, floors=floors_with(record)))
    assert error.startswith(f"Floors!B2: {message}")


OUTSIDE = [
    "../roof.csv", r"..\roof.csv", "sub/../../roof.csv", "/etc/passwd", r"\roof.csv", r"C:\roof.csv", "C:roof.csv",
    r"\\server\share\roof.csv", "//server/share/roof.csv", "file:///etc/passwd", "http://example.org/roof.csv",
    "roof.csv:stream", "CON", "nul.csv", "sub/COM1.csv", "roof\u200d.csv", "n" * 600,
]  # fmt: skip


@pytest.mark.parametrize("record", OUTSIDE)
def test_records_outside_the_folder(tmp_path: Path, record: str) -> None:
    with pytest.raises(
        WorkbookError, match=r"is outside the workbook's folder\. Copy it next to the workbook and write"
    ):
        read(tmp_path, floors=floors_with(record))


def test_links_that_lead_outside(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    write_record(tmp_path / "roof.csv")
    (inside / "link.csv").symlink_to(tmp_path / "roof.csv")
    (inside / "circle.csv").symlink_to(inside / "circle.csv")
    with pytest.raises(WorkbookError, match=r"'link.csv' is a link that leads outside the workbook's folder\. Copy it"):
        read(inside, floors=floors_with("link.csv"))
    with pytest.raises(WorkbookError, match=r"'circle.csv' (cannot be found under that name|was not found)"):
        read(inside, floors=floors_with("circle.csv"))


@pytest.mark.parametrize(
    ("building", "record", "axis", "off"),
    [(0, 15, "X", None), (0, 16, "X", 16), (0, 196, "X", 16), (0, 180, "X", None), (0, 90, "Y", None),
     (0, 0, "Y", 90), (350, 10, "X", 20), (350, 360, "X", None), (-90, 0, "Y", None), (None, 45, "X", None)],
)  # fmt: skip
def test_direction_of_records(
    tmp_path: Path, building: float | None, record: float, axis: str, off: float | None
) -> None:
    write_record(tmp_path / "one.csv", comments=f"# azimuth: {record}\n")
    inventory = read(tmp_path, floors=floors_with("one.csv", axis), Building=[["Azimuth of X [deg]", building]])
    message = f"Floors!B2: 'one.csv' points to {record:g} deg, {off or 0:.0f} deg off the {axis} axis."
    fix = "Check the axis, or Azimuth of X in Building."
    assert remarks(inventory, "warning") == (set() if off is None else {f"{message} {fix}"})


UNSERVED = "Fill in PFA X or PFA Y, or name a record; or fill in Ground PGA, or choose Shaking, in Building."
NO_GROUND = "Building gives neither Ground PGA nor Ground PGV nor SDS nor a ShakeMap file nor Shaking."


def test_a_floor_without_motion(tmp_path: Path) -> None:
    floors: Sheet = [["Floor", "Name", "PFA X [g]", "PFV X [cm/s]"], ["1", "Ground", None, 30]]
    assert errors_of(write(tmp_path, floors=floors)) == {
        "Floors!C2: floor '1' has neither a record nor a PFA, no Elevation by which its motion follows from other "
        f"floors, and {NO_GROUND} {UNSERVED}"
    }


def test_a_floor_beside_none_of_which_the_motion_and_the_height_are_known(tmp_path: Path) -> None:
    floors: Sheet = [["Floor", "Elevation [m]", "PFA X [g]"], ["1", None, 0.3], ["2", 4, None]]
    assert errors_of(write(tmp_path, floors=floors)) == {
        f"Floors!C3: floor '2' has neither a record nor a PFA, no other floor has one and an Elevation, and {NO_GROUND} "
        f"{UNSERVED}"
    }


@pytest.mark.parametrize(
    ("middle", "building", "error"),
    [
        ((4, None), [], None), ((12, None), [], None), ((-3, None), [], None),
        *(((None, None), [line], None) for line in (
            ["SDS [g]", 0.5], ["Ground PGA [g]", 0.2], ["Ground PGV [cm/s]", 20], ["Shaking", "JMA 7"]
        )),
        ((None, None), [["Storeys", 4]],
         "C3: floor '2' has neither a record nor a PFA, no Elevation by which its motion follows from other floors, and "
         f"{NO_GROUND} {UNSERVED}"),
    ],
)  # fmt: skip
def test_a_floor_without_motion_that_others_or_the_ground_serve(
    tmp_path: Path, middle: tuple[float | None, ...], building: list[list[Any]], error: str | None
) -> None:
    """What nothing can serve, whatever the scenario, is told with the other faults of the workbook."""
    floors: Sheet = [["Floor", "Elevation [m]", "PFA X [g]"], ["1", 3, 0.3], ["2", *middle], ["3", 8, 0.4]]
    items = [*ITEMS, ["A2", "9", 40, 180]]
    found = errors_of(write(tmp_path, items, floors, Building=building))
    other = {one for one in found if one.startswith("Items!B3: Floor '9' is not in the Floors sheet.")}
    assert len(other) == 1
    assert found - other == ({f"Floors!{error}"} if error else set())


@pytest.mark.parametrize(
    ("lowest", "building", "is_served"),
    [
        (["1", 0], [], True), (["1", -3], [["Storeys", 4]], True), (["1", 3], [], False),
        (["0", None], [["Storeys", 4]], True), (["2", None], [["Storeys", 4]], False), (["0", None], [], False),
    ],
)  # fmt: skip
def test_a_motion_at_grade_serves_floors_of_unknown_height(
    tmp_path: Path, lowest: list[Any], building: list[list[Any]], is_served: bool
) -> None:
    write_record(tmp_path / "one.csv")
    for motion in ([None, "one.csv"], [0.3, None]):
        floors: Sheet = [["Floor", "Elevation [m]", "PFA X [g]", "Record X"], [*lowest, *motion], ["loft", *[None] * 3]]
        path = write(tmp_path, floors=floors, items=[*ITEMS[:1], ["A1", "loft", 40, 180]], Building=building)
        if not is_served:
            assert {one.split(":")[0] for one in errors_of(path)} == {"Floors!C3"}
            continue
        loft = assess.run(path, verify="none").motions[-1]
        unknown = "unknown_height" if building else "unknown_building"
        assert (loft.floor, loft.source, loft.flags) == ("loft", "beam", ("drawn_building", unknown))


def test_what_cannot_be_read_is_told_once(tmp_path: Path) -> None:
    """A floor whose Elevation, or a building whose Ground PGA, cannot be read might be served by it."""
    floors: Sheet = [["Floor", "Elevation [m]", "PFA X [g]"], ["1", 0, 0.3], ["2", "high", None], ["3", 12, None]]
    errors = errors_of(write(tmp_path, floors=floors, Building=[["Ground PGA [g]", "strong"]]))
    assert {one.split(":")[0] for one in errors} == {"Floors!B3", "Building!B1"}
    floors = [["Floor", "Elevation [m]", "PFA X [g]"], ["1", "low", 0.3], ["2", 4, None], ["3", 12, 0.4]]
    assert {one.split(":")[0] for one in errors_of(write(tmp_path, floors=floors))} == {"Floors!B2"}


def test_floor(tmp_path: Path) -> None:
    (tmp_path / "plan.png").write_bytes(PNG)
    header = ["Floor", "Name", "Elevation [ft]", "PFA X [g]", "PFA Y [gal]", "PFV Y [m/s]", "Plan image"]
    inventory = read(tmp_path, floors=[header, [1, "Ground floor", 10, 0.5, 300, 0.4, "plan.png"]])
    floor = inventory.floors[0]
    assert (floor.row, floor.floor, floor.name) == (2, "1", "Ground floor")
    found = (floor.elevation, floor.pfa["X"], floor.pfa["Y"], floor.pfv["Y"])
    assert found == pytest.approx((3.048, 0.5 * GRAVITY, 3, 0.4))
    assert floor.plan is None  # without its numbers: see test_picture_files


@pytest.mark.parametrize("data", [PNG, JPEG])
def test_logo(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "logo").write_bytes(data)
    assert read(tmp_path, Building=[["Logo file", "logo"]]).building.logo == tmp_path / "logo"


USELESS = "the picture 'logo.png' cannot be used: "
PICTURES = [
    (b"<svg onload='x'/>", "logo.png", USELESS + "it is no PNG or JPEG picture. Save it as PNG or JPEG."),
    (b"", "logo.png", USELESS + "it is no PNG or JPEG picture. Save it as PNG or JPEG."),
    (PNG + bytes(10 * 2**20), "logo.png", USELESS + "it is larger than 10 MB. Save it smaller."),
    (claim_size(PNG, 12_000, 12_000), "logo.png",
     USELESS + "it has 144 million pixels, expected at most 50. Save it smaller."),
    (PNG[:-20], "logo.png", USELESS + "it is damaged. Open it in a graphics program and save it again."),
    (PNG, "other.png", "the file 'other.png' was not found next to the workbook. Check the name, or copy the file there."),
    (PNG, "../logo.png", "the file '../logo.png' is outside the workbook's folder. "
                         "Copy it next to the workbook and write its name alone."),
]  # fmt: skip


@pytest.mark.parametrize(("data", "name", "message"), PICTURES, ids=range(len(PICTURES)))
@pytest.mark.parametrize("sheet", ["Building", "Floors"])
def test_pictures_that_cannot_be_used(tmp_path: Path, data: bytes, name: str, message: str, sheet: str) -> None:
    (tmp_path / "logo.png").write_bytes(data)
    if sheet == "Building":
        inventory = read_inventory(write(tmp_path, Building=[["Logo file", name]]))
        assert inventory.building.logo is None
        (warning,) = remarks(inventory, "warning")
        assert warning.replace(" It is left out.", "") == f"Building!B1: {message}"
    else:
        path = write(tmp_path, floors=[["Floor", "PFA X [g]", "Plan image"], ["1", 0.5, name]])
        plan = {b"": "it is no PNG, JPEG, SVG or DXF file. Save it as one of them."}
        plan[b"<svg onload='x'/>"] = "it holds no lines that can be drawn. Save it as PNG."
        assert errors_of(path) == {f"Floors!C2: {USELESS + plan[data] if data in plan else message}"}


def test_a_workbook_is_read_from_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_record(tmp_path / "one.csv")
    path = write(tmp_path, floors=floors_with("one.csv"))
    monkeypatch.chdir(tmp_path)
    here = read_inventory(path.name)
    assert (here.source, here.sha256) == (Path("book.xlsx"), read_inventory(str(path)).sha256)
