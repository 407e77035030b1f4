"""The evacuation routes in results.json: every number is that of the run, and the schema holds."""

import json
from dataclasses import asdict

import jsonschema
import pytest

from assess.report.data import SCHEMA, write_json
from assess.settings import Settings
from tests.report.routed import KNOWN, assess_routed

VERIFIED = Settings(verify="all", runs=20, route_risk=0.1)


@pytest.fixture(scope="module", params=["formulas", "verified"])
def written(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("routes")
    more = {"settings": VERIFIED, **KNOWN} if request.param == "verified" else {}
    run = assess_routed(folder / "w.xlsx", **more)
    write_json(run, folder / "r.json")
    text = (folder / "r.json").read_text(encoding="utf-8")
    return run, json.loads(text, parse_constant=pytest.fail)


def _schema():
    return json.loads(SCHEMA.read_text(encoding="utf-8"))


def test_the_schema_holds(written):
    jsonschema.validate(written[1], _schema())


WRONG = [
    (("risk",), 0),
    (("segments", 0, "state"), "shut"),
    (("segments", 0, "blocked", "probability"), 1.1),
    (("segments", 0, "blocked"), None),
    (("segments", 0, "state"), "not evaluated"),
    (("segments", 0, "evaluated"), False),
    (("segments", 1, "state"), "reduced"),
    (("segments", 1, "missing"), ["Clear width"]),
    (("routes", 0, "evaluated"), False),
    (("routes", 0, "unevaluated_segments"), [1]),
    (("rooms", 0, "ways", 0, "shared"), None),
    (("uncounted_pieces",), -1),
    (("routes", 0, "fixes", 0, "row"), 0),
    (("routes", 0, "segments"), [-1]),
    (("rooms", 0, "ways", 0, "more"), 1),
    (("floors", 0, "blocked_routes_expected"), -0.1),
]


def test_the_schema_refuses(written):
    validator, taken = jsonschema.Draft202012Validator(_schema()), []
    for path, wrong in WRONG:
        found = json.loads(json.dumps(written[1]))
        at = found["routes"]
        for key in path[:-1]:
            at = at[key]
        at[path[-1]] = wrong
        taken += [(path, wrong)] * validator.is_valid(found)
    assert taken == []


def test_the_document_is_that_of_the_rows(written):
    """Each value under its own name, but for places, and what only joins tables, or draws the plan."""
    routes, found = written[0].route_tables, written[1]["routes"]
    assert found == routes.to_record()
    assert found["risk"] == routes.risk == written[0].settings.route_risk
    assert routes.uncounted_pieces == sum(one.uncounted_pieces for one in routes.floors)
    for row, one in zip(found["routes"], routes.routes, strict=True):
        assert row["blocked"] == asdict(one.blocked)
        assert row["segments"] == list(one.segment_indices)
        piece = one.most_likely_piece
        assert row["most_likely_piece"] == (piece and {"item": piece.item, "row": piece.row})
    assert set(found["segments"][0]["blocked"]) == {
        "probability", "low", "high", "joint", "independent", "correlated", "runs", "is_joint", "pieces", "unverified",
        "unconfirmed",
    }  # fmt: skip


def test_rows_join_the_other_tables(written):
    run = written[0]
    items, routes = run.item_rows, run.route_tables
    named = [*(piece for one in routes.segments for piece in (*one.pieces, *one.other_rooms)),
             *(fix for one in routes.routes for fix in one.fixes),
             *filter(None, (one.most_likely_piece for one in (*routes.segments, *routes.rooms)))]  # fmt: skip
    assert {one.item for one in named} >= {"tall", "held"}
    for one in named:
        assert (one.item, one.row) == (items[one.item_index].item, items[one.item_index].row)
    for one in routes.routes:
        assert {routes.segments[at].route for at in one.segment_indices} == {one.route}
    for room in routes.rooms:
        assert room.unevaluated_segments == tuple(routes.segments[at].segment for at in room.unevaluated_indices)
