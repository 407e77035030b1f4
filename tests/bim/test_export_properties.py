"""Risk classes as property sets: read back by ifcopenshell from models of which every byte is still there."""

import math
import shutil
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.validate
import pytest
from ifcopenshell.util.element import get_psets

from assess.bim.export_model import PROPERTY_SET
from assess.errors import InputError, ModelError
from tests.bim.export_runs import (
    BUILDING,
    CUPBOARD_1,
    CUPBOARDS,
    DESKS,
    DOOR_B202,
    DUPLEX,
    FLOORS,
    HELD,
    OFFICE,
    PLACES,
    ROUTES,
    SIMULATED,
    SOFA,
    export,
    piece,
    read_rows,
    write_adopted,
    write_results,
)
from tests.bim.ifc_files import ModelWriter


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    """Return the results of the cupboards, simulated: where nothing is known of the building no class is confirmed."""
    folder = tmp_path_factory.mktemp("simulated")
    return write_results(folder, settings=SIMULATED, places=PLACES, routes=ROUTES)


@pytest.fixture(scope="module")
def exported(simulated, tmp_path_factory):
    out = tmp_path_factory.mktemp("exported") / "out.ifc"
    out.write_bytes(export(simulated, DUPLEX, with_topics=False).model)
    return out


def read_sets(path: Path, name: str = PROPERTY_SET) -> dict[str, dict[str, Any]]:
    """Return the property sets of a name by the GlobalIds of the elements that have one."""
    model = ifcopenshell.open(str(path))
    sets = {one.GlobalId: get_psets(one, should_inherit=False) for one in model.by_type("IfcElement")}
    return {key: own[name] for key, own in sets.items() if name in own}


def complain(path: Path) -> list[str]:
    """Return what ifcopenshell's validation finds wrong with a model."""
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    return sorted(str(one["message"]) for one in logger.statements)


def test_every_original_byte_is_still_there(exported):
    before, after = DUPLEX.read_bytes(), exported.read_bytes()
    at = before.rindex(b"ENDSEC;")
    assert after.startswith(before[:at])
    assert after.endswith(before[at:])
    added = after[at : len(after) - len(before) + at]
    assert added.isascii()
    assert added.startswith(b"#39115=")


def test_values_stand_on_the_right_elements(simulated, exported):
    sets, rows = read_sets(exported), read_rows(simulated)
    assert sets.keys() == {one["source_id"] for one in CUPBOARDS}
    for key, found in sets.items():
        row = next(one for one in rows.values() if one["source_id"] == key)
        assert found["Item"] == row["item"]
        assert math.isclose(found["Probability"], row["adopted"]["probability"], abs_tol=0)
        assert found["Basis"] == row["adopted"]["basis"]
        assert found["PFA_g"] == row["pfa_g"]
        assert (found["Breadth_cm"], found["Height_cm"]) == (row["breadth_cm"], row["height_cm"])
        assert found["AssessedBy"].startswith("assess ")


def test_a_class_is_that_of_the_report_and_what_has_none_says_so(exported):
    sets = read_sets(exported)
    assert (sets[CUPBOARD_1]["RiskClass"], sets[CUPBOARD_1]["Basis"]) == ("very high", "simulated")
    assert sets[HELD]["RiskClass"] == "depends on its anchor (free-standing: very high)"
    assert sets[HELD]["Anchored"] == "yes"
    assert sets[SOFA]["RiskClass"] == "unconfirmed (high)", "that of the faster third of the buildings"
    assert sets[SOFA]["Basis"] == "unconfirmed"


def test_the_upper_class_stands_there_where_it_differs(simulated, exported):
    sets, differs = read_sets(exported), 0
    for row in read_rows(simulated).values():
        adopted, found = row["adopted"], sets[row["source_id"]]
        upper = adopted["class_upper"] if adopted["class_upper"] != adopted["class"] else None
        assert found.get("ClassUpper") == upper
        assert upper is None or f", could be {upper}" in found["RiskClass"]
        differs += upper is not None
    assert differs < len(sets)


def test_a_class_by_which_programs_filter_tells_what_it_could_be(simulated, tmp_path):
    """Twenty draws leave the class of one of the two open; as which one is chance, the file is edited."""
    results = write_adopted(simulated, tmp_path, {"class": "low", "class_upper": "medium", "probability": 0.0})
    out = tmp_path / "out.ifc"
    out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    sets = read_sets(out)
    assert (sets[CUPBOARD_1]["RiskClass"], sets[CUPBOARD_1]["ClassUpper"]) == ("low, could be medium", "medium")
    assert sets[HELD]["RiskClass"] == "depends on its anchor (free-standing: low, could be medium)"
    assert sets[SOFA]["RiskClass"] == "unconfirmed (low), could be medium"


