"""Study `table2`: formulas against direct integration, by storey and channel, on instrumented buildings.

The paper's Table 2 (sections 3.2.1 to 3.2.3) does this on three buildings whose records are not to be had.
"""

from collections.abc import Iterator, Sequence
from dataclasses import astuple
from functools import partial
from typing import Any

from assess.report.figures.draw import draw
from assess.studies._agreement import NAMES
from assess.studies._compared import Compared, compare
from assess.studies._formulas import CRITERIA, FORMULAS
from assess.studies._judged import RECORDED, TOGETHER, Judged, rock_all
from assess.studies._study import Finding, Options, Row, Study, Table
from assess.studies._table2_page import describe, explain_overview, give_overview, say_failures, summarise
from assess.studies._table2_print import describe_print
from assess.units import GRAVITY

CHANNELS = (
    "building", "level", "channel", "axis", "scaled_to", "factor", "pfa_g", "pfv_cm_s", "breadth_cm", "height_cm",
    *FORMULAS, *CRITERIA, "fallen", "runs", "fell_in_record",
)  # fmt: skip
MARKS = (("x", "#6b6b6b"), ("^", "#1b4f72"), ("o", "#db7133"), ("s", "#8c1d3f"))
"""Of the formulas in the figure."""


def run(options: Options) -> Finding:
    """Hold the formulas against integration."""
    judged = rock_all(options)
    found = compare(judged)
    return Finding(
        page=[*describe(judged, found, options), *describe_print()],
        overview=[*give_overview(found), *explain_overview(judged)],
        summary=[summarise(judged, found, options)],
        failures=list(say_failures(judged, found)),
        tables=_build_tables(judged, found),
        figures={"table2.svg": draw(7, 2.6, partial(_paint, found))},
    )


def _build_tables(judged: Sequence[Judged], found: Compared) -> dict[str, Table]:
    pairs = found.pairs
    return {
        "table2-channels": Table(columns=CHANNELS, rows=list(_channel_rows(judged))),
        "table2-agreement": Table(
            columns=("building", "cases_chosen", "method", *NAMES),
            rows=[(*key, *astuple(one)) for key, one in found.agreements.items()],
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


def _channel_rows(judged: Sequence[Judged]) -> Iterator[Row]:
    """Yield a row for each block at each PFA under each channel; `scaled_to` tells for what the PFA was chosen."""
    purposes = (*["given PFA"] * RECORDED, "as recorded", *["with its floor"] * len(TOGETHER))
    for one in judged:
        trials, channel = one.trials, one.trials.channel
        for at, purpose in enumerate(purposes):
            peaks = float(one.factors[at]), float(trials.pfa[at] / GRAVITY), float(100 * trials.pfv[at])
            for block, (breadth, height) in enumerate(zip(trials.breadth, trials.height, strict=True)):
                said = [float(one.formulas[key][at, block]) for key in (*FORMULAS, *CRITERIA)]
                yield (
                    channel.building, channel.level, channel.name, channel.axis, purpose, *peaks, 100 * breadth,
                    100 * height, *said, int(trials.fallen[at, block]), trials.runs,
                    bool(trials.fell_in_record[at, block]),
                )  # fmt: skip


def _paint(found: Compared, figure: Any) -> None:
    """Paint the bias of each formula over PFV/PFA, a point a channel: what the formula leaves out shows."""
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


STUDY = Study(
    name="table2",
    order=30,
    title="Formulas against direct integration, by storey and channel",
    of="Table 2, sections 3.2.1 to 3.2.3",
    run=run,
    takes=frozenset({"breadth", "height"}),
)
