"""Risk classes as property sets: read back by ifcopenshell from models of which every byte is still there."""

import math
import re
import shutil
from functools import cache
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.guid
import ifcopenshell.validate
import pytest
from hypothesis import example, given, settings, strategies as st
from ifcopenshell.util.element import get_psets

from assess.bim.export_files import LONGEST_LABEL, append_lines, make_global_id, write_label, write_real
from assess.bim.export_model import PROPERTY_SET, make_uuid
from assess.errors import InputError, ModelError
from assess.i18n import load_catalogue, speaking
from assess.text import plain_line
from tests.bim.export_runs import (
    CUPBOARD_1,
    CUPBOARD_2,
    CUPBOARDS,
    DESKS,
    DOOR_B202,
    DUPLEX,
    FLOORS,
    HELD,
    OFFICE,
    SOFA,
    export,
    piece,
    read_rows,
    write_adopted,
    write_results,
)
from tests.bim.ifc_files import ModelWriter


@pytest.fixture(scope="module")
def exported(simulated, tmp_path_factory):
    out = tmp_path_factory.mktemp("exported") / "out.ifc"
    out.write_bytes(export(simulated, DUPLEX, with_topics=False).model)
    return out


def read_exported(results: Path, model: Path) -> dict[str, dict[str, Any]]:
    """Return the property sets that an export writes, and leave the model beside the results as out.ifc."""
    out = results.with_name("out.ifc")
    out.write_bytes(export(results, model, with_topics=False).model)
    return read_sets(out)


def read_sets(path: Path, name: str = PROPERTY_SET) -> dict[str, dict[str, Any]]:
    """Return the property sets of a name by the GlobalIds of the elements that have one."""
    model = ifcopenshell.open(str(path))
    sets = {one.GlobalId: get_psets(one, should_inherit=False) for one in model.by_type("IfcElement")}
    return {key: own[name] for key, own in sets.items() if name in own}


@cache
def complain(path: Path) -> list[str]:
    """Return what ifcopenshell's validation finds wrong with a model, which stays as it is."""
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    return sorted(str(one["message"]) for one in logger.statements)


def test_every_original_byte_is_still_there_and_no_two_have_one_global_id(exported):
    before, after = DUPLEX.read_bytes(), exported.read_bytes()
    at = before.rindex(b"ENDSEC;")
    assert after.startswith(before[:at])
    assert after.endswith(before[at:])
    added = after[at : len(after) - len(before) + at]
    assert added.isascii()
    assert added.startswith(b"#39115=")
    model = ifcopenshell.open(str(exported))
    ids = [one.GlobalId for one in model.by_type("IfcRoot")]
    assert len(ids) == len(set(ids))


def test_values_classes_and_fixings_of_the_report_stand_on_the_right_elements(simulated, exported):
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
    sets, differs = read_sets(exported), 0
    assert (sets[CUPBOARD_1]["RiskClass"], sets[CUPBOARD_1]["Basis"]) == ("very high", "simulated")
    assert sets[HELD]["RiskClass"] == "depends on its anchor (free-standing: very high)"
    assert sets[HELD]["Anchored"] == "yes"
    assert sets[SOFA]["RiskClass"] == "unconfirmed (high)", "that of the faster third of the buildings"
    assert sets[SOFA]["Basis"] == "unconfirmed"
    for row in read_rows(simulated).values():
        adopted, found = row["adopted"], sets[row["source_id"]]
        upper = adopted["class_upper"] if adopted["class_upper"] != adopted["class"] else None
        assert found.get("ClassUpper") == upper
        assert upper is None or f", could be {upper}" in found["RiskClass"]
        differs += upper is not None
    assert differs < len(sets)
    sets = read_sets(exported)
    found = sets[CUPBOARD_1]
    assert (found["MayBlockRoutes"], found["FixingDetail"]) == ("Scala", "L-bracket to studs")
    assert found["FixOrder"] in (1, 2)
    assert found["FixingTension84_kN"] > found["FixingTension_kN"] > 0
    assert found["BaseShear_kN"] > 0
    assert "FixOrder" not in sets[HELD]


def test_a_class_by_which_programs_filter_tells_what_it_could_be(simulated, flat, tmp_path):
    """Twenty draws leave the class of one of the two open; as which one is chance, the file is edited."""
    results = write_adopted(simulated, tmp_path, {"class": "low", "class_upper": "medium", "probability": 0.0})
    sets = read_exported(results, flat)
    assert (sets[CUPBOARD_1]["RiskClass"], sets[CUPBOARD_1]["ClassUpper"]) == ("low, could be medium", "medium")
    assert sets[HELD]["RiskClass"] == "depends on its anchor (free-standing: low, could be medium)"
    assert sets[SOFA]["RiskClass"] == "unconfirmed (low), could be medium"


