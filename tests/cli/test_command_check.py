"""`assess check`: workbooks that lack the shaking, and --fix: the corrected copy, what is printed, the exit status."""

from pathlib import Path

from assess.workbook.read import read_inventory
from tests.cli.calling import error, run
from tests.workbooks import ITEMS, RECORDS, address, edited, write

BREADTH = address("breadth", 2)
HEIGHTS = [address("height", row) for row in (2, 3, 4, 5)]
LACKING = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 4}]


def habits(path: Path, *typed: str, **cells: str) -> Path:
    """A workbook with the first breadth and heights as they are typed, and with other cells of Items."""
    write(path)
    items = dict(zip((BREADTH, *HEIGHTS), typed, strict=False)) | cells
    path.write_bytes(edited(path.read_bytes(), {"Items": items}))
    return path


def test_a_corrected_copy_is_written(tmp_path):
    path = habits(tmp_path / "book.xlsx", "30 cm", "200 cm", "2 m", "1.8 m", "0.9 m", **{address("anchored", 4): "N"})
    before = path.read_bytes()
    done = run("check", path, "--fix", tmp_path / "out.xlsx")
    assert (done.exit_code, done.stderr.count("error")) == (0, 0), done.output
    assert done.stdout.startswith(f"wrote {tmp_path / 'out.xlsx'}: 6 cells corrected.\n")
    shown = "{} '200 cm' -> 200, {} '2 m' -> 200, {} '1.8 m' -> 180 and 1 more".format(*HEIGHTS)
    assert f"  Items, 4 cells: {shown}. The unit is in the header.\n" in done.stdout
    assert path.read_bytes() == before
    inventory = read_inventory(tmp_path / "out.xlsx")
    assert inventory.items[0].breadth == 0.3
    assert not inventory.corrections
    assert len(inventory.items) == len(ITEMS)


def test_errors_that_remain_are_named_and_the_copy_is_written(tmp_path):
    path = habits(tmp_path / "book.xlsx", "30 cm", "200", "high")
    done = run("check", path, "--fix", tmp_path / "out.xlsx")
    assert done.exit_code == 2
    assert f"Items!{HEIGHTS[1]}: Height is the text 'high'" in done.stderr
    assert done.stderr.endswith("1 error to correct by hand.\n")
    assert run("check", tmp_path / "out.xlsx").stderr.count("error ") == 1


def test_the_problems_are_those_that_a_check_of_the_copy_names(tmp_path):
    path = habits(tmp_path / "book.xlsx", "30 cm")
    floor = {address("pfa_x", 2, "Floors"): "far too strong"}
    path.write_bytes(edited(path.read_bytes(), {"Floors": floor}))
    shown = run("check", path, "--fix", tmp_path / "out.xlsx").stderr.splitlines()
    assert shown[:-1] == run("check", tmp_path / "out.xlsx").stderr.splitlines()[:-1]
    assert not any("left out" in line for line in shown)


def test_the_workbook_itself_is_never_written(tmp_path):
    path = habits(tmp_path / "book.xlsx", "30 cm")
    (tmp_path / "linked.xlsx").hardlink_to(path)
    before = path.read_bytes()
    for out in (path, tmp_path / "." / "book.xlsx", tmp_path / "linked.xlsx"):
        assert "is the workbook itself" in error(run("check", path, "--fix", out, "--force"))
    assert path.read_bytes() == before


def test_files_that_the_workbook_names_are_looked_for_next_to_it(tmp_path):
    record = next(one for one in sorted(RECORDS.rglob("*")) if one.suffix == ".csv")
    path = write(tmp_path / "book.xlsx", floors=[{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "record_x": record.name}])
    (tmp_path / record.name).write_bytes(record.read_bytes())
    path.write_bytes(edited(path.read_bytes(), {"Items": {BREADTH: "30 cm"}}))
    (tmp_path / "other").mkdir()
    done = run("check", path, "--fix", tmp_path / "other" / "out.xlsx")
    assert "The files that the workbook names lie next to book.xlsx: copy them next to out.xlsx as well." in done.stdout
    assert "copy them" not in run("check", path, "--fix", tmp_path / "out.xlsx").stdout


# ---------------------------------------------------------------- what lacks the shaking


def test_what_lacks_the_shaking_and_what_does_not(tmp_path):
    """What is wrong stays an error next to what is missing; a chosen profile without ground motion is incomplete."""
    items = [*ITEMS, {"item": "B", "floor": "9", "breadth": 40, "height": 180}]
    done = run("check", write(tmp_path / "w.xlsx", items, LACKING))
    assert done.exit_code == 2
    assert "3 errors; nothing was written." in done.stderr
    assert "incomplete" not in done.stderr
    done = run("check", write(tmp_path / "w.xlsx", scenario_kind="NTC 2018", floors=LACKING))
    assert done.exit_code == 1
    assert "Hazard map" in done.stderr
    done = run("check", write(tmp_path / "w.xlsx", shaking="MMI VII, very strong"))
    assert done.exit_code == 0
    assert "Shaking is not used" in done.stderr
    assert "To know the shaking better" not in done.stderr
