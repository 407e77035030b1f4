"""Write `validation.md` and its figures from the studies: ``python docs/validation.py``, part of ``make docs``.

Every number on the page is from the run. What takes long is kept in `out/studies` and taken up by the next run. The
page and its figures are written together at the end; `docs` is as it was until then.
"""

import os
import sys
from pathlib import Path

from assess.studies import Options, all_studies
from assess.studies._run import run_all, write_files
from assess.studies._write import PAGE, build_page

ROOT = Path(__file__).parents[1]
DOCS, OUT = ROOT / "docs", ROOT / "out" / "studies"
FIGURES = "figures/"


def main() -> None:
    """Write the page."""
    options = Options(out=OUT, jobs=os.cpu_count() or 1, tell=lambda what: print(what, file=sys.stderr))  # noqa: T201
    findings = run_all(all_studies(), options)
    figures = {f"{FIGURES}{name}": data for one in findings.values() for name, data in one.figures.items()}
    page = build_page(all_studies(), findings, options, FIGURES)
    write_files(DOCS, figures | {PAGE: page.encode("utf-8")})


if __name__ == "__main__":
    main()
