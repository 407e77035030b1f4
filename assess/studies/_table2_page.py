"""What the page says of formulas held against direct integration: tables and sentences of study `table2`."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from assess.studies._agreement import correlate_ranks
from assess.studies._compared import ALL, NOTHING, Compared
from assess.studies._formulas import CRITERIA, FORMULAS, INTEGRATION, percent
from assess.studies._judged import TOGETHER, Judged, by_building
from assess.studies._study import Options, Row, table_lines
from assess.studies._table2_print import say_contrary
from assess.studies._trials import HEIGHTS, LEVELS, RATIOS
from assess.units import GRAVITY, LENGTH

SHOWN = 0.5
"""PFA at which the table of channels shows the risks of one block [g]."""
RECORDS_AT = (0.3, 0.5, 0.7, 0.9)
"""PFA at which it is told what the records themselves overturn [g]."""
OR, KANEKO = "proposed_or", "kaneko_hayashi"


# ---------------------------------------------------------------- the head


def give_overview(found: Compared) -> Iterator[str]:
    """Yield the table of buildings and formulas: bias, rank correlation, classes missed in either direction."""
    heads = "bias", "error", "rank correlation", "same class", "within one", "too low", "too high"
    titles = {**FORMULAS, NOTHING: f'"{NOTHING}"'}
    yield from table_lines(
        ("building", "formula", *heads),
        [
            (
                name, titles[key], f"{100 * one.bias:+.1f}", f"{100 * one.rms:.1f}",
                "-" if math.isnan(one.rank_correlation) else f"{one.rank_correlation:.2f}",
                percent(one.same_class), percent(one.within_one_class),
                f"{100 * one.class_too_low:.1f} % ({100 * one.beyond_too_low:.1f})",
                f"{100 * one.class_too_high:.1f} % ({100 * one.beyond_too_high:.1f})",
            )
            for (name, subset, key), one in found.agreements.items()
            if subset == ALL
        ],
    )  # fmt: skip


def explain_overview(judged: Sequence[Judged]) -> Iterator[str]:
    """Yield what the columns of the overview are, and what the rows stand on."""
    yield ""
    told = "; ".join(
        f"{name}: {_count_channels(own)}, PFV/PFA {_span([one.ratio for one in own], 2)} s, scaled "
        f"{_span([one.factors[at] for one in own for at in (0, len(LEVELS) - 1)], 1)} times"
        for name, own in by_building(judged).items()
    )
    yield (
        "Bias is the mean of formula less integration, error their root mean square difference, both in percentage "
        "points; rank correlation is Spearman's. Too low and too high are the shares of cases (a block under the "
        "motions of a channel at one PFA) that a formula puts into a lower or a higher class than integration; in "
        "brackets those beyond the sampling error of the motions (class outside the 95 % interval, case by case). "
        f'"{NOTHING.capitalize()}" is a yardstick: what is farther off is of no use there. {told}.'
    )


def _count_channels(own: Sequence[Judged]) -> str:
    return f"{len(own)} channel{'s' if len(own) > 1 else ''}"


def summarise(judged: Sequence[Judged], found: Compared, options: Options) -> str:
    """Return one sentence on what was compared, and how near the nearest formula comes."""
    names = list(by_building(judged))
    near = min(FORMULAS, key=lambda key: sum(abs(found.agreements[name, ALL, key].bias) for name in names))
    biases = _join(f"{100 * found.agreements[name, ALL, near].bias:+.1f}" for name in names)
    ranks = _join(f"{found.agreements[name, ALL, near].rank_correlation:.2f}" for name in names)
    return (
        f"{len(judged)} floor channels of {len(names)} instrumented buildings, {options.runs} motions each, "
        f"{judged[0].trials.breadth.size} blocks: the smallest bias is that of {FORMULAS[near]}, {biases} points, with "
        f"rank correlations of {ranks} ({', '.join(names)}). {say_contrary()}"
    )


def say_failures(judged: Sequence[Judged], found: Compared) -> Iterator[str]:
    """Yield where the formulas fail against integration."""
    names, rest = list(by_building(judged)), found.at_rest
    by_ratio = correlate_ranks(found.biases[OR], found.ratios)
    high = {key: _join(percent(found.agreements[name, ALL, key].class_too_high) for name in names) for key in FORMULAS}
    yield (
        "**OR does not see how long a motion pushes.** It knows PFA alone, so it says the same for a slow floor and "
        f"for a quick one: it puts {high[OR]} of the cases into too high a class ({' / '.join(names)}). The quicker "
        f"the motion, the further off: over the channels, its bias has a rank correlation of {by_ratio:.2f} "
        "with PFV/PFA."
    )
    yield (
        f"**OR calls pieces dangerous that the record cannot rock.** In {percent(rest.share)} of the cases the "
        f"record's PFA is below g·B/H, so that a rigid block under it stands still. OR puts {percent(rest.above[OR])} "
        f"of these into class medium or higher, Kaneko-Hayashi {percent(rest.above[KANEKO])}, FEMA P-58 "
        f"{percent(rest.above['fema_p58'])}; integration {100 * rest.above_by_integration:.1f} %, from motions whose "
        "peaks exceed the record's."
    )
    low = _join(f"{100 * found.agreements[name, ALL, KANEKO].class_too_low:.1f}" for name in names)
    yield (
        f"**Kaneko-Hayashi errs to both sides**: too low a class in {low} % of the cases, too high in "
        f"{high[KANEKO]}; FEMA P-58 is hardly ever too low, and too high in {high['fema_p58']}."
    )
    yield from _say_useless(names, found)
    idle = _join(percent(found.criteria[name, "static"].idle) for name in names)
    missed = _join(_percent(found.criteria[name, "japan_rule"].missed) for name in names)
    yield (
        "**Criteria are no forecasts.** Of the cases that stand in most motions, the static criterion is met in "
        f"{idle}; of those that fall in at least half, the Japanese rule does not ask for fixing in {missed}."
    )


def _say_useless(names: Sequence[str], found: Compared) -> Iterator[str]:
    """Yield where a formula is farther off than the word that nothing falls."""
    for name in names:
        nothing, errors = found.agreements[name, ALL, NOTHING], {}
        for key, title in FORMULAS.items():
            error = found.agreements[name, ALL, key].rms
            if error > nothing.rms:
                errors[title] = f"{title} by {100 * error:.1f}"
        if errors:
            yield (
                f'**In {name} "{NOTHING}" is nearer than {len(errors)} of {len(FORMULAS)} formulas**: it errs by '
                f"{100 * nothing.rms:.1f} points (root mean square), {', '.join(errors.values())}; the mean chance by "
                f"integration is {100 * -nothing.bias:.1f} %."
            )


def _percent(share: float) -> str:
    return "-" if math.isnan(share) else percent(share)


def _join(words: Iterator[str]) -> str:
    return " / ".join(words)


def _span(values: Sequence[float], decimals: int) -> str:
    low, high = f"{min(values):.{decimals}f}", f"{max(values):.{decimals}f}"
    return low if low == high else f"{low} to {high}"


# ---------------------------------------------------------------- the section


def describe(judged: Sequence[Judged], found: Compared, options: Options) -> Iterator[str]:
    """Yield the section but for the paper's own table."""
    yield from _describe_inputs(judged, options)
    yield from _describe_subsets(found)
    yield from _describe_criteria(found)
    yield from _describe_channels(judged, options)
    yield from _describe_pairs(found)


