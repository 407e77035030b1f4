import json

import jsonschema
import pytest

from assess.report.data import SCHEMA, write_json
from docs.results_schema import build_schema
from tests.workbooks import ITEMS, assessed


@pytest.mark.slow
def test_results_follow_their_schema_which_refuses_an_unknown_field_and_a_probability_above_one(tmp_path):
    run = assessed(tmp_path / "w.xlsx", period=0.9, building="Hall", scenario="A test")
    write_json(run, tmp_path / "results.json")
    text = (tmp_path / "results.json").read_text(encoding="utf-8")
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(json.loads(text), schema)
    wrong = json.loads(text)
    wrong["items"][0]["adopted"]["probability"] = 1.2
    with pytest.raises(jsonschema.ValidationError, match=r"1\.2"):
        jsonschema.validate(wrong, schema)
    wrong = json.loads(text) | {"more": 1}
    with pytest.raises(jsonschema.ValidationError, match="more"):
        jsonschema.validate(wrong, schema)


def test_the_schema_is_that_of_the_fields_and_rows_and_knows_their_limits():
    assert json.loads(SCHEMA.read_text(encoding="utf-8")) == build_schema(), "run: make docs"
    definitions = build_schema()["$defs"]
    chance, segment = definitions["chance"]["properties"], definitions["segment"]["properties"]
    assert chance["probability"] == {"type": "number", "minimum": 0, "maximum": 1,
                                     "description": chance["probability"]["description"]}  # fmt: skip
    assert chance["probability"]["description"].startswith("From the joint outcomes")
    assert {"from", "to"} <= set(segment)
    assert not {"from_place", "workbook_row", "extends_start_m"} & set(segment)
    assert "minimum" in segment["length_m"]
    assert "minimum" not in segment["start_x_m"]
    assert definitions["item"]["properties"]["friction"]["type"] == ["number", "null"]
    text = "Draws of an earthquake like this one and of the piece, a motion each, that it was simulated under."
    assert definitions["verification"]["properties"]["runs"] == {
        "type": "integer", "minimum": 0, "description": text,
    }  # fmt: skip


def test_the_larger_pfa_governs_by_the_paper_sizes_carry_no_binary_noise_and_every_pfv_is_a_number(tmp_path):
    run = assessed(tmp_path / "w.xlsx", class_by="proposed OR")
    write_json(run, tmp_path / "r.json")
    first = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))["items"][0]
    assert (first["axis"], first["pfa_g"], first["pfv_cm_s"]) == ("X", 0.3, 30.0)
    assert first["adopted"]["probability"] == first["methods"]["proposed_or"]["value"]
    sizes = [29, 32.1, 47.2, 57, 58, 113.3]
    items = [{"item": str(at), "floor": "1", "breadth": size, "height": 206.4} for at, size in enumerate(sizes)]
    run = assessed(tmp_path / "w.xlsx", items)
    assert [one.item.breadth_cm for one in run] == sizes
    run = assessed(tmp_path / "w.xlsx", ITEMS, [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_y": 0.3}])
    write_json(run, tmp_path / "r.json")
    found = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"), parse_constant=pytest.fail)
    demands = [one for floor in found["floors"] for one in floor["demands"]]
    assert all(one["pfv_follows"] and one["pfv_cm_s"] > 0 for one in demands)
    assert found["items"][0]["pfv_cm_s"] == demands[0]["pfv_cm_s"]
    assert found["items"][0]["methods"]["fema_p58"]["value"] is not None
    assert "pfv_unknown" not in found["items"][0]["methods"]["fema_p58"]["flags"]
