"""The series of figures, computed with the methods and motions and kept in one file, so that reports need neither.

Arrays by name; `m` is a place in `Results.motions`:

=========================== ==========================================================================================
``workbook``, ``logo``      bytes of the workbook and of the logo (uint8), where there are any
``plan/f``                  bytes of the plan of floor f of `Results.floor_rows`, where it is drawn: see `FloorPlan`
``photo/p``                 bytes of the p-th photo (JPEG); ``photo/of_item`` (n,) which one each item has, -1 for none
``motion/m/acceleration_g`` the recorded motion as treated (n,)
``motion/m/cases``          places in `Results.cases_table` of the c cases that were simulated under its ensemble
``motion/m/runs``           (c,) motions that each was simulated under, the first ones
``motion/m/overturned``     (c, ceil(k/8)) one bit a motion, the first in the highest bit (`numpy.unpackbits`)
``motion/m/rotation``       (c, k) largest |theta| over the critical angle [-]; 0 beyond its runs
``motion/m/example/j``      the j-th of the first motions [g], ``motion/m/example_steps_s`` their time steps
``motion/m/periods_s``      (p,) periods of the spectra
``motion/m/spectra_g``      (k, p) 5 % pseudo-acceleration of the first motions; ``motion/m/target_g`` and
                            ``motion/m/record_spectrum_g`` (p,) what their mean is to meet, and the record's own
``contours/...``            ``items``, ``height_cm``, ``pfv_per_pfa_s``, ``breadth_cm`` (b,), ``pfa_g`` (a,), and by the
                            key of each method that is drawn its chance (a, b)
=========================== ==========================================================================================
"""

import io
import math
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from assess.errors import CancelledError
from assess.methods import Cases
from assess.pipeline.adopt import Assessment
from assess.pipeline.demand import Demand
from assess.progress import SILENT, Progress
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.text import natural_key
from assess.units import ACCELERATION, GRAVITY, LENGTH, ROUNDING, VELOCITY

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

ALIKE = 0.1
"""Pieces whose height is this close to the chosen one are drawn on the contours [-]."""
FINE_BELOW = 50.0
"""Heights [cm] below which they are rounded to 1 cm in place of 10 cm."""
STEPS = 121
"""Points of the grid along each side."""
SLENDER, STOUT = 0.08, 0.45
"""The grid reaches from the first to the second B/H [-], and further where pieces lie."""
WEAKEST, STRONGEST, BEYOND = 0.02, 0.4, 2.0
"""It reaches from the first to the second PFA [g], at least to as many times the largest of a piece as the third."""

Arrays = dict[str, NDArray[Any]]


class _CheckedFile(io.BufferedWriter):
    """A file at a path, which asks before each write whether to stop."""

    def __init__(self, path: Path, progress: Progress) -> None:
        super().__init__(io.FileIO(path, "wb"))
        self._progress = progress

    def write(self, data: "ReadableBuffer", /) -> int:
        """Write."""
        self._progress.check()
        return super().write(data)


def build_series(
    assessment: Assessment, demands: Sequence[Demand], results: Iterable[ItemResult], progress: Progress = SILENT
) -> Arrays:
    """Compute the series."""
    inventory, joints, files = assessment.inventory, assessment.joints, dict[str, bytes]()
    if inventory.data:
        files["workbook"] = inventory.data
    logo = inventory.building.logo
    if logo is not None and logo.is_file():
        files["logo"] = logo.read_bytes()
    files |= {f"plan/{at}": one.plan.content for at, one in enumerate(inventory.floors) if one.plan is not None}
    arrays: Arrays = {name: np.frombuffer(content, dtype=np.uint8) for name, content in files.items()}
    order = {name: at for at, name in enumerate(inventory.photos)}
    if order:
        arrays["photo/of_item"] = np.array([order.get(item.more.get("photo", ""), -1) for item in inventory.items])
    arrays |= {f"photo/{at}": np.frombuffer(inventory.photos[name], dtype=np.uint8) for name, at in order.items()}
    for index, demand in enumerate(demands):
        progress.check()
        own, motion, joint = dict[str, NDArray[Any]](), demand.motion, joints.get(demand)
        spectra = None if joint is None else joint.spectra
        if motion is not None and not demand.is_borrowed:
            own["acceleration_g"] = (motion.acceleration / GRAVITY).astype(np.float32)
        if joint is not None:
            own |= {"cases": joint.cases.astype(np.int32), "runs": joint.runs.astype(np.int32)}
            own |= {"overturned": np.packbits(joint.fell, axis=1), "rotation": joint.rotation}
            examples = enumerate(joint.examples)
            own |= {f"example/{at}": (values / GRAVITY).astype(np.float32) for at, (values, _) in examples}
            own["example_steps_s"] = np.array([step for _, step in joint.examples])
        if spectra is not None:
            own |= {"periods_s": spectra.periods, "spectra_g": (spectra.ordinates / GRAVITY).astype(np.float32)}
        if spectra is not None and spectra.target is not None:
            own["target_g"] = spectra.target / GRAVITY
        elif spectra is not None and motion is not None:
            from assess.motion.spectrum import response_spectrum

            recorded = response_spectrum(motion.acceleration, motion.time_step, spectra.periods).pseudo
            own["record_spectrum_g"] = recorded / GRAVITY
        arrays |= {f"motion/{index}/{name}": array for name, array in own.items()}
    return arrays | {f"contours/{name}": array for name, array in _contours(assessment, results)}


