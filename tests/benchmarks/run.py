"""Benchmarks, each a ratio against a rival in the same run: ``make benchmark``, or alone by the names of their modules.

``python tests/benchmarks/run.py start`` takes half a minute; ``run.py whole_runs --before PATH`` prints whole runs as a
ratio to those of an older checkout, too. Times on a shared machine vary; each pair runs in turn, and the median of the
ratios is what counts.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.benchmarks import (
    beam_floors,
    bounds,
    cancel,
    generating,
    live_answers,
    models,
    portfolio,
    portfolio_growth,
    report,
    rocking,
    routes,
    storing,
    verified,
    whole_runs,
)

USUAL: Mapping[str, Callable[[Path], Iterator[str]]] = {
    "portfolio": portfolio.rows, "report": report.rows, "verified": verified.rows, "routes": routes.rows,
    "cancel": cancel.rows, "live_answers": live_answers.rows, "models": models.rows, "generating": generating.rows,
    "beam_floors": beam_floors.rows, "rocking": rocking.rows, "storing": storing.rows,
}  # fmt: skip
LONG: Mapping[str, Callable[[Path], Iterator[str]]] = {
    "bounds": bounds.rows, "portfolio_growth": portfolio_growth.rows, "portfolio_growth_small": portfolio_growth.small,
}  # fmt: skip
"""Only where they are named: each takes ten minutes and more, the last one a minute."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=["start", "whole_runs", *USUAL, *LONG, []], metavar="NAME",
                        help="start, whole_runs, " + ", ".join((*USUAL, *LONG)))  # fmt: skip
    parser.add_argument("--before", type=Path, help="a checkout that whole runs are compared with")
    given = parser.parse_args()
    for name in given.names or ("whole_runs", *USUAL):
        with tempfile.TemporaryDirectory() as box:
            if name in ("start", "whole_runs"):
                table = whole_runs.rows(Path(box), given.before, is_quick=name == "start")
            else:
                table = (USUAL | LONG)[name](Path(box))
            for row in table:
                print(row, flush=True)
        print()


if __name__ == "__main__":
    main()
