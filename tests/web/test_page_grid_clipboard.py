"""Blocks of cells by the real clipboard: from Excel, LibreOffice and Google Sheets, and back."""

import pytest
from playwright.sync_api import expect

from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PASTED = """([kind]) => new Promise((done) => document.addEventListener("paste",
    (event) => done(event.clipboardData.getData(kind)), { once: true, capture: true }))"""
FROM_CALC = """<html><head><meta http-equiv="content-type" content="text/html; charset=utf-8"/><style type="text/css">
    body,div,table{ font-family:"Liberation Sans"; font-size:x-small }
    a.comment-indicator:hover + comment { display:block }
</style></head><body><table cellspacing="0" border="0"><colgroup width="85"></colgroup>
<tr><td height="17" align="left" style="border: 1px">First<br>second</td>
<td align="right" sdval="45.123456" sdnum="1040;">45,12</td></tr>
<tr><td height="17" align="left">12&quot; shelf</td><td align="right" sdval="1200.5" sdnum="1040;">1.200,50</td></tr>
</table></body></html>"""
FROM_EXCEL = """<html xmlns:x="urn:schemas-microsoft-com:office:excel"><head>
<style><!-- .xl65 {mso-number-format:"0\\.0";} --></style>
</head><body><table border=0 cellpadding=0><!--StartFragment--><col width=64>
<tr height=20 style='height:15.0pt'><td height=20 class=xl65 width=64 style='width:48pt'>Bookcase at
  the door</td><td class=xl65 align=right x:num="38.25">38,3</td></tr>
<tr><td colspan=2>joined</td></tr><!--EndFragment--></table></body></html>"""
FROM_SHEETS = """<meta charset='utf-8'><google-sheets-html-origin><table><tbody><tr>
<td data-sheets-value='{"1":2,"2":"Desk"}'>Desk</td>
<td data-sheets-value='{"1":3,"3":62.5}'>63</td></tr></tbody></table>"""


def test_a_thousand_rows_are_one_edit_and_one_step_back(small):
    before = small.server.client.get("/api/download").data
    block = [
        [f"N{n}", "", "1", f"Room {n % 40}", "Shelf", "", "", "40,5", "80", str(150 + n % 60)] for n in range(1000)
    ]
    small.copy_text("\r\n".join("\t".join(row) for row in block) + "\r\n").select("Item", 8)
    small.type("<Control+v>")
    expect(small.page.locator(".grid-frame")).to_be_visible()
    small.settle()
    names = small.values("Items", "item")
    assert [names[row] for row in (8, 9, 1007)] == ["N0", "N1", "N999"]
    assert small.values("Items", "breadth")[500] == 40.5
    assert small.values("Items", "height")[1007] == 150 + 999 % 60
    assert small.page.evaluate("async () => (await import('/store.mjs')).store.live.size") == 1000 + len(ITEMS)
    small.type("<Control+z>").settle()
    assert list(small.values("Items", "item")) == list(range(2, 2 + len(ITEMS)))
    assert small.server.client.get("/api/download").data == before
    small.type("<Control+y>").settle()
    assert small.values("Items", "item") == names


def test_tables_of_other_programs(small):
    text = '"First\nsecond"\t45,12\n12" shelf\t1.200,50\n'
    small.copy_text(text, FROM_CALC).select("Description", 2)
    small.type("<Control+v>")  # Description, Type
    small.copy_text("45,12\t1200,5", None).select("Breadth", 3).type("<Control+v>")
    small.copy_text("Bookcase at the door\t38,3\njoined\t\n", FROM_EXCEL).select("Type", 5).type("<Control+v>")
    small.copy_text("Desk\t63", FROM_SHEETS).select("Photo", 4).type("<Control+v>")
    small.settle()
    assert [small.values("Items", "description")[row] for row in (2, 3)] == ["First\nsecond", '12" shelf']
    assert [small.cells("Items", row)[5] for row in (2, 3)] == [45.123456, 1200.5]
    assert small.values("Items", "breadth")[3] == 45.12
    assert small.values("Items", "width")[3] == 1200.5
    assert small.values("Items", "type")[5] == "Bookcase at the door"
    assert small.values("Items", "quantity")[5] == 38.25
    assert small.values("Items", "type")[6] == "joined"
    assert small.values("Items", "photo")[4] == "Desk"
    assert small.values("Items", "source_id")[4] == 62.5


def test_what_is_copied_can_be_pasted_elsewhere_and_back(small):
    small.select("Room", 3).type("Tab there", "<Alt+Enter>", '"so"', "<Enter>")
    small.select("Item", 2, "Description", 3).type("<Control+c>")
    other = small.page.context.new_page()
    other.set_content("<textarea autofocus></textarea>")
    for kind in ("text/plain", "text/html"):
        other.evaluate(f"() => (window.got = ({PASTED})(['{kind}'])) && null")
        other.locator("textarea").press("Control+v")
        got = other.evaluate("() => window.got")
        if kind == "text/plain":
            assert got.replace("\r", "").split("\n")[0].split("\t")[0] == "A1"
            assert '"Tab there\n""so"""' in got.replace("\r", "")
        else:
            assert "mso-number-format" in got
            assert got.count("<tr") == 2
    other.close()
    small.page.bring_to_front()
    small.select("Item", 7).type("<Control+v>").settle()
    assert small.values("Items", "room")[8] == small.values("Items", "room")[3]
    assert small.cells("Items", 7)[:5] == ["A1", None, "1", "Hall", "Bookcase"]


def test_what_is_pasted_fills_a_multiple_leaves_computed_cells_moves_what_was_cut_and_joins_a_text(small):
    small.copy_text("40\t80").select("Breadth", 2, "Width", 5).type("<Control+v>").settle()
    assert [small.cells("Items", row)[7:9] for row in range(2, 7)] == [[40, 80]] * 4 + [[None, None]]
    small.copy_text("Z\tcomputed\t2").select("Item", 7).type("<Control+v>").settle()
    assert small.cells("Items", 7)[:3] == ["Z", None, "2"]
    small.select("Room", 2, "Description", 2).type("<Control+x>").settle()
    assert small.cells("Items", 2)[3:5] == [None, None]
    small.select("Room", 6).type("<Control+v>").settle()
    assert small.cells("Items", 6)[3:5] == ["Hall", "Bookcase"]
    small.type("<Control+z>", "<Control+z>").settle()
    assert small.cells("Items", 2)[3:5] == ["Hall", "Bookcase"]
    small.copy_text("of oak").select("Description", 2).type("<F2>", " ", "<Control+v>", "<Enter>").settle()
    assert small.values("Items", "description")[2] == "Bookcase of oak"
