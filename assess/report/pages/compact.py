"""Long lists in a compact form: lines of fixed columns, which a PDF lays out many times faster than a table's cells."""

import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from assess.i18n import gettext as _
from assess.report import words
from assess.report.summary import describe
from assess.results import ItemResult
from assess.risk import RiskClass

if TYPE_CHECKING:
    from assess.methods import MethodInfo

LINES = 58
"""Lines of one block: what a page holds."""
MOST_LINES = 5000
"""Rows that a list shows; beyond that a PDF gets too long for anybody to read."""


@dataclass(frozen=True, slots=True)
class Line:
    """One row: its text, and its class, which is set in colour behind it; None where it has none."""

    text: str
    risk: RiskClass | None
    label: str


@dataclass(frozen=True, slots=True)
class Block:
    """A page's worth of lines below a head."""

    head: str
    lines: Sequence[Line]


@dataclass(frozen=True, slots=True)
class _Column:
    """One column: its head, its width in characters (numbers stand to the right), and what stands in it."""

    head: str
    width: int
    read: Callable[[ItemResult], str]
    is_number: bool = False

    def put(self, text: str) -> str:
        """Return a text as wide as the column."""
        return fit(text, self.width, to_right=self.is_number)


def fit(text: str, width: int, *, to_right: bool = False) -> str:
    """Return a text that takes `width` places in a font of equal widths, cut where it is longer."""
    text = " ".join(text.split())
    taken = sum(map(_places, text))
    if taken > width:
        kept, left = "", width - 1
        for character in text:
            left -= _places(character)
            if left < 0:
                break
            kept += character
        text, taken = kept + "…", sum(map(_places, kept)) + 1
    return " " * (width - taken) + text if to_right else text + " " * (width - taken)


def _places(character: str) -> int:
    """Return how many places a character takes: none if it stands above another one, two if it is a wide one."""
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def list_pieces(results: Sequence[ItemResult], methods: Sequence["MethodInfo"], *, has_simulated: bool) -> list[Block]:
    """Return all pieces, a line a row, with what the table of all pieces shows."""
    columns = [
        _Column(_("Item"), 12, lambda one: one.item.item),
        _Column(_("Floor"), 6, lambda one: one.item.floor),
        _Column(_("Room"), 14, lambda one: one.item.room),
        _Column(_("Description"), 30, lambda one: describe(one, 30)),
        _Column(_("No."), 5, lambda one: f"{one.item.quantity}", is_number=True),
        _Column("B × W × H [cm]", 17, words.size, is_number=True),
        _Column("B/H", 6, lambda one: words.fixed(one.item.breadth_to_height, 3), is_number=True),
        _Column(_("Axis"), 5, lambda one: one.governing.motion.axis),
        _Column("PFA [g]", 7, lambda one: words.in_g(one.governing.motion.pfa_g), is_number=True),
        *(_Column(_(one.short_title), 7, _reader(one), is_number=True) for one in methods if one.is_live),
        _Column(_("Chance"), 25 if has_simulated else 7, words.chance, is_number=True),
    ]
    return _blocks(columns, results)


def list_methods(results: Sequence[ItemResult], methods: Sequence["MethodInfo"]) -> list[Block]:
    """Return what every method gives for each row under its governing motion, a line a row."""
    columns = [
        _Column(_("Item"), 12, lambda one: one.item.item),
        _Column(_("Floor"), 6, lambda one: one.item.floor),
        _Column("B/H", 6, lambda one: words.fixed(one.item.breadth_to_height, 3), is_number=True),
        _Column("PFA [g]", 7, lambda one: words.in_g(one.governing.motion.pfa_g), is_number=True),
        _Column("PFV [cm/s]", 10, lambda one: words.in_cm_s(one.governing.motion.pfv_cm_s), is_number=True),
        *(_Column(_(method.title), _width(method), _reader(method), is_number=True) for method in methods),
    ]
    return _blocks(columns, results)


def _width(method: "MethodInfo") -> int:
    """Return the width of a method's column: that of a criterion's longer word."""
    return max(len(_(word)) for word in method.words) if any(method.words) else 17


def _reader(method: "MethodInfo") -> Callable[[ItemResult], str]:
    def read(one: ItemResult) -> str:
        value = one.governing.methods[method.key].value
        if method.kind == "probability" or value is None:
            return words.percent(value)
        return _(method.words[0 if value else 1])

    return read


def _blocks(columns: Sequence[_Column], results: Sequence[ItemResult]) -> list[Block]:
    head = "  ".join(column.put(column.head) for column in columns)
    lines = [_line(columns, one) for one in results[:MOST_LINES]]
    return [Block(head, lines[at : at + LINES]) for at in range(0, len(lines), LINES)]


def _line(columns: Sequence[_Column], one: ItemResult) -> Line:
    text = "  ".join(column.put(column.read(one)) for column in columns)
    marks = words.class_marks(one)
    if one.is_anchored:
        mark = _("anchored")
        return Line(text, None, f"⚓ {mark} ({words.risk_label(one.adopted.risk)}{marks})")
    return Line(text, one.adopted.risk, f"{words.risk_label(one.adopted.risk)}{marks}")
