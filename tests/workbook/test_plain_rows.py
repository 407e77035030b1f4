"""Rows that are cut out before the XML parser: each sheet reads as it does through the parser alone."""

import random
from pathlib import Path
from typing import Any

import pytest

from assess.errors import WorkbookError
from assess.workbook.open import UNSAVED, Book, read_file
from assess.workbook.plain_rows import RowCutter
from assess.workbook.read import open_workbook
from tests.conftest import EXAMPLE
from tests.workbook.books import change_parts, read_part, write
from tests.workbook.raw import MAIN, SHEET

PREPARED = (
    '<c r="B{n}" s="9"><f>IF($A{n}="","",$C{n}&amp;"■")</f><v></v></c><c r="AA{n}"><f>$H{n}&gt;=0.7</f><v></v></c>'
)
FEW = tuple(range(2, 12))


def body(*rows: str) -> bytes:
    return f'<worksheet xmlns="{MAIN}"><sheetData>{"".join(rows)}</sheetData></worksheet>'.encode()


def prepared(*numbers: int) -> str:
    return "".join(f'<row r="{n}" spans="1:38">{PREPARED.format(n=n)}</row>' for n in numbers)


def look(data: bytes) -> Any:
    found: list[Any] = []
    try:
        with Book(data, "book.xlsx") as book:
            for name in book.sheets:
                cells = book.cells(name)
                found += [name, [*cells.rows()], cells.last_row, cells.far, cells.merged, cells.hidden_rows]
        found += [open_workbook(data, "book.xlsx")]
    except WorkbookError as error:
        found.append(str(error))
    return found


def parse_alone(monkeypatch: pytest.MonkeyPatch, data: bytes) -> Any:
    with monkeypatch.context() as patch:
        patch.setattr(RowCutter, "cut", lambda self, piece: piece)
        patch.setattr(RowCutter, "finish", lambda self: b"")
        return look(data)


