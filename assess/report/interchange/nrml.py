"""Fragilities as an NRML fragility model of OpenQuake, against the PGA of the ground.

Reference
---------
Global Earthquake Model Foundation. OpenQuake Engine manual, fragility models: NRML 0.5, ``fragilityModel``.

Departures
----------
OpenQuake has no intensity measure of a floor, so that a curve is written once for each floor with its levels multiplied
by ground PGA / PFA of the floor in the scenario assessed (of two axes, and of parallel records, the least: at a given
PGA the chance is then at least that of each), with the taxonomy ``type|floor``, no two alike. The floor amplifies alike
at every level, and without scatter.
"""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from assess.errors import InputError
from assess.i18n import Text, fill
from assess.pipeline.adopt import Assessment
from assess.pipeline.known_ground import find_ground
from assess.pipeline.piece_fragility import PieceFragilities, PieceFragility
from assess.report.interchange import exchange_files as files
from assess.text import plain_line
from assess.units import GRAVITY

NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"
LIMIT_STATE = "overturned"
REACH = 4.0
"""Least and largest level of a lognormal, in standard deviations: beyond them lie 0.003 % of the chance each. OpenQuake
divides this range into steps, so that a wider one would be read more coarsely."""
ENDS = 0.02
"""Share that may fall at the first level of a table, and stand at its last one: OpenQuake does not extrapolate."""
BELOW = 0.1
"""Level from which a table's chance grows from 0 to that of its first level, over that level."""
PER_FLOOR = (
    "One function for each type or item and floor, against the peak ground acceleration: levels of the floor's PFA "
    "times ground PGA / PFA of the floor in the scenario. The amplification from ground to floor is that of the "
    "scenario at every level, and its uncertainty is not in beta, nor is that of the ground motion. The functions hold "
    "for this building only."
)


def write_nrml(assessment: Assessment, found: PieceFragilities) -> files.Exchange:
    """Write the curves as a fragility model, NAME-nrml.xml; where no lognormal stands in, the table is written.

    The scenario of `assessment` gives the PGA of the ground; `found` is of it and against PFA, by
    `assess.pipeline.piece_fragility.find_piece_fragilities`. Raises InputError if the measure is PFV, the ground PGA is
    unknown, or no curve can be written.
    """
    pga = find_ground_pga(assessment, found.im)
    kept, left = files.choose_curves("OpenQuake", found.curves, _judge)
    stem = Path(assessment.inventory.file_name).stem
    floors = list(dict.fromkeys(floor for one in kept for floor in one.floors))
    root = ET.Element("nrml", {"xmlns": NAMESPACE})
    (name,) = files.name_safely([f"assess {stem}"], "_")
    model = ET.SubElement(root, "fragilityModel", {"id": name, "assetCategory": "contents", "lossCategory": "contents"})
    lines = [files.describe_origin(assessment, found), f"{PER_FLOOR} Ground PGA {pga / GRAVITY:.4g} g."]
    description = ET.SubElement(model, "description")
    ET.SubElement(model, "limitStates").text = LIMIT_STATE
    level = dict(zip(floors, files.name_safely(floors, "_"), strict=True))
    for name, one in zip(files.name_safely((one.name for one in kept), "_"), kept, strict=True):
        for floor in one.floors:
            taxonomy = f"{name}|{level[floor]}"
            ratio = pga / max(motion.demand.pfa for motion in one.motions if motion.floor == floor)
            what = f"{taxonomy}: {plain_line(one.name)} on floor {plain_line(floor)}"
            lines.append(" ".join([f"{what}, PFA / ground PGA {1 / ratio:.4g}.", *files.describe_curve(one, found.im)]))
            _add_function(model, taxonomy, one, ratio)
    description.text = "\n".join([*lines, *(f"Left out: {plain_line(one.name)}: {one.why}." for one in left)])
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return files.Exchange(files={f"{stem}-nrml.xml": data + b"\n"}, left_out=left)


def find_ground_pga(assessment: Assessment, im: str) -> float:
    """Return the ground PGA that goes with the motions of the floors [m/s2]; InputError if unknown, or `im` is PFV."""
    if im != "pfa":
        raise InputError.about(
            "formats: OpenQuake computes accelerations of the ground, which a PFV cannot be derived from: nrml is "
            "written for curves against PFA only. Take PFA as the measure, or another format."
        )
    pga = find_ground(assessment.inventory).find_pga({one.source for one in assessment.case_demand})
    if pga is None:
        raise InputError.about(
            "formats: nrml relates each floor to the ground, whose peak acceleration in this scenario is not "
            "known. Fill in Ground PGA in the sheet Building, that of the same earthquake as the floors' motions."
        )
    return assessment.settings.scale * pga


def _judge(one: PieceFragility) -> Text | None:
    """Return why a curve cannot be written; None where its lognormal stands in, or its table is whole."""
    curve = one.curve
    if curve.is_lognormal:
        return None
    if curve.levels.size < 2:
        return curve.why
    if curve.shares[0] > ENDS or curve.shares.max() < 1 - ENDS:
        return fill(
            "no lognormal stands in for its table, and OpenQuake does not continue a table: give levels from where at "
            "most {low:.0%} overturn to where at least {high:.0%} do",
            low=ENDS,
            high=1 - ENDS,
        )
    return None


def _add_function(model: ET.Element, name: str, one: PieceFragility, ratio: float) -> None:
    """Add the curve of a floor, whose ground PGA / PFA is `ratio` [-].

    A lognormal is continuous: NRML gives the mean and the standard deviation of the level, not of its logarithm. A
    table is discrete: its chances do not fall where those of the draws do.
    """
    curve = one.curve
    if curve.is_lognormal:
        median, beta = curve.median * ratio / GRAVITY, curve.dispersion
        mean = median * math.exp(beta**2 / 2)
        lowest, highest = (_write_number(median * math.exp(sign * REACH * beta)) for sign in (-1, 1))
        own = ET.SubElement(model, "fragilityFunction", {"id": name, "format": "continuous", "shape": "logncdf"})
        ET.SubElement(own, "imls", {"imt": "PGA", "noDamageLimit": lowest, "minIML": lowest, "maxIML": highest})
        spread = mean * math.sqrt(math.expm1(beta**2))
        ET.SubElement(own, "params", {"ls": LIMIT_STATE, "mean": _write_number(mean), "stddev": _write_number(spread)})
        return
    levels, shares = (curve.levels * ratio / GRAVITY).tolist(), np.maximum.accumulate(curve.shares).tolist()
    own = ET.SubElement(model, "fragilityFunction", {"id": name, "format": "discrete"})
    imls = ET.SubElement(own, "imls", {"imt": "PGA", "noDamageLimit": _write_number(BELOW * levels[0])})
    imls.text = " ".join(map(_write_number, levels))
    ET.SubElement(own, "poes", {"ls": LIMIT_STATE}).text = " ".join(map(_write_number, shares))


def _write_number(value: float) -> str:
    return repr(files.round_number(value))
