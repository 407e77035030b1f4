"""Fragilities as a damage database of pelicun: a table of components, and what they are.

Reference
---------
Zsarnóczay A, Deierlein GG (2020). PELICUN: A computational framework for estimating damage, loss and community
resilience. 17th World Conference on Earthquake Engineering. Format: pelicun 3.10, damage databases of SimCenter's
DamageAndLossModelLibrary (`fragility.csv`, `fragility.json`).

Departures
----------
Components are directional: one at location k and direction d reads ``1-PFA-(k-1)-d`` (pelicun's own offset of -1), the
floor on which the contents of storey k stand. A component that is not directional takes 1.2 times the larger direction,
unless ``NonDirectionalMultipliers`` says otherwise, so that its median would not be that of the curve.
"""

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from assess.fragility import MOST_MISFIT
from assess.i18n import fill
from assess.pipeline.adopt import Assessment
from assess.pipeline.piece_fragility import PieceFragilities
from assess.report.interchange import exchange_files as files
from assess.text import plain_line
from assess.units import GRAVITY
from assess.version import __version__

DEMANDS: Mapping[str, tuple[str, str, float]] = {
    "pfa": ("Peak Floor Acceleration", "g", GRAVITY),
    "pfv": ("Peak Floor Velocity", "mps", 1.0),
}
"""What pelicun calls each intensity measure, its unit there, and that unit in SI."""
HEADS = (
    "ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional",
    "LS1-Family", "LS1-Theta_0", "LS1-Theta_1", "LS1-DamageStateWeights",
)  # fmt: skip
USE = (
    "Demand-Directional is 1: give each component the direction along which it overturns, 1 or 2. Where that is not "
    'known, direction 0 takes the larger one; set "NonDirectionalMultipliers": {"ALL": 1.0} then, as pelicun '
    "multiplies by 1.2 by default. Location k reads the demand of floor k-1, on which the contents of storey k stand."
)


def write_pelicun(assessment: Assessment, found: PieceFragilities) -> files.Exchange:
    """Write the lognormals as a damage database, NAME-pelicun.csv and NAME-pelicun.json; pelicun takes nothing else.

    `found` is of `assessment`, by `assess.pipeline.piece_fragility.find_piece_fragilities`. Raises InputError if no
    curve can be written.
    """
    rough = fill(
        "no lognormal stands in for its table: the misfit exceeds {most:g}. More draws lessen the part of it that is "
        "chance; the table itself is in the formats csv and json",
        most=MOST_MISFIT,
    )
    kept, left = files.choose_curves(
        "pelicun", found.curves,
        lambda one: None if one.curve.is_lognormal else rough if one.curve.kind == "fitted" else one.curve.why,
    )  # fmt: skip
    stem = Path(assessment.inventory.file_name).stem
    names = files.name_safely((f"{stem} {one.name} {found.im}" for one in kept), ".")
    ids = [f"assess.{name}" for name in names]
    demand, unit, size = DEMANDS[found.im]
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(HEADS)
    for key, curve in zip(ids, (one.curve for one in kept), strict=True):
        theta, beta = files.round_number(curve.median / size), files.round_number(curve.dispersion)
        writer.writerow([key, 0, demand, unit, 0, 1, "lognormal", theta, beta, ""])
    about: dict[str, Any] = {
        "_GeneralInformation": {
            "ShortName": f"assess: {plain_line(stem)}",
            "Description": files.describe_origin(assessment, found),
            "Version": __version__,
            "Use": USE,
            "LeftOut": [{"Name": plain_line(one.name), "Reason": str(one.why)} for one in left],
        }
    }
    for key, one in zip(ids, kept, strict=True):
        about[key] = {
            "Description": f"{plain_line(one.name)}: {files.say_sizes(one)}",
            "Comments": " ".join(files.describe_curve(one, found.im)),
            "SuggestedComponentBlockSize": "1 EA",
            "RoundUpToIntegerQuantity": "True",
            "LimitStates": {"LS1": {"DS1": {"Description": "Overturns."}}},
        }
    return files.Exchange(
        files={
            f"{stem}-pelicun.csv": table.getvalue().encode(),
            f"{stem}-pelicun.json": f"{json.dumps(about, ensure_ascii=False, allow_nan=False, indent=1)}\n".encode(),
        },
        left_out=left,
    )
