"""A workbook with what only spreadsheet programs know, edited: all of it stays, and LibreOffice shows the same."""

import io
import re
import shutil
import zipfile
from pathlib import Path

import pytest
from openpyxl import load_workbook

from assess.pipeline.live_values import with_live
from assess.web.book import Book
from assess.workbook import template
from assess.workbook.layout import LETTERS, PLACES
from assess.workbook.schema import LIVE
from assess.workbook.template import Content, write_workbook
from assess.workbook.writer import write_book
from tests.pictures import picture
from tests.recalculate import libreoffice, needs_libreoffice, stored_cells
from tests.workbook.books import change_parts, replace
from tests.workbooks import FLOORS, ITEMS

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
LINKS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
ROWS = {"Building": [{"building": "Hall", "ground_pga": 0.2, "period": 0.8}], "Floors": FLOORS, "Items": ITEMS}


def add_own(book):
    """What a user adds: a chart, a picture, a comment, a table, formulas, a rich text, a sheet."""
    items, mine = book.get_worksheet_by_name("Items"), book.add_worksheet("Mine")
    items.write_row(0, 60, ["Owner", "Twice"])
    for row in range(1, 6):
        items.write(row, 60, f"Person {row}")
        items.write_formula(row, 61, f"=2*{LETTERS['Items', 'height']}{row + 1}", None, 1.0)
    items.write_comment("A3", "Look at this one")
    items.insert_image("BM2", "own.png", {"image_data": io.BytesIO(picture("PNG"))})
    chart = book.add_chart({"type": "column"})
    chart.add_series({"values": f"=Items!${LETTERS['Items', 'height']}$2:${LETTERS['Items', 'height']}$6"})
    mine.insert_chart("J2", chart)
    mine.write_row(0, 0, ["Floor", "Pieces"])
    for row, line in enumerate([["1", 2], ["2", 3], ["1", 4]], 1):
        mine.write_row(row, 0, line)
    mine.write_rich_string("A8", "Rich ", book.add_format({"bold": True}), "text")
    mine.add_table("A20:B22", {"columns": [{"header": "x"}, {"header": "y"}], "data": [[1, 2], [3, 4]]})
    mine.write_formula("D1", f"=SUM(Items!{LETTERS['Items', 'height']}2:{LETTERS['Items', 'height']}6)", None, 5)


def add_pivot(path):
    """Add a pivot table of the cells A1:B4 of the last sheet, as Excel keeps it, with its cache."""
    field = '<sharedItems count="2"><s v="1"/><s v="2"/></sharedItems>'
    cache = (
        f'<pivotCacheDefinition xmlns="{MAIN}" xmlns:r="{LINKS}" r:id="rId1" refreshedBy="Ann" createdVersion="3" '
        'refreshedVersion="3" recordCount="3"><cacheSource type="worksheet"><worksheetSource ref="A1:B4" sheet="Mine"/>'
        f'</cacheSource><cacheFields count="2"><cacheField name="Floor" numFmtId="0">{field}</cacheField><cacheField '
        'name="Pieces" numFmtId="0"><sharedItems containsSemiMixedTypes="0" containsString="0" containsNumber="1" '
        'containsInteger="1" minValue="2" maxValue="4"/></cacheField></cacheFields></pivotCacheDefinition>'
    )
    records = (
        f'<pivotCacheRecords xmlns="{MAIN}" count="3"><r><x v="0"/><n v="2"/></r><r><x v="1"/><n v="3"/></r>'
        '<r><x v="0"/><n v="4"/></r></pivotCacheRecords>'
    )
    table = (
        f'<pivotTableDefinition xmlns="{MAIN}" name="Pivot" cacheId="1" dataCaption="Values" createdVersion="3" '
        'updatedVersion="3"><location ref="F1:G4" firstHeaderRow="1" firstDataRow="1" firstDataCol="1"/><pivotFields '
        'count="2"><pivotField axis="axisRow" showAll="0"><items count="3"><item x="0"/><item x="1"/>'
        '<item t="default"/></items></pivotField><pivotField dataField="1" showAll="0"/></pivotFields>'
        '<rowFields count="1"><field x="0"/>'
        '</rowFields><rowItems count="3"><i><x/></i><i><x v="1"/></i><i t="grand"><x/></i></rowItems>'
        '<colItems count="1"><i/></colItems>'
        '<dataFields count="1"><dataField name="Sum" fld="1"/></dataFields></pivotTableDefinition>'
    )

    def links(target, kind):
        relation = f'<Relationship Id="rId1" Type="{LINKS}/{kind}" Target="{target}"/>'
        return f'<Relationships xmlns="{PACKAGE}">{relation}</Relationships>'.encode()

    with zipfile.ZipFile(path) as archive:
        sheets = [name for name in archive.namelist() if re.fullmatch(r"xl/worksheets/sheet\d+\.xml", name)]
    last = f"xl/worksheets/_rels/sheet{len(sheets)}.xml.rels"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml.pivot"
    types = "".join(
        f'<Override PartName="/xl/{part}.xml" ContentType="{kind}{name}+xml"/>'
        for part, name in (("pivotCache/pivotCacheDefinition1", "CacheDefinition"),
                           ("pivotCache/pivotCacheRecords1", "CacheRecords"), ("pivotTables/pivotTable1", "Table"))
    )  # fmt: skip
    caches = '<pivotCaches><pivotCache cacheId="1" r:id="rId77"/></pivotCaches>'
    relation = '<Relationship Id="rId77" Type="{}/{}" Target="{}"/></Relationships>'.format
    return change_parts(path, {
        "xl/pivotCache/pivotCacheDefinition1.xml": cache.encode(),
        "xl/pivotCache/pivotCacheRecords1.xml": records.encode(),
        "xl/pivotTables/pivotTable1.xml": table.encode(),
        "xl/pivotCache/_rels/pivotCacheDefinition1.xml.rels": links("pivotCacheRecords1.xml", "pivotCacheRecords"),
        "xl/pivotTables/_rels/pivotTable1.xml.rels": links(
            "../pivotCache/pivotCacheDefinition1.xml", "pivotCacheDefinition"),
        "[Content_Types].xml": replace("</Types>", f"{types}</Types>"),
        "xl/workbook.xml": replace("</workbook>", f"{caches}</workbook>"),
        "xl/_rels/workbook.xml.rels": replace("</Relationships>", relation(
            LINKS, "pivotCacheDefinition", "pivotCache/pivotCacheDefinition1.xml")),
        last: replace("</Relationships>", relation(LINKS, "pivotTable", "../pivotTables/pivotTable1.xml")),
    })  # fmt: skip


