"""Study `table1`: up the paper's buildings, and under a folder of records."""

import csv
import math
import os
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from assess.errors import InputError
from assess.methods import Cases
from assess.motion.formats import read_records
from assess.motion.record import treat
from assess.rocking.ensemble import follow_block
from assess.studies import run_study
from assess.studies.agreement import SHORT_TITLES, evaluate_formulas
from assess.studies.study import Options
from assess.studies.table1 import (
    LONGEST,
    STUDY,
    climb,
    climb_all,
    count_classes,
    evaluate_folder,
    quote,
    read_folder,
    read_stations,
)  # fmt: skip
from assess.units import GRAVITY

SAMPLES = Path(__file__).parents[2] / "samples"
MARKET = Path(__file__).parents[2] / "inventories" / "records" / "575-market"
STATIONS = {one.number: one for one in read_stations()}


def options(**given):
    return Options(out=Path("unused"), **given)


@cache
def climbs(longer=1.0):
    return climb_all([one for one in STATIONS.values() if one.pga], options(), longer)


# ---------------------------------------------------------------- the buildings


def test_the_50_buildings_one_without_pga():
    assert len(STATIONS) == 50
    assert [one.number for one in STATIONS.values() if not one.pga] == ["014"]
    san_jose = STATIONS["003"]
    assert (san_jose.storeys, san_jose.earthquake) == (3, "LomaPrieta, 17 Oct. 1989")
    assert san_jose.height == pytest.approx(594 * 0.0254)
    assert san_jose.pga["longitudinal"] == pytest.approx(0.2 * GRAVITY)


def test_a_stiff_and_a_tall_building_by_hand():
    # 003: h = 15.09 m, T1 = 1.4 x 0.0488 h^0.75 = 0.523 s: ln(0.523/0.4)/ln(0.63/0.4) = 0.590 of the way from 0.4 to
    # 0.63 s in the table. PGV 0.2 x 105 = 21 cm/s. z/h = 1/3 is 2/9 of the way from 0.3 to 0.45, 2/3 is 4/9 from 0.6.
    found = [one for one in climb(STATIONS["003"], STATIONS["003"].period) if one.direction == "longitudinal"]
    assert STATIONS["003"].period == pytest.approx(0.523, abs=5e-4)
    assert [one.place for one in found] == pytest.approx([0, 1 / 3, 2 / 3, 1])
    assert [one.pfa / GRAVITY for one in found] == pytest.approx([0.2, 0.2925, 0.4086, 0.6426], abs=1e-4)
    assert [100 * one.pfv for one in found] == pytest.approx([21, 26.19, 38.51, 50.48], abs=0.01)
    assert [one.is_roof for one in found] == [False, False, False, True]
    # 001: h = 51.2 m, T1 = 1.308 s: 0.571 of the way from 1 to 1.6 s; PFA 2.680 and 2.377, PFV 2.724 and 2.762 there.
    roof = [one for one in climb(STATIONS["001"], STATIONS["001"].period) if one.direction == "longitudinal"][-1]
    assert STATIONS["001"].period == pytest.approx(1.308, abs=5e-4)
    assert roof.pfa / GRAVITY == pytest.approx(0.234 * (2.680 - 0.571 * 0.303), rel=1e-3)
    assert 100 * roof.pfv == pytest.approx(0.234 * 105 * (2.724 + 0.571 * 0.038), rel=1e-3)


@given(st.sampled_from([one for one in STATIONS.values() if one.pga]))
def test_the_roof_shakes_most_and_every_floor_faster_than_the_one_below(station):
    for direction in station.pga:
        floors = [one for one in climb(station, station.period) if one.direction == direction]
        assert floors[0].pfa == station.pga[direction]
        assert max(one.pfa for one in floors) == floors[-1].pfa > floors[0].pfa
        assert np.all(np.diff([one.pfv for one in floors]) > 0)