def write_series(path: Path, arrays: Arrays, progress: Progress = SILENT) -> None:
    """Write the series to `path`; OSError if it cannot be written; CancelledError, and no file, if stopped."""
    try:
        # numpy.savez may not close its own file
        with _CheckedFile(path, progress) as file, zipfile.ZipFile(file, "w") as box:
            for name, array in arrays.items():
                with box.open(f"{name}.npy", "w", force_zip64=True) as part:
                    np.lib.format.write_array(part, array, allow_pickle=False)
    except CancelledError:
        path.unlink(missing_ok=True)
        raise


def _contours(assessment: Assessment, results: Iterable[ItemResult]) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the grid for the height that most risky pieces share, else the commonest; nothing without pieces."""
    free = [one for one in results if not one.is_anchored]
    if not free:
        return
    counts: Counter[float] = Counter()
    for one in [one for one in free if one.adopted.upper >= RiskClass.HIGH] or free:
        step = 10.0 if one.item.height_cm >= FINE_BELOW else 1.0  # halves go up
        counts[math.floor(one.item.height_cm / step * (1 + ROUNDING) + 0.5) * step] += one.item.quantity
    height = max(counts, key=lambda height: (counts[height], height))  # that most pieces (not rows) share
    near = [one for one in free if abs(one.item.height_cm - height) <= ALIKE * height * (1 + ROUNDING)]
    pieces = sorted(near, key=lambda one: (-one.adopted.upper, -one.adopted.probability, natural_key(one.item.item)))
    worst = pieces[0].governing.motion
    ratio = math.nan  # PFV over PFA [s] of the motion that governs the worst piece
    if worst.pfv_cm_s and worst.pfa_g:
        ratio = worst.pfv_cm_s * VELOCITY["cm/s"] / (worst.pfa_g * GRAVITY)
    breadths = [one.item.breadth_cm for one in pieces]
    pfas = [one.governing.motion.pfa_g for one in pieces]
    thinnest, widest = min(SLENDER * height, 0.85 * min(breadths)), max(STOUT * height, 1.1 * max(breadths))
    weakest, strongest = min(WEAKEST, 0.85 * min(pfas)), max(STRONGEST, BEYOND * max(pfas))
    breadth, pfa = np.linspace(thinnest, widest, STEPS), np.linspace(weakest, strongest, STEPS)
    yield "items", np.array([one.item.index for one in pieces], dtype=np.int32)
    yield "height_cm", np.array(height)
    yield "pfv_per_pfa_s", np.array(ratio)
    yield "breadth_cm", breadth
    yield "pfa_g", pfa
    wide, strong = (values.ravel() for values in np.meshgrid(breadth, pfa))
    acceleration = strong * ACCELERATION["g"]
    cases = Cases.of(
        breadth=wide * LENGTH["cm"], height=height * LENGTH["cm"], pfa=acceleration, pfv=ratio * acceleration
    )
    for method in assessment.methods:
        if method.is_live and not (method.ruled_by == "pfv" and math.isnan(ratio)):
            value = np.nan_to_num(method.evaluate(cases, assessment.settings).value)  # 0 where no piece rocks by it
            yield method.key, value.reshape(pfa.size, breadth.size).astype(np.float32)