@pytest.fixture
def compare(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Return a function that reads a sheet of this XML, having compared it with the parser alone."""

    def check(xml: bytes) -> Any:
        data = change_parts(write(tmp_path), {SHEET: xml}).read_bytes()
        found = look(data)
        assert found == parse_alone(monkeypatch, data)
        return found

    return check


def test_prepared_rows_are_not_parsed_and_nothing_is_lost(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Or else the rest of this file would compare the parser with itself."""
    cut: list[str] = []
    take = RowCutter._take

    def note(self: RowCutter, row: Any) -> Any:
        cut.append(row[2])
        return take(self, row)

    monkeypatch.setattr(RowCutter, "_take", note)
    look(change_parts(write(tmp_path), {SHEET: body(prepared(*FEW))}).read_bytes())
    assert cut == [str(n) for n in FEW] * 2  # once for each way to read
    data = read_file(EXAMPLE)
    assert look(data) == parse_alone(monkeypatch, data)


@pytest.mark.parametrize("is_first", [True, False])
def test_a_value_hidden_in_a_prepared_row_is_read(compare, is_first: bool) -> None:
    hidden = {
        "number": ('<c r="H5"><v>12.5</v></c>', 7, 12.5),
        "text": ('<c r="H5" t="str"><f>"a"</f><v>Hall</v></c>', 7, "Hall"),
        "inline text": ('<c r="H5" t="inlineStr"><is><t>Hall</t></is></c>', 7, "Hall"),
        "CDATA": ('<c r="H5" t="inlineStr"><is><t><![CDATA[<b>]]></t></is></c>', 7, "<b>"),
        "entity": ('<c r="H5" t="str"><v>A&amp;B&#65;</v></c>', 7, "A&BA"),
        "truth": ('<c r="H5" t="b"><v>1</v></c>', 7, True),
        "single quotes": ("<c r='H5'><v>3</v></c>", 7, 3),
        "other order": ('<c s="1" t="n" r="H5"><v>3</v></c>', 7, 3),
        "no address": ("<c/><c><v>4</v></c>", 28, 4),
        "prefix": (f'<x:c xmlns:x="{MAIN}" r="H5"><x:v>3</x:v></x:c>', 7, 3),
        "shared formula": ('<c r="H5"><f t="shared" ref="H5:H9" si="0">A1</f><v>3</v></c>', 7, 3),
        "unsaved formula": ('<c r="H5"><f>A1</f></c>', 7, UNSAVED),
        "unsaved shared formula": ('<c r="H5"><f t="shared" si="0"/><v></v></c>', 7, UNSAVED),
        "spaces": ('<c r="H5" >\n<f>A1</f>\n<v>3</v>\r\n</c>', 7, 3),
    }
    own = PREPARED.format(n=5)
    for name, (cell, at, value) in hidden.items():
        row = f'<row r="5">{cell + own if is_first and name != "no address" else own + cell}</row>'
        _, rows, last_row, *_ = compare(body(prepared(2, 3, 4), row, prepared(6, 7)))
        assert dict(rows)[5][at] == value, name
        assert dict(rows)[5][1] is UNSAVED
        assert last_row == 7


SAME = {
    "cells out of order": body('<row r="2"><c r="C2"><v>1</v></c><c r="A2"><v>2</v></c></row>', prepared(3)),
    "a cell twice": body('<row r="2"><c r="C2"><v>1</v></c><c r="C2"><v>2</v></c><c r="C2"/></row>'),
    "a blank over a formula": body('<row r="2"><c r="C2"><f>1</f><v></v></c><c r="C2" s="3"/></row>'),
    "blanks": body('<row r="2" hidden="1"><c r="C2" s="1"/><c r="D2" s="1"/></row>', "<row><c/></row>"),
    "rows without number": body("<row><c><v>1</v></c></row>", prepared(2), "<row><c><v>1</v></c></row>"),
    "an address of another row": body('<row r="2"><c r="C9"><v>1</v></c></row>'),
    "far columns": body('<row r="2"><c r="IV2"><f>1</f><v></v></c><c r="IW2"><f>1</f><v></v></c></row>', prepared(3)),
    "very far columns": body('<row r="2"><c r="ZZ2"><v>1</v></c><c r="XFE2"><v>1</v></c></row>'),
    "comments": body(prepared(2), f"<!-- {prepared(3)} -->", prepared(4)),
    "a comment in a row": body(f'<row r="2">{PREPARED.format(n=2)}<!-- x --></row>', prepared(3)),
    "processing instructions": body(prepared(2), f"<?x {prepared(3)} ?>", prepared(4)),
    "CDATA with a row": body(f'<row r="1"><c r="A1" t="inlineStr"><is><t><![CDATA[{prepared(2)}]]></t></is></c></row>'),
    "a row in a cell": body(f'<row r="1"><c r="A1" t="str"><v>a</v>{prepared(2)}<v>b</v></c></row>', prepared(3)),
    "a row in an attribute": body(f"<row r='1' a='{prepared(2)}'></row>"),
    "an entity of its own": b'<!DOCTYPE w [<!ENTITY e "1">]>' + body('<row r="2"><c r="A2"><f>&e;</f><v></v></c></row>'),
    "an unknown entity": body('<row r="2"><c r="A2"><f>&e;</f><v></v></c></row>'),
    "a bare ampersand": body('<row r="2"><c r="A2"><f>A & B</f><v></v></c></row>'),
    "the end of CDATA": body('<row r="2"><c r="A2"><f>]]&gt; ]]></f><v></v></c></row>'),
    "a control character": body('<row r="2"><c r="A2"><f>\x01</f><v></v></c></row>'),
    "no character": body('<row r="2"><c r="A2"><f>\uffff</f><v></v></c></row>'),
    "no UTF-8": body('<row r="2"><c r="A2"><f>?</f><v></v></c></row>').replace(b"?", b"\xff"),
    "Latin-1": b'<?xml version="1.0" encoding="ISO-8859-1"?>'
    + body('<row r="2"><c r="A2" t="str"><v>?</v></c></row>').replace(b"?", b"\xe9"),
    "Latin-1, spelt at length": b'<?xml version="1.0"  encoding\t=\n"ISO-8859-1" ?>'
    + body('<row r="2"><c r="A2" t="str"><v>?</v></c></row>').replace(b"?", b"\xe9"),
    "zeros before a number": body('<row r="02"><c r="A02"><v>1</v></c></row>', '<row r="0003"><c r="A3"><v>1</v></c></row>'),
    "a declaration": b'\xef\xbb\xbf<?xml version="1.0" encoding="utf-8"?>' + body(prepared(2, 3)),
    "US-ASCII": b"<?xml version='1.0' encoding='us-ascii'?>" + body(prepared(2, 3)),
    "UTF-16": body(prepared(2)).decode().encode("utf-16"),
    "rows out of order": body(prepared(5, 4)),
    "a row twice": body(prepared(4, 4)),
    "a row too far": body(prepared(2, 1048577)),
    "a bad number": body('<row r="2"><c r="A2"><v>1x</v></c></row>', prepared(3)),
    "a bad index": body('<row r="2"><c r="A2" t="s"><v>99999</v></c></row>'),
    "a bad number before bad XML": body('<row r="2"><c r="A2"><v>1x</v></c></row>', "<row r=2>"),
    "bad XML before a bad number": body("<row r=2>", '<row r="2"><c r="A2"><v>1x</v></c></row>'),
    "an attribute twice": body('<row r="2" r="2"><c r="A2"><v>1</v></c></row>'),
    "closed wrongly": body('<row r="2"><c r="A2"><v>1</v></row></c>'),
    "closed at once": body('<row r="2"/>', prepared(3), '<row r="4"/>'),
    "not closed": body(prepared(2, 3)).removesuffix(b"</worksheet>"),
    "a new line": body('<row r="2"><c r="A2" t="str"><v>a\r\nb</v></c><c r="B2" t="str"><v>_x000D_ _x005F_x</v></c></row>'),
    "nothing": b"",
}  # fmt: skip


@pytest.mark.slow
def test_it_reads_as_through_the_parser_whatever_the_damage(compare, tmp_path: Path) -> None:
    for name, xml in SAME.items():
        assert compare(xml), name
    assert compare(
        body(prepared(2, 3)).replace(b"<", b"<x:").replace(b"<x:/", b"</x:").replace(b"xmlns=", b"xmlns:x=")
    )[1]
    compare(read_part(write(tmp_path), SHEET).encode())
    # Cut off, or with a byte changed: the same values, or the same error.
    draw = random.Random(1)
    whole = body('<row r="1"><c r="A1" t="s"><v>0</v></c><c r="B1"><v>1</v></c></row>', prepared(2, 3, 4))
    signs = b'<>/"&;= \x00\x80\xc3Ac1!?]-'
    for _ in range(40):
        at = draw.randrange(len(whole))
        compare(whole[:at])
        compare(whole[:at] + bytes([draw.choice(signs)]) + whole[at + 1 :])


def test_a_sheet_in_many_pieces_is_read_and_a_row_of_over_2_mb_refused(compare, tmp_path: Path) -> None:
    """A sheet of a megabyte comes in pieces, each of which ends in the middle of something."""
    rows = [
        f'<row r="{n}"><c r="A{n}" t="str"><v>{"■" * (n % 97)}</v></c>{PREPARED.format(n=n)}</row>'
        for n in range(1, 4000)
    ]
    _, found, last_row, *_ = compare(body(*rows))
    assert (len(found), last_row) == (3999, 3999)
    assert found[95][1][0] == "■" * 96
    draw = random.Random(1)
    cells = (f'<c r="B2"><f>{draw.randbytes(100).hex()}</f><v></v></c>' for _ in range(12_000))
    row = f'<row r="2">{"".join(cells)}</row>'
    assert "holds a row of over 2 MB" in compare(body(prepared(1), row, prepared(3)))[-1]
