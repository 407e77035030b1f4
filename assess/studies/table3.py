"""Study `table3`: the PGA at which nine blocks overturned on a shaking table, against what the formulas say.

The paper's Table 3 (section 5), after Purvance et al. (2008). It prints B/H and PGA alone, so that only methods that
need no more are held against the tests.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from assess.methods._method import FloatArray
from assess.report.figures.draw import draw
from assess.risk import RiskClass, classify
from assess.studies._blocks import (
    BOUND,
    BRANCH,
    CASES,
    EXPECTED,
    HEIGHTS,
    PRINTED,
    STATIC,
    TESTS,
    USED,
    Block,
    Judgement,
    check_printed,
    find_boundaries,
    judge_methods,
    read_blocks,
)
from assess.studies._study import Finding, Options, Row, Study, Table, table_lines

DRAWN = {
    USED: ("o", "#1b4f72"),
    BRANCH: ("s", "#db7133"),
    STATIC: ("^", "#6b6b6b"),
}
"""Marks and colours of the medians in the figure; the others have one of the same medians."""


def run(options: Options) -> Finding:
    """Hold the methods against the tests, and our OR against the printed one."""
    blocks = read_blocks()
    judged = judge_methods(blocks, options)
    return Finding(
        page=list(_describe(blocks, judged, options)),
        summary=list(_summarise(blocks, judged, options)),
        tables=_build_tables(blocks, judged, options),
        figures={"table3.svg": draw(7, 2.7, partial(_paint, blocks, judged))},
    )


# ---------------------------------------------------------------- the tables


def _build_tables(blocks: Sequence[Block], judged: Mapping[str, Judgement], options: Options) -> dict[str, Table]:
    columns = (
        "sample", "breadth_to_height", "method", *(f"pga_{case}_g" for case in CASES), "median_pfa_g",
        "median_over_mean", *(f"chance_at_{case}" for case in CASES),
    )  # fmt: skip
    methods = ("method", "mean_ln_median_over_mean", "scatter_ln", "rank_correlation")
    printed = ("sample", "breadth_to_height", "case", "pga_g", "or_printed", "or_equation_9", "or_as_used")
    return {
        "table3": Table(columns=columns, rows=list(_block_rows(blocks, judged))),
        "table3-methods": Table(
            columns=methods,
            rows=[(name, one.bias, one.scatter, one.rank_correlation) for name, one in judged.items()],
        ),
        "table3-printed": Table(columns=printed, rows=list(_printed_rows(blocks, judged))),
    }


def _block_rows(blocks: Sequence[Block], judged: Mapping[str, Judgement]) -> Iterator[Row]:
    for at, block in enumerate(blocks):
        for name, one in judged.items():
            median = float(one.medians[at])
            peaks = [block.pga[case] for case in CASES]
            yield block.name, block.ratio, name, *peaks, median, median / block.pga["mean"], *one.chances[at].tolist()


def _printed_rows(blocks: Sequence[Block], judged: Mapping[str, Judgement]) -> Iterator[Row]:
    for at, block in enumerate(blocks):
        for case, name in enumerate(CASES):
            ours = [float(judged[key].chances[at, case]) for key in (PRINTED, USED)]
            yield block.name, block.ratio, name, block.pga[name], block.printed[name], *ours


# ---------------------------------------------------------------- the page


def _describe(blocks: Sequence[Block], judged: Mapping[str, Judgement], options: Options) -> Iterator[str]:
    yield (
        f"{len(blocks)} blocks of Purvance et al. (2008), {TESTS} tests each; Table 3 prints B/H and the least, mean "
        "and largest PGA of overturning, which is PFA here. A method's median is the PFA at which it first says one "
        f"half. A method that fits has it near the mean, and says about {_join(EXPECTED)} at the three."
    )
    yield ""
    yield from _method_lines(judged)
    yield ""
    yield from _block_lines(blocks, judged)
    yield ""
    yield _describe_or(blocks, judged)
    yield ""
    yield _describe_kaneko_hayashi(blocks, judged, options)
    yield ""
    yield _describe_printed(blocks, options)
    yield ""
    yield LEFT_OUT


def _method_lines(judged: Mapping[str, Judgement]) -> list[str]:
    heads = ("method", "median / measured mean", "scatter of its ln", "chance at least/mean/largest")
    rows = []
    for name, one in judged.items():
        least, most = ("at least ", "at most ") if name == BOUND else ("", "")
        chances = _join(one.chances.mean(axis=0))
        rows.append((name, f"{least}{math.exp(one.bias):.2f}", f"{one.scatter:.2f}", f"{most}{chances}"))
    return table_lines(heads, rows)


def _block_lines(blocks: Sequence[Block], judged: Mapping[str, Judgement]) -> list[str]:
    medians = {"OR": judged[USED], "Kaneko-Hayashi, at least": judged[BOUND], "static": judged[STATIC]}
    medians_of = (f"median: {name} [g]" for name in medians)
    heads = ("block", "B/H", "PGA least/mean/largest [g]", *medians_of, "OR as printed")
    rows = []
    for at, block in enumerate(blocks):
        peaks, printed = (_join([values[case] for case in CASES]) for values in (block.pga, block.printed))
        own = (f"{one.medians[at]:.2f}" for one in medians.values())
        rows.append((block.name, f"{block.ratio:.2f}", peaks, *own, printed))
    return table_lines(heads, rows)


def _join(values: Sequence[float] | FloatArray) -> str:
    return "/".join(f"{value:.2f}" for value in values)


def _describe_or(blocks: Sequence[Block], judged: Mapping[str, Judgement]) -> str:
    used = judged[USED]
    below = int(np.sum(used.medians < judged[STATIC].medians))
    early = [one.name for one in blocks if one.pga["min"] < one.ratio]
    least, mean, largest = (f"{value:.2f}" for value in used.chances.mean(axis=0))
    return (
        f"OR's median is {math.exp(used.bias):.2f} of the measured mean: OR says {mean} at the mean, and is flat, "
        f"{least} and {largest} at the ends. For {below} of {len(blocks)} blocks its median is below g B/H, where an "
        f"ideal block cannot rock; yet {', '.join(early)} at least once fell below that."
    )


def _describe_kaneko_hayashi(blocks: Sequence[Block], judged: Mapping[str, Judgement], options: Options) -> str:
    low, high = find_boundaries(blocks, options)
    return (
        "Kaneko-Hayashi's PFA branch holds for floor frequencies F_f = PFA/(2 pi PFV) up to F_b, "
        f"{low:.1f} to {high:.1f} Hz (H of {HEIGHTS[0]:g} to {HEIGHTS[1]:g} m); above, PFV decides and the median is "
        "higher. 'PFV unknown' is the largest chance over every PFV. So the median is at least "
        f"{math.exp(judged[BOUND].bias):.2f} of the measured mean."
    )


def _describe_printed(blocks: Sequence[Block], options: Options) -> str:
    check = check_printed(blocks, options)
    names = {"mean": "mean", "max": "largest", "min": "least"}
    told = "; ".join(f"{_count_classes(blocks, case)} at the {name}" for case, name in names.items())
    return (
        f"All {check.count} printed OR are equation (9), within {check.largest:.4f}. The paper's prose (section 5) "
        f"calls mean and largest very high; by its own classes they are: {told}."
    )


def _count_classes(blocks: Sequence[Block], case: str) -> str:
    found = [classify(one.printed[case]) for one in blocks]
    return ", ".join(f"{found.count(risk)} {risk.word}" for risk in reversed(RiskClass) if risk in found)


LEFT_OUT = (
    "Not evaluated, as PFV, sizes and histories are not printed: Ishiyama and FEMA P-58 (PFV, H), the "
    "Japanese rule (H), direct integration (H, histories)."
)


def _summarise(blocks: Sequence[Block], judged: Mapping[str, Judgement], options: Options) -> Iterator[str]:
    check, used, bound = check_printed(blocks, options), judged[USED], judged[BOUND]
    yield (
        f"Shaking table: all {check.count} printed OR of Table 3 come out within {check.largest:.4f}. OR reaches one "
        f"half at {math.exp(used.bias):.2f} of the measured mean PGA (scatter of ln {used.scatter:.2f}); "
        f"Kaneko-Hayashi, whatever PFV was, at least at {math.exp(bound.bias):.2f}. At the least, mean and "
        f"largest PGA OR says {_join(used.chances.mean(axis=0))} and Kaneko-Hayashi at most "
        f"{_join(bound.chances.mean(axis=0))}, where about {_join(EXPECTED)} would fit."
    )


# ---------------------------------------------------------------- the figure


def _paint(blocks: Sequence[Block], judged: Mapping[str, Judgement], figure: Any) -> None:
    panels = figure.subplots(1, len(DRAWN), sharex=True, sharey=True)
    least, means, largest = (np.array([one.pga[case] for one in blocks]) for case in CASES)
    bars, look = (means - least, largest - means), {"ms": 3.5, "elinewidth": 0.5, "capsize": 1.5}
    for axes, (name, (mark, colour)) in zip(panels, DRAWN.items(), strict=True):
        axes.plot([0, 1], [0, 1], color="#444444", linewidth=0.6, linestyle="--")
        axes.errorbar(means, judged[name].medians, xerr=bars, fmt=mark, color=colour, **look)
        _name_blocks(axes, blocks, judged[name].medians)
        axes.set_title(name, loc="left", fontsize=8)
        axes.set_xlim(0, 1.15)
        axes.set_ylim(0, 0.7)
        axes.tick_params(labelsize=6)
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].text(0.62, 0.64, "1:1", fontsize=6, ha="right")
    panels[0].set_ylabel("median: PFA of chance one half [g]", fontsize=7)
    figure.supxlabel("measured overturning PGA: mean, least and largest of ten tests [g]", fontsize=7)


def _name_blocks(axes: Any, blocks: Sequence[Block], medians: FloatArray) -> None:
    """Write the names of the blocks of each B/H at the end of their bars."""
    for ratio, median in {one.ratio: median for one, median in zip(blocks, medians, strict=True)}.items():
        own = [one for one in blocks if one.ratio == ratio]
        end = max(one.pga["max"] for one in own), median
        name = ", ".join(one.name for one in own)
        axes.annotate(name, end, xytext=(4, 0), textcoords="offset points", fontsize=6, va="center")


STUDY = Study(name="table3", order=50, title="Formulas against shaking-table tests", of="Table 3, section 5", run=run)
