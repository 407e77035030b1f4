"""The tables of a portfolio as Parquet, written and read by DuckDB, with the columns of `table_schemas` alone.

DuckDB writes Parquet itself: it takes 69 MB where pyarrow takes 171 MB. Files hold up to `ROWS` rows each, so that a
million rows need no more memory than these; the same rows give the same bytes.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.environment import say_install
from assess.errors import InputError, OutputError
from assess.portfolio.building_task import Part
from assess.portfolio.table_schemas import TABLES
from assess.table import Kind

if TYPE_CHECKING:
    import duckdb
    import pandas as pd

ROWS = 100_000  # rows of one file at most
SQL_TYPES: dict[Kind, str] = {"text": "VARCHAR", "number": "DOUBLE", "count": "BIGINT", "flag": "BOOLEAN"}
FRAME_TYPES: dict[Kind, str] = {"text": "object", "number": "float64", "count": "Int64", "flag": "boolean"}
"""Types of pandas: what is not known is None, NaN, NA and NA."""


def check_tables() -> Any:
    """Return the package that writes the tables; InputError if it is not installed."""
    try:
        import duckdb
    except ImportError:
        raise InputError.about(
            "the format parquet needs duckdb, which is not installed. {how}", how=say_install("parquet")
        ) from None
    return duckdb


def build_frame(name: str, rows: Sequence[Sequence[Any]]) -> "pd.DataFrame":
    """Return rows of a table as a frame with the types of its columns."""
    import pandas as pd

    columns = TABLES[name]
    values = [list(own) for own in zip(*rows, strict=True)] if rows else [[] for _ in columns]
    for at, column in enumerate(columns):
        if column.kind == "text":
            known: dict[Any, Any] = {}
            values[at] = [known.setdefault(value, value) for value in values[at]]  # one text for many rows
    return pd.DataFrame(
        {one.key: pd.Series(own, dtype=FRAME_TYPES[one.kind]) for one, own in zip(columns, values, strict=True)}
    )


def write_tables(parts: Iterable[Part], folder: Path | None) -> "dict[str, pd.DataFrame]":
    """Write all tables from parts in their order, each read once; return them as frames.

    A table is written block by block, as ``NAME.parquet``, or as ``NAME-0001.parquet`` and so on with several blocks;
    no files without a folder. Raises InputError if DuckDB is needed and not installed; OutputError if a file cannot be
    written.
    """
    import pandas as pd

    rows: dict[str, list[Sequence[Any]]] = {name: [] for name in TABLES}
    frames: dict[str, list[pd.DataFrame]] = {name: [] for name in TABLES}

    def find_path(name: str, number: int) -> Path:
        return Path(folder or "", f"{name}-{number:04}.parquet")

    def flush(name: str) -> None:
        block, rows[name] = rows[name][:ROWS], rows[name][ROWS:]
        frames[name].append(build_frame(name, block))
        if folder is None:
            return
        path = find_path(name, len(frames[name]))
        columns = ", ".join(f'"{one.key}"::{SQL_TYPES[one.kind]} AS "{one.key}"' for one in TABLES[name])
        duckdb = check_tables()
        try:
            with _connect(duckdb) as connection:
                connection.register("found", frames[name][-1])
                connection.execute(
                    f"COPY (SELECT {columns} FROM found) TO {_quote(path)} "  # noqa: S608 - names of our own
                    f"(FORMAT parquet, COMPRESSION zstd, ROW_GROUP_SIZE {ROWS})"
                )
        except duckdb.Error as error:
            why = str(error).splitlines()[0]
            raise OutputError.about("{path} could not be written: {why}", path=path.name, why=why) from None

    for part in parts:
        for name in TABLES:
            rows[name] += part.rows(name)
            while len(rows[name]) >= ROWS:
                flush(name)
    for name in TABLES:
        if rows[name] or not frames[name]:
            flush(name)
        if folder is not None and len(frames[name]) == 1:
            find_path(name, 1).rename(folder / f"{name}.parquet")
    return {name: own[0] if len(own) == 1 else pd.concat(own, ignore_index=True) for name, own in frames.items()}


def _connect(duckdb: Any) -> "duckdb.DuckDBPyConnection":
    """Return a connection that gives the same bytes whenever it writes the same rows, and loads nothing."""
    connection = duckdb.connect(config={"threads": 1, "autoinstall_known_extensions": False})
    connection.execute("SET preserve_insertion_order = true")
    return connection  # type: ignore[no-any-return]


def _quote(path: Path) -> str:
    return "'" + str(path).replace("'", "''") + "'"


def find_files(folder: Path, name: str) -> list[Path]:
    """Return the files of a table in their order."""
    whole = folder / f"{name}.parquet"
    return [whole] if whole.is_file() else sorted(folder.glob(f"{name}-[0-9][0-9][0-9][0-9].parquet"))


def read_table(folder: str | Path, name: str) -> "pd.DataFrame":
    """Return a table, one of `TABLES`, from the folder of results; InputError if that or DuckDB cannot be used."""
    if name not in TABLES:
        raise InputError.about(
            "{name!r} is an unknown table; expected one of: {names}", name=name, names=", ".join(TABLES)
        )
    duckdb, files = check_tables(), find_files(Path(folder), name)
    if not files:
        raise InputError.about("{folder}: there is no {name}.parquet.", folder=folder, name=name)
    listed = ", ".join(map(_quote, files))
    try:
        with _connect(duckdb) as connection:
            names = ", ".join(f'"{one.key}"' for one in TABLES[name])
            frame = connection.execute(f"SELECT {names} FROM read_parquet([{listed}])").df()  # noqa: S608
    except duckdb.Error as error:
        why = str(error).splitlines()[0]
        raise InputError.about(
            "{folder}: {name}.parquet cannot be read: {why}", folder=folder, name=name, why=why
        ) from None
    frame = frame.astype({one.key: FRAME_TYPES[one.kind] for one in TABLES[name]})
    for one in TABLES[name]:
        if one.kind == "text":
            frame[one.key] = frame[one.key].where(frame[one.key].notna(), None)
    return frame
