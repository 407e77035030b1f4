"""How the formulas and criteria do against what the blocks did, on whole buildings and on parts of the cases."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from assess.methods._method import BoolArray
from assess.methods.proposed_or import METHOD as PROPOSED_OR
from assess.risk import LIMITS
from assess.studies._agreement import Agreement, find_agreement
from assess.studies._formulas import CRITERIA, FORMULAS
from assess.studies._judged import Judged, agree, as_recorded, by_building, every_case, pool
from assess.studies._pairs import Pair, find_pairs
from assess.units import GRAVITY, ROUNDING

MOST_SCALED = 3.0
"""Factor up to which a record is taken for little scaled [-]."""
ALL = "all cases"
NOTHING = "nothing falls"
"""What knows nothing: a formula that is farther off is of no use there."""


def is_little_scaled(one: Judged) -> BoolArray:
    """Choose the cases whose record is scaled up to `MOST_SCALED` times."""
    return every_case(one) & (one.factors[:, np.newaxis] <= MOST_SCALED)


def is_in_range(one: Judged) -> BoolArray:
    """Choose the cases of a B/H and a PFA at which OR is checked by tests."""
    ratio = PROPOSED_OR.valid["breadth_to_height"].holds(one.trials.breadth / one.trials.height)
    pfa = PROPOSED_OR.valid["pfa"].holds(one.trials.pfa / GRAVITY)
    return every_case(one) & np.asarray(pfa[:, np.newaxis] & ratio, dtype=np.bool_)


def is_at_rest(one: Judged) -> BoolArray:
    """Choose the cases in which the record is too weak for a rigid block to rock: its PFA is below g B/H."""
    start = GRAVITY * one.trials.breadth / one.trials.height
    return every_case(one) & np.asarray(one.trials.pfa[:, np.newaxis] < start * (1 - ROUNDING), dtype=np.bool_)


SUBSETS = {
    ALL: every_case,
    "as recorded": as_recorded,
    f"scaled up to {MOST_SCALED:g} times": is_little_scaled,
    "in OR's checked range": is_in_range,
}


@dataclass(frozen=True, slots=True)
class Criterion:
    """What a criterion says of the cases that fall in at least half of the motions, and of the others.

    `missed` is the share of the first for which it is not met, `idle` the share of the others for which it is [-]; NaN
    where there are none.
    """

    missed: float
    idle: float


@dataclass(frozen=True, slots=True)
class AtRest:
    """What is said of the cases whose record is too weak for a rigid block to rock, all buildings together.

    Parameters
    ----------
    share : float
        Of all cases [-].
    above : mapping of str to float
        Share of them that a formula puts into class medium or higher, by key [-].
    above_by_integration : float
        The same by integration [-]: single motions have larger peaks than the record.
    """

    share: float
    above: Mapping[str, float]
    above_by_integration: float


@dataclass(frozen=True, slots=True)
class Compared:
    """All of it.

    Agreements go by building, part of the cases (see `SUBSETS`) and key of the formula, or `NOTHING`; criteria by
    building and key. `ratios` are PFV/PFA of the channels [s], (c,), and `biases` those of each formula under them [-],
    (c,), by key.
    """

    agreements: Mapping[tuple[str, str, str], Agreement]
    ratios: Sequence[float]
    biases: Mapping[str, Sequence[float]]
    criteria: Mapping[tuple[str, str], Criterion]
    at_rest: AtRest
    pairs: Sequence[Pair]


def compare(judged: Sequence[Judged]) -> Compared:
    """Hold formulas and criteria against what the blocks did."""
    return Compared(
        agreements=find_agreements(judged),
        ratios=[one.ratio for one in judged],
        biases={key: [agree([one], key).bias for one in judged] for key in FORMULAS},
        criteria=find_criteria(judged),
        at_rest=find_at_rest(judged),
        pairs=find_pairs(judged),
    )


def find_agreements(judged: Sequence[Judged]) -> dict[tuple[str, str, str], Agreement]:
    """Return how each formula agrees with integration, by building, subset and key; subsets without cases are out."""
    found: dict[tuple[str, str, str], Agreement] = {}
    for name, own in by_building(judged).items():
        for subset, chosen in SUBSETS.items():
            if not any(chosen(one).any() for one in own):
                continue
            found |= {(name, subset, key): agree(own, key, chosen) for key in FORMULAS}
            fallen = pool(own, next(iter(FORMULAS)), chosen)[1]
            found[name, subset, NOTHING] = find_agreement(np.zeros(fallen.size), fallen, own[0].trials.runs)
    return found


def find_criteria(judged: Sequence[Judged]) -> dict[tuple[str, str], Criterion]:
    """Return how the criteria do, by building and key."""
    found = {}
    for name, own in by_building(judged).items():
        for key in CRITERIA:
            met, fallen = pool(own, key)
            falls = fallen >= own[0].trials.runs / 2
            found[name, key] = Criterion(_share(met[falls] == 0), _share(met[~falls] == 1))
    return found


def _share(found: BoolArray) -> float:
    return float(found.mean()) if found.size else float("nan")


def find_at_rest(judged: Sequence[Judged]) -> AtRest:
    """Return what is said of blocks that the record as scaled cannot rock."""
    said = {key: pool(judged, key, is_at_rest) for key in FORMULAS}
    fallen = next(iter(said.values()))[1]
    every = sum(int(every_case(one).sum()) for one in judged)
    return AtRest(
        share=fallen.size / every,
        above={key: _share(values >= LIMITS[0]) for key, (values, _) in said.items()},
        above_by_integration=_share(fallen >= LIMITS[0] * judged[0].trials.runs),
    )
