"""outcomes.npz: under which motions each piece overturned, for those who count what falls together.

Motion k is one earthquake on every floor of the building: two pieces fall together where both have bit k set.
"""

from pathlib import Path

import numpy as np

from assess.adoption import VERIFICATION
from assess.methods._method import Joint
from assess.results import Assessment


def write_npz(assessment: Assessment, path: Path) -> None:
    """Write the outcomes of all m verified cases (a piece under one floor motion), most of which have k motions.

    Arrays: ``item``, ``row`` (of the sheet Items), ``axis``, ``source`` and ``governs`` (m,) tell the case; ``runs``
    (m,) how many motions it was integrated under, the first ones; ``overturned`` (m, ceil(k/8)) has one bit a motion,
    the first in the highest bit (`numpy.unpackbits`); ``max_rotation_ratio`` (m, k) is the largest |theta| over the
    critical angle, NaN beyond the runs.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    joints = assessment.outcomes[VERIFICATION].joints
    cases = np.concatenate([joint.cases for joint in joints]) if joints else np.zeros(0, dtype=np.intp)
    items = [assessment.inventory.items[at] for at in assessment.case_item[cases]]
    demands = [assessment.case_demand[case] for case in cases]
    most = max((joint.fell.shape[1] for joint in joints), default=0)
    with path.open("wb") as file:
        np.savez_compressed(
            file,
            item=np.array([item.item for item in items], dtype=np.str_),
            row=np.array([item.row for item in items], dtype=np.int64),
            axis=np.array([demand.axis for demand in demands], dtype=np.str_),
            source=np.array([demand.label for demand in demands], dtype=np.str_),
            governs=np.isin(cases, assessment.governing),
            runs=np.concatenate([joint.runs for joint in joints]) if joints else np.zeros(0, dtype=np.int64),
            overturned=np.concatenate([_pack(joint, most) for joint in joints])
            if joints
            else np.zeros((0, 0), np.uint8),
            max_rotation_ratio=np.concatenate([_rotations(joint, most) for joint in joints])
            if joints
            else np.zeros((0, 0), np.float32),
        )


def _pack(joint: Joint, most: int) -> np.ndarray:
    wide = np.zeros((len(joint.fell), most), dtype=np.bool_)
    wide[:, : joint.fell.shape[1]] = joint.fell
    return np.packbits(wide, axis=1)


def _rotations(joint: Joint, most: int) -> np.ndarray:
    wide = np.full((len(joint.fell), most), np.nan, dtype=np.float32)
    wide[:, : joint.rotation.shape[1]] = joint.rotation
    wide[np.arange(most) >= joint.runs[:, np.newaxis]] = np.nan
    return wide