def test_an_unconfirmed_class_of_the_formula_is_called_so(simulated, tmp_path):
    """Where motions may be too weak the formula's class stands; no motion here is, so that the file is edited."""
    results = write_adopted(simulated, tmp_path, {"method": "fema_p58"})
    out = tmp_path / "out.ifc"
    out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    assert read_sets(out)[SOFA]["RiskClass"] == "unconfirmed (formula: high)"


def test_an_assumed_shaking_is_called_assumed(tmp_path):
    floors = [{"floor": "1", "elevation": 0.0}, {"floor": "2", "elevation": 3.1}]
    results = write_results(tmp_path, CUPBOARDS, floors, building={"shaking": "MMI VIII, severe", "height": 6.2})
    out = tmp_path / "out.ifc"
    out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    assert read_sets(out)[CUPBOARD_1]["Scenario"] == "MMI VIII, severe (assumed)"


def test_texts_come_back_with_their_accents(exported):
    found = read_sets(exported)[CUPBOARD_1]
    assert found["Item"] == "Armadio è 1"
    assert found["Description"] == "Armadio d'angolo \\ 2 m"
    assert found["Scenario"].startswith("Forte – 475 anni 🏢")
    assert found["Report"].startswith("Palazzo Duè, building.xlsx, revision B, 2026-05-04, results.json SHA-256 ")


def test_a_piece_of_the_schedule_has_what_an_engineer_needs(exported):
    sets = read_sets(exported)
    found = sets[CUPBOARD_1]
    assert (found["MayBlockRoutes"], found["FixingDetail"]) == ("Scala", "L-bracket to studs")
    assert found["FixOrder"] in (1, 2)
    assert found["FixingTension84_kN"] > found["FixingTension_kN"] > 0
    assert found["BaseShear_kN"] > 0
    assert "FixOrder" not in sets[HELD]


def test_the_model_has_no_fault_that_it_did_not_have(exported):
    assert complain(exported) == complain(DUPLEX)
    model = ifcopenshell.open(str(exported))
    ids = [one.GlobalId for one in model.by_type("IfcRoot")]
    assert len(ids) == len(set(ids))


def test_the_owner_history_is_that_of_the_element(exported):
    model = ifcopenshell.open(str(exported))
    sets = [one for one in model.by_type("IfcPropertySet") if one.Name == PROPERTY_SET]
    assert {one.OwnerHistory.id() for one in sets} == {model.by_guid(CUPBOARD_1).OwnerHistory.id()}


def test_the_same_export_gives_the_same_bytes(simulated, exported):
    assert export(simulated, DUPLEX, with_topics=False).model == exported.read_bytes()


def test_a_model_in_millimetres_with_windows_line_ends(tmp_path):
    items = [piece(name, "1", key, x, y) for name, (key, x, y) in DESKS.items()]
    results = write_results(tmp_path, items, FLOORS[:1])
    out = tmp_path / "office.ifc"
    out.write_bytes(export(results, OFFICE, with_topics=False).model)
    sets = read_sets(out)
    assert {key: one["Item"] for key, one in sets.items()} == {key: name for name, (key, _x, _y) in DESKS.items()}
    assert {one["Breadth_cm"] for one in sets.values()} == {54.5}
    added = out.read_bytes()[OFFICE.read_bytes().rindex(b"ENDSEC;") :]
    assert added.count(b"\n") == added.count(b"\r\n")
    assert complain(out) == complain(OFFICE)


@pytest.mark.parametrize("has_owner", [True, False])
def test_an_ifc4_model_with_and_without_owner_histories(tmp_path, has_owner):
    writer = ModelWriter("IFC4")
    storey = writer.storey()
    desk = writer.piece("Desk", (0, 0, 0, 0.6, 1.2, 2.0), within=storey, at=(2, 3, 0))
    if not has_owner:
        desk.OwnerHistory = None
    model = writer.write(tmp_path / "model.ifc")
    results = write_results(tmp_path, [piece("Desk", "1", desk.GlobalId, 2, 3)], FLOORS[:1])
    out = tmp_path / "out.ifc"
    out.write_bytes(export(results, model, with_topics=False).model)
    assert read_sets(out)[desk.GlobalId]["Item"] == "Desk"
    written = ifcopenshell.open(str(out))
    (found,) = written.by_type("IfcPropertySet")
    assert (found.OwnerHistory is not None) == has_owner
    assert complain(out) == complain(model)


