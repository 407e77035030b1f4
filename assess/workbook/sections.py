"""Rows that are no entries, headings between them and hidden ones, and what is said of these."""

import re
from collections.abc import Collection, Iterator, Sequence

from assess.i18n import Text, fill, join, nfill
from assess.workbook.open import Cells
from assess.workbook.values import ERRORS, is_blank, shorten

FIRST_COLUMNS = 4
"""A heading stands in one of so many columns from the left."""

_MOST_RANGES = 10
_RANGE = re.compile(r"([A-Z]{1,3})(\d+):([A-Z]{1,3})(\d+)")


def find_lone_text(cells: Cells, known: Collection[int], first: Collection[int]) -> int | None:
    """Return the column of the only filled cell of a row, if it is one of the `first` and holds words; else None.

    Cells of columns that are not `known` do not count.
    """
    filled = None
    for at, value in cells.items():
        if at in known and not is_blank(value):
            if filled is not None:
                return None
            filled = at
    value = cells.get(filled) if filled in first and filled is not None else None
    is_text = isinstance(value, str) and value.strip() not in ERRORS and any(map(str.isalpha, value))
    return filled if is_text else None


def list_spanned(merged: Sequence[str]) -> set[int]:
    """Return the rows in which cells of several columns are merged, and of that row alone."""
    found = (match for one in merged if (match := _RANGE.fullmatch(one)))
    return {int(match[2]) for match in found if match[1] != match[3] and match[2] == match[4]}


def describe_heading(value: object) -> Text:
    """Say that a row is taken for a heading."""
    return nfill(
        "{text} stands alone in its row; it is taken for a heading and skipped.",
        "{n:,} rows hold a text alone, such as {text}; they are taken for headings and skipped ({cells}).",
        1, text=shorten(value), cells="",
    )  # fmt: skip


def describe_repeated() -> Text:
    """Say that a row repeats the headers."""
    return nfill(
        "the row repeats the headers; it is skipped.", "{n:,} rows repeat the headers; they are skipped ({cells}).",
        1, cells="",
    )  # fmt: skip


def describe_hidden_rows(numbers: Sequence[int], *, is_furniture: bool) -> Text:
    """Say which hidden rows are read.

    `numbers`: of the rows, in their order.
    `is_furniture`: whether they are rows of furniture, which are assessed.
    """
    rows = list_ranges(numbers)
    if is_furniture:
        return nfill(
            "hidden row {rows} is assessed as well.", "{n:,} hidden rows are assessed as well: {rows}.",
            len(numbers), rows=rows,
        )  # fmt: skip
    return nfill(
        "hidden row {rows} is read as well.", "{n:,} hidden rows are read as well: {rows}.", len(numbers), rows=rows
    )


def describe_hidden_columns(labels: Sequence[str]) -> Text:
    """Say which hidden columns are read."""
    listed = join(", ", map(fill, labels))
    return nfill(
        "the hidden column {labels} is read as well.", "{n:,} hidden columns are read as well: {labels}.",
        len(labels), labels=listed,
    )  # fmt: skip


def list_ranges(numbers: Sequence[int]) -> Text:
    """Return numbers in words, those that follow one another as a range: "12, 15 to 16"."""
    parts = [
        str(first) if first == last else fill("{first} to {last}", first=str(first), last=str(last))
        for first, last in _find_runs(numbers)
    ]
    return join(", ", [*parts[:_MOST_RANGES], *["..."] * (len(parts) > _MOST_RANGES)])


def _find_runs(numbers: Sequence[int]) -> Iterator[tuple[int, int]]:
    first = last = None
    for number in numbers:
        if last is not None and first is not None and number != last + 1:
            yield first, last
            first = None
        first, last = number if first is None else first, number
    if first is not None and last is not None:
        yield first, last
