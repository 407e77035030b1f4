"""``assess import``: what users see of it, and what they find in the folder."""

import hashlib
import json
from pathlib import Path

import pytest

from assess.workbook.lists import PLACES
from assess.workbook.read import read_inventory, read_tables
from tests.bim.cobie_files import COMPONENTS, TYPES, one_type, write_cobie
from tests.bim.model_here import models_read_here
from tests.cli.calling import error, run
from tests.workbooks import edited

MODELS = Path(__file__).parents[2] / "samples" / "models"
DUPLEX = MODELS / "duplex.ifc"


@pytest.fixture(autouse=True, scope="module")
def _models_read_here():
    with models_read_here():
        yield


@pytest.fixture
def cobie(tmp_path: Path) -> Path:
    return write_cobie(tmp_path / "handover.xlsx")


def test_the_workbook_lacks_the_shaking_alone_and_runs_with_it(cobie):
    out = cobie.with_name("building.xlsx")
    done = run("import", cobie, "-o", out)
    assert done.exit_code == 0
    assert done.stdout.splitlines()[:2] == [
        "handover.xlsx: 2 pieces of 1 type on 2 floors taken.",
        "1 component left out (AssetType is Fixed): Door B (1).",
    ]
    checked = run("check", out)
    assert checked.exit_code == 1
    errors = [line for line in checked.stderr.splitlines() if line.startswith("error")]
    assert len(errors) == 2
    assert all("has neither a record nor a PFA" in line for line in errors)
    fill_in(out, ground_pga=0.3)
    assert run("check", out).exit_code == 0


def test_furniture_that_was_left_out_is_named_and_ends_with_1_and_names_are_printed_clean(tmp_path):
    path = write_cobie(tmp_path / "h.xlsx", types=({**TYPES[0], "NominalHeight": "n/a"}, {**TYPES[0], "Name": "Rack"}),
                       components=(*COMPONENTS[:2], {**COMPONENTS[0], "TypeName": "Rack"}))  # fmt: skip
    done = run("import", path, "-o", tmp_path / "b.xlsx")
    assert done.exit_code == 1
    assert done.stdout.splitlines()[:2] == [
        "h.xlsx: 1 of 3 pieces of 1 type on 1 floor taken.",
        "2 pieces left out (no NominalHeight): Bookcase A (2).",
    ]
    assert (tmp_path / "b.xlsx").exists()
    rows = one_type(Name="Rack \u202e[31m", NominalHeight=None)
    rows["components"] = ({**COMPONENTS[0], "TypeName": "Rack \u202e[31m"},)
    done = run("import", write_cobie(tmp_path / "c.xlsx", **rows), "-o", tmp_path / "d.xlsx")
    assert "Rack [31m (1)" in done.stdout


def test_damaged_and_truncated_files_leave_nothing(cobie, tmp_path):
    for data, name, message, shares in (
        (cobie.read_bytes(), "handover.xlsx", "handover.xlsx is", (0.2, 0.95)),
        (DUPLEX.read_bytes(), "a.ifc", "a.ifc cannot be read: it is", (0.0, 0.3, 0.99)),
    ):
        path = tmp_path / f"of {name}" / name
        path.parent.mkdir()
        for share in shares:
            path.write_bytes(data[: int(share * len(data))])
            assert message in error(run("import", path, "-o", path.with_name("b.xlsx"))), share
            assert [one.name for one in path.parent.iterdir()] == [name], share


# ---------------------------------------------------------------- building models


def fill_in(path: Path, **building: float | str) -> None:
    """Set lines of Building, as a person does."""
    cells = {f"B{PLACES['Building', name] + 1}": value for name, value in building.items()}
    path.write_bytes(edited(path.read_bytes(), {"Building": cells}))


