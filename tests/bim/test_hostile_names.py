"""Names in a building model command nothing: no terminal, spreadsheet or browser, and no file outside the folder."""

import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import openpyxl
import pytest

import assess
from assess.bim.building_model import LONGEST_NAME
from assess.bim.read_source import read_source
from assess.errors import ModelError
from assess.workbook.read import read_inventory
from tests.bim.ifc_files import ModelWriter
from tests.cli.calling import run
from tests.report.reading import write_html
from tests.test_unknown_texts import UNSAFE
from tests.workbooks import UNVERIFIED

SHELF = (0, 0, 0, 0.4, 0.8, 1.9)
SHAKEN = {"shaking": "MMI VIII, severe"}
NAMES = (
    "a\x1b]0;PWN\x07\x08\x9b31mz", r"a\X\1B]0;PWN\X\07\X\9B31mz", r"a\X\0Ab\X\0Dc", "_x000D_", "#REF!", "#N/A",
    '=HYPERLINK("http://evil.example","x")', "+1+1", "-2+3", "@SUM(A1)", "{=1+1}", "=cmd|' /C calc'!A0",
    "<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "&lt;script&gt;alert(2)&lt;/script&gt;",
    "../../../tmp/evil", "/etc/evil", "C:/evil", r"..\\..\\evil", "a#b; c; d", "{x} {0} %s {name!r}", "$", "*",
    "http://evil.example/", "internal:Items!A1", r"a\X2\202E\X0\cod.exe\X2\2066\X0\b", r"\X2\200B\X0\ ",
    r"a\X2\200B\X0\b", "ab", r"a\X2\D800\X0\b\X2\DFFF\X0\c", r"a\X2\D834DD1E\X0\b", r"a\X4\0010FFFF\X0\b",
    r"a\X4\7FFFFFFF\X0\b", r"a\X2\FFFE\X0\b", "x" * 10_000, "x" * 10_000 + "y", "w " * 5000,
)  # fmt: skip
"""As they stand in a file: ``\\X2\\`` and its like are escapes of STEP (ISO 10303-21)."""


