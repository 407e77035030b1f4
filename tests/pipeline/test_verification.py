"""The verification through a whole run: what it changes, what it may not, and that it comes out the same."""

import io
import json
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import numpy as np
import pytest

import assess
import assess.report
from assess.motion.spectrum import response_spectrum
from assess.pipeline.run import compute
from assess.report.data import SCHEMA
from assess.risk import RiskClass, classify
from assess.settings import Settings
from tests.cli.calling import run
from tests.shaking import RECORDS, TIMES, write_record, write_records
from tests.workbooks import assessed, write

SAMPLES = Path(__file__).parents[2] / "samples" / "records"

FLOORS = [
    {"floor": "roof", "record_x": "fast.csv; slow.csv"},
    {"floor": "pulse", "record_x": "pulse.csv"},
    {"floor": "still", "record_x": "still.csv"},
    {"floor": "given", "pfa_x": 0.3, "pfv_x": 30.0},
]
ITEMS = [
    {"item": "parallel", "floor": "roof", "axis": "X", "breadth": 37, "height": 180},
    {"item": "usual", "floor": "roof", "axis": "X", "breadth": 40, "height": 180, "quantity": 3},
    {"item": "twin", "floor": "roof", "axis": "X", "breadth": 40, "height": 180},
    {"item": "falls", "floor": "pulse", "axis": "X", "breadth": 70, "height": 300},
    {"item": "stands", "floor": "still", "axis": "X", "breadth": 40, "height": 180},
    {"item": "stocky", "floor": "still", "axis": "X", "breadth": 145, "height": 100},
    {"item": "thin", "floor": "given", "axis": "X", "breadth": 25, "height": 180},
    {"item": "broad", "floor": "given", "axis": "X", "breadth": 62, "height": 180},
]


def _run(folder, path, *more, formats="json"):
    """The command, in this process; returns what it printed and wrote."""
    out = folder / "out"
    done = run("run", str(path), "--out", str(out), "--formats", formats, *map(str, more))
    assert done.exit_code == 0, done.output
    files = {file.name: file.read_bytes() for file in out.iterdir()}
    found = json.loads(files["results.json"])
    return SimpleNamespace(
        stdout=done.stdout, stderr=done.stderr, files=files, found=found, out=out,
        items={one["item"]: one for one in found["items"]},
    )  # fmt: skip


EXACT = {"motion_uncertainty": 0, "piece_uncertainty": "no", "class_by": "proposed OR"}
"""Nothing is drawn: what is adopted is what happens if exactly this motion recurs."""


def _book(folder, items=None, floors=None, **building):
    write_records(folder)
    return write(folder / "w.xlsx", items or ITEMS, floors or FLOORS, **(EXACT | building))


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """All pieces of the workbook, simulated under 100 motions each; and the results that were written."""
    folder, kept = tmp_path_factory.mktemp("verified"), []
    whole = assess.report.write_reports

    def keep(results, *more, **named):
        kept.append(results)
        return whole(results, *more, **named)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(assess.report, "write_reports", keep)
        found = _run(folder, _book(folder), "--verify", "all", "--runs", 100, formats="json,csv,npz")
    found.results = kept[0]
    return found


@pytest.fixture(scope="module")
def results(done):
    return done.results


@pytest.fixture(scope="module")
def inventory(tmp_path_factory):
    return assess.read_inventory(_book(tmp_path_factory.mktemp("inventory")))


# --- what is found ---


def test_every_piece_that_rocks_is_counted_with_its_interval(done):
    for name, item in done.items.items():
        found = item["verification"]
        if name == "stocky":
            assert found is None
            continue
        assert found["runs"] == 100
        assert found["draws"] == (400 if name in ("usual", "twin") else 100), "of 3 pieces, and one exactly like them"
        assert found["probability"] == found["overturned"] / found["draws"]
        assert found["low"] <= found["probability"] <= found["high"]
        assert item["methods"]["housner_monte_carlo"]["value"] == found["probability"]
    for name in ("verification", "adopted", "methods", "axes"):
        assert done.items["usual"][name] == done.items["twin"][name]


