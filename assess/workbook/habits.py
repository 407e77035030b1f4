"""How people type: what is remarked on a cell that was understood, and one message for the cells of one habit."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Any

from assess.errors import Gap, Problem, Severity
from assess.i18n import Text, fill, join, nfill
from assess.text import UNCLEAN, plain_text

SHOWN = 60
"""Characters of a value that its message quotes."""
_ESCAPE = re.compile(r"_x(00[01][0-9A-Fa-f])_")  # how a workbook writes control characters
SHOWN_CELLS = 3
"""Cells of a group that its message names."""
_BLANK = dict.fromkeys(("column", "text", "value", "cells"), "")
_HABITS: Mapping[str, tuple[Text, Text]] = {
    "unit": (nfill("{column}: {text} holds its unit; it is read as {value}.",
        "{column}: {n:,} cells hold their unit, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The unit is in the header.")),
    "percent": (nfill("{column}: {text} is a percentage; it is read as {value}.",
        "{column}: {n:,} cells hold a percentage, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The percentage is converted to the unit of the column.")),
    "comma": (nfill("{column}: {text} has a decimal comma; it is read as {value}.",
        "{column}: {n:,} cells have a decimal comma, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The decimal comma was typed into a text.")),
    "thousands": (nfill("{column}: {text} has separators between thousands; it is read as {value}.",
        "{column}: {n:,} cells have separators between thousands, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The separators between thousands were typed into a text.")),
    "signs": (nfill("{column}: {text} has look-alike signs or digits; it is read as {value}.",
        "{column}: {n:,} cells have look-alike signs or digits, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("A dash or a digit only looks like the plain one.")),
    "text": (nfill("{column}: {text} is a number stored as text; it is read as {value}.",
        "{column}: {n:,} cells hold a number stored as text, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The number was stored as text.")),
    "choice": (nfill("{column}: {text} is read as {value}.",
        "{column}: {n:,} cells hold a short form, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The choice is written out.")),
    "spaces": (nfill("{column}: {text} has stray spaces; it is read as {value}.",
        "{column}: {n:,} cells have stray spaces, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The stray spaces are taken out.")),
    "date": (nfill("{column}: {text} is read as the date {value}.",
        "{column}: {n:,} cells hold a date, such as {text}, which is read as {value} ({cells}).",
        1, **_BLANK), fill("The date is written as year-month-day.")),
}  # fmt: skip
"""By habit: what is said of one cell and of many, and what a correction says was done."""


def shorten(value: object) -> str:
    """Return a value as it may be quoted in a message: clean, in quotes, at most 60 characters."""
    text = clean(str(value))[0]
    return f"'{text[:SHOWN]}…'" if len(text) > SHOWN else f"'{text}'"


def clean(text: str) -> tuple[str, int]:
    """Take out of a text what is not text, and count it.

    Control characters become the replacement character; unseen marks, such as those that turn the direction of
    writing, are left out, since they make a text show other than it reads. Line breaks and tabs stay.
    """
    if text.isascii() and text.isprintable() and "_x0" not in text:
        return text, 0
    text = _ESCAPE.sub(lambda match: chr(int(match[1], 16)), text).replace("\r\n", "\n").replace("\r", "\n")
    return plain_text(text), len(UNCLEAN.findall(text))


class CellError(Exception):
    """A cell does not hold what its column needs; the text names the value, the rule and the likely slip."""

    def __init__(self, message: Text, fix: Text | str = "") -> None:
        super().__init__(message)
        self.message, self.fix = message, fix


@dataclass(frozen=True, slots=True)
class Remark:
    """What is remarkable about a cell that can be read.

    A note where it was merely typed otherwise than asked for, by a `habit`, "" for none; `value` then belongs into the
    cell instead, as `why` says.
    """

    message: Text
    fix: Text | str = ""
    severity: Severity = "warning"
    habit: str = ""
    value: float | str | None = None
    why: Text | str = ""


def note(habit: str, column: Text | str, text: str, value: object, corrected: float | str) -> Remark:
    """Return the note on a cell, `text`, of a column, that is read as `value` and should be `corrected`."""
    known, why = _HABITS[habit]
    message = nfill(known.template, known.many, 1, **{**_BLANK, "column": column, "text": text, "value": value})
    return Remark(message, "", "note", habit, corrected, why)


def group_problems(problems: Iterable[Problem]) -> list[Problem]:
    """Return problems as they are shown: those of one kind, in one column of a sheet, as one.

    It stands where the first of them stood and names that cell; its message counts the cells and names the first
    three. Problems without a `group`, and those that name different things, stay apart.
    """
    return [merged for merged, _ in list_groups(problems)]


def list_groups(problems: Iterable[Problem]) -> list[tuple[Problem, list[Problem]]]:
    """Return problems as `group_problems` does, each with those that it stands for."""
    grouped: dict[tuple[object, ...], list[Problem]] = {}
    for at, problem in enumerate(problems):
        kind: tuple[object, ...] = (at,)
        if problem.group:
            values = problem.message.values if isinstance(problem.message, Text) else {}
            texts = (problem.message, problem.fix, *(one for one in values.values() if isinstance(one, Text)))
            templates = (one.template if isinstance(one, Text) else one for one in texts)
            column = re.sub(r"\d+", "", problem.cell)
            kind = (problem.severity, problem.sheet, column, problem.group, *templates, values.get("name"))
        grouped.setdefault(kind, []).append(problem)
    return [(_merge(alike) if len(alike) > 1 else alike[0], alike) for alike in grouped.values()]


def _merge(alike: Sequence[Problem]) -> Problem:
    quoted = []  # what the cells that are named hold, where it differs
    for one in alike[:SHOWN_CELLS]:
        values: Mapping[str, Any] = one.message.values if isinstance(one.message, Text) else {}
        quoted.append(str(values.get("text", values.get("typed", ""))))
    if len(set(quoted)) == 1 or not all(quoted):
        quoted = []
    shown = (f"{one.cell} {text}" if text else one.cell for one, text in zip_longest(alike, quoted))
    cells, message = name_some([*shown], SHOWN_CELLS), alike[0].message
    if isinstance(message, Text) and "cells" in message.values:
        values = {name: value for name, value in message.values.items() if name != "n"}
        merged = nfill(message.template, message.many, len(alike), **values | {"cells": cells})
    else:
        merged = fill("{message} The same in {n:,} cells ({cells}).", message=message, n=len(alike), cells=cells)
    return replace(alike[0], message=merged)


def name_some(names: Sequence[Text | str], most: int) -> Text:
    """Return the first of some names, with dots where there are more."""
    return join(", ", [*names[:most], *["..."] * (len(names) > most)])


def count_kinds(problems: Sequence[Problem], severity: Severity = "error") -> tuple[int, int]:
    """Return how many kinds of problems of a severity there are, and how many problems."""
    found = [one for one in problems if one.severity == severity]
    return len(group_problems(found)), len(found)


BETTER = (
    fill(
        "Hazard map: the geological survey or the building authority of your country publishes one. Look up the peak "
        "ground acceleration (PGA) at the address, mostly that with a return period of 475 years, and type it into "
        "Ground PGA in Building."
    ),
    fill(
        "ShakeMap of a past earthquake: the USGS (earthquake.usgs.gov) and many national services publish maps of "
        "how strongly the ground shook. Put its grid.xml beside the workbook and name it in ShakeMap file in "
        "Building, with Latitude and Longitude; or read the PGA at the address, often in % of g (25 % of g is 0.25 g), "
        "and type it into Ground PGA."
    ),
    fill(
        "Records: where instruments in the building or near it recorded an earthquake, ask those who run them for the "
        "files, put these beside the workbook and name them in Record X and Record Y in Floors."
    ),
)
"""The three ways to know how the ground shakes better than by an assumed intensity."""
ASSUME = fill(
    "If you know none of these: choose how strongly the ground shakes in Shaking in Building, such as 'MMI VII, very "
    "strong', and fill in the Elevation of every floor, or, where floors are called by their number, Height and "
    "Storeys in Building. The reports then say that the shaking is assumed."
)
LIST = fill(
    "Furniture: in Items, write one row for each piece. Give it a name, its floor, and a Type of the Catalogue, or its "
    "Breadth and Height."
)


def list_ways(problems: Sequence[Problem]) -> tuple[Text, ...]:
    """Return the ways to complete a workbook, from its problems: shaking, furniture, or none."""
    gaps = [one for one in problems if isinstance(one, Gap)]
    shaking = (*BETTER, ASSUME) if any(one.lacks == "shaking" for one in gaps) else ()
    return (*shaking, *((LIST,) if any(one.lacks == "furniture" for one in gaps) else ()))
