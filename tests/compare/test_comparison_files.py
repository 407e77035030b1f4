"""The files of a comparison: what they hold, whole or none, and that files of the user's own are left alone."""

import hashlib
import json
import re

import openpyxl
import pypdfium2
import pytest

from assess.compare import comparison_files
from assess.compare.changes import compare
from assess.compare.comparison_document import View
from assess.compare.comparison_files import write_comparison
from assess.compare.past_run import read_run
from assess.errors import CancelledError, InputError, OutputError, PdfUnavailableError
from assess.progress import Progress
from assess.report.ownership import is_sealed
from assess.settings import Settings
from tests.compare.past import change, item, write_routed_run
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """A building with routes before and after: stronger shaking, and a name that is markup and a formula."""
    folder = tmp_path_factory.mktemp("files")
    before = write_routed_run(folder / "weak", Settings(verify="none", scale=0.4))
    after = write_routed_run(folder / "b", UNVERIFIED)

    def edit(record):
        item(record, "calm").update(item="<script>alert(1)</script>", description="=1+1")
        record["building"]["building"] = "</h1><b>Hall & Co"

    return compare(read_run(before), read_run(change(after, folder / "c", edit)))


@pytest.fixture(scope="module")
def written(found, tmp_path_factory):
    return write_comparison(found, tmp_path_factory.mktemp("written") / "out")


def _text(document):
    return " ".join(" ".join(page.get_textpage().get_text_range() for page in document).split())


def test_the_list_of_the_files_is_right_and_the_pdf_is_sealed(written):
    assert set(written) == {"html", "pdf", "xlsx", "json"}
    folder = written["json"].parent
    assert {path.name for path in folder.iterdir()} == {path.name for path in written.values()}
    listed = json.loads(written["json"].read_text(encoding="utf-8"))["assess"]["files"]
    for name in ("compare.html", "compare.xlsx"):
        assert listed[name] == hashlib.sha256((folder / name).read_bytes()).hexdigest()
    assert listed["compare.pdf"] is None
    assert is_sealed(written["pdf"], written["json"])


def test_no_text_of_a_run_is_markup_a_link_or_a_formula(written):
    page = written["html"].read_text(encoding="utf-8")
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in page.replace("<wbr>", "")
    assert not re.search(r"(src|href)=|<script|</h1><b>", page)
    book = openpyxl.load_workbook(written["xlsx"])
    assert {cell.data_type for sheet in book for row in sheet.iter_rows() for cell in row} <= {"s", "n"}
    for sheet in book:
        assert sheet.page_setup.orientation == "landscape"
        assert len(sheet.oddHeader.left.text) + len(sheet.oddHeader.center.text or "") < 255


def test_the_pdf_is_tagged_carries_the_document_and_says_the_same(found, written):
    document = pypdfium2.PdfDocument(written["pdf"])
    assert document.is_tagged()
    attached = document.get_attachment(0)
    assert attached.get_name() == "compare.json"
    assert bytes(attached.get_data()) == written["json"].read_bytes()
    text = _text(document)
    assert View(found).headline in text
    assert all("BEFORE: motion × 0.4" in " ".join(page.get_textpage().get_text_range().split()) for page in document)
    assert "Page 1 of" in text
    assert next(mark.get_title() for mark in document.get_toc()) == "Status of the last report's recommendations"
    document.close()


def test_a_second_comparison_replaces_the_first_and_removes_what_it_does_not_write(found, tmp_path):
    write_comparison(found, tmp_path, ("html", "xlsx"))
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    write_comparison(found, tmp_path, ("html",))
    assert {path.name for path in tmp_path.iterdir()} == {"compare.html", "compare.json", "notes.txt"}


def test_a_file_of_the_users_own_is_not_replaced(found, tmp_path):
    (tmp_path / "compare.html").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match=r"would be replaced, but no compare\.json beside them .*: compare\.html\."):
        write_comparison(found, tmp_path, ("html",))
    assert {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()} == {"compare.html": "mine"}


@pytest.mark.slow
def test_a_file_that_was_changed_is_not_replaced(found, tmp_path):
    for name, formats in (("compare.html", ("html",)), ("compare.pdf", ("pdf",))):
        folder = tmp_path / name
        write_comparison(found, folder, formats)
        with (folder / name).open("ab") as file:
            file.write(b"\n% more")
        with pytest.raises(InputError, match=rf"changed after they were written, .*: {name}\. Move"):
            write_comparison(found, folder, formats)


def test_reports_of_a_run_in_the_folder_stay_and_are_not_taken_for_a_comparison(found, tmp_path):
    (tmp_path / "results.json").write_bytes(found.after.path.read_bytes())
    write_comparison(found, tmp_path, ("html",))
    write_comparison(found, tmp_path, ("xlsx",))
    assert {path.name for path in tmp_path.iterdir()} == {"results.json", "compare.xlsx", "compare.json"}
    assert (tmp_path / "results.json").read_bytes() == found.after.path.read_bytes()
    (tmp_path / "compare.json").write_text('{"schema": "1.0", "assess": {"version": "1"}}', encoding="utf-8")
    with pytest.raises(InputError, match="would be replaced"):
        write_comparison(found, tmp_path, ("html",))
    assert (tmp_path / "results.json").is_file()


def test_without_the_libraries_of_the_pdf_the_others_are_written(found, tmp_path, monkeypatch):
    def fail(*_given, **_named):
        raise PdfUnavailableError("no library")

    monkeypatch.setattr(comparison_files, "print_page", fail)
    with pytest.raises(PdfUnavailableError):
        write_comparison(found, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"compare.html", "compare.json", "compare.xlsx"}
    assert set(json.loads((tmp_path / "compare.json").read_text())["assess"]["files"]) == {
        "compare.html",
        "compare.xlsx",
    }


def test_what_fails_or_is_cancelled_leaves_nothing(found, tmp_path, monkeypatch):
    from threading import Event

    cancel = Event()
    cancel.set()
    with pytest.raises(CancelledError):
        write_comparison(found, tmp_path / "a", progress=Progress(None, cancel))

    def full(*_given, **_named):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(comparison_files, "render_comparison", full)
    with pytest.raises(OutputError, match="No space left on device"):
        write_comparison(found, tmp_path / "b", ("html", "xlsx"))
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError, match="'docx' is unknown"):
        write_comparison(found, tmp_path / "c", ("docx",))