def test_ensembles_tell_how_they_meet_their_spectrum(done):
    for floor in done.found["floors"]:
        along_x = [one["ensemble"] for one in floor["demands"] if one["axis"] == "X"]
        assert [one["ensemble"] for one in floor["demands"] if one["axis"] == "Y"] == [None] * len(along_x)
        is_drawn = floor["floor"] == "given"
        for one in along_x:
            assert (one["motions"], one["assumed_motion"], one["bands"] is None) == (100, is_drawn, not is_drawn)
            assert one["fit"] is None if is_drawn else 0.9 < one["fit"]["pfa_ratio"] < 1.1


def test_where_nothing_rocks_none_of_n_overturns(done):
    """Of 100, none cannot show "low"; that it cannot rock does."""
    item = done.items["stands"]
    found, adopted = item["verification"], item["adopted"]
    assert (found["overturned"], found["probability"], found["low"]) == (0, 0.0, 0.0)
    assert found["high"] == pytest.approx(0.0370, abs=5e-5)
    assert found["record"] == {"overturned": False, "max_rotation_ratio": 0.0}
    assert (adopted["class"], adopted["class_upper"], adopted["basis"]) == ("low", "low", "cannot rock")


def test_a_piece_that_falls_in_the_record_is_at_least_high(done):
    item = done.items["falls"]
    assert item["verification"]["record"]["overturned"] is True
    assert item["verification"]["record"]["max_rotation_ratio"] == pytest.approx(np.pi / 2 / np.arctan(70 / 300))
    assert item["verification"]["probability"] < 0.3
    assert (item["adopted"]["class"], item["adopted"]["basis"]) == ("high", "unconfirmed")
    assert {"fell_in_record", "weak_motions"} <= set(item["adopted"]["flags"]), "random phases do not make its pulse"


def test_of_parallel_records_the_worst_governs_and_lowered_is_held_against_the_highest(done, results):
    """The fast record has the higher class by formula, the slow one overturns more."""
    item, one = done.items["parallel"], results["parallel"]
    fast, slow = item["axes"]
    assert [axis["source"] for axis in item["axes"]] == ["fast.csv", "slow.csv"]
    assert fast["verification"]["overturned"] < slow["verification"]["overturned"]
    assert item["pfa_source"] == "slow.csv"
    assert classify(fast["methods"]["proposed_or"]) is RiskClass.VERY_HIGH
    assert classify(slow["methods"]["proposed_or"]) is RiskClass.HIGH
    assert (item["adopted"]["class"], item["adopted"]["lowered_from"]) == ("medium", "very high")
    assert (one.adopted.lowered_from, one.by_formula.motion.record) == (RiskClass.VERY_HIGH, "fast.csv")


# --- lowered, and never lowered ---


def test_every_lowered_class_is_marked(done, results):
    lowered = {one.item.item: one.adopted.lowered_from for one in results if one.adopted.lowered_from}
    assert {"parallel", "usual", "twin"} <= set(lowered)
    assert not {"falls", "stocky", "stands"} & set(lowered)
    for one in results:
        highest = RiskClass(max(int(classify(case.methods["proposed_or"].value)) for case in one.cases))
        is_lower = one.adopted.risk < highest and one.adopted.can_rock and not one.adopted.is_unconfirmed
        assert one.adopted.lowered_from == (highest if is_lower else None)
    assert re.search(rf"; class lowered: \d+ pieces in {len(lowered)} rows; unconfirmed: ", done.stdout)


def test_of_an_unknown_building_a_class_is_simulated_and_unconfirmed(done):
    for name in ("thin", "broad"):
        item = done.items[name]
        found, adopted = item["verification"], item["adopted"]
        assert {"assumed_motion", "unknown_building", "unconfirmed"} <= set(adopted["flags"])
        assert adopted["probability"] == found["probability"]
        assert adopted["class"] == RiskClass(classify(max(found["probability"], found["if_faster"]))).word
        assert (adopted["low"], adopted["high"], found["record"]) == (None, None, None)
        assert found["ideal"] is None, "what is drawn cannot recur"
        assert found["if_slower"] <= found["if_faster"]


