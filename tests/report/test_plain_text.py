"""Text of the workbook stays text in all outputs: never a formula, markup, a path or a hidden character."""

import csv
import json
import re
from html.parser import HTMLParser

import docx
import openpyxl
import pypdfium2
import pytest

import assess
from assess.report.pages.html import hash_script
from assess.workbook.schema import SHEETS
from tests.motion.writers import zipped
from tests.recalculate import evaluate
from tests.report.reading import no_figures
from tests.workbooks import parts_of, write_sheets

FORMULA = '=HYPERLINK("http://x","y")'
SCRIPT = "<script>alert(1)</script>"
PATH = "../../etc/passwd"
LONG = "long " * 6400
CONTROL = "bell\x07null\x00 end"
TURNED = "abc\u202edef\u200f"
HOSTILE = (FORMULA, SCRIPT, PATH, LONG, CONTROL, TURNED)

_TEXT = [
    column.name for column in SHEETS[2].columns if column.kind == "text" and not column.source and column.name != "item"
]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    """A workbook with a hostile text in every text column of every sheet, and all that is made of it."""
    folder = tmp_path_factory.mktemp("text")
    names = [f"{at} {text[:60]}" for at, text in enumerate(HOSTILE)]
    rows = {
        "Building": [{"building": FORMULA, "address": SCRIPT, "use": PATH, "prepared_by": CONTROL,
                      "organisation": TURNED, "scenario": SCRIPT + FORMULA}],
        "Floors": [{"floor": FORMULA, "name": SCRIPT, "pfa_x": 0.4}, {"floor": SCRIPT, "name": LONG, "pfa_y": 0.2}],
        "Catalogue": [{"type": FORMULA, "source": SCRIPT, "breadth": 40, "height": 180},
                      {"type": SCRIPT, "source": FORMULA, "breadth": 40, "height": 180}],
        "Places": [{"place": name, "floor": FORMULA, "x": at, "y": 2} for at, name in enumerate((FORMULA, SCRIPT))],
        "Routes": [{"route": FORMULA, "segment": SCRIPT, "floor": FORMULA, "start": FORMULA, "end": SCRIPT,
                    "notes": PATH}],
        "Items": [
            {"item": name, "floor": FORMULA, "type": SCRIPT} | dict.fromkeys(_TEXT, text) | {"segment": ""}
            for name, text in zip(names, HOSTILE, strict=True)
        ] + [{"item": "placed", "floor": FORMULA, "type": FORMULA, "route": FORMULA, "segment": SCRIPT, "x": 1,
              "y": 1}],
    }  # fmt: skip
    path = folder / "w.xlsx"
    parts = parts_of(write_sheets(path, rows))
    # XlsxWriter escapes the escape; a hostile file has the control character itself behind _xHHHH_.
    path.write_bytes(zipped({name: data.replace(b"_x005F_x00", b"_x00") for name, data in parts.items()}))
    results = assess.run(path)
    with no_figures():
        return results, assess.write_reports(results, folder / "out", ("xlsx", "html", "json", "csv", "docx"))


