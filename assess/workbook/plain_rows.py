"""Rows of a sheet in the plain form in which programs write them, found by a pattern instead of the XML parser.

A prepared workbook has some thousands of cells that hold a formula and no value, and a parser that calls Python at each
tag spends most of the time of a reading on them. Here whole rows are cut out of the XML before the parser sees it. The
parser still gets the tags of each row, empty, so that it goes on to check their order, their nesting and the
document as a whole; the cells are handed over when it comes to the end of their row.

Only what can be read in one way is cut: cells of one form with an address, in a document of UTF-8 without comments,
CDATA, processing instructions, a document type or entities of its own. Whatever else a sheet holds goes through the
parser as it is.
"""

import re
from functools import cache, lru_cache

_END = b"</row>"
_DECLARATION = re.compile(rb"(?:\xef\xbb\xbf)?(?:<\?xml\s([^?]*)\?>)?")
_ENCODING = re.compile(rb"encoding\s*=\s*[\"'](?!utf-8[\"'])", re.IGNORECASE)
_OTHER_ENTITY = re.compile(rb"&(?!(?:amp|lt|gt|quot|apos);)")
_CONTROLS = bytes(one for one in range(32) if one not in b"\t\n\r")
_BEYOND = (b"]]>", b"\xef\xbf\xbe", b"\xef\xbf\xbf")
"""What no document may hold as text: the end of a CDATA section, and two numbers that are no character."""

_CELL = (
    r'<c r="{any}[A-Z]{{1,2}}){any}[0-9]{{1,7}})"(?: s="{any}[0-9]{{1,6}})")?(?: t="{any}[a-z]{{1,3}})")?'
    r"(?:/>|>(?:{any}<f)(?: aca=\"(?:false|true)\")?>[^<]*+</f>)?{any}<v>[^<&\r]*+</v>|<v/>)?</c>)"
)
_EMPTY = r'<c r="[A-H]?[A-Z][0-9]{1,7}"(?: s="[0-9]{1,6}")?(?:/>|><f>[^<]*+</f><v></v></c>)'
"""A cell without a value, in the first 208 columns: blank, or as a prepared row holds it."""
_ROW = re.compile(rf'(<row r="([0-9]{{1,7}})"[^<>]*(?<!/)>)(?:((?:{_EMPTY})+)|((?:{_CELL.format(any="(?:")})+))</row>')
_UNSAVED = re.compile(r'<c r="([A-Z]{1,2})[0-9]{1,7}"[^<>]*><f>')
_CELLS = re.compile(_CELL.format(any="("))

PlainCell = tuple[str, str, str, str, str, str]
"""Letters and row of the address, style and type ("" where it has none), formula and value with their tags."""


class RowCutter:
    """Cuts plain rows out of the XML of a sheet as it comes, piece by piece.

    `rows` holds the cells of the rows that were cut out of the last piece, by the number of the row, as text for
    `list_cells`, and whether none of them has a value.
    """

    def __init__(self) -> None:
        self.rows: dict[int, tuple[str, bool]] = {}
        self._rest, self._last = b"", b""
        self._can_cut: bool | None = None

    def cut(self, piece: bytes) -> bytes:
        """Return what the parser is to be given of a piece and what was held back before it; a part row is held back.

        Of rows that were cut out it is the tags of the row alone.
        """
        data = self._rest + piece
        whole = data.rfind(_END) + len(_END)
        if whole < len(_END):
            whole = len(data)
        data, self._rest = data[:whole], data[whole:]
        return self._cut_whole(data)

    def finish(self) -> bytes:
        """Return what was held back."""
        data, self._rest = self._rest, b""
        return self._cut_whole(data)

    def _cut_whole(self, data: bytes) -> bytes:
        self.rows, start = {}, 0
        if self._can_cut is None and (found := _DECLARATION.match(data)):
            self._can_cut, start = not _ENCODING.search(found[1] or b""), found.end()
        joined = self._last + data[start:]
        self._last = data[-1:]
        self._can_cut = self._can_cut and b"<!" not in joined and b"<?" not in joined
        if not self._can_cut or _END not in data or not _is_plain(data):
            return data
        try:
            return _ROW.sub(self._take, data.decode()).encode()
        except UnicodeDecodeError:
            return data

    def _take(self, row: re.Match[str]) -> str:
        start, digits, empty, cells = row.groups()
        number = int(digits)
        if number in self.rows:
            return row[0]
        self.rows[number] = (empty, True) if empty else (cells, False)
        return f"{start}</row>"


def _is_plain(data: bytes) -> bool:
    """Tell whether the text of a piece is one that every XML parser accepts, with predefined entities only."""
    return (
        not any(one[:1] in data and one in data for one in _BEYOND)
        and len(data.translate(None, _CONTROLS)) == len(data)
        and not _OTHER_ENTITY.search(data)
    )


def list_unsaved(cells: str) -> tuple[int, ...]:
    """Return the columns, from 0, of the formulas in a row without a value, in their order."""
    return _number_columns(*_UNSAVED.findall(cells))


@lru_cache(maxsize=64)  # prepared rows are alike
def _number_columns(*letters: str) -> tuple[int, ...]:
    return tuple(column_number(one) - 1 for one in letters)


def list_cells(cells: str) -> list[PlainCell]:
    """Return the cells of a row that was cut out, in their order."""
    return _CELLS.findall(cells)


@cache
def column_letters(at: int) -> str:
    """Return the letters of a column, counted from 0."""
    letters, at = "", at + 1
    while at:
        at, rest = divmod(at - 1, 26)
        letters = chr(ord("A") + rest) + letters
    return letters


@cache
def column_number(letters: str) -> int:
    """Return the number of a column, from 1; ValueError if letters are none."""
    if not (1 <= len(letters) <= 3 and letters.isascii() and letters.isalpha()):
        raise ValueError(f"{letters[:20]} is no column")
    number = 0
    for letter in letters.upper():
        number = 26 * number + ord(letter) - ord("A") + 1
    return number


def split_address(address: str) -> tuple[int, int] | None:
    """Return column and row of a cell, both from 1, by its address ``C3``; None if it is none."""
    found = re.fullmatch(r"([A-Z]{1,3})([1-9]\d{0,6})", address)
    return (column_number(found[1]), int(found[2])) if found else None


def split_range(reference: str) -> tuple[int, int, int, int] | None:
    """Return first and last column, first and last row of a range ``A1:C5`` or ``A1``; None if it is none."""
    first, _, last = reference.replace("$", "").partition(":")
    one, other = split_address(first), split_address(last or first)
    return (one[0], other[0], one[1], other[1]) if one and other else None
