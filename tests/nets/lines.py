"""What each output holds, as lines: the words and numbers that a reader sees, each at its place."""

import json
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import Any

import docx
import openpyxl
import pypdfium2
from docx.table import Table

import assess
from assess.cli.command_run import describe_result
from assess.results import Results

SEEN = ("alt", "aria-label", "title")
"""Attributes of HTML that hold words."""
APART = frozenset(
    re.findall(
        r"\w+",
        "address article aside blockquote body caption dd details div dl dt fieldset figcaption figure footer form h1 "
        "h2 h3 h4 h5 h6 header hr html li main nav ol p section summary svg table tbody text tfoot thead title tr ul",
    )
)
"""Elements of which each is a line of its own."""
HEADINGS = frozenset(("h1", "h2", "h3", "h4", "h5", "h6"))
UNSEEN = frozenset(("script", "style", "template"))
_SIGNIFICANT = 9
"""Digits of the numbers in results.json that are held: the last ones differ between processors."""


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = []
        self.open = ""
        self.unseen = 0

    def _end(self, mark: str = "") -> None:
        text = " ".join(self.open.split())
        if text.strip("| "):
            self.lines.append(mark + text)
        self.open = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.unseen += tag in UNSEEN
        if tag in APART:
            self._end()
        elif tag in ("td", "th"):
            self.open += " | "
        words = [f"({name}: {value})" for name, value in attrs if name in SEEN and value]
        self.open += "".join(f" {one} " for one in words)

    def handle_endtag(self, tag: str) -> None:
        self.unseen -= tag in UNSEEN
        if tag in APART:
            self._end(f"{'#' * int(tag[1])} " if tag in HEADINGS else "")

    def handle_data(self, data: str) -> None:
        if not self.unseen:
            self.open += data


def read_html(path: Path) -> list[str]:
    """Return the words of a page, a line an element of its own, cells of a row divided by |."""
    page = _Page()
    page.feed(path.read_text(encoding="utf-8"))
    page.close()
    return page.lines


def read_excel(path: Path) -> list[str]:
    """Return the cells of each row, a formula as it is filled down: where it says the same of each row, once."""
    lines = []
    for sheet in openpyxl.load_workbook(path).worksheets:
        known: dict[str, str] = {}
        lines.append(f"# {sheet.title}")
        for row in sheet.iter_rows():
            cells = []
            for cell in row:
                if cell.value is None:
                    continue
                text = str(cell.value)
                if text.startswith("="):
                    text = re.sub(rf"(?<=[A-Z]){cell.row}(?!\d)", "{row}", text)
                    if known.get(cell.column_letter) == text:
                        continue
                    known[cell.column_letter] = text
                cells.append(f"{cell.column_letter} {text}")
            if cells:
                lines.append(f"{row[0].row}: " + " | ".join(cells))
    return lines


def read_word(path: Path) -> list[str]:
    """Return paragraphs, and rows of tables."""
    return [line for part in docx.Document(str(path)).iter_inner_content() for line in _read_part(part)]


def _read_part(part: Any) -> Iterator[str]:
    if isinstance(part, Table):
        for row in part.rows:
            texts = [cell.text for cell in row.cells]
            yield "| " + " | ".join(
                " ".join(one.split()) for one, other in pairwise([*texts, None]) if one is not other
            )
    elif part.text.strip():
        yield f"{part.style.name}: {' '.join(part.text.split())}"


def read_json(path: Path) -> list[str]:
    """Return a line a value, with its place, but for the hashes of other files."""
    record = json.loads(path.read_text(encoding="utf-8"))
    record["assess"].pop("files", None)
    return list(flatten(record, ""))


def flatten(value: Any, place: str) -> Iterator[str]:
    """Yield a line a value, with its place."""
    if isinstance(value, (dict, list)) and value:
        for name, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from flatten(part, f"{place}/{name}")
    else:
        yield f"{place} {value:.{_SIGNIFICANT}g}" if isinstance(value, float) else f"{place} {value}"


def read_csv(path: Path) -> list[str]:
    """Return the rows."""
    return path.read_text(encoding="utf-8-sig").splitlines()


def read_pdf(path: Path) -> list[str]:
    """Return the sentences of a document, without where its lines and pages end."""
    texts = [page.get_textpage().get_text_range().replace("\ufffe", "-") for page in pypdfium2.PdfDocument(path)]
    words = re.sub(r"(Page|Pagina) \d+ (of|di) \d+ ?", "", " ".join(" ".join(texts).split()))
    return re.split(r"(?<=[.:;]) ", words.strip())


READERS: Mapping[str, Callable[[Path], list[str]]] = {
    "html": read_html, "xlsx": read_excel, "docx": read_word, "json": read_json, "csv": read_csv, "pdf": read_pdf,
    "annex": read_pdf,
}  # fmt: skip
PDFS = ("pdf", "annex")
QUICK = tuple(name for name in READERS if name not in PDFS)
TERMINAL = "txt"


def render(results: Results, folder: Path, formats: Collection[str]) -> dict[str, list[str]]:
    """Write outputs of results and return their lines, by format; `TERMINAL` is what the command prints."""
    written = assess.write_reports(results, folder, tuple(formats))
    found = {name: READERS[name](written[name]) for name in formats}
    return found | {TERMINAL: list(describe_result(results))}