@pytest.mark.slow
def test_classes_of_the_formula_are_called_so_and_a_second_export_is_refused(simulated, flat, tmp_path):
    """Where motions may be too weak, or a piece was left out of the simulation; here none is: files are edited."""
    sets = read_exported(write_adopted(simulated, tmp_path, {"method": "fema_p58"}), flat)
    assert sets[SOFA]["RiskClass"] == "unconfirmed (formula: high)"
    accents = Path(shutil.copy(flat, tmp_path / "modèle è.ifc"))
    sets = read_exported(write_adopted(simulated, tmp_path, {"basis": "formula"}), accents)
    assert sets[CUPBOARD_1]["RiskClass"] == "very high by formula only"
    exported = tmp_path / "out.ifc"
    exported.write_bytes(export(simulated, flat, with_topics=False).model)
    message = r"out.ifc holds Assess_OverturningRisk already, on 4 of the pieces \(the first is Armadio d'angolo"
    with pytest.raises(ModelError, match=message):
        export(simulated, exported)
    assert export(simulated, exported, with_properties=False).topics.count > 0


@pytest.mark.slow
def test_by_formula_alone_there_is_no_interval_and_pieces_of_another_workbook_can_join_a_model(flat, tmp_path):
    floors = [{"floor": "1", "elevation": 0.0}, {"floor": "2", "elevation": 3.1}]
    results = write_results(tmp_path, CUPBOARDS, floors, building={"shaking": "MMI VIII, severe", "height": 6.2})
    found = read_exported(results, flat)[CUPBOARD_1]
    assert found["Scenario"] == "MMI VIII, severe (assumed)"
    assert (found["Basis"], "by formula" in found["RiskClass"]) == ("formula", False)
    assert {"ProbabilityLow", "ProbabilityHigh"}.isdisjoint(found)
    joined = tmp_path / "joined.ifc"
    joined.write_bytes(export(write_results(tmp_path / "a", CUPBOARDS[:2]), flat, with_topics=False).model)
    second = export(write_results(tmp_path / "b", CUPBOARDS[2:]), joined, with_topics=False)
    joined.write_bytes(second.model)
    assert len(read_sets(joined)) == 4
    assert complain(joined) == complain(flat)


@pytest.mark.slow
def test_texts_come_back_in_the_language_in_use_and_the_same_export_gives_the_same_bytes(simulated, exported, flat):
    found = read_sets(exported)[CUPBOARD_1]
    assert found["Item"] == "Armadio è 1"
    assert found["Description"] == "Armadio d'angolo \\ 2 m"
    assert found["Scenario"].startswith("Forte – 475 anni 🏢")
    assert found["Report"].startswith("Palazzo Duè, building.xlsx, revision B, 2026-05-04, results.json SHA-256 ")
    with speaking(load_catalogue("it")):
        assert read_exported(simulated, flat)[CUPBOARD_1]["RiskClass"] == "molto alto"
    model = ifcopenshell.open(str(exported))
    sets = [one for one in model.by_type("IfcPropertySet") if one.Name == PROPERTY_SET]
    assert {one.OwnerHistory.id() for one in sets} == {model.by_guid(CUPBOARD_1).OwnerHistory.id()}
    assert export(simulated, DUPLEX, with_topics=False).model == exported.read_bytes()


@pytest.mark.long  # the gate does the same with small models
def test_the_model_has_no_fault_that_it_did_not_have(exported):
    assert complain(exported) == complain(DUPLEX)


@pytest.mark.slow
def test_a_model_in_millimetres_with_windows_line_ends(tmp_path):
    items = [piece(name, "1", key, x, y) for name, (key, x, y) in DESKS.items()]
    sets = read_exported(write_results(tmp_path, items, FLOORS[:1]), OFFICE)
    assert {key: one["Item"] for key, one in sets.items()} == {key: name for name, (key, _x, _y) in DESKS.items()}
    assert {one["Breadth_cm"] for one in sets.values()} == {54.5}
    out = tmp_path / "out.ifc"
    added = out.read_bytes()[OFFICE.read_bytes().rindex(b"ENDSEC;") :]
    assert added.count(b"\n") == added.count(b"\r\n")
    assert complain(out) == complain(OFFICE)