def test_by_formula_alone_there_is_no_interval(tmp_path):
    out = tmp_path / "out.ifc"
    results = write_results(tmp_path)
    out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    found = read_sets(out)[CUPBOARD_1]
    assert (found["Basis"], found["RiskClass"]) == ("formula", "very high")
    assert {"ProbabilityLow", "ProbabilityHigh"}.isdisjoint(found)


def test_where_others_were_simulated_a_class_by_formula_says_so(tmp_path):
    """As the simulation leaves no piece out here, the file is edited."""
    results = write_results(tmp_path, settings=SIMULATED)
    text = results.read_text(encoding="utf-8")
    results.write_text(text.replace('"basis": "simulated"', '"basis": "formula"', 1), encoding="utf-8")
    out = tmp_path / "out.ifc"
    out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    assert read_sets(out)[CUPBOARD_1]["RiskClass"] == "very high by formula only"


def test_the_texts_are_in_the_language_in_use(tmp_path):
    from assess.i18n import load_catalogue, speaking

    results = write_results(tmp_path)
    out = tmp_path / "out.ifc"
    with speaking(load_catalogue("it")):
        out.write_bytes(export(results, DUPLEX, with_topics=False).model)
    assert read_sets(out)[CUPBOARD_1]["RiskClass"] == "molto alto"


# ---------------------------------------------------------------- what cannot be written


def test_pieces_that_are_not_in_the_model_are_named(tmp_path):
    items = [
        *CUPBOARDS[:2],
        piece("No id", "1", None, 1, 1),
        piece("Stranger", "1", "0000000000000000000000", 2, 1),
        piece("Text", "1", "é 62.5'", 4, 1),
    ]
    found = export(write_results(tmp_path, items), DUPLEX, with_topics=False)
    assert (found.written, found.is_complete) == (2, False)
    assert found.without_id == ("No id",)
    assert found.missing == ("Stranger", "Text")
    out = tmp_path / "out.ifc"
    out.write_bytes(found.model)
    assert read_sets(out).keys() == {one["source_id"] for one in CUPBOARDS[:2]}


NO_PIECES = {
    "IfcWall": "2O2Fr$t4X7Zf8NOew3FKau",
    "IfcWallStandardCase": "2O2Fr$t4X7Zf8NOew3FNld",
    "IfcSlab": "2O2Fr$t4X7Zf8NOew3FK4F",
    "IfcRoof": "0jf0rYHfX3RAB3bSIRjmxl",
    "IfcCovering": "3bXiCStxP6Fgxdej$yc5T8",
    "IfcDoor": DOOR_B202,
    "IfcWindow": "1hOSvn6df7F8_7GcBWlR72",
    "IfcBeam": "2OrWItJ6zAwBNp0OUxK_l8",
    "IfcStair": "0wkEuT1wr1kOyafLY4v_O1",
    "IfcRailing": "0wkEuT1wr1kOyafLY4v_PL",
    "IfcOpeningElement": "1xS3BCk291UvhgP2dvNrrP",
    "IfcSpace": "0BTBFw6f90Nfh9rP1dlXrr",
    "IfcBuildingStorey": "1xS3BCk291UvhgP2dvNMKI",
    "IfcFurnitureType": "0wkEuT1wr1kOyafLY4vyuY",
}
"""Of Duplex, one of each."""


def test_nothing_is_written_on_what_is_no_furniture(tmp_path):
    others = [piece(name, "1", key, 1.0 + at, 1) for at, (name, key) in enumerate(NO_PIECES.items())]
    found = export(write_results(tmp_path, [*CUPBOARDS[:2], *others]), DUPLEX)
    assert (found.written, found.is_complete, found.missing) == (2, False, ())
    assert found.refused == {name: (name,) for name in NO_PIECES}
    out = tmp_path / "out.ifc"
    out.write_bytes(found.model)
    assert read_sets(out).keys() == {one["source_id"] for one in CUPBOARDS[:2]}
    assert found.topics.unplaced > 0, "entries of such pieces"


def test_a_workbook_of_walls_alone_is_refused(tmp_path):
    results = write_results(tmp_path, [piece("Wall", "1", NO_PIECES["IfcWall"], 1, 1)])
    message = r"is that of furniture in duplex.ifc: 2O2Fr\$t4X7Zf8NOew3FKau is an IfcWall. Fill in Source ID in Items"
    with pytest.raises(ModelError, match=message):
        export(results, DUPLEX)


