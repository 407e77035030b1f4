"""items.parquet: a row a piece, for other programs."""

from pathlib import Path
from typing import TYPE_CHECKING

from assess.report_formats import Format

if TYPE_CHECKING:
    from assess.report.job import Job


def _write(job: "Job", path: Path) -> None:
    from assess.report.parquet_file import write_parquet

    write_parquet(job.results, path, job.progress)


FORMATS = (
    Format(
        key="parquet", file="items.parquet", place=90, write=_write, is_default=False, needs={"duckdb": "duckdb"},
        extra="parquet",
    ),
)  # fmt: skip
