"""Fragilities as an NRML fragility model: read as the format's documentation says, by a reader of our own.

OpenQuake's own reader is no part of these tests, as openquake.engine does not install without GDAL.
"""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from assess.errors import InputError
from assess.fragility import lognormal_chance
from assess.report.interchange.nrml import write_nrml
from assess.units import GRAVITY
from tests.report.made_fragilities import BARE, RISING, UNEVEN, assess_small, shape_curves

TAG = "{http://openquake.org/xmlns/nrml/0.5}"


def read(written):
    """Return the description, and the chance at each level [g] of ground PGA by taxonomy, as the format defines it."""
    ((name, data),) = written.files.items()
    assert name == "small office-nrml.xml"
    (model,) = ET.fromstring(data)
    assert (model.tag, model.get("id")) == (f"{TAG}fragilityModel", "assess_small_office")
    assert (model.get("assetCategory"), model.get("lossCategory")) == ("contents", "contents")
    description, states, *functions = model
    assert states.text == "overturned"
    chances = {one.get("id"): read_function(one) for one in functions}
    assert len(chances) == len(functions), "no two taxonomies are alike"
    return description.text, chances


def read_function(element):
    imls, values = element
    assert (imls.get("imt"), values.get("ls")) == ("PGA", "overturned")
    if element.get("format") == "discrete":
        levels, poes = ([float(one) for one in node.text.split()] for node in (imls, values))
        start = float(imls.get("noDamageLimit"))
        assert 0 < start < levels[0]
        return lambda x: np.interp(x, [start, *levels], [0, *poes])
    mean, spread = float(values.get("mean")), float(values.get("stddev"))
    beta = math.sqrt(math.log(1 + (spread / mean) ** 2))
    median = mean**2 / math.hypot(mean, spread)
    low, high = float(imls.get("minIML")), float(imls.get("maxIML"))
    assert 0 < low == float(imls.get("noDamageLimit")) < median < high
    return lambda x: np.where(np.asarray(x) <= low, 0, lognormal_chance(np.minimum(x, high), median, beta))


def test_each_floor_has_the_chances_of_its_amplification_at_any_strength_under_names_of_its_own(small):
    """PFA over ground PGA is 0.3 / 0.25 on floor 1, along the stronger axis, and 0.5 / 0.25 on floor 2."""
    assessment, found = small
    found = shape_curves(found, ("Shelf", RISING), ("Uneven", UNEVEN))
    description, chances = read(write_nrml(assessment, found))
    assert list(chances) == ["Shelf|1", "Shelf|2", "Uneven|1", "Uneven|2"]
    shelf, uneven = (one.curve for one in found.curves)
    pfa = np.linspace(0.01, 3, 200)
    for floor, amplification in (("1", 1.2), ("2", 2.0)):
        fitted = lognormal_chance(pfa, shelf.median / GRAVITY, shelf.dispersion)
        assert chances[f"Shelf|{floor}"](pfa / amplification) == pytest.approx(fitted, abs=1e-4)
        levels = uneven.levels / GRAVITY / amplification
        assert chances[f"Uneven|{floor}"](levels) == pytest.approx([0, 0.4, 0.4, 0.4, 1], abs=1e-4), "it never falls"
        assert f"Shelf|{floor}: Shelf on floor {floor}, PFA / ground PGA {amplification:g}." in description
    for words in ("Ground PGA 0.25 g", "its uncertainty is not in beta", "for this building only", "For screening"):
        assert words in description
    # The ground grows with the floors, so that the ratio stays.
    assessment, found = small
    twice = assess_small(scale=2.0)
    rising = ("Shelf", RISING)
    (once, scaled) = (
        read(write_nrml(one, shape_curves(each, rising)))[1]["Shelf|1"](0.3)
        for one, each in ((assessment, found), twice)
    )
    assert scaled == pytest.approx(once, rel=1e-4)
    # OpenQuake keeps the last chance of a table at every higher level, which would look safer than it is.
    assessment, found = small
    found = shape_curves(
        found, ("Shelf", RISING), ("Early", UNEVEN[:-1]), ("Late", UNEVEN[1:]), ("Still", (0.0, 0.0)), ("One", (0.5,))
    )
    written = write_nrml(assessment, found)
    description, chances = read(written)
    assert list(chances) == ["Shelf|1", "Shelf|2"]
    why = {one.name: str(one.why) for one in written.left_out}
    assert list(why) == ["Early", "Late", "Still", "One"]
    assert "give levels from where at most 2% overturn to where at least 98% do" in why["Early"]
    assert why["One"] == "not fitted: the levels are fewer than two"
    assert "Left out: Late: " in description
    assessment, found = small
    names = ["a\x00b", "<b>&\"'#", "Ａ|1", "a|1", "書架", "\ud800", "]]>"]
    found = shape_curves(found, *((name, RISING) for name in names))
    description, chances = read(write_nrml(assessment, found))
    assert len(chances) == 2 * len(names)
    assert all(one.isascii() and one.count("|") == 1 and not set(one) & set("#'\" <>&") for one in chances)
    assert "書架 on floor 1" in description


def test_what_cannot_be_written_is_refused_with_the_reason(small):
    with pytest.raises(InputError, match=r"formats: OpenQuake computes accelerations of the ground, .* Take PFA"):
        write_nrml(*assess_small(im="pfv"))
    assessment, found = small
    with pytest.raises(InputError, match=r"none of the 1 curves can be written for OpenQuake. The first is S: no log"):
        write_nrml(assessment, shape_curves(found, ("S", (0.0, 0.0))))
    # The floors' PFA is filled in: an SDS is then of a design, not of their earthquake.
    for building in ({"Height [m]": 9}, {"Height [m]": 9, "SDS [g]": 1.0}):
        with pytest.raises(InputError, match=r"formats: nrml relates each floor to the ground.* Fill in Ground PGA"):
            write_nrml(*assess_small(building))


@pytest.mark.slow
def test_a_profile_starts_from_the_ground_of_sds():
    """Floors that follow the profile belong to 0.4 SDS."""
    assessment, found = assess_small({"Height [m]": 9, "SDS [g]": 1.0, "Scenario kind": "ASCE 7-22"}, floors=BARE)
    description, chances = read(write_nrml(assessment, shape_curves(found, ("Shelf", RISING))))
    assert "Ground PGA 0.4 g" in description
    assert "Shelf|2" in chances
