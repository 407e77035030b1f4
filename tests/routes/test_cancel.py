"""Progress through the routes, and a cancel in the middle of them."""

from threading import Event

import pytest

from assess.errors import CancelledError
from assess.progress import Progress, Report
from assess.routes.evaluate import evaluate_routes
from assess.routes.obstructions import find_obstructions
from assess.settings import Settings
from tests.routes.buildings import building, make_falls, piece, stretch

SEGMENTS = [stretch(f"s{at}", route=f"R{at % 3}") for at in range(12)]
ITEMS = [piece(1.5, 0.0, route=f"R{at % 3}", segment=f"s{at % 12}") for at in range(36)]
SETTINGS = Settings(runs=200)


def test_the_stage_rises_to_its_end():
    reports: list[Report] = []
    held = building(ITEMS, SEGMENTS)
    evaluate_routes(held, find_obstructions(held), make_falls([0.1] * 36), SETTINGS, progress=Progress(reports.append))
    assert {(one.stage, one.detail) for one in reports} == {("routes", "12 segments of 3 routes")}
    shares = [one.share for one in reports]
    assert shares == sorted(shares)
    assert (shares[0], shares[-1]) == (0.0, 1.0)
    assert len(reports) > 12


@pytest.mark.parametrize("after", [0, 1, 5, 13])
def test_a_cancel_stops_the_work_at_the_next_step(after):
    cancel, reports = Event(), []

    def listen(report):
        assert not cancel.is_set(), "nothing is reported after a cancel"
        reports.append(report)
        if len(reports) > after:
            cancel.set()

    held = building(ITEMS, SEGMENTS)
    with pytest.raises(CancelledError):
        evaluate_routes(
            held, find_obstructions(held), make_falls([0.1] * 36), SETTINGS, progress=Progress(listen, cancel)
        )
    assert len(reports) == after + 1


def test_a_cancel_stops_the_geometry():
    cancel = Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find_obstructions(building(ITEMS, SEGMENTS), Progress(cancel=cancel))