@given(st.floats(0.2, 1.2), st.floats(0.5, 2.5))
def test_no_roof_is_safer_than_the_storey_below(breadth, height):
    one = climb_all([STATIONS["002"]], options(breadth=breadth, height=height))
    storeys = STATIONS["002"].storeys
    for key in SHORT_TITLES:
        pairs = zip(one.levels, one.values[key].tolist(), strict=True)
        below = max(value for level, value in pairs if level.number == storeys)
        roof = one.find_worst(key)["002"]
        assert roof >= below or math.isnan(roof)


def test_every_floor_in_both_directions_is_counted_in_one_class():
    known = [one for one in STATIONS.values() if one.pga]
    assert len(climbs().levels) == sum(2 * (one.storeys + 1) for one in known)
    for climbed in (climbs(), climbs(LONGEST)):
        for key in SHORT_TITLES:
            assert sum(count_classes(climbed.find_worst(key)).values()) == 49


def test_what_the_page_says_of_the_papers_three():
    """Its worst three are among the worst five here; by Kaneko-Hayashi none is very high."""
    for key in ("proposed_or", "kaneko_hayashi"):
        found = climbs().find_worst(key)
        worst = sorted(found, key=lambda number: -found[number])[:5]
        assert sorted(worst) == ["001", "002", "003", "004", "005"]
    assert count_classes({one: found[one] for one in ("003", "004", "005")}) == {3: 0, 2: 1, 1: 2, 0: 0}
    pga = {number: max(one.pga.values()) for number, one in STATIONS.items() if one.pga}
    assert sorted(pga, key=lambda number: -pga[number])[:2] == ["001", "002"]


