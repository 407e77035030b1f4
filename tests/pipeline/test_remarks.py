"""What a run remarks on the motion of the floors: at which place, and whether as a warning or as a note."""

import pytest

from assess.pipeline.run import compute
from assess.settings import Settings
from tests.pipeline.rows import read
from tests.workbooks import RECORDS

PIECE = [{"item": "a", "floor": "1", "breadth": 40, "height": 180}]
RECORDED = [{"floor": "1", "record_x": "0165a_u.smc"}]
"""Its treated PFA is 0.271 g, its PFV 22.7 cm/s."""
GROUND = {"ground_pga": 0.2, "ground_pgv": 20}
CODE = "Building SDS: SDS is used for the code's force on anchors only: "


def floor(elevation=None, **more):
    return [{"floor": "1", "elevation": elevation, **more}]


def by_storeys(storeys):
    return floor(27), None, {**GROUND, "height": 30, "storeys": storeys}


def by_period(period, scenario=None):
    return floor(16), scenario, {**GROUND, "period": period}


def by_code(pga):
    return (
        [{**RECORDED[0], "elevation": 0, "pfa_y": 0.4, "pfv_y": 40}], "ASCE 7-22",
        {"ground_pga": pga, "ground_pgv": 100 * pga, "period": 0.2},
    )  # fmt: skip


PERIOD = "Building Period T1: Period T1 {:g} s is outside 0.117 to 1.56 s, 0.3 to 4 times 0.0488 h^0.75"
STOREYS = "Building Height: Height 30 m over {} is {} m a storey, outside 2.5 to 6 m."
FAR = "Building Height: z/h is taken against Height 131 m; the highest floor listed is at 36 m."
UNKNOWN = "floor 1: neither T1, Height, Storeys nor an Elevation is known, so that buildings of every period"


@pytest.mark.parametrize(
    ("case", "expected"),
    [
        ((floor(3, pfa_x=0.3), None, {}), {}),
        ((floor(3, pfa_x=0.3, pfv_x=30), None, {"height": 300, "storeys": 2, "period": 15}), {}),  # of no floor
        (  # what a code's profile sets aside: a warning where it is the stronger
            by_code(0.01),
            {
                "Floors row 1 Record X: Record X of floor '1' is not used: its PFA is 0.271 g, the": "warning",
                "Floors row 1 PFA Y: PFA Y 0.400 g of floor '1' is not used: the scenario 'ASCE 7-22'": "warning",
                "Floors row 1 PFV Y: PFV Y 40.0 cm/s of floor '1' is not used: the scenario 'ASCE 7-22'": "warning",
            },
        ),
        (
            by_code(0.9),
            {
                "Floors row 1 Record X: Record X of floor '1' is not used": "note",
                "Floors row 1 PFA Y: PFA Y 0.400 g of floor '1' is not used": "note",
                "Floors row 1 PFV Y: PFV Y 40.0 cm/s of floor '1' is not used": "note",
            },
        ),
        (
            ([{**RECORDED[0], "pfa_x": 0.02}], "given", {"period": 1, "height": 9}),
            {"Record X of floor '1' is not used: its PFA is 0.271 g, the scenario 'given' uses 0.020 g": "warning",
             "floor 1: its height in the building is not known and is drawn": "warning"},
        ),
        (
            ([{**RECORDED[0], "pfa_x": 0.02}], "recorded", {}),
            {"PFA X 0.020 g of floor '1' is not used: the record is used, with 0.271 g": "note"},
        ),
        (
            ([{**RECORDED[0], "pfv_x": 300}], None, {}),
            {"PFV X 300.0 cm/s of floor '1' is not used: the record is used, with 22.7 cm/s": "warning"},
        ),
        *(  # ground motion that no floor needs
            ((RECORDED, scenario, {**GROUND, "sds": 0.5}),
             {f"Building Ground PGA: Ground PGA is not used: {why}.": "note",
              "Building Ground PGV: Ground PGV is not used: every floor has a record.": "note",
              f"{CODE}{why}.": "note"})
            for scenario, why in ((None, "every floor has a record"), ("recorded", "scenario 'recorded'"))
        ),
        (
            (RECORDED, None, {"ground_pga": 0.2}),
            {"Ground PGA is used for the code's force on anchors only: every floor has a record.": "note"},
        ),
        *(((floor(**motion), None, GROUND), {UNKNOWN: "warning"}) for motion in ({"pfa_x": 0.3}, {})),
        ((floor(), None, {**GROUND, "period": 1}), {"floor 1: its height in the building is not known": "warning"}),
        ((floor(3), None, {**GROUND, "sds": 0.503}), {}),  # 0.4 x 0.503 = 0.2012 differs from 0.2 by 0.6 %
        ((floor(3), None, {**GROUND, "sds": 0.6}), {f"{CODE}0.4 SDS is 0.240 g, but floors follow": "warning"}),
        ((floor(3), None, {**GROUND, "sds": 0.4}), {f"{CODE}0.4 SDS is 0.160 g, but floors follow": "note"}),
        ((floor(12), None, {**GROUND, "height": 10}), {"Elevation 12 m is above the roof, 10 m": "warning"}),
        ((floor(12), None, {**GROUND, "height": 12}), {}),
        (([*floor(-3), {"floor": "B2", "elevation": -6}], None, GROUND), {}),  # of basements none is above the roof
        (by_storeys(1), {STOREYS.format("1 storey", 30): "warning"}),
        (by_storeys(4), {STOREYS.format("4 storeys", 7.5): "warning"}),
        (by_storeys(15), {STOREYS.format("15 storeys", 2): "warning"}),
        *((by_storeys(fits), {}) for fits in (5, 12, None)),
        ((floor(36), None, {**GROUND, "height": 131}), {FAR: "note"}),
        ((floor(36), None, {**GROUND, "height": 54}), {}),
        *((by_period(odd, of), {PERIOD.format(odd): "warning"}) for odd in (0.1, 1.6) for of in (None, "ASCE 7-22")),
        *((by_period(fits), {}) for fits in (0.12, 1.5)),  # 0.0488 x 16^0.75 = 0.3904 s
        (
            ([{**RECORDED[0], "elevation": 0}, {"floor": "2", "elevation": 4},
              {"floor": "3", "elevation": 8, "pfa_x": 0.1}, {"floor": "4", "elevation": 12}], None, GROUND),
            {"mixed sources: recorded motion (1); given peaks (3); drawn buildings on the ground motion (2, 4)": "note",
             "Ground PGA is used for the code's force on anchors only: the motion at grade is known.": "note",
             "Ground PGV is not used: the motion at grade is known.": "note"},
        ),
    ],
)  # fmt: skip
def test_what_is_remarked_on(case, expected):
    floors, scenario, building = case
    inventory = read(PIECE, floors, RECORDS, **building)
    problems = compute(inventory, Settings(scenario=scenario, verify="none")).problems
    remarks = {str(one): one.severity for one in problems if one not in inventory.problems}
    assert len(remarks) == len(expected), remarks
    for text, severity in expected.items():
        assert [kind for one, kind in remarks.items() if text in one] == [severity], remarks
