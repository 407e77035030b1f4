"""Hazard curves: files as people and OpenQuake write them, the nearest site, and what is wrong with a file."""

import math
from pathlib import Path

import numpy as np
import pytest

from assess.errors import InputError
from assess.hazard import find_distance, parse_hazard
from assess.i18n import Text
from assess.units import GRAVITY as G
from tests.hazards import read_hazard
from tests.refusals import check_refusals

DATA = Path(__file__).parent / "data" / "hazard"
CASE_33, CASE_44 = (DATA / f"oq-case{number}-hazard_curve-mean-PGA.csv" for number in (33, 44))

PLAIN = "pga_g,annual_rate\n0.05,0.02\n0.1,0.007\n0.4,2.105e-3\n"
SITES = """#,,,,,"generated_by='OpenQuake engine 3.20.0', kind='mean', investigation_time=50.0, imt='PGA'"
lon,lat,depth,poe-0.1000000,poe-0.2000000,poe-0.4000000
13.0,42.0,0.0,9.0E-01,4.0E-01,1.0E-01
13.5,42.0,0.0,8.0E-01,3.0E-01,5.0E-02
-120.0,37.0,0.0,1.000000E+00,5.0E-01,0.000000E+00
"""


def parse(text, **where):
    return parse_hazard(text.encode(), "curve.csv", **where)


# --- two columns ---


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        "annual_rate,pga_g\n0.02,0.05\n0.007,0.1\n2.105e-3,0.4\n",
        "\ufeff# site: town hall\r\n\r\nPGA_g , Annual_Rate\r\n0.05,0.02\r\n# 475 years is the last\r\n0.1,0.007\r\n"
        ".4,2.105E-03,,\r\n",
        '"pga_g";"annual_rate"\n0,05;0,02\n0,1;0,007\n0,4;0,002105\n',
        "pga_g\tannual_rate\n0.05\t0.02\n0.1\t0.007\n0.4\t0.002105\n",
    ],
)
def test_tables_as_people_write_them(text):
    curve = parse(text)
    np.testing.assert_allclose(curve.pga, np.array([0.05, 0.1, 0.4]) * G, rtol=1e-15)
    np.testing.assert_allclose(curve.rate, [0.02, 0.007, 0.002105], rtol=1e-15)
    assert (curve.file, curve.latitude, curve.longitude, curve.distance, curve.notes) == (
        "curve.csv", None, None, None, (),
    )  # fmt: skip
    assert not curve.is_far


def test_tables_in_latin_1_with_level_rates_or_a_last_line_that_may_be_cut_off():
    assert parse_hazard("# sito: città\n".encode("latin-1") + PLAIN.encode(), "x.csv").rate.size == 3
    level = parse("pga_g,annual_rate\n0.01,0.02\n0.1,0.02\n0.4,0.002\n").rate
    np.testing.assert_array_equal(level, [0.02, 0.02, 0.002])
    # The last rate would be read as a smaller one; what people type may end without an end of line.
    text = "pga_g,annual_rate\n0.1,0.0123\n0.4,0.0019"
    assert parse(f"{text}\n").notes == ()
    for cut in (text, text[:-1]):
        (note,) = parse(cut).notes
        assert str(note).startswith("the last line of the hazard file has no end: see that its last rate is whole")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "curve.csv: there is no table. Its first row has to be: pga_g,annual_rate"),
        ("# only this\n,,\n", "curve.csv: there is no table"),
        ("0.05,0.02\n0.1,0.007\n", "curve.csv: line 1: the first row has to be pga_g,annual_rate, or that of hazard"),
        ("# x\npga,rate\n0.05,0.02\n", "curve.csv: line 2: the first row has to be"),
        ("pga_g,annual_rate,note\n0.05,0.02,a\n", "curve.csv: line 1: the first row has to be"),
        ("pga_g,annual_rate\n", "curve.csv: the number of rows is 0: a curve needs two or more"),
        ("pga_g,annual_rate\n0.05,0.02\n", "curve.csv: the number of rows is 1"),
        ("pga_g,annual_rate\n0.05,0.02\n\n0.1\n", "curve.csv: line 4: the number of cells is 1, not 2"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,7e-3,8\n", "curve.csv: line 3: the number of cells is 3, not 2"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,1/475\n", "curve.csv: line 3: annual_rate is '1/475', not a number"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,nan\n", "curve.csv: line 3: annual_rate is 'nan', not a number"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,1e999\n", "curve.csv: line 3: annual_rate is '1e999', not a number"),
        ("pga_g,annual_rate\n0.05,0.02\n1_0,0.01\n", "curve.csv: line 3: pga_g is '1_0', not a number"),
        ("pga_g,annual_rate\n0,0.02\n0.1,0.01\n", "curve.csv: line 2: pga_g is 0, expected above 0 and at most 50"),
        ("pga_g,annual_rate\n5,0.02\n98.1,0.01\n",
         "curve.csv: line 3: pga_g is 98.1, expected above 0 and at most 50, in g"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,0\n", "curve.csv: line 3: annual_rate is 0, expected above 0"),
        ("pga_g,annual_rate\n0.05,0.02\n0.1,-1e-3\n", "curve.csv: line 3: annual_rate is -0.001, expected above 0"),
        ("pga_g,annual_rate\n0.1,0.02\n0.05,0.01\n", "curve.csv: line 3: pga_g 0.05 does not rise from 0.1"),
        ("pga_g,annual_rate\n0.1,0.02\n0.1,0.01\n", "curve.csv: line 3: pga_g 0.1 does not rise from 0.1"),
        ("pga_g,annual_rate\n0.1,50\n0.2,475\n",
         "curve.csv: line 3: annual_rate rises from 50 to 475, but it has to fall as"),
        ("pga_g,annual_rate\n0.1,0.01\n0.2,0.01\n", "curve.csv: the annual rate is the same in every row"),
    ],
)  # fmt: skip
def test_tables_that_cannot_be_used(text, message):
    with pytest.raises(InputError) as raised:
        parse(text)
    assert str(raised.value).startswith(message)
    assert isinstance(raised.value.message, Text), "it can be translated"


