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


@pytest.fixture(scope="module")
def small():
    return assess_small()


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


def test_identifiers_are_safe_and_unique(small):
    """A name that reads as a formula, as markup or in another script; alike but for case; alike after shortening."""
    assessment, found = small
    names = ["=1+2", "<b>Böse & 'Co'</b>", "書架", "shelf a", "Shelf-A", "Shelf A 2", "x" * 99, "x" * 98, "書"]
    rows, about = read(write_pelicun(assessment, shape_curves(found, *((name, RISING) for name in names))))
    ids = [row["ID"] for row in rows]
    assert len({one.lower() for one in ids}) == len(names)
    assert all(re.fullmatch(r"assess(\.[A-Za-z0-9]+)+", one) for one in ids)
    assert [about[one]["Description"].partition(": base")[0] for one in ids] == names


def test_nothing_is_written_where_there_is_no_lognormal(small):
    assessment, found = small
    with pytest.raises(
        InputError, match=r"formats: none of the 1 curves can be written for pelicun. The first is U: no"
    ):
        write_pelicun(assessment, shape_curves(found, ("U", UNEVEN)))
