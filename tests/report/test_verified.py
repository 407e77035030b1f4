"""What the reports say of runs that are simulated, partly simulated, or not."""

import base64
import re
import shutil
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import assess
from assess.motion.record import Motion
from assess.motion.suite import Suite
from assess.pipeline import ensembles
from assess.report import words
from assess.report.content import Content
from assess.report.say.simulation import describe_trials, list_misfits
from assess.risk import RiskClass, classify
from assess.settings import Settings
from assess.units import GRAVITY
from tests.report.reading import write_html
from tests.shaking import write_records
from tests.workbooks import RECORDS, write

SCRIPT = "<b>$x$</b>"
FLOORS = [{"floor": "1", "pfa_x": 0.2, "pfv_x": 40}, {"floor": "2", "pfa_x": 0.15, "pfv_x": 30}]
ITEMS = [
    {"item": SCRIPT, "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 1, "axis": "X"},
    {"item": "twin", "floor": "1", "breadth": 30, "width": 80, "height": 200, "x": 1, "y": 3, "axis": "X",
     "quantity": 1},
    {"item": "fixed", "floor": "1", "breadth": 30, "width": 80, "height": 200, "anchored": "yes"},
    {"item": "stout", "floor": "2", "breadth": 60, "width": 60, "height": 200, "axis": "X", "quantity": 4},
    {"item": "cube", "floor": "2", "breadth": 90, "width": 90, "height": 60},
]  # fmt: skip

GROUND = "a record of the ground on a floor of Elevation 0"
CERTAIN = {"motion_uncertainty": 0, "piece_uncertainty": "no"}
"""Of the building: nothing is drawn, so that it is known which of the pulses overturn a piece."""


def _pulses(*peaks):
    """Return a suite of five waves of 1 s each [g]."""
    times = np.arange(0, 8, 0.01)
    wave = np.where(times < 5, np.sin(2 * np.pi * times), 0.0)
    motions = []
    for at, peak in enumerate(peaks):
        acceleration = peak * GRAVITY * wave
        velocity = np.cumsum(acceleration) * 0.01
        motions.append((f"m{at}.csv", Motion(acceleration, velocity, np.cumsum(velocity) * 0.01, 0.01)))
    return Suite("ours", tuple(motions), {})


def _assess(folder, peaks, items=ITEMS, floors=FLOORS, building=(), **settings):
    inventory = assess.read_inventory(write(folder / "w.xlsx", items, floors, **CERTAIN | dict(building)))
    with pytest.MonkeyPatch.context() as patch:  # weak motions may lower classes here, to show how that looks
        patch.setattr(ensembles, "WEAK_PFA", 0.0)
        patch.setattr(ensembles, "WEAK_PFV", 0.0)
        return assess.run(inventory, Settings(**settings), suite=_pulses(*peaks), jobs=1)


def _figures(html):
    """Return the SVG figures of the section Verification."""
    part = html[html.index('<section id="verification"') :]
    found = re.findall(r'<img src="data:image/svg\+xml;base64,([^"]+)"', part[: part.index("</section>")])
    return [ET.fromstring(base64.b64decode(one)) for one in found]


def _ids(figure, name):
    return [one for one in figure.iter() if one.get("id", "") == name]


@pytest.fixture(scope="module")
def some(tmp_path_factory):
    """All simulated; of 40 motions 10 overturn the slender pieces."""
    return _assess(tmp_path_factory.mktemp("some"), [1.0] * 10 + [0.1] * 30, ITEMS[:4], verify="all")


@pytest.fixture(scope="module")
def assumed(tmp_path_factory):
    """One floor with peaks alone, of a building of which nothing is known."""
    path = write(tmp_path_factory.mktemp("assumed") / "w.xlsx", ITEMS[:1], FLOORS[:1], restitution=0.9)
    return assess.run(assess.read_inventory(path), Settings(runs=20), jobs=1)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """One floor with a record, with generated motions."""
    folder = tmp_path_factory.mktemp("recorded")
    write_records(folder, "slow")
    path = write(folder / "w.xlsx", ITEMS[:1], [{"floor": "1", "record_x": "slow.csv"}])
    return assess.run(assess.read_inventory(path), Settings(verify="all", runs=20), jobs=1)


@pytest.fixture(scope="module")
def page_of_some(some, tmp_path_factory):
    return write_html(some, tmp_path_factory.mktemp("html"), figures=True)


@pytest.fixture(scope="module")
def page_of_assumed(assumed, tmp_path_factory):
    return write_html(assumed, tmp_path_factory.mktemp("html"), figures=True)


class TestChanges:
    def test_a_raised_class_is_reported_and_comes_first(self, tmp_path):
        content = Content(_assess(tmp_path, [2.0] * 30, verify="all", class_by="proposed OR"))
        raised = "7 pieces in 4 rows (1 of them anchored)"
        assert f"class raised: {raised}" in content.verified.sentence
        assert {one.adopted.risk for one in content.verified.raised} == {RiskClass.VERY_HIGH}

    def test_the_stopping_rule_names_the_undecided(self, some):
        table = some.cases_table
        found = table.outcomes[some.simulation.key]
        undecided = {**found.flags, "undecided": np.arange(len(table)) == 0}
        outcomes = {**table.outcomes, some.simulation.key: replace(found, flags=undecided)}
        auto = replace(
            some, settings=Settings(runs="auto"), cases_table=replace(table, outcomes=outcomes),
            provenance=replace(some.provenance, suite=None, interval_z=2.64),
        )  # fmt: skip
        content = Content(auto)
        text = " ".join(describe_trials(content.verified))
        assert "checked after 125, 250, 500, 1,000, 2,500 and 5,000 motions, with an interval (z = 2.64)" in text
        assert f"Undecided after 5,000: {SCRIPT}." in text
        assert "1 row still undecided" in content.verified.sentence
        decided = Content(replace(auto, cases_table=table))
        assert "No piece is left undecided." in " ".join(describe_trials(decided.verified))
        assert "125 to 5,000 motions each" in decided.verified.sentence


class TestMotions:
    @pytest.mark.parametrize(
        ("floors", "building", "ways"),
        [
            ([{"floor": "1", "elevation": 4}], {"ground_pga": 0.2}, f"{GROUND}, else Ground PGV"),
            (FLOORS[:1], {"height": 9}, "records of the floors, else Period T1"),
            ([{"floor": "0", "elevation": 0, "record_x": "slow.csv"}, {"floor": "1", "elevation": 4}], {},
             "Storeys, else Period T1"),
            ([{"floor": "0", "elevation": 0, "record_x": "slow.csv"}, {"floor": "1", "elevation": 4}],
             {"period": 0.5, "structure": "frame"}, None),
        ],
    )  # fmt: skip
    def test_what_would_narrow_an_assumed_motion_most_is_said_once(self, tmp_path, floors, building, ways):
        write_records(tmp_path, "slow")
        inventory = assess.read_inventory(write(tmp_path / "w.xlsx", ITEMS[:1], floors, **building))
        results = assess.run(inventory, Settings(runs=25), jobs=1)
        interval = Content(results).verified.interval
        assert interval.partition("; what would narrow it most: ")[2] == (ways or "")
        (one,), texts = list(results), [each.text for each in Content(results).cautions]
        assert any(f"What would narrow it: {(ways or '').partition(',')[0]}" in text for text in texts) == bool(ways)
        thirds = words.find_thirds(one)
        if thirds is not None:
            low, high = map(words.in_percent, thirds)
            assert words.chance(one).replace(words.NO_BREAK, " ").endswith(f"({low} to {high} %)")
            assert words.find_highest(one) == max(one.adopted.upper, classify(thirds[1]) or RiskClass.LOW)

    def test_a_large_misfit_is_reported(self, recorded):
        def worsen(motion):
            if motion.ensemble is None:
                return motion
            fit = replace(motion.ensemble.fit, mean_deviation=0.15, worst_deviation=-0.4, worst_period_s=2.0)
            return replace(motion, ensemble=replace(motion.ensemble, fit=fit))

        assert list_misfits(recorded) == []
        (misfit,) = list_misfits(replace(recorded, motions=tuple(map(worsen, recorded.motions))))
        assert misfit == (
            "Floor 1 X: PFA and the spectrum cannot both be matched. PFA takes precedence; the mean spectrum deviates "
            "by 15.0 % on average, and by 40.0 % at 2.00 s, where it is worst."
        )


class TestFigures:
    def test_they_show_each_piece_once_and_no_markup(self, page_of_some):
        motions, convergence, rotations = _figures(page_of_some)
        assert len(_ids(convergence, "chance")) == len(_ids(convergence, "interval")) == 2
        assert len(_ids(convergence, "class-limit")) == 2 * 3
        assert len(_ids(convergence, "class")) == 4
        assert len(_ids(rotations, "overturned")) == 2
        for number in (1, 2, 3):
            (line,) = _ids(motions, f"motion-{number}")
            assert any(len(path.get("d", "")) > 1000 for path in line.iter())
        assert _ids(motions, "record") == []
        assert f"{SCRIPT} (and 1 alike)".replace("<", "&lt;").replace(">", "&gt;") in page_of_some
        assert SCRIPT not in page_of_some
        assert all(re.search(r'alt="[^"]{10,}"', image) for image in re.findall(r"<img [^>]*>", page_of_some))

    def test_the_spectra_of_the_users_motions_are_drawn(self, page_of_some):
        motions = _figures(page_of_some)[0]
        assert _subpaths(motions, "spectra") == 40
        assert len(_ids(motions, "band")) == len(_ids(motions, "mean")) == 1
        assert _ids(motions, "wanted") == [], "neither a record nor a target"

    def test_assumed_motions_are_drawn_without_spectra(self, page_of_assumed):
        motions = _figures(page_of_assumed)[0]
        for name in ("wanted", "spectra", "band", "mean", "record"):
            assert _ids(motions, name) == [], name
        (panels,) = {len([one for one in motions.iter() if one.get("id", "").startswith("axes_")])}
        assert panels == 3, "the first motions alone"

    @pytest.mark.slow
    def test_the_record_is_the_target(self, tmp_path):
        shutil.copy(RECORDS / "made-up-sweep.csv", tmp_path)
        floors = [{"floor": "1", "record_x": "made-up-sweep.csv#north"}]
        own = _figures(
            write_html(_assess(tmp_path, [1.0] * 3, ITEMS[:1], floors, verify="all"), tmp_path, figures=True)
        )
        assert len(_ids(own[0], "wanted")) == 1, "the record's own"
        assert "stroke-dasharray" not in ET.tostring(_ids(own[0], "wanted")[0], encoding="unicode")
        assert sum(len(ET.tostring(one)) for one in own) < 450_000


def _subpaths(figure, name):
    """Count the curves of a line: the pen is lifted between two."""
    (group,) = _ids(figure, name)
    return sum(path.get("d", "").count("M") for path in group.iter())


def test_a_range_on_assumed_motion_holds_the_chance():
    """The slower, the middle and the faster third of few draws may come in any order."""
    floors = [{"floor": "0", "elevation": 0}, {"floor": "1", "elevation": 4}]
    items = [
        {"item": f"{floor}{b}", "floor": floor, "breadth": b, "height": 180} for floor in "01" for b in (28, 33, 40)
    ]
    building = {"building": "House", "storeys": 2, "ground_pga": 0.3}
    inventory = assess.read_inventory({"Building": [building], "Floors": floors, "Items": items})
    results = assess.run(inventory, verify="all", runs=12, figures=False)
    ranges = [(one.adopted.probability, words.find_thirds(one)) for one in results if one.adopted.is_simulated]
    assert ranges
    assert all(found is not None and found[0] <= chance <= found[1] for chance, found in ranges)