@pytest.mark.parametrize("has_owner", [True, False])
@pytest.mark.slow
def test_an_ifc4_model_with_and_without_owner_histories(tmp_path, has_owner):
    writer = ModelWriter("IFC4")
    storey = writer.storey()
    desk = writer.piece("Desk", (0, 0, 0, 0.6, 1.2, 2.0), within=storey, at=(2, 3, 0))
    if not has_owner:
        desk.OwnerHistory = None
    model = writer.write(tmp_path / "model.ifc")
    results = write_results(tmp_path, [piece("Desk", "1", desk.GlobalId, 2, 3)], FLOORS[:1])
    assert read_exported(results, model)[desk.GlobalId]["Item"] == "Desk"
    out = tmp_path / "out.ifc"
    written = ifcopenshell.open(str(out))
    (found,) = written.by_type("IfcPropertySet")
    assert (found.OwnerHistory is not None) == has_owner
    assert complain(out) == complain(model)


NO_PIECES = {
    "IfcWall": "2O2Fr$t4X7Zf8NOew3FKau", "IfcWallStandardCase": "2O2Fr$t4X7Zf8NOew3FNld",
    "IfcSlab": "2O2Fr$t4X7Zf8NOew3FK4F", "IfcRoof": "0jf0rYHfX3RAB3bSIRjmxl", "IfcDoor": DOOR_B202,
    "IfcCovering": "3bXiCStxP6Fgxdej$yc5T8", "IfcWindow": "1hOSvn6df7F8_7GcBWlR72",
    "IfcBeam": "2OrWItJ6zAwBNp0OUxK_l8", "IfcStair": "0wkEuT1wr1kOyafLY4v_O1", "IfcSpace": "0BTBFw6f90Nfh9rP1dlXrr",
    "IfcRailing": "0wkEuT1wr1kOyafLY4v_PL", "IfcOpeningElement": "1xS3BCk291UvhgP2dvNrrP",
    "IfcBuildingStorey": "1xS3BCk291UvhgP2dvNMKI", "IfcFurnitureType": "0wkEuT1wr1kOyafLY4vyuY",
}  # fmt: skip
"""Of Duplex, one of each."""


@pytest.mark.slow
def test_nothing_is_written_on_what_is_no_furniture_or_not_in_the_model_unless_an_import_takes_it_by_name(tmp_path):
    others = [piece(name, "1", key, 1.0 + at, 1) for at, (name, key) in enumerate(NO_PIECES.items())]
    others += [
        piece("No id", "1", None, 1, 1),
        piece("Stranger", "1", "0" * 22, 2, 1),
        piece("Text", "1", "é 62.5'", 4, 1),
    ]
    found = export(write_results(tmp_path, [*CUPBOARDS[:2], *others]), DUPLEX)
    assert (found.written, found.is_complete) == (2, False)
    assert (found.without_id, found.missing) == (("No id",), ("Stranger", "Text"))
    assert found.refused == {name: (name,) for name in NO_PIECES}
    out = tmp_path / "out.ifc"
    out.write_bytes(found.model)
    assert read_sets(out).keys() == {one["source_id"] for one in CUPBOARDS[:2]}
    assert found.topics.unplaced > 0, "entries of such pieces"
    writer = ModelWriter("IFC4")
    storey = writer.storey()
    items: list[dict[str, Any]] = []
    for name in ("BuildingElementProxy", "ElementAssembly", "TransportElement", "FlowTerminal", "Tank"):
        one = writer.element(f"Ifc{name}", name, (0, 0, 0, 0.6, 1.2, 2.0), within=storey, at=(2, 3, 0))
        items.append(piece(name, "1", one.GlobalId, 2 + len(items), 3))
    found = export(write_results(tmp_path, items, FLOORS[:1]), writer.write(tmp_path / "model.ifc"))
    assert (found.written, found.is_complete) == (5, True)


@pytest.mark.slow
def test_of_pieces_with_one_source_id_the_worst_is_written(flat, tmp_path):
    """The first stands on the ground floor and is low, the second very high; of another key there are three."""
    items = [
        piece("Low", "1", CUPBOARD_1, 2.91, -11.41, height=40.0),
        piece("Tall", "2", CUPBOARD_1, 2.91, -11.41),
        *(piece(f"C{at}", "2", CUPBOARD_2, 2.91 + at, -11.41, height=height)
          for at, height in enumerate((60.0, 200.0, 90.0))),
        CUPBOARDS[2],
    ]  # fmt: skip
    results = write_results(tmp_path, items)
    found = export(results, flat)
    assert (found.written, found.is_complete, found.repeated) == (3, False, ("Low", "Tall", "C0", "C1", "C2"))
    sets = read_exported(results, flat)
    assert (sets[CUPBOARD_1]["Item"], sets[CUPBOARD_1]["RiskClass"]) == ("Tall", "very high")
    assert sets[CUPBOARD_1]["Of"] == "2 pieces with this Source ID, the worse"
    assert (sets[CUPBOARD_2]["Item"], sets[CUPBOARD_2]["Of"]) == ("C1", "3 pieces with this Source ID, the worst")
    assert "Of" not in sets[HELD]
    assert complain(tmp_path / "out.ifc") == complain(flat)


