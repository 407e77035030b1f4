"""Housner Monte Carlo (key ``housner_monte_carlo``): the rocking of each piece, integrated under many motions.

Reference
---------
Sections 2.1 and 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas", equations (1) to (4); the block
is Housner's (1963), of any height of the centre of gravity.

Equations
---------
theta'' = -p2 [sin(alpha sgn theta - theta) + (a_g/g) cos(alpha sgn theta - theta)], p2 = m g R / I0; risk =
overturned / N, with its Wilson interval.

Validity
--------
Rigid, free-standing pieces that neither slide nor bounce, with B/H below 1.41 (of a uniform block), in plane motion.

Departures
----------
N is 200 by default; the paper's is 100, of which none fallen cannot show "low". With N "auto", the interval is that of
six checks. What the piece does under the recorded motion itself is found too. The paper's Monte Carlo takes the floor's
motion and the piece as exactly known; that is found as well (`ideal`), but adopted is the chance in an earthquake like
this one, of a piece like this one: see `assess.rocking.draws`.
"""

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray, IntArray
from assess.i18n import Text, fill, nfill
from assess.methods.cases import NO_WALL, Alike, Cases, Ensemble, Joint
from assess.methods.expression import number, show
from assess.methods.method import Column, Example, Method, Outcome, Reason, Reference
from assess.methods.simulate import (
    LOOKS,
    SlipAndWall,
    find_branch,
    interval_width,
    make_batches,
    rock_cases,
    rock_draws,
    run_side_by_side,
)
from assess.methods.verdicts import Verdicts
from assess.progress import SILENT, Stage
from assess.risk import classify_all, wilson_end, wilson_interval
from assess.rocking.block import MIDDLE
from assess.rocking.draws import TRIED
from assess.rocking.sliding import UNKNOWN, Branch, is_outside_shenton
from assess.settings import AUTO, Settings
from assess.units import GRAVITY, LENGTH

BATCH = 500
"""Motions made at once."""
MOST_PAIRS = 400_000
"""Pairs of case and motion that are rocked at once; they take some 800 bytes each, for all dispersions together."""
SHOWN = 3
"""Motions kept for reports."""


WAYS = np.array([one.word for one in Branch] + [""])
"""How a piece starts to move, of `Branch` and last of `UNKNOWN`."""
COUNTS = ("runs", "draws", "fallen", "ideal")
AS_FOUND = (
    "if_slower", "if_faster", "record_overturned", "record_rotation", "sliding_branch", "slip_median_cm", "slip_84_cm",
    "one_sided",
)  # fmt: skip
"""Columns that are found ensemble by ensemble."""
FLAGS = ("shenton_extended", "wall_higher", "assumed_motion", "unknown_building", "weak_motions")
"""Flags that are, after `fell_in_record`."""