def test_the_files(tmp_path):
    shown = run_study(STUDY, Options(out=tmp_path))
    page = "\n".join(shown.page)
    for words in (
        "for 014 Table 1 prints no PGA. **The floors are a scenario, not records:**", "001 and 002 rank with them",
        "a PGV of 105 cm/s per g and T1 = 0.0683 h^0.75 from the height",
        "in places 2/4/5 by OR, 4/3/5 by Kaneko-Hayashi, 4/3/5 by FEMA P-58",
        "A free-standing piece of 45 x 160 cm (B/H 0.28) on every floor",
    ):  # fmt: skip
        assert words in page
    assert "49 of the paper's 50 buildings" in shown.summary[0]
    with (tmp_path / "table1.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(climbs().levels)
    roof = [one for one in rows if one["id"] == "003" and one["direction"] == "longitudinal"][-1]
    assert (roof["floor"], roof["z_over_h"]) == ("4", "1.0")
    assert float(roof["pfv_cm_s"]) == pytest.approx(50.48, abs=0.01)
    assert (roof["proposed_or_class"], roof["static_class"]) == ("very high", "rocking can start")
    assert not (tmp_path / "table1-records.csv").exists()
    assert len((tmp_path / "table1.svg").read_bytes()) < 120_000


def test_a_piece_outside_the_checked_range_is_reported_and_names_are_quoted():
    outside = "(B/H 1.00, outside the range in which OR is checked, 0.14 to 0.39)"
    for breadth, shown in ((1.0, outside), (0.39, "(B/H 0.39) on")):
        assert shown in STUDY.run(options(breadth=breadth, height=1.0)).page[0]
    for name, shown in (("a", "`a`"), ("a`b", "``a`b``"), ("`a``b", "``` `a``b ```"), ("a\nb", "`a b`")):
        assert quote(name) == shown


# ---------------------------------------------------------------- a folder of records


def test_every_file_is_read_or_told():
    folder = read_folder(SAMPLES / "records", Path("unused"))
    named = {one.name for one in folder.channels} | {name for name, _ in folder.left_out}
    assert {name.partition("#")[0] for name in named} == {file.name for file in (SAMPLES / "records").iterdir()}
    reasons = dict(folder.left_out)
    assert reasons["made-up-sweep.csv#up"].startswith("vertical")
    assert reasons["1103.HNZ.NP.BE_a.smc"].startswith("vertical")
    assert "velocities" in reasons["1103.HN2.NP.RE_v.smc"]
    assert "the file format is not supported" in reasons["README.md"]


def test_the_verdict_is_that_of_the_record_itself():
    given = options(breadth=0.15, height=1.5)
    folder = read_folder(SAMPLES / "records", Path("unused"))
    table = evaluate_folder(folder, given).tables["table1-records"]
    rows = {str(row[0]): dict(zip(table.columns, row, strict=True)) for row in table.rows}
    assert set(rows) == {one.name for one in folder.channels}
    for name, row in rows.items():
        file, _, channel = name.partition("#")
        records = read_records(SAMPLES / "records" / file)
        motion = treat(next(one for one in records if not channel or one.channel == channel))
        alone = follow_block(0.15, 1.5, motion.acceleration, motion.time_step)
        assert (row["overturned"], row["impacts"]) == (alone.overturned, alone.impacts)
        assert row["rotation_over_critical_angle"] == pytest.approx(alone.rotation)
        cases = Cases.of(breadth=0.15, height=1.5, pfa=motion.pfa, pfv=motion.pfv)
        by_formula = evaluate_formulas(cases, given.settings)
        for key in SHORT_TITLES:
            assert row[key] == by_formula[key][0]
    assert {row["overturned"] for row in rows.values()} == {True, False}
    stocky = evaluate_folder(folder, options(breadth=1.5, height=1.0))
    assert {row[-3:] for row in stocky.tables["table1-records"].rows} == {("", "", "")}
    assert "the piece does not rock" in "\n".join(stocky.page)


def test_folders_that_cannot_serve(tmp_path):
    with pytest.raises(InputError, match=r"there is no such folder\. Name a folder of floor records"):
        STUDY.run(options(records=tmp_path / "nowhere"))
    with pytest.raises(InputError, match=r"it is empty\)\. Put floor records into it"):
        STUDY.run(options(records=tmp_path))
    (tmp_path / "notes.txt").write_text("no record", encoding="utf-8")
    (tmp_path / "more").mkdir()
    with pytest.raises(InputError, match=r"more: a folder: .*notes\.txt: .*Put floor records into it"):
        STUDY.run(options(records=tmp_path))
    for at in range(40):
        (tmp_path / f"{at}.txt").write_text("no record", encoding="utf-8")
    with pytest.raises(InputError, match="; and 34 more") as caught:
        read_folder(tmp_path, Path("unused"))
    assert len(str(caught.value)) < 8 * 130 + 300


@pytest.mark.skipif(os.name == "nt", reason="no pipes in folders")
def test_links_to_nothing_and_pipes_are_reported_and_not_opened(tmp_path):
    folder = copy_record(tmp_path, "a.smc")
    os.mkfifo(folder / "pipe.smc")
    (folder / "gone.smc").symlink_to("nowhere.smc")
    (folder / "round.smc").symlink_to("round.smc")
    (folder / "within").mkdir()
    reasons = dict(read_folder(folder, Path("unused")).left_out)
    assert {name for name, reason in reasons.items() if reason == "not a regular file"} == {
        "pipe.smc", "gone.smc", "round.smc"
    }  # fmt: skip
    assert reasons["within"] == "a folder: subfolders are not searched"


def copy_record(parent, name):
    """Return a folder with one record of that name."""
    folder = parent / "records"
    folder.mkdir()
    (folder / name).write_bytes((SAMPLES / "records" / "0165a_u.smc").read_bytes())
    return folder


@pytest.mark.skipif(os.name == "nt", reason="no such names")
def test_names_stand_on_the_page_as_they_are(tmp_path):
    folder = copy_record(tmp_path, "a`b|c.smc")
    (folder / os.fsdecode(b"\xff|`d.txt")).write_text("no record", encoding="utf-8")
    renamed = folder.rename(tmp_path / "my `own` records")
    shown = run_study(STUDY, Options(out=tmp_path / "out", records=renamed))
    page = "\n".join(shown.page)
    assert "(folder ``my `own` records``," in page
    assert "\n| ``a`b\\|c.smc`` | " in page
    assert "Left out, with the full reasons in `table1-records-left-out.csv`: ``\\udcff|`d.txt`` (" in page
    with (tmp_path / "out" / "table1-records.csv").open(encoding="utf-8", newline="") as file:
        assert [row["record"] for row in csv.DictReader(file)] == ["a`b|c.smc"]