def set_item(path: Path, row: int, **values: float | str) -> None:
    """Set cells of a row of Items, as a person does."""
    from assess.workbook.plain_rows import column_letters

    cells = {f"{column_letters(PLACES['Items', name])}{row}": value for name, value in values.items()}
    path.write_bytes(edited(path.read_bytes(), {"Items": cells}))


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workbook of the duplex; copy it to change it."""
    out = tmp_path_factory.mktemp("duplex") / "duplex.xlsx"
    done = run("import", MODELS / "duplex.ifc", "-o", out)
    assert done.exit_code == 1
    out.with_suffix(".txt").write_text(done.stdout, encoding="utf-8")
    return out


@pytest.fixture
def duplex(imported: Path, tmp_path: Path) -> Path:
    for one in imported.parent.iterdir():
        (tmp_path / one.name).write_bytes(one.read_bytes())
    return tmp_path / imported.name


def test_a_model_gives_pieces_plans_and_the_list_of_what_was_left_out(imported):
    said = imported.with_suffix(".txt").read_text(encoding="utf-8")
    assert said.startswith(
        "duplex.ifc: 47 of 61 pieces of 9 types on 2 floors taken.\n14 pieces left out (not on the floor"
    )
    assert "IfcFurnishingElement M_Upper Cabinet-Double Door-Wall 1000 mm (6)" in said
    assert "Check: Doors that lead out of the ground storey (a room on one side only): 4 of 14." in said
    record = (imported.parent / "duplex-import.txt").read_text(encoding="utf-8")
    assert record.splitlines()[0].endswith(
        "from duplex.ifc, SHA-256 " + hashlib.sha256(DUPLEX.read_bytes()).hexdigest()
    )
    assert record.endswith(said)
    assert {one.name for one in imported.parent.iterdir()} == {
        "duplex.xlsx", "duplex.txt", "duplex-import.txt", "duplex-Level-1.svg", "duplex-Level-2.svg", "duplex-Roof.svg",
    }  # fmt: skip


def test_the_wardrobes_have_their_supports_and_the_catalogue_their_type(duplex):
    fill_in(duplex, shaking="MMI VII, very strong")
    inventory = read_inventory(duplex)
    found = [one for one in inventory.items if "Tall Cabinet" in one.description]
    assert len(found) == 8
    for one in found:
        assert (one.breadth, one.width, one.height) == pytest.approx((0.485, 0.8, 2.0))
        assert one.notes.startswith(
            "body 54.5 x 80.0 x 200.0 cm, 48.5 cm between the outer supports, which are off the middle: to one side it "
            "tips as with a Breadth of 42.5 cm;"  # the plinth is set back at the front only
        )
        assert (one.sizes_from, one.type) == ("model", "M_Tall Cabinet-Single Door(2) 800 mm")
        assert len(one.more["source_id"]) == 22


@pytest.mark.slow
def test_with_the_shaking_filled_in_reports_show_the_walls(duplex):
    fill_in(duplex, shaking="MMI VII, very strong")
    out = duplex.parent / "reports"
    done = run("run", duplex, "--out", out, "--verify", "none", "--formats", "html,json")
    assert done.exit_code == 0, done.stderr
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "the plan duplex-Level-1.svg, placed by the workbook" in page
    plans = json.loads((out / "results.json").read_text(encoding="utf-8"))["floors"]
    assert [floor["floor"] for floor in plans] == ["Level 1", "Level 2", "Roof"]


@pytest.mark.slow
def test_drafted_routes_reach_an_exit_or_a_stair_from_19_rooms(tmp_path):
    out = tmp_path / "d.xlsx"
    done = run("import", MODELS / "duplex.ifc", "-o", out, "--routes", "draft")
    assert "No way out of 1 room was found in the model: R301 Roof." in done.stdout
    fill_in(out, shaking="MMI VII, very strong")
    inventory = read_inventory(out)
    assert inventory.routes
    assert all(segment.route.endswith(" (draft)") for segment in inventory.routes)
    ends = {end for segment in inventory.routes for end in (segment.start, segment.end)}
    rooms = {row.place for row in inventory.places if row.outline and row.place in ends}
    assert len(rooms) == 20  # with a room that is a stair
    assert len({one for one in rooms if "Stair" not in one}) == 19
    assert "drafted from a building model" in run("check", out).stderr


@pytest.mark.slow
def test_an_update_keeps_what_people_typed_and_lists_what_changed(duplex):
    set_item(duplex, 2, anchored="yes", weight=55.0, notes="ours", height=99.0)
    before = duplex.read_bytes()
    done = run("import", MODELS / "duplex.ifc", "-o", duplex, "--update")
    assert done.exit_code == 1  # 14 pieces are left out
    changed = [line for line in done.stdout.splitlines() if line.startswith("Items ")]
    assert len(changed) == 1
    assert " of A102-01: 99 -> 81.3" in changed[0]
    assert duplex.read_bytes() != before
    fill_in(duplex, shaking="MMI VII, very strong")
    first = next(one for one in read_inventory(duplex).items if one.item == "A102-01")
    assert first.height == pytest.approx(0.813)
    assert (first.anchored, first.weight, first.notes) == ("yes", 55.0, "ours")


@pytest.mark.slow
def test_what_people_save_while_an_update_reads_the_model_is_not_lost(duplex, monkeypatch):
    from assess.bim import read_source

    real, record = read_source.read_source, duplex.with_name("duplex-import.txt")

    def read_while_somebody_saves(*args, **choices):
        found = real(*args, **choices)
        set_item(duplex, 3, notes="typed meanwhile")
        return found

    set_item(duplex, 2, height=99.0)
    record.write_text("of the first import", encoding="utf-8")
    monkeypatch.setattr(read_source, "read_source", read_while_somebody_saves)
    done = run("import", DUPLEX, "-o", duplex, "--update")
    assert (done.exit_code, done.stdout) == (1, "")
    assert "duplex.xlsx was changed while the model was read: run the import again." in done.stderr
    assert record.read_text(encoding="utf-8") == "of the first import"
    fill_in(duplex, shaking="MMI VII, very strong")
    first, second = read_inventory(duplex).items[:2]
    assert first.height == pytest.approx(0.99)
    assert second.notes == "typed meanwhile"


def test_an_update_replaces_plans_of_imports_alone_and_without_changes_leaves_every_byte(duplex):
    folder, before = duplex.parent, duplex.read_bytes()
    done = run("import", MODELS / "duplex.ifc", "-o", duplex, "--update")
    assert "The workbook is up to date with the model: nothing was changed." in done.stdout
    assert duplex.read_bytes() == before
    assert done.stderr.startswith(f"{duplex} stays as it is; wrote this list beside it. Now run: assess check")
    plans = [folder / f"duplex-{name}.svg" for name in ("Level-1", "Level-2", "Roof")]
    data = [plan.read_bytes() for plan in plans]
    plans[0].write_bytes(b"<svg>drawn by people</svg>")
    plans[1].unlink()
    plans[2].write_bytes(data[2].replace(b"</svg>", b"<!-- of an older model --></svg>"))
    done = run("import", DUPLEX, "-o", duplex, "--update")
    assert "stays as it is: duplex-Level-1.svg is not a plan of the import" in done.stdout
    assert f"{duplex} stays as it is; wrote 2 plans and this list beside it" in done.stderr
    assert [plan.read_bytes() for plan in plans] == [b"<svg>drawn by people</svg>", *data[1:]]
    assert duplex.read_bytes() == before


@pytest.mark.slow
def test_an_update_writes_no_plan_over_one_of_people_that_the_workbook_does_not_name(duplex):
    """The model has another name today, under which people have drawn a plan."""
    model = duplex.with_name("house.ifc")
    model.write_bytes(DUPLEX.read_bytes())
    mine = duplex.with_name("house-Level-1.svg")
    mine.write_bytes(b"mine")
    run("import", model, "-o", duplex, "--update")
    assert mine.read_bytes() == b"mine"
    tables, _ = read_tables(duplex.read_bytes(), duplex.name)
    named = [row.get("plan") for row in tables["Floors"].rows]
    assert named == ["house-Level-1-2.svg", "house-Level-2.svg", "house-Roof.svg"]
    before = duplex.read_bytes()
    assert "is up to date" in run("import", model, "-o", duplex, "--update").stdout
    assert duplex.read_bytes() == before


@pytest.mark.slow
def test_a_plan_that_is_there_is_not_replaced(tmp_path):
    plan = tmp_path / "LargeBuilding-Level-1.svg"
    plan.write_text("mine", encoding="utf-8")
    done = run("import", MODELS / "LargeBuilding.ifc", "-o", tmp_path / "b.xlsx")
    assert (done.exit_code, plan.read_text(encoding="utf-8")) == (1, "mine")
    assert "LargeBuilding-Level-1.svg already exists: add --force" in done.stderr
    assert not (tmp_path / "b.xlsx").exists()
    assert run("import", MODELS / "LargeBuilding.ifc", "-o", tmp_path / "b.xlsx", "--force").exit_code == 0


def test_a_model_without_furniture_gives_storeys_and_rooms(tmp_path):
    from tests.bim.ifc_files import one_room

    model, storey, _ = one_room()
    model.element("IfcWall", "W", (3, 0, 0, 6, 0.2, 3), within=storey)
    done = run("import", model.write(tmp_path / "a.ifc"), "-o", tmp_path / "b.xlsx")
    assert done.exit_code == 1
    assert done.stdout.splitlines()[:2] == [
        "a.ifc: 0 pieces of 0 types on 1 floor taken.", "No furniture was found: fill in Items by hand.",
    ]  # fmt: skip
    assert {one.name for one in tmp_path.iterdir()} == {"a.ifc", "b.xlsx", "a-Level-1.svg", "a-import.txt"}
    checked = run("check", tmp_path / "b.xlsx")
    assert (checked.exit_code, "is incomplete" in checked.stderr) == (1, True)
