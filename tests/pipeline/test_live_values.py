"""The live columns' stored values, from assessments."""

from dataclasses import replace

import pytest

from assess.pipeline.live_values import live_values, with_live
from assess.pipeline.run import compute
from assess.risk import RiskClass
from assess.settings import Settings
from assess.units import GRAVITY
from assess.workbook.formulas import LIVE_METHODS, say_class
from assess.workbook.lists import RUN_ASSESS
from assess.workbook.read import read_inventory
from assess.workbook.template import Content, write_workbook

RECORD = "time [s],acceleration [g]\n" + "".join(f"{at * 0.01:.2f},{0.2 * (-1) ** at}\n" for at in range(400))
ITEMS = [
    {"item": "a", "floor": "1", "breadth": 40, "height": 180, "axis": "X"},
    {"item": "b", "floor": "1", "breadth": 40, "height": 180, "axis": "Y"},
    {"item": "c", "floor": "1", "breadth": 40, "height": 180},
    {"item": "d", "floor": "2", "breadth": 90, "height": 180, "anchored": "yes"},
    {"item": "e", "floor": "2", "breadth": 90, "height": 180, "anchored": "partly"},
]
CONTENT = Content(
    {
        "Floors": [{"floor": "1", "record_x": "x.csv", "pfa_y": 0.4, "pfv_y": 30}, {"floor": "2", "pfa_x": 0.3}],
        "Items": ITEMS,
    }
)


def test_a_record_on_any_axis_of_a_piece_asks_for_a_run(tmp_path):
    (tmp_path / "x.csv").write_text(RECORD, encoding="utf-8")
    along_x, along_y, both, anchored, partly = with_live(CONTENT, folder=tmp_path).live
    assert along_x[1:] == both[1:] == [RUN_ASSESS] * 7
    assert along_x[0] == along_y[0] == pytest.approx(40 / 180)
    assert along_y[1] == pytest.approx(0.4)
    assert along_y[5:7] == ["◇ medium", "■ very high"]
    assert anchored[5:7] == ["anchored"] * 2
    assert partly[6] == "◇ medium*", "outside the checked range, and classed as free-standing"
    assert anchored[:5] == partly[:5]


def test_what_no_formula_knows_asks_for_a_run(tmp_path):
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.4}, {"floor": "2", "elevation": 4}]
    content = Content({"Floors": floors, "Items": ITEMS, "Building": [{"ground_pga": 0.2}]})
    assert [row[1] for row in with_live(content).live] == [pytest.approx(0.4)] * 3 + [RUN_ASSESS] * 2
    by_code = replace(content, rows={**content.rows, "Building": [{"ground_pga": 0.2, "scenario_kind": "NTC 2018"}]})
    unknown = [RUN_ASSESS] * 7
    anchored = [*unknown[:4], "anchored", "anchored", RUN_ASSESS]
    assert [row[1:] for row in with_live(by_code).live] == [unknown, unknown, unknown, anchored, unknown]


@pytest.mark.slow
def test_they_are_the_results_of_the_run(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.3, "pfa_y": 0.4, "pfv_x": 30}, {"floor": "2", "pfa_x": 0.3, "pfv_x": 9}]
    path = tmp_path / "book.xlsx"
    write_workbook(path, Content({"Floors": floors, "Items": ITEMS, "Building": [{"period": 0.8}]}))
    inventory = read_inventory(path)
    run = compute(inventory, Settings(verify="none"))
    for item, one, values in zip(inventory.items, run.governing, live_values(inventory), strict=True):
        assert values[1] == run.cases.pfa[one] / GRAVITY
        assert values[2:-3] == [run.outcomes[method.key].value[one] for method in LIVE_METHODS]
        assert values[-1] == ("yes" if run.adoption.can_rock[one] else "no")
        risk = say_class(RiskClass(run.adoption.risk[one]))
        assert values[-3].startswith("anchored" if item.anchored == "yes" else risk)
