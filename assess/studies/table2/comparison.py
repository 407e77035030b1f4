"""Formulas and criteria compared with direct integration: on whole buildings, on parts of the cases, on each floor."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from assess.risk import LIMITS
from assess.studies.agreement import (
    Agreement,
    Compared,
    agree,
    as_recorded,
    by_building,
    every_case,
    find_agreement,
    pool,
)
from assess.studies.buildings import FIRST_TOGETHER, TOGETHER
from assess.studies.studied_methods import CRITERIA, FORMULAS, INTEGRATION, METHODS, OR, BoolArray
from assess.units import GRAVITY, ROUNDING

MOST_SCALED = 3.0
"""Largest factor of a record that is called little scaled [-]."""
ALL = "all cases"
NOTHING = "nothing falls"
"""The trivial prediction: a formula with a larger error is of no use."""


def is_little_scaled(one: Compared) -> BoolArray:
    """Choose the cases whose record is scaled by at most `MOST_SCALED`."""
    return every_case(one) & (one.factors[:, np.newaxis] <= MOST_SCALED)


def is_in_range(one: Compared) -> BoolArray:
    """Choose the cases of a B/H and a PFA for which OR is checked by tests."""
    valid = METHODS[OR].valid
    ratio = valid["breadth_to_height"].holds(one.trials.breadth / one.trials.height)
    pfa = valid["pfa"].holds(one.trials.pfa / GRAVITY)
    return every_case(one) & np.asarray(pfa[:, np.newaxis] & ratio, dtype=np.bool_)


def is_at_rest(one: Compared) -> BoolArray:
    """Choose the cases in which the record cannot make a rigid block rock: its PFA is below g B/H."""
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
    """How a criterion separates the cases that fall in at least half of the motions from the others.

    `missed` is the share of the former for which it is not met, `idle` the share of the latter for which it is [-]; NaN
    where there are none.
    """

    missed: float
    idle: float


@dataclass(frozen=True, slots=True)
class AtRest:
    """The cases whose record cannot make a rigid block rock, all buildings together.

    `share` is their share of all cases; `above` is the share of them that a formula puts into class medium or higher,
    by key, and `above_by_integration` the same by integration, as single motions have larger peaks than the record [-].
    """

    share: float
    above: Mapping[str, float]
    above_by_integration: float


@dataclass(frozen=True, slots=True)
class Pair:
    """Two channels of a floor, scaled by one factor: mean difference of the chances of a block [-], by method."""

    building: str
    level: str
    names: tuple[str, str]
    is_along: bool
    pfa: float
    apart: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Comparison:
    """All of the above.

    Agreements are by building, part of the cases (see `SUBSETS`) and key of the formula, or `NOTHING`; `uncertain` are
    those of all cases with integration where motion and piece are uncertain, by building and the same key; criteria by
    building and key. `ratios` are PFV/PFA of the channels [s], (c,), and `biases` those of each formula under them [-],
    (c,), by key.
    """

    agreements: Mapping[tuple[str, str, str], Agreement]
    uncertain: Mapping[tuple[str, str], Agreement]
    ratios: Sequence[float]
    biases: Mapping[str, Sequence[float]]
    criteria: Mapping[tuple[str, str], Criterion]
    at_rest: AtRest
    pairs: Sequence[Pair]


def compare(compared: Sequence[Compared]) -> Comparison:
    """Compare formulas and criteria with the response of the blocks."""
    return Comparison(
        agreements=find_agreements(compared),
        uncertain=find_uncertain(compared),
        ratios=[one.ratio for one in compared],
        biases={key: [agree([one], key).bias for one in compared] for key in FORMULAS},
        criteria=find_criteria(compared),
        at_rest=find_at_rest(compared),
        pairs=find_pairs(compared),
    )


def find_agreements(compared: Sequence[Compared]) -> dict[tuple[str, str, str], Agreement]:
    """Return how each formula agrees with integration, by building, subset and key; empty subsets are left out."""
    found: dict[tuple[str, str, str], Agreement] = {}
    for name, own in by_building(compared).items():
        for subset, chosen in SUBSETS.items():
            if not any(chosen(one).any() for one in own):
                continue
            found |= {(name, subset, key): agree(own, key, chosen) for key in FORMULAS}
            fallen = pool(own, OR, chosen)[1]
            found[name, subset, NOTHING] = find_agreement(np.zeros(fallen.size), fallen, own[0].trials.runs)
    return found


def find_uncertain(compared: Sequence[Compared]) -> dict[tuple[str, str], Agreement]:
    """Return how each formula agrees with integration where motion and piece are uncertain, by building and key."""
    found: dict[tuple[str, str], Agreement] = {}
    for name, own in by_building(compared).items():
        found |= {(name, key): agree(own, key, uncertain=True) for key in FORMULAS}
        fallen = pool(own, OR, uncertain=True)[1]
        found[name, NOTHING] = find_agreement(np.zeros(fallen.size), fallen, own[0].trials.runs)
    return found


def find_criteria(compared: Sequence[Compared]) -> dict[tuple[str, str], Criterion]:
    """Return how well the criteria separate what falls, by building and key."""
    found = {}
    for name, own in by_building(compared).items():
        for key in CRITERIA:
            met, fallen = pool(own, key)
            falls = fallen >= own[0].trials.runs / 2
            found[name, key] = Criterion(_share(met[falls] == 0), _share(met[~falls] == 1))
    return found


def _share(found: BoolArray) -> float:
    return float(found.mean()) if found.size else float("nan")


def find_at_rest(compared: Sequence[Compared]) -> AtRest:
    """Return how formulas and integration classify blocks that the record as scaled cannot make rock."""
    fallen = pool(compared, OR, is_at_rest)[1]
    every = sum(int(every_case(one).sum()) for one in compared)
    return AtRest(
        share=fallen.size / every,
        above={key: _share(pool(compared, key, is_at_rest)[0] >= LIMITS[0]) for key in FORMULAS},
        above_by_integration=_share(fallen >= LIMITS[0] * compared[0].trials.runs),
    )


def find_pairs(compared: Sequence[Compared]) -> list[Pair]:
    """Return every two channels of a floor at each PFA of `TOGETHER`."""
    found = []
    for one, other in combinations(compared, 2):
        a, b = one.trials.channel, other.trials.channel
        if (a.building, a.level) != (b.building, b.level):
            continue
        pairs = {key: (one.formulas[key], other.formulas[key]) for key in FORMULAS}
        pairs[INTEGRATION] = one.trials.risk, other.trials.risk
        for at, pfa in enumerate(TOGETHER, FIRST_TOGETHER):
            apart = {key: float(np.nanmean(np.abs(x[at] - y[at]))) for key, (x, y) in pairs.items()}
            found.append(Pair(a.building, a.level, (a.name, b.name), a.axis == b.axis, pfa, apart))
    return found
