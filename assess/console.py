"""What the command line says, and the exit status it ends with."""

import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Never

import typer

from assess.errors import InputError, OutputError, Problem, WorkbookError

if TYPE_CHECKING:
    from assess.results import Assessment
    from assess.routes.model import Routes

MOST_PRINTED = 200
"""Problems printed in one run; the rest are counted."""
INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""


@contextmanager
def exits(interrupted: Callable[[], str] = lambda: "no report was written") -> Iterator[None]:
    """Turn what is raised on purpose into a message and an exit status; Ctrl-C ends the process at once.

    Reports are written beside the old ones and moved into place at the end, so that nothing is half written.

    Parameters
    ----------
    interrupted : callable
        Returns what there is to tell after Ctrl-C.
    """
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(f"\nInterrupted; {interrupted()}.", err=True)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(INTERRUPTED)  # threads that integrate would be waited for
    except WorkbookError as error:
        print_problems(error.problems)
        errors = sum(problem.severity == "error" for problem in error.problems)
        typer.echo(f"{errors} error{'s' if errors != 1 else ''}; nothing was written.", err=True)
        raise typer.Exit(2) from None
    except InputError as error:
        typer.echo(f"error  {error}", err=True)
        raise typer.Exit(2) from None
    except OutputError as error:
        typer.echo(f"error  {error}", err=True)
        raise typer.Exit(1) from None


@contextmanager
def stops() -> Iterator[None]:
    """Take a polite request to end (SIGTERM) as Ctrl-C."""

    def stop(*_: object) -> Never:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def print_problems(problems: Sequence[Problem]) -> None:
    """Print problems to standard error, the first `MOST_PRINTED` of them."""
    for problem in problems[:MOST_PRINTED]:
        typer.echo(f"{problem.severity:<7}  {problem}", err=True)
    if len(problems) > MOST_PRINTED:
        typer.echo(f"... and {len(problems) - MOST_PRINTED:,} more.", err=True)


def print_result(assessment: "Assessment", files: Sequence[Path]) -> None:
    """Print the pieces of each class and how many routes are at risk, and name the files."""
    from assess.ranking import count_pieces
    from assess.risk import RiskClass

    counts, anchored = count_pieces(assessment)
    for risk in reversed(RiskClass):
        typer.echo(f"{risk.label:<13} {counts[risk]:>6,} {'piece' if counts[risk] == 1 else 'pieces'}")
    if anchored:
        typer.echo(f"{'  anchored':<13} {anchored:>6,}, only as safe as the anchors")
    if assessment.routes:
        typer.echo(_describe_routes(assessment.routes))
    typer.echo(f"Chance of overturning in this scenario, not per year. {_describe_verification(assessment)}")
    for file in files:
        typer.echo(f"wrote {file}", err=True)


def _describe_routes(routes: "Routes") -> str:
    from assess.report.findings.routes import is_held
    from assess.routes.model import RouteState

    outlooks = [one.outlook for one in routes.routes if one.is_evaluated]
    states = [one.state for one in outlooks]
    doubtful = sum(one.state == RouteState.OPEN < one.upper for one in outlooks)
    held = sum(is_held(one, routes.risk) for one in outlooks)
    unknown = len(routes.routes) - len(outlooks)
    return (
        f"Evacuation routes: of {len(states):,}, {states.count(RouteState.BLOCKED):,} may be blocked and "
        f"{states.count(RouteState.REDUCED):,} reduced at a risk of {100 * routes.risk:g} %"
        + (f", for {doubtful:,} more it is not excluded" if doubtful else "")
        + (f"; {held:,} may be blocked if anchors fail" if held else "")
        + (f"; {unknown:,} more {'is' if unknown == 1 else 'are'} not evaluated" if unknown else "")
        + f"; {routes.blocked_routes:.2f} are expected to be blocked."
    )


def _describe_verification(assessment: "Assessment") -> str:
    if not assessment.joints:
        return "Not verified."
    from assess.report.findings.verified import describe_verification

    return describe_verification(assessment)
