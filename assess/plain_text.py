"""Text of unknown origin made safe to show: names in records and archives, cells, names of files; and its lines.

Control characters can command a terminal, and marks that turn the direction of writing make a text show other than
it reads (Unicode Standard Annex 9; CVE-2021-42574).
"""

import re

_UNSEEN = "\u200e\u200f\u061c\u202a-\u202e\u2066-\u2069\u200b\u2060\ufeff"
"""Marks of direction and characters without width; those with a meaning in some script, U+200C and U+200D, stay."""
_NO_TEXT = "\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff" + "".join(
    chr(plane + last) for plane in range(0, 0x110000, 0x10000) for last in (0xFFFE, 0xFFFF)
)
"""Control characters but tabs and line feeds, halves of characters, and numbers that Unicode gives to no character."""

REPLACEMENT = "\ufffd"
"""What stands in place of what is not text."""
UNCLEAN = re.compile(f"([{_UNSEEN}])|[{_NO_TEXT}]")
"""Finds what `plain_text` takes out; group 1 matches what leaves nothing in its place."""

_BREAKS = re.compile("[\t\n]+")


def plain_text(text: str) -> str:
    """Return a text without what is not text: control characters are replaced, unseen marks left out.

    Tabs and line breaks stay; a line break of any system becomes a line feed.
    """
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
