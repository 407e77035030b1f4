"""report.xlsx: the report as a workbook with live formulas."""

from pathlib import Path

from assess.report.formats import Format
from assess.report.job import Job


def _write(job: Job, path: Path) -> None:
    from assess.report.xlsx import write_xlsx

    write_xlsx(job.content, path, job.progress)


FORMATS = (Format(key="xlsx", file="report.xlsx", place=30, write=_write),)