def write_tower(path: Path) -> Path:
    """Write a model with a storey for each name, on which all have it: room, pieces, type, door, stair."""
    model = ModelWriter()
    for number in range(len(NAMES)):
        level, name = 3.0 * number, f"NAME{number};"
        storey = model.storey(name, level)
        storey.LongName = name
        room = model.space(storey, (3, 2, level, 6, 4, 2.8), name, name)
        pieces = [model.piece(name, SHELF, within=room, at=(at, 1, level), Tag=name) for at in (1, 2)]
        model.piece(name, SHELF, within=room, at=(4, 1, level + 1))
        model.typed("IfcFurnitureType", name, pieces[0])
        model.element("IfcDoor", name, (2, -0.1, level, 0.9, 0.1, 2.1), within=storey, OverallWidth=0.9)
        model.element("IfcWall", name, (3, -0.1, level, 6, 0.2, 2.8), within=storey)
        model.element("IfcStair", name, (5, 3, level, 0.9, 2.4, 3.0), within=storey)
        model.element("IfcBuildingElementProxy", name, SHELF, within=storey)
    model.building.LongName = f"NAME{NAMES.index('<script>alert(1)</script>')};"
    model.building.BuildingAddress = model.file.create_entity("IfcPostalAddress", Town=f"NAME{len(NAMES) - 3};")
    data = model.write(path).read_bytes()
    for number, name in enumerate(NAMES):
        data = data.replace(b"'NAME%d;'" % number, b"'" + name.replace("'", "''").encode("latin-1") + b"'")
    path.write_bytes(data)
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Return a folder in which a command has imported the model."""
    folder: Path = tmp_path_factory.mktemp("names")
    done = run("import", write_tower(folder / "a.ifc"), "-o", folder / "book.xlsx", "--routes", "draft")
    assert done.exit_code == 1, done.output  # the pieces on the wall were left out
    (folder / "said").write_text(done.output, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def page(folder) -> str:
    inventory = read_inventory(folder / "book.xlsx", building=SHAKEN)
    assert len(inventory.items) == 2 * len(NAMES)
    return write_html(assess.run(inventory, UNVERIFIED), folder / "out")


def test_terminal_workbook_and_plans_hold_them_harmless_and_cut(folder):
    said = (folder / "said").read_text(encoding="utf-8")
    assert "]0;PWN" in said
    assert "x" * (LONGEST_NAME + 1) not in said
    done = run("check", folder / "book.xlsx")
    errors = [line for line in done.stderr.splitlines() if line.startswith("error")]
    assert errors
    assert all("has neither a record nor a PFA" in line for line in errors)
    assert not UNSAFE.search(said + done.output)
    book = openpyxl.load_workbook(folder / "book.xlsx")
    formulas = [str(cell.value) for page in book for row in page.iter_rows() for cell in row if cell.data_type == "f"]
    assert not [one for one in formulas if re.search("HYPERLINK|evil|cmd|SUM\\(A1\\)", one)]
    assert not [cell.coordinate for page in book for row in page.iter_rows() for cell in row if cell.hyperlink]
    floors = {str(cell.value): cell.data_type for cell in book["Floors"]["A"]}
    assert floors['=HYPERLINK("http://evil.example","x")'] == floors["+1+1"] == floors["@SUM(A1)"] == "s"
    texts = [str(cell.value) for page in book for row in page.iter_rows() for cell in row if cell.data_type == "s"]
    assert not [one for one in texts if UNSAFE.search(one)]
    plans = sorted(folder.glob("*.svg"))
    assert len(plans) == len(NAMES)
    others = {"a.ifc", "a-import.txt", "book.xlsx", "said", "out"}
    assert {path.name for path in folder.iterdir()} <= {*(one.name for one in plans), *others}
    for one in plans:
        assert re.fullmatch(r"a(-[A-Za-z0-9-]{1,70})?\.svg", one.name), one.name
        tags = {element.tag.rpartition("}")[2] for element in ElementTree.parse(one).iter()}
        assert tags == {"svg", "style", "g", "path"}


class Tags(HTMLParser):
    """Notes what of a page a browser would run or fetch."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self.is_script = False

    def handle_starttag(self, tag, attributes) -> None:
        self.is_script = tag == "script"
        values = dict(attributes)
        self.found += [name for name in values if name.startswith("on")]
        self.found += [one for name in ("src", "href", "action") if "evil" in (one := str(values.get(name)))]

    def handle_endtag(self, tag) -> None:
        self.is_script = False

    def handle_data(self, data) -> None:
        if self.is_script and re.search(r"^\s*alert\(", data):
            self.found.append(data)


@pytest.mark.slow
def test_the_report_runs_nothing_of_them(page):
    tags = Tags()
    tags.feed(page)
    assert tags.found == []
    assert "&lt;script&gt;alert(1)" in page
    assert "<script>alert(" not in page
    assert not UNSAFE.search(page)


BREAKING = (b"a\x00b", rb"a\X2\ZZZZ\X0\b", b"\xff", rb"a\X2\0041", rb"a\X2\004", rb"a\X\G", b"\\S\\")


@pytest.mark.parametrize("name", BREAKING)
@pytest.mark.slow
def test_names_that_break_the_rules_of_the_file_end_in_words_or_are_read(tmp_path, name):
    model = ModelWriter()
    storey = model.storey()
    model.piece("NAME", SHELF, within=storey, at=(2, 1, 0))
    path = model.write(tmp_path / "a.ifc")
    data = path.read_bytes()
    path.write_bytes(data.replace(b"'NAME'", b"'" + name + b"'"))
    try:
        ends = f"{len(read_source(path, 'a.ifc').items)} taken"
    except ModelError as error:
        ends = error.message
    assert re.match(r"1 taken|a\.ifc (is damaged|could not be read): ", ends)
