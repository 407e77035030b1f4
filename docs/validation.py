"""Write `validation.md` and its figures from the studies: ``python docs/validation.py``, part of ``make docs``.

Every number on the page is from the run, and the page names the processor and the versions of the packages. The
results of long work are kept in `out/studies` for the next run. The page and its figures are written together at the
end; until then `docs` is unchanged. The section of ``docs/formulas.py``, which is no study, stays as it is.
"""

import os
import sys
from pathlib import Path

from assess.progress import Progress, Report
from assess.studies import PAGE, Options, all_studies, build_page, run_all, write_files
from docs.machine import describe_machine

ROOT = Path(__file__).parents[1]
DOCS, OUT = ROOT / "docs", ROOT / "out" / "studies"
FIGURES = "figures/"
HEADING, NEXT = "## Formula adopted where nothing is simulated\n", "## Released blocks"
"""Of the section of `docs/formulas.py`, and of the one after it."""


def main() -> None:
    """Write the page."""
    options = Options(out=OUT, jobs=os.cpu_count() or 1)
    findings = run_all(all_studies(), options, Progress(show))
    figures = {f"{FIGURES}{name}": data for one in findings.values() for name, data in one.figures.items()}
    page = f"{build_page(all_studies(), findings, options, FIGURES)}\n{describe_machine()}\n"
    _, section = split_page((DOCS / PAGE).read_text(encoding="utf-8"))
    write_files(DOCS, figures | {PAGE: page.replace(NEXT, section + NEXT, 1).encode("utf-8")})


def split_page(page: str) -> tuple[str, str]:
    """Return the page without the section of `docs/formulas.py`, and that section."""
    before, found, rest = page.partition(HEADING)
    own, _, after = rest.partition(NEXT)
    return (before + NEXT + after, found + own) if found else (page, "")


def show(report: Report) -> None:
    """Print how far the work is."""
    end = "\n" if report.share == 1 else "\r"
    print(f"{report.stage}: {100 * report.share:.0f} %", end=end, file=sys.stderr)  # noqa: T201


if __name__ == "__main__":
    main()
