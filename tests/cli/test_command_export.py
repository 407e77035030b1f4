"""``assess export``: what users see of it, and what they find in the folder."""

import re
import zipfile
from pathlib import Path

import ifcopenshell
import pytest
from ifcopenshell.util.element import get_psets

from tests.bim.export_runs import CUPBOARD_1, CUPBOARDS, DUPLEX, OFFICE, PLACES, ROUTES, piece, write_results
from tests.bim.model_here import models_read_here
from tests.cli.calling import error, run

WALL = "2O2Fr$t4X7Zf8NOew3FKau"


@pytest.fixture(autouse=True, scope="module")
def _models_read_here():
    with models_read_here():
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return write_results(tmp_path_factory.mktemp("results"), places=PLACES, routes=ROUTES)


@pytest.fixture
def results(made, tmp_path):
    path = tmp_path / "results.json"
    path.write_bytes(made.read_bytes())
    return path


def files(folder: Path) -> list[str]:
    return sorted(one.name for one in folder.iterdir())


def read_class(path: Path) -> str:
    model = ifcopenshell.open(str(path))
    return str(get_psets(model.by_guid(CUPBOARD_1))["Assess_OverturningRisk"]["RiskClass"])


def test_both_are_written_and_said(results):
    out, bcf = results.with_name("risk.ifc"), results.with_name("fix.bcfzip")
    done = run("export", results, "--ifc", DUPLEX, "-o", out, "--bcf", bcf)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0] == "duplex.ifc: a property set Assess_OverturningRisk on 4 pieces."
    assert "what to fix, in the order of the schedule" in lines[1]
    assert f"wrote {out}" in done.stderr
    assert f"wrote {bcf}" in done.stderr
    assert read_class(out) == "very high"
    assert "bcf.version" in zipfile.ZipFile(bcf).namelist()


@pytest.mark.parametrize(("option", "name"), [("--out", "risk.ifc"), ("--bcf", "fix.bcf")])
def test_each_can_be_written_by_itself_from_the_folder_of_a_report(results, option, name):
    done = run("export", results.parent, "--ifc", DUPLEX, option, results.with_name(name))
    assert done.exit_code == 0
    assert len(done.stdout.splitlines()) == 1
    assert files(results.parent) == sorted([name, "results.json"])


@pytest.mark.slow
def test_pieces_that_are_not_in_the_model_are_named_and_end_with_1(tmp_path):
    items = [*CUPBOARDS, piece("No id", "1", None, 1, 1), piece("Stranger", "1", "0" * 22, 2, 1)]
    results = write_results(tmp_path, items)
    done = run("export", results, "--ifc", DUPLEX, "-o", tmp_path / "o.ifc", "--bcf", tmp_path / "t.bcfzip")
    assert done.exit_code == 1
    assert "Not written, 1 piece without a Source ID: No id." in done.stdout
    assert "Not written, 1 piece with a Source ID that is not in duplex.ifc: Stranger." in done.stdout
    assert (tmp_path / "o.ifc").exists()
    assert (tmp_path / "t.bcfzip").exists()


def test_pieces_of_walls_and_pieces_that_share_an_element_are_named_and_end_with_1(tmp_path):
    items = [*CUPBOARDS, piece("On a wall", "1", WALL, 1, 1), piece("Twin", "1", CUPBOARD_1, 2, 1, height=40.0)]
    out = tmp_path / "o.ifc"
    done = run("export", write_results(tmp_path, items), "--ifc", DUPLEX, "-o", out)
    assert done.exit_code == 1
    assert done.stdout.splitlines() == [
        "duplex.ifc: a property set Assess_OverturningRisk on 4 pieces.",
        "Not written, 1 piece whose Source ID is an IfcWall in the model, not furniture: On a wall.",
        "2 pieces that share a Source ID; the property set is that of the worse: Armadio è 1, Twin.",
    ]
    model = ifcopenshell.open(str(out))
    assert "Assess_OverturningRisk" not in get_psets(model.by_guid(WALL))
    assert read_class(out) == "very high"


@pytest.mark.slow
def test_relative_names_in_the_folder_of_the_model(results, monkeypatch):
    """As it is called most often: from the folder that holds model and results."""
    results.with_name("model.ifc").write_bytes(DUPLEX.read_bytes())
    monkeypatch.chdir(results.parent)
    done = run("export", "results.json", "--ifc", "model.ifc", "-o", "risk.ifc", "--bcf", "fix.bcfzip")
    assert (done.exit_code, done.stderr.splitlines()[-2:]) == (0, ["wrote risk.ifc", "wrote fix.bcfzip"])
    assert files(results.parent) == ["fix.bcfzip", "model.ifc", "results.json", "risk.ifc"]
    assert read_class(Path("risk.ifc")) == "very high"
    assert run("export", ".", "--ifc", "./model.ifc", "-o", "risk.ifc", "--force").exit_code == 0
    assert "model.ifc is read for this" in str(error(run("export", ".", "--ifc", "model.ifc", "-o", "./model.ifc")))


def test_the_texts_are_in_the_language_of_the_workbook(tmp_path):
    results = write_results(tmp_path, building={"building": "Casa", "language": "Italiano"})
    out = tmp_path / "o.ifc"
    assert run("export", results, "--ifc", DUPLEX, "-o", out).exit_code == 0
    assert read_class(out) == "molto alto"


# ---------------------------------------------------------------- what is refused


def refuse(results: Path, *words: object) -> str:
    """Return the message of an export that fails, prints one line and leaves the folder as it was."""
    before = {one.name: one.read_bytes() for one in results.parent.iterdir()}
    message = str(error(run("export", results, *words)))
    assert {one.name: one.read_bytes() for one in results.parent.iterdir()} == before
    return message


def test_what_cannot_be_read_leaves_the_folder_as_it_was(results):
    model, out, bcf = (results.with_name(name) for name in ("model.ifc", "o.ifc", "t.bcfzip"))
    assert "is that of an element of LargeBuilding.ifc" in refuse(results, "--ifc", OFFICE, "-o", out)
    for data, message in (
        (b"", "model.ifc .* is empty"),
        (DUPLEX.read_bytes()[: 2 * DUPLEX.stat().st_size // 3], "END-ISO-10303-21;, is missing"),
        (b"PK\x03\x04....", "packed as a zip file"),
        (b"plain text", "does not begin as an IFC file"),
    ):
        model.write_bytes(data)
        assert re.search(message, refuse(results, "--ifc", model, "-o", out, "--bcf", bcf))
    results.write_text("{}", encoding="utf-8")
    assert "results.json was not written by assess" in refuse(results, "--ifc", DUPLEX, "-o", out)


def test_a_model_that_was_exported_before(results):
    first = results.with_name("first.ifc")
    run("export", results, "--ifc", DUPLEX, "-o", first)
    message = refuse(results, "--ifc", first, "-o", results.with_name("second.ifc"))
    assert "first.ifc holds Assess_OverturningRisk already, on 4 of the pieces" in message
