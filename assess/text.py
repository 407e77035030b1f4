"""Texts: made safe to show, sorted in natural order, and sentences that remember the parts they are made of.

Of unknown origin are names in records and archives, cells and names of files: control characters can command a
terminal, and marks that turn the direction of writing make a text show other than it reads (Unicode Standard Annex 9;
CVE-2021-42574).
"""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from typing import Any

_UNSEEN = "\u200e\u200f\u061c\u202a-\u202e\u2066-\u2069\u200b\u2060\ufeff"
"""Marks of direction and characters without width; those with a meaning in some script, U+200C and U+200D, stay."""
_NO_TEXT = "\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff" + "".join(
    chr(plane + last) for plane in range(0, 0x110000, 0x10000) for last in (0xFFFE, 0xFFFF)
)
"""Control characters but tabs and line feeds, halves of characters, and numbers that Unicode gives to no character."""

REPLACEMENT = "\ufffd"  # what stands in place of what is not text
UNCLEAN = re.compile(f"([{_UNSEEN}])|[{_NO_TEXT}]")
"""Finds what `plain_text` takes out; group 1 matches what leaves nothing in its place."""

_BREAKS = re.compile("[\t\n]+")
_NUMBER = re.compile(r"(\d+)")


def plain_text(text: str) -> str:
    """Return a text without control characters and unseen marks; tabs stay, line breaks become line feeds."""
    if text.isascii() and text.isprintable():
        return text
    return UNCLEAN.sub(lambda found: "" if found[1] else REPLACEMENT, with_line_feeds(text))


def with_line_feeds(text: str) -> str:
    """Return a text in which every line break is a line feed, whichever system it comes from."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


def split_text(text: str) -> list[str]:
    """Return the lines of a text; `str.splitlines` also splits at characters that may stand inside a name."""
    return with_line_feeds(text).split("\n")


def plain_line(text: str) -> str:
    """Return a text likewise, on one line."""
    return _BREAKS.sub(" ", plain_text(text))


def natural_key(name: str) -> tuple[tuple[tuple[int, str], ...], str]:
    """Return what names are sorted by: a whole number within a name counts by its value, capitals do not count.

    Of equal numbers the one with fewer digits comes first: 25-7 before 25-07. No order depends on that of the input.
    """
    plain = unicodedata.normalize("NFKC", name).casefold().strip()
    parts = _NUMBER.split(plain)
    values = [(len(one.lstrip("0")), one.lstrip("0")) if at % 2 else (0, one) for at, one in enumerate(parts)]
    return tuple(values), f"{len(plain):09}{plain}{name}"


class Text(str):
    """An English sentence made of parts: a `template`, with others for more than one where it counts, and `values`."""

    template: str
    many: str
    values: Mapping[str, Any]


def fill(template: str, /, **values: Any) -> Text:
    """Return a sentence with `values` put into its template, plain whatever they hold, with what translates it."""
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
