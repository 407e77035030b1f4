"""ShakeMaps: values at a place, their scatter, what is told of the map, and files that cannot be used."""

import pickle
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from assess.errors import InputError
from assess.motion.shakemap import name_uncertainty, parse_shakemap, read_shakemap
from assess.units import GRAVITY
from tests.motion.grids import BAY, EPICENTRE, LATITUDES, MARKET_STREET, build_grid
from tests.refusals import check_refusals

PGA = (10.0, 20.0, 10.0, 20.0, 40.0, 80.0)
PLAIN = {"PGA": ("pctg", PGA)}


def _at(data: bytes, latitude: float = 37.5, longitude: float = -122.0, **more):
    return parse_shakemap(data, "grid.xml", **more).at(latitude, longitude)


def test_loma_prieta_at_575_market_street():
    """The map has 0.1525 g where 0.139 g was recorded on the ground; sigma, PGV and Vs30 as published."""
    site = read_shakemap(BAY).at(*MARKET_STREET)
    assert site.pga / GRAVITY == pytest.approx(0.1525, abs=5e-5)
    assert site.dispersion == pytest.approx(0.09, abs=5e-4)
    assert site.pgv == pytest.approx(0.196, abs=5e-4)
    assert abs(np.log(site.pga / GRAVITY / 0.139)) < 1.1 * site.dispersion
    facts = {str(label): str(value) for label, value in site.facts}
    assert facts["Earthquake"] == "Loma Prieta, California, magnitude 6.9"
    assert facts["Status of the map"] == "RELEASED"
    assert facts["Kind of event"] == "ACTUAL"
    assert facts["Vs30 of the map at the building"].startswith("363 m/s; its effect is in the map")
    assert site.cautions == ()


def test_uncertainty_beside_gives_the_share_of_all_places():
    """At a point of the grid: inter 0.24, intra 0.50 of PGV, whose sigma the grid does not have."""
    site = read_shakemap(EPICENTRE).at(37.2, -122.25)
    assert site.shared == pytest.approx(0.24**2 / (0.24**2 + 0.50**2))
    assert site.dispersion == pytest.approx(0.3446)
    assert site.dispersion_source == "STDPGV of uncertainty.xml"
    assert "File of uncertainties" in dict(site.facts)


def test_outside_the_map_nothing_is_taken():
    place = r"latitude 37\.7893, longitude -122\.4008"
    limits = r"latitude 36\.5000 to 37\.2000 and longitude -122\.5000 to -121\.3000"
    with pytest.raises(InputError, match=rf"^grid\.xml: {place} is outside the map, which covers {limits}$"):
        read_shakemap(EPICENTRE).at(*MARKET_STREET)


def test_it_travels_by_its_path_and_hash_and_notices_a_change(tmp_path):
    path = Path(shutil.copy(BAY, tmp_path / "grid.xml"))
    packed = pickle.dumps(read_shakemap(path))
    assert len(packed) < 1000
    assert pickle.loads(packed).at(*MARKET_STREET) == read_shakemap(path).at(*MARKET_STREET)
    other = pickle.dumps(read_shakemap(Path(shutil.copy(BAY, tmp_path / "grid2.xml"))))
    (tmp_path / "grid2.xml").write_bytes(build_grid(PLAIN))
    with pytest.raises(InputError, match=r"grid2\.xml has changed since the run began"):
        pickle.loads(other)


# ---------------------------------------------------------------- interpolation


def test_between_points_the_logarithm_is_interpolated_whichever_way_rows_run():
    assert _at(build_grid(PLAIN), 38.0, -121.75).pga == pytest.approx(0.1 * 2**0.5 * GRAVITY)
    assert _at(build_grid(PLAIN), 37.25, -121.75).pga == pytest.approx((0.1 * 0.2 * 0.4 * 0.8) ** 0.25 * GRAVITY)
    assert _at(build_grid(PLAIN), 37.0, -121.5).pga == pytest.approx(0.8 * GRAVITY), "a corner of the map"
    turned = build_grid({"PGA": ("pctg", PGA[::-1])}, LATITUDES[::-1], (-121.5, -122.0))
    assert _at(turned, 37.3, -121.9).pga == pytest.approx(_at(build_grid(PLAIN), 37.3, -121.9).pga, rel=1e-12)


