"""Rows inserted or deleted: what refers to cells of a sheet, anywhere in a workbook, follows its cells.

References stand in the sheet itself (merged cells, filters, validations, conditional formats, links), in formulas of
every sheet, in defined names, tables, comments, drawings, charts and pivot tables. Each part is read tag by tag; only
tags and texts that refer to moved cells are written anew. What goes with deleted rows, such as their comments, is cut
out with them. Office Open XML: ECMA-376 Part 1, 18.3 (worksheets), 18.17 (formulas), 20.5 (drawings).
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from html import escape, unescape
from typing import ClassVar

from assess.i18n import Text, fill
from assess.workbook.open import SHEET_COLUMNS, SHEET_ROWS, Area
from assess.workbook.plain_rows import column_letters, column_number, split_range


@dataclass(frozen=True, slots=True)
class RowShift:
    """Rows that are inserted before row `at` (`count` above 0), or deleted from it on (below 0).

    New rows take over the styles and the formulas of the row `like`, numbered as before; of none where it is 0.
    """

    at: int
    count: int
    like: int = 0

    def row(self, row: int) -> int | None:
        """Return where a row comes to lie; None for one that is deleted."""
        if row < self.at:
            return row
        return None if row < self.at - self.count else row + self.count

    def back(self, row: int) -> int | None:
        """Return where a row lay before; None for one that is inserted."""
        if row < self.at:
            return row
        return None if row < self.at + self.count else row - self.count

    def reverse(self) -> "RowShift":
        """Return the shift that takes it back, but for what stood in rows that are deleted."""
        return RowShift(self.at, -self.count)

    def area(self, area: Area) -> Area | None:
        """Return where an area comes to lie; None if all its rows are deleted."""
        left, right, top, bottom = area
        if self.count < 0:
            gone = self.at - self.count  # the first row that stays
            top = top if top < self.at else max(top, gone) + self.count
            bottom = bottom if bottom < self.at else max(bottom, gone - 1) + self.count
            return (left, right, top, bottom) if top <= bottom else None
        if (top, bottom) == (1, SHEET_ROWS):
            return area
        move = self.count
        return left, right, top + move * (top >= self.at), min(bottom + move * (bottom >= self.at), SHEET_ROWS)


@dataclass(frozen=True, slots=True)
class RowMove:
    """Rows from `at` on that come to lie before row `to`, which is numbered as before; no row is added or lost.

    An area that holds all rows that come to lie elsewhere stays; one within the moved rows, or within those that
    they pass, follows; another one becomes what it is after the rows are inserted there and deleted here.
    """

    at: int
    count: int
    to: int
    like: ClassVar[int] = 0

    @property
    def span(self) -> tuple[int, int]:
        """The first and the last of all rows that come to lie elsewhere."""
        return min(self.at, self.to), max(self.at + self.count, self.to) - 1

    def row(self, row: int) -> int:
        """Return where a row comes to lie."""
        first, last = self.span
        if not first <= row <= last:
            return row
        passed, is_up = last - first + 1 - self.count, self.to < self.at
        if self.at <= row < self.at + self.count:
            return row - passed if is_up else row + passed
        return row + self.count if is_up else row - self.count

    def back(self, row: int) -> int:
        """Return where a row lay before."""
        return self.reverse().row(row)

    def reverse(self) -> "RowMove":
        """Return the move that takes it back."""
        at = self.row(self.at)
        return RowMove(at, self.count, self.at + (self.count if self.at > at else 0))

    def area(self, area: Area) -> Area:
        """Return where an area comes to lie."""
        left, right, top, bottom = area
        first, last = self.span
        if bottom < first or top > last or (top <= first and bottom >= last):
            return area
        is_inside = first <= top and bottom <= last
        if is_inside and self.row(bottom) - self.row(top) == bottom - top:
            return left, right, self.row(top), self.row(bottom)
        gone = self.at if self.to > self.at else self.at + self.count
        inserted = RowShift(self.to, self.count).area(area) or area
        return RowShift(gone, -self.count).area(inserted) or area


@dataclass(frozen=True, slots=True)
class Growth:
    """Rows that were filled in directly below a table: areas that end above them reach to the last of them.

    `blocks` are the first and the last row of each block of new rows, with the columns that they fill.
    """

    blocks: tuple[tuple[int, int, frozenset[int]], ...] = ()

    def area(self, area: Area) -> Area | None:
        """Return an area with the new rows below it."""
        left, right, top, bottom = area
        return next(((left, right, top, last) for first, last, _ in self.blocks if first <= bottom + 1 <= last), area)

    def of_columns(self, left: int, right: int) -> "Growth":
        """Return the growth of a table, which takes in rows that are filled in its own columns [from 1]."""
        own = range(left - 1, right)
        return Growth(tuple(one for one in self.blocks if not one[2].isdisjoint(own)))


Shift = RowShift | RowMove
"""What becomes of the rows of a sheet."""
Move = Shift | Growth
"""Where areas come to lie."""


# ---------------------------------------------------------------- references in texts

_NAME = r"(?:'(?:[^']|'')+'|(?:\[[^\[\]]*\])?[^\W\d][\w.]*(?::[^\W\d][\w.]*)?)!"
_CELL = r"\$?[A-Z]{1,3}\$?[0-9]{1,7}"
_REFERENCE = re.compile(
    rf'"(?:[^"]|"")*"|(?<![\w.$\]])({_NAME})?({_CELL}|\$?[0-9]{{1,7}}(?=:))(?::({_CELL}|\$?[0-9]{{1,7}}))?(?![\w.(!:\[])'
    r"|'(?:[^']|'')*'!?|\[[^\[\]]*\]"
)
"""A text, a reference with its sheet, or what only looks as if it held one: a name of a sheet, a column of a table."""
_PARTS = re.compile(r"(\$?)([A-Z]{0,3})(\$?)([0-9]+)")


def shift_formula(text: str, sheet: str, is_own: bool, move: Move) -> str:
    """Return a formula, or a list of references, whose references to a sheet follow its cells.

    `is_own`: whether references without a sheet mean this one. One whose cells are gone is ``#REF!``.
    """

    def follow(found: re.Match[str]) -> str:
        name, first, last = found.groups()
        if first is None or not (is_own if name is None else _plain_name(name) == sheet.casefold()):
            return found[0]
        one, other = _PARTS.fullmatch(first), _PARTS.fullmatch(last or first)
        if one is None or other is None or bool(one[2]) != bool(other[2]):
            return found[0]
        columns = [column_number(part[2]) for part in (one, other)] if one[2] else [1, SHEET_COLUMNS]
        rows = int(one[4]), int(other[4])
        area = move.area((min(columns), max(columns), min(rows), max(rows)))
        if area is None:
            return f"{name or ''}#REF!"
        numbers = area[2:] if rows[0] <= rows[1] else area[:1:-1]
        ends = [f"{part[1]}{part[2]}{part[3]}{row}" for part, row in zip((one, other), numbers, strict=True)]
        return (name or "") + (f"{ends[0]}:{ends[1]}" if last else ends[0])

    return _REFERENCE.sub(follow, text) if any(sign.isdigit() for sign in text) else text


@lru_cache(maxsize=64)
def _plain_name(name: str) -> str:
    bare = name[:-1]
    return (bare[1:-1].replace("''", "'") if bare.startswith("'") else bare).casefold()


def translate_formula(text: str, rows: int, columns: int = 0) -> str:
    """Return a formula as another cell holds it that is filled in from the first: references without $ go with it."""

    def follow(found: re.Match[str]) -> str:
        name, first, last = found.groups()
        if first is None:
            return found[0]
        ends = []
        for part in filter(None, (_PARTS.fullmatch(one) for one in (first, last) if one)):
            letters, row = part[2], int(part[4]) + (0 if part[3] or (part[1] and not part[2]) else rows)
            if letters and not part[1] and columns:
                at = column_number(letters) + columns
                letters = column_letters(at - 1) if 1 <= at <= SHEET_COLUMNS else ""
            ends.append(f"{part[1]}{letters}{part[3]}{row}" if 1 <= row <= SHEET_ROWS and bool(letters) == bool(part[2])
                        else "#REF!")  # fmt: skip
        return (name or "") + ("#REF!" if "#REF!" in ends else ":".join(ends))

    return _REFERENCE.sub(follow, text)


def move_areas(text: str, move: Move) -> str | None:
    """Return areas that a blank parts, moved; None if all are gone. What is no area stays."""
    moved = []
    for one in text.split():
        area = split_range(one)
        if area is None:
            moved.append(one)
        elif found := move.area(area):
            left, right, top, bottom = found
            first, last = f"{column_letters(left - 1)}{top}", f"{column_letters(right - 1)}{bottom}"
            moved.append(f"{first}:{last}" if ":" in one else first)
    return " ".join(moved) or None


# ---------------------------------------------------------------- references in parts

_TOKEN = re.compile(r"<(/?)([^\s<>/!?]+)((?:[^<>\"']|\"[^\"]*\"|'[^']*')*?)(/?)>([^<]*)")
_ATTRIBUTE = re.compile(r"(\s)([^\s=/>]+)(\s*=\s*)(\"[^\"]*\"|'[^']*')")
AREAS: Mapping[str, tuple[str, ...]] = {
    "dimension": ("ref",), "mergeCell": ("ref",), "autoFilter": ("ref",), "sortState": ("ref",),
    "sortCondition": ("ref",), "hyperlink": ("ref",), "dataValidation": ("sqref",),
    "conditionalFormatting": ("sqref",), "ignoredError": ("sqref",), "protectedRange": ("sqref",),
    "selection": ("sqref", "activeCell"), "pane": ("topLeftCell",), "sheetView": ("topLeftCell",),
    "f": ("ref", "r1", "r2"), "c": ("r",), "table": ("ref",), "comment": ("ref",), "threadedComment": ("ref",),
    "cellWatch": ("r",), "inputCells": ("r",), "location": ("ref",), "singleXmlCell": ("r",),
}  # fmt: skip
"""Attributes that are areas of the part's own sheet, by element."""
GROWING: Mapping[str, tuple[str, ...]] = {
    one: AREAS[one] for one in ("autoFilter", "sortState", "dataValidation", "conditionalFormatting", "table")
}
"""Those that take in rows filled in directly below."""
_FORMULAS = frozenset({"f", "formula", "formula1", "formula2", "definedName", "calculatedColumnFormula",
                       "totalsRowFormula", "fmlaLink", "fmlaRange"})  # fmt: skip
