"""What a document is made of: headings, paragraphs, lists, tables, tiles, figures, equations and notes.

A section is a function from results to blocks. Renderers turn blocks into HTML (`assess.report.html_blocks`) and Word
(`assess.report.word`); neither knows what a section is about. `kind` names the style of a block, a row, a cell or a run
of words: its class in HTML, its style in Word.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from assess.i18n import markup

# ---------------------------------------------------------------- on a line


@dataclass(frozen=True, slots=True)
class Span:
    """A run of words with a style; `href` makes it a link, `title` says what it leads to.

    Of kinds, "strong", "em", "sub", "sup" and "break" (a new line) are those of HTML; the others are classes.
    """

    words: "Words"
    kind: str = ""
    href: str = ""
    title: str = ""


@dataclass(frozen=True, slots=True)
class Image:
    """A picture: as SVG that is drawn where it stands, or the address of one (``data:``), with what it says in words.

    An SVG that has its own title needs no `alternative`. On a line it is a sign or a photo, in a `Figure` a figure.
    """

    source: str
    alternative: str = ""
    kind: str = ""

    @property
    def is_drawn(self) -> bool:
        """Whether it is an SVG, not an address."""
        return self.source.startswith("<svg")


@dataclass(frozen=True, slots=True)
class Equation:
    """A line of a method in plain text, whose equations are set as mathematics."""

    text: str


Inline: TypeAlias = str | Span | Image | Equation
Words: TypeAlias = Inline | Sequence[Inline]
"""What stands on a line: text, which renderers escape, and runs of it with a style, links and small pictures."""
Runs: TypeAlias = list[Inline]
BREAK = Span("", "break")
DASH = "–"
_TAG = re.compile(r"<(em|strong)>(.*?)</\1>", re.DOTALL)
_RAISED = re.compile(r"(?<=[^\W\d_])_([^\W_]+\*?)|\^(?:\((-?\d+(?:[.,]\d+)?)\)|(-?\d+(?:[.,]\d+)?))")


def strong(words: Words) -> Span:
    """Return words in bold."""
    return Span(words, "strong")


def note(words: Words) -> Span:
    """Return words in small print."""
    return Span(words, "note")


def rich(text: str, /, **values: Any) -> list[Inline]:
    """Return a translated text whose tags <em> and <strong> count; those inside `values` do not."""
    from markupsafe import Markup

    text, found, at = str(markup(text, **values)), list[Inline](), 0
    for tag in _TAG.finditer(text):
        found += [Markup(text[at : tag.start()]).unescape(), Span(Markup(tag[2]).unescape(), tag[1])]  # noqa: S704
        at = tag.end()
    return [one for one in (*found, Markup(text[at:]).unescape()) if one]  # noqa: S704 - only to be unescaped


def lower_indices(text: str) -> list[Inline]:
    """Return words with quantities: what stands behind _ is set below the line, a number behind ^ above it."""
    found: list[Inline] = []
    at = 0
    for one in _RAISED.finditer(text):
        found += [text[at : one.start()], Span(one[1], "sub") if one[1] else Span(one[2] or one[3], "sup")]
        at = one.end()
    return [one for one in (*found, text[at:]) if one]


def join_words(parts: Iterable[Words], mark: Inline = " ") -> list[Inline]:
    """Return the parts that are not empty, with a mark between them."""
    found: list[Inline] = []
    for part in parts:
        if part:
            found += [*([mark] if found else []), *list_words(part)]
    return found


def put_words(text: str, **parts: Words) -> list[Inline]:
    """Return a translated text with words in place of its ``{name}``."""
    pieces = re.split(r"\{(\w+)\}", text)
    found = (parts[one] if at % 2 else one for at, one in enumerate(pieces))
    return [inline for one in found if one for inline in list_words(one)]


def list_words(words: Words) -> Sequence[Inline]:
    """Return words as a sequence."""
    return (words,) if isinstance(words, str | Span | Image | Equation) else words


def plain_words(words: Words) -> str:
    """Return words without styles and pictures."""
    return "".join(
        one if isinstance(one, str) else one.text if isinstance(one, Equation)
        else "" if isinstance(one, Image) else "\n" if one is BREAK else plain_words(one.words)
        for one in list_words(words)
    )  # fmt: skip


# ---------------------------------------------------------------- tables


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its heading, the class of its width, and whether its cells stand to the right."""

    heading: Words = ""
    width: str = ""
    is_number: bool = False
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell that is more than its words: the head of its row, over several columns, or sorted by another value."""

    words: Words
    kind: str = ""
    is_head: bool = False
    columns: int = 1
    sort: Any = None


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a table; `data` are values that a page filters rows by."""

    cells: Sequence["Cell | Words"]
    kind: str = ""
    id: str = ""
    data: Mapping[str, str] = field(default_factory=dict)

    def place_cells(self) -> Iterator[tuple[int, Cell]]:
        """Yield the cells, each with the column that it begins in."""
        at = 0
        for one in self.cells:
            cell = one if isinstance(one, Cell) else Cell(one)
            yield at, cell
            at += cell.columns