@pytest.mark.parametrize("longitudes", [(179.5, -180.0, -179.5), (179.5, 180.0, 180.5), (-180.5, -180.0, -179.5)])
def test_a_map_across_the_date_line(longitudes):
    data = build_grid({"PGA": ("%g", (10, 20, 40, 10, 20, 40))}, (1.0, 0.0), longitudes)
    for east in (179.75, -180.25):
        assert _at(data, 0.5, east).pga == pytest.approx(0.1 * 2**0.5 * GRAVITY)
    for west in (-179.75, 180.25):
        assert _at(data, 0.5, west).pga == pytest.approx(0.2 * 2**0.5 * GRAVITY)
    with pytest.raises(InputError, match="outside the map"):
        _at(data, 0.5, 0.0)


@pytest.mark.parametrize("unit", ["pctg", "%g", ""])
@pytest.mark.parametrize("speed", ["cms", "cm/s", ""])
def test_both_spellings_of_units_and_none(unit, speed):
    fields = {"PGA": (unit, PGA), "PGV": (speed, PGA), "PSA03": (unit, PGA), "PSA10": (unit, PGA)}
    site = _at(build_grid(fields))
    assert (site.pga, site.pgv) == pytest.approx((0.1 * GRAVITY, 0.1))
    assert site.psa == ((0.3, pytest.approx(0.1 * GRAVITY)), (1.0, pytest.approx(0.1 * GRAVITY)))


def test_a_pgv_that_is_rounded_to_0_is_not_known_and_a_pga_is_refused():
    site = _at(build_grid(PLAIN | {"PGV": ("cms", (0.0,) * 6)}))
    assert site.pgv is None
    with pytest.raises(InputError, match=r"the PGA of the map is 0 or not a number \(NaN\) at latitude 37\.5000"):
        _at(build_grid({"PGA": ("pctg", (1, 1, 0.0, 1, 1, 1))}))


# ---------------------------------------------------------------- scatter


def test_without_any_uncertainty_one_is_assumed_and_sigma_is_interpolated_linearly():
    site = _at(build_grid(PLAIN))
    assert site.dispersion == pytest.approx(0.605, abs=5e-4)
    assert site.shared == pytest.approx(0.348**2 / 0.605**2, rel=1e-3)
    assumed = "assumed, as the map has none at this place: the total of Boore et al. 2014"
    assert site.dispersion_source.startswith(assumed)
    interpolated = _at(build_grid(PLAIN | {"STDPGA": ("ln(pctg)", (0.1, 0.3) * 3)}), 37.5, -121.75)
    assert interpolated.dispersion == pytest.approx(0.2)


@pytest.mark.parametrize(("magnitude", "sigma"), [("4.0", 0.801), ("5.0", 0.702), ("5.5", 0.605), ("unknown", 0.605)])
def test_it_is_larger_for_small_earthquakes(magnitude, sigma):
    """tau 0.398 to 0.348 and phi 0.695 to 0.495 from magnitude 4.5 to 5.5, linearly."""
    site = _at(build_grid(PLAIN).replace(b'magnitude="6.0"', f'magnitude="{magnitude}"'.encode()))
    assert site.dispersion == pytest.approx(sigma, abs=5e-4)


