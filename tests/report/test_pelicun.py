"""Fragilities as a damage database of pelicun. That pelicun reads it right: tests/interop/test_pelicun_reads.py."""

import csv
import io
import json
import re

import pytest

from assess.errors import InputError
from assess.report.interchange.pelicun import write_pelicun
from assess.units import GRAVITY
from tests.report.made_fragilities import RISING, STEEP, UNEVEN, assess_small, shape_curves


def read(written):
    table, about = (written.files[f"small office-pelicun.{kind}"].decode() for kind in ("csv", "json"))
    return list(csv.DictReader(io.StringIO(table))), json.loads(about)


@pytest.mark.parametrize(
    ("im", "demand", "unit", "size"),
    [("pfa", "Peak Floor Acceleration", "g", GRAVITY), ("pfv", "Peak Floor Velocity", "mps", 1.0)],
)
def test_medians_and_betas_are_those_found(im, demand, unit, size):
    assessment, found = assess_small(im=im)
    found = shape_curves(found, ("Shelf", RISING), ("Uneven", UNEVEN), ("Cabinet", STEEP))
    written = write_pelicun(assessment, found)
    rows, about = read(written)
    kept = [one for one in found.curves if one.curve.is_lognormal]
    assert [one.name for one in kept] == ["Shelf", "Cabinet"]
    assert [one.name for one in written.left_out] == ["Uneven"]
    for row, one in zip(rows, kept, strict=True):
        assert (row["Demand-Type"], row["Demand-Unit"], row["LS1-Family"]) == (demand, unit, "lognormal")
        assert (row["Incomplete"], row["Demand-Offset"], row["Demand-Directional"]) == ("0", "0", "1")
        assert float(row["LS1-Theta_0"]) == pytest.approx(one.curve.median / size, rel=1e-5)
        assert float(row["LS1-Theta_1"]) == pytest.approx(one.curve.dispersion, rel=1e-5)
        assert about[row["ID"]]["Description"].startswith(one.name)
        assert row["ID"].endswith(f".{im}")


def test_identifiers_are_safe_and_unique_and_what_it_is_of_stands_in_the_metadata(small):
    """A name that reads as a formula, as markup or in another script; alike but for case; alike after shortening."""
    assessment, found = small
    names = ["=1+2", "<b>Böse & 'Co'</b>", "書架", "shelf a", "Shelf-A", "Shelf A 2", "x" * 99, "x" * 98, "書"]
    rows, about = read(write_pelicun(assessment, shape_curves(found, *((name, RISING) for name in names))))
    ids = [row["ID"] for row in rows]
    assert len({one.lower() for one in ids}) == len(names)
    assert all(re.fullmatch(r"assess(\.[A-Za-z0-9]+)+", one) for one in ids)
    assert [about[one]["Description"].partition(": base")[0] for one in ids] == names
    assessment, found = small
    with pytest.raises(
        InputError, match=r"formats: none of the 1 curves can be written for pelicun. The first is U: no"
    ):
        write_pelicun(assessment, shape_curves(found, ("U", UNEVEN)))
    assessment, found = small
    found = shape_curves(found, ("Shelf", RISING), ("Uneven", UNEVEN), ("Still", (0.0, 0.0)))
    rows, about = read(write_pelicun(assessment, found))
    general = about.pop("_GeneralInformation")
    assert [row["ID"] for row in rows] == list(about) == ["assess.small.office.Shelf.pfa"]
    for words in (
        "small office.xlsx", f"SHA-256 {assessment.inventory.sha256}", "60 motions, seed 3", "For screening",
        "maximum binomial likelihood", "The uncertainty of the motion is not in them, that of the pieces is",
    ):  # fmt: skip
        assert words in general["Description"]
    assert "NonDirectionalMultipliers" in general["Use"]
    (one,) = about.values()
    assert one["Description"] == "Shelf: base 30 to 40 cm, height 180 cm, free-standing"
    curve = found.curves[0].curve
    assert f"median {curve.median / GRAVITY:.4g} g" in one["Comments"]
    assert f"largest misfit {curve.misfit:.3f}" in one["Comments"]
    assert re.search(r"PFV/PFA of the motions: 0\.\d+ to 0\.\d+ s\.", one["Comments"])
    assert general["LeftOut"] == [
        {
            "Name": "Uneven",
            "Reason": "no lognormal stands in for its table: the misfit exceeds 0.05. More draws lessen "
            "the part of it that is chance; the table itself is in the formats csv and json",
        },
        {"Name": "Still", "Reason": "not fitted: nothing fell at any level"},
    ]
