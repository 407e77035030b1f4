"""report.xlsx: the report as a workbook with live formulas."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write(job: "Job", path: Path) -> None:
    from assess.report.xlsx import write_xlsx

    write_xlsx(job.content, path, job.progress)


FORMATS = (Format(key="xlsx", file="report.xlsx", place=30, write=_write),)
