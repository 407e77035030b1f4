"""Whether each piece has a Source ID of its own: by it a model is imported again, and results are brought back."""

from collections.abc import Iterator

from assess.errors import Problem
from assess.i18n import fill
from assess.workbook.parse import Row, Tables
from assess.workbook.values import shorten


def check_source_ids(tables: Tables) -> Iterator[Problem]:
    """Warn of pieces that have the Source ID of another: of a row that was copied."""
    table = tables["Items"]
    first: dict[str, Row] = {}
    for row in table.with_all("source_id"):
        own = row.get("source_id").strip()
        other = first.setdefault(own, row)
        if other is not row:
            message = fill("{label} {id} is that of row {row}, too.", label=table.label("source_id"), id=shorten(own),
                           row=other.number)  # fmt: skip
            fix = fill("Clear it where the row was copied: which of the two is in the model is not known.")
            yield table.habit("source_id", row, message, fix, "warning")