@pytest.mark.parametrize(
    ("fields", "beside", "found"),
    [
        ({"STDPGA": 0.3, "STDPGV": 0.4}, {}, (0.4, "STDPGV of grid.xml")),
        ({"STDPGA": 0.3}, {"STDPGA": 0.2, "STDPGV": 0.5}, (0.5, "STDPGV of uncertainty.xml")),
        ({"STDPGA": 0.3}, {}, (0.3, "STDPGA of grid.xml")),
        ({"STDPGA": 0.3, "STDPGV": 0.0}, {}, (0.3, "STDPGA of grid.xml")),
        ({}, {"STDPGA": 0.2}, (0.2, "STDPGA of uncertainty.xml")),
    ],
)
def test_where_the_map_has_pgv_its_sigma_rules(fields, beside, found):
    named = {name: ("", (value,) * 6) for name, value in fields.items()}
    data = build_grid(PLAIN | {"PGV": ("cms", (20.0,) * 6)} | named)
    grid = build_grid({name: ("", (value,) * 6) for name, value in beside.items()}) if beside else None
    site = _at(data, uncertainty=grid, uncertainty_name="uncertainty.xml")
    assert (site.measure, site.dispersion, site.dispersion_source) == ("PGV", *found)


def test_assumed_sigma_and_share_are_those_of_pgv_where_the_map_has_it():
    """Boore et al. (2014): tau 0.346 and phi 0.552 from magnitude 5.5 on."""
    site = _at(build_grid(PLAIN | {"PGV": ("cms", (20.0,) * 6)}))
    assert site.dispersion == pytest.approx(0.651, abs=5e-4)
    assert site.shared == pytest.approx(0.346**2 / (0.346**2 + 0.552**2))


@pytest.mark.parametrize(("measures", "shared"), [(("PGA", "PGV"), 0.2), (("PGA",), 0.5)])
def test_the_share_is_that_of_pgv_and_of_pga_where_the_file_has_no_other(measures, shared):
    parts = {"PGA": (0.3, 0.3), "PGV": (0.2, 0.4)}
    fields = {
        f"GMPE_{part}_STD{name}": ("", (value,) * 6)
        for name in measures
        for part, value in zip(("INTER", "INTRA"), parts[name], strict=True)
    }
    data = build_grid(PLAIN | {"PGV": ("cms", (20.0,) * 6), "STDPGA": ("", (0.3,) * 6)})
    site = _at(data, uncertainty=build_grid(fields), uncertainty_name="uncertainty.xml")
    assert site.shared == pytest.approx(shared)


def test_a_sigma_of_0_everywhere_is_none_and_at_some_points_is_kept():
    """An instrument leaves no doubt at its own point; a map without any doubt has a field that was not filled in."""
    zero = build_grid(PLAIN | {"STDPGA": ("ln(pctg)", (0.0,) * 6)})
    site = _at(zero)
    assert site.dispersion == pytest.approx(0.605, abs=5e-4)
    assert site.shared == pytest.approx(0.348**2 / 0.605**2, rel=1e-3)
    why = "assumed, as the map's STDPGA is 0 everywhere: the total of Boore et al. 2014 for magnitude 5.5 or more"
    assert site.dispersion_source == why
    some = _at(build_grid(PLAIN | {"STDPGA": ("ln(pctg)", (0.3, 0.3, 0.0, 0.3, 0.3, "nan"))}))
    assert (some.dispersion, some.dispersion_source) == (0.0, "STDPGA of grid.xml")
    beside = {"uncertainty_name": "uncertainty.xml", "uncertainty": build_grid({"STDPGA": ("", (0.25,) * 6)})}
    assert _at(zero, **beside).dispersion_source == "STDPGA of uncertainty.xml"
    beside["uncertainty"] = build_grid({"STDPGA": ("", (0.0,) * 6)})
    assert _at(build_grid(PLAIN), **beside).dispersion_source == why


