"""How wide columns and how high rows must be for their headings and helps, so that none is cut.

Widths are in characters, as spreadsheet programs count them: the width of a digit in the font of the sheet.
"""

LINE = 15
"""Height of one line [points]."""

_BOLD = 1.15
"""Width of a bold letter, of the wider fonts that stand in where the workbook's is missing."""

_REGULAR = 0.95
"""Likewise of a letter that is not bold."""

_EDGE, _BUTTON = 1, 3
"""Left free at the edges, and for the button of a filter, which covers the end of the last line."""


def fit_width(heading: str, width: float) -> float:
    """Return the width at which no word of a heading is broken, at least `width`."""
    words = heading.split()
    return max(width, *(_BOLD * len(word) + _EDGE for word in words), _BOLD * len(words[-1]) + _EDGE + _BUTTON)


def count_heading_lines(heading: str, width: float) -> int:
    """Return the lines that a bold heading takes in a column of a filter, one for its button where that needs it."""
    room = (width - _EDGE) / _BOLD
    lines, used = _wrap(heading, room)
    return lines + (used > room - _BUTTON / _BOLD)


def count_text_lines(text: str, width: float) -> int:
    """Return the lines that a text which is not bold takes in a column."""
    return _wrap(text, (width - _EDGE) / _REGULAR)[0]


def _wrap(text: str, room: float) -> tuple[int, int]:
    """Return the lines of a text that is broken at its spaces, and the letters in the last."""
    lines, used = 1, 0
    for word in text.split():
        needed = used + bool(used) + len(word)
        lines, used = (lines, needed) if needed <= room or not used else (lines + 1, len(word))
    return lines, used
