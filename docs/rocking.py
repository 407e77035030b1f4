"""Write `rocking.md`: the accuracy of the integration of rocking, measured on pairs of block and real record.

Run it with ``python docs/rocking.py``. Every number on the page is from the run.
"""

import sys
import time
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from assess.rocking import ensemble, kernel  # noqa: E402
from assess.rocking.ensemble import rock_blocks  # noqa: E402
from assess.units import GRAVITY  # noqa: E402
from docs.machine import describe_machine  # noqa: E402
from tests.rocking.pairs import Pair, draw_pairs, ground, read_table  # noqa: E402 - a script, and tests are no part of the package
from tests.rocking.reference import of_sizes, scaled  # noqa: E402
from tests.rocking.variants import kernel_with  # noqa: E402

EVERY = 7
"""Of so many pairs one is used where the table is not needed whole."""
FINEST = 16


class Outcomes:
    """Verdicts, rotations and impacts of a list of pairs."""

    def __init__(self, rows: list[tuple[bool, float, int]]) -> None:
        over, rotation, impacts = zip(*rows, strict=True)
        self.over, self.rotation, self.impacts = np.array(over), np.array(rotation), np.array(impacts)


def main() -> None:
    """Write the page."""
    table = read_table()
    pairs = draw_pairs()
    page = [*lines_of_agreement(pairs, table), *lines_of_division(pairs[::EVERY]), *lines_of_steps(pairs)]
    page += [*lines_of_rest(pairs[::EVERY], table[::EVERY]), "", describe_machine()]
    (ROOT / "docs" / "rocking.md").write_text("\n".join(page) + "\n", encoding="utf-8")


def motion_of(pair: Pair) -> tuple[np.ndarray, float]:
    """Return the accelerations of a pair [g] and their time step [s]."""
    name, breadth, height, times = pair
    values, step = ground(name)
    return scaled(values, of_sizes(breadth, height), times), step


def rock(pairs: list[Pair], parts: int = 1, p_dt: float | None = None) -> Outcomes:
    """Rock pairs, with each step of the motion divided into `parts`, or stretched beforehand to so long a p dt."""
    rows = []
    for pair in pairs:
        values, step = motion_of(pair)
        if p_dt is not None:
            step = p_dt / of_sizes(*pair[1:3]).p
        at = np.arange((values.size - 1) * parts + 1) / parts
        divided = np.interp(at, np.arange(values.size), values)
        found = rock_blocks(pair[1], pair[2], divided[None] * GRAVITY, step / parts)
        rows.append((bool(found.overturned[0, 0]), float(found.rotation[0, 0]), int(found.impacts[0, 0])))
    return Outcomes(rows)


def of_table(table: list[dict[str, str]]) -> Outcomes:
    """Return what the reference found."""
    return Outcomes(
        [(row["overturned"] == "1", float(row["max_rotation_ratio"]), int(row["impacts"])) for row in table]
    )


def compare(found: Outcomes, other: Outcomes, chosen: np.ndarray | None = None) -> str:
    """Return cells: share of equal verdicts, and differences of rotations below the critical angle."""
    rocked = ~found.over & ~other.over & (other.rotation > 0) & (other.rotation < 1)
    if chosen is not None:
        rocked &= chosen
    error = np.abs(found.rotation[rocked] / other.rotation[rocked] - 1)
    verdicts = found.over == other.over if chosen is None else (found.over == other.over)[chosen]
    return (
        f"{verdicts.sum()} of {verdicts.size} ({verdicts.mean():.2%}) | {error.size} | {np.median(error):.1e} | "
        f"{np.quantile(error, 0.9):.1e} | {error.max():.1e}"
    )


COLUMNS = "equal verdicts | rotations compared | median difference | 90 % below | largest |"
RULE = "---|---|---|---|---|"