@pytest.mark.parametrize("name", ["uncertainty.xml", "my-uncertainty.xml"])
def test_sigma_of_the_file_beside(tmp_path, name):
    (tmp_path / "my-grid.xml").write_bytes(build_grid(PLAIN))
    (tmp_path / name).write_bytes(build_grid({"STDPGA": ("", (0.25,) * 6)}))
    found = read_shakemap(tmp_path / "my-grid.xml")
    alone = parse_shakemap((tmp_path / "my-grid.xml").read_bytes(), "my-grid.xml")
    assert found.at(37.5, -122.0).dispersion == 0.25
    assert found.at(37.5, -122.0).dispersion_source == f"STDPGA of {name}"
    assert found.sha256 != alone.sha256, "a part of a portfolio is computed again where the file beside is another one"
    assert found.at(37.5, -122.0).sha256 == alone.sha256


def test_the_file_beside_has_names_of_its_own_and_may_not_be_of_another_earthquake():
    assert name_uncertainty("grid.xml") == ("uncertainty.xml",)
    assert name_uncertainty("ev1_grid.xml") == ("ev1_uncertainty.xml", "uncertainty.xml")
    other = build_grid({"STDPGA": ("", (0.2,) * 6)}, event="ev2")
    with pytest.raises(InputError, match=r"uncertainty\.xml: it is of the event 'ev2', but the grid of 'ev1'"):
        parse_shakemap(build_grid(PLAIN), "grid.xml", uncertainty=other, uncertainty_name="uncertainty.xml")


def test_a_file_beside_that_is_cut_off_is_named_with_its_folder_and_the_way_out(tmp_path):
    (tmp_path / "grid.xml").write_bytes(build_grid(PLAIN))
    (tmp_path / "uncertainty.xml").write_bytes(build_grid({"STDPGA": ("", (0.25,) * 6)})[:-60])
    fault = r"uncertainty\.xml: line \d+: the XML is damaged or cut off\. Download it again"
    way = r"You can remove the file: the STDPGV or STDPGA of grid\.xml is then used, or an assumed one where it has "
    way += "none"
    with pytest.raises(InputError, match=rf"^{re.escape(str(tmp_path))}.{fault}\. {way}$"):
        read_shakemap(tmp_path / "grid.xml")


def test_a_map_that_is_not_reviewed_is_warned_of():
    for status, text in (("AUTOMATIC", "nobody had reviewed it"), ("CANCELLED", "has withdrawn it")):
        (caution,) = _at(build_grid(PLAIN, status=status)).cautions
        assert text in caution, status


# ---------------------------------------------------------------- files that cannot be used

