"""Study `table3`: the PGA at which nine blocks overturned on a shaking table, compared with the formulas.

The paper's Table 3 (section 5), after Purvance et al. (2008). It prints B/H and PGA alone, so only methods that need no
more are compared with the tests.
"""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.methods import Cases
from assess.report.figures.draw import draw
from assess.risk import RiskClass, classify
from assess.studies.agreement import KANEKO, METHODS, OR, STATIC, correlate_ranks
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts, write_finding
from assess.units import GRAVITY

CASES = ("min", "mean", "max")
TESTS = 10
"""Tests of each block; the table prints the least, the mean and the largest PGA."""
EXPECTED = (1 / (TESTS + 1), 0.5, TESTS / (TESTS + 1))
"""Chances of a correct fragility at the least, the mean and the largest of ten: ranks over n + 1 for the ends."""
ANY_HEIGHT, FAST = 1.0, 1e6
"""The sizes are not printed, and no method evaluated here depends on the height [m]; a PFV [m/s] at which F_f lies far
below F_b, which selects Kaneko-Hayashi's branch of acceleration."""
HEIGHTS = (0.3, 1.2)
"""For the boundary of that branch [m]: I-beam blocks are about as high as the second; the others are not printed."""
STRONGEST, STEP = 2.0, 0.001
"""Medians are searched up to this PFA [g], in steps."""
PRINTED, USED, BRANCH, BOUND, START = (
    "OR, equation (9)", "OR as used", "Kaneko-Hayashi, PFA branch", "Kaneko-Hayashi, PFV unknown", "Static, g B/H"
)  # fmt: skip
DRAWN = {USED: ("o", "#1b4f72"), BRANCH: ("s", "#db7133"), START: ("^", "#6b6b6b")}
"""Marks and colours of the medians in the figure; the other methods have the medians of one of these."""


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
    """Return the chance of each method that needs only B/H and PFA, by name."""

    def evaluate(key: str, is_raw: bool, pfv: float, ratio: FloatArray, pfa: FloatArray) -> FloatArray:
        cases = Cases.of(breadth=ratio * ANY_HEIGHT, height=ANY_HEIGHT, pfa=pfa * GRAVITY, pfv=pfv)
        outcome = METHODS[key].evaluate(cases, options.settings)
        return np.asarray(outcome.detail["raw"] if is_raw else outcome.value, dtype=np.float64)

    return {
        PRINTED: partial(evaluate, OR, True, math.nan),
        USED: partial(evaluate, OR, False, math.nan),
        BRANCH: partial(evaluate, KANEKO, False, FAST),
        BOUND: partial(evaluate, KANEKO, False, math.nan),
        START: partial(evaluate, STATIC, False, math.nan),
    }


def find_median(chance: Chance, ratio: float) -> float:
    """Return the PFA [g] at which a chance first reaches one half; NaN if it does not, 0 if it does so at rest."""
    pfa = np.arange(0, STRONGEST + STEP, STEP)
    over = np.flatnonzero(chance(np.full(pfa.size, ratio), pfa) >= 0.5)
    if not over.size:
        return math.nan
    at = int(over[0])
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
    """A method compared with the tests of b blocks.

    `medians` (b,) are the PFA at which its chance is one half [g]; `chances` (b, 3) those at the least, mean and
    largest measured PGA [-]; `rank_correlation` is Spearman's, of medians and measured means [-]; `bias` and
    `scatter` are mean and standard deviation of ln(median/measured mean) [-], `share` is its geometric mean [-].
    """

    medians: FloatArray
    chances: FloatArray
    rank_correlation: float
    bias: float
    scatter: float
    share: float


def judge_methods(blocks: Sequence[Block], options: Options) -> dict[str, Judgement]:
    """Compare each method with the tests."""
    means = np.array([one.pga["mean"] for one in blocks])
    found = {}
    for name, chance in build_chances(options).items():
        medians = np.array([find_median(chance, one.ratio) for one in blocks])
        chances = [chance(np.full(3, one.ratio), np.array([one.pga[case] for case in CASES])) for one in blocks]
        off, ranks = np.log(medians / means), correlate_ranks(medians, means)
        bias, scatter = float(off.mean()), float(off.std())
        found[name] = Judgement(medians, np.array(chances), ranks, bias, scatter, math.exp(bias))
    return found


def check_printed(blocks: Sequence[Block], options: Options) -> tuple[int, float]:
    """Return how many values of OR the table prints, and their largest difference from equation (9) [-]."""
    values = [(one.ratio, one.pga[case], one.printed[case]) for one in blocks for case in CASES]
    ratios, pga, printed = np.array(values).T
    return printed.size, float(np.abs(build_chances(options)[PRINTED](ratios, pga) - printed).max())


