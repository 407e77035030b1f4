"""Study `table2`: formulas compared with direct integration, by storey and channel, on instrumented buildings.

The paper's Table 2 (sections 3.2.1 to 3.2.3) does this on three buildings whose records are not available.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np

from assess.arrays import BoolArray
from assess.report.figures.draw import draw
from assess.risk import LIMITS, classify_all
from assess.rocking.draws import BASE, Uncertainty
from assess.studies.agreement import (
    CRITERIA,
    FEMA,
    FORMULAS,
    INTEGRATION,
    JAPAN,
    KANEKO,
    METHODS,
    NAMES,
    OR,
    STATIC,
    Agreement,
    Chosen,
    Compared,
    agree,
    by_building,
    correlate_ranks,
    every_case,
    find_agreement,
    pool,
    rock_all,
)  # fmt: skip
from assess.studies.buildings import FIRST_TOGETHER, HEIGHTS, LEVELS, RATIOS, RECORDED, TOGETHER
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts, write_finding
from assess.units import GRAVITY, LENGTH, ROUNDING

MOST_SCALED = 3.0
"""Largest factor of a record that is called little scaled [-]."""
ALL = "all cases"
NOTHING = "nothing falls"
"""The trivial prediction: a formula with a larger error is of no use."""


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


SUBSETS: Mapping[str, Chosen] = {
    ALL: every_case,
    "as recorded": lambda one: every_case(one, RECORDED),
    f"scaled up to {MOST_SCALED:g} times": lambda one: every_case(one) & (one.factors[:, np.newaxis] <= MOST_SCALED),
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
    """Compare formulas and criteria with the response of the blocks; subsets without a case are left out."""
    agreements: dict[tuple[str, str, str], Agreement] = {}
    uncertain: dict[tuple[str, str], Agreement] = {}
    criteria = {}
    for name, own in by_building(compared).items():
        for subset, chosen in SUBSETS.items():
            if any(chosen(one).any() for one in own):
                found = _agree_all(own, chosen, uncertain=False)
                agreements |= {(name, subset, key): one for key, one in found.items()}
        found = _agree_all(own, every_case, uncertain=True)
        uncertain |= {(name, key): one for key, one in found.items()}
        for key in CRITERIA:
            met, fallen = pool(own, key)
            falls = fallen >= own[0].trials.runs / 2
            criteria[name, key] = Criterion(_share(met[falls] == 0), _share(met[~falls] == 1))
    pairs = []
    for one, other in combinations(compared, 2):
        a, b = one.trials.channel, other.trials.channel
        if (a.building, a.level) != (b.building, b.level):
            continue
        chances = {key: (one.formulas[key], other.formulas[key]) for key in FORMULAS}
        chances[INTEGRATION] = one.trials.risk, other.trials.risk
        for at, pfa in enumerate(TOGETHER, FIRST_TOGETHER):
            apart = {key: float(np.nanmean(np.abs(x[at] - y[at]))) for key, (x, y) in chances.items()}
            pairs.append(Pair(a.building, a.level, (a.name, b.name), a.axis == b.axis, pfa, apart))
    fallen = pool(compared, OR, is_at_rest)[1]
    return Comparison(
        agreements=agreements, uncertain=uncertain,
        ratios=[one.ratio for one in compared],
        biases={key: [agree([one], key).bias for one in compared] for key in FORMULAS},
        criteria=criteria,
        at_rest=AtRest(
            share=fallen.size / sum(int(every_case(one).sum()) for one in compared),
            above={key: _share(pool(compared, key, is_at_rest)[0] >= LIMITS[0]) for key in FORMULAS},
            above_by_integration=_share(fallen >= LIMITS[0] * compared[0].trials.runs),
        ),
        pairs=pairs,
    )  # fmt: skip


def _agree_all(own: Sequence[Compared], chosen: Chosen, *, uncertain: bool) -> dict[str, Agreement]:
    """Return how each formula, and `NOTHING`, agrees with integration."""
    fallen = pool(own, OR, chosen, uncertain=uncertain)[1]
    found = {key: agree(own, key, chosen, uncertain=uncertain) for key in FORMULAS}
    return found | {NOTHING: find_agreement(np.zeros(fallen.size), fallen, own[0].trials.runs)}


def _share(found: BoolArray) -> float:
    return float(found.mean()) if found.size else float("nan")


CHANNELS = (
    "building", "level", "channel", "axis", "scaled_to", "factor", "pfa_g", "pfv_cm_s", "breadth_cm", "height_cm",
    *FORMULAS, *CRITERIA, "fallen", "fallen_uncertain", "runs", "fell_in_record",
)  # fmt: skip
MARKS = (("x", "#6b6b6b"), ("^", "#1b4f72"), ("o", "#db7133"), ("s", "#8c1d3f"))
"""Of the formulas in the figure."""
SHOWN = 0.5
"""PFA at which the table of channels shows the risks of one block [g]."""
RECORDS_AT = (0.3, 0.5, 0.7, 0.9)
"""PFA at which the share of blocks that the records themselves overturn is given [g]."""
CLEAR = 0.5
"""Rank correlation from which a dependence is called clear [-]."""
DIRECT = "housner_direct"
"""Column of the paper's own integration."""


