"""The PDF itself, read back: what it says of itself, what is attached to it, its outline and its fonts."""

import ctypes
import re
import subprocess
from dataclasses import replace
from threading import Event

import pypdfium2
import pypdfium2.raw as pdfium
import pytest

import assess
from assess.errors import CancelledError
from assess.progress import Progress
from assess.report.content import Content
from assess.report.pages.pdf import list_problems
from assess.report.report_options import ReportOptions
from assess.results import Series
from tests.report.reading import read_pages, write_pdf
from tests.workbooks import assessed

EPOCH = 1_700_000_000
PREPARED = {"building": "Town hall & Café", "prepared_by": "Ann Bee", "organisation": "Us & Co"}


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The default report in Italian, dated by SOURCE_DATE_EPOCH."""
    folder = tmp_path_factory.mktemp("pdf")
    assessment = assessed(folder / "Büro 1.xlsx", **PREPARED)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", str(EPOCH))
        written = assess.write_reports(assessment, folder / "out", ("pdf", "json"), ReportOptions(language="it"))
    document = pypdfium2.PdfDocument(written["pdf"])
    yield assessment, written, document
    document.close()


def _attachments(document):
    return {
        (one := document.get_attachment(at)).get_name(): bytes(one.get_data())
        for at in range(document.count_attachments())
    }


def test_it_tells_what_it_is_with_workbook_and_results_attached_and_every_font_embedded(report):
    _, written, document = report
    told = document.get_metadata_dict()
    assert "Town hall & Café" in told["Title"]
    assert told["Author"] == "Ann Bee, Us & Co"
    assert told["Keywords"]
    assert told["Creator"] == f"assess {assess.__version__}"
    assert told["CreationDate"] == told["ModDate"] == "D:20231114221320Z"
    size = pdfium.FPDFCatalog_GetLanguage(document.raw, None, 0)
    language = ctypes.create_string_buffer(size)
    pdfium.FPDFCatalog_GetLanguage(document.raw, ctypes.cast(language, ctypes.POINTER(ctypes.c_ushort)), size)
    assert language.raw.decode("utf-16-le").rstrip("\0") == "it"
    assert len(document) > 5
    assert document.is_tagged()
    source = written["pdf"].parents[1] / "Büro 1.xlsx"
    assert _attachments(document) == {
        source.name: source.read_bytes(),
        "results.json": written["json"].read_bytes(),
    }
    data = written["pdf"].read_bytes()
    kinds = re.findall(rb"/Subtype /(application[^/\s]+)", data)
    assert kinds == [b"application#2fvnd.openxmlformats-officedocument.spreadsheetml.sheet", b"application#2fjson"]
    packed = _unpack(written["pdf"])
    assert set(re.findall(rb"/AFRelationship /(\w+)", packed)) == {b"Source", b"Data"}
    dates = re.findall(rb"/(?:Creation|Mod)Date \((D:\d{14}Z)\)", data + packed)
    assert dates == [b"D:20231114221320Z"] * 6
    fonts = {}
    for page in document:
        for one in page.get_objects(filter=[pdfium.FPDF_PAGEOBJ_TEXT]):
            font = pdfium.FPDFTextObj_GetFont(one.raw)
            name = ctypes.create_string_buffer(80)
            pdfium.FPDFFont_GetBaseFontName(font, name, 80)
            fonts[name.value.decode()] = pdfium.FPDFFont_GetIsEmbedded(font)
    assert fonts
    assert set(fonts.values()) == {1}
    assert {name.split("+")[-1].split("-")[0] for name in fonts} <= {"Report", "emoji"}


@pytest.mark.slow
def test_a_report_has_the_workbook_that_was_read_and_without_its_series_names_what_is_left_out(tmp_path):
    results, read = assessed(tmp_path / "w.xlsx"), (tmp_path / "w.xlsx").read_bytes()
    (tmp_path / "w.xlsx").write_bytes(b"changed")
    assert list_problems(results) == []
    write_pdf(Content(results), tmp_path / "a.pdf", ReportOptions(accessible=True))
    assert b"pdfuaid" in _unpack(tmp_path / "a.pdf")
    document = pypdfium2.PdfDocument(tmp_path / "a.pdf")
    attached = _attachments(document)
    document.close()
    assert list(attached) == ["results.json", "w.xlsx"]
    assert attached["w.xlsx"] == read
    results = assessed(tmp_path / "w.xlsx")
    gone = replace(results, series=Series(tmp_path / "none.npz"))
    assert [str(one) for one in list_problems(gone)] == [
        "w.xlsx is not attached to the PDF: the results hold no copy of it."
    ]
    write_pdf(Content(gone), tmp_path / "a.pdf", ReportOptions(), edition="annex")
    document = pypdfium2.PdfDocument(tmp_path / "a.pdf")
    text = " ".join(read_pages(tmp_path / "a.pdf"))
    assert list(_attachments(document)) == ["results.json"]
    assert "w.xlsx is not attached to the PDF" in text
    assert "Figures are left out" in text
    assert "risk over breadth and acceleration" in text
    document.close()


def _unpack(path):
    """Return the small compressed streams of a PDF: objects, and what it says of itself."""
    import zlib

    found = re.findall(rb"stream\n(.*?)\nendstream", path.read_bytes(), re.DOTALL)
    return b"".join(zlib.decompress(one) for one in found if one[:1] == b"\x78" and len(one) < 200_000)


def test_a_cancelled_layout_ends_at_once(tmp_path, monkeypatch):
    """Cancelled while WeasyPrint lays the page out: its process is gone when the error arrives."""
    cancel, started, results = Event(), [], assessed(tmp_path / "w.xlsx")
    content = Content(results)

    class Started(subprocess.Popen[bytes]):
        def __init__(self, *args, **named):
            super().__init__(*args, **named)
            started.append(self)
            cancel.set()

    monkeypatch.setattr(subprocess, "Popen", Started)
    with pytest.raises(CancelledError):
        write_pdf(content, tmp_path / "a.pdf", ReportOptions(), Progress(None, cancel))
    (process,) = started
    assert process.returncode not in (None, 0)
    assert not (tmp_path / "a.pdf").exists()
