"""report.html: the report for a screen."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write(job: "Job", path: Path) -> None:
    from assess.report.pages.html import write_html

    write_html(job.content, path, job.options, job.progress)


FORMATS = (Format(key="html", file="report.html", place=40, write=_write),)
