import json

import jsonschema
import pytest

from assess.report.data import SCHEMA, write_json
from assess.report.results_schema import build_schema
from tests.workbooks import assessed


@pytest.fixture
def results(tmp_path):
    run = assessed(tmp_path / "w.xlsx", period=0.9, building="Hall", scenario="A test")
    write_json(run, tmp_path / "results.json")
    return run, json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_results_follow_their_schema(results):
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(results[1], schema)


def test_the_schema_is_that_of_the_fields_and_rows():
    assert json.loads(SCHEMA.read_text(encoding="utf-8")) == build_schema(), "run: make docs"