def test_the_inventory_is_cleaned_and_says_so_and_json_csv_html_and_word_have_its_texts(outputs):
    results, _ = outputs
    texts = [one.item.notes for one in results]
    assert texts[:4] == [FORMULA, SCRIPT, PATH, LONG.strip()]
    assert texts[4] == "bell\ufffdnull\ufffd end"
    assert texts[5] == "abcdef"
    assert any("control or direction characters" in one.message for one in results.problem_rows)
    _, written = outputs
    text = written["json"].read_text(encoding="utf-8")
    items = json.loads(text)["items"]
    for name in ("room", "description", "notes"):
        assert [item[name] for item in items][:4] == [FORMULA, SCRIPT, PATH, LONG.strip()]
    assert _no_hidden(text)
    text = written["csv"].read_text(encoding="utf-8-sig")
    assert _no_hidden(text)
    rows = list(csv.DictReader(text.splitlines()))
    for name in ("room", "description", "notes"):
        assert rows[0][name] == "'" + FORMULA
        assert rows[1][name] == SCRIPT
        assert rows[3][name] == LONG.strip()
    _, written = outputs
    text = written["html"].read_text(encoding="utf-8")
    tags = _Tags()
    tags.feed(text)
    assert (tags.wrong, tags.open) == ([], [])
    assert text.lower().count("<script") == 1
    (script,) = re.findall(r"<script>(.*?)</script>", text, flags=re.DOTALL)
    assert f"script-src '{hash_script(script)}'" in text
    assert "default-src 'none'" in text
    assert "url(" not in re.sub(r"url\((data:|#)", "", text)
    assert not re.search(r"(?:href|src)=\"(?!data:|#)", text)
    assert all('scope="' in head for head in re.findall(r"<th[ >][^>]*", text))
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in text
    assert "=HYPERLINK(&#34;http://x&#34;,&#34;y&#34;)" in text
    assert PATH in text
    assert _no_hidden(text)
    _, written = outputs
    texts = [
        cell.text for table in docx.Document(str(written["docx"])).tables for row in table.rows for cell in row.cells
    ]
    shown = " ".join(" ".join(texts).split())
    assert SCRIPT in shown
    assert FORMULA in shown
    texts = [data.decode() for name, data in parts_of(written["docx"]).items() if name.endswith((".xml", ".rels"))]
    assert not any('TargetMode="External"' in text for text in texts)
    assert all(_no_hidden(text) for text in texts)


def _no_hidden(text):
    return not re.search("[\x00-\x08\x0b\x0c\x0e-\x1f\u202a-\u202e\u2066-\u2069\u200e\u200f]", text)


def test_excel_which_counts_a_floor_with_such_a_name(outputs):
    """A name such as =HYPERLINK(...) is no criterion: the floor's pieces are counted."""
    results, written = outputs
    book = evaluate(written["xlsx"])
    summary = openpyxl.load_workbook(written["xlsx"])["Summary"]
    tops = [cell.row for row in summary.iter_rows(max_col=1) for cell in row if cell.value == "Floor"]
    counts = [book.get_value("Summary", top + 1, 9) for top in tops]
    assert sum(counts) == len(results)
    texts = set()
    for sheet in openpyxl.load_workbook(written["xlsx"]):
        for row in sheet.iter_rows():
            for cell in row:
                assert cell.hyperlink is None
                if cell.data_type == "f":
                    assert "HYPERLINK" not in cell.value
                elif isinstance(cell.value, str):
                    texts.add(cell.value)
    assert {FORMULA, SCRIPT, PATH, LONG.strip()} <= texts
    parts = parts_of(written["xlsx"])
    raw = b"".join(data for name, data in parts.items() if name.endswith(".xml")).decode()
    assert "<f>HYPERLINK" not in raw
    assert not any("hyperlink" in name for name in parts)
    assert _no_hidden(raw)


class _Tags(HTMLParser):
    """Collects the tags that are open, and those that are closed in the wrong order."""

    def __init__(self):
        super().__init__()
        self.open, self.wrong = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "img", "br", "wbr", "col", "link", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


@pytest.mark.slow
def test_pdf(outputs, tmp_path):
    results, _ = outputs
    editions = ("annex",)
    written = assess.write_reports(results, tmp_path, editions)
    texts = []
    for name in editions:
        document = pypdfium2.PdfDocument(written[name])
        texts += [document[at].get_textpage().get_text_range() for at in range(len(document))]
        document.close()
        assert b"/URI" not in written[name].read_bytes()
        assert b"/JavaScript" not in written[name].read_bytes()
    text = "".join(texts)
    flat = re.sub(r"[\s\ufffe]+", "", text)
    assert FORMULA.replace(" ", "") in flat
    assert SCRIPT in flat
    assert PATH in flat
    assert "characters;whole" in flat
    assert len(texts) < 60
