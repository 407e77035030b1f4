"""Texts of unknown origin: none of them commands a terminal or turns the direction of writing, wherever it is shown."""

import re
import zipfile
from pathlib import Path

import pytest

from assess.cli.console import describe_progress, print_error, print_problems
from assess.errors import Problem
from assess.i18n import Catalogue, fill, gettext, join, nfill, speaking
from assess.motion.formats import read_records
from assess.progress import Report
from assess.report import write_reports
from assess.text import plain_line, plain_text
from tests.cli.calling import run
from tests.report.reading import render
from tests.shaking import RECORDS
from tests.workbook import books
from tests.workbook.books import change_parts, replace
from tests.workbooks import assessed

EVIL = "a\x1b]0;PWN\x07\x9b31m\x00\u202ecod\u2066\u200b\x7fz"
CLEAN = "a\ufffd]0;PWN\ufffd\ufffd31m\ufffdcod\ufffdz"
UNSAFE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b\u200e\u200f\u202a-\u202e\u2060\u2066-\u2069\ufeff]")


def archive(path: Path, member: str, data: bytes = b"no record") -> Path:
    with zipfile.ZipFile(path, "w") as out:
        out.writestr(zipfile.ZipInfo(member), data)
    return path


def record(title: str = EVIL) -> bytes:
    """A record of the PEER format whose title holds event, station and component."""
    values = "\n".join(f"{value:.6f}" for value in RECORDS["pulse"])
    name = title.replace("\u202e", "").replace("\u2066", "").replace("\u200b", "").replace("\x00", "")
    head = f"PEER\n{name} quake, 1/1/2000, {name} station, {name} NS\nACCELERATION TIME SERIES IN UNITS OF G\n"
    return f"{head}NPTS= {len(RECORDS['pulse'])}, DT= .0100\n{values}\n".encode("latin-1")


# ---------------------------------------------------------------- one rule


def test_what_is_no_text_is_taken_out() -> None:
    for text, shown in (
        ("plain", "plain"), ("Zürich ▲ 漢字 𝄞", "Zürich ▲ 漢字 𝄞"), (EVIL, CLEAN), ("a\r\nb\rc\td", "a\nb\nc\td"),
        ("a\ud800\ufffe\U0001ffffb", "a\ufffd\ufffd\ufffdb"), ("می\u200cخواهم", "می\u200cخواهم"), ("", ""),
    ):  # fmt: skip
        assert plain_text(text) == shown
        assert plain_line(text) == re.sub("[\t\n]", " ", shown)


def test_sentences() -> None:
    """A sentence is clean whatever its values hold, and its translation too."""
    texts: list[str] = [
        fill("{name} is wrong: {why:.40}", name=EVIL, why=str(ValueError(EVIL))),
        fill("{path} is wrong", path=Path(EVIL.replace("\x00", ""))),
        nfill("{n} {name}", "{n} of {name}", 2, name=EVIL),
        join("; ", [EVIL, fill("{x}", x=EVIL)]),
    ]
    italian = Catalogue("it", {"{name} is wrong: {why:.40}": ("{name} è sbagliato: {why:.40}",)})
    with speaking(italian):
        texts += [gettext(text) for text in texts]
    assert texts[4].startswith(f"{CLEAN} è sbagliato")
    assert [text for text in texts if UNSAFE.search(text)] == []


def test_messages_on_the_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    """A line break in a value makes no line that looks like a message of its own."""
    print_error(f"{EVIL}\nerror  forged")
    print_problems([Problem("warning", EVIL, "A1", "first\nerror  forged", EVIL)])
    shown = capsys.readouterr().err
    assert not UNSAFE.search(shown)
    assert [line for line in shown.splitlines() if line.startswith("error")] == [f"error  {CLEAN}"]
    assert describe_progress(Report("reading", 0.5, f"{EVIL}\nx", None)) == f"Reading {CLEAN} x: 50 %"


# ---------------------------------------------------------------- by source


def test_names_of_members_of_an_archive(tmp_path: Path) -> None:
    done = run("record", archive(tmp_path / "set.zip", "bad\x1b]0;PWN\x07.txt"))
    assert (done.exit_code, done.stdout) == (2, "")
    assert "bad\ufffd]0;PWN\ufffd.txt: unsupported file format" in done.stderr
    path = archive(tmp_path / "good.zip", "bad\x1b.AT2", record("x"))
    assert [one.file for one in read_records(path)] == ["good.zip/bad\ufffd.AT2"]
    assert not UNSAFE.search(run("record", path).output)


def test_texts_of_a_record(tmp_path: Path) -> None:
    """Its station, event and channels, on the terminal and in JSON."""
    (tmp_path / "a.AT2").write_bytes(record())
    lines = [f"{0.01 * at:.2f},{value:.6f}" for at, value in enumerate(RECORDS["pulse"])]
    (tmp_path / "a.csv").write_text("\n".join(["time [s],a\x1b\x9b\u202ex [g]", *lines]), encoding="utf-8")
    sought = ((["a.AT2"], "]0;PWN\ufffd\ufffd31m"), (["a.AT2", "--json"], "]0;PWN"), (["a.csv"], "a\ufffd\ufffdx"))
    for words, part in sought:
        done = run("record", tmp_path / words[0], *words[1:])
        assert done.exit_code == 0
        assert part in done.stdout, done.output
        assert not UNSAFE.search(done.stdout + done.stderr)
    (found,) = read_records(tmp_path / "a.AT2")
    assert not UNSAFE.search(f"{found.event}{found.station}{found.channel}{found.file}")


@pytest.mark.slow
def test_reports(tmp_path: Path) -> None:
    """Texts of a record and of a workbook reach every report clean."""
    (tmp_path / "a.AT2").write_bytes(record())
    items = [{"item": "A1", "floor": "1", "description": "Box_x001B_]0;x\u202e", "breadth": 30, "height": 180}]
    floors = [{"floor": "1", "record_x": "a.AT2", "pfa_y": 0.3}]
    results = assessed(tmp_path / "book.xlsx", items, floors)
    written = write_reports(results, tmp_path / "out", ("html", "json", "csv", "xlsx"))
    for name in ("html", "json", "csv"):
        text = written[name].read_text(encoding="utf-8-sig")
        assert "]0;" in text
        assert [found[0] for found in UNSAFE.finditer(text.replace("\r\n", "\n"))] == [], name
    assert not UNSAFE.search(render(results, for_print=True)), "of which the PDF is made"
    with zipfile.ZipFile(written["xlsx"]) as parts:
        assert not any(UNSAFE.search(parts.read(one).decode()) for one in parts.namelist() if one.endswith(".xml"))


def test_damaged_workbooks(tmp_path: Path) -> None:
    """What a message quotes of a workbook's XML is clean."""
    for part, old, new in (
        ("worksheets/sheet1", '<row r="2"', '<row r="a\x9bb\u202e"'), ("worksheets/sheet1", 't="n"', 't="\x9b"'),
        ("worksheets/sheet1", "<sheetData>", "<sheetData><x\u202e/>"),
        ("workbook", 'name="Items"', 'name="Item\x9bs\u202e"'),
    ):  # fmt: skip
        path = change_parts(books.write(tmp_path), {f"xl/{part}.xml": replace(old, new)})
        done = run("check", path)
        assert not UNSAFE.search(done.output), new
        assert part != "workbook" or (done.exit_code == 2 and "Item" in done.output)