@pytest.mark.parametrize(
    "name", ["IfcBuildingElementProxy", "IfcElementAssembly", "IfcTransportElement", "IfcFlowTerminal", "IfcTank"]
)
def test_what_an_import_takes_by_name_may_be_a_piece(tmp_path, name):
    writer = ModelWriter("IFC4")
    one = writer.element(name, "Thing", (0, 0, 0, 0.6, 1.2, 2.0), within=writer.storey(), at=(2, 3, 0))
    model = writer.write(tmp_path / "model.ifc")
    found = export(write_results(tmp_path, [piece("Thing", "1", one.GlobalId, 2, 3)], FLOORS[:1]), model)
    assert (found.written, found.is_complete) == (1, True)


@pytest.mark.slow
def test_of_two_pieces_with_one_source_id_the_worse_is_written(tmp_path):
    """The first stands on the ground floor and is low, the second very high."""
    items = [
        piece("Low", "1", CUPBOARD_1, 2.91, -11.41, height=40.0),
        piece("Tall", "2", CUPBOARD_1, 2.91, -11.41),
        CUPBOARDS[1],
    ]
    results = write_results(tmp_path, items)
    found = export(results, DUPLEX)
    assert (found.written, found.is_complete, found.repeated) == (2, False, ("Low", "Tall"))
    out = tmp_path / "out.ifc"
    out.write_bytes(found.model)
    sets = read_sets(out)
    assert (sets[CUPBOARD_1]["Item"], sets[CUPBOARD_1]["RiskClass"]) == ("Tall", "very high")
    assert sets[CUPBOARD_1]["Of"] == "2 pieces with this Source ID, the worse"
    assert "Of" not in sets[CUPBOARDS[1]["source_id"]]
    assert complain(out) == complain(DUPLEX)


def test_of_three_pieces_it_is_the_worst(tmp_path):
    items = [piece(f"C{at}", "2", CUPBOARD_1, 2.91 + at, -11.41, height=height)
             for at, height in enumerate((60.0, 200.0, 90.0))]  # fmt: skip
    out = tmp_path / "out.ifc"
    out.write_bytes(export(write_results(tmp_path, items), DUPLEX).model)
    found = read_sets(out)[CUPBOARD_1]
    assert (found["Item"], found["Of"]) == ("C1", "3 pieces with this Source ID, the worst")


def test_a_model_that_was_exported_before_is_refused(simulated, exported):
    message = r"out.ifc holds Assess_OverturningRisk already, on 4 of the pieces \(the first is M_Tall Cabinet"
    with pytest.raises(ModelError, match=message):
        export(simulated, exported)
    assert export(simulated, exported, with_properties=False).topics.count > 0


@pytest.mark.slow
def test_pieces_of_another_workbook_can_join_a_model(tmp_path):
    """Two workbooks of one building: the sets of the second join those of the first."""
    first = export(write_results(tmp_path / "a", CUPBOARDS[:2]), DUPLEX, with_topics=False)
    joined = tmp_path / "joined.ifc"
    joined.write_bytes(first.model)
    second = export(write_results(tmp_path / "b", CUPBOARDS[2:]), joined, with_topics=False)
    joined.write_bytes(second.model)
    assert len(read_sets(joined)) == 4
    assert complain(joined) == complain(DUPLEX)


def test_results_of_another_building_are_refused(tmp_path):
    items = [piece(name, "1", key, x, y) for name, (key, x, y) in DESKS.items()]
    results = write_results(tmp_path, items, FLOORS[:1])
    with pytest.raises(
        ModelError, match=r"None of the Source IDs in .*results.json is that of an element of duplex.ifc"
    ):
        export(results, DUPLEX)


def test_results_without_identifiers_are_refused(tmp_path):
    results = write_results(tmp_path, [piece("A", "1", None, 1, 1)], FLOORS[:1], building=BUILDING)
    with pytest.raises(InputError, match=r"results.json holds no Source ID"):
        export(results, DUPLEX)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "model.ifc .*is empty"),
        (b"hello", "does not begin as an IFC file"),
        (DUPLEX.read_bytes()[:-1000], "END-ISO-10303-21;, is missing"),
        (b"PK\x03\x04", "packed as a zip file"),
    ],
)
def test_a_damaged_model_is_refused(tmp_path, simulated, data, message):
    model = tmp_path / "model.ifc"
    model.write_bytes(data)
    with pytest.raises(ModelError, match=message):
        export(simulated, model)


def test_a_missing_model_is_refused(tmp_path, simulated):
    with pytest.raises(ModelError, match=r"gone.ifc cannot be read: No such file or directory"):
        export(simulated, tmp_path / "gone.ifc")


def test_a_model_under_a_name_with_accents(tmp_path, simulated):
    model = Path(shutil.copy(DUPLEX, tmp_path / "modèle è.ifc"))
    assert export(simulated, model, with_topics=False).written == 4