def _describe_inputs(judged: Sequence[Judged], options: Options) -> Iterator[str]:
    buildings, blocks = by_building(judged), judged[0].trials.breadth.size
    yield (
        f"{blocks} blocks (B/H {RATIOS[0]:g} to {RATIOS[-1]:g}, heights {HEIGHTS[0]:g} to {HEIGHTS[-1]:g} m: an even "
        f"grid, not what stands in real buildings) under {options.runs} motions for each channel, generated for the 5 "
        f"% spectrum of its record and scaled so that the record's PFA is {LEVELS[0]:g}, {LEVELS[1]:g}, ... "
        f"{LEVELS[-1]:g} g, as in the paper's section 3.2.3. Scaling keeps the shape of the spectrum. Formulas are "
        "given PFA and PFV of the record. The records are of the U.S. Geological Survey and unchanged; they come "
        "along, with their provenance."
    )
    yield ""
    heads = (
        "building", "earthquake", "channels", "PFA recorded [g]", "scaled up to", "PFV/PFA [s]",
        "motions' mean PFA, PFV over the record's", "cases of which none fell",
        f"blocks that the records overturn at {', '.join(f'{one:g}' for one in RECORDS_AT)} g",
    )  # fmt: skip
    yield from table_lines(heads, [_building_row(own) for own in buildings.values()])
    yield ""


