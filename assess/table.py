"""Tables: the fields of a row, each said once, and the rows as columns of their values.

A `Field` says where a value stands in a row and what it is called. Records of results.json, lines of items.csv and
pandas tables are made of columns, a thousand rows at a time; a row is made only where somebody asks for one.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any, Literal

from assess.i18n import gettext as _

if TYPE_CHECKING:
    import pandas as pd

Kind = Literal[
    "text", "number", "count", "share", "flag", "class", "list", "signs", "factors", "counts", "records",
]  # fmt: skip
"""What a field holds: a share lies in [0, 1]; a class is one of `RiskClass`; signs are a list of 1 and -1; counts are
numbers by name; records are rows within the row."""
Where = Literal["json", "csv", "excel", "pieces", "risky", "methods"]
"""The last three are lists of the pages (HTML, PDF and its lines): all pieces, those at high risk, every method."""
DATA: frozenset[Where] = frozenset(("json", "csv"))
"""Of fields that the sheet Items of the Excel report leaves out, or shows in live columns of its own."""
FILES: frozenset[Where] = DATA | {"excel"}
EVERYWHERE: frozenset[Where] = FILES | {"pieces"}

_NUMBERS = frozenset(("number", "count", "share", "flag"))
_PLAIN: Mapping[str, Callable[[Any], Any]] = {
    "class": attrgetter("word"), "list": list, "signs": list, "factors": list, "counts": dict,
}  # fmt: skip
"""From what a row holds to what results.json does, by kind."""
_GROUPS = frozenset(("verification", "ensemble", "sliding", "annual", "anchor"))
"""Groups of fields that are null together, as are those within them, where nothing in them is known."""
_DTYPES: Mapping[Kind, str] = {
    "text": "string", "class": "string", "number": "float64", "share": "float64", "count": "Int64", "flag": "boolean",
}  # fmt: skip
"""Of the columns of a pandas table: the same whatever the rows are, also where there are none."""
PART = 1000  # rows whose columns and texts are made at a time
_dump = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(", ", ": ")).encode


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One field of a row.

    * `key`: Its column in items.csv and in the tables of a notebook, with the unit.
    * `source`: Attributes that lead from the row to its value, ``governing.motion.pfa_g``; by default the key. What is
      behind a None is None; an entry of a mapping is named like an attribute, one of a tuple by its number.
    * `path`: Its place in a record of results.json; by default ``(key,)``.
    * `label`, `short`: Heading in reports without the unit, and a shorter one for the lists of pages.
    * `format`, `width`: How Excel shows it, and the width of its column there, in characters.
    * `is_optional`: Whether it may be None; a field of a group, whether it may be where the group is there.
    * `is_blank_unknown`: Whether "" stands for what is unknown.
    * `records`, `line`: The fields of the rows within the row, of kind "records", and what items.csv says of each: a
      text with their keys in braces.
    * `flat`: From its value to the one of items.csv, where that differs.
    """

    key: str
    source: str = ""
    path: tuple[str, ...] = ()
    label: str = ""
    short: str = ""
    unit: str = ""
    format: str = ""
    width: int = 9
    kind: Kind = "text"
    is_optional: bool = False
    choices: tuple[str, ...] = ()
    is_blank_unknown: bool = False
    shows: frozenset[Where] = FILES
    help: str = ""
    records: "tuple[Field, ...]" = ()
    line: str = ""
    flat: Callable[[Any], Any] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "source", self.source or self.key)

    @property
    def place(self) -> tuple[str, ...]:
        """Its place in a record of results.json."""
        return self.path or (self.key,)

    def heading(self) -> str:
        """Return its label with the unit in brackets, in the language in use."""
        return _head(self.label, self.unit)

    def short_heading(self) -> str:
        """Return its heading in the lists of pages, in the language in use."""
        return _head(self.short or self.label, self.unit)

    def read(self, row: Any) -> Any:
        """Return the value of a row, as results.json has it: None for what is unknown."""
        for name in self.source.split("."):
            row = None if row is None else _step(row, name)(row)
        return self.plain(row)

    def plain(self, value: Any) -> Any:
        """Return what a row holds as results.json does: the word of a class, a list of a tuple."""
        if value is None or (self.is_blank_unknown and value == ""):
            return None
        if self.kind == "records":
            return list(Table.of(self.records, value).records())
        return _PLAIN[self.kind](value) if self.kind in _PLAIN else value

    def flatten(self, value: Any) -> Any:
        """Return a value of results.json as items.csv and a table have it."""
        if self.line:
            return [self.line.format_map(one) for one in value]
        return value if self.flat is None else self.flat(value)


def _head(label: str, unit: str) -> str:
    return f"{_(label)} [{unit}]" if unit else _(label)


def _step(row: Any, name: str) -> Callable[[Any], Any]:
    if isinstance(row, dict):
        return lambda one: one.get(name)
    return itemgetter(int(name)) if name.isdecimal() else attrgetter(name)


def unnest(record: Mapping[str, Any], chosen: Iterable[Field]) -> dict[str, Any]:
    """Return a row of a table from a record of results.json: that of the row which the record was made from."""
    row = {}
    for field in chosen:
        value: Any = record
        for name in field.place:
            value = value.get(name) if isinstance(value, Mapping) else None
        row[field.key] = field.flatten(value)
    return row