@pytest.mark.slow
def test_results_that_are_not_of_this_model_are_refused(tmp_path):
    desks = [piece(name, "1", key, x, y) for name, (key, x, y) in DESKS.items()]
    for items, error, message in (
        ([piece("Wall", "1", NO_PIECES["IfcWall"], 1, 1)], ModelError,
         r"is that of furniture in duplex.ifc: 2O2Fr\$t4X7Zf8NOew3FKau is an IfcWall. Fill in Source ID in Items"),
        (desks, ModelError, r"None of the Source IDs in .*results.json is that of an element of duplex.ifc"),
        ([piece("A", "1", None, 1, 1)], InputError, r"results.json holds no Source ID"),
    ):  # fmt: skip
        with pytest.raises(error, match=message):
            export(write_results(tmp_path, items, FLOORS[:1]), DUPLEX)


def test_a_damaged_or_missing_model_is_refused(tmp_path, simulated):
    model = tmp_path / "model.ifc"
    for data, message in (
        (b"", "model.ifc .*is empty"), (b"hello", "does not begin as an IFC file"),
        (DUPLEX.read_bytes()[:-1000], "END-ISO-10303-21;, is missing"), (b"PK\x03\x04", "packed as a zip file"),
    ):  # fmt: skip
        model.write_bytes(data)
        with pytest.raises(ModelError, match=message):
            export(simulated, model)
    with pytest.raises(ModelError, match=r"gone.ifc cannot be read: No such file or directory"):
        export(simulated, tmp_path / "gone.ifc")


MODEL = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=IFCLABEL('ENDSEC;');\nENDSEC;\nEND-ISO-10303-21;\n"


def read_back(value: str) -> Any:
    header = "HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('IFC4'));ENDSEC;"
    model = ifcopenshell.file.from_string(
        f"ISO-10303-21;{header}DATA;#1=IFCPROPERTYSINGLEVALUE('N',$,{value},$);ENDSEC;END-ISO-10303-21;"
    )
    return model.by_id(1).NominalValue.wrappedValue


@settings(max_examples=40)
@given(st.text(st.characters(codec="utf-8"), max_size=40))
@example("d'angolo a\\b perché – è é🏢é\ntwo\x07")
def test_every_text_comes_back_from_ascii_on_one_line(text):
    written = write_label(text)
    assert written.isascii()
    assert "\n" not in written
    assert read_back(written) == plain_line(text)


def test_a_label_is_no_longer_than_the_schema_allows_and_identifiers_are_those_of_their_numbers():
    value = read_back(write_label("è" * 300))
    assert (len(value), value[-2:]) == (LONGEST_LABEL, "è…")
    for at in range(50):
        found = make_global_id("property set", str(at))
        assert ifcopenshell.guid.expand(found) == make_uuid("property set", str(at)).hex
        assert (len(found), found[0] in "0123") == (22, True)
    assert make_global_id("a", "b") == make_global_id("a", "b") != make_global_id("a", "c")
    assert make_global_id("a", "b") != make_global_id("b", "a")


@settings(max_examples=40)
@given(st.floats(min_value=-1e12, max_value=1e12))
def test_every_number_comes_back(number):
    text = write_real(number)
    assert re.fullmatch(r"IFCREAL\(-?\d+\.\d*(E-?\d+)?\)", text)
    assert read_back(text) == number


def test_lines_stand_before_the_last_endsec_and_a_file_with_another_end_is_refused():
    for end in ("\n", "\r\n"):
        data = MODEL.replace(b"\n", end.encode())
        found = append_lines(data, ["#2=A();", "#3=B();"], "m.ifc")
        before, after = data[: data.rindex(b"ENDSEC;")], data[data.rindex(b"ENDSEC;") :]
        assert found == before + f"#2=A();{end}#3=B();{end}".encode() + after, end
    data = b"ISO-10303-21;HEADER;ENDSEC;DATA;#1=A();ENDSEC ;/* a **remark** */ END-ISO-10303-21;"
    found = append_lines(data, ["#2=B();"], "m.ifc")
    assert found == data.replace(b"ENDSEC ;", b"\n#2=B();\nENDSEC ;")
    for last in (b"", b"ENDSEC;\n", b"END-ISO-10303-21;\n", b"ENDSEC;\n#9=A();\nEND-ISO-10303-21;\n"):
        with pytest.raises(ModelError, match=r"m.ifc does not end as an IFC file does"):
            append_lines(b"ISO-10303-21;\nDATA;\n#1=A();\n" + last, ["#2=B();"], "m.ifc")
