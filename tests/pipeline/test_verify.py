"""The simulation of chosen pieces: what it reports, how it is cancelled, and how many results it refuses."""

import threading

import pytest

from assess.errors import CancelledError, InputError
from assess.model import Inventory
from assess.pipeline import verify as verification
from assess.pipeline.run import compute
from assess.progress import Progress, Report
from assess.settings import Settings
from assess.workbook.read import read_inventory

FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 40}, {"floor": "2", "pfa_x": 0.4, "pfv_x": 60}]
ITEMS = [
    {"item": f"{floor}-{breadth}", "floor": floor, "axis": "X", "breadth": breadth, "width": 60, "height": 180}
    for floor in "12"
    for breadth in (30, 40, 50)
]


@pytest.fixture
def inventory() -> Inventory:
    return read_inventory({"Floors": FLOORS, "Items": ITEMS})


def test_it_reports_one_stage_with_what_is_simulated(inventory):
    """Rows are counted, whatever their quantity; nothing to simulate is no stage."""
    several = read_inventory({"Floors": FLOORS, "Items": [one | {"quantity": 3} for one in ITEMS]})
    for given, verify, details in (
        (inventory, "all", {"6 rows on 2 floors"}),
        (several, "all", {"6 rows on 2 floors"}),
        (inventory, "none", set()),
    ):
        reports: list[Report] = []
        compute(given, Settings(verify=verify, runs=4), progress=Progress(reports.append))
        own = [one for one in reports if one.stage == "verification"]
        assert {one.detail for one in own} == details
        shares = [one.share for one in own]
        assert shares == sorted(shares)
        assert {0.0, 1.0} <= set(shares) or not details


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_cancel_ends_it_while_motions_are_made(inventory, jobs):
    """The cancel comes with the first report, long before the first motions are made, and no work follows."""
    cancel, reports = threading.Event(), []

    def listen(report):
        reports.append(report)
        if report.stage == "verification":
            cancel.set()

    with pytest.raises(CancelledError):
        compute(inventory, Settings(verify="all", runs=100_000), jobs=jobs, progress=Progress(listen, cancel))
    assert reports[-1].stage == "verification"
    assert reports[-1].share == 0.0


def test_more_results_than_the_memory_holds_are_refused(inventory, monkeypatch):
    monkeypatch.setattr(verification, "MOST_PAIRS", 100)
    with pytest.raises(InputError, match=r"runs is 101: 606 results .* expected at most 100\. Use fewer motions"):
        compute(inventory, Settings(verify="all", runs=101))