GOOD = build_grid(PLAIN)
BAD = {
    "empty": (b"", "the file is empty"),
    "zip": (b"PK\x03\x04" + bytes(50), r"not XML.*Download grid\.xml"),
    "HDF": (b"\x89HDF\r\n\x1a\n" + bytes(50), "not XML"),
    "JSON": (b'{"input": {}}', "not XML"),
    "text": (b"lon,lat,pga\n1,2,3\n", "not the XML of a ShakeMap"),
    "another XML": (b"<?xml version='1.0'?><svg/>", "its first element is svg, expected shakemap_grid"),
    "cut off in a row": (GOOD[:-60], "line 6: the XML is damaged or cut off"),
    "cut off in the head": (GOOD[:200], "damaged or cut off|not the XML of a ShakeMap"),
    "entities": (GOOD.replace(b"<shakemap", b'<!DOCTYPE a [<!ENTITY b "c">]><shakemap', 1), "declares XML entities"),
    "a huge claim": (build_grid(PLAIN, size=(10**9, 3)), "1,000,000,000 x 3 points are more than"),
    "no count": (GOOD.replace(b'nlon="2"', b'nlon="two"'), "nlon is 'two', expected 2 or more"),
    "rows are missing": (build_grid(PLAIN, size=(2, 4)), "6 whole rows of 3 numbers, expected 8"),
    "too many rows": (build_grid(PLAIN, size=(2, 2)), "more than 4 rows"),
    "no number": (
        build_grid({"PGA": ("pctg", (1, 2, "high", 4, 5, 6))}),
        "row 3: number 3 is 'high', which is not a number",
    ),
    "underscores": (build_grid({"PGA": ("pctg", (1, 2, "1_0", 4, 5, 6))}), "holds something that is not a number"),
    "infinite": (build_grid({"PGA": ("pctg", (1, 2, "inf", 4, 5, 6))}), "PGA is inf at"),
    "negative": (build_grid({"PGA": ("pctg", (1, 2, -3, 4, 5, 6))}), "PGA is -3 at .* expected 0 to 1000 %g"),
    "cm/s2": (build_grid({"PGA": ("cm/s2", PGA)}), "the field PGA has the unit 'cm/s2', expected %g"),
    "log10": (build_grid(PLAIN | {"STDPGA": ("log10(%g)", (0.1,) * 6)}), "STDPGA has the unit 'log10"),
    "no PGA": (build_grid({"MMI": ("intensity", PGA)}), "the field PGA is missing"),
    "a field twice": (GOOD.replace(b'name="LAT"', b'name="PGA"'), "the field PGA is there twice"),
    "no latitude": (GOOD.replace(b'name="LAT"', b'name="UP"'), "the field LAT is missing"),
    "fields not numbered": (GOOD.replace(b'index="3"', b'index="7"'), "not numbered from 1 on"),
    "no event": (GOOD.replace(b"<event ", b"<happening "), "the element event is missing"),
    "data twice": (GOOD.replace(b"<grid_data>", b"<grid_data></grid_data><grid_data>"), "grid_data is there twice"),
    "uneven": (build_grid(PLAIN, (38.0, 37.6, 37.0)), "not those of a regular grid"),
    "one place twice": (build_grid(PLAIN, longitudes=(-122.0, -122.0)), "not those of a regular grid"),
    "off the earth": (build_grid(PLAIN, (98.0, 97.5, 97.0)), "row 1: LON -122 and LAT 98 are not a place on earth"),
}


def test_a_file_that_cannot_be_used_is_named_with_the_reason():
    cases = [(data, rf"(?s)^grid\.xml: .*(?:{match})") for data, match in BAD.values()]
    check_refusals(InputError, lambda data: parse_shakemap(data, "grid.xml"), cases)


def test_no_number_is_refused_only_next_to_a_building():
    found = parse_shakemap(build_grid({"PGA": ("pctg", (1, 2, "NaN", 4, 5, 6))}), "grid.xml")
    message = r"grid\.xml: the PGA of the map is 0 or not a number \(NaN\) at latitude 37\.6"
    with pytest.raises(InputError, match=message):
        found.at(37.6, -121.7)
    site = found.at(38.0, -121.7)
    assert np.isfinite(site.pga)
    assert site.cautions == ("1 point of the ShakeMap's grid holds no value (NaN); it is not next to the building",)


def test_a_scatter_that_is_no_number_is_assumed_and_points_without_a_value_are_next_to_some_buildings_only():
    missing = "the ShakeMap holds no value (NaN) of {} next to the building: it is taken as not known there"
    found = parse_shakemap(build_grid(PLAIN | {"STDPGA": ("", ("nan",) * 6)}), "grid.xml").at(37.5, -121.7)
    assert found.dispersion > 0.5
    assert str(found.dispersion_source).startswith("assumed, as the map has none at this place")
    assert found.cautions == (missing.format("STDPGA"),)
    data = build_grid(PLAIN | {"PGV": ("cms", (1, 1, "nan", "nan", 1, 1))}, (38.0, 37.5, 37.0))
    near, far = _at(data, 37.6, -121.7), _at(data, 37.0, -121.7)
    assert near.pgv is None
    assert near.cautions == (missing.format("PGV"),)
    assert far.pgv is not None
    assert far.cautions == (
        "2 points of the ShakeMap's grid hold no value (NaN); none of them is next to the building",
    )


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"grid\.xml: the file cannot be read \(No such file"):
        read_shakemap(tmp_path / "grid.xml")
