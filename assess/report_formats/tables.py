"""results.json, items.csv, and outcomes.npz with the outcomes of every motion: for other programs."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write_json(job: "Job", _path: Path) -> None:
    job.write_data()


def _write_csv(job: "Job", path: Path) -> None:
    from assess.report.data import write_csv

    write_csv(job.results, path, job.progress)


def _write_npz(job: "Job", path: Path) -> None:
    from assess.report.data import write_npz

    write_npz(job.results, path, job.progress)


FORMATS = (
    Format(key="json", file="results.json", place=50, write=_write_json),
    Format(key="csv", file="items.csv", place=60, write=_write_csv),
    Format(key="npz", file="outcomes.npz", place=80, write=_write_npz, is_default=False),
)
