"""Ground-motion fields of OpenQuake: scenarios at the nearest site, and files that cannot be used.

The files are made here, in the form in which OpenQuake exports them.
"""

import pickle
from pathlib import Path

import numpy as np
import pytest

from assess.errors import InputError
from assess.motion.ground_scenarios import read_scenarios
from assess.units import GRAVITY
from tests.refusals import check_refusals

SITES = "site_id,lon,lat\n0,-122.40,37.80\n1,-122.20,37.80\n"
VALUES = "site_id,event_id,gmv_PGA\n0,0,0.1\n0,1,0.2\n0,2,0.4\n1,0,0.3\n1,1,0.3\n1,2,0.3\n"
COMMENT = "#,,\"generated_by='OpenQuake engine 3.16.3', start_date='2023-01-01T00:00:00'\"\n"


def _write(folder: Path, values: str = VALUES, sites: str = SITES, name: str = "sitemesh.csv") -> Path:
    (folder / "gmf-data.csv").write_text(COMMENT + values, encoding="utf-8")
    (folder / name).write_text(COMMENT + sites, encoding="utf-8")
    return folder


@pytest.mark.parametrize("name", ["sitemesh.csv", "sites.csv"])
def test_the_nearest_site_gives_median_dispersion_and_scenarios(tmp_path, name):
    site = read_scenarios(_write(tmp_path, name=name)).at(37.79, -122.41)
    assert site.pga == pytest.approx(0.2 * GRAVITY), "exp of the mean of ln PGA"
    assert site.dispersion == pytest.approx(np.log(2) * np.sqrt(2 / 3)), "of all scenarios: the population's"
    assert site.scenarios == pytest.approx((-(1.5**0.5), 0, 1.5**0.5)), "in the order of events"
    assert site.dispersion_source == "standard deviation of 3 scenarios of gmf-data.csv"
    assert site.shared is None
    assert site.distance == pytest.approx(1417, abs=5)
    assert site.cautions == ()


def test_the_order_of_rows_and_columns_does_not_matter(tmp_path):
    values = "gmv_SA(1.0),event_id,gmv_PGA,gmv_PGV,site_id\n.1,2,.4,40,0\n.1,0,.3,20,1\n.1,1,.2,20,0\n.2,1,.3,20,1\n"
    values += ".4,0,.1,10,0\n.1,2,.3,20,1\n"
    site = read_scenarios(_write(tmp_path, values)).at(37.8, -122.4)
    assert site.scenarios == pytest.approx((-(1.5**0.5), 0, 1.5**0.5))
    assert site.pgv == pytest.approx(0.2)
    ((period, value),) = site.psa
    assert (period, value) == pytest.approx((1.0, (0.1 * 0.1 * 0.4) ** (1 / 3) * GRAVITY))


def test_pgv_decides_which_scenario_is_a_strong_one(tmp_path):
    values = "site_id,event_id,gmv_PGA,gmv_PGV\n0,0,.1,40\n0,1,.2,20\n0,2,.4,10\n"
    site = read_scenarios(_write(tmp_path, values)).at(37.8, -122.4)
    assert site.measure == "PGV"
    assert site.scenarios == pytest.approx((1.5**0.5, 0, -(1.5**0.5)))
    assert (site.pga, site.pgv) == pytest.approx((0.2 * GRAVITY, 0.2))


def test_sites_may_be_named_by_texts(tmp_path):
    values = VALUES.replace("site_id", "custom_site_id").replace("\n0,", "\n9q8yy,").replace("\n1,", "\n9q9nf,")
    sites = SITES.replace("site_id", "custom_site_id").replace("\n0,", "\n9q8yy,").replace("\n1,", "\n9q9nf,")
    assert read_scenarios(_write(tmp_path, values, sites)).at(37.8, -122.4).pga == pytest.approx(0.2 * GRAVITY)


def test_a_far_site_is_warned_of_and_one_beyond_50_km_does_not_cover_a_place(tmp_path):
    scenarios = read_scenarios(_write(tmp_path))
    assert scenarios.at(37.8, -122.4).cautions == ()
    assert scenarios.at(38.1, -122.4).cautions == ("the nearest site of the scenarios is 33 km from the building",)
    match = (
        r"^gmf-data\.csv: the scenarios do not cover latitude 38\.5000, longitude -122\.4000: their nearest site is "
        r"78 km away, expected at most 50 km\. Check Latitude and Longitude, or compute the fields for sites near"
    )
    with pytest.raises(InputError, match=match):
        scenarios.at(38.5, -122.4)


