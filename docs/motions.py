"""Write `motions.md` and its figures: generated motions and generic targets, compared with records.

Run it with ``python docs/motions.py``. Every number on the page is from the run.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from assess.motion.formats import read_records
from assess.motion.generate import CALIBRATED, Generator, build_generator
from assess.motion.record import CORNER, Motion, treat
from assess.motion.spectrum import build_periods, pseudo_acceleration, response_spectrum
from assess.motion.target import (
    JUDGED_FROM,
    build_grid,
    estimate_period,
    generic_shape,
    generic_target,
    matched_to,
    recorded_target,
)
from assess.motion.target_fit import velocities
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


def main() -> None:
    """Write the page and the figures."""
    from docs.ensemble_figures import draw_ensemble, draw_targets

    figures = ROOT / "docs" / "figures"
    motions = {name: treat(read_records(path)[0]) for name, (path, _, _) in RECORDS.items()}
    generators = {name: build(motion) for name, motion in motions.items()}
    across = {name: build(motion, axis="Y") for name, motion in motions.items()}
    first = next(iter(RECORDS))
    (figures / "ensemble.png").write_bytes(draw_ensemble(generators[first], first, "png"))
    periods = build_periods(0.03, 10.0, 200)
    (figures / "targets.png").write_bytes(draw_targets(list(panels(motions, periods)), periods, "png"))
    page = (
        "\n".join(
            [
                *lines_of_ensembles(generators, across),
                *lines_of_shaking(generators),
                *lines_of_targets(motions),
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
    yield "# Generated motions and generic targets, compared with records"
    yield ""
    yield "Written by `python docs/motions.py`; every number is from that run (seed 1). The simulation"
    yield "in `assess run` uses such motions where a floor has a record, or only peaks."
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
    target, step = generator.target, generator.grid.time_step
    periods = np.geomspace(JUDGED_FROM, matched_to(target.periods, target.pseudo), 300)
    spectra = pseudo_acceleration(generator.realise(0, ALL), step, periods, threads=2)
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
        step, made = generator.grid.time_step, generator.realise(0, ALL)
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


def panels(
    motions: dict[str, Motion], periods: np.ndarray
) -> Iterator[tuple[str, list[np.ndarray], list[tuple[str, np.ndarray]]]]:
    """Yield what each panel of the figure of targets shows, a building each."""
    for building in dict.fromkeys(name.split(",")[0] for name in RECORDS):
        own = [name for name in RECORDS if name.startswith(building)]
        _, period, height = RECORDS[own[0]]
        recorded = [shape_of(motions[name], periods) for name in own]
        estimated = estimate_period(height)
        assert estimated is not None  # noqa: S101 - the height is known
        yield (
            building,
            recorded,
            [
                (f"T1 known: {period:g} s", generic_shape(periods, period)),
                (f"by height: {height:g} m, {estimated:.2f} s", generic_shape(periods, estimated, is_estimated=True)),
                ("neither known", generic_shape(periods, None)),
            ],
        )


def shape_of(motion: Motion, periods: np.ndarray) -> np.ndarray:
    """Return PSA/PFA [-] of a recorded motion."""
    return np.asarray(response_spectrum(motion.acceleration, motion.time_step, periods).pseudo / motion.pfa)


def lines_of_targets(motions: dict[str, Motion]) -> Iterator[str]:
    """Yield the part on generic targets."""
    periods = build_periods(0.05, 10.0, 200)
    yield "## Generic targets, for floors of which only PFA is known"
    yield ""
    yield "Largest pseudo-velocity of the generic spectrum over that of the record, both for the record's PFA, and the"
    yield "ratio of their ordinates at 1 s. Below 1 the generic spectrum is on the unsafe side. T1 is read from the"
    yield "records' spectra; the heights of the buildings at Alhambra and Berkeley are unknown; 50 m is assumed."
    yield ""
    yield "![PSA/PFA of recorded floors and of generic targets](figures/targets.png)"
    yield ""
    yield "| record | T1 known: velocity, 1 s | by height | neither known |"
    yield "|---|---|---|---|"
    for name, (_, period, height) in RECORDS.items():
        recorded = shape_of(motions[name], periods)
        shapes = (
            generic_shape(periods, period),
            generic_shape(periods, estimate_period(height), is_estimated=True),
            generic_shape(periods, None),
        )
        cells = [compare(shape, recorded, periods) for shape in shapes]
        yield f"| {name} | {' | '.join(cells)} |"
    yield ""
    yield from lines_of_peaks(motions)


def compare(generic: np.ndarray, recorded: np.ndarray, periods: np.ndarray) -> str:
    """Return the two ratios of a row."""
    at = int(np.abs(periods - 1.0).argmin())
    return f"{(generic * periods).max() / (recorded * periods).max():.1f}, {generic[at] / recorded[at]:.1f}"


def lines_of_peaks(motions: dict[str, Motion]) -> Iterator[str]:
    """Yield what the motions made from a generic spectrum come to."""
    motion = next(iter(motions.values()))
    yield "Where PFA and spectrum cannot both be met, PFA takes precedence and the misfit is reported. A given PFV caps"
    yield "the spectrum, at the level that makes the mean PFV what is given. Motions for"
    yield f"the PFA of the 42nd floor ({motion.pfa / 9.80665:.3f} g; its recorded PFV is {motion.pfv * 100:.0f} cm/s):"
    yield ""
    yield "| known | deviation of the mean spectrum: mean | largest | mean PFV [cm/s] |"
    yield "|---|---|---|---|"
    for words, known in (
        ("PFA", {}), ("PFA, T1 0.3 s", {"period": 0.3}), ("PFA, T1 0.8 s", {"period": 0.8}),
        ("PFA, T1 6 s", {"period": 6.0}), ("PFA, height 175 m", {"height": 175.0}), ("PFA, PFV 40 cm/s", {"pfv": 0.4}),
        ("PFA, PFV 40 cm/s, T1 6 s", {"pfv": 0.4, "period": 6.0}),
    ):  # fmt: skip
        grid = build_grid([], period=known.get("period"))
        generator = build_generator(generic_target(motion.pfa, grid, **known), grid, seed=SEED, axis="X", threads=2)
        fit, pfv = generator.fit, np.abs(velocities(generator.realise(), grid.time_step)).max(axis=1).mean()
        worst = f"{fit.worst_deviation:+.1%} at {fit.worst_period:.2f} s"
        yield f"| {words} | {fit.mean_deviation:.1%} | {worst} | {pfv * 100:.0f} |"


if __name__ == "__main__":
    main()