@pytest.fixture
def rich(tmp_path, monkeypatch):
    """A workbook of furniture with all of that in it, and a chain of calculation as Excel writes it."""
    write = write_book
    monkeypatch.setattr(
        template, "write_book", lambda path, fill: write(path, lambda book: (fill(book), add_own(book)))
    )
    write_workbook(tmp_path / "rich.xlsx", with_live(Content(ROWS)))
    path = add_pivot(tmp_path / "rich.xlsx")
    chain = f'<calcChain xmlns="{MAIN}"><c r="B2" i="4"/><c r="B3"/></calcChain>'
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml.calcChain+xml"
    link = f'<Relationship Id="rId99" Type="{LINKS}/calcChain" Target="calcChain.xml"/>'
    return change_parts(path, {
        "xl/calcChain.xml": chain.encode(),
        "[Content_Types].xml": replace(
            "</Types>", f'<Override PartName="/xl/calcChain.xml" ContentType="{kind}"/></Types>'),
        "xl/_rels/workbook.xml.rels": replace("</Relationships>", f"{link}</Relationships>"),
    })  # fmt: skip


def edit_all(book):
    height, name = PLACES["Items", "height"], PLACES["Items", "item"]
    book.edit(1, [["Items", 2, height, 150], ["Items", 4, name, "A3 renamed"], ["Items", 3, 60, "New owner"]], "x")
    added = {"item": "A6", "floor": "1", "breadth": 30, "height": 150, "anchored": "no"}
    book.edit(2, [["Items", 7, PLACES["Items", field], value] for field, value in added.items()], "x")


def parts_of(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_everything_of_the_user_stays(rich):
    before = parts_of(rich)
    assert {"xl/charts/chart1.xml", "xl/media/image1.png", "xl/pivotTables/pivotTable1.xml"} < {*before}
    book = Book.open_disk(rich)
    edit_all(book)
    book.save()
    after = parts_of(rich)
    assert list(before) == list(after)
    assert {name for name in before if before[name] != after[name]} == {"xl/worksheets/sheet4.xml"}


@needs_libreoffice
@pytest.mark.libreoffice
@pytest.mark.slow
def test_libreoffice_shows_the_same(rich, tmp_path):
    """Nothing but the edits and what follows from them differs; stored results are what LibreOffice computes."""
    before = stored_cells(libreoffice(rich, tmp_path / "before.xlsx"))
    book = Book.open_disk(rich)
    edit_all(book)
    book.edit(3, [["Floors", 3, PLACES["Floors", "pfa_x"], 0.8]], "x")
    book.save()
    as_users = stored_cells(libreoffice(rich, tmp_path / "users.xlsx", recalculates=False))
    after = stored_cells(libreoffice(rich, tmp_path / "after.xlsx"))
    live = {("Items", f"{LETTERS['Items', label]}{row}") for label in LIVE for row in range(2, 8)}
    assert live <= after.keys()
    for cell in live:
        stored, computed = as_users.get(cell), after.get(cell)
        assert stored == (computed if isinstance(computed, str) else pytest.approx(computed, rel=1e-6)), cell
    changed = {cell for cell in before.keys() | after.keys() if before.get(cell) != after.get(cell)}
    assert {("Items", "A4"), ("Items", "BI3"), ("Items", f"{LETTERS['Items', 'height']}2"), ("Mine", "D1")} <= changed
    assert {sheet for sheet, _ in changed} == {"Items", "Mine", "Floors", "Lists"}
    names = parts_of(tmp_path / "after.xlsx")
    assert any("pivotTable" in name for name in names)
    assert any("charts/chart" in name for name in names)
    assert any("media/" in name for name in names)


def test_undo_after_a_save_brings_rich_text_back(tmp_path):
    path = tmp_path / "own.xlsx"
    shutil.copy(Path(__file__).parents[1] / "nets" / "workbooks" / "1904.xlsx", path)
    before = path.read_bytes()
    book = Book.open_disk(path)
    book.edit(1, [["Items", 3, 3, "Plain"]], "x")
    book.save()
    assert load_workbook(path)["Items"].cell(3, 4).value == "Plain"
    book.undo(book.version)
    assert book.state()["unsaved"]
    book.save()
    assert path.read_bytes() == before
    assert not book.state()["unsaved"]
    book.redo(book.version)
    book.save()
    assert load_workbook(path)["Items"].cell(3, 4).value == "Plain"
