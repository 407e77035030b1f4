"""The blocks of the paper's Table 3: their overturning on a shaking table, and what each method says of them."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from assess.methods import Cases, Method
from assess.methods._method import FloatArray
from assess.methods.kaneko_hayashi import METHOD as KANEKO_HAYASHI
from assess.methods.proposed_or import METHOD as PROPOSED_OR
from assess.methods.static import METHOD as STATIC_CRITERION
from assess.studies._agreement import correlate_ranks
from assess.studies._facts import read_facts
from assess.studies._study import Options
from assess.units import GRAVITY

CASES = ("min", "mean", "max")
TESTS = 10
"""Tests of each block; the table prints the least, the mean and the largest PGA."""
EXPECTED = (1 / (TESTS + 1), 0.5, TESTS / (TESTS + 1))
"""What a fragility that fits gives at the least, the mean and the largest of ten: ranks over n + 1 for the ends."""
ANY_HEIGHT = 1.0
"""The sizes are not printed; no method that is evaluated here looks at the height [m]."""
FAST = 1e6
"""A PFV [m/s] at which F_f lies far below F_b: it chooses Kaneko-Hayashi's branch of acceleration."""
HEIGHTS = (0.3, 1.2)
"""For the boundary of that branch [m]: I-beam blocks are about as high as the second; the others are not printed."""
STRONGEST, STEP = 2.0, 0.001
"""Medians are sought up to this PFA [g], in steps."""
PRINTED, USED = "OR, equation (9)", "OR as used"
BRANCH, BOUND = "Kaneko-Hayashi, PFA branch", "Kaneko-Hayashi, PFV unknown"
STATIC = "Static, g B/H"


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """One block of Table 3: B/H [-], and by case ("min", "mean", "max") overturning PGA [g] and OR as printed [-]."""

    name: str
    ratio: float
    pga: Mapping[str, float]
    printed: Mapping[str, float]


def read_blocks() -> list[Block]:
    """Return the nine blocks."""
    rows = read_facts("table3_shaking_table")
    found = []
    for name in dict.fromkeys(row["sample"] for row in rows):
        own = {row["case"]: row for row in rows if row["sample"] == name}
        pga, printed = ({case: float(own[case][column]) for case in CASES} for column in ("pga_g", "or"))
        found.append(Block(name, float(own["mean"]["breadth_to_height"]), pga, printed))
    return found


Chance = Callable[[FloatArray, FloatArray], FloatArray]
"""Chance of overturning (n,) of B/H (n,) [-] and PFA (n,) [g]."""


def build_chances(options: Options) -> dict[str, Chance]:
    """Return the chances by name: of each method that needs B/H and PFA alone."""

    def evaluate(method: Method, is_raw: bool, pfv: float, ratio: FloatArray, pfa: FloatArray) -> FloatArray:
        cases = Cases.of(breadth=ratio * ANY_HEIGHT, height=ANY_HEIGHT, pfa=pfa * GRAVITY, pfv=pfv)
        outcome = method.evaluate(cases, options.settings)
        return np.asarray(outcome.detail["raw"] if is_raw else outcome.value, dtype=np.float64)

    return {
        PRINTED: partial(evaluate, PROPOSED_OR, True, math.nan),
        USED: partial(evaluate, PROPOSED_OR, False, math.nan),
        BRANCH: partial(evaluate, KANEKO_HAYASHI, False, FAST),
        BOUND: partial(evaluate, KANEKO_HAYASHI, False, math.nan),
        STATIC: partial(evaluate, STATIC_CRITERION, False, math.nan),
    }


def find_median(chance: Chance, ratio: float) -> float:
    """Return the PFA [g] at which a chance first reaches one half; NaN if it does not, 0 if it does so at rest."""
    pfa = np.arange(0, STRONGEST + STEP, STEP)
    values = chance(np.full(pfa.size, ratio), pfa)
    reached = np.flatnonzero(values >= 0.5)
    if not reached.size:
        return math.nan
    at = int(reached[0])
    if at == 0:
        return 0.0
    low, high = float(pfa[at - 1]), float(pfa[at])
    while high - low > 1e-12:
        middle = (low + high) / 2
        is_over = chance(np.array([ratio]), np.array([middle]))[0] >= 0.5
        low, high = (low, middle) if is_over else (middle, high)
    return high


@dataclass(frozen=True, slots=True, eq=False)
class Judgement:
    """What one method says of the blocks.

    Parameters
    ----------
    medians : (b,) array
        PFA at which it reaches one half [g].
    chances : (b, 3) array
        At the least, mean and largest measured PGA [-].
    rank_correlation : float
        Spearman's, of medians and measured means [-].
    bias, scatter : float
        Mean and standard deviation of ln(median/measured mean) [-].
    """

    medians: FloatArray
    chances: FloatArray
    rank_correlation: float
    bias: float
    scatter: float


def judge_methods(blocks: Sequence[Block], options: Options) -> dict[str, Judgement]:
    """Hold each method against the tests."""
    means = np.array([one.pga["mean"] for one in blocks])
    found = {}
    for name, chance in build_chances(options).items():
        medians = np.array([find_median(chance, one.ratio) for one in blocks])
        chances = [chance(np.full(3, one.ratio), np.array([one.pga[case] for case in CASES])) for one in blocks]
        off = np.log(medians / means)
        found[name] = Judgement(
            medians, np.array(chances), correlate_ranks(medians, means), float(off.mean()), float(off.std())
        )
    return found


@dataclass(frozen=True, slots=True)
class Check:
    """The printed values of OR against ours: of how many, and how far the worst is off."""

    count: int
    largest: float


def check_printed(blocks: Sequence[Block], options: Options) -> Check:
    """Evaluate OR as printed at every PGA of the table."""
    chance = build_chances(options)[PRINTED]
    ratios, pga, printed = np.array(
        [(one.ratio, one.pga[case], one.printed[case]) for one in blocks for case in CASES]
    ).T
    return Check(printed.size, float(np.abs(chance(ratios, pga) - printed).max()))


def find_boundaries(blocks: Sequence[Block], options: Options) -> tuple[float, float]:
    """Return the least and largest F_b of Kaneko-Hayashi [Hz] over the blocks at `HEIGHTS`."""
    height, ratio = np.meshgrid(HEIGHTS, [one.ratio for one in blocks])
    cases = Cases.of(breadth=(ratio * height).ravel(), height=height.ravel(), pfa=GRAVITY)
    found = KANEKO_HAYASHI.evaluate(cases, options.settings).detail["boundary_frequency_hz"]
    return float(found.min()), float(found.max())
