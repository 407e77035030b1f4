"""An English sentence that remembers the parts it is made of, so that a report can say it in another language."""

from collections.abc import Iterable, Mapping
from typing import Any

from assess.plain_text import plain_text


class Text(str):
    """An English sentence made of parts: a `template`, with others for more than one where it counts, and `values`."""

    template: str
    many: str
    values: Mapping[str, Any]


def fill(template: str, /, **values: Any) -> Text:
    """Return a sentence with `values` put into its template: a text now, and what a report needs to translate it.

    Whatever the values hold, the sentence has no control characters and no marks of direction.
    """
    return _fill(template, "", values, values.get("n"))


def nfill(one: str, many: str, n: int, /, **values: Any) -> Text:
    """Return the sentence for one or for many, with ``{n}`` and `values` put in."""
    return _fill(one, many, {"n": n, **values}, n)


def count(number: int, noun: str) -> str:
    """Return a number with its English noun, whose plural takes an s: "1 error", "2,000 errors"; never translated."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def join(mark: str, parts: Iterable[object]) -> Text:
    """Return `parts` with a `mark` between them; those that are a `Text` are translated when it is."""
    values = {f"part_{at}": part for at, part in enumerate(parts)}
    return _fill(mark.join(f"{{{name}}}" for name in values), "", values, None)


def _fill(template: str, many: str, values: Mapping[str, Any], n: int | None) -> Text:
    text = Text(plain_text((many if many and n != 1 else template).format(**values)))
    text.template, text.many, text.values = template, many, values
    return text