"""Elements and attributes whose text is a formula."""
_GO = frozenset({"mergeCell", "hyperlink", "dataValidation", "conditionalFormatting", "ignoredError", "protectedRange",
                 "comment", "threadedComment", "cellWatch", "sparkline", "brk", "autoFilter", "sortState",
                 "sortCondition"})  # fmt: skip
"""Elements that go with the cells that they are about."""
_VIEWS = frozenset({"selection", "pane", "sheetView", "dimension"})
"""Elements of which the first cell is left where their cells go."""
_EMPTY = re.compile(
    r"<((?:\w+:)?(?:mergeCells|hyperlinks|dataValidations|ignoredErrors|protectedRanges|cellWatches|rowBreaks|"
    r"sparklines|sparklineGroup|sparklineGroups|conditionalFormattings|ext|extLst))(?=[\s>])[^>]*>\s*</\1>"
)
"""Lists that may not be empty."""
_ROW = re.compile(r"(\sr\s*=\s*[\"'])([0-9]+)")
_OWN = re.compile(r"\s(?:r|hidden|spans)\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_ADDRESS = re.compile(r"(\sr\s*=\s*[\"']([A-Z]{1,3}))([0-9]+)")
_STYLE = re.compile(r"\ss\s*=\s*[\"'][0-9]+[\"']")
_SHARED = re.compile(r"\bt\s*=\s*[\"']shared[\"']")
_INDEX = re.compile(r"\bsi\s*=\s*[\"']([0-9]+)[\"']")


class NotMovedError(Exception):
    """The references of a part cannot be moved with certainty; `why` tells the reason."""

    def __init__(self, why: Text) -> None:
        self.why = why
        super().__init__(why)


class PartShift:
    """Moves the references of one part of the zip to the cells of a sheet.

    * `sheet`: how formulas call the sheet.
    * `is_own`: whether areas, and references without a sheet, mean it: its own part, its tables and comments.
    * `move`: where its cells come to lie.
    """

    def __init__(self, sheet: str, is_own: bool, move: Move) -> None:
        self.sheet, self.is_own, self.move = sheet, is_own, move
        self.shift = None if isinstance(move, Growth) else move
        self.areas = AREAS if self.shift else GROWING
        self.out: list[str] = []
        self.open: list[tuple[str, int]] = []
        """The elements that are open: name, and where in the output they begin."""
        self.skipped, self.has_cut = 0, False
        """How many elements, of one that is cut out, are open; whether one was cut out."""
        self.place = (0, 0)
        """Row and column of the cell that is read, as before."""
        self.moved_row: int | None = 0
        self.shared: dict[str, tuple[int, int, str]] = {}
        self.columns: dict[int, tuple[list[str], list[str]]] = {}
        self.new_rows = ""
        self.taken: list[Area] = []
        """The areas of validations, of which no two may overlap."""

    def apply(self, data: bytes) -> bytes:
        """Return the part with its references moved; raises NotMovedError if that is not certain."""
        text = data.decode()
        if self.shift is None and (rows := re.search(r"<((?:\w+:)?sheetData)[\s>].*</\1>", text, re.DOTALL)):
            pieces = [text[: rows.start()], text[rows.start() : rows.end()], text[rows.end() :]]
            validations = re.findall(r"dataValidation\s[^>]*?sqref=[\"']([^\"']*)", pieces[2])
            self.taken = [area for one in validations for part in one.split() if (area := split_range(part))]
        else:
            pieces = [text, "", ""]
            if isinstance(self.shift, RowShift) and self.is_own and self.shift.count > 0 and self.shift.like:
                self.new_rows = self._copy_rows(text, self.shift)
        self._read(pieces[0], pieces[0].find("<", pieces[0].find("?>") + 2 if "<?xml" in pieces[0][:10] else 0))
        self.out.append(pieces[1])
        self._read(pieces[2], 0)
        if self.open:
            raise NotMovedError(fill("its tags do not match"))
        moved, before = "".join(self.out), ""
        while self.has_cut and moved != before:
            before, moved = moved, _EMPTY.sub("", moved)
        if isinstance(self.shift, RowMove) and self.is_own:
            moved = _ROWS.sub(lambda found: found[1] + _sort_rows(found[3]) + found[4], moved, count=1)
        return moved.encode()

    def _read(self, text: str, begin: int) -> None:
        if "<!" in text[begin:] or "<?" in text[begin:]:
            raise NotMovedError(fill("it holds comments or raw text"))
        self.out.append(text[:begin])
        end = begin
        for found in _TOKEN.finditer(text, begin):
            if found.start() != end:
                raise NotMovedError(fill("a tag cannot be found in it"))
            end = found.end()
            slash, tag, attributes, closed, after = found.groups()
            if slash:
                self._leave(tag, after)
            elif self.skipped:
                self.skipped += not closed
            else:
                self._enter(tag, attributes, closed, after)
        if text[end:].strip():
            raise NotMovedError(fill("a tag cannot be found in it"))
        self.out.append(text[end:])

    def _leave(self, tag: str, after: str) -> None:
        if self.skipped:
            self.skipped -= 1
            self.out.append("" if self.skipped else after)
            return
        if not self.open or self.open.pop()[0] != tag:
            raise NotMovedError(fill("its tags do not match"))
        if self.new_rows and tag.rpartition(":")[2] == "sheetData":
            self._put_new_rows()
        self.out.append(f"</{tag}>{after}")

    def _enter(self, tag: str, attributes: str, closed: str, after: str) -> None:
        name, start = tag.rpartition(":")[2], len(self.out)
        is_cell = self.shift is not None and self.is_own and bool(self.open) and name in ("row", "c", "f")
        kept: str | None = attributes
        if is_cell and name == "row":
            kept = self._move_row(attributes, self.shift)
        elif is_cell and name == "c":
            kept = self._move_cell(attributes)
        elif is_cell and name == "f" and _SHARED.search(attributes):
            kept, formula = "", self._take_shared(attributes, "" if closed else after)
            if closed:  # one that follows the first one gets its own text
                moved = shift_formula(formula, self.sheet, True, self.move)
                self.out.append(f"<{tag}>{escape(moved, quote=False)}</{tag}>{after}")
                return
            after = escape(formula, quote=False)
        elif attributes.strip():
            kept = self._attributes(name, attributes)
        if kept is None:
            self.skipped, self.has_cut = 0 if closed else 1, True
            self.out.append(after if closed else "")
            return
        if not closed:
            self.open.append((tag, start))
        if not closed and after.strip():
            text = self._text(name, attributes, after)
            if text is None:
                at = max(at for at, (one, _) in enumerate(self.open) if one.rpartition(":")[2] in _GO)
                self.skipped, self.has_cut = len(self.open) - at, True
                del self.out[self.open[at][1] :], self.open[at:]
                return
            after = text
        self.out.append(f"<{tag}{kept}{closed}>{after}")

    # ------------------------------------------------------------ rows and cells

    def _move_row(self, attributes: str, shift: Shift | None) -> str | None:
        """Return the attributes of a row at its new place, None for one that is deleted; new ones come before it."""
        found = _ROW.search(attributes)
        if found is None or shift is None:
            raise NotMovedError(fill("its rows have no numbers"))
        number = int(found[2])
        if self.new_rows and number >= shift.at:
            self._put_new_rows()
        self.place, self.moved_row = (number, 0), shift.row(number)
        if self.moved_row is None:
            return None
        return f"{attributes[: found.start()]}{found[1]}{self.moved_row}{attributes[found.end() :]}"

    def _move_cell(self, attributes: str) -> str:
        found = _ADDRESS.search(attributes)
        if found is None:
            self.place = self.place[0], self.place[1] + 1
            return attributes
        self.place = self.place[0], column_number(found[2])
        return f"{attributes[: found.start()]}{found[1]}{self.moved_row}{attributes[found.end() :]}"

    def _take_shared(self, attributes: str, text: str) -> str:
        """Return the formula of a cell that shares it: the first cell holds it, the others are as filled in from it."""
        index = _INDEX.search(attributes)
        if index is None:
            raise NotMovedError(fill("a shared formula has no number"))
        if text:
            self.shared[index[1]] = *self.place, unescape(text)
            return unescape(text)
        if index[1] not in self.shared:
            raise NotMovedError(fill("a shared formula is not there"))
        row, column, formula = self.shared[index[1]]
        return translate_formula(formula, self.place[0] - row, self.place[1] - column)

    def _put_new_rows(self) -> None:
        self.out.append(self.new_rows)
        self.new_rows = ""

    def _copy_rows(self, text: str, shift: RowShift) -> str:
        """Return the XML of the new rows: styles and formulas of the row that they are like."""
        reader = PartShift(self.sheet, True, RowShift(SHEET_ROWS, 0))
        begin = re.search(r"<(?:\w+:)?sheetData[\s>]", text)
        number = rf"(?=[^<>]*\sr\s*=\s*[\"']{shift.like}[\"'])"
        source = re.search(rf"<((?:\w+:)?)row({number}[^<>]*?)(?:/>|>.*?</\1row>)", text, re.DOTALL)
        if begin is None or source is None:
            return ""
        prefix, own = source[1], _OWN.sub("", source[2])
        cells: list[tuple[str, str, str]] = []
        for tag, attributes, closed, after in re.findall(
            r"<(?:\w+:)?(row|c|f)((?:\s[^<>]*?)?)(/?)>([^<]*)", text[begin.start() : source.end()]
        ):
            if tag == "row":
                reader._move_row(attributes, RowShift(SHEET_ROWS, 0))
            elif tag == "c":
                reader._move_cell(attributes)
                if reader.place[0] == shift.like:
                    found = _STYLE.search(attributes)
                    cells.append((column_letters(reader.place[1] - 1), found[0] if found else "", ""))
            elif (is_shared := bool(_SHARED.search(attributes))) or "t=" not in attributes:
                own_text = "" if closed else after
                formula = reader._take_shared(attributes, own_text) if is_shared else unescape(own_text)
                if reader.place[0] == shift.like and cells and formula:
                    cells[-1] = (*cells[-1][:2], shift_formula(formula, self.sheet, True, shift))
        here, rows = shift.row(shift.like) or 0, []
        for new in range(shift.at, shift.at + shift.count):
            made = []
            for letters, style, formula in cells:
                written = escape(translate_formula(formula, new - here), quote=False)
                content = f"><{prefix}f>{written}</{prefix}f></{prefix}c>" if formula else "/>"
                made.append(f'<{prefix}c r="{letters}{new}"{style}{content}')
            rows.append(f'<{prefix}row r="{new}"{own}>{"".join(made)}</{prefix}row>')
        return "".join(rows)

    # ------------------------------------------------------------ all else

    def _attributes(self, name: str, attributes: str) -> str | None:
        """Return the attributes of an element, None if it goes with its cells."""
        wanted = self.areas.get(name, ()) if self.is_own else ()
        if name == "worksheetSource" and self.shift and f'sheet="{escape(self.sheet)}"' in attributes:
            wanted = ("ref",)
        is_break = self.is_own and isinstance(self.shift, RowShift) and name == "brk" and self._is_in("rowBreaks")
        is_gone = False

        def change(found: re.Match[str]) -> str:
            nonlocal is_gone
            key, value = found[2], unescape(found[4][1:-1])
            moved: str | None = value
            if key in wanted:
                moved = move_areas(value, self.move)
                if self.shift is None and name == "dataValidation" and self._overlaps(value, moved or ""):
                    moved = value
            elif is_break and key == "id" and value.isdigit():
                area = self.move.area((1, 1, int(value), int(value)))
                moved = str(area[2]) if area else None
            elif self.shift and (key in _FORMULAS or (name == "hyperlink" and key == "location")):
                moved = shift_formula(value, self.sheet, False, self.move)
            if moved is None:
                if name not in _GO | _VIEWS:
                    raise NotMovedError(fill("it refers to rows that are deleted"))
                is_gone, moved = is_gone or name in _GO, "A1"
            quote = found[4][0]
            text = escape(moved, quote=False).replace(quote, "&quot;" if quote == '"' else "&apos;")
            return found[0] if moved == value else f"{found[1]}{key}{found[3]}{quote}{text}{quote}"

        changed = _ATTRIBUTE.sub(change, attributes)
        return None if is_gone else changed

    def _overlaps(self, before: str, after: str) -> bool:
        """Tell whether a validation that grows reaches into another one."""
        own = [split_range(one) for one in before.split()]
        others = [one for one in self.taken if one not in own]
        grown = [area for one in after.split() if (area := split_range(one))]
        return any(
            left <= right2 and left2 <= right and top <= bottom2 and top2 <= bottom
            for left, right, top, bottom in grown
            for left2, right2, top2, bottom2 in others
        )

    def _is_in(self, name: str) -> bool:
        return bool(self.open) and self.open[-1][0].rpartition(":")[2] == name

    def _text(self, name: str, attributes: str, text: str) -> str | None:
        """Return the text of an element; None if what it is about goes."""
        if name == "sqref" and self.is_own:
            is_moved = self.shift is not None or not any(one.endswith("sparkline") for one, _ in self.open)
            return move_areas(unescape(text), self.move) if is_moved else text
        if name not in _FORMULAS:
            return text
        if self.shift is None and not (
            name == "definedName" and re.search("_xlnm.(Print_Area|_FilterDatabase)", attributes)
        ):
            return text
        if name == "f" and self.is_own and self.moved_row:
            return self._move_own(text)
        formula = unescape(text)
        moved = shift_formula(formula, self.sheet, self.is_own and name != "definedName", self.move)
        return text if moved == formula else escape(moved, quote=False)

    def _move_own(self, text: str) -> str:
        """Return the formula of the cell that is read, moved.

        Most formulas of a column are alike but for the number of their own row: such a one is taken apart once.
        """
        row, column = self.place
        known = self.columns.get(column)
        if known is None or str(row).join(known[0]) != text:
            known = self.columns[column] = self._take_apart(unescape(text), row)
        if known[1]:
            return str(self.moved_row).join(known[1])
        return escape(shift_formula(unescape(text), self.sheet, True, self.move), quote=False)

    def _take_apart(self, formula: str, row: int) -> tuple[list[str], list[str]]:
        """Return what stands between the numbers of its own row in a formula, before and after the shift.

        Nothing after it where the formula refers to other rows without $: these move in their own way.
        """
        before, after, end = [""], [""], 0
        for found in _REFERENCE.finditer(formula):
            between, token, end = formula[end : found.start()], found[0], found.end()
            name, *ends = found.groups()
            parts = [part for one in ends if one and (part := _PARTS.fullmatch(one))]
            relative = [part for part in parts if part[2] and not part[3]]
            if name is not None or not relative:
                before[-1] += between + token
                after[-1] += between + shift_formula(token, self.sheet, True, self.move)
                if name is not None and relative:
                    return before, []
            elif len(relative) < len(parts) or any(part[4] != str(row) for part in relative):
                return before, []
            else:
                texts = [between + parts[0][1] + parts[0][2], *(f":{part[1]}{part[2]}" for part in parts[1:])]
                for one in texts:
                    before[-1] += one
                    after[-1] += one
                    before.append("")
                    after.append("")
        before[-1] += formula[end:]
        after[-1] += formula[end:]
        return [escape(one, quote=False) for one in before], [escape(one, quote=False) for one in after]


_ROWS = re.compile(r"(<((?:\w+:)?)sheetData(?:\s[^<>]*)?>)(.*)(</\2sheetData>)", re.DOTALL)
_ONE_ROW = re.compile(r"<((?:\w+:)?)row(?=[\s/>])[^<>]*?(?:/>|>.*?</\1row>)\s*", re.DOTALL)


def _sort_rows(text: str) -> str:
    """Return the rows of a sheet by their numbers."""
    rows = [(int(number[2]), found[0]) for found in _ONE_ROW.finditer(text) if (number := _ROW.search(found[0]))]
    if sum(len(row) for _, row in rows) != len(text.lstrip()):
        raise NotMovedError(fill("a tag cannot be found in it"))
    return "".join(row for _, row in sorted(rows, key=lambda one: one[0]))


_SHAPE = re.compile(r"<v:shape\b.*?</v:shape>", re.DOTALL)
_SHAPE_ROW = re.compile(r"(<x:Row>\s*)([0-9]+)")
_ANCHOR = re.compile(r"(<x:Anchor>)([^<]*)")


def shift_shapes(data: bytes, move: Shift) -> bytes:
    """Return the old drawing of a sheet, with the boxes of its comments, after a shift of rows."""

    def follow(found: re.Match[str]) -> str:
        shape = found[0]
        row = _SHAPE_ROW.search(shape)
        if row is not None:
            moved = move.row(int(row[2]) + 1)
            if moved is None:
                return ""
            shape = f"{shape[: row.start()]}{row[1]}{moved - 1}{shape[row.end() :]}"
        return _ANCHOR.sub(anchor, shape) if isinstance(move, RowShift) else shape

    def anchor(found: re.Match[str]) -> str:
        numbers = found[2].split(",")
        if len(numbers) == 8 and all(one.strip().isdigit() for one in numbers):
            for at in (2, 6):
                numbers[at] = f" {_move_edge(int(numbers[at]), move)}"
        return found[1] + ",".join(numbers)

    return _SHAPE.sub(follow, data.decode()).encode()


_DRAWN_ROW = re.compile(r"(<(?:\w+:)?row>)([0-9]+)(?=</)")


def shift_drawing(data: bytes, move: Shift) -> bytes:
    """Return a drawing whose pictures and charts stay at their cells; where rows only change places, as they are."""
    if isinstance(move, RowMove):
        return data
    return _DRAWN_ROW.sub(lambda found: f"{found[1]}{_move_edge(int(found[2]), move)}", data.decode()).encode()


def _move_edge(row: int, move: Shift) -> int:
    """Return where the row of an edge comes to lie, from 0; that of a deleted row goes to the next one."""
    moved = move.row(row + 1)
    return (move.at if moved is None else moved) - 1
