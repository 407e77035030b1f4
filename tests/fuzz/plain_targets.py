"""Targets whose input is a file: recorded motions, the XML of a workbook, fitted models, pictures."""

import functools
import io
import random
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path

import numpy as np
import xlsxwriter

from assess.errors import AssessError, InputError, RecordError, WorkbookError
from assess.hazard import parse_hazard
from assess.methods import Cases
from assess.methods.fitted import read_model
from assess.motion.formats import list_addresses, parse_records, select
from assess.motion.record import MOST_ACCELERATION, treat
from assess.pictures import SHOWN, PictureError, check_picture, prepare_photo, prepare_picture, prepare_plan
from assess.settings import Settings
from assess.workbook.read import read_inventory
from tests.fuzz.engine import BrokenRuleError
from tests.fuzz.havoc import NUMBERS, mangle
from tests.motion.writers import SAMPLES, zipped
from tests.pictures import picture
from tests.workbook.books import FLOORS, ITEMS, write_book, write_shared
from tests.workbook.raw import SHEET, TABLE, add_part, sheet_of

ROOT = Path(__file__).parents[2]
LONGEST_MESSAGE = 3000


def check_message(error: AssessError, place: str) -> None:
    """Check that an error says where and what."""
    text = str(error)
    if place not in text or not len(place) + 5 < len(text) < LONGEST_MESSAGE:
        raise BrokenRuleError(f"a message that does not name its place, or is too long: {text[:200]!r}")


def keep(holds: bool, rule: str) -> None:
    """Raise BrokenRuleError unless a rule holds."""
    if not holds:
        raise BrokenRuleError(rule)


FURTHER = frozenset({"read", "read in part", "refused"})
"""How far an input may have got to be changed further."""


