"""Writes the table of bounds in limits.md, from the constants: ``python docs/bounds.py``, part of ``make docs``."""

import importlib
from collections.abc import Iterator
from pathlib import Path

PAGE = Path(__file__).with_name("limits.md")
START, END = "<!-- bounds: python docs/bounds.py -->\n", "<!-- end of bounds -->\n"

REFUSED = "refused, with how to cut it down"
BY_CELL = "an error at the cell that names it"
OPEN, FORMATS, ARCHIVE = "assess.workbook.open", "assess.motion.formats", "assess.motion.formats._archive"
COMMON, CSV, TEXT = (f"assess.motion.formats.{name}" for name in ("_format", "plain_csv", "_text"))
ALLOWANCE, PICTURES, PLANS = "assess.workbook.kept_files", "assess.pictures", "assess.plans"

MODEL, PROCESS = "assess.bim.ifc_model", "assess.bim.model_process"
SCAN, HOME = "assess.bim.roomplan", "assess.bim.sweet_home"

ROWS: tuple[tuple[str, str, str, float, str, str], ...] = (
    ("Workbook: size of the file", OPEN, "MAX_FILE", 2**20, "{:.0f} MiB", REFUSED),
    ("Workbook: unpacked size of all its parts", OPEN, "MAX_TOTAL", 2**20, "{:.0f} MiB", REFUSED),
    ("Workbook: parts", OPEN, "MAX_PARTS", 1, "{:,.0f}", REFUSED),
    ("Workbook: rows of a sheet (items, floors, places, segments)", OPEN, "MAX_ROWS", 1, "{:,.0f}",
     "an error at the first cell beyond"),
    ("Workbook: columns of a sheet", OPEN, "MAX_COLUMNS", 1, "{:,.0f}", "an error at the first cell beyond"),
    ("Workbook: one row", OPEN, "MAX_ROW_BYTES", 2**20, "{:.0f} MiB of XML", REFUSED),
    ("Building model (IFC): size of the file", MODEL, "MOST_BYTES", 2**20, "{:.0f} MiB", REFUSED),
    ("Building model: processor time", PROCESS, "SECONDS", 1, "{:.0f} s", REFUSED),
    ("Building model: memory", PROCESS, "MEMORY", 2**30, "{:.0f} GiB", REFUSED),
    ("Building model: pieces", MODEL, "MOST_PIECES", 1, "{:,.0f}", REFUSED),
    ("Scan (RoomPlan): size of the file", SCAN, "MOST_BYTES", 2**20, "{:.0f} MiB", REFUSED),
    ("Scan (RoomPlan): objects", SCAN, "MOST_OBJECTS", 1, "{:,.0f}", REFUSED),
    ("Home (Sweet Home 3D): size of the file", HOME, "MOST_BYTES", 2**20, "{:.0f} MiB", REFUSED),
    ("Home (Sweet Home 3D): pieces", HOME, "MOST_PIECES", 1, "{:,.0f}", REFUSED),
    ("Topics of an export (BCF)", "assess.bim.export_topics", "MOST", 1, "{:,.0f}",
     "the last entries are left out, counted"),
    ("Record file: size", FORMATS, "LARGEST_FILE", 1e6, "{:.0f} MB", BY_CELL),
    ("Record file: channels", COMMON, "MOST_CHANNELS", 1, "{:,.0f}", BY_CELL + ", at the headings"),
    ("Record file: samples of a channel", "assess.motion.record", "MOST_SAMPLES", 1, "{:,.0f}", BY_CELL),
    ("Record file: samples of all channels", COMMON, "MOST_VALUES", 1, "{:,.0f}", BY_CELL),
    ("Record file: lines of text", TEXT, "MOST_LINES", 1, "{:,.0f}", BY_CELL),
    ("Record file: comments and headings of plain CSV", CSV, "MOST_HEAD", 2**10, "{:.0f} KiB", BY_CELL),
    ("Record file: one row of plain CSV", CSV, "BLOCK", 2**20, "{:.0f} MiB", BY_CELL),
    ("Record file: records of miniSEED", "assess.motion.formats.miniseed", "MOST_PARTS", 1, "{:,.0f}", BY_CELL),
    ("Zip archive: unpacked", ARCHIVE, "MOST_UNPACKED", 1e6, "{:.0f} MB", BY_CELL),
    ("Zip archive: one member, unpacked", ARCHIVE, "LARGEST_MEMBER", 1e6, "{:.0f} MB", BY_CELL),
    ("Zip archive: members", ARCHIVE, "MOST_MEMBERS", 1, "{:,.0f}", BY_CELL),
    ("Zip archive: archives in archives", ARCHIVE, "DEEPEST", 1, "{:.0f} levels", "the inner one is left out, noted"),
    ("All records of a workbook: size of the files", ALLOWANCE, "MOST_RECORD_BYTES", 1e6, "{:.0f} MB", BY_CELL),
    ("All records of a workbook: samples", ALLOWANCE, "MOST_RECORD_SAMPLES", 1, "{:,.0f}", BY_CELL),
    ("All records of a workbook: zip archives", ALLOWANCE, "MOST_ARCHIVES", 1, "{:,.0f}", BY_CELL),
    ("Hazard file: size", "assess.hazard", "LARGEST_FILE", 1e6, "{:.0f} MB", BY_CELL),
    ("Hazard file: cells", "assess.hazard", "MOST_CELLS", 1, "{:,.0f}", BY_CELL),
    ("Picture: size of the file", PICTURES, "MOST_BYTES", 2**20, "{:.0f} MiB", BY_CELL),
    ("Picture: pixels", PICTURES, "MOST_PIXELS", 1e6, "{:.0f} million", BY_CELL),
    ("Picture: longer side in a report", PICTURES, "SHOWN", 1, "{:,.0f} pixels", "made smaller"),
    ("All pictures of a workbook: pixels", ALLOWANCE, "MOST_PICTURE_PIXELS", 1e6, "{:.0f} million", BY_CELL),
    ("Plan as DXF: size of the file", PLANS, "MOST_FILE", 2**20, "{:.0f} MiB", BY_CELL),
    ("Plan as DXF: group codes", f"{PLANS}.dxf", "MOST_TAGS", 1, "{:,.0f}", BY_CELL),
    ("Plan as DXF: blocks that are inserted", f"{PLANS}.dxf", "MOST_INSERTS", 1, "{:,.0f}", BY_CELL),
    ("Plan as SVG: size of the file", PICTURES, "MOST_BYTES", 2**20, "{:.0f} MiB", BY_CELL),
    ("Plan as SVG or DXF: elements", f"{PLANS}.linework", "MOST_ELEMENTS", 1, "{:,.0f}", BY_CELL),
    ("Plan as SVG or DXF: points as read", f"{PLANS}.linework", "MOST_RAW", 1, "{:,.0f}", BY_CELL),
    ("Plan as SVG or DXF: points that are kept", f"{PLANS}.linework", "MOST_POINTS", 1, "{:,.0f}", BY_CELL),
    ("All drawings of a workbook: files", ALLOWANCE, "MOST_DRAWINGS", 1, "{:,.0f}", BY_CELL),
    ("All drawings of a workbook: size of the files", ALLOWANCE, "MOST_DRAWING_BYTES", 1e6, "{:.0f} MB", BY_CELL),
    ("Photos of a workbook: files", ALLOWANCE, "MOST_PHOTOS", 1, "{:,.0f}", BY_CELL),
    ("Photos of a workbook: size of all as reports hold them", ALLOWANCE, "MOST_PHOTO_BYTES", 1e6, "{:.0f} MB",
     BY_CELL),
    ("Fitted model: size of the file", "assess.methods.fitted", "MOST_BYTES", 2**10, "{:.0f} KiB", REFUSED),
    ("Fitted model: terms of a polynomial", "assess.methods.fitted", "MOST_TERMS", 1, "{:.0f}", REFUSED),
    ("Fitted models of a run", "assess.cli.command_run", "MOST_METHODS", 1, "{:.0f}", REFUSED),
    ("Simulation: results of one motion on one piece", "assess.pipeline.verify", "MOST_PAIRS", 1e6, "{:.0f} million",
     "refused before the first, with fewer motions as the way out"),
    ("Report: rows of pieces in the HTML and the PDF", "assess.report.sections.pieces", "MOST_LINES", 1, "{:,.0f}",
     "left out, noted; the Excel file and results.json hold all"),
)  # fmt: skip
"""What is bounded; module and name of the constant, its divisor and format; what happens past it."""


def build_table() -> str:
    """Return the table, with the line that starts and the one that ends it."""
    return START + "\n".join(_lines()) + "\n" + END


def _lines() -> Iterator[str]:
    yield "| what | at most | beyond that | constant |"
    yield "|---|---|---|---|"
    for what, module, name, divisor, form, beyond in ROWS:
        value = getattr(importlib.import_module(module), name)
        path = Path(str(importlib.import_module(module).__file__)).relative_to(Path(__file__).parents[1]).as_posix()
        yield f"| {what} | {form.format(value / divisor)} | {beyond} | `{path}` {name} |"


def replace_table(page: str) -> str:
    """Return a page with its table replaced."""
    before, _, rest = page.partition(START)
    return before + build_table() + rest.partition(END)[2]


if __name__ == "__main__":
    PAGE.write_text(replace_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
