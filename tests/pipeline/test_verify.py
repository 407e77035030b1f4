"""The simulation of chosen pieces: what it reports, how it is cancelled, and how many results it refuses."""

import threading

import pytest

from assess.errors import CancelledError, InputError
from assess.model import Inventory
from assess.pipeline import verify as verification
from assess.pipeline.run import compute
from assess.progress import Progress, Report
from assess.settings import CPU_QUOTA, Settings, count_processors
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
    reports: list[Report] = []
    compute(inventory, Settings(verify="all", runs=4), progress=Progress(reports.append))
    own = [one for one in reports if one.stage == "verification"]
    assert {one.detail for one in own} == {"6 rows on 2 floors"}
    assert [own[0].share, own[-1].share] == [0.0, 1.0]
    assert [one.share for one in own] == sorted(one.share for one in own)


def test_rows_are_counted_whatever_their_quantity():
    reports: list[Report] = []
    several = read_inventory({"Floors": FLOORS, "Items": [one | {"quantity": 3} for one in ITEMS]})
    compute(several, Settings(verify="all", runs=4), progress=Progress(reports.append))
    assert {one.detail for one in reports if one.stage == "verification"} == {"6 rows on 2 floors"}


def test_nothing_to_simulate_is_no_stage(inventory):
    reports: list[Report] = []
    compute(inventory, Settings(verify="none"), progress=Progress(reports.append))
    assert not any(one.stage == "verification" for one in reports)


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


def test_processors_are_limited_by_the_quota_of_a_container(tmp_path, monkeypatch):
    quota = tmp_path / "cpu.max"
    monkeypatch.setattr("assess.settings.CPU_QUOTA", quota)
    every = count_processors()
    assert every >= 1
    for text, expected in (("50000 100000", 1), ("150000 100000", min(2, every)), ("max 100000", every), ("", every)):
        quota.write_text(text, encoding="ascii")
        assert count_processors() == expected
    assert CPU_QUOTA.name == "cpu.max"