def test_one_scenario_alone_or_equal_ones_do_not_scatter(tmp_path):
    site = read_scenarios(_write(tmp_path, "site_id,event_id,gmv_PGA\n0,7,0.25\n1,7,0.3\n")).at(37.8, -122.4)
    assert site.pga == pytest.approx(0.25 * GRAVITY)
    assert (site.dispersion, site.scenarios) == (0.0, (0.0,))
    assert site.dispersion_source == "gmf-data.csv holds 1 scenario alone"
    assert site.facts[0] == ("Scenarios", "1 event")
    (caution,) = site.cautions
    assert "the motion of the ground is taken as known" in caution
    equal = read_scenarios(_write(tmp_path)).at(37.8, -122.2)
    assert (equal.dispersion, equal.scenarios, equal.cautions) == (0.0, (0.0,) * 3, (caution,))


def test_a_site_without_some_event_is_refused(tmp_path):
    found = read_scenarios(_write(tmp_path, VALUES.replace("0,2,0.4\n", "")))
    assert found.at(37.8, -122.2).pga == pytest.approx(0.3 * GRAVITY)
    match = r"has 2 of 3 events: the others lie below the engine's minimum.*minimum_intensity 0"
    with pytest.raises(InputError, match=match):
        found.at(37.8, -122.4)


def test_it_travels_by_its_folder_and_hash(tmp_path):
    packed = pickle.dumps(read_scenarios(_write(tmp_path)))
    assert len(packed) < 1000
    assert pickle.loads(packed).at(37.8, -122.4).pga == pytest.approx(0.2 * GRAVITY)
    (tmp_path / "two").mkdir()
    packed = pickle.dumps(read_scenarios(_write(tmp_path / "two")))
    _write(tmp_path / "two", sites=SITES.replace("37.80", "37.81"))
    with pytest.raises(InputError, match="two has changed since the run began"):
        pickle.loads(packed)


BAD_VALUES = [
    (VALUES.replace("0.4", "0.0"), r"gmf-data\.csv: line 5: gmv_PGA is 0, expected above 0 and at most 10 g"),
    (VALUES.replace("0.4", "-0.4"), "line 5: gmv_PGA is -0.4"),
    (VALUES.replace("0.4", "nan"), "line 5: gmv_PGA is nan"),
    (VALUES.replace("0.4", "392"), "line 5: gmv_PGA is 392"),  # in cm/s2
    (VALUES.replace("0.4", "high"), "line 5: 'high' is not a number"),
    (VALUES[:-6], "the last line has no end: the file is cut off"),
    (VALUES[:-4].rstrip() + "\n", "line 8: '' is not a number"),
    (VALUES.replace("0.4", "0.4,1"), "line 5: the number of cells is 4, but there are 3 headings"),
    (VALUES.replace("gmv_PGA", "gmv_PGV"), "the column gmv_PGA is missing"),
    (VALUES.replace("event_id", "rupture"), "the column event_id is missing"),
    (VALUES.replace("site_id", "place"), r"neither site_id nor custom_site_id is a column of both .* sitemesh\.csv"),
    (VALUES.replace("\n1,2,", "\n5,2,"), r"line 8: its site_id is not in sitemesh\.csv"),
    (VALUES.replace("0,2,", "0,1,"), "event 1 is there twice at a site"),
    (VALUES.replace("0,2,", "0,1.5,"), "line 5: event_id has to be a whole number"),
    (VALUES.replace("\n0,2,0.4", "\n\n\n0,2,-0.4"), "line 7: gmv_PGA is -0.4"),  # after blank lines
    (VALUES.replace("0.4", "-0.4").replace("\n", "\r\n"), "line 5: gmv_PGA is -0.4"),  # after lines of Windows
    (VALUES.replace("event_id", "site_id"), "has a heading twice"),
    ("site_id,event_id,gmv_PGA\n", "there are no rows below the headings"),
    ("", "there is no table"),
]
BAD_SITES = [
    (SITES.replace("lon", "x"), r"^sitemesh\.csv: the column lon is missing"),
    (SITES.replace("\n1,", "\n0,"), r"sitemesh\.csv: a site_id is there twice"),
    (SITES.replace("37.80", "97.80"), r"sitemesh\.csv: line 3: lon and lat are not a place on earth"),
    (SITES.replace("37.80", "nan"), r"sitemesh\.csv: line 3: lon and lat are not a place on earth"),
]


def test_values_and_sites_that_cannot_be_used(tmp_path):
    check_refusals(InputError, lambda values: read_scenarios(_write(tmp_path, values)), BAD_VALUES)
    check_refusals(InputError, lambda sites: read_scenarios(_write(tmp_path, sites=sites)), BAD_SITES)


def test_files_of_another_kind_or_missing(tmp_path):
    with pytest.raises(InputError, match=r"the folder has no gmf-data\.csv"):
        read_scenarios(tmp_path)
    _write(tmp_path)
    (tmp_path / "gmf-data.csv").write_bytes(b"PK\x03\x04")
    with pytest.raises(InputError, match=r"gmf-data\.csv: the file is not plain text"):
        read_scenarios(tmp_path)
    (tmp_path / "sitemesh.csv").unlink()
    with pytest.raises(InputError, match=r"the folder has no sitemesh\.csv or sites\.csv"):
        read_scenarios(tmp_path)
