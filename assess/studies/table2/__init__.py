"""Study `table2`: formulas compared with direct integration, by storey and channel, on instrumented buildings.

The paper's Table 2 (sections 3.2.1 to 3.2.3) does this on three buildings whose records are not available.
"""

from collections.abc import Iterator, Sequence
from dataclasses import astuple
from functools import partial
from typing import Any

import numpy as np

from assess.report.figures.draw import draw
from assess.risk import classify_all
from assess.rocking.draws import BASE, Uncertainty
from assess.studies.agreement import NAMES, Compared, by_building, correlate_ranks, rock_all
from assess.studies.buildings import HEIGHTS, LEVELS, RATIOS, RECORDED, TOGETHER
from assess.studies.studied_methods import CRITERIA, FEMA, FORMULAS, INTEGRATION, JAPAN, KANEKO, OR, STATIC, FloatArray
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts
from assess.studies.study_pages import write_finding
from assess.studies.table2.comparison import ALL, NOTHING, Comparison, compare
from assess.units import GRAVITY, LENGTH

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
    return write_finding(
        "table2",
        collect(compared, found, options),
        tables=_build_tables(compared, found),
        figures={"table2.svg": draw(7, 2.6, partial(_paint, found))},
    )


def _build_tables(compared: Sequence[Compared], found: Comparison) -> dict[str, Table]:
    pairs = found.pairs
    return {
        "table2-channels": Table(columns=CHANNELS, rows=list(_channel_rows(compared))),
        "table2-agreement": Table(
            columns=("building", "cases_chosen", "method", *NAMES),
            rows=[(*key, *astuple(one)) for key, one in found.agreements.items()],
        ),
        "table2-uncertain": Table(
            columns=("building", "method", *NAMES),
            rows=[(*key, *astuple(one)) for key, one in found.uncertain.items()],
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
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=6, frameon=False)


# ---------------------------------------------------------------- the page: every conclusion follows from the numbers


def collect(compared: Sequence[Compared], found: Comparison, options: Options) -> dict[str, object]:
    """Return what the page shows."""
    names = list(by_building(compared))
    whole = {key: [found.agreements[name, ALL, key] for name in names] for key in (*FORMULAS, NOTHING)}
    nearest = min(FORMULAS, key=lambda key: sum(abs(one.bias) for one in whole[key]))
    return {
        "OR": OR, "KANEKO": KANEKO, "FEMA": FEMA, "NOTHING": NOTHING, "ALL": ALL, "INTEGRATION": INTEGRATION,
        "formulas": FORMULAS, "criteria": CRITERIA, "ratios": RATIOS, "heights": HEIGHTS, "levels": LEVELS,
        "together": TOGETHER, "records_at": RECORDS_AT, "clear": CLEAR, "g": GRAVITY,
        "uncertainty": Uncertainty(), "base": BASE,
        "options": options, "compared": compared, "found": found, "names": names, "whole": whole, "nearest": nearest,
        "correlation": correlate_ranks(found.biases[OR], found.ratios),
        "static": [found.criteria[name, STATIC] for name in names],
        "japan": [found.criteria[name, JAPAN] for name in names],
        "buildings": [describe_building(own) for own in by_building(compared).values()],
        "pairs": describe_pairs(found), **choose_block(compared, options), **collect_published(),
    }  # fmt: skip


def describe_building(own: Sequence[Compared]) -> dict[str, object]:
    """Return the channels of a building: recorded PFA [g], PFV/PFA [s], factors, motions and what falls [-]."""
    trials = [one.trials for one in own]
    return {
        "building": own[0].building, "channels": len(own), "ratios": [one.ratio for one in own],
        "factors": [one.factors[at] for one in own for at in (0, len(LEVELS) - 1)],
        "peaks": [one.channel.read().pfa / GRAVITY for one in trials],
        "mean_pfa": [one.mean_pfa for one in trials], "mean_pfv": [one.mean_pfv for one in trials],
        "none": float(np.mean([one.fallen[: len(LEVELS)] == 0 for one in trials])),
        "records": [float(np.mean([one.fell_in_record[LEVELS.index(at)] for one in trials])) for at in RECORDS_AT],
    }  # fmt: skip


def choose_block(compared: Sequence[Compared], options: Options) -> dict[str, object]:
    """Return the block that is nearest to the piece of the options, its size [cm], and where it is among the trials."""
    trials = compared[0].trials
    off = np.abs(trials.breadth / options.breadth - 1) + np.abs(trials.height / options.height - 1)
    block = int(off.argmin())
    size = [float(one[block] / LENGTH["cm"]) for one in (trials.breadth, trials.height)]
    return {"block": block, "size": size, "shown": SHOWN, "at": LEVELS.index(SHOWN)}


def describe_pairs(found: Comparison) -> list[dict[str, object]]:
    """Return how the channels of a floor agree, by building and direction."""
    rows: list[dict[str, object]] = []
    for building, is_along in dict.fromkeys((one.building, one.is_along) for one in found.pairs):
        own = [one.apart for one in found.pairs if (one.building, one.is_along) == (building, is_along)]
        means = [float(np.mean([one[key] for one in own])) for key in (*FORMULAS, INTEGRATION)]
        closer = sum(one[INTEGRATION] < one[KANEKO] for one in own)
        rows.append({"building": building, "is_along": is_along, "count": len(own), "means": means, "closer": closer})
    return rows


# ---------------------------------------------------------------- the paper's own table


def read_published() -> dict[str, FloatArray]:
    """Return the columns of chances of the paper's Table 2 [-], (27,) each."""
    rows = read_facts("table2_methods")
    return {name: np.array([float(row[name]) for row in rows]) for name in (KANEKO, DIRECT, OR)}


def collect_published() -> dict[str, object]:
    """Return the paper's Table 2, channel by channel, and how its formulas agree with its integration."""
    chances = read_published()
    direct, steps = (
        chances[DIRECT],
        {key: classify_all(one) - classify_all(chances[DIRECT]) for key, one in chances.items()},
    )
    return {
        "published": read_facts("table2_methods"), "columns": list(chances),
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
    name="table2",
    order=30,
    title="Formulas against direct integration, by storey and channel",
    of="Table 2, sections 3.2.1 to 3.2.3",
    run=run,
    takes=frozenset({"breadth", "height"}),
)