def test_files_that_are_no_text_or_too_large_or_cannot_be_read(monkeypatch, tmp_path):
    no_text = r"x\.csv: the file is not plain text\. Save it as CSV UTF-8"
    check_refusals(InputError, lambda data: parse_hazard(data, "x.csv"), [
        (b"PK\x03\x04", no_text), (b"\xff\xfep\0g\0a\0", no_text), (b"pga_g\0", no_text),
        # str.splitlines() makes a line of each of these signs, too: at ten times the memory of the file.
        (b"pga_g,annual_rate\n0.1\x0b0.2\x1c0.3\n", r"line 2: the number of cells is 1, not 2"),
    ])  # fmt: skip
    unread = [(tmp_path / "none.csv", r"none\.csv: the file cannot be read \(No such file")]
    check_refusals(InputError, read_hazard, [*unread, (tmp_path, "the file cannot be read")])
    many = r"^x\.csv: the file has more than 1,500,000 cells: cut it to the sites near"
    monkeypatch.setattr("assess.hazard.find_distance", pytest.fail)
    check_refusals(InputError, lambda mark: parse_hazard(b"pga_g,annual_rate\n" + mark * 1_500_000, "x.csv"), [
        (mark, many) for mark in (b"1,", b"1\n", b";", b"\t", b"\r")
    ])  # fmt: skip
    monkeypatch.setattr("assess.hazard.LARGEST_FILE", 20)
    with pytest.raises(InputError, match="larger than"):
        parse(PLAIN)


# --- OpenQuake ---


def test_oq_case_33_in_50_years():
    """Chances in 50 years; the last three levels have none, the first ones the same."""
    curve = read_hazard(CASE_33)
    assert (curve.latitude, curve.longitude, curve.distance) == (37.895, 14.905, None)
    assert curve.pga[0] == pytest.approx(1e-6 * G)
    assert curve.pga[-1] == pytest.approx(0.0248532 * G)
    assert curve.pga.size == curve.rate.size == 25
    assert curve.rate[0] == pytest.approx(-math.log(1 - 0.5539548) / 50, rel=1e-12)
    assert curve.rate[-1] == pytest.approx(1.518764e-4 / 50, rel=1e-4)
    assert (np.diff(curve.rate) <= 0).all()
    assert [str(note) for note in curve.notes] == ["3 levels whose chance is 0 or 1 were left out"]


def test_oq_case_44_in_1_year():
    curve = read_hazard(CASE_44, latitude=0.0, longitude=0.05)
    assert curve.pga[[0, -1]] == pytest.approx(np.array([0.005, 2.13]) * G)
    assert curve.rate[0] == pytest.approx(9.571899e-4, rel=1e-3)
    assert curve.rate[0] == pytest.approx(-math.log1p(-9.571899e-4), rel=1e-12)
    assert curve.notes == ()
    assert curve.distance == pytest.approx(math.radians(0.05) * 6_371_000, rel=1e-9)
    assert not curve.is_far
    assert read_hazard(CASE_44, latitude=0.0, longitude=0.1).is_far