def lines_of_agreement(pairs: list[Pair], table: list[dict[str, str]]) -> Iterator[str]:
    """Yield the part on the reference."""
    found, reference = rock(pairs), of_table(table)
    robust = np.array([row["robust"] == "1" for row in table])
    more, fewer = int((found.over & ~reference.over).sum()), int((~found.over & reference.over).sum())
    yield "# Accuracy of the integration of rocking"
    yield ""
    yield "Written by `python docs/rocking.py`; every number is from that run. Pairs are those of"
    yield f"`tests/rocking/pairs.py`: the strongest 25 s of {len({pair[0] for pair in pairs})} records of floors and"
    yield "ground, blocks 0.6 to 2.2 m high with B/H of 0.1 to 0.6, peaks of 0.5 to 4 times the block's threshold."
    yield "Relative differences of rotations are compared where both stay below the critical angle."
    yield ""
    yield "## Against a reference"
    yield ""
    yield "scipy's DOP853 with a tolerance of 1e-10, one sample at a time, impacts located as events. A pair is robust"
    yield "if the reference has one verdict at seven amplitudes within 2 %."
    yield ""
    yield f"| pairs | {COLUMNS}"
    yield f"|---|{RULE}"
    yield f"| all | {compare(found, reference)} |"
    yield f"| robust | {compare(found, reference, robust)} |"
    yield ""
    yield f"{reference.over.mean():.2%} overturn by the reference, {found.over.mean():.2%} here: {more} pairs only"
    yield f"here, {fewer} only there."
    yield ""


def lines_of_division(pairs: list[Pair]) -> Iterator[str]:
    """Yield the part on shorter steps."""
    yield "## With shorter steps"
    yield ""
    yield "The same motions, on the straight lines between their samples, with each step divided, against undivided."
    yield ""
    yield f"| divided into | {COLUMNS}"
    yield f"|---|{RULE}"
    usual = rock(pairs)
    for parts in (2, 4, 8, 16):
        yield f"| {parts} | {compare(rock(pairs, parts), usual)} |"
    yield ""


def lines_of_steps(pairs: list[Pair]) -> Iterator[str]:
    """Yield the part on long steps."""
    yield "## Why longer steps are divided"
    yield ""
    yield f"Steps longer than p dt = {ensemble.LONGEST_STEP:g} are divided. Here the records are stretched until all"
    yield f"steps are as long as given, and not divided; compared with the same divided into {FINEST}."
    yield ""
    yield f"| p dt | {COLUMNS}"
    yield f"|---|{RULE}"
    with patch.object(ensemble, "LONGEST_STEP", 1.0):
        for p_dt in (0.05, 0.1, 0.2, 0.4):
            yield f"| {p_dt:g} | {compare(rock(pairs, 1, p_dt), rock(pairs, FINEST, p_dt))} |"
    yield ""


def timed(pairs: list[Pair]) -> float:
    """Return the seconds that the blocks of all pairs take under the record of the first, at a peak of 0.5 g."""
    values, step = ground(pairs[0][0])
    _, breadth, height, _ = zip(*pairs, strict=True)
    start = time.perf_counter()
    rock_blocks(breadth, height, values[None] * (0.5 * GRAVITY / np.abs(values).max()), step)
    return time.perf_counter() - start


def lines_of_rest(pairs: list[Pair], table: list[dict[str, str]]) -> Iterator[str]:
    """Yield the part on the height of the last hop."""
    reference = of_table(table)
    yield "## When a block rests"
    yield ""
    yield "After an impact a block rests if its next hop would be lower than this share of the critical angle; here it"
    yield f"is {kernel.REST:g}, in the reference 1e-9. Against the reference. Seconds: the time for all these blocks"
    yield f"under one record with a peak of 0.5 g, the least of nine, over those at {kernel.REST:g}."
    yield ""
    yield f"| share | {COLUMNS} impacts per pair | seconds |"
    yield f"|---|{RULE}---|---|"
    seconds, cells = {}, {}
    for rest in (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
        with patch.object(kernel, "rock", kernel_with(REST=rest)):
            rock(pairs[:5])  # compiles it
            found = rock(pairs)
            seconds[rest] = min(timed(pairs) for _ in range(9))
        cells[rest] = f"{compare(found, reference)} | {found.impacts.mean():.0f}"
    for rest, cell in cells.items():
        yield f"| {rest:g} | {cell} | {seconds[rest] / seconds[kernel.REST]:.2f} |"


if __name__ == "__main__":
    main()
