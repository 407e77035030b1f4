"""What else of a workbook has to follow when cells change: the order of calculation, and the call to recalculate."""

import posixpath
from collections.abc import Collection, Mapping, Sequence

from assess.workbook.open import RELATIONS, TYPES, WORKBOOK, Book, Tree
from assess.workbook.places import Edit, SmallPart, add_attribute, apply_edits, drop_attributes, split_range

_BEFORE_CALCULATION = frozenset({
    "fileVersion", "fileSharing", "workbookPr", "workbookProtection", "bookViews", "sheets", "functionGroups",
    "externalReferences", "definedNames",
})  # fmt: skip
"""What stands before calcPr in a workbook (ECMA-376 Part 1, 18.2.27)."""


def set_recalculation(book: Book) -> dict[str, bytes]:
    """Return the workbook's own part if it has to change so that programs recalculate every formula on opening it."""
    part = book.read(SmallPart, WORKBOOK)
    named = next(part.named("calcPr"), None)
    if named is not None:
        if named.attributes.get("fullCalcOnLoad") in ("1", "true"):
            return {}
        tag = drop_attributes(part.data[named.start : named.head], (b"fullCalcOnLoad",))
        edit = (named.start, named.head, add_attribute(tag, b'fullCalcOnLoad="1"'))
        return {WORKBOOK: apply_edits(part.data, [edit])}
    root = part.elements[-1]
    prefix, colon, _ = root.name.rpartition(":")
    before = [
        one.end
        for one in part.elements
        if one.parent == root.name and one.name.rpartition(":")[2] in _BEFORE_CALCULATION
    ]
    at = max(before, default=root.head)
    return {WORKBOOK: apply_edits(part.data, [(at, at, f'<{prefix}{colon}calcPr fullCalcOnLoad="1"/>'.encode())])}


def drop_from_chain(book: Book, formulas: Sequence[tuple[str, str]]) -> dict[str, bytes | None]:
    """Return the parts that change when cells lose their formulas: the calculation chain loses their entries.

    A chain with an entry for a cell without a formula makes Excel repair the file. One that would be empty is left
    out, with what refers to it. An entry without a sheet is on the sheet of the one before it.
    """
    path = book.parts.get("calcChain")
    if path is None or not formulas:
        return {}
    part = book.read(SmallPart, path)
    gone = {(book.sheet_ids[sheet], address) for sheet, address in formulas}
    edits, kept = _edit_chain(part, gone)
    if kept:
        return {path: apply_edits(part.data, edits)} if edits else {}
    return {path: None, **_drop_references(book, path)}


def _edit_chain(part: SmallPart, gone: Collection[tuple[str, str]]) -> tuple[list[Edit], int]:
    edits: list[Edit] = []
    sheet = written = "0"
    kept = 0
    for one in part.named("c"):
        sheet = one.attributes.get("i", sheet)
        if (sheet, one.attributes.get("r", "")) in gone:
            edits.append((one.start, one.end, b""))
            continue
        kept += 1
        if "i" not in one.attributes and sheet != written:
            tag = part.data[one.start : one.head]
            edits.append((one.start, one.head, add_attribute(tag, f'i="{sheet}"'.encode())))
        written = sheet
    return edits, kept


def _drop_references(book: Book, path: str) -> Mapping[str, bytes]:
    changed = {}
    for name, tag, attribute in ((TYPES, "Override", "PartName"), (RELATIONS, "Relationship", "Target")):
        part = book.read(SmallPart, name)
        found = [one for one in part.named(tag) if book.find_part("xl", one.attributes.get(attribute, "")) == path]
        if found:
            changed[name] = apply_edits(part.data, [(one.start, one.end, b"") for one in found])
    return changed


def find_headings(book: Book, path: str) -> list[tuple[int, int, int]]:
    """Return first and last column and the row of the headers of each table of a sheet.

    A table keeps a copy of its headers; where they differ, Excel repairs the file.
    """
    return [span[:3] for span, table in _list_tables(book, path) if table.get("headerRowCount", "1") != "0"]


def find_totals(data: bytes, sheet: str, name: str) -> list[int]:
    """Return the rows of a sheet that are totals rows of tables; WorkbookError if the workbook cannot be opened."""
    with Book(data, name) as book:
        tables = _list_tables(book, book.sheets[sheet]) if sheet in book.sheets else []
    return [
        row
        for (_, _, _, bottom), table in tables
        if (count := table.get("totalsRowCount", "0")).isdigit()
        for row in range(bottom - int(count) + 1, bottom + 1)
    ]


def _list_tables(book: Book, path: str) -> list[tuple[tuple[int, int, int, int], Mapping[str, str]]]:
    """Return the area of each table of a sheet, and its attributes."""
    folder, name = posixpath.split(path)
    relations = book.find_part(folder, f"_rels/{name}.rels")
    if relations is None:
        return []
    found: list[tuple[tuple[int, int, int, int], Mapping[str, str]]] = []
    for one in book.read(Tree, relations).find("Relationship"):
        target = book.find_part(folder, one.get("Target", ""))
        if one.get("Type", "").endswith("/table") and target is not None:
            for table in book.read(Tree, target).find("table"):
                span = split_range(table.get("ref", ""))
                if span is not None:
                    found.append((span, table))
    return found