def run(options: Options) -> Finding:
    """Compare the formulas with integration."""
    compared = rock_all(options)
    found = compare(compared)
    pairs = found.pairs
    tables = {
        "table2-channels": Table(columns=CHANNELS, rows=list(_channel_rows(compared))),
        "table2-agreement": Table(
            columns=("building", "cases_chosen", "method", *NAMES),
            rows=[(*key, *astuple(one)) for key, one in found.agreements.items()],
        ),
        "table2-uncertain": Table(
            columns=("building", "method", *NAMES), rows=[(*key, *astuple(one)) for key, one in found.uncertain.items()]
        ),
        "table2-criteria": Table(
            columns=("building", "criterion", "not_met_though_it_falls", "met_though_it_stands"),
            rows=[(*key, one.missed, one.idle) for key, one in found.criteria.items()],
        ),
        "table2-pairs": Table(
            columns=("building", "level", "one", "other", "along_one_axis", "pfa_g", *pairs[0].apart),
            rows=[(one.building, one.level, *one.names, one.is_along, one.pfa, *one.apart.values()) for one in pairs],
        ),
    }
    return write_finding(
        "table2",
        collect(compared, found, options),
        tables=tables, figures={"table2.svg": draw(7, 2.6, partial(_paint, found))},
    )  # fmt: skip


def _channel_rows(compared: Sequence[Compared]) -> Iterator[Row]:
    """Yield a row for each block at each PFA under each channel; `scaled_to` says how the PFA was chosen."""
    purposes = (*["given PFA"] * RECORDED, "as recorded", *["with its floor"] * len(TOGETHER))
    for one in compared:
        trials, channel = one.trials, one.trials.channel
        for at, purpose in enumerate(purposes):
            peaks = float(one.factors[at]), float(trials.pfa[at] / GRAVITY), float(100 * trials.pfv[at])
            for block, (breadth, height) in enumerate(zip(trials.breadth, trials.height, strict=True)):
                values = [float(one.formulas[key][at, block]) for key in (*FORMULAS, *CRITERIA)]
                yield (
                    channel.building, channel.level, channel.name, channel.axis, purpose, *peaks, 100 * breadth,
                    100 * height, *values, int(trials.fallen[at, block]), int(trials.fallen_uncertain[at, block]),
                    trials.runs, bool(trials.fell_in_record[at, block]),
                )  # fmt: skip