class Columns:
    """Rows that follow each other, as columns: each is made when it is asked for, and kept."""

    def __init__(self, rows: Sequence[Any]) -> None:
        self._rows = rows
        self._made: dict[str, list[Any]] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def column(self, source: str) -> list[Any]:
        """Return what stands at the end of attributes (`Field.source`), a value a row."""
        found = self._made.get(source)
        if found is None:
            found = self._made[source] = self._make(source)
        return found

    def inner(self, source: str) -> "tuple[Columns, Sequence[int]]":
        """Return the rows within the rows, and how many there are in each."""
        lists = self.column(source)
        return Columns([row for rows in lists for row in rows]), [len(rows) for rows in lists]

    def _make(self, source: str) -> list[Any]:
        parent, _dot, name = source.rpartition(".")
        rows = self.column(parent) if parent else self._rows
        step = next((_step(row, name) for row in rows if row is not None), None)
        return [None] * len(rows) if step is None else [None if row is None else step(row) for row in rows]


Tree = Mapping[str, "Field | Tree"]


class Table:
    """Rows of the same fields, in `parts` so that many take little memory; values are those of `Field.read`."""

    def __init__(self, fields: Iterable[Field], parts: Callable[[], Iterable[Columns]]) -> None:
        self.fields = tuple(fields)
        self.parts = parts

    @classmethod
    def of(cls, fields: Iterable[Field], rows: Sequence[Any]) -> "Table":
        """Return the table of rows that are there as objects."""
        return cls(fields, lambda: (Columns(rows[at : at + PART]) for at in range(0, max(1, len(rows)), PART)))

    def __len__(self) -> int:
        return sum(map(len, self.parts()))

    @property
    def columns(self) -> dict[str, list[Any]]:
        """The values of every column by key, as items.csv has them."""
        parts = [self.flat_columns(part) for part in self.parts()]
        return {one.key: [value for part in parts for value in part[at]] for at, one in enumerate(self.fields)}

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield each row by key, as items.csv has it."""
        keys = [one.key for one in self.fields]
        for part in self.parts():
            yield from (dict(zip(keys, row, strict=True)) for row in zip(*self.flat_columns(part), strict=True))

    def json_parts(self) -> Iterator[list[str]]:
        """Yield the rows of one part after the other, each row as the text of its record of results.json."""
        tree = build_tree(self.fields)
        return (_spell(tree, part) for part in self.parts())

    def records(self) -> Iterator[dict[str, Any]]:
        """Yield each row as a record of results.json."""
        return (json.loads(text) for part in self.json_parts() for text in part)

    def flat_columns(self, part: Columns, change: Callable[[Any], Any] = lambda value: value) -> list[list[Any]]:
        """Return the values of some rows, column by column, as items.csv has them; `change` is made to texts, lists."""
        return [_flatten_column(one, part, change) for one in self.fields]

    def to_frame(self) -> "pd.DataFrame":
        """Return the table for a notebook: its types are those of the fields."""
        import pandas as pd

        types = {one.key: _DTYPES.get(one.kind, "object") for one in self.fields}
        return pd.DataFrame({key: pd.Series(values, dtype=types[key]) for key, values in self.columns.items()})


def build_tree(fields: Iterable[Field]) -> Tree:
    """Return the fields by their places in a record, groups within groups."""
    tree: dict[str, Any] = {}
    for one in fields:
        inner = tree
        for name in one.place[:-1]:
            inner = inner.setdefault(name, {})
        inner[one.place[-1]] = one
    return tree


def _spell(tree: Tree, part: Columns, *, is_null: bool = False) -> list[str]:
    pattern, columns = _find_pattern(tree, part, is_null=is_null)
    texts = [pattern % row for row in zip(*columns, strict=True)]
    if not is_null:
        return texts
    blank = pattern % (("null",) * len(columns))
    return ["null" if text == blank else text for text in texts]


def _find_pattern(tree: Tree, part: Columns, *, is_null: bool) -> tuple[str, list[list[str]]]:
    entries, columns = [], []
    for name, one in tree.items():
        gap = "%s"
        if isinstance(one, Field):
            columns.append(_spell_column(one, part))
        elif is_null or name in _GROUPS:
            columns.append(_spell(one, part, is_null=True))
        else:
            gap, inner = _find_pattern(one, part, is_null=False)
            columns += inner
        entries.append(f"{_dump(name).replace('%', '%%')}: {gap}")
    return f"{{{', '.join(entries)}}}", columns


def _spell_column(field: Field, part: Columns) -> list[str]:
    """Return the values of a field as results.json spells them; the same text or list is spelt once."""
    if field.kind == "records":
        inner, counts = part.inner(field.source)
        texts = iter(_spell(build_tree(field.records), inner))
        return [f"[{', '.join(islice(texts, count))}]" for count in counts]
    values = part.column(field.source)
    if field.kind in _NUMBERS:
        if values.count(None) == len(values):  # often: nothing was simulated, or is placed
            return ["null"] * len(values)
        return _dump(values)[1:-1].split(", ")
    spelt = {value: _dump(field.plain(value)) for value in set(values)}
    return [spelt[value] for value in values]


def _flatten_column(field: Field, part: Columns, change: Callable[[Any], Any]) -> list[Any]:
    if field.kind == "records" and not field.line:
        return [change(json.loads(text)) for text in _spell_column(field, part)]
    if field.kind == "records":
        inner, counts = part.inner(field.source)
        chosen = [one for one in field.records if f"{{{one.key}}}" in field.line]
        rows = zip(*(_flatten_column(one, inner, lambda value: value) for one in chosen), strict=True)
        keys = [one.key for one in chosen]
        lines = (field.line.format_map(dict(zip(keys, row, strict=True))) for row in rows)
        return [change(list(islice(lines, count))) for count in counts]
    values = part.column(field.source)
    if field.kind in _NUMBERS and field.flat is None:
        return values
    flat = {value: change(field.flatten(field.plain(value))) for value in set(values)}
    return [flat[value] for value in values]