# --- which pieces, which motions ---


@pytest.mark.slow
def test_high_simulates_only_what_is_high_or_doubtful_or_on_a_route(tmp_path):
    items = [
        {"item": "calm", "floor": "calm", "axis": "X", "breadth": 60, "height": 180},
        {"item": "outside", "floor": "still", "axis": "X", "breadth": 90, "height": 180},
    ]
    path = _book(tmp_path, items, [*FLOORS, {"floor": "calm", "pfa_x": 0.12}], motion_uncertainty=0.4)
    done = _run(tmp_path, path, "--verify", "high", "--runs", 5)
    calm, outside = done.items["calm"], done.items["outside"]
    assert (calm["verification"], calm["adopted"]["method"], calm["adopted"]["basis"]) == (
        None, "proposed_or", "formula",
    )  # fmt: skip
    assert calm["adopted"]["probability"] == calm["methods"]["proposed_or"]["value"]
    assert "extrapolated" in outside["methods"]["proposed_or"]["flags"]
    assert outside["verification"]["runs"] == 5


@pytest.mark.slow
def test_a_borrowed_motion_has_phases_of_its_own(tmp_path):
    write_records(tmp_path, "slow")
    items = [{"item": "a", "floor": "1", "breadth": 30, "height": 180}]
    settings = Settings(verify="all", runs=60)
    results = assessed(tmp_path / "w.xlsx", items, [{"floor": "1", "record_x": "slow.csv"}], settings=settings)
    one, other = (case.motion for case in results["a"].cases)
    assert (one.axis, other.axis, one.pfa_g) == ("X", "Y", other.pfa_g)
    for name in ("rotation", "example/0"):
        assert not np.array_equal(*(results.series[f"motion/{motion.index}/{name}"] for motion in (one, other)))
    assert "one_axis_only" in other.flags


def test_the_spectra_of_each_floor_are_kept(inventory):
    """Those of the examples, worked out alone; the target of a recorded floor is the record's own spectrum."""
    for demand, joint in compute(inventory, Settings(verify="all", runs=100)).joints.items():
        spectra = joint.spectra
        assert (spectra is None) == (demand.motion is None)
        if spectra is None:
            continue
        assert spectra.ordinates.shape == (100, spectra.periods.size)
        for (motion, step), ordinates in zip(joint.examples, spectra.ordinates, strict=False):
            expected = response_spectrum(motion, step, spectra.periods).pseudo
            # They are found in single precision and on fewer samples where periods are long.
            np.testing.assert_allclose(ordinates, expected, rtol=0.01, atol=0.005 * expected.max())
        deviation = spectra.ordinates.mean(axis=0) / spectra.target - 1
        assert np.abs(deviation).mean() == pytest.approx(joint.fit.mean_deviation, abs=1e-5)
        assert deviation[np.abs(deviation).argmax()] == pytest.approx(joint.fit.worst_deviation, abs=1e-5)
        own = response_spectrum(demand.motion.acceleration, demand.motion.time_step, spectra.periods).pseudo
        np.testing.assert_allclose(spectra.target, own, rtol=0.02)


# --- the same again ---

SMALL = [ITEMS[0], ITEMS[1], {"item": "g", "floor": "given", "axis": "X", "breadth": 40, "height": 180}]
SMALL_FLOORS = [{"floor": "roof", "record_x": "slow.csv"}, {"floor": "given", "pfa_x": 0.3, "pfv_x": 30.0}]


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    path = _book(folder, SMALL, SMALL_FLOORS)
    return folder, path, _run(folder, path, "--verify", "all", "--runs", 40, "--jobs", 1, formats="json,npz")


@pytest.mark.slow
def test_the_order_of_rows_is_irrelevant(small, tmp_path):
    _, _, before = small
    again = _run(tmp_path, _book(tmp_path, SMALL[::-1], SMALL_FLOORS[::-1]), "--verify", "all", "--runs", 40)
    assert list(again.items) == list(before.items)[::-1]
    for name, item in before.items.items():
        assert again.items[name] | {"source": None} == item | {"source": None}