def evaluate(
    cases: Cases, settings: Settings, *, threads: int = 1, stage: Stage | None = None, verdicts: Verdicts | None = None
) -> Outcome:
    """Integrate the cases that have an ensemble, each of which is one part of `stage`; the others have no value.

    With `verdicts`, which hold all of those cases, nothing is integrated: slip, walls and how far pieces turn are left
    out, which change no chance.
    """
    known = (cases.ensemble >= 0) & ~cases.is_stocky & ~np.isnan(cases.threshold)
    owns = [(number, np.flatnonzero(known & (cases.ensemble == number))) for number in range(len(cases.ensembles))]
    owns = [(number, own) for number, own in owns if own.size or (cases.slides_under == number).any()]
    side_by_side = min(threads, len(owns))
    stage = stage or Stage(SILENT, "verification", "", len(cases.ensembles))
    count, way, joints = cases.breadth.size, find_branch(cases), []
    found: dict[str, NDArray[Any]] = {name: np.zeros(count, dtype=np.int64) for name in COUNTS}
    found |= {"tried": np.zeros((len(TRIED), count), dtype=np.int64)}
    found |= {name: np.full(count, np.nan) for name in AS_FOUND} | {"sliding_branch": WAYS[way]}
    found |= {name: np.zeros(count, dtype=np.bool_) for name in FLAGS}
    found["shenton_extended"] = (way != UNKNOWN) & is_outside_shenton(cases.centre)

    work = partial(_integrate, cases, settings, stage, max(1, threads // max(1, side_by_side)))
    done = run_side_by_side(work, owns, side_by_side)
    if verdicts is not None:
        done = (_recall(cases, settings, verdicts, *one) for one in owns if one[1].size)
    for joint, parts in done:
        joints += [joint] if joint.cases.size else []
        for own, values in parts:
            for name, one in values.items():
                found[name][..., own] = one
    runs, draws, has_run, assumed = found["runs"], found["draws"], found["runs"] > 0, found["assumed_motion"]
    fallen, share, low, high = _count(found["fallen"], runs, draws, settings)
    exact = runs if settings.ideal else np.where(assumed, 0, runs)  # what is drawn cannot recur
    ideal = _count(found["ideal"], exact, exact, settings)
    tried = [_count(one, runs, draws, settings)[1] for one in found["tried"]]
    detail = {
        "runs": np.where(has_run, runs, np.nan),
        "draws": np.where(has_run, draws, np.nan),
        "overturned": fallen,
        "low": low,
        "high": high,
        **dict(zip(("ideal_overturned", "ideal", "ideal_low", "ideal_high"), ideal, strict=True)),
        **{f"dispersion_{one:g}": np.where(assumed, np.nan, way) for one, way in zip(TRIED, tried, strict=True)},
        **{name: found[name] for name in AS_FOUND},
    }
    open_low, open_high = ideal[2:] if settings.ideal else (low, high)
    undecided = has_run & (settings.runs == AUTO) & (classify_all(open_low) != classify_all(open_high))
    flags = {"fell_in_record": found["record_overturned"] == 1, **{name: found[name] for name in FLAGS}}
    return Outcome(share, detail, {**flags, "does_not_rock": cases.is_stocky, "undecided": undecided}, tuple(joints))


def _count(fallen: IntArray, runs: IntArray, draws: IntArray, settings: Settings) -> tuple[FloatArray, ...]:
    """Return how many of the draws overturn each case, their share, and its interval; NaN where there are none.

    `draws` are those of all pieces alike, which have their earthquakes in common: the interval is that of `runs`.
    """
    done, some = runs > 0, np.maximum(runs, 1)
    share = fallen / np.maximum(draws, 1)
    ends = wilson_interval(share * some, some, interval_width(settings))
    return tuple(np.where(done, one, np.nan) for one in (fallen, share, *ends))


def _integrate(
    cases: Cases, settings: Settings, stage: Stage, threads: int, number: int, own: NDArray[np.intp]
) -> tuple[Joint, list[tuple[NDArray[np.intp], dict[str, Any]]]]:
    """Integrate the cases `own` of an ensemble, check by check with runs="auto"; those that are decided leave.

    Returned: also, by name, what was found of some of the cases.
    """
    from assess.motion.target_fit import measure_peaks

    ensemble, progress = cases.ensembles[number], stage.progress
    motions, is_drawn = ensemble.open(threads, progress), ensemble.is_assumed
    checks = LOOKS if settings.runs == AUTO else (int(settings.runs),)
    count, runs = own.size, np.zeros(own.size, dtype=np.int64)
    fell, ideal = np.zeros((count, 0), np.bool_), np.zeros((count, 0), np.bool_)
    rotation, tried = np.zeros((count, 0), np.float32), np.zeros((len(TRIED), count), dtype=np.int64)
    size, going, has_wall = min(BATCH, MOST_PAIRS // max(1, count) + 1), np.arange(count), cases.wall[own] != NO_WALL
    extras = SlipAndWall(cases, settings, np.flatnonzero(cases.slides_under == number), own[has_wall])
    alike, speeds = Alike.of(cases.alike[own], cases.quantity[own]), list[FloatArray]()
    for first, last in zip((0, *checks), checks, strict=False):
        wider = ((0, 0), (0, last - first))
        fell, ideal, rotation = np.pad(fell, wider), np.pad(ideal, wider), np.pad(rotation, wider)
        for at, batch, time_step in make_batches(motions, first, last, size):
            here = slice(at, at + len(batch))
            if going.size:
                drawn, turned = rock_draws(
                    cases, own[going], batch, time_step, first=at, seed=settings.seed, threads=threads,
                    dispersions=(cases.dispersion[own[going]], *(() if is_drawn else TRIED)), progress=progress,
                )  # fmt: skip
                fell[going, here], rotation[going, here] = drawn[0], turned[0]
                if is_drawn:
                    pfa, pfv = measure_peaks(batch, time_step).T
                    speeds.append(np.asarray(pfv / pfa))
                else:
                    tried[:, going] += drawn[1:].sum(axis=2)
                if settings.ideal or not is_drawn:
                    ideal[going, here], _ = rock_cases(cases, own[going], batch, time_step, threads, progress)
            if first == 0:
                extras.add(batch, time_step, at, threads, progress)
            stage.at(here.stop / checks[-1], number)
        runs[going] = last
        counted = ideal if settings.ideal else fell
        low, high = wilson_interval(alike.average(counted.sum(axis=1))[going], last, interval_width(settings))
        going = going[classify_all(low) != classify_all(high)]
        if not going.size:
            break
    stage.at(1.0, number)
    shown = [(one.astype(np.float32), step) for many, step in motions.realise(0, min(SHOWN, last)) for one in many]
    joint = Joint(
        ensemble=number, cases=own, runs=runs, fell=fell, ideal=ideal, rotation=rotation, examples=shown,
        fit=motions.fit, spectra=motions.spectra and motions.spectra.first(last), is_weak=motions.is_weak,
        bands=motions.bands,
    )  # fmt: skip
    every = np.concatenate(speeds) if speeds else np.zeros(0)
    found = {**_sum_up(joint, ensemble, counted, alike, every), "tried": alike.add_up(tried)}
    if ensemble.record is not None and count:
        motion, time_step = ensemble.record
        under, angle = rock_cases(cases, own, motion[np.newaxis], time_step, threads, progress)
        found |= {"record_overturned": under[:, 0].astype(np.float64), "record_rotation": angle[:, 0]}
    return joint, [(own, found), *extras.find(counted, has_wall, alike)]


def _recall(
    cases: Cases, settings: Settings, verdicts: Verdicts, number: int, own: NDArray[np.intp]
) -> tuple[Joint, list[tuple[NDArray[np.intp], dict[str, Any]]]]:
    """Return what `_integrate` does of the cases `own` of an ensemble, from what is kept of them."""
    known, ensemble = verdicts.recall(cases, number, own, settings), cases.ensembles[number]
    joint = Joint(
        ensemble=number, cases=own, runs=np.full(own.size, int(settings.runs)), fell=known.fell, ideal=known.ideal,
        rotation=np.zeros((0, 0), dtype=np.float32), examples=(), fit=None, is_weak=known.is_weak,
    )  # fmt: skip
    alike, every = Alike.of(cases.alike[own], cases.quantity[own]), known.speeds
    counted = known.ideal if settings.ideal else known.fell
    found = _sum_up(joint, ensemble, counted, alike, np.zeros(0) if every is None else every)
    record = dict(zip(("record_overturned", "record_rotation"), known.record.T, strict=True))
    return joint, [(own, {**found, **record})]


def _sum_up(joint: Joint, ensemble: Ensemble, counted: BoolArray, alike: Alike, speeds: FloatArray) -> dict[str, Any]:
    """Return what follows from the draws of the cases of an ensemble, whose motions have PFV/PFA `speeds` [s]."""
    slower, faster = _find_thirds(counted, joint.runs, speeds, alike)
    return {
        "runs": joint.runs, "draws": joint.runs * alike.total, "fallen": alike.add_up(joint.fell.sum(axis=1)),
        "ideal": joint.ideal.sum(axis=1), "if_slower": slower, "if_faster": faster,
        "assumed_motion": ensemble.is_assumed, "unknown_building": ensemble.is_unknown, "weak_motions": joint.is_weak,
    }  # fmt: skip


def _find_thirds(
    fell: BoolArray, runs: NDArray[np.int64], every: FloatArray, alike: Alike
) -> tuple[FloatArray, FloatArray]:
    """Return the chances (m,) in the third of the draws with the least PFV/PFA and in that with the most; else NaN."""
    found = np.full((2, len(runs)), np.nan)
    for count in np.unique(runs[runs > 0]).tolist() if every.size else ():
        order = np.argsort(every[:count], kind="stable")
        own, third = runs == count, max(1, count // 3)
        for row, draws in zip(found, (order[:third], order[-third:]), strict=True):
            row[own] = fell[:, draws].mean(axis=1)[own]
    slower, faster = (alike.average(row) for row in found)
    return slower, faster


# ---------------------------------------------------------------- worked through for one piece


def steps(example: Example) -> list[Text]:
    """Work the numbers of the block, then the share of motions that overturn it, and its interval."""
    k, n, draws = (example.number(name) for name in ("overturned", "runs", "draws"))
    z = interval_width(example.settings)
    share, runs, width = number(example.value, ".5f"), number(n, ".0f"), number(z, ".4f")
    numbers = {"low": example.number("low"), "high": example.number("high"), "z": z}
    found = [
        *_work_block(example),
        nfill(
            "It overturned in {k:,} of {n:,} draw of an earthquake like this one.",
            "It overturned in {k:,} of {n:,} draws of an earthquake like this one.",
            int(n),
            k=int(k),
        )
        if draws == n
        else fill(
            "It and the pieces exactly like it on its floor overturned in {k:,} of {draws:,} draws of an earthquake "
            "like this one, {n:,} each.",
            k=int(k), draws=int(draws), n=int(n),
        ),
        show("R = k/n", number(k, ".0f") / number(draws, ".0f"), ".4f"),
        show("R_low", wilson_end(share, runs, width, is_high=False), ".4f"),
        show("R_high", wilson_end(share, runs, width, is_high=True), ".4f"),
        fill("The 95 % interval reaches from {low:.4f} to {high:.4f} (Wilson, z = {z:.2f}).", **numbers),
    ]  # fmt: skip
    fallen, fell = example.number("ideal_overturned"), example.number("record_overturned")
    if not math.isnan(fallen):  # what is drawn cannot recur
        found.append(
            nfill(
                "If exactly this motion recurred and the piece were exactly as given, it would overturn under {k:,} of "
                "{n:,} motion.",
                "If exactly this motion recurred and the piece were exactly as given, it would overturn under {k:,} of "
                "{n:,} motions.",
                int(n),
                k=int(fallen),
            )
        )
    if fell == 1:
        found.append(fill("Under the recorded motion itself it overturns, so its class is at least high."))
    elif fell == 0:
        found.append(fill("Under the recorded motion itself it does not overturn."))
    return found


def _work_block(example: Example) -> list[Text]:
    B, H = (number(one * LENGTH["cm"], ".6g") for one in (example.breadth, example.height))
    g = number(GRAVITY, ".5f")
    if example.centre == MIDDLE:
        alpha, r, limit = np.arctan(B / H), 0.5 * np.sqrt(B**2 + H**2), g * B / H
        p = np.sqrt(3 * g / (4 * number(float(r.value), ".6g")))
        found = [
            show("α = atan(B/H)", alpha, ".6f", "rad"),
            show("r = ½·√(B² + H²)", r, ".5f", "m"),
            show("p = √(3g/4r)", p, ".4f", "rad/s"),
            show("g·B/H", limit, ".4f", "m/s²"),
        ]
        eta = show("η = 1 - 1.5·sin² α", 1 - 1.5 * np.sin(number(float(alpha.value), ".6f")) ** 2, ".4f")
    else:
        half, height = B / 2, number(example.centre, ".4g") * H
        b, z = number(float(half.value), ".6g"), number(float(height.value), ".6g")
        limit, alpha, radius = g * b / z, np.arctan(b / z), np.sqrt(b**2 + z**2)
        R = number(float(radius.value), ".6g")
        inertia = (B**2 + H**2) / 12 + R**2
        I = number(float(inertia.value), ".6g")  # noqa: E741 - the symbol of mechanics
        found = [
            show("b = B/2", half, ".5f", "m"),
            show("z_c", height, ".5f", "m"),
            show("α = atan(b/z_c)", alpha, ".6f", "rad"),
            show("R = √(b² + z_c²)", radius, ".5f", "m"),
            show("I₀/m = (B² + H²)/12 + R²", inertia, ".5f"),
            show("p = √(m·g·R/I₀)", np.sqrt(g * R / I), ".4f", "rad/s"),
            show("g·b/z_c", limit, ".4f", "m/s²"),
        ]
        eta = show("η = 1 - 2·m·R²·sin² α/I₀", 1 - 2 * b**2 / I, ".4f")
    if not math.isnan(example.restitution):
        eta = fill("η = {eta:g}, as set for the building.", eta=example.restitution)
    starts = fill(
        "The piece starts to rock where the floor's acceleration exceeds {limit:.4f} m/s².", limit=limit.value
    )
    return [*found, eta, starts]


METHOD = Method(
    key="housner_monte_carlo",
    title="Housner Monte Carlo",
    short_title="Housner Monte Carlo",
    role="simulation",
    kind="probability",
    order=70,
    predicts="The chance that a free-standing piece overturns, from its rocking integrated under many motions that are "
    "compatible with the floor's record or drawn for its building, in an earthquake like this one.",
    reference=Reference(
        authors="Housner G",
        year="1963",
        title="The behavior of inverted pendulum structures during earthquakes",
        source="Bulletin of the Seismological Society of America 53(2):403-417",
        remark='The Monte Carlo is section 3.2.2 of "Overturning Risk of Furniture in Earthquake Affected Areas".',
    ),
    needs=frozenset({"breadth", "height", "ensemble"}),
    evaluate=evaluate,
    steps=steps,
    columns=(
        Column("runs", "Draws", kind="count", format=",.0f"),
        Column("draws", "Draws of all pieces alike", kind="count", format=",.0f"),
        Column("overturned", "Overturned", kind="count", format=",.0f"),
        Column("low", "Lower end of the interval"),
        Column("high", "Upper end of the interval"),
        Column("ideal_overturned", "Overturned, if exactly this motion recurred", kind="count", format=",.0f"),
        Column("ideal", "Chance if exactly this motion recurred"),
        Column("ideal_low", "Lower end of its interval"),
        Column("ideal_high", "Upper end of its interval"),
        Column("dispersion_0.2", "Chance with a dispersion of the motion of 0.2"),
        Column("dispersion_0.6", "Chance with a dispersion of the motion of 0.6"),
        Column("if_slower", "Chance in the third of the draws with the least PFV/PFA"),
        Column("if_faster", "Chance in the third of the draws with the most PFV/PFA"),
        Column("record_overturned", "Overturns under the record", kind="truth", format=".0f"),
        Column("record_rotation", "Largest rotation under the record over the critical angle", format=".2f"),
        Column("sliding_branch", "How it starts to move", kind="text", format=""),
        Column("slip_median_cm", "Peak slip, median", "cm", ".1f"),
        Column("slip_84_cm", "Peak slip, 84 %", "cm", ".1f"),
        Column("one_sided", "Chance with a wall at its back"),
    ),
    reasons=(
        Reason(
            "Direct integration follows each piece through whole motions of the floor, with its size. Draws that "
            "overturn it: {overturned} of {draws}."
        ),
        Reason(
            "PFA {pfa_g} g is {pfa_to_start} times g·B/H, above which a uniform block can start to rock; the draws "
            "that overturn the piece have higher peaks, or a more slender or top-heavy body.",
            side="above",
            can_rock=False,
        ),
        Reason(
            "PFA is {pfa_to_start} times g·B/H: rocking can start, but a short peak need not overturn the piece, and "
            "under most of the integrated motions it comes back to rest.",
            side="below",
            can_rock=True,
        ),
        Reason(
            "No record of this floor is known: the integrated motions are those of drawn earthquakes in drawn "
            "buildings.",
            flag="assumed_motion",
        ),
        Reason("The motions that were integrated are weaker than the floor's.", flag="weak_motions"),
    ),
    equations=(
        "I₀·θ″ + m·g·r·sin(-α - θ) = -m·a_g·r·cos(-α - θ), θ < 0   (1)",
        "I₀·θ″ + m·g·r·sin(α - θ) = -m·a_g·r·cos(α - θ), θ > 0   (2), I₀ = (4/3)·m·r², tan α = B/H, r = ½·√(B² + H²)",
        "θ″ = -p²·[sin(α·sgn θ - θ) + (a_g/g)·cos(α·sgn θ - θ)]   (3)",
        "p = √(3g/4r)   (4)",
        "Rocking starts where |a_g|/g > B/H",
        "After an impact: θ′ = (1 - 1.5·sin²α) · θ′ before; overturned: |θ| ≥ π/2",
        "Centre of gravity at z_c, not H/2: tan α = b/z_c, b = B/2, R² = b² + z_c², I₀ = m·(B² + H²)/12 + m·R², "
        "p² = m·g·R/I₀",
        "There rocking starts where |a_g|/g > b/z_c; after an impact: θ′ = (1 - 2·m·R²·sin²α/I₀) · θ′ before",
        "Draw k: motion k · exp(β·ε_k), ε_k = N(0, 1) for the whole building; base B·N(0.97, 0.05), height H·N(1, "
        "0.02), z_c/H = N(as given, 0.05), restitution = N(as given or as above, 0.04)",
        "Risk = overturned / N; interval: (R + z²/2N ± z·√(R(1 - R)/N + z²/4N²)) / (1 + z²/N)",
    ),
    assumptions=(
        "The piece is rigid and free-standing; its centre of gravity is at mid-height, or where the workbook gives it; "
        "it neither slides nor bounces, and moves in one plane; vertical motion is left out.",
        "An earthquake like this one: on floors with a record, or driven by one, β is 0.4, assumed, unless the "
        "workbook gives another. Elsewhere drawn motions scatter by themselves, and β is that of what gives the ground "
        "motion: of a ShakeMap, a field or an intensity; 0 of a typed peak or a code. ε is normal, and correlated from "
        "place to place in a city; scenarios of the ground bring their own numbers. Base, height, centre of gravity "
        "and restitution of each piece are drawn; their means and dispersions are assumed. Normal numbers are cut at 3 "
        "standard deviations.",
        "Sizes that were measured by a scan are less certain: base and height are drawn with standard deviations of "
        "0.1 and 0.05 of the given ones, also assumed.",
        "Draw k has one scale for the whole building, and its motions have the same random phases on every floor along "
        "an axis. Between floors that have records of one earthquake on one clock the sign of each octave is that of "
        "the records; elsewhere the signs of modes are not known.",
        "Motions are linear between samples. A block at rest can start again. After the end of a motion it is followed "
        "until it can no longer fall.",
        "The factors exp(β·ε_k) are stratified: each 25 draws have one ε in each 25th of its distribution, 200 one in "
        "each 200th. Pieces that are exactly alike on a floor have one chance, from the draws of all of them; which of "
        "them fall together in a draw is kept.",
        "The interval is Wilson's, 95 % (z = 1.96), of N independent draws: it covers the number of draws only, not "
        "the model of the block, how well the floor's motion is known, or the assumed dispersions. As the draws are "
        "stratified, it is wider than it has to be.",
        "The chance is that of a piece that does not slide. How it starts to move at the floor's PFA is shown beside, "
        "by Shenton's limits (1996), resting and sliding friction being equal. So is the peak slip of a block that "
        "slides and does not rock (Newmark 1965), under the same draws: it depends on the friction and the floor "
        "alone, and is 0 in draws in which the piece, by its size, does not slide. Neither lowers a chance or a class.",
        "With a wall at its back, a piece turns away from it alone and rebounds as by Sorrentino et al. (2011); this "
        "rebound is assumed, not compared with the printed paper. The wall moves with the floor and does not pound. "
        "Where the side of the wall is not known, the larger chance of the two directions counts. It is shown beside, "
        "and lowers nothing.",
        'With N "auto", motions are added at 125, 250, 500, 1,000, 2,500 and 5,000, and a piece is done once its '
        "interval (z = 2.64: 95 % for all six checks together) lies within one class. Slip and what a wall changes are "
        "found under the first 125.",
    ),
    departures=(
        'N is 200 by default; the paper\'s is 100. None of 100 fallen cannot show "low": the interval then reaches to '
        "0.037.",
        "What the piece does under the recorded motion itself is found as well: one that overturns there is at least "
        "high.",
        "The paper takes the floor's motion and the piece as exactly known. That chance is shown next to the adopted "
        "one, as that if exactly this motion recurred, and is adopted where a run asks for it.",
        "The paper's block is uniform; here the centre of gravity may be at any height.",
    ),
    flags={
        "fell_in_record": "it overturns under the recorded motion itself, so its class is at least high",
        "assumed_motion": "no record of this floor is known: ground motion and building are drawn",
        "unknown_building": "neither T1, Height, Storeys nor an Elevation is known: buildings of every period and "
        "floors of every height are drawn, and its class is that of the faster third of them where that is higher",
        "weak_motions": "the motions are weaker than the floor's: simulation may raise a class, never lower it",
        "shenton_extended": "Shenton's limits hold for a centre of gravity at mid-height: how this piece starts to "
        "move is derived in the same way for its own",
        "wall_higher": "with a wall at its back it falls in more draws than without one; its class is that without",
        "undecided": "after 5,000 motions its interval still reaches over more than one class",
        "does_not_rock": "B/H is 1.41 or more: too stocky to rock, direct integration and FEMA P-58 do not apply",
    },
)