class Records:
    """Files of recorded motion of every format, archives, and hazard curves, which share the reading of CSV."""

    suffix, most_seconds, further = ".bin", 5.0, FURTHER
    tokens = (
        *NUMBERS, b"\0", b"\xff", b"\n", b"\r\n", b"|", b"[g]", b"[cm/s2]", b";", b",", b"\t", b"#", b'"',
        b"time [s],", b"# azimuth: ", b"UNCORRECTED", b"CORRECTED ACCELEROGRAM", b"/&", b"NPTS= ", b"DT= ",
        b"(8F10.3)", b"PK\x03\x04", b"points of accel data equally spaced at", b"SEC", b"cm/sec/sec", b"HNE",
        b"pga_g,annual_rate\n", b"GAL",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return a written file of every format, and the heads of the real ones."""
        real = [
            *(ROOT / "samples" / "records").glob("*.[sc][ms]?"),
            *(ROOT / "tests" / "data" / "hazard").glob("*.csv"),
        ]
        written = [SAMPLES[name]().data for name in SAMPLES]
        csv = b"# station: A\n# azimuth: a=0, b=90\ntime [s],a [g],b [cm/s2]\n" + b"".join(
            b"%.2f,%.3f,%d\n" % (row / 100, row % 7 / 100, row % 5) for row in range(40)
        )
        hazard = b"pga_g,annual_rate\n0.05,0.02\n0.1,0.01\n0.4,0.001\n"
        archives = [zipped({"a/r.bin": one[:9000], "b.txt": b"x"}, 0) for one in (written[0], written[6], csv)]
        return [*(path.read_bytes()[:90_000] for path in sorted(real)), *written, csv, hazard, *archives]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change bytes; now and then pack the file into an archive, under a name that may be odd."""
        if draw.random() < 0.03:
            name = draw.choice(["r", "../r", "/r", "a\\b", "\x1b[31m.v2", "é" * 200, "r/", "r#1", "\u202e"])
            return zipped({name: data, "r": data[:3000]}, draw.choice((0, 8)))
        return mangle(draw, data, pool, self.tokens)

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read it as a record and as a hazard curve."""
        del folder
        try:
            curve = parse_hazard(data, "fuzz.bin", latitude=37.0, longitude=-122.0)
            keep(bool(np.isfinite(curve.pga).all() and np.isfinite(curve.rate).all()), "a hazard curve is not finite")
        except InputError as error:
            check_message(error, "fuzz.bin")
        try:
            records = parse_records(data, "fuzz.bin")
        except RecordError as error:
            check_message(error, "fuzz.bin")
            return "refused"
        for address, record in zip(list_addresses(records), records, strict=True):
            keep(select(records, address) is record, "an address that does not mean its record")
            keep(bool(np.abs(record.acceleration).max() <= MOST_ACCELERATION), "a record above 50 g")
            keep(record.azimuth_deg is None or 0 <= record.azimuth_deg <= 360, "an azimuth beyond 360")
        if deep or records[0].acceleration.size * records[0].time_step < 100:
            motion = treat(records[0])
            keep(bool(np.isfinite([motion.pfa, motion.pfv, motion.pfd]).all()), "a treated motion is not finite")
        return "read"


class Xml:
    """The parts of a workbook's zip."""

    suffix, most_seconds, further = ".xlsx", 5.0, FURTHER
    tokens = (
        *NUMBERS, b"<", b">", b"</c>", b"</row>", b"<c r='A1'>", b'<row r="2">', b"<v>", b"<f>", b"&#x1b;",
        b"&lt;", b"<!DOCTYPE x []>", b"<!--", b"]]>", b"\xff\xfe", b"\0", b't="s"', b't="d"', b't="e"', b't="b"',
        b't="str"', b's="9"', b'"', b"x:", b"xml:space", b"A1:Z9", b"_x000D_", b"#REF!", b"true", b"\xc2\xa0",
        b"XFE1",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return small workbooks as Excel, openpyxl and a program that keeps texts in their cells write them."""
        with tempfile.TemporaryDirectory() as box:
            items = [[*ITEMS[0], "Notes"], ["A1", "1", 40, 180, "=1+1"], ["A2", "1", 30, 90, "é"]]
            excel = write_shared(Path(box) / "book.xlsx", {"Items": items, "Floors": FLOORS}).read_bytes()
            plain = write_book(Path(box) / "own.xlsx", {"Items": items, "Floors": FLOORS}).read_bytes()
            inline = add_part(write_book(Path(box) / "in.xlsx", {"Items": items, "Floors": FLOORS}), SHEET,
                              sheet_of(iter([TABLE]))).read_bytes()  # fmt: skip
        return [excel, plain, inline, _every_kind()]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change the bytes of a part, or exchange the value of an attribute; now and then the zip itself."""
        if draw.random() < 0.1:
            return mangle(draw, data, pool, [b"PK\x03\x04", b"PK\x01\x02", b"PK\x05\x06", *NUMBERS])
        try:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                parts = {name: archive.read(name) for name in archive.namelist()}
        except Exception:
            return draw.choice(pool[: len(self.seeds())])
        likely = [
            name for name in parts if "sheet" in name or "shared" in name or "workbook" in name or "styles" in name
        ]
        name = draw.choice(likely or list(parts))
        part = parts[name]
        pieces = part.split(b'"')
        if draw.random() < 0.4 and len(pieces) > 2:
            at = 2 * draw.randrange(len(pieces) // 2) + 1
            pieces[at] = draw.choice([*self.tokens, pieces[2 * draw.randrange(len(pieces) // 2) + 1]])
            parts[name] = b'"'.join(pieces)
        else:
            parts[name] = mangle(draw, part, [part, *pool], self.tokens, 3)
        target = io.BytesIO()
        with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            for one, content in parts.items():
                archive.writestr(one, content)
        return target.getvalue()

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read it, strictly and leaving out what is faulty."""
        del deep
        path = folder / "fuzz.xlsx"
        path.write_bytes(data)
        try:
            read_inventory(path)
        except WorkbookError as error:
            check_problems(error)
        else:
            return "read"
        try:
            read_inventory(path, strict=False)
        except WorkbookError:
            return "refused"
        return "read in part"


def _every_kind() -> bytes:
    """Return a workbook whose cells are of every kind: formulas with results, dates, errors, merged ones."""
    target = io.BytesIO()
    with xlsxwriter.Workbook(target) as book:
        date = book.add_format({"num_format": "yyyy-mm-dd"})
        for name, rows in {"Items": ITEMS, "Floors": FLOORS}.items():
            page = book.add_worksheet(name)
            for number, row in enumerate(rows):
                page.write_row(number, 0, row)
        page.write_row("C1", ["Notes", "Plan", "Elevation [m]"])
        page.write_formula("E2", "=1+1", None, 2)
        page.write_datetime("C2", datetime(2026, 2, 3, tzinfo=None), date)
        page.merge_range("C5:E6", "merged")
        page.write_boolean("D3", True)
        page.write_formula("D2", "=1/0", None, "#DIV/0!")
    return target.getvalue()


def check_problems(error: WorkbookError) -> None:
    """Check that each problem says what is wrong, where it is wrong if that is in a sheet, and in bounds."""
    keep(any(one.severity == "error" for one in error.problems), "an error without an error")
    for one in error.problems:
        keep(10 < len(str(one)) < LONGEST_MESSAGE, f"a message that is too short or long: {str(one)[:100]!r}")
        keep(not one.cell or bool(one.sheet), "a cell without a sheet")


class Models:
    """TOML files of fitted models."""

    suffix, most_seconds, further = ".toml", 2.0, FURTHER
    tokens = (
        *NUMBERS, b"[", b"]", b"=", b'"', b"'''", b"\\u0000", b"\\U0010ffff", b"[range]", b"b1 = ", b"1979-05-27",
        b"true", b"{a=1}", b"[" * 300, b"probit", b"polynomial", b'"1/x"', b"terms = ", b"#", b"\xef\xbb\xbf",
        b"fitted_",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return a model of each kind."""
        return [MODEL.format(kind=kind, formula=formula).encode() for kind, formula in FORMULAS.items()]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change bytes."""
        return mangle(draw, data, pool, self.tokens, 3)

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Read it, evaluate it, and have it describe itself."""
        del deep
        path = folder / "fuzz.toml"
        path.write_bytes(data)
        try:
            method = read_model(path)
        except InputError as error:
            check_message(error, str(path))
            return "refused"
        found = method.evaluate(_cases(), Settings())
        known = found.value[~np.isnan(found.value)]
        keep(bool(((known >= 0) & (known <= 1)).all()), "a chance beyond 0 to 1")
        keep(bool(method.title and method.short_title and method.equations), "a method without a title or equations")
        return "read"


@functools.cache
def _cases() -> Cases:
    sizes = np.array([0.001, 0.3, 0.45, 0.9, 5.0])
    motions = np.array([0.0, 1e-9, 2.0, 9.8, 400.0])
    breadth, pfa = (grid.ravel() for grid in np.meshgrid(sizes, motions))
    return Cases.of(breadth=breadth, height=1.8, pfa=pfa, pfv=pfa / 10)


FORMULAS = {
    "probit": "b0 = -1.5\nb1 = 0.8\nb2 = 1.1",
    "polynomial": 'base = "1/x"\nterms = [\n  [0, 0, -0.2],\n  [1, 1, 0.0003],\n  [2, 1, 1e-5],\n]',
}
MODEL = """# A fitted model.
format = 1
key = "fitted_{kind}_a"
title = "Model of two buildings"
kind = "{kind}"
fitted_on = "buildings A and B, 12 motions, 200 runs, seed 1"

[range]
breadth_to_height = [0.1, 0.6]
pfa_g = [0.05, 1.2]
height_cm = [60.0, 240.0]
pfv_cm_s = [2.0, 150.0]
pfv_over_pfa_s = [0.05, 0.3]

[errors]
leave_one_out_rmse = 0.12
leave_one_out_standard_error = 0.02
constant_rmse = 0.21

[{kind}]
{formula}
"""


class Pictures:
    """PNG and JPEG files."""

    suffix, most_seconds, further = ".bin", 5.0, FURTHER
    tokens = (
        *NUMBERS, b"IHDR", b"IDAT", b"IEND", b"PLTE", b"tRNS", b"acTL", b"fcTL", b"iCCP", b"eXIf", b"zTXt",
        b"\xff\xc0", b"\xff\xc2", b"\xff\xc4", b"\xff\xd8", b"\xff\xd9", b"\xff\xda", b"\xff\xe1\0\x08Exif",
        b"\xff\xe2MPF\0", b"\xff\xee", b"\0\0\0\0", b"\xff\xff\xff\xff", b"\x7f\xff\xff\xff", b"\x01", b"\x10",
        b"\x06",
    )  # fmt: skip

    def seeds(self) -> Sequence[bytes]:
        """Return pictures of all kinds of pixels, one of them wider than reports show."""
        modes = [("PNG", mode) for mode in ("1", "L", "LA", "P", "RGB", "RGBA", "I;16")]
        small = [
            picture(kind, mode, (12, 9)) for kind, mode in (*modes, ("JPEG", "L"), ("JPEG", "RGB"), ("JPEG", "CMYK"))
        ]
        return [*small, picture("JPEG", "RGB", (33, 17), progressive=True), picture("PNG", "RGB", (SHOWN + 1, 2))]

    def mutate(self, draw: random.Random, data: bytes, pool: Sequence[bytes]) -> bytes:
        """Change bytes; mostly put the sums of a PNG's parts right afterwards."""
        data = mangle(draw, data, pool, self.tokens, 3)
        return _repair(data) if data.startswith(b"\x89PNG") and draw.random() < 0.8 else data

    def check(self, data: bytes, folder: Path, *, deep: bool) -> str:
        """Check it as `assess check` does, and prepare it as a report does: what the one accepts the other can use."""
        del folder, deep
        try:
            check_picture(data)
        except PictureError as error:
            check_message(error, "it ")
            return "refused"
        from PIL import Image

        prepared, kind = prepare_picture(data)
        with Image.open(io.BytesIO(prepared)) as shown:
            shown.load()
            keep(max(shown.size) <= SHOWN, "a picture that is larger than reports show")
            keep(len(prepare_photo(data)) < 500_000, "a large photo")
            keep(prepare_plan(data, 300)[1] > 0, "a plan without height")
            keep(kind == f"image/{str(shown.format).lower()}" or shown.format == "MPO", "a picture of another kind")
        return "read"


def _repair(data: bytes) -> bytes:
    """Return a PNG whose parts have the right sums, as far as their lengths lead."""
    at, parts = 8, [data[:8]]
    while at + 12 <= len(data):
        size = int(struct.unpack_from(">I", data, at)[0])
        if at + 12 + size > len(data):
            break
        body = data[at + 4 : at + 8 + size]
        parts += [data[at : at + 4], body, struct.pack(">I", zlib.crc32(body))]
        at += 12 + size
    return b"".join([*parts, data[at:]])
