"""Files that a workbook names: records, their channels and directions, pictures."""

import re
from pathlib import Path

import numpy as np
import pytest

import assess
from assess.errors import WorkbookError
from tests.pictures import claim_size, picture
from tests.workbook.books import ITEMS, Sheet, errors_of, read, remarks, write

PNG = picture("PNG")


def write_record(path: Path, heading: str = "time [s],NS [g]", comments: str = "") -> None:
    times = np.arange(0, 4, 0.01)
    motion = 0.2 * np.sin(6 * times) * np.sin(np.pi * times / 4)
    channels = heading.count(",")
    rows = [f"{t:.2f}," + ",".join([f"{a:.6f}"] * channels) for t, a in zip(times, motion, strict=True)]
    path.write_text(comments + heading + "\n" + "\n".join(rows) + "\n", encoding="utf-8")


def floors_with(record: str, axis: str = "X") -> Sheet:
    return [["Floor", f"Record {axis}"], ["1", record]]


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


def test_records_that_cannot_be_used_and_links_that_lead_outside_the_folder(tmp_path: Path) -> None:
    outside = [
        "../roof.csv", r"..\roof.csv", "sub/../../roof.csv", "/etc/passwd", r"\roof.csv", r"C:\roof.csv", "C:roof.csv",
        r"\\server\share\roof.csv", "//server/share/roof.csv", "file:///etc/passwd", "http://example.org/roof.csv",
        "roof.csv:stream", "CON", "nul.csv", "sub/COM1.csv", "roof\u200d.csv", "n" * 600,
    ]  # fmt: skip
    floors = [["Floor", "Record X"], *([f"F{at}", record] for at, record in enumerate(outside))]
    found = errors_of(write(tmp_path, [ITEMS[0], ["A1", "F0", 40, 180]], floors))
    assert len(found) == len(outside)
    words = "is outside the workbook's folder. Copy it next to the workbook and write its name alone."
    assert [one for one in found if words not in one] == []
    inside = tmp_path / "inside"
    inside.mkdir()
    write_record(tmp_path / "roof.csv")
    (inside / "link.csv").symlink_to(tmp_path / "roof.csv")
    (inside / "circle.csv").symlink_to(inside / "circle.csv")
    with pytest.raises(WorkbookError, match=r"'link.csv' is a link that leads outside the workbook's folder\. Copy it"):
        read(inside, floors=floors_with("link.csv"))
    with pytest.raises(WorkbookError, match=r"'circle.csv' (cannot be found under that name|was not found)"):
        read(inside, floors=floors_with("circle.csv"))
    write_record(tmp_path / "two.csv", "time [s],NS [g],Up [g]")
    (tmp_path / "noise.csv").write_text("no record", encoding="utf-8")
    for record, message in BAD_RECORDS:
        (error,) = errors_of(write(tmp_path, floors=floors_with(record)))
        assert error.startswith(f"Floors!B2: {message}")


def test_records_are_read_with_their_direction_and_one_that_is_not_known_is_asked_for(tmp_path: Path) -> None:
    for building, record, axis, off in (
        (0, 15, "X", None), (0, 16, "X", 16), (0, 196, "X", 16), (0, 180, "X", None), (0, 90, "Y", None),
        (0, 0, "Y", 90), (350, 10, "X", 20), (350, 360, "X", None), (-90, 0, "Y", None), (None, 45, "X", None),
    ):  # fmt: skip
        write_record(tmp_path / "one.csv", comments=f"# azimuth: {record}\n")
        inventory = read(tmp_path, floors=floors_with("one.csv", axis), Building=[["Azimuth of X [deg]", building]])
        message = f"Floors!B2: 'one.csv' points to {record} deg, {off} deg off the {axis} axis."
        fix = "Check the axis, or Azimuth of X in Building."
        assert remarks(inventory, "warning") == (set() if off is None else {f"{message} {fix}"})
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
    write_record(tmp_path / "one.csv", "time [s],acceleration [g]")
    (warning,) = remarks(read(tmp_path, floors=floors_with("one.csv")), "warning")
    assert warning.startswith("Floors!B2: the direction of 'one.csv' is not known: is it horizontal?")
    write_record(tmp_path / "one.csv", "time [s],x [g]")
    assert not remarks(read(tmp_path, floors=floors_with("one.csv")), "warning")


UNSERVED = "Fill in PFA X or PFA Y, or name a record; or fill in Ground PGA, or choose Shaking, in Building."
NO_GROUND = "Building gives neither Ground PGA nor Ground PGV nor SDS nor a ShakeMap file nor Shaking."


