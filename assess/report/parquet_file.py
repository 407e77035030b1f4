"""items.parquet: the rows and columns of items.csv, typed, written by DuckDB.

The types come from the fields, never from the values, so that the files of many buildings can be read as one table.
"""

from pathlib import Path
from typing import Any

from assess.progress import SILENT, Progress
from assess.results import Results
from assess.table import Kind

_SQL_TYPES: dict[Kind, str] = {"number": "DOUBLE", "share": "DOUBLE", "count": "BIGINT", "flag": "BOOLEAN"}
"""Of the columns by what a field holds; all others are VARCHAR, lists joined by "; " as in items.csv."""


def write_parquet(results: Results, path: Path, progress: Progress = SILENT) -> None:
    """Write items.parquet: one row an item; what is not known is NULL. The same results give the same bytes.

    Raises
    ------
    InputError
        If DuckDB is not installed.
    OSError
        If the file cannot be written.
    CancelledError
        If the work was cancelled.
    """
    progress.wait_for(lambda: _write(results, path))


def _write(results: Results, path: Path) -> None:
    import duckdb

    table = results.table("items")
    types, frame = {one.key: _SQL_TYPES.get(one.kind, "VARCHAR") for one in table.fields}, table.to_frame()
    for key in (key for key, sql in types.items() if sql == "VARCHAR"):
        frame[key] = frame[key].astype("object").map(_to_text)
    names = {key: '"' + key.replace('"', '""') + '"' for key in types}
    columns = ", ".join(f"{names[key]}::{sql} AS {names[key]}" for key, sql in types.items())
    target = str(path).replace("'", "''")
    try:
        with duckdb.connect(config={"threads": 1, "autoinstall_known_extensions": False}) as connection:
            connection.register("found", frame)
            connection.execute(
                f"COPY (SELECT {columns} FROM found) TO '{target}' (FORMAT parquet, COMPRESSION zstd)"  # noqa: S608
            )
    except duckdb.Error as error:
        raise OSError(str(error).splitlines()[0]) from None


def _to_text(value: Any) -> str | None:
    if isinstance(value, list):
        return "; ".join(map(str, value))
    return value if isinstance(value, str) else None