@pytest.mark.slow
def test_threads_change_no_byte_and_another_seed_gives_other_motions(small, tmp_path):
    _, path, before = small
    words = ("--verify", "all", "--runs", 40)
    assert _run(tmp_path / "a", path, *words, "--jobs", 3, formats="json,npz").files == before.files
    again = _run(tmp_path / "b", path, *words, "--seed", 2)
    assert again.found["assess"]["seed"] == 2
    shares = [[one["verification"]["overturned"] for one in found.items.values()] for found in (before, again)]
    assert shares[0] != shares[1]


def test_auto_stops_each_piece_by_itself(tmp_path):
    items = [
        {"item": "falls", "floor": "1", "axis": "X", "breadth": 25, "height": 180},
        {"item": "stands", "floor": "1", "axis": "X", "breadth": 170, "height": 180},
    ]
    write_record(tmp_path / "strong.csv", 3 * RECORDS["slow"])
    path = write(tmp_path / "w.xlsx", items, [{"floor": "1", "record_x": "strong.csv"}])
    done = _run(tmp_path, path, "--verify", "all", "--runs", "auto", formats="json,npz")
    runs = {name: item["verification"]["runs"] for name, item in done.items.items()}
    assert runs == {"falls": 125, "stands": 250}
    assert done.found["assess"]["settings"]["runs"] == "auto"
    assert [floor["demands"][0]["ensemble"]["motions"] for floor in done.found["floors"][:1]] == [250]
    arrays = np.load(io.BytesIO(done.files["outcomes.npz"]))
    assert arrays["overturned"].shape == (2, 32)
    assert np.isnan(arrays["max_rotation_ratio"]).sum(axis=1).tolist() == [125, 0]
    assert "125 to 5,000 motions each" in done.stdout


# --- every motion ---


def test_outcomes_agree_with_the_results(done):
    arrays = np.load(io.BytesIO(done.files["outcomes.npz"]))
    fell = np.unpackbits(arrays["overturned"], axis=1)[:, :100]
    turned = arrays["max_rotation_ratio"]
    assert fell.shape == turned.shape == (10, 100)
    seen = set()
    for at, name in enumerate(arrays["item"]):
        item = done.items[str(name)]
        axis = next(one for one in item["axes"] if one["source"] == arrays["source"][at])
        own = axis["verification"]["overturned"] * 100 / axis["verification"]["draws"]
        assert fell[at].sum() == own, "nothing is drawn: those alike fall together"
        assert arrays["runs"][at] == axis["verification"]["runs"]
        assert (arrays["row"][at], arrays["axis"][at]) == (item["source"]["row"], "X")
        critical = np.arctan(item["breadth_to_height"])
        np.testing.assert_array_equal(turned[at] >= np.float32(np.pi / 2 / critical) * (1 - 1e-6), fell[at] == 1)
        if arrays["governs"][at]:
            assert item["verification"]["overturned"] == axis["verification"]["overturned"]
            seen.add(str(name))
    assert seen == set(done.items) - {"stocky"}


# --- motions of one's own ---


@pytest.fixture
def suite(tmp_path):
    folder = tmp_path / "mine"
    folder.mkdir()
    for number in range(4):
        long = np.sin(2 * np.pi * TIMES / (0.8 + 0.3 * number)) * np.exp(-(((TIMES - 4) / 2) ** 2))
        write_record(folder / f"m{number}.csv", (0.1 + 0.1 * number) * long)
    write_record(folder / "other.csv", 0.2 * np.sin(2 * np.pi * TIMES), step=0.02)
    (folder / "README.md").write_text("Mine.", encoding="utf-8")
    return folder


