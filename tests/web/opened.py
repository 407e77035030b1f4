"""Workbooks held as the server holds them, for tests that need no server."""

from pathlib import Path

from assess.web.book import Book

MARKET = Path(__file__).parents[2] / "inventories" / "market-street.xlsx"


def hold(path: Path) -> Book:
    """Hold the bytes of a workbook, with the files next to it."""
    return Book.hold(path.name, path.read_bytes(), path.parent)


def edit(book: Book, *cells) -> None:
    """Change cells, each a sheet, a row, a field and a value."""
    edits = []
    for sheet, row, field, value in cells:
        place = book.sheets[sheet].place(field, row)
        assert place is not None, field
        edits.append([sheet, *place, value])
    book.edit(book.version, edits, "test")
