"""QR codes of stickers: what one reads with a phone that stands before a piece."""

from collections.abc import Iterable

from markupsafe import escape

from assess.errors import Problem, WorkbookError
from assess.i18n import fill
from assess.report.say.orders import Sticker
from assess.results import Results

MOST_BYTES = 213
"""Bytes (UTF-8) of a code's text: what version 10 holds with error correction M (ISO/IEC 18004, table 7).

It has 57 modules a side, 65 with its margin: 0.43 mm each at the 28 mm that a sticker has room for. What a phone still
reads of smaller ones depends on the phone: 0.4 mm is assumed to be the least.
"""


def draw_code(text: str) -> str:
    """Return the code of a text as SVG, with the text as its title."""
    import segno

    code = segno.make(text, error="m", micro=False, encoding="utf-8")
    drawn = code.svg_inline(omitsize=True, border=4)
    head, inside = drawn.split(">", 1)
    return f'{head} xmlns="http://www.w3.org/2000/svg" role="img"><title>{escape(text)}</title>{inside}'


def check_codes(stickers: Iterable[Sticker], results: Results) -> None:
    """Raise WorkbookError, with the cell of each piece, where the text of a sticker is too long for a code."""
    sheet, letter = results.provenance.sheets["Items"], results.provenance.letters["Items"]["item"]
    found = {}
    for one in stickers:
        if (size := len(one.text.encode())) > MOST_BYTES:
            message = fill("the QR code of its sticker would hold {size} bytes, {most} at most can be read at its "
                           "size: {text}.", size=size, most=MOST_BYTES, text=one.text)  # fmt: skip
            fix = fill("Shorten Item or Room by {n} characters, or leave out the format work.", n=size - MOST_BYTES)
            cell = f"{letter}{one.result.item.row}"
            found[cell] = Problem("error", sheet, cell, message, fix)
    if found:
        raise WorkbookError(list(found.values()), results.provenance.language)
