"""`assess routes`: the table, the document, the CSV and the figure of one sweep, and what it says of bad input."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from matplotlib.figure import Figure

import assess
from assess.cli.command_routes import PFA
from assess.cli.curve_figures import MOST_ROUTE_PANELS, ROUTES_A_PANEL, choose_routes, paint_routes
from assess.cli.route_output import Sweep
from assess.pipeline.route_sweep import Fragility, RouteFragility
from assess.rocking.draws import Uncertainty
from assess.route_results import Chance, PieceRef
from assess.units import GRAVITY
from tests.cli.calling import run
from tests.refusals import check_refusals
from tests.shaking import write_records
from tests.workbooks import write_sheets

CORRIDOR = {"segment": "corridor", "clear_width": 1.5, "required_width": 0.9}
ROUTES = [
    {"route": "Aula", "floor": "1", **CORRIDOR},
    {"route": "=Bar", "floor": "2", **CORRIDOR},
    {"route": "Closet", "floor": "3", **CORRIDOR},
]
SHAPE = {"width": 80, "axis": "X", "edge_distance": 0}
ITEMS = [
    {"item": "a1", "floor": "1", "breadth": 40, "height": 180, "route": "Aula", **SHAPE},
    {"item": "a2", "floor": "1", "breadth": 30, "height": 170, "route": "Aula", "anchored": "yes", **SHAPE},
    {"item": "b1", "floor": "2", "breadth": 50, "height": 180, "route": "=Bar", "quantity": 2, **SHAPE},
]
FLOORS = [{"floor": "1", "record_x": "slow.csv"}, {"floor": "2", "pfa_x": 0.5}, {"floor": "3", "pfa_x": 0.5}]
SWEEP = ("--pfa", "0.1:0.9:0.2", "--runs", "20", "--seed", "3")


def write(folder: Path, **rows: Any) -> Path:
    write_records(folder, "slow")
    content = {"Building": [{"period": 1.0}], "Floors": FLOORS, "Items": ITEMS, "Routes": ROUTES, **rows}
    return write_sheets(folder / "w.xlsx", content)


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """One sweep with everything that it can write."""
    folder = tmp_path_factory.mktemp("sweep")
    path, plot, table = write(folder), folder / "f.png", folder / "t.csv"
    done = run("routes", path, *SWEEP, "--json", "--plot", plot, "--csv", table)
    assert (done.exit_code, done.exception) == (0, None)
    assert done.stderr.splitlines()[-2:] == [f"wrote {table}", f"wrote {plot}"]
    assert sorted(one.name for one in folder.iterdir()) == ["f.png", "slow.csv", "t.csv", "w.xlsx"]
    return folder, json.loads(done.stdout)


# --- what comes out ---


def test_the_document(swept):
    folder, document = swept
    assert document["workbook"]["sha256"] == assess.read_inventory(folder / "w.xlsx").sha256
    assert {"shapely", "networkx", "numba"} <= set(document["assess"]["platform"])
    asked = [0.1, 0.3, 0.5, 0.7, 0.9]
    assert document["inserted_g"] == [pfa for pfa in document["pfa_g"] if pfa not in asked]
    assert sorted({*asked, *document["inserted_g"]}) == document["pfa_g"] != asked
    aula, bar, closet = document["routes"]
    assert [one["evaluated"] for one in (aula, bar, closet)] == [True, True, False]
    assert (closet["chances"], closet["passes"]) == ([], []), "nothing tells what can reach it"
    for one in (aula, bar):
        assert [at["pfa_g"] for at in one["chances"]] == document["pfa_g"]
        assert [at["pfa_g"] for at in one["chances"] if at["inserted"]] == document["inserted_g"]
        assert all(at["low"] <= at["blocked"] <= at["high"] for at in one["chances"])
    assert aula["chances"][0]["blocked"] == bar["chances"][0]["blocked"] == 0, "0.1 g lies below B/H"
    assert aula["chances"][-1]["blocked"] > 0.5
    assert all(at["if_anchors_fail"]["blocked"] >= at["blocked"] for at in aula["chances"])
    assert {at["if_anchors_fail"] for at in bar["chances"]} == {None}
    rows = list(csv.DictReader((folder / "t.csv").read_text("utf-8-sig").splitlines()))
    assert [row["route"] for row in rows if row["route"] != "Closet"] == (
        ["Aula"] * len(document["pfa_g"]) + ["'=Bar"] * len(document["pfa_g"])
    ), "no text is taken for a formula"


@pytest.mark.parametrize(
    ("chances", "anchors", "said"),
    [
        ([0.0, 0.02], None, "The only route stays below 3 % up to 0.2 g, the largest PFA evaluated."),
        ([0.0, 0.03], None, "The only route stays below 3 % up to 0.1 g. From 0.2 g 'A' (because of 'p') reaches 3 %."),
        ([0.5, 0.0], None, "Already at 0.1 g, the smallest PFA evaluated, 'A' (because of 'p') reaches 3 %."),
        (
            [0.0, 0.0, 0.5], [0.0, 0.1, 0.6],
            "The only route stays below 3 % up to 0.2 g. From 0.3 g 'A' (because of 'p') reaches 3 %. If the anchors "
            "fail, 'A' reaches 3 % from 0.2 g.",
        ),
    ],
)  # fmt: skip
def test_what_the_verdict_says(chances, anchors, said):
    sweep = swept_with(chances, 0, anchors)
    (route,) = sweep.fragility.routes
    blamed = replace(route, causes=(PieceRef(item="p", row=2, item_index=0),))
    verdict = replace(sweep, fragility=replace(sweep.fragility, routes=(blamed,))).verdict
    assert verdict.say() == said


def test_the_verdict_of_routes_of_which_nothing_is_known():
    sweep = swept_with([0.0, 0.0], 0)
    (route,) = sweep.fragility.routes
    bare = replace(sweep, fragility=replace(sweep.fragility, routes=(replace(route, is_evaluated=False),)))
    assert bare.verdict.say() == "No route can be evaluated: the workbook places no furniture next to any."
    assert bare.verdict.below_up_to_g is None
    many = replace(sweep.fragility, routes=tuple(replace(route, route=name, doubtful=1) for name in "ABCD"))
    said = replace(sweep, fragility=many).verdict.say()
    assert said == (
        "All 4 routes stay below 3 % up to 0.2 g, the largest PFA evaluated. The chances of 'A', 'B', 'C' and 1 more "
        "are lower bounds."
    )


@pytest.mark.parametrize(("chances", "said", "judged"), [
    ([0.0, 0.02], "No route can be evaluated as a whole. Not evaluated: 'A' (segment 'stair').", False),
    (
        [0.0, 0.03],
        "The only route stays below 3 % up to 0.1 g. From 0.2 g 'A' (blocked with nothing fallen) reaches 3 %. The "
        "chances of 'A' are lower bounds. Counted without what is not evaluated: 'A' (segment 'stair').",
        True,
    ),
])  # fmt: skip
def test_a_route_is_below_the_limit_only_with_all_segments_evaluated(chances, said, judged):
    """What its other segments reach, it reaches; what they do not, the one that is not evaluated may."""
    sweep = swept_with(chances, 0)
    (route,) = sweep.fragility.routes
    part = replace(sweep, fragility=replace(sweep.fragility, routes=(replace(route, unevaluated=("stair",)),)))
    assert part.verdict.say() == said
    data = part.verdict.describe()
    assert data["not_evaluated"] == ([] if judged else ["A"])
    assert data["not_evaluated_segments"] == [{"route": "A", "segments": ["stair"]}]
    assert "without segments that are not evaluated: 'stair'" in part.to_text()


def swept_with(chances: list[float], spread: float, anchors: list[float] | None = None) -> Sweep:
    """A sweep over 0.1, 0.2, ... g of one route, with these chances and a range of this much to both sides."""

    def chance(at: float) -> Chance:
        low, high = max(at - spread, 0), min(at + spread, 1)
        return Chance(
            probability=at, low=low, high=high, joint=at, independent=at, correlated=at, runs=100, is_joint=True,
            pieces=1, unverified=0,
        )  # fmt: skip

    route = RouteFragility(
        route="A", floors=(), blocked=tuple(map(chance, chances)), scenario_pfa=(1.5, 2.5), is_evaluated=True,
        unevaluated=(), if_anchors_fail=anchors and tuple(map(chance, anchors)), doubtful=0, causes=(),
    )  # fmt: skip
    values = tuple(GRAVITY * (1 + at) / 10 for at in range(len(chances)))
    found = Fragility(
        values=values, inserted=frozenset(), limit=0.03, runs=100, seed=1, uncertainty=Uncertainty(), routes=(route,),
        generic=(), unshaped=(), weak=(), stocky=0, unplaced=0,
    )  # fmt: skip
    inventory = SimpleNamespace(file_name="w.xlsx", sha256="")
    return Sweep(cast("Any", SimpleNamespace(inventory=inventory, scenario="as filled")), found)


@pytest.mark.parametrize("chances", [[0.5], [0.0, 1.0], [0.0, 0.1, 0.9, 0.9, 0.4, 1.0]])
def test_the_figure_has_no_line_over_a_jump(chances):
    sweep = swept_with(chances, 0.05)
    figure = Figure()
    panels = [list(sweep.fragility.routes)]
    paint_routes(sweep, panels, figure)
    (axes,) = figure.axes
    steps = [
        abs(step) for line in axes.lines if line.get_linewidth() > 1 and line.get_transform() == axes.transData
        for step in np.diff(np.asarray(line.get_ydata(), dtype=float)) if line.get_linestyle() != "None"
    ]  # fmt: skip
    assert all(np.isnan(step) or step <= 0.2 for step in steps)
    (marks,) = (line for line in axes.lines if line.get_linestyle() == "None")
    assert list(marks.get_ydata()) == chances


def test_it_is_what_a_run_finds_at_the_floors_own_pfa(swept):
    folder, _ = swept
    path, settings = folder / "w.xlsx", assess.Settings(verify="all", runs=20, seed=3)
    ran = assess.run(assess.read_inventory(path), settings)
    pfa = ran.motions_of("1", "X")[0].pfa_g
    done = run("routes", path, "--pfa", f"{pfa:.12f}:{pfa:.12f}", "--runs", 20, "--seed", 3, "--json")
    (at,) = json.loads(done.stdout)["routes"][0]["chances"]
    assert ran.has_routes
    route = ran.route_tables.routes[0]
    assert route.blocked is not None
    assert (at["blocked"], at["low"], at["high"]) == (
        route.blocked.probability, route.blocked.low, route.blocked.high,
    )  # fmt: skip
    assert route.blocked_if_anchors_fail is not None
    assert at["if_anchors_fail"]["blocked"] == route.blocked_if_anchors_fail.probability
    assert 0 < at["blocked"] < 1


def test_the_figure_draws_what_can_be_blocked_eight_a_panel():
    (route,) = swept_with([0.0], 0.1).fragility.routes
    live = [replace(route, route=str(at)) for at in range(70)]
    still = list(swept_with([0.0], 0).fragility.routes)
    panels, left = choose_routes([*still, *live[:20]])
    assert ([len(one) for one in panels], left) == ([7, 7, 6], 0)
    panels, left = choose_routes(live)
    assert [len(one) for one in panels] == [ROUTES_A_PANEL] * MOST_ROUTE_PANELS
    assert left == 70 - ROUTES_A_PANEL * MOST_ROUTE_PANELS
    assert choose_routes(still) == ([still], 0)


# --- what is wrong ---


def test_values_that_are_none():
    cases = [
        ("0.1", "--pfa: '0.1' is not LOW:HIGH or LOW:HIGH:STEP in g, as 0.1:1.0 or 0.1:1.0:0.05."),
        ("a:b", "--pfa: 'a:b' is not LOW:HIGH"),
        ("0,1:1,0", "--pfa: '0,1:1,0' is not LOW:HIGH"),
        ("0.1:nan", "--pfa: '0.1:nan' is not LOW:HIGH"),
        ("-0.1:0.5", "--pfa: '-0.1:0.5' is not LOW:HIGH"),
        ("0.1:1:0.1:2", "is not LOW:HIGH"),
        ("0:1", "--pfa is 0 to 1 g, expected above 0, LOW first, and at most 5 g."),
        ("0.8:0.2", "--pfa is 0.8 to 0.2 g, expected above 0, LOW first, and at most 5 g."),
        ("0.1:5.1", "--pfa is 0.1 to 5.1 g, expected above 0"),
        ("0.1:1:0", "--pfa: the step is 0 g, expected above 0."),
        ("0.1:1.0:0.01", "--pfa: 0.1:1.0:0.01 gives over 50 values. Take a larger step."),
        ("0.1:1.0:0.000000000001", "gives over 50 values"),
    ]
    check_refusals(assess.InputError, PFA.read, [(pfa, re.escape(message)) for pfa, message in cases])


def test_values():
    for text, values in (
        ("0.1:0.35", [0.1, 0.15, 0.2, 0.25, 0.3, 0.35]),
        ("0.3:0.3", [0.3]),
        (" .1:0.22 ", [0.1, 0.15, 0.2, 0.22]),
        ("0.30:0.32:1", [0.3, 0.32]),
        ("0.1:5:0.1", [round(0.1 * at, 1) for at in range(1, 51)]),
    ):
        assert PFA.read(text) == values, text