def head(words: Words) -> Cell:
    """Return the cell that names its row."""
    return Cell(words, is_head=True)


def part(words: Words, columns: int) -> Row:
    """Return a row that is the heading of those below it."""
    return Row((Cell(words, is_head=True, columns=columns),), "part")


@dataclass(frozen=True, slots=True)
class Table:
    """A table; `groups` are its rows, those of one part together. `kind` holds its classes.

    `is_named`: it shows names of the workbook, whose long words have places to break at; `is_cards`: each row becomes
    a card on a phone, for rows that are read one by one.
    """

    columns: Sequence[Column]
    groups: Sequence[Sequence[Row]]
    kind: str = ""
    caption: Words = ""
    id: str = ""
    is_named: bool = False
    is_cards: bool = True


def table(
    columns: Sequence[Column],
    rows: Iterable[Sequence[Cell | Words] | Row],
    kind: str = "",
    caption: Words = "",
    *,
    is_named: bool = False,
    is_cards: bool = True,
) -> Table:
    """Return a table of one part."""
    group = [one if isinstance(one, Row) else Row(one) for one in rows]
    return Table(columns, [group], kind, caption, is_named=is_named, is_cards=is_cards)


def list_columns(*columns: tuple[Words, str] | tuple[Words, str, str]) -> list[Column]:
    """Return columns from heading, width and "num" where they hold numbers."""
    return [Column(one[0], one[1], is_number=len(one) > 2) for one in columns]


# ---------------------------------------------------------------- blocks


@dataclass(frozen=True, slots=True)
class Title:
    """The title of a document, with what stands on every page of it in print: in short, its status, its conditions."""

    words: Words
    short: str
    status: str = ""
    conditions: str = ""


@dataclass(frozen=True, slots=True)
class Contents:
    """The contents: a line for each section, with the lines below it, and words after all of them."""

    heading: str
    lines: Sequence[tuple[Words, Sequence[Words]]]
    after: Words = ""


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading inside a section."""

    words: Words
    level: int = 3


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph; kinds are lead, lead-in (kept with what follows), caution, small, legend."""

    words: Words
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list."""

    items: Sequence[Words]
    kind: str = "tight"


@dataclass(frozen=True, slots=True)
class Terms:
    """Words with their meanings."""

    items: Sequence[tuple[Words, Words]]


@dataclass(frozen=True, slots=True)
class Tile:
    """A count that is read first."""

    kind: str
    name: str
    number: str
    note: str


@dataclass(frozen=True, slots=True)
class Tiles:
    """Counts side by side."""

    tiles: Sequence[Tile]


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure with its caption; `legend` stands between them."""

    image: Image
    caption: Words = ""
    kind: str = ""
    legend: Sequence["Block"] = ()


@dataclass(frozen=True, slots=True)
class Listing:
    """Lines of fixed columns below a head: what a PDF lays out many times faster than a table."""

    head: str
    lines: Sequence[Words]


@dataclass(frozen=True, slots=True)
class Equations:
    """Equations, a line each."""

    lines: Sequence[Words]
    is_whole: bool = True


@dataclass(frozen=True, slots=True)
class Box:
    """Blocks that belong together; `tag` is div, article or header."""

    blocks: Sequence["Block"]
    kind: str = ""
    tag: str = "div"
    id: str = ""
    label: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """A section of a document; `kind` says how it is laid out: run-on (on the same page), wide (pages turned).

    One without a heading goes on with the section before it, and is not in the contents.
    """

    blocks: Sequence["Block"]
    kind: str = ""
    id: str = ""
    heading: str = ""


@dataclass(frozen=True, kw_only=True)
class Document:
    """A whole document: what stands above its sections, the sections, and what a page or a file says of itself.

    `title` is that of the window, `description` and `keywords` are for catalogues, `author` who prepared it;
    `conditions` must stand on every page, such as that anchors are assumed. `kind` is what styles go by.
    """

    title: str
    cover: Sequence["Block"]
    sections: Sequence[Section]
    author: str
    description: str
    keywords: str = ""
    conditions: str = ""
    kind: str = ""
    contents: Contents | None = None


Block: TypeAlias = (
    Title | Contents | Heading | Paragraph | Bullets | Terms | Table | Tiles | Figure | Listing | Equations | Box
)


def more(left: int, say: Callable[[int], str]) -> list[Block]:
    """Return a line on what is left out; nothing where all is shown."""
    return [Paragraph(say(left), "small")] if left > 0 else []
