"""Write `motions.md` and its figures: generated motions, and floors without a record, compared with records.

Run it with ``python docs/motions.py``. Every number on the page is from the run.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from assess.intensity import RATIO
from assess.motion.assumed import UNKNOWN, estimate_period
from assess.motion.floor_medians import find_medians
from assess.motion.formats import read_records
from assess.motion.generate import CALIBRATED, Generator, build_generator
from assess.motion.record import CORNER, Motion, treat
from assess.motion.spectrum import response_spectrum
from assess.motion.target import (
    JUDGED_FROM,
    build_grid,
    matched_to,
    recorded_target,
)
from docs.machine import describe_machine

ROOT = Path(__file__).parents[1]
MARKET = ROOT / "inventories" / "records" / "575-market"
SAMPLES = ROOT / "samples" / "records"
BERKELEY = ROOT / "samples" / "buildings" / "berkeley-1103"
SEED, ALL = 1, 200

RECORDS: dict[str, tuple[Path, float, float]] = {
    **{
        f"575 Market Street, {level}, {azimuth}°": (
            MARKET / f"891018_1.cra-1.0210{letter}.smc", 6.0 if azimuth in (45, 225) else 5.0, 175.0,
        )
        for letter, level, azimuth in (
            ("a", "42nd floor", 45), ("b", "42nd floor", 225), ("c", "42nd floor", 135),
            ("d", "34th floor", 45), ("e", "34th floor", 225),
            ("g", "25th floor", 45), ("h", "25th floor", 225), ("i", "25th floor", 135),
            ("k", "ground", 315),
        )
    },
    "Alhambra, 12th floor, 90°": (SAMPLES / "0165a_u.smc", 2.0, 50.0),
    "Berkeley, roof, east core, 171°": (SAMPLES / "1103.HN2.NP.RE_a.smc", 0.8, 50.0),
    **{
        f"Berkeley, {place}°": (BERKELEY / f"1103.{name}_a.smc", 0.8 if name.startswith("HN2") else 1.0, 50.0)
        for name, place in (
            ("HN2.NP.RC", "roof, centre, 171"), ("HN2.NP.RS", "roof, south-west, 171"),
            ("HN3.NP.RE", "roof, east core, 261"), ("HN3.NP.RS", "roof, south-west, 81"),
            ("HN2.NP.4E", "4th floor, east, 171"), ("HN2.NP.4W", "4th floor, west, 171"),
            ("HN2.NP.BE", "basement, east, 351"), ("HN2.NP.BW", "basement, west, 351"),
            ("HN3.NP.BE", "basement, east, 261"), ("HN3.NP.BW", "basement, west, 261"),
        )
    },
}  # fmt: skip
"""Records of floors: file, T1 as read from their spectra [s], and height of the building [m]: 175 for 575 Market
Street, 50 assumed for the other two, whose height is unknown."""

_MARKET, _BERKELEY = "575 Market Street", "Berkeley"
BLIND: dict[str, tuple[str, float]] = {
    **{
        f"{_MARKET}, {level}, {azimuth}°": (f"{_MARKET}, ground, 315°", place)
        for level, azimuth, place in (
            ("42nd floor", 45, 0.976), ("42nd floor", 225, 0.976), ("42nd floor", 135, 0.976),
            ("34th floor", 45, 0.786), ("34th floor", 225, 0.786),
            ("25th floor", 45, 0.571), ("25th floor", 225, 0.571), ("25th floor", 135, 0.571),
        )
    },
    **{
        f"{_BERKELEY}, {place}°": (f"{_BERKELEY}, basement, east, {base}°", height)
        for place, base, height in (
            ("roof, east core, 171", 351, 1.0), ("roof, centre, 171", 351, 1.0), ("roof, south-west, 171", 351, 1.0),
            ("roof, east core, 261", 261, 1.0), ("roof, south-west, 81", 261, 1.0), ("4th floor, east, 171", 351, 0.29),
            ("4th floor, west, 171", 351, 0.29),
        )
    },
}  # fmt: skip
"""Recorded floors with the record of the ground below them, and z/h [-]; that of Berkeley's fourth floor is assumed."""


