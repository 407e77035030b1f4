"""The tables of a portfolio as Parquet, written and read by DuckDB, with the columns of `table_schemas` alone.

DuckDB writes Parquet itself: it takes 69 MB where pyarrow takes 171 MB. Files hold up to `ROWS` rows each, so that a
million rows need no more memory than these; the same rows give the same bytes.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.errors import InputError, OutputError
from assess.extras import say_install
from assess.i18n import fill
from assess.portfolio.part_files import Part
from assess.portfolio.table_schemas import TABLES, TableColumn, Type

if TYPE_CHECKING:
    import duckdb
    import pandas as pd

ROWS = 100_000
"""Rows of one file at most."""
SQL_TYPES: dict[Type, str] = {"text": "VARCHAR", "number": "DOUBLE", "count": "BIGINT", "flag": "BOOLEAN"}
FRAME_TYPES: dict[Type, str] = {"text": "object", "number": "float64", "count": "Int64", "flag": "boolean"}
"""Types of pandas: what is not known is None, NaN, NA and NA."""


def check_tables() -> None:
    """Raise InputError unless the tables can be written."""
    _import()


def _import() -> Any:
    try:
        import duckdb
    except ImportError:
        raise InputError(
            fill("the format parquet needs duckdb, which is not installed. {how}", how=say_install("parquet"))
        ) from None
    return duckdb


# ---------------------------------------------------------------- rows to frames


def build_frame(name: str, rows: Sequence[Sequence[Any]]) -> "pd.DataFrame":
    """Return rows of a table as a frame with the types of its columns."""
    import pandas as pd

    columns = TABLES[name]
    values = zip(*rows, strict=True) if rows else ([] for _ in columns)
    return pd.DataFrame(
        {column.name: _to_series(column, list(own)) for column, own in zip(columns, values, strict=True)}
    )


def _to_series(column: TableColumn, values: list[Any]) -> "pd.Series[Any]":
    import pandas as pd

    if column.type == "text":
        known: dict[Any, Any] = {}
        values = [known.setdefault(value, value) for value in values]  # one text for many rows: names repeat
    return pd.Series(values, dtype=FRAME_TYPES[column.type])


def _retype(frame: "pd.DataFrame", columns: Sequence[TableColumn]) -> "pd.DataFrame":
    """Return a frame with the types of the columns of a table, whatever it was read as."""
    found = frame.astype({one.name: FRAME_TYPES[one.type] for one in columns})
    for one in columns:
        if one.type == "text":
            found[one.name] = found[one.name].where(found[one.name].notna(), None)
    return found


# ---------------------------------------------------------------- Parquet


class TableWriter:
    """Writes a table block by block, as ``NAME.parquet``, or as ``NAME-0001.parquet`` and so on with several blocks.

    Parameters
    ----------
    name : str
        One of `TABLES`.
    folder : Path, optional
        Where to; None where no files are wanted.
    keeps : bool
        Whether the rows are kept, for `frame`.
    """

    def __init__(self, name: str, folder: Path | None, *, keeps: bool) -> None:
        self.name, self._folder, self._keeps = name, folder, keeps
        self._rows: list[Sequence[Any]] = []
        self._frames: list[pd.DataFrame] = []
        self._written: list[Path] = []

    def add(self, rows: Iterable[Sequence[Any]]) -> None:
        """Add rows; a block that is full is written."""
        self._rows.extend(rows)
        while len(self._rows) >= ROWS:
            block, self._rows = self._rows[:ROWS], self._rows[ROWS:]
            self._flush(block)

    def close(self) -> list[Path]:
        """Write what is left, and return the files.

        Raises
        ------
        InputError
            If DuckDB is not installed.
        OutputError
            If a file cannot be written.
        """
        if self._rows or not self._frames:
            self._flush(self._rows)
            self._rows = []
        if len(self._written) == 1:
            self._written = [self._written[0].rename(self._written[0].with_name(f"{self.name}.parquet"))]
        return self._written

    @property
    def frame(self) -> "pd.DataFrame":
        """All rows, with the types of their columns."""
        import pandas as pd

        return self._frames[0] if len(self._frames) == 1 else pd.concat(self._frames, ignore_index=True)

    def _flush(self, rows: Sequence[Sequence[Any]]) -> None:
        frame = build_frame(self.name, rows)
        if self._folder is not None:
            path = self._folder / f"{self.name}-{len(self._written) + 1:04}.parquet"
            _write_file(self.name, frame, path)
            self._written.append(path)
        self._frames.append(frame if self._keeps else frame.iloc[:0])


def write_tables(parts: Iterable[Part], folder: Path | None, *, keeps: bool = True) -> "dict[str, TableWriter]":
    """Write all tables from parts in their order, each read once, and return the writers by the names of tables.

    Raises
    ------
    InputError
        If files are wanted and DuckDB is not installed.
    OutputError
        If a file cannot be written.
    """
    writers = {name: TableWriter(name, folder, keeps=keeps) for name in TABLES}
    for part in parts:
        for name, writer in writers.items():
            writer.add(part.rows(name))
    for writer in writers.values():
        writer.close()
    return writers


def _write_file(name: str, frame: "pd.DataFrame", path: Path) -> None:
    duckdb = _import()
    columns = ", ".join(f'"{one.name}"::{SQL_TYPES[one.type]} AS "{one.name}"' for one in TABLES[name])
    try:
        with _connect(duckdb) as connection:
            connection.register("found", frame)
            connection.execute(
                f"COPY (SELECT {columns} FROM found) TO {_quote(path)} "  # noqa: S608 - names of our own
                f"(FORMAT parquet, COMPRESSION zstd, ROW_GROUP_SIZE {ROWS})"
            )
    except duckdb.Error as error:
        why = str(error).splitlines()[0]
        raise OutputError(fill("{path} could not be written: {why}", path=path.name, why=why)) from None


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
    """Return a table of a portfolio: "buildings", "pieces", "routes", "problems" or "draws".

    Parameters
    ----------
    folder : str or Path
        The folder of its results.
    name : str
        One of `TABLES`.

    Raises
    ------
    InputError
        If there is no such table, it cannot be read, or DuckDB is not installed.
    """
    if name not in TABLES:
        raise InputError(
            fill("{name!r} is an unknown table; expected one of: {names}", name=name, names=", ".join(TABLES))
        )
    duckdb, files = _import(), find_files(Path(folder), name)
    if not files:
        raise InputError(fill("{folder}: there is no {name}.parquet.", folder=folder, name=name))
    listed = ", ".join(map(_quote, files))
    try:
        with _connect(duckdb) as connection:
            names = ", ".join(f'"{one.name}"' for one in TABLES[name])
            frame = connection.execute(f"SELECT {names} FROM read_parquet([{listed}])").df()  # noqa: S608
    except duckdb.Error as error:
        why = str(error).splitlines()[0]
        raise InputError(
            fill("{folder}: {name}.parquet cannot be read: {why}", folder=folder, name=name, why=why)
        ) from None
    return _retype(frame, TABLES[name])
