"""report.html: the report for a screen."""

from pathlib import Path

from assess.report.formats import Format
from assess.report.job import Job


def _write(job: Job, path: Path) -> None:
    from assess.report.pages.html import write_html

    write_html(job.content, path, job.options, job.progress)


FORMATS = (Format(key="html", file="report.html", place=40, write=_write),)