def test_a_floor_without_motion_is_an_error_unless_others_or_the_ground_serve_it(tmp_path: Path) -> None:
    floors: Sheet = [["Floor", "Elevation [m]", "PFA X [g]", "PFV X [cm/s]"], ["1", None, None, 30]]
    assert errors_of(write(tmp_path, floors=floors)) == {
        "Floors!C2: floor '1' has neither a record nor a PFA, no Elevation by which its motion follows from other "
        f"floors, and {NO_GROUND} {UNSERVED}"
    }
    assert errors_of(write(tmp_path, floors=[*floors[:1], ["1", None, 0.3], ["2", 4, None]])) == {
        f"Floors!C3: floor '2' has neither a record nor a PFA, no other floor has one and an Elevation, and {NO_GROUND} "
        f"{UNSERVED}"
    }
    # What cannot be read is told once: a floor, or a ground motion, that might be served by it is not told of.
    for rows, ground, cells in (
        ([["1", 0, 0.3], ["2", "high"], ["3", 12]], "strong", {"Floors!B3", "Building!B1"}),
        ([["1", "low", 0.3], ["2", 4], ["3", 12, 0.4]], None, {"Floors!B2"}),
    ):
        path = write(tmp_path, floors=[floors[0], *rows], Building=[["Ground PGA [g]", ground]])
        assert {one.split(":")[0] for one in errors_of(path)} == cells
    # What nothing can serve, whatever the scenario, is told with the other faults of the workbook.
    grounds = [["SDS [g]", 0.5], ["Ground PGA [g]", 0.2], ["Ground PGV [cm/s]", 20], ["Shaking", "JMA 7"]]
    served = [*((height, []) for height in (4, 12, -3)), *((None, [line]) for line in grounds)]
    for height, building in [*served, (None, [["Storeys", 4]])]:
        floors = [["Floor", "Elevation [m]", "PFA X [g]"], ["1", 3, 0.3], ["2", height, None], ["3", 8, 0.4]]
        path = write(tmp_path, [*ITEMS, ["A2", "9", 40, 180]], floors, Building=building)
        unserved = set() if (height, building) in served else {"Floors!C3"}
        assert {one.split(":")[0] for one in errors_of(path)} == {"Items!B3"} | unserved


def test_a_motion_at_grade_serves_floors_of_unknown_height(tmp_path: Path) -> None:
    write_record(tmp_path / "one.csv")
    storeys: Sheet = [["Storeys", 4]]
    nothing: Sheet = []
    for lowest, building, is_served in (
        (["1", 0], nothing, True), (["1", -3], storeys, True), (["1", 3], nothing, False),
        (["0", None], storeys, True), (["2", None], storeys, False), (["0", None], nothing, False),
    ):  # fmt: skip
        for motion in ([None, "one.csv"], [0.3, None]):
            floors: Sheet = [
                ["Floor", "Elevation [m]", "PFA X [g]", "Record X"],
                [*lowest, *motion],
                ["loft", *[None] * 3],
            ]
            path = write(tmp_path, [ITEMS[0], ["A1", "loft", 40, 180]], floors, Building=building)
            if not is_served:
                assert {one.split(":")[0] for one in errors_of(path)} == {"Floors!C3"}
                continue
            loft = assess.run(path, verify="none").motions[-1]
            unknown = "unknown_height" if building else "unknown_building"
            assert (loft.floor, loft.source, loft.flags) == ("loft", "beam", ("drawn_building", unknown))


def test_logos(tmp_path: Path) -> None:
    """One that cannot be used is left out; plans of floors: test_picture_files."""
    logo = tmp_path / "logo.png"
    useless = "the picture 'logo.png' cannot be used: "
    for data, name, message in (
        (PNG, "logo.png", ""),
        (picture("JPEG"), "logo.png", ""),
        (b"<svg onload='x'/>", "logo.png", f"{useless}it is no PNG or JPEG picture. Save it as PNG or JPEG."),
        (PNG + bytes(10 * 2**20), "logo.png", f"{useless}it is larger than 10 MB. Save it smaller."),
        (claim_size(PNG, 12_000, 12_000), "logo.png", f"{useless}it has 144 million pixels, expected at most 50."),
        (PNG[:-20], "logo.png", f"{useless}it is damaged. Open it in a graphics program and save it again."),
        (PNG, "other.png", "the file 'other.png' was not found next to the workbook."),
        (PNG, "../logo.png", "the file '../logo.png' is outside the workbook's folder."),
    ):
        logo.write_bytes(data)
        inventory = read(tmp_path, Building=[["Logo file", name]])
        assert inventory.building.logo == (None if message else logo)
        (warning,) = remarks(inventory, "warning") or {"Building!B1: "}
        assert warning.startswith(f"Building!B1: {message}")