@pytest.mark.parametrize("scaled", [False, True])
def test_motions_of_ones_own(tmp_path, suite, scaled):
    more = ["--scale-motions"] if scaled else []
    done = _run(tmp_path, _book(tmp_path), "--motions", suite, *more)
    settings, inputs = done.found["assess"]["settings"], done.found["assess"]["inputs"]
    assert (settings["runs"], settings["scale_motions"]) == (5, scaled)
    assert sorted(inputs["motions"]) == ["m0.csv", "m1.csv", "m2.csv", "m3.csv", "other.csv"]
    jsonschema.validate(done.found, json.loads(SCHEMA.read_text(encoding="utf-8")))
    ensembles = [one["ensemble"] for floor in done.found["floors"] for one in floor["demands"] if one["axis"] == "X"]
    assert any(one["weak_motions"] for one in ensembles), "some floors shake more than these, or faster"
    unknown = ("assumed_motion", "unknown_building", "signs", "fit", "bands")
    assert {(one["motions"], *(bool(one[name]) for name in unknown)) for one in ensembles} == {(5, *[False] * 5)}
    assert {item["verification"]["runs"] for item in done.items.values() if item["verification"]} == {5}
    still = done.items["stands"]["verification"]["overturned"]
    assert still == 0 if scaled else still > 0, "scaled to the 0.05 g of its floor, nothing rocks"


def test_a_suite_that_cannot_be_read_ends_the_run(tmp_path, suite):
    (suite / "bad.csv").write_text("nothing of use", encoding="utf-8")
    path = _book(tmp_path)
    done = run("run", str(path), "--out", str(tmp_path / "out"), "--motions", str(suite))
    assert done.exit_code == 2
    assert re.search(r"error .*bad\.csv", done.stderr)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("peak", "period", "more"),
    [(0.002, 1.0, []), (0.4, 0.05, ["--scale-motions"])],
    ids=["of far too low a level", "scaled, but without the floor's velocity"],
)
def test_motions_weaker_than_the_floor_lower_no_class(tmp_path, peak, period, more):
    (tmp_path / "mine").mkdir()
    motion = peak * np.sin(2 * np.pi * TIMES / period) * np.exp(-(((TIMES - 4) / 2) ** 2))
    for number in range(6):
        write_record(tmp_path / "mine" / f"m{number}.csv", motion)
    items = [{"item": "thin", "floor": "1", "breadth": 30, "height": 180}]
    path = write(tmp_path / "w.xlsx", items, [{"floor": "1", "pfa_x": 0.5, "pfv_x": 70}])
    done = _run(tmp_path, path, "--motions", tmp_path / "mine", *more)
    (item,) = done.items.values()
    assert item["verification"]["overturned"] == 0
    assert (item["adopted"]["method"], item["adopted"]["lowered_from"]) == ("fema_p58", None)
    assert {"weak_motions", "unconfirmed"} <= set(item["adopted"]["flags"])
    assert "weaker than floor '1' X" in done.stderr


@pytest.mark.slow
def test_what_a_piece_does_along_the_other_axis_is_not_lost(tmp_path):
    """It falls under the record along X; along Y, of which only a peak is known, more motions overturn it."""
    shutil.copy(SAMPLES / "np01002p_4225a_a.smc", tmp_path)
    floors = [{"floor": "R", "record_x": "np01002p_4225a_a.smc", "pfa_y": 0.5, "pfv_y": 60}]
    path = write(tmp_path / "w.xlsx", [{"item": "thin", "floor": "R", "breadth": 20, "height": 200}], floors)
    done = _run(tmp_path, path, "--runs", 30)
    item = done.items["thin"]
    assert (item["axis"], item["verification"]["record"]) == ("Y", None)
    assert item["axes"][0]["verification"]["record"]["overturned"] is True
    assert "fell_in_record" in item["adopted"]["flags"]
    assert item["adopted"]["class"] in ("high", "very high")


def test_a_folder_that_cannot_be_written_is_reported_before_the_long_work(tmp_path, monkeypatch):
    monkeypatch.setattr("assess.pipeline.run.compute", lambda *_, **__: pytest.fail("the work has begun"))
    (tmp_path / "file").write_text("", encoding="utf-8")
    path = write(tmp_path / "w.xlsx")
    done = run("run", str(path), "--out", str(tmp_path / "file" / "out"))
    assert done.exit_code == 1
    assert f"cannot be written to: {tmp_path / 'file'} is a file. Name another folder." in done.stderr
