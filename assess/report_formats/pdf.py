"""report.pdf and annex.pdf: the client's edition, and what it rests on; few read the latter, and it takes longest."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write(job: "Job", path: Path) -> None:
    from assess.report.pages.pdf import finish_pdf

    finish_pdf(job.layouts[path.name], job.results, path, job.options, job.progress, data=job.data)


FORMATS = (
    Format(key="pdf", file="report.pdf", place=10, write=_write, edition="client"),
    Format(key="annex", file="annex.pdf", place=20, write=_write, edition="annex", is_default=False),
)