def test_the_nearest_site_is_taken():
    curve = parse(SITES, latitude=42.1, longitude=13.3)
    assert (curve.latitude, curve.longitude) == (42.0, 13.5)
    np.testing.assert_allclose(curve.rate, -np.log1p(-np.array([0.8, 0.3, 0.05])) / 50, rtol=1e-14)
    assert 19_500 < curve.distance < 20_500
    assert curve.is_far
    assert parse(SITES, latitude=42.1, longitude=13.2).longitude == 13.0


def test_chances_of_0_and_1_are_left_out():
    text = SITES.replace("1.000000E+00,5.0E-01,0.000000E+00", "1.000000E+00,5.0E-01,1.0E-01")
    curve = parse(text, latitude=37, longitude=240.001)
    assert curve.longitude == -120
    assert curve.distance < 100
    np.testing.assert_allclose(curve.pga, np.array([0.2, 0.4]) * G)
    assert str(curve.notes[0]) == "1 level whose chance is 0 or 1 was left out"
    curve = parse(SITES.replace("kind='mean'", "kind='quantile-0.85'"), latitude=42, longitude=13)
    assert [str(note) for note in curve.notes] == ["the curve is 'quantile-0.85', not the mean"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("imt='PGA'", "imt='SA(0.3)'"), "the curve is of SA(0.3), expected PGA"),
        (("investigation_time=50.0", "time=50.0"), "the first line has no investigation_time above 0"),
        (("investigation_time=50.0", "investigation_time=1e-308"), "investigation_time is 1e-308, expected 0.01 to 1e"),
        (("investigation_time=50.0", "investigation_time=0"), "the first line has no investigation_time above 0"),
        (("poe-0.2000000", "poe-0.0500000"), "line 2: expected two or more columns poe-LEVEL with rising levels"),
        (("poe-0.2000000", "poe-x"), "line 2: poe-x is 'x', not a number"),
        (("poe-0.2000000", f"poe-{'x' * 90}"), f"line 2: poe-{'x' * 36} is '{'x' * 40}', not a number"),
        (("13.0,42.0,0.0,9.0E-01,", "13.0,42.0,0.0,"), "line 3: the number of cells is 5, but there are 6 headings"),
        (("13.0,42.0", "13.0,91.0"), "line 3: lon 13 and lat 91 are not a place on earth"),
        (("13.5,42.0", "13.5,north"), "line 4: lat is 'north', not a number"),
        (("9.0E-01", "9.0E+01"), "line 3: the chance of exceeding 0.1 g is 90, expected 0 to 1"),
        (("4.0E-01", "much"), "line 3: poe-0.2000000 is 'much', not a number"),
        (("4.0E-01", "9.5E-01"), "line 3: the chance of exceeding 0.2 g is larger than that of the level before"),
        (("9.0E-01,4.0E-01,1.0E-01", "1.0,1.0,1.0E-01"), "line 3: fewer than two chances are between 0 and 1"),
    ],
)
def test_sites_that_cannot_be_used(change, message):
    assert change[0] in SITES
    with pytest.raises(InputError) as raised:
        parse(SITES.replace(change[0], change[1], 1), latitude=42, longitude=13)
    assert str(raised.value).startswith(f"curve.csv: {message}")


def test_several_sites_need_a_place():
    needed = "the file has 3 sites: the building's latitude and longitude are needed"
    places: tuple[dict[str, float], ...] = ({}, {"latitude": 42.0}, {"longitude": 13.0})
    check_refusals(InputError, lambda where: parse(SITES, **where), [(where, needed) for where in places])
    with pytest.raises(InputError, match="there are no sites"):
        parse("\n".join(SITES.splitlines()[:2]))


def test_distances():
    """A degree of latitude; a quarter of the earth; across the date line; the antipode."""
    degree = math.pi * 6_371_000 / 180
    found = find_distance(0.0, 179.0, np.array([1.0, 90.0, 0.0, 0.0]), np.array([179.0, 10.0, -180.0, -1.0]))
    np.testing.assert_allclose(found, np.array([1, 90, 1, 180]) * degree, rtol=1e-9)


@pytest.mark.parametrize("name", ["oq-case33", "oq-case44"])
def test_a_cut_table_of_openquake_is_never_read_as_another_curve(name):
    data = (DATA / f"{name}-hazard_curve-mean-PGA.csv").read_bytes()
    whole = parse_hazard(data, "h.csv", latitude=0, longitude=0)
    for end in range(len(data)):
        try:
            cut = parse_hazard(data[:end], "h.csv", latitude=0, longitude=0)
        except InputError as error:
            assert str(error).startswith("h.csv: ")  # noqa: PT017 - most cuts are refused, some leave the curve whole
            continue
        assert cut.rate.tolist() == whole.rate.tolist()
