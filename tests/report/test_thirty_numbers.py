"""What a caretaker works by is one number in every document: fixings each and in all, and the pull, of ten lines."""

import json
import re

import docx
import openpyxl
import pytest

import assess
from assess.report.words import NO_BREAK
from tests.report.reading import read_pages

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def files(tmp_path_factory, verified_example):
    folder = tmp_path_factory.mktemp("thirty")
    return assess.write_reports(verified_example, folder, ("pdf", "html", "docx", "xlsx", "json", "work"))


def _flat(text):
    return " ".join(text.replace(NO_BREAK, " ").split())


def test_thirty_numbers_are_the_same_in_pdf_html_word_excel_work_orders_and_json(files):
    found = json.loads(files["json"].read_text(encoding="utf-8"))
    works = [
        (f"{entry['place']}", work)
        for entry in found["schedule"]["entries"]
        for work in entry["works"]
        if entry["phase"] != "C" and len(entry["works"]) == 1 and work["fixings"]
    ]
    assert len(works) >= 10
    sheet = openpyxl.load_workbook(files["xlsx"])["Work list"]
    heads = {cell.value: cell.column for cell in sheet[2]}
    rows = {
        str(row[heads["No."] - 1].value): [row[heads[head] - 1].value for head in ("Fixings each", "Fixings in all")]
        + [_flat(str(row[heads["Pull of one fixing"] - 1].value))]
        for row in sheet.iter_rows(min_row=3) if row[heads["No."] - 1].value
    }  # fmt: skip
    word = [[_flat(cell.text) for cell in row.cells] for table in docx.Document(str(files["docx"])).tables
            for row in table.rows]  # fmt: skip
    texts = {
        "pdf": _flat(" ".join(read_pages(files["pdf"]))), "work": _flat(" ".join(read_pages(files["work"]))),
        "html": _flat(re.sub(r"<[^>]+>", " ", files["html"].read_text(encoding="utf-8"))),
    }  # fmt: skip
    for number, work in works[:10]:
        mark = "+" if work["fixings_are_least"] else ""
        pull = f"{work['pull_kn']:.2f} kN" if work["pull_kn"] else "none"
        pull = "< 0.01 kN" if work["pull_kn"] and work["pull_kn"] < 0.005 else pull
        each, in_all = f"{work['fixings']}{mark}", f"{work['all_fixings']}{mark}"
        excel = rows[number]
        assert excel[:2] == [work["fixings"], work["all_fixings"]], number
        assert excel[2].startswith(pull), number
        line = f"{each} {in_all} {pull}"
        for name, text in texts.items():
            assert line in text, (name, number, line)
        cells = next(row for row in word if row[0] == number and len(row) >= 7)
        assert (cells[3], cells[4]) == (each, in_all), number
        assert cells[5].startswith(pull), number