def find_boundaries(blocks: Sequence[Block], options: Options) -> tuple[float, float]:
    """Return the least and largest F_b of Kaneko-Hayashi [Hz] over the blocks at `HEIGHTS`."""
    height, ratio = np.meshgrid(HEIGHTS, [one.ratio for one in blocks])
    cases = Cases.of(breadth=(ratio * height).ravel(), height=height.ravel(), pfa=GRAVITY)
    found = METHODS[KANEKO].evaluate(cases, options.settings).detail["boundary_frequency_hz"]
    return float(found.min()), float(found.max())


def run(options: Options) -> Finding:
    """Compare the methods with the tests, and OR as evaluated here with OR as printed."""
    blocks = read_blocks()
    judged = judge_methods(blocks, options)
    counts = {case: Counter(classify(one.printed[case]) for one in blocks) for case in CASES}
    values = {
        "blocks": blocks, "judged": judged, "used": judged[USED], "bound": judged[BOUND], "start": judged[START],
        "tests": TESTS, "expected": EXPECTED, "heights": HEIGHTS, "boundaries": find_boundaries(blocks, options),
        "printed": check_printed(blocks, options), "early": [one.name for one in blocks if one.pga["min"] < one.ratio],
        "classes": {
            case: ", ".join(f"{found[risk]} {risk.word}" for risk in reversed(RiskClass) if found[risk])
            for case, found in counts.items()
        },
    }  # fmt: skip
    columns = (
        "sample", "breadth_to_height", "method", *(f"pga_{case}_g" for case in CASES), "median_pfa_g",
        "median_over_mean", *(f"chance_at_{case}" for case in CASES),
    )  # fmt: skip
    methods = ("method", "mean_ln_median_over_mean", "scatter_ln", "rank_correlation")
    printed = ("sample", "breadth_to_height", "case", "pga_g", "or_printed", "or_equation_9", "or_as_used")
    summary = [(name, one.bias, one.scatter, one.rank_correlation) for name, one in judged.items()]
    of_blocks: list[Row] = []
    of_cases: list[Row] = []
    for at, block in enumerate(blocks):
        for name, one in judged.items():
            median, chances = float(one.medians[at]), one.chances[at].tolist()
            peaks = (*block.pga.values(), median, median / block.pga["mean"])
            of_blocks.append((block.name, block.ratio, name, *peaks, *chances))
        for number, case in enumerate(CASES):
            chances = [float(judged[key].chances[at, number]) for key in (PRINTED, USED)]
            of_cases.append((block.name, block.ratio, case, block.pga[case], block.printed[case], *chances))
    return write_finding(
        "table3",
        values,
        tables={
            "table3": Table(columns=columns, rows=of_blocks),
            "table3-methods": Table(columns=methods, rows=summary),
            "table3-printed": Table(columns=printed, rows=of_cases),
        },
        figures={"table3.svg": draw(7, 2.7, partial(_paint, blocks, judged))},
    )


def _paint(blocks: Sequence[Block], judged: Mapping[str, Judgement], figure: Any) -> None:
    panels = figure.subplots(1, len(DRAWN), sharex=True, sharey=True)
    least, means, largest = (np.array([one.pga[case] for one in blocks]) for case in CASES)
    bars, style = (means - least, largest - means), {"ms": 3.5, "elinewidth": 0.5, "capsize": 1.5}
    for axes, (name, (mark, colour)) in zip(panels, DRAWN.items(), strict=True):
        axes.plot([0, 1], [0, 1], color="#444444", linewidth=0.6, linestyle="--")
        axes.errorbar(means, judged[name].medians, xerr=bars, fmt=mark, color=colour, **style)
        for ratio, median in {one.ratio: at for one, at in zip(blocks, judged[name].medians, strict=True)}.items():
            own = [one for one in blocks if one.ratio == ratio]
            end, label = (max(one.pga["max"] for one in own), median), ", ".join(one.name for one in own)
            axes.annotate(label, end, xytext=(4, 0), textcoords="offset points", fontsize=6, va="center")
        axes.set_title(name, loc="left", fontsize=8)
        axes.set_xlim(0, 1.15)
        axes.set_ylim(0, 0.7)
        axes.tick_params(labelsize=6)
    panels[0].text(0.62, 0.64, "1:1", fontsize=6, ha="right")
    panels[0].set_ylabel("median: PFA of chance one half [g]", fontsize=7)
    figure.supxlabel("measured overturning PGA: mean, least and largest of ten tests [g]", fontsize=7)


STUDY = Study(name="table3", order=50, title="Formulas against shaking-table tests", of="Table 3, section 5", run=run)
