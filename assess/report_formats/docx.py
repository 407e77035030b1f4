"""report.docx: the client's edition for Word."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write(job: "Job", path: Path) -> None:
    from assess.report.word import write_word

    write_word(job.content, path, job.options, job.progress)


FORMATS = (
    Format(
        key="docx", file="report.docx", place=70, write=_write, is_default=False,
        needs={"docx": "python-docx", "pypdfium2": "pypdfium2"}, extra="word",
    ),
)  # fmt: skip