def _building_row(own: Sequence[Judged]) -> Row:
    building, trials = own[0].building, [one.trials for one in own]
    peaks = [one.channel.read().pfa / GRAVITY for one in trials]
    none = np.mean([one.fallen[: len(LEVELS)] == 0 for one in trials])
    records = [np.mean([one.fell_in_record[LEVELS.index(value)] for one in trials]) for value in RECORDS_AT]
    return (
        f"{building.name}, {building.place}", building.event, len(own), _span(peaks, 3),
        f"{LEVELS[-1] / min(peaks):.0f} times", _span([one.ratio for one in own], 3),
        f"{_span([one.mean_pfa for one in trials], 2)}, {_span([one.mean_pfv for one in trials], 2)}",
        percent(float(none)), _join(percent(float(one)) for one in records),
    )  # fmt: skip


def _describe_subsets(found: Compared) -> Iterator[str]:
    yield (
        "Bias on parts of the cases, in percentage points. OR as printed is equation (9), cut to 0 and 1; as used it "
        "is held where it would fall:"
    )
    yield ""
    rows = []
    for name, subset in dict.fromkeys((name, subset) for name, subset, _ in found.agreements):
        own = [found.agreements[name, subset, key] for key in FORMULAS]
        rows.append((name, subset, f"{own[0].cases:,}", *(f"{100 * one.bias:+.1f}" for one in own)))
    yield from table_lines(("building", "cases", "number", *FORMULAS.values()), rows)
    yield ""


def _describe_criteria(found: Compared) -> Iterator[str]:
    yield (
        "Criteria say yes or no. Not met though it falls: of the cases that fall in at least half of the motions; met "
        "though it stands: of the others."
    )
    yield ""
    rows = [
        (name, CRITERIA[key], _percent(one.missed), _percent(one.idle)) for (name, key), one in found.criteria.items()
    ]
    yield from table_lines(("building", "criterion", "not met though it falls", "met though it stands"), rows)
    yield ""


def _describe_channels(judged: Sequence[Judged], options: Options) -> Iterator[str]:
    """Yield the counterpart of the paper's Table 2: one block under every channel at one PFA."""
    trials = judged[0].trials
    off = np.abs(trials.breadth / options.breadth - 1) + np.abs(trials.height / options.height - 1)
    block, at = int(off.argmin()), LEVELS.index(SHOWN)
    size = f"{trials.breadth[block] / LENGTH['cm']:.0f} x {trials.height[block] / LENGTH['cm']:.0f} cm"
    yield (
        f"By storey and channel, one block of {size}, every record scaled from its PFA to {SHOWN:g} g (all blocks and "
        "values of PFA, recorded ones too: `table2-channels.csv`):"
    )
    yield ""
    rows = [
        (
            one.building.name, one.trials.channel.level, f"{one.trials.channel.name} ({one.trials.channel.axis})",
            f"{one.trials.channel.read().pfa / GRAVITY:.3f}", f"{one.ratio:.3f}",
            *(percent(one.formulas[key][at, block]) for key in FORMULAS), percent(one.trials.risk[at, block]),
        )
        for one in judged
    ]  # fmt: skip
    heads = ("building", "level", "channel", "PFA [g]", "PFV/PFA [s]", *FORMULAS.values(), INTEGRATION)
    yield from table_lines(heads, rows)
    yield ""


def _describe_pairs(found: Compared) -> Iterator[str]:
    """Yield whether the channels of a floor agree: the paper finds that under integration they do."""
    names = (*FORMULAS.values(), INTEGRATION)
    yield (
        f"Two channels of one floor, moved by one factor (the stronger to {', '.join(f'{one:g}' for one in TOGETHER)} "
        "g): mean difference of the chances of a block, in percentage points. The paper's section 3.2.2 finds that "
        "integration brings the channels of a floor together. Where little falls all are near together; motions along "
        "one axis of a building share their phases here, which brings them nearer, too."
    )
    yield ""
    rows = []
    for building, is_along in dict.fromkeys((one.building, one.is_along) for one in found.pairs):
        own = [one for one in found.pairs if (one.building, one.is_along) == (building, is_along)]
        closer = sum(one.apart[INTEGRATION] < one.apart[KANEKO] for one in own)
        means = [f"{100 * np.mean([one.apart[key] for one in own]):.1f}" for key in (*FORMULAS, INTEGRATION)]
        axes = "along one axis" if is_along else "across"
        rows.append((building, axes, len(own), *means, f"{closer} of {len(own)}"))
    heads = "building", "channels", "comparisons", *names, "integration closer than Kaneko-Hayashi"
    yield from table_lines(heads, rows)
    yield ""