def main() -> None:
    """Write the page and the figures."""
    from docs.ensemble_figures import draw_ensemble

    figures = ROOT / "docs" / "figures"
    motions = {name: treat(read_records(path)[0]) for name, (path, _, _) in RECORDS.items()}
    generators = {name: build(motion) for name, motion in motions.items()}
    across = {name: build(motion, axis="Y") for name, motion in motions.items()}
    first = next(iter(RECORDS))
    (figures / "ensemble.png").write_bytes(draw_ensemble(generators[first], first, "png"))
    page = (
        "\n".join(
            [
                *lines_of_ensembles(generators, across),
                *lines_of_shaking(generators),
                *lines_of_blind(motions),
                "",
                describe_machine(),
            ]
        )
        + "\n"
    )
    (ROOT / "docs" / "motions.md").write_text(page, encoding="utf-8")


def build(motion: Motion, axis: str = "X") -> Generator:
    """Return the generator of one record on a grid of its own."""
    grid = build_grid([motion])
    return build_generator(recorded_target(motion, grid), grid, seed=SEED, axis=axis, threads=2)


def lines_of_ensembles(generators: dict[str, Generator], across: dict[str, Generator]) -> Iterator[str]:
    """Yield the part on ensembles."""
    yield "# Motions of floors, with a record and without, compared with records"
    yield ""
    yield "Written by `python docs/motions.py`; every number is from that run (seed 1). The simulation in `assess"
    yield "run` uses such motions where a floor has a record: *recorded motion*. Elsewhere the motion is *assumed*:"
    yield "each draw is an earthquake with the PGA and PGV of the ground that are known, through a building whose"
    yield "period and stiffness are drawn, a beam that bends and shears (Miranda and Taghavi 2005), so that its"
    yield "floors move as one, with the phases and signs of its modes. A record of the ground takes the place of"
    yield "drawn ground motions. Floors of which PFA or PFV is typed meet it in every draw. Between floors with"
    yield "records and others draw k has the same random phases, but not the record's own phases above: what falls"
    yield "together there is an estimate."
    yield ""
    yield "## Ensembles compatible with a recorded floor"
    yield ""
    yield "Mean 5 % spectrum of 100 realisations against the record's, from 0.05 s to the period in the third column:"
    yield "1.5 times the longest at which pseudo-velocity is half its maximum, at least 3 s, at most 10 s. Scatter is"
    yield "the coefficient of variation among realisations: that of random phases, which is less than from one"
    yield "earthquake to another. Filter, bending and wavelets are found on the first 100 realisations; all 200 are"
    yield "those and the next 100, made by the same steps. Axis Y has other phases. The spectra of this table are"
    yield "exact, at 300 periods that are not those matched."
    yield ""
    yield "![Target, 100 realisations and their mean](figures/ensemble.png)"
    yield ""
    yield (
        "| record | PFA [g], PFV [cm/s] | to [s] | deviation: mean | largest | at [s] | all 200: mean | largest "
        "| axis Y: mean | largest | Y, all 200: mean | largest | mean PFA, scatter | mean PFV, scatter |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for name, generator in generators.items():
        yield row_of(name, generator, across[name])
    yield ""


def deviations_of(generator: Generator) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Return periods [s], and how the mean spectra of the first 100 and of all 200 deviate from the target [-]."""
    target, step = generator.target, generator.phases.grid.time_step
    periods = np.geomspace(JUDGED_FROM, matched_to(target.periods, target.pseudo), 300)
    spectra = response_spectrum(generator.realise(0, ALL), step, periods, threads=2).pseudo
    wanted = target.ordinates(periods, step)
    return periods, (spectra[:CALIBRATED].mean(axis=0) / wanted - 1, spectra.mean(axis=0) / wanted - 1)


def row_of(name: str, generator: Generator, across: Generator) -> str:
    """Return the row of one record."""
    target, fit = generator.target, generator.fit
    periods, (first, every) = deviations_of(generator)
    _, others = deviations_of(across)
    worst = int(np.abs(first).argmax())
    cells = [f"{np.abs(one).mean():.1%} | {one[np.abs(one).argmax()]:+.1%}" for one in (first, every, *others)]
    return (
        f"| {name} | {target.pfa / 9.80665:.3f}, {target.pfv * 100:.1f} | {fit.matched_to:.1f} | "
        f"{cells[0]} | {periods[worst]:.2f} | {' | '.join(cells[1:])} | "
        f"{fit.pfa_ratio:.2f}, {fit.pfa_scatter:.2f} | {fit.pfv_ratio:.2f}, {fit.pfv_scatter:.2f} |"
    )


def lines_of_shaking(generators: dict[str, Generator]) -> Iterator[str]:
    """Yield the part on what is not matched."""
    yield "### What is not matched"
    yield ""
    yield "Means of the first 100 and of all 200 realisations over the record's own: peak displacement of motions"
    yield "without their content below 0.1 Hz (PFD), time from 5 % to 95 % of Arias intensity, Arias intensity, zero"
    yield "crossings of acceleration. For the same spectrum random phases take more energy than a record, and longer: a"
    yield "single pulse of a record becomes several cycles."
    yield ""
    yield "| record | PFD | duration | Arias intensity | zero crossings |"
    yield "|---|---|---|---|---|"
    rows = []
    for name, generator in generators.items():
        assert generator.target.acceleration is not None  # noqa: S101 - all are records
        step, made = generator.phases.grid.time_step, generator.realise(0, ALL)
        own = shaking_of(generator.target.acceleration[None], step)[0]
        every = shaking_of(made, step) / own
        rows.append((every[:CALIBRATED].mean(axis=0), every.mean(axis=0)))
        yield f"| {name} | {' | '.join(f'{a:.2f}, {b:.2f}' for a, b in zip(*rows[-1], strict=True))} |"
    means = np.mean(rows, axis=0)
    yield f"| mean | {' | '.join(f'{a:.2f}, {b:.2f}' for a, b in zip(*means, strict=True))} |"
    yield ""


def shaking_of(motions: np.ndarray, step: float) -> np.ndarray:
    """Return PFD [m], duration [s], Arias intensity [m2/s3] and zero crossings of motions (k, n) [m/s2], (k, 4)."""
    motions = np.asarray(motions, np.float64)
    count = motions.shape[1]
    passed = np.cumsum(motions**2, axis=1)
    share = passed / passed[:, -1:]
    frequencies = np.fft.rfftfreq(2 * count, step)
    with np.errstate(divide="ignore"):
        low = np.where(frequencies > 0, 1 / np.sqrt(1 + (CORNER / frequencies) ** 8), 0.0)
        twice = np.where(frequencies > 0, -1 / (2 * np.pi * frequencies) ** 2, 0.0)
    displacement = np.fft.irfft(np.fft.rfft(motions, 2 * count, axis=1) * low * twice, axis=1)[:, :count]
    duration = ((share > 0.95).argmax(axis=1) - (share > 0.05).argmax(axis=1)) * step
    crossings = (np.signbit(motions[:, 1:]) != np.signbit(motions[:, :-1])).sum(axis=1)
    arias = passed[:, -1] * step * np.pi / (2 * 9.80665)
    return np.stack([np.abs(displacement).max(axis=1), duration, arias, crossings], axis=1)


def lines_of_blind(motions: dict[str, Motion]) -> Iterator[str]:
    """Yield the part on floors of which only the ground motion is known."""
    yield "## Floors without a record, blind from the ground"
    yield ""
    yield "Median PFA and PFV of drawn buildings on the ground motion over those that were recorded: from the"
    yield "recorded PGA and PGV of the ground along the same direction, or the nearest to it, and T1 or the height"
    yield "of the building. 1 is right. The floors of one building have one ground motion and one building in"
    yield "common: their ratios are not independent. Berkeley's earthquake is of magnitude 4.4, with a PGV/PGA of"
    yield "30 cm/s per g; its height is assumed."
    yield ""
    yield "| record | z/h | T1 known: PFA | PFV | by height: PFA | PFV | PGA and height alone: PFA | PFV |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, (ground, place) in BLIND.items():
        (_, period, height), own, base = RECORDS[name], motions[name], motions[ground]
        by_height, ratio = estimate_period(height), base.pfv / base.pfa
        cells = []
        for known, by in ((period, ratio), (by_height, ratio), (by_height, RATIO)):
            pfa, pfv = find_medians(known, place, UNKNOWN, by)
            cells += [f"{base.pfa * pfa / own.pfa:.2f}", f"{base.pfa * by * pfv / own.pfv:.2f}"]
        yield f"| {name} | {place:.2f} | {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
