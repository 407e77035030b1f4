"""``assess import``: what users see of it, and what they find in the folder."""

from pathlib import Path

import pytest

from tests.bim.cobie_files import COMPONENTS, TYPES, one_type, write_cobie
from tests.cli.calling import error, run
from tests.workbooks import write


@pytest.fixture
def cobie(tmp_path: Path) -> Path:
    return write_cobie(tmp_path / "handover.xlsx")


def test_it_says_what_was_taken_and_what_was_left_out(cobie):
    out = cobie.with_name("building.xlsx")
    done = run("import", cobie, "-o", out)
    assert done.exit_code == 0
    assert done.stdout.splitlines()[:2] == [
        "handover.xlsx: 2 pieces of 1 type on 2 floors taken.",
        "1 component left out (AssetType is Fixed): Door B (1).",
    ]
    assert done.stderr.startswith(f"wrote {out}. Choose Shaking in Building or fill in Floors, then run: assess check")


def test_the_workbook_lacks_the_shaking_alone(cobie):
    out = cobie.with_name("building.xlsx")
    run("import", cobie, "--out", out)
    checked = run("check", out)
    assert checked.exit_code == 1
    errors = [line for line in checked.stderr.splitlines() if line.startswith("error")]
    assert len(errors) == 2
    assert all("has neither a record nor a PFA" in line for line in errors)
    assert "building.xlsx is incomplete: what is filled in can be used." in checked.stderr


def test_with_the_shaking_filled_in_it_runs(cobie):
    from assess.workbook.layout import PLACES
    from assess.workbook.patch import patch_workbook

    out = cobie.with_name("building.xlsx")
    run("import", cobie, "-o", out)
    cell = f"B{PLACES['Building', 'ground_pga'] + 1}"
    out.write_bytes(patch_workbook(out.read_bytes(), {"Building": {cell: 0.3}}).data)
    assert run("check", out).stdout == "building.xlsx: no errors. 2 rows of furniture on 2 floors, 0 route segments.\n"


def test_furniture_that_was_left_out_is_named_and_ends_with_1(tmp_path):
    path = write_cobie(tmp_path / "h.xlsx", types=({**TYPES[0], "NominalHeight": "n/a"}, {**TYPES[0], "Name": "Rack"}),
                       components=(*COMPONENTS[:2], {**COMPONENTS[0], "TypeName": "Rack"}))  # fmt: skip
    done = run("import", path, "-o", tmp_path / "b.xlsx")
    assert done.exit_code == 1
    assert done.stdout.splitlines()[:2] == [
        "h.xlsx: 1 piece of 1 type on 2 floors taken.",
        "2 pieces left out (no NominalHeight): Bookcase A (2).",
    ]
    assert (tmp_path / "b.xlsx").exists()


def test_without_furniture_the_floors_are_written_and_the_end_is_1(tmp_path):
    done = run("import", write_cobie(tmp_path / "h.xlsx", components=()), "-o", tmp_path / "b.xlsx")
    assert done.exit_code == 1
    assert "No furniture was found: fill in Items by hand." in done.stdout
    checked = run("check", tmp_path / "b.xlsx")
    assert (checked.exit_code, "is incomplete" in checked.stderr) == (1, True)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("model.ifc", "model.ifc is of a kind that is not imported: name a COBie spreadsheet, which ends in .xlsx."),
        ("scan.json", "scan.json is of a kind that is not imported"),
        ("folder", "folder is of a kind that is not imported"),
        ("missing.xlsx", "missing.xlsx does not exist. Check the name and the folder."),
    ],
)
def test_files_of_another_kind(tmp_path, name, message):
    done = run("import", tmp_path / name, "-o", tmp_path / "b.xlsx")
    assert message in error(done)
    assert not (tmp_path / "b.xlsx").exists()


def test_an_inventory_given_by_mistake_is_said(tmp_path):
    path = write(tmp_path / "inventory.xlsx")
    done = run("import", path, "-o", tmp_path / "b.xlsx")
    assert "inventory.xlsx is an inventory workbook already, not a COBie file." in error(done)


def test_an_existing_workbook_stays_unless_forced(cobie):
    out = cobie.with_name("building.xlsx")
    out.write_bytes(b"mine")
    done = run("import", cobie, "-o", out)
    assert (done.exit_code, done.stdout) == (1, "")
    assert "already exists: add --force to replace it" in done.stderr
    assert out.read_bytes() == b"mine"
    assert run("import", cobie, "-o", out, "--force").exit_code == 0
    assert out.read_bytes().startswith(b"PK")


def test_the_file_itself_is_never_replaced(cobie):
    before = cobie.read_bytes()
    assert "is the file to import" in error(run("import", cobie, "-o", cobie, "--force"))
    assert cobie.read_bytes() == before


def test_the_workbook_has_to_end_in_xlsx(cobie):
    assert "does not end in .xlsx: name it b.xlsx" in error(run("import", cobie, "-o", cobie.with_name("b.csv")))


@pytest.mark.parametrize("share", [0.2, 0.95])
def test_a_damaged_file_leaves_nothing(cobie, share):
    data = cobie.read_bytes()
    cobie.write_bytes(data[: int(share * len(data))])
    out = cobie.with_name("building.xlsx")
    assert "handover.xlsx is" in error(run("import", cobie, "-o", out))
    assert [one.name for one in cobie.parent.iterdir()] == ["handover.xlsx"]


def test_names_that_command_a_terminal_are_printed_clean(tmp_path):
    rows = one_type(Name="Rack \u202e[31m", NominalHeight=None)
    rows["components"] = ({**COMPONENTS[0], "TypeName": "Rack \u202e[31m"},)
    done = run("import", write_cobie(tmp_path / "h.xlsx", **rows), "-o", tmp_path / "b.xlsx")
    assert "Rack [31m (1)" in done.stdout