def _paint(found: Comparison, figure: Any) -> None:
    """Paint the bias of each formula over PFV/PFA, a point per channel: the influence that the formula leaves out."""
    axes = figure.subplots()
    for (key, title), (mark, colour) in zip(FORMULAS.items(), MARKS, strict=True):
        bias = [100 * one for one in found.biases[key]]
        axes.plot(found.ratios, bias, mark, ms=4, mfc="none", mec=colour, label=title)
    axes.axhline(0, color="#888888", lw=0.6)
    axes.set_xlabel("PFV/PFA of the record [s]", fontsize=7)
    axes.set_ylabel("bias [percentage points]", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.legend(fontsize=6, frameon=False)


def collect(compared: Sequence[Compared], found: Comparison, options: Options) -> dict[str, object]:
    """Return what the page shows."""
    names = list(by_building(compared))
    whole = {key: [found.agreements[name, ALL, key] for name in names] for key in (*FORMULAS, NOTHING)}
    nearest = min(FORMULAS, key=lambda key: sum(abs(one.bias) for one in whole[key]))
    trials = compared[0].trials
    off = np.abs(trials.breadth / options.breadth - 1) + np.abs(trials.height / options.height - 1)
    block = int(off.argmin())  # that nearest to the piece of the options
    pairs: list[dict[str, object]] = []
    for building, is_along in dict.fromkeys((one.building, one.is_along) for one in found.pairs):
        apart = [one.apart for one in found.pairs if (one.building, one.is_along) == (building, is_along)]
        means = [float(np.mean([one[key] for one in apart])) for key in (*FORMULAS, INTEGRATION)]
        closer = sum(one[INTEGRATION] < one[KANEKO] for one in apart)
        of = {"building": building, "is_along": is_along, "count": len(apart)}
        pairs.append(of | {"means": means, "closer": closer})
    return {
        "OR": OR, "KANEKO": KANEKO, "FEMA": FEMA, "NOTHING": NOTHING, "ALL": ALL, "INTEGRATION": INTEGRATION,
        "formulas": FORMULAS, "criteria": CRITERIA, "ratios": RATIOS, "heights": HEIGHTS, "levels": LEVELS,
        "together": TOGETHER, "records_at": RECORDS_AT, "clear": CLEAR, "g": GRAVITY,
        "uncertainty": Uncertainty(), "base": BASE,
        "options": options, "compared": compared, "found": found, "names": names, "whole": whole, "nearest": nearest,
        "correlation": correlate_ranks(found.biases[OR], found.ratios),
        "static": [found.criteria[name, STATIC] for name in names],
        "japan": [found.criteria[name, JAPAN] for name in names],
        "buildings": [
            {
                "building": own[0].building, "channels": len(own), "ratios": [one.ratio for one in own],
                "factors": [one.factors[at] for one in own for at in (0, len(LEVELS) - 1)],
                "peaks": [one.trials.channel.read().pfa / GRAVITY for one in own],
                "mean_pfa": [one.trials.mean_pfa for one in own], "mean_pfv": [one.trials.mean_pfv for one in own],
                "none": float(np.mean([one.trials.fallen[: len(LEVELS)] == 0 for one in own])),
                "records": [
                    float(np.mean([one.trials.fell_in_record[LEVELS.index(at)] for one in own])) for at in RECORDS_AT
                ],
            }
            for own in by_building(compared).values()
        ], "pairs": pairs,
        "block": block, "size": [float(one[block] / LENGTH["cm"]) for one in (trials.breadth, trials.height)],
        "shown": SHOWN, "at": LEVELS.index(SHOWN), **collect_published(),
    }  # fmt: skip


def collect_published() -> dict[str, object]:
    """Return the paper's Table 2, channel by channel, and how its formulas agree with its integration."""
    rows = read_facts("table2_methods")
    chances = {name: np.array([float(row[name]) for row in rows]) for name in (KANEKO, DIRECT, OR)}
    direct = chances[DIRECT]
    steps = {key: classify_all(one) - classify_all(direct) for key, one in chances.items()}
    return {
        "published": rows, "columns": list(chances),
        "above": int(np.sum(direct > chances[OR])), "level": int(np.sum(direct == chances[OR])),
        "judged": {
            key: {
                "name": name, "bias": float(np.mean(chances[key] - direct)),
                "rank_correlation": correlate_ranks(chances[key], direct),
                "too_low": float(np.mean(steps[key] < 0)), "too_high": float(np.mean(steps[key] > 0)),
            }
            for key, name in ((OR, "OR"), (KANEKO, "Kaneko-Hayashi"))
        },
    }  # fmt: skip


STUDY = Study(
    name="table2", order=30, title="Formulas against direct integration, by storey and channel",
    of="Table 2, sections 3.2.1 to 3.2.3", run=run, takes=frozenset({"breadth", "height"}),
)  # fmt: skip
